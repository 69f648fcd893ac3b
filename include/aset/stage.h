/*
 * stage.h - what a model lacks to be a picture: a view that shows all of it, lights, a ground to stand on, a background. One
 * rule for every model, made from its box alone, so that a stream of triangles needs no more than a measuring pass.
 */
#ifndef ASET_STAGE_H
#define ASET_STAGE_H

#include "aset/scene.h"

ASET_HEADER_BEGIN

/* The axis that points upwards. */
typedef enum aset_up { ASET_UP_Y, ASET_UP_Z } aset_up;

/* All zero, or a NULL for the whole struct, gives the defaults: y up, a ground, a square picture. */
typedef struct aset_stage_options {
    aset_up up;
    bool no_ground;
    aset_real aspect; /* width by height of the picture that is to show the whole model; 0 means 1 */
} aset_stage_options;

/* The surface of models that bring none: a warm grey (0.80, 0.75, 0.68), diffuse 1, no highlight, two-sided. */
aset_material aset_stage_material(void);

/*
 * Emits a background, a view, two lights and, unless options say otherwise, a ground into sink, at any time: before the
 * model's own entities or behind them. The ground leaves its material as the sink's current one.
 *
 * With c the middle and r half the diagonal of the box from low to high, and directions as (to the right, up, to the front),
 * which is (x, y, z) with y up and (x, z, -y) with z up:
 *
 *   view        from c along (-0.5, 0.4, 1), looking at c, an angle of 30 degrees across the picture's height, from so far
 *               that the sphere of radius r around c just fits: r / sin 15 degrees, and farther for a picture that is
 *               higher than wide. It asks for no resolution.
 *   lights      points: the key light at c + 4 r (-1.2, 1.6, 0.8) of 0.85, a fill light at c + 4 r (1.2, 0.8, 1.6) of 0.3
 *   ground      a square of half side 3 r below c, grey (0.62, diffuse 1), r / 1024 under the lowest coordinate, so that a
 *               floor of the model's own lies on it and not in it
 *   background  (0.80, 0.84, 0.90)
 *
 * A box of (almost) no extent, a point say, is taken as one of r = 128 roundings (a float's, in double too: a draft's words are
 * floats) of its largest coordinate, or 1 at the
 * origin, or where r is below 10^-17 (in double 10^-150). ASET_ERR_PRECISION: between the ends of the box, on its longest axis,
 * lie fewer than 64 of the numbers that its largest coordinate has for neighbours, and not none at all, as aset_space_measure has it;
 * ASET_ERR_ARGUMENT: low above high, an aspect that is not above 0 and finite; ASET_ERR_UNSUPPORTED: a ground in a library without polygons; else the sink's answer, which is ASET_ERR_GEOMETRY for a box so far out or so large that the
 * stage's points exceed what the library takes: below a twentieth of that all is well at aspects from 1 up.
 */
aset_status aset_stage_emit(const aset_sink *sink, const aset_vec3 *low, const aset_vec3 *high,
                            const aset_stage_options *options);

ASET_HEADER_END
#endif
