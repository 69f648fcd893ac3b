/*
 * answers.h - who answers a ray: the objects that a space refers to (exact.c), a summary's textures (approx/summary_query.c),
 * a draft's facets (approx/draft_query.c).
 *
 * What a program names brings its answers along: aset_space_build, aset_summary_build and aset_draft_open each leave a pointer
 * to their own, and the tracer asks through it. So a program that only draws drafts links no exact query, and an exact program
 * nothing of drafts.
 */
#ifndef ASET_SPACE_ANSWERS_H
#define ASET_SPACE_ANSWERS_H

#include "aset/trace.h"
#include "base/vec.h"

/* What a ray has met. */
typedef struct query_hit {
    aset_real t;
    aset_vec3 near;   /* where the ray was made to start, */
    aset_real t_near; /* and t from there: the hit's point with the least rounding */
    uint32_t object; /* exact; ASET_NO_OBJECT for a cell */
    uint32_t cell;   /* approximate: dense number */
    int face;        /* approximate: axis * 2, + 1 going down */
    bool curtailed;  /* approximate: the ray was trapped, and hit nothing */
    aset_real cover; /* the share of the ray that ends here: 1 unless a draft covers it in part */
    const aset_scene *scene; /* of the object; NULL for a cell */
    const struct aset_answers *by; /* who knows the rest */
} query_hit;

struct aset_answers {
    bool layered; /* meet may find more than one hit: those that cover a ray together */
    /*
     * What a ray of unit direction meets at 0 < t < t_max, in order, until it is covered; is_seen: nothing is between, it is an eye
     * ray or a caller's. How many: at most 1 unless layered. The first hit may be written to where there is none.
     */
    uint32_t (*meet)(query_hit *hits, const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max,
                     bool is_seen, aset_statistics *statistics);
    /*
     * Whether it meets anything at 0 < t < t_max. No cell that a draft has marked lies behind t_last, as far as the asker knows.
     */
    bool (*any)(const aset_tracer *tracer, aset_vec3 origin, aset_vec3 direction, aset_real t_max, aset_real t_last,
                aset_statistics *statistics);
    /* Normals and material of a hit, and its cell; own is where a material that is kept nowhere is put. */
    void (*surface)(aset_hit *surface, aset_material *own, const aset_tracer *tracer, const query_hit *hit);
    /* How far from a surface rays start that are answered here. NULL: the usual distance is enough. */
    aset_real (*clearance)(const aset_tracer *tracer);
};

extern const struct aset_answers aset_exact_answers;

/* Lengths of a hit from the scene's own to the caller's, where a tiny scene's t may have no number, but stays above 0. */
static inline void answers_to_caller(query_hit *hit, const aset_scene *scene) {
    aset_real per_scale = 1 / scene->scale;
    hit->t = real_max(hit->t * per_scale, REAL_DENORMAL);
    hit->t_near *= per_scale;
    hit->near = vec_scale(hit->near, per_scale);
}

/* The normal of a slice, towards the ray. */
static inline aset_vec3 answers_slice_normal(int face) {
    aset_real towards = (face & 1) != 0 ? R(1) : R(-1);
    int axis = face / 2;
    return vec(axis == 0 ? towards : 0, axis == 1 ? towards : 0, axis == 2 ? towards : 0);
}

#endif
