/*
 * test_memory.c - what is measured is what is taken: exact arenas work, eight bytes less fail cleanly with the bytes that
 * were missing, macros are constant expressions and tell the same, and no arena size crashes anything.
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

static uint64_t sum_of(const unsigned char *bytes, size_t n) {
    uint64_t sum = 1;
    for (size_t i = 0; i < n; i++) {
        sum = (sum ^ bytes[i]) * UINT64_C(1099511628211);
    }
    return sum;
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
            static const size_t rooms[] = {0, 8, 16, 1000, 1029, 1024, 1032, 4096, 100000, 1000000};
            for (size_t k = 0; k < COUNT_OF(rooms); k++) {
                stage s;
                aset_space_size size;
                stage_open_model(&s, &m, rooms[k]);
                aset_arena before = s.arena;
                uint64_t sum = sum_of(s.arena.block, s.arena.used);
                if (k == 0) {
                    assert_int_equal(aset_space_measure(&expected, &s.scene, &aset_mset, &options, NULL), ASET_OK);
                }
                assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, &options, &s.arena), ASET_OK);
                check(same_size(&size, &expected), SEED ", %zu bytes", r.seed, rooms[k]);
                check(same_arena(&s.arena, &before), SEED, r.seed);
                check(sum == sum_of(s.arena.block, s.arena.used), SEED ": it wrote over the scene", r.seed);
                stage_close(&s);
            }
        }
        model_free(&m);
    }
}

/* --- automatic divisions --- */

static void test_memory__automatic_divisions_shrink_to_fit(void **state) {
    (void)state;
    random_state r = random_start(seed_of(300));
    model m;
    stage s;
    aset_space_size largest, smallest;
    aset_space_options one = divided(1, 1, 1);
    model_random(&m, &r, 60, 5, 0.1, 2);
    stage_open_model(&s, &m, 0);
    assert_int_equal(aset_space_measure(&largest, &s.scene, &aset_mset, NULL, NULL), ASET_OK);
    assert_int_equal(aset_space_measure(&smallest, &s.scene, &aset_mset, &one, NULL), ASET_OK);
    stage_close(&s);
    assert_true(largest.divisions[0] > 9);
    uint32_t n_sizes = 0, last = 0;
    for (size_t room = smallest.total; room <= 4 * largest.total; room += room < 3000 ? 8 : room / 8 / 8 * 8) {
        aset_space space;
        stage_open_model(&s, &m, room);
        check(aset_space_build(&space, &s.scene, &aset_mset, NULL, &s.arena) == ASET_OK, "%zu bytes", room);
        n_sizes += space.slices.n[0] != last;
        last = space.slices.n[0];
        stage_close(&s);
    }
    assert_int_equal(last, largest.divisions[0]);
    assert_true(n_sizes >= 5);
    aset_space_size size = smallest;
    assert_int_equal(build_in(&m, NULL, &aset_mset, smallest.total - 8, &size, r.seed), ASET_ERR_NOMEM);
    model_free(&m);
}

static void test_memory__automatic_divisions_leave_the_reserve(void **state) {
    (void)state;
    random_state r = random_start(seed_of(310));
    model m;
    model_random(&m, &r, 60, 5, 0.1, 2);
    for (size_t room = 3000; room <= 60000; room += room / 10 / 8 * 8) {
        for (uint32_t textures = 0; textures <= 64; textures += 64) {
            stage s;
            aset_space space;
            aset_space_options options;
            memset(&options, 0, sizeof options);
            options.reserve = 300;
            options.textures = ASET_WITH_APPROXIMATION ? textures : 0;
            stage_open_model(&s, &m, room);
            aset_status status = aset_space_build(&space, &s.scene, &aset_mset, &options, &s.arena);
            check(status == ASET_OK || (room < 5000 && status == ASET_ERR_NOMEM), "%zu bytes", room);
#if ASET_WITH_APPROXIMATION
            aset_summary summary;
            if (status == ASET_OK && textures > 0) {
                check(aset_summary_build(&summary, &space, textures, &s.arena) == ASET_OK, "%zu bytes", room);
            }
#endif
            if (status == ASET_OK) {
                check(aset_arena_fits(&s.arena, options.reserve), "%zu bytes", room);
            }
            stage_close(&s);
        }
    }
    model_free(&m);
}

/* Where even the coarsest divisions leave too little, that is said; where they are given, the reserve is the caller's affair. */
static void test_memory__a_reserve_that_cannot_be_left(void **state) {
    (void)state;
    const aset_method *const methods[] = {&aset_mset, &aset_set, &aset_grid, &aset_octree, &aset_brute};
    random_state r = random_start(seed_of(311));
    model m;
    model_random(&m, &r, 60, 5, 0.1, 2);
    for (size_t i = 0; i < COUNT_OF(methods); i++) {
        stage s;
        aset_space space;
        aset_space_options options;
        memset(&options, 0, sizeof options);
        stage_open_model(&s, &m, 20000);
        options.reserve = s.arena.size - s.arena.used - 8;
        size_t used = s.arena.used;
        aset_status status = aset_space_build(&space, &s.scene, methods[i], &options, &s.arena);
        check(status == (methods[i] == &aset_brute ? ASET_OK : ASET_ERR_NOMEM), "%s: %d", aset_method_name(methods[i]), (int)status);
        check(status == ASET_OK || (s.arena.missing > 0 && s.arena.used == used), "%s", aset_method_name(methods[i]));
        options.reserve = 0;
        options.textures = ASET_TEXTURES_MAX + 1;
        assert_int_equal(aset_space_build(&space, &s.scene, methods[i], &options, &s.arena), ASET_ERR_ARGUMENT);
        stage_close(&s);
    }
    model_free(&m);
}

/* Given divisions are the caller's: they do not shrink. */
static void test_memory__given_divisions_do_not_shrink(void **state) {
    (void)state;
    random_state r = random_start(seed_of(320));
    model m;
    stage s;
    aset_space_size size;
    aset_space_options options = divided(8, 8, 8);
    model_random(&m, &r, 30, 5, 0.1, 2);
    stage_open_model(&s, &m, 0);
    assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, &options, NULL), ASET_OK);
    stage_close(&s);
    assert_true(size.divisions[0] == 8 && size.divisions[1] == 8 && size.divisions[2] == 8);
    for (size_t room = 0; room < size.total; room += 16) {
        assert_int_equal(build_in(&m, &options, &aset_mset, room, &size, r.seed), ASET_ERR_NOMEM);
    }
    model_free(&m);
}

/* --- the scratch --- */

static void test_memory__scratch_takes_what_its_macro_says(void **state) {
    (void)state;
    static const uint32_t depths[] = {1, 2, 3, 5, 16, ASET_DEPTH_MAX};
    aset_scratch scratch;
    for (size_t i = 0; i < COUNT_OF(depths); i++) {
        size_t need = ASET_BYTES_SCRATCH(depths[i]);
        guarded g = guarded_open(need);
        aset_arena arena;
        assert_int_equal(aset_arena_init(&arena, g.block, need), ASET_OK);
        assert_int_equal(aset_scratch_init(&scratch, depths[i], &arena), ASET_OK);
        assert_int_equal(arena.used, need);
        assert_int_equal(arena.used_by[ASET_CATEGORY_SCRATCH], need);
        assert_int_equal(aset_arena_init(&arena, g.block, need - 8), ASET_OK);
        aset_arena before = arena;
        assert_int_equal(aset_scratch_init(&scratch, depths[i], &arena), ASET_ERR_NOMEM);
        assert_int_equal(arena.missing, 8);
        assert_true(same_arena(&arena, &before));
        guarded_close(&g);
    }
    guarded g = guarded_open(ASET_BYTES_SCRATCH(ASET_DEPTH_DEFAULT));
    aset_arena arena;
    assert_int_equal(aset_arena_init(&arena, g.block, g.size), ASET_OK);
    assert_int_equal(aset_scratch_init(&scratch, ASET_DEPTH_MAX + 1, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_scratch_init(NULL, 1, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_scratch_init(&scratch, 1, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_scratch_init(&scratch, 0, &arena), ASET_OK); /* the default depth */
    assert_int_equal(arena.used, arena.size);
    guarded_close(&g);
}

/* --- constant expressions --- */

#if ASET_WITH_SPHERES
/*
 * Five spheres, each well inside one voxel of its own of a grid of 4 x 4 x 4: six sides each; the grid is one block for each
 * of the six faces. Two materials, so two textures, since no two spheres share a cell.
 */
enum { EXAMPLE_OBJECTS = 5, EXAMPLE_CELLS = 30, EXAMPLE_REFERENCES = 30, EXAMPLE_BLOCKS = 6, EXAMPLE_TEXTURES = 2 };

static void example_model(model *m) {
    static const dvec places[EXAMPLE_OBJECTS] = {{0, 0, 0}, {3, 3, 3}, {1, 2, 0}, {2, 1, 1}, {0, 2, 3}};
    aset_material second = plain_material();
    second.diffuse = R(0.25);
    model_start(m);
    for (int i = 0; i < EXAMPLE_OBJECTS; i++) {
        if (i == 2) {
            model_material(m, &second);
        }
        model_sphere(m, dvec_real(places[i]), 0.375);
    }
    model_light(m, real3(9, 9, 9));
}

#define EXAMPLE_SCENE ASET_BYTES_SCENE(EXAMPLE_OBJECTS, EXAMPLE_OBJECTS * ASET_COORDINATES_SPHERE, 2, 1)
#define EXAMPLE_SPACE ASET_BYTES_MSET(4, 4, 4, EXAMPLE_BLOCKS, EXAMPLE_REFERENCES, EXAMPLE_OBJECTS)
#if ASET_WITH_APPROXIMATION
#define EXAMPLE_SUMMARY ASET_BYTES_SUMMARY(EXAMPLE_CELLS, EXAMPLE_TEXTURES)
#else
#define EXAMPLE_SUMMARY 0
#endif
#define EXAMPLE_SCRATCH ASET_BYTES_SCRATCH(3)

/* As sizes of static arrays: if one of them were no constant expression, this would not compile. */
static ASET_ARENA_BLOCK(example_block, EXAMPLE_SCENE + EXAMPLE_SPACE + EXAMPLE_SUMMARY + EXAMPLE_SCRATCH);
typedef unsigned char one_by_one[ASET_BYTES_SCENE(7, 100, 3, 2)][ASET_BYTES_SCRATCH(1)];
enum { BRUTE_AS_CONSTANT = (int)ASET_BYTES_BRUTE, WIDTH_AS_CONSTANT = (int)ASET_WIDTH(1000u) };

static aset_status build_example(aset_arena *arena, size_t used[4]) {
    model m;
    aset_counter counter;
    aset_scene scene;
    aset_space space;
    aset_scratch scratch;
    aset_space_options options = divided(4, 4, 4);
    example_model(&m);
    aset_sink sink = aset_counter_sink(&counter);
    assert_int_equal(model_emit(&sink, &m), ASET_OK);
    aset_status status = aset_scene_init(&scene, arena, &counter.counts);
    if (status == ASET_OK) {
        sink = aset_scene_sink(&scene);
        status = model_emit(&sink, &m);
        used[0] = arena->used;
        status = status == ASET_OK ? aset_space_build(&space, &scene, &aset_mset, &options, arena) : status;
        used[1] = arena->used;
    }
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
    status = status == ASET_OK ? aset_summary_build(&summary, &space, 16, arena) : status;
#endif
    used[2] = arena->used;
    status = status == ASET_OK ? aset_scratch_init(&scratch, 3, arena) : status;
    used[3] = arena->used;
    model_free(&m);
    return status;
}

static void test_memory__macros_are_exact_constants(void **state) {
    (void)state;
    aset_arena arena;
    size_t used[4];
    assert_int_equal(aset_arena_init(&arena, example_block, sizeof example_block), ASET_OK);
    assert_int_equal(build_example(&arena, used), ASET_OK);
    assert_int_equal(used[0], EXAMPLE_SCENE);
    assert_int_equal(used[1] - used[0], EXAMPLE_SPACE);
    assert_int_equal(used[2] - used[1], EXAMPLE_SUMMARY);
    assert_int_equal(used[3] - used[2], EXAMPLE_SCRATCH);
    assert_int_equal(arena.used, sizeof example_block);
    assert_int_equal(aset_arena_init(&arena, example_block, sizeof example_block - 8), ASET_OK);
    assert_int_equal(build_example(&arena, used), ASET_ERR_NOMEM);
    assert_int_equal(arena.missing, 8);
    assert_int_equal(sizeof(one_by_one), ASET_BYTES_SCENE(7, 100, 3, 2) * ASET_BYTES_SCRATCH(1));
    assert_int_equal(BRUTE_AS_CONSTANT, 0);
    assert_int_equal(WIDTH_AS_CONSTANT, 10);
}

static void test_memory__width_of_numbers(void **state) {
    (void)state;
    assert_int_equal(ASET_WIDTH(0u), 1);
    for (unsigned bits = 1; bits <= 32; bits++) {
        uint32_t smallest = UINT32_C(1) << (bits - 1);
        assert_int_equal(ASET_WIDTH(smallest), bits);
        assert_int_equal(ASET_WIDTH(smallest | (smallest - 1)), bits);
    }
    assert_int_equal(ASET_BYTES_PACKED(0, 7), 0);
    assert_int_equal(ASET_BYTES_PACKED(9, 7), 8);
    assert_int_equal(ASET_BYTES_PACKED(64, 1), 8);
    assert_int_equal(ASET_BYTES_PACKED(10, 7), 16);
    /* numbers are found by their bit, counted in a size_t: where that ends, more than any arena has */
    uint64_t bits = UINT64_C(214748366) * 20;
    assert_true(ASET_BYTES_PACKED(214748366u, 20) == (bits > SIZE_MAX ? UINT64_C(1) << 31 : (bits + 63) / 64 * 8));
    assert_true(ASET_BYTES_PACKED(UINT32_C(1) << 31, 16) >= UINT64_C(1) << 31);
}
#endif

/* --- the sweep --- */

typedef struct whole {
    const model *model;
    aset_space_options options;
    aset_arena arena;
    aset_scene scene;
    aset_space space;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
    aset_scratch scratch;
    int stage; /* the step that failed, 0 to 3; 4: all went well */
} whole;

static aset_status build_whole(whole *w, const aset_counts *limits) {
    w->stage = 0;
    aset_status status = aset_scene_init(&w->scene, &w->arena, limits);
    if (status != ASET_OK) {
        return status;
    }
    aset_sink sink = aset_scene_sink(&w->scene);
    assert_int_equal(model_emit(&sink, w->model), ASET_OK);
    w->stage = 1;
    status = aset_space_build(&w->space, &w->scene, &aset_mset, &w->options, &w->arena);
    if (status != ASET_OK) {
        return status;
    }
    w->stage = 2;
#if ASET_WITH_APPROXIMATION
    status = aset_summary_build(&w->summary, &w->space, 8, &w->arena);
    if (status != ASET_OK) {
        return status;
    }
#endif
    w->stage = 3;
    status = aset_scratch_init(&w->scratch, 2, &w->arena);
    w->stage += status == ASET_OK;
    return status;
}

/* A few pixels of what was built, so that a reader of what was not written is found. */
static void draw_a_little(const whole *w) {
    aset_tracer tracer;
    aset_view view;
    aset_picture picture;
    unsigned char pixels[3 * 8];
    aset_scratch scratch = w->scratch;
    memset(&tracer, 0, sizeof tracer);
    memset(&view, 0, sizeof view);
    memset(&picture, 0, sizeof picture);
    tracer.scene = &w->scene;
    tracer.space = &w->space;
    tracer.depth = 2;
#if ASET_WITH_APPROXIMATION
    tracer.summary = &w->summary;
    tracer.approx_kinds = ASET_ALL_KINDS;
    tracer.approx_depth = 1;
#endif
    view.from = real3(20, 3, 5);
    view.up.z = 1;
    view.angle_deg = 40;
    picture.width = picture.height = 8;
    picture.pixels = pixels;
    assert_int_equal(aset_render_rows(&tracer, &view, &picture, 4, 1, &scratch, NULL), ASET_OK);
}

/* From no byte to more than enough: always a clean status, the guards intact, and a number of missing bytes. */
static void sweep(const model *m, const aset_space_options *options, uint64_t seed) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    assert_int_equal(model_emit(&sink, m), ASET_OK);
    int last = 0;
    bool is_auto = options->divisions[0] == 0;
    for (size_t size = 0; last < 4 || is_auto; size += 8) {
        guarded g = guarded_open(size);
        whole w;
        memset(&w, 0, sizeof w);
        w.model = m;
        w.options = *options;
        assert_int_equal(aset_arena_init(&w.arena, g.block, size), ASET_OK);
        aset_status status = build_whole(&w, &counter.counts);
        check(guarded_intact(&g), SEED ", %zu bytes", seed, size);
        if (status == ASET_OK) {
            check(w.arena.used <= size && w.stage == 4, SEED ", %zu bytes", seed, size);
            check(is_auto || w.arena.used == size, SEED ", %zu bytes", seed, size);
            draw_a_little(&w);
        } else {
            check(status == ASET_ERR_NOMEM, SEED ", %zu bytes: status %d", seed, size, (int)status);
            check(w.arena.missing > 0 && w.arena.missing % 8 == 0 && w.arena.missing < 100000, SEED ", %zu bytes", seed,
                  size);
        }
        check(is_auto || w.stage >= last, SEED ", %zu bytes", seed, size);
        last = w.stage;
        guarded_close(&g);
        if (size > 20000) {
            assert_true(is_auto);
            break;
        }
    }
    assert_int_equal(last, 4);
}

static void test_memory__any_arena_size_ends_cleanly(void **state) {
    (void)state;
    random_state r = random_start(seed_of(400));
    model m;
    aset_space_options options = divided(3, 4, 5);
    model_random(&m, &r, 12, 2, 0.3, 2);
    sweep(&m, &options, r.seed);
    memset(&options, 0, sizeof options);
    options.reserve = ASET_BYTES_SCRATCH(2);
    options.textures = ASET_WITH_APPROXIMATION ? 8 : 0;
    sweep(&m, &options, r.seed);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory__scene_takes_what_its_macro_says),
        cmocka_unit_test(test_memory__space_takes_what_was_measured),
        cmocka_unit_test(test_memory__measure_is_the_same_with_any_arena),
        cmocka_unit_test(test_memory__automatic_divisions_shrink_to_fit),
        cmocka_unit_test(test_memory__automatic_divisions_leave_the_reserve),
        cmocka_unit_test(test_memory__a_reserve_that_cannot_be_left),
        cmocka_unit_test(test_memory__given_divisions_do_not_shrink),
        cmocka_unit_test(test_memory__scratch_takes_what_its_macro_says),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_memory__macros_are_exact_constants),
        cmocka_unit_test(test_memory__width_of_numbers),
#endif
        cmocka_unit_test(test_memory__any_arena_size_ends_cleanly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
