/* shade.h - the light that leaves a hit surface by itself, and the rays that leave it. */
#ifndef ASET_TRACE_SHADE_H
#define ASET_TRACE_SHADE_H

#include "trace/light.h"
#include "trace/query.h"

/*
 * New rays start off the surface by nudge along its geometric normal. The point of a hit errs by a few units in the last
 * place of the numbers it is made of, |point| and t, so the nudge is SHADE_NUDGE of those: no length in scene units.
 */
#define SHADE_NUDGE (32 * REAL_UNIT)
/* Shadow rays need less of a draft's clearance: they ignore the voxel that they start in. */
#define SHADE_SHADOW_SHARE (R(1) / 3)

/*
 * Exact rays that leave a draft's facet need more: the surface lies beside it. Of 1, 2, 4 and 8 times twice gave the pictures closest to the exact
 * ones, of six scenes.
 */
#define SHADE_EXACT_SHARE R(2)

/* A hit, ready for shading. */
typedef struct shading {
    aset_hit hit;
    aset_vec3 direction; /* of the ray that came */
    aset_vec3 normal;    /* shading normal, on the side that is seen */
    aset_vec3 facing;    /* geometric normal, on the side that the ray came from */
    bool entering;       /* the ray came to the surface's front */
    aset_real nudge;     /* how far new rays start from the surface, */
    aset_real clearance; /* and how far at least those that a draft will answer; 0 without one */
    uint32_t known, dark; /* bits of lights, the first 32: whether something is before them has been told, and is so */
    aset_material own;   /* the material of a draft's facet */
} shading;

void aset_shading_make(shading *s, const aset_tracer *tracer, const query_hit *hit, aset_vec3 direction);

/* Whether rays of this kind and depth take the approximation: the one place that decides. */
bool aset_policy_approximate(const aset_tracer *tracer, aset_kind kind, uint32_t depth);

/* 0.1 fill + what the lights add; sends the shadow rays to lights that are not known. depth: of the ray that hit. */
aset_colour aset_shade_local(const aset_tracer *tracer, shading *s, uint32_t depth, aset_statistics *statistics);

/* A facet seven clearances behind another one, two columns, mostly is the same surface's: it is taken to lie in the same shadows. */
static inline bool shade_is_same(aset_real t_before, aset_real t, aset_real clearance) {
    return t - t_before < 7 * clearance;
}

static inline void shade_add(aset_colour *sum, aset_real weight, const aset_colour *colour) {
    sum->r += weight * colour->r;
    sum->g += weight * colour->g;
    sum->b += weight * colour->b;
}

/* The share of the fill that is there without light. */
static inline aset_colour shade_ambient(const aset_material *m) {
    aset_colour c = {R(0.1) * m->fill.r, R(0.1) * m->fill.g, R(0.1) * m->fill.b};
    return c;
}

/* Phong's. */
static inline aset_real shade_highlight(aset_real shine, aset_vec3 normal, aset_vec3 direction, aset_vec3 to_light, aset_real n_dot_l) {
    aset_vec3 mirrored = vec_sub(vec_scale(normal, 2 * n_dot_l), to_light);
    aset_real r_dot_v = -vec_dot(mirrored, direction);
    return r_dot_v > 0 ? aset_real_power(r_dot_v, shine) : 0;
}

/* Adds what a light sends on to a ray that came along direction; n_dot_l above 0. */
static inline void shade_add_light(aset_colour *sum, const aset_material *m, aset_vec3 normal, aset_vec3 direction, const light_ray *towards,
                          aset_real n_dot_l) {
    aset_real diffuse = m->diffuse * n_dot_l, specular = 0;
    if (m->specular > 0) {
        specular = m->specular * shade_highlight(m->shine, normal, direction, towards->direction, n_dot_l);
    }
    sum->r += (m->fill.r * diffuse + specular) * towards->colour.r;
    sum->g += (m->fill.g * diffuse + specular) * towards->colour.g;
    sum->b += (m->fill.b * diffuse + specular) * towards->colour.b;
}

/*
 * Where a ray that leaves the surface along direction starts, on the side it goes to. share: of the clearance, for a ray that the
 * approximation answers.
 */
aset_vec3 aset_shade_start(const shading *s, aset_vec3 direction, bool approximate, aset_real share);

aset_vec3 aset_shade_reflected(const shading *s);

#if ASET_WITH_REFRACTION
/* The refracted direction; false under total internal reflection. */
bool aset_shade_refracted(const shading *s, aset_vec3 *direction);
#endif

#endif
