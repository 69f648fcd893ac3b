/*
 * test_faults.c - every call that takes an arena, in arenas of every size: at each a clean status, the guards intact, what had
 * been taken given back, and what is missing told. From no byte to the need for small scenes, around every allocation for
 * large ones; all seven methods, and drafts opened. (The baker's sweep is in test_baker.c.)
 */
#include "support/support.h"

#include "aset/procedural.h"

#define DEPTH 3
#define TEXTURES 8

enum { STEP_SCENE, STEP_SPACE, STEP_SUMMARY, STEP_SCRATCH, STEPS };

typedef struct whole {
    aset_arena arena;
    aset_scene scene;
    aset_space space;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
    aset_scratch scratch;
} whole;

typedef struct subject {
    const char *name;
    const aset_method *method;
    aset_space_options options;
    aset_counts limits;
    stage_source source;
    const void *context;
} subject;

static aset_status take_step(whole *w, const subject *s, int step) {
    switch (step) {
    case STEP_SCENE: return aset_scene_init(&w->scene, &w->arena, &s->limits);
    case STEP_SPACE: return aset_space_build(&w->space, &w->scene, s->method, &s->options, &w->arena);
#if ASET_WITH_APPROXIMATION
    case STEP_SUMMARY: return aset_summary_build(&w->summary, &w->space, TEXTURES, &w->arena);
#endif
    case STEP_SCRATCH: return aset_scratch_init(&w->scratch, DEPTH, &w->arena);
    default: return ASET_OK;
    }
}

/* As far as it goes in the arena; the step that failed, or STEPS. A step that fails leaves the arena as it found it. */
static int build_whole(whole *w, const subject *s) {
    for (int step = 0; step < STEPS; step++) {
        const aset_arena before = w->arena;
        aset_status status = take_step(w, s, step);
        if (status != ASET_OK) {
            check(status == ASET_ERR_NOMEM && w->arena.missing > 0 && w->arena.missing % 8 == 0, "%s %s: status %d, %zu missing",
                  aset_method_name(s->method), s->name, (int)status, w->arena.missing);
            check(w->arena.used == before.used && w->arena.peak == before.peak &&
                      memcmp(w->arena.used_by, before.used_by, sizeof before.used_by) == 0,
                  "%s %s: step %d of %zu bytes", aset_method_name(s->method), s->name, step, w->arena.size);
            return step;
        }
        if (step == STEP_SCENE) {
            aset_sink sink = aset_scene_sink(&w->scene);
            assert_int_equal(s->source(&sink, s->context), ASET_OK);
        }
    }
    return STEPS;
}

/* In an arena of this size between guards. *missing: of the step that failed. */
static int build_in(const subject *s, size_t size, size_t *missing) {
    guarded g = guarded_open(size);
    whole w;
    assert_int_equal(aset_arena_init(&w.arena, g.block, size), ASET_OK);
    int step = build_whole(&w, s);
    check(guarded_intact(&g), "%s %s in %zu bytes", aset_method_name(s->method), s->name, size);
    *missing = w.arena.missing;
    guarded_close(&g);
    return step;
}

/* One size; then with what was missing. Methods that need memory to count tell it in two steps. */
static int try_size(const subject *s, size_t size, bool again) {
    size_t missing;
    int step = build_in(s, size, &missing), then = step;
    for (int tries = 0; again && then == step && step < STEPS; tries++) {
        check(tries < 3, "%s %s in %zu bytes: %zu more are not enough", aset_method_name(s->method), s->name, size, missing);
        size += missing;
        then = build_in(s, size, &missing);
    }
    return step;
}

static void subject_open(subject *s, const char *name, const aset_method *method, stage_source source, const void *context) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    memset(s, 0, sizeof *s);
    assert_int_equal(source(&sink, context), ASET_OK);
    s->name = name;
    s->method = method;
    s->source = source;
    s->context = context;
    s->limits = counter.counts;
    for (int a = 0; a < 3; a++) {
        s->options.divisions[a] = (uint32_t)(3 + a);
    }
    s->options.depth = 2;
}

static const aset_method *const methods[] = {&aset_brute, &aset_set, &aset_mset, &aset_grid, &aset_octree, &aset_arts, &aset_excell};

static void test_faults__every_size_of_small_scenes(void **state) {
    (void)state;
    random_state r = random_start(seed_of(1));
    model m;
    model_random(&m, &r, 9, 2, 0.3, 2);
    for (size_t i = 0; i < COUNT_OF(methods); i++) {
        subject s;
        int step = 0, last = 0;
        subject_open(&s, "random", methods[i], model_emit, &m);
        for (size_t size = 0; step < STEPS; size += 8) {
            step = try_size(&s, size, size % 64 == 0);
            check(step >= last, "%s in %zu bytes gets less far than in fewer", aset_method_name(methods[i]), size);
            check(size < 1000000, "%s", aset_method_name(methods[i]));
            last = step;
        }
    }
    model_free(&m);
}

/* --- large scenes, around every allocation --- */

static aset_status emit_procedural(const aset_sink *sink, const void *context) {
    return aset_procedural_find(context)->emit(sink, 4);
}

/* Where what was built begins in the arena, apart from the block itself; those that a method has not are NULL. */
static size_t starts_of(const whole *w, const void *starts[32]) {
    const void *all[] = {
        w->scene.objects,      w->scene.coordinates, w->scene.materials,          w->scene.lights,
        w->space.cells.map,    w->space.cells.marks, w->space.cells.map_rank,     w->space.cells.first,
        w->space.large,        w->space.boxes,       w->space.references.first,   w->space.references.starts,
        w->space.nodes,        w->space.directory,   w->space.references.objects, w->space.bucket_depth,
        w->space.slices.planes[0], w->space.slices.planes[1], w->space.slices.planes[2],
#if ASET_WITH_APPROXIMATION
        w->summary.textures,   w->summary.of_cell,
#endif
        w->scratch.stack};
    memcpy(starts, all, sizeof all);
    return COUNT_OF(all);
}

static void test_faults__every_allocation_of_large_scenes(void **state) {
    (void)state;
    static const char *const names[] = {"balls", "tetra", "rings"};
    const size_t room = (size_t)16 << 20;
    for (size_t k = 0; k < COUNT_OF(names) * COUNT_OF(methods); k++) {
        const char *name = names[k / COUNT_OF(methods)];
        aset_counter counter;
        aset_sink sink = aset_counter_sink(&counter);
        subject s;
        whole w;
        const void *starts[32];
        if (emit_procedural(&sink, name) == ASET_ERR_UNSUPPORTED) {
            continue;
        }
        memset(&w, 0, sizeof w);
        subject_open(&s, name, methods[k % COUNT_OF(methods)], emit_procedural, name);
        guarded g = guarded_open(room);
        assert_int_equal(aset_arena_init(&w.arena, g.block, room), ASET_OK);
        assert_int_equal(build_whole(&w, &s), STEPS);
        size_t n = starts_of(&w, starts), tried = 0;
        size_t ends[] = {w.arena.used, w.arena.peak};
        for (size_t i = 0; i < n + COUNT_OF(ends); i++) {
            uintptr_t from = (uintptr_t)g.block;
            size_t at = i >= n ? ends[i - n] : (uintptr_t)starts[i] - from;
            if (i >= n || ((uintptr_t)starts[i] >= from && at <= room)) {
                (void)try_size(&s, at / 8 * 8, true);
                (void)try_size(&s, at / 8 * 8 + 8, true);
                (void)try_size(&s, at < 8 ? 0 : at / 8 * 8 - 8, true);
                tried++;
            }
        }
        assert_true(tried >= 6);
        guarded_close(&g);
    }
}

/* --- drafts opened --- */

#if ASET_WITH_DRAFTS
/* The words, to be freed, of a bake that keeps an object. */
static uint32_t *bake_words(const model *m, size_t *n) {
    const size_t room = (size_t)1 << 20;
    guarded g = guarded_open(room);
    aset_arena arena;
    aset_draft draft;
    aset_baker *baker = malloc(sizeof *baker);
    aset_bake_options options;
    bool again = true;
    memset(&options, 0, sizeof options);
    options.divisions[0] = options.divisions[1] = options.divisions[2] = 6;
    assert_non_null(baker);
    assert_int_equal(aset_arena_init(&arena, g.block, room), ASET_OK);
    assert_int_equal(aset_baker_init(baker, &arena, &options), ASET_OK);
    while (again) {
        aset_sink sink = aset_baker_sink(baker);
        assert_int_equal(model_emit(&sink, m), ASET_OK);
        assert_int_equal(aset_baker_pass(baker, &again), ASET_OK);
    }
    assert_int_equal(aset_baker_finish(&draft, baker), ASET_OK);
    assert_true(draft.stage.counts.objects > 0);
    *n = draft.n_words;
    uint32_t *words = malloc(draft.n_words * sizeof *words);
    assert_non_null(words);
    memcpy(words, draft.words, draft.n_words * sizeof *words);
    free(baker);
    guarded_close(&g);
    return words;
}

static void test_faults__every_size_for_an_opened_draft(void **state) {
    (void)state;
    random_state r = random_start(seed_of(20));
    model m;
    size_t n;
    aset_status status = ASET_ERR_NOMEM;
    model_random(&m, &r, 20, 4, 0.2, 1);
    model_random_thing(&m, &r, 1, 60);
    model_light(&m, dvec_real(dvec_make(9, 9, 9)));
    uint32_t *words = bake_words(&m, &n);
    for (size_t size = 0; status != ASET_OK; size += 8) {
        aset_arena arena;
        aset_draft draft, untouched;
        guarded g = guarded_open(size);
        memset(&draft, 0x5a, sizeof draft);
        memset(&untouched, 0x5a, sizeof untouched);
        assert_int_equal(aset_arena_init(&arena, g.block, size), ASET_OK);
        status = aset_draft_open(&draft, words, n, &arena, NULL);
        if (status == ASET_OK) {
            assert_int_equal(arena.used, size);
        } else {
            check(status == ASET_ERR_NOMEM && arena.used == 0 && arena.missing > 0, "%zu bytes: %d", size, (int)status);
            check(memcmp(&draft, &untouched, sizeof draft) == 0, "%zu bytes: the draft was written to", size);
            check(size + arena.missing < 100000, "%zu bytes: %zu missing", size, arena.missing);
        }
        guarded_close(&g);
    }
    free(words);
    model_free(&m);
}
#else
#define test_faults__every_size_for_an_opened_draft test_support__not_compiled
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faults__every_size_of_small_scenes),
        cmocka_unit_test(test_faults__every_allocation_of_large_scenes),
        cmocka_unit_test(test_faults__every_size_for_an_opened_draft),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
