/*
 * draft_cover.h - how a ray's cover (draft_ray.h) grows: how much of the ray a footprint stops, and the layers that it meets.
 *
 * The tolerances, all in columns, were chosen on bunny, gears, mount and tetra (docs/drafts.md).
 */
#ifndef ASET_APPROX_DRAFT_COVER_H
#define ASET_APPROX_DRAFT_COVER_H

#include "approx/draft_ray.h"

#if ASET_WITH_DRAFTS

#define BEYOND_SIDES R(0.25)  /* a facet's plane is met so far beside its voxel, */
#define BEYOND_HEIGHT R(0.5)  /* and so far above or below it: neighbours' planes do not meet exactly */
#define SOFTNESS R(2)         /* how steeply cover falls across a footprint's edge, per column */
#define SOFT_BIAS R(0.2)      /* and how much more than half of it lies outside: closes the seams between footprints */
#define COVER_LEAST R(0.03)   /* less cover is none, */
#define COVER_MOST R(0.97)    /* more is all */

/* A voxel has a facet on each of its sides at most. */
#define DRAFT_FACETS_MAX 6

/* Where a ray meets one facet's plane, (u, v) in its voxel. How much of the ray it stops is told where that matters. */
typedef struct draft_meeting {
    aset_real t, u, v;
    uint32_t facet;
    uint16_t footprint;
    bool away; /* it faces away from the ray's origin */
} draft_meeting;

static inline draft_cover draft_cover_of(draft_layer *layers) {
    draft_cover c = {layers, 0, 1};
    return c;
}

/* Facets are met behind this t only. */
static inline aset_real draft_cover_end(const draft_cover *c) {
    return c->n > 0 ? c->layers[c->n - 1].t : 0;
}

/* The bit of column (i, j); the last columns also serve what is met beyond them. From before the first ones it is 0 already. */
static inline bool draft_bit_at(uint32_t footprint, int i, int j) {
    i = i < 3 ? i : 3;
    j = j < 3 ? j : 3;
    return (footprint >> (i + 4 * j) & 1u) != 0;
}

/* A footprint's row of four columns from column i to i + 1, i from -1 to 3: outside lies what lies at the end. Two bits. */
static inline unsigned draft_pair_in_row(uint32_t footprint, int row, int i) {
    uint32_t four = footprint >> 4 * row & 15u, six = four << 1 | (four & 1u) | (four & 8u) << 2;
    return six >> (i + 1) & 3u;
}

/* How much of a ray through (u, v) the footprint stops: its columns interpolated, so that edges are soft. */
static inline aset_real draft_soft_cover(uint32_t footprint, aset_real u, aset_real v) {
    if (footprint == 0xffffu) {
        return 1;
    }
    aset_real x = u - R(0.5), y = v - R(0.5);
    int i = (int)(x + 1) - 1, j = (int)(y + 1) - 1; /* floor: both are -1 to 3 */
    aset_real a = x - (aset_real)i, b = y - (aset_real)j;
    const aset_real of_pair[4] = {0, 1 - a, a, (1 - a) + a}; /* between two columns, of which none, one or both are covered */
    aset_real mean = (1 - b) * of_pair[draft_pair_in_row(footprint, j < 0 ? 0 : j, i)] +
                     b * of_pair[draft_pair_in_row(footprint, j < 3 ? j + 1 : 3, i)];
    aset_real cover = (mean - R(0.5)) * SOFTNESS + R(0.5) + SOFT_BIAS;
    return cover < COVER_LEAST ? 0 : cover > COVER_MOST ? 1 : cover;
}

/* Puts a meeting among the n found in a voxel, the nearest first. */
static inline void draft_meeting_insert(draft_meeting *found, uint32_t n, const draft_meeting *m) {
    for (; n > 0 && found[n - 1].t > m->t; n--) {
        found[n] = found[n - 1];
    }
    found[n] = *m;
}

static inline void draft_cover_add_layer(draft_cover *c, const draft_meeting *m, aset_real cover) {
    draft_layer *layer = c->layers + c->n++;
    layer->t = m->t;
    layer->facet = m->facet;
    layer->face = m->away;
    layer->cover = c->left * cover;
    c->left -= layer->cover;
    if (c->n == DRAFT_LAYERS_MAX || c->left < COVER_LEAST) {
        layer->cover += c->left;
        c->left = 0;
    }
}

/* Lays one meeting behind what is there. True: nothing behind matters any more. */
static inline bool aset_draft_cover_lay(draft_cover *c, const draft_meeting *m) {
    aset_real cover = draft_soft_cover(m->footprint, m->u, m->v);
    if (!(cover > 0)) {
        return false;
    }
    if (c->n > 0 && m->away) { /* the surface's inside: the ray came through a seam, not past an edge */
        c->layers[c->n - 1].cover += c->left;
        c->left = 0;
    } else {
        draft_cover_add_layer(c, m, cover);
    }
    return !(c->left > 0);
}

/* Lays what a voxel's facets gave, nearest first, behind what is there. True: nothing behind matters any more. */
bool aset_draft_cover_add(draft_cover *c, const draft_meeting *found, uint32_t n);

#endif
#endif
