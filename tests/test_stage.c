/* test_stage.c - the view, lights and ground of models: where they are, that they show the whole model, and odd boxes. */
#include "support/support.h"

#include "aset/stage.h"

#include <math.h>

#define TURN_15 (15 * 3.14159265358979323846 / 180)

/* What came, and one letter for each entity in order. */
typedef struct seen {
    char order[16];
    size_t n;
    aset_status answer; /* to the entity number answer_at */
    size_t answer_at;
    aset_colour background;
    aset_view view;
    aset_light lights[2];
    aset_material material;
    aset_vec3 corners[4];
    uint32_t n_lights, n_corners;
} seen;

static aset_status note(seen *s, char letter) {
    assert_true(s->n + 1 < sizeof s->order);
    s->order[s->n++] = letter;
    s->order[s->n] = '\0';
    return s->n == s->answer_at ? s->answer : ASET_OK;
}

static aset_status see_background(void *context, const aset_colour *colour) {
    ((seen *)context)->background = *colour;
    return note(context, 'b');
}

static aset_status see_view(void *context, const aset_view *view) {
    ((seen *)context)->view = *view;
    return note(context, 'v');
}

static aset_status see_light(void *context, const aset_light *light) {
    seen *s = context;
    assert_true(s->n_lights < 2);
    s->lights[s->n_lights++] = *light;
    return note(s, 'l');
}

static aset_status see_material(void *context, const aset_material *material) {
    ((seen *)context)->material = *material;
    return note(context, 'm');
}

#if ASET_WITH_POLYGONS
static aset_status see_begin(void *context, uint32_t n_points, bool with_normals) {
    assert_int_equal(n_points, 4);
    assert_false(with_normals);
    return note(context, 'p');
}

static aset_status see_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    seen *s = context;
    assert_true(s->n_corners < 4 && normal == NULL);
    s->corners[s->n_corners++] = *point;
    return ASET_OK;
}

static aset_status see_end(void *context) {
    return note(context, 'e');
}
#endif

static aset_sink seen_sink(seen *s) {
    aset_sink sink;
    memset(&sink, 0, sizeof sink);
    memset(s, 0, sizeof *s);
    sink.context = s;
    sink.background = see_background;
    sink.view = see_view;
    sink.light = see_light;
    sink.material = see_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = see_begin;
    sink.polygon_point = see_point;
    sink.polygon_end = see_end;
#endif
    return sink;
}

static aset_vec3 v(double x, double y, double z) {
    return (aset_vec3){(aset_real)x, (aset_real)y, (aset_real)z};
}

static bool is_near(aset_vec3 a, aset_vec3 b, double tolerance) {
    return fabs((double)a.x - (double)b.x) <= tolerance && fabs((double)a.y - (double)b.y) <= tolerance &&
           fabs((double)a.z - (double)b.z) <= tolerance;
}

/* Without a ground where there are no polygons. */
static aset_stage_options options_of(aset_up up, double aspect) {
    aset_stage_options o = {up, !ASET_WITH_POLYGONS, (aset_real)aspect};
    return o;
}

/* A box of half diagonal 3 around (10, 20, 30): half edges 1, 2, 2. */
static void test_stage__is_where_the_rule_says(void **state) {
    (void)state;
    for (int up = ASET_UP_Y; up <= ASET_UP_Z; up++) {
        seen s;
        aset_sink sink = seen_sink(&s);
        aset_vec3 low = v(9, 18, 28), high = v(11, 22, 32);
        aset_stage_options o = options_of((aset_up)up, 0);
        assert_int_equal(aset_stage_emit(&sink, &low, &high, &o), ASET_OK);
        assert_string_equal(s.order, ASET_WITH_POLYGONS ? "bvllmpe" : "bvll");
        bool z = up == ASET_UP_Z;
        double length = sqrt(0.25 + 0.16 + 1), far = 3 / sin(TURN_15) / length;
        assert_true(is_near(s.view.at, v(10, 20, 30), 1e-5));
        aset_vec3 eye = z ? v(10 - 0.5 * far, 20 - far, 30 + 0.4 * far) : v(10 - 0.5 * far, 20 + 0.4 * far, 30 + far);
        aset_vec3 key = z ? v(10 - 14.4, 20 - 9.6, 30 + 19.2) : v(10 - 14.4, 20 + 19.2, 30 + 9.6);
        aset_vec3 fill = z ? v(10 + 14.4, 20 - 19.2, 30 + 9.6) : v(10 + 14.4, 20 + 9.6, 30 + 19.2);
        assert_true(is_near(s.view.from, eye, 1e-4));
        assert_true(is_near(s.view.up, z ? v(0, 0, 1) : v(0, 1, 0), 0));
        assert_true(s.view.angle_deg == 30 && s.view.height == 0 && s.view.width_px == 0 && s.view.height_px == 0);
        assert_true(is_near(s.lights[0].position, key, 1e-4) && is_near(s.lights[1].position, fill, 1e-4));
        assert_true(s.lights[0].has_colour && !s.lights[0].directional && fabs((double)s.lights[0].colour.g - 0.85) < 1e-6);
        assert_true(s.lights[1].has_colour && !s.lights[1].directional && fabs((double)s.lights[1].colour.b - 0.3) < 1e-6);
        assert_true(s.background.r < s.background.g && s.background.g < s.background.b && s.background.b < 1);
#if ASET_WITH_POLYGONS
        double below = 3.0 / 1024;
        assert_true(is_near(s.corners[0], z ? v(1, 11, 28 - below) : v(1, 18 - below, 39), 1e-5));
        assert_true(is_near(s.corners[1], z ? v(19, 11, 28 - below) : v(19, 18 - below, 39), 1e-5));
        assert_true(is_near(s.corners[2], z ? v(19, 29, 28 - below) : v(19, 18 - below, 21), 1e-5));
        assert_true(is_near(s.corners[3], z ? v(1, 29, 28 - below) : v(1, 18 - below, 21), 1e-5));
        assert_true(s.material.diffuse == 1 && s.material.specular == 0 && fabs((double)s.material.fill.r - 0.62) < 1e-6);
#endif
    }
}

static void test_stage__no_options_and_no_ground(void **state) {
    (void)state;
    seen s, t;
    aset_vec3 low = v(0, 0, 0), high = v(1, 1, 1);
    aset_stage_options o = {ASET_UP_Y, true, 0};
    aset_sink sink = seen_sink(&s);
    assert_int_equal(aset_stage_emit(&sink, &low, &high, &o), ASET_OK);
    assert_string_equal(s.order, "bvll");
    sink = seen_sink(&t);
#if ASET_WITH_POLYGONS
    assert_int_equal(aset_stage_emit(&sink, &low, &high, NULL), ASET_OK);
    assert_string_equal(t.order, "bvllmpe");
    assert_true(is_near(s.view.from, t.view.from, 0));
#else
    assert_int_equal(aset_stage_emit(&sink, &low, &high, NULL), ASET_ERR_UNSUPPORTED);
#endif
    aset_material m = aset_stage_material();
    assert_true(m.diffuse == 1 && m.specular == 0 && !m.one_sided && m.fill.r > m.fill.g && m.fill.g > m.fill.b);
}

/* Where a point falls in the picture: -1 to 1 across its height, and the same unit across its width. */
static void project(const aset_view *view, aset_vec3 point, double *x, double *y) {
    double f[3] = {(double)view->at.x - (double)view->from.x, (double)view->at.y - (double)view->from.y,
                   (double)view->at.z - (double)view->from.z};
    double p[3] = {(double)point.x - (double)view->from.x, (double)point.y - (double)view->from.y,
                   (double)point.z - (double)view->from.z};
    double u[3] = {(double)view->up.x, (double)view->up.y, (double)view->up.z}, r[3], w[3];
    double scale = tan(TURN_15);
    double length = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]), across;
    for (int i = 0; i < 3; i++) {
        f[i] /= length;
    }
    for (int i = 0; i < 3; i++) {
        r[i] = f[(i + 1) % 3] * u[(i + 2) % 3] - f[(i + 2) % 3] * u[(i + 1) % 3];
    }
    across = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    for (int i = 0; i < 3; i++) {
        w[i] = (r[(i + 1) % 3] * f[(i + 2) % 3] - r[(i + 2) % 3] * f[(i + 1) % 3]) / across;
    }
    double depth = p[0] * f[0] + p[1] * f[1] + p[2] * f[2];
    assert_true(depth > 0);
    *x = (p[0] * r[0] + p[1] * r[1] + p[2] * r[2]) / across / depth / scale;
    *y = (p[0] * w[0] + p[1] * w[1] + p[2] * w[2]) / depth / scale;
}

static void test_stage__every_corner_is_in_the_picture(void **state) {
    (void)state;
    random_state r = random_start(seed_of(51));
    for (int i = 0; i < 3000; i++) {
        seen s;
        aset_sink sink = seen_sink(&s);
        double scale = pow(10, random_between(&r, -10, 10)), aspect = pow(2, random_between(&r, -6, 6));
        aset_vec3 middle = random_in_cube(&r, scale), size = random_in_cube(&r, scale);
        double half[3] = {fabs((double)size.x), fabs((double)size.y), fabs((double)size.z)};
        aset_vec3 low = v((double)middle.x - half[0], (double)middle.y - half[1], (double)middle.z - half[2]);
        aset_vec3 high = v((double)middle.x + half[0], (double)middle.y + half[1], (double)middle.z + half[2]);
        aset_stage_options o = options_of(random_chance(&r, 0.5) ? ASET_UP_Y : ASET_UP_Z, aspect);
        check(aset_stage_emit(&sink, &low, &high, &o) == ASET_OK, SEED " box %d", r.seed, i);
        for (int corner = 0; corner < 8; corner++) {
            double x, y;
            aset_vec3 at = {corner & 1 ? low.x : high.x, corner & 2 ? low.y : high.y, corner & 4 ? low.z : high.z};
            project(&s.view, at, &x, &y);
            check(fabs(x) <= aspect * 1.001 && fabs(y) <= 1.001, SEED " box %d: at %g %g, aspect %g", r.seed, i, x, y,
                  aspect);
        }
    }
}

/* Points, lines and planes, near and far: the counter checks a view as every sink does. */
static void test_stage__boxes_without_extent_have_a_view(void **state) {
    (void)state;
    static const double places[] = {0, 1e-30, 1, -1000, 1e6, 1e12, 1e15}, sizes[] = {0, 1e-35, 1e-20, 1e-9, 1, 1e5};
    uint32_t refused = 0;
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        for (size_t k = 0; k < COUNT_OF(sizes); k++) {
            for (int axes = 0; axes < 8; axes++) {
                aset_counter counter;
                aset_sink sink = aset_counter_sink(&counter);
                aset_vec3 low = v(places[i], -places[i], places[i] / 2), high = low;
                high.x += axes & 1 ? (aset_real)sizes[k] : 0;
                high.y += axes & 2 ? (aset_real)sizes[k] : 0;
                high.z += axes & 4 ? (aset_real)sizes[k] : 0;
                aset_stage_options o = options_of(axes % 2 == 0 ? ASET_UP_Y : ASET_UP_Z, 1);
                double span = fmax(fmax((double)(high.x - low.x), (double)(high.y - low.y)), (double)(high.z - low.z));
                double steps = span / (2 * (double)REAL_UNIT * fabs(places[i])); /* between its ends, or a few more */
                bool told = span == 0 || places[i] == 0 || steps > 65;
                aset_status status = aset_stage_emit(&sink, &low, &high, &o);
                check(told || steps < 63 ? status == (told ? ASET_OK : ASET_ERR_PRECISION) : true,
                      "place %g, size %g, axes %d: %d", places[i], sizes[k], axes, (int)status);
                if (status != ASET_OK) {
                    refused++;
                    continue;
                }
                check(counter.has_view && counter.counts.lights == 2 && counter.counts.polygons == ASET_WITH_POLYGONS,
                      "place %g, size %g, axes %d", places[i], sizes[k], axes);
                aset_vec3 along = {counter.view.at.x - counter.view.from.x, counter.view.at.y - counter.view.from.y,
                                   counter.view.at.z - counter.view.from.z};
                double sum = fabs((double)along.x) + fabs((double)along.y) + fabs((double)along.z);
                double share = fabs((double)along.x) / sum;
                check(share > 0.2 && share < 0.35, "place %g, size %g, axes %d: %g", places[i], sizes[k], axes, share);
            }
        }
    }
    assert_true(refused > 0);
}

/* Far from the origin, as maps have it: what has a hundred steps and more between its ends fills the picture as anywhere. */
static void test_stage__far_models_fill_the_picture(void **state) {
    (void)state;
    const double place = 1048576, step = place * 2 * (double)REAL_UNIT;
    for (double size = 256; size <= 65536; size *= 4) {
        aset_counter counter;
        aset_sink sink = aset_counter_sink(&counter);
        aset_vec3 low = v(place, 0, place), high = v(place + size * step, size * step, place + size * step);
        aset_stage_options o = options_of(ASET_UP_Y, 1);
        double x, y;
        assert_int_equal(aset_stage_emit(&sink, &low, &high, &o), ASET_OK);
        project(&counter.view, low, &x, &y);
        check(hypot(x, y) > (sizeof(aset_real) > sizeof(float) ? 0 : 0.3) && hypot(x, y) < 1.1, "%g steps: at %g %g", size, x, y);
    }
}

static void test_stage__refuses(void **state) {
    (void)state;
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    aset_vec3 low = v(0, 0, 0), high = v(1, 1, 1), huge = v(9e29, 9e29, 9e29);
    aset_vec3 nowhere = v(0, (double)NAN, 0), end = v((double)INFINITY, 1, 1);
    aset_stage_options o = options_of(ASET_UP_Y, 1), flat = options_of(ASET_UP_Y, -1), odd = options_of((aset_up)7, 1),
                       thin = options_of(ASET_UP_Y, (double)INFINITY);
    assert_int_equal(aset_stage_emit(NULL, &low, &high, &o), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, NULL, &high, &o), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &low, NULL, &o), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &high, &low, &o), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &low, &nowhere, &o), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &low, &end, &o), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &counter.low, &counter.high, &o), ASET_ERR_ARGUMENT); /* of nothing */
    assert_int_equal(aset_stage_emit(&sink, &low, &high, &flat), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &low, &high, &thin), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_stage_emit(&sink, &low, &high, &odd), ASET_ERR_ARGUMENT);
    assert_int_equal(counter.counts.lights, 0);
#if ASET_REAL_BITS == 32
    assert_int_equal(aset_stage_emit(&sink, &low, &huge, &o), ASET_ERR_GEOMETRY);
#else
    (void)huge;
#endif
}

static void test_stage__the_sinks_answer_ends_it(void **state) {
    (void)state;
    aset_vec3 low = v(0, 0, 0), high = v(1, 1, 1);
    aset_stage_options o = options_of(ASET_UP_Y, 1);
    for (size_t at = 1; at <= (ASET_WITH_POLYGONS ? 7 : 4); at++) {
        seen s;
        aset_sink sink = seen_sink(&s);
        s.answer = ASET_ERR_STOPPED;
        s.answer_at = at;
        assert_int_equal(aset_stage_emit(&sink, &low, &high, &o), ASET_ERR_STOPPED);
        assert_int_equal(s.n, at);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stage__is_where_the_rule_says),
        cmocka_unit_test(test_stage__no_options_and_no_ground),
        cmocka_unit_test(test_stage__every_corner_is_in_the_picture),
        cmocka_unit_test(test_stage__boxes_without_extent_have_a_view),
        cmocka_unit_test(test_stage__far_models_fill_the_picture),
        cmocka_unit_test(test_stage__refuses),
        cmocka_unit_test(test_stage__the_sinks_answer_ends_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
