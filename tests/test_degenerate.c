/*
 * test_degenerate.c - scenes, lights, materials and rays that are as degenerate as they come, through every method, exact,
 * approximate and from drafts: every colour is finite, every hit is a place with normals of unit length, no walk takes more
 * steps than there are slices, and every method agrees with brute force.
 *
 * ASET_LONG=1: ten million rays instead of forty thousand.
 */
#include "support/rays.h"

#include <math.h>

enum { RAYS = 40000, RAYS_LONG = 10000000, SCENES = 8, METHODS = 7, ROOM = 4 << 20 };

/* --- scenes --- */

static void add_materials(model *m, random_state *r) {
    const double shines[] = {0, 1, 1e5}, indices[] = {0, 1, 1e-3, 1e3, 1.5};
    m->n_materials = 0;
    for (size_t i = 0; i < 15; i++) {
        aset_material x = plain_material();
        x.shine = (aset_real)shines[i % 3];
        x.specular = (aset_real)(i % 2 == 0 ? 0.9 : 0);
#if ASET_WITH_REFRACTION
        x.transmittance = (aset_real)(i % 4 < 3 ? 0.9 : 0);
        x.refraction_index = (aset_real)indices[i / 3];
#endif
        x.one_sided = random_chance(r, 0.2);
        model_material(m, &x);
    }
}

/* Lights that shine from a surface, from within, from nowhere near, or not at all. */
static void add_lights(model *m, random_state *r) {
    uint32_t n = random_below(r, 4);
    for (uint32_t i = 0; i < n && m->n_things > 0; i++) {
        const thing *t = m->things + random_below(r, m->n_things);
        dvec place = dvec_of(t->points[0]);
        switch (random_below(r, 4)) {
        case 0: break; /* a corner, or the middle of a sphere */
        case 1: place = dvec_along(place, fabs((double)t->radii[0]), dvec_of(random_direction(r))); break;
        case 2: place = dvec_of(random_in_cube(r, 1e29)); break;
        default: place = dvec_of(random_in_cube(r, 5)); break;
        }
        model_light(m, dvec_real(place));
        m->lights[m->n_lights - 1].directional = random_chance(r, 0.2) && dvec_length(place) > 0;
    }
}

/* A triangle ten million times as long as wide, with two corners in one, or with all three on a line. */
static void add_needle(model *m, random_state *r) {
    dvec a = dvec_of(random_in_cube(r, 4)), along = dvec_of(random_direction(r)), across = dvec_of(random_direction(r));
    double length = pow(10, random_between(r, -2, 1)), share = random_between(r, 0, 1);
    aset_vec3 p[4] = {dvec_real(a), dvec_real(dvec_along(a, length, along)), dvec_real(a), dvec_real(a)};
    switch (random_below(r, 4)) {
    case 0: p[2] = dvec_real(dvec_along(dvec_of(p[1]), 1e-7 * length, across)); break;
    case 1: p[2] = p[random_below(r, 2)]; break;
    case 2: p[2] = dvec_real(dvec_along(a, share * length, along)); break;
    default: p[2] = dvec_real(dvec_along(a, length, across)); break;
    }
    p[3] = random_chance(r, 0.5) ? p[2] : p[0];
    model_polygon(m, p, NULL, 3 + random_below(r, 2));
}

static void add_odd_cone(model *m, random_state *r) {
    dvec a = dvec_of(random_in_cube(r, 4));
    double radius = pow(10, random_between(r, -6, 0.5)), length = pow(10, random_between(r, -6, 1));
    const double others[] = {radius, 0, radius * (1 + 2e-7), radius * (1 - 2e-7), 1e-30, 1e3 * radius};
    dvec b = dvec_along(a, length, dvec_of(random_direction(r)));
    aset_vec3 base = dvec_real(a), apex = dvec_real(b);
    double sign = random_chance(r, 0.3) ? -1 : 1;
    if (memcmp(&base, &apex, sizeof base) != 0) {
        model_cone(m, base, sign * radius, apex, sign * others[random_below(r, COUNT_OF(others))]);
    }
}

static void add_odd_sphere(model *m, random_state *r) {
    double radius = pow(10, random_between(r, -7, 1)), sign = random_chance(r, 0.3) ? -1 : 1;
    model_sphere(m, random_chance(r, 0.5) ? real3(0, 0, 0) : random_in_cube(r, 4), sign * radius);
}

/* Of the least numbers there are. */
static void add_tiny(model *m, random_state *r) {
    aset_vec3 p[3];
    for (int i = 0; i < 3; i++) {
        double x = random_between(r, -1e-38, 1e-38), y = random_between(r, -1e-44, 1e-44);
        p[i] = real3(x, y, random_chance(r, 0.5) ? -0.0 : 1e-40);
    }
    model_polygon(m, p, NULL, 3);
    model_sphere(m, p[0], 1e-41);
}

static void keep_available(model *m) {
    uint32_t n = 0;
    for (uint32_t i = 0; i < m->n_things; i++) {
        if (thing_available(m->things[i].kind)) {
            m->things[n++] = m->things[i];
        }
    }
    m->n_things = n;
}

static void make_scene(model *m, random_state *r, int scene) {
    model_start(m);
    add_materials(m, r);
    for (int i = 0; i < 12; i++) {
        switch (scene) {
        case 0: add_needle(m, r); break;
        case 1: model_in_one_point(m, random_in_cube(r, 0), 1); break;
        case 2: model_in_one_plane(m, r, 1, 1); break;
        case 3: add_odd_cone(m, r); break;
        case 4: add_odd_sphere(m, r); break;
        case 5: add_tiny(m, r); break;
        case 6:
            if (i == 0) {
                model_in_slices(m, r);
            }
            break;
        default:
            add_needle(m, r);
            add_odd_cone(m, r);
            add_odd_sphere(m, r);
            (void)model_random_thing(m, r, 4, 2);
            break;
        }
    }
    keep_available(m);
    for (uint32_t i = 0; i < m->n_things; i++) {
        m->things[i].material = random_below(r, m->n_materials);
    }
    add_lights(m, r);
}

/* --- rays --- */

/* In the plane of a polygon, or 10^-7 off it, towards one of its corners. */
static void along_polygon(aset_ray *ray, random_state *r, const thing *t) {
    dvec a = dvec_of(t->points[0]), u = dvec_sub(dvec_of(t->points[1]), a), v = dvec_sub(dvec_of(t->points[2]), a);
    double s = random_between(r, -3, 3);
    ray->origin = dvec_real(dvec_along(dvec_along(a, s, u), random_between(r, -3, 3), v));
    dvec way = dvec_sub(dvec_of(t->points[random_below(r, 3)]), dvec_of(ray->origin));
    double off = random_chance(r, 0.5) ? 0 : 1e-7 * dvec_length(way);
    ray->direction = dvec_real(dvec_along(way, off, dvec_of(random_direction(r))));
}

/* Zeros of either sign, denormal and tiny components, lengths of all sizes. */
static void spoil_direction(aset_ray *ray, random_state *r) {
    const double odd[] = {0.0, -0.0, 1e-45, -1e-40, 1e-38, -1e-20, 1e-8};
    for (int a = 0; a < 3; a++) {
        if (random_chance(r, 0.4)) {
            set_axis(&ray->direction, a, (aset_real)odd[random_below(r, COUNT_OF(odd))]);
        }
    }
}

/* Exactly on a corner of a voxel. */
static void put_on_corner(aset_ray *ray, random_state *r, const aset_space *space) {
    for (int a = 0; a < 3; a++) {
        set_axis(&ray->origin, a, random_slice(r, space, a, true) / space->scene->scale);
    }
}

static aset_ray odd_ray(random_state *r, const aset_space *space, const model *m) {
    static const ray_sort sorts[] = {FROM_OUTSIDE, FROM_INSIDE, ALONG_AXIS, NEARLY_ALONG_AXIS, ALONG_BOX};
    aset_ray ray = random_ray_common(r, space, sorts[random_below(r, COUNT_OF(sorts))], true);
    const thing *t = m->n_things > 0 ? m->things + random_below(r, m->n_things) : NULL;
    switch (random_below(r, 6)) {
    case 0:
        if (t != NULL && t->n_points > 0) {
            along_polygon(&ray, r, t);
        }
        break;
    case 1: put_on_corner(&ray, r, space); break;
    case 2:
        if (t != NULL) {
            ray.origin = t->points[0]; /* a corner, or within: a camera inside an object */
        }
        break;
    case 3: spoil_direction(&ray, r); break;
    default: break;
    }
    if (!(vec_largest(ray.direction) > 0)) {
        ray.direction = real3(0, -0.0, -1);
    }
    return ray;
}

/* --- asking --- */

typedef struct bench {
    const char *name;
    uint64_t seed, ray;
    int scene;
    aset_tracer tracer;
    aset_scratch scratch;
    uint64_t steps_most;
} bench;

#define BENCH_TEXT "%s, scene %d, " SEED ", ray %" PRIu64
#define BENCH_ARGS(b) (b)->name, (b)->scene, (b)->seed, (b)->ray

static bool is_unit(aset_vec3 n) {
    return fabs(dvec_length(dvec_of(n)) - 1) < 1e-5;
}

/* t is no number of lengths of a direction that is nearly none. */
static void check_hit(const bench *b, const aset_ray *ray, const aset_hit *hit) {
    bool counts = real_finite(hit->t) || vec_largest(ray->direction) < R(1e-30);
    check(hit->t >= 0 && counts && vec_finite(hit->point), BENCH_TEXT ": t %g", BENCH_ARGS(b), (double)hit->t);
    check(is_unit(hit->normal) && is_unit(hit->geometric), BENCH_TEXT ": normals %g %g %g, %g %g %g", BENCH_ARGS(b),
          (double)hit->normal.x, (double)hit->normal.y, (double)hit->normal.z, (double)hit->geometric.x,
          (double)hit->geometric.y, (double)hit->geometric.z);
}

static void ask(bench *b, const aset_ray *ray, bool approximate) {
    aset_statistics closest, any;
    aset_hit hit;
    bool found, blocked;
    memset(&closest, 0, sizeof closest);
    memset(&any, 0, sizeof any);
    assert_int_equal(aset_closest_hit(&found, &hit, &b->tracer, ray, approximate, &closest), ASET_OK);
    assert_int_equal(aset_any_hit(&blocked, &b->tracer, ray, approximate, &any), ASET_OK);
    /* a ray that came through a seam of a draft asks up to four beside it */
    uint64_t walks_most = b->tracer.draft != NULL && b->tracer.draft->closes_seams ? 5 : 1;
    check(closest.cells_visited <= walks_most * b->steps_most && any.cells_visited <= b->steps_most, BENCH_TEXT ": %" PRIu64 " steps, not %" PRIu64,
          BENCH_ARGS(b), closest.cells_visited, b->steps_most);
    if (found) {
        check_hit(b, ray, &hit);
    }
    b->ray++;
}

static void ask_colour(bench *b, const aset_ray *ray) {
    aset_colour c;
    assert_int_equal(aset_ray_colour(&c, &b->tracer, ray, &b->scratch, NULL), ASET_OK);
    check(real_finite(c.r) && real_finite(c.g) && real_finite(c.b) && c.r >= 0 && c.g >= 0 && c.b >= 0,
          BENCH_TEXT ": colour %g %g %g of the ray %.9g %.9g %.9g, %.9g %.9g %.9g", BENCH_ARGS(b), (double)c.r, (double)c.g,
          (double)c.b, (double)ray->origin.x, (double)ray->origin.y, (double)ray->origin.z, (double)ray->direction.x,
          (double)ray->direction.y, (double)ray->direction.z);
}

static uint32_t rays_each(void) {
    return (uint32_t)(long_run() ? RAYS_LONG : RAYS) / (SCENES * METHODS);
}

/* How often a scene is made anew for its rays. */
static uint32_t variants(void) {
    return long_run() ? 20 : 2;
}

static void check_space(bench *b, const model *m, const aset_method *method) {
    stage s;
    aset_space space, brute;
    random_state r = random_start(b->seed + 1);
    stage_open_model(&s, m, ROOM);
    assert_int_equal(aset_space_build(&space, &s.scene, method, NULL, &s.arena), ASET_OK);
    stage_space(&s, &brute, &aset_brute, 1, 1, 1);
    assert_int_equal(aset_scratch_init(&b->scratch, 0, &s.arena), ASET_OK);
    aset_tracer plain = stage_tracer(&s, &brute);
    b->tracer = stage_tracer(&s, &space);
    b->name = aset_method_name(method);
    b->steps_most = (uint64_t)space.slices.n[0] + space.slices.n[1] + space.slices.n[2] + 1;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
    assert_int_equal(aset_summary_build(&summary, &space, 0, &s.arena), ASET_OK);
    b->tracer.summary = &summary;
    b->tracer.curtail = R(0.25);
#endif
    b->ray = 0;
    while (b->ray < rays_each() / variants() + 1) {
        aset_ray ray = odd_ray(&r, &space, m);
        bool approximate = ASET_WITH_APPROXIMATION && b->ray % 3 == 2;
#if ASET_WITH_APPROXIMATION
        b->tracer.approx_kinds = approximate ? ASET_ALL_KINDS : 0;
        b->tracer.approx_depth = b->ray % 2;
#endif
        ask_colour(b, &ray);
        ask(b, &ray, approximate);
        check(same_closest(&plain, &b->tracer, &ray, NULL), BENCH_TEXT ": not brute force's hit", BENCH_ARGS(b));
    }
    stage_close(&s);
}

static void check_scenes(const aset_method *method) {
    for (int scene = 0; scene < SCENES; scene++) {
        for (uint32_t k = 0; k < variants(); k++) {
            bench b;
            model m;
            memset(&b, 0, sizeof b);
            b.seed = seed_of(1000 * (uint64_t)scene + k);
            b.scene = scene;
            random_state r = random_start(b.seed);
            make_scene(&m, &r, scene);
            check_space(&b, &m, method);
            model_free(&m);
        }
    }
}

#define TEST_METHOD(method)                                                                                            \
    static void test_degenerate__##method(void **state) {                                                              \
        (void)state;                                                                                                   \
        check_scenes(&aset_##method);                                                                                  \
    }

TEST_METHOD(mset)
TEST_METHOD(grid)
TEST_METHOD(set)
TEST_METHOD(octree)
TEST_METHOD(arts)
TEST_METHOD(excell)
TEST_METHOD(brute)

/* --- drafts --- */

#if ASET_WITH_DRAFTS
/* False: there is nothing to bake. */
static bool bake(aset_draft *draft, aset_arena *arena, const model *m, bool keep_none) {
    aset_baker *baker = malloc(sizeof *baker);
    const aset_bake_options options = {.divisions = {12, 10, 8}, .keep_none = keep_none};
    bool again = m->n_things > 0;
    assert_non_null(baker);
    assert_int_equal(aset_baker_init(baker, arena, &options), ASET_OK);
    while (again) {
        aset_sink sink = aset_baker_sink(baker);
        assert_int_equal(model_emit(&sink, m), ASET_OK);
        assert_int_equal(aset_baker_pass(baker, &again), ASET_OK);
    }
    bool some = m->n_things > 0;
    if (some) {
        assert_int_equal(aset_baker_finish(draft, baker), ASET_OK);
    }
    free(baker);
    return some;
}

static void check_draft(bench *b, const model *m, int variant) {
    stage s; /* the same scene beside it, for its rays' sorts */
    aset_space space;
    aset_draft draft;
    random_state r = random_start(b->seed + 2);
    stage_open_model(&s, m, ROOM);
    stage_space(&s, &space, &aset_brute, 1, 1, 1);
    if (bake(&draft, &s.arena, m, variant % 2 == 0)) {
        assert_int_equal(aset_scratch_init(&b->scratch, 0, &s.arena), ASET_OK);
        memset(&b->tracer, 0, sizeof b->tracer);
        b->tracer.scene = &draft.stage;
        b->tracer.draft = &draft;
        b->tracer.draft_sides = variant % 4 >= 2;
        b->tracer.approx_kinds = ASET_ALL_KINDS;
        b->name = b->tracer.draft_sides ? "sides of a draft" : "draft";
        /* in each block that is crossed ten crossings and one more, and the blocks */
        b->steps_most = 12 * ((uint64_t)draft.blocks[0] + draft.blocks[1] + draft.blocks[2] + 1);
        b->ray = 0;
        while (b->ray < rays_each() / variants() + 1) {
            aset_ray ray = odd_ray(&r, &space, m);
            ask_colour(b, &ray);
            ask(b, &ray, true);
        }
    }
    stage_close(&s);
}

static void test_degenerate__drafts(void **state) {
    (void)state;
    for (int scene = 0; scene < SCENES; scene++) {
        for (uint32_t k = 0; k < 2 * variants(); k++) {
            bench b;
            model m;
            memset(&b, 0, sizeof b);
            b.seed = seed_of(1000 * (uint64_t)scene + 500 + k);
            b.scene = scene;
            random_state r = random_start(b.seed);
            make_scene(&m, &r, scene);
            check_draft(&b, &m, (int)k);
            model_free(&m);
        }
    }
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_degenerate__mset),   cmocka_unit_test(test_degenerate__grid), cmocka_unit_test(test_degenerate__set),
        cmocka_unit_test(test_degenerate__octree), cmocka_unit_test(test_degenerate__arts), cmocka_unit_test(test_degenerate__excell),
        cmocka_unit_test(test_degenerate__brute),
#if ASET_WITH_DRAFTS
        cmocka_unit_test(test_degenerate__drafts),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
