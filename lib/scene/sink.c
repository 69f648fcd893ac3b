/* sink.c - conveniences for callers of sinks. */
#include "aset/scene.h"

#if ASET_WITH_POLYGONS
aset_status aset_sink_polygon(const aset_sink *sink, const aset_vec3 *points, const aset_vec3 *normals,
                              uint32_t n_points) {
    aset_status status = sink->polygon_begin(sink->context, n_points, normals != NULL);
    for (uint32_t i = 0; i < n_points && status == ASET_OK; i++) {
        status = sink->polygon_point(sink->context, points + i, normals == NULL ? NULL : normals + i);
    }
    return status == ASET_OK ? sink->polygon_end(sink->context) : status;
}
#endif
