/*
 * test_self.c - rays that leave a surface do not hit it again: triangles with coordinates from 10^-8 to 10^8 in one and the same
 * triangle, spheres with radii from 10^-4 to 10^4, near the origin and far from it; outgoing rays in any direction and nearly
 * along the surface.
 */
#include "support/support.h"

#include "trace/shade.h"

enum { OBJECTS = 1000, RAYS = 1000 };

/* So many of the rays at least must leave a surface, else the test says nothing: some needles are too thin to be met. */
#define SHARE_LEAST 0.9

/* 10 to a power between low and high, of either sign. */
static double random_power(random_state *r, double low, double high) {
    double size = pow(10, random_between(r, low, high));
    return random_chance(r, 0.5) ? size : -size;
}

/* A direction, half of them within a tenth to 10^-7 of the plane across n. */
static dvec random_grazing(random_state *r, dvec n) {
    dvec d = dvec_of(random_direction(r));
    if (random_chance(r, 0.5)) {
        double up = random_power(r, -7, -1);
        d = dvec_along(dvec_unit(dvec_along(d, -dvec_dot(d, n), n)), up, n);
    }
    return d;
}

typedef struct tally {
    uint64_t left, again;
} tally;

/* One ray to the target, and one that leaves from where it hits. outwards: only along the normal. */
static void bounce(tally *sum, const aset_tracer *tracer, random_state *r, dvec from, dvec target, bool outwards) {
    aset_statistics statistics;
    query_hit hit;
    shading s;
    aset_vec3 origin = dvec_real(from);
    dvec way = dvec_sub(target, dvec_of(origin));
    memset(&statistics, 0, sizeof statistics);
    if (!(dvec_length(way) > 0)) {
        return;
    }
    aset_vec3 direction = aset_vec_unit(dvec_real(dvec_unit(way)));
    if (!aset_query_closest(&hit, tracer, origin, direction, REAL_INFINITY, false, &statistics)) {
        return;
    }
    aset_shading_make(&s, tracer, &hit, direction);
    dvec n = dvec_of(s.hit.geometric), out = random_grazing(r, n);
    out = outwards && dvec_dot(out, n) < 0 ? dvec_make(-out.x, -out.y, -out.z) : out;
    aset_vec3 leaving = aset_vec_unit(dvec_real(dvec_unit(out)));
    if (outwards && !(vec_dot(leaving, s.hit.geometric) > 0)) {
        return; /* rounding turned it inwards */
    }
    sum->left++;
    sum->again +=
        aset_query_any(tracer, aset_shade_start(&s, leaving, false, 0), leaving, REAL_INFINITY, false, REAL_INFINITY, &statistics);
}

static void report(const char *what, const tally *sum, uint64_t seed) {
    check(sum->again == 0, "%s, " SEED ": %" PRIu64 " of %" PRIu64 " rays hit their own surface", what, seed, sum->again,
          sum->left);
    check((double)sum->left >= SHARE_LEAST * OBJECTS * RAYS, "%s: only %" PRIu64 " rays", what, sum->left);
    if (long_run()) {
        print_message("%s: %" PRIu64 " rays leave, none hits its own surface\n", what, sum->left);
    }
}

/* A stage of the model's one object, brute force. */
static void open_one(stage *s, aset_space *space, aset_tracer *tracer, const model *m) {
    stage_open_model(s, m, 0);
    stage_space(s, space, &aset_brute, 1, 1, 1);
    *tracer = stage_tracer(s, space);
}

#if ASET_WITH_POLYGONS
static dvec random_corner(random_state *r) {
    double x = random_power(r, -8, 8), y = random_power(r, -8, 8);
    return dvec_make(x, y, random_power(r, -8, 8));
}

/* Every third one as a needle, whose short edge is any of the three. */
static void random_corners(aset_vec3 points[3], random_state *r, int number) {
    for (int i = 0; i < 3; i++) {
        points[i] = dvec_real(random_corner(r));
    }
    if (number % 3 == 0) {
        uint32_t k = random_below(r, 3);
        dvec p = dvec_of(points[k]);
        double width = dvec_length(p) * pow(10, random_between(r, -6, -2));
        points[(k + 1) % 3] = dvec_real(dvec_along(p, width, dvec_of(random_direction(r))));
    }
}

static void bounce_off_triangle(tally *sum, const aset_tracer *tracer, random_state *r, const thing *t) {
    double u = random_between(r, 0, 1), v = random_between(r, 0, 1);
    u = u + v > 1 ? 1 - u : u;
    v = u + v > 1 ? 1 - v : v;
    dvec a = dvec_of(t->points[0]), ab = dvec_sub(dvec_of(t->points[1]), a), ac = dvec_sub(dvec_of(t->points[2]), a);
    dvec target = dvec_along(dvec_along(a, u, ab), v, ac);
    double size = fmax(dvec_length(ab), dvec_length(ac)) * pow(10, random_between(r, -2, 2));
    bounce(sum, tracer, r, dvec_along(target, size, dvec_of(random_direction(r))), target, false);
}

static void test_self__triangles(void **state) {
    (void)state;
    uint64_t seed = seed_of(100);
    random_state r = random_start(seed);
    tally sum = {0, 0};
    for (int i = 0; i < OBJECTS; i++) {
        model m;
        stage s;
        aset_space space;
        aset_tracer tracer;
        aset_vec3 points[3];
        random_corners(points, &r, i);
        model_start(&m);
        model_polygon(&m, points, NULL, 3);
        open_one(&s, &space, &tracer, &m);
        uint64_t enough = sum.left + RAYS;
        for (int k = 0; k < 3 * RAYS && sum.left < enough; k++) { /* a needle is not always met */
            bounce_off_triangle(&sum, &tracer, &r, m.things);
        }
        stage_close(&s);
        model_free(&m);
    }
    report("triangles", &sum, seed);
}
#endif

#if ASET_WITH_SPHERES
/* From outside or, for the ray that leaves through the surface, from inside. */
static void bounce_off_sphere(tally *sum, const aset_tracer *tracer, random_state *r, const thing *t) {
    dvec centre = dvec_of(t->points[0]);
    double radius = (double)t->radii[0], share = random_chance(r, 0.3) ? random_between(r, 0, 0.9) : pow(10, random_between(r, 0.1, 2));
    dvec from = dvec_along(centre, share * radius, dvec_of(random_direction(r)));
    dvec target = dvec_along(centre, random_between(r, 0, 0.999) * radius, dvec_of(random_direction(r)));
    bounce(sum, tracer, r, from, target, true);
}

static void test_self__spheres(void **state) {
    (void)state;
    uint64_t seed = seed_of(200);
    random_state r = random_start(seed);
    tally sum = {0, 0};
    for (int i = 0; i < OBJECTS; i++) {
        model m;
        stage s;
        aset_space space;
        aset_tracer tracer;
        double radius = pow(10, random_between(&r, -4, 4)), away = radius * (i % 2 == 0 ? 0 : pow(10, random_between(&r, -1, 3)));
        model_start(&m);
        model_sphere(&m, dvec_real(dvec_along(dvec_make(0, 0, 0), away, dvec_of(random_direction(&r)))), radius);
        open_one(&s, &space, &tracer, &m);
        uint64_t enough = sum.left + RAYS;
        for (int k = 0; k < 3 * RAYS && sum.left < enough; k++) { /* one smaller than its place can be told is not always met */
            bounce_off_sphere(&sum, &tracer, &r, m.things);
        }
        stage_close(&s);
        model_free(&m);
    }
    report("spheres", &sum, seed);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_self__triangles),
#endif
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_self__spheres),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
