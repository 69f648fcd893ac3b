/* approach.h - a ray made ready for a scene: from outside it is brought near. */
#ifndef ASET_SCENE_APPROACH_H
#define ASET_SCENE_APPROACH_H

#include "scene/shape.h"

/*
 * Is the origin in less than the box that aset_approach_move measures to? Then that moves nothing: so with most rays that a surface
 * sends on.
 */
static inline bool approach_entered(const aset_scene *scene, aset_vec3 origin) {
    aset_vec3 low = scene->low, high = scene->high;
    aset_real grown = 4 * scene->margin;
    return origin.x >= low.x - grown && origin.x <= high.x + grown && origin.y >= low.y - grown &&
           origin.y <= high.y + grown && origin.z >= low.z - grown && origin.z <= high.z + grown;
}

/* A ray's origin in the scene's own lengths; from so far that these have no number for it, at the end of their range. */
aset_vec3 aset_approach_origin(const aset_scene *scene, aset_vec3 origin);

/* Moves a ray from outside near the scene. By how much. */
aset_real aset_approach_move(probe *ray, const aset_scene *scene);

/* Makes a ray of unit direction ready, in the scene's own lengths; from outside it is moved near the scene. By how much. */
aset_real aset_approach_ready(probe *ray, const aset_scene *scene, aset_vec3 origin, aset_vec3 direction);

/* t_max as the moved ray counts it, and the rounding of that. */
static inline aset_real approach_end(aset_real moved, aset_real t_max) {
    return t_max - moved + 4 * REAL_UNIT * moved;
}

#endif
