/* draw.h - what the fuzzers of drafts and scenes draw, and what must hold of any picture. */
#ifndef ASET_TESTS_FUZZ_DRAW_H
#define ASET_TESTS_FUZZ_DRAW_H

#include "fuzz.h"

#include <math.h>

#define DRAW_PIXELS 8u
#define DRAW_DEPTH 4u

static inline aset_view view_of_box(const aset_vec3 *low, const aset_vec3 *high) {
    aset_view view;
    memset(&view, 0, sizeof view);
    view.at.x = low->x / 2 + high->x / 2;
    view.at.y = low->y / 2 + high->y / 2;
    view.at.z = low->z / 2 + high->z / 2;
    aset_real away = (high->x - low->x) + (high->y - low->y) + (high->z - low->z);
    view.from.x = view.at.x + away * (aset_real)0.7;
    view.from.y = view.at.y + away * (aset_real)0.9;
    view.from.z = view.at.z + away;
    view.up.y = 1;
    view.angle_deg = 50;
    return view;
}

#if ASET_WITH_DRAFTS
/* Once more in beams and with a reach: the same pixels. */
static inline void draw_aided(const aset_tracer *plain, const aset_view *view, aset_picture picture, const unsigned char *pixels) {
    enum { VOXELS = 100, TILES = 6, BYTES = DRAW_PIXELS * DRAW_PIXELS * 4 };
    uint32_t n_lights = plain->draft->stage.counts.lights;
    aset_arena arena = open_arena(ASET_BYTES_SCRATCH(DRAW_DEPTH) + ASET_BYTES_BEAMS(VOXELS) + ASET_BYTES_REACH(TILES, n_lights));
    aset_tracer tracer = *plain;
    aset_scratch scratch;
    aset_beams beams;
    aset_reach reach;
    unsigned char again[BYTES];
    require(aset_scratch_init(&scratch, DRAW_DEPTH, &arena) == ASET_OK && aset_beams_init(&beams, VOXELS, &arena) == ASET_OK);
    require(aset_reach_init(&reach, plain->draft, TILES, &arena) == ASET_OK);
    scratch.beams = &beams;
    tracer.reach = &reach;
    picture.pixels = again;
    require(aset_render_rows(&tracer, view, &picture, 0, DRAW_PIXELS, &scratch, NULL) == ASET_OK);
    require(memcmp(pixels, again, sizeof again) == 0);
    close_arena(&arena);
}
#endif

static inline void draw_view(const aset_tracer *tracer, const aset_view *view) {
    aset_arena arena = open_arena(ASET_BYTES_SCRATCH(DRAW_DEPTH));
    aset_scratch scratch;
    aset_statistics counts;
    aset_picture picture;
    unsigned char *pixels = malloc(DRAW_PIXELS * DRAW_PIXELS * 4);
    require(pixels != NULL && aset_scratch_init(&scratch, DRAW_DEPTH, &arena) == ASET_OK);
    memset(&counts, 0, sizeof counts);
    memset(&picture, 0, sizeof picture);
    picture.width = picture.height = DRAW_PIXELS;
    picture.format = ASET_RGBA8888;
    picture.transparent = true;
    picture.pixels = pixels;
    picture.stride = DRAW_PIXELS * 4;
    aset_status status = aset_render_rows(tracer, view, &picture, 0, DRAW_PIXELS, &scratch, &counts);
    require(status == ASET_OK || status == ASET_ERR_GEOMETRY || status == ASET_ERR_ARGUMENT);
    require(status != ASET_OK || counts.primary == DRAW_PIXELS * DRAW_PIXELS);
    require(counts.primary_hit <= counts.primary && counts.shadow_hit <= counts.shadow);
#if ASET_WITH_DRAFTS
    if (tracer->draft != NULL && status == ASET_OK) {
        draw_aided(tracer, view, picture, pixels);
    }
#endif
    free(pixels);
    close_arena(&arena);
}

static inline bool finite_vec(aset_vec3 v) {
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

/* Without rounding and overflow in the way: a ray in between may be refused or not. */
static inline bool usable_ray(const aset_ray *ray) {
    aset_vec3 d = ray->direction;
    double length = sqrt((double)d.x * (double)d.x + (double)d.y * (double)d.y + (double)d.z * (double)d.z);
    return finite_vec(ray->origin) && length > 1e-37 && length < 1e37 && ray->t_max == ray->t_max;
}

static inline bool broken_ray(const aset_ray *ray) {
    aset_vec3 d = ray->direction;
    bool none = d.x == 0 && d.y == 0 && d.z == 0;
    return none || !finite_vec(ray->origin) || !finite_vec(d) || ray->t_max != ray->t_max;
}

static inline void check_answer(aset_status status, const aset_ray *ray) {
    require(status == ASET_OK || (status == ASET_ERR_ARGUMENT && !usable_ray(ray)));
    require(status != ASET_OK || !broken_ray(ray));
}

/* t is a distance by the direction's length, so along a direction longer than 1 it may come out as 0. */
static inline void check_hit(const aset_tracer *tracer, const aset_hit *hit, const aset_ray *ray) {
    aset_vec3 d = ray->direction;
    bool is_long = fabs((double)d.x) + fabs((double)d.y) + fabs((double)d.z) > 1;
    if (!(hit->t > 0 || (hit->t == 0 && is_long))) {
        fprintf(stderr, "t %g, object %u, from %g %g %g along %g %g %g\n", (double)hit->t, (unsigned)hit->object,
                (double)ray->origin.x, (double)ray->origin.y, (double)ray->origin.z, (double)d.x, (double)d.y, (double)d.z);
    }
    require(hit->t > 0 || (hit->t == 0 && is_long));
    require(hit->object == ASET_NO_OBJECT || hit->object < tracer->scene->counts.objects);
}

#if ASET_WITH_DRAFTS

/* Rays from the corners of a cube around the draft's box and from its middle, in fixed directions. */
static inline void shoot_draft(const aset_tracer *tracer, const aset_draft *d, uint32_t choice) {
    for (uint32_t i = 0; i < 16; i++) {
        if (!chosen(choice, 2, i % 2)) {
            continue;
        }
        aset_ray ray;
        aset_hit hit;
        bool found = false, any = false;
        memset(&hit, 0, sizeof hit);
        aset_real from[3], along[3];
        for (int a = 0; a < 3; a++) {
            aset_real size = d->size[a] * 4 * (aset_real)d->n[a];
            aset_real side = (i >> a & 1u) != 0 ? (aset_real)1.25 : (aset_real)-0.25;
            from[a] = d->low[a] + size * (i >= 8 ? (aset_real)0.5 : side);
            along[a] = size * (side > 0 ? -1 : 1) * ((uint32_t)a == i % 4 ? 0 : 1);
        }
        ray.origin.x = from[0], ray.origin.y = from[1], ray.origin.z = from[2];
        ray.direction.x = along[0], ray.direction.y = along[1], ray.direction.z = along[2];
        ray.t_max = i % 3 == 0 ? 1 : (aset_real)INFINITY;
        aset_status status = aset_closest_hit(&found, &hit, tracer, &ray, true, NULL);
        require(aset_any_hit(&any, tracer, &ray, true, NULL) == status);
        check_answer(status, &ray);
        if (found && hit.object == ASET_NO_OBJECT) {
            require(hit.cell < d->n_facets);
            (void)aset_draft_texture(d, hit.cell);
        }
    }
}

static inline void draw_draft(const aset_draft *draft, uint32_t choice) {
    aset_vec3 low = {draft->low[0], draft->low[1], draft->low[2]}, high = low;
    high.x += draft->size[0] * 4 * (aset_real)draft->n[0];
    high.y += draft->size[1] * 4 * (aset_real)draft->n[1];
    high.z += draft->size[2] * 4 * (aset_real)draft->n[2];
    aset_view view = view_of_box(&low, &high);
    aset_tracer tracer;
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &draft->stage;
    tracer.draft = draft;
    tracer.approx_kinds = ASET_ALL_KINDS;
    tracer.depth = DRAW_DEPTH;
    for (uint32_t sides = 0; sides < 2; sides++) {
        if (!chosen(choice, 2, sides)) {
            continue;
        }
        tracer.draft_sides = sides == 1;
        if (!draft->stage.has_view || chosen(choice / 2, 2, 0)) {
            draw_view(&tracer, &view);
        }
        if (draft->stage.has_view && chosen(choice / 2, 2, 1)) {
            draw_view(&tracer, &draft->stage.view);
        }
        shoot_draft(&tracer, draft, choice / 4);
    }
}

#endif
#endif
