/*
 * test_space.c - spaces against brute force on the same seeded rays, bit for bit; that no object is met twice; that every
 * cell is marked as the rule says; structure counts; hostile scenes.
 */
#include "support/rays.h"

#include "space/cells.h"
#include "space/slices.h"

#define ROOM ((size_t)6 << 20)

/* --- rays of all sorts --- */

static const ray_sort sorts[] = {FROM_OUTSIDE, FROM_INSIDE, ALONG_AXIS, NEARLY_ALONG_AXIS, IN_SLICE, FROM_SLICE,
                                 THROUGH_CORNERS, ALONG_BOX, FROM_SURFACE, IN_SURFACE, FROM_FAR};

/* From a corner of voxels along a diagonal of its voxel. */
static void put_through_corners(aset_ray *ray, random_state *r, const aset_space *space) {
    for (int a = 0; a < 3; a++) {
        int32_t k = (int32_t)random_below(r, space->slices.n[a]);
        aset_real from = slices_plane(&space->slices, a, k), to = slices_plane(&space->slices, a, k + 1);
        set_axis(&ray->origin, a, from);
        set_axis(&ray->direction, a, random_chance(r, 0.5) ? to - from : from - to);
    }
    if (ray->direction.x == 0 && ray->direction.y == 0 && ray->direction.z == 0) {
        ray->direction.x = 1; /* a scene so small that its slices coincide */
    }
    if (random_chance(r, 0.5)) {
        dvec back = dvec_along(dvec_of(ray->origin), -4.0, dvec_of(ray->direction));
        ray->origin = dvec_real(back);
    }
}

/* A point on an object's box, a corner as often as not: where polygons end. */
static dvec random_on_box(random_state *r, const aset_scene *scene) {
    aset_vec3 low, high;
    aset_object_bounds(scene, random_below(r, scene->counts.objects), &low, &high);
    const double from[3] = {(double)low.x, (double)low.y, (double)low.z};
    const double to[3] = {(double)high.x, (double)high.y, (double)high.z};
    double at[3];
    for (int a = 0; a < 3; a++) {
        double share = random_between(r, -1, 2); /* beyond 0 and 1: just there */
        at[a] = share <= 0 ? from[a] : share >= 1 ? to[a] : from[a] + share * (to[a] - from[a]);
    }
    return dvec_make(at[0], at[1], at[2]);
}

/*
 * From a hit onwards: any way, or in the surface's own plane, where t is a quotient of two numbers near 0 and nothing but
 * the clamp to the object's box holds it.
 */
static void put_on_surface(aset_ray *ray, random_state *r, const aset_scene *scene, bool in_surface) {
    aset_vec3 normal = {0, 0, 1};
    ray->origin = dvec_real(random_in_scene(r, scene, 1));
    for (int trial = 0; trial < 10; trial++) {
        aset_vec3 low, high;
        uint32_t object = random_below(r, scene->counts.objects);
        aset_object_bounds(scene, object, &low, &high);
        dvec span = dvec_sub(dvec_of(high), dvec_of(low)), target = dvec_of(low);
        target.x += span.x * random_between(r, 0, 1);
        target.y += span.y * random_between(r, 0, 1);
        target.z += span.z * random_between(r, 0, 1);
        aim_at(ray, target);
        if (move_to_hit(ray, scene, object)) {
            aset_hit surface;
            surface.point = ray->origin;
            aset_object_surface(&surface, scene, object);
            normal = surface.geometric;
            break;
        }
    }
    ray->direction = random_direction(r);
    if (in_surface) {
        dvec along = dvec_unit(dvec_cross(dvec_of(ray->direction), dvec_of(normal)));
        ray->direction = dvec_real(along);
        ray->origin = dvec_real(dvec_along(dvec_of(ray->origin), -size_of(scene) * random_between(r, 0, 1), along));
    }
}

static aset_ray random_ray(random_state *r, const aset_space *space, ray_sort sort) {
    const aset_scene *scene = space->scene;
    aset_ray ray = random_ray_common(r, space, sort, false);
    switch (sort) {
    case THROUGH_CORNERS: put_through_corners(&ray, r, space); break;
    case FROM_SURFACE: put_on_surface(&ray, r, scene, false); break;
    case IN_SURFACE: put_on_surface(&ray, r, scene, true); break;
    case FROM_FAR: {
        double distance = size_of(scene) * pow(10, random_between(r, 0.5, 7));
        dvec near = random_chance(r, 0.5) ? random_in_scene(r, scene, 0) : random_on_box(r, scene);
        ray.origin = dvec_real(dvec_along(near, distance, dvec_of(random_direction(r))));
        ray.direction = dvec_real(dvec_unit(dvec_sub(near, dvec_of(ray.origin))));
        break;
    }
    default: break;
    }
    return ray;
}

/* --- one ray through both --- */

typedef struct match {
    duel duel;
    uint64_t brute_tests, other_tests; /* of the closest hits */
} match;

static void compare_queries(match *m, const aset_ray *ray, ray_sort sort) {
    duel *d = &m->duel;
    aset_statistics brute, other;
    bool any, expected_any;
    uint32_t n_objects = d->stage->scene.counts.objects;
    memset(&brute, 0, sizeof brute);
    memset(&other, 0, sizeof other);
    bool found = duel_closest(d, ray, sort, &brute, &other);
    check(brute.tests == n_objects, DUEL_TEXT, DUEL_ARGS(d, sort));
    m->brute_tests += brute.tests;
    m->other_tests += other.tests;
    assert_int_equal(aset_any_hit(&expected_any, &d->brute, ray, false, &brute), ASET_OK);
    assert_int_equal(aset_any_hit(&any, &d->other, ray, false, &other), ASET_OK);
    check(any == found && expected_any == found, DUEL_TEXT, DUEL_ARGS(d, sort));
    check(brute.tests == 2 * n_objects, DUEL_TEXT, DUEL_ARGS(d, sort));
}

static void run_match(match *m, const stage *s, const aset_space *brute, const aset_space *space, uint32_t n_rays) {
    duel *d = &m->duel;
    random_state r = random_start(d->seed);
    duel_open(d, s, brute, space);
    for (uint32_t i = 0; i < n_rays; i++, d->rays++) {
        ray_sort sort = sorts[i % COUNT_OF(sorts)];
        aset_ray ray = random_ray(&r, space, sort);
        compare_queries(m, &ray, sort);
        if (sort != FROM_FAR && i % 3 == 0) {
            inspection in;
            memset(&in, 0, sizeof in);
            in.walk.visit = inspect;
            ray = brought_near(&s->scene, &ray);
            inspect_walk(&in, d, &ray, sort);
            inspect_seen(d, &ray, sort);
        }
    }
    duel_close(d);
}

static const uint32_t grids[][3] = {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {7, 7, 7}, {30, 30, 30}, {5, 1, 13}, {1, 40, 2},
                                    {64, 3, 9}};

/* What a model is put into: each method in some forms; share: one in so many of the rays. */
static const struct {
    const aset_method *method;
    uint32_t n[3], depth, leaf, share;
} forms[] = {
    {&aset_mset, {1, 1, 1}, 0, 0, 1},   {&aset_mset, {2, 2, 2}, 0, 0, 1},    {&aset_mset, {3, 3, 3}, 0, 0, 1},
    {&aset_mset, {7, 7, 7}, 0, 0, 1},   {&aset_mset, {30, 30, 30}, 0, 0, 1}, {&aset_mset, {5, 1, 13}, 0, 0, 1},
    {&aset_mset, {1, 40, 2}, 0, 0, 1},  {&aset_mset, {64, 3, 9}, 0, 0, 1},   {&aset_set, {4, 4, 4}, 0, 0, 3},
    {&aset_set, {30, 2, 7}, 0, 0, 3},   {&aset_set, {400, 400, 400}, 0, 0, 3}, {&aset_grid, {1, 1, 1}, 0, 0, 3},
    {&aset_grid, {7, 7, 7}, 0, 0, 3},   {&aset_grid, {30, 1, 12}, 0, 0, 3},  {&aset_octree, {0, 0, 0}, 1, 1, 3},
    {&aset_octree, {0, 0, 0}, 4, 1, 3}, {&aset_octree, {0, 0, 0}, 6, 5, 3},  {&aset_arts, {0, 0, 0}, 2, 2, 3},
    {&aset_arts, {0, 0, 0}, 5, 1, 3},   {&aset_excell, {0, 0, 0}, 1, 1, 3},  {&aset_excell, {0, 0, 0}, 4, 3, 3},
};

static void build_form(stage *s, aset_space *space, size_t form) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, forms[form].n, sizeof options.divisions);
    options.depth = forms[form].depth;
    options.leaf = forms[form].leaf;
    aset_status status = aset_space_build(space, &s->scene, forms[form].method, &options, &s->arena);
    check(status == ASET_OK, "%s: status %d, %zu bytes missing", aset_method_name(forms[form].method), (int)status,
          s->arena.missing);
}

/* The model in every form. Frees it. The rays that hit in MSET. */
static uint64_t duel_model(model *m, const char *name, uint64_t seed, uint32_t n_rays) {
    uint64_t hits = 0;
    for (size_t f = 0; f < COUNT_OF(forms); f++) {
        stage s;
        aset_space brute, space;
        match d;
        memset(&d, 0, sizeof d);
        d.duel.name = name;
        d.duel.seed = seed + 1000 * f;
        d.duel.depth = forms[f].depth;
        d.duel.leaf = forms[f].leaf;
        stage_open_model(&s, m, ROOM);
        stage_space(&s, &brute, &aset_brute, 1, 1, 1);
        build_form(&s, &space, f);
        run_match(&d, &s, &brute, &space, n_rays / forms[f].share);
        hits += forms[f].method == &aset_mset ? d.duel.hits : 0;
        stage_close(&s);
    }
    model_free(m);
    return hits;
}

/* --- equal to brute force --- */

static void test_space__all_equal_brute_on_small_objects(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        model_random(&m, &r, 80, 5, 0.2, 1.5);
        assert_true(duel_model(&m, "small objects", r.seed, 1200) > 300);
    }
}

/* More large ones than a space may list apart. */
static void test_space__all_equal_brute_on_large_objects(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3; i++) {
        random_state r = random_start(seed_of(10 + i));
        model m;
        model_random(&m, &r, 40, 5, 3, 12);
        for (uint32_t k = 0; k < 30; k++) {
            model_random_thing(&m, &r, 5, 0.5);
        }
        assert_true(duel_model(&m, "large objects", r.seed, 900) > 600);
    }
}

/* A few large ones among many: the list's purpose. */
static void test_space__all_equal_brute_on_mixed_sizes(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 4; i++) {
        random_state r = random_start(seed_of(20 + i));
        model m;
        model_random(&m, &r, 60, 5, 0.1, 0.8);
        for (uint32_t k = 0; k < 3 + 5 * i; k++) {
            model_random_thing(&m, &r, 4, random_between(&r, 4, 10));
        }
        assert_true(duel_model(&m, "mixed sizes", r.seed, 700) > 150);
    }
}

static void test_space__all_equal_brute_away_from_the_origin(void **state) {
    (void)state;
    for (size_t i = 0; i < FAR_PLACES; i++) {
        random_state r = random_start(seed_of(30 + i));
        model m;
        model_random(&m, &r, 50, 5, 0.3, 4);
        model_move(&m, far_places + i);
        assert_true(duel_model(&m, "moved", r.seed, 400) > 80);
    }
}

static void test_space__all_equal_brute_on_procedural_scenes(void **state) {
    (void)state;
    for (size_t i = 0; i < SPD_SCENES; i++) {
        for (size_t f = i % 2; f < COUNT_OF(forms); f += 2) {
            stage s;
            aset_space brute, space;
            match d;
            memset(&d, 0, sizeof d);
            d.duel.name = small_scenes[i].name;
            d.duel.seed = seed_of(40 + 100 * i + f);
            d.duel.depth = forms[f].depth;
            d.duel.leaf = forms[f].leaf;
            if (stage_open_procedural(&s, small_scenes[i].name, small_scenes[i].size, ROOM)) {
                stage_space(&s, &brute, &aset_brute, 1, 1, 1);
                build_form(&s, &space, f);
                run_match(&d, &s, &brute, &space, 300);
                assert_true(d.duel.hits > 25);
                stage_close(&s);
            }
        }
    }
}

/* --- hostile scenes --- */

#if ASET_WITH_POLYGONS
static void test_space__objects_in_one_plane(void **state) {
    (void)state;
    for (int axis = 0; axis < 3; axis++) {
        random_state r = random_start(seed_of(200 + (uint64_t)axis));
        model m;
        model_random(&m, &r, 0, 1, 1, 1);
        model_in_one_plane(&m, &r, axis, 50);
        assert_true(duel_model(&m, "one plane", r.seed, 500) > 150);
    }
}

/* From as far as a million scenes, straight at the corners of what lies in one plane: nearly all is up to rounding. */
static void test_space__far_rays_at_the_edges_of_a_flat_scene(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3 * COUNT_OF(forms); i++) {
        random_state r = random_start(seed_of(400 + i));
        int axis = (int)(i % 3);
        model m;
        stage s;
        aset_space brute, space;
        model_start(&m);
        for (int k = 0; k < 20; k++) {
            aset_vec3 corner = {R(2.5), R(2.5), R(2.5)}, u = {0, 0, 0}, v = {0, 0, 0};
            set_axis(&corner, (axis + 1) % 3, (aset_real)random_below(&r, 9));
            set_axis(&corner, (axis + 2) % 3, (aset_real)random_between(&r, -4, 4));
            set_axis(&u, (axis + 1) % 3, (aset_real)(1 + random_below(&r, 3)));
            set_axis(&v, (axis + 2) % 3, (aset_real)random_between(&r, 0.2, 3));
            model_rectangle(&m, corner, u, v);
        }
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &brute, &aset_brute, 1, 1, 1);
        build_form(&s, &space, i / 3);
        aset_tracer a = stage_tracer(&s, &brute), b = stage_tracer(&s, &space);
        for (int k = 0; k < 1500; k++) {
            aset_ray ray = random_ray(&r, &space, FROM_FAR);
            check(same_closest(&a, &b, &ray, NULL), SEED ", ray %d", r.seed, k);
        }
        stage_close(&s);
        model_free(&m);
    }
}

/* A scene of no size: it must build, and nothing is ever hit. */
static void test_space__objects_in_one_point(void **state) {
    (void)state;
    static const aset_vec3 places[2] = {{0, 0, 0}, {1, 2, -3}};
    for (int i = 0; i < 2; i++) {
        model m;
        model_start(&m);
        model_in_one_point(&m, places[i], 20);
        assert_true(duel_model(&m, "one point", seed_of(210), 200) == 0);
    }
}

static void test_space__objects_in_slices(void **state) {
    (void)state;
    random_state r = random_start(seed_of(220));
    model m;
    model_start(&m);
    model_in_slices(&m, &r);
    stage s;
    aset_space brute, space;
    match d;
    stage_open_model(&s, &m, ROOM);
    stage_space(&s, &brute, &aset_brute, 1, 1, 1);
    stage_space(&s, &space, &aset_mset, 4, 4, 4);
    memset(&d, 0, sizeof d);
    d.duel.name = "in slices";
    d.duel.seed = r.seed;
    run_match(&d, &s, &brute, &space, 8000);
    assert_true(d.duel.hits > 2000);
    aset_tracer a = stage_tracer(&s, &brute), b = stage_tracer(&s, &space);
    for (int i = 0; i < 8000; i++) {
        aset_ray ray = random_whole_ray(&r);
        check(same_closest(&a, &b, &ray, NULL), SEED ", ray %d", r.seed, i);
    }
    stage_close(&s);
    model_free(&m);
}
#endif

#if ASET_WITH_SPHERES
/* At equal t the object added first wins, in every grid. */
static void test_space__thousand_coincident_spheres(void **state) {
    (void)state;
    random_state r = random_start(seed_of(230));
    model m;
    stage s;
    model_start(&m);
    for (int i = 0; i < 1000; i++) {
        model_sphere(&m, real3(1, 2, 3), 2);
    }
    stage_open_model(&s, &m, (size_t)64 << 20);
    for (size_t g = 0; g < 4; g++) {
        aset_space space;
        aset_mark mark = aset_arena_mark(&s.arena);
        stage_space(&s, &space, &aset_mset, grids[g][0], grids[g][1], grids[g][2]);
        aset_tracer tracer = stage_tracer(&s, &space);
        for (int i = 0; i < 200; i++) {
            aset_ray ray = random_ray(&r, &space, sorts[i % ALONG_BOX]);
            aset_real t = object_hit(&s.scene, 0, ray.origin, dvec_real(dvec_unit(dvec_of(ray.direction))));
            aset_hit hit;
            bool found;
            aset_statistics statistics;
            memset(&statistics, 0, sizeof statistics);
            ray.t_max = REAL_INFINITY;
            assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, &statistics), ASET_OK);
            check(found == (t < REAL_INFINITY), SEED ", ray %d", r.seed, i);
            check(!found || hit.object == 0, SEED ", ray %d: object %" PRIu32, r.seed, i, hit.object);
            check(statistics.tests <= 1000, SEED ", ray %d", r.seed, i);
        }
        aset_arena_release(&s.arena, &mark);
    }
    stage_close(&s);
    model_free(&m);
}

static void test_space__one_object_a_million_times_larger(void **state) {
    (void)state;
    random_state r = random_start(seed_of(240));
    model m;
    model_random(&m, &r, 40, 5, 0.5, 2);
    model_sphere(&m, real3(0, 0, -1e6), 1e6);
    stage s;
    stage_open_model(&s, &m, ROOM);
    for (size_t g = 0; g < COUNT_OF(grids); g++) {
        aset_space brute, space;
        aset_mark mark = aset_arena_mark(&s.arena);
        stage_space(&s, &brute, &aset_brute, 1, 1, 1);
        stage_space(&s, &space, &aset_mset, grids[g][0], grids[g][1], grids[g][2]);
        aset_tracer a = stage_tracer(&s, &brute), b = stage_tracer(&s, &space);
        uint32_t hits = 0;
        for (int i = 0; i < 500; i++) {
            aset_ray ray = random_ray_from(&r, 10);
            bool found;
            ray.origin.z += 10;
            check(same_closest(&a, &b, &ray, &found), SEED ", ray %d", r.seed, i);
            hits += found;
        }
        assert_true(hits > 150);
        aset_arena_release(&s.arena, &mark);
    }
    stage_close(&s);
    assert_true(duel_model(&m, "a million times larger", r.seed, 300) > 100);
}
#endif

static aset_status emit_nothing(const aset_sink *sink, const void *context) {
    (void)sink, (void)context;
    return ASET_OK;
}

static void test_space__scene_without_objects(void **state) {
    (void)state;
    const aset_method *const methods[2] = {&aset_brute, &aset_mset};
    for (int i = 0; i < 2; i++) {
        random_state r = random_start(seed_of(250));
        stage s;
        aset_space space;
        stage_open(&s, emit_nothing, NULL, 4096);
        stage_space(&s, &space, methods[i], 3, 3, 3);
        assert_int_equal(space.structure.nonempty, 0);
        assert_int_equal(space.structure.references, 0);
        aset_tracer tracer = stage_tracer(&s, &space);
        for (int k = 0; k < 100; k++) {
            aset_ray ray = random_ray_from(&r, 2);
            aset_hit hit;
            bool found = true;
            assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, NULL), ASET_OK);
            assert_false(found);
            found = true;
            assert_int_equal(aset_any_hit(&found, &tracer, &ray, false, NULL), ASET_OK);
            assert_false(found);
        }
        stage_close(&s);
    }
}

/* Rays from where float ends: no crash, and both agree that it is a miss or what is hit. */
static void test_space__rays_from_the_end_of_the_range(void **state) {
    (void)state;
    random_state r = random_start(seed_of(260));
    model m;
    stage s;
    aset_space brute, space;
    model_random(&m, &r, 30, 5, 0.5, 2);
    stage_open_model(&s, &m, ROOM);
    stage_space(&s, &brute, &aset_brute, 1, 1, 1);
    stage_space(&s, &space, &aset_mset, 6, 7, 8);
    aset_tracer a = stage_tracer(&s, &brute), b = stage_tracer(&s, &space);
    for (int i = 0; i < 3000; i++) {
        dvec way = dvec_of(random_direction(&r));
        double distance = pow(10, random_between(&r, 8, 37));
        aset_ray ray = {dvec_real(dvec_along(dvec_make(0, 0, 0), distance, way)), dvec_real(way), REAL_INFINITY};
        ray.direction = i % 2 == 0 ? dvec_real(dvec_along(dvec_make(0, 0, 0), -1, way)) : ray.direction;
        aset_hit expected, hit;
        bool expected_found, found;
        assert_int_equal(aset_closest_hit(&expected_found, &expected, &a, &ray, false, NULL), ASET_OK);
        assert_int_equal(aset_closest_hit(&found, &hit, &b, &ray, false, NULL), ASET_OK);
        check(found == expected_found && (!found || same_hit(&hit, &expected)), SEED ", ray %d", r.seed, i);
        check(i % 2 == 0 || !found, SEED ", ray %d goes away", r.seed, i);
    }
    stage_close(&s);
    model_free(&m);
}

/* --- work --- */

static void test_space__mset_tests_far_fewer_objects(void **state) {
    (void)state;
    random_state r = random_start(seed_of(270));
    model m;
    stage s;
    aset_space brute, space;
    match d;
    memset(&d, 0, sizeof d);
    model_random(&m, &r, 300, 5, 0.1, 0.4);
    stage_open_model(&s, &m, ROOM);
    stage_space(&s, &brute, &aset_brute, 1, 1, 1);
    stage_space(&s, &space, &aset_mset, 20, 20, 20);
    d.duel.name = "many small";
    d.duel.seed = r.seed;
    run_match(&d, &s, &brute, &space, 2000);
    assert_int_equal(d.brute_tests, 2000 * 300);
    assert_true(d.other_tests * 10 < d.brute_tests);
    stage_close(&s);
    model_free(&m);
}

/* tests = rays x objects; test_hits = how many of them hit before t_max, whether nearest or not. */
static void test_space__brute_counts_every_test_and_hit(void **state) {
    (void)state;
    random_state r = random_start(seed_of(280));
    model m;
    stage s;
    aset_space brute;
    aset_statistics statistics;
    uint64_t hits = 0;
    memset(&statistics, 0, sizeof statistics);
    model_random(&m, &r, 60, 3, 0.5, 4);
    stage_open_model(&s, &m, 0);
    stage_space(&s, &brute, &aset_brute, 1, 1, 1);
    aset_tracer tracer = stage_tracer(&s, &brute);
    for (uint32_t i = 0; i < 500; i++) {
        aset_ray ray = random_ray(&r, &brute, FROM_OUTSIDE);
        aset_hit hit;
        bool found;
        for (uint32_t k = 0; k < 60; k++) {
            hits += object_hit(&s.scene, k, ray.origin, dvec_real(dvec_of(ray.direction))) < ray.t_max;
        }
        assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, &statistics), ASET_OK);
        check(statistics.tests == 60 * (i + 1), SEED ", ray %" PRIu32, r.seed, i);
        check(statistics.test_hits == hits, SEED ", ray %" PRIu32 ": %" PRIu64 " hits, not %" PRIu64, r.seed, i,
              statistics.test_hits, hits);
        check(statistics.cells_visited == i + 1 && statistics.nonempty_visited == i + 1, SEED, r.seed);
    }
    stage_close(&s);
    model_free(&m);
}

/* --- marks --- */

typedef struct listing {
    uint8_t *refers; /* cell * objects + object */
    uint32_t n_objects, last_cell, last_object;
    bool disorder, twice;
} listing;

static void list_cell(void *context, uint32_t cell, const uint32_t *objects, uint32_t n) {
    listing *l = context;
    for (uint32_t i = 0; i < n; i++) {
        bool first = cell != l->last_cell;
        l->disorder = l->disorder || (l->last_cell != UINT32_MAX && cell < l->last_cell) ||
                      (!first && objects[i] <= l->last_object);
        l->last_cell = cell;
        l->last_object = objects[i];
        uint8_t *refers = l->refers + (size_t)cell * l->n_objects + objects[i];
        l->twice = l->twice || *refers != 0;
        *refers = 1;
    }
}

/* Every cell, marked or not, against the rule; every reference against the rule. */
static void check_marks(const stage *s, const aset_space *space, uint64_t seed) {
    const uint32_t *n = space->slices.n;
    uint32_t n_objects = s->scene.counts.objects, n_cells = 0;
    uint64_t n_references = 0;
    listing l = {calloc((size_t)space->cells.n_cells * n_objects + 1, 1), n_objects, UINT32_MAX, 0, false, false};
    uint8_t *used = calloc(space->cells.n_cells + 1, 1);
    int32_t (*low)[3] = malloc(n_objects * sizeof *low), (*high)[3] = malloc(n_objects * sizeof *high);
    space->method->each_cell(space, list_cell, &l);
    check(!l.disorder && !l.twice, SEED, seed);
    for (uint32_t i = 0; i < n_objects; i++) {
        expected_box(space, i, low[i], high[i]);
    }
    int32_t v[3] = {0, 0, 0};
    do {
        for (uint32_t face = 0; face < 6; face++) {
            uint32_t cell = cell_number(space, v, face), n_here = 0;
            for (uint32_t i = 0; i < n_objects; i++) {
                bool marked = expected_marked(low[i], high[i], v, face);
                n_here += marked;
                check(!marked || cell != UINT32_MAX, SEED ", object %" PRIu32 " missing", seed, i);
                check(cell == UINT32_MAX || (l.refers[(size_t)cell * n_objects + i] != 0) == marked,
                      SEED ", voxel %d %d %d, face %" PRIu32 ", object %" PRIu32, seed, (int)v[0], (int)v[1],
                      (int)v[2], face, i);
            }
            check((n_here > 0) == (cell != UINT32_MAX), SEED, seed);
            check(n_here == 0 || (cell < space->cells.n_cells && used[cell] == 0), SEED, seed);
            used[n_here > 0 ? cell : space->cells.n_cells] = 1;
            n_cells += n_here > 0;
            n_references += n_here;
        }
    } while (voxel_next(v, n));
    check(n_cells == space->structure.nonempty && n_cells == space->cells.n_cells, SEED, seed);
    check(n_references == space->structure.references, SEED, seed);
    check(space->structure.leaves == 2 * ((uint64_t)(n[0] + 1) * n[1] * n[2] + (uint64_t)n[0] * (n[1] + 1) * n[2] +
                                          (uint64_t)n[0] * n[1] * (n[2] + 1)), SEED, seed);
    check(space->structure.interior == 0, SEED, seed);
    free(l.refers);
    free(used);
    free(low);
    free(high);
}

static void test_space__objects_are_marked_on_their_six_layers(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(300 + i));
        model m;
        stage s;
        model_random(&m, &r, 30, 5, 0.1, 6);
        stage_open_model(&s, &m, ROOM);
        for (size_t g = 0; g < COUNT_OF(grids); g++) {
            if (grids[g][0] * grids[g][1] * grids[g][2] > 10000 && i > 0) {
                continue;
            }
            aset_space space;
            aset_mark mark = aset_arena_mark(&s.arena);
            stage_space(&s, &space, &aset_mset, grids[g][0], grids[g][1], grids[g][2]);
            check_marks(&s, &space, r.seed);
            aset_arena_release(&s.arena, &mark);
        }
        stage_close(&s);
        model_free(&m);
    }
}

/* The voxel that holds x is exactly the last whose lower slice is not above x: to the last bit, on every slice. */
static void test_space__slices_are_located_exactly(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 40; i++) {
        random_state r = random_start(seed_of(310 + i));
        model m;
        stage s;
        aset_space space;
        uint32_t n = 1 + random_below(&r, 100);
        model_random(&m, &r, 10, random_between(&r, 0.1, 1000), 0.01, 4);
        const far_place place = {1, dvec_of(random_in_cube(&r, 1000))};
        model_move(&m, &place);
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &space, &aset_mset, n, 1, 2);
        for (int32_t k = 1; k < (int32_t)n; k++) {
            aset_real plane = slices_plane(&space.slices, 0, k);
#if ASET_REAL_BITS == 32
            aset_real below = nextafterf(plane, -REAL_INFINITY), above = nextafterf(plane, REAL_INFINITY);
#else
            aset_real below = nextafter(plane, -REAL_INFINITY), above = nextafter(plane, REAL_INFINITY);
#endif
            check(aset_slices_locate(&space.slices, 0, plane) == k, SEED ", slice %d of %" PRIu32, r.seed, (int)k, n);
            check(aset_slices_locate(&space.slices, 0, below) == k - 1, SEED ", slice %d of %" PRIu32, r.seed, (int)k, n);
            check(aset_slices_locate(&space.slices, 0, above) == k, SEED ", slice %d of %" PRIu32, r.seed, (int)k, n);
        }
        check(aset_slices_locate(&space.slices, 0, R(-1e30)) == 0, SEED, r.seed);
        check(aset_slices_locate(&space.slices, 0, R(1e30)) == (int32_t)n - 1, SEED, r.seed);
        stage_close(&s);
        model_free(&m);
    }
}

/* The slices span the scene's box, and a little more: no object's box reaches beyond the outermost. */
static void test_space__slices_span_the_scene(void **state) {
    (void)state;
    random_state r = random_start(seed_of(320));
    for (size_t g = 0; g < COUNT_OF(grids); g++) {
        model m;
        stage s;
        aset_space space;
        model_random(&m, &r, 10, 50, 0.5, 4);
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &space, &aset_mset, grids[g][0], grids[g][1], grids[g][2]);
        for (int a = 0; a < 3; a++) {
            double l = (double)axis_of(s.scene.low, a), h = (double)axis_of(s.scene.high, a);
            double first = (double)slices_plane(&space.slices, a, 0);
            double last = (double)slices_plane(&space.slices, a, (int32_t)grids[g][a]);
            assert_int_equal(space.slices.n[a], grids[g][a]);
            assert_true(first < l && last > h);
            assert_true(first > l - 1e-3 * size_of(&s.scene) && last < h + 1e-3 * size_of(&s.scene));
        }
        stage_close(&s);
        model_free(&m);
    }
}

static void test_space__brute_is_one_cell(void **state) {
    (void)state;
    random_state r = random_start(seed_of(330));
    model m;
    stage s;
    aset_space space;
    model_random(&m, &r, 30, 5, 0.1, 6);
    stage_open_model(&s, &m, 0);
    stage_space(&s, &space, &aset_brute, 9, 9, 9);
    assert_int_equal(space.structure.leaves, 1);
    assert_int_equal(space.structure.nonempty, 1);
    assert_int_equal(space.structure.references, 30);
    assert_int_equal(space.structure.interior, 0);
    assert_string_equal(aset_method_name(&aset_brute), "brute");
    assert_string_equal(aset_method_name(&aset_mset), "mset");
    stage_close(&s);
    model_free(&m);
}

/* --- options --- */

static void test_space__refuses_bad_arguments(void **state) {
    (void)state;
    random_state r = random_start(seed_of(340));
    model m;
    stage s;
    aset_space space;
    aset_space_size size;
    aset_space_options options;
    model_random(&m, &r, 10, 5, 0.1, 1);
    stage_open_model(&s, &m, ROOM);
    size_t used = s.arena.used;
    static const uint32_t bad[][3] = {{0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {ASET_DIVISIONS_MAX + 1, 1, 1},
                                      {1, UINT32_MAX, 1}, {4, 4, ASET_DIVISIONS_MAX + 1}};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        memset(&options, 0, sizeof options);
        memcpy(options.divisions, bad[i], sizeof bad[i]);
        assert_int_equal(aset_space_build(&space, &s.scene, &aset_mset, &options, &s.arena), ASET_ERR_ARGUMENT);
        assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, &options, &s.arena), ASET_ERR_ARGUMENT);
    }
    assert_int_equal(aset_space_build(NULL, &s.scene, &aset_mset, NULL, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_space_build(&space, NULL, &aset_mset, NULL, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_space_build(&space, &s.scene, NULL, NULL, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_space_build(&space, &s.scene, &aset_mset, NULL, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_space_measure(NULL, &s.scene, &aset_mset, NULL, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_space_measure(&size, NULL, &aset_mset, NULL, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_space_measure(&size, &s.scene, NULL, NULL, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(s.arena.used, used);
    aset_space_size before; /* a measurement that fails leaves the last one as it is */
    memset(&options, 0, sizeof options);
    options.depth = ASET_DEPTH_TREE_MAX + 1;
    assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, NULL, &s.arena), ASET_OK);
    memcpy(&before, &size, sizeof size);
    assert_int_equal(aset_space_measure(&size, &s.scene, &aset_octree, &options, &s.arena), ASET_ERR_ARGUMENT);
    assert_memory_equal(&size, &before, sizeof size);
    stage_space(&s, &space, &aset_mset, ASET_DIVISIONS_MAX, 1, 2); /* the largest allowed */
    stage_close(&s);
    model_free(&m);
    model_random(&m, &r, 300, 5, 0.1, 1); /* more than a kilobyte of the stack can measure a tree over */
    stage_open_model(&s, &m, ROOM);
    assert_int_equal(aset_space_measure(&size, &s.scene, &aset_octree, NULL, NULL), ASET_ERR_NOMEM);
    assert_true(size.scratch > 1024);
    before.scratch = size.scratch;
    assert_memory_equal(&size, &before, sizeof size);
    stage_close(&s);
    model_free(&m);
}

#if ASET_WITH_SPHERES
/* 6 x 2048^2 references for each: 171 are more than 32 bits can number. */
static void test_space__too_many_references(void **state) {
    (void)state;
    model m;
    stage s;
    aset_space space;
    aset_space_size size;
    aset_space_options options;
    memset(&options, 0, sizeof options);
    options.divisions[0] = options.divisions[1] = options.divisions[2] = ASET_DIVISIONS_MAX;
    model_start(&m);
    for (int i = 0; i < 171; i++) {
        model_sphere(&m, real3(0, 0, 0), 1);
    }
    stage_open_model(&s, &m, 1 << 16);
    size_t used = s.arena.used;
    assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, &options, NULL), ASET_ERR_LIMIT);
    assert_int_equal(aset_space_build(&space, &s.scene, &aset_mset, &options, &s.arena), ASET_ERR_LIMIT);
    assert_int_equal(s.arena.used, used);
    stage_close(&s);
    model_free(&m);
}

static void auto_divisions(uint32_t n_objects, dvec spread, size_t budget, uint32_t divisions[3]) {
    random_state r = random_start(seed_of(350));
    model m;
    stage s;
    model_start(&m);
    for (uint32_t i = 0; i < n_objects; i++) {
        dvec p = dvec_of(random_in_cube(&r, 1));
        dvec at = i < 2 ? dvec_make(i * 2.0 - 1, i * 2.0 - 1, i * 2.0 - 1) : p;
        model_sphere(&m, real3(at.x * spread.x, at.y * spread.y, at.z * spread.z), 1e-6);
    }
    stage_open_model(&s, &m, 0);
    aset_auto_divisions(&s.scene, budget, divisions);
    stage_close(&s);
    model_free(&m);
}

static void test_space__automatic_divisions(void **state) {
    (void)state;
    static const struct {
        uint32_t objects, divisions;
    } cases[] = {{1, 4}, {8, 8}, {27, 12}, {1000, 40}, {8000, 80}, {32768, 128}, {50000, 147}};
    const dvec cube = {1, 1, 1}, flat = {1, 1, 0.0004}, almost = {1, 1, 0.002}, line = {0.0001, 1, 0};
    uint32_t n[3];
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        auto_divisions(cases[i].objects, cube, 0, n);
        check(n[0] == cases[i].divisions && n[1] == n[0] && n[2] == n[0], "%" PRIu32 " objects: %" PRIu32,
              cases[i].objects, n[0]);
    }
    auto_divisions(1000, flat, 0, n);
    assert_true(n[0] == 400 && n[1] == 400 && n[2] == 1); /* cbrt(64 000 / 0.001) */
    auto_divisions(1000, almost, 0, n);
    assert_true(n[0] == 317 && n[1] == 317 && n[2] == 1); /* cbrt(64 000 / 0.002) = 317.5 less the spheres' own size */
    auto_divisions(1000, line, 0, n);
    assert_true(n[0] == 1 && n[1] == 512 && n[2] == 1); /* the most */
}

/* The map of blocks stays below half of the budget, and is not smaller than need be. */
static void test_space__automatic_divisions_within_a_budget(void **state) {
    (void)state;
    const dvec cube = {1, 1, 1};
    uint32_t n[3], last = 0;
    for (size_t budget = 64; budget < 400000; budget += budget / 3) {
        auto_divisions(20000, cube, budget, n);
        uint64_t map = 12 * ASET_BLOCK_WORDS(n[0], n[1], n[2], 6u);
        check(n[0] == 1 || map <= budget / 2, "budget %zu: %" PRIu32 " divisions, %" PRIu64 " bytes", budget, n[0], map);
        check(n[0] >= last, "budget %zu: %" PRIu32 " divisions, fewer than before", budget, n[0]);
        check(n[0] >= 100 || map * 8 >= budget || budget < 400, "budget %zu: %" PRIu32 " divisions only", budget, n[0]);
        last = n[0];
    }
    auto_divisions(20000, cube, 400000, n);
    assert_int_equal(n[0], 109);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_space__all_equal_brute_on_small_objects),
        cmocka_unit_test(test_space__all_equal_brute_on_large_objects),
        cmocka_unit_test(test_space__all_equal_brute_on_mixed_sizes),
        cmocka_unit_test(test_space__all_equal_brute_away_from_the_origin),
        cmocka_unit_test(test_space__all_equal_brute_on_procedural_scenes),
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_space__objects_in_one_plane),
        cmocka_unit_test(test_space__far_rays_at_the_edges_of_a_flat_scene),
        cmocka_unit_test(test_space__objects_in_one_point),
        cmocka_unit_test(test_space__objects_in_slices),
#endif
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_space__thousand_coincident_spheres),
        cmocka_unit_test(test_space__one_object_a_million_times_larger),
#endif
        cmocka_unit_test(test_space__scene_without_objects),
        cmocka_unit_test(test_space__rays_from_the_end_of_the_range),
        cmocka_unit_test(test_space__mset_tests_far_fewer_objects),
        cmocka_unit_test(test_space__brute_counts_every_test_and_hit),
        cmocka_unit_test(test_space__objects_are_marked_on_their_six_layers),
        cmocka_unit_test(test_space__slices_are_located_exactly),
        cmocka_unit_test(test_space__slices_span_the_scene),
        cmocka_unit_test(test_space__brute_is_one_cell),
        cmocka_unit_test(test_space__refuses_bad_arguments),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_space__too_many_references),
        cmocka_unit_test(test_space__automatic_divisions),
        cmocka_unit_test(test_space__automatic_divisions_within_a_budget),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
