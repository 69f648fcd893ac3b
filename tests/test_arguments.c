/*
 * test_arguments.c - NaN and infinity in every real number that a public function takes, and beyond what coordinates may be: a
 * status and nothing changed, or the harmless thing that the header says. The headers one after another; functions that take no
 * real number are not here.
 *
 *   arena.h        none                          summary.h     none
 *   scene.h        the sinks                     draft.h       baker's sink and triangles, words
 *   stage.h        box and aspect                trace.h       rays, views, curtail
 *   space.h        none                          report.h      seconds
 *   load.h         options->material             procedural.h  none
 */
#include "support/support.h"

#include "aset/load.h"
#include "base/vec.h"

#define NOT_FINITE 3
static const aset_real bad[] = {(aset_real)NAN, REAL_INFINITY, -REAL_INFINITY, REAL_MAX, -REAL_MAX};
static const char *const bad_names[] = {"NaN", "infinity", "-infinity", "the largest", "-the largest"};

/* --- sinks: every field of every entity --- */

/* One entity with field number field (counted over all its reals) replaced by x; false if it has no such field. */
typedef bool (*entity_try)(const aset_sink *sink, size_t field, aset_real x, aset_status *status);

static bool put_in(aset_real *const *fields, size_t n, size_t field, aset_real x) {
    if (field >= n) {
        return false;
    }
    *fields[field] = x;
    return true;
}

static bool try_background(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_colour c = {1, 1, 1};
    aset_real *const fields[] = {&c.r, &c.g, &c.b};
    bool some = put_in(fields, COUNT_OF(fields), field, x);
    *status = sink->background(sink->context, &c);
    return some;
}

static bool try_light(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_light light = {{1, 2, 3}, {1, 1, 1}, true, field % 2 == 1};
    aset_real *const fields[] = {&light.position.x, &light.position.x, &light.position.y, &light.position.y, &light.position.z,
                                 &light.position.z, &light.colour.r,   &light.colour.r,   &light.colour.g,   &light.colour.g,
                                 &light.colour.b,   &light.colour.b};
    bool some = put_in(fields, COUNT_OF(fields), field, x);
    *status = sink->light(sink->context, &light);
    return some;
}

static aset_view good_view(void) {
    aset_view view;
    memset(&view, 0, sizeof view);
    view.from.y = -5;
    view.up.z = 1;
    view.angle_deg = 45;
    return view;
}

/* Field 9 is the angle; 10 the height, which is not 0 then. */
static bool spoil_view(aset_view *view, size_t field, aset_real x) {
    aset_real *const fields[] = {&view->from.x, &view->from.y, &view->from.z, &view->at.x,      &view->at.y,  &view->at.z,
                                 &view->up.x,   &view->up.y,   &view->up.z,   &view->angle_deg, &view->height};
    return put_in(fields, COUNT_OF(fields), field, x);
}

static bool try_view(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_view view = good_view();
    bool some = spoil_view(&view, field, x);
    *status = sink->view(sink->context, &view);
    return some;
}

static bool spoil_material(aset_material *m, size_t field, aset_real x) {
    aset_real *const fields[] = {&m->fill.r, &m->fill.g, &m->fill.b, &m->diffuse, &m->specular, &m->shine,
#if ASET_WITH_REFRACTION
                                 &m->transmittance, &m->refraction_index
#endif
    };
    return put_in(fields, COUNT_OF(fields), field, x);
}

static bool try_material(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_material m = plain_material();
    bool some = spoil_material(&m, field, x);
    *status = sink->material(sink->context, &m);
    return some;
}

static void give_material(const aset_sink *sink) {
    aset_material m = plain_material();
    assert_int_equal(sink->material(sink->context, &m), ASET_OK);
}

#if ASET_WITH_POLYGONS
static bool try_polygon(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_real at[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    bool some = field < 9;
    give_material(sink);
    if (some) {
        at[field] = x;
    }
    const aset_vec3 p[3] = {{at[0], at[1], at[2]}, {at[3], at[4], at[5]}, {at[6], at[7], at[8]}};
    *status = aset_sink_polygon(sink, p, NULL, 3);
    return some;
}
#endif

#if ASET_WITH_PATCHES
/* Normals only: the points are checked as a polygon's. */
static bool try_patch(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    const aset_vec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    aset_real at[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    bool some = field < 9;
    give_material(sink);
    if (some) {
        at[field] = x;
    }
    const aset_vec3 normals[3] = {{at[0], at[1], at[2]}, {at[3], at[4], at[5]}, {at[6], at[7], at[8]}};
    *status = aset_sink_polygon(sink, p, normals, 3);
    return some;
}
#endif

#if ASET_WITH_SPHERES
static bool try_sphere(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_vec3 centre = {1, 2, 3};
    aset_real radius = 1, *const fields[] = {&centre.x, &centre.y, &centre.z, &radius};
    bool some = put_in(fields, COUNT_OF(fields), field, x);
    give_material(sink);
    *status = sink->sphere(sink->context, &centre, radius);
    return some;
}
#endif

#if ASET_WITH_CONES
static bool try_cone(const aset_sink *sink, size_t field, aset_real x, aset_status *status) {
    aset_vec3 base = {1, 2, 3}, apex = {3, 2, 1};
    aset_real radius = 1, other = 2;
    aset_real *const fields[] = {&base.x, &base.y, &base.z, &apex.x, &apex.y, &apex.z, &radius, &other};
    bool some = put_in(fields, COUNT_OF(fields), field, x);
    give_material(sink);
    *status = sink->cone(sink->context, &base, radius, &apex, other);
    return some;
}
#endif

static const struct {
    const char *name;
    entity_try attempt;
    bool may_be_large; /* any finite amount, if it is not below 0; of a direction any finite number at all */
    bool may_be_negative;
    size_t amounts_from; /* these fields are amounts: else coordinates */
} entities[] = {{"background", try_background, true, false, 0},
                {"light", try_light, true, false, 6},
                {"view", try_view, true, false, 9},
                {"material", try_material, true, false, 0},
#if ASET_WITH_POLYGONS
                {"polygon", try_polygon, false, false, SIZE_MAX},
#endif
#if ASET_WITH_PATCHES
                {"patch", try_patch, true, true, 0},
#endif
#if ASET_WITH_SPHERES
                {"sphere", try_sphere, false, false, SIZE_MAX},
#endif
#if ASET_WITH_CONES
                {"cone", try_cone, false, false, SIZE_MAX},
#endif
};

/* What a sink must say: OK if the number is one that the field may have. up of a view is a direction. */
static bool may_have(size_t entity, size_t field, size_t k) {
    if (k < NOT_FINITE) {
        return false;
    }
    bool is_view = strcmp(entities[entity].name, "view") == 0;
    if (is_view && field >= 6 && field < 9) {
        return true;
    }
    bool is_amount = field >= entities[entity].amounts_from && entities[entity].may_be_large;
    return is_amount && !(is_view && field >= 9) && (bad[k] > 0 || entities[entity].may_be_negative);
}

static void check_sink(const char *name, const aset_sink *sink) {
    for (size_t e = 0; e < COUNT_OF(entities); e++) {
        for (size_t k = 0; k < COUNT_OF(bad); k++) {
            aset_status status;
            for (size_t field = 0; entities[e].attempt(sink, field, bad[k], &status); field++) {
                bool directional = strcmp(entities[e].name, "light") == 0 && field < 6;
                bool fine = may_have(e, field, k);
                check(directional || (status == ASET_OK) == fine, "%s: %s, field %zu, %s: %s", name, entities[e].name, field,
                      bad_names[k], aset_status_text(status));
                check(k >= NOT_FINITE || status == ASET_ERR_GEOMETRY || status == ASET_ERR_ARGUMENT, "%s: %s, field %zu, %s: %s",
                      name, entities[e].name, field, bad_names[k], aset_status_text(status));
            }
            check(status == ASET_OK, "%s: a good %s: %s", name, entities[e].name, aset_status_text(status));
        }
    }
}

enum { MANY = 1000 };

static void test_arguments__sinks(void **state) {
    (void)state;
    static uint64_t block[1 << 16];
    const aset_counts limits = {.objects = MANY, .coordinates = 20 * MANY, .materials = MANY, .lights = MANY};
    aset_arena arena;
    aset_scene scene;
    aset_counter counter;
    assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
    assert_int_equal(aset_scene_init(&scene, &arena, &limits), ASET_OK);
    aset_sink sink = aset_scene_sink(&scene);
    check_sink("scene", &sink);
    assert_true(vec_finite(scene.low) && vec_finite(scene.high) && real_finite(scene.margin));
    sink = aset_counter_sink(&counter);
    check_sink("counter", &sink);
#if ASET_WITH_DRAFTS
    aset_baker *baker = malloc(sizeof *baker);
    assert_int_equal(aset_baker_init(baker, &arena, NULL), ASET_OK);
    sink = aset_baker_sink(baker);
    check_sink("baker", &sink);
    free(baker);
#endif
}

/* --- the baker's own way in --- */

#if ASET_WITH_DRAFTS && ASET_WITH_POLYGONS
/* In the first pass they are refused; in a later one, where the source broke its promise, they do no harm. */
static void test_arguments__triangles_of_a_bake(void **state) {
    (void)state;
    static uint64_t block[1 << 16];
    for (size_t k = 0; k < COUNT_OF(bad); k++) {
        for (int i = 0; i < 9; i++) {
            aset_real t[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1}, broken[18];
            aset_baker *baker = malloc(sizeof *baker);
            const aset_bake_options options = {.divisions = {8, 8, 8}, .keep_none = i % 2 == 0};
            aset_arena arena;
            bool again = true;
            memcpy(broken, t, sizeof t);
            broken[i] = bad[k];
            assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
            assert_int_equal(aset_baker_init(baker, &arena, &options), ASET_OK);
            aset_sink sink = aset_baker_sink(baker);
            give_material(&sink);
            assert_int_equal(aset_baker_triangles(baker, broken, 2), ASET_ERR_GEOMETRY);
            assert_int_equal(aset_baker_triangles(baker, t, 2), ASET_OK);
            aset_status status = aset_baker_pass(baker, &again);
            assert_int_equal(status, ASET_OK);
            for (int pass = 0; pass < 9 && status == ASET_OK && again; pass++) {
                sink = aset_baker_sink(baker);
                give_material(&sink);
                (void)aset_baker_triangles(baker, broken, 2);
                status = aset_baker_pass(baker, &again);
            }
            aset_draft draft;
            if (status == ASET_OK) {
                assert_false(again);
                assert_int_equal(aset_baker_finish(&draft, baker), ASET_OK);
                assert_int_equal(aset_draft_open(&draft, draft.words, draft.n_words, &arena, NULL), ASET_OK);
            }
            free(baker);
        }
    }
}

/* Coordinates that a scene takes and the cells do not. */
static void test_arguments__a_bake_is_smaller_than_a_scene(void **state) {
    (void)state;
    const double sizes[] = {9e14, 2e15, 1e25};
    for (size_t k = 0; k < COUNT_OF(sizes); k++) {
        const aset_real at[9] = {(aset_real)sizes[k], 0, 0, 1, 0, 0, 0, 1, 0};
        aset_arena arena;
        aset_counter counter;
        aset_baker *baker = malloc(sizeof *baker);
        assert_int_equal(aset_arena_init(&arena, NULL, 0), ASET_OK);
        assert_int_equal(aset_baker_init(baker, &arena, NULL), ASET_OK);
        aset_sink sink = aset_baker_sink(baker), counting = aset_counter_sink(&counter);
        give_material(&sink);
        give_material(&counting);
        const aset_vec3 p[3] = {{at[0], 0, 0}, {1, 0, 0}, {0, 1, 0}};
        aset_status expected = k == 0 ? ASET_OK : ASET_ERR_GEOMETRY;
        assert_int_equal(aset_baker_triangles(baker, at, 1), expected);
        assert_int_equal(aset_sink_polygon(&sink, p, NULL, 3), expected);
        assert_int_equal(aset_sink_polygon(&counting, p, NULL, 3), ASET_OK);
        free(baker);
    }
}
#endif

/* --- stage --- */

static void test_arguments__stage(void **state) {
    (void)state;
    for (size_t k = 0; k < NOT_FINITE; k++) {
        for (size_t field = 0; field < 7; field++) {
            aset_counter counter;
            aset_sink sink = aset_counter_sink(&counter);
            aset_vec3 low = {0, 0, 0}, high = {1, 1, 1};
            aset_stage_options options;
            memset(&options, 0, sizeof options);
            aset_real *const fields[] = {&low.x, &low.y, &low.z, &high.x, &high.y, &high.z, &options.aspect};
            *fields[field] = bad[k];
            check(aset_stage_emit(&sink, &low, &high, &options) == ASET_ERR_ARGUMENT, "field %zu, %s", field, bad_names[k]);
            assert_true(!counter.has_view && counter.counts.lights == 0);
        }
    }
}

/* --- rays, views, fractions --- */

typedef struct bench {
    model m;
    stage s;
    aset_space space;
    aset_scratch scratch;
    aset_tracer tracer;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
} bench;

static void bench_open(bench *b) {
    random_state r = random_start(seed_of(10));
    model_random(&b->m, &r, 20, 3, 0.3, 1);
    stage_open_model(&b->s, &b->m, 1 << 20);
    stage_space(&b->s, &b->space, &aset_mset, 5, 6, 7);
    b->tracer = stage_tracer(&b->s, &b->space);
#if ASET_WITH_APPROXIMATION
    assert_int_equal(aset_summary_build(&b->summary, &b->space, 0, &b->s.arena), ASET_OK);
    b->tracer.summary = &b->summary;
#endif
    assert_int_equal(aset_scratch_init(&b->scratch, 0, &b->s.arena), ASET_OK);
}

static void bench_close(bench *b) {
    stage_close(&b->s);
    model_free(&b->m);
}

static void test_arguments__rays(void **state) {
    (void)state;
    bench b;
    bench_open(&b);
    for (size_t k = 0; k < COUNT_OF(bad); k++) {
        for (size_t field = 0; field < 7; field++) {
            aset_ray ray = {{1, 2, 9}, {0, 0, -1}, REAL_INFINITY};
            aset_real *const fields[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z, &ray.direction.x,
                                         &ray.direction.y, &ray.direction.z, &ray.t_max};
            aset_hit hit;
            aset_colour colour = {-1, -1, -1};
            bool found = true;
            *fields[field] = bad[k];
            bool is_bad = field < 6 ? k < NOT_FINITE : k == 0;
            bool none = field == 6 && bad[k] < 0; /* an end before the origin: nothing is hit */
            for (int approximate = 0; approximate <= ASET_WITH_APPROXIMATION; approximate++) {
                aset_status status = aset_closest_hit(&found, &hit, &b.tracer, &ray, approximate, NULL);
                check(status == (is_bad ? ASET_ERR_ARGUMENT : ASET_OK), "field %zu, %s: %s", field, bad_names[k], aset_status_text(status));
                check(!none || !found, "field %zu, %s", field, bad_names[k]);
                check(aset_any_hit(&found, &b.tracer, &ray, approximate, NULL) == status, "field %zu, %s", field, bad_names[k]);
                check(!none || !found, "field %zu, %s", field, bad_names[k]);
            }
            if (field < 6) { /* its t_max is not used */
                aset_status status = aset_ray_colour(&colour, &b.tracer, &ray, &b.scratch, NULL);
                check(status == (is_bad ? ASET_ERR_ARGUMENT : ASET_OK), "field %zu, %s", field, bad_names[k]);
                check(is_bad ? colour.r == -1 : real_finite(colour.r), "field %zu, %s", field, bad_names[k]);
            }
        }
    }
    bench_close(&b);
}

static void test_arguments__views(void **state) {
    (void)state;
    bench b;
    bench_open(&b);
    for (size_t k = 0; k < COUNT_OF(bad); k++) {
        unsigned char pixels[3 * 16];
        const aset_picture picture = {.width = 4, .height = 4, .pixels = pixels, .stride = 12};
        aset_view view = good_view();
        for (size_t field = 0; spoil_view(&view, field, bad[k]); field++) {
            memset(pixels, 0x5a, sizeof pixels);
            aset_status status = aset_render_rows(&b.tracer, &view, &picture, 0, 4, &b.scratch, NULL);
            bool fine = may_have(2, field, k);
            check((status == ASET_OK) == fine, "field %zu, %s: %s", field, bad_names[k], aset_status_text(status));
            for (size_t i = 0; !fine && i < sizeof pixels; i++) {
                assert_int_equal(pixels[i], 0x5a);
            }
            view = good_view();
        }
    }
    bench_close(&b);
}

#if ASET_WITH_APPROXIMATION
/* NaN and below 0 are never, infinity is always: what the header says. */
static void test_arguments__curtail(void **state) {
    (void)state;
    bench b;
    bench_open(&b);
    for (size_t k = 0; k < COUNT_OF(bad); k++) {
        random_state r = random_start(seed_of(20));
        for (int i = 0; i < 200; i++) {
            aset_ray ray = random_ray_from(&r, 5);
            aset_hit hit;
            bool found, plain;
            b.tracer.curtail = 0;
            assert_int_equal(aset_closest_hit(&plain, &hit, &b.tracer, &ray, true, NULL), ASET_OK);
            b.tracer.curtail = bad[k];
            assert_int_equal(aset_closest_hit(&found, &hit, &b.tracer, &ray, true, NULL), ASET_OK);
            check(found == (plain && !(bad[k] > 0)), "%s, ray %d", bad_names[k], i);
        }
    }
    bench_close(&b);
}
#endif

/* --- report --- */

/* Seconds that are no numbers are 0 in text and JSON. */
static void test_arguments__report(void **state) {
    (void)state;
    bench b;
    bench_open(&b);
    for (size_t k = 0; k < COUNT_OF(bad); k++) {
        char text[8192];
        aset_report report;
        memset(&report, 0, sizeof report);
        report.tracer = &b.tracer;
        report.load_s = report.build_s = report.render_s = (double)bad[k];
        assert_true(aset_report_json(text, sizeof text, &report) < sizeof text);
        assert_non_null(strstr(text, "\"time\":{\"load_s\":0.000000,\"build_s\":0.000000,\"render_s\":0.000000}}"));
        assert_true(aset_report_text(text, sizeof text, &report) < sizeof text);
        assert_non_null(strstr(text, "0.000 s load, 0.000 s build, 0.000 s render"));
    }
    bench_close(&b);
}

/* --- readers --- */

/* The caller's own material is given to the sink, which refuses it as any other. */
static void test_arguments__material_of_a_reader(void **state) {
    (void)state;
    static const char text[] = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
                               "endsolid s\n";
    for (size_t k = 0; k < NOT_FINITE && ASET_WITH_POLYGONS; k++) {
        aset_material material = plain_material();
        for (size_t field = 0; spoil_material(&material, field, bad[k]); field++) {
            byte_source source = source_of(text, sizeof text - 1, 7);
            aset_load_options options;
            aset_load_report report;
            aset_counter counter;
            aset_sink sink = aset_counter_sink(&counter);
            memset(&options, 0, sizeof options);
            options.material = &material;
            check(aset_load_stl(&sink, give, &source, &options, &report) == ASET_ERR_ARGUMENT, "field %zu, %s", field, bad_names[k]);
            assert_int_equal(counter.counts.objects, 0);
            material = plain_material();
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arguments__sinks),
#if ASET_WITH_DRAFTS && ASET_WITH_POLYGONS
        cmocka_unit_test(test_arguments__triangles_of_a_bake),
        cmocka_unit_test(test_arguments__a_bake_is_smaller_than_a_scene),
#endif
        cmocka_unit_test(test_arguments__stage),
        cmocka_unit_test(test_arguments__rays),
        cmocka_unit_test(test_arguments__views),
#if ASET_WITH_APPROXIMATION
        cmocka_unit_test(test_arguments__curtail),
#endif
        cmocka_unit_test(test_arguments__report),
        cmocka_unit_test(test_arguments__material_of_a_reader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
