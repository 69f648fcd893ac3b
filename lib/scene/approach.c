/*
 * approach.c - a ray that starts away from the scene is first brought near it: from afar the rounding of its slice crossings
 * would exceed the boxes' margins. All spaces see the same moved ray.
 */
#include "scene/approach.h"

/* Where a ray from outside is made to start: this part of the scene's size before the box. */
#define NEAR R(0.0625)
#define APPROACHES 4
/* A move leaves an origin off by some 2^-22 (2^-51) of the way it had: so many lead here from the end of the numbers to the least. */
#if ASET_REAL_BITS == 32
#define APPROACHES_FROM_AFAR 12
#else
#define APPROACHES_FROM_AFAR 40
#endif

/* The larger of an origin's distances to both sides of a box, on one axis. */
static inline aset_real farther(aset_real low, aset_real high, aset_real origin) {
    return real_max(high - origin, origin - low);
}

#if ASET_FUSED
/* Narrows the ray's stay in a box by one axis, as aset_probe_box does. False: it misses. */
static inline bool narrow(const probe *ray, int a, aset_real low, aset_real high, aset_real *t_in, aset_real *t_out) {
    aset_real origin = ray->origin[a], inverse = ray->inverse[a];
    if (!ray->moves[a]) {
        return origin >= low && origin <= high;
    }
    bool up = ray->direction[a] > 0;
    *t_in = real_max(((up ? low : high) - origin) * inverse, *t_in);
    *t_out = real_min(((up ? high : low) - origin) * inverse, *t_out);
    return true;
}

/* aset_probe_box, axis by axis without a loop. */
static inline bool probe_in(const probe *ray, aset_vec3 low, aset_vec3 high, aset_real *t_in, aset_real *t_out) {
    *t_in = -REAL_INFINITY;
    *t_out = REAL_INFINITY;
    return narrow(ray, 0, low.x, high.x, t_in, t_out) && narrow(ray, 1, low.y, high.y, t_in, t_out) &&
           narrow(ray, 2, low.z, high.z, t_in, t_out) && *t_in <= *t_out;
}
#else
#define probe_in aset_probe_box
#endif

/*
 * How far the ray is from the scene's box: t at which it enters, 0 if it misses or has entered. The box is grown by more than any
 * object's, and by the rounding of its sides' t from here: a ray that misses it is refused by the clamp of every object too.
 */
static aset_real distance_to(const probe *ray, aset_vec3 low, aset_vec3 high, aset_real margin) {
    const aset_real *o = ray->origin;
    aset_real t_in, t_out;
    aset_real away = real_max(farther(low.x, high.x, o[0]), farther(low.y, high.y, o[1]));
    away = real_max(away, farther(low.z, high.z, o[2]));
    aset_real grown = 4 * margin + 4 * REAL_UNIT * away;
    aset_vec3 more = vec(grown, grown, grown);
    return probe_in(ray, vec_sub(low, more), vec_add(high, more), &t_in, &t_out) && t_in > 0 ? t_in : 0;
}

aset_real aset_approach_move(probe *ray, const aset_scene *scene) {
    if (!(scene->margin > 0)) { /* it has no box */
        return 0;
    }
    aset_real moved = 0, near = NEAR * vec_largest(vec_sub(scene->high, scene->low));
    for (int i = 0; i < APPROACHES_FROM_AFAR; i++) { /* from very far away the first move ends up somewhere near: so again */
        aset_real step = distance_to(ray, scene->low, scene->high, scene->margin) - near;
        if (!(step > (i < APPROACHES ? 0 : near))) {
            break;
        }
        for (int a = 0; a < 3; a++) {
            ray->origin[a] += step * ray->direction[a];
        }
        moved += step;
    }
    return moved;
}

aset_vec3 aset_approach_origin(const aset_scene *scene, aset_vec3 origin) {
    const aset_real end = REAL_MAX / 4;
    aset_vec3 end_3 = vec(end, end, end);
    return scene->scale == 1 ? origin : vec_max(vec_scale(end_3, -1), vec_min(end_3, scene_point(scene, origin)));
}

aset_real aset_approach_ready(probe *ray, const aset_scene *scene, aset_vec3 origin, aset_vec3 direction) {
    origin = aset_approach_origin(scene, origin);
    *ray = aset_probe_make(origin, direction);
    return approach_entered(scene, origin) ? 0 : aset_approach_move(ray, scene);
}
