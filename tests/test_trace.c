/*
 * test_trace.c - colours of simple scenes computed a second time, from Whitted's model as trace.h states it; which rays are
 * approximate and where they stop; cameras, formats and rows; pictures of MSET against those of brute force.
 */
#include "support/support.h"

#include "space/slices.h"

#define ROOM ((size_t)3 << 20)
#define PI 3.14159265358979323846
enum { SCRATCH_DEPTH = 24 };

static aset_vec3 real3(double x, double y, double z) {
    return dvec_real(dvec_make(x, y, z));
}

static dvec scaled(double s, dvec v) {
    return dvec_make(s * v.x, s * v.y, s * v.z);
}

/* --- a studio: a model, its space and summary, ready to be looked at --- */

typedef struct studio {
    model m;
    stage s;
    aset_space space;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
    aset_scratch scratch;
    aset_tracer tracer;
    aset_statistics statistics; /* of the last question */
} studio;

/* The model is made; builds the rest. n divisions on each axis. */
static void studio_open(studio *st, const aset_method *method, uint32_t n) {
    stage_open_model(&st->s, &st->m, ROOM);
    stage_space(&st->s, &st->space, method, n, n, n);
    assert_int_equal(aset_scratch_init(&st->scratch, SCRATCH_DEPTH, &st->s.arena), ASET_OK);
    st->tracer = stage_tracer(&st->s, &st->space);
#if ASET_WITH_APPROXIMATION
    assert_int_equal(aset_summary_build(&st->summary, &st->space, 0, &st->s.arena), ASET_OK);
    st->tracer.summary = &st->summary; /* approx_kinds is 0: every ray is exact */
#endif
}

static void studio_close(studio *st) {
    stage_close(&st->s);
    model_free(&st->m);
}

static dvec colour_of(studio *st, aset_vec3 origin, dvec direction) {
    aset_ray ray = {origin, dvec_real(direction), REAL_INFINITY};
    aset_colour c;
    memset(&st->statistics, 0, sizeof st->statistics);
    assert_int_equal(aset_ray_colour(&c, &st->tracer, &ray, &st->scratch, &st->statistics), ASET_OK);
    return dvec_make((double)c.r, (double)c.g, (double)c.b);
}

static void check_colour(dvec c, double r, double g, double b, double tolerance, const char *what) {
    check(fabs(c.x - r) <= tolerance && fabs(c.y - g) <= tolerance && fabs(c.z - b) <= tolerance,
          "%s: %.6f %.6f %.6f, not %.6f %.6f %.6f", what, c.x, c.y, c.z, r, g, b);
}

/* --- the functions that stand for libm's --- */

static void test_trace__power_and_tangent(void **state) {
    (void)state;
    for (int i = 0; i <= 1000; i++) {
        double base = i / 1000.0;
        static const double exponents[] = {0.5, 1, 2, 3.0827, 10, 33, 101.15, 1000, 100000};
        for (size_t k = 0; k < COUNT_OF(exponents); k++) {
            double exact = pow((double)(aset_real)base, (double)(aset_real)exponents[k]);
            double got = (double)aset_real_power((aset_real)base, (aset_real)exponents[k]);
            check(fabs(got - exact) <= 1.0 / 4096, "%g ^ %g is %g, not %g", base, exponents[k], got, exact);
        }
    }
    assert_true(aset_real_power(0, 0) == 1 && aset_real_power(R(0.3), 0) == 1 && aset_real_power(0, 2) == 0 &&
                aset_real_power(1, 9) == 1);
    assert_true(aset_real_power(R(1.0000002), 100000) == 1);
    for (int i = 0; i < 900; i++) {
        double angle = i / 10.0, exact = tan(angle * PI / 180);
        check(fabs((double)aset_real_tangent_deg((aset_real)angle) - exact) <= 2e-5 * (1 + exact * exact), "tan %g", angle);
    }
}

/* --- one sphere, one light --- */

#if ASET_WITH_SPHERES
static aset_material shiny(void) {
    aset_material m = plain_material();
    m.fill.r = R(0.8);
    m.fill.g = R(0.5);
    m.fill.b = R(0.25);
    m.diffuse = R(0.75);
    m.specular = R(0.5);
    m.shine = 20;
    return m;
}

/* Whitted's local colour, in double: n towards the viewer. One light of this intensity. */
static dvec whitted(const aset_material *m, dvec point, dvec n, dvec view, dvec light, double intensity) {
    dvec l = dvec_unit(dvec_sub(light, point));
    double n_l = dvec_dot(n, l), diffuse = 0, specular = 0;
    if (n_l > 0) {
        dvec mirrored = dvec_sub(scaled(2 * n_l, n), l);
        double r_v = -dvec_dot(mirrored, view);
        diffuse = (double)m->diffuse * n_l * intensity;
        specular = r_v > 0 ? (double)m->specular * pow(r_v, (double)m->shine) * intensity : 0;
    }
    return dvec_make((double)m->fill.r * (0.1 + diffuse) + specular, (double)m->fill.g * (0.1 + diffuse) + specular,
                     (double)m->fill.b * (0.1 + diffuse) + specular);
}

/* One shiny ball at the origin, no mirror images: depth 1. */
static void ball_studio(studio *st, const aset_vec3 *lights, uint32_t n_lights) {
    memset(st, 0, sizeof *st);
    model_start(&st->m);
    st->m.materials[0] = shiny();
    model_sphere(&st->m, real3(0, 0, 0), 1);
    for (uint32_t i = 0; i < n_lights; i++) {
        model_light(&st->m, lights[i]);
    }
    studio_open(st, &aset_mset, 3);
    st->tracer.depth = 1;
}

static void test_trace__background_and_ambient(void **state) {
    (void)state;
    studio st;
    ball_studio(&st, NULL, 0);
    st.s.scene.background.g = R(0.625);
    dvec c = colour_of(&st, real3(0, 0, 5), dvec_make(0, 1, 0));
    assert_true(c.x == 0 && c.y == 0.625 && c.z == 0);
    assert_true(st.statistics.primary == 1 && st.statistics.primary_hit == 0 && st.statistics.shadow == 0);
    c = colour_of(&st, real3(0, 0, 5), dvec_make(0, 0, -1));
    check_colour(c, 0.08, 0.05, 0.025, 1e-6, "ambient");
    assert_true(st.statistics.primary == 1 && st.statistics.primary_hit == 1);
    st.s.scene.materials[0].fill.r = 30; /* not clamped */
    c = colour_of(&st, real3(0, 0, 5), dvec_make(0, 0, -3));
    check_colour(c, 3, 0.05, 0.025, 1e-6, "ambient above 1");
    studio_close(&st);
}

static void test_trace__diffuse_and_highlight(void **state) {
    (void)state;
    random_state r = random_start(seed_of(1));
    uint32_t lit = 0, bright = 0;
    for (int i = 0; i < 400; i++) {
        studio st;
        double away = random_between(&r, 1.5, 20);
        dvec light = scaled(away, dvec_of(random_direction(&r)));
        aset_vec3 position = dvec_real(light);
        ball_studio(&st, &position, 1);
        dvec from = scaled(4, dvec_of(random_direction(&r))), view = dvec_unit(scaled(-1, from));
        dvec tilted = dvec_unit(dvec_along(view, 0.1, dvec_of(random_direction(&r))));
        double b = dvec_dot(from, tilted), t = -b - sqrt(b * b - dvec_dot(from, from) + 1);
        dvec point = dvec_along(from, t, tilted);
        dvec expected = whitted(&st.m.materials[0], point, point, tilted, light, 1);
        dvec c = colour_of(&st, dvec_real(from), tilted);
        double n_l = dvec_dot(point, dvec_unit(dvec_sub(light, point)));
        if (fabs(n_l) > 1e-3) { /* else the ball's own rounding decides about its shadow */
            check_colour(c, expected.x, expected.y, expected.z, 1e-3, "lit ball");
            check(st.statistics.shadow == (n_l > 0) && st.statistics.shadow_hit == 0, SEED ", case %d", r.seed, i);
        }
        lit += n_l > 0;
        bright += expected.z - 0.25 * (0.1 + 0.75 * fmax(n_l, 0)) > 0.05;
        studio_close(&st);
    }
    assert_true(lit > 100 && lit < 300 && bright > 3);
}

static void test_trace__lights_share_their_intensity(void **state) {
    (void)state;
    const aset_vec3 lights[4] = {{3, 0, 9}, {-3, 0, 9}, {0, 4, 9}, {1, -4, 9}};
    for (uint32_t n = 1; n <= 4; n++) {
        studio st;
        dvec sum = {0, 0, 0}, point = {0, 0, 1}, view = {0, 0, -1};
        ball_studio(&st, lights, n);
        for (uint32_t i = 0; i < n; i++) {
            dvec one = whitted(&st.m.materials[0], point, point, view, dvec_of(lights[i]), 1 / sqrt(n));
            sum = dvec_along(sum, 1, dvec_sub(one, dvec_make(0.08, 0.05, 0.025)));
        }
        dvec c = colour_of(&st, real3(0, 0, 5), view);
        check_colour(c, 0.08 + sum.x, 0.05 + sum.y, 0.025 + sum.z, 1e-3, "n lights");
        assert_int_equal(st.statistics.shadow, n);
        studio_close(&st);
    }
}

static void test_trace__coloured_and_directional_lights(void **state) {
    (void)state;
    studio st;
    dvec point = {0, 0, 1}, view = {0, 0, -1}, light = {3, 1, 9};
    memset(&st, 0, sizeof st);
    model_start(&st.m);
    st.m.materials[0] = shiny();
    model_sphere(&st.m, real3(0, 0, 0), 1);
    model_light(&st.m, dvec_real(light));
    model_light(&st.m, dvec_real(light));
    st.m.lights[0].has_colour = true;
    st.m.lights[0].colour.r = 2;
    st.m.lights[0].colour.b = R(0.5);
    studio_open(&st, &aset_mset, 2);
    st.tracer.depth = 1;
    /* the coloured one as it says, the other as the only one without a colour */
    dvec one = dvec_sub(whitted(&st.m.materials[0], point, point, view, light, 1), dvec_make(0.08, 0.05, 0.025));
    dvec c = colour_of(&st, real3(0, 0, 5), view);
    check_colour(c, 0.08 + 3 * one.x, 0.05 + one.y, 0.025 + 1.5 * one.z, 3e-3, "coloured light");
    studio_close(&st);
    static const double lengths[3] = {1, 1e-4, 1e6};
    for (int i = 0; i < 3; i++) {
        memset(&st, 0, sizeof st);
        model_start(&st.m);
        st.m.materials[0] = shiny();
        model_sphere(&st.m, real3(0, 0, 0), 1);
        model_light(&st.m, dvec_real(scaled(lengths[i], dvec_unit(dvec_make(1, 2, 2)))));
        st.m.lights[0].directional = true;
        studio_open(&st, &aset_mset, 2);
        st.tracer.depth = 1;
        dvec expected = whitted(&st.m.materials[0], point, point, view, scaled(1e9, dvec_make(1, 2, 2)), 1);
        c = colour_of(&st, real3(0, 0, 5), view);
        check_colour(c, expected.x, expected.y, expected.z, 1e-3, "directional light");
        studio_close(&st);
    }
}

/* Ambient alone if something stands between, whatever it lets through; not if it stands elsewhere on the line. */
static void test_trace__shadows(void **state) {
    (void)state;
    static const struct {
        double z;
        bool directional, dark;
    } cases[] = {{5, false, true}, {9.9, false, true}, {12, false, false}, {-3, false, false}, {12, true, true},
                 {500, true, true}, {-3, true, false}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        for (int glass = 0; glass <= ASET_WITH_REFRACTION; glass++) {
            studio st;
            memset(&st, 0, sizeof st);
            model_start(&st.m);
            st.m.materials[0].one_sided = true;
            model_light(&st.m, real3(0, 0, 10));
            st.m.lights[0].directional = cases[i].directional;
            model_sphere(&st.m, real3(0, 0, 0), 1);
            aset_material blocker = plain_material();
#if ASET_WITH_REFRACTION
            blocker.transmittance = (aset_real)glass;
#endif
            model_material(&st.m, &blocker);
            model_sphere(&st.m, real3(0, 0, cases[i].z), 0.05);
            studio_open(&st, &aset_mset, 4);
            dvec c = colour_of(&st, real3(3, 0, 1 + 3e-3), dvec_make(-1, 0, -1e-3));
            check(st.statistics.primary_hit == 1 && st.statistics.shadow == 1, "case %zu", i);
            check(st.statistics.shadow_hit == cases[i].dark, "case %zu", i);
            check((c.x < 0.1 + 1e-6) == cases[i].dark && c.x > 0.1 - 1e-6, "case %zu: %g", i, c.x);
            studio_close(&st);
        }
    }
}

#if ASET_WITH_POLYGONS
/* A light at the very point that is seen has no direction: it adds nothing. One at the end of the numbers has. */
static void test_trace__lights_at_the_point_and_far_away(void **state) {
    (void)state;
    static const double places[] = {0, 1e-20, 1e14};
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        studio st;
        memset(&st, 0, sizeof st);
        model_start(&st.m);
        model_light(&st.m, real3(0, 0, places[i]));
        model_rectangle(&st.m, real3(-1, -1, 0), real3(2, 0, 0), real3(0, 2, 0));
        studio_open(&st, &aset_mset, 2);
        dvec c = colour_of(&st, real3(0, 0, 4), dvec_make(0, 0, -1));
        check(st.statistics.primary_hit == 1 && st.statistics.shadow == (places[i] > 0), "place %g", places[i]);
        double lit = places[i] > 0 ? 0.6 : 0.1;
        check_colour(c, lit, lit, lit, 1e-5, "light");
        studio_close(&st);
    }
}
#else
#define test_trace__lights_at_the_point_and_far_away test_support__not_compiled
#endif
#endif

/* --- sides --- */

#if ASET_WITH_POLYGONS
/* Both sides of a two-sided polygon are lit, each from its own side; of a one-sided the front alone is there. */
static void test_trace__polygons_are_lit_on_the_side_that_is_seen(void **state) {
    (void)state;
    for (int one_sided = 0; one_sided < 2; one_sided++) {
        for (int light_up = 0; light_up < 2; light_up++) {
            studio st;
            memset(&st, 0, sizeof st);
            model_start(&st.m);
            st.m.materials[0].one_sided = one_sided;
            model_rectangle(&st.m, real3(-1, -1, 0), real3(2, 0, 0), real3(0, 2, 0));
            model_light(&st.m, real3(0, 0, light_up ? 7 : -7));
            studio_open(&st, &aset_mset, 2);
            dvec above = colour_of(&st, real3(0.25, 0.125, 3), dvec_make(0, 0, -1));
            check_colour(above, light_up ? 0.6 : 0.1, light_up ? 0.6 : 0.1, light_up ? 0.6 : 0.1, 2e-3, "from above");
            dvec below = colour_of(&st, real3(0.25, 0.125, -3), dvec_make(0, 0, 1));
            double expected = one_sided ? 0 : light_up ? 0.1 : 0.6;
            check_colour(below, expected, expected, expected, 2e-3, "from below");
            studio_close(&st);
        }
    }
}
#endif

/* --- mirrors --- */

#if ASET_WITH_SPHERES && ASET_WITH_POLYGONS && ASET_WITH_REFLECTION
/* An object that shows 0.1 of its fill and nothing else. */
static aset_material painted(double r, double g, double b) {
    aset_material m = plain_material();
    m.fill.r = (aset_real)r;
    m.fill.g = (aset_real)g;
    m.fill.b = (aset_real)b;
    m.diffuse = 0;
    return m;
}

static dvec random_downwards(random_state *r) {
    double x = random_between(r, -1, 1), y = random_between(r, -1, 1);
    return dvec_unit(dvec_make(x, y, -1));
}

static void test_trace__reflection_off_a_mirror(void **state) {
    (void)state;
    random_state r = random_start(seed_of(20));
    aset_material mirror = painted(0.5, 0, 0), ball = painted(0, 0, 5);
    mirror.specular = R(0.75);
    for (int i = 0; i < 50; i++) {
        studio st;
        dvec down = random_downwards(&r);
        dvec up = dvec_make(down.x, down.y, -down.z);
        memset(&st, 0, sizeof st);
        model_start(&st.m);
        model_material(&st.m, &mirror);
        model_rectangle(&st.m, real3(-4, -4, 0), real3(8, 0, 0), real3(0, 8, 0));
        model_material(&st.m, &ball);
        model_sphere(&st.m, dvec_real(scaled(2, up)), 0.02);
        st.m.background.g = 1;
        studio_open(&st, &aset_mset, 5);
        dvec c = colour_of(&st, dvec_real(scaled(-3, down)), down);
        check_colour(c, 0.05, 0, 0.75 * 0.5, 1e-5, "ball in the mirror");
        check(st.statistics.reflected == 1 && st.statistics.secondary_hit == 1, SEED, r.seed);
        c = colour_of(&st, real3(0.1 - 3 * down.x, -3 * down.y, -3 * down.z), down); /* a parallel ray passes the ball */
        check_colour(c, 0.05, 0.75, 0, 1e-5, "sky in the mirror");
        check(st.statistics.reflected == 1 && st.statistics.secondary_hit == 0, SEED, r.seed);
        st.tracer.depth = 1;
        c = colour_of(&st, dvec_real(scaled(-3, down)), down);
        check_colour(c, 0.05, 0, 0, 1e-5, "no reflection at depth 1");
        check(st.statistics.reflected == 0, SEED, r.seed);
        studio_close(&st);
    }
}

/* Between two mirrors a chain of depth rays adds a geometric series. */
static void test_trace__depth_ends_the_chain(void **state) {
    (void)state;
    studio st;
    aset_material mirror = painted(1, 2, 0);
    mirror.specular = R(0.5);
    memset(&st, 0, sizeof st);
    model_start(&st.m);
    model_material(&st.m, &mirror);
    model_rectangle(&st.m, real3(-50, -50, 0), real3(100, 0, 0), real3(0, 100, 0));
    model_rectangle(&st.m, real3(-50, -50, 1), real3(100, 0, 0), real3(0, 100, 0));
    st.m.background.b = 1;
    studio_open(&st, &aset_mset, 3);
    for (uint32_t depth = 0; depth <= SCRATCH_DEPTH; depth++) {
        uint32_t n = depth == 0 ? ASET_DEPTH_DEFAULT : depth;
        st.tracer.depth = depth;
        dvec c = colour_of(&st, real3(0, 0, 0.5), dvec_make(0.1, 0.2, 1));
        double sum = 0.2 * (1 - pow(0.5, n));
        check_colour(c, sum, 2 * sum, 0, 1e-5, "between mirrors");
        check(st.statistics.reflected == n - 1, "depth %" PRIu32, depth);
        check(st.statistics.secondary_hit == n - 1, "depth %" PRIu32, depth);
    }
    studio_close(&st);
}
#endif

/* --- glass --- */

#if ASET_WITH_SPHERES && ASET_WITH_POLYGONS && ASET_WITH_REFRACTION && ASET_WITH_REFLECTION
/* Snell's law in double; n against d; false: total reflection. */
static bool snell(dvec d, dvec n, double ratio, dvec *out) {
    double c = -dvec_dot(d, n), root = 1 - ratio * ratio * (1 - c * c);
    if (root < 0) {
        return false;
    }
    *out = dvec_unit(dvec_along(scaled(ratio, d), ratio * c - sqrt(root), n));
    return true;
}

static aset_material glass(double transmittance, double index) {
    aset_material m = painted(1, 0, 0);
    m.transmittance = (aset_real)transmittance;
    m.refraction_index = (aset_real)index;
    return m;
}

/* A slab from z = 0 to 1, its faces turned outwards, and a small ball where the ray should go. */
static void slab_studio(studio *st, double transmittance, double index, dvec ball) {
    aset_material material = glass(transmittance, index), paint = painted(0, 0, 10);
    memset(st, 0, sizeof *st);
    model_start(&st->m);
    model_material(&st->m, &material);
    model_rectangle(&st->m, real3(-20, -20, 1), real3(40, 0, 0), real3(0, 40, 0));
    model_rectangle(&st->m, real3(-20, -20, 0), real3(0, 40, 0), real3(40, 0, 0));
    model_material(&st->m, &paint);
    model_sphere(&st->m, dvec_real(ball), 0.02);
    st->m.background.g = 1;
    studio_open(st, &aset_mset, 6);
}

static void test_trace__refraction_through_a_slab(void **state) {
    (void)state;
    random_state r = random_start(seed_of(30));
    for (int i = 0; i < 60; i++) {
        double index = i % 3 == 0 ? 0 : random_between(&r, 1.1, 2.4), ratio = index > 0 ? 1 / index : 1;
        dvec down = random_downwards(&r), inside;
        assert_true(snell(down, dvec_make(0, 0, 1), ratio, &inside));
        dvec exit = dvec_along(dvec_make(0, 0, 1), -1 / inside.z, inside);
        studio st;
        slab_studio(&st, 0.5, index, dvec_along(exit, 2, down)); /* it comes out as it went in, but moved */
        aset_vec3 origin = dvec_real(dvec_along(dvec_make(0, 0, 1), -3, down));
        dvec c = colour_of(&st, origin, down);
        check_colour(c, 0.1 * (1 + 0.5), 0, 0.25 * 1, 1e-4, "ball behind the slab");
        check(st.statistics.refracted == 2 && st.statistics.reflected == 0, SEED ", case %d", r.seed, i);
        st.tracer.depth = 2;
        c = colour_of(&st, origin, down);
        check_colour(c, 0.1 * (1 + 0.5), 0, 0, 1e-4, "depth 2");
        studio_close(&st);
        if (index > 1.3 && down.z > -0.9) { /* not where it would go without bending */
            slab_studio(&st, 0.5, index, dvec_along(dvec_make(0, 0, 1), 2 - 1 / down.z, down));
            c = colour_of(&st, origin, down);
            check_colour(c, 0.1 * (1 + 0.5), 0.25, 0, 1e-4, "sky behind the slab");
            studio_close(&st);
        }
    }
}

/* Straight in and out, by an index whose last digit is above 1: sum and difference of the directions cancel to nothing. */
static void test_trace__refraction_beyond_the_digits(void **state) {
    (void)state;
    const double indices[] = {4 / (double)REAL_UNIT, (double)REAL_UNIT / 4};
    for (size_t i = 0; i < COUNT_OF(indices); i++) {
        studio st;
        slab_studio(&st, 0.5, indices[i], dvec_make(0, 0, -2));
        dvec c = colour_of(&st, real3(0, 0, 3), dvec_make(0, 0, -1));
        check_colour(c, 0.1 * (1 + 0.5), 0, 0.25 * 1, 1e-4, "ball behind the slab");
        studio_close(&st);
    }
}

static void test_trace__refraction_through_a_ball(void **state) {
    (void)state;
    random_state r = random_start(seed_of(31));
    for (int i = 0; i < 60; i++) {
        double index = random_between(&r, 1.1, 2);
        dvec from = scaled(4, dvec_of(random_direction(&r)));
        dvec d = dvec_unit(dvec_along(scaled(-1, from), 0.8, dvec_of(random_direction(&r)))), inside, out;
        double b = dvec_dot(from, d), under_root = b * b - dvec_dot(from, from) + 1;
        if (under_root < 0.1) {
            continue;
        }
        dvec entry = dvec_along(from, -b - sqrt(under_root), d);
        assert_true(snell(d, entry, 1 / index, &inside));
        dvec exit = dvec_along(entry, -2 * dvec_dot(entry, inside), inside);
        assert_true(snell(inside, scaled(-1, exit), index, &out));
        studio st;
        aset_material material = glass(0.75, index), paint = painted(0, 0, 10);
        memset(&st, 0, sizeof st);
        model_start(&st.m);
        model_material(&st.m, &material);
        model_sphere(&st.m, real3(0, 0, 0), 1);
        model_material(&st.m, &paint);
        model_sphere(&st.m, dvec_real(dvec_along(exit, 3, out)), 0.02);
        studio_open(&st, &aset_mset, 5);
        dvec c = colour_of(&st, dvec_real(from), d);
        check_colour(c, 0.1 * 1.75, 0, 0.75 * 0.75, 1e-4, "ball behind the ball");
        check(st.statistics.refracted == 2, SEED ", case %d", r.seed, i);
        studio_close(&st);
    }
}

static void test_trace__total_internal_reflection(void **state) {
    (void)state;
    const double critical = asin(1 / 1.5) * 180 / PI;
    for (int above = 0; above < 2; above++) {
        double angle = (critical + (above ? 1 : -1)) * PI / 180;
        dvec up = dvec_make(sin(angle), 0, cos(angle));
        studio st;
        slab_studio(&st, 0.5, 1.5, dvec_make(0, 19, 9));
        dvec c = colour_of(&st, real3(0, 0, 0.5), up);
        assert_int_equal(st.statistics.refracted, above ? 0 : 1);
        assert_int_equal(st.statistics.reflected, 0);
        check_colour(c, 0.1, above ? 0 : 0.5, 0, 1e-5, "inside the slab");
        st.tracer.spd_rules = true; /* the reflected ray is sent, though it weighs nothing */
        c = colour_of(&st, real3(0, 0, 0.5), up);
        check_colour(c, 0.1, above ? 0 : 0.5, 0, 1e-5, "inside the slab");
        assert_true(above ? st.statistics.refracted == 0 && st.statistics.reflected == 4
                          : st.statistics.refracted == 4 && st.statistics.reflected == 4);
        studio_close(&st);
        aset_material material = glass(0.5, 1.5);
        material.specular = R(0.5);
        slab_studio(&st, 0.5, 1.5, dvec_make(0, 19, 9));
        st.s.scene.materials[0] = material;
        c = colour_of(&st, real3(0, 0, 0.5), up);
        if (above) { /* it stays in the slab, halved each time, until the depth is used up */
            check_colour(c, 0.1 * (1 + 0.5 + 0.25 + 0.125 + 0.0625), 0, 0, 1e-5, "to and fro");
            assert_true(st.statistics.reflected == 4 && st.statistics.refracted == 0);
        }
        studio_close(&st);
    }
}
#endif

#if ASET_WITH_REFLECTION && ASET_WITH_SPHERES
/* Between two mirrors that give back far more than they get: much light, but a number. */
static void test_trace__mirrors_that_amplify(void **state) {
    (void)state;
    const double most = sqrt((double)REAL_MAX), amounts[] = {2, most / 4, most * 4, (double)REAL_MAX};
    for (size_t i = 0; i < COUNT_OF(amounts); i++) {
        studio st;
        aset_material material = painted(0, 0, 0);
        material.specular = (aset_real)amounts[i];
        memset(&st, 0, sizeof st);
        model_start(&st.m);
        model_material(&st.m, &material);
        model_sphere(&st.m, real3(0, 0, 0), 1);
        model_sphere(&st.m, real3(0, 0, 4), 1);
        st.m.background.g = 1;
        studio_open(&st, &aset_mset, 5);
        dvec c = colour_of(&st, real3(0, 0, 2), dvec_unit(dvec_make(0, 0.1, 1)));
        check(st.statistics.reflected == 4 || st.statistics.secondary_hit < st.statistics.reflected, "amount %g", amounts[i]);
        check(c.x == 0 && c.z == 0 && c.y >= 0, "amount %g: %g %g %g", amounts[i], c.x, c.y, c.z);
        studio_close(&st);
    }
}
#endif

/* --- queries --- */

/* Towards the origin. */
static aset_view view_from(double x, double y, double z) {
    aset_view view;
    memset(&view, 0, sizeof view);
    view.from = real3(x, y, z);
    view.up.z = 1;
    view.angle_deg = 50;
    return view;
}

static void random_studio(studio *st, uint64_t seed, uint32_t n_things, const aset_method *method, uint32_t n) {
    random_state r = random_start(seed);
    memset(st, 0, sizeof *st);
    model_random(&st->m, &r, n_things, 4, 1, 5);
    studio_open(st, method, n);
}

static void test_trace__t_counts_in_lengths_of_the_direction(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(40), 40, &aset_mset, 6);
    random_state r = random_start(seed_of(41));
    uint32_t hits = 0;
    for (int i = 0; i < 500; i++) {
        aset_ray ray = random_ray_from(&r, 5);
        aset_hit hit, other;
        bool found, again;
        assert_int_equal(aset_closest_hit(&found, &hit, &st.tracer, &ray, false, NULL), ASET_OK);
        static const double lengths[] = {0.25, 1024, 1.0 / 1048576, 1125899906842624.0, 1.0 / 1180591620717411303424.0};
        for (size_t k = 0; k < COUNT_OF(lengths); k++) {
            aset_ray longer = ray;
            longer.direction = dvec_real(scaled(lengths[k], dvec_of(ray.direction)));
            longer.t_max = found ? (aset_real)(1.001 * (double)hit.t / lengths[k]) : REAL_INFINITY;
            assert_int_equal(aset_closest_hit(&again, &other, &st.tracer, &longer, false, NULL), ASET_OK);
            check(found == again && (!found || fabs((double)other.t * lengths[k] / (double)hit.t - 1) < 1e-3),
                  SEED ", ray %d", r.seed, i);
            longer.t_max = found ? (aset_real)(0.999 * (double)hit.t / lengths[k]) : 0;
            assert_int_equal(aset_any_hit(&again, &st.tracer, &longer, false, NULL), ASET_OK);
            check(!again, SEED ", ray %d", r.seed, i);
        }
        hits += found;
    }
    check(hits > 20, "%" PRIu32, hits);
    studio_close(&st);
}

static void test_trace__queries_refuse_bad_rays(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(50), 5, &aset_mset, 2);
    const aset_ray good = {{9, 9, 9}, {-1, -1, -1}, REAL_INFINITY};
    const aset_real bad[3] = {REAL_INFINITY, -REAL_INFINITY, (aset_real)NAN};
    aset_hit hit, before;
    aset_colour colour;
    bool found = true;
    memset(&hit, 0x3c, sizeof hit);
    before = hit;
    for (int i = 0; i < 22; i++) {
        aset_ray ray = good;
        aset_real *const fields[6] = {&ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.direction.x, &ray.direction.y,
                                      &ray.direction.z};
        if (i < 18) {
            *fields[i / 3] = bad[i % 3];
        } else if (i == 18) {
            ray.t_max = (aset_real)NAN;
        } else {
            ray.direction = real3(0, i == 20 ? -0.0 : 0.0, 0);
        }
        assert_int_equal(aset_closest_hit(&found, &hit, &st.tracer, &ray, false, NULL), ASET_ERR_ARGUMENT);
        assert_int_equal(aset_any_hit(&found, &st.tracer, &ray, false, NULL), ASET_ERR_ARGUMENT);
        if (i != 18) {
            assert_int_equal(aset_ray_colour(&colour, &st.tracer, &ray, &st.scratch, NULL), ASET_ERR_ARGUMENT);
        }
    }
    aset_tracer none = st.tracer;
    none.scene = NULL;
    assert_int_equal(aset_closest_hit(&found, &hit, &none, &good, false, NULL), ASET_ERR_ARGUMENT);
    none = st.tracer;
    none.space = NULL;
    assert_int_equal(aset_any_hit(&found, &none, &good, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_ray_colour(&colour, &none, &good, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(NULL, &hit, &st.tracer, &good, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(&found, NULL, &st.tracer, &good, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(&found, &hit, NULL, &good, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(&found, &hit, &st.tracer, NULL, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_any_hit(NULL, &st.tracer, &good, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_ray_colour(NULL, &st.tracer, &good, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_ray_colour(&colour, &st.tracer, NULL, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_ray_colour(&colour, &st.tracer, &good, NULL, NULL), ASET_ERR_ARGUMENT);
    st.tracer.depth = SCRATCH_DEPTH + 1;
    assert_int_equal(aset_ray_colour(&colour, &st.tracer, &good, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    st.tracer.depth = SCRATCH_DEPTH;
    assert_int_equal(aset_ray_colour(&colour, &st.tracer, &good, &st.scratch, NULL), ASET_OK);
    assert_memory_equal(&hit, &before, sizeof hit);
#if ASET_WITH_APPROXIMATION
    st.tracer.summary = NULL;
#endif
    assert_int_equal(aset_closest_hit(&found, &hit, &st.tracer, &good, true, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_any_hit(&found, &st.tracer, &good, true, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(&found, &hit, &st.tracer, &good, false, NULL), ASET_OK);
    studio_close(&st);
}

/* --- approximate rays --- */

#if ASET_WITH_APPROXIMATION
/* The crossing of slice k of axis a; whether the side met there is marked; undecided near the corners of voxels. */
static bool side_at(const studio *st, const aset_ray *ray, int a, int32_t k, double *t, uint32_t *cell, bool *undecided) {
    const double o[3] = {(double)ray->origin.x, (double)ray->origin.y, (double)ray->origin.z};
    const double d[3] = {(double)ray->direction.x, (double)ray->direction.y, (double)ray->direction.z};
    const aset_slices *slices = &st->space.slices;
    int32_t voxel[3];
    *t = ((double)slices_plane(slices, a, k) - o[a]) / d[a];
    *undecided = false;
    for (int b = 0; b < 3; b++) {
        double at = (o[b] + *t * d[b] - (double)slices->low[b]) / (double)slices->width[b];
        if (b == a) {
            voxel[b] = d[a] > 0 ? k : k - 1;
        } else {
            *undecided = *undecided || fabs(at - floor(at + 0.5)) < 1e-3;
            voxel[b] = (int32_t)floor(at);
        }
        if (voxel[b] < 0 || voxel[b] >= (int32_t)slices->n[b]) {
            return false;
        }
    }
    *cell = cell_number(&st->space, voxel, (uint32_t)a * 2 + (d[a] < 0));
    return *cell != UINT32_MAX;
}

/* The first marked side at t > 0, found by trying all crossings. */
static double first_side(const studio *st, const aset_ray *ray, uint32_t *cell, int *axis, bool *undecided) {
    double first = HUGE_VAL;
    bool doubt = false;
    dvec d = dvec_of(ray->direction);
    *undecided = fmin(fabs(d.x), fmin(fabs(d.y), fabs(d.z))) < 0.02; /* nearly in a slice */
    for (int a = 0; a < 3; a++) {
        for (int32_t k = 0; k <= (int32_t)st->space.slices.n[a]; k++) {
            double t;
            uint32_t here;
            bool marked = side_at(st, ray, a, k, &t, &here, &doubt);
            *undecided = *undecided || doubt || fabs(t) < 1e-3;
            if (marked && t > 0 && t < first) {
                first = t;
                *cell = here;
                *axis = a;
            }
        }
    }
    return first;
}

static void check_approximate_ray(studio *st, const aset_ray *ray, uint64_t seed, uint32_t *compared, uint32_t *hits) {
    aset_statistics statistics;
    aset_hit hit;
    uint32_t cell = 0;
    int axis = 0;
    bool found, any, undecided;
    double t = first_side(st, ray, &cell, &axis, &undecided);
    memset(&statistics, 0, sizeof statistics);
    assert_int_equal(aset_closest_hit(&found, &hit, &st->tracer, ray, true, &statistics), ASET_OK);
    assert_int_equal(aset_any_hit(&any, &st->tracer, ray, true, &statistics), ASET_OK);
    check(any == found && statistics.tests == 0 && statistics.approx_hits == 2u * found, SEED, seed);
    if (found) {
        aset_ray shorter = *ray;
        shorter.t_max = (aset_real)((double)hit.t * 0.999);
        assert_int_equal(aset_any_hit(&any, &st->tracer, &shorter, true, NULL), ASET_OK);
        check(!any, SEED, seed);
        shorter.t_max = (aset_real)((double)hit.t * 1.001);
        assert_int_equal(aset_any_hit(&any, &st->tracer, &shorter, true, NULL), ASET_OK);
        check(any, SEED, seed);
    }
    if (undecided) {
        return;
    }
    ++*compared;
    check(found == (t < HUGE_VAL), SEED ", at %g", seed, t);
    if (found) {
        dvec normal = dvec_of(hit.geometric), direction = dvec_of(ray->direction);
        ++*hits;
        check(fabs((double)hit.t - t) < 5e-4 && hit.t > 0, SEED ": %g, not %g", seed, (double)hit.t, t);
        check(hit.object == ASET_NO_OBJECT && hit.cell == cell, SEED, seed);
        check(hit.material >= st->summary.textures && hit.material < st->summary.textures + st->summary.n_textures, SEED,
              seed);
        check(dvec_length(normal) == 1 && dvec_dot(normal, direction) < 0, SEED, seed);
        check(fabs(axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) == 1, SEED, seed);
        check(memcmp(&hit.normal, &hit.geometric, sizeof hit.normal) == 0, SEED, seed);
        check(dvec_length(dvec_sub(dvec_of(hit.point), dvec_along(dvec_of(ray->origin), t, direction))) < 5e-4, SEED, seed);
    }
}

/* From outside, and from inside, where the sides of the origin's own box and those behind are ignored. */
static void test_trace__approximate_rays_stop_at_the_first_marked_side(void **state) {
    (void)state;
    uint32_t compared = 0, hits = 0;
    for (uint64_t i = 0; i < 4; i++) {
        studio st;
        random_studio(&st, seed_of(60 + i), 4 + 4 * (uint32_t)i, &aset_mset, 9);
        random_state r = random_start(seed_of(70 + i));
        for (int k = 0; k < 1000; k++) {
            aset_ray ray = random_ray_from(&r, k % 2 == 0 ? 5 : 14);
            if (k % 2 == 1) {
                ray.direction = dvec_real(dvec_unit(dvec_sub(dvec_of(random_in_cube(&r, 5)), dvec_of(ray.origin))));
            }
            check_approximate_ray(&st, &ray, r.seed, &compared, &hits);
        }
        studio_close(&st);
    }
    assert_true(compared > 2500 && hits > 1000 && hits < compared);
}

/* Which rays are exact is seen from the tests: brute force makes one for every object and exact ray. */
static void check_policy(studio *st, const aset_picture *picture, const aset_view *view, uint32_t kinds, uint32_t level,
                         const aset_statistics *below) {
    aset_statistics s;
    memset(&s, 0, sizeof s);
    st->tracer.approx_kinds = kinds;
    st->tracer.approx_depth = level;
    st->tracer.depth = 4;
    assert_int_equal(aset_render_rows(&st->tracer, view, picture, 0, picture->height, &st->scratch, &s), ASET_OK);
    const uint64_t all[4] = {s.primary, s.shadow, s.reflected, s.refracted};
    const uint64_t before[4] = {below->primary, below->shadow, below->reflected, below->refracted};
    uint64_t exact = 0, approximate = 0;
    for (int i = 0; i < 4; i++) {
        assert_true(all[i] >= before[i]);
        exact += before[i] + ((kinds >> i & 1) != 0 ? 0 : all[i] - before[i]);
        approximate += (kinds >> i & 1) != 0 ? all[i] - before[i] : 0;
    }
    check(s.tests == exact * st->s.scene.counts.objects, "kinds %" PRIu32 " from %" PRIu32 ": %" PRIu64 " tests, %" PRIu64
          " exact rays", kinds, level, s.tests, exact);
    check(s.approx_hits <= approximate, "kinds %" PRIu32 " from %" PRIu32, kinds, level);
    check(kinds != ASET_ALL_KINDS || level > 0 || (s.tests == 0 && s.approx_hits > 0), "all");
}

static void test_trace__kinds_and_depth_decide_which_rays_are_approximate(void **state) {
    (void)state;
    studio st;
    unsigned char pixels[12 * 12 * 3];
    aset_view view = view_from(14, 5, 4);
    aset_picture picture = {12, 12, ASET_RGB888, pixels, 36, false, NULL, NULL};
    random_studio(&st, seed_of(80), 30, &aset_brute, 1);
    for (uint32_t i = 0; i < st.s.scene.counts.materials; i++) {
        st.s.scene.materials[i].specular = R(0.5);
        st.s.scene.materials[i].one_sided = false;
#if ASET_WITH_REFRACTION
        st.s.scene.materials[i].transmittance = i % 2 == 0 ? R(0.5) : 0;
#endif
    }
    for (uint32_t level = 0; level <= 4; level++) {
        aset_statistics below; /* rays of lesser depth are exact whatever the kinds, so always the same */
        memset(&below, 0, sizeof below);
        st.tracer.approx_kinds = 0;
        st.tracer.depth = level;
        if (level > 0) {
            assert_int_equal(aset_render_rows(&st.tracer, &view, &picture, 0, 12, &st.scratch, &below), ASET_OK);
            assert_true(below.approx_hits == 0 && below.shadow > 0);
            assert_true(level < 2 || !ASET_WITH_REFLECTION || below.reflected > 0);
        }
        for (uint32_t kinds = 0; kinds <= ASET_ALL_KINDS; kinds++) {
            check_policy(&st, &picture, &view, kinds, level, &below);
        }
    }
    studio_close(&st);
}

/* Without a summary every ray is exact, whatever is asked for. */
static void test_trace__without_a_summary_every_ray_is_exact(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(90), 20, &aset_brute, 1);
    st.tracer.approx_kinds = ASET_ALL_KINDS;
    st.tracer.summary = NULL;
    colour_of(&st, real3(14, 5, 4), dvec_make(-14, -5, -4));
    assert_true(st.statistics.approx_hits == 0);
    assert_true(st.statistics.tests == 20 * (st.statistics.primary + st.statistics.shadow + st.statistics.reflected +
                                             st.statistics.refracted));
    studio_close(&st);
}

static double voxel_diagonal(const studio *st) {
    dvec span = dvec_sub(dvec_of(st->s.scene.high), dvec_of(st->s.scene.low));
    const uint32_t *n = st->space.slices.n;
    return dvec_length(dvec_make(span.x / n[0], span.y / n[1], span.z / n[2]));
}

/* Less than the fraction of the diagonal, or more: then there is no hit, and it is counted as curtailed, not as a hit. */
static void test_trace__curtailed_rays(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(100), 25, &aset_mset, 8);
    random_state r = random_start(seed_of(101));
    double diagonal = voxel_diagonal(&st);
    uint32_t n[2] = {0, 0};
    for (int i = 0; i < 1500; i++) {
        aset_ray ray = random_ray_from(&r, 6);
        aset_hit hit;
        bool found, still, any;
        double share = random_between(&r, 0.05, 1.5);
        bool more = random_chance(&r, 0.5);
        st.tracer.curtail = 0;
        st.tracer.curtail_more = more; /* without a fraction it means nothing */
        assert_int_equal(aset_closest_hit(&found, &hit, &st.tracer, &ray, true, NULL), ASET_OK);
        if (!found || fabs((double)hit.t - share * diagonal) < 1e-3) {
            continue;
        }
        aset_statistics s;
        memset(&s, 0, sizeof s);
        st.tracer.curtail = (aset_real)share;
        bool curtailed = more ? (double)hit.t > share * diagonal : (double)hit.t < share * diagonal;
        assert_int_equal(aset_closest_hit(&still, &hit, &st.tracer, &ray, true, &s), ASET_OK);
        check(still == !curtailed && s.curtailed == curtailed, SEED ", ray %d", r.seed, i);
        check(s.approx_hits == !curtailed, SEED ", ray %d: a curtailed ray takes no texture", r.seed, i);
        assert_int_equal(aset_any_hit(&any, &st.tracer, &ray, true, NULL), ASET_OK);
        check(any == still, SEED ", ray %d", r.seed, i);
        assert_int_equal(aset_closest_hit(&still, &hit, &st.tracer, &ray, false, &s), ASET_OK);
        check(s.curtailed == curtailed, SEED ", ray %d: an exact ray is never curtailed", r.seed, i);
        n[curtailed]++;
    }
    assert_true(n[0] > 100 && n[1] > 100);
    studio_close(&st);
}

/* A curtailed eye ray returns the background, a curtailed shadow ray lets the light through. */
static void test_trace__curtailed_rays_return_background_or_light(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(110), 25, &aset_mset, 8);
    st.tracer.approx_kinds = ASET_PRIMARY;
    st.tracer.curtail = R(1e-6);
    st.tracer.curtail_more = true; /* everything */
    dvec c = colour_of(&st, real3(14, 5, 4), dvec_make(-14, -5, -4));
    assert_true(c.x == 0 && c.y == 0 && c.z == 0.5);
    assert_true(st.statistics.curtailed == 1 && st.statistics.primary_hit == 0);
    st.tracer.approx_kinds = ASET_SHADOW;
    uint64_t shadow = 0;
    random_state r = random_start(seed_of(111));
    for (int i = 0; i < 200; i++) {
        dvec from = scaled(15, dvec_of(random_direction(&r)));
        colour_of(&st, dvec_real(from), scaled(-1, from));
        assert_int_equal(st.statistics.shadow_hit, 0);
        shadow += st.statistics.curtailed;
    }
    check(shadow > 20, "%" PRIu64, shadow);
    studio_close(&st);
}

#if ASET_WITH_SPHERES
/* The colour where an approximate ray stops: the texture, lit as a face of the slice. */
static void test_trace__approximate_colour_is_the_lit_texture(void **state) {
    (void)state;
    studio st;
    memset(&st, 0, sizeof st);
    model_start(&st.m);
    st.m.materials[0] = shiny();
    model_sphere(&st.m, real3(0, 0, 0), 1);
    model_light(&st.m, real3(2, 3, 9));
    studio_open(&st, &aset_mset, 1);
    st.tracer.depth = 1;
    st.tracer.approx_kinds = ASET_PRIMARY;
    st.tracer.approx_depth = 0;
    dvec from = {0.5, 0.25, 6}, view = dvec_unit(dvec_make(0.05, 0.1, -1));
    dvec point = dvec_along(from, (1 - from.z) / view.z, view);
    dvec expected = whitted(&st.m.materials[0], point, dvec_make(0, 0, 1), view, dvec_make(2, 3, 9), 1);
    dvec c = colour_of(&st, dvec_real(from), view);
    check_colour(c, expected.x, expected.y, expected.z, 1e-3, "top of the ball's box");
    assert_true(st.statistics.approx_hits == 1 && st.statistics.tests <= 1 && st.statistics.shadow == 1);
    st.tracer.approx_kinds = ASET_PRIMARY | ASET_SHADOW; /* from the box's face upwards nothing is met */
    c = colour_of(&st, dvec_real(from), view);
    check_colour(c, expected.x, expected.y, expected.z, 1e-3, "with an approximate shadow ray");
    assert_true(st.statistics.tests == 0 && st.statistics.shadow == 1 && st.statistics.shadow_hit == 0);
    studio_close(&st);
}
#endif
#endif

/* --- pictures --- */

static unsigned char byte_of(double x) {
    return (unsigned char)((x > 0 ? x < 1 ? x : 1 : 0) * 255 + 0.5);
}

static aset_picture picture_of(uint32_t width, uint32_t height, aset_format format) {
    aset_picture p;
    memset(&p, 0, sizeof p);
    p.width = width;
    p.height = height;
    p.format = format;
    p.stride = (width + 1) * aset_format_bytes(format);
    p.pixels = calloc(p.stride, height + 1); /* room for the rules of the SPD too */
    assert_non_null(p.pixels);
    return p;
}

/* The whole picture; counts into st->statistics. */
static void draw(studio *st, const aset_view *view, const aset_picture *p) {
    uint32_t rows = p->height + st->tracer.spd_rules;
    memset(&st->statistics, 0, sizeof st->statistics);
    assert_int_equal(aset_render_rows(&st->tracer, view, p, 0, rows, &st->scratch, &st->statistics), ASET_OK);
}

/* The eye ray through (x, y), in pixels from the upper left corner, by a camera of our own. */
static aset_ray eye_ray(const aset_view *view, double width, double height, double x, double y) {
    dvec forward = dvec_unit(dvec_sub(dvec_of(view->at), dvec_of(view->from)));
    dvec right = dvec_unit(dvec_cross(forward, dvec_of(view->up))), up = dvec_cross(right, forward);
    double half = view->height > 0 ? (double)view->height / 2 : tan((double)view->angle_deg * PI / 360);
    double across = (2 * x - width) / height * half, above = (height - 2 * y) / height * half;
    dvec offset = dvec_along(scaled(across, right), above, up), from = dvec_of(view->from);
    aset_ray ray = {view->from, dvec_real(dvec_along(forward, 1, offset)), REAL_INFINITY};
    if (view->height > 0) {
        ray.origin = dvec_real(dvec_along(from, 1, offset));
        ray.direction = dvec_real(forward);
    }
    return ray;
}

/* How many pixels differ by more than 1 from rays of our own, of samples x samples a pixel, shifted by so many pixels. */
static uint32_t differing(studio *st, const aset_view *view, const aset_picture *p, uint32_t columns, uint32_t rows,
                          uint32_t samples, double shift) {
    uint32_t n = 0;
    for (uint32_t k = 0; k < columns * rows; k++) {
        double sum[3] = {0};
        for (uint32_t i = 0; i < samples * samples; i++) {
            double x = k % columns + shift + (i % samples + 0.5) / samples;
            double y = k / columns + shift + (i / samples + 0.5) / samples;
            aset_ray ray = eye_ray(view, p->width, p->height, x, y);
            dvec c = colour_of(st, ray.origin, dvec_of(ray.direction));
            sum[0] += fmin(c.x, 1);
            sum[1] += fmin(c.y, 1);
            sum[2] += fmin(c.z, 1);
        }
        const unsigned char *pixel = (unsigned char *)p->pixels + k / columns * p->stride + k % columns * 3;
        bool same = true;
        for (int c = 0; c < 3; c++) {
            same = same && abs(byte_of(sum[c] / (samples * samples)) - pixel[c]) <= 1;
        }
        n += !same;
    }
    return n;
}

static aset_view random_view(random_state *r, bool orthographic) {
    aset_view view;
    memset(&view, 0, sizeof view);
    double away = random_between(r, 9, 15), length = random_between(r, 0.1, 10);
    view.from = dvec_real(scaled(away, dvec_of(random_direction(r))));
    view.at = random_in_cube(r, 2);
    view.up = dvec_real(scaled(length, dvec_of(random_direction(r))));
    view.angle_deg = (aset_real)random_between(r, 20, 90);
    view.height = orthographic ? (aset_real)random_between(r, 4, 12) : 0;
    return view;
}

static void test_trace__cameras(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(200), 40, &aset_mset, 6);
    random_state r = random_start(seed_of(201));
    st.tracer.depth = 1;
    for (int i = 0; i < 12; i++) {
        aset_view view = random_view(&r, i % 2 == 1);
        aset_picture p = picture_of(i % 3 == 0 ? 40 : 25, i % 3 == 1 ? 40 : 30, ASET_RGB888);
        draw(&st, &view, &p);
        check(st.statistics.primary == p.width * p.height && st.statistics.primary_hit > 50, SEED ", view %d", r.seed, i);
        uint32_t n = differing(&st, &view, &p, p.width, p.height, 1, 0);
        check(n * 50 < p.width * p.height, SEED ", view %d: %" PRIu32 " pixels differ", r.seed, i, n); /* edges */
        free(p.pixels);
    }
    studio_close(&st);
}

static void test_trace__samples_and_corner_rays(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(210), 40, &aset_mset, 6);
    random_state r = random_start(seed_of(211));
    st.tracer.depth = 1;
    st.s.scene.background.b = 3; /* each sample is clamped before the mean */
    for (int i = 0; i < 4; i++) {
        uint32_t samples = (uint32_t)i + 1;
        aset_view view = random_view(&r, false);
        aset_picture p = picture_of(24, 20, ASET_RGB888);
        st.tracer.samples = samples;
        draw(&st, &view, &p);
        check(st.statistics.primary == 24 * 20 * samples * samples, SEED, r.seed);
        uint32_t n = differing(&st, &view, &p, 24, 20, samples, 0);
        check(n * 25 < 24 * 20, SEED ", %" PRIu32 " samples: %" PRIu32 " pixels differ", r.seed, samples, n);
        st.tracer.samples = 0;
        st.tracer.spd_rules = true;
        draw(&st, &view, &p);
        check(st.statistics.primary == 25 * 21, SEED, r.seed);
        n = differing(&st, &view, &p, 25, 21, 1, -0.5);
        check(n * 25 < 24 * 20, SEED ", corners: %" PRIu32 " pixels differ", r.seed, n);
        st.tracer.spd_rules = false;
        free(p.pixels);
    }
    studio_close(&st);
}

static void test_trace__formats(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(220), 30, &aset_mset, 6);
    aset_view view = view_from(12, 5, 4);
    aset_picture rgb = picture_of(30, 20, ASET_RGB888), rgba = picture_of(30, 20, ASET_RGBA8888);
    aset_picture grey = picture_of(30, 20, ASET_GREY8), packed = picture_of(30, 20, ASET_RGB565);
    assert_true(aset_format_bytes(ASET_RGB888) == 3 && aset_format_bytes(ASET_RGBA8888) == 4);
    assert_true(aset_format_bytes(ASET_GREY8) == 1 && aset_format_bytes(ASET_RGB565) == 2);
    draw(&st, &view, &rgb);
    draw(&st, &view, &rgba);
    draw(&st, &view, &grey);
    draw(&st, &view, &packed);
    uint32_t n_clear = 0, n_wrong = 0;
    for (uint32_t k = 0; k < 600; k++) {
        size_t row = k / 30, column = k % 30;
        const unsigned char *c = (unsigned char *)rgb.pixels + row * rgb.stride + column * 3;
        const unsigned char *a = (unsigned char *)rgba.pixels + row * rgba.stride + column * 4;
        const unsigned char *g = (unsigned char *)grey.pixels + row * grey.stride + column;
        uint16_t p;
        memcpy(&p, (unsigned char *)packed.pixels + row * packed.stride + column * 2, 2);
        assert_true(a[0] == c[0] && a[1] == c[1] && a[2] == c[2] && a[3] == 255);
        assert_true(p >> 11 == c[0] >> 3 && (p >> 5 & 63) == c[1] >> 2 && (p & 31) == c[2] >> 3);
        assert_true(fabs(0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2] - *g) < 1.01);
    }
    rgba.transparent = true;
    draw(&st, &view, &rgba);
    for (uint32_t k = 0; k < 600; k++) {
        aset_ray ray = eye_ray(&view, 30, 20, k % 30 + 0.5, k / 30 + 0.5);
        const unsigned char *a = (unsigned char *)rgba.pixels + k / 30 * rgba.stride + k % 30 * 4;
        colour_of(&st, ray.origin, dvec_of(ray.direction));
        n_clear += a[3] == 0;
        assert_true(a[3] == 0 || a[3] == 255);
        n_wrong += (a[3] == 255) != (st.statistics.primary_hit == 1);
    }
    /* edges may differ */
    check(n_clear > 50 && n_clear < 550 && n_wrong < 10, "%" PRIu32 " clear, %" PRIu32 " wrong", n_clear, n_wrong);
    st.tracer.samples = 2;
    draw(&st, &view, &rgba);
    for (uint32_t k = 0, n_parts = 0; k < 600; k++) {
        int alpha = ((unsigned char *)rgba.pixels)[k / 30 * rgba.stride + k % 30 * 4 + 3];
        assert_true(alpha == 0 || alpha == 64 || alpha == 128 || alpha == 191 || alpha == 255);
        n_parts += alpha > 0 && alpha < 255;
        assert_true(k < 599 || n_parts > 10);
    }
    free(rgb.pixels);
    free(rgba.pixels);
    free(grey.pixels);
    free(packed.pixels);
    studio_close(&st);
}

#if ASET_WITH_SPHERES
/* Rounding and clamping, to the byte: a ball that fills the picture and shows a tenth of its fill. */
static void test_trace__colours_become_bytes(void **state) {
    (void)state;
    studio st;
    memset(&st, 0, sizeof st);
    model_start(&st.m);
    model_sphere(&st.m, real3(0, 0, 0), 5);
    studio_open(&st, &aset_mset, 1);
    aset_view view = view_from(6, 0, 0);
    aset_picture p = picture_of(1, 1, ASET_RGB888);
    const unsigned char *pixel = p.pixels;
    for (int i = 0; i <= 255; i++) {
        for (int part = -4; part <= 4; part += 2) {
            st.s.scene.materials[0].fill.r = (aset_real)((i + part * 0.1) / 25.5);
            st.s.scene.materials[0].fill.g = (aset_real)(10 + i);
            draw(&st, &view, &p);
            check(pixel[0] == i && pixel[1] == 255, "%d: %d", i, pixel[0]);
        }
    }
    free(p.pixels);
    studio_close(&st);
}
#endif

typedef struct taker {
    unsigned char *frame;
    size_t bytes;
    uint32_t next, stop_at;
    const void *pixels;
    bool in_order, same_place;
} taker;

static int take_row(void *context, uint32_t row, const void *pixels) {
    taker *t = context;
    t->in_order = t->in_order && row == t->next;
    t->same_place = t->same_place && (t->pixels == NULL || t->pixels == pixels);
    t->pixels = pixels;
    t->next++;
    memcpy(t->frame + row * t->bytes, pixels, t->bytes);
    return row == t->stop_at ? 7 : 0;
}

static void test_trace__rows(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(230), 30, &aset_mset, 6);
    aset_view view = view_from(12, 5, 4);
    aset_picture whole = picture_of(31, 23, ASET_RGB888), apart = picture_of(31, 23, ASET_RGB888), row = whole;
    draw(&st, &view, &whole);
    aset_statistics sum = st.statistics, parts;
    memset(&parts, 0, sizeof parts);
    for (uint32_t first = 23; first > 0;) { /* from the last to the first, in pieces of 1 to 4 */
        uint32_t n = first > 4 ? 1 + first % 4 : first;
        first -= n;
        aset_picture piece = apart;
        piece.pixels = (unsigned char *)apart.pixels + first * apart.stride;
        assert_int_equal(aset_render_rows(&st.tracer, &view, &piece, first, n, &st.scratch, &parts), ASET_OK);
    }
    assert_memory_equal(whole.pixels, apart.pixels, whole.stride * 23);
    assert_memory_equal(&sum, &parts, sizeof sum);

    unsigned char line[31 * 3], frame[31 * 3 * 23];
    taker t = {frame, sizeof line, 0, UINT32_MAX, NULL, true, true};
    row.pixels = line;
    row.stride = 0;
    row.on_row = take_row;
    row.context = &t;
    assert_int_equal(aset_render_rows(&st.tracer, &view, &row, 0, 23, &st.scratch, NULL), ASET_OK);
    assert_true(t.next == 23 && t.in_order && t.same_place && t.pixels == line);
    for (uint32_t i = 0; i < 23; i++) {
        assert_memory_equal(frame + i * sizeof line, (unsigned char *)whole.pixels + i * whole.stride, sizeof line);
    }
    memset(frame, 0xee, sizeof frame);
    taker stopping = {frame, sizeof line, 3, 5, NULL, true, true};
    row.context = &stopping;
    assert_int_equal(aset_render_rows(&st.tracer, &view, &row, 3, 20, &st.scratch, NULL), ASET_ERR_STOPPED);
    assert_true(stopping.next == 6 && stopping.in_order);
    assert_true(frame[0] == 0xee && frame[6 * sizeof line] == 0xee);
    assert_memory_equal(frame + 5 * sizeof line, (unsigned char *)whole.pixels + 5 * whole.stride, sizeof line);
    row.on_row = NULL;
    assert_int_equal(aset_render_rows(&st.tracer, &view, &row, 23, 0, &st.scratch, NULL), ASET_OK); /* nothing to do */
    free(whole.pixels);
    free(apart.pixels);
    studio_close(&st);
}

static void test_trace__rendering_refuses_bad_arguments(void **state) {
    (void)state;
    studio st;
    random_studio(&st, seed_of(240), 5, &aset_mset, 3);
    aset_view view = view_from(12, 5, 4), bad_view;
    aset_picture p = picture_of(8, 6, ASET_RGB888), bad;
    aset_tracer tracer = st.tracer;
    aset_scratch none = {0};
    assert_int_equal(aset_render_rows(NULL, &view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_render_rows(&tracer, NULL, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_render_rows(&tracer, &view, NULL, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_render_rows(&tracer, &view, &p, 0, 1, NULL, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_render_rows(&tracer, &view, &p, 0, 1, &none, NULL), ASET_ERR_ARGUMENT);
    static const uint32_t rows[][2] = {{0, 7}, {6, 1}, {7, 0}, {1, 6}, {3, UINT32_MAX}, {UINT32_MAX, 2}, {UINT32_MAX, 0}};
    for (size_t i = 0; i < COUNT_OF(rows); i++) {
        assert_int_equal(aset_render_rows(&tracer, &view, &p, rows[i][0], rows[i][1], &st.scratch, NULL), ASET_ERR_ARGUMENT);
    }
    static const uint32_t sizes[][2] = {{0, 6}, {8, 0}, {65536, 1}, {1, 65536}, {UINT32_MAX, UINT32_MAX}};
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        bad = p;
        bad.width = sizes[i][0];
        bad.height = sizes[i][1];
        assert_int_equal(aset_render_rows(&tracer, &view, &bad, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    }
    aset_tracer many = tracer, nothing = tracer;
    many.samples = UINT32_MAX;
    assert_int_equal(aset_render_rows(&many, &view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    nothing.scene = NULL;
    assert_int_equal(aset_render_rows(&nothing, &view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    nothing = tracer;
    nothing.space = NULL;
    assert_int_equal(aset_render_rows(&nothing, &view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    bad = p;
    bad.pixels = NULL;
    assert_int_equal(aset_render_rows(&tracer, &view, &bad, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    bad = p;
    bad.format = (aset_format)9;
    assert_int_equal(aset_render_rows(&tracer, &view, &bad, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    bad_view = view;
    bad_view.at = view.from;
    assert_int_equal(aset_render_rows(&tracer, &bad_view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_GEOMETRY);
    bad_view = view;
    bad_view.angle_deg = 0;
    assert_int_equal(aset_render_rows(&tracer, &bad_view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    tracer.depth = SCRATCH_DEPTH + 1;
    assert_int_equal(aset_render_rows(&tracer, &view, &p, 0, 1, &st.scratch, NULL), ASET_ERR_ARGUMENT);
    tracer.depth = SCRATCH_DEPTH;
    assert_int_equal(aset_render_rows(&tracer, &view, &p, 5, 1, &st.scratch, NULL), ASET_OK);
    for (size_t i = 0; i < p.stride * p.height; i++) {
        assert_true(i < p.width * 3 || ((unsigned char *)p.pixels)[i] == 0); /* only the one row was written */
    }
    free(p.pixels);
    studio_close(&st);
}

/* --- MSET against brute force --- */

static void draw_procedural(const char *name, uint32_t size, const aset_method *method, uint32_t n, bool spd_rules,
                            const aset_picture *p, aset_statistics *statistics) {
    stage s;
    aset_space space;
    aset_scratch scratch;
    memset(statistics, 0, sizeof *statistics);
    if (!stage_open_procedural(&s, name, size, ROOM)) {
        return;
    }
    stage_space(&s, &space, method, n, n + 1, n + 2);
    assert_int_equal(aset_scratch_init(&scratch, 5, &s.arena), ASET_OK);
    aset_tracer tracer = stage_tracer(&s, &space);
    tracer.spd_rules = spd_rules;
    assert_int_equal(aset_render_rows(&tracer, &s.scene.view, p, 0, p->height + spd_rules, &scratch, statistics), ASET_OK);
    assert_true(statistics->primary_hit > 100 && statistics->shadow > 100);
    assert_true(method != &aset_brute || statistics->tests == s.scene.counts.objects * (statistics->primary +
                    statistics->shadow + statistics->reflected + statistics->refracted));
    stage_close(&s);
}

static void test_trace__mset_pictures_equal_brute_force(void **state) {
    (void)state;
    static const struct {
        const char *name;
        uint32_t size;
    } scenes[] = {{"balls", 2}, {"gears", 1}, {"mount", 3}, {"rings", 2}, {"teapot", 2}, {"tetra", 3}, {"tree", 5}};
    for (size_t i = 0; i < COUNT_OF(scenes); i++) {
        for (int spd_rules = 0; spd_rules < 2; spd_rules++) {
            aset_picture expected = picture_of(48, 48, ASET_RGB888), p = picture_of(48, 48, ASET_RGB888);
            aset_statistics brute, mset;
            draw_procedural(scenes[i].name, scenes[i].size, &aset_brute, 1, spd_rules, &expected, &brute);
            for (uint32_t n = 3; n <= 19; n += 8) {
                draw_procedural(scenes[i].name, scenes[i].size, &aset_mset, n, spd_rules, &p, &mset);
                check(memcmp(p.pixels, expected.pixels, p.stride * 49) == 0, "%s, %" PRIu32 " divisions", scenes[i].name, n);
                check(mset.primary == brute.primary && mset.primary_hit == brute.primary_hit &&
                          mset.shadow == brute.shadow && mset.shadow_hit == brute.shadow_hit &&
                          mset.reflected == brute.reflected && mset.refracted == brute.refracted &&
                          mset.secondary_hit == brute.secondary_hit && mset.approx_hits == 0 && mset.curtailed == 0,
                      "%s, %" PRIu32 " divisions", scenes[i].name, n);
                check(mset.tests < brute.tests || brute.tests == 0, "%s, %" PRIu32 " divisions", scenes[i].name, n);
            }
            free(expected.pixels);
            free(p.pixels);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_trace__power_and_tangent),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_trace__background_and_ambient),
        cmocka_unit_test(test_trace__diffuse_and_highlight),
        cmocka_unit_test(test_trace__lights_share_their_intensity),
        cmocka_unit_test(test_trace__coloured_and_directional_lights),
        cmocka_unit_test(test_trace__shadows),
        cmocka_unit_test(test_trace__lights_at_the_point_and_far_away),
#endif
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_trace__polygons_are_lit_on_the_side_that_is_seen),
#endif
#if ASET_WITH_SPHERES && ASET_WITH_POLYGONS && ASET_WITH_REFLECTION
        cmocka_unit_test(test_trace__reflection_off_a_mirror),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_trace__mirrors_that_amplify),
#endif
        cmocka_unit_test(test_trace__depth_ends_the_chain),
#endif
#if ASET_WITH_SPHERES && ASET_WITH_POLYGONS && ASET_WITH_REFRACTION && ASET_WITH_REFLECTION
        cmocka_unit_test(test_trace__refraction_through_a_slab),
        cmocka_unit_test(test_trace__refraction_through_a_ball),
        cmocka_unit_test(test_trace__refraction_beyond_the_digits),
        cmocka_unit_test(test_trace__total_internal_reflection),
#endif
        cmocka_unit_test(test_trace__t_counts_in_lengths_of_the_direction),
        cmocka_unit_test(test_trace__queries_refuse_bad_rays),
#if ASET_WITH_APPROXIMATION
        cmocka_unit_test(test_trace__approximate_rays_stop_at_the_first_marked_side),
        cmocka_unit_test(test_trace__kinds_and_depth_decide_which_rays_are_approximate),
        cmocka_unit_test(test_trace__without_a_summary_every_ray_is_exact),
        cmocka_unit_test(test_trace__curtailed_rays),
        cmocka_unit_test(test_trace__curtailed_rays_return_background_or_light),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_trace__approximate_colour_is_the_lit_texture),
#endif
#endif
        cmocka_unit_test(test_trace__cameras),
        cmocka_unit_test(test_trace__samples_and_corner_rays),
        cmocka_unit_test(test_trace__formats),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_trace__colours_become_bytes),
#endif
        cmocka_unit_test(test_trace__rows),
        cmocka_unit_test(test_trace__rendering_refuses_bad_arguments),
        cmocka_unit_test(test_trace__mset_pictures_equal_brute_force),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
