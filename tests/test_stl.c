/* test_stl.c - the reader of stereolithography files, binary and text. */
#include "model_tests.h"

#if ASET_WITH_POLYGONS

static bytes_buffer pyramid(const char *header) {
    bytes_buffer to;
    memset(&to, 0, sizeof to);
    add_text(&to, header);
    memset(to.bytes + to.size, ' ', 80 - to.size);
    to.size = 80;
    add_number(&to, 6, 4);
    for (int t = 0; t < 6; t++) {
        for (int i = 0; i < 12; i++) {
            add_float(&to, i < 3 ? 0 : pyramid_points[pyramid_triangles[t][i / 3 - 1]][i % 3]);
        }
        add_number(&to, 0xffff, 2); /* attributes mean nothing */
    }
    return to;
}

#define FACET(a, b, c) "facet normal 0 0 0 outer loop vertex " a " vertex " b " vertex " c " endloop endfacet\n"
#define TEXT_PYRAMID                                                                                                        \
    "solid pyramid\n" FACET("0 0 0", "0 2 0", "2 2 0") FACET("0 0 0", "2 2 0", "2 0 0") FACET("0 0 0", "2 0 0", "1 1 1.5")  \
        FACET("2 0 0", "2 2 0", "1 1 1.5") FACET("2 2 0", "0 2 0", "1 1 1.5")                                               \
            FACET("0 2 0", "0 0 0", "1 1 1.5") "endsolid pyramid\n"
#define ONE FACET("0 0 0", "1 0 0", "0 1 0")
#define ONE_LOG "t 0 0 0, 1 0 0, 0 1 0,; "

static void test_stl__binary_whatever_its_first_word(void **state) {
    (void)state;
    static const char *const headers[] = {"", "solid", "solid facet normal", "binary", "  SOLID x"};
    for (size_t i = 0; i < COUNT_OF(headers); i++) {
        const bytes_buffer file = pyramid(headers[i]);
        expect_log(aset_load_stl, file.bytes, file.size, true, NULL, PYRAMID_LOG, 0);
        expect_log(aset_load_stl, file.bytes, file.size, false, NULL, PYRAMID_LOG, 0);
    }
}

static void test_stl__text(void **state) {
    (void)state;
    expect_text(aset_load_stl, TEXT_PYRAMID, PYRAMID_LOG);
    expect_log(aset_load_stl, TEXT_PYRAMID, strlen(TEXT_PYRAMID), false, NULL, PYRAMID_LOG, 0);
}

static void test_stl__text_in_other_spellings(void **state) {
    (void)state;
    expect_text(aset_load_stl, "solid\n" ONE "endsolid", GREY ONE_LOG);
    expect_text(aset_load_stl, " \n solid a # b\r\n" ONE "endsolid a # b\r\nsolid c\r" ONE "EndSolid\r",
                GREY ONE_LOG ONE_LOG);
    expect_text(aset_load_stl,
                "SOLID X\nFACET NORMAL nan -nan(ind) 1.#QNAN\nOUTER\nLOOP\nVERTEX 0 0 0\nVertex 1 0 0\nvertex 0 1 0\n"
                "ENDLOOP\nENDFACET\nENDSOLID\n",
                GREY ONE_LOG);
    expect_text(aset_load_stl, "solid\nfacet outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet endsolid",
                GREY ONE_LOG);
    expect_text(aset_load_stl, "\xef\xbb\xbf" "solid\n" ONE "endsolid", GREY ONE_LOG); /* UTF-8's mark */
}

static void test_stl__polygons_are_fanned_and_short_ones_counted(void **state) {
    (void)state;
    const char *text =
        "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 1 1 0 vertex 0 1 0 vertex 0 .5 0\n"
        "endloop endfacet facet normal 0 0 1 outer loop vertex 1 1 1 vertex 1 1 2 endloop endfacet\n"
        "facet normal 0 0 1 outer loop endloop endfacet endsolid\n";
    expect_log(aset_load_stl, text, strlen(text), true, NULL,
               GREY "t 0 0 0, 1 0 0, 1 1 0,; t 0 0 0, 1 1 0, 0 1 0,; t 0 0 0, 0 1 0, 0 0.5 0,; ", 2);
}

static void test_stl__bad_coordinates_are_counted_and_left_out(void **state) {
    (void)state;
    static const char text[] = "solid\n" FACET("0 0 nan", "1 0 0", "0 1 0") FACET("0 0 0", "inf 0 0", "0 1 0")
        FACET("0 0 0", "1 0 0", "0 -1e400 0") FACET("0 0 0", "1e200 0 0", "0 1 0") FACET("1.#INF 0 0", "1 0 0", "0 1 0")
            ONE FACET("1 1 1", "1 1 1", "1 1 1") ONE "endsolid";
    expect_log(aset_load_stl, text, strlen(text), true, NULL, GREY ONE_LOG "t 1 1 1, 1 1 1, 1 1 1,; " ONE_LOG, 5);
    static const uint32_t bad[] = {0x7f800000, 0xff800000, 0x7fc00000, 0xffc00001, 0x7f800001, 0x7f7fffff, 0x58800000};
    bytes_buffer file = pyramid("");
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
#if ASET_REAL_BITS == 64
        if (i >= 5) {
            break; /* a large float is no large double */
        }
#endif
        for (size_t k = 0; k < 9; k++) {
            bytes_buffer copy = file;
            copy.size = 84 + 12 + 4 * k;
            add_number(&copy, bad[i], 4);
            copy.size = file.size;
            expect_log(aset_load_stl, copy.bytes, copy.size, true, NULL,
                       GREY "" /* without the first */
                            "t 0 0 0, 2 2 0, 2 0 0,; t 0 0 0, 2 0 0, 1 1 1.5,; t 2 0 0, 2 2 0, 1 1 1.5,; "
                            "t 2 2 0, 0 2 0, 1 1 1.5,; t 0 2 0, 0 0 0, 1 1 1.5,; ",
                       1);
        }
    }
}

static void test_stl__triangles_that_the_sink_refuses_are_counted(void **state) {
    (void)state;
    const bytes_buffer file = pyramid("");
    for (unsigned call = 1; call <= 31; call++) { /* the material and five calls for each triangle */
        aset_load_report report;
        recorder to = recorder_start(true);
        const aset_sink sink = recorder_sink(&to);
        source from = source_of(file.bytes, file.size, SIZE_MAX);
        to.fail_call = call;
        to.failure = ASET_ERR_GEOMETRY;
        const aset_status status = aset_load_stl(&sink, give, &from, NULL, &report);
        assert_int_equal(status, call == 1 ? ASET_ERR_GEOMETRY : ASET_OK);
        assert_int_equal(report.skipped, call == 1 ? 0 : 1);
        assert_int_equal(report.triangles, call == 1 ? 0 : 5);
    }
}

static void test_stl__the_default_material_is_a_choice(void **state) {
    (void)state;
    aset_material material;
    aset_load_options options;
    memset(&material, 0, sizeof material);
    memset(&options, 0, sizeof options);
    material.fill.g = (aset_real)0.5;
    material.diffuse = (aset_real)0.75;
    material.specular = (aset_real)0.25;
    material.shine = 8;
    material.one_sided = true;
    options.material = &material;
    expect_log(aset_load_stl, "solid\n" ONE "endsolid", strlen("solid\n" ONE "endsolid"), true, &options,
               "m 0 0.5 0, 0.75 0.25 8 0 0 one; " ONE_LOG, 0);
}

static void test_stl__errors_of_text(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"solid\n@", 2, ASET_ERR_SYNTAX, "", "ends within a solid"},
        {"solid\nendsolid\n@", 3, ASET_ERR_SYNTAX, "", "no facet in it"},
        {"solid\n@vertex 1 2 3", 2, ASET_ERR_SYNTAX, "vertex", "not a part of a solid"},
        {"solid\nfacet normal 0 0 0 @0 0 0", 2, ASET_ERR_SYNTAX, "0", "without a loop"},
        {"solid\nfacet normal 0 0 0 outer @lop", 2, ASET_ERR_SYNTAX, "lop", "another word"},
        {"solid\nfacet normal 0 0 0 outer loop\n@1 2 3", 3, ASET_ERR_SYNTAX, "1", "neither"},
        {"solid\nfacet normal 0 0 0 outer loop\nvertex 1 @x 3", 3, ASET_ERR_SYNTAX, "x", "not a decimal number"},
        {"solid\nfacet normal 0 0 0 outer loop\nvertex 1 2@", 3, ASET_ERR_SYNTAX, "", "ends within a solid"},
        {"solid\nfacet normal 0 0 0 outer loop vertex 1 1 1 endloop\n@facet", 3, ASET_ERR_SYNTAX, "facet", "another word"},
        {"solid\n" ONE "endsolid\n@more", 4, ASET_ERR_SYNTAX, "more", "not the beginning"},
        {"solid\nfacet normal nan nan nan outer loop vertex nan 0 0 vertex 0 0 0 vertex 1 0 0 endloop endfacet endsolid@", 2,
         ASET_ERR_SYNTAX, "", "no facet in it that can be drawn"},
    };
    expect_all_bad(aset_load_stl, true, bad, COUNT_OF(bad));
    expect_all_bad(aset_load_stl, false, bad, COUNT_OF(bad));
}

static void test_stl__errors_of_binary(void **state) {
    (void)state;
    bytes_buffer file = pyramid("solid");
    const bad_case lies = {NULL, 0, ASET_ERR_SYNTAX, "384 of 434", "of another size"};
    const bad_case huge = {NULL, 0, ASET_ERR_SYNTAX, "384 of 214748364834", "of another size"};
    const bad_case ends = {NULL, 0, ASET_ERR_SYNTAX, "6 of 7", "ends before the last triangle"};
    const bad_case ends_4g = {NULL, 0, ASET_ERR_SYNTAX, "6 of 4294967295", "ends before the last triangle"};
    const bad_case behind = {NULL, 0, ASET_ERR_SYNTAX, "5 of 5", "bytes behind the last triangle"};
    const bad_case none = {NULL, 0, ASET_ERR_SYNTAX, "", "no facet in it"};
    const bad_case header = {NULL, 0, ASET_ERR_SYNTAX, "83 of 84", "neither text nor a whole binary header"};
    file.bytes[80] = 7;
    expect_bad_bytes(aset_load_stl, file.bytes, file.size, true, 80, &lies);
    expect_bad_bytes(aset_load_stl, file.bytes, file.size, false, 384, &ends);
    memset(file.bytes + 80, 0xff, 4);
    expect_bad_bytes(aset_load_stl, file.bytes, file.size, true, 80, &huge);
    expect_bad_bytes(aset_load_stl, file.bytes, file.size, false, 384, &ends_4g);
    memset(file.bytes + 80, 0, 4);
    file.bytes[80] = 5;
    expect_bad_bytes(aset_load_stl, file.bytes, file.size, false, 84 + 5 * 50, &behind);
    file.bytes[80] = 0;
    expect_bad_bytes(aset_load_stl, file.bytes, 84, true, 84, &none);
    expect_bad_bytes(aset_load_stl, file.bytes, 84, false, 84, &none);
    file = pyramid("x");
    expect_bad_bytes(aset_load_stl, file.bytes, 83, false, 83, &header);
    expect_bad_bytes(aset_load_stl, file.bytes, 83, true, 83, &header);
}

static void test_stl__empty_input(void **state) {
    (void)state;
    const bad_case bad = {"@", 1, ASET_ERR_SYNTAX, "", "no facet in it"};
    expect_all_bad(aset_load_stl, false, &bad, 1);
}

static void test_stl__survives(void **state) {
    (void)state;
    const bytes_buffer file = pyramid("solid");
    expect_cuts(aset_load_stl, file.bytes, file.size, false);
    expect_failures(aset_load_stl, file.bytes, file.size);
    expect_survival(aset_load_stl, file.bytes, file.size);
    expect_sink_errors(aset_load_stl, file.bytes, file.size, 31);
    expect_cuts(aset_load_stl, TEXT_PYRAMID, strlen(TEXT_PYRAMID) - strlen(" pyramid\n"), false);
    expect_failures(aset_load_stl, TEXT_PYRAMID, strlen(TEXT_PYRAMID));
    expect_survival(aset_load_stl, TEXT_PYRAMID, strlen(TEXT_PYRAMID));
    expect_sink_errors(aset_load_stl, TEXT_PYRAMID, strlen(TEXT_PYRAMID), 31);
}

static void test_stl__arguments(void **state) {
    (void)state;
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of("", 0, 1);
    assert_int_equal(aset_load_stl(NULL, give, &from, NULL, &report), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_load_stl(&sink, NULL, &from, NULL, &report), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_load_stl(&sink, give, &from, NULL, NULL), ASET_ERR_ARGUMENT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stl__binary_whatever_its_first_word),
        cmocka_unit_test(test_stl__text),
        cmocka_unit_test(test_stl__text_in_other_spellings),
        cmocka_unit_test(test_stl__polygons_are_fanned_and_short_ones_counted),
        cmocka_unit_test(test_stl__bad_coordinates_are_counted_and_left_out),
        cmocka_unit_test(test_stl__triangles_that_the_sink_refuses_are_counted),
        cmocka_unit_test(test_stl__the_default_material_is_a_choice),
        cmocka_unit_test(test_stl__errors_of_text),
        cmocka_unit_test(test_stl__errors_of_binary),
        cmocka_unit_test(test_stl__empty_input),
        cmocka_unit_test(test_stl__survives),
        cmocka_unit_test(test_stl__arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

static void test_stl__switched_off(void **state) {
    (void)state;
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    source from = source_of("", 0, 1);
    assert_int_equal(aset_load_stl(&sink, give, &from, NULL, &report), ASET_ERR_UNSUPPORTED);
    assert_non_null(report.what);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_stl__switched_off)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
