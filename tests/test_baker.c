/*
 * test_baker.c - baking drafts: the same words whatever the order of objects and the number of passes, exact shares of
 * columns, bytes of the arena, sources that err or change their mind, and models that are flat, tiny, huge, or all in one
 * voxel.
 */
#include "support/support.h"

#if ASET_WITH_DRAFTS

#include "approx/facet.h"

#define ROOM ((size_t)8 << 20)

typedef struct baked {
    guarded memory;
    aset_arena arena;
    aset_draft draft;
    aset_bake_report report;
} baked;

/* All passes of a bake. What the source or the baker answered last. */
static aset_status bake_all(aset_draft *draft, aset_bake_report *report, aset_arena *arena, const aset_bake_options *options,
                            stage_source source, const void *context) {
    aset_baker *baker = malloc(sizeof *baker);
    bool again = true;
    assert_non_null(baker);
    aset_status status = aset_baker_init(baker, arena, options);
    for (int pass = 0; status == ASET_OK && again; pass++) {
        assert_true(pass < 10000);
        aset_sink sink = aset_baker_sink(baker);
        status = source(&sink, context);
        if (status == ASET_OK) {
            status = aset_baker_pass(baker, &again);
            assert_true(status == ASET_OK || !again);
        }
    }
    if (status == ASET_OK) {
        status = aset_baker_finish(draft, baker);
    }
    *report = baker->report;
    free(baker);
    return status;
}

static void bake_source(baked *b, stage_source source, const void *context, const aset_bake_options *options, size_t room) {
    b->memory = guarded_open(room);
    assert_int_equal(aset_arena_init(&b->arena, b->memory.block, room), ASET_OK);
    assert_int_equal(bake_all(&b->draft, &b->report, &b->arena, options, source, context), ASET_OK);
    assert_true(guarded_intact(&b->memory));
}

static void bake_model(baked *b, const model *m, const aset_bake_options *options) {
    bake_source(b, model_emit, m, options, ROOM);
}

static void bake_close(baked *b) {
    guarded_close(&b->memory);
}

static bool same_words(const aset_draft *a, const aset_draft *b) {
    return a->n_words == b->n_words && memcmp(a->words, b->words, a->n_words * sizeof *a->words) == 0;
}

static void check_opens(const aset_draft *draft) {
    guarded memory = guarded_open(1 << 16);
    aset_arena arena;
    aset_draft opened;
    const char *why = "";
    assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
    aset_status status = aset_draft_open(&opened, draft->words, draft->n_words, &arena, &why);
    check(status == ASET_OK, "%d: %s", (int)status, why);
    guarded_close(&memory);
}

static aset_bake_options options_of(uint32_t nx, uint32_t ny, uint32_t nz) {
    aset_bake_options options;
    memset(&options, 0, sizeof options);
    options.divisions[0] = nx;
    options.divisions[1] = ny;
    options.divisions[2] = nz;
    return options;
}

static void shuffle(model *m, random_state *r) {
    for (uint32_t i = m->n_things; i > 1; i--) {
        uint32_t k = random_below(r, i);
        thing swapped = m->things[i - 1];
        m->things[i - 1] = m->things[k];
        m->things[k] = swapped;
    }
}

static aset_vec3 at(double x, double y, double z) {
    return dvec_real(dvec_make(x, y, z));
}

#if ASET_WITH_POLYGONS
/* Column middles in all footprints of a side, axis * 2 + down. */
static uint32_t columns_of_side(const aset_draft *draft, int axis, bool down) {
    uint32_t n = 0;
    for (uint32_t i = 0; i < draft->n_facets; i++) {
        facet f = facet_read(draft, i);
        n += f.axis == axis && f.down == down ? bits_count(f.footprint) : 0;
    }
    return n;
}
#endif

/* --- the same words --- */

static void test_baker__order_of_objects_does_not_matter(void **state) {
    (void)state;
    const aset_bake_options choices[] = {options_of(0, 0, 0), options_of(16, 16, 16), options_of(5, 33, 9),
                                          options_of(1, 1, 1)};
    for (uint64_t i = 0; i < 4; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        model_random(&m, &r, i < 2 ? 12 : 300, 10, 0.1, i % 2 == 0 ? 2 : 15); /* few: several are kept; many: none */
        for (size_t c = 0; c < COUNT_OF(choices); c++) {
            baked a, b;
            bake_model(&a, &m, &choices[c]);
            check_opens(&a.draft);
            for (int k = 0; k < 3; k++) {
                shuffle(&m, &r);
                bake_model(&b, &m, &choices[c]);
                check(same_words(&a.draft, &b.draft), SEED ", choice %zu, kept %" PRIu32, r.seed, c, a.report.kept);
                check(a.report.unseen == b.report.unseen && a.report.merged == b.report.merged &&
                          a.report.kept == b.report.kept, SEED, r.seed);
                bake_close(&b);
            }
            bake_close(&a);
        }
        model_free(&m);
    }
}

/* Numbers that are equal but not the same bits. */
static void test_baker__order_of_equal_materials_does_not_matter(void **state) {
    (void)state;
    aset_bake_options options = options_of(4, 4, 4);
    aset_material zero = plain_material();
    model m;
    baked a, b;
    model_start(&m);
    zero.fill.r = 0;
    model_material(&m, &zero);
    model_random_thing(&m, &(random_state){1, 1}, 1, 1)->material = 1;
    zero.fill.r = R(-0.0);
    zero.one_sided = true;
    model_material(&m, &zero);
    model_random_thing(&m, &(random_state){2, 2}, 1, 1)->material = 2;
    options.keep_none = true;
    bake_model(&a, &m, &options);
    m.backwards = true;
    bake_model(&b, &m, &options);
    assert_true(same_words(&a.draft, &b.draft));
    bake_close(&a);
    bake_close(&b);
    model_free(&m);
}

static void test_baker__passes_do_not_matter(void **state) {
    (void)state;
    const uint32_t grids[][3] = {{16, 16, 32}, {7, 30, 41}, {32, 32, 64}, {40, 9, 5}};
    uint32_t most = 0, compared = 0;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(50 + i));
        const uint32_t *g = grids[i % COUNT_OF(grids)];
        aset_bake_options options = options_of(g[0], g[1], g[2]);
        model m;
        baked whole;
        model_random(&m, &r, 200, 10, 0.5, 6);
        for (uint32_t k = 0; k < m.n_things && i % 3 != 0; k++) {
            m.things[k].material = 0; /* one material only */
        }
        options.bytes = ROOM - 65536;
        bake_model(&whole, &m, &options);
        for (size_t bytes = 1 << 19; bytes > 2000; bytes -= bytes / 3) {
            guarded memory = guarded_open(ROOM);
            aset_arena arena;
            aset_draft draft;
            aset_bake_report report;
            options.bytes = bytes;
            assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
            aset_status status = bake_all(&draft, &report, &arena, &options, model_emit, &m);
            check(status == ASET_OK || status == ASET_ERR_NOMEM, SEED ", %d", r.seed, (int)status);
            if (status == ASET_OK && report.merged == 0 && whole.report.merged == 0) {
                check(same_words(&draft, &whole.draft), SEED ", %zu bytes, %" PRIu32 " passes", r.seed, bytes,
                      report.passes);
                check(report.unseen == whole.report.unseen && report.voxels == whole.report.voxels, SEED, r.seed);
                most = report.passes > most ? report.passes : most;
                compared++;
            } else if (status != ASET_OK) {
                check(arena.used == 0 && arena.missing > 0, SEED ", %zu bytes", r.seed, bytes);
            }
            check(arena.peak <= bytes, SEED ", %zu bytes, peak %zu", r.seed, bytes, arena.peak);
            guarded_close(&memory);
        }
        bake_close(&whole);
        model_free(&m);
    }
    assert_true(most >= 6 && compared > 30);
}

/* --- memory --- */

static void test_baker__arena_holds_words_and_stage_only(void **state) {
    (void)state;
    random_state r = random_start(seed_of(80));
    model m;
    baked b;
    aset_bake_options options = options_of(12, 12, 12);
    model_random(&m, &r, 100, 10, 1, 5);
    bake_model(&b, &m, &options);
    const aset_counts *c = &b.draft.stage.limits;
    size_t bytes = ASET_BYTES_SCENE(c->objects, c->coordinates, c->materials, c->lights);
    assert_int_equal(b.arena.used, ASET_ROUND(b.draft.n_words * sizeof(uint32_t)) + bytes);
    assert_int_equal(b.arena.used_by[ASET_CATEGORY_CELLS], ASET_ROUND(b.draft.n_words * sizeof(uint32_t)));
    assert_int_equal(b.arena.used_by[ASET_CATEGORY_SCRATCH], 0);
    assert_int_equal(b.report.objects, m.n_things);
    assert_int_equal(b.report.facets, b.draft.n_facets);
    assert_int_equal(b.draft.stage.counts.lights, m.n_lights);
    assert_memory_equal(&b.draft.stage.background, &m.background, sizeof m.background);
    bake_close(&b);
    model_free(&m);
}

/* In an arena of which something is used already. */
static aset_status bake_in_bytes(size_t bytes, const model *m, const aset_bake_options *options, size_t *missing,
                                 aset_draft *draft, guarded *memory) {
    aset_arena arena;
    aset_bake_report report;
    *memory = guarded_open(bytes);
    assert_int_equal(aset_arena_init(&arena, memory->block, bytes), ASET_OK);
    (void)aset_arena_alloc(&arena, 40, ASET_CATEGORY_VOXELS);
    aset_arena before = arena;
    arena.missing = 0;
    aset_status status = bake_all(draft, &report, &arena, options, model_emit, m);
    assert_true(guarded_intact(memory));
    if (status != ASET_OK) {
        check(arena.used == before.used && memcmp(arena.used_by, before.used_by, sizeof arena.used_by) == 0, "%zu", bytes);
    }
    *missing = arena.missing;
    return status;
}

static void test_baker__stated_need_is_enough(void **state) {
    (void)state;
    const aset_bake_options choices[] = {options_of(12, 12, 12), options_of(6, 9, 30), options_of(0, 0, 0)};
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(90 + i));
        model m;
        model_random(&m, &r, i < 3 ? 60 : 6, 10, 1, 5);
        for (uint32_t k = 0; k < m.n_things && i % 2 == 0; k++) {
            m.things[k].material = 0;
        }
        uint32_t at_once = 0;
        for (size_t bytes = 64; bytes < 400000; bytes += bytes < 4096 ? 520 : bytes / 6) {
            const aset_bake_options *options = &choices[i % COUNT_OF(choices)];
            size_t missing, missing_then;
            guarded memory, larger;
            aset_draft draft;
            aset_status status = bake_in_bytes(bytes, &m, options, &missing, &draft, &memory);
            size_t now = bytes;
            for (int tries = 0; status != ASET_OK; tries++) { /* what is missing is known better with each */
                check(status == ASET_ERR_NOMEM && missing > 0 && tries < 3, SEED ", %zu: %d, %zu then", r.seed, bytes,
                      (int)status, missing);
                now += missing;
                status = bake_in_bytes(now, &m, options, &missing_then, &draft, &larger);
                missing = missing_then;
                guarded_close(&larger);
            }
            at_once += now == bytes;
            guarded_close(&memory);
        }
        check(at_once > 2, SEED, r.seed);
        model_free(&m);
    }
}

static void test_baker__automatic_divisions_follow_memory(void **state) {
    (void)state;
    random_state r = random_start(seed_of(100));
    model m;
    uint32_t before = 0, first = 0;
    model_random(&m, &r, 200, 10, 1, 5);
    for (size_t bytes = 160000; bytes < 6000000; bytes *= 2) {
        aset_bake_options options = options_of(0, 0, 0);
        aset_bake_report report;
        aset_draft draft;
        aset_arena arena;
        guarded memory = guarded_open(bytes);
        assert_int_equal(aset_arena_init(&arena, memory.block, bytes), ASET_OK);
        aset_status status = bake_all(&draft, &report, &arena, &options, model_emit, &m);
        check(status == ASET_OK, "%zu bytes: %d, %zu missing", bytes, (int)status, arena.missing);
        uint32_t longest = draft.n[0] > draft.n[1] ? draft.n[0] : draft.n[1];
        longest = longest > draft.n[2] ? longest : draft.n[2];
        check(longest >= before && longest <= 128, "%zu bytes: %" PRIu32 " after %" PRIu32, bytes, longest, before);
        first = first > 0 ? first : longest;
        before = longest;
        guarded_close(&memory);
    }
    assert_true(first < before);
    assert_int_equal(before, 128);
    model_free(&m);
}

/* --- what is refused --- */

static void test_baker__arguments(void **state) {
    (void)state;
    aset_arena arena;
    aset_baker *baker = malloc(sizeof *baker);
    aset_draft draft;
    bool again;
    assert_int_equal(aset_arena_init(&arena, NULL, 0), ASET_OK);
    assert_int_equal(aset_baker_init(NULL, &arena, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_init(baker, NULL, NULL), ASET_ERR_ARGUMENT);
    const uint32_t bad[][3] = {{0, 4, 4}, {4, 0, 4}, {4, 4, 0}, {513, 4, 4}, {4, 4, UINT32_MAX}};
    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        aset_bake_options options = options_of(bad[i][0], bad[i][1], bad[i][2]);
        assert_int_equal(aset_baker_init(baker, &arena, &options), ASET_ERR_ARGUMENT);
    }
    assert_int_equal(aset_baker_init(baker, &arena, NULL), ASET_OK);
    assert_int_equal(aset_baker_finish(&draft, baker), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_finish(NULL, baker), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_finish(&draft, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_pass(NULL, &again), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_pass(baker, NULL), ASET_ERR_ARGUMENT);
    again = true;
    assert_int_equal(aset_baker_pass(baker, &again), ASET_ERR_GEOMETRY); /* an empty source */
    assert_false(again);
    assert_int_equal(aset_baker_pass(baker, &again), ASET_ERR_ARGUMENT);
    free(baker);
}

static void test_baker__bad_entities_are_refused_as_a_scene_does(void **state) {
    (void)state;
    aset_arena arena;
    aset_baker *baker = malloc(sizeof *baker);
    aset_counter counter;
    aset_material material = plain_material(), bad = plain_material();
    assert_int_equal(aset_arena_init(&arena, NULL, 0), ASET_OK);
    assert_int_equal(aset_baker_init(baker, &arena, NULL), ASET_OK);
    aset_sink sinks[2] = {aset_baker_sink(baker), aset_counter_sink(&counter)};
    bad.diffuse = -1;
    for (int i = 0; i < 2; i++) {
        aset_sink *s = &sinks[i];
        for (int round = 0; round < 2; round++) {
            aset_status none = round == 0 ? ASET_ERR_ARGUMENT : ASET_OK;
#if ASET_WITH_POLYGONS
            const aset_vec3 points[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, nan[3] = {{0, 0, 0}, {R(NAN), 0, 0}, {0, 1, 0}};
            assert_int_equal(aset_sink_polygon(s, points, NULL, 2), ASET_ERR_GEOMETRY);
            assert_int_equal(aset_sink_polygon(s, points, NULL, 3), none);
            assert_int_not_equal(aset_sink_polygon(s, nan, NULL, 3), ASET_OK);
            assert_int_not_equal(s->polygon_point(s->context, points, NULL), ASET_OK);
            assert_int_not_equal(s->polygon_end(s->context), ASET_OK);
#endif
#if ASET_WITH_SPHERES
            const aset_vec3 centre = {0, 0, 0}, far = {R(INFINITY), 0, 0};
            assert_int_equal(s->sphere(s->context, &centre, 1), none);
            assert_int_equal(s->sphere(s->context, &centre, 0), ASET_ERR_GEOMETRY);
            assert_int_equal(s->sphere(s->context, &far, 1), ASET_ERR_GEOMETRY);
#endif
#if ASET_WITH_CONES
            const aset_vec3 base = {0, 0, 0}, apex = {0, 0, 1};
            assert_int_equal(s->cone(s->context, &base, 1, &apex, 1), none);
            assert_int_equal(s->cone(s->context, &base, 1, &base, 1), ASET_ERR_GEOMETRY);
#endif
            assert_int_equal(s->material(s->context, &bad), ASET_ERR_ARGUMENT);
            assert_int_equal(s->material(s->context, &material), ASET_OK);
        }
#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES && ASET_WITH_CONES
        for (int other = 0; other < (i == 0 ? 3 : 2); other++) { /* another object abandons a polygon in progress */
            const aset_vec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
            const aset_real triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
            assert_int_equal(s->polygon_begin(s->context, 3, false), ASET_OK);
            assert_int_equal(s->polygon_point(s->context, p, NULL), ASET_OK);
            assert_int_equal(other == 0   ? s->sphere(s->context, p, 1)
                             : other == 1 ? s->cone(s->context, p, 1, p + 1, 1)
                                          : aset_baker_triangles(baker, triangle, 1),
                             ASET_OK);
            assert_int_equal(s->polygon_point(s->context, p + 1, NULL), ASET_ERR_GEOMETRY);
            assert_int_equal(s->polygon_end(s->context), ASET_ERR_GEOMETRY);
        }
#endif
    }
    free(baker);
}

#if ASET_WITH_POLYGONS
static void test_baker__triangles_are_checked(void **state) {
    (void)state;
    aset_arena arena;
    aset_baker *baker = malloc(sizeof *baker);
    aset_material material = plain_material();
    static const aset_real whole[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const aset_real bad[] = {R(NAN), REAL_INFINITY, -REAL_INFINITY, REAL_MAX};
    assert_int_equal(aset_arena_init(&arena, NULL, 0), ASET_OK);
    assert_int_equal(aset_baker_init(baker, &arena, NULL), ASET_OK);
    assert_int_equal(aset_baker_triangles(baker, whole, 1), ASET_ERR_ARGUMENT); /* no material yet */
    aset_sink sink = aset_baker_sink(baker);
    assert_int_equal(sink.material(sink.context, &material), ASET_OK);
    assert_int_equal(aset_baker_triangles(NULL, whole, 1), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_triangles(baker, NULL, 1), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_baker_triangles(baker, NULL, 0), ASET_OK);
    for (int i = 0; i < 36; i++) { /* the first, some in the middle, the last, which is looked at alone */
        for (size_t k = 0; k < COUNT_OF(bad); k++) {
            aset_real t[36];
            for (int j = 0; j < 4; j++) {
                memcpy(t + 9 * j, whole, sizeof whole);
            }
            t[i] = bad[k];
            aset_status status = aset_baker_triangles(baker, t + i / 9 * 9, 1);
            check(status == ASET_ERR_GEOMETRY, "coordinate %d, bad %zu: %d", i, k, (int)status);
            status = aset_baker_triangles(baker, t, 4);
            check(status == ASET_ERR_GEOMETRY, "coordinate %d of four, bad %zu: %d", i, k, (int)status);
        }
    }
    assert_int_equal(aset_baker_triangles(baker, whole, 1), ASET_OK);
    free(baker);
}
#endif

/* --- sources that change between passes --- */

/* The next pass gives another model. Nothing may crash, and nothing be written outside; errors and drafts are both fine. */
static void bake_two_models(const model *first, const model *then, const aset_bake_options *options, size_t bytes,
                            uint64_t seed) {
    guarded memory = guarded_open(bytes);
    aset_arena arena;
    aset_draft draft;
    aset_baker *baker = malloc(sizeof *baker);
    bool again = true;
    assert_int_equal(aset_arena_init(&arena, memory.block, bytes), ASET_OK);
    assert_int_equal(aset_baker_init(baker, &arena, options), ASET_OK);
    aset_sink sink = aset_baker_sink(baker);
    aset_status status = model_emit(&sink, first);
    status = status == ASET_OK ? aset_baker_pass(baker, &again) : status;
    for (int pass = 0; pass < 40 && status == ASET_OK && again; pass++) {
        (void)model_emit(&sink, then); /* which goes on at an error, as a careless program would */
        status = aset_baker_pass(baker, &again);
    }
    if (status == ASET_OK && !again) {
        assert_int_equal(aset_baker_finish(&draft, baker), ASET_OK);
        check_opens(&draft);
    } else if (status != ASET_OK) {
        check(arena.used == 0, SEED, seed);
    }
    free(baker);
    guarded_close(&memory);
}

static void test_baker__a_source_that_changes_does_no_harm(void **state) {
    (void)state;
    const double edges[] = {10, 0.001, 1e6, 1e14};
    for (uint64_t i = 0; i < 120; i++) {
        random_state r = random_start(seed_of(200 + i));
        model first, then;
        aset_bake_options options = options_of(i % 3 == 0 ? 0 : 9, i % 3 == 0 ? 0 : 5, i % 3 == 0 ? 0 : 12);
        double edge = edges[random_below(&r, COUNT_OF(edges))];
        options.bytes = i % 5 == 0 ? 30000 : 0;
        model_random(&first, &r, 1 + random_below(&r, 30), 10, 0.5, 6);
        model_random(&then, &r, 1 + random_below(&r, 60), edge, edge / 20, edge);
        bake_two_models(&first, &then, &options, 300000, r.seed);
        bake_two_models(&then, &first, &options, 300000, r.seed);
        model_free(&first);
        model_free(&then);
    }
}

/* --- sources that fail --- */

/* The model's first things, a polygon that is never ended, and no more. */
static aset_status emit_broken(const aset_sink *sink, const model *m, uint32_t n_things) {
    model part = *m;
    part.n_things = n_things;
    assert_int_equal(model_emit(sink, &part), ASET_OK);
#if ASET_WITH_POLYGONS
    aset_vec3 point = at(1, 2, 3);
    if (n_things > 0) {
        assert_int_equal(sink->polygon_begin(sink->context, 3, false), ASET_OK);
        assert_int_equal(sink->polygon_point(sink->context, &point, NULL), ASET_OK);
    }
#endif
    return ASET_ERR_READ;
}

/* A baker that was given up takes nothing, makes nothing, and no longer touches the arena. */
static void check_abandoned(aset_baker *baker, const model *m) {
    aset_arena *arena = baker->arena;
    size_t used = arena->used;
    bool again = true;
    aset_draft draft;
    aset_sink sink = aset_baker_sink(baker);
    assert_int_not_equal(model_emit(&sink, m), ASET_OK);
    assert_int_equal(aset_baker_pass(baker, &again), ASET_ERR_ARGUMENT);
    assert_false(again);
    assert_int_equal(aset_baker_finish(&draft, baker), ASET_ERR_ARGUMENT);
    aset_baker_abandon(baker);
    assert_int_equal(arena->used, used);
}

/* A bake whose source fails in that pass after so many things; false: there are fewer passes, and all went well. */
static bool bake_failing(aset_arena *arena, const model *m, int bad_pass, uint32_t n_things) {
    aset_baker *baker = malloc(sizeof *baker);
    aset_bake_options options = options_of(5, 4, 3);
    aset_arena before = *arena;
    aset_draft draft;
    bool again = true, failed = false;
    assert_int_equal(aset_baker_init(baker, arena, &options), ASET_OK);
    for (int pass = 0; again && !failed; pass++) {
        aset_sink sink = aset_baker_sink(baker);
        failed = pass == bad_pass && emit_broken(&sink, m, n_things) != ASET_OK;
        if (!failed) {
            assert_int_equal(model_emit(&sink, m), ASET_OK);
            assert_int_equal(aset_baker_pass(baker, &again), ASET_OK);
        }
    }
    if (failed) {
        aset_baker_abandon(baker);
        check(arena->used == before.used && memcmp(arena->used_by, before.used_by, sizeof before.used_by) == 0,
              "pass %d, %u things", bad_pass, (unsigned)n_things);
        check_abandoned(baker, m);
    } else {
        assert_int_equal(aset_baker_finish(&draft, baker), ASET_OK);
        size_t used = arena->used;
        aset_baker_abandon(baker); /* takes nothing back that has become a draft */
        assert_int_equal(arena->used, used);
    }
    free(baker);
    return failed;
}

/* Wherever the source fails, in whatever pass, the arena is as before, and the next bake makes the same words. */
static void test_baker__a_source_that_fails_leaves_nothing(void **state) {
    (void)state;
    guarded memory = guarded_open(ROOM);
    aset_arena arena;
    random_state r = random_start(seed_of(350));
    model m;
    int pass = 0;
    model_random(&m, &r, 9, 4, 0.5, 3);
    if (ASET_WITH_POLYGONS) {
        model_rectangle(&m, at(-40, -40, -6), at(80, 0, 0), at(0, 80, 0)); /* is kept, so that all kinds of passes come */
    }
    assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
    (void)aset_arena_alloc(&arena, 40, ASET_CATEGORY_SCRATCH);
    aset_mark mark = aset_arena_mark(&arena);
    while (bake_failing(&arena, &m, pass, 0)) {
        aset_arena_release(&arena, &mark);
        for (uint32_t n = 1; n <= m.n_things; n++) {
            assert_true(bake_failing(&arena, &m, pass, n));
        }
        pass++;
    }
    assert_int_equal(pass, ASET_WITH_POLYGONS ? 3 : 2);
    baked whole;
    aset_draft draft;
    aset_bake_report report;
    aset_bake_options options = options_of(5, 4, 3);
    bake_model(&whole, &m, &options);
    aset_arena_release(&arena, &mark);
    assert_int_equal(bake_all(&draft, &report, &arena, &options, model_emit, &m), ASET_OK);
    assert_true(same_words(&draft, &whole.draft));
    aset_baker never;
    memset(&never, 0, sizeof never);
    aset_baker_abandon(&never);
    aset_baker_abandon(NULL);
    bake_close(&whole);
    model_free(&m);
    guarded_close(&memory);
}

#if ASET_WITH_POLYGONS
/* A polygon that is still open when the pass ends is forgotten; after the end nothing is taken any more. */
static void test_baker__open_polygons_and_late_entities(void **state) {
    (void)state;
    guarded memory = guarded_open(ROOM);
    aset_arena arena;
    aset_draft draft;
    aset_baker *baker = malloc(sizeof *baker);
    aset_bake_options options = options_of(4, 4, 4);
    aset_material material = plain_material();
    const aset_vec3 points[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    const aset_real coordinates[9] = {0, 0, 0, 1, 0, 0, 0, 1, 1};
    bool again = true;
    options.keep_none = true;
    assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
    assert_int_equal(aset_baker_init(baker, &arena, &options), ASET_OK);
    aset_sink s = aset_baker_sink(baker);
    for (int pass = 0; again; pass++) {
        if (pass == 1) { /* of the 100 points announced before, more than fit what was measured */
            for (int i = 0; i < 50; i++) {
                assert_int_not_equal(s.polygon_point(s.context, points, NULL), ASET_OK);
            }
        }
        assert_int_equal(s.material(s.context, &material), ASET_OK);
        assert_int_equal(aset_sink_polygon(&s, points, NULL, 3), ASET_OK);
        if (pass == 0) {
            assert_int_equal(s.polygon_begin(s.context, 100, false), ASET_OK);
        }
        assert_int_equal(aset_baker_pass(baker, &again), ASET_OK);
    }
    for (int finished = 0; finished < 2; finished++) {
        assert_int_not_equal(aset_sink_polygon(&s, points, NULL, 3), ASET_OK);
        assert_int_not_equal(aset_baker_triangles(baker, coordinates, 1), ASET_OK);
#if ASET_WITH_SPHERES
        assert_int_not_equal(s.sphere(s.context, points, 1), ASET_OK);
#endif
#if ASET_WITH_CONES
        assert_int_not_equal(s.cone(s.context, points, 1, points + 1, 1), ASET_OK);
#endif
        if (finished == 0) {
            assert_int_equal(aset_baker_finish(&draft, baker), ASET_OK);
        }
    }
    size_t used = arena.used;
    assert_int_equal(aset_baker_pass(baker, &again), ASET_ERR_ARGUMENT);
    assert_int_equal(arena.used, used); /* the draft is not taken back */
    assert_int_equal(aset_baker_finish(&draft, baker), ASET_ERR_ARGUMENT);
    check_opens(&draft);
    free(baker);
    guarded_close(&memory);
}

/* --- shares of columns --- */

static void add_triangle(model *m, aset_vec3 a, aset_vec3 b, aset_vec3 c) {
    const aset_vec3 points[3] = {a, b, c};
    model_polygon(m, points, NULL, 3);
}

static void randomly_triangulate(model *m, random_state *r, aset_vec3 corner[3], int depth) {
    if (depth == 0) {
        add_triangle(m, corner[0], corner[1], corner[2]);
        return;
    }
    double u = random_between(r, 0.05, 0.9), v = random_between(r, 0.05, 0.95 - u);
    dvec a = dvec_of(corner[0]), ab = dvec_sub(dvec_of(corner[1]), a), ac = dvec_sub(dvec_of(corner[2]), a);
    aset_vec3 inside = dvec_real(dvec_along(dvec_along(a, u, ab), v, ac));
    for (int i = 0; i < 3; i++) {
        aset_vec3 part[3] = {corner[i], corner[(i + 1) % 3], inside};
        randomly_triangulate(m, r, part, depth - 1);
    }
}

static aset_vec3 permuted(double a, double u, double v, int axis) {
    return axis == 0 ? at(a, u, v) : axis == 1 ? at(v, a, u) : at(u, v, a);
}

/* A square of one polygon, and of many triangles down to far below a column: the same words, as no column counts twice. */
static void test_baker__shared_edges_share_columns(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        random_state r = random_start(seed_of(300 + i));
        int axis = (int)(i % 3);
        bool down = i % 2 == 1;
        aset_bake_options options = options_of(9, 9, 9);
        model whole, parts;
        baked a, b;
        aset_vec3 c[4] = {permuted(2, 0, 0, axis), permuted(2, 1, 0, axis), permuted(2, 1, 1, axis),
                          permuted(2, 0, 1, axis)};
        options.keep_none = true;
        model_start(&whole);
        model_start(&parts);
        for (int k = 0; k < 2 && down; k++) {
            aset_vec3 swapped = c[k];
            c[k] = c[3 - k];
            c[3 - k] = swapped;
        }
        model_polygon(&whole, c, NULL, 4);
        aset_vec3 halves[2][3] = {{c[0], c[1], c[2]}, {c[0], c[2], c[3]}};
        randomly_triangulate(&parts, &r, halves[0], 6);
        randomly_triangulate(&parts, &r, halves[1], 5);
        bake_model(&a, &whole, &options);
        bake_model(&b, &parts, &options);
        uint32_t all = 36 * 36;
        check(columns_of_side(&a.draft, axis, down) == all, SEED ": %" PRIu32, r.seed,
              columns_of_side(&a.draft, axis, down));
        check(same_words(&a.draft, &b.draft), SEED ", %" PRIu32 " facets and %" PRIu32, r.seed, a.draft.n_facets,
              b.draft.n_facets);
        check(b.report.unseen > 0 && a.report.unseen == 0, SEED, r.seed);
        bake_close(&a);
        bake_close(&b);
        model_free(&whole);
        model_free(&parts);
    }
}

/* Footprints of a closed patchwork on an oblique plane: as the one polygon's, too. */
static void test_baker__concave_polygons_cover_what_their_triangles_do(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 60; i++) {
        random_state r = random_start(seed_of(330 + i));
        int axis = (int)(i % 3);
        model whole, parts;
        baked a, b;
        aset_vec3 points[THING_POINTS_MAX];
        uint32_t n = 5 + random_below(&r, THING_POINTS_MAX - 4);
        aset_bake_options options = options_of(7, 8, 6);
        options.keep_none = true;
        model_start(&whole);
        model_start(&parts);
        for (uint32_t k = 0; k < n; k++) {
            double angle = 6.283185307 * (k + random_between(&r, 0, 0.6)) / n, radius = random_between(&r, 0.1, 1);
            points[k] = permuted(0, radius * cos(angle), radius * sin(angle), axis);
        }
        model_polygon(&whole, points, NULL, n);
        for (uint32_t k = 0; k < n; k++) {
            add_triangle(&parts, at(0, 0, 0), points[k], points[(k + 1) % n]);
        }
        bake_model(&a, &whole, &options);
        bake_model(&b, &parts, &options);
        check(a.draft.n_facets > 0 && same_words(&a.draft, &b.draft),
              SEED ", axis %d: %" PRIu32 " columns and %" PRIu32, r.seed, axis,
              columns_of_side(&a.draft, axis, false), columns_of_side(&b.draft, axis, false));
        bake_close(&a);
        bake_close(&b);
        model_free(&whole);
        model_free(&parts);
    }
}

typedef struct soup {
    const aset_real *coordinates;
    uint32_t n, times;
    aset_material materials[2];
    bool quick;
} soup;

/* Noise: as many materials and footprints as there are. */
static aset_status noise_emit(const aset_sink *sink, const void *context) {
    random_state r = random_start(*(const uint64_t *)context);
    aset_view view = {{9, 8, 7}, {0, 0, 1}, {0, 0, 1}, 30, 0, 64, 48};
    aset_status status = sink->view(sink->context, &view);
    for (int i = 0; i < 30000 && status == ASET_OK; i++) {
        aset_material material = plain_material();
        aset_vec3 p = random_in_cube(&r, 1), points[3];
        material.fill.r = (aset_real)random_between(&r, 0, 1);
        for (int k = 0; k < 3; k++) {
            points[k] = random_in_cube(&r, 0.05);
            points[k].x += p.x;
            points[k].y += p.y;
            points[k].z += p.z;
        }
        status = sink->material(sink->context, &material);
        status = status == ASET_OK ? aset_sink_polygon(sink, points, NULL, 3) : status;
    }
    return status;
}

static void test_baker__noise(void **state) {
    (void)state;
    const size_t rooms[] = {8000000, 1500000};
    for (size_t i = 0; i < COUNT_OF(rooms); i++) {
        uint64_t seed = seed_of(700);
        aset_bake_options options = options_of(40, 30, 20);
        guarded memory = guarded_open(rooms[i]);
        aset_arena arena;
        aset_draft draft;
        aset_bake_report report;
        assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
        aset_status status = bake_all(&draft, &report, &arena, &options, noise_emit, &seed);
        check(status == ASET_OK || (status == ASET_ERR_NOMEM && i > 0), "%zu: %d", rooms[i], (int)status);
        if (status == ASET_OK) {
            check_opens(&draft);
            assert_true(report.merged > 0 && report.textures >= 64 && report.facets > 20000);
            assert_true(draft.stage.has_view && draft.stage.view.width_px == 64 && draft.stage.view.angle_deg == 30);
        } else {
            size_t need = rooms[i] + arena.missing;
            guarded larger = guarded_open(need);
            assert_int_equal(aset_arena_init(&arena, larger.block, need), ASET_OK);
            status = bake_all(&draft, &report, &arena, &options, noise_emit, &seed);
            check(status == ASET_OK, "%zu after %zu: %zu missing", need, rooms[i], arena.missing);
            guarded_close(&larger);
        }
        guarded_close(&memory);
    }
}

static aset_status soup_emit(const aset_sink *sink, const void *context) {
    const soup *s = context;
    aset_status status = ASET_OK;
    for (uint32_t k = 0; k < s->times && status == ASET_OK; k++) {
        status = sink->material(sink->context, &s->materials[k % 2]);
        if (status == ASET_OK && s->quick) {
            status = aset_baker_triangles(sink->context, s->coordinates, s->n);
        }
        for (uint32_t i = 0; i < s->n && !s->quick && status == ASET_OK; i++) {
            const aset_real *c = s->coordinates + 9 * (size_t)i;
            const aset_vec3 points[3] = {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}};
            status = aset_sink_polygon(sink, points, NULL, 3);
        }
    }
    return status;
}

/* Sums of millions: no overflow, no drift. */
static void test_baker__a_million_triangles_in_one_voxel(void **state) {
    (void)state;
    static const aset_real square[18] = {0, 0, 0, 1, 0, 0, 1, 1, R(0.25), 0, 0, 0, 1, 1, R(0.25), 0, 1, R(0.25)};
    const aset_real shines[] = {20, R(16777215)};
    for (int k = 0; k < 4; k++) {
        soup s = {square, 2, 2, {plain_material(), plain_material()}, k % 2 == 0};
        aset_bake_options options = options_of(1, 1, 1);
        baked few, many;
        s.materials[0].shine = shines[k / 2];
        s.materials[1].shine = shines[k / 2];
        s.materials[1].fill.g = 0;
        bake_source(&few, soup_emit, &s, &options, ROOM);
        s.times = k % 2 == 0 ? 500000 : 100000; /* the quick way, and the sink's */
        options.keep_none = true;
        bake_source(&many, soup_emit, &s, &options, ROOM);
        bake_close(&few);
        check(many.report.objects == 2 * (uint64_t)s.times, "k %d", k);
        s.times = 2;
        bake_source(&few, soup_emit, &s, &options, ROOM);
        assert_int_equal(many.draft.n_facets, 1);
        check(same_words(&few.draft, &many.draft), "k %d", k);
        aset_material mean = aset_draft_texture(&many.draft, 0);
        check(mean.shine == shines[k / 2] && real_abs(mean.fill.g - R(0.5)) < R(1e-4), "shine %g", (double)mean.shine);
        facet f = facet_read(&many.draft, 0);
        assert_int_equal(f.footprint, 0xffff);
        bake_close(&few);
        bake_close(&many);
    }
}

/* Parts of two materials as large as can be, one layer below what a sum holds and one above. */
static void test_baker__too_many_layers_are_refused(void **state) {
    (void)state;
    static const aset_real square[18] = {0, 0, R(0.5), 1, 0, R(0.5), 1, 1, R(0.5), 0, 0, R(0.5), 1, 1, R(0.5), 0, 1, R(0.5)};
    for (int k = 0; k < 2; k++) {
        soup s = {square, 2, (uint32_t)((1 << 20) - 1 + k), {plain_material(), plain_material()}, true};
        aset_bake_options options = options_of(1, 1, 1);
        guarded memory = guarded_open(ROOM);
        aset_arena arena;
        aset_draft draft;
        aset_bake_report report;
        options.keep_none = true;
        s.materials[0].shine = R(20000000);
        s.materials[1].shine = R(19000000);
        assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
        aset_status status = bake_all(&draft, &report, &arena, &options, soup_emit, &s);
        assert_int_equal(status, k == 0 ? ASET_OK : ASET_ERR_LIMIT);
        if (status == ASET_OK) {
            assert_true(aset_draft_texture(&draft, 0).shine == R(16777215));
        } else {
            assert_int_equal(arena.used, 0);
        }
        guarded_close(&memory);
    }
}

/* A polygon's mean plane may leave its box: no pass may pass it over for its box alone. */
static void test_baker__bent_polygons_in_any_number_of_passes(void **state) {
    (void)state;
    model m;
    model_start(&m);
    for (int i = 0; i < 64 * 64; i++) { /* all of two faces, for bins enough */
        model_rectangle(&m, at(i % 64, i / 64, 0.1), at(1, 0, 0), at(0, 1, 0));
        model_rectangle(&m, at(i % 64, i / 64, 63.9), at(1, 0, 0), at(0, 1, 0));
    }
    const aset_vec3 bent[4] = {at(0, 0, 31), at(60, 0, 1), at(60, 60, 31), at(0, 60, 31)};
    model_polygon(&m, bent, NULL, 4);
    aset_bake_options options = options_of(16, 16, 16);
    baked whole;
    options.keep_none = true;
    bake_model(&whole, &m, &options);
    uint32_t most = 0;
    for (options.bytes = 160000; options.bytes >= 15000; options.bytes -= 3000) {
        baked b;
        bake_model(&b, &m, &options);
        check(same_words(&b.draft, &whole.draft), "%zu bytes, %" PRIu32 " facets, not %" PRIu32, options.bytes,
              b.draft.n_facets, whole.draft.n_facets);
        most = b.report.passes > most ? b.report.passes : most;
        bake_close(&b);
    }
    check(most > 5, "%" PRIu32 " passes", most);
    bake_close(&whole);
    model_free(&m);
}

/* The quick way in and the sink give the same words, kept triangles included. */
/* The plane of a long thin triangle, as rounding has it, may lie far beside it, and no pass may find what another does not. */
static void test_baker__slivers_in_any_number_of_passes(void **state) {
    (void)state;
    enum { N = 40000, DIVISIONS = 256 };
    random_state r = random_start(1);
    aset_real *coordinates = malloc((size_t)N * 9 * sizeof *coordinates);
    assert_non_null(coordinates);
    for (int i = 0; i < N; i++) { /* from corner to corner, up to just below a layer of blocks; at first two as large as the box */
        double top = (16 * (1 + random_below(&r, DIVISIONS / 4 - 1)) - 0.6) / (4.0 * DIVISIONS), long_[3], from[3], share = random_between(&r, 0.3, 1);
        from[2] = top * random_between(&r, 0, 1);
        long_[2] = top - from[2];
        for (int a = 0; a < 2; a++) {
            from[a] = random_between(&r, 0, 0.02);
            long_[a] = random_between(&r, 0.98, 1) - from[a];
        }
        for (int a = 0; a < 3 && i < 2; a++) {
            from[a] = 0;
            long_[a] = a == 1 ? i : 1;
        }
        for (int a = 0; a < 3; a++) {
            coordinates[9 * i + a] = (aset_real)from[a];
            coordinates[9 * i + 3 + a] = (aset_real)(from[a] + long_[a]);
            coordinates[9 * i + 6 + a] = (aset_real)(from[a] + share * long_[a] + random_between(&r, -5e-7, 5e-7));
        }
    }
    soup s = {coordinates, N, 1, {plain_material(), plain_material()}, true};
    aset_bake_options options = options_of(DIVISIONS, DIVISIONS, DIVISIONS);
    baked whole, parts;
    options.keep_none = true;
    bake_source(&whole, soup_emit, &s, &options, (size_t)64 << 20);
    options.bytes = (size_t)DIVISIONS * DIVISIONS * DIVISIONS / 8 + 16 * (size_t)whole.draft.n_facets + 4 * whole.draft.n_words + 60000;
    bake_source(&parts, soup_emit, &s, &options, (size_t)64 << 20);
    check(parts.report.passes > whole.report.passes, "%" PRIu32 " passes", parts.report.passes);
    check(same_words(&whole.draft, &parts.draft), "%" PRIu32 " facets and %" PRIu32, whole.draft.n_facets, parts.draft.n_facets);
    bake_close(&whole);
    bake_close(&parts);
    free(coordinates);
}

/* Squares of so many materials, and a polygon of so many points. */
typedef struct crowd {
    uint32_t n_materials, n_points;
} crowd;

static aset_status crowd_emit(const aset_sink *sink, const void *context) {
    const crowd *c = context;
    aset_status status = ASET_OK;
    for (uint32_t i = 0; i < c->n_materials && status == ASET_OK; i++) {
        double x = i % 20, y = i / 20, z = i % 7 * 0.3; /* NOLINT: whole numbers */
        const aset_vec3 points[4] = {at(x, y, z), at(x + 0.9, y, z), at(x + 0.9, y + 0.9, z), at(x, y + 0.9, z)};
        aset_material material = plain_material();
        material.fill.r = (aset_real)(i % 20) / 20;
        material.fill.g = (aset_real)(i / 20) / 20;
        status = sink->material(sink->context, &material);
        status = status == ASET_OK ? aset_sink_polygon(sink, points, NULL, 4) : status;
    }
    if (c->n_points > 0 && status == ASET_OK) {
        status = sink->polygon_begin(sink->context, c->n_points, false);
        for (uint32_t i = 0; i < c->n_points && status == ASET_OK; i++) {
            double t = (double)i / c->n_points;
            aset_vec3 point = at(t < 0.5 ? t : 1 - t, t < 0.5 ? 0 : 0.1, 1);
            status = sink->polygon_point(sink->context, &point, NULL);
        }
        status = status == ASET_OK ? sink->polygon_end(sink->context) : status;
    }
    return status;
}

/* All textures are told apart in 512 kB, whatever marks and a large polygon take besides. */
static void test_baker__textures_of_little_memory(void **state) {
    (void)state;
    const struct {
        uint32_t divisions, points;
        size_t bytes;
    } cases[] = {{64, 0, 600000}, {64, 9000, 750000}, {128, 0, 1200000}, {256, 0, 5000000}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        crowd c = {400, cases[i].points};
        aset_bake_options options = options_of(cases[i].divisions, cases[i].divisions, cases[i].divisions);
        baked much, little;
        options.keep_none = true;
        bake_source(&much, crowd_emit, &c, &options, (size_t)64 << 20);
        options.bytes = cases[i].bytes * (sizeof(aset_real) / 4);
        bake_source(&little, crowd_emit, &c, &options, (size_t)64 << 20);
        check(little.report.merged == 0 && little.report.textures >= 400, "%zu: %" PRIu32 " textures, %" PRIu32 " facets share", i,
              little.report.textures, little.report.merged);
        check(same_words(&much.draft, &little.draft), "%zu", i);
        bake_close(&much);
        bake_close(&little);
    }
}

/* Nor is more taken for the stage. */
static void test_baker__bytes_for_the_stage(void **state) {
    (void)state;
    model m;
    model_start(&m);
    model_sphere(&m, at(0, 0, 0), 1);
    model_light(&m, at(3, 4, 5));
    aset_bake_options options = options_of(4, 4, 4);
    aset_arena arena;
    aset_draft draft;
    aset_bake_report report;
    guarded memory = guarded_open(ROOM);
    options.bytes = 16;
    options.keep_none = true;
    assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
    assert_int_equal(bake_all(&draft, &report, &arena, &options, model_emit, &m), ASET_ERR_NOMEM);
    check(arena.peak == 0 && arena.missing == ASET_BYTES_SCENE(0, 0, 0, 1) - options.bytes, "%zu at the peak, %zu missing", arena.peak, arena.missing);
    guarded_close(&memory);
    model_free(&m);
}

/* The region has room for the points of the largest polygon, or the bake says what is missing; automatic divisions fit beside them. */
static void test_baker__a_polygon_of_many_points(void **state) {
    (void)state;
    for (uint32_t points = 10000; points <= 100000; points *= 10) {
        for (uint32_t divisions = 0; divisions <= 16; divisions += 8) {
            crowd c = {1, points};
            aset_bake_options options = options_of(divisions, divisions, divisions);
            aset_status status = ASET_ERR_NOMEM;
            size_t bytes = 100000;
            int tries = 0;
            for (; status == ASET_ERR_NOMEM && tries < 5; tries++) {
                aset_arena arena;
                aset_draft draft;
                aset_bake_report report;
                guarded memory = guarded_open(bytes);
                assert_int_equal(aset_arena_init(&arena, memory.block, bytes), ASET_OK);
                status = bake_all(&draft, &report, &arena, &options, crowd_emit, &c);
                bytes += arena.missing;
                guarded_close(&memory);
            }
            check(status == ASET_OK, "%" PRIu32 " points, %" PRIu32 " divisions: %d after %d tries", points, divisions, (int)status, tries);
            options.bytes = 64 * points / 10; /* the points alone take more */
            aset_arena arena;
            aset_draft draft;
            aset_bake_report report;
            guarded memory = guarded_open((size_t)16 << 20);
            assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
            status = bake_all(&draft, &report, &arena, &options, crowd_emit, &c);
            check(status == ASET_ERR_NOMEM && arena.missing > 0, "%" PRIu32 " points: %d", points, (int)status);
            check(arena.peak <= options.bytes, "%zu bytes of %zu", arena.peak, options.bytes);
            guarded_close(&memory);
        }
    }
}

static void test_baker__triangles_are_polygons(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(400 + i));
        aset_real coordinates[9 * 100];
        soup s = {coordinates, i % 2 == 0 ? 100 : 6, 1, {plain_material(), plain_material()}, true};
        baked a, b;
        for (uint32_t k = 0; k < s.n * 3; k++) {
            aset_vec3 p = random_in_cube(&r, k < 12 ? 4 : 1);
            memcpy(coordinates + 3 * k, &p, sizeof p);
        }
        bake_source(&a, soup_emit, &s, NULL, ROOM);
        s.quick = false;
        bake_source(&b, soup_emit, &s, NULL, ROOM);
        check(a.report.kept > 0, SEED, r.seed);
        check(same_words(&a.draft, &b.draft), SEED, r.seed);
        check(memcmp(&a.report, &b.report, sizeof a.report) == 0, SEED, r.seed);
        bake_close(&a);
        bake_close(&b);
    }
}

/* --- what is kept --- */

static void test_baker__a_ground_is_kept(void **state) {
    (void)state;
    model m;
    baked b;
    aset_material red = plain_material();
    random_state r = random_start(seed_of(420));
    model_start(&m);
    red.fill.g = red.fill.b = 0;
    red.one_sided = true;
    for (int i = 0; i < 500; i++) {
        aset_vec3 p = random_in_cube(&r, 1), q = random_in_cube(&r, 0.2), s = random_in_cube(&r, 0.2);
        add_triangle(&m, p, at((double)(p.x + q.x), (double)(p.y + q.y), (double)(p.z + q.z)),
                     at((double)(p.x + s.x), (double)(p.y + s.y), (double)(p.z + s.z)));
    }
    model_material(&m, &red);
    model_rectangle(&m, at(-100, -100, -1.5), at(200, 0, 0), at(0, 200, 0));
    bake_model(&b, &m, NULL);
    assert_int_equal(b.report.kept, 1);
    assert_int_equal(b.draft.stage.counts.objects, 1);
    assert_int_equal(b.draft.n_textures, 1);
    assert_true(b.draft.size[0] < R(0.02)); /* the cells are the model's, not the ground's */
    assert_true(b.draft.stage.materials[0].one_sided && b.draft.stage.materials[0].fill.g == 0);
    aset_bake_options options = options_of(20, 20, 20);
    options.keep_none = true;
    bake_close(&b);
    bake_model(&b, &m, &options);
    assert_int_equal(b.report.kept, 0);
    assert_true(b.draft.size[0] > R(2));
    bake_close(&b);
    model_free(&m);
}

static void test_baker__equal_objects_are_kept_all_or_none(void **state) {
    (void)state;
    for (uint32_t n = 14; n <= 19; n++) {
        for (uint32_t larger = 0; larger < 3; larger++) {
            model m;
            baked b;
            model_start(&m);
            for (uint32_t i = 0; i < n; i++) {
                model_rectangle(&m, at(0, 0, i), at(64, 0, 0), at(0, 64, 0));
                if (i < larger) {
                    model_rectangle(&m, at(0, 0, -1 - (double)i), at(65 + (double)i, 0, 0), at(0, 64, 0));
                }
            }
            uint32_t expected = n + larger <= ASET_KEPT_MAX ? n + larger : larger;
            const aset_bake_options options = options_of(4, 4, 4);
            bake_model(&b, &m, &options);
            check(b.report.kept == expected, "%" PRIu32 " and %" PRIu32 " larger: %" PRIu32, n, larger, b.report.kept);
            check_opens(&b.draft);
            bake_close(&b);
            model_free(&m);
        }
    }
}
#endif

/* A ray from outside, the hit's facet; false: less than half of it was covered by the draft. */
static bool look(aset_hit *hit, const aset_draft *draft, aset_vec3 from, aset_vec3 towards) {
    aset_tracer tracer;
    bool found = false;
    aset_ray ray = {from, {towards.x - from.x, towards.y - from.y, towards.z - from.z}, REAL_INFINITY};
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &draft->stage;
    tracer.draft = draft;
    assert_int_equal(aset_closest_hit(&found, hit, &tracer, &ray, true, NULL), ASET_OK);
    return found;
}

#if ASET_WITH_POLYGONS
static void check_flat(dvec corner, dvec u, dvec v, double distance, const char *name) {
    random_state r = random_start(seed_of(500));
    dvec n = dvec_unit(dvec_cross(u, v));
    model m;
    model_start(&m);
    for (int i = 0; i < 20; i++) { /* too many to be kept */
        for (int j = 0; j < 20; j++) {
            aset_vec3 c = dvec_real(dvec_along(dvec_along(corner, i / 20.0, u), j / 20.0, v));
            dvec du = dvec_make(u.x / 20, u.y / 20, u.z / 20), dv = dvec_make(v.x / 20, v.y / 20, v.z / 20);
            model_rectangle(&m, c, dvec_real(du), dvec_real(dv));
        }
    }
    baked b;
    bake_model(&b, &m, NULL);
    check_opens(&b.draft);
    int missed = 0;
    for (int i = 0; i < 2000; i++) {
        aset_hit hit;
        double s = random_between(&r, 0.1, 0.9), t = random_between(&r, 0.1, 0.9);
        dvec target = dvec_along(dvec_along(corner, s, u), t, v);
        dvec from = dvec_along(dvec_along(target, distance * (i % 2 == 0 ? 1 : -1) * dvec_length(u), n), distance * 0.3, u);
        missed += !look(&hit, &b.draft, dvec_real(from), dvec_real(target));
    }
    check(missed == 0, "%s from %g: %d of 2000 missed", name, distance, missed);
    bake_close(&b);
    model_free(&m);
}

static void test_baker__flat_models(void **state) {
    (void)state;
    for (double distance = 0.5; distance < 200; distance *= 10) {
        check_flat(dvec_make(0, 0, 0), dvec_make(1, 0, 0), dvec_make(0, 1, 0), distance, "z");
        check_flat(dvec_make(3, 0, 0), dvec_make(0, 1, 0), dvec_make(0, 0, 1), distance, "x");
        check_flat(dvec_make(0, -7, 0), dvec_make(1, 0, 0), dvec_make(0, 0, 1), distance, "y");
        check_flat(dvec_make(0, 0, 0), dvec_make(1, 0, 1), dvec_make(0, 1, 0), distance, "oblique");
        check_flat(dvec_make(0, 0, 0), dvec_make(1, 0.3, -0.2), dvec_make(0.1, 0.9, 0.5), distance, "more oblique");
    }
}
#endif

/* Scaled by a power of two every step is, so that all words but the box's are the same. */
static void test_baker__scale_does_not_matter(void **state) {
    (void)state;
    const int powers[] = {-46, -80, -20, 10, 45};
    for (uint64_t i = 0; i < 3; i++) {
        for (size_t k = 0; k < COUNT_OF(powers); k++) {
            random_state r = random_start(seed_of(520 + i));
            aset_bake_options options = options_of(10, 11, 12);
            aset_real scale = (aset_real)ldexp(1, powers[k]);
            model m;
            baked a, b;
            model_random(&m, &r, i == 0 ? 10 : 100, 5, 0.5, 5);
            m.n_lights = 0;
            options.keep_none = true;
            bake_model(&a, &m, &options);
            for (uint32_t t = 0; t < m.n_things; t++) {
                thing *it = m.things + t;
                for (int p = 0; p < THING_POINTS_MAX; p++) {
                    it->points[p].x *= scale;
                    it->points[p].y *= scale;
                    it->points[p].z *= scale;
                }
                it->radii[0] *= scale;
                it->radii[1] *= scale;
            }
            bake_model(&b, &m, &options);
            check_opens(&b.draft);
            check(a.draft.n_words == b.draft.n_words && memcmp(a.draft.words + WORD_BLOCKS, b.draft.words + WORD_BLOCKS,
                                                               (a.draft.n_words - WORD_BLOCKS) * 4) == 0,
                  SEED ", 2^%d", r.seed, powers[k]);
            bake_close(&a);
            bake_close(&b);
            model_free(&m);
        }
    }
}

/* Models of hardly any size, near and far: always a draft, and one that opens. */
#if ASET_WITH_SPHERES
/* What a source that does not stay the same gives: spheres and lights in the first pass, and from then on. */
typedef struct fickle {
    int spheres[2], lights[2];
    int *pass;
} fickle;

static aset_status fickle_emit(const aset_sink *sink, const void *context) {
    const fickle *f = context;
    int k = (*f->pass)++ > 0;
    aset_material material = plain_material();
    aset_light light;
    memset(&light, 0, sizeof light);
    light.position.z = 100;
    aset_status status = sink->material(sink->context, &material);
    for (int i = 0; i < f->lights[k] && status == ASET_OK; i++) {
        status = sink->light(sink->context, &light);
    }
    for (int i = 0; i < f->spheres[k] && status == ASET_OK; i++) {
        aset_vec3 centre = at(i % 10, i / 10, 0);
        status = sink->sphere(sink->context, &centre, R(0.4));
    }
    return status;
}

static void test_baker__a_source_that_changes_is_refused(void **state) {
    (void)state;
    static const int spheres[][2] = {{100, 100}, {100, 0}, {100, 99}, {100, 101}, {100, 100}, {3, 3}, {3, 2}};
    for (size_t i = 0; i < COUNT_OF(spheres); i++) { /* the last two: all are kept, or none */
        for (int keep = 0; keep < 2; keep++) {
            int pass = 0;
            const fickle f = {{spheres[i][0], spheres[i][1]}, {2, i == 4 ? 1 : 2}, &pass};
            guarded memory = guarded_open(ROOM);
            aset_arena arena;
            aset_draft draft;
            aset_bake_report report;
            aset_bake_options options = options_of(16, 16, 16);
            options.keep_none = keep == 0;
            assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
            aset_status status = bake_all(&draft, &report, &arena, &options, fickle_emit, &f);
            check(status == (i == 0 || i == 5 ? ASET_OK : ASET_ERR_GEOMETRY), "source %zu, %d: %d", i, keep, (int)status);
            check(status == ASET_OK || arena.used == 0, "source %zu, %d: %zu bytes kept", i, keep, arena.used);
            guarded_close(&memory);
        }
    }
}

/* Lights are as many in every pass, whichever comes first: the stage, or passes that bake. */
static void test_baker__lights_that_change_are_refused(void **state) {
    (void)state;
    for (int changes = 0; changes < 4; changes++) { /* from that pass on; 0: never */
        for (int keep = 0; keep < 2; keep++) {
            int pass = 0;
            fickle f = {{100, 100}, {3, 3}, &pass};
            guarded memory = guarded_open(ROOM);
            aset_arena arena;
            aset_baker *baker = malloc(sizeof *baker);
            aset_bake_options options = options_of(16, 16, 16);
            options.keep_none = keep == 0;
            options.bytes = 160000; /* so that there are several passes */
            bool again = true;
            aset_status status = aset_arena_init(&arena, memory.block, memory.size);
            assert_int_equal(aset_baker_init(baker, &arena, &options), ASET_OK);
            for (int i = 0; again && status == ASET_OK; i++) {
                aset_sink sink = aset_baker_sink(baker);
                f.lights[0] = f.lights[1] = changes > 0 && i >= changes ? 2 : 3;
                assert_int_equal(fickle_emit(&sink, &f), ASET_OK);
                if (keep == 1) {
                    const aset_vec3 far = {-500, 0, 0};
                    assert_int_equal(sink.sphere(sink.context, &far, 300), ASET_OK);
                }
                status = aset_baker_pass(baker, &again);
            }
            check(status == (changes == 0 ? ASET_OK : ASET_ERR_GEOMETRY), "from pass %d on, %d: %d", changes, keep, (int)status);
            check(changes > 0 || baker->report.passes > 4, "%u passes", baker->report.passes);
            free(baker);
            guarded_close(&memory);
        }
    }
}

/* What is emitted after an end goes nowhere, least of all into memory that is somebody else's by now. */
static void test_baker__nothing_is_written_after_an_end(void **state) {
    (void)state;
    for (int passes = 0; passes < 3; passes++) {
        guarded memory = guarded_open(ROOM);
        aset_arena arena;
        aset_baker *baker = malloc(sizeof *baker);
        aset_bake_options options = options_of(8, 8, 8);
        int pass = 0;
        fickle f = {{100, 100}, {3, 3}, &pass};
        bool again = true;
        aset_light light;
        memset(&light, 0, sizeof light);
        assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
        assert_int_equal(aset_baker_init(baker, &arena, &options), ASET_OK);
        aset_sink sink = aset_baker_sink(baker);
        for (int i = 0; i < passes; i++) {
            assert_int_equal(fickle_emit(&sink, &f), ASET_OK);
            f.lights[1] = i == 0 && passes == 2 ? 2 : 3; /* the second pass fails, then */
            assert_int_equal(aset_baker_pass(baker, &again), i == 0 ? ASET_OK : ASET_ERR_GEOMETRY);
        }
        aset_baker_abandon(baker);
        unsigned char *others = aset_arena_alloc(&arena, 65536, ASET_CATEGORY_SCRATCH);
        memset(others, 7, 65536);
        (void)sink.light(sink.context, &light);
        assert_int_not_equal(sink.sphere(sink.context, &light.position, 1), ASET_OK);
        for (int i = 0; i < 65536; i++) {
            assert_int_equal(others[i], 7);
        }
        free(baker);
        guarded_close(&memory);
    }
}

#if ASET_REAL_BITS == 64
/* A draft's words are floats: where these hardly tell a model's parts apart, though its own numbers do. */
static void test_baker__far_from_the_origin_in_double(void **state) {
    (void)state;
    static const double places[] = {0, 1e3, 1e5, 1e7, 1e9, 1e12};
    for (size_t i = 0; i < COUNT_OF(places); i++) {
        guarded memory = guarded_open(ROOM);
        aset_arena arena;
        aset_draft draft;
        aset_bake_report report;
        aset_bake_options options = options_of(32, 32, 32);
        model m;
        model_start(&m);
        model_sphere(&m, at(places[i] + 0.3, places[i], -places[i]), 1);
        options.keep_none = true;
        assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
        aset_status status = bake_all(&draft, &report, &arena, &options, model_emit, &m);
        check(status == (places[i] < 1e6 ? ASET_OK : ASET_ERR_PRECISION), "at %g: %d", places[i], (int)status);
        if (status == ASET_OK) {
            for (int a = 0; a < 3; a++) {
                double centre = a == 0 ? places[i] + 0.3 : a == 1 ? places[i] : -places[i];
                double low = draft.low[a], high = low + draft.size[a] * 4 * draft.n[a];
                check(low <= centre - 1 && centre + 1 <= high, "at %g: %g to %g on axis %d", places[i], low, high, a);
            }
        }
        model_free(&m);
        guarded_close(&memory);
    }
}
#endif
#endif

#if ASET_WITH_SPHERES
/* What meets no column's middle is counted, an object as one. */
static void test_baker__tiny_round_things_are_unseen(void **state) {
    (void)state;
    model m;
    baked b;
    aset_bake_options options = options_of(8, 8, 8);
    options.keep_none = true;
    model_start(&m);
    model_sphere(&m, at(0, 0, 0), 1);
    for (int i = 0; i < 100; i++) {
        model_sphere(&m, at(0.01 * i, 0.3, 0.4), 1e-6);
    }
    bake_model(&b, &m, &options);
    assert_int_equal(b.report.objects, 101);
    assert_int_equal(b.report.unseen, 100);
    bake_close(&b);
#if ASET_WITH_CONES
    for (int i = 0; i < 7; i++) {
        model_cone(&m, at(0.01 * i, 0.3, 0.4), 1e-6, at(0.01 * i, 0.3, 0.400001), 2e-6);
    }
    bake_model(&b, &m, &options);
    assert_int_equal(b.report.unseen, 107);
    bake_close(&b);
#endif
    model_free(&m);
}

#if ASET_REAL_BITS == 64
/* The words hold floats: what they cannot tell is refused at the end, with nothing left behind. */
static aset_status odd_stage(const aset_sink *sink, const void *context) {
    int which = *(const int *)context;
    aset_material plain = plain_material();
    aset_light light = {.position = {which == 0 ? 1e60 : 5, 0, 0}};
    aset_view view = {.from = {1e5, 0, 0}, .at = {1e5 + (which == 1 ? 1e-5 : 1), 0, 0}, .up = {0, 0, 1}, .angle_deg = 40};
    plain.fill.r = which == 2 ? 1e50 : 1;
    assert_int_equal(sink->light(sink->context, &light), ASET_OK);
    assert_int_equal(sink->view(sink->context, &view), ASET_OK);
    assert_int_equal(sink->material(sink->context, &plain), ASET_OK);
    for (int i = 0; i < 9; i++) { /* one large, to be kept */
        const aset_vec3 centre = {i, 0, 0};
        assert_int_equal(sink->sphere(sink->context, &centre, i == 0 ? 50 : 0.1), ASET_OK);
    }
    return ASET_OK;
}

static void test_baker__what_floats_cannot_tell(void **state) {
    (void)state;
    for (int which = 0; which < 4; which++) {
        guarded memory = guarded_open(ROOM);
        aset_arena arena;
        aset_draft draft;
        aset_bake_report report;
        aset_bake_options options = options_of(8, 8, 8);
        assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
        aset_status status = bake_all(&draft, &report, &arena, &options, odd_stage, &which);
        check(report.kept == 1, "%d: %" PRIu32, which, report.kept);
        check(status == (which < 3 ? ASET_ERR_PRECISION : ASET_OK), "%d: %d", which, (int)status);
        check(status == ASET_OK || arena.used == 0, "%d: %zu", which, arena.used);
        guarded_close(&memory);
    }
}
#endif
#endif

static void test_baker__models_of_hardly_any_size(void **state) {
    (void)state;
    const double sizes[] = {0, 1e-44, 1e-38, 1e-36, 1e-30, 1e-25, 1e-14, 1e-8}, places[] = {0, 1e-30, 1, 1e14};
    for (size_t i = 0; i < COUNT_OF(sizes) * COUNT_OF(places) * 2; i++) {
        random_state r = random_start(seed_of(540 + i));
        double size = sizes[i / 2 / COUNT_OF(places)], place = places[i / 2 % COUNT_OF(places)];
        uint32_t n = i % 8 == 0 ? 0 : 40;
        aset_bake_options options = options_of(n, n, n);
        (void)r; /* polygons' only */
        model m;
        baked b;
        options.keep_none = i % 2 == 0;
        model_start(&m);
        for (int k = 0; k < 12; k++) {
#if ASET_WITH_POLYGONS
            aset_vec3 p[3];
            for (int c = 0; c < 3; c++) {
                dvec corner = dvec_of(random_in_cube(&r, 1));
                p[c] = at(place + size * corner.x, place + size * corner.y, place + size * corner.z);
            }
            add_triangle(&m, p[0], p[1], p[2]);
#endif
#if ASET_WITH_SPHERES
            if (size > 0 && (aset_real)size > 0) {
                model_sphere(&m, at(place, place + size, place), size);
            }
#endif
        }
        if (m.n_things > 0) {
            b.memory = guarded_open(ROOM);
            assert_int_equal(aset_arena_init(&b.arena, b.memory.block, ROOM), ASET_OK);
            aset_status status = bake_all(&b.draft, &b.report, &b.arena, &options, model_emit, &m);
            /* in double a model may have an extent of its own that a draft's floats do not tell */
            bool lost = ASET_REAL_BITS == 64 && size > 0 && size < 1e-4 * place && status == ASET_ERR_PRECISION;
            check(status == ASET_OK || lost, "size %g at %g: %d", size, place, (int)status);
            if (status == ASET_OK) {
                check_opens(&b.draft);
                for (int a = 0; a < 3; a++) {
                    check(real_finite(b.draft.per_size[a]) && b.draft.size[a] > 0, "size %g at %g", size, place);
                }
                aset_hit hit;
                (void)look(&hit, &b.draft, at(place * 2 + 2 * size + 1, place, place), at(place, place, place));
            }
            bake_close(&b);
        }
        model_free(&m);
    }
}

/* Numbers that a material may have and a draft's texture may not. */
static void test_baker__materials_of_any_size(void **state) {
    (void)state;
    const aset_real amounts[] = {0, R(1e-30), R(16777216), R(1e9), R(1e30)};
    for (size_t i = 0; i < COUNT_OF(amounts) * 4; i++) {
        random_state r = random_start(seed_of(560 + i));
        aset_material material = plain_material();
        aset_bake_options options = options_of(3, 3, 3);
        model m;
        baked b;
        model_start(&m);
        material.shine = amounts[i / 4];
        material.fill.r = i % 2 == 0 ? amounts[i / 4] : 1;
        model_material(&m, &material);
        for (int k = 0; k < 5; k++) {
            model_random_thing(&m, &r, 1, 1)->material = i / 2 % 2 == 0 ? 1 : (uint32_t)k % 2;
        }
        options.keep_none = i % 3 == 0;
        bake_model(&b, &m, &options);
        check_opens(&b.draft);
        bake_close(&b);
        model_free(&m);
    }
}

/* --- pictures of whole bodies --- */

#if ASET_WITH_SPHERES
/* From everywhere towards points well within: each ray stops, near the sphere, and the normal looks out. */
static void check_ball(const baked *b, double radius, int rays, const char *name) {
    random_state r = random_start(seed_of(600));
    int missed = 0, wrong = 0, far = 0, through = 0;
    for (int i = 0; i < rays; i++) {
        aset_hit hit;
        dvec out = dvec_of(random_direction(&r)), in = dvec_of(random_in_cube(&r, 0.5 * radius));
        aset_vec3 from = at(out.x * radius * 3, out.y * radius * 3, out.z * radius * 3);
        if (!look(&hit, &b->draft, from, dvec_real(in))) {
            missed++;
            continue;
        }
        dvec p = dvec_of(hit.point);
        through += hit.t > 1; /* most of the ray reached the middle */
        far += fabs(dvec_length(p) - radius) > 3 * (double)b->draft.column;
        wrong += dvec_dot(dvec_of(hit.normal), p) <= 0;
    }
    check(missed == 0 && through * 250 <= rays && far == 0 && wrong == 0,
          "%s: %d of %d missed, %d through, %d far, %d normals inwards", name, missed, rays, through, far, wrong);
}

static void test_baker__a_sphere_has_no_hole(void **state) {
    (void)state;
    const uint32_t grids[] = {8, 32, 64};
    for (size_t g = 0; g < COUNT_OF(grids); g++) {
        aset_bake_options options = options_of(grids[g], grids[g], grids[g]);
        model m;
        baked b;
        options.keep_none = true;
        model_start(&m);
        model_sphere(&m, at(0, 0, 0), 2);
        bake_model(&b, &m, &options);
        check_ball(&b, 2, grids[g] == 32 ? 100000 : 10000, "sphere");
        bake_close(&b);
        model_free(&m);
    }
}

#if ASET_WITH_POLYGONS
/* The same of triangles. */
static void test_baker__a_ball_of_triangles_has_no_hole(void **state) {
    (void)state;
    const uint32_t around = 60;
    model m;
    baked b;
    model_start(&m);
    for (uint32_t i = 0; i < around; i++) {
        for (uint32_t j = 0; j < around / 2; j++) {
            aset_vec3 c[4];
            for (uint32_t k = 0; k < 4; k++) {
                double a = 6.28318530718 * ((i + (k == 1 || k == 2)) % around) / around;
                double e = 3.14159265359 * (j + (k > 1)) / (around / 2);
                c[3 - k] = at(2 * cos(a) * sin(e), 2 * sin(a) * sin(e), 2 * cos(e));
            }
            add_triangle(&m, c[0], c[1], c[2]);
            add_triangle(&m, c[0], c[2], c[3]);
        }
    }
    bake_model(&b, &m, NULL);
    check_ball(&b, 2, 100000, "ball");
    bake_close(&b);
    model_free(&m);
}
#endif
#endif

#if ASET_WITH_CONES
static void test_baker__cones_face_outwards(void **state) {
    (void)state;
    model m;
    baked b;
    random_state r = random_start(seed_of(620));
    aset_bake_options options = options_of(32, 32, 32);
    int missed = 0, wrong = 0;
    options.keep_none = true;
    model_start(&m);
    model_cone(&m, at(0, 0, -3), 1.5, at(0, 0, 3), 1);
    bake_model(&b, &m, &options);
    for (int i = 0; i < 20000; i++) {
        aset_hit hit;
        double a = random_between(&r, 0, 6.28318), z = random_between(&r, -2, 2);
        if (!look(&hit, &b.draft, at(6 * cos(a), 6 * sin(a), z), at(0, 0, z))) {
            missed++;
            continue;
        }
        wrong += (double)(hit.normal.x * hit.point.x + hit.normal.y * hit.point.y) <= 0;
    }
    check(missed * 400 <= 20000 && wrong == 0, "%d missed, %d normals inwards", missed, wrong);
    bake_close(&b);
    model_free(&m);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_baker__order_of_objects_does_not_matter),
        cmocka_unit_test(test_baker__order_of_equal_materials_does_not_matter),
        cmocka_unit_test(test_baker__passes_do_not_matter),
        cmocka_unit_test(test_baker__arena_holds_words_and_stage_only),
        cmocka_unit_test(test_baker__stated_need_is_enough),
        cmocka_unit_test(test_baker__automatic_divisions_follow_memory),
        cmocka_unit_test(test_baker__arguments),
        cmocka_unit_test(test_baker__bad_entities_are_refused_as_a_scene_does),
        cmocka_unit_test(test_baker__a_source_that_changes_does_no_harm),
        cmocka_unit_test(test_baker__a_source_that_fails_leaves_nothing),
        cmocka_unit_test(test_baker__scale_does_not_matter),
        cmocka_unit_test(test_baker__models_of_hardly_any_size),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_baker__a_source_that_changes_is_refused),
        cmocka_unit_test(test_baker__lights_that_change_are_refused),
        cmocka_unit_test(test_baker__nothing_is_written_after_an_end),
        cmocka_unit_test(test_baker__tiny_round_things_are_unseen),
#if ASET_REAL_BITS == 64
        cmocka_unit_test(test_baker__far_from_the_origin_in_double),
        cmocka_unit_test(test_baker__what_floats_cannot_tell),
#endif
#endif
        cmocka_unit_test(test_baker__materials_of_any_size),
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_baker__triangles_are_checked),
        cmocka_unit_test(test_baker__open_polygons_and_late_entities),
        cmocka_unit_test(test_baker__shared_edges_share_columns),
        cmocka_unit_test(test_baker__concave_polygons_cover_what_their_triangles_do),
        cmocka_unit_test(test_baker__a_million_triangles_in_one_voxel),
        cmocka_unit_test(test_baker__too_many_layers_are_refused),
        cmocka_unit_test(test_baker__bent_polygons_in_any_number_of_passes),
        cmocka_unit_test(test_baker__slivers_in_any_number_of_passes),
        cmocka_unit_test(test_baker__textures_of_little_memory),
        cmocka_unit_test(test_baker__bytes_for_the_stage),
        cmocka_unit_test(test_baker__a_polygon_of_many_points),
        cmocka_unit_test(test_baker__triangles_are_polygons),
        cmocka_unit_test(test_baker__noise),
        cmocka_unit_test(test_baker__a_ground_is_kept),
        cmocka_unit_test(test_baker__equal_objects_are_kept_all_or_none),
        cmocka_unit_test(test_baker__flat_models),
#endif
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_baker__a_sphere_has_no_hole),
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_baker__a_ball_of_triangles_has_no_hole),
#endif
#endif
#if ASET_WITH_CONES
        cmocka_unit_test(test_baker__cones_face_outwards),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_support__not_compiled)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
