/*
 * tables_measure.c - draws the pictures of a row of `aset tables` and counts.
 *
 * Invariant: counts depend on the side of the picture alone. Times are of the processor, not of the clock, as the machine
 * may be shared; a round draws each timed picture once, in turn, so that what slows the machine slows all of them.
 */
#include "tables.h"

#include "tool.h"

#include "aset/procedural.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

/* The need is found in an arena of the scene's bytes and these: snow's slices at 100 divisions take 112 kB. */
#define GENEROUS (8u << 20)

enum { ALL_RAYS, PRIMARY_RAYS, DEEPER_RAYS };

typedef struct drawing {
    int rays;
    bool is_aset, one_light, narrow, curtail_more;
    double curtail;
} drawing;

static const drawing drawings[N_DRAWN] = {
    [DRAWN_PRIMARY] = {.rays = PRIMARY_RAYS},
    [DRAWN_MSET] = {.rays = ALL_RAYS},
    [DRAWN_ASET] = {.is_aset = true, .curtail = 0.5},
    [DRAWN_OFF] = {.is_aset = true},
    [DRAWN_LESS_025] = {.is_aset = true, .curtail = 0.25},
    [DRAWN_LESS_1] = {.is_aset = true, .curtail = 1},
    [DRAWN_MORE_05] = {.is_aset = true, .curtail = 0.5, .curtail_more = true},
    [DRAWN_ONE_LIGHT] = {.one_light = true},
    [DRAWN_ONE_LIGHT_PRIMARY] = {.rays = PRIMARY_RAYS, .one_light = true},
    [DRAWN_NARROW] = {.narrow = true},
    [DRAWN_DEEPER] = {.rays = DEEPER_RAYS},
    [DRAWN_DEEPER_OFF] = {.rays = DEEPER_RAYS, .is_aset = true},
};

static uint32_t depth_of(const drawing *what, uint32_t depth) {
    return what->rays == PRIMARY_RAYS ? 1u : what->rays == DEEPER_RAYS ? depth + DEEPER : depth;
}

/* What a picture is drawn from, in a block of its own. */
typedef struct built {
    void *block;
    aset_arena arena;
    aset_scene scene;
    aset_space space;
    aset_summary summary;
    aset_scratch scratch;
    double build_s;
} built;

static double processor_s(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

/* All of it in the first size bytes of the block. */
static aset_status build_within(built *b, size_t size, const published_row *row, const aset_procedural *source,
                                const aset_counts *counts, uint32_t depth, bool is_aset) {
    const aset_space_options options = {.divisions = {row->divisions, row->divisions, row->divisions}};
    aset_status status = aset_arena_init(&b->arena, b->block, size);
    if (status == ASET_OK) {
        status = aset_scene_init(&b->scene, &b->arena, counts);
    }
    if (status == ASET_OK) {
        aset_sink sink = aset_scene_sink(&b->scene);
        status = source->emit(&sink, row->size);
    }
    double start = processor_s();
    if (status == ASET_OK) {
        status = aset_scratch_init(&b->scratch, depth, &b->arena);
    }
    if (status == ASET_OK) {
        status = aset_space_build(&b->space, &b->scene, &aset_mset, &options, &b->arena);
    }
    if (status == ASET_OK && is_aset) {
        status = aset_summary_build(&b->summary, &b->space, 0, &b->arena);
    }
    b->build_s = processor_s() - start;
    return status;
}

static aset_status draw(const built *b, const drawing *what, uint32_t depth, uint32_t side, uint8_t *line,
                        aset_statistics *counts) {
    aset_scene scene = b->scene;
    aset_view view = scene.view;
    aset_scratch scratch = b->scratch;
    if (what->one_light && scene.counts.lights > 1) {
        scene.counts.lights = 1; /* colours are not looked at here, so the light may stay as weak as it was among others */
    }
    view.angle_deg = what->narrow ? view.angle_deg / 2 : view.angle_deg;
    const aset_tracer tracer = {.scene = &scene,
                                .space = &b->space,
                                .summary = what->is_aset ? &b->summary : NULL,
                                .approx_kinds = what->is_aset ? ASET_ALL_KINDS : 0,
                                .approx_depth = 1,
                                .curtail = (aset_real)what->curtail,
                                .curtail_more = what->curtail_more,
                                .depth = depth};
    const aset_picture picture = {.width = side, .height = side, .pixels = line};
    memset(counts, 0, sizeof *counts);
    return aset_render_rows(&tracer, &view, &picture, 0, side, &scratch, counts);
}

/* What row_measure needs for its pictures. */
typedef struct studio {
    const published_row *published;
    const aset_procedural *source;
    aset_counts counts;
    size_t need[2];
    built built[2];
    uint32_t side;
    uint8_t *line;
    uint64_t *done;
} studio;

static bool tell(const studio *s, aset_status status) {
    if (status != ASET_OK) {
        tool_error(s->published->scene, 0, "%s", aset_status_text(status));
    }
    return status == ASET_OK;
}

static void studio_close(studio *s) {
    free(s->built[BY_MSET].block);
    free(s->built[BY_ASET].block);
    free(s->line);
}

static bool studio_open(studio *s) {
    aset_counter counter;
    s->source = aset_procedural_find(s->published->scene);
    if (s->source == NULL) {
        tool_error(NULL, 0, "tables: there is no scene %s", s->published->scene);
        return false;
    }
    aset_sink sink = aset_counter_sink(&counter);
    if (!tell(s, s->source->emit(&sink, s->published->size))) {
        return false;
    }
    s->counts = counter.counts;
    const aset_counts *c = &s->counts;
    size_t size = ASET_BYTES_SCENE(c->objects, c->coordinates, c->materials, c->lights) + GENEROUS;
    s->line = malloc((size_t)s->side * 3u);
    s->built[BY_MSET].block = malloc(size);
    s->built[BY_ASET].block = malloc(size);
    if (s->line == NULL || s->built[BY_MSET].block == NULL || s->built[BY_ASET].block == NULL) {
        tool_error(s->published->scene, 0, "the machine has no memory for two blocks of %zu bytes", size);
        return false;
    }
    for (int by = BY_MSET; by <= BY_ASET; by++) {
        if (!tell(s, build_within(&s->built[by], size, s->published, s->source, &s->counts, s->published->depth,
                                  by == BY_ASET))) {
            return false;
        }
        s->need[by] = s->built[by].arena.peak;
    }
    return true;
}

/* One picture of a scene built anew. */
static bool shoot(studio *s, int drawn, aset_statistics *counts, double *picture_s, double *build_s) {
    const drawing *what = &drawings[drawn];
    int by = what->is_aset ? BY_ASET : BY_MSET;
    built *b = &s->built[by];
    uint32_t depth = depth_of(what, s->published->depth);
    size_t size = s->need[by] - ASET_BYTES_SCRATCH(s->published->depth) + ASET_BYTES_SCRATCH(depth);
    if (!tell(s, build_within(b, size, s->published, s->source, &s->counts, depth, what->is_aset))) {
        return false;
    }
    double start = processor_s();
    if (!tell(s, draw(b, what, depth, s->side, s->line, counts))) {
        return false;
    }
    *picture_s = processor_s() - start;
    *build_s = b->build_s;
    tool_progress_step(++*s->done);
    return true;
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Sorts them. */
static double median(double *values, uint32_t n) {
    qsort(values, n, sizeof *values, ascending);
    return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

typedef struct timings {
    double picture_s[N_TIMED][ROUNDS_MAX], build_s[N_TIMED][ROUNDS_MAX];
} timings;

static double total_s(const timings *all, int k, uint32_t i) {
    return all->picture_s[k][i] + all->build_s[k][i];
}

/* Fills sorted with a picture's total by MSET's, round for round; the median. */
static double ratio_to_mset(double sorted[ROUNDS_MAX], const timings *all, int k, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        sorted[i] = quotient(total_s(all, k, i), total_s(all, DRAWN_MSET, i));
    }
    return median(sorted, n);
}

/* Ratios and differences are taken within a round, then their medians. */
static void evaluate(table_row *row, timings *all) {
    double sorted[ROUNDS_MAX];
    uint32_t n = row->rounds;
    row->off_ratio = ratio_to_mset(sorted, all, DRAWN_OFF, n);
    row->time_ratio = ratio_to_mset(sorted, all, DRAWN_ASET, n);
    row->time_low = sorted[0];
    row->time_high = sorted[n - 1];
    for (uint32_t i = 0; i < n; i++) {
        sorted[i] = quotient(all->picture_s[DRAWN_PRIMARY][i], all->picture_s[DRAWN_MSET][i]);
    }
    row->primary_share = median(sorted, n);
    for (int by = BY_MSET; by <= BY_ASET; by++) {
        int k = by == BY_MSET ? DRAWN_MSET : DRAWN_ASET;
        for (uint32_t i = 0; i < n; i++) {
            sorted[i] = all->picture_s[k][i] - all->picture_s[DRAWN_PRIMARY][i];
        }
        row->secondary_s[by] = median(sorted, n);
    }
    /* these sort the rounds themselves, and so come last */
    row->mset_s = median(all->picture_s[DRAWN_MSET], n);
    row->build_s[BY_MSET] = median(all->build_s[DRAWN_MSET], n);
    row->build_s[BY_ASET] = median(all->build_s[DRAWN_ASET], n);
}

static bool time_rounds(studio *s, table_row *row) {
    timings all;
    for (uint32_t i = 0; i < row->rounds; i++) {
        for (int k = 0; k < N_TIMED; k++) {
            aset_statistics counts;
            if (!shoot(s, k, &counts, &all.picture_s[k][i], &all.build_s[k][i])) {
                return false;
            }
            if (memcmp(&counts, &row->counts[k], sizeof counts) != 0) {
                tool_error(s->published->scene, 0, "round %u counts otherwise than the one before, expected the same",
                           (unsigned)i);
                return false;
            }
        }
    }
    if (row->rounds > 0) {
        evaluate(row, &all);
    }
    return true;
}

bool row_measure(table_row *row, const published_row *published, uint32_t side, uint32_t rounds, uint64_t *done) {
    studio s;
    memset(row, 0, sizeof *row);
    memset(&s, 0, sizeof s);
    row->published = s.published = published;
    row->rounds = rounds;
    s.side = side;
    s.done = done;
    bool fine = studio_open(&s);
    for (int k = 0; k < N_DRAWN && fine; k++) {
        double picture_s, build_s; /* the first of each is not timed */
        fine = shoot(&s, k, &row->counts[k], &picture_s, &build_s);
    }
    fine = fine && time_rounds(&s, row);
    row->structure = s.built[BY_MSET].space.structure;
    row->n_textures = s.built[BY_ASET].summary.n_textures;
    row->n_merged = s.built[BY_ASET].summary.merged;
    row->bytes[BY_MSET] = s.need[BY_MSET];
    row->bytes[BY_ASET] = s.need[BY_ASET];
    studio_close(&s);
    return fine;
}

/* --- what follows from the counts --- */

double quotient(double above, double below) {
    return below > 0.0 ? above / below : 0.0;
}

double rays_of(const aset_statistics *s) {
    return (double)(s->primary + s->shadow + s->reflected + s->refracted);
}

double hits_of(const aset_statistics *s) {
    return (double)(s->primary_hit + s->shadow_hit + s->secondary_hit + s->curtailed);
}

double attempts_of(const aset_statistics *s) {
    return (double)(s->tests + s->approx_hits + s->curtailed);
}

double row_density(const table_row *row) {
    return quotient((double)row->structure.references, (double)row->structure.nonempty);
}

double row_primary(const table_row *row) {
    return rays_of(&row->counts[DRAWN_PRIMARY]);
}

double row_secondary(const table_row *row, int drawn) {
    return rays_of(&row->counts[drawn]) - row_primary(row);
}

double row_secondary_tests(const table_row *row, int drawn) {
    double tests = (double)row->counts[drawn].tests - (double)row->counts[DRAWN_PRIMARY].tests;
    return quotient(tests, row_secondary(row, drawn));
}

double row_secondary_cells(const table_row *row, int drawn) {
    double cells = (double)row->counts[drawn].cells_visited - (double)row->counts[DRAWN_PRIMARY].cells_visited;
    return quotient(cells, row_secondary(row, drawn));
}

double row_secondary_rate(const table_row *row, int by) {
    return quotient(row_secondary(row, by == BY_MSET ? DRAWN_MSET : DRAWN_ASET), row->secondary_s[by]);
}
