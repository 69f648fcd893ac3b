/* reach.h - what a reach (aset/reach.h) knows of shadow rays. */
#ifndef ASET_TRACE_REACH_H
#define ASET_TRACE_REACH_H

#include "approx/draft_lanes.h"
#include "aset/trace.h"
#include "trace/light.h"
#include "trace/outlook.h"

#if ASET_WITH_DRAFTS

/* Points side by side, how far off them rays start at most, and the light's distance: infinity for a directional one. */
typedef struct reach_points {
    aset_real point[3][DRAFT_BEAM], off[DRAFT_BEAM], distance[DRAFT_BEAM];
} reach_points;

/* Through a pointer, so that who names no reach links none. */
struct aset_reach_calls {
    /*
     * The t behind which the shadow ray to light number light meets no marked voxel. The ray starts at most off beside point; towards:
     * as from the point itself.
     */
    aset_real (*last)(const aset_reach *reach, uint32_t light, aset_vec3 point, aset_real off, const light_ray *towards);
    /* For points side by side; last is set where more is known than what it is. NULL without DRAFT_SHADES_BEAMS. */
    void (*last_each)(aset_real *restrict last, const aset_reach *reach, uint32_t light, const reach_points *restrict points);
};

/* Was the tracer's reach made for this very light? Its scene may have other ones than the draft's stage. */
static inline bool reach_is_of(const aset_tracer *tracer, uint32_t light) {
    const aset_reach *reach = tracer->reach;
    if (reach == NULL || reach->draft != tracer->draft || light >= reach->n_lights) {
        return false;
    }
    const aset_reach_map *map = reach->lights + light;
    const aset_light *asked = tracer->scene->lights + light;
    return map->directional == asked->directional && map->position.x == asked->position.x &&
           map->position.y == asked->position.y && map->position.z == asked->position.z;
}

#endif
#endif
