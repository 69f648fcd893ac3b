/*
 * tetra.c - Sierpinski's tetrahedron: every tetrahedron replaced by four of half its edge at its corners.
 *
 * The corners are every second corner of a cube, so all coordinates are multiples of a power of two and exact in float.
 * Source: W. Sierpinski, 1915, for the figure; E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11),
 * 1987, and the Standard Procedural Databases 3 for the scene.
 */
#include "emit.h"

#if ASET_WITH_POLYGONS

static const emit_point corner_signs[4] = {{-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {1, 1, 1}};

static emit_point corner(const emit_point *centre, double half_edge, int i) {
    emit_point result;
    result.x = centre->x + half_edge * corner_signs[i].x;
    result.y = centre->y + half_edge * corner_signs[i].y;
    result.z = centre->z + half_edge * corner_signs[i].z;
    return result;
}

/* One tetrahedron, its faces seen from outside. */
static aset_status faces(const aset_sink *sink, const emit_point *centre, double half_edge) {
    static const int corners_of_face[4][3] = {{0, 1, 2}, {3, 2, 1}, {2, 3, 0}, {1, 0, 3}};
    aset_status status = ASET_OK;
    for (int face = 0; face < 4 && status == ASET_OK; face++) {
        emit_point points[3];
        for (int i = 0; i < 3; i++) {
            points[i] = corner(centre, half_edge, corners_of_face[face][i]);
        }
        status = aset_emit_polygon(sink, points, NULL, 3);
    }
    return status;
}

aset_status aset_emit_tetrahedra(const aset_sink *sink, uint32_t depth, const emit_point *centre, double half_edge) {
    aset_status status = ASET_OK;
    if (depth <= 1) {
        return faces(sink, centre, half_edge);
    }
    for (int i = 0; i < 4 && status == ASET_OK; i++) {
        emit_point next = corner(centre, half_edge / 2.0, i);
        status = aset_emit_tetrahedra(sink, depth - 1, &next, half_edge / 2.0);
    }
    return status;
}

aset_status aset_procedural_tetra(const aset_sink *sink, uint32_t size) {
    static const emit_point lights[] = {{2, -18, -5}};
    static const emit_setting setting = {{1.022846, -3.177154, -2.174512},
                                         {-0.004103, -0.004103, 0.216539},
                                         {-0.816497, -0.816497, 0.816497},
                                         lights,
                                         1};
    static const emit_surface red = {1, 0.2, 0.2, 1, 0, EMIT_DULL, 0, 0};
    static const emit_point origin = {0, 0, 0};
    aset_status status = EMIT_SIZE(tetra, &size);
    if (status == ASET_OK) {
        status = aset_emit_setting(sink, &setting);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &red);
    }
    return status == ASET_OK ? aset_emit_tetrahedra(sink, size, &origin, 1.0) : status;
}

#else
aset_status aset_emit_tetrahedra(const aset_sink *sink, uint32_t depth, const emit_point *centre, double half_edge) {
    (void)sink, (void)depth, (void)centre, (void)half_edge;
    return ASET_ERR_UNSUPPORTED;
}

EMIT_UNSUPPORTED(tetra)
#endif
