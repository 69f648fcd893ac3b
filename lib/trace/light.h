/* light.h - what a light sends to a point. */
#ifndef ASET_TRACE_LIGHT_H
#define ASET_TRACE_LIGHT_H

#include "aset/scene.h"
#include "base/vec.h"

typedef struct light_ray {
    aset_vec3 direction; /* unit, towards the light */
    aset_real distance;  /* REAL_INFINITY for a directional light */
    aset_colour colour;
} light_ray;

/* False if the point is the light itself, which then sends nothing. */
bool aset_light_towards(light_ray *towards, const aset_scene *scene, const aset_light *light, aset_vec3 point);

#endif
