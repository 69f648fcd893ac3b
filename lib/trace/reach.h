/* reach.h - what a reach (aset/reach.h) knows of one shadow ray. */
#ifndef ASET_TRACE_REACH_H
#define ASET_TRACE_REACH_H

#include "trace/light.h"
#include "trace/outlook.h"

#if ASET_WITH_DRAFTS

/* Through a pointer, so that who names no reach links none. */
struct aset_reach_calls {
    /*
     * The t behind which the shadow ray to light number light meets no marked voxel. The ray starts at most off beside point; towards:
     * as from the point itself.
     */
    aset_real (*last)(const aset_reach *reach, uint32_t light, aset_vec3 point, aset_real off, const light_ray *towards);
};

#endif
#endif
