/*
 * trace.h - what a ray sees: queries of single rays, colours by Whitted's model, rows of a picture.
 *
 * A tracer is your choice of scene, space, summary and rules; nothing in it is written to, so that any number of threads may
 * use one. What a thread writes it brings along: a scratch (the stack of rays) and statistics.
 */
#ifndef ASET_TRACE_H
#define ASET_TRACE_H

#include "aset/beams.h"
#include "aset/reach.h"
#include "aset/summary.h"

ASET_HEADER_BEGIN

/* Fill it with zeros, then set what you need; a field at 0 means what its comment says. */
typedef struct aset_tracer {
    const aset_scene *scene; /* finished */
    const aset_space *space; /* built over it */
#if ASET_WITH_APPROXIMATION
    const aset_summary *summary; /* of that space; with neither this nor a draft every ray is exact, whatever follows */
#if ASET_WITH_DRAFTS
    const aset_draft *draft; /* not NULL: approximate rays meet this and not the summary. If all kinds are approximate from
                                depth 0, scene may be &draft->stage and space NULL */
    const aset_reach *reach; /* of that draft: shadow rays end sooner. NULL: none */
    bool draft_sides;        /* a voxel's own side is the hit, with its facet's normal, instead of the facet's plane */
#endif
    uint32_t approx_kinds; /* which kinds of rays may be approximate: a mask of aset_kind */
    uint32_t approx_depth; /* rays of this depth and deeper are approximate; the eye ray has depth 0, its reflected ray 1,
                              a shadow ray the depth of the ray whose hit it lights. 1 is the paper's setting */
    /*
     * Trapped rays (the paper's footnote 8; of a summary's cells, not a draft's): an approximate ray that meets a cell after less
     * than this fraction of a voxel's diagonal is ended; it returns the background, a shadow ray counts as lit. 0, or less, or not a number: never; INFINITY:
     * always. curtail_more turns the test around, to the letter of the footnote.
     */
    aset_real curtail;
    bool curtail_more;
#endif
    uint32_t depth;   /* rays in a chain, the eye ray being 1; 0 means 5 */
    uint32_t samples; /* n for n x n rays a pixel, up to 64; 0 means 1: one ray through the pixel's centre */
    bool spd_rules;   /* the SPD testing procedure (Haines 1987): rays through pixel corners, so a picture of w x h has
                         (w + 1) x (h + 1) of them, and a reflected ray from every reflecting or transmitting surface */
} aset_tracer;

#define ASET_DEPTH_DEFAULT 5u
#define ASET_DEPTH_MAX 1000u

/*
 * The nearest hit of a ray: exact (on an object), or approximate (on the first cell with a texture that is met at t > 0; with a
 * draft on what covers most of the ray: a facet, whose number is hit->cell and whose material, by aset_draft_texture, is
 * not pointed to; or a kept object, with its number in draft->stage).
 * *found says whether there is one; hit is written only then. An approximate query without a summary, a ray with a number
 * that is not finite (t_max may be INFINITY), without direction, or with one whose length is beyond all numbers: ASET_ERR_ARGUMENT.
 * Adds to *statistics unless it is NULL.
 */
aset_status aset_closest_hit(bool *found, aset_hit *hit, const aset_tracer *tracer, const aset_ray *ray,
                             bool approximate, aset_statistics *statistics);

/*
 * Whether the ray hits anything at 0 < t < t_max, as shadow rays ask: cheaper than the nearest. With a draft the voxel that it starts
 * in is ignored. Otherwise as aset_closest_hit.
 */
aset_status aset_any_hit(bool *found, const aset_tracer *tracer, const aset_ray *ray, bool approximate,
                         aset_statistics *statistics);

/* A ray that waits on the stack. Private. */
typedef struct aset_waiting {
    aset_vec3 origin, direction;
    aset_real weight;
    uint16_t depth;
    uint16_t kind;
} aset_waiting;

/* The stack of rays, one for each thread. */
typedef struct aset_scratch {
    aset_waiting *stack;
    uint32_t capacity;
#if ASET_WITH_DRAFTS
    aset_beams *beams; /* yours to set: drafts are then drawn in beams; NULL, as aset_scratch_init leaves it: ray by ray */
#endif
} aset_scratch;

/* Bytes in the arena of a scratch for rays of this depth. A ray leaves at most one other waiting on each level. */
#define ASET_BYTES_SCRATCH(depth) ASET_ROUND((size_t)(depth) * sizeof(aset_waiting))

/*
 * Takes a scratch for chains of depth rays (0 means ASET_DEPTH_DEFAULT) from the arena. ASET_ERR_ARGUMENT: over
 * ASET_DEPTH_MAX.
 */
aset_status aset_scratch_init(aset_scratch *scratch, uint32_t depth, aset_arena *arena);

/*
 * The colour that comes back along a ray, by Whitted's model (1980) as libaset defines it: 0.1 fill + for each unshadowed
 * light I (Kd fill (N.L) + Ks (R.V)^shine), + Ks times the reflected ray's + T times the refracted ray's colour; the
 * background where nothing is hit; no falloff. Not clamped: a component may be infinite, or no number, only where a product of
 * amounts of the materials and a light leaves the range of numbers. ray->t_max is not used. ASET_ERR_ARGUMENT as aset_closest_hit,
 * and for a scratch of less depth than the tracer's.
 */
aset_status aset_ray_colour(aset_colour *colour, const aset_tracer *tracer, const aset_ray *ray, aset_scratch *scratch,
                            aset_statistics *statistics);

/* --- pictures --- */

/* How a pixel is stored. RGB565: 16 bits in the machine's byte order, red on top, as display controllers take it. */
typedef enum aset_format { ASET_RGB888, ASET_RGBA8888, ASET_GREY8, ASET_RGB565 } aset_format;

/* Bytes of a pixel: 3, 4, 1 or 2. */
size_t aset_format_bytes(aset_format format);

/*
 * Where rows go. Row first_row of a call to aset_render_rows is written to pixels, each further row stride bytes behind: a
 * whole frame, or with stride 0 one row again and again, which on_row takes away.
 */
typedef struct aset_picture {
    uint32_t width, height; /* of the whole picture, up to 65535 each */
    aset_format format;
    void *pixels;
    size_t stride;
    bool transparent; /* RGBA8888: pixels whose eye rays hit nothing get alpha 0 (in proportion with several samples) */
    /*
     * Called after each row if not NULL; unless stride is less than a row's bytes, up to three rows below may have been written by
     * then as well. Any answer but 0 stops: ASET_ERR_STOPPED.
     */
    int (*on_row)(void *context, uint32_t row, const void *pixels);
    void *context;
} aset_picture;

/*
 * Draws the rows first_row to first_row + n_rows - 1 of the picture that view shows. Colours are clamped to 0..1, times 255,
 * rounded, without gamma; of several samples each is clamped, then they are averaged. The same rows come out whichever
 * thread draws them. Under spd_rules the picture has width + 1 columns and height + 1 rows. ASET_ERR_ARGUMENT: a row outside
 * the picture, no scratch, too many samples; ASET_ERR_GEOMETRY or ASET_ERR_ARGUMENT: a view that cannot be, as a
 * sink would say; ASET_ERR_STOPPED.
 */
aset_status aset_render_rows(const aset_tracer *tracer, const aset_view *view, const aset_picture *picture,
                             uint32_t first_row, uint32_t n_rows, aset_scratch *scratch, aset_statistics *statistics);

ASET_HEADER_END
#endif
