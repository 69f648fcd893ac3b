/* beam.h - what the renderer asks of beams (aset/beams.h): through pointers, so that who names none links none. */
#ifndef ASET_TRACE_BEAM_H
#define ASET_TRACE_BEAM_H

#include "aset/beams.h"
#include "trace/camera.h"
#include "trace/trace_tree.h"

#if ASET_WITH_DRAFTS

#define BEAM_RAYS 8u
#define BEAM_ROWS 8u

/* The picture's rays: row r, sample j of n lies at r + (j + 1/2) / n - corner pixels. */
typedef struct beam_frame {
    const camera *eye;
    const aset_draft *draft;
    uint32_t width, height;  /* pixels */
    uint32_t columns, rows;  /* of rays at one a pixel */
    uint32_t samples;
    aset_real corner;
} beam_frame;

/* The eye rays of neighbouring pixels, and what they meet. */
typedef struct beam_rays {
    aset_vec3 origins[BEAM_RAYS], directions[BEAM_RAYS];
    eye_hits hits[BEAM_RAYS];
} beam_rays;

struct aset_beam_calls {
    /* Whether the draft can be seen in beams at all. */
    bool (*begin)(aset_beams *beams, const beam_frame *frame);
    /* Makes a row ready. False: it must be drawn ray by ray. */
    bool (*begin_row)(aset_beams *beams, const beam_frame *frame, uint32_t row);
    /* Chooses the voxels before the pixels from column on, a multiple of BEAM_RAYS. False: there are none. */
    bool (*choose)(aset_beams *beams, uint32_t column);
    /* What n rays through the pixels chosen for meet: voxels, and objects that the draft keeps. */
    void (*meet)(aset_beams *beams, beam_rays *rays, uint32_t n, const aset_tracer *tracer, aset_statistics *statistics);
};

#endif
#endif
