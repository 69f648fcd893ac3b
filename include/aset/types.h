/*
 * types.h - numbers, statuses, and the words that every other header uses: vector, colour, material, light, view, ray,
 * hit, statistics.
 */
#ifndef ASET_TYPES_H
#define ASET_TYPES_H

#include "aset/config.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

ASET_HEADER_BEGIN

#if ASET_REAL_BITS == 32
typedef float aset_real;
#else
typedef double aset_real;
#endif

/* Private: what answers rays for a space, a summary or a draft. */
struct aset_answers;

/*
 * What a call says. 0 is success; everything else is negative and leaves the objects it was given as they were, but for what a
 * call begins with clearing: aset_baker_init its baker, aset_flat_init its flat.
 */
typedef enum aset_status {
    ASET_OK = 0,
    ASET_ERR_ARGUMENT = -1,    /* a pointer, count or option is outside what the declaration allows */
    ASET_ERR_NOMEM = -2,       /* the arena is too small; aset_arena.missing says by how many bytes */
    ASET_ERR_LIMIT = -3,       /* a count is beyond what the library can index */
    ASET_ERR_GEOMETRY = -4,    /* a coordinate is not finite, a polygon has under three points, a cone no length ... */
    ASET_ERR_UNSUPPORTED = -5, /* the feature was switched off when the library was compiled */
    ASET_ERR_STOPPED = -6,     /* a caller's callback asked to stop */
    ASET_ERR_READ = -7,        /* the caller's read callback failed */
    ASET_ERR_SYNTAX = -8,      /* the input is not in the format; the reader's report says where and why */
    ASET_ERR_ARITHMETIC = -9,  /* numbers are not rounded one by one, to nearest, with denormals: see aset_arena_init */
    ASET_ERR_PRECISION = -10   /* the scene lies so far from the origin that its coordinates hardly tell its parts apart */
} aset_status;

/* One sentence in English for a status, never NULL; static text. */
const char *aset_status_text(aset_status status);

typedef struct aset_vec3 {
    aset_real x, y, z;
} aset_vec3;

/* Linear red, green and blue; 0 is none and 1 the brightest a picture shows. */
typedef struct aset_colour {
    aset_real r, g, b;
} aset_colour;

/*
 * A surface (Whitted 1980, with Phong's highlight): the paper's "texture" has the same parts, averaged over a cell.
 */
typedef struct aset_material {
    aset_colour fill;   /* what the diffuse light is multiplied with */
    aset_real diffuse;  /* Kd, 0 or more */
    aset_real specular; /* Ks, 0 or more: highlight, and the share of the reflected ray */
    aset_real shine;    /* Phong's exponent, 0 or more */
#if ASET_WITH_REFRACTION
    aset_real transmittance;    /* T, 0 or more: the share of the refracted ray */
    aset_real refraction_index; /* of the inside against the outside; 0 means 1, no bending */
#endif
    bool one_sided; /* true: seen only from the side its normal points to */
} aset_material;

typedef struct aset_light {
    aset_vec3 position; /* a point; or, if directional, the direction towards the light (any length but 0) */
    aset_colour colour; /* intensity; ignored while has_colour is false */
    bool has_colour;    /* false: white of intensity 1 / sqrt(number of lights without a colour of their own), the SPD's rule */
    bool directional;
} aset_light;

typedef struct aset_view {
    aset_vec3 from, at, up;
    aset_real angle_deg; /* perspective: the full field of view across the picture's height, 0 < angle < 180 */
    aset_real height;    /* orthographic: the height of the picture in scene units, up to 10^30 (10^300 in double); 0: perspective */
    uint32_t width_px, height_px; /* the resolution that the scene asks for; 0: none */
} aset_view;

typedef struct aset_ray {
    aset_vec3 origin, direction; /* finite; the direction is not 0 and need not be of unit length. A quarter of the largest number
                                    is as far as an origin is told; and 2^78 times the scene's size */
    aset_real t_max; /* hits with 0 < t < t_max count, to the rounding of t; t in lengths of direction. INFINITY: no end */
} aset_ray;

/* Object number of a hit on a cell, which belongs to no object. */
#define ASET_NO_OBJECT UINT32_MAX

typedef struct aset_hit {
    aset_real t; /* in lengths of the ray's direction; may underflow to 0 where that is very long, overflow where very short */
    aset_vec3 point;
    aset_vec3 normal;    /* unit; the shading normal as the scene gives it (a patch's is interpolated), not turned */
    aset_vec3 geometric; /* unit; the surface's own normal, not turned; for a cell its slice's, towards the ray */
    uint32_t object;     /* number in the order of adding, or ASET_NO_OBJECT for a cell */
    uint32_t cell;       /* the dense number of the cell met; 0 for an object */
    const aset_material *material; /* the object's, or the cell's texture */
} aset_hit;

/* The kinds of rays, as bits of a mask (which kinds may be approximate). */
typedef enum aset_kind {
    ASET_PRIMARY = 1,
    ASET_SHADOW = 2,
    ASET_REFLECTED = 4,
    ASET_REFRACTED = 8,
    ASET_ALL_KINDS = 15
} aset_kind;

/*
 * Counts of what rays did. A call adds to them once per ray; nothing is global. All exact and the same for every run. All are
 * uint64_t, so that the core adds them up and reports them as an array, in this order.
 */
typedef struct aset_statistics {
    uint64_t primary, primary_hit;
    uint64_t shadow, shadow_hit;
    uint64_t reflected, refracted, secondary_hit;
    uint64_t curtailed;        /* approximate rays ended because they were trapped (the paper's footnote 8) */
    uint64_t cells_visited;    /* cells entered, empty ones included; by a ray at a draft's seam those of the rays beside it, too */
    uint64_t nonempty_visited; /* of these, with references (exact) or a texture (approximate) */
    uint64_t tests;            /* one object against one ray; a polygon of 144 vertices counts 1 */
    uint64_t test_hits;        /* of these, the ones that hit within the ray's bounds */
    uint64_t approx_hits;      /* rays that took a cell's texture */
} aset_statistics;

/* Adds every count of from to those of to: for statistics kept by several threads. */
void aset_statistics_add(aset_statistics *to, const aset_statistics *from);

ASET_HEADER_END
#endif
