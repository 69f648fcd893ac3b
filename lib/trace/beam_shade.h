/* beam_shade.h - the colours of what beams' rays have met, found together. */
#ifndef ASET_TRACE_BEAM_SHADE_H
#define ASET_TRACE_BEAM_SHADE_H

#include "approx/draft_beam.h"
#include "trace/drawing.h"

#if ASET_WITH_DRAFTS && DRAFT_SHADES_BEAMS

/* Beams whose colours are still to come: so many fill a queue of layers better than one does. */
#define BEAM_SHADER_BEAMS 4

/* Layers side by side; those that are not entered are as others were, and nothing comes of them. */
typedef struct beam_queue {
    uint32_t n;
    aset_colour *sum[DRAFT_BEAM]; /* of the layer's ray */
    int32_t same[DRAFT_BEAM];     /* as the layer before: in the same shadows */
    aset_real share[DRAFT_BEAM], t[DRAFT_BEAM], nudge[DRAFT_BEAM];
    aset_real origin[3][DRAFT_BEAM], direction[3][DRAFT_BEAM], point[3][DRAFT_BEAM], normal[3][DRAFT_BEAM];
    uint32_t texture[DRAFT_BEAM];
    aset_material own[DRAFT_BEAM];
    const aset_material *material[DRAFT_BEAM]; /* of own */
    uint32_t known, dark; /* of the last layer that was shaded: shade.h */
} beam_queue;

typedef struct beam_shader {
    const drawing *d;
    beam_queue queue;
    uint32_t n_beams;
    uint32_t n_rays[BEAM_SHADER_BEAMS];
    gathered *into[BEAM_SHADER_BEAMS];
    aset_colour sum[BEAM_SHADER_BEAMS][DRAFT_BEAM];
    aset_real left[BEAM_SHADER_BEAMS][DRAFT_BEAM];
} beam_shader;

/* Neighbouring eye rays, n of DRAFT_BEAM, and what they have met. */
typedef struct beam_sight {
    const draft_beam *met;
    aset_real (*origins)[DRAFT_BEAM], (*directions)[DRAFT_BEAM];
    uint32_t n;
} beam_sight;

/* Whether a picture's hits may be shaded so at all: where nothing but the draft answers eye rays and their shadow rays, by its own rules. */
bool aset_beam_shader_start(beam_shader *shader, const drawing *d);

/*
 * Adds to each ray's gathered samples what aset_trace_tree gives for it, number for number, not later than at the next finish: till then
 * they must stay. False: that will not be done, for some of the rays would send others on.
 */
bool aset_beam_shader_add(beam_shader *shader, const beam_sight *sight, gathered *into);

/* All that is still to come. */
void aset_beam_shader_finish(beam_shader *shader);

#endif
#endif
