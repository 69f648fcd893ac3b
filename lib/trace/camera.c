/* camera.c - perspective and orthographic views. The angle or height spans the picture's height; pixels are square. */
#include "trace/camera.h"

#include "base/vec.h"
#include "scene/entity.h"

aset_status aset_camera_make(camera *c, const aset_view *view, uint32_t width, uint32_t height) {
    aset_status status = aset_entity_check_view(view);
    if (status != ASET_OK) {
        return status;
    }
    c->from = view->from;
    c->forward = aset_vec_unit(vec_sub(view->at, view->from));
    c->orthographic = view->height > 0;
    aset_vec3 right = aset_vec_unit(vec_cross(c->forward, aset_vec_unit(view->up)));
    aset_vec3 down = vec_cross(c->forward, right);
    aset_real half = c->orthographic ? view->height / 2 : aset_real_tangent_deg(view->angle_deg / 2);
    c->right = vec_scale(right, half * (aset_real)width / (aset_real)height);
    c->down = vec_scale(down, half);
    return ASET_OK;
}

void aset_camera_ray(const camera *c, aset_real x, aset_real y, aset_vec3 *origin, aset_vec3 *direction) {
    aset_vec3 across = vec_along(vec_scale(c->right, x), y, c->down);
    if (c->orthographic) {
        *origin = vec_add(c->from, across);
        *direction = c->forward;
    } else {
        *origin = c->from;
        *direction = aset_vec_unit(vec_add(c->forward, across));
    }
}
