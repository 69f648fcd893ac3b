/*
 * trade_run.c - one measurement of one setting: space and summary or draft built, picture drawn, in an arena of exactly the
 * need.
 *
 * The scene stays loaded in an arena of its own. Allocations only add up, so the scene's bytes and the second arena's are
 * together those of the one arena that `aset render --memory` would need, not one more: they are the setting's peak. What
 * is streamed, a draft or flat cells, has no scene in its arena, and none counted. The block is the same for all settings and was written to
 * before, so that no setting pays for fresh pages.
 *
 * A draft's need is found by trying: the baker goes by the room that it has, and takes more passes over the source where
 * that is less. It takes the same steps each time in an arena of the same size, so what was enough once is enough always.
 */
#include "metrics.h"
#include "trade.h"

#include <stdlib.h>
#include <string.h>

static uint64_t microseconds_since(double start) {
    double us = 1e6 * (tool_seconds() - start);
    return us > 1.0 ? (uint64_t)(us + 0.5) : 1; /* 0 means not measured */
}

/* What a picture is drawn from, all of it in the arena. */
typedef struct drawing {
    aset_arena arena;
    aset_scratch scratch;
    aset_space space;
    aset_summary summary;
    aset_draft draft;
    aset_scene stage; /* of flat cells that are streamed */
    double reading_s; /* of the source, while baking or streaming */
    bool told;        /* the source has failed and said so */
} drawing;

bool trade_is_streamed(const trade_setting *s) {
    return tool_streams(s->method, s->rays->mask, s->rays->level);
}

uint64_t trade_peak(const trade_setting *s) {
    return s->need + (trade_is_streamed(s) ? 0 : s->group->scene->loaded.scene_bytes);
}

/* One reading into the baker. */
static aset_status bake_pass(drawing *d, tool_source *source, aset_baker *baker, bool *again) {
    tool_batch batch;
    aset_sink sink = tool_batch_sink(&batch, NULL, baker);
    double start = tool_seconds();
    d->told = !tool_source_read(source, &sink);
    aset_status status = d->told ? ASET_ERR_READ : tool_batch_end(&batch);
    d->reading_s += tool_seconds() - start - batch.seconds;
    return status == ASET_OK ? aset_baker_pass(baker, again) : status;
}

static aset_status bake(const trade_setting *s, drawing *d) {
    const trade_group *group = s->group;
    tool_source *source = &group->scene->source;
    aset_baker baker;
    aset_bake_options options;
    bool again = true;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, s->grid, sizeof options.divisions);
    source->stage.aspect = (aset_real)group->width / (aset_real)group->height;
    aset_status status = aset_baker_init(&baker, &d->arena, &options);
    while (status == ASET_OK && again) {
        status = bake_pass(d, source, &baker, &again);
    }
    status = status == ASET_OK ? aset_baker_finish(&d->draft, &baker) : status;
    aset_baker_abandon(&baker);
    return status;
}

static aset_status flatten(const trade_setting *s, drawing *d, const aset_space_options *options) {
    trade_scene *scene = s->group->scene;
    tool_flat flat;
    flat.stage = &d->stage;
    flat.space = &d->space;
    flat.summary = &d->summary;
    scene->source.stage.aspect = (aset_real)s->group->width / (aset_real)s->group->height;
    aset_status status = tool_flatten(&flat, &scene->source, &scene->loaded.counter, s->method, options, &d->arena);
    d->reading_s += flat.load_s;
    d->told = flat.told;
    return status;
}

/* In the order of `aset render`. d is all zeros but for the arena. */
static aset_status build(const trade *t, const trade_setting *s, drawing *d) {
    const aset_scene *scene = &s->group->scene->loaded.scene;
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, s->grid, sizeof options.divisions);
    options.depth = s->tree_depth;
    options.leaf = t->drawn.leaf;
    aset_status status = aset_scratch_init(&d->scratch, t->drawn.depth, &d->arena);
    if (status == ASET_OK && trade_is_streamed(s) && s->cells == CELLS_FLAT) {
        return flatten(s, d, &options);
    }
    if (status == ASET_OK && !trade_is_streamed(s)) {
        status = aset_space_build(&d->space, scene, s->method, &options, &d->arena);
    }
    if (status == ASET_OK && s->cells != CELLS_FLAT) {
        status = bake(s, d);
    } else if (status == ASET_OK && s->approx != TRADE_EXACT) {
        status = aset_summary_build(&d->summary, &d->space, aset_summary_capacity(scene), &d->arena);
    }
    return status;
}

static aset_status render(const trade *t, const trade_setting *s, drawing *d, uint8_t *pixels, aset_statistics *statistics) {
    const trade_group *group = s->group;
    bool is_drafted = s->cells != CELLS_FLAT, is_streamed = trade_is_streamed(s);
    const aset_scene *stage = is_drafted ? &d->draft.stage : &d->stage;
    aset_tracer tracer;
    aset_picture picture;
    aset_view view = is_streamed ? stage->view : group->view;
    memset(&tracer, 0, sizeof tracer);
    memset(&picture, 0, sizeof picture);
    tracer.scene = is_streamed ? stage : &group->scene->loaded.scene;
    tracer.space = is_streamed && is_drafted ? NULL : &d->space;
    tracer.summary = s->approx != TRADE_EXACT && !is_drafted ? &d->summary : NULL;
    tracer.draft = is_drafted ? &d->draft : NULL;
    tracer.draft_sides = s->cells == CELLS_NORMAL;
    tracer.approx_kinds = s->rays->mask;
    tracer.approx_depth = s->rays->level;
    tracer.curtail = (aset_real)s->curtail;
    tracer.curtail_more = t->drawn.curtail_more;
    tracer.depth = t->drawn.depth;
    tracer.samples = t->drawn.samples;
    tracer.spd_rules = t->drawn.spd_rules;
    view.width_px = picture.width = group->width;
    view.height_px = picture.height = group->height;
    picture.format = ASET_RGB888;
    picture.pixels = pixels;
    picture.stride = (size_t)group->columns * 3;
    return aset_render_rows(&tracer, &view, &picture, 0, group->rows, &d->scratch, statistics);
}

/* A draft's need is the least that will do, but for this share of it: each halving of that costs one more bake. */
#define NEED_SHARE 32u

/* False if it is another error than too little memory, of which *size is then enough for one more try. */
static bool try_need(const trade *t, trade_setting *s, size_t *size, bool *found) {
    drawing d;
    memset(&d, 0, sizeof d);
    void *block = malloc(*size);
    aset_status status = block != NULL ? aset_arena_init(&d.arena, block, *size) : ASET_ERR_NOMEM;
    status = status == ASET_OK ? build(t, s, &d) : status;
    free(block);
    *found = status == ASET_OK;
    s->need = *found ? d.arena.peak : s->need;
    *size += d.arena.missing;
    if (block == NULL || (status != ASET_OK && status != ASET_ERR_NOMEM && !d.told)) {
        tool_error(s->group->scene->name, 0, "trade: a draft: %s", aset_status_text(status));
    }
    return block != NULL && (status == ASET_OK || status == ASET_ERR_NOMEM);
}

bool trade_find_need(const trade *t, trade_setting *s) {
    size_t size =
        s->need + 4 * ASET_BYTES_BAKE(s->grid[0], s->grid[1], s->grid[2]) + 65536u; /* two doublings, and a stage */
    bool found = false, fine = true;
    size_t low = s->need;
    while (fine && !found) {
        fine = try_need(t, s, &size, &found);
    }
    while (fine && s->need > low + s->need / NEED_SHARE) {
        size_t middle = low + (s->need - low) / 2, more = middle;
        fine = try_need(t, s, &more, &found);
        low = found ? low : middle;
    }
    return fine;
}

bool trade_draw(const trade *t, const trade_setting *s, uint8_t *pixels, trade_figures *figures, uint64_t *build_us,
                uint64_t *render_us) {
    drawing d;
    aset_statistics n;
    memset(&d, 0, sizeof d);
    memset(&n, 0, sizeof n);
    double start = tool_seconds();
    aset_status status = aset_arena_init(&d.arena, t->block, s->need);
    if (status == ASET_OK) {
        status = build(t, s, &d);
    }
    *build_us = microseconds_since(start + d.reading_s);
    start = tool_seconds();
    if (status == ASET_OK) {
        status = render(t, s, &d, pixels, &n);
    }
    *render_us = microseconds_since(start);
    if (d.told) {
        return false;
    }
    if (status != ASET_OK) {
        tool_error(s->group->scene->name, 0, "trade: %s: %s", s->key, aset_status_text(status));
        return false;
    }
    memset(figures, 0, sizeof *figures);
    figures->rays = n.primary + n.shadow + n.reflected + n.refracted;
    figures->tests = n.tests;
    figures->cells = n.cells_visited;
    figures->peak = trade_peak(s);
    return true;
}

static uint8_t *take_pixels(const trade_group *group) {
    uint8_t *pixels = malloc((size_t)group->columns * group->rows * 3);
    if (pixels == NULL) {
        tool_error(group->scene->name, 0, "no memory for a picture");
    }
    return pixels;
}

/* The group's exact picture, by its first exact setting: all exact methods draw the same. */
static bool draw_exact(const trade *t, trade_group *group) {
    trade_figures figures;
    uint64_t build_us, render_us;
    const trade_setting *exact = t->settings;
    if (group->exact != NULL) {
        return true;
    }
    while (exact->group != group || exact->approx != TRADE_EXACT) {
        exact++; /* every group has one */
    }
    group->exact = take_pixels(group);
    return group->exact != NULL && trade_draw(t, exact, group->exact, &figures, &build_us, &render_us);
}

/* Nine digits are what the CSV holds: the value as it will be read back there. */
static double as_written(double value) {
    char text[40];
    (void)snprintf(text, sizeof text, "%.9g", value);
    return strtod(text, NULL);
}

static void find_error(const trade_group *group, const uint8_t *pixels, trade_figures *figures) {
    metrics_difference d = metrics_differ(group->exact, pixels, group->columns, group->rows);
    figures->psnr = as_written(metrics_psnr(&d));
    figures->rmse = as_written(metrics_rmse(&d));
    figures->ssim = as_written(metrics_ssim(group->exact, pixels, group->columns, group->rows));
    figures->max_difference = d.max_difference;
    figures->differing = as_written((double)d.n_differing / (double)d.n_pixels);
}

bool trade_measure(trade *t, trade_setting *s, uint32_t round) {
    trade_figures figures;
    uint8_t *pixels = take_pixels(s->group);
    bool done = pixels != NULL && (s->has_figures || draw_exact(t, s->group)) &&
                trade_draw(t, s, pixels, &figures, &s->build[round], &s->render[round]);
    if (done && !s->has_figures) {
        find_error(s->group, pixels, &figures);
        s->figures = figures;
        s->has_figures = true;
    } else if (done && (figures.rays != s->figures.rays || figures.tests != s->figures.tests ||
                        figures.cells != s->figures.cells || figures.peak != s->figures.peak)) {
        tool_error(
            s->group->scene->name, 0,
            "trade: %s: counts other than in the rounds before; was trade.csv.partial made by another build? expected "
            "it to be removed",
            s->key);
        done = false;
    }
    free(pixels);
    return done;
}
