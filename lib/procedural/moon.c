/*
 * moon.c - Sierpinski's tetrahedron of ruby glass before a moon.
 *
 * Stands for "Tetra and a Moon" (Figure 7) of Dauenhauer and Semwal, "Approximate Ray Tracing" (Graphics Interface 1990), of
 * which the paper tells 11.4 objects per non-empty side of a cell at 10 divisions; the tetrahedra of size 5 alone have
 * 8.7. The moon stands outside their box and so stretches the volume: its place and radius were searched for 11.4, and
 * where a hundredth to and fro does not matter. Glass, because the paper also counts 3.3 secondary rays for each primary
 * one: rays that are reflected and refracted at every hit come near that (2.8), mirrors alone stay at 0.3.
 */
#include "emit.h"

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES

aset_status aset_procedural_tetra_moon(const aset_sink *sink, uint32_t size) {
    static const emit_point lights[2] = {{2, -18, -5}, {-8, -9, 6}};
    static const emit_point from = {1.022846, -3.177154, -2.174512}, to = {-0.20, 0.02, 0.28};
    static const emit_point up = {-0.816497, -0.816497, 0.816497};
    static const emit_surface ruby = {1.0, 0.4, 0.2, 0.55, 0.4, 30.0, 0.5, 1.1};
    static const emit_surface pale = {1.0, 0.95, 0.82, 0.8, 0.35, 8.0, 0.0, 0.0};
    static const emit_point origin = {0.0, 0.0, 0.0}, moon = {-2.0, 1.2, 1.3};
    aset_status status = EMIT_SIZE(tetra_moon, &size);
    if (status == ASET_OK) {
        status = aset_emit_background(sink, 0.02, 0.03, 0.10);
    }
    if (status == ASET_OK) {
        status = aset_emit_view(sink, &from, &to, &up, 45.0, 512);
    }
    for (uint32_t i = 0; i < 2 && status == ASET_OK; i++) {
        status = aset_emit_light(sink, &lights[i]);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &ruby);
    }
    if (status == ASET_OK) {
        status = aset_emit_tetrahedra(sink, size, &origin, 1.0);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &pale);
    }
    return status == ASET_OK ? aset_emit_sphere(sink, &moon, 0.6) : status;
}

#else
EMIT_UNSUPPORTED(tetra_moon)
#endif
