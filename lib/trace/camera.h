/* camera.h - from picture coordinates to eye rays. */
#ifndef ASET_TRACE_CAMERA_H
#define ASET_TRACE_CAMERA_H

#include "aset/types.h"

typedef struct camera {
    aset_vec3 from, forward;
    aset_vec3 right, down; /* from the picture's middle to its right and lower edge */
    bool orthographic;
} camera;

/* ASET_ERR_ARGUMENT or ASET_ERR_GEOMETRY for a view that cannot be. */
aset_status aset_camera_make(camera *c, const aset_view *view, uint32_t width, uint32_t height);

/* x and y from -1 (left, top) to 1 (right, bottom); the direction is of unit length. */
void aset_camera_ray(const camera *c, aset_real x, aset_real y, aset_vec3 *origin, aset_vec3 *direction);

#endif
