/*
 * plan_draft.c - drafts as a plan tries them: by render's own steps, in the memory of the plan. Beams draw rows together, so that rays
 * one by one would not tell the time: the picture is drawn, or a smaller one if it is large.
 */
#include "plan_draft.h"

#include "need.h"
#include "plan_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pixels that are drawn at the most. */
#define PIXELS_MAX 262144.0

static settings settings_of(const plan_wish *wish, const plan_setting *s) {
    settings of = *wish->given;
    of.method = s->method;
    of.approx_kinds = s->approx_kinds;
    of.approx_depth = s->approx_depth;
    of.cells = s->cells;
    memcpy(of.grid, s->grid, sizeof of.grid);
    of.memory = s->bytes;
    of.width = wish->width;
    of.height = wish->height;
    of.depth = wish->depth;
    return of;
}

aset_status plan_draft_make(prepared *p, const measured *m, const plan_wish *wish, const plan_setting *s, bool *told) {
    settings of = settings_of(wish, s);
    return prepare_again(p, &of, wish->source, &m->counter, told);
}

double plan_draft_seconds(const prepared *p, const plan_wish *wish) {
    double all = (double)wish->width * wish->height, share = fmin(1, sqrt(PIXELS_MAX / all));
    aset_view view = p->view;
    aset_picture picture;
    aset_tracer tracer = p->tracer;
    memset(&picture, 0, sizeof picture);
    view.width_px = picture.width = (uint32_t)fmax(1, wish->width * share);
    view.height_px = picture.height = (uint32_t)fmax(1, wish->height * share);
    uint32_t columns = picture.width + tracer.spd_rules, rows = picture.height + tracer.spd_rules;
    picture.stride = (size_t)columns * 3;
    picture.pixels = malloc(picture.stride * rows);
    if (picture.pixels == NULL) {
        tool_error(p->path, 0, "plan: the machine has no memory for a probe");
        return -1;
    }
    double start = plan_cpu_seconds();
    (void)aset_render_rows(&tracer, &view, &picture, 0, rows, &p->scratches[0], NULL); /* what it takes was checked by prepare */
    double seconds = plan_cpu_seconds() - start;
    free(picture.pixels);
    return seconds * all / ((double)picture.width * picture.height);
}

size_t plan_draft_need(const measured *m, const plan_wish *wish, const plan_setting *s) {
    settings of = settings_of(wish, s);
    bool is_quick = tool_need_is_quick(m->counter.counts.objects, s->grid);
    return (size_t)(is_quick ? prepare_draft_need(&of, wish->source, &m->counter) : of.memory);
}
