/* drawing.h - a picture being drawn, and how its pixels come about: for render.c, and for beams, which draw rows in another way. */
#ifndef ASET_TRACE_DRAWING_H
#define ASET_TRACE_DRAWING_H

#include "base/real.h"
#include "trace/camera.h"
#include "trace/trace_tree.h"

typedef struct drawing {
    const aset_tracer *tracer;
    const aset_picture *picture;
    camera eye;
    uint32_t columns, rows; /* rays at one a pixel */
    uint32_t samples;
    aset_real corner; /* pixel corners lie half a pixel before the centres */
    aset_scratch *scratch;
    aset_statistics *statistics;
} drawing;

/* What a pixel has gathered of its samples. */
typedef struct gathered {
    aset_colour sum;
    aset_real cover;
} gathered;

/* Where a sample of a pixel lies on an axis of the picture that has so many pixels: -1 to 1. */
static inline aset_real drawing_place(const drawing *d, uint32_t pixel, uint32_t sample, uint32_t size) {
    aset_real at = (aset_real)pixel - d->corner + ((aset_real)sample + R(0.5)) / (aset_real)d->samples;
    return 2 * at / (aset_real)size - 1;
}

/* The eye ray of sample (i, j) of a pixel. */
void aset_drawing_ray(const drawing *d, uint32_t column, uint32_t row, uint32_t i, uint32_t j, aset_vec3 *origin,
                      aset_vec3 *direction);

/* Adds a sample, clamped; cover: the share of its eye ray that hit something. */
void aset_drawing_gather(gathered *g, aset_colour c, aset_real cover);

/* The mean of all samples, as the picture's format has it. */
void aset_drawing_put(const drawing *d, const gathered *g, unsigned char *at);

#if ASET_WITH_DRAFTS
/* How beams draw: through a pointer, so that who names none links none. */
struct aset_beam_calls {
    /* Whether they can draw this picture at all; before its first row. */
    bool (*begin)(aset_beams *beams, const drawing *d);
    /*
     * Draws some of the n_rows rows that are wanted from row on, stride bytes apart; how many. 0: nothing was drawn, the
     * row's rays must be traced one by one.
     */
    uint32_t (*draw_rows)(aset_beams *beams, const drawing *d, uint32_t row, uint32_t n_rows, unsigned char *line, size_t stride);
};
#endif

#endif
