/*
 * test_draft.c - drafts opened from words, good and broken; rays and pictures of them.
 */
#include "support/support.h"

#if ASET_WITH_DRAFTS

#include "approx/draft_shadows.h"

#define ROOM ((size_t)4 << 20)
enum { SIDE = 40 };

typedef struct drawn {
    guarded memory;
    aset_arena arena;
    aset_draft draft;
    aset_bake_report report;
} drawn;

static void bake(drawn *d, const model *m, uint32_t nx, uint32_t ny, uint32_t nz, bool keep_none) {
    aset_baker *baker = malloc(sizeof *baker);
    aset_bake_options options;
    bool again = true;
    memset(&options, 0, sizeof options);
    options.divisions[0] = nx;
    options.divisions[1] = ny;
    options.divisions[2] = nz;
    options.keep_none = keep_none;
    d->memory = guarded_open(ROOM);
    assert_int_equal(aset_arena_init(&d->arena, d->memory.block, d->memory.size), ASET_OK);
    assert_int_equal(aset_baker_init(baker, &d->arena, &options), ASET_OK);
    while (again) {
        aset_sink sink = aset_baker_sink(baker);
        assert_int_equal(model_emit(&sink, m), ASET_OK);
        assert_int_equal(aset_baker_pass(baker, &again), ASET_OK);
    }
    assert_int_equal(aset_baker_finish(&d->draft, baker), ASET_OK);
    d->report = baker->report;
    free(baker);
}

static void drawn_close(drawn *d) {
    guarded_close(&d->memory);
}

static aset_tracer tracer_of(const aset_draft *draft) {
    aset_tracer tracer;
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &draft->stage;
    tracer.draft = draft;
    tracer.approx_kinds = ASET_ALL_KINDS;
    return tracer;
}

static aset_view view_from(aset_vec3 from) {
    aset_view view;
    memset(&view, 0, sizeof view);
    view.from = from;
    view.up.z = 1;
    view.up.x = R(0.1);
    view.angle_deg = 45;
    return view;
}

static aset_status draw(unsigned char *pixels, uint32_t side, const aset_tracer *tracer, const aset_view *view,
                        aset_statistics *statistics) {
    uint64_t block[ASET_DEPTH_DEFAULT * 8];
    aset_arena arena;
    aset_scratch scratch;
    aset_picture picture;
    memset(&picture, 0, sizeof picture);
    picture.width = picture.height = side;
    picture.format = ASET_RGBA8888;
    picture.transparent = true;
    picture.pixels = pixels;
    picture.stride = 4 * (size_t)side;
    assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
    assert_int_equal(aset_scratch_init(&scratch, 0, &arena), ASET_OK);
    return aset_render_rows(tracer, view, &picture, 0, side, &scratch, statistics);
}

/* How a picture is drawn: with beams of so many voxels and a reach of so many tiles, or without (0); so many rows at once, 0: all. */
typedef struct aids {
    uint32_t voxels, tiles;
} aids;

static aset_status draw_with(unsigned char *pixels, uint32_t side, aset_tracer tracer, const aset_view *view, aids with,
                             uint32_t at_once, aset_statistics *statistics) {
    guarded memory = guarded_open((size_t)1 << 20);
    aset_arena arena;
    aset_scratch scratch;
    aset_beams beams;
    aset_reach reach;
    aset_picture picture;
    uint32_t rows = side + tracer.spd_rules;
    aset_status status = ASET_OK;
    memset(&picture, 0, sizeof picture);
    picture.width = picture.height = side;
    picture.format = ASET_RGBA8888;
    picture.transparent = true;
    picture.stride = 4 * (size_t)rows;
    assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
    assert_int_equal(aset_scratch_init(&scratch, 0, &arena), ASET_OK);
    if (with.voxels > 0) {
        size_t before = arena.used;
        assert_int_equal(aset_beams_init(&beams, with.voxels, &arena), ASET_OK);
        assert_int_equal(arena.used - before, ASET_BYTES_BEAMS(with.voxels));
        scratch.beams = &beams;
    }
    if (with.tiles > 0) {
        size_t before = arena.used;
        assert_int_equal(aset_reach_init(&reach, tracer.draft, with.tiles, &arena), ASET_OK);
        assert_int_equal(arena.used - before, ASET_BYTES_REACH(with.tiles, tracer.draft->stage.counts.lights));
        tracer.reach = &reach;
    }
    at_once = at_once > 0 ? at_once : rows;
    for (uint32_t row = 0; row < rows && status == ASET_OK; row += at_once) {
        picture.pixels = pixels + row * picture.stride;
        status = aset_render_rows(&tracer, view, &picture, row, rows - row < at_once ? rows - row : at_once, &scratch, statistics);
    }
    guarded_close(&memory);
    return status;
}

/* A model with a ground, reflecting things, two lights (one directional, one coloured) and a view. */
static void model_of(model *m, random_state *r, uint32_t n, bool ground) {
    (void)ground; /* of polygons */
    model_random(m, r, n, 4, 0.5, 3);
#if ASET_WITH_POLYGONS
    if (ground) {
        model_rectangle(m, dvec_real(dvec_make(-20, -20, -5)), dvec_real(dvec_make(40, 0, 0)),
                        dvec_real(dvec_make(0, 40, 0)));
    }
#endif
    m->lights[0].directional = true;
    m->lights[1].has_colour = true;
    m->lights[1].colour.r = R(0.7);
    m->lights[1].colour.g = R(0.3);
}

/* A draft of such a model. */
static void bake_model(drawn *d, random_state *r, uint32_t n, bool ground, uint32_t nx, uint32_t ny, uint32_t nz, bool keep_none) {
    model m;
    model_of(&m, r, n, ground);
    bake(d, &m, nx, ny, nz, keep_none);
    model_free(&m);
}

/* --- opening --- */

typedef struct opened {
    uint32_t *words; /* a copy of exactly their length, so that reading beyond is seen by the sanitizers */
    size_t n_words;
    uint64_t block[2048];
    aset_arena arena;
    aset_draft draft;
    const char *why;
} opened;

static void copy_words(opened *o, const uint32_t *words, size_t n_words) {
    o->words = malloc(n_words * sizeof *words + (n_words == 0));
    assert_non_null(o->words);
    memcpy(o->words, words, n_words * sizeof *words);
    o->n_words = n_words;
}

static aset_status open_copy(opened *o) {
    o->why = NULL;
    assert_int_equal(aset_arena_init(&o->arena, o->block, sizeof o->block), ASET_OK);
    aset_status status = aset_draft_open(&o->draft, o->words, o->n_words, &o->arena, &o->why);
    check(status == ASET_OK || o->arena.used == 0, "%d", (int)status);
    check((status == ASET_ERR_SYNTAX) == (o->why != NULL), "%d", (int)status);
    return status;
}

static void seal(opened *o) {
    o->words[WORD_CHECK] = aset_draft_checksum(o->words, o->n_words);
}

static void test_draft__opened_words_give_the_same_pictures(void **state) {
    (void)state;
    uint32_t kept = 0;
    for (uint64_t i = 0; i < 12; i++) {
        static unsigned char a[SIDE * SIDE * 4], b[SIDE * SIDE * 4];
        random_state r = random_start(seed_of(i));
        drawn d;
        opened *o = malloc(sizeof *o);
        aset_statistics before = {0}, after = {0};
        bake_model(&d, &r, i < 6 ? 100 : 14, i % 2 == 0, 12, 10, 14, false);
        kept += d.report.kept;
        copy_words(o, d.draft.words, d.draft.n_words);
        assert_int_equal(open_copy(o), ASET_OK);
        aset_tracer first = tracer_of(&d.draft), second = tracer_of(&o->draft);
        first.draft_sides = second.draft_sides = i % 3 == 0;
        aset_view view = view_from(dvec_real(dvec_make(9, 6, 4)));
        assert_int_equal(draw(a, SIDE, &first, &view, &before), ASET_OK);
        assert_int_equal(draw(b, SIDE, &second, &view, &after), ASET_OK);
#if ASET_REAL_BITS == 32
        check(memcmp(a, b, sizeof a) == 0, SEED, r.seed);
        check(memcmp(&before, &after, sizeof before) == 0, SEED, r.seed);
#else
        int differing = 0; /* the stage's numbers are floats in the words: shadows' and kept objects' edges move a little */
        for (size_t k = 0; k < sizeof a; k++) {
            differing += abs(a[k] - b[k]) > 1;
        }
        check(differing * 50 < SIDE * SIDE * 4, SEED ": %d", r.seed, differing);
#endif
        free(o->words);
        free(o);
        drawn_close(&d);
    }
    assert_true(kept > 12);
}

/* Everything that is drawn from a draft, a little of each: nothing may be read outside, nothing may go on forever. */
static void use(const aset_draft *draft, random_state *r) {
    static unsigned char pixels[5 * 5 * 4];
    aset_tracer tracer = tracer_of(draft);
    aset_view view = view_from(random_in_cube(r, 12));
    aset_statistics statistics = {0};
    for (int sides = 0; sides < 2; sides++) {
        tracer.draft_sides = sides != 0;
        aset_status status = draw(pixels, 5, &tracer, &view, &statistics);
        check(status == ASET_OK || status == ASET_ERR_ARGUMENT || status == ASET_ERR_GEOMETRY, SEED ": %d", r->seed,
              (int)status);
        for (int i = 0; i < 10; i++) {
            aset_ray ray = random_ray_from(r, i % 2 == 0 ? 4 : 20);
            aset_hit hit;
            bool found;
            if (i % 2 == 1) {
                ray.direction.x = -ray.origin.x;
                ray.direction.y = -ray.origin.y;
                ray.direction.z = -ray.origin.z;
            }
            assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), ASET_OK);
            if (found && hit.object == ASET_NO_OBJECT) {
                assert_true(hit.cell < draft->n_facets);
                (void)aset_draft_texture(draft, hit.cell);
            }
            assert_int_equal(aset_any_hit(&found, &tracer, &ray, true, NULL), ASET_OK);
        }
    }
}

static uint32_t pattern(uint32_t word, int k, random_state *r) {
    if (k < 32) {
        return word ^ UINT32_C(1) << k;
    }
    switch (k) {
    case 32: return ~word;
    case 33: return 0;
    case 34: return UINT32_MAX;
    case 35: return word + 1;
    case 36: return word - 1;
    case 37: return 0x7f800000u; /* infinity */
    case 38: return 0x7fc00000u; /* not a number */
    case 39: return (uint32_t)random_next(r);
    case 40: return word ^ 3u << random_below(r, 31);
    case 41: return word << 1;
    case 42: return word >> 1;
    default: return word ^ (uint32_t)(random_next(r) & random_next(r) & random_next(r));
    }
}

static void test_draft__every_word_changed_is_refused_or_harmless(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 3; i++) {
        random_state r = random_start(seed_of(20 + i));
        drawn d;
        opened *o = malloc(sizeof *o);
        uint32_t refused = 0, drawn_anyway = 0;
        bake_model(&d, &r, i == 0 ? 60 : 6, true, 5, 4, 6, i == 0);
        copy_words(o, d.draft.words, d.draft.n_words);
        for (size_t w = 0; w < o->n_words; w++) {
            uint32_t whole = o->words[w], sum = o->words[WORD_CHECK];
            for (int k = 0; k < 46; k++) {
                o->words[w] = pattern(whole, k, &r);
                if (o->words[w] == whole) {
                    continue;
                }
                if (k % 8 == 0 && w != WORD_CHECK) { /* without a fitting check sum it is refused whatever it is */
                    check(open_copy(o) == ASET_ERR_SYNTAX, SEED ", word %zu", r.seed, w);
                }
                if (w != WORD_CHECK) {
                    seal(o);
                }
                if (open_copy(o) == ASET_OK) {
                    drawn_anyway++;
                    use(&o->draft, &r);
                } else {
                    refused++;
                }
                o->words[WORD_CHECK] = sum;
            }
            o->words[w] = whole;
        }
        check(refused > 1000 && drawn_anyway > 1000, SEED ": %" PRIu32 ", %" PRIu32, r.seed, refused, drawn_anyway);
        free(o->words);
        free(o);
        drawn_close(&d);
    }
}

/* Several words at once, the structure's above all. */
static void test_draft__many_words_changed(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 30; i++) {
        random_state r = random_start(seed_of(30 + i));
        drawn d;
        opened *o = malloc(sizeof *o);
        bake_model(&d, &r, 40, true, 6, 6, 6, false);
        copy_words(o, d.draft.words, d.draft.n_words);
        for (int k = 0; k < 400; k++) {
            memcpy(o->words, d.draft.words, o->n_words * sizeof *o->words);
            uint32_t changes = 1 + random_below(&r, 4), spread = k % 2 == 0 ? (uint32_t)o->n_words : WORDS_HEADER + 60;
            for (uint32_t c = 0; c < changes; c++) {
                size_t w = 4 + random_below(&r, spread - 4);
                o->words[w] = pattern(o->words[w], (int)random_below(&r, 46), &r);
            }
            seal(o);
            if (open_copy(o) == ASET_OK) {
                use(&o->draft, &r);
            }
        }
        free(o->words);
        free(o);
        drawn_close(&d);
    }
}

/* The bits that start voxels are moved, their number kept: a voxel of too many facets is refused. */
static void test_draft__a_voxel_has_six_facets_at_most(void **state) {
    (void)state;
    random_state r = random_start(seed_of(65));
    drawn d;
    opened *o = malloc(sizeof *o);
    bake_model(&d, &r, 200, false, 4, 4, 4, true);
    copy_words(o, d.draft.words, d.draft.n_words);
    uint32_t *starts = o->words + (d.draft.starts - d.draft.words), n = d.draft.n_facets, voxels = d.report.voxels;
    assert_int_equal(d.draft.n_blocks, 1);
    assert_true(n > voxels + 8);
    memset(starts, 0, (n / 32 + 1) * sizeof *starts);
    for (uint32_t i = 0; i < voxels; i++) {
        starts[i / 32] |= 1u << i % 32; /* all at the start, so that the last voxel gets what is left */
    }
    starts[n / 32] |= 1u << n % 32;
    seal(o);
    aset_status status = open_copy(o);
    assert_int_equal(status, ASET_ERR_SYNTAX);
    free(o->words);
    free(o);
    drawn_close(&d);
}

static void test_draft__cut_off_anywhere(void **state) {
    (void)state;
    random_state r = random_start(seed_of(70));
    drawn d;
    bake_model(&d, &r, 20, true, 5, 5, 5, false);
    for (size_t n = 0; n < d.draft.n_words + 3; n++) {
        opened *o = malloc(sizeof *o);
        size_t have = n < d.draft.n_words ? n : d.draft.n_words;
        copy_words(o, d.draft.words, have);
        if (n > have) {
            o->words = realloc(o->words, n * sizeof *o->words);
            memset(o->words + have, 0, (n - have) * sizeof *o->words);
            o->n_words = n;
        }
        aset_status expected = n == d.draft.n_words ? ASET_OK : ASET_ERR_SYNTAX;
        check(open_copy(o) == expected, "%zu words of %zu", n, d.draft.n_words);
        if (n > WORD_CHECK) {
            o->words[WORD_N_WORDS] = (uint32_t)n;
            seal(o);
            check(open_copy(o) == expected, "%zu words of %zu, sealed", n, d.draft.n_words);
        }
        free(o->words);
        free(o);
    }
    drawn_close(&d);
}

static void test_draft__sentences_and_arguments(void **state) {
    (void)state;
    random_state r = random_start(seed_of(80));
    drawn d;
    opened *o = malloc(sizeof *o);
    bake_model(&d, &r, 20, true, 5, 5, 5, false);
    copy_words(o, d.draft.words, d.draft.n_words);
    assert_int_equal(open_copy(o), ASET_OK);
    aset_arena none;
    assert_int_equal(aset_draft_open(NULL, o->words, o->n_words, &o->arena, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_draft_open(&o->draft, NULL, o->n_words, &o->arena, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_draft_open(&o->draft, o->words, o->n_words, NULL, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_draft_open(&o->draft, o->words, 0, &o->arena, NULL), ASET_ERR_SYNTAX);
    assert_int_equal(aset_arena_init(&none, NULL, 0), ASET_OK);
    assert_int_equal(aset_draft_open(&o->draft, o->words, o->n_words, &none, NULL), ASET_ERR_NOMEM);
    assert_true(none.missing > 0);
    guarded exact = guarded_open(none.missing);
    aset_arena arena;
    assert_int_equal(aset_arena_init(&arena, exact.block, exact.size), ASET_OK);
    assert_int_equal(aset_draft_open(&o->draft, o->words, o->n_words, &arena, NULL), ASET_OK);
    guarded_close(&exact);
    for (size_t k = 1; k < 4; k++) {
        char *moved = malloc(o->n_words * 4 + 4);
        memcpy(moved + k, o->words, o->n_words * 4);
        assert_int_equal(aset_draft_open(&o->draft, (const uint32_t *)(void *)(moved + k), o->n_words, &o->arena, NULL),
                         ASET_ERR_ARGUMENT);
        free(moved);
    }
    for (size_t i = 0; i < o->n_words; i++) {
        uint32_t w = o->words[i];
        o->words[i] = w >> 24 | (w >> 8 & 0xff00u) | (w << 8 & 0xff0000u) | w << 24;
    }
    assert_int_equal(open_copy(o), ASET_ERR_SYNTAX);
    assert_non_null(strstr(o->why, "byte order"));
    o->words[WORD_MAGIC] = FACET_MAGIC;
    o->words[WORD_VERSION] = FACET_VERSION + 1;
    assert_int_equal(open_copy(o), ASET_ERR_SYNTAX);
    assert_non_null(strstr(o->why, "version"));
    free(o->words);
    copy_words(o, d.draft.words, d.draft.n_words);
    o->words[(size_t)(o->draft.textures - o->draft.words) + 6] = word_of_float(R(0.5)); /* transmits */
    seal(o);
    assert_int_equal(open_copy(o), ASET_WITH_REFRACTION ? ASET_OK : ASET_ERR_UNSUPPORTED);
    free(o->words);
    copy_words(o, d.draft.words, d.draft.n_words);
    o->words[WORD_SURFACES] = o->words[WORD_FACETS] + 1;
    seal(o);
    assert_int_equal(open_copy(o), ASET_ERR_SYNTAX);
    assert_non_null(strstr(o->why, "surfaces"));
    free(o->words);
    free(o);
    drawn_close(&d);
}

static void test_draft__garbage(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 4000; i++) {
        random_state r = random_start(seed_of(100 + i));
        uint32_t n = 40 + random_below(&r, 200);
        opened *o = malloc(sizeof *o);
        o->words = malloc(n * sizeof *o->words);
        o->n_words = n;
        for (uint32_t k = 0; k < n; k++) {
            o->words[k] = i % 2 == 0 ? (uint32_t)random_next(&r) : random_below(&r, 1 + random_below(&r, 12));
        }
        if (i % 4 > 0) {
            o->words[WORD_MAGIC] = FACET_MAGIC;
            o->words[WORD_VERSION] = FACET_VERSION;
            o->words[WORD_N_WORDS] = n;
            for (int a = 0; a < 3; a++) {
                o->words[WORD_N + a] = 1 + random_below(&r, 9);
                o->words[WORD_SIZE + a] = o->words[WORD_LOW + a] = word_of_float(1);
            }
            seal(o);
        }
        if (open_copy(o) == ASET_OK) {
            use(&o->draft, &r);
        }
        free(o->words);
        free(o);
    }
}

/* --- rays --- */

static void test_draft__layers_are_in_order_and_cover_once(void **state) {
    (void)state;
    uint32_t met = 0, several = 0;
    for (uint64_t i = 0; i < 8; i++) {
        random_state r = random_start(seed_of(300 + i));
        drawn d;
        bake_model(&d, &r, 150, false, 14, 15, 16, true);
        for (int k = 0; k < 4000; k++) {
            draft_layer layers[DRAFT_LAYERS_MAX];
            draft_counts counts = {0, 0};
            aset_vec3 from = random_in_cube(&r, 8), to = random_in_cube(&r, 4);
            aset_vec3 direction = aset_vec_unit(vec_sub(to, from));
            aset_real t_max = k % 3 == 0 ? (aset_real)random_between(&r, 0, 12) : REAL_INFINITY, before = 0, sum = 0;
            draft_mode mode = k % 5 == 0 ? DRAFT_SIDE : DRAFT_PLANE;
            uint32_t n = aset_draft_layers(layers, &d.draft, mode, from, direction, t_max, &counts).n;
            assert_true(n <= DRAFT_LAYERS_MAX);
            for (uint32_t l = 0; l < n; l++) {
                check(layers[l].t >= before && layers[l].t > 0 && layers[l].t < t_max, SEED ", ray %d", r.seed, k);
                check(layers[l].cover > 0 && layers[l].facet < d.draft.n_facets, SEED ", ray %d", r.seed, k);
                before = layers[l].t;
                sum += layers[l].cover;
            }
            check(sum <= 1 + 4 * REAL_UNIT, SEED ", ray %d: %g", r.seed, k, (double)sum);
            check(counts.nonempty <= counts.cells && (n == 0 || counts.nonempty > 0), SEED ", ray %d", r.seed, k);
            met += n > 0;
            several += n > 1;
        }
        drawn_close(&d);
    }
    assert_true(met > 1000 && several > 50);
}

/* Rays that meet a ball's far side first came through seams between footprints: as good as none. */
static void test_draft__seams_are_closed(void **state) {
    (void)state;
    uint32_t through = 0;
    for (uint64_t i = 0; i < 4; i++) {
        random_state r = random_start(seed_of(340 + i));
        const aset_vec3 centre = random_in_cube(&r, 1);
        model m;
        drawn d;
        model_start(&m);
        model_sphere(&m, centre, 3);
        bake(&d, &m, 24, 24, 24, true);
        for (uint32_t k = 0; k < 10000; k++) {
            draft_layer layers[DRAFT_LAYERS_MAX];
            draft_counts counts = {0, 0};
            aset_vec3 from = vec_add(centre, vec_scale(aset_vec_unit(random_in_cube(&r, 1)), 12));
            aset_vec3 to = vec_add(centre, random_in_cube(&r, R(1.4)));
            aset_vec3 direction = aset_vec_unit(vec_sub(to, from));
            draft_cover met = aset_draft_layers(layers, &d.draft, DRAFT_PLANE, from, direction, REAL_INFINITY, &counts);
            aset_draft_close_seam(&met, &d.draft, from, direction, REAL_INFINITY, &counts);
            check(met.n > 0, SEED ", ray %u", r.seed, k);
            through += layers[0].t > 12; /* its middle lies there */
        }
        drawn_close(&d);
        model_free(&m);
    }
    check(through <= 3, "%u rays", through);
}

/* A rough sheet of triangles over -3 to 3, but for a slit of the width about x = 0. */
static void rough_sheet(model *m, random_state *r, aset_real slit) {
    enum { N = 12 };
    aset_vec3 at[N + 1][N + 1];
    for (int i = 0; i <= N; i++) {
        for (int j = 0; j <= N; j++) {
            aset_real x = i < N / 2 ? -slit / 2 - R(0.5) * (aset_real)(N / 2 - 1 - i) : slit / 2 + R(0.5) * (aset_real)(i - N / 2);
            at[i][j] = vec(x, R(0.5) * (aset_real)(j - N / 2), (aset_real)random_between(r, -0.4, 0.4));
        }
    }
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N && (i != N / 2 - 1 || !(slit > 0)); j++) {
            const aset_vec3 one[3] = {at[i][j], at[i + 1][j], at[i][j + 1]}, other[3] = {at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]};
            model_polygon(m, one, NULL, 3);
            model_polygon(m, other, NULL, 3);
        }
    }
}

/*
 * n slanting rays through a sheet with nothing behind: what is left, before seams are closed and after, of all those together that met
 * something, and of those that did not. They go to places of |x| up to half_width; to a slit's, in its plane.
 */
static double rays_left(double *left_after, double *missed, const aset_draft *draft, random_state *r, aset_real half_width,
                        uint32_t n) {
    double left = 0;
    *left_after = *missed = 0;
    for (uint32_t k = 0; k < n; k++) {
        draft_layer layers[DRAFT_LAYERS_MAX];
        draft_counts counts = {0, 0};
        aset_vec3 to = {(aset_real)random_between(r, -(double)half_width, (double)half_width), (aset_real)random_between(r, -2, 2), 0};
        aset_vec3 from = vec_add(to, vec(half_width < 1 ? 0 : (aset_real)random_between(r, -6, 6), (aset_real)random_between(r, -6, 6), 9));
        aset_vec3 direction = aset_vec_unit(vec_sub(to, from));
        draft_cover met = aset_draft_layers(layers, draft, DRAFT_PLANE, from, direction, REAL_INFINITY, &counts);
        const aset_real before = met.left;
        aset_real sum = 0;
        bool misses = met.n == 0;
        left += misses ? 0 : (double)before;
        *missed += misses;
        aset_draft_close_seam(&met, draft, from, direction, REAL_INFINITY, &counts);
        for (uint32_t i = 0; i < met.n; i++) {
            sum += layers[i].cover;
        }
        check(met.left <= before && real_abs(sum + met.left - 1) <= 4 * REAL_UNIT, SEED ", ray %u: %g", r->seed, k, (double)sum);
        *left_after += misses ? 0 : (double)met.left;
        check(!misses || met.n == 0, SEED ", ray %u", r->seed, k);
    }
    return left;
}

/* Most of what rays leave that pass a sheet's facets in part is closed; nothing is in a slit of three columns. */
static void test_draft__seams_of_open_surfaces_are_closed(void **state) {
    (void)state;
    double left = 0, left_after = 0;
    for (uint64_t i = 0; i < 4; i++) {
        random_state r = random_start(seed_of(350 + i));
        double after, missed;
        model whole, slit;
        drawn d;
        model_start(&whole);
        rough_sheet(&whole, &r, 0);
        bake(&d, &whole, 24, 24, 8, true);
        left += rays_left(&after, &missed, &d.draft, &r, 2, 10000);
        left_after += after;
        drawn_close(&d);
        model_free(&whole);
        model_start(&slit);
        rough_sheet(&slit, &r, R(0.19)); /* a column is about 6 / 24 / 4 */
        bake(&d, &slit, 24, 24, 8, true);
        assert_true(d.draft.closes_seams);
        check(rays_left(&after, &missed, &d.draft, &r, R(0.005), 1000) == 0 && missed == 1000, SEED ", %g", r.seed, missed);
        drawn_close(&d);
        model_free(&slit);
    }
    check(left > 100 && left_after <= left / 4, "%g rays of %g", left_after, left);
}

/*
 * Where something stops a shadow ray, something is met; where most of a ray is stopped by what faces it beyond the voxel that it starts
 * in, a shadow ray is.
 */
static void test_draft__any_agrees_with_closest(void **state) {
    (void)state;
    uint32_t solid = 0, passed = 0, blocked_by_nothing = 0, sides_differ = 0;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(320 + i));
        drawn d;
        bake_model(&d, &r, 120, i % 2 == 0, 16, 16, 16, i % 3 == 0);
        aset_tracer tracer = tracer_of(&d.draft);
        const aset_vec3 voxel = {4 * d.draft.size[0], 4 * d.draft.size[1], 4 * d.draft.size[2]};
        for (int k = 0; k < 5000; k++) {
            aset_ray ray = random_ray_from(&r, k % 2 == 0 ? 12 : 4);
            aset_hit hit;
            bool any, closest;
            ray.t_max = k % 4 == 0 ? (aset_real)random_between(&r, 0, 10) : REAL_INFINITY;
            tracer.draft_sides = k % 3 == 0;
            assert_int_equal(aset_any_hit(&any, &tracer, &ray, true, NULL), ASET_OK);
            assert_int_equal(aset_closest_hit(&closest, &hit, &tracer, &ray, true, NULL), ASET_OK);
            if (tracer.draft_sides) {
                sides_differ += any != closest;
            } else {
                blocked_by_nothing += any && !closest;
                bool is_own = closest && hit.t * aset_vec_length(ray.direction) < R(1.25) * aset_vec_length(voxel);
                bool faces = closest && !is_own && vec_dot(hit.normal, ray.direction) < 0;
                solid += faces;
                passed += faces && !any;
            }
        }
        drawn_close(&d);
    }
    check(blocked_by_nothing == 0, "%" PRIu32, blocked_by_nothing);
    check(sides_differ == 0, "%" PRIu32, sides_differ);
    check(solid > 1000 && passed * 20 < solid, "%" PRIu32 " of %" PRIu32 " shadow rays passed", passed, solid);
}

/* From a voxel's middle to no farther than its sides nothing stops a shadow ray, whatever is met there. */
static void test_draft__shadow_rays_ignore_the_voxel_that_they_start_in(void **state) {
    (void)state;
    random_state r = random_start(seed_of(330));
    drawn d;
    uint32_t met = 0;
    bake_model(&d, &r, 120, true, 16, 16, 16, false);
    aset_tracer tracer = tracer_of(&d.draft);
    const aset_real *low = d.draft.low, *column = d.draft.size;
    for (uint32_t i = 0; i < 16 * 16 * 16; i++) {
        aset_ray ray = random_ray_from(&r, 4);
        aset_hit hit;
        bool any, closest;
        ray.origin = vec(low[0] + ((aset_real)(i % 16) * 4 + 2) * column[0], low[1] + ((aset_real)(i / 16 % 16) * 4 + 2) * column[1],
                         low[2] + ((aset_real)(i / 256) * 4 + 2) * column[2]);
        ray.direction = aset_vec_unit(ray.direction);
        ray.t_max = R(1.99) * real_min(column[0], real_min(column[1], column[2]));
        assert_int_equal(aset_any_hit(&any, &tracer, &ray, true, NULL), ASET_OK);
        assert_int_equal(aset_closest_hit(&closest, &hit, &tracer, &ray, true, NULL), ASET_OK);
        check(!any, "from voxel %" PRIu32, i);
        met += closest;
    }
    check(met > 100, "only %" PRIu32 " rays met anything", met);
    drawn_close(&d);
}

#if DRAFT_SHADES_BEAMS

/* Origins on slices, between them, anywhere, beside the box; directions that cross slices at once, along axes, any. */
static void any_shadow_ray(aset_vec3 *origin, aset_vec3 *direction, random_state *r, const aset_draft *draft) {
    aset_real o[3], d[3];
    uint32_t kind = (uint32_t)(random_next(r) % 4);
    for (int a = 0; a < 3; a++) {
        double at = random_between(r, -0.2, 1.2) * 4 * draft->n[a];
        at = kind == 0 ? 4 * floor(at / 4) : kind == 1 ? 4 * floor(at / 4) + 2 : at;
        o[a] = draft->low[a] + draft->size[a] * (aset_real)at;
        d[a] = draft->size[a] * (aset_real)((int)(random_next(r) % 3) - 1);
    }
    *origin = vec(o[0], o[1], o[2]);
    *direction = random_next(r) % 2 == 0 ? random_direction(r) : aset_vec_unit(vec(d[0], d[1], d[2]));
    *direction = vec_largest(*direction) > 0 ? *direction : vec(0, -1, 0);
}

static void test_draft__shadow_rays_side_by_side(void **state) {
    (void)state;
    uint64_t blocked = 0, cells = 0, together = 0;
    for (uint64_t i = 0; i < 600; i++) {
        static drawn d;
        random_state r = random_start(seed_of(1300 + i));
        if (i % 100 == 0) {
            static const uint32_t n[] = {16, 1, 7, 32, 64, 5};
            bake_model(&d, &r, 40, false, n[i / 100], n[(i / 100 + 1) % 6], n[(i / 100 + 2) % 6], true);
        }
        draft_shadows s;
        aset_vec3 origins[DRAFT_BEAM], directions[DRAFT_BEAM];
        aset_real o[3][DRAFT_BEAM], u[3][DRAFT_BEAM], t_last[DRAFT_BEAM];
        for (uint32_t k = 0; k < DRAFT_BEAM; k++) {
            any_shadow_ray(&origins[k], &directions[k], &r, &d.draft);
            o[0][k] = origins[k].x, o[1][k] = origins[k].y, o[2][k] = origins[k].z;
            u[0][k] = directions[k].x, u[1][k] = directions[k].y, u[2][k] = directions[k].z;
            s.t_max[k] = k % 3 == 0 ? (aset_real)random_between(&r, 0, 12) : REAL_INFINITY;
            s.t_last[k] = t_last[k] = k % 5 == 0 ? (aset_real)random_between(&r, -1, 8) : REAL_INFINITY;
        }
        uint32_t expected = 0;
        for (uint32_t k = 0; k < DRAFT_BEAM; k++) {
            draft_counts alone = {0, 0}, beside = {0, 0};
            bool a = aset_draft_blocks(&d.draft, DRAFT_PLANE, origins[k], directions[k], s.t_max[k], t_last[k], &alone);
            bool b = aset_draft_shadows_send(&s, &d.draft, o, u, UINT32_C(1) << k, &beside) != 0;
            check(a == b && alone.nonempty == beside.nonempty && beside.cells <= alone.cells,
                  SEED ": ray %u: %d %d, %" PRIu32 " %" PRIu32 " voxels, %" PRIu32 " %" PRIu32 " cells", r.seed, k, a, b,
                  alone.nonempty, beside.nonempty, alone.cells, beside.cells);
            expected |= (uint32_t)a << k;
            blocked += a;
            cells += alone.cells;
            together += beside.cells;
        }
        draft_counts all = {0, 0};
        check(aset_draft_shadows_send(&s, &d.draft, o, u, 0xffff, &all) == (expected & 0xffff), SEED ": of all %x", r.seed, expected);
        if (i % 100 == 99) {
            drawn_close(&d);
        }
    }
    check(blocked > 500 && together <= cells, "%" PRIu64 " blocked, %" PRIu64 " %" PRIu64 " cells", blocked, cells, together);
}

#endif

static void test_draft__odd_rays(void **state) {
    (void)state;
    random_state r = random_start(seed_of(340));
    drawn d;
    bake_model(&d, &r, 100, true, 8, 8, 8, false);
    aset_tracer tracer = tracer_of(&d.draft);
    const aset_real odd[] = {R(NAN), REAL_INFINITY, -REAL_INFINITY};
    bool found;
    aset_hit hit;
    for (int sides = 0; sides < 2; sides++) {
        tracer.draft_sides = sides != 0;
        for (int i = 0; i < 7; i++) {
            for (size_t k = 0; k < COUNT_OF(odd); k++) {
                aset_ray ray = {{9, 9, 9}, {-1, -1, -1}, REAL_INFINITY};
                aset_real *places[7] = {&ray.origin.x, &ray.origin.y, &ray.origin.z, &ray.direction.x, &ray.direction.y,
                                        &ray.direction.z, &ray.t_max};
                *places[i] = odd[k];
                aset_status expected = i == 6 && k > 0 ? ASET_OK : ASET_ERR_ARGUMENT;
                assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), expected);
                assert_int_equal(aset_any_hit(&found, &tracer, &ray, true, NULL), expected);
            }
        }
        aset_ray still = {{0, 0, 0}, {0, 0, 0}, REAL_INFINITY};
        assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &still, true, NULL), ASET_ERR_ARGUMENT);
        /* Along slices, through corners, from on them, from inside, with components that hardly move. */
        for (int k = 0; k < 30000; k++) {
            aset_ray ray;
            aset_vec3 to;
            aset_real *from = &ray.origin.x, *target = &to.x, *direction = &ray.direction.x;
            for (int a = 0; a < 3; a++) {
                from[a] = d.draft.low[a] + d.draft.size[a] * (aset_real)random_below(&r, 33);
                target[a] = d.draft.low[a] + d.draft.size[a] * 4 * (aset_real)random_below(&r, 9);
                from[a] += random_chance(&r, 0.3) ? (aset_real)random_between(&r, -9, 9) : 0;
                direction[a] = random_chance(&r, 0.3) ? 0 : target[a] - from[a];
                direction[a] = random_chance(&r, 0.1) ? R(1e-30) : direction[a];
            }
            ray.t_max = REAL_INFINITY;
            if (vec_largest(ray.direction) > 0) {
                assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), ASET_OK);
                check(!found || (hit.t > 0 && vec_finite(hit.point)), "ray %d", k);
                assert_int_equal(aset_any_hit(&found, &tracer, &ray, true, NULL), ASET_OK);
            }
        }
    }
    drawn_close(&d);
}

/* A component of -0 is one of 0: in a ray, alone or in a beam, and towards a light. */
static void test_draft__zeros_of_either_sign(void **state) {
    (void)state;
    static const aset_real zeros[2] = {0, R(-0.0)};
    static unsigned char pixels[4][SIDE * SIDE * 4];
    random_state r = random_start(seed_of(345));
    drawn d;
    aset_statistics counts[4];
    aset_light light;
    memset(counts, 0, sizeof counts);
    memset(&light, 0, sizeof light);
    bake_model(&d, &r, 150, false, 12, 12, 12, true);
    aset_tracer tracer = tracer_of(&d.draft);
    int met[2] = {0, 0}, blocked[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 900; i++) {
            aset_ray ray = {{(aset_real)(i % 30 - 15) / 4, -30, (aset_real)(i / 30 - 15) / 4}, {zeros[k], 1, zeros[k]}, REAL_INFINITY};
            aset_hit hit;
            bool closest, any;
            assert_int_equal(aset_closest_hit(&closest, &hit, &tracer, &ray, true, NULL), ASET_OK);
            assert_int_equal(aset_any_hit(&any, &tracer, &ray, true, NULL), ASET_OK);
            met[k] += closest;
            blocked[k] += any;
        }
    }
    check(met[0] > 100 && met[0] == met[1] && blocked[0] > 100 && blocked[0] == blocked[1],
          "of 900 rays %d and %d meet something, %d and %d are blocked", met[0], met[1], blocked[0], blocked[1]);
    for (int k = 0; k < 4; k++) { /* a parallel view along y, a light along z; ray by ray, then by beams */
        aset_scene lit = d.draft.stage;
        light.directional = true;
        light.position = vec(zeros[k & 1], zeros[k & 1], 1);
        lit.lights = &light;
        lit.counts.lights = 1;
        tracer.scene = &lit;
        aset_view view = view_from(vec(zeros[k & 1], -30, zeros[k & 1]));
        view.at = vec(zeros[k & 1], 0, 0);
        view.up = vec(zeros[k & 1], zeros[k & 1], 1);
        view.height = 10;
        assert_int_equal(draw_with(pixels[k], SIDE, tracer, &view, (aids){k < 2 ? 0 : 4000, 0}, 0, &counts[k]), ASET_OK);
        check(memcmp(pixels[0], pixels[k], sizeof pixels[0]) == 0 && counts[k].shadow_hit == counts[0].shadow_hit, "picture %d", k);
    }
    check(counts[0].shadow_hit > 50, "%" PRIu64 " shadow rays are stopped", counts[0].shadow_hit);
    drawn_close(&d);
}

#if ASET_WITH_SPHERES
/* From very far a ball is still met, as long as the ray itself says so to within the ball. */
static void test_draft__rays_from_far_away(void **state) {
    (void)state;
    const double distances[] = {10, 1e3, 1e5, 1e6};
    random_state r = random_start(seed_of(350));
    model m;
    drawn d;
    model_start(&m);
    model_sphere(&m, vec(0, 0, 0), 1);
    bake(&d, &m, 32, 32, 32, true);
    aset_tracer tracer = tracer_of(&d.draft);
    for (size_t i = 0; i < COUNT_OF(distances); i++) {
        int missed = 0;
        for (int k = 0; k < 3000; k++) {
            aset_vec3 out = random_direction(&r), in = random_in_cube(&r, 0.3);
            aset_ray ray;
            aset_hit hit;
            bool found;
            ray.origin = vec_scale(out, (aset_real)distances[i]);
            ray.direction = vec_sub(in, ray.origin);
            ray.t_max = REAL_INFINITY;
            assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), ASET_OK);
            missed += !found;
        }
        check(missed * 100 <= 3000, "from %g: %d of 3000 missed", distances[i], missed);
    }
    drawn_close(&d);
    model_free(&m);
}
#endif

/* --- the tracer --- */

static void test_draft__without_a_space_all_rays_must_be_approximate(void **state) {
    (void)state;
    static unsigned char pixels[SIDE * SIDE * 4];
    random_state r = random_start(seed_of(360));
    drawn d;
    bake_model(&d, &r, 60, true, 8, 8, 8, false);
    aset_tracer tracer = tracer_of(&d.draft);
    aset_view view = view_from(dvec_real(dvec_make(12, 5, 3)));
    aset_ray ray = {{9, 9, 9}, {-1, -1, -1}, REAL_INFINITY};
    aset_hit hit;
    bool found;
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, NULL), ASET_OK);
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_any_hit(&found, &tracer, &ray, false, NULL), ASET_ERR_ARGUMENT);
    for (uint32_t kinds = 0; kinds < ASET_ALL_KINDS; kinds++) {
        tracer.approx_kinds = kinds;
        assert_int_equal(draw(pixels, SIDE, &tracer, &view, NULL), ASET_ERR_ARGUMENT);
    }
    tracer.approx_kinds = ASET_ALL_KINDS;
    tracer.approx_depth = 1;
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, NULL), ASET_ERR_ARGUMENT);
    tracer.approx_depth = 0;
    tracer.draft = NULL;
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), ASET_ERR_ARGUMENT);
    tracer.draft = &d.draft;
    tracer.scene = NULL;
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, true, NULL), ASET_ERR_ARGUMENT);
    drawn_close(&d);
}

/* Nothing but the cells that are looked at may depend on beams and reach. */
static void check_same(const aset_statistics *a, const aset_statistics *b, uint64_t seed) {
    check(a->primary == b->primary && a->primary_hit == b->primary_hit && a->shadow == b->shadow &&
              a->shadow_hit == b->shadow_hit && a->reflected == b->reflected && a->refracted == b->refracted &&
              a->secondary_hit == b->secondary_hit && a->curtailed == b->curtailed && a->tests == b->tests &&
              a->test_hits == b->test_hits && a->approx_hits == b->approx_hits && a->nonempty_visited == b->nonempty_visited,
          SEED ": %" PRIu64 " %" PRIu64 " primary, %" PRIu64 " %" PRIu64 " hit, %" PRIu64 " %" PRIu64 " shadow, %" PRIu64
               " %" PRIu64 " not empty",
          seed, a->primary, b->primary, a->primary_hit, b->primary_hit, a->shadow, b->shadow, a->nonempty_visited,
          b->nonempty_visited);
    check(b->cells_visited <= a->cells_visited, SEED ": %" PRIu64 " > %" PRIu64, seed, b->cells_visited, a->cells_visited);
}

static void check_aids_change_nothing(const aset_tracer *tracer, const aset_view *view, aids with, uint64_t seed) {
    static unsigned char plain[SIDE * SIDE * 4], aided[SIDE * SIDE * 4];
    aset_statistics a = {0}, b = {0};
    assert_int_equal(draw_with(plain, SIDE, *tracer, view, (aids){0, 0}, 0, &a), ASET_OK);
    assert_int_equal(draw_with(aided, SIDE, *tracer, view, with, 0, &b), ASET_OK);
    check(memcmp(plain, aided, sizeof plain) == 0, SEED, seed);
    check_same(&a, &b, seed);
}

/* Drafts for some rays beside a space for the others. */
static void test_draft__beside_a_space(void **state) {
    (void)state;
    static unsigned char exact[SIDE * SIDE * 4], mixed[SIDE * SIDE * 4];
    random_state r = random_start(seed_of(370));
    model m;
    drawn d;
    stage s;
    aset_space space;
    aset_statistics e = {0}, x = {0};
    model_of(&m, &r, 60, true);
    bake(&d, &m, 24, 24, 24, false);
    stage_open_model(&s, &m, ROOM);
    stage_space(&s, &space, &aset_mset, 8, 8, 8);
    aset_tracer tracer = stage_tracer(&s, &space);
    aset_view view = view_from(dvec_real(dvec_make(12, 5, 3)));
    assert_int_equal(draw(exact, SIDE, &tracer, &view, &e), ASET_OK);
    tracer.draft = &d.draft;
    assert_int_equal(draw(mixed, SIDE, &tracer, &view, &x), ASET_OK); /* no kinds: all exact */
    assert_memory_equal(exact, mixed, sizeof exact);
    assert_memory_equal(&e, &x, sizeof e);
    tracer.approx_kinds = ASET_SHADOW;
    memset(&x, 0, sizeof x);
    assert_int_equal(draw(mixed, SIDE, &tracer, &view, &x), ASET_OK);
    assert_int_equal(x.primary, e.primary);
    assert_int_equal(x.primary_hit, e.primary_hit);
    assert_true(x.approx_hits > 0 && e.approx_hits == 0);
    drawn_close(&d);
    bake(&d, &m, 24, 24, 24, true);
    tracer.approx_kinds = ASET_PRIMARY; /* what beams meet is not always lit by the draft */
    tracer.depth = 1;
    view = view_from(dvec_real(dvec_make(60, 25, 20)));
    view.angle_deg = 15;
    check_aids_change_nothing(&tracer, &view, (aids){4000, 32}, r.seed);
    stage_close(&s);
    drawn_close(&d);
    model_free(&m);
}

/* Views from everywhere: far, near, among the voxels, along an axis, parallel. */
static aset_view any_view(random_state *r, uint64_t i) {
    static const double distances[] = {12, 30, 9, 300, 3, 7};
    aset_vec3 d = random_direction(r);
    double distance = distances[i % COUNT_OF(distances)];
    if (i % 5 == 1) { /* an axis, and two coordinates within the box */
        d = dvec_real(dvec_make(i % 2 == 0 ? 1 : -1, 0.05, -0.02));
    }
    aset_view view = view_from(dvec_real(dvec_make(d.x * distance, d.y * distance, d.z * distance)));
    view.angle_deg = (aset_real)(distance > 100 ? 3 : 50);
    view.height = i % 4 == 3 ? R(11) : 0;
    return view;
}

static void test_draft__beams_and_reach_change_no_picture(void **state) {
    (void)state;
    enum { PIXELS = (SIDE + 1) * (SIDE + 1) * 4 };
    uint64_t walked = 0, looked_at = 0;
    for (uint64_t i = 0; i < 48; i++) {
        static unsigned char plain[PIXELS], aided[PIXELS];
        static const aids with[] = {{4000, 0}, {0, 32}, {4000, 64}, {60, 7}, {1, 1}};
        static const uint32_t at_once[COUNT_OF(with)] = {0, 1, 7, 6, 1};
        random_state r = random_start(seed_of(i));
        model m;
        drawn d;
        model_of(&m, &r, 200, i % 3 == 0);
        m.lights[1].position = i % 6 < 3 ? dvec_real(dvec_make(15, 9, 12)) : dvec_real(dvec_make(0.5, 1, 2)); /* among the voxels */
        bake(&d, &m, 20, 17, 23, i % 2 == 0);
        aset_tracer tracer = tracer_of(&d.draft);
        aset_view view = any_view(&r, i);
        tracer.samples = i % 7 == 2 ? 2 : 1;
        tracer.spd_rules = i % 7 == 4;
        tracer.draft_sides = i % 11 == 10;
        tracer.depth = 1 + (uint32_t)i % 3;
        aset_statistics a = {0};
        memset(plain, 0, sizeof plain);
        assert_int_equal(draw_with(plain, SIDE, tracer, &view, (aids){0, 0}, 0, &a), ASET_OK);
        for (size_t k = 0; k < COUNT_OF(with); k++) {
            aset_statistics b = {0};
            memset(aided, 0, sizeof aided);
            assert_int_equal(draw_with(aided, SIDE, tracer, &view, with[k], at_once[k], &b), ASET_OK);
            check(memcmp(plain, aided, sizeof plain) == 0, SEED ": %u voxels, %u tiles", r.seed, with[k].voxels, with[k].tiles);
            check_same(&a, &b, r.seed);
            walked += k == 2 ? a.cells_visited : 0;
            looked_at += k == 2 ? b.cells_visited : 0;
        }
        drawn_close(&d);
        model_free(&m);
    }
    check(looked_at * 10 < walked * 9, "%" PRIu64 " of %" PRIu64 " cells looked at", looked_at, walked); /* they are of use */
}

/* Voxels of less than two pixels: rays go alone, with or without beams. */
static void test_draft__small_voxels_are_met_ray_by_ray(void **state) {
    (void)state;
    static unsigned char pixels[SIDE * SIDE * 4];
    random_state r = random_start(seed_of(60));
    drawn d;
    bake_model(&d, &r, 200, false, 20, 20, 20, true);
    aset_tracer tracer = tracer_of(&d.draft);
    aset_view view = view_from(vec(12, 3, 2));
    for (uint32_t side = 10; side <= SIDE; side += SIDE - 10) {
        aset_statistics alone = {0}, beside = {0};
        assert_int_equal(draw_with(pixels, side, tracer, &view, (aids){0, 0}, 0, &alone), ASET_OK);
        assert_int_equal(draw_with(pixels, side, tracer, &view, (aids){4000, 0}, 0, &beside), ASET_OK);
        check((side == 10) == (beside.cells_visited == alone.cells_visited), "%u: %" PRIu64 " %" PRIu64, side, beside.cells_visited,
              alone.cells_visited);
    }
    drawn_close(&d);
}

/* A tracer's scene may have its lights elsewhere than the draft, and more of them. */
static void test_draft__a_reach_helps_its_own_lights_alone(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 8; i++) {
        random_state r = random_start(seed_of(700 + i));
        aset_light lights[6];
        model m;
        drawn d;
        model_of(&m, &r, 150, false);
        bake(&d, &m, 16, 16, 16, true);
        aset_scene other = d.draft.stage;
        memset(lights, 0, sizeof lights);
        for (int k = 0; k < 6; k++) {
            lights[k].directional = k % 2 == (int)(i % 2);
            lights[k].position = vec_scale(random_direction(&r), lights[k].directional ? 1 : 30);
        }
        other.lights = lights;
        other.counts.lights = 1 + (uint32_t)i % 6;
        aset_tracer tracer = tracer_of(&d.draft);
        tracer.scene = &other;
        aset_view view = any_view(&r, i * 2);
        check_aids_change_nothing(&tracer, &view, (aids){4000, 48}, r.seed);
        drawn_close(&d);
        model_free(&m);
    }
}

/* Points and radii; point lights. */
static void scale_model(model *m, aset_real by) {
    for (uint32_t i = 0; i < m->n_things; i++) {
        thing *t = m->things + i;
        for (uint32_t k = 0; k < THING_POINTS_MAX; k++) {
            t->points[k] = vec_scale(t->points[k], by);
        }
        t->radii[0] *= by;
        t->radii[1] *= by;
    }
    for (uint32_t i = 0; i < m->n_lights; i++) {
        m->lights[i].position = vec_scale(m->lights[i].position, m->lights[i].directional ? 1 : by);
    }
}

/*
 * Lit together or one by one: more lights than a word has bits, some of them among the voxels, and one in the middle of a facet; lengths
 * whose squares are no numbers to reckon with; nothing that sends rays on, and things that do beside such that do not.
 */
static void test_draft__what_beams_meet_is_lit_alike(void **state) {
    (void)state;
    static const int exponents[] = {0, 45, -90};
    for (uint64_t i = 0; i < 24; i++) {
        random_state r = random_start(seed_of(1200 + i));
        aset_real scale = (aset_real)ldexp(1, exponents[i % 3]);
        model m;
        drawn d;
        model_of(&m, &r, 40, false);
        for (uint32_t k = 0; k < m.n_materials; k++) {
            bool matte = i % 2 == 0 || k % 4 != 1;
            m.materials[k].specular = matte ? 0 : m.materials[k].specular;
#if ASET_WITH_REFRACTION
            m.materials[k].transmittance = matte ? 0 : m.materials[k].transmittance;
#endif
        }
        if (i % 4 == 1) { /* among the voxels: no reach */
            m.lights[1].position = vec(R(0.5), 1, 2);
        }
        scale_model(&m, scale);
        bake(&d, &m, 14, 15, 16, true);
        aset_tracer tracer = tracer_of(&d.draft);
        aset_light lights[40]; /* the draft's own, for which the reach was made, and others */
        aset_scene other = d.draft.stage;
        memcpy(lights, other.lights, other.counts.lights * sizeof *lights);
        other.lights = lights;
        while (i % 6 < 3 && other.counts.lights < COUNT_OF(lights)) {
            aset_light *light = lights + other.counts.lights++;
            memset(light, 0, sizeof *light);
            light->directional = other.counts.lights % 5 == 0;
            light->position = random_direction(&r);
            light->position = vec_scale(light->position, light->directional ? 1 : (aset_real)random_between(&r, 0, 12) * scale);
        }
        tracer.scene = &other;
        tracer.depth = 1 + (uint32_t)i / 3 % 2;
        tracer.samples = i % 4 == 3 ? 6 : 1; /* added up in their order, whoever lights them */
        aset_view view = view_from(vec_scale(random_direction(&r), 14 * scale));
        check_aids_change_nothing(&tracer, &view, (aids){8000, 40}, r.seed);
        drawn_close(&d);
        model_free(&m);
    }
}

/* Cells of unlike sizes on the axes, seen from about where single rays begin nearer to them; and from the box's very face. */
static void test_draft__beams_from_far_away_and_from_a_face(void **state) {
    (void)state;
    static const uint32_t divisions[][3] = {{64, 16, 16}, {8, 7, 15}, {2, 1, 3}, {1, 1, 1}, {17, 17, 17}};
    for (uint64_t i = 0; i < 60; i++) {
        random_state r = random_start(seed_of(800 + i));
        const uint32_t *n = divisions[i % COUNT_OF(divisions)];
        drawn d;
        bake_model(&d, &r, 100, false, n[0], n[1], n[2], true);
        aset_tracer tracer = tracer_of(&d.draft);
        aset_vec3 out = random_direction(&r), middle;
        aset_real *from = &middle.x, longest = 0;
        for (int k = 0; k < 3; k++) {
            aset_real side = d.draft.size[k] * 4 * (aset_real)n[k];
            from[k] = d.draft.low[k] + side / 2;
            longest = real_max(longest, side);
        }
        aset_view view = view_from(vec_along(middle, longest * (aset_real)random_between(&r, 20, 110), out));
        view.at = middle;
        view.angle_deg = R(1.5);
        if (i >= 40) { /* looking out, or in, from a face */
            int axis = (int)(i % 3);
            aset_vec3 there = middle;
            *(axis == 0 ? &there.x : axis == 1 ? &there.y : &there.z) =
                i % 2 == 0 ? d.draft.low[axis] : d.draft.low[axis] + d.draft.size[axis] * 4 * (aset_real)n[axis];
            view = view_from(there);
            view.up = vec(R(0.3), R(0.5), R(0.8));
            view.at = i % 4 < 2 ? middle : vec_along(there, 1, vec_sub(there, middle));
            view.height = i % 8 < 4 ? longest : 0;
        }
        check_aids_change_nothing(&tracer, &view, (aids){8000, 0}, r.seed);
        drawn_close(&d);
    }
}

/* A scratch whose beams are kept from picture to picture, and where a picture goes. */
typedef struct beam_studio {
    guarded memory;
    aset_arena arena;
    aset_scratch scratch;
    aset_beams beams;
    aset_picture picture;
} beam_studio;

static void beam_studio_open(beam_studio *b, uint32_t side, uint32_t voxels) {
    memset(b, 0, sizeof *b);
    b->memory = guarded_open((size_t)1 << 20);
    b->picture.width = b->picture.height = side;
    b->picture.format = ASET_RGBA8888;
    b->picture.stride = 4 * (size_t)side;
    assert_int_equal(aset_arena_init(&b->arena, b->memory.block, b->memory.size), ASET_OK);
    assert_int_equal(aset_scratch_init(&b->scratch, 0, &b->arena), ASET_OK);
    assert_int_equal(aset_beams_init(&b->beams, voxels, &b->arena), ASET_OK);
    b->scratch.beams = &b->beams;
}

static void test_draft__beams_follow_the_draft_and_the_view(void **state) {
    (void)state;
    static unsigned char first[2][SIDE * SIDE * 4], again[SIDE * SIDE * 4];
    beam_studio b;
    beam_studio_open(&b, SIDE, 4000);
    for (uint64_t i = 0; i < 8; i++) { /* the same beams for one draft, view and size after the other */
        random_state r = random_start(seed_of(i));
        drawn d;
        bake_model(&d, &r, 60, false, 12, 12, 12, true);
        aset_tracer tracer = tracer_of(&d.draft);
        for (int k = 0; k < 2; k++) {
            aset_view view = any_view(&r, (uint64_t)k * 2);
            b.picture.pixels = first[k];
            b.scratch.beams = NULL;
            assert_int_equal(aset_render_rows(&tracer, &view, &b.picture, 0, SIDE, &b.scratch, NULL), ASET_OK);
            b.picture.pixels = again;
            b.scratch.beams = &b.beams;
            assert_int_equal(aset_render_rows(&tracer, &view, &b.picture, 0, SIDE, &b.scratch, NULL), ASET_OK);
            check(memcmp(first[k], again, sizeof again) == 0, SEED ": %d", r.seed, k);
        }
        drawn_close(&d);
    }
    guarded_close(&b.memory);
}

/* The inverse of an odd number among the numbers of 32 bits. */
static uint32_t inverse_of(uint32_t x) {
    uint32_t y = x;
    for (int i = 0; i < 5; i++) {
        y *= 2 - x * y;
    }
    return y;
}

/* Gives words that lack only it the check sum wanted, by the header's first spare word: the sum can be gone back from its end. */
static void forge(uint32_t *words, size_t n_words, uint32_t wanted) {
    const uint32_t prime = 16777619u, back = inverse_of(prime);
    uint32_t before = 2166136261u, after = wanted;
    for (size_t i = WORD_CHECK + 1; i < WORD_SPARE; i++) {
        before = (before ^ words[i]) * prime;
        before ^= before >> 15;
    }
    for (size_t i = n_words; i-- > WORD_SPARE;) {
        after ^= after >> 15 ^ after >> 30;
        after *= back;
        after ^= i > WORD_SPARE ? words[i] : 0;
    }
    words[WORD_SPARE] = before ^ after;
    words[WORD_CHECK] = wanted;
    assert_int_equal(aset_draft_checksum(words, n_words), wanted);
}

/* A small draft comes where a large one lay, with its box and its check sum: beams that take it for the other read nothing beyond. */
static void test_draft__beams_of_a_draft_that_was_exchanged(void **state) {
    (void)state;
    static unsigned char pixels[SIDE * SIDE * 4];
    model m, one;
    drawn large, small;
    opened *o = malloc(sizeof *o);
    random_state r = random_start(seed_of(77));
    model_of(&m, &r, 200, false);
    model_start(&one);
    model_random_thing(&one, &r, 1, 1);
    bake(&large, &m, 12, 12, 12, true);
    bake(&small, &one, 2, 2, 2, true);
    assert_true(large.draft.n_words > small.draft.n_words);
    beam_studio b;
    beam_studio_open(&b, SIDE, 8000);
    b.picture.pixels = pixels;
    aset_view view = view_from(dvec_real(dvec_make(9, 6, 4)));
    copy_words(o, large.draft.words, large.draft.n_words);
    for (int k = 0; k < 2; k++) {
        if (k == 1) { /* in the same place, and nothing behind it */
            size_t n = small.draft.n_words;
            memcpy(o->words, small.draft.words, n * sizeof *o->words);
            memcpy(o->words + WORD_LOW, large.draft.words + WORD_LOW, 6 * sizeof *o->words);
            forge(o->words, n, large.draft.words[WORD_CHECK]);
            memset(o->words + n, 0xff, (o->n_words - n) * sizeof *o->words);
            o->n_words = n;
        }
        assert_int_equal(open_copy(o), ASET_OK);
        aset_tracer tracer = tracer_of(&o->draft);
        aset_statistics statistics = {0};
        /* few rows, so that the voxels before them are still those of the first time */
        assert_int_equal(aset_render_rows(&tracer, &view, &b.picture, SIDE / 16 * 8, 8, &b.scratch, &statistics), ASET_OK);
        /* of a voxel that the draft does not have, no more than six facets are asked */
        check(statistics.tests <= 6 * statistics.nonempty_visited, "%" PRIu64 " of %" PRIu64, statistics.tests,
              statistics.nonempty_visited);
    }
    free(o->words);
    free(o);
    guarded_close(&b.memory);
    drawn_close(&small);
    drawn_close(&large);
    model_free(&one);
    model_free(&m);
}

#if ASET_WITH_POLYGONS
static aset_vec3 real3(double x, double y, double z) {
    return dvec_real(dvec_make(x, y, z));
}

/* A cube in whole numbers, seen along diagonals: rays that enter and leave its box, and cross its planes, at one t. */
static void test_draft__beams_and_rays_agree_where_planes_are_crossed_at_once(void **state) {
    (void)state;
    model m;
    drawn d;
    opened *o = malloc(sizeof *o);
    model_start(&m);
    model_light(&m, real3(100, 200, 300));
    for (int side = 0; side < 2; side++) {
        const double far = 16 * side;
        model_rectangle(&m, real3(far, 0, 0), real3(0, 16, 0), real3(0, 0, 16));
        model_rectangle(&m, real3(0, far, 0), real3(16, 0, 0), real3(0, 0, 16));
        model_rectangle(&m, real3(0, 0, far), real3(16, 0, 0), real3(0, 16, 0));
    }
    bake(&d, &m, 4, 4, 4, true);
    copy_words(o, d.draft.words, d.draft.n_words);
    for (int a = 0; a < 3; a++) { /* the grid onto the cube, in whole numbers */
        o->words[WORD_LOW + a] = word_of_float(0);
        o->words[WORD_SIZE + a] = word_of_float(1);
    }
    seal(o);
    assert_int_equal(open_copy(o), ASET_OK);
    aset_tracer tracer = tracer_of(&o->draft);
    tracer.depth = 1;
    beam_studio b;
    beam_studio_open(&b, 1, 4096);
    uint32_t met = 0;
    for (int i = 0; i < 13 * 13 * 8; i++) {
        aset_real from[3] = {(aset_real)(16 + i % 13 * 4), (aset_real)(16 + i / 13 % 13 * 4), 40}, step[3] = {-20, -20, -20};
        for (int a = 0; a < 3; a++) { /* from all eight corners */
            if ((i / 169 >> a & 1) != 0) {
                from[a] = 16 - from[a];
                step[a] = 20;
            }
        }
        aset_view view = {.from = {from[0], from[1], from[2]},
                          .at = {from[0] + step[0], from[1] + step[1], from[2] + step[2]}, .up = {0, 0, 1}, .height = 8};
        unsigned char pixels[2][4];
        aset_statistics statistics[2] = {{0}, {0}};
        for (int k = 0; k < 2; k++) {
            b.picture.transparent = true;
            b.picture.pixels = pixels[k];
            b.scratch.beams = k == 0 ? NULL : &b.beams;
            assert_int_equal(aset_render_rows(&tracer, &view, &b.picture, 0, 1, &b.scratch, &statistics[k]), ASET_OK);
        }
        check(memcmp(pixels[0], pixels[1], 4) == 0 && statistics[0].nonempty_visited == statistics[1].nonempty_visited,
              "%d: alpha %d and %d", i, pixels[0][3], pixels[1][3]);
        met += pixels[0][3] > 0;
    }
    check(met > 100, "%" PRIu32, met);
    free(o->words);
    free(o);
    guarded_close(&b.memory);
    drawn_close(&d);
    model_free(&m);
}
#endif

/* What the beams are of, changed one thing at a time, and a picture in which two rows may not be drawn together. */
static void test_draft__beams_are_of_one_picture(void **state) {
    (void)state;
    static unsigned char plain[(SIDE + 9) * (SIDE + 9) * 4], again[sizeof plain];
    random_state r = random_start(seed_of(9));
    guarded memory = guarded_open((size_t)1 << 18);
    aset_arena arena;
    aset_scratch scratch;
    aset_beams beams;
    drawn d;
    bake_model(&d, &r, 60, false, 12, 12, 12, true);
    assert_int_equal(aset_arena_init(&arena, memory.block, memory.size), ASET_OK);
    assert_int_equal(aset_scratch_init(&scratch, 0, &arena), ASET_OK);
    assert_int_equal(aset_beams_init(&beams, 4000, &arena), ASET_OK);
    for (int i = 0; i < 24; i++) {
        aset_tracer tracer = tracer_of(&d.draft);
        aset_view view = any_view(&r, 0);
        aset_picture picture;
        memset(&picture, 0, sizeof picture);
        picture.width = picture.height = SIDE;
        picture.format = ASET_RGBA8888;
        aset_real *numbers[6] = {&view.from.x, &view.from.y, &view.from.z, &view.at.x, &view.at.y, &view.angle_deg};
        view.from = vec(R(9), R(-12), R(7)); /* the same each time but for one thing, and every second time but for none */
        view.at = vec(0, 0, 0);
        view.up = vec(0, 0, 1);
        view.angle_deg = 35;
        if (i % 2 == 1 && i / 2 < 6) {
            *numbers[i / 2] += R(0.25);
        }
        view.up = i == 13 ? vec(1, 0, 0) : view.up;
        view.height = i == 15 ? R(12) : 0;
        picture.width += i == 17;
        picture.height += i == 19;
        tracer.samples = i == 21 ? 2 : 1;
        tracer.spd_rules = i == 23;
        uint32_t rows = picture.height + tracer.spd_rules;
        picture.stride = 4 * (size_t)(picture.width + tracer.spd_rules);
        memset(plain, 0, sizeof plain);
        memset(again, 0, sizeof again);
        picture.pixels = plain;
        scratch.beams = NULL;
        assert_int_equal(aset_render_rows(&tracer, &view, &picture, 0, rows, &scratch, NULL), ASET_OK);
        picture.pixels = again;
        scratch.beams = &beams;
        assert_int_equal(aset_render_rows(&tracer, &view, &picture, 0, rows, &scratch, NULL), ASET_OK);
        check(memcmp(plain, again, sizeof plain) == 0, "thing %d", i);
        picture.stride = 4; /* rows that lie over each other come out as drawn one after the other */
        memset(plain, 0, sizeof plain);
        memset(again, 0, sizeof again);
        assert_int_equal(aset_render_rows(&tracer, &view, &picture, 0, rows, &scratch, NULL), ASET_OK);
        picture.pixels = plain;
        scratch.beams = NULL;
        assert_int_equal(aset_render_rows(&tracer, &view, &picture, 0, rows, &scratch, NULL), ASET_OK);
        check(memcmp(plain, again, sizeof plain) == 0, "thing %d, rows that overlap", i);
    }
    drawn_close(&d);
    guarded_close(&memory);
}

static void test_draft__beams_and_reach_refuse(void **state) {
    (void)state;
    uint64_t block[64];
    aset_arena arena;
    aset_beams beams;
    aset_reach reach;
    random_state r = random_start(seed_of(1));
    drawn d;
    bake_model(&d, &r, 20, false, 8, 8, 8, true);
    assert_int_equal(aset_arena_init(&arena, block, sizeof block), ASET_OK);
    assert_int_equal(aset_beams_init(NULL, 9, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_beams_init(&beams, 0, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_beams_init(&beams, ASET_BEAMS_MAX + 1, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_beams_init(&beams, 9, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_beams_init(&beams, 1000, &arena), ASET_ERR_NOMEM);
    assert_int_equal(arena.missing, ASET_BYTES_BEAMS(1000) - sizeof block);
    assert_int_equal(aset_reach_init(NULL, &d.draft, 8, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_reach_init(&reach, NULL, 8, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_reach_init(&reach, &d.draft, 0, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_reach_init(&reach, &d.draft, ASET_REACH_TILES_MAX + 1, &arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_reach_init(&reach, &d.draft, 8, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_reach_init(&reach, &d.draft, 64, &arena), ASET_ERR_NOMEM);
    assert_int_equal(arena.missing, ASET_BYTES_REACH(64, d.draft.stage.counts.lights) - sizeof block);
    assert_int_equal(arena.used, 0);
    d.draft.stage.counts.lights = 0; /* and then nothing is needed */
    assert_int_equal(aset_arena_init(&arena, NULL, 0), ASET_OK);
    assert_int_equal(aset_reach_init(&reach, &d.draft, 8, &arena), ASET_OK);
    drawn_close(&d);
}

static void test_draft__statistics(void **state) {
    (void)state;
    static unsigned char pixels[SIDE * SIDE * 4];
    random_state r = random_start(seed_of(380));
    model m;
    drawn d;
    aset_statistics s = {0}, twice = {0};
    model_of(&m, &r, 60, true);
    bake(&d, &m, 16, 16, 16, false);
    aset_tracer tracer = tracer_of(&d.draft);
    aset_view view = view_from(dvec_real(dvec_make(12, 5, 3)));
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, &s), ASET_OK);
    assert_int_equal(s.primary, SIDE * SIDE);
    assert_true(s.primary_hit > 0 && s.primary_hit <= s.primary && s.shadow_hit <= s.shadow && s.shadow > 0);
    assert_true(s.cells_visited >= s.nonempty_visited && s.nonempty_visited >= s.approx_hits && s.approx_hits > 0);
    assert_true(s.approx_hits <= s.primary_hit + s.shadow_hit + s.secondary_hit);
    assert_int_equal(s.curtailed, 0);
    if (d.report.kept > 0) { /* every ray tests what is kept, and nothing else is tested */
        assert_int_equal(s.tests, (s.primary + s.shadow + s.reflected + s.refracted) * d.report.kept);
        assert_true(s.test_hits > 0 && s.test_hits <= s.tests);
    }
    twice = s;
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, &twice), ASET_OK);
    assert_int_equal(twice.cells_visited, 2 * s.cells_visited);
    assert_int_equal(twice.primary, 2 * s.primary);
    drawn_close(&d);
    model_free(&m);
}

#if ASET_WITH_POLYGONS
/* The shadow rays of a picture of a slope, seen and lit from above, and of another square as far above it as given, 0 for none. */
static aset_statistics shadows_of_slope(double other, uint32_t n_lights) {
    static unsigned char pixels[SIDE * SIDE * 4];
    model m;
    drawn d;
    aset_statistics s = {0};
    model_start(&m);
    model_rectangle(&m, dvec_real(dvec_make(-4, -4, -2)), dvec_real(dvec_make(8, 0, 1)), dvec_real(dvec_make(0, 8, 3)));
    if (other > 0) {
        model_rectangle(&m, dvec_real(dvec_make(-1, -1, other)), dvec_real(dvec_make(2.2, 0, 0.3)), dvec_real(dvec_make(0.2, 2, 0)));
    }
    for (uint32_t i = 0; i < n_lights; i++) {
        model_light(&m, dvec_real(dvec_make(1, 2, 40)));
    }
    bake(&d, &m, 12, 12, 12, true);
    aset_tracer tracer = tracer_of(&d.draft);
    aset_view view = view_from(dvec_real(dvec_make(0.5, -1, 14)));
    assert_int_equal(draw(pixels, SIDE, &tracer, &view, &s), ASET_OK);
    assert_true(s.primary_hit > SIDE * SIDE / 4);
    drawn_close(&d);
    model_free(&m);
    return s;
}

/*
 * Where facets of one surface share a ray, one shadow ray to each of the first 32 lights does for them; where a ray meets an edge and
 * what lies far behind it, two.
 */
static void test_draft__layers_of_one_surface_share_a_shadow_ray(void **state) {
    (void)state;
    aset_statistics one = shadows_of_slope(0, 1), two = shadows_of_slope(4, 1), many = shadows_of_slope(0, 32);
    assert_int_equal(one.shadow, one.primary_hit);
    assert_true(two.shadow > two.primary_hit);
    assert_int_equal(many.shadow, 32 * one.shadow);
    assert_true(shadows_of_slope(0, 33).shadow > 33 * one.shadow);
}
#endif

#if ASET_WITH_POLYGONS && ASET_WITH_REFLECTION
/* Where eye rays meet a draft and others the scene, these do not meet the surface that the facet stands for: nothing else is there. */
static void test_draft__exact_rays_leave_the_facets_own_surface(void **state) {
    (void)state;
    static unsigned char pixels[SIDE * SIDE * 4];
    random_state r = random_start(seed_of(390));
    for (int i = 0; i < 20; i++) {
        model m;
        drawn d;
        stage s;
        aset_space space;
        aset_statistics n = {0};
        model_start(&m);
        m.materials[0].specular = R(0.5);
        model_rectangle(&m, dvec_real(dvec_make(-4, -4, random_between(&r, -2, 2))), dvec_real(dvec_make(8, 0, random_between(&r, -2, 2))),
                        dvec_real(dvec_make(0, 8, random_between(&r, -2, 2))));
        model_light(&m, dvec_real(dvec_make(1, 2, 40)));
        bake(&d, &m, 16, 16, 16, true);
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &space, &aset_mset, 4, 4, 4);
        aset_tracer tracer = stage_tracer(&s, &space);
        tracer.draft = &d.draft;
        tracer.approx_kinds = ASET_PRIMARY;
        aset_view view = view_from(dvec_real(dvec_make(0.5, -1, 14)));
        assert_int_equal(draw(pixels, SIDE, &tracer, &view, &n), ASET_OK);
        check(n.shadow >= n.primary_hit && n.reflected > SIDE * SIDE / 4, "slope %d: too few rays", i);
        check(n.shadow_hit == 0 && n.secondary_hit == 0, "slope %d: %" PRIu64 " of %" PRIu64 " shadow rays and %" PRIu64 " of %" PRIu64
              " reflected ones meet it", i, n.shadow_hit, n.shadow, n.secondary_hit, n.reflected);
        stage_close(&s);
        drawn_close(&d);
        model_free(&m);
    }
}
#endif

/* All objects kept: no facets, and still a draft, the same as the scene. */
static void test_draft__all_kept(void **state) {
    (void)state;
    static unsigned char exact[SIDE * SIDE * 4], kept[SIDE * SIDE * 4];
    random_state r = random_start(seed_of(390));
    model m;
    drawn d;
    stage s;
    aset_space space;
    model_random(&m, &r, 0, 4, 3, 3);
    for (uint32_t i = 0; i < 5; i++) {
#if ASET_WITH_SPHERES
        model_sphere(&m, vec((aset_real)i, 0, (aset_real)(i % 2)), 1)->material = i % 6;
#elif ASET_WITH_POLYGONS
        model_rectangle(&m, vec((aset_real)i, 0, 0), vec(0, 1, 0), vec(0, 0, 1))->material = i % 6;
#else
        model_cone(&m, vec((aset_real)i, 0, 0), 1, vec((aset_real)i, 0, 1), 1)->material = i % 6;
#endif
    }
    bake(&d, &m, 4, 4, 4, false);
    assert_int_equal(d.report.kept, 5);
    assert_int_equal(d.draft.n_facets, 0);
    stage_open_model(&s, &m, ROOM);
    stage_space(&s, &space, &aset_mset, 4, 4, 4);
    aset_tracer of_scene = stage_tracer(&s, &space), of_draft = tracer_of(&d.draft);
    of_scene.depth = of_draft.depth = 1;
    s.scene.counts.lights = d.draft.stage.counts.lights = 0; /* the draft's shadow rays start a little farther away */
    aset_view view = view_from(dvec_real(dvec_make(12, 5, 3)));
    assert_int_equal(draw(exact, SIDE, &of_scene, &view, NULL), ASET_OK);
    assert_int_equal(draw(kept, SIDE, &of_draft, &view, NULL), ASET_OK);
    assert_memory_equal(exact, kept, sizeof exact);
    stage_close(&s);
    drawn_close(&d);
    model_free(&m);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_draft__opened_words_give_the_same_pictures),
        cmocka_unit_test(test_draft__every_word_changed_is_refused_or_harmless),
        cmocka_unit_test(test_draft__many_words_changed),
        cmocka_unit_test(test_draft__a_voxel_has_six_facets_at_most),
        cmocka_unit_test(test_draft__cut_off_anywhere),
        cmocka_unit_test(test_draft__sentences_and_arguments),
        cmocka_unit_test(test_draft__garbage),
        cmocka_unit_test(test_draft__layers_are_in_order_and_cover_once),
        cmocka_unit_test(test_draft__seams_are_closed),
        cmocka_unit_test(test_draft__seams_of_open_surfaces_are_closed),
        cmocka_unit_test(test_draft__any_agrees_with_closest),
        cmocka_unit_test(test_draft__shadow_rays_ignore_the_voxel_that_they_start_in),
#if DRAFT_SHADES_BEAMS
        cmocka_unit_test(test_draft__shadow_rays_side_by_side),
#endif
        cmocka_unit_test(test_draft__odd_rays),
        cmocka_unit_test(test_draft__zeros_of_either_sign),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_draft__rays_from_far_away),
#endif
        cmocka_unit_test(test_draft__without_a_space_all_rays_must_be_approximate),
        cmocka_unit_test(test_draft__beside_a_space),
        cmocka_unit_test(test_draft__beams_and_reach_change_no_picture),
        cmocka_unit_test(test_draft__a_reach_helps_its_own_lights_alone),
        cmocka_unit_test(test_draft__what_beams_meet_is_lit_alike),
        cmocka_unit_test(test_draft__small_voxels_are_met_ray_by_ray),
        cmocka_unit_test(test_draft__beams_from_far_away_and_from_a_face),
        cmocka_unit_test(test_draft__beams_follow_the_draft_and_the_view),
        cmocka_unit_test(test_draft__beams_of_a_draft_that_was_exchanged),
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_draft__beams_and_rays_agree_where_planes_are_crossed_at_once),
#endif
        cmocka_unit_test(test_draft__beams_are_of_one_picture),
        cmocka_unit_test(test_draft__beams_and_reach_refuse),
        cmocka_unit_test(test_draft__statistics),
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_draft__layers_of_one_surface_share_a_shadow_ray),
#endif
#if ASET_WITH_POLYGONS && ASET_WITH_REFLECTION
        cmocka_unit_test(test_draft__exact_rays_leave_the_facets_own_surface),
#endif
        cmocka_unit_test(test_draft__all_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_support__not_compiled)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
