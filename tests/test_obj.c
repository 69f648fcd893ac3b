/* test_obj.c - the reader of Wavefront OBJ and its material libraries, and that all formats of models agree. */
#include "model_tests.h"

#include "../lib/load/reader.h"

#if ASET_WITH_POLYGONS

#define CONVERT_NO_MAIN
#include "convert.c"

#define THREE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#define ONE_LOG "t 0 0 0, 1 0 0, 0 1 0,; "
#define PYRAMID                                                                                                             \
    "# a pyramid\no pyramid\nv 0 0 0\nv 0 2 0\nv 2 2 0\nv 2 0 0\nv 1 1 1.5\ns off\nf 1 2 3 4\nf 1 4 5\nf 4 3 5\n"           \
    "f 3 2 5\nf 2 1 5\n"

static void test_obj__pyramid(void **state) {
    (void)state;
    expect_text(aset_load_obj, PYRAMID, PYRAMID_LOG);
    expect_log(aset_load_obj, PYRAMID, strlen(PYRAMID), false, NULL, PYRAMID_LOG, 0);
}

static void test_obj__forms_of_corners(void **state) {
    (void)state;
    static const char *const faces[] = {
        "f 1 2 3",
        "f 1/1 2/2 3/3",
        "f 1//1 2//2 3//3",
        "f 1/1/1 2/2/2 3/3/3",
        "f -3 -2 -1",
        "f 1/ 2/ 3//",
        "f -3/-9 2//7 3",
        "f 1/1/ 2/2/ 3/3/",
        "f -3//-3 -2//-2 -1//-1",
        "f 1 2 \\\n 3",
        "f 1 2\\\r\n 3",
        "f \\\n1 2 3",
        "f 1 2 3 # 4 5",
        "f 1 2 3#",
        "\tf\t1\t2\t3  ",
        "f 1\\\n2\\\n\\\n3",
        "f 1 2 3 # C:\\",
        "# C:\\\nf 1 2 3",
        "o x # C:\\\nf 1 2 3",
        "v 1 2 3 # C:\\\nf -4 -3 -2",
    };
    for (size_t i = 0; i < COUNT_OF(faces); i++) {
        char text[200];
        snprintf(text, sizeof text, THREE "vt 0 0\nvt 1 0 0\nvn 0 0 1\n%s\r\nf 1 2 3", faces[i]);
        expect_text(aset_load_obj, text, GREY ONE_LOG ONE_LOG);
    }
}

static void test_obj__negative_indices_count_from_where_they_stand(void **state) {
    (void)state;
    expect_text(aset_load_obj, THREE "f -3 -2 -1\nv 5 5 5\nf -4 -3 -2\nf -3 -2 -1\nf 1 2 -2\n",
                GREY ONE_LOG ONE_LOG "t 1 0 0, 0 1 0, 5 5 5,; " ONE_LOG);
}

static void test_obj__what_is_not_used_is_passed_over(void **state) {
    (void)state;
    expect_text(aset_load_obj,
                "\xef\xbb\xbf# from an editor\nmtllib none.mtl\ng a b c\no x\ns 1\nvt 0 nan\nvn x y z\nvp 1\np 1\nl 1 2 99\n"
                "curv 0 1 \\\n 1 2 3\ncall f.obj\ng \\\nf 9 9 9\n\xc3\xa9t\xc3\xa9 1 2\n"
                "v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 \\\n0\nf 1 2 3\nusemtl\nend",
                GREY ONE_LOG);
}

static void test_obj__bad_parts_are_counted_and_left_out(void **state) {
    (void)state;
    static const char text[] =
        THREE "v nan 0 0\nv 0 -inf 0\nv 0 0 1e99999\nf 1 2 3\nf 1 2 4\nf 1 2 3 5\nf 6 1 2 3\nf 1 2\nf 1\nf\n"
              "f 1 1 1\nf 1 2 3\nf 1 2 3\n";
    expect_log(aset_load_obj, text, strlen(text), true, NULL,
               GREY ONE_LOG ONE_LOG "t 0 0 0, 0 0 0, 0 0 0,; " ONE_LOG ONE_LOG, 1 + 1 + 2 + 3);
    aset_load_report report;
    aset_vertex_store store;
    const aset_load_options options = options_with(&store);
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of(PYRAMID, strlen(PYRAMID), SIZE_MAX);
    to.refuse_all = true;
    assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_ERR_SYNTAX);
    assert_int_equal(report.skipped, 6);
    assert_non_null(strstr(report.what, "that can be drawn"));
}

static void test_obj__errors(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"@", 1, ASET_ERR_SYNTAX, "", "no facet in it"},
        {"v 1 2 3\n@", 2, ASET_ERR_SYNTAX, "", "no facet in it"},
        {"v 1 2@", 1, ASET_ERR_SYNTAX, "", "ends within a vertex"},
        {"v 1 2\n@v 1 2 3", 2, ASET_ERR_SYNTAX, "v", "not complete before this"},
        {"v 1 @2,5 3\n", 1, ASET_ERR_SYNTAX, "2,5", "not a decimal number"},
        {THREE "f 1 2 @4\n", 4, ASET_ERR_SYNTAX, "4", "a vertex that is not there"},
        {THREE "f 1 2 @0\n", 4, ASET_ERR_SYNTAX, "0", "a vertex that is not there"},
        {THREE "f 1 2 @-4\n", 4, ASET_ERR_SYNTAX, "-4", "a vertex that is not there"},
        {THREE "f 1 2 @4294967297\n", 4, ASET_ERR_SYNTAX, "4294967297", "a vertex that is not there"},
        {THREE "f 1 2 @99999999999999999999999999\n", 4, ASET_ERR_SYNTAX, "99999999999999999999999999", "not there"},
        {THREE "f 1 2 @-99999999999999999999999999\n", 4, ASET_ERR_SYNTAX, "-99999999999999999999999999", "not there"},
        {THREE "f 1 2 @three\n", 4, ASET_ERR_SYNTAX, "three", "not a corner"},
        {THREE "f 1 2 @3.0\n", 4, ASET_ERR_SYNTAX, "3.0", "not a corner"},
        {THREE "f 1 2 @3/1/1/1\n", 4, ASET_ERR_SYNTAX, "3/1/1/1", "not a corner"},
        {THREE "f 1 2 @/3\n", 4, ASET_ERR_SYNTAX, "/3", "not a corner"},
        {THREE "f 1 2 @3/-\n", 4, ASET_ERR_SYNTAX, "3/-", "not a corner"},
        {THREE "f 1 2 @3/1x 2\n", 4, ASET_ERR_SYNTAX, "3/1x", "not a corner"},
        {THREE "f 1 2 @-\n", 4, ASET_ERR_SYNTAX, "-", "not a corner"},
        {"v 0 0 0\nf 1 1 @2\nv 1 1 1", 2, ASET_ERR_SYNTAX, "2", "a vertex that is not there"},
    };
    expect_all_bad(aset_load_obj, true, bad, COUNT_OF(bad));
    static const char control[] = "v 0 0 0\n\0\1\2";
    const bad_case byte = {NULL, 2, ASET_ERR_SYNTAX, "?", "a control byte"};
    expect_bad_bytes(aset_load_obj, control, sizeof control - 1, true, 8, &byte);
}

static void test_obj__smooth(void **state) {
    (void)state;
    static const char text[] = THREE "vn 0 0 1\nvn 0 1 1\nvn 1 nan 0\nf 1//1 2//2 3//1\nf 1//-2 2//2 3/9/2\nf 1//1 2 3//1\n"
                                     "f 1//1 2//2 3//3\nf 1/2 2/3 3/4\n";
    aset_vertex_store store;
    aset_load_options options = options_with(&store);
    options.smooth = true;
#if ASET_WITH_PATCHES
    expect_log(
        aset_load_obj, text, strlen(text), true, &options,
        GREY
        "p 0 0 0 / 0 0 1, 1 0 0 / 0 1 1, 0 1 0 / 0 0 1,; p 0 0 0 / 0 1 1, 1 0 0 / 0 1 1, 0 1 0 / 0 1 1,; " ONE_LOG ONE_LOG
            ONE_LOG,
        0);
    const char *absent = THREE "vn 0 0 1\nf 1//1 2//1 3//2\n"; /* whole data sets are so */
    expect_log(aset_load_obj, absent, strlen(absent), true, &options, GREY ONE_LOG, 0);
#else
    assert_int_equal(load_any(aset_load_obj, source_of(text, strlen(text), 1), true, options), ASET_ERR_UNSUPPORTED);
#endif
    expect_text(aset_load_obj, text, GREY ONE_LOG ONE_LOG ONE_LOG ONE_LOG ONE_LOG);
}

/* ---- materials ---- */

#if ASET_READER_BUFFER >= 3
#define MARK "\xef\xbb\xbf"
#else
#define MARK ""
#endif

static const char *const books[] = {
    "a.mtl",
    MARK "newmtl red\n# materials\nKd 1 0 0\nKa 1 1 1\nKs .25 .5 .125\nNs 10\nillum 3\nmap_Kd red.png\n\nnewmtl grey\nKd .5\n"
    "newmtl red\nKd 0 0 0\nnewmtl a name of its own\nKd 0 1 0\n",
    "b c.mtl",
    "newmtl blue\r\nKd 0 0 \\\r\n 1\r\nNs -2\r\n",
    "d.mtl",
    "Kd 9 9 9\nnewmtl red\nKd 9 9 9\nnewmtl plain",
    "e.mtl",
    "newmtl plain2",
    "names.mtl",
    "newmtl Material #25\nKd 1 0 0\nillum 2\nKs .25 .5 .125\nNs 10\nnewmtl #0000ff # blue\nKd 0 0 1\nnewmtl mirror\nillum 2\nKs 1\nillum 5\n",
    "glass.mtl",
    "newmtl by_d\nd 0.25\nTr 0.1\nNi 1.5\nnewmtl by_tr\nTr 0.25\nNi 1.25\nnewmtl by_halo\nd -halo 0.5\nnewmtl beyond\nd 7\n"
    "newmtl opaque\nd 1\nTr 1\n",
    "broken.mtl",
    "newmtl a\nKd 1 0 0\nnewmtl b\nKd 1 x 0\n",
    NULL,
};

static aset_load_options options_of(aset_vertex_store *store, aset_library *library, shelf *s) {
    aset_load_options options = options_with(store);
    memset(s, 0, sizeof *s);
    s->books = books;
    library->open = shelf_open;
    library->close = shelf_close;
    library->context = s;
    options.library = library;
    return options;
}

#define F "f 1 2 3\n"
#define RED "m 1 0 0, 1 0.5 10 0 0; "
#define HALF "m 0.5 0.5 0.5, 1 0 0 0 0; "
#define BLUE "m 0 0 1, 1 0 0 0 0; "

static void test_obj__materials(void **state) {
    (void)state;
    static const char text[] =
        "mtllib a.mtl\n" THREE F "usemtl red\n" F F "usemtl grey\nusemtl red\n" F "usemtl grey # half\n" F "usemtl blue\n" F
        "mtllib b c.mtl\nmtllib a.mtl\nusemtl blue\n" F "usemtl a name of  its own\nusemtl a name of its own  \n" F
        "usemtl\n" F "mtllib missing.mtl d.mtl e.mtl\nusemtl red\n" F "usemtl plain\n" F "usemtl plain2\n" F;
    aset_vertex_store store;
    aset_library library;
    shelf s;
    const aset_load_options options = options_of(&store, &library, &s);
    expect_log(aset_load_obj, text, strlen(text), true, &options,
               GREY ONE_LOG RED ONE_LOG ONE_LOG ONE_LOG HALF ONE_LOG GREY ONE_LOG BLUE ONE_LOG
               "m 0 1 0, 1 0 0 0 0; " ONE_LOG GREY ONE_LOG RED ONE_LOG GREY ONE_LOG ONE_LOG,
               0);
    assert_int_equal(s.opened, s.closed);
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of(text, strlen(text), SIZE_MAX);
    assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_OK);
    assert_int_equal(report.unknown_materials, 2); /* blue before its library, and two blanks where it has one */
    assert_int_equal(report.vertices, 3);
}

/* What exporters write: a # in names, quotes, a library behind the name, and no mirror where illum says that nothing reflects. */
static void test_obj__materials_as_exporters_write_them(void **state) {
    (void)state;
    static const char text[] = "usemtl Material #25\nmtllib \"names.mtl\"\n" THREE F "usemtl #0000ff\n" F "usemtl Material #26\n" F
                               "usemtl # nothing\n" F "usemtl mirror # \n" F "usemtl #";
    aset_vertex_store store;
    aset_library library;
    shelf s;
    const aset_load_options options = options_of(&store, &library, &s);
    expect_log(aset_load_obj, text, strlen(text), true, &options,
               "m 1 0 0, 1 0 10 0 0; " ONE_LOG BLUE ONE_LOG GREY ONE_LOG ONE_LOG "m 0.8 0.8 0.8, 1 1 0 0 0; " ONE_LOG, 0);
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of(text, strlen(text), 1);
    assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_OK);
    assert_int_equal(report.unknown_materials, 1);
}

static void test_obj__few_places_for_materials_cost_reading_only(void **state) {
    (void)state;
    char text[6000];
    size_t n =
        (size_t)snprintf(text, sizeof text, "mtllib a.mtl\nmtllib b c.mtl\nmtllib d.mtl e.mtl\nmtllib glass.mtl\n" THREE);
    static const char *const names[] = {"red", "grey", "blue", "plain", "opaque", "nobody", "plain2", "a name of its own"};
    for (int i = 0; i < 120; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "usemtl %s\n" F, names[(i * 5 + i * i / 7) % 8]);
    }
    aset_vertex_store store;
    aset_library library;
    shelf s;
    aset_load_options options = options_of(&store, &library, &s);
    aset_load_report report;
    recorder want = recorder_start(false);
    aset_sink sink = recorder_sink(&want);
    source from = source_of(text, n, SIZE_MAX);
    aset_named_material places[20];
    options.materials = places;
    options.n_materials = 20;
    assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_OK);
    const unsigned opened = s.opened;
    for (uint32_t k = 0; k < 9; k++) { /* none: the reader's own 8 */
        memset(places, 0xa5, sizeof places);
        recorder to = recorder_start(false);
        sink = recorder_sink(&to);
        from = source_of(text, n, SIZE_MAX);
        options.n_materials = k;
        s.opened = s.closed = 0;
        assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_OK);
        assert_string_equal(to.text, want.text);
        assert_true(s.opened >= opened && s.opened == s.closed);
        for (size_t i = k * sizeof places[0]; i < sizeof places; i++) {
            assert_int_equal(((unsigned char *)places)[i], 0xa5);
        }
        free(to.text);
    }
    free(want.text);
}

static void test_obj__transparency(void **state) {
    (void)state;
    static const char text[] = "mtllib glass.mtl\n" THREE "usemtl by_d\n" F "usemtl by_tr\n" F "usemtl by_halo\n" F
                               "usemtl beyond\n" F "usemtl opaque\n" F;
    aset_vertex_store store;
    aset_library library;
    shelf s;
    aset_load_options options = options_of(&store, &library, &s);
#if ASET_WITH_REFRACTION
    expect_log(aset_load_obj, text, strlen(text), true, &options,
               "m 0.8 0.8 0.8, 1 0 0 0.75 1.5; " ONE_LOG "m 0.8 0.8 0.8, 1 0 0 0.25 1.25; " ONE_LOG
               "m 0.8 0.8 0.8, 1 0 0 0.5 0; " ONE_LOG GREY ONE_LOG ONE_LOG,
               0);
#else
    assert_int_equal(load_any(aset_load_obj, source_of(text, strlen(text), 1), true, options), ASET_ERR_UNSUPPORTED);
    static const char opaque[] = "mtllib glass.mtl\n" THREE "usemtl beyond\n" F "usemtl opaque\n" F;
    expect_log(aset_load_obj, opaque, strlen(opaque), true, &options, GREY ONE_LOG ONE_LOG, 0);
#endif
}

static void test_obj__errors_of_libraries(void **state) {
    (void)state;
    static const char text[] = "mtllib broken.mtl\n" THREE "usemtl a\n" F;
    aset_vertex_store store;
    aset_library library;
    shelf s;
    aset_load_options options = options_of(&store, &library, &s);
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of(text, strlen(text), SIZE_MAX);
    assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_ERR_SYNTAX);
    assert_string_equal(report.library, "broken.mtl");
    assert_int_equal(report.line, 4);
    assert_int_equal(report.vertices, 3);
    assert_string_equal(report.token, "x");
    assert_int_equal(s.opened, s.closed);
    static const char joined[] = "mtllib e.mtl \\\n  a.mtl\n" THREE "usemtl  \\\r\n red\n" F;
    expect_log(aset_load_obj, joined, strlen(joined), true, &options, RED ONE_LOG, 0); /* lines joined within names */
    char padded[600] = "mtllib a.mtl\n" THREE "usemtl red"; /* blanks behind a name are none of it, however many */
    memset(padded + strlen(padded), ' ', 400);
    memcpy(padded + strlen(padded), "\n" F, sizeof "\n" F);
    expect_log(aset_load_obj, padded, strlen(padded), true, &options, RED ONE_LOG, 0);
    char longest[600] = "mtllib a.mtl\n" THREE "usemtl red\nusemtl "; /* 255 bytes, and a comment: of no library, so grey */
    memset(longest + strlen(longest), 'x', 255);
    memcpy(longest + strlen(longest), " # y\n" F, sizeof " # y\n" F);
    expect_log(aset_load_obj, longest, strlen(longest), true, &options, GREY ONE_LOG, 0);
    char names[400] = "d 0.5\nKd 1 0 0\nnewmtl "; /* what belongs to no material; a name that is too long */
    const char *const own[] = {"broken.mtl", names, NULL};
    memset(names + strlen(names), 'x', 300);
    s.books = own;
    from = source_of(text, strlen(text), SIZE_MAX);
    assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_ERR_LIMIT);
    assert_string_equal(report.library, "broken.mtl");
    assert_int_equal(report.line, 3);
    assert_int_equal(s.opened, s.closed);
    s.books = books;
    for (size_t at = 1; at < strlen(books[1]); at++) { /* every library fails at every byte */
        static const char good[] = "mtllib a.mtl\n" THREE "usemtl red\n" F;
        from = source_of(good, strlen(good), SIZE_MAX);
        s.fail_at = at;
        assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_ERR_READ);
        assert_string_equal(report.library, "a.mtl");
        assert_int_equal(s.opened, s.closed);
    }
}

static void test_obj__library_texts_survive(void **state) {
    (void)state;
    static const char text[] = "mtllib x\n" THREE "usemtl by_d\n" F "usemtl beyond\n" F "usemtl red\n" F;
    static const char others[] = {0, '\n', ' ', '#', '-', '.', '9', '\\', 127, -1};
    const char *const originals[] = {books[1], books[9]};
    for (size_t b = 0; b < COUNT_OF(originals); b++) {
        const size_t size = strlen(originals[b]);
        char *copy = malloc(size + 1);
        assert_non_null(copy);
        for (size_t at = 0; at < size; at++) {
            for (size_t i = 0; i < COUNT_OF(others); i++) { /* the first, 0, cuts it off */
                const char *own[] = {"x", copy, NULL};
                aset_vertex_store store;
                aset_library library;
                shelf s;
                const aset_load_options options = options_of(&store, &library, &s);
                s.books = own;
                memcpy(copy, originals[b], size + 1);
                copy[at] = others[i];
                const aset_status status = load_any(aset_load_obj, source_of(text, strlen(text), SIZE_MAX), true, options);
                assert_true(status == ASET_OK || status == ASET_ERR_SYNTAX ||
                            (!ASET_WITH_REFRACTION && status == ASET_ERR_UNSUPPORTED));
                assert_int_equal(s.opened, s.closed);
            }
        }
        free(copy);
    }
}

static void test_obj__too_many_names(void **state) {
    (void)state;
    char text[2000];
    size_t n = 0;
    for (int i = 0; i < 60; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "mtllib library%02d\n", i); /* 10 bytes each */
    }
    const bad_case names = {NULL, 51, ASET_ERR_LIMIT, "mtllib", "more names"};
    expect_bad_bytes(aset_load_obj, text, n, true, 50 * 17, &names);
    n = (size_t)snprintf(text, sizeof text, "usemtl ");
    memset(text + n, 'x', 300);
    const bad_case name = {NULL, 1, ASET_ERR_LIMIT, "usemtl", "a name too long"};
    expect_bad_bytes(aset_load_obj, text, n + 300, true, 0, &name);
}

/* ---- memory ---- */

static void test_obj__memory_for_vertices(void **state) {
    (void)state;
    for (size_t fits = 0; fits < 6; fits++) {
        for (size_t slack = 0; slack < 2; slack++) {
            aset_vertex_store store;
            aset_load_options options = options_with(&store);
            aset_load_report report;
            recorder to = recorder_start(true);
            const aset_sink sink = recorder_sink(&to);
            source from = source_of(PYRAMID, strlen(PYRAMID), SIZE_MAX);
            store.size = ASET_BYTES_VERTICES(fits, false, false) + slack * (3 * sizeof(aset_real) - 1);
            const aset_status status = aset_load_obj(&sink, give, &from, &options, &report);
            assert_int_equal(status, fits == 5 ? ASET_OK : ASET_ERR_NOMEM);
            if (fits < 5) {
                char token[32];
                snprintf(token, sizeof token, "%lu vertices", (unsigned long)fits);
                assert_string_equal(report.token, token);
                assert_int_equal(report.line, 3 + fits);
                assert_non_null(strstr(report.expected, "spill file"));
            }
        }
    }
}

/* Faces and points in turn, normals too: through every window it is the same as in memory. */
static void test_obj__spilling_changes_nothing(void **state) {
    (void)state;
    static char text[200000];
    static unsigned char block[200000];
    size_t n = 0;
    for (int i = 0; i < 2500; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "v %d %d %d\n", i, i * 31 % 97, i * 7 % 13);
        if (i % 3 == 0) {
            n += (size_t)snprintf(text + n, sizeof text - n, "vn %d 1 %d\n", i, i * 3 % 7);
        }
        if (i > 2) {
            n += (size_t)snprintf(text + n, sizeof text - n, "f %d//%d %d//-1 -%d//1\n", i * 37 % i + 1,
                                  i * 53 % (i / 3) + 1, i * 91 % i + 1, i * 17 % i + 1);
        }
    }
    for (int smooth = 0; smooth <= (ASET_WITH_PATCHES ? 1 : 0); smooth++) {
        char *want = NULL;
        for (size_t size = sizeof block; size >= ASET_BYTES_WINDOW; size = size > 20000 ? size / 2 : size * 3 / 4) {
            spill_file file;
            aset_vertex_store store;
            aset_load_options options = options_with(&store);
            aset_load_report report;
            recorder to = recorder_start(false);
            const aset_sink sink = recorder_sink(&to);
            source from = source_of(text, n, SIZE_MAX);
            memset(&file, 0, sizeof file);
            store.block = block;
            store.size = size;
            store.write = spill_write;
            store.read = spill_read;
            store.context = &file;
            options.smooth = smooth == 1;
            assert_int_equal(aset_load_obj(&sink, give, &from, &options, &report), ASET_OK);
            assert_int_equal(report.triangles, 2497);
            if (want == NULL) {
                want = to.text;
                assert_int_equal(file.size, 0);
            } else {
                assert_string_equal(to.text, want);
                free(to.text);
            }
            for (unsigned call = 1, calls = file.calls; call <= calls; call += calls / 5 + 1) {
                recorder quiet = recorder_start(true);
                const aset_sink other = recorder_sink(&quiet);
                spill_free(&file);
                memset(&file, 0, sizeof file);
                file.fail_call = call;
                from = source_of(text, n, SIZE_MAX);
                assert_int_equal(aset_load_obj(&other, give, &from, &options, &report), ASET_ERR_READ);
            }
            spill_free(&file);
        }
        free(want);
    }
}

static void test_obj__survives(void **state) {
    (void)state;
    static const char other[] = THREE "vt 1 2\nvn 0 0 1\nf 1/1/1 2//1 \\\n-1\nusemtl x\nf 1 2 3";
    expect_cuts(aset_load_obj, PYRAMID, strlen(PYRAMID), true);
    expect_failures(aset_load_obj, PYRAMID, strlen(PYRAMID));
    expect_survival(aset_load_obj, PYRAMID, strlen(PYRAMID));
    expect_sink_errors(aset_load_obj, PYRAMID, strlen(PYRAMID), 31);
    expect_cuts(aset_load_obj, other, strlen(other), true);
    expect_failures(aset_load_obj, other, strlen(other));
    expect_survival(aset_load_obj, other, strlen(other));
}

/* ---- one model in all formats ---- */

/* The hash of a file's triangles, all its vertices in memory. */
static uint64_t hash_of_file(loader load, FILE *file, uint64_t *triangles) {
    static unsigned char block[1000000];
    aset_vertex_store store;
    aset_load_options options = options_with(&store);
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    store.block = block;
    store.size = sizeof block;
    rewind(file);
    assert_int_equal(load(&sink, read_stream, file, &options, &report), ASET_OK);
    assert_int_equal(report.skipped, 0);
    *triangles = to.triangles;
    return to.hash;
}

static void expect_same_in_all_formats(FILE *obj, const char *path, uint64_t n) {
    static const struct {
        const char *name;
        loader load;
    } formats[] = {{"obj", aset_load_obj},       {"stl", aset_load_stl},    {"stl-ascii", aset_load_stl},
                   {"ply-ascii", aset_load_ply}, {"ply-le", aset_load_ply}, {"ply-be", aset_load_ply}};
    uint64_t triangles;
    const uint64_t hash = hash_of_file(aset_load_obj, obj, &triangles);
    assert_int_equal(triangles, n);
    mesh m;
    memset(&m, 0, sizeof m);
    assert_true(read_mesh(&m, path));
    for (size_t i = 0; i < COUNT_OF(formats); i++) {
        FILE *file = tmpfile();
        assert_non_null(file);
        assert_true(write_mesh(&m, file, formats[i].name));
        assert_int_equal(hash_of_file(formats[i].load, file, &triangles), hash);
        assert_int_equal(triangles, n);
        (void)fclose(file);
    }
    free_mesh(&m);
}

/* Three models of others, when they are there. */
static void test_obj__real_models_are_the_same_in_all_formats(void **state) {
    (void)state;
    static const struct {
        const char *name;
        uint64_t triangles;
    } models[] = {{"stanford-bunny", 69451}, {"suzanne", 968}, {"teapot", 6320}};
    for (size_t i = 0; i < COUNT_OF(models); i++) {
        char path[100];
        snprintf(path, sizeof path, "../shared/models/%s.obj", models[i].name);
        FILE *file = fopen(path, "rb");
        if (file == NULL) {
            print_message("skipped: no %s\n", path);
            continue;
        }
        expect_same_in_all_formats(file, path, models[i].triangles);
        (void)fclose(file);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_obj__pyramid),
        cmocka_unit_test(test_obj__forms_of_corners),
        cmocka_unit_test(test_obj__negative_indices_count_from_where_they_stand),
        cmocka_unit_test(test_obj__what_is_not_used_is_passed_over),
        cmocka_unit_test(test_obj__bad_parts_are_counted_and_left_out),
        cmocka_unit_test(test_obj__errors),
        cmocka_unit_test(test_obj__smooth),
        cmocka_unit_test(test_obj__materials),
        cmocka_unit_test(test_obj__materials_as_exporters_write_them),
        cmocka_unit_test(test_obj__few_places_for_materials_cost_reading_only),
        cmocka_unit_test(test_obj__transparency),
        cmocka_unit_test(test_obj__errors_of_libraries),
        cmocka_unit_test(test_obj__library_texts_survive),
        cmocka_unit_test(test_obj__too_many_names),
        cmocka_unit_test(test_obj__memory_for_vertices),
        cmocka_unit_test(test_obj__spilling_changes_nothing),
        cmocka_unit_test(test_obj__survives),
        cmocka_unit_test(test_obj__real_models_are_the_same_in_all_formats),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

static void test_obj__switched_off(void **state) {
    (void)state;
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of("", 0, 1);
    assert_int_equal(aset_load_obj(&sink, give, &from, NULL, &report), ASET_ERR_UNSUPPORTED);
    assert_non_null(report.what);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_obj__switched_off)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
