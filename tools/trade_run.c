/*
 * trade_run.c - one measurement of one setting: space and summary built, picture drawn, in an arena of exactly the need.
 *
 * The scene stays loaded in an arena of its own. Allocations only add up, so the scene's bytes and the second arena's are
 * together those of the one arena that `aset render --memory` would need, not one more: they are the setting's peak. The
 * block is the same for all settings and was written to before, so that no setting pays for fresh pages.
 */
#include "metrics.h"
#include "trade.h"

#include <stdlib.h>
#include <string.h>

static uint64_t microseconds_since(double start) {
    double us = 1e6 * (tool_seconds() - start);
    return us > 1.0 ? (uint64_t)(us + 0.5) : 1; /* 0 means not measured */
}

static aset_status build(const trade_setting *s, aset_arena *arena, aset_space *space, aset_summary *summary,
                         aset_scratch *scratch) {
    const aset_scene *scene = &s->group->scene->loaded.scene;
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, s->grid, sizeof options.divisions);
    options.depth = s->tree_depth;
    aset_status status = aset_scratch_init(scratch, ASET_DEPTH_DEFAULT, arena);
    if (status == ASET_OK) {
        status = aset_space_build(space, scene, s->method, &options, arena);
    }
    if (status == ASET_OK && s->approx != TRADE_EXACT) {
        status = aset_summary_build(summary, space, aset_summary_capacity(scene), arena);
    }
    return status;
}

static aset_status render(const trade_setting *s, const aset_space *space, const aset_summary *summary,
                          aset_scratch *scratch, uint8_t *pixels, aset_statistics *statistics) {
    const trade_group *group = s->group;
    const trade_approx *approx = &trade_approxes[s->approx];
    aset_tracer tracer;
    aset_picture picture;
    aset_view view = group->scene->loaded.scene.view;
    memset(&tracer, 0, sizeof tracer);
    memset(&picture, 0, sizeof picture);
    tracer.scene = &group->scene->loaded.scene;
    tracer.space = space;
    tracer.summary = s->approx != TRADE_EXACT ? summary : NULL;
    tracer.approx_kinds = approx->mask;
    tracer.approx_depth = approx->level;
    tracer.curtail = (aset_real)s->curtail;
    view.width_px = picture.width = group->width;
    view.height_px = picture.height = group->height;
    picture.format = ASET_RGB888;
    picture.pixels = pixels;
    picture.stride = (size_t)group->width * 3;
    return aset_render_rows(&tracer, &view, &picture, 0, group->height, scratch, statistics);
}

bool trade_draw(const trade *t, const trade_setting *s, uint8_t *pixels, trade_figures *figures, uint64_t *build_us,
                uint64_t *render_us) {
    aset_arena arena;
    aset_space space;
    aset_summary summary;
    aset_scratch scratch;
    aset_statistics n;
    memset(&n, 0, sizeof n);
    double start = tool_seconds();
    aset_status status = aset_arena_init(&arena, t->block, s->need);
    if (status == ASET_OK) {
        status = build(s, &arena, &space, &summary, &scratch);
    }
    *build_us = microseconds_since(start);
    start = tool_seconds();
    if (status == ASET_OK) {
        status = render(s, &space, &summary, &scratch, pixels, &n);
    }
    *render_us = microseconds_since(start);
    if (status != ASET_OK) {
        tool_error(s->group->scene->name, 0, "trade: %s: %s", s->key, aset_status_text(status));
        return false;
    }
    memset(figures, 0, sizeof *figures);
    figures->rays = n.primary + n.shadow + n.reflected + n.refracted;
    figures->tests = n.tests;
    figures->cells = n.cells_visited;
    figures->peak = s->group->scene->loaded.scene_bytes + s->need;
    return true;
}

static uint8_t *take_pixels(const trade_group *group) {
    uint8_t *pixels = malloc((size_t)group->width * group->height * 3);
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
    metrics_difference d = metrics_differ(group->exact, pixels, group->width, group->height);
    figures->psnr = as_written(metrics_psnr(&d));
    figures->rmse = as_written(metrics_rmse(&d));
    figures->ssim = as_written(metrics_ssim(group->exact, pixels, group->width, group->height));
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
