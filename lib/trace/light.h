/* light.h - what a light sends to a point. */
#ifndef ASET_TRACE_LIGHT_H
#define ASET_TRACE_LIGHT_H

#include "aset/scene.h"
#include "base/vec.h"

/* Well within the distances whose squares neither overflow nor lose bits. */
#define LIGHT_NEAR R(1e-10)
#define LIGHT_FAR R(1e10)

typedef struct light_ray {
    aset_vec3 direction; /* unit, towards the light */
    aset_real distance;  /* REAL_INFINITY for a directional light */
    aset_colour colour;
} light_ray;

static inline aset_colour light_colour(const aset_scene *scene, const aset_light *light) {
    aset_colour white;
    if (light->has_colour) {
        return light->colour;
    }
    white.r = white.g = white.b = 1 / real_sqrt((aset_real)scene->n_uncoloured);
    return white;
}

/* False if the point is the light itself, which then sends nothing. */
bool aset_light_towards(light_ray *towards, const aset_scene *scene, const aset_light *light, aset_vec3 point);

#endif
