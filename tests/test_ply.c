/* test_ply.c - the reader of the Polygon File Format, text and binary of both byte orders. */
#include "model_tests.h"

#if ASET_WITH_POLYGONS

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define LIST "property list uchar int vertex_indices\n"
#define TEXT "ply\nformat ascii 1.0\n"
/* Three points and a face of them, with more properties of either. */
#define ONE(more_vertex, more_face)                                                                                         \
    TEXT "element vertex 3\n" XYZ more_vertex "element face 1\n" LIST more_face "end_header\n"
#define ONE_LOG "t 0 0 0, 1 0 0, 0 1 0,; "

#define TEXT_PYRAMID                                                                                                        \
    TEXT "comment 5 points, one square\nobj_info none\nelement vertex 5\n" XYZ "element face 5\n" LIST                      \
         "end_header\n0 0 0\n0 2 0\n2 2 0\n2 0 0\n1 1 1.5\n4 0 1 2 3\n3 0 3 4\n3 3 2 4\n3 2 1 4\n3 1 0 4\n"

static bytes_buffer pyramid(bool high_first) {
    bytes_buffer to;
    memset(&to, 0, sizeof to);
    to.high_first = high_first;
    add_text(&to, high_first ? "ply\nformat binary_big_endian 1.0\n" : "ply\nformat binary_little_endian 1.0\n");
    add_text(&to, "element vertex 5\n" XYZ "element face 6\n" LIST "end_header\n");
    for (int i = 0; i < 15; i++) {
        add_float(&to, pyramid_points[i / 3][i % 3]);
    }
    for (int t = 0; t < 6; t++) {
        add_number(&to, 3, 1);
        for (int i = 0; i < 3; i++) {
            add_number(&to, pyramid_triangles[t][i], 4);
        }
    }
    return to;
}

static void test_ply__pyramid_in_all_forms(void **state) {
    (void)state;
    expect_text(aset_load_ply, TEXT_PYRAMID, PYRAMID_LOG);
    expect_text(aset_load_ply, "\xef\xbb\xbf" TEXT_PYRAMID, PYRAMID_LOG); /* UTF-8's mark */
    for (int i = 0; i < 2; i++) {
        const bytes_buffer file = pyramid(i == 1);
        expect_log(aset_load_ply, file.bytes, file.size, true, NULL, PYRAMID_LOG, 0);
        expect_log(aset_load_ply, file.bytes, file.size, false, NULL, PYRAMID_LOG, 0);
    }
}

/* Every type for x, and for the count and the numbers of the list, behind and between properties that mean nothing. */
static void add_typed(bytes_buffer *to, int type, int x) {
    static const unsigned bytes[] = {1, 1, 2, 2, 4, 4};
    if (type < 6) {
        add_number(to, (uint32_t)x, bytes[type]);
    } else if (type == 6) {
        add_float(to, (float)x);
    } else {
        const double wide = x;
        uint64_t bits;
        memcpy(&bits, &wide, sizeof bits);
        add_number(to, (uint32_t)(to->high_first ? bits >> 32 : bits), 4);
        add_number(to, (uint32_t)(to->high_first ? bits : bits >> 32), 4);
    }
}

static void test_ply__every_type_anywhere(void **state) {
    (void)state;
    static const char *const names[2][8] = {{"char", "uchar", "short", "ushort", "int", "uint", "float", "double"},
                                            {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"}};
    for (int high = 0; high < 2; high++) {
        for (int type = 0; type < 8; type++) {
            const char *name = names[high][type], *whole = names[1 - high][type < 6 ? type : 1];
            const int whole_type = type < 6 ? type : 1, low = type % 2 == 0 || type > 5 ? -1 : 0;
            char header[900], log[200];
            bytes_buffer to;
            memset(&to, 0, sizeof to);
            to.high_first = high == 1;
            snprintf(
                header, sizeof header,
                "ply\r\nformat binary_%s_endian 1.0\r\nelement camera 2\r\nproperty %s fov\r\nproperty list %s %s knots\r\n"
                "element vertex 3\r\nproperty double quality\r\nproperty list %s %s near\r\nproperty %s z\r\n"
                "property char flags\r\nproperty %s x\r\nproperty %s y\r\nelement face 1\r\nproperty %s a\r\n"
                "property list uchar double uv\r\nproperty list %s %s vertex_index\r\nproperty short b\r\nend_header\r\n",
                high == 1 ? "big" : "little", name, whole, name, whole, name, name, name, name, name, whole, whole);
            add_text(&to, header);
            for (int i = 0; i < 2; i++) {
                add_typed(&to, type, 7);
                add_typed(&to, whole_type, 2 * i);
                for (int k = 0; k < 2 * i; k++) {
                    add_typed(&to, type, 100);
                }
            }
            for (int i = 0; i < 3; i++) {
                add_typed(&to, 7, 12345);
                add_typed(&to, whole_type, 1);
                add_typed(&to, type, 9);
                add_typed(&to, type, low), add_typed(&to, 0, -5), add_typed(&to, type, i == 1 ? 100 : 0);
                add_typed(&to, type, i == 2 ? 50 : 0);
            }
            add_typed(&to, type, 1);
            add_typed(&to, 1, 2), add_typed(&to, 7, 3), add_typed(&to, 7, 4);
            add_typed(&to, whole_type, 3);
            for (int i = 0; i < 3; i++) {
                add_typed(&to, whole_type, i);
            }
            add_typed(&to, 2, 1);
            snprintf(log, sizeof log, GREY "t 0 0 %d, 100 0 %d, 0 50 %d,; ", low, low, low);
            expect_log(aset_load_ply, to.bytes, to.size, true, NULL, log, 0);
            expect_cuts(aset_load_ply, to.bytes, to.size, false);
        }
    }
}

static void test_ply__line_ends_before_binary_data(void **state) {
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r", " \n", "\t \r\n", " \t\r"};
    for (size_t e = 0; e < COUNT_OF(ends); e++) {
        bytes_buffer to;
        char header[400];
        memset(&to, 0, sizeof to);
        snprintf(
            header, sizeof header,
            "ply%sformat binary_little_endian 1.0%selement vertex 3%sproperty char x%sproperty char y%sproperty char z%s"
            "element face 1%sproperty list char char vertex_indices%send_header%s",
            ends[e], ends[e], ends[e], ends[e], ends[e], ends[e], ends[e], ends[e], ends[e]);
        add_text(&to, header);
        add_text(&to, "\n\r\n\r\n\r \n\t"); /* the data begins with what looks like an end of a line */
        add_number(&to, 3, 1), add_number(&to, 0, 1), add_number(&to, 1, 1), add_number(&to, 2, 1);
        expect_log(aset_load_ply, to.bytes, to.size, true, NULL, GREY "t 10 13 10, 13 10 13, 32 10 9,; ", 0);
    }
}

static void test_ply__colours(void **state) {
    (void)state;
    expect_text(aset_load_ply,
                ONE("property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n",
                    "") "0 0 0 255 0 0 9\n1 0 0 0 255 0 9\n0 1 0 0 255 255 9\n3 0 1 2\n",
                "m 0.333333 0.666667 0.333333, 1 0 0 0 0; " ONE_LOG);
    expect_text(aset_load_ply,
                ONE("property float r\nproperty float b\nproperty float g\n",
                    "") "0 0 0 1 .5 .25\n1 0 0 1 .5 .25\n0 1 0 1 .5 .25\n3 0 1 2\n",
                "m 1 0.25 0.5, 1 0 0 0 0; " ONE_LOG);
    expect_text(
        aset_load_ply,
        ONE("property uchar red\nproperty uchar green\nproperty uchar blue\n",
            "property ushort red\nproperty ushort green\nproperty ushort blue\n") "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 "
                                                                                  "255 255\n3 0 1 2 65535 0 13107\n",
        "m 1 0 0.2, 1 0 0 0 0; " ONE_LOG);
    expect_text(aset_load_ply, /* not all three, negative, and not a number */
                ONE("property uchar red\nproperty uchar blue\n", "") "0 0 0 255 0\n1 0 0 0 255\n0 1 0 0 255\n3 0 1 2\n",
                GREY ONE_LOG);
    expect_text(
        aset_load_ply,
        ONE("", "property float diffuse_red\nproperty float diffuse_green\nproperty float diffuse_blue\n") "0 0 0\n1 0 0\n0 "
                                                                                                           "1 0\n3 0 1 2 -1 "
                                                                                                           "nan 2\n",
        "m 0 0 2, 1 0 0 0 0; " ONE_LOG);
}

static void test_ply__a_colour_before_or_behind_the_list(void **state) {
    (void)state;
    expect_text(aset_load_ply,
                TEXT "element vertex 4\n" XYZ "element face 3\nproperty uchar red\nproperty uchar green\n" LIST
                     "property uchar blue\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                     "255 0 4 0 1 2 3 0\n255 0 3 0 1 2 0\n0 0 3 0 1 2 255\n",
                "m 1 0 0, 1 0 0 0 0; t 0 0 0, 1 0 0, 1 1 0,; t 0 0 0, 1 1 0, 0 1 0,; t 0 0 0, 1 0 0, 1 1 0,; "
                "m 0 0 1, 1 0 0 0 0; t 0 0 0, 1 0 0, 1 1 0,; ");
}

static void test_ply__normals_if_wanted(void **state) {
    (void)state;
    static const char text[] =
        ONE("property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\n",
            "") "0 0 0 0 0 1 255 255 255\n1 0 0 0 1 1 255 255 255\n0 1 0 0 0 2 255 255 255\n3 0 1 2\n";
    expect_text(aset_load_ply, text, "m 1 1 1, 1 0 0 0 0; " ONE_LOG);
    aset_vertex_store store;
    aset_load_options options = options_with(&store);
    options.smooth = true;
#if ASET_WITH_PATCHES
    expect_log(aset_load_ply, text, strlen(text), true, &options,
               "m 1 1 1, 1 0 0 0 0; p 0 0 0 / 0 0 1, 1 0 0 / 0 1 1, 0 1 0 / 0 0 2,; ", 0);
    expect_log(aset_load_ply, TEXT_PYRAMID, strlen(TEXT_PYRAMID), true, &options, PYRAMID_LOG, 0);
#else
    assert_int_equal(load_any(aset_load_ply, source_of(text, strlen(text), 1), true, options), ASET_ERR_UNSUPPORTED);
#endif
}

static void test_ply__bad_parts_are_counted_and_left_out(void **state) {
    (void)state;
    static const char text[] =
        TEXT "element vertex 5\n" XYZ "element face 8\n" LIST "end_header\n0 0 0\n1 0 0\n0 1 0\nnan 0 0\n0 1e300 -inf\n"
             "3 0 1 2\n3 0 1 3\n4 0 1 2 4\n2 0 1\n0\n1 4\n3 1 1 1\n4 3 0 1 2\n";
    expect_log(aset_load_ply, text, strlen(text), true, NULL, GREY ONE_LOG ONE_LOG "t 1 0 0, 1 0 0, 1 0 0,; ",
               1 + 1 + 1 + 1 + 1 + 2);
}

static void test_ply__other_elements(void **state) {
    (void)state;
    expect_text(aset_load_ply,
                TEXT "element empty 4000000000\nelement vertex 3\n" XYZ "element face 1\n" LIST
                     "element edge 2\nproperty int vertex1\nproperty int vertex2\nproperty list uint float w\nend_header\n"
                     "0 0 0 1 0 0\n\n0 1 0 3 0 1 2\n0 1 0\n1 2 2 .5\n.5\n",
                GREY ONE_LOG);
    expect_text(aset_load_ply, /* many properties of no use are one */
                TEXT "element vertex 3\nproperty int x\nproperty int y\nproperty int z\n"
#define P "property float f\n"
#define P8 P P P P P P P P
                P8 P8 P8 P8 P8 P8 P8 P8 "element face 1\n" LIST "end_header\n"
#define N8 " 1 2 3 4 5 6 7 8"
                     "0 0 0" N8 N8 N8 N8 N8 N8 N8 N8 "\n1 0 0" N8 N8 N8 N8 N8 N8 N8 N8 "\n0 1 0" N8 N8 N8 N8 N8 N8 N8 N8 "\n"
                     "3 0 1 2\n",
                GREY ONE_LOG);
}

static void test_ply__errors(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"@", 1, ASET_ERR_SYNTAX, "", "ends within its header"},
        {"@plx\n", 1, ASET_ERR_SYNTAX, "plx", "not a PLY file"},
        {"ply\n@element vertex 3\n", 2, ASET_ERR_SYNTAX, "element", "another word than the format's"},
        {"ply\nformat @utf8 1.0\n", 2, ASET_ERR_SYNTAX, "utf8", "an unknown format"},
        {"ply\nformat ascii @2.0\n", 2, ASET_ERR_SYNTAX, "2.0", "an unknown version"},
        {TEXT "@elephant 1\n", 3, ASET_ERR_SYNTAX, "elephant", "not a line of a header"},
        {TEXT "@property int x\n", 3, ASET_ERR_SYNTAX, "property", "a property before any element"},
        {TEXT "element vertex @-1\n", 3, ASET_ERR_SYNTAX, "-1", "not a whole number"},
        {TEXT "element vertex @4294967296\n", 3, ASET_ERR_SYNTAX, "4294967296", "a number too large"},
        {TEXT "element vertex 1\nelement @vertex 1\n", 4, ASET_ERR_SYNTAX, "vertex", "already has"},
        {TEXT "element vertex 1\nproperty @real x\n", 4, ASET_ERR_SYNTAX, "real", "an unknown type"},
        {TEXT "element vertex 1\nproperty list @float int x\n", 4, ASET_ERR_SYNTAX, "float", "count is not whole"},
        {TEXT "element face 1\nproperty list char @float vertex_index\n", 4, ASET_ERR_SYNTAX, "float", "not whole"},
        {TEXT "element vertex 3\n" XYZ "element @tristrips 1\n" LIST "end_header\n", 7, ASET_ERR_UNSUPPORTED, "tristrips",
         "strips"},
        {TEXT "element @face 1\n" LIST "element vertex 3\n" XYZ "end_header\n", 3, ASET_ERR_UNSUPPORTED, "face",
         "before the vertices"},
        {TEXT "element vertex 3\n" XYZ "element @face 1\nproperty list uchar int corners\nend_header\n", 7, ASET_ERR_SYNTAX,
         "face", "without a list"},
        {TEXT "element @vertex 3\nproperty int x\nproperty int y\nelement face 1\n" LIST "end_header\n", 3, ASET_ERR_SYNTAX,
         "vertex", "without x, y and z"},
        {TEXT "element vertex 3\n" XYZ "end_header\n@0 0 0 1 0 0 0 1 0\n", 8, ASET_ERR_SYNTAX, "", "no facet in it"},
        {TEXT "element vertex 3\n" XYZ "element face 0\n" LIST "end_header\n@0 0 0 1 0 0 0 1 0\n", 10, ASET_ERR_SYNTAX, "",
         "no facet in it"},
        {ONE("", "") "0 0 0 1 0 0 0 @x 0\n3 0 1 2\n", 10, ASET_ERR_SYNTAX, "x", "not a decimal number"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n3 0 1 @3\n", 11, ASET_ERR_SYNTAX, "3", "a vertex that is not there"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n3 0 1 @-1\n", 11, ASET_ERR_SYNTAX, "-1", "a vertex that is not there"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n3 0 1 @1.5\n", 11, ASET_ERR_SYNTAX, "1.5", "not a whole number"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n@-3 0 1 2\n", 11, ASET_ERR_SYNTAX, "-3", "negative length"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n3 0 1 2\n@3 0 1 2\n", 12, ASET_ERR_SYNTAX, "3", "more in the file"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n2 0 1 @", 11, ASET_ERR_SYNTAX, "", "no facet in it that can be drawn"},
    };
    expect_all_bad(aset_load_ply, false, bad, COUNT_OF(bad));
    static const bad_case cut[] = {
        {ONE("", "") "0 0 0 1 0 0 0 1@", 10, ASET_ERR_SYNTAX, "2 of 3", "ends before the last vertex"},
        {ONE("", "") "0 0 0 1 0 0 0 1 0\n4000000000 0 1 2\n@", 12, ASET_ERR_SYNTAX, "0 of 1", "ends before the last face"},
        {TEXT "element vertex 3\n" XYZ "element face 4294967295\n" LIST "end_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n@", 11,
         ASET_ERR_SYNTAX, "1 of 4294967295", "ends before the last face"},
    };
    expect_all_bad(aset_load_ply, false, cut, COUNT_OF(cut));
    static const bad_case sized[] = {
        {TEXT "element vertex 3\n" XYZ "element face 4294967295\n" LIST "@end_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n", 9,
         ASET_ERR_SYNTAX, "end_header", "announces more than the file holds"},
    };
    expect_all_bad(aset_load_ply, true, sized, COUNT_OF(sized));
}

static void test_ply__errors_of_binary(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) {
        bytes_buffer file = pyramid(i == 1);
        const bad_case index = {NULL, 0, ASET_ERR_SYNTAX, "5 of 6", "a vertex that is not there"};
        const bad_case more = {NULL, 0, ASET_ERR_SYNTAX, "", "more in the file"};
        const bad_case ends = {NULL, 0, ASET_ERR_SYNTAX, "5 of 6", "ends before the last face"};
        const size_t size = file.size;
        expect_bad_bytes(aset_load_ply, file.bytes, size - 1, false, size - 1, &ends);
        file.bytes[size - (i == 1 ? 1 : 4)] = 5;
        expect_bad_bytes(aset_load_ply, file.bytes, size, true, size, &index);
        file.bytes[size - (i == 1 ? 4 : 1)] = -1;
        expect_bad_bytes(aset_load_ply, file.bytes, size, true, size, &index);
        file = pyramid(i == 1);
        add_text(&file, "  \n\r");
        add_number(&file, 0, 4);
        expect_log(aset_load_ply, file.bytes, file.size, true, NULL, PYRAMID_LOG, 0);
        add_text(&file, "x");
        expect_bad_bytes(aset_load_ply, file.bytes, file.size, true, file.size - 1, &more);
    }
}

static void test_ply__limits(void **state) {
    (void)state;
    char text[8000];
    size_t n = (size_t)snprintf(text, sizeof text, TEXT);
    for (int i = 0; i < 17; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "element e%d 0\n", i);
    }
    const bad_case elements = {NULL, 19, ASET_ERR_LIMIT, "element", "more kinds of elements"};
    expect_bad_bytes(aset_load_ply, text, n, true, n - strlen("element e16 0\n"), &elements);
    n = (size_t)snprintf(text, sizeof text, TEXT "element vertex 3\n");
    for (int i = 0; i < 49; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "property list char int l\n");
    }
    const bad_case properties = {NULL, 52, ASET_ERR_LIMIT, "l", "more properties"};
    expect_bad_bytes(aset_load_ply, text, n, true, n - 2, &properties);
    for (int points = 64; points <= 65; points++) { /* of a face with a colour */
        n = (size_t)snprintf(text, sizeof text,
                             ONE("", "property uchar r\nproperty uchar g\nproperty uchar b\n") "0 0 0 1 0 0 0 1 0\n");
        const size_t at = n;
        n += (size_t)snprintf(text + n, sizeof text - n, "%d", points);
        for (int i = 0; i < points; i++) {
            n += (size_t)snprintf(text + n, sizeof text - n, " %d", i % 3);
        }
        n += (size_t)snprintf(text + n, sizeof text - n, " 255 255 255\n");
        const bad_case face = {NULL, 14, ASET_ERR_LIMIT, "65", "more points than can be kept"};
        aset_vertex_store store;
        if (points == 64) {
            assert_int_equal(load_any(aset_load_ply, source_of(text, n, 5), true, options_with(&store)), ASET_OK);
        } else {
            expect_bad_bytes(aset_load_ply, text, n, true, at, &face);
        }
    }
}

static void test_ply__memory_for_vertices(void **state) {
    (void)state;
    const char *text = TEXT_PYRAMID;
    for (size_t fits = 0; fits < 6; fits++) {
        aset_vertex_store store;
        aset_load_options options = options_with(&store);
        aset_load_report report;
        recorder to = recorder_start(true);
        const aset_sink sink = recorder_sink(&to);
        source from = source_of(text, strlen(text), SIZE_MAX);
        store.size = ASET_BYTES_VERTICES(fits, false, false);
        const aset_status status = aset_load_ply(&sink, give, &from, &options, &report);
        assert_int_equal(status, fits == 5 ? ASET_OK : ASET_ERR_NOMEM);
        if (fits < 5) {
            char token[32];
            snprintf(token, sizeof token, "%lu vertices", (unsigned long)fits);
            assert_string_equal(report.token, token);
            assert_non_null(strstr(report.what, "memory for vertices"));
            assert_int_equal(report.vertices, 0); /* known from the header */
        }
    }
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of(text, strlen(text), SIZE_MAX);
    assert_int_equal(aset_load_ply(&sink, give, &from, NULL, &report), ASET_ERR_NOMEM);
}

/* A grid of 40 x 40 points with colours: through the smallest window it is the same as in memory. */
static void test_ply__spilling_changes_nothing(void **state) {
    (void)state;
    static char text[200000];
    static unsigned char block[100000];
    size_t n =
        (size_t)snprintf(text, sizeof text,
                         TEXT "element vertex 1600\n" XYZ "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                              "element face 1521\n" LIST "end_header\n");
    for (int i = 0; i < 1600; i++) {
        n += (size_t)snprintf(text + n, sizeof text - n, "%d %d %d %d %d %d\n", i % 40, i / 40, i * 7 % 11, i % 256, 9, 7);
    }
    for (int i = 0; i < 1521; i++) {
        const int k = i * 734 % 1521, at = k / 39 * 40 + k % 39; /* in no order */
        n += (size_t)snprintf(text + n, sizeof text - n, "4 %d %d %d %d\n", at, at + 1, at + 41, at + 40);
    }
    uint64_t hash = 0;
    for (size_t size = sizeof block; size >= ASET_BYTES_WINDOW; size = size > 9000 ? size / 3 : size - 1021) {
        for (unsigned shift = 0; shift < 4; shift++) {
            spill_file file;
            aset_vertex_store store;
            aset_load_options options = options_with(&store);
            aset_load_report report;
            recorder to = recorder_start(true);
            const aset_sink sink = recorder_sink(&to);
            source from = source_of(text, n, SIZE_MAX);
            memset(&file, 0, sizeof file);
            store.block = block + shift;
            store.size = size - (size > ASET_BYTES_WINDOW + 4 ? shift : 0);
            store.write = spill_write;
            store.read = spill_read;
            store.context = &file;
            assert_int_equal(aset_load_ply(&sink, give, &from, &options, &report), ASET_OK);
            hash = hash == 0 ? to.hash : hash;
            assert_int_equal(to.hash, hash);
            assert_int_equal(to.triangles, 3042);
            assert_int_equal(file.size != 0, store.size < ASET_BYTES_VERTICES(1600, false, true));
            const unsigned calls = file.calls;
            for (unsigned call = 1; call <= calls; call += calls / 7 + 1) { /* and when the file fails */
                spill_free(&file);
                memset(&file, 0, sizeof file);
                file.fail_call = call;
                from = source_of(text, n, SIZE_MAX);
                assert_int_equal(aset_load_ply(&sink, give, &from, &options, &report), ASET_ERR_READ);
                assert_non_null(strstr(report.what, "spill file"));
            }
            spill_free(&file);
        }
    }
}

static void test_ply__survives(void **state) {
    (void)state;
    const char *coloured =
        ONE("property uchar red\nproperty uchar green\nproperty uchar blue\n",
            "property char r\nproperty char g\nproperty char b\n") "0 0 0 1 2 3 1 0 0 4 5 6\n0 1 0 7 8 9\n3 0 1 2 1 2 3";
    for (int i = 0; i < 2; i++) {
        const bytes_buffer file = pyramid(i == 1);
        expect_cuts(aset_load_ply, file.bytes, file.size, false);
        expect_failures(aset_load_ply, file.bytes, file.size);
        expect_survival(aset_load_ply, file.bytes, file.size);
        expect_sink_errors(aset_load_ply, file.bytes, file.size, 31);
    }
    expect_cuts(aset_load_ply, TEXT_PYRAMID, strlen(TEXT_PYRAMID) - 2, false);
    expect_failures(aset_load_ply, TEXT_PYRAMID, strlen(TEXT_PYRAMID));
    expect_survival(aset_load_ply, TEXT_PYRAMID, strlen(TEXT_PYRAMID));
    expect_sink_errors(aset_load_ply, TEXT_PYRAMID, strlen(TEXT_PYRAMID), 31);
    expect_cuts(aset_load_ply, coloured, strlen(coloured), false);
    expect_survival(aset_load_ply, coloured, strlen(coloured));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ply__pyramid_in_all_forms),
        cmocka_unit_test(test_ply__every_type_anywhere),
        cmocka_unit_test(test_ply__line_ends_before_binary_data),
        cmocka_unit_test(test_ply__colours),
        cmocka_unit_test(test_ply__a_colour_before_or_behind_the_list),
        cmocka_unit_test(test_ply__normals_if_wanted),
        cmocka_unit_test(test_ply__bad_parts_are_counted_and_left_out),
        cmocka_unit_test(test_ply__other_elements),
        cmocka_unit_test(test_ply__errors),
        cmocka_unit_test(test_ply__errors_of_binary),
        cmocka_unit_test(test_ply__limits),
        cmocka_unit_test(test_ply__memory_for_vertices),
        cmocka_unit_test(test_ply__spilling_changes_nothing),
        cmocka_unit_test(test_ply__survives),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

static void test_ply__switched_off(void **state) {
    (void)state;
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of("", 0, 1);
    assert_int_equal(aset_load_ply(&sink, give, &from, NULL, &report), ASET_ERR_UNSUPPORTED);
    assert_non_null(report.what);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ply__switched_off)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
