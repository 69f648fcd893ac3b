/*
 * test_nff.c - the NFF reader and the tokens and numbers under it, with a sink of our own that writes down what it is told.
 *
 * In inputs that must fail, '@' stands before the byte that the report has to name; the mark is not part of the input. Every
 * input is read in pieces of 1, 2, 7 and all bytes.
 */
#include "support/support.h"

#include <float.h>
#include <math.h>

#include "aset/load.h"

#include "../lib/load/reader.h"

#define ALL_KINDS (ASET_WITH_POLYGONS && ASET_WITH_PATCHES && ASET_WITH_SPHERES && ASET_WITH_CONES)

#if ASET_REAL_BITS == 32
#define EXACT "%.9g" /* enough digits to come back as the same number */
#define REFERENCE(text) strtof(text, NULL)
#else
#define EXACT "%.17g"
#define REFERENCE(text) strtod(text, NULL)
#endif

/* The seven lines and one that nearly every input needs. */
#define VIEW "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 64 48\n"
#define VIEW_LOG "view 0 0 5 at 0 0 0 up 0 1 0 angle 45 height 0 size 64 48; "
#define FILL "f 1 0.5 0 0.75 0.25 3 0 0\n"
#define FILL_LOG "fill 1 0.5 0 0.75 0.25 3 0 0 two; "

/* ---- a sink that writes down ---- */

typedef struct recorder {
    char *text;
    size_t length, capacity;
    const char *number;        /* how a number is printed, a space before it */
    unsigned calls, fail_call; /* calls so far, counted from 1; the one that fails, 0: none */
    aset_status failure;
    bool as_nff;               /* writes NFF instead of the log */
} recorder;

static void put(recorder *to, const char *text) {
    to->text = text_append(to->text, &to->length, &to->capacity, text);
}

static void put_numbers(recorder *to, unsigned n, ...) {
    va_list list;
    va_start(list, n);
    for (unsigned i = 0; i < n; i++) {
        char text[64];
        snprintf(text, sizeof text, to->number, va_arg(list, double));
        put(to, text);
    }
    va_end(list);
}

static void put_vec3(recorder *to, const aset_vec3 *v) {
    put_numbers(to, 3, (double)v->x, (double)v->y, (double)v->z);
}

static void put_colour(recorder *to, const aset_colour *c) {
    put_numbers(to, 3, (double)c->r, (double)c->g, (double)c->b);
}

static aset_status recorded(recorder *to) {
    put(to, to->as_nff ? "\n" : "; ");
    return ++to->calls == to->fail_call ? to->failure : ASET_OK;
}

static aset_status record_background(void *context, const aset_colour *colour) {
    recorder *to = context;
    put(to, to->as_nff ? "b" : "back");
    put_colour(to, colour);
    return recorded(to);
}

static aset_status record_view(void *context, const aset_view *view) {
    recorder *to = context;
    put(to, to->as_nff ? "v\nfrom" : "view");
    put_vec3(to, &view->from);
    put(to, to->as_nff ? "\nat" : " at");
    put_vec3(to, &view->at);
    put(to, to->as_nff ? "\nup" : " up");
    put_vec3(to, &view->up);
    put(to, to->as_nff ? "\nangle" : " angle");
    put_numbers(to, 1, (double)view->angle_deg);
    if (to->as_nff) {
        assert_true(view->height == 0);
        put(to, "\nhither 0\nresolution");
    } else {
        put(to, " height");
        put_numbers(to, 1, (double)view->height);
        put(to, " size");
    }
    put_numbers(to, 2, (double)view->width_px, (double)view->height_px);
    return recorded(to);
}

static aset_status record_light(void *context, const aset_light *light) {
    recorder *to = context;
    assert_false(light->directional);
    put(to, to->as_nff ? "l" : "light");
    put_vec3(to, &light->position);
    if (light->has_colour) {
        put(to, to->as_nff ? "" : " colour");
        put_colour(to, &light->colour);
    }
    return recorded(to);
}

static aset_status record_material(void *context, const aset_material *material) {
    recorder *to = context;
    put(to, to->as_nff ? "f" : "fill");
    put_colour(to, &material->fill);
    put_numbers(to, 3, (double)material->diffuse, (double)material->specular, (double)material->shine);
#if ASET_WITH_REFRACTION
    put_numbers(to, 2, (double)material->transmittance, (double)material->refraction_index);
#else
    put_numbers(to, 2, 0.0, 0.0);
#endif
    if (!to->as_nff) {
        put(to, material->one_sided ? " one" : " two");
    }
    return recorded(to);
}

#if ASET_WITH_POLYGONS
static aset_status record_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    recorder *to = context;
    char text[32];
    snprintf(text, sizeof text, to->as_nff ? "%s %lu" : "%s%lu", with_normals ? "pp" : "p", (unsigned long)n_points);
    put(to, text);
    return recorded(to);
}

static aset_status record_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    recorder *to = context;
    put_vec3(to, point);
    if (normal != NULL) {
        put(to, to->as_nff ? "" : " normal");
        put_vec3(to, normal);
    }
    return recorded(to);
}

static aset_status record_polygon_end(void *context) {
    recorder *to = context;
    put(to, to->as_nff ? "" : "end");
    return recorded(to);
}
#endif

#if ASET_WITH_SPHERES
static aset_status record_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    recorder *to = context;
    put(to, to->as_nff ? "s" : "sphere");
    put_vec3(to, centre);
    put_numbers(to, 1, (double)radius);
    return recorded(to);
}
#endif

#if ASET_WITH_CONES
static aset_status record_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                               aset_real apex_radius) {
    recorder *to = context;
    put(to, to->as_nff ? "c" : "cone");
    put_vec3(to, base);
    put_numbers(to, 1, (double)base_radius);
    put_vec3(to, apex);
    put_numbers(to, 1, (double)apex_radius);
    return recorded(to);
}
#endif

static void recorder_init(recorder *to, const char *number, bool as_nff) {
    memset(to, 0, sizeof *to);
    to->number = number;
    to->as_nff = as_nff;
    put(to, "");
}

static aset_sink recorder_sink(recorder *to) {
    aset_sink sink;
    memset(&sink, 0, sizeof sink);
    sink.context = to;
    sink.background = record_background;
    sink.view = record_view;
    sink.light = record_light;
    sink.material = record_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = record_polygon_begin;
    sink.polygon_point = record_polygon_point;
    sink.polygon_end = record_polygon_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = record_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = record_cone;
#endif
    return sink;
}

/* ---- what most cases do ---- */

static aset_status load(byte_source from, recorder *to, aset_load_report *report) {
    const aset_sink sink = recorder_sink(to);
    memset(report, 0xa5, sizeof *report);
    return aset_load_nff(&sink, give, &from, NULL, report);
}

static void expect_log_bytes(const char *bytes, size_t size, const char *log) {
    for (size_t i = 0; i < COUNT_OF(chunks); i++) {
        recorder to;
        aset_load_report report;
        recorder_init(&to, " %.6g", false);
        const aset_status status = load(source_of(bytes, size, chunks[i]), &to, &report);
        if (status != ASET_OK) {
            print_error("line %lu: %s: '%s'\n", (unsigned long)report.line, report.what, report.token);
        }
        assert_int_equal(status, ASET_OK);
        assert_null(report.what);
        assert_null(report.expected);
        assert_string_equal(report.token, "");
        assert_string_equal(to.text, log);
        free(to.text);
    }
}

static void expect_log(const char *text, const char *log) {
    expect_log_bytes(text, strlen(text), log);
}

static void expect_bad_bytes(const char *bytes, size_t size, size_t offset, const bad_case *bad) {
    for (size_t i = 0; i < COUNT_OF(chunks); i++) {
        recorder to;
        aset_load_report report;
        recorder_init(&to, " %.6g", false);
        const aset_status status = load(source_of(bytes, size, chunks[i]), &to, &report);
        if (status != bad->status || report.what == NULL || strstr(report.what, bad->what) == NULL) {
            print_error("for: %s\n", bad->text);
        }
        assert_int_equal(status, bad->status);
        assert_non_null(report.what);
        assert_non_null(strstr(report.what, bad->what));
        assert_string_equal(report.token, bad->token);
        assert_int_equal(report.offset, offset);
        assert_int_equal(report.line, bad->line);
        free(to.text);
    }
}

static void expect_bad(const bad_case *bad) {
    size_t size, offset;
    char *text = bad_input(bad, &size, &offset);
    expect_bad_bytes(text, size, offset, bad);
    free(text);
}

static void expect_all_bad(const bad_case *bad, size_t n) {
    for (size_t i = 0; i < n; i++) {
        expect_bad(&bad[i]);
    }
}

/* ---- good input ---- */

static void test_nff__view_background_lights(void **state) {
    (void)state;
    expect_log("b 0.078 0.361 0.753\n" VIEW "l 4 3 2\nl 1 -4 4\n",
               "back 0.078 0.361 0.753; " VIEW_LOG "light 4 3 2; light 1 -4 4; ");
}

static void test_nff__view_parts_in_any_order_without_hither(void **state) {
    (void)state;
    expect_log("v resolution 64 48 up 0 1 0\nangle 45 at 0 0 0 from 0 0 5", VIEW_LOG);
    expect_log("v resolution 64 48 hither 0 up 0 1 0\nangle 45 at 0 0 0 from 0 0 5 l 1 2 3", VIEW_LOG "light 1 2 3; ");
}

static void test_nff__second_view_is_passed_on(void **state) {
    (void)state;
    expect_log(VIEW VIEW, VIEW_LOG VIEW_LOG);
}

static void test_nff__light_colour_is_what_follows_as_numbers(void **state) {
    (void)state;
    expect_log(VIEW "l 1 2 3 0.5 0.25 1\n", VIEW_LOG "light 1 2 3 colour 0.5 0.25 1; ");
    expect_log(VIEW "l 1 2 3\n  .5 +.25 1e0\nl 4 5 6", VIEW_LOG "light 1 2 3 colour 0.5 0.25 1; light 4 5 6; ");
    expect_log(VIEW "l 1 2 3 # no colour 1 1 1\nb 1 1 1", VIEW_LOG "light 1 2 3; back 1 1 1; ");
}

static void test_nff__values_above_one_pass(void **state) {
    (void)state;
    expect_log("b 2 0 1e3\n" VIEW "f 1.5 2 3 4 5 100000 0 0\n",
               "back 2 0 1000; " VIEW_LOG "fill 1.5 2 3 4 5 100000 0 0 two; ");
}

static void test_nff__line_ends(void **state) {
    (void)state;
    expect_log("b 1 1 1\r\nv\r\nfrom 0 0 5\r\nat 0 0 0\r\nup 0 1 0\r\nangle 45\r\nresolution 64 48\r\n# last\r\n",
               "back 1 1 1; " VIEW_LOG);
    expect_log("b 1 1 1\rv\rfrom 0 0 5\rat 0 0 0\r# comment\rup 0 1 0\rangle 45\rresolution 64 48", "back 1 1 1; " VIEW_LOG);
    expect_log("\n\n \t b\t1 1\t\t1 \n\r\n" VIEW "\n\n", "back 1 1 1; " VIEW_LOG);
}

#if ASET_READER_BUFFER >= 3
static void test_nff__a_mark_of_utf8(void **state) {
    (void)state;
    expect_log("\xef\xbb\xbf" "b 1 1 1\n" VIEW, "back 1 1 1; " VIEW_LOG);
    expect_log("\xef\xbb\xbf# from an editor\n" VIEW, VIEW_LOG);
    static const bad_case bad[] = {
        {"\xef\xbb\xbf@", 1, ASET_ERR_SYNTAX, "", "empty"},
        {"@\xef\xbb", 1, ASET_ERR_SYNTAX, "??", "an unknown entity"},
        {"\xef\xbb\xbf@\xef\xbb\xbf" "b 1 1 1", 1, ASET_ERR_SYNTAX, "???b", "an unknown entity"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
}
#endif

static void test_nff__comments_anywhere(void **state) {
    (void)state;
    expect_log("# first\n#\n##b 9 9 9\nb 1 # the green:\n 1#and blue\n1 # \xc3\xa9\xff end\n" VIEW "# no end of line",
               "back 1 1 1; " VIEW_LOG);
}

static void test_nff__exponents(void **state) {
    (void)state;
    expect_log(VIEW "l 5.14416e-18 -2.22045E-16 1e+3 1.5e1 0e0 1e-400",
               VIEW_LOG "light 5.14416e-18 -2.22045e-16 1000 colour 15 0 0; ");
    expect_log(VIEW "l -0 +1. -.5", VIEW_LOG "light -0 1 -0.5; ");
}

static void test_nff__materials_without_objects(void **state) {
    (void)state;
    expect_log(FILL FILL VIEW FILL, FILL_LOG FILL_LOG VIEW_LOG FILL_LOG);
}

#if ASET_WITH_REFRACTION
static void test_nff__transmitting_material(void **state) {
    (void)state;
    expect_log(VIEW "f 1 1 1 0.1 0.1 101.148 0.9 1.5\n", VIEW_LOG "fill 1 1 1 0.1 0.1 101.148 0.9 1.5 two; ");
}
#endif

static void test_nff__one_sided_opaque(void **state) {
    (void)state;
#if ASET_WITH_REFRACTION
    static const char text[] = VIEW "f 1 1 1 1 0 3 0 0\nf 1 1 1 1 0 3 0.1 0\n";
    static const char log[] = VIEW_LOG "fill 1 1 1 1 0 3 0 0 one; fill 1 1 1 1 0 3 0.1 0 two; ";
#else
    static const char text[] = VIEW "f 1 1 1 1 0 3 0 0\n";
    static const char log[] = VIEW_LOG "fill 1 1 1 1 0 3 0 0 one; ";
#endif
    byte_source from = source_of(text, sizeof text - 1, 1);
    recorder to;
    aset_load_report report;
    recorder_init(&to, " %.6g", false);
    const aset_sink sink = recorder_sink(&to);
    aset_load_options options;
    memset(&options, 0, sizeof options);
    options.one_sided_opaque = true;
    assert_int_equal(aset_load_nff(&sink, give, &from, &options, &report), ASET_OK);
    assert_string_equal(to.text, log);
    free(to.text);
}

#if ASET_WITH_SPHERES
static void test_nff__spheres(void **state) {
    (void)state;
    expect_log(VIEW FILL "s 1 2 3 0.5 s 1 2 3 -0.5", VIEW_LOG FILL_LOG "sphere 1 2 3 0.5; sphere 1 2 3 -0.5; ");
}
#endif

#if ASET_WITH_CONES
static void test_nff__cone_on_one_line_and_on_three(void **state) {
    (void)state;
    static const char log[] = VIEW_LOG FILL_LOG "cone 1 2 3 4 5 6 7 8; cone 0 0 0 -1 0 0 1 -1; ";
    expect_log(VIEW FILL "c 1 2 3 4 5 6 7 8\nc 0 0 0 -1 0 0 1 -1\n", log);
    expect_log(VIEW FILL "c\n1 2 3 4\n5 6 7 8\nc\n0 0 0 -1\n0 0 1 -1\n", log);
}
#endif

#if ASET_WITH_POLYGONS
static void test_nff__polygons(void **state) {
    (void)state;
    static const char log[] = VIEW_LOG FILL_LOG "p3;  0 0 0;  1 0 0;  0 1 0; end; p4;  0 0 0;  1 0 0;  1 1 0;  0 1 0; end; ";
    expect_log(VIEW FILL "p 3\n0 0 0\n1 0 0\n0 1 0\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n", log);
    expect_log(VIEW FILL "p\n3 0 0 0 1 0 0 0 1\n0 p 4 0 0 0 # corner\n1 0 0 1 1 0 0 1 0", log);
}

static void test_nff__polygon_of_many_points(void **state) {
    (void)state;
    char text[8000] = VIEW FILL "p 144\n", log[8000] = VIEW_LOG FILL_LOG "p144; ";
    for (int i = 0; i < 144; i++) {
        snprintf(text + strlen(text), 32, "%d 0 %d\n", i, i * i);
        snprintf(log + strlen(log), 32, " %d 0 %d; ", i, i * i);
    }
    strcat(log, "end; ");
    expect_log(text, log);
}
#endif

#if ASET_WITH_PATCHES
static void test_nff__patches(void **state) {
    (void)state;
    expect_log(VIEW FILL "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 0\n",
               VIEW_LOG FILL_LOG "pp3;  0 0 0 normal 0 0 1;  1 0 0 normal 0 0 1;  0 1 0 normal 0 0 0; end; ");
}
#endif

/* ---- bad input ---- */

static void test_nff__empty(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"@", 1, ASET_ERR_SYNTAX, "", "empty"},
        {"\n\n  @", 3, ASET_ERR_SYNTAX, "", "empty"},
        {"# only\r\n# comments\r\n@", 3, ASET_ERR_SYNTAX, "", "empty"},
        {"# only a comment@", 1, ASET_ERR_SYNTAX, "", "empty"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
}

static void test_nff__no_view(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"b 1 1 1\nl 1 2 3\n@", 3, ASET_ERR_SYNTAX, "", "no view"},
        {FILL "@", 2, ASET_ERR_SYNTAX, "", "no view"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
}

static void test_nff__unknown_words(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {VIEW "@q 1 2 3\n", 8, ASET_ERR_SYNTAX, "q", "an unknown entity"},
        {"b 1 1 1\r\n  @ppp 3", 2, ASET_ERR_SYNTAX, "ppp", "an unknown entity"},
        {"@B 1 1 1", 1, ASET_ERR_SYNTAX, "B", "an unknown entity"},
        {"@bb", 1, ASET_ERR_SYNTAX, "bb", "an unknown entity"},
        {VIEW "b 1 1 1 @1", 8, ASET_ERR_SYNTAX, "1", "a number where"},
        {VIEW "l 1 2 3 1 1 1 @-1", 8, ASET_ERR_SYNTAX, "-1", "a number where"},
        {"b 1 1 1\n@\xef\xbb\xbf v", 2, ASET_ERR_SYNTAX, "???", "an unknown entity"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
    recorder to;
    aset_load_report report;
    recorder_init(&to, " %.6g", false);
    load(source_of("x", 1, 1), &to, &report);
    assert_string_equal(report.expected, "one of v b l f c s p pp");
    free(to.text);
}

static void test_nff__not_numbers(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"b 1 @x 1", 1, ASET_ERR_SYNTAX, "x", "not a decimal number"},
        {"b 1 1 @l 1 2 3", 1, ASET_ERR_SYNTAX, "l", "not a decimal number"},
        {"b 1\n@1,5 1", 2, ASET_ERR_SYNTAX, "1,5", "not a decimal number"},
        {"l 0 0 @0x10", 1, ASET_ERR_SYNTAX, "0x10", "not a decimal number"},
        {"l 0 0 @1e", 1, ASET_ERR_SYNTAX, "1e", "not a decimal number"},
        {"l 0 0 @-", 1, ASET_ERR_SYNTAX, "-", "not a decimal number"},
        {"l 0 0 @nan", 1, ASET_ERR_SYNTAX, "nan", "not a finite number"},
        {"l 0\n0\n@-INF\n", 3, ASET_ERR_SYNTAX, "-INF", "not a finite number"},
        {"l 0 0 @1e999", 1, ASET_ERR_SYNTAX, "1e999", "too large"},
        {"f 1 1 1 1 0 @-1e400 0 0", 1, ASET_ERR_SYNTAX, "-1e400", "too large"},
#if ASET_REAL_BITS == 32
        {"l 0 0 @3.5e38", 1, ASET_ERR_SYNTAX, "3.5e38", "too large"},
#endif
        {VIEW "l 1 2 3 @+x", 8, ASET_ERR_SYNTAX, "+x", "not a decimal number"},
        {VIEW "l 1 2 3 4 @b", 8, ASET_ERR_SYNTAX, "b", "not a decimal number"},
        {"b @a_word_that_the_report_has_to_cut_off", 1, ASET_ERR_SYNTAX, "a_word_that_the_report_has_to_c", "not a decimal"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
}

static void test_nff__negative_amounts(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"b 0 @-0.1 0", 1, ASET_ERR_SYNTAX, "-0.1", "negative"},
        {"l 0 0 0 1 @-1 1", 1, ASET_ERR_SYNTAX, "-1", "negative"},
        {"f @-1 1 1 1 1 1 0 0", 1, ASET_ERR_SYNTAX, "-1", "negative"},
        {"f 1 1 1 @-1 1 1 0 0", 1, ASET_ERR_SYNTAX, "-1", "negative"},
        {"f 1 1 1 1 @-1 1 0 0", 1, ASET_ERR_SYNTAX, "-1", "negative"},
        {"f 1 1 1 1 1 @-1 0 0", 1, ASET_ERR_SYNTAX, "-1", "negative"},
        {"f 1 1 1 1 1 1 @-1 0", 1, ASET_ERR_SYNTAX, "-1", "negative"},
        {"f 1 1 1 1 1 1 0 @-1", 1, ASET_ERR_SYNTAX, "-1", "negative"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
}

static void test_nff__incomplete_views(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"v @l 1 2 3", 1, ASET_ERR_SYNTAX, "l", "not complete"},
        {"v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\n@b 1 1 1", 7, ASET_ERR_SYNTAX, "b", "not complete"},
        {"v\nfrom 0 0 5\n@form 0 0 0", 3, ASET_ERR_SYNTAX, "form", "not complete"},
        {"v\nfrom 0 0 5\nat 0 0 @up 0 1 0", 3, ASET_ERR_SYNTAX, "up", "not a decimal number"},
        {"v\nfrom 0 0 5 @5", 2, ASET_ERR_SYNTAX, "5", "not complete"},
        {"v\nfrom 0 0 5\nat 0 0 0\n@from 0 0 5", 4, ASET_ERR_SYNTAX, "from", "already"},
        {"v hither 1 @hither 1", 1, ASET_ERR_SYNTAX, "hither", "already"},
        {VIEW "@angle 45", 8, ASET_ERR_SYNTAX, "angle", "already"},
        {VIEW "@fov 45", 8, ASET_ERR_SYNTAX, "fov", "an unknown entity"},
        {"v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\n@", 7, ASET_ERR_SYNTAX, "", "ends within a view"},
        {"v\nfrom 0 0@", 2, ASET_ERR_SYNTAX, "", "ends within a view"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
    recorder to;
    aset_load_report report;
    recorder_init(&to, " %.6g", false);
    load(source_of("v from 0 0 5 up 0 1 0 b", 23, 1), &to, &report);
    assert_string_equal(report.expected, "at x y z");
    free(to.text);
}

#define PARTS_BEFORE(angle) "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle " angle "\n"

static void test_nff__angles_and_resolutions(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {PARTS_BEFORE("@0"), 5, ASET_ERR_SYNTAX, "0", "an angle"},
        {PARTS_BEFORE("@-45"), 5, ASET_ERR_SYNTAX, "-45", "an angle"},
        {PARTS_BEFORE("@180"), 5, ASET_ERR_SYNTAX, "180", "an angle"},
        {PARTS_BEFORE("@179.9999999999999999999"), 5, ASET_ERR_SYNTAX, "179.9999999999999999999", "an angle"},
        {PARTS_BEFORE("@1e-400"), 5, ASET_ERR_SYNTAX, "1e-400", "an angle"},
        {PARTS_BEFORE("45") "resolution @0 1", 6, ASET_ERR_SYNTAX, "0", "a resolution outside"},
        {PARTS_BEFORE("45") "resolution 1 @65536", 6, ASET_ERR_SYNTAX, "65536", "a resolution outside"},
        {PARTS_BEFORE("45") "resolution @-1 1", 6, ASET_ERR_SYNTAX, "-1", "not a whole number"},
        {PARTS_BEFORE("45") "resolution @1.5 1", 6, ASET_ERR_SYNTAX, "1.5", "not a whole number"},
        {PARTS_BEFORE("45") "resolution 512\n@b 1 1 1", 7, ASET_ERR_SYNTAX, "b", "not a whole number"},
        {PARTS_BEFORE("45") "resolution @99999999999999999999999 1", 6, ASET_ERR_SYNTAX, "99999999999999999999999",
         "too large"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
    expect_log(PARTS_BEFORE("179.5") "resolution 1 65535",
               "view 0 0 5 at 0 0 0 up 0 1 0 angle 179.5 height 0 size 1 65535; ");
}

#define VIEW_OF(from, at, up) "b 1 1 1\n@v from " from " at " at " up " up " angle 45 resolution 9 9"
#define VIEW_OF_UNMARKED(from, at, up) "v from " from " at " at " up " up " angle 45 resolution 9 9"

static void test_nff__degenerate_views(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {VIEW_OF("1 2 3", "1 2 3", "0 1 0"), 2, ASET_ERR_GEOMETRY, "v", "zero view vector"},
        {VIEW_OF("1 2 3", "1 2 3.000000000000000000001", "0 1 0"), 2, ASET_ERR_GEOMETRY, "v", "zero view vector"},
        {VIEW_OF("1 2 3", "0 0 0", "0 0 0"), 2, ASET_ERR_GEOMETRY, "v", "zero up vector"},
        {VIEW_OF("1 2 3", "0 0 0", "0 -0 1e-400"), 2, ASET_ERR_GEOMETRY, "v", "zero up vector"},
        {VIEW_OF("1 2 3", "0 0 0", "2 4 6"), 2, ASET_ERR_GEOMETRY, "v", "parallel"},
        {VIEW_OF("1 2 3", "0 0 0", "-1e30 -2e30 -3e30"), 2, ASET_ERR_GEOMETRY, "v", "parallel"},
        {VIEW_OF("3e38 0 0", "-3e38 0 0", "1e-30 0 0"), 2, ASET_ERR_GEOMETRY, "v", "parallel"},
        /* the tolerance, a sine of 1e-5 */
        {VIEW_OF("0 0 5", "0 0 0", "0 0.99e-5 1"), 2, ASET_ERR_GEOMETRY, "v", "parallel"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
    expect_log(VIEW_OF_UNMARKED("0 0 5", "0 0 0", "0 1.01e-5 1"),
               "view 0 0 5 at 0 0 0 up 0 1.01e-05 1 angle 45 height 0 size 9 9; ");
    expect_log(VIEW_OF_UNMARKED("0 0 1e-30", "0 0 0", "1e30 0 1e30"),
               "view 0 0 1e-30 at 0 0 0 up 1e+30 0 1e+30 angle 45 height 0 size 9 9; ");
    expect_log(VIEW_OF_UNMARKED("3e38 0 0", "-3e38 0 0", "0 3e38 0"),
               "view 3e+38 0 0 at -3e+38 0 0 up 0 3e+38 0 angle 45 height 0 size 9 9; ");
}

static void test_nff__files_that_end_within_an_entity(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {"b 1 1@", 1, ASET_ERR_SYNTAX, "", "ends within a background"},
        {"l 1 2\n@", 2, ASET_ERR_SYNTAX, "", "ends within a light"},
        {"l 1 2 3 1@", 1, ASET_ERR_SYNTAX, "", "ends within a light"},
        {"f 1 1 1 1 1 1 0 # ior\n@", 2, ASET_ERR_SYNTAX, "", "ends within a material"},
#if ASET_WITH_CONES
        {VIEW FILL "c 1 2 3 4\n5 6 7@", 10, ASET_ERR_SYNTAX, "", "ends within a cone"},
#endif
#if ASET_WITH_SPHERES
        {VIEW FILL "s@", 9, ASET_ERR_SYNTAX, "", "ends within a sphere"},
#endif
#if ASET_WITH_POLYGONS
        {VIEW FILL "p@", 9, ASET_ERR_SYNTAX, "", "ends within a polygon"},
        {VIEW FILL "p 3\n0 0 0\n1 0 0\n@", 12, ASET_ERR_SYNTAX, "", "ends within a polygon"},
        {VIEW FILL "p 1000000000\n0 0 0\n1 0 0\n@", 12, ASET_ERR_SYNTAX, "", "ends within a polygon"},
        {VIEW FILL "p 4294967295\n0 0 0\n@", 11, ASET_ERR_SYNTAX, "", "ends within a polygon"},
#endif
#if ASET_WITH_PATCHES
        {VIEW FILL "pp 3\n0 0 0 0 0 1\n1 0 0@", 11, ASET_ERR_SYNTAX, "", "ends within a patch"},
#endif
    };
    expect_all_bad(bad, COUNT_OF(bad));
}

#if ASET_WITH_POLYGONS
static void test_nff__counts(void **state) {
    (void)state;
    static const bad_case bad[] = {
        {VIEW FILL "p @2\n0 0 0\n1 0 0\n", 9, ASET_ERR_SYNTAX, "2", "fewer than 3"},
        {VIEW FILL "p @0", 9, ASET_ERR_SYNTAX, "0", "fewer than 3"},
        {VIEW FILL "p @-3", 9, ASET_ERR_SYNTAX, "-3", "not a whole number"},
        {VIEW FILL "p @3.0", 9, ASET_ERR_SYNTAX, "3.0", "not a whole number"},
        {VIEW FILL "p @four", 9, ASET_ERR_SYNTAX, "four", "not a whole number"},
        {VIEW FILL "p @4294967296", 9, ASET_ERR_SYNTAX, "4294967296", "too large"},
        {VIEW FILL "p @18446744073709551619", 9, ASET_ERR_SYNTAX, "18446744073709551619", "too large"},
        {VIEW FILL "p 3\n0 0 0\n1 0 0\n0 1 0\n@0 0 1", 13, ASET_ERR_SYNTAX, "0", "a number where"},
        {VIEW FILL "p 4\n0 0 0\n1 0 0\n0 1 0\n@s 0 0 1", 13, ASET_ERR_SYNTAX, "s", "not a decimal number"},
    };
    expect_all_bad(bad, COUNT_OF(bad));
}
#endif

static void test_nff__objects_too_early(void **state) {
    (void)state;
    static const bad_case bad[] = {
#if ASET_WITH_SPHERES
        {"# x\n@s 0 0 0 1\n" VIEW, 2, ASET_ERR_SYNTAX, "s", "before the view"},
        {FILL "@s 0 0 0 1\n" VIEW, 2, ASET_ERR_SYNTAX, "s", "before the view"},
        {VIEW "@s 0 0 0 1\n" FILL, 8, ASET_ERR_SYNTAX, "s", "before any material"},
#endif
#if ASET_WITH_CONES
        {VIEW "@c 0 0 0 1 0 0 1 1\n", 8, ASET_ERR_SYNTAX, "c", "before any material"},
#endif
#if ASET_WITH_POLYGONS
        {VIEW "@p 3\n", 8, ASET_ERR_SYNTAX, "p", "before any material"},
#endif
#if ASET_WITH_PATCHES
        {"@pp 3\n", 1, ASET_ERR_SYNTAX, "pp", "before the view"},
#endif
    };
    expect_all_bad(bad, COUNT_OF(bad));
}

#if !(ALL_KINDS && ASET_WITH_REFRACTION)
static void test_nff__switched_off(void **state) {
    (void)state;
    static const bad_case bad[] = {
#if !ASET_WITH_POLYGONS
        {VIEW FILL "\n@p 3 0 0 0", 10, ASET_ERR_UNSUPPORTED, "p", "polygons were switched off"},
#endif
#if !ASET_WITH_PATCHES
        {VIEW FILL "\n@pp 3 0 0 0", 10, ASET_ERR_UNSUPPORTED, "pp", "patches were switched off"},
#endif
#if !ASET_WITH_SPHERES
        {VIEW FILL "\n@s 0 0 0 1", 10, ASET_ERR_UNSUPPORTED, "s", "spheres were switched off"},
#endif
#if !ASET_WITH_CONES
        {VIEW FILL "\n@c 0 0 0 1", 10, ASET_ERR_UNSUPPORTED, "c", "cones were switched off"},
#endif
#if !ASET_WITH_REFRACTION
        {"f 1 1 1 1 1 1\n@0.5 1.5", 2, ASET_ERR_UNSUPPORTED, "0.5", "transmission was switched off"},
#endif
    };
    expect_all_bad(bad, COUNT_OF(bad));
}
#endif

static void test_nff__control_bytes(void **state) {
    (void)state;
    static const char controls[] = {0, 1, 7, 11, 12, 26, 27, 31, 127};
    for (size_t i = 0; i < sizeof controls; i++) {
        const bad_case bad = {"a control byte", 2, ASET_ERR_SYNTAX, "?", "a control byte"};
        char blank[] = "b 1 1 1\n 1 v", word[] = "b 1 1 1\nfr1m", comment[] = "b 1 1 1\n# no";
        blank[9] = word[10] = comment[10] = controls[i];
        expect_bad_bytes(blank, sizeof blank - 1, 9, &bad);
        expect_bad_bytes(word, sizeof word - 1, 10, &bad);
        expect_bad_bytes(comment, sizeof comment - 1, 10, &bad);
    }
}

static void test_nff__over_long_words(void **state) {
    (void)state;
    char text[300], cut[32];
    const bad_case bad = {"an over-long word", 2, ASET_ERR_SYNTAX, cut, "too long"};
    memset(text, '1', sizeof text);
    memset(cut, '1', sizeof cut);
    cut[31] = '\0';
    memcpy(text, "b 1\n", 4);
    expect_bad_bytes(text, 4 + ASET_READER_TOKEN, 4, &bad);
    expect_bad_bytes(text, sizeof text, 4, &bad);
    /* the longest that passes: 1.0...0 */
    memset(text, '0', sizeof text);
    memcpy(text, "b 1\n1.", 6);
    text[4 + ASET_READER_TOKEN - 1] = ' ';
    const size_t used = 4 + ASET_READER_TOKEN;
    memcpy(text + used, "1 " VIEW, sizeof "1 " VIEW);
    expect_log(text, "back 1 1 1; " VIEW_LOG);
}

static void test_nff__long_comments(void **state) {
    (void)state;
    char *text = malloc(100000);
    assert_non_null(text);
    memset(text, '#', 100000);
    memcpy(text + 90000, "\n" VIEW, sizeof "\n" VIEW);
    expect_log(text, VIEW_LOG);
    free(text);
}

/* ---- callbacks and sinks that fail ---- */

#if ALL_KINDS
/* One of everything, one entity a line but for the view; counts of calls and lines below. */
#define ONE_OF_ALL                                                                                                     \
    "b 1 1 1\n" VIEW "l 1 2 3\n" FILL "p 3 0 0 0 1 0 0 0 1 0\npp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1\ns 0 0 0 1\n"      \
    "c 0 0 0 1 0 0 1 1\n"

static void test_nff__refusals_of_the_sink(void **state) {
    (void)state;
    static const struct {
        uint32_t line;
        const char *token, *degenerate;
    } calls[] = {
        {1, "b", "background"},          {2, "v", "degenerate view"},     {9, "l", "light"},
        {10, "f", "material"},           {11, "p", "a polygon with a number"}, {11, "p", "a polygon with a number"},
        {11, "p", "a polygon with a number"}, {11, "p", "a polygon with a number"}, {11, "p", "a polygon with a number"},
        {12, "pp", "a patch with a number"},  {12, "pp", "a patch with a number"},  {12, "pp", "a patch with a number"},
        {12, "pp", "a patch with a number"},  {12, "pp", "a patch with a number"},  {13, "s", "degenerate sphere"},
        {14, "c", "degenerate cone"},
    };
    static const struct {
        aset_status status;
        const char *what; /* NULL: the call's own */
    } answers[] = {
        {ASET_ERR_GEOMETRY, NULL},           {ASET_ERR_NOMEM, "does not fit in the arena's limits"},
        {ASET_ERR_LIMIT, "more than"},       {ASET_ERR_UNSUPPORTED, "switched off"},
        {ASET_ERR_STOPPED, "asked to stop"}, {ASET_ERR_ARGUMENT, "refused"},
    };
    static const char text[] = ONE_OF_ALL;
    for (unsigned call = 0; call <= COUNT_OF(calls); call++) {
        for (size_t i = 0; i < COUNT_OF(answers); i++) {
            recorder to;
            aset_load_report report;
            recorder_init(&to, " %.6g", false);
            to.fail_call = call + 1;
            to.failure = answers[i].status;
            const aset_status status = load(source_of(text, sizeof text - 1, 7), &to, &report);
            if (call == COUNT_OF(calls)) { /* there is no such call */
                assert_int_equal(status, ASET_OK);
            } else {
                size_t offset = 0;
                for (uint32_t line = 1; line < calls[call].line; line++) {
                    offset += strcspn(text + offset, "\n") + 1;
                }
                assert_int_equal(status, answers[i].status);
                assert_int_equal(to.calls, call + 1); /* and none after it */
                assert_int_equal(report.line, calls[call].line);
                assert_int_equal(report.offset, offset);
                assert_string_equal(report.token, calls[call].token);
                assert_non_null(strstr(report.what, answers[i].what == NULL ? calls[call].degenerate : answers[i].what));
            }
            free(to.text);
        }
    }
}
#else
#define ONE_OF_ALL "b 1 1 1\n" VIEW "l 1 2 3\n" FILL
#endif

static void test_nff__read_fails_at_every_byte(void **state) {
    (void)state;
    static const char text[] = ONE_OF_ALL;
    for (size_t fail_at = 0; fail_at < sizeof text; fail_at++) { /* the last: instead of the end */
        for (size_t i = 0; i < COUNT_OF(chunks); i++) {
            recorder to;
            aset_load_report report;
            recorder_init(&to, " %.6g", false);
            byte_source from = source_of(text, sizeof text - 1, chunks[i]);
            from.fail_at = fail_at;
            assert_int_equal(load(from, &to, &report), ASET_ERR_READ);
            assert_int_equal(report.offset, fail_at);
            uint32_t line = 1;
            for (size_t k = 0; k < fail_at; k++) {
                line += text[k] == '\n';
            }
            assert_int_equal(report.line, line);
            assert_string_equal(report.what, "the input could not be read");
            free(to.text);
        }
    }
}

static ptrdiff_t give_too_much(void *context, void *buffer, size_t size) {
    (void)context;
    memset(buffer, 'b', size);
    return (ptrdiff_t)size + 1;
}

static void test_nff__read_gives_too_much(void **state) {
    (void)state;
    recorder to;
    aset_load_report report;
    recorder_init(&to, " %.6g", false);
    const aset_sink sink = recorder_sink(&to);
    assert_int_equal(aset_load_nff(&sink, give_too_much, NULL, NULL, &report), ASET_ERR_READ);
    assert_non_null(strstr(report.what, "more bytes"));
    free(to.text);
}

static void test_nff__arguments(void **state) {
    (void)state;
    recorder to;
    aset_load_report report;
    recorder_init(&to, " %.6g", false);
    const aset_sink sink = recorder_sink(&to);
    assert_int_equal(aset_load_nff(NULL, give, NULL, NULL, &report), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_load_nff(&sink, NULL, NULL, NULL, &report), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_load_nff(&sink, give, NULL, NULL, NULL), ASET_ERR_ARGUMENT);
    free(to.text);
}

#if ALL_KINDS
/*
 * Cut off after every byte. A file is complete where its last byte is in brackets (not part of the input), and only there.
 * Its last number may then be shorter than meant, which no reader can know.
 */
static void test_nff__every_prefix(void **state) {
    (void)state;
    static const char marked[] = "# a file\nb 0 1 0\nl 4 3 2\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\n"
                                 "resolution 64 [48\r\n# note\n]l 1 2 [3.5 ]1 0 [0.25\n]f 1 1 1 1 0 3 0 [0\n]"
                                 "p 3\n0 0 0\n1 0 0\n0 1 [0\n]pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 [1\n]"
                                 "s 0 0 0 [1\n]c\n0 0 0 1\n0 0 1 [0.5#end\n]";
    char text[sizeof marked];
    bool complete[sizeof marked], inside = false;
    size_t size = 0;
    for (size_t i = 0; marked[i] != '\0'; i++) {
        if (marked[i] == '[' || marked[i] == ']') {
            inside = marked[i] == '[';
        } else {
            text[size] = marked[i];
            complete[size++] = inside;
        }
    }
    for (size_t cut = 0; cut <= size; cut++) {
        for (size_t i = 0; i < COUNT_OF(chunks); i++) {
            recorder to;
            aset_load_report report;
            char *copy = malloc(cut + 1); /* of its own size, so that a sanitizer sees a byte too far */
            assert_non_null(copy);
            memcpy(copy, text, cut);
            recorder_init(&to, " %.6g", false);
            const aset_status status = load(source_of(copy, cut, chunks[i]), &to, &report);
            const bool whole = cut > 0 && complete[cut - 1];
            if (whole != (status == ASET_OK)) {
                print_error("cut after %lu bytes\n", (unsigned long)cut);
            }
            assert_int_equal(status, whole ? ASET_OK : ASET_ERR_SYNTAX);
            assert_true(whole || (report.what != NULL && report.offset <= cut));
            free(copy);
            free(to.text);
        }
    }
}
#endif

static random_state numbers; /* a test that draws sets its state */

static uint32_t number_below(uint32_t n) {
    return (uint32_t)(random_next(&numbers) % n);
}

/* One byte of a good file replaced, dropped or doubled: any answer but a crash, and an error tells its place. */
static void test_nff__damaged_files(void **state) {
    (void)state;
    static const char good[] = ONE_OF_ALL;
    numbers.state = 20260101;
    for (int round = 0; round < 20000; round++) {
        char text[sizeof good + 1];
        size_t size = sizeof good - 1;
        const size_t at = number_below((uint32_t)size);
        memcpy(text, good, size);
        switch (number_below(3)) {
        case 0:
            text[at] = (char)number_below(256);
            break;
        case 1:
            memmove(text + at, text + at + 1, --size - at);
            break;
        default:
            memmove(text + at + 1, text + at, size++ - at);
            break;
        }
        recorder to;
        aset_load_report report;
        recorder_init(&to, " %.6g", false);
        const aset_status status = load(source_of(text, size, 3), &to, &report);
        assert_true(status == ASET_OK || status == ASET_ERR_SYNTAX || status == ASET_ERR_GEOMETRY ||
                    status == ASET_ERR_UNSUPPORTED);
        assert_true((status == ASET_OK) == (report.what == NULL));
        assert_true(report.what == NULL || (report.offset <= size && report.line >= 1 && report.line <= 20));
        free(to.text);
    }
}

/* ---- the reader by itself ---- */

static void test_nff__tokens_know_their_lines(void **state) {
    (void)state;
    static const char text[] = "f 1 2\n3 # 4\n\r\nf\r5";
    static const struct {
        const char *token;
        bool starts_line;
        uint32_t line;
        uint64_t offset;
    } expected[] = {
        {"f", true, 1, 0},  {"1", false, 1, 2}, {"2", false, 1, 4}, {"3", true, 2, 6},
        {"f", true, 4, 14}, {"5", true, 5, 16}, {"", true, 5, 17},  {"", true, 5, 17},
    };
    for (size_t i = 0; i < COUNT_OF(chunks); i++) {
        aset_reader reader;
        aset_load_report report;
        byte_source from = source_of(text, sizeof text - 1, chunks[i]);
        aset_reader_init(&reader, give, &from, &report);
        for (size_t k = 0; k < COUNT_OF(expected); k++) {
            assert_int_equal(aset_reader_keep(&reader), ASET_OK);
            assert_int_equal(aset_reader_keep(&reader), ASET_OK); /* twice is like once */
            assert_string_equal(reader.token, expected[k].token);
            assert_int_equal(reader.starts_line, expected[k].starts_line);
            assert_int_equal(aset_reader_next(&reader), ASET_OK);
            const aset_place place = aset_reader_place(&reader);
            assert_string_equal(place.token, expected[k].token);
            assert_int_equal(reader.length, strlen(expected[k].token));
            assert_int_equal(place.line, expected[k].line);
            assert_int_equal(place.offset, expected[k].offset);
        }
    }
}

static void test_nff__comment_byte_is_a_choice(void **state) {
    (void)state;
    aset_reader reader;
    aset_load_report report;
    byte_source from = source_of("a#b ! c", 7, 1);
    aset_reader_init(&reader, give, &from, &report);
    reader.comment = -1;
    assert_int_equal(aset_reader_next(&reader), ASET_OK);
    assert_true(aset_reader_is(&reader, "a#b"));
    assert_false(aset_reader_is(&reader, "a#"));
    assert_false(aset_reader_is(&reader, "a#bc"));
    reader.comment = '!';
    assert_int_equal(aset_reader_next(&reader), ASET_OK);
    assert_int_equal(reader.length, 0);
}

static void test_nff__skip_peek_and_raw(void **state) {
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    static const char binary[] = {0, '\n', '\r', 27, -1, 0, 7, 8, 9, 10, 11, 12};
    for (size_t e = 0; e < COUNT_OF(ends); e++) {
        char text[64];
        const int header = snprintf(text, sizeof text, "ply x y%send%s", ends[e], ends[e]);
        assert_true(header > 0);
        memcpy(text + header, binary, sizeof binary);
        for (size_t i = 0; i < COUNT_OF(chunks); i++) {
            aset_reader reader;
            aset_load_report report;
            unsigned char got[sizeof binary + 5];
            const unsigned char *seen;
            size_t n;
            byte_source from = source_of(text, (size_t)header + sizeof binary, chunks[i]);
            aset_reader_init(&reader, give, &from, &report);
            assert_int_equal(aset_reader_next(&reader), ASET_OK);
            assert_int_equal(aset_reader_skip_line(&reader), ASET_OK);
            assert_int_equal(aset_reader_next(&reader), ASET_OK);
            assert_string_equal(reader.token, "end");
            assert_int_equal(reader.token_line, 2);
            assert_int_equal(aset_reader_skip_line(&reader), ASET_OK);
            assert_int_equal(aset_reader_peek(&reader, 9, &seen, &n), ASET_OK);
            assert_int_equal(n, ASET_READER_BUFFER < 9 ? ASET_READER_BUFFER : 9);
            assert_memory_equal(seen, binary, n);
            size_t taken = 0;
            do {
                assert_int_equal(aset_reader_peek(&reader, 5, &seen, &n), ASET_OK);
                assert_true(taken + n <= sizeof got);
                memcpy(got + taken, seen, n);
                aset_reader_advance(&reader, n);
                taken += n;
            } while (n > 0);
            assert_int_equal(taken, sizeof binary);
            assert_memory_equal(got, binary, sizeof binary);
            assert_int_equal(reader.offset, (size_t)header + sizeof binary);
            assert_int_equal(aset_reader_peek(&reader, 3, &seen, &n), ASET_OK);
            assert_int_equal(n, 0);
            assert_int_equal(aset_reader_skip_line(&reader), ASET_OK); /* at the end there is nothing to skip */
        }
    }
}

/* ---- numbers ---- */

/* The same bits as the C library's, which rounds correctly on the systems where the tests run; or too large for both. */
static void expect_reference(const char *text) {
    const aset_real reference = (aset_real)REFERENCE(text);
    aset_real value = 12345;
    const char *wrong = aset_number_real(text, strlen(text), &value);
    if (isinf(reference)) {
        if (wrong == NULL || strcmp(wrong, "a number too large") != 0) {
            fail_msg("'%s' is too large, but gave " EXACT, text, (double)value);
        }
        assert_true(value == 12345);
    } else if (wrong != NULL || memcmp(&value, &reference, sizeof value) != 0) {
        fail_msg("'%s' gave " EXACT " instead of " EXACT " (%s)", text, (double)value, (double)reference,
                 wrong == NULL ? "no error" : wrong);
    }
}

static void test_nff__numbers_in_a_table(void **state) {
    (void)state;
    static const char *const good[] = {
        "0", "-0", "+0", "0.0", ".0", "0.", "000", "0e5", "0e-99999999999", "0e99999999999", "1", "+1", "-1", "1.",
        ".5", "-.5", "00012.500", "0.1", "0.2", "0.3", "3.0827", "101.148", "5.14416e-18", "-2.22045e-16", "1e22",
        "1e23", "1E5", "1e+5", "1e05", "16777216", "16777217", "16777218", "16777219", "33554435", "9007199254740992",
        "9007199254740993", "9007199254740995", "9007199254740993.0000000000000000000000000000000000001",
        "18446744073709551615", "18446744073709551616",
        "0.333333333333333333333333333333333333333333333333333333333333333333333333333333333333333",
        "123456789012345678901234567890123456789012345678901234567890e-40", "3.4028234e38", "3.4028235e38",
        "3.40282356e38", "3.4028235677973366e38", "3.4028235677973366163753939545814e38",
        "340282356779733661637539395458142568447.9999", "340282356779733661637539395458142568448", "3.5e38", "1e39",
        "1e40", "-1e39", "1.17549435e-38", "1.17549421e-38", "1.1754943e-38", "1.17549428e-38", "1e-38", "1e-39",
        "1.4e-45", "2.1e-45", "7.1e-46", "7.0064923e-46",
        "7.00649232162408535461864791644958065640130970938257885878534141944895541342930300743319094181060791015625e-46",
        "7.00649232162408535461864791644958065640130970938257885878534141944895541342930300743319094181060791015626e-46",
        "7e-46", "1e-46", "1e-47", "1.7976931348623157e308", "1.7976931348623158e308", "1.7976931348623159e308",
        "1.8e308", "1e309", "2.2250738585072014e-308", "2.2250738585072011e-308", "2.225073858507201e-308", "4.9e-324",
        "5e-324", "2.5e-324", "2.47e-324", "2.4703282292062327e-324", "2.4703282292062328e-324", "1e-324", "1e-325",
        "1e-1000000", "1e1000000", "1e-99999999999999999999", "1e99999999999999999999",
        "0.00000000000000000000000000000000000000000000000000000001e56",
        "100000000000000000000000000000000000000000000000000000000000e-59",
    };
    for (size_t i = 0; i < COUNT_OF(good); i++) {
        expect_reference(good[i]);
    }
}

static void test_nff__strings_that_are_no_numbers(void **state) {
    (void)state;
    static const char *const bad[] = {
        "", "+", "-", ".", "e5", ".e5", "1e", "1e+", "1e-", "1e5.0", "1.2.3", "--1", "+-1", "1x", "x1", "0x10", "1f",
        "1,5", "1 ", " 1", "1e5e5", "1d5", "in", "na", "1_0", "\xb2",
    };
    static const char *const infinite[] = {"nan", "-nan", "NaN", "nan(0x1)", "inf", "+inf", "-Infinity", "INF"};
    aset_real value = 7;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        const char *wrong = aset_number_real(bad[i], strlen(bad[i]), &value);
        assert_non_null(wrong);
        assert_string_equal(wrong, "not a decimal number");
    }
    for (size_t i = 0; i < COUNT_OF(infinite); i++) {
        assert_string_equal(aset_number_real(infinite[i], strlen(infinite[i]), &value), "not a finite number");
    }
    assert_true(value == 7);
    assert_null(aset_number_real("12/34", 2, &value)); /* a piece of a longer text, as OBJ has them */
    assert_true(value == 12);
}

static void test_nff__whole_numbers(void **state) {
    (void)state;
    static const struct {
        const char *text;
        uint32_t value;
    } good[] = {
        {"0", 0}, {"3", 3}, {"007", 7}, {"65535", 65535}, {"4294967295", UINT32_MAX}, {"00000000004294967295", UINT32_MAX},
    };
    static const char *const bad[] = {"", "-1", "+1", "1.0", "1e3", "0x1", "4294967296", "99999999999999999999999999999999"};
    uint32_t value;
    for (size_t i = 0; i < COUNT_OF(good); i++) {
        assert_null(aset_number_whole(good[i].text, strlen(good[i].text), &value));
        assert_int_equal(value, good[i].value);
    }
    value = 7;
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        assert_non_null(aset_number_whole(bad[i], strlen(bad[i]), &value));
    }
    assert_int_equal(value, 7);
}

/* Digits, point and exponent at random; exponents reach beyond both ends of the range. */
static void random_decimal(char text[ASET_READER_TOKEN]) {
    const uint32_t range = ASET_REAL_BITS == 32 ? 60 : 350;
    const uint32_t n = 1 + number_below(number_below(4) == 0 ? 100 : 20), point = number_below(n + 1);
    size_t at = 0;
    if (number_below(2) == 0) {
        text[at++] = number_below(4) == 0 ? '+' : '-';
    }
    for (uint32_t i = 0; i < n; i++) {
        if (i == point) {
            text[at++] = '.';
        }
        text[at++] = (char)('0' + number_below(10));
    }
    text[at] = '\0';
    if (number_below(3) != 0) {
        const int exponent = (int)number_below(2 * range + 1) - (int)range;
        snprintf(text + at, ASET_READER_TOKEN - at, number_below(2) == 0 ? "e%d" : "E%d", exponent);
    }
}

static void test_nff__numbers_equal_the_c_library_s(void **state) {
    (void)state;
    numbers.state = 88;
    for (int i = 0; i < 100000; i++) {
        char text[ASET_READER_TOKEN];
        random_decimal(text);
        expect_reference(text);
    }
}

/* Any finite aset_real comes back from 9 or 17 digits. */
static void test_nff__numbers_round_trip(void **state) {
    (void)state;
    numbers.state = 1987;
    for (int i = 0; i < 100000; i++) {
        const uint64_t bits = random_next(&numbers);
        aset_real number, value = 0;
        char text[64];
        memcpy(&number, &bits, sizeof number < sizeof bits ? sizeof number : sizeof bits);
        if (isnan(number) || isinf(number)) {
            continue;
        }
        snprintf(text, sizeof text, EXACT, (double)number);
        assert_null(aset_number_real(text, strlen(text), &value));
        if (memcmp(&value, &number, sizeof value) != 0) {
            fail_msg("%s gave " EXACT, text, (double)value);
        }
    }
}

/* Exactly between two neighbours, and a trifle above: where a rounding of already rounded digits fails. */
static void test_nff__ties(void **state) {
    (void)state;
#if ASET_REAL_BITS == 32
    typedef double wider;
    static const char format[] = "%.90e";
#else
    typedef long double wider;
    static const char format[] = "%.90Le";
    if (LDBL_MANT_DIG < 54) {
        skip();
    }
#endif
    numbers.state = 24;
    const int mantissa_bits = ASET_REAL_BITS == 32 ? 24 : 53, exponents = ASET_REAL_BITS == 32 ? 80 : 100;
    for (int i = 0; i < 20000; i++) {
        const uint64_t word = random_next(&numbers) >> (64 - mantissa_bits);
        const uint64_t mantissa = (word | (uint64_t)1 << (mantissa_bits - 1)) * 2 + 1;
        const wider tie = (wider)ldexpl((long double)mantissa, (int)number_below((uint32_t)exponents) - exponents);
        char text[ASET_READER_TOKEN];
        snprintf(text, sizeof text, format, tie);
        expect_reference(text);
        char *e = strchr(text, 'e');
        e[-1] = '1';
        expect_reference(text);
    }
}

/* ---- reference files ---- */

static ptrdiff_t give_file(void *context, void *buffer, size_t size) {
    FILE *file = context;
    const size_t n = fread(buffer, 1, size, file);
    return n == 0 && ferror(file) ? -1 : (ptrdiff_t)n;
}

#if ASET_WITH_REFRACTION
static char *whole_file(FILE *file) {
    size_t size = 0, capacity = 1 << 16;
    char *text = malloc(capacity);
    assert_non_null(text);
    for (size_t n; (n = fread(text + size, 1, capacity - size - 1, file)) > 0;) {
        size += n;
        if (size + 1 == capacity) {
            text = realloc(text, capacity *= 2);
            assert_non_null(text);
        }
    }
    text[size] = '\0';
    return text;
}

/* The next token of *at, ended with 0 in place; NULL at the end. The files compared have no comments. */
static char *token_of(char **at) {
    char *token = *at + strspn(*at, " \t\r\n");
    char *end = token + strcspn(token, " \t\r\n");
    *at = *end == '\0' ? end : end + 1;
    *end = '\0';
    return *token == '\0' ? NULL : token;
}

/* Token by token the same words and, read by the C library, the same numbers; but for hither, which no sink is told. */
static void expect_same_tokens(char *file, char *written) {
    bool hither = false;
    for (;;) {
        const char *a = token_of(&file), *b = token_of(&written);
        if (a == NULL || b == NULL) {
            assert_null(a);
            assert_null(b);
            return;
        }
        if (strcmp(a, b) != 0 && !hither && !(strspn(a, "+-.0123456789") > 0 && REFERENCE(a) == REFERENCE(b))) {
            fail_msg("%s became %s", a, b);
        }
        hither = strcmp(a, "hither") == 0;
    }
}
#endif

static void expect_round_trip(FILE *file, const char *name) {
    recorder first, second;
    aset_load_report report;
    recorder_init(&first, " " EXACT, true);
    recorder_init(&second, " " EXACT, true);
    aset_sink sink = recorder_sink(&first);
    const aset_status status = aset_load_nff(&sink, give_file, file, NULL, &report);
    if (status != ASET_OK) {
        print_message("%s:%lu: %s: '%s'\n", name, (unsigned long)report.line, report.what, report.token);
    }
    if (status != ASET_ERR_UNSUPPORTED || (ALL_KINDS && ASET_WITH_REFRACTION)) {
        assert_int_equal(status, ASET_OK);
        assert_int_equal(load(source_of(first.text, first.length, 4096), &second, &report), ASET_OK);
        assert_string_equal(first.text, second.text);
#if ASET_WITH_REFRACTION /* else the index of refraction is lost on the way */
        rewind(file);
        char *text = whole_file(file);
        expect_same_tokens(text, first.text);
        free(text);
#endif
    }
    free(first.text);
    free(second.text);
}

static void test_nff__reference_files(void **state) {
    (void)state;
    static const char *const names[] = {"balls", "balls-2", "gears", "gears-2", "mount", "mount-4", "rings",
                                        "rings-3", "teapot", "teapot-3", "tetra", "tetra-5", "tree", "tree-7"};
    size_t n_read = 0;
    for (size_t i = 0; i < COUNT_OF(names); i++) {
        char path[64];
        snprintf(path, sizeof path, "../shared/scenes/%s.nff", names[i]);
        FILE *file = fopen(path, "rb");
        if (file != NULL) {
            expect_round_trip(file, path);
            fclose(file);
            n_read++;
        }
    }
    if (n_read == 0) {
        skip();
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nff__view_background_lights),
        cmocka_unit_test(test_nff__view_parts_in_any_order_without_hither),
        cmocka_unit_test(test_nff__second_view_is_passed_on),
        cmocka_unit_test(test_nff__light_colour_is_what_follows_as_numbers),
        cmocka_unit_test(test_nff__values_above_one_pass),
        cmocka_unit_test(test_nff__line_ends),
#if ASET_READER_BUFFER >= 3
        cmocka_unit_test(test_nff__a_mark_of_utf8),
#endif
        cmocka_unit_test(test_nff__comments_anywhere),
        cmocka_unit_test(test_nff__exponents),
        cmocka_unit_test(test_nff__materials_without_objects),
#if ASET_WITH_REFRACTION
        cmocka_unit_test(test_nff__transmitting_material),
#endif
        cmocka_unit_test(test_nff__one_sided_opaque),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_nff__spheres),
#endif
#if ASET_WITH_CONES
        cmocka_unit_test(test_nff__cone_on_one_line_and_on_three),
#endif
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_nff__polygons),
        cmocka_unit_test(test_nff__polygon_of_many_points),
        cmocka_unit_test(test_nff__counts),
#endif
#if ASET_WITH_PATCHES
        cmocka_unit_test(test_nff__patches),
#endif
        cmocka_unit_test(test_nff__empty),
        cmocka_unit_test(test_nff__no_view),
        cmocka_unit_test(test_nff__unknown_words),
        cmocka_unit_test(test_nff__not_numbers),
        cmocka_unit_test(test_nff__negative_amounts),
        cmocka_unit_test(test_nff__incomplete_views),
        cmocka_unit_test(test_nff__angles_and_resolutions),
        cmocka_unit_test(test_nff__degenerate_views),
        cmocka_unit_test(test_nff__files_that_end_within_an_entity),
        cmocka_unit_test(test_nff__objects_too_early),
#if !(ALL_KINDS && ASET_WITH_REFRACTION)
        cmocka_unit_test(test_nff__switched_off),
#endif
        cmocka_unit_test(test_nff__control_bytes),
        cmocka_unit_test(test_nff__over_long_words),
        cmocka_unit_test(test_nff__long_comments),
#if ALL_KINDS
        cmocka_unit_test(test_nff__refusals_of_the_sink),
        cmocka_unit_test(test_nff__every_prefix),
#endif
        cmocka_unit_test(test_nff__read_fails_at_every_byte),
        cmocka_unit_test(test_nff__read_gives_too_much),
        cmocka_unit_test(test_nff__arguments),
        cmocka_unit_test(test_nff__damaged_files),
        cmocka_unit_test(test_nff__tokens_know_their_lines),
        cmocka_unit_test(test_nff__comment_byte_is_a_choice),
        cmocka_unit_test(test_nff__skip_peek_and_raw),
        cmocka_unit_test(test_nff__numbers_in_a_table),
        cmocka_unit_test(test_nff__strings_that_are_no_numbers),
        cmocka_unit_test(test_nff__whole_numbers),
        cmocka_unit_test(test_nff__numbers_equal_the_c_library_s),
        cmocka_unit_test(test_nff__numbers_round_trip),
        cmocka_unit_test(test_nff__ties),
        cmocka_unit_test(test_nff__reference_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
