/*
 * test_flat.c - cells and textures from a stream: word for word those of a whole scene, whatever the order of the objects
 * and however many passes memory allows; needs to the byte; what is refused.
 */
#include "support/rays.h"

#if ASET_WITH_APPROXIMATION && ASET_WITH_SPHERES

#include "approx/texture.h"
#include "scene/entity.h"
#include "aset/procedural.h"

#define ROOM ((size_t)8 << 20)

/* --- sources --- */

typedef struct source {
    stage_source emit;
    const void *context;
} source;

static source source_of_model(const model *m) {
    source s = {model_emit, m};
    return s;
}

/* Spheres in a row, each with a material of its own, some shared by neighbours that touch. */
typedef struct necklace {
    uint32_t n_spheres, n_materials;
    bool backwards;
} necklace;

static aset_status emit_necklace(const aset_sink *sink, const void *context) {
    const necklace *n = context;
    aset_status status = ASET_OK;
    for (uint32_t i = 0; i < n->n_spheres && status == ASET_OK; i++) {
        uint32_t k = n->backwards ? n->n_spheres - 1 - i : i, m = k * 7919u % n->n_materials;
        aset_material material = plain_material();
        material.fill.r = (aset_real)m / (aset_real)n->n_materials;
        material.specular = (aset_real)(m % 13) / 13;
        material.shine = (aset_real)(m % 50);
        aset_vec3 centre = real3(0.3 * (k % 40), 0.9 * (k / 40 % 40), 0.4 * (k / 1600) + 0.01 * k);
        status = sink->material(sink->context, &material);
        status = status == ASET_OK ? sink->sphere(sink->context, &centre, R(0.35)) : status;
    }
    return status;
}

/* --- making --- */

typedef struct made {
    guarded memory;
    aset_arena arena;
    aset_scene stage;
    aset_space space;
    aset_summary summary;
    uint32_t passes;
    size_t least;
} made;

static aset_counter count(const source *from) {
    aset_counter counter;
    aset_sink sink = aset_counter_sink(&counter);
    assert_int_equal(from->emit(&sink, from->context), ASET_OK);
    return counter;
}

static aset_space_options divisions_of(uint32_t nx, uint32_t ny, uint32_t nz) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    options.divisions[0] = nx;
    options.divisions[1] = ny;
    options.divisions[2] = nz;
    return options;
}

/* In a block of size bytes. It stays open after an error too. */
static aset_status make(made *m, const source *from, const aset_method *method, const aset_space_options *options,
                        size_t size) {
    aset_flat flat;
    aset_counter counter = count(from);
    bool again = true;
    m->memory = guarded_open(size);
    memset(m->memory.block, 0x5a, size);
    assert_int_equal(aset_arena_init(&m->arena, m->memory.block, size), ASET_OK);
    aset_status status = aset_flat_init(&flat, &m->arena, &counter, method, options);
    while (status == ASET_OK && again) {
        aset_sink sink = aset_flat_sink(&flat);
        status = from->emit(&sink, from->context);
        status = status == ASET_OK ? aset_flat_pass(&flat, &again) : status;
    }
    m->passes = flat.passes;
    m->least = flat.least;
    status = status == ASET_OK ? aset_flat_finish(&m->stage, &m->space, &m->summary, &flat) : status;
    if (status != ASET_OK) {
        assert_int_equal(m->arena.used, 0);
    }
    return status;
}

static void unmake(made *m) {
    guarded_close(&m->memory);
}

/* The least bytes with which it can be made: what is told as missing, until nothing is. */
static size_t need_of(const source *from, const aset_method *method, const aset_space_options *options) {
    size_t size = 0;
    aset_status status = ASET_ERR_NOMEM;
    for (int tries = 0; status == ASET_ERR_NOMEM; tries++) {
        made m;
        status = make(&m, from, method, options, size);
        size += status == ASET_ERR_NOMEM ? m.arena.missing : 0;
        assert_true(tries < 8);
        unmake(&m);
    }
    assert_int_equal(status, ASET_OK);
    return size;
}

/* --- comparing --- */

static void compare_words(const char *what, const void *a, const void *b, size_t size) {
    check(size == 0 || memcmp(a, b, size) == 0, "%s differ", what);
}

static void compare_cells(const aset_space *a, const aset_space *b) {
    const aset_cells *c = &a->cells, *d = &b->cells;
    for (int k = 0; k < 3; k++) {
        assert_int_equal(a->slices.n[k], b->slices.n[k]);
        assert_true(a->slices.low[k] == b->slices.low[k] && a->slices.width[k] == b->slices.width[k]);
        assert_true(a->slices.first[k] == b->slices.first[k] && a->slices.last[k] == b->slices.last[k]);
        assert_true(a->slices.per_width[k] == b->slices.per_width[k]);
    }
    assert_int_equal(c->n_blocks, d->n_blocks);
    assert_int_equal(c->n_cells, d->n_cells);
    size_t words = (size_t)ASET_BLOCK_WORDS(a->slices.n[0], a->slices.n[1], a->slices.n[2], c->faces);
    compare_words("maps", c->map, d->map, 12 * words);
    compare_words("marks", c->marks, d->marks, 12 * (size_t)c->n_blocks);
    assert_memory_equal(&a->structure, &b->structure, sizeof a->structure);
}

static void compare_summaries(const aset_summary *a, const aset_summary *b) {
    assert_int_equal(a->n_textures, b->n_textures);
    assert_int_equal(a->capacity, b->capacity);
    assert_int_equal(a->merged, b->merged);
    assert_int_equal(a->width, b->width);
    for (uint32_t i = 0; i < a->n_textures; i++) {
        assert_true(entity_same_look(a->textures + i, b->textures + i));
    }
    compare_words("numbers", a->of_cell, b->of_cell, (size_t)ASET_BYTES_PACKED(a->space->cells.n_cells, a->width));
}

/* All of a hit but where its texture stands. */
static bool same_cell_hit(const aset_hit *a, const aset_hit *b) {
    aset_hit c = *b;
    c.material = a->material;
    return same_hit(a, &c) && a->cell == b->cell && entity_same_look(a->material, b->material);
}

/* Some rays of every sort. */
static void compare_rays(const aset_tracer *a, const aset_tracer *b, uint64_t seed) {
    random_state r = random_start(seed);
    aset_statistics in_a, in_b;
    memset(&in_a, 0, sizeof in_a);
    memset(&in_b, 0, sizeof in_b);
    for (int i = 0; i < 300; i++) {
        bool found_a, found_b;
        aset_hit hit_a, hit_b;
        aset_ray ray = random_ray_common(&r, a->space, (ray_sort)(i % RAY_SORTS), false);
        assert_int_equal(aset_closest_hit(&found_a, &hit_a, a, &ray, true, &in_a), ASET_OK);
        assert_int_equal(aset_closest_hit(&found_b, &hit_b, b, &ray, true, &in_b), ASET_OK);
        check(found_a == found_b && (!found_a || same_cell_hit(&hit_a, &hit_b)), SEED ", ray %d", seed,
              i);
    }
    assert_memory_equal(&in_a, &in_b, sizeof in_a);
}

/* A picture, with all that follows from a hit. */
static void compare_pictures(const aset_tracer *a, const aset_tracer *b, aset_arena *arena) {
    enum { SIDE = 24 };
    static uint8_t pixels[2][SIDE * SIDE * 3];
    aset_statistics in[2];
    aset_scratch scratch;
    aset_mark mark = aset_arena_mark(arena);
    aset_view view = a->scene->view;
    aset_picture picture = {.width = SIDE, .height = SIDE, .format = ASET_RGB888, .stride = SIDE * 3};
    memset(in, 0, sizeof in);
    assert_memory_equal(&a->scene->view, &b->scene->view, sizeof view);
    assert_int_equal(aset_scratch_init(&scratch, 0, arena), ASET_OK);
    for (int i = 0; i < 2; i++) {
        picture.pixels = pixels[i];
        assert_int_equal(aset_render_rows(i == 0 ? a : b, &view, &picture, 0, SIDE, &scratch, &in[i]), ASET_OK);
    }
    assert_memory_equal(pixels[0], pixels[1], sizeof pixels[0]);
    assert_memory_equal(&in[0], &in[1], sizeof in[0]);
    aset_arena_release(arena, &mark);
}

/* A whole scene's space and summary in the stage's arena, and what was made beside it. */
static void compare(stage *s, const made *m, const aset_method *method, const aset_space_options *options, uint64_t seed) {
    aset_space space;
    aset_summary summary;
    aset_mark mark = aset_arena_mark(&s->arena);
    assert_int_equal(aset_space_build(&space, &s->scene, method, options, &s->arena), ASET_OK);
    assert_int_equal(aset_summary_build(&summary, &space, options->textures, &s->arena), ASET_OK);
    compare_cells(&space, &m->space);
    compare_summaries(&summary, &m->summary);
    assert_true(s->scene.margin == m->stage.margin);
    assert_int_equal(m->stage.counts.objects, 0);
    assert_int_equal(m->arena.used_by[ASET_CATEGORY_OBJECTS] + m->arena.used_by[ASET_CATEGORY_VERTICES], 0);
    assert_int_equal(m->arena.used_by[ASET_CATEGORY_REFERENCES] + m->arena.used_by[ASET_CATEGORY_SCRATCH], 0);
    aset_tracer whole = stage_tracer(s, &space), flat;
    whole.summary = &summary;
    whole.approx_kinds = ASET_ALL_KINDS;
    whole.curtail = R(0.5);
    flat = whole;
    flat.scene = &m->stage;
    flat.space = &m->space;
    flat.summary = &m->summary;
    compare_rays(&whole, &flat, seed);
    if (s->scene.has_view) {
        compare_pictures(&whole, &flat, &s->arena);
    }
    aset_arena_release(&s->arena, &mark);
}

static const aset_method *const methods[2] = {&aset_mset, &aset_grid};
static const uint32_t grids[][3] = {{1, 1, 1}, {2, 3, 4}, {13, 40, 5}, {24, 24, 24}};

/* --- equality --- */

typedef struct procedural_size {
    const aset_procedural *procedural;
    uint32_t size;
} procedural_size;

static aset_status emit_procedural(const aset_sink *sink, const void *context) {
    const procedural_size *p = context;
    return p->procedural->emit(sink, p->size);
}

static void test_flat__is_the_whole_scene_s(void **state) {
    (void)state;
    for (size_t i = 0; i < SMALL_SCENES; i++) {
        stage s;
        procedural_size p = {aset_procedural_find(small_scenes[i].name), small_scenes[i].size};
        source from = {emit_procedural, &p};
        if (!stage_open_procedural(&s, small_scenes[i].name, small_scenes[i].size, ROOM)) {
            continue;
        }
        for (size_t k = 0; k < 2 * COUNT_OF(grids); k++) {
            const uint32_t *n = grids[k / 2];
            aset_space_options options = divisions_of(n[0], n[1], n[2]);
            made m;
            assert_int_equal(make(&m, &from, methods[k % 2], &options, ROOM), ASET_OK);
            compare(&s, &m, methods[k % 2], &options, k);
            unmake(&m);
        }
        stage_close(&s);
    }
}

/* Kinds, sizes and materials at random, some far away, and each model from its other end. */
static void test_flat__order_of_objects_does_not_matter(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 24; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        stage s;
        made forwards, backwards;
        const aset_method *method = methods[i % 2];
        const uint32_t *n = grids[i / 2 % COUNT_OF(grids)];
        aset_space_options options = divisions_of(n[0], n[1], n[2]);
        options.textures = i % 3 == 0 ? 3 : 0;
        model_random(&m, &r, 60, 5, 0.2, 6);
        model_light(&m, real3(9, -4, 30));
        if (i % 4 == 3) {
            model_move(&m, far_places + i % FAR_PLACES);
        }
        source from = source_of_model(&m);
        stage_open_model(&s, &m, ROOM);
        assert_int_equal(make(&forwards, &from, method, &options, ROOM), ASET_OK);
        m.backwards = true;
        assert_int_equal(make(&backwards, &from, method, &options, ROOM), ASET_OK);
        compare(&s, &forwards, method, &options, r.seed);
        compare(&s, &backwards, method, &options, r.seed);
        assert_int_equal(forwards.stage.counts.lights, s.scene.counts.lights);
        unmake(&forwards);
        unmake(&backwards);
        stage_close(&s);
        model_free(&m);
    }
}

/* The least and the largest that a scene keeps as they are (scene.c), and what has lost all but seven bits to underflow. */
#if ASET_REAL_BITS == 32
#define EDGE_LOW R(0x1p-24)
#define EDGE_HIGH R(0x1p48)
#define DENORMAL R(1e-43)
#else
#define EDGE_LOW R(0x1p-192)
#define EDGE_HIGH R(0x1p384)
#define DENORMAL R(1e-321)
#endif

typedef struct odd_sizes {
    aset_real unit;    /* of a few things near the origin */
    aset_real refused; /* of a polygon that is given up after two points; 0: there is none */
    bool at_first;
    aset_real wider;
} odd_sizes;

static void give_up(const aset_sink *sink, aset_real size) {
    aset_vec3 a = {size, 0, -size}, b = {0, size / 2, size};
    assert_int_equal(sink->polygon_begin(sink->context, 4, false), ASET_OK);
    assert_int_equal(sink->polygon_point(sink->context, &a, NULL), ASET_OK);
    assert_int_equal(sink->polygon_point(sink->context, &b, NULL), ASET_OK);
    assert_int_equal(sink->polygon_end(sink->context), ASET_ERR_GEOMETRY);
}

static aset_status emit_odd_sizes(const aset_sink *sink, const void *context) {
    const odd_sizes *o = context;
    aset_real u = o->unit;
    const aset_material material = plain_material();
    aset_status status = sink->material(sink->context, &material);
#if ASET_WITH_POLYGONS
    aset_vec3 corners[4] = {{0, 0, u}, {u, 0, u}, {u, u, u / 2}, {0, u, 0}};
    if (o->refused > 0 && o->at_first) {
        give_up(sink, o->refused);
    }
    status = status == ASET_OK ? aset_sink_polygon(sink, corners, NULL, 4) : status;
    if (o->refused > 0 && !o->at_first) {
        give_up(sink, o->refused);
    }
    corners[2].z = -u;
    status = status == ASET_OK ? aset_sink_polygon(sink, corners, NULL, 3) : status;
#endif
    aset_vec3 centre = {u * R(0.75), -u / 3, u / 8};
    status = status == ASET_OK ? sink->sphere(sink->context, &centre, u / 2) : status;
#if ASET_WITH_CONES
    for (int i = 0; i < 24; i++) { /* the outermost, where bounds are least exact */
        aset_real x = u * R(0.04) * (aset_real)(i % 5), y = u * R(0.03) * (aset_real)(i % 7), z = u * R(0.02) * (aset_real)(i % 11);
        aset_vec3 base = {u / 3, y, -z}, apex = {-x, u / 11, u * R(0.6)};
        status = status == ASET_OK ? sink->cone(sink->context, &base, u + y, &apex, u + x + z + o->wider * u) : status;
    }
#endif
    return status;
}

/*
 * The scale of a whole scene and of a stream is decided by the same box: not by what was refused, nor by centres without their radii,
 * and it holds all that is in it where the caller's numbers are denormal.
 */
static void test_flat__sizes_at_the_ends_of_the_numbers(void **state) {
    (void)state;
    static const aset_real refused[] = {0, 1, R(0x1p80)};
    static const aset_real units[] = {1,           EDGE_LOW,           EDGE_LOW * R(0.9),    EDGE_LOW * R(1e-6),
                                      EDGE_HIGH,   EDGE_HIGH * R(0.9), DENORMAL,             DENORMAL * R(1.1),
                                      DENORMAL * 3, DENORMAL * 100,    DENORMAL * R(1.0e6)};
    for (size_t i = 0; i < COUNT_OF(units) * 6; i++) {
        size_t how = i / COUNT_OF(units);
        odd_sizes o = {units[i % COUNT_OF(units)], refused[how % 3], how >= 3, R(0.1) * (aset_real)(i % 7)};
        source from = {emit_odd_sizes, &o};
        const aset_method *method = methods[i % 2];
        aset_space_options options = divisions_of(19, 29, 36);
        stage s;
        made m;
        stage_open(&s, emit_odd_sizes, &o, ROOM);
        assert_int_equal(make(&m, &from, method, &options, ROOM), ASET_OK);
        assert_true(s.scene.scale == m.stage.scale);
        assert_memory_equal(&s.scene.low, &m.stage.low, sizeof s.scene.low);
        assert_memory_equal(&s.scene.high, &m.stage.high, sizeof s.scene.high);
        for (uint32_t k = 0; k < s.scene.counts.objects; k++) {
            aset_vec3 low, high;
            aset_object_own_bounds(&s.scene, k, &low, &high);
            assert_true(vec_largest(vec_sub(vec_min(low, s.scene.low), s.scene.low)) <= s.scene.margin);
            assert_true(vec_largest(vec_sub(vec_max(high, s.scene.high), s.scene.high)) <= s.scene.margin);
        }
        compare(&s, &m, method, &options, i);
        unmake(&m);
        stage_close(&s);
    }
}

/* More materials than cells are told apart by, in lists that are long enough and too short. */
static void test_flat__a_thousand_materials(void **state) {
    (void)state;
    static const uint32_t capacities[] = {0, 2, 100, ASET_TEXTURES_MAX};
    necklace beads = {2500, 1000, false};
    source from = {emit_necklace, &beads};
    stage s;
    stage_open(&s, emit_necklace, &beads, ROOM);
    for (size_t i = 0; i < 2 * COUNT_OF(capacities); i++) {
        made m;
        aset_space_options options = divisions_of(30, 30, 30);
        options.textures = capacities[i / 2];
        for (int order = 0; order < 2; order++) {
            beads.backwards = order == 1;
            assert_int_equal(make(&m, &from, methods[i % 2], &options, ROOM), ASET_OK);
            assert_true(options.textures == 0 || options.textures > 100 || m.summary.merged > 0);
            beads.backwards = false;
            compare(&s, &m, methods[i % 2], &options, i);
            unmake(&m);
        }
    }
    stage_close(&s);
}

/* Two passes where all look alike, three where no cell has objects of two materials, else four. */
static void test_flat__passes(void **state) {
    (void)state;
    static const uint32_t expected[3] = {2, 3, 4};
    for (int i = 0; i < 3; i++) {
        model m;
        made done;
        aset_material red = plain_material();
        aset_space_options options = divisions_of(8, 8, 8);
        model_start(&m);
        model_sphere(&m, real3(0, 0, 0), 1);
        red.fill.g = 0;
        (void)model_material(&m, &red);
        if (i > 0) {
            model_sphere(&m, real3(i == 1 ? 9 : 1, 0, 0), 1);
        }
        source from = source_of_model(&m);
        assert_int_equal(make(&done, &from, &aset_grid, &options, ROOM), ASET_OK);
        assert_int_equal(done.passes, expected[i]);
        unmake(&done);
        model_free(&m);
    }
}

/* --- memory --- */

/* From the need up, with more and more passes towards it, always the same; one byte less says so. */
static void check_budgets(const source *from, stage *s, const aset_method *method, const aset_space_options *options,
                          bool many_passes) {
    size_t need = need_of(from, method, options), sizes[4];
    uint32_t most = 0;
    made m;
    assert_int_equal(make(&m, from, method, options, need - 1), ASET_ERR_NOMEM);
    assert_int_equal(m.arena.missing, 1);
    unmake(&m);
    for (size_t i = 0; i < COUNT_OF(sizes); i++) {
        sizes[i] = need + (i * i * i * 1500 + 7) * (i > 0);
        assert_int_equal(make(&m, from, method, options, sizes[i]), ASET_OK);
        most = m.passes > most ? m.passes : most;
        assert_true(m.passes <= 11);
        assert_int_equal(m.least, need);
        if (i == 0) {
            assert_int_equal(m.arena.peak, need);
        }
        compare(s, &m, method, options, i);
        unmake(&m);
    }
    assert_true(most > 4 || !many_passes);
}

static void test_flat__in_the_least_bytes(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        stage s;
        const uint32_t *n = grids[1 + i / 2];
        aset_space_options options = divisions_of(n[0], n[1], n[2]);
        model_random(&m, &r, 40, 5, 0.2, 4);
        source from = source_of_model(&m);
        stage_open_model(&s, &m, ROOM);
        check_budgets(&from, &s, methods[i % 2], &options, false);
        stage_close(&s);
        model_free(&m);
    }
    necklace beads = {2500, 1000, false};
    source from = {emit_necklace, &beads};
    aset_space_options options = divisions_of(30, 30, 30);
    stage s;
    stage_open(&s, emit_necklace, &beads, ROOM);
    check_budgets(&from, &s, &aset_mset, &options, true);
    check_budgets(&from, &s, &aset_grid, &options, true);
    stage_close(&s);
}

/* Bytes that are to stay free do. */
static void test_flat__leaves_the_reserve(void **state) {
    (void)state;
    necklace beads = {400, 30, false};
    source from = {emit_necklace, &beads};
    aset_space_options options = divisions_of(12, 12, 12);
    size_t need = need_of(&from, &aset_mset, &options);
    options.reserve = 1000;
    assert_int_equal(need_of(&from, &aset_mset, &options), need + 1000);
    made m;
    assert_int_equal(make(&m, &from, &aset_mset, &options, need + 1500), ASET_OK);
    assert_true(m.arena.peak <= need + 500);
    unmake(&m);
}

/* As many divisions as a whole scene's where there is room; fewer and fewer where there is not, until the need is told. */
static void test_flat__automatic_divisions(void **state) {
    (void)state;
    necklace beads = {900, 40, false};
    source from = {emit_necklace, &beads};
    stage s;
    uint32_t n[3], last = UINT32_MAX;
    size_t size = ROOM;
    made m;
    stage_open(&s, emit_necklace, &beads, ROOM);
    aset_auto_divisions(&s.scene, 0, n);
    for (aset_status status = ASET_OK; status == ASET_OK; size = size * 2 / 3) {
        status = make(&m, &from, &aset_mset, NULL, size);
        if (status == ASET_OK) {
            aset_space_options same = divisions_of(m.space.slices.n[0], m.space.slices.n[1], m.space.slices.n[2]);
            assert_true(size < ROOM || memcmp(same.divisions, n, sizeof n) == 0);
            assert_true(same.divisions[0] <= last);
            last = same.divisions[0];
            compare(&s, &m, &aset_mset, &same, size);
            assert_int_equal(m.least, need_of(&from, &aset_mset, &same));
        } else {
            assert_int_equal(status, ASET_ERR_NOMEM);
            assert_true(m.arena.missing > 0 && last <= 2);
        }
        unmake(&m);
    }
    stage_close(&s);
}

/* --- what is refused, and what is empty --- */

static aset_status emit_nothing(const aset_sink *sink, const void *context) {
    const aset_colour *colour = context;
    return sink->background(sink->context, colour);
}

static void test_flat__of_no_objects(void **state) {
    (void)state;
    const aset_colour blue = {0, 0, 1};
    source from = {emit_nothing, &blue};
    aset_space_options options = divisions_of(4, 4, 4);
    stage s;
    made m;
    stage_open(&s, emit_nothing, &blue, 4096);
    assert_int_equal(make(&m, &from, &aset_mset, &options, 4096), ASET_OK);
    compare(&s, &m, &aset_mset, &options, 1);
    assert_true(m.stage.background.b == 1);
    unmake(&m);
    stage_close(&s);
}

static void test_flat__answers_approximate_rays_alone(void **state) {
    (void)state;
    necklace beads = {20, 5, false};
    source from = {emit_necklace, &beads};
    aset_space_options options = divisions_of(4, 4, 4);
    made m;
    bool found;
    aset_hit hit;
    aset_colour colour;
    aset_scratch scratch;
    aset_summary again;
    assert_int_equal(make(&m, &from, &aset_mset, &options, ROOM), ASET_OK);
    assert_int_equal(aset_scratch_init(&scratch, 0, &m.arena), ASET_OK);
    aset_tracer tracer;
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &m.stage;
    tracer.space = &m.space;
    tracer.summary = &m.summary;
    tracer.approx_kinds = ASET_ALL_KINDS;
    const aset_ray ray = {{-5, 0, 0}, {1, 0, 0}, REAL_INFINITY};
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), ASET_OK);
    assert_true(found);
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_any_hit(&found, &tracer, &ray, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_ray_colour(&colour, &tracer, &ray, &scratch, NULL), ASET_OK);
    tracer.approx_depth = 1;
    assert_int_equal(aset_ray_colour(&colour, &tracer, &ray, &scratch, NULL), ASET_ERR_ARGUMENT);
    tracer.approx_depth = 0;
    tracer.approx_kinds = ASET_PRIMARY;
    assert_int_equal(aset_ray_colour(&colour, &tracer, &ray, &scratch, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_build(&again, &m.space, 0, &m.arena), ASET_ERR_ARGUMENT);
    unmake(&m);
}

static void test_flat__refuses_bad_arguments(void **state) {
    (void)state;
    static ASET_ARENA_BLOCK(block, 65536);
    necklace beads = {5, 2, false};
    source from = {emit_necklace, &beads};
    aset_arena arena;
    aset_flat flat;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_counter counter = count(&from);
    aset_space_options options = divisions_of(4, 4, 4), none = divisions_of(0, 4, 4), many = divisions_of(4, 2049, 4);
    bool again;
    assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
    assert_int_equal(aset_flat_init(NULL, &arena, &counter, &aset_mset, &options), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_init(&flat, NULL, &counter, &aset_mset, &options), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_init(&flat, &arena, NULL, &aset_mset, &options), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_init(&flat, &arena, &counter, NULL, &options), ASET_ERR_ARGUMENT);
    const aset_method *const others[] = {&aset_set, &aset_octree, &aset_arts, &aset_excell, &aset_brute};
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        assert_int_equal(aset_flat_init(&flat, &arena, &counter, others[i], &options), ASET_ERR_ARGUMENT);
    }
    assert_int_equal(aset_flat_init(&flat, &arena, &counter, &aset_mset, &none), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_init(&flat, &arena, &counter, &aset_mset, &many), ASET_ERR_ARGUMENT);
    options.textures = ASET_TEXTURES_MAX + 1;
    assert_int_equal(aset_flat_init(&flat, &arena, &counter, &aset_mset, &options), ASET_ERR_ARGUMENT);
    options.textures = 0;
    assert_int_equal(arena.used, 0);
    assert_int_equal(aset_flat_init(&flat, &arena, &counter, &aset_mset, &options), ASET_OK);
    assert_int_equal(aset_flat_finish(&scene, &space, &summary, &flat), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_finish(NULL, &space, &summary, &flat), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_finish(&scene, NULL, &summary, &flat), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_finish(&scene, &space, NULL, &flat), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_finish(&scene, &space, &summary, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_pass(&flat, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_flat_pass(NULL, &again), ASET_ERR_ARGUMENT);
    /* a sphere without a material, a material that cannot be, a sphere of no size: as a scene answers */
    aset_sink sink = aset_flat_sink(&flat);
    aset_material bad = plain_material();
    bad.diffuse = -1;
    assert_int_equal(sink.sphere(sink.context, &(aset_vec3){0, 0, 0}, 1), ASET_ERR_ARGUMENT);
    assert_int_equal(sink.material(sink.context, &bad), ASET_ERR_ARGUMENT);
    bad.diffuse = 1;
    assert_int_equal(sink.material(sink.context, &bad), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &(aset_vec3){0, 0, 0}, 0), ASET_ERR_GEOMETRY);
    /* and a pass that lacks objects */
    assert_int_equal(aset_flat_pass(&flat, &again), ASET_ERR_GEOMETRY);
    assert_false(again);
    assert_int_equal(arena.used, 0);
    assert_int_equal(aset_flat_pass(&flat, &again), ASET_ERR_ARGUMENT);
    sink = aset_flat_sink(&flat);
    assert_int_equal(sink.material(sink.context, &bad), ASET_OK);
    assert_int_equal(sink.sphere(sink.context, &(aset_vec3){0, 0, 0}, 1), ASET_ERR_ARGUMENT);
}

/* A source that gives other objects in one of its passes: an error, and nothing written where it should not be. */
static void test_flat__a_source_that_changes(void **state) {
    (void)state;
    for (uint32_t change = 0; change < 4; change++) {
        random_state r = random_start(seed_of(change));
        model m, other;
        aset_flat flat;
        aset_space_options options = divisions_of(16, 16, 16);
        guarded memory = guarded_open(1 << 20);
        aset_arena arena;
        model_random(&m, &r, 30, 5, 0.2, 4);
        model_random(&other, &r, 30, 9, 0.2, 4);
        source from = source_of_model(&m);
        aset_counter counter = count(&from);
        bool again = true;
        assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
        assert_int_equal(aset_flat_init(&flat, &arena, &counter, &aset_mset, &options), ASET_OK);
        aset_status status = ASET_OK;
        for (uint32_t pass = 0; status == ASET_OK && again; pass++) {
            aset_sink sink = aset_flat_sink(&flat);
            assert_int_equal(model_emit(&sink, pass == change ? &other : &m), ASET_OK);
            status = aset_flat_pass(&flat, &again);
        }
        assert_int_equal(status, ASET_ERR_GEOMETRY);
        assert_int_equal(flat.passes, change + 1);
        assert_int_equal(arena.used, 0);
        guarded_close(&memory);
        model_free(&m);
        model_free(&other);
    }
}

/* Sums that could leave 64 bits are an error: objects of the largest exponent, one given, and many more said to be there. */
static void test_flat__sums_stay_in_range(void **state) {
    (void)state;
    static ASET_ARENA_BLOCK(block, 65536);
    static const uint32_t counts[2] = {(1u << 24) - 1, (1u << 24) + 2};
    for (int i = 0; i < 2; i++) {
        aset_arena arena;
        aset_flat flat;
        aset_space_options options = divisions_of(1, 1, 1);
        model m;
        aset_material material = plain_material();
        material.shine = R(1e30);
        model_start(&m);
        (void)model_material(&m, &material);
        model_sphere(&m, real3(0, 0, 0), 1);
        source from = source_of_model(&m);
        aset_counter counter = count(&from);
        bool again = true;
        counter.counts.objects = counts[i];
        assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
        assert_int_equal(aset_flat_init(&flat, &arena, &counter, &aset_grid, &options), ASET_OK);
        aset_status status = ASET_OK;
        while (status == ASET_OK && again) {
            aset_sink sink = aset_flat_sink(&flat);
            assert_int_equal(model_emit(&sink, &m), ASET_OK);
            flat.counter.counts.objects = counts[i];
            status = aset_flat_pass(&flat, &again);
        }
        assert_int_equal(status, i == 0 ? ASET_OK : ASET_ERR_LIMIT);
        assert_true(status == ASET_OK || arena.used == 0);
        model_free(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat__is_the_whole_scene_s),
        cmocka_unit_test(test_flat__order_of_objects_does_not_matter),
        cmocka_unit_test(test_flat__sizes_at_the_ends_of_the_numbers),
        cmocka_unit_test(test_flat__a_thousand_materials),
        cmocka_unit_test(test_flat__passes),
        cmocka_unit_test(test_flat__in_the_least_bytes),
        cmocka_unit_test(test_flat__leaves_the_reserve),
        cmocka_unit_test(test_flat__automatic_divisions),
        cmocka_unit_test(test_flat__of_no_objects),
        cmocka_unit_test(test_flat__answers_approximate_rays_alone),
        cmocka_unit_test(test_flat__refuses_bad_arguments),
        cmocka_unit_test(test_flat__a_source_that_changes),
        cmocka_unit_test(test_flat__sums_stay_in_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_support__not_compiled)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
