/* test_scene.c - sinks: what the counter counts, what the builder keeps, what both refuse, and bounds. */
#include "support/support.h"

#include "scene/shape.h"

#include <float.h>

#define PI 3.14159265358979323846

static const aset_vec3 somewhere = {1, 2, 3}, elsewhere = {4, 5, 7};

static bool same_counts(const aset_counts *a, const aset_counts *b) {
    return a->objects == b->objects && a->polygons == b->polygons && a->patches == b->patches &&
           a->spheres == b->spheres && a->cones == b->cones && a->materials == b->materials && a->lights == b->lights &&
           a->coordinates == b->coordinates;
}

static bool same_vec(const aset_vec3 *a, const aset_vec3 *b) {
    return a->x == b->x && a->y == b->y && a->z == b->z;
}

/* --- a sink that looks whether a refused entity left a trace in the scene --- */

typedef struct trace_of {
    aset_counts counts;
    aset_vec3 low, high;
    aset_colour background;
    uint32_t n_uncoloured;
    uint64_t contents; /* a check sum of all that is stored */
} trace_of;

typedef struct watch {
    aset_sink inner;
    const aset_scene *scene;
    trace_of before; /* after the last whole entity */
    uint32_t n_refused;
    bool traces;
} watch;

static uint64_t check_sum(uint64_t sum, const void *bytes, size_t n) {
    const unsigned char *b = bytes;
    for (size_t i = 0; i < n; i++) {
        sum = (sum ^ b[i]) * UINT64_C(1099511628211);
    }
    return sum;
}

static trace_of look(const aset_scene *s) {
    trace_of t = {s->counts, s->low, s->high, s->background, s->n_uncoloured, UINT64_C(14695981039346656037)};
    t.contents = check_sum(t.contents, s->objects, s->counts.objects * sizeof *s->objects);
    t.contents = check_sum(t.contents, s->coordinates, (size_t)s->counts.coordinates * sizeof *s->coordinates);
    t.contents = check_sum(t.contents, s->materials, s->counts.materials * sizeof *s->materials);
    t.contents = check_sum(t.contents, s->lights, s->counts.lights * sizeof *s->lights);
    return t;
}

static bool same_trace(const trace_of *a, const trace_of *b) {
    return same_counts(&a->counts, &b->counts) && same_vec(&a->low, &b->low) && same_vec(&a->high, &b->high) &&
           a->background.r == b->background.r && a->background.g == b->background.g &&
           a->background.b == b->background.b && a->n_uncoloured == b->n_uncoloured && a->contents == b->contents;
}

static aset_status watched(watch *w, aset_status status) {
    trace_of now = look(w->scene);
    if (status != ASET_OK) {
        w->n_refused++;
        w->traces = w->traces || !same_trace(&now, &w->before);
    }
    return status;
}

/* For what is a whole entity, or the end of one. */
static aset_status watched_whole(watch *w, aset_status status) {
    if (watched(w, status) == ASET_OK) {
        w->before = look(w->scene);
    }
    return status;
}

static aset_status watch_background(void *context, const aset_colour *colour) {
    watch *w = context;
    return watched_whole(w, w->inner.background(w->inner.context, colour));
}

static aset_status watch_view(void *context, const aset_view *view) {
    watch *w = context;
    return watched_whole(w, w->inner.view(w->inner.context, view));
}

static aset_status watch_light(void *context, const aset_light *light) {
    watch *w = context;
    return watched_whole(w, w->inner.light(w->inner.context, light));
}

static aset_status watch_material(void *context, const aset_material *material) {
    watch *w = context;
    return watched_whole(w, w->inner.material(w->inner.context, material));
}

#if ASET_WITH_POLYGONS
static aset_status watch_begin(void *context, uint32_t n_points, bool with_normals) {
    watch *w = context;
    return watched(w, w->inner.polygon_begin(w->inner.context, n_points, with_normals));
}

static aset_status watch_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    watch *w = context;
    return watched(w, w->inner.polygon_point(w->inner.context, point, normal));
}

static aset_status watch_end(void *context) {
    watch *w = context;
    return watched_whole(w, w->inner.polygon_end(w->inner.context));
}
#endif

#if ASET_WITH_SPHERES
static aset_status watch_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    watch *w = context;
    return watched_whole(w, w->inner.sphere(w->inner.context, centre, radius));
}
#endif

#if ASET_WITH_CONES
static aset_status watch_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                              aset_real apex_radius) {
    watch *w = context;
    return watched_whole(w, w->inner.cone(w->inner.context, base, base_radius, apex, apex_radius));
}
#endif

static aset_sink watch_sink(watch *w, aset_scene *scene) {
    memset(w, 0, sizeof *w);
    w->inner = aset_scene_sink(scene);
    w->scene = scene;
    w->before = look(scene);
    aset_sink sink;
    memset(&sink, 0, sizeof sink);
    sink.context = w;
    sink.background = watch_background;
    sink.view = watch_view;
    sink.light = watch_light;
    sink.material = watch_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = watch_begin;
    sink.polygon_point = watch_point;
    sink.polygon_end = watch_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = watch_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = watch_cone;
#endif
    return sink;
}

/* --- a scene of given limits in a block of its own --- */

typedef struct bench {
    guarded memory;
    aset_arena arena;
    aset_scene scene;
} bench;

static void bench_open(bench *b, const aset_counts *c) {
    b->memory = guarded_open(ASET_BYTES_SCENE(c->objects, c->coordinates, c->materials, c->lights));
    assert_int_equal(aset_arena_init(&b->arena, b->memory.block, b->memory.size), ASET_OK);
    assert_int_equal(aset_scene_init(&b->scene, &b->arena, c), ASET_OK);
}

static void bench_close(bench *b) {
    guarded_close(&b->memory);
}

static aset_counts limits_of(uint32_t objects, uint32_t coordinates, uint32_t materials, uint32_t lights) {
    aset_counts c;
    memset(&c, 0, sizeof c);
    c.objects = objects;
    c.coordinates = coordinates;
    c.materials = materials;
    c.lights = lights;
    return c;
}

/* --- counting --- */

static void check_counter_equals_builder(const stage *s, const char *name, uint64_t seed) {
    aset_vec3 low, high;
    check(same_counts(&s->counter.counts, &s->scene.counts), "%s, " SEED, name, seed);
    check(s->scene.counts.objects == s->scene.counts.polygons + s->scene.counts.patches + s->scene.counts.spheres +
                                         s->scene.counts.cones, "%s, " SEED, name, seed);
    check(aset_scene_bounds(&s->scene, &low, &high), "%s, " SEED, name, seed);
    check(same_vec(&s->counter.low, &low) && same_vec(&s->counter.high, &high), "%s, " SEED, name, seed);
    check(s->arena.used == s->memory.size, "%s, " SEED, name, seed);
}

static void test_scene__counter_equals_builder(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 40; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        stage s;
        model_random(&m, &r, 1 + random_below(&r, 60), 5, 0.01, 3);
        stage_open_model(&s, &m, 0);
        check_counter_equals_builder(&s, "random model", r.seed);
        uint32_t kinds[THING_KINDS] = {0};
        for (uint32_t k = 0; k < m.n_things; k++) {
            kinds[m.things[k].kind]++;
        }
        const aset_counts *c = &s.counter.counts;
        check(c->polygons == kinds[THING_POLYGON] && c->patches == kinds[THING_PATCH] &&
                  c->spheres == kinds[THING_SPHERE] && c->cones == kinds[THING_CONE] && c->lights == 2, SEED, r.seed);
        stage_close(&s);
        model_free(&m);
    }
}

static void test_scene__counter_equals_builder_on_procedural_scenes(void **state) {
    (void)state;
    static const struct {
        const char *name;
        uint32_t size;
    } scenes[] = {{"balls", 2}, {"gears", 1}, {"mount", 3}, {"rings", 2}, {"teapot", 2}, {"tetra", 3}, {"tree", 5}};
    for (size_t i = 0; i < COUNT_OF(scenes); i++) {
        stage s;
        if (stage_open_procedural(&s, scenes[i].name, scenes[i].size, 0)) {
            check_counter_equals_builder(&s, scenes[i].name, 0);
            assert_true(s.scene.has_view && s.counter.has_view);
            assert_memory_equal(&s.scene.view.from, &s.counter.view.from, sizeof s.scene.view.from);
            stage_close(&s);
        }
    }
}

static void test_scene__polygons_take_what_the_macros_say(void **state) {
    (void)state;
#if ASET_WITH_POLYGONS
    for (uint32_t n = 3; n <= THING_POINTS_MAX; n++) {
        aset_vec3 points[THING_POINTS_MAX], normals[THING_POINTS_MAX];
        for (uint32_t i = 0; i < n; i++) {
            points[i] = dvec_real(dvec_make(cos(2 * PI * i / n), sin(2 * PI * i / n), 1));
            normals[i] = points[i];
        }
        for (int patch = 0; patch <= ASET_WITH_PATCHES; patch++) {
            model m;
            stage s;
            model_start(&m);
            model_polygon(&m, points, patch ? normals : NULL, n);
            model_polygon(&m, points, patch ? normals : NULL, n);
            stage_open_model(&s, &m, 0);
            uint64_t each = patch ? ASET_COORDINATES_PATCH(n) : ASET_COORDINATES_POLYGON(n);
            assert_int_equal(s.counter.counts.coordinates, 2 * each);
            stage_close(&s);
            model_free(&m);
        }
    }
#endif
}

/* --- limits --- */

typedef struct limit_case {
    const char *name;
    aset_counts limits;
    bool possible; /* there is one to take away */
} limit_case;

/* Builds with the limits; checks that exactly one entity was refused with ASET_ERR_NOMEM and left no trace. */
static void check_refused(const model *m, const limit_case *c, uint64_t seed) {
    bench b;
    watch w;
    bench_open(&b, &c->limits);
    aset_sink sink = watch_sink(&w, &b.scene);
    check(model_emit(&sink, m) == ASET_ERR_NOMEM, "%s one less, " SEED, c->name, seed);
    check(w.n_refused == 1 && !w.traces, "%s one less, " SEED, c->name, seed);
    bench_close(&b);
}

static void test_scene__one_less_of_each_limit_is_refused(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 25; i++) {
        random_state r = random_start(seed_of(100 + i));
        model m;
        stage s;
        model_random(&m, &r, 1 + random_below(&r, 20), 5, 0.1, 3);
        stage_open_model(&s, &m, 0);
        limit_case cases[4];
        static const char *const names[4] = {"objects", "coordinates", "materials", "lights"};
        for (int k = 0; k < 4; k++) {
            cases[k].name = names[k];
            cases[k].limits = s.counter.counts;
        }
        cases[0].limits.objects--;
        cases[1].limits.coordinates--;
        cases[2].limits.materials--;
        cases[3].limits.lights--;
        for (int k = 0; k < 4; k++) {
            check_refused(&m, &cases[k], r.seed);
        }
        stage_close(&s);
        model_free(&m);
    }
}

static void test_scene__refused_lights_and_objects_leave_room_for_others(void **state) {
    (void)state;
#if ASET_WITH_SPHERES
    bench b;
    aset_counts limits = limits_of(2, 8, 1, 1);
    bench_open(&b, &limits);
    aset_sink sink = aset_scene_sink(&b.scene);
    aset_material first = plain_material(), second = plain_material();
    second.diffuse = R(0.25);
    aset_light light;
    memset(&light, 0, sizeof light);
    assert_int_equal(sink.light(sink.context, &light), ASET_OK);
    assert_int_equal(sink.light(sink.context, &light), ASET_ERR_NOMEM);
    assert_int_equal(sink.material(sink.context, &first), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &somewhere, 1), ASET_OK);
    assert_int_equal(sink.material(sink.context, &second), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &somewhere, 1), ASET_ERR_NOMEM);
    assert_int_equal(sink.sphere(sink.context, &somewhere, 1), ASET_ERR_NOMEM); /* not even at the second time */
    assert_int_equal(sink.material(sink.context, &first), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &elsewhere, 1), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &elsewhere, 1), ASET_ERR_NOMEM);
    assert_int_equal(b.scene.counts.objects, 2);
    assert_int_equal(b.scene.counts.materials, 1);
    assert_true(shape_of(&b.scene, 1).material == b.scene.materials);
    bench_close(&b);
#endif
}

static void test_scene__init_refuses(void **state) {
    (void)state;
    uint64_t words[64];
    aset_arena arena;
    aset_scene scene;
    aset_counts limits = limits_of(1, 4, 1, 1);
    assert_int_equal(aset_arena_init(&arena, words, sizeof words), ASET_OK);
    assert_int_equal(aset_scene_init(NULL, &arena, &limits), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_scene_init(&scene, NULL, &limits), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_scene_init(&scene, &arena, NULL), ASET_ERR_ARGUMENT);
    limits.coordinates = UINT32_MAX; /* one more than 2^32 - 2 */
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_ERR_LIMIT);
    limits.coordinates = UINT64_MAX;
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_ERR_LIMIT);
    limits.coordinates = UINT32_MAX - 1;
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_ERR_NOMEM);
    limits = limits_of(1, 4, (1u << 29) + 1, 1);
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_ERR_LIMIT);
    limits = limits_of(1, 4, (1u << 29) - 1, 1);
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_ERR_NOMEM);
    assert_int_equal(arena.used, 0);
    assert_int_equal(arena.peak, 0);
}

static void test_scene__init_of_nothing_takes_nothing(void **state) {
    (void)state;
    aset_arena arena;
    aset_scene scene;
    aset_counts limits = limits_of(0, 0, 0, 0);
    aset_vec3 low = somewhere, high = elsewhere;
    assert_int_equal(aset_arena_init(&arena, NULL, 0), ASET_OK);
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_OK);
    assert_false(aset_scene_bounds(&scene, &low, &high));
    assert_true(same_vec(&low, &somewhere) && same_vec(&high, &elsewhere));
    assert_true(scene.background.r == 0 && scene.background.g == 0 && scene.background.b == 0 && !scene.has_view);
    aset_sink sink = aset_scene_sink(&scene);
    aset_light light;
    memset(&light, 0, sizeof light);
    assert_int_equal(sink.light(sink.context, &light), ASET_ERR_NOMEM);
}

/* --- what is refused: both sinks must say the same --- */

/* A counter, and a builder that is watched. */
typedef struct pair {
    bench bench;
    watch watch;
    aset_counter counter;
    aset_sink sinks[2];
} pair;

static void pair_open(pair *p) {
    aset_counts limits = limits_of(100, 4000, 100, 100);
    bench_open(&p->bench, &limits);
    p->sinks[0] = aset_counter_sink(&p->counter);
    p->sinks[1] = watch_sink(&p->watch, &p->bench.scene);
}

static void pair_material(pair *p) {
    aset_material plain = plain_material();
    for (int i = 0; i < 2; i++) {
        assert_int_equal(p->sinks[i].material(p->sinks[i].context, &plain), ASET_OK);
    }
}

/* After refusals: nothing may have stayed behind, in either. */
static void pair_close(pair *p, uint32_t n_objects) {
    assert_false(p->watch.traces);
    assert_int_equal(p->bench.scene.counts.objects, n_objects);
    assert_true(same_counts(&p->counter.counts, &p->bench.scene.counts));
    bench_close(&p->bench);
}

static const aset_real bad_numbers[3] = {REAL_INFINITY, -REAL_INFINITY, (aset_real)NAN};

static aset_vec3 spoiled(aset_vec3 v, int axis, int number) {
    *(axis == 0 ? &v.x : axis == 1 ? &v.y : &v.z) = bad_numbers[number];
    return v;
}

static void test_scene__refuses_bad_spheres(void **state) {
    (void)state;
#if ASET_WITH_SPHERES
    pair p;
    pair_open(&p);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(p.sinks[i].sphere(p.sinks[i].context, &somewhere, 1), ASET_ERR_ARGUMENT);
    }
    pair_material(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        assert_int_equal(s->sphere(s->context, &somewhere, 0), ASET_ERR_GEOMETRY);
        assert_int_equal(s->sphere(s->context, &somewhere, -R(0.0)), ASET_ERR_GEOMETRY);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(s->sphere(s->context, &somewhere, bad_numbers[k]), ASET_ERR_GEOMETRY);
            for (int a = 0; a < 3; a++) {
                aset_vec3 centre = spoiled(somewhere, a, k);
                assert_int_equal(s->sphere(s->context, &centre, 1), ASET_ERR_GEOMETRY);
            }
        }
        assert_int_equal(s->sphere(s->context, &somewhere, -1), ASET_OK);
    }
    pair_close(&p, 1);
#endif
}

static void test_scene__refuses_bad_cones(void **state) {
    (void)state;
#if ASET_WITH_CONES
    pair p;
    pair_open(&p);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(p.sinks[i].cone(p.sinks[i].context, &somewhere, 1, &elsewhere, 1), ASET_ERR_ARGUMENT);
    }
    pair_material(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        assert_int_equal(s->cone(s->context, &somewhere, 1, &somewhere, 2), ASET_ERR_GEOMETRY);
        assert_int_equal(s->cone(s->context, &somewhere, 0, &elsewhere, 0), ASET_ERR_GEOMETRY);
        assert_int_equal(s->cone(s->context, &somewhere, 1, &elsewhere, -1), ASET_ERR_GEOMETRY);
        assert_int_equal(s->cone(s->context, &somewhere, R(-0.5), &elsewhere, 2), ASET_ERR_GEOMETRY);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(s->cone(s->context, &somewhere, bad_numbers[k], &elsewhere, 1), ASET_ERR_GEOMETRY);
            assert_int_equal(s->cone(s->context, &somewhere, 1, &elsewhere, bad_numbers[k]), ASET_ERR_GEOMETRY);
            for (int a = 0; a < 3; a++) {
                aset_vec3 bad = spoiled(somewhere, a, k);
                assert_int_equal(s->cone(s->context, &bad, 1, &elsewhere, 1), ASET_ERR_GEOMETRY);
                assert_int_equal(s->cone(s->context, &elsewhere, 1, &bad, 1), ASET_ERR_GEOMETRY);
            }
        }
        assert_int_equal(s->cone(s->context, &somewhere, 0, &elsewhere, 1), ASET_OK);
        assert_int_equal(s->cone(s->context, &somewhere, 1, &elsewhere, 0), ASET_OK);
        assert_int_equal(s->cone(s->context, &somewhere, -1, &elsewhere, -2), ASET_OK);
        assert_int_equal(s->cone(s->context, &somewhere, 0, &elsewhere, -2), ASET_OK);
    }
    pair_close(&p, 4);
#endif
}

#if ASET_WITH_POLYGONS
static const aset_vec3 corners[5] = {{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {2, 2, 0}, {0, 2, 0}};

static void test_scene__refuses_bad_polygons(void **state) {
    (void)state;
    pair p;
    pair_open(&p);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(aset_sink_polygon(p.sinks + i, corners, NULL, 5), ASET_ERR_ARGUMENT);
        assert_int_equal(p.sinks[i].polygon_begin(p.sinks[i].context, 5, false), ASET_ERR_ARGUMENT);
        assert_int_equal(p.sinks[i].polygon_point(p.sinks[i].context, corners, NULL), ASET_ERR_GEOMETRY);
    }
    pair_material(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        for (uint32_t n = 0; n < 3; n++) {
            assert_int_equal(aset_sink_polygon(s, corners, NULL, n), ASET_ERR_GEOMETRY);
        }
        for (int k = 0; k < 9; k++) {
            aset_vec3 points[5];
            memcpy(points, corners, sizeof points);
            points[k % 5] = spoiled(points[k % 5], k % 3, k / 3);
            assert_int_equal(aset_sink_polygon(s, points, NULL, 5), ASET_ERR_GEOMETRY);
        }
        assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
        assert_int_equal(s->polygon_point(s->context, corners, NULL), ASET_ERR_GEOMETRY);
        assert_int_equal(aset_sink_polygon(s, corners, NULL, 5), ASET_OK);
    }
    pair_close(&p, 1);
}

/* A polygon that ends too early, goes on too long, or changes its mind about normals is no polygon. */
static void test_scene__refuses_polygons_not_as_announced(void **state) {
    (void)state;
    pair p;
    pair_open(&p);
    pair_material(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        for (uint32_t given = 0; given < 5; given++) {
            assert_int_equal(s->polygon_begin(s->context, 5, false), ASET_OK);
            for (uint32_t k = 0; k < given; k++) {
                assert_int_equal(s->polygon_point(s->context, corners + k, NULL), ASET_OK);
            }
            assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
            assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
        }
        assert_int_equal(s->polygon_begin(s->context, 4, false), ASET_OK);
        for (uint32_t k = 0; k < 4; k++) {
            assert_int_equal(s->polygon_point(s->context, corners + k, NULL), ASET_OK);
        }
        assert_int_equal(s->polygon_point(s->context, corners + 4, NULL), ASET_ERR_GEOMETRY);
        assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
        assert_int_equal(s->polygon_begin(s->context, 3, false), ASET_OK);
        assert_int_equal(s->polygon_point(s->context, corners, corners + 1), ASET_ERR_GEOMETRY);
        assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
#if ASET_WITH_PATCHES
        assert_int_equal(s->polygon_begin(s->context, 3, true), ASET_OK);
        assert_int_equal(s->polygon_point(s->context, corners, NULL), ASET_ERR_GEOMETRY);
        assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
        aset_vec3 bad = spoiled(somewhere, 1, 2);
        assert_int_equal(s->polygon_begin(s->context, 3, true), ASET_OK);
        assert_int_equal(s->polygon_point(s->context, corners, &bad), ASET_ERR_GEOMETRY);
#else
        assert_int_equal(s->polygon_begin(s->context, 3, true), ASET_ERR_UNSUPPORTED);
        assert_int_equal(s->polygon_point(s->context, corners, corners), ASET_ERR_GEOMETRY);
#endif
        assert_int_equal(aset_sink_polygon(s, corners, NULL, 3), ASET_OK);
    }
    pair_close(&p, 1);
}

/* The points of the abandoned one must not get into the next. */
static void test_scene__abandoned_polygon_is_forgotten(void **state) {
    (void)state;
    const aset_vec3 wild[4] = {{50, 50, 50}, {-60, 50, 50}, {-60, -70, 50}, {50, -70, 50}};
    pair p;
    pair_open(&p);
    pair_material(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        for (uint32_t given = 0; given <= 4; given++) {
            assert_int_equal(s->polygon_begin(s->context, 4, false), ASET_OK);
            for (uint32_t k = 0; k < given; k++) {
                assert_int_equal(s->polygon_point(s->context, wild + k, NULL), ASET_OK);
            }
            assert_int_equal(aset_sink_polygon(s, corners, NULL, 5), ASET_OK);
        }
    }
    const aset_scene *scene = &p.bench.scene;
    assert_true(scene->high.x == 3 && scene->high.y == 2 && scene->high.z == 0);
    assert_true(scene->low.x == 0 && scene->low.y == 0 && scene->low.z == 0);
    assert_true(same_vec(&scene->high, &p.counter.high) && same_vec(&scene->low, &p.counter.low));
    for (uint32_t i = 0; i < 5; i++) {
        aset_vec3 origin = {R(2.5), 1, 5}, direction = {0, 0, -1};
        assert_true(object_hit(scene, i, origin, direction) == 5);
    }
    pair_close(&p, 5);
}

/*
 * A source may go on after a refused polygon; the counter's counts must still be exactly what the builder needs, and the
 * builder must not have kept the material that only the refused polygon used.
 */
static void test_scene__refused_polygon_does_not_keep_its_material(void **state) {
    (void)state;
    aset_material first = plain_material(), second = plain_material();
    second.diffuse = R(0.25);
    aset_vec3 bad = spoiled(somewhere, 0, 0);
    pair p;
    pair_open(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        assert_int_equal(s->material(s->context, &first), ASET_OK);
        assert_int_equal(s->polygon_begin(s->context, 4, false), ASET_OK);
        assert_int_equal(s->polygon_point(s->context, &bad, NULL), ASET_ERR_GEOMETRY);
        assert_int_equal(s->material(s->context, &second), ASET_OK);
        assert_int_equal(aset_sink_polygon(s, corners, NULL, 5), ASET_OK);
    }
    assert_int_equal(p.counter.counts.materials, 1);
    assert_int_equal(p.bench.scene.counts.materials, 1);
    pair_close(&p, 1);
}

/* What comes between a polygon's begin and end may be refused or end the polygon, but never get into the scene half. */
static void check_interrupted(uint32_t object_limit, uint32_t n_before) {
    aset_counts limits = limits_of(object_limit, 1000, 4, 1);
    bench b;
    bench_open(&b, &limits);
    aset_sink sink = aset_scene_sink(&b.scene);
    aset_material plain = plain_material();
    bool polygon_kept = true;
    uint32_t n_others = 0;
    assert_int_equal(sink.material(sink.context, &plain), ASET_OK);
    assert_int_equal(sink.polygon_begin(sink.context, 5, false), ASET_OK);
    for (uint32_t k = 0; k < 5; k++) {
        if (k == n_before) {
#if ASET_WITH_SPHERES
            n_others += sink.sphere(sink.context, &elsewhere, 1) == ASET_OK;
#endif
#if ASET_WITH_CONES
            n_others += sink.cone(sink.context, &somewhere, 1, &elsewhere, 1) == ASET_OK;
#endif
        }
        polygon_kept = polygon_kept && sink.polygon_point(sink.context, corners + k, NULL) == ASET_OK;
    }
    polygon_kept = sink.polygon_end(sink.context) == ASET_OK && polygon_kept;
    check(b.scene.counts.objects <= object_limit, "%" PRIu32 " points before", n_before);
    check(b.scene.counts.objects == n_others + polygon_kept, "%" PRIu32 " points before", n_before);
    if (polygon_kept) {
        uint32_t polygon = b.scene.counts.objects - 1;
        aset_vec3 origin = {R(2.5), 1, 5}, direction = {0, 0, -1}, low, high;
        aset_object_bounds(&b.scene, polygon, &low, &high);
        check(low.x == 0 && low.y == 0 && low.z == 0 && high.x == 3 && high.y == 2 && high.z == 0,
              "%" PRIu32 " points before", n_before);
        check(object_hit(&b.scene, polygon, origin, direction) == 5, "%" PRIu32 " points before", n_before);
    }
    bench_close(&b);
}

static void test_scene__objects_within_a_polygon_do_no_harm(void **state) {
    (void)state;
    for (uint32_t n_before = 0; n_before < 5; n_before++) {
        for (uint32_t limit = 1; limit <= 3; limit++) {
            check_interrupted(limit, n_before);
        }
    }
}
#endif

static void test_scene__refuses_bad_materials(void **state) {
    (void)state;
    pair p;
    pair_open(&p);
    const aset_real bad[4] = {-1, bad_numbers[0], bad_numbers[1], bad_numbers[2]};
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        for (int k = 0; k < 4; k++) {
            aset_material m = plain_material();
            aset_real *const fields[] = {
                &m.fill.r, &m.fill.g, &m.fill.b, &m.diffuse, &m.specular, &m.shine,
#if ASET_WITH_REFRACTION
                &m.transmittance, &m.refraction_index,
#endif
            };
            for (size_t f = 0; f < COUNT_OF(fields); f++) {
                aset_real kept = *fields[f];
                *fields[f] = bad[k];
                assert_int_equal(s->material(s->context, &m), ASET_ERR_ARGUMENT);
                *fields[f] = kept;
            }
        }
#if ASET_WITH_SPHERES
        assert_int_equal(s->sphere(s->context, &somewhere, 1), ASET_ERR_ARGUMENT); /* still no material */
#endif
    }
    pair_close(&p, 0);
}

static void test_scene__refuses_bad_lights_and_backgrounds(void **state) {
    (void)state;
    pair p;
    pair_open(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        aset_light light;
        memset(&light, 0, sizeof light);
        light.directional = true;
        assert_int_equal(s->light(s->context, &light), ASET_ERR_GEOMETRY);
        light.directional = false;
        for (int k = 0; k < 3; k++) {
            light.position = spoiled(somewhere, k, k);
            assert_int_equal(s->light(s->context, &light), ASET_ERR_GEOMETRY);
            aset_colour colour = {0, R(0.5), bad_numbers[k]};
            assert_int_equal(s->background(s->context, &colour), ASET_ERR_ARGUMENT);
        }
        light.position = somewhere;
        light.colour.g = -1;
        assert_int_equal(s->light(s->context, &light), ASET_OK); /* its colour is ignored */
        light.has_colour = true;
        assert_int_equal(s->light(s->context, &light), ASET_ERR_ARGUMENT);
        light.colour.g = 3;
        assert_int_equal(s->light(s->context, &light), ASET_OK);
        aset_colour background = {0, -1, 0};
        assert_int_equal(s->background(s->context, &background), ASET_ERR_ARGUMENT);
        background.g = 2;
        assert_int_equal(s->background(s->context, &background), ASET_OK);
    }
    assert_true(p.bench.scene.background.g == 2);
    assert_int_equal(p.bench.scene.counts.lights, 2);
    assert_int_equal(p.bench.scene.n_uncoloured, 1);
    pair_close(&p, 0);
}

static aset_view good_view(void) {
    aset_view view;
    memset(&view, 0, sizeof view);
    view.at.x = 1;
    view.up.z = 1;
    view.angle_deg = 45;
    return view;
}

static void test_scene__refuses_bad_views(void **state) {
    (void)state;
    pair p;
    pair_open(&p);
    for (int i = 0; i < 2; i++) {
        const aset_sink *s = p.sinks + i;
        aset_view view = good_view();
        assert_int_equal(s->view(s->context, &view), ASET_OK);
        for (int k = 0; k < 3; k++) {
            view = good_view();
            view.from = spoiled(view.from, k, k);
            assert_int_equal(s->view(s->context, &view), ASET_ERR_GEOMETRY);
            view = good_view();
            view.up = spoiled(view.up, k, k);
            assert_int_equal(s->view(s->context, &view), ASET_ERR_GEOMETRY);
            view = good_view();
            view.at = spoiled(view.at, k, k);
            assert_int_equal(s->view(s->context, &view), ASET_ERR_GEOMETRY);
            view = good_view();
            view.height = bad_numbers[k];
            assert_int_equal(s->view(s->context, &view), ASET_ERR_ARGUMENT);
        }
        view = good_view();
        view.at = view.from;
        assert_int_equal(s->view(s->context, &view), ASET_ERR_GEOMETRY);
        view = good_view();
        view.up = view.at; /* along the line of sight */
        assert_int_equal(s->view(s->context, &view), ASET_ERR_GEOMETRY);
        view = good_view();
        memset(&view.up, 0, sizeof view.up);
        assert_int_equal(s->view(s->context, &view), ASET_ERR_GEOMETRY);
        const aset_real bad_angles[5] = {0, 180, -10, bad_numbers[0], bad_numbers[2]};
        for (int k = 0; k < 5; k++) {
            view = good_view();
            view.angle_deg = bad_angles[k];
            assert_int_equal(s->view(s->context, &view), ASET_ERR_ARGUMENT);
        }
        view = good_view();
        view.height = -1;
        assert_int_equal(s->view(s->context, &view), ASET_ERR_ARGUMENT);
        view.height = 4;
        view.angle_deg = 0; /* an orthographic view has none */
        assert_int_equal(s->view(s->context, &view), ASET_OK);
    }
    assert_true(p.bench.scene.view.height == 4 && p.counter.view.height == 4);
    pair_close(&p, 0);
}

/* --- both sinks under calls in any order --- */

/* One random call; with within, anything may come between a polygon's begin and end. Returns its status. */
static aset_status random_call(const aset_sink *s, random_state *r, bool within, uint32_t *open_points) {
    aset_vec3 point = random_in_cube(r, 3), other = random_in_cube(r, 3);
    if (random_chance(r, 0.05)) {
        point.y = REAL_INFINITY;
    }
    uint32_t choice = random_below(r, 8);
    aset_real radius = random_chance(r, 0.1) ? 0 : R(0.5);
    if (*open_points > 0 && (!within || choice < 6)) {
        choice = 7; /* go on with the polygon, or abandon it */
    }
    switch (choice) {
    case 0: case 1: {
        aset_material m = plain_material();
        m.shine = (aset_real)random_below(r, 20);
        return s->material(s->context, &m);
    }
#if ASET_WITH_SPHERES
    case 2: case 3: return s->sphere(s->context, &point, radius);
#endif
#if ASET_WITH_CONES
    case 4: return s->cone(s->context, &point, radius, &other, random_chance(r, 0.2) ? 0 : R(0.5));
#endif
#if ASET_WITH_POLYGONS
    case 7:
        if (*open_points > 0 && random_chance(r, 0.95)) {
            (*open_points)--;
            return *open_points == 0 ? s->polygon_end(s->context) : s->polygon_point(s->context, &point, NULL);
        }
        /* fallthrough */
    case 5: case 6: {
        uint32_t n = 2 + random_below(r, 5);
        uint32_t calls = n + (random_chance(r, 0.9) ? 0 : random_below(r, 3)) - (random_chance(r, 0.9) ? 0 : 1);
        *open_points = calls + 1;
        return s->polygon_begin(s->context, n, false);
    }
#endif
    default: {
        aset_light light;
        memset(&light, 0, sizeof light);
        light.position = point;
        return s->light(s->context, &light);
    }
    }
    (void)radius, (void)other;
}

static uint32_t random_calls(const aset_sink *sink, uint64_t seed, bool within) {
    random_state r = random_start(seed);
    uint32_t open_points = 0, n_refused = 0;
    for (int i = 0; i < 400; i++) {
        n_refused += random_call(sink, &r, within, &open_points) != ASET_OK;
    }
    return n_refused;
}

static void check_random_calls(uint64_t seed, bool within) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    random_calls(&sink, seed, within);
    aset_counts ample = limits_of(500, 9000, 500, 500);
    bench wide, exact;
    watch w;
    bench_open(&wide, &ample);
    bench_open(&exact, &counter.counts);
    sink = watch_sink(&w, &wide.scene);
    check(random_calls(&sink, seed, within) > 0, "nothing was refused, " SEED, seed);
    check(!w.traces, "a refused entity left a trace, " SEED, seed);
    check(same_counts(&counter.counts, &wide.scene.counts), SEED, seed);
    sink = aset_scene_sink(&exact.scene);
    random_calls(&sink, seed, within);
    check(same_counts(&counter.counts, &exact.scene.counts), "the counter's counts are not enough, " SEED, seed);
    bench_close(&wide);
    bench_close(&exact);
}

static void test_scene__sinks_agree_on_any_entities(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        check_random_calls(seed_of(200 + i), false);
    }
}

static void test_scene__sinks_agree_on_any_calls(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        check_random_calls(seed_of(500 + i), true);
    }
}

/* --- materials --- */

#if ASET_WITH_SPHERES
/* Gives a sphere with material number k. */
static void sphere_of(const aset_sink *sink, uint32_t k) {
    aset_material m = plain_material();
    m.shine = (aset_real)k;
    assert_int_equal(sink->material(sink->context, &m), ASET_OK);
    assert_int_equal(sink->sphere(sink->context, &somewhere, 1), ASET_OK);
}

static uint32_t materials_after(uint32_t distinct, uint32_t rounds) {
    aset_counts limits = limits_of(1000, 4000, 1000, 0);
    bench b;
    aset_counter counter;
    bench_open(&b, &limits);
    aset_sink scene = aset_scene_sink(&b.scene), count = aset_counter_sink(&counter);
    for (uint32_t i = 0; i < distinct * rounds; i++) {
        sphere_of(&scene, i % distinct);
        sphere_of(&count, i % distinct);
        assert_true(shape_of(&b.scene, i).material->shine == (aset_real)(i % distinct));
    }
    uint32_t n = b.scene.counts.materials;
    assert_int_equal(counter.counts.materials, n);
    bench_close(&b);
    return n;
}

static void test_scene__repeated_materials_are_stored_once(void **state) {
    (void)state;
    assert_int_equal(materials_after(1, 50), 1);
    assert_int_equal(materials_after(2, 50), 2);
    assert_int_equal(materials_after(ASET_RECENT, 10), ASET_RECENT);
    assert_int_equal(materials_after(ASET_RECENT + 1, 3), 3 * (ASET_RECENT + 1)); /* always just forgotten */
}

static void test_scene__materials_differ_in_every_part(void **state) {
    (void)state;
    aset_counts limits = limits_of(100, 400, 100, 0);
    bench b;
    bench_open(&b, &limits);
    aset_sink sink = aset_scene_sink(&b.scene);
    uint32_t n = 0;
    for (int part = 0; part < 10; part++) {
        aset_material m = plain_material();
        m.fill.r = part == 0 ? R(0.5) : m.fill.r;
        m.fill.g = part == 1 ? R(0.5) : m.fill.g;
        m.fill.b = part == 2 ? R(0.5) : m.fill.b;
        m.diffuse = part == 3 ? R(0.75) : m.diffuse;
        m.specular = part == 4 ? R(0.5) : m.specular;
        m.shine = part == 5 ? R(0.5) : m.shine;
        m.one_sided = part == 6;
#if ASET_WITH_REFRACTION
        m.transmittance = part == 7 ? R(0.5) : m.transmittance;
        m.refraction_index = part == 8 ? R(0.5) : m.refraction_index;
#else
        if (part == 7 || part == 8) {
            continue;
        }
#endif
        n++;
        assert_int_equal(sink.material(sink.context, &m), ASET_OK);
        assert_int_equal(sink.sphere(sink.context, &somewhere, 1), ASET_OK);
        assert_int_equal(b.scene.counts.materials, n);
    }
    bench_close(&b);
}

static void test_scene__unused_materials_are_not_stored(void **state) {
    (void)state;
    aset_counts limits = limits_of(2, 8, 1, 0);
    bench b;
    bench_open(&b, &limits);
    aset_sink sink = aset_scene_sink(&b.scene);
    for (uint32_t i = 0; i < 100; i++) {
        aset_material m = plain_material();
        m.shine = (aset_real)i;
        assert_int_equal(sink.material(sink.context, &m), ASET_OK);
    }
    assert_int_equal(b.scene.counts.materials, 0);
    assert_int_equal(sink.sphere(sink.context, &somewhere, 1), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &somewhere, 1), ASET_OK);
    assert_int_equal(b.scene.counts.materials, 1);
    assert_true(shape_of(&b.scene, 0).material->shine == 99 && shape_of(&b.scene, 1).material->shine == 99);
    bench_close(&b);
}
#endif

/* --- bounds --- */

static void grow(dvec p, double low[3], double high[3]) {
    const double at[3] = {p.x, p.y, p.z};
    for (int a = 0; a < 3; a++) {
        low[a] = at[a] < low[a] ? at[a] : low[a];
        high[a] = at[a] > high[a] ? at[a] : high[a];
    }
}

/* A disc's rim in so many points. */
static void grow_disc(dvec centre, dvec axis, double radius, double low[3], double high[3]) {
    dvec u = dvec_unit(dvec_cross(axis, fabs(axis.x) < 0.6 ? dvec_make(1, 0, 0) : dvec_make(0, 1, 0)));
    dvec v = dvec_cross(axis, u);
    for (int i = 0; i < 4000; i++) {
        double angle = 2 * PI * i / 4000;
        grow(dvec_along(dvec_along(centre, radius * cos(angle), u), radius * sin(angle), v), low, high);
    }
}

static void sampled_bounds(const thing *t, double low[3], double high[3]) {
    for (int a = 0; a < 3; a++) {
        low[a] = DBL_MAX;
        high[a] = -DBL_MAX;
    }
    if (t->kind == THING_CONE) {
        dvec base = dvec_of(t->points[0]), apex = dvec_of(t->points[1]), axis = dvec_unit(dvec_sub(apex, base));
        grow_disc(base, axis, fabs((double)t->radii[0]), low, high);
        grow_disc(apex, axis, fabs((double)t->radii[1]), low, high);
    } else if (t->kind == THING_SPHERE) {
        dvec c = dvec_of(t->points[0]);
        double r = fabs((double)t->radii[0]);
        grow(dvec_make(c.x - r, c.y - r, c.z - r), low, high);
        grow(dvec_make(c.x + r, c.y + r, c.z + r), low, high);
    } else {
        for (uint32_t i = 0; i < t->n_points; i++) {
            grow(dvec_of(t->points[i]), low, high);
        }
    }
}

static void test_scene__bounds_of_objects_are_tight(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20; i++) {
        random_state r = random_start(seed_of(700 + i));
        double all_low[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, all_high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
        model m;
        stage s;
        model_random(&m, &r, 40, 5, 0.1, 3);
        stage_open_model(&s, &m, 0);
        for (uint32_t k = 0; k < m.n_things; k++) {
            double low[3], high[3];
            aset_vec3 lower, upper;
            sampled_bounds(m.things + k, low, high);
            aset_object_bounds(&s.scene, k, &lower, &upper);
            const double from[3] = {(double)lower.x, (double)lower.y, (double)lower.z};
            const double to[3] = {(double)upper.x, (double)upper.y, (double)upper.z};
            for (int a = 0; a < 3; a++) { /* 4000 points of a rim miss its extreme by 3e-7 radii */
                check(fabs(from[a] - low[a]) < 1e-5 && fabs(to[a] - high[a]) < 1e-5,
                      "thing %" PRIu32 " of kind %u, axis %d, " SEED, k, m.things[k].kind, a, r.seed);
                all_low[a] = from[a] < all_low[a] ? from[a] : all_low[a];
                all_high[a] = to[a] > all_high[a] ? to[a] : all_high[a];
            }
        }
        aset_vec3 lower, upper;
        assert_true(aset_scene_bounds(&s.scene, &lower, &upper));
        check((double)lower.x == all_low[0] && (double)lower.y == all_low[1] && (double)lower.z == all_low[2], SEED, r.seed);
        check((double)upper.x == all_high[0] && (double)upper.y == all_high[1] && (double)upper.z == all_high[2], SEED,
              r.seed);
        stage_close(&s);
        model_free(&m);
    }
}

static void test_scene__cone_along_an_axis_has_no_slack(void **state) {
    (void)state;
#if ASET_WITH_CONES
    for (int a = 0; a < 3; a++) {
        model m;
        stage s;
        aset_vec3 base = {0, 0, 0}, apex = {0, 0, 0}, low, high;
        *(a == 0 ? &apex.x : a == 1 ? &apex.y : &apex.z) = 3;
        model_start(&m);
        model_cone(&m, base, -1, apex, -2);
        stage_open_model(&s, &m, 0);
        aset_object_bounds(&s.scene, 0, &low, &high);
        for (int b = 0; b < 3; b++) {
            aset_real l = b == 0 ? low.x : b == 1 ? low.y : low.z, h = b == 0 ? high.x : b == 1 ? high.y : high.z;
            assert_true(a == b ? l == 0 && h == 3 : l == -2 && h == 2);
        }
        stage_close(&s);
        model_free(&m);
    }
#endif
}

/* --- polygons without area --- */

#if ASET_WITH_POLYGONS
static aset_vec3 whole_point(random_state *r) {
    aset_vec3 v;
    v.x = (aset_real)random_below(r, 17) - 8;
    v.y = (aset_real)random_below(r, 17) - 8;
    v.z = (aset_real)random_below(r, 17) - 8;
    return v;
}

/* Whole numbers, so that the points lie exactly on a line, whatever is rounded. */
static void test_scene__polygons_without_area_are_kept_and_never_hit(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 200; i++) {
        random_state r = random_start(seed_of(800 + i));
        uint32_t n = 3 + random_below(&r, 4);
        aset_vec3 points[6], start = whole_point(&r), step = whole_point(&r);
        for (uint32_t k = 0; k < n; k++) {
            aset_real t = (aset_real)random_below(&r, 6);
            points[k].x = start.x + t * step.x;
            points[k].y = start.y + t * step.y;
            points[k].z = start.z + t * step.z;
        }
        model m;
        stage s;
        model_start(&m);
        model_polygon(&m, points, NULL, n);
        stage_open_model(&s, &m, 0);
        check(s.scene.counts.objects == 1 && s.scene.counts.polygons == 1, SEED, r.seed);
        for (int k = 0; k < 100; k++) {
            dvec origin = dvec_of(random_in_cube(&r, 30));
            dvec target = dvec_along(dvec_of(start), random_between(&r, 0, 5), dvec_of(step));
            aset_vec3 direction = dvec_real(dvec_unit(dvec_sub(target, origin)));
            check(!(object_hit(&s.scene, 0, dvec_real(origin), direction) < REAL_INFINITY), SEED ", ray %d", r.seed, k);
        }
        stage_close(&s);
        model_free(&m);
    }
}
#endif

/* --- a scene as a source --- */

static aset_status emit_scene(const aset_sink *sink, const void *context) {
    return aset_scene_emit(sink, context);
}

/* What comes out goes into another scene, which is the same but for roundings of normals, made unit length once more. */
static void test_scene__is_a_source(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        stage a, b;
        model_random(&m, &r, 80, 5, 0.1, 4);
        stage_open_model(&a, &m, 0);
        stage_open(&b, emit_scene, &a.scene, 0);
        const aset_counts *n = &a.scene.counts;
        assert_memory_equal(n, &b.scene.counts, sizeof *n);
        assert_memory_equal(a.scene.objects, b.scene.objects, n->objects * sizeof *a.scene.objects);
        assert_memory_equal(a.scene.materials, b.scene.materials, n->materials * sizeof *a.scene.materials);
        assert_memory_equal(a.scene.lights, b.scene.lights, n->lights * sizeof *a.scene.lights);
        assert_memory_equal(&a.scene.background, &b.scene.background, sizeof a.scene.background);
        for (uint64_t k = 0; k < n->coordinates; k++) {
            double difference = (double)a.scene.coordinates[k] - (double)b.scene.coordinates[k];
            check(fabs(difference) <= 4 * (double)REAL_UNIT, SEED ", coordinate %" PRIu64, r.seed, k);
        }
        for (uint32_t k = 0; k < n->objects; k++) {
            aset_vec3 low[2], high[2];
            aset_object_bounds(&a.scene, k, &low[0], &high[0]);
            aset_object_bounds(&b.scene, k, &low[1], &high[1]);
            assert_memory_equal(&low[0], &low[1], sizeof low[0]);
            assert_memory_equal(&high[0], &high[1], sizeof high[0]);
        }
        stage_close(&b);
        stage_close(&a);
        model_free(&m);
    }
}

/* The sink's answer ends it, and the view comes along. */
static void test_scene__as_a_source_stops_when_told(void **state) {
    (void)state;
    random_state r = random_start(seed_of(7));
    model m;
    stage a;
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    const aset_view view = {.from = {0, -9, 0}, .at = {0, 0, 0}, .up = {0, 0, 1}, .angle_deg = 40};
    model_random(&m, &r, 20, 5, 0.1, 4);
    stage_open_model(&a, &m, 0);
    aset_sink to = aset_scene_sink(&a.scene);
    assert_int_equal(to.view(to.context, &view), ASET_OK);
    assert_int_equal(aset_scene_emit(&sink, &a.scene), ASET_OK);
    assert_true(counter.has_view && counter.view.angle_deg == 40);
    assert_int_equal(aset_scene_emit(&to, &a.scene), ASET_ERR_NOMEM); /* into itself, which is full */
    assert_int_equal(aset_scene_emit(NULL, &a.scene), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_scene_emit(&sink, NULL), ASET_ERR_ARGUMENT);
    stage_close(&a);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scene__is_a_source),
        cmocka_unit_test(test_scene__as_a_source_stops_when_told),
        cmocka_unit_test(test_scene__counter_equals_builder),
        cmocka_unit_test(test_scene__counter_equals_builder_on_procedural_scenes),
        cmocka_unit_test(test_scene__polygons_take_what_the_macros_say),
        cmocka_unit_test(test_scene__one_less_of_each_limit_is_refused),
        cmocka_unit_test(test_scene__refused_lights_and_objects_leave_room_for_others),
        cmocka_unit_test(test_scene__init_refuses),
        cmocka_unit_test(test_scene__init_of_nothing_takes_nothing),
        cmocka_unit_test(test_scene__refuses_bad_spheres),
        cmocka_unit_test(test_scene__refuses_bad_cones),
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_scene__refuses_bad_polygons),
        cmocka_unit_test(test_scene__refuses_polygons_not_as_announced),
        cmocka_unit_test(test_scene__abandoned_polygon_is_forgotten),
        cmocka_unit_test(test_scene__refused_polygon_does_not_keep_its_material),
        cmocka_unit_test(test_scene__objects_within_a_polygon_do_no_harm),
        cmocka_unit_test(test_scene__polygons_without_area_are_kept_and_never_hit),
#endif
        cmocka_unit_test(test_scene__refuses_bad_materials),
        cmocka_unit_test(test_scene__refuses_bad_lights_and_backgrounds),
        cmocka_unit_test(test_scene__refuses_bad_views),
        cmocka_unit_test(test_scene__sinks_agree_on_any_entities),
        cmocka_unit_test(test_scene__sinks_agree_on_any_calls),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_scene__repeated_materials_are_stored_once),
        cmocka_unit_test(test_scene__materials_differ_in_every_part),
        cmocka_unit_test(test_scene__unused_materials_are_not_stored),
#endif
        cmocka_unit_test(test_scene__bounds_of_objects_are_tight),
        cmocka_unit_test(test_scene__cone_along_an_axis_has_no_slack),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
