/*
 * test_tight.c - no ray slips through a closed surface: tessellated spheres of 20 to 1,280 triangles in four places, all seven
 * methods, from outside and from inside, at random and exactly at vertices and at points of edges.
 *
 * ASET_LONG=1: ten million rays a place for MSET and grid, a million for the other methods, a hundred thousand for brute force;
 * else a tenth of that, as in `make test`.
 */
#include "support/support.h"

#if ASET_WITH_POLYGONS

#define PI 3.14159265358979323846
/* Rays from outside pass the middle within this part of the radius: the icosahedron's own outline lies beyond 0.79. */
#define WITHIN 0.7

enum { LEVELS = 4, METHODS = 7 };

static const struct {
    const char *text;
    double radius;
    dvec centre;
} places[] = {{"radius 2", 2, {0, 0, 0}},
              {"radius 2, far away", 2, {148376, 1234, -223423}},
              {"radius 10^-6", 1e-6, {0, 0, 0}},
              {"radius 10^6", 1e6, {0, 0, 0}}};

static const struct {
    const aset_method *method;
    uint32_t rays; /* in the long run */
} methods[METHODS] = {{&aset_mset, 10000000}, {&aset_grid, 10000000}, {&aset_set, 1000000},  {&aset_octree, 1000000},
                      {&aset_arts, 1000000},  {&aset_excell, 1000000}, {&aset_brute, 100000}};

/* --- the sphere: neighbours round the same middle of an edge, a + b being b + a, so it is closed to the last bit --- */

static void add_triangle(model *m, dvec a, dvec b, dvec c, int level) {
    if (level == 0) {
        const aset_vec3 points[3] = {dvec_real(a), dvec_real(b), dvec_real(c)};
        model_polygon(m, points, NULL, 3);
        return;
    }
    dvec ab = dvec_unit(dvec_along(a, 1, b)), bc = dvec_unit(dvec_along(b, 1, c)), ca = dvec_unit(dvec_along(c, 1, a));
    add_triangle(m, a, ab, ca, level - 1);
    add_triangle(m, ab, b, bc, level - 1);
    add_triangle(m, ca, bc, c, level - 1);
    add_triangle(m, ab, bc, ca, level - 1);
}

/* An icosahedron: two poles and two rings of five, halved level times. */
static void add_sphere(model *m, int level, double radius, dvec centre) {
    dvec at[12];
    at[0] = dvec_make(0, 0, 1);
    at[11] = dvec_make(0, 0, -1);
    for (int i = 0; i < 5; i++) {
        double angle = 2 * PI * i / 5, low = angle + PI / 5, across = 2 / sqrt(5), up = 1 / sqrt(5);
        at[1 + i] = dvec_make(across * cos(angle), across * sin(angle), up);
        at[6 + i] = dvec_make(across * cos(low), across * sin(low), -up);
    }
    for (int i = 0; i < 5; i++) {
        int k = (i + 1) % 5;
        add_triangle(m, at[0], at[1 + i], at[1 + k], level);
        add_triangle(m, at[1 + i], at[6 + i], at[1 + k], level);
        add_triangle(m, at[6 + i], at[6 + k], at[1 + k], level);
        add_triangle(m, at[11], at[6 + k], at[6 + i], level);
    }
    for (uint32_t i = 0; i < m->n_things; i++) {
        for (int k = 0; k < 3; k++) {
            m->things[i].points[k] = dvec_real(dvec_along(centre, radius, dvec_of(m->things[i].points[k])));
        }
    }
}

/* --- rays --- */

typedef struct bench {
    model m;
    stage s;
    aset_space space;
    aset_tracer tracer;
    double radius;
    dvec centre;
} bench;

/* A point of the sphere: anywhere, a vertex, the middle of an edge or another point of it. */
static dvec random_target(const bench *b, random_state *r) {
    const thing *t = b->m.things + random_below(r, b->m.n_things);
    uint32_t k = random_below(r, 3), sort = random_below(r, 4);
    dvec p = dvec_of(t->points[k]), q = dvec_of(t->points[(k + 1) % 3]);
    if (sort == 0) {
        return dvec_along(b->centre, b->radius, dvec_of(random_direction(r)));
    }
    if (sort == 1) {
        return p;
    }
    double share = sort == 2 ? 0.5 : random_between(r, 0, 1);
    return dvec_along(p, share, dvec_sub(q, p));
}

static dvec random_inside(const bench *b, random_state *r) {
    double share = random_chance(r, 0.1) ? 0 : random_between(r, 0, 0.5);
    return dvec_along(b->centre, share * b->radius, dvec_of(random_direction(r)));
}

/* From up to twenty radii away, so that the line passes the middle well within the outline. */
static dvec random_outside(const bench *b, random_state *r, dvec target) {
    for (;;) {
        dvec origin = dvec_along(b->centre, b->radius * 1.5 * pow(13, random_between(r, 0, 1)), dvec_of(random_direction(r)));
        dvec d = dvec_unit(dvec_sub(target, origin)), f = dvec_sub(b->centre, origin);
        double along = dvec_dot(d, f), past = dvec_length(dvec_along(f, -along, d));
        if (past < WITHIN * b->radius && dvec_dot(dvec_sub(target, b->centre), d) < 0) {
            return origin;
        }
    }
}

/* Did the ray get out, or in? A hit on the far side is a leak of the near one. */
static bool leaks(const bench *b, const aset_ray *ray, bool outside) {
    aset_hit hit;
    bool closest, any;
    assert_int_equal(aset_closest_hit(&closest, &hit, &b->tracer, ray, false, NULL), ASET_OK);
    assert_int_equal(aset_any_hit(&any, &b->tracer, ray, false, NULL), ASET_OK);
    if (!closest || !any) {
        return true;
    }
    double way = (double)hit.t * dvec_length(dvec_of(ray->direction));
    return outside && way > dvec_length(dvec_sub(b->centre, dvec_of(ray->origin)));
}

static void shoot(const bench *b, uint32_t n_rays, uint64_t seed, const char *place) {
    random_state r = random_start(seed);
    uint32_t n_leaks = 0;
    for (uint32_t i = 0; i < n_rays; i++) {
        bool outside = i % 2 == 1;
        dvec target = random_target(b, &r), from = outside ? random_outside(b, &r, target) : random_inside(b, &r);
        aset_ray ray = {dvec_real(from), {0, 0, 0}, REAL_INFINITY};
        dvec way = dvec_sub(target, dvec_of(ray.origin));
        ray.direction = dvec_real(random_chance(&r, 0.5) ? way : dvec_unit(way));
        n_leaks += leaks(b, &ray, outside);
    }
    check(n_leaks == 0, "%s, %s, %" PRIu32 " triangles, " SEED ": %" PRIu32 " of %" PRIu32 " rays leak", place,
          aset_method_name(b->space.method), b->m.n_things, seed, n_leaks, n_rays);
}

static void check_place(size_t place, size_t method) {
    uint32_t n_rays = methods[method].rays / (long_run() ? 1 : 10) / LEVELS;
    for (int level = 0; level < LEVELS; level++) {
        bench b;
        b.radius = places[place].radius;
        b.centre = places[place].centre;
        model_start(&b.m);
        add_sphere(&b.m, level, b.radius, b.centre);
        stage_open_model(&b.s, &b.m, 4 << 20);
        assert_int_equal(aset_space_build(&b.space, &b.s.scene, methods[method].method, NULL, &b.s.arena), ASET_OK);
        b.tracer = stage_tracer(&b.s, &b.space);
        shoot(&b, n_rays, seed_of(100 * (uint64_t)place + 10 * method + (uint64_t)level), places[place].text);
        stage_close(&b.s);
        model_free(&b.m);
    }
    if (long_run()) {
        print_message("%s: %" PRIu32 " rays through %s, none leaks\n", places[place].text, n_rays * LEVELS,
                      aset_method_name(methods[method].method));
    }
}

static void check_method(const aset_method *method) {
    for (size_t k = 0; k < METHODS; k++) {
        for (size_t place = 0; methods[k].method == method && place < COUNT_OF(places); place++) {
            check_place(place, k);
        }
    }
}

static void test_tight__mset(void **state) {
    (void)state;
    check_method(&aset_mset);
}

static void test_tight__grid(void **state) {
    (void)state;
    check_method(&aset_grid);
}

static void test_tight__set(void **state) {
    (void)state;
    check_method(&aset_set);
}

static void test_tight__octree_and_arts(void **state) {
    (void)state;
    check_method(&aset_octree);
    check_method(&aset_arts);
}

static void test_tight__excell(void **state) {
    (void)state;
    check_method(&aset_excell);
}

static void test_tight__brute(void **state) {
    (void)state;
    check_method(&aset_brute);
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_tight__mset),
        cmocka_unit_test(test_tight__grid),
        cmocka_unit_test(test_tight__set),
        cmocka_unit_test(test_tight__octree_and_arts),
        cmocka_unit_test(test_tight__excell),
        cmocka_unit_test(test_tight__brute),
#else
        cmocka_unit_test(test_support__not_compiled),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
