/* shade.h - the light that leaves a hit surface by itself, and the rays that leave it. */
#ifndef ASET_TRACE_SHADE_H
#define ASET_TRACE_SHADE_H

#include "trace/query.h"

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

/* Where a ray that leaves the surface along direction starts: off the surface by clearance at least, on the side it goes to. */
aset_vec3 aset_shade_start(const shading *s, aset_vec3 direction, aset_real clearance);

aset_vec3 aset_shade_reflected(const shading *s);

#if ASET_WITH_REFRACTION
/* The refracted direction; false under total internal reflection. */
bool aset_shade_refracted(const shading *s, aset_vec3 *direction);
#endif

#endif
