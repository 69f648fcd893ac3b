/*
 * light.c - point and directional lights, without falloff. A light without a colour of its own is white, and n of them have
 * 1 / sqrt(n) each: the rule of the SPD's own exporters (Haines).
 */
#include "trace/light.h"

bool aset_light_towards(light_ray *towards, const aset_scene *scene, const aset_light *light, aset_vec3 point) {
    if (light->directional) {
        towards->direction = light->position; /* the scene keeps it in unit length */
        towards->distance = REAL_INFINITY;
    } else {
        aset_vec3 way = vec_sub(light->position, point);
        aset_real distance = aset_vec_length(way);
        if (!(distance > 0)) {
            return false;
        }
        /* aset_vec_unit takes the same root where the square is in range: it need not be drawn twice */
        towards->direction = distance > LIGHT_NEAR && distance < LIGHT_FAR ? vec_scale(way, 1 / distance) : aset_vec_unit(way);
        towards->distance = distance;
    }
    towards->colour = light_colour(scene, light);
    return true;
}
