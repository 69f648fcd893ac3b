/*
 * test_summary.c - what cells remember: equal-weight averages computed a second time, whatever the order of the objects; the
 * bounded list; its bytes.
 */
#include "support/support.h"

#if ASET_WITH_APPROXIMATION

#include "approx/summary.h"
#include "approx/texture.h"

#define ROOM ((size_t)4 << 20)
enum { PARTS = 8 };

static void parts_of(const aset_material *m, double parts[PARTS]) {
    memset(parts, 0, PARTS * sizeof *parts);
    parts[0] = (double)m->fill.r;
    parts[1] = (double)m->fill.g;
    parts[2] = (double)m->fill.b;
    parts[3] = (double)m->diffuse;
    parts[4] = (double)m->specular;
    parts[5] = (double)m->shine;
#if ASET_WITH_REFRACTION
    parts[6] = (double)m->transmittance;
    parts[7] = m->refraction_index > 0 ? (double)m->refraction_index : 1; /* 0 means 1 */
#endif
}

static bool same_texture(const aset_material *a, const aset_material *b) {
    double p[PARTS], q[PARTS];
    parts_of(a, p);
    parts_of(b, q);
    return memcmp(p, q, sizeof p) == 0;
}

/* Each part is kept in units of 2^-16, and in an aset_real. */
static bool near_texture(const aset_material *m, const double expected[PARTS]) {
    double parts[PARTS];
    parts_of(m, parts);
    for (int i = 0; i < PARTS; i++) {
        if (!(fabs(parts[i] - expected[i]) <= 1.01 / 65536 + fabs(expected[i]) / (1 << 22))) {
            return false;
        }
    }
    return true;
}

/* --- averages --- */

/* Goes through all cell sides of a grid: each has a texture exactly if an object is on it, and it is the mean of theirs. */
static void check_averages(const model *m, const stage *s, const aset_space *space, const aset_summary *summary,
                           uint64_t seed) {
    const uint32_t *n = space->slices.n;
    uint32_t n_objects = s->scene.counts.objects;
    int32_t (*low)[3] = malloc(n_objects * sizeof *low), (*high)[3] = malloc(n_objects * sizeof *high), v[3];
    for (uint32_t i = 0; i < n_objects; i++) {
        expected_box(space, i, low[i], high[i]);
    }
    for (uint32_t k = 0; k < n[0] * n[1] * n[2] * 6; k++) {
        uint32_t face = k % 6, voxel = k / 6, n_here = 0;
        double sum[PARTS] = {0};
        v[0] = (int32_t)(voxel % n[0]);
        v[1] = (int32_t)(voxel / n[0] % n[1]);
        v[2] = (int32_t)(voxel / n[0] / n[1]);
        for (uint32_t i = 0; i < n_objects; i++) {
            if (expected_marked(low[i], high[i], v, face)) {
                double parts[PARTS];
                parts_of(m->materials + m->things[m->backwards ? n_objects - 1 - i : i].material, parts);
                for (int p = 0; p < PARTS; p++) {
                    sum[p] += parts[p];
                }
                n_here++;
            }
        }
        uint32_t cell = cell_number(space, v, face);
        check((cell == UINT32_MAX) == (n_here == 0), SEED, seed);
        for (int p = 0; p < PARTS && n_here > 0; p++) {
            sum[p] /= n_here;
        }
        if (n_here > 0) {
            const aset_material *texture = summary_texture(summary, cell);
            check(near_texture(texture, sum), SEED ", voxel %d %d %d, face %" PRIu32 ", %" PRIu32 " objects", seed,
                  (int)v[0], (int)v[1], (int)v[2], face, n_here);
            check(!texture->one_sided, SEED, seed);
        }
    }
    free(low);
    free(high);
}

/* A cell of one object has its material, where that is of whole units: also where half a unit more cannot be told from a unit more. */
static void test_summary__one_material_is_kept_as_it_is(void **state) {
    (void)state;
    const aset_real units[] = {1, 65537, 4194305, 8388607, 8388609, 8388611, 16777215};
    for (size_t i = 0; i < COUNT_OF(units); i++) {
        aset_material material, mean;
        texture_sum sum;
        memset(&material, 0, sizeof material);
        memset(&sum, 0, sizeof sum);
        material.diffuse = material.shine = units[i] / 65536;
        for (int n = 0; n < 3; n++) {
            aset_texture_sum_add(&sum, &material);
            mean = aset_texture_average(&sum);
            check(mean.shine == material.shine && mean.diffuse == material.diffuse, "%g units, %d times", (double)units[i], n + 1);
        }
    }
}

static void test_summary__textures_are_equal_weight_averages(void **state) {
    (void)state;
    static const uint32_t grids[][3] = {{1, 1, 1}, {2, 3, 4}, {6, 6, 6}, {12, 5, 9}};
    for (uint64_t i = 0; i < 5; i++) {
        random_state r = random_start(seed_of(i));
        model m;
        stage s;
        model_random(&m, &r, 60, 5, 0.2, 6);
        m.materials[0].shine = 100000; /* the SPD's largest */
        stage_open_model(&s, &m, ROOM);
        for (size_t g = 0; g < COUNT_OF(grids); g++) {
            aset_space space;
            aset_summary summary;
            aset_mark mark = aset_arena_mark(&s.arena);
            stage_space(&s, &space, &aset_mset, grids[g][0], grids[g][1], grids[g][2]);
            assert_int_equal(aset_summary_build(&summary, &space, ASET_TEXTURES_MAX, &s.arena), ASET_OK);
            check_averages(&m, &s, &space, &summary, r.seed);
            check(summary.merged == 0, SEED, r.seed);
            aset_arena_release(&s.arena, &mark);
        }
        stage_close(&s);
        model_free(&m);
    }
}

#if ASET_WITH_SPHERES
/* By hand: two red ones and a blue one on the same sides. */
static void test_summary__every_object_has_the_same_weight(void **state) {
    (void)state;
    const aset_vec3 middle = {0, 0, 0};
    model m;
    stage s;
    aset_space space;
    aset_summary summary;
    model_start(&m);
    aset_material red = plain_material(), blue = plain_material();
    red.fill.g = red.fill.b = blue.fill.r = blue.fill.g = 0;
    red.diffuse = R(0.5);
    blue.diffuse = R(0.875);
    blue.specular = R(0.75);
    red.shine = 4;
    blue.shine = 16;
    blue.one_sided = true;
    model_material(&m, &red);
    model_sphere(&m, middle, 1);
    model_sphere(&m, middle, -1);
    model_material(&m, &blue);
    model_sphere(&m, middle, 1);
    const double expected[PARTS] = {2.0 / 3, 0, 1.0 / 3, 0.625, 0.25, 8, 0, ASET_WITH_REFRACTION};
    const aset_method *const methods[2] = {&aset_mset, &aset_brute};
    for (int i = 0; i < 2; i++) {
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &space, methods[i], 3, 3, 3);
        assert_int_equal(aset_summary_build(&summary, &space, 0, &s.arena), ASET_OK);
        assert_int_equal(summary.n_textures, 1);
        assert_int_equal(summary.merged, 0);
        assert_true(near_texture(summary_texture(&summary, 0), expected));
        stage_close(&s);
    }
    model_free(&m);
}
#endif

/* The texture of every (voxel, face) must be the same to the bit, though cells list their objects the other way round. */
static void test_summary__order_of_objects_does_not_matter(void **state) {
    (void)state;
    static const uint32_t capacities[] = {1, 3, 16, 4096};
    for (uint64_t i = 0; i < 8; i++) {
        random_state r = random_start(seed_of(100 + i));
        model m;
        model_random(&m, &r, 60, 5, 0.2, 6);
        for (size_t c = 0; c < COUNT_OF(capacities); c++) {
            stage s[2];
            aset_space space[2];
            aset_summary summary[2];
            for (int k = 0; k < 2; k++) {
                m.backwards = k == 1;
                stage_open_model(&s[k], &m, ROOM);
                stage_space(&s[k], &space[k], &aset_mset, 7, 8, 9);
                assert_int_equal(aset_summary_build(&summary[k], &space[k], capacities[c], &s[k].arena), ASET_OK);
            }
            check(summary[0].n_textures == summary[1].n_textures && summary[0].merged == summary[1].merged, SEED, r.seed);
            check(space[0].cells.n_cells == space[1].cells.n_cells, SEED, r.seed);
            for (uint32_t cell = 0; cell < space[0].cells.n_cells; cell++) {
                check(same_texture(summary_texture(&summary[0], cell), summary_texture(&summary[1], cell)),
                      SEED ", capacity %" PRIu32 ", cell %" PRIu32, r.seed, capacities[c], cell);
            }
            stage_close(&s[0]);
            stage_close(&s[1]);
        }
        model_free(&m);
    }
}

/* --- the list --- */

/* Two models' worth of cells whose averages differ in colour only, so that every sensible nearness agrees. */
static void coloured_model(model *m, random_state *r) {
    model_start(m);
    for (int i = 0; i < 8; i++) {
        aset_material material = plain_material();
        material.fill.r = (aset_real)random_between(r, 0, 1);
        material.fill.g = (aset_real)random_between(r, 0, 1);
        material.fill.b = (aset_real)random_between(r, 0, 1);
        model_material(m, &material);
    }
    for (int i = 0; i < 40; i++) {
        thing *t = model_random_thing(m, r, 5, random_between(r, 0.3, 4));
        t->material = random_below(r, m->n_materials);
    }
}

static double colour_distance(const aset_material *a, const aset_material *b) {
    dvec d = {(double)a->fill.r - (double)b->fill.r, (double)a->fill.g - (double)b->fill.g,
              (double)a->fill.b - (double)b->fill.b};
    return dvec_length(d);
}

static bool in_list(const aset_material *list, uint32_t n, const aset_material *texture) {
    for (uint32_t i = 0; i < n; i++) {
        if (same_texture(list + i, texture)) {
            return true;
        }
    }
    return false;
}

static void test_summary__equal_textures_are_shared(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(200 + i));
        model m;
        stage s;
        aset_space space;
        aset_summary summary;
        coloured_model(&m, &r);
        m.materials[3] = m.materials[4]; /* two numbers, one look */
        m.materials[4].one_sided = true;
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &space, &aset_mset, 6, 7, 5);
        assert_int_equal(aset_summary_build(&summary, &space, 10000, &s.arena), ASET_OK);
        uint8_t *used = calloc(summary.n_textures, 1);
        for (uint32_t k = 0; k < summary.n_textures; k++) {
            check(!in_list(summary.textures, k, summary.textures + k), SEED ", texture %" PRIu32, r.seed, k);
        }
        for (uint32_t cell = 0; cell < space.cells.n_cells; cell++) {
            size_t number = (size_t)(summary_texture(&summary, cell) - summary.textures);
            assert_true(number < summary.n_textures);
            used[number] = 1;
        }
        for (uint32_t k = 0; k < summary.n_textures; k++) {
            check(used[k] == 1, SEED ", texture %" PRIu32 " is nobody's", r.seed, k);
        }
        check(summary.n_textures < space.cells.n_cells && summary.n_textures > 8, SEED, r.seed);
        free(used);
        stage_close(&s);
        model_free(&m);
    }
}

/* Against the summary that had room for all: who has the own texture, who another, and whether that is the nearest. */
static void check_bounded(const aset_summary *full, const aset_summary *small, uint32_t capacity, uint64_t seed) {
    uint32_t merged = 0;
    check(small->n_textures == (full->n_textures < capacity ? full->n_textures : capacity), SEED, seed);
    check(small->capacity == capacity, SEED, seed);
    for (uint32_t cell = 0; cell < full->space->cells.n_cells; cell++) {
        const aset_material *own = summary_texture(full, cell), *taken = summary_texture(small, cell);
        if (in_list(small->textures, small->n_textures, own)) {
            check(same_texture(own, taken), SEED ", capacity %" PRIu32 ", cell %" PRIu32, seed, capacity, cell);
            continue;
        }
        merged++;
        for (uint32_t k = 0; k < small->n_textures; k++) {
            check(colour_distance(own, taken) <= colour_distance(own, small->textures + k) + 1e-6,
                  SEED ", capacity %" PRIu32 ", cell %" PRIu32, seed, capacity, cell);
        }
    }
    check(small->merged == merged, SEED ", capacity %" PRIu32 ": %" PRIu32 " merged, not %" PRIu32, seed, capacity,
          small->merged, merged);
    check((merged > 0) == (capacity < full->n_textures), SEED, seed);
    for (uint32_t k = 0; k < small->n_textures; k++) { /* first come, first served */
        check(same_texture(small->textures + k, full->textures + k), SEED, seed);
    }
}

static void test_summary__full_list_gives_the_nearest_and_counts_it(void **state) {
    (void)state;
    for (uint64_t i = 0; i < 6; i++) {
        random_state r = random_start(seed_of(300 + i));
        model m;
        stage s;
        aset_space space;
        aset_summary full;
        coloured_model(&m, &r);
        stage_open_model(&s, &m, ROOM);
        stage_space(&s, &space, &aset_mset, 6, 7, 5);
        assert_int_equal(aset_summary_build(&full, &space, 10000, &s.arena), ASET_OK);
        check(full.n_textures > 20, SEED ": %" PRIu32, r.seed, full.n_textures);
        const uint32_t capacities[] = {1, 2, 3, 4, 5, 16, 33, 64, 65, full.n_textures - 1, full.n_textures,
                                       full.n_textures + 1};
        for (size_t c = 0; c < COUNT_OF(capacities); c++) {
            aset_summary small;
            aset_mark mark = aset_arena_mark(&s.arena);
            assert_int_equal(aset_summary_build(&small, &space, capacities[c], &s.arena), ASET_OK);
            check_bounded(&full, &small, capacities[c], r.seed);
            aset_arena_release(&s.arena, &mark);
        }
        stage_close(&s);
        model_free(&m);
    }
}

/* Nearness looks at every part: of two textures in the list, the one that differs less in one part is taken. */
static void test_summary__nearest_by_every_part(void **state) {
    (void)state;
    aset_material first = plain_material();
    first.fill.r = first.fill.g = first.fill.b = R(0.2);
    first.diffuse = R(0.2);
    first.shine = 4;
    for (int part = 0; part < PARTS; part++) {
        double p[PARTS];
        aset_material m[3];
        for (int k = 0; k < 3; k++) {
            const double grown[3] = {0, 0.7, 0.5};
            m[k] = first;
            switch (part) {
            case 0: m[k].fill.r += (aset_real)grown[k]; break;
            case 1: m[k].fill.g += (aset_real)grown[k]; break;
            case 2: m[k].fill.b += (aset_real)grown[k]; break;
            case 3: m[k].diffuse += (aset_real)grown[k]; break;
            case 4: m[k].specular += (aset_real)grown[k]; break;
            case 5: m[k].shine += (aset_real)(100 * grown[k]); break;
#if ASET_WITH_REFRACTION
            case 6: m[k].transmittance += (aset_real)grown[k]; break;
            default: m[k].refraction_index += (aset_real)(1 + grown[k]); break;
#else
            default: m[k].diffuse += (aset_real)grown[k]; break;
#endif
            }
        }
        model row;
        stage s;
        aset_space space;
        aset_summary summary;
        const aset_vec3 places[3] = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}};
        random_state r = random_start(seed_of(350));
        model_start(&row);
        for (int k = 0; k < 3; k++) { /* along x, so that cells come in this order */
            model_material(&row, &m[k]);
            thing *t = model_random_thing(&row, &r, 0, 1);
            for (int i = 0; i < THING_POINTS_MAX; i++) {
                t->points[i].x += places[k].x;
            }
        }
        stage_open_model(&s, &row, ROOM);
        stage_space(&s, &space, &aset_mset, 3, 1, 1);
        assert_int_equal(aset_summary_build(&summary, &space, 2, &s.arena), ASET_OK);
        assert_int_equal(summary.n_textures, 2);
        const int32_t last[3] = {2, 0, 0};
        parts_of(&m[1], p);
        check(near_texture(summary_texture(&summary, cell_number(&space, last, 0)), p), "part %d", part);
        stage_close(&s);
        model_free(&row);
    }
}

#if ASET_WITH_SPHERES
static void test_summary__automatic_capacity(void **state) {
    (void)state;
    static const uint32_t cases[][2] = {{1, 32}, {2, 64}, {3, 128}, {4, 128}, {5, 256}, {8, 256}, {9, 512}, {40, 2048}};
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        model m;
        stage s;
        aset_space space;
        aset_summary summary;
        model_start(&m);
        m.n_materials = 0;
        for (uint32_t k = 0; k < cases[i][0]; k++) {
            const aset_vec3 place = {(aset_real)k, 0, 0};
            aset_material material = plain_material();
            material.shine = (aset_real)k;
            model_material(&m, &material);
            model_sphere(&m, place, 0.25);
        }
        stage_open_model(&s, &m, ROOM);
        assert_int_equal(aset_summary_capacity(&s.scene), cases[i][1]);
        stage_space(&s, &space, &aset_mset, 4, 1, 1);
        assert_int_equal(aset_summary_build(&summary, &space, 0, &s.arena), ASET_OK);
        assert_int_equal(summary.capacity, cases[i][1]);
        stage_close(&s);
        model_free(&m);
    }
    aset_scene many;
    memset(&many, 0, sizeof many);
    assert_int_equal(aset_summary_capacity(&many), 16);
    many.counts.materials = 256;
    assert_int_equal(aset_summary_capacity(&many), 4096);
    many.counts.materials = 100000;
    assert_int_equal(aset_summary_capacity(&many), 4096);
}
#endif

/* --- bytes and arguments --- */

static bool same_arena(const aset_arena *a, const aset_arena *b) {
    return a->block == b->block && a->size == b->size && a->used == b->used && a->peak == b->peak &&
           memcmp(a->used_by, b->used_by, sizeof a->used_by) == 0;
}

/* The summary in an arena that has exactly room bytes left; whatever comes of it, cleanly. */
static aset_status build_in(const model *m, uint32_t capacity, size_t room, size_t need, uint64_t seed) {
    stage s;
    aset_space space;
    aset_summary summary, untouched;
    aset_space_options options;
    aset_space_size size;
    memset(&options, 0, sizeof options);
    memset(&summary, 0x5a, sizeof summary);
    memset(&untouched, 0x5a, sizeof untouched);
    options.divisions[0] = options.divisions[1] = options.divisions[2] = 5;
    stage_open_model(&s, m, 0);
    assert_int_equal(aset_space_measure(&size, &s.scene, &aset_mset, &options, NULL), ASET_OK);
    stage_close(&s);
    stage_open_model(&s, m, size.total + room);
    stage_space(&s, &space, &aset_mset, 5, 5, 5);
    aset_arena before = s.arena;
    size_t measured = 0;
    aset_status expected = aset_summary_measure(&measured, &space, capacity, &s.arena);
    check(same_arena(&s.arena, &before), SEED, seed);
    check(expected == ASET_OK ? measured == need : expected == ASET_ERR_NOMEM && measured >= need, SEED, seed);
    check(expected == ASET_OK || s.arena.missing == measured - room, SEED, seed);
    aset_status status = aset_summary_build(&summary, &space, capacity, &s.arena);
    if (status == ASET_OK) {
        check(s.arena.used - before.used == need && s.arena.used_by[ASET_CATEGORY_TEXTURES] == need, SEED, seed);
        check(need == ASET_BYTES_SUMMARY(space.cells.n_cells, summary.n_textures), SEED, seed);
        check(s.arena.peak == s.arena.used && summary.space == &space, SEED, seed);
    } else {
        check(status == ASET_ERR_NOMEM && same_arena(&s.arena, &before), SEED, seed);
        check(memcmp(&summary, &untouched, sizeof summary) == 0, SEED, seed);
        check(s.arena.missing == measured - room, SEED ": %zu missing", seed, s.arena.missing);
    }
    stage_close(&s);
    return status;
}

static void test_summary__takes_what_was_measured(void **state) {
    (void)state;
    static const uint32_t capacities[] = {1, 2, 7, 64, 0, ASET_TEXTURES_MAX};
    for (uint64_t i = 0; i < 4; i++) {
        random_state r = random_start(seed_of(400 + i));
        model m;
        model_random(&m, &r, 30, 5, 0.3, 4);
        for (size_t c = 0; c < COUNT_OF(capacities); c++) {
            stage s;
            aset_space space;
            size_t need;
            stage_open_model(&s, &m, ROOM);
            stage_space(&s, &space, &aset_mset, 5, 5, 5);
            assert_int_equal(aset_summary_measure(&need, &space, capacities[c], &s.arena), ASET_OK);
            stage_close(&s);
            check(build_in(&m, capacities[c], need, need, r.seed) == ASET_OK, SEED, r.seed);
            check(build_in(&m, capacities[c], need + 8, need, r.seed) == ASET_OK, SEED, r.seed);
            for (size_t room = 0; room < need; room += need / 24 / 8 * 8 + 8) {
                check(build_in(&m, capacities[c], room, need, r.seed) == ASET_ERR_NOMEM, SEED, r.seed);
            }
            check(build_in(&m, capacities[c], need - 8, need, r.seed) == ASET_ERR_NOMEM, SEED, r.seed);
        }
        model_free(&m);
    }
}

static void test_summary__refuses_bad_arguments(void **state) {
    (void)state;
    random_state r = random_start(seed_of(500));
    model m;
    stage s;
    aset_space space;
    aset_summary summary;
    size_t bytes;
    model_random(&m, &r, 10, 5, 0.3, 4);
    stage_open_model(&s, &m, ROOM);
    stage_space(&s, &space, &aset_mset, 2, 2, 2);
    size_t used = s.arena.used;
    assert_int_equal(aset_summary_build(NULL, &space, 1, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_build(&summary, NULL, 1, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_build(&summary, &space, 1, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_build(&summary, &space, ASET_TEXTURES_MAX + 1, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_measure(NULL, &space, 1, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_measure(&bytes, NULL, 1, &s.arena), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_measure(&bytes, &space, 1, NULL), ASET_ERR_ARGUMENT);
    assert_int_equal(aset_summary_measure(&bytes, &space, UINT32_MAX, &s.arena), ASET_ERR_ARGUMENT);
    aset_arena nothing;
    assert_int_equal(aset_arena_init(&nothing, NULL, 0), ASET_OK);
    assert_int_equal(aset_summary_measure(&bytes, &space, 1, &nothing), ASET_ERR_NOMEM);
    assert_int_equal(s.arena.used, used);
    stage_close(&s);
    model_free(&m);
}

static aset_status emit_nothing(const aset_sink *sink, const void *context) {
    (void)sink, (void)context;
    return ASET_OK;
}

static void test_summary__of_a_space_without_objects(void **state) {
    (void)state;
    stage s;
    aset_space space;
    aset_summary summary;
    stage_open(&s, emit_nothing, NULL, 4096);
    stage_space(&s, &space, &aset_mset, 2, 2, 2);
    assert_int_equal(aset_summary_build(&summary, &space, 0, &s.arena), ASET_OK);
    assert_int_equal(summary.n_textures, 0);
    assert_int_equal(summary.merged, 0);
    stage_close(&s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_summary__one_material_is_kept_as_it_is),
        cmocka_unit_test(test_summary__textures_are_equal_weight_averages),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_summary__every_object_has_the_same_weight),
#endif
        cmocka_unit_test(test_summary__order_of_objects_does_not_matter),
        cmocka_unit_test(test_summary__equal_textures_are_shared),
        cmocka_unit_test(test_summary__full_list_gives_the_nearest_and_counts_it),
        cmocka_unit_test(test_summary__nearest_by_every_part),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_summary__automatic_capacity),
#endif
        cmocka_unit_test(test_summary__takes_what_was_measured),
        cmocka_unit_test(test_summary__refuses_bad_arguments),
        cmocka_unit_test(test_summary__of_a_space_without_objects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_support__not_compiled)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#endif
