/*
 * test_memory.c - what is measured is what is taken: exact arenas work, eight bytes less fail cleanly with the bytes that were
 * missing, macros are constant expressions and tell the same, and no arena size crashes anything.
 */
#include "support/support.h"

static aset_vec3 real3(double x, double y, double z) {
    return dvec_real(dvec_make(x, y, z));
}

static aset_space_options divided(uint32_t nx, uint32_t ny, uint32_t nz) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    options.divisions[0] = nx;
    options.divisions[1] = ny;
    options.divisions[2] = nz;
    return options;
}

static bool same_arena(const aset_arena *a, const aset_arena *b) {
    return a->block == b->block && a->size == b->size && a->used == b->used && a->peak == b->peak &&
           memcmp(a->used_by, b->used_by, sizeof a->used_by) == 0 && memcmp(a->peak_by, b->peak_by, sizeof a->peak_by) == 0;
}

static bool same_size(const aset_space_size *a, const aset_space_size *b) {
    return a->cells == b->cells && a->references == b->references && a->voxels == b->voxels && a->total == b->total &&
           memcmp(a->divisions, b->divisions, sizeof a->divisions) == 0 && a->n_blocks == b->n_blocks &&
           a->n_cells == b->n_cells && a->n_references == b->n_references;
}

/* --- the scene --- */

static void test_memory__scene_takes_what_its_macro_says(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 20; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        stage s;
        model_random(&m, &r, 1 + random_below(&r, 40), 5, 0.1, 3);
        stage_open_model(&s, &m, 0);
        const aset_counts *c = &s.counter.counts;
        size_t need = ASET_BYTES_SCENE(c->objects, c->coordinates, c->materials, c->lights);
        check(s.arena.used == need && s.arena.peak == need, SEED, r.seed);
        check(s.arena.used_by[ASET_CATEGORY_OBJECTS] + s.arena.used_by[ASET_CATEGORY_VERTICES] +
                      s.arena.used_by[ASET_CATEGORY_MATERIALS] == need, SEED, r.seed);
        check(s.arena.used_by[ASET_CATEGORY_OBJECTS] == ASET_ROUND(c->objects * sizeof(aset_object)), SEED, r.seed);
        guarded g = guarded_open(need - 8);
        aset_arena arena, before;
        aset_scene scene;
        assert_int_equal(aset_arena_init(&arena, g.block, g.size), ASET_OK);
        before = arena;
        check(aset_scene_init(&scene, &arena, c) == ASET_ERR_NOMEM && arena.missing == 8, SEED, r.seed);
        check(same_arena(&arena, &before), SEED, r.seed);
        guarded_close(&g);
        stage_close(&s);
        model_free(&m);
    }
}

/* --- the space --- */

static const uint32_t grids[][3] = {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {5, 5, 5}, {7, 3, 12}, {20, 20, 20}, {64, 1, 2}};

/* Builds in an arena of exactly size bytes after the scene; the status. The arena's state, before and after, is checked. */
static aset_status build_in(const model *m, const aset_space_options *options, const aset_method *method, size_t room,
                            aset_space_size *size, uint64_t seed) {
    stage s;
    aset_space space, untouched;
    memset(&space, 0x5a, sizeof space);
    memset(&untouched, 0x5a, sizeof untouched);
    stage_open_model(&s, m, room);
    aset_arena before = s.arena;
    aset_status status = aset_space_build(&space, &s.scene, method, options, &s.arena);
    if (status == ASET_OK) {
        check(s.arena.used - before.used == size->total, SEED ": %zu bytes, not %zu", seed, s.arena.used - before.used,
              size->total);
        check(s.arena.used_by[ASET_CATEGORY_CELLS] == size->cells, SEED, seed);
        check(s.arena.used_by[ASET_CATEGORY_REFERENCES] == size->references, SEED, seed);
        check(s.arena.used_by[ASET_CATEGORY_VOXELS] == size->voxels, SEED, seed);
        check(space.cells.n_cells == size->n_cells && space.structure.references == size->n_references, SEED, seed);
        check(s.arena.peak == s.arena.used, SEED ": the build took more on its way", seed);
    } else {
        check(status == ASET_ERR_NOMEM && s.arena.missing == size->total - room, SEED ": %zu missing", seed,
              s.arena.missing);
        check(same_arena(&s.arena, &before), SEED, seed);
        check(memcmp(&space, &untouched, sizeof space) == 0, SEED, seed);
    }
    stage_close(&s); /* looks at the guards */
    return status;
}

static void test_memory__space_takes_what_was_measured(void **state) {
    (void)state;
    const aset_method *const methods[2] = {&aset_mset, &aset_brute};
    for (uint64_t i = 0; i < 8; i++) {
        random_state r = random_start(seed_of(100 + i));
        model m;
        model_random(&m, &r, 1 + random_below(&r, 50), 5, 0.05, i % 2 == 0 ? 2 : 8);
        for (size_t g = 0; g < COUNT_OF(grids) * 2; g++) {
            const aset_method *method = methods[g % 2];
            aset_space_options options = divided(grids[g / 2][0], grids[g / 2][1], grids[g / 2][2]);
            aset_space_size size;
            stage s;
            stage_open_model(&s, &m, 0);
            assert_int_equal(aset_space_measure(&size, &s.scene, method, &options, NULL), ASET_OK);
            stage_close(&s);
            check(size.total == size.cells + size.references + size.voxels, SEED, r.seed);
            check(build_in(&m, &options, method, size.total, &size, r.seed) == ASET_OK, SEED, r.seed);
            check(build_in(&m, &options, method, size.total + 4096, &size, r.seed) == ASET_OK, SEED, r.seed);
            if (method == &aset_mset) {
                check(build_in(&m, &options, method, size.total - 8, &size, r.seed) == ASET_ERR_NOMEM, SEED, r.seed);
                check(build_in(&m, &options, method, 0, &size, r.seed) == ASET_ERR_NOMEM, SEED, r.seed);
            } else {
                check(size.total == ASET_BYTES_BRUTE, SEED, r.seed);
            }
        }
        model_free(&m);
    }
}

/* However little the measuring pass may write to, and it may account nothing. */
static void test_memory__measure_is_the_same_with_any_arena(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(200 + i));
        model m;
        model_random(&m, &r, 40, 5, 0.1, 3);
        for (size_t g = 0; g < COUNT_OF(grids); g++) {
            aset_space_options options = divided(grids[g][0], grids[g][1], grids[g][2]);
            aset_space_size expected;
            static const size_t rooms[] = {0, 8, 16, 1000, 1024, 1032, 4096, 100000, 1000000};
            for (size_t k = 0; k < COUNT_OF(rooms); k++) {
                stage s;
                aset_space_size size;
                stage_open_model(&s, &m, rooms[k]);
                aset_arena before = s.arena;
                if (k == 0) {
                    assert_int_equal(aset_space_measure(&expected, &s.scene, &aset_mset, &options, NULL), ASET_OK);
                }
                assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, &options, &s.arena), ASET_OK);
                check(same_size(&size, &expected), SEED ", %zu bytes", r.seed, rooms[k]);
                check(same_arena(&s.arena, &before), SEED, r.seed);
                assert_int_equal(model_emit(&(aset_sink){0}, &(model){0}) == ASET_OK, false);
                stage_close(&s);
            }
        }
        model_free(&m);
    }
}
