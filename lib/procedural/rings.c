/*
 * rings.c - layers of ring clusters before a wall. Each cluster is six pentagons of cylinders with a sphere at every joint,
 * linked like the rings of a chain: one lies flat, five stand around it.
 *
 * Source: E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and the Standard Procedural
 * Databases 3 that came of it.
 */
#include "elementary.h"
#include "emit.h"

#include <math.h>

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES && ASET_WITH_CONES

enum { n_corners = 5, n_joints = 6 * n_corners };

#define TUBE 0.07412 /* the radius of cylinders and spheres; the joints lie at 1 / (1 + TUBE) from the centre */

static void joints(emit_point result[n_joints]) {
    const double cosine = 1.0 / sqrt(5.0), sine = 2.0 / sqrt(5.0); /* of the angle between a dodecahedron's normals */
    for (int i = 0; i < n_joints; i++) {
        double corner = EMIT_RAD(72.0 * (i % n_corners));
        double x = aset_emit_cosine(corner) / (1.0 + TUBE), y = aset_emit_sine(corner) / (1.0 + TUBE);
        if (i < n_corners) {
            result[i] = (emit_point){x, y, 0.0};
        } else {
            double azimuth = EMIT_RAD(72.0 * (i / n_corners) - 36.0);
            double cos_a = aset_emit_cosine(azimuth), sin_a = aset_emit_sine(azimuth);
            result[i].x = x * cos_a - y * cosine * sin_a;
            result[i].y = x * sin_a + y * cosine * cos_a;
            result[i].z = y * sine;
        }
    }
}

static aset_status cluster(const aset_sink *sink, const emit_point points[n_joints], const emit_point *offset) {
    static const double colours[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};
    aset_status status = ASET_OK;
    for (int i = 0; i < n_joints && status == ASET_OK; i++) {
        int previous = i % n_corners == 0 ? i + n_corners - 1 : i - 1;
        emit_point base = {points[i].x + offset->x, points[i].y + offset->y, points[i].z + offset->z};
        emit_point apex = {points[previous].x + offset->x, points[previous].y + offset->y,
                           points[previous].z + offset->z};
        if (i % n_corners == 0) {
            const double *colour = colours[i / n_corners];
            emit_surface surface = {colour[0], colour[1], colour[2], 0.5, 0.2, EMIT_SHINE_37, 0, 0};
            status = aset_emit_material(sink, &surface);
        }
        if (status == ASET_OK) {
            status = aset_emit_cone(sink, &base, TUBE, &apex, TUBE);
        }
        if (status == ASET_OK) {
            status = aset_emit_sphere(sink, &base, TUBE);
        }
    }
    return status;
}

/* A square behind the last layer, a little larger than the view sees. */
static aset_status wall(const aset_sink *sink, double layer, uint32_t n_layers) {
    static const emit_surface white = {1, 1, 1, 1, 0, EMIT_DULL, 0, 0};
    double y = layer * (n_layers + 1.0);
    double half = 1.01 * (y + layer) * aset_emit_tangent(EMIT_RAD(22.5));
    emit_point corners[4] = {{-1.0 + half, y, 0.5 + half},
                             {-1.0 - half, y, 0.5 + half},
                             {-1.0 - half, y, 0.5 - half},
                             {-1.0 + half, y, 0.5 - half}};
    aset_status status = aset_emit_material(sink, &white);
    return status == ASET_OK ? aset_emit_polygon(sink, corners, NULL, 4) : status;
}

/* Number depth, counted from 0: (depth + 1)^2 clusters, two units apart. */
static aset_status layer_of(const aset_sink *sink, const emit_point points[n_joints], double layer, int depth) {
    aset_status status = ASET_OK;
    for (int jz = 0; jz <= depth; jz++) {
        for (int jx = 0; jx <= depth && status == ASET_OK; jx++) {
            emit_point offset = {2 * jx - depth, layer * (depth + 1), 2 * jz - depth};
            status = cluster(sink, points, &offset);
        }
    }
    return status;
}

aset_status aset_procedural_rings(const aset_sink *sink, uint32_t size) {
    /* the distance of the layers, and of the eye from the first */
    const double layer = 1.0 / aset_emit_sine(EMIT_RAD(22.5));
    const emit_point lights[] = {{3, -layer, 3}, {-4, -layer, 1}, {2, -layer, -4}};
    const emit_setting setting = {{-1, -layer, 0.5}, {-1, 1 - layer, 0.5}, {0, 0, 1}, lights, 3};
    emit_point points[n_joints];
    aset_status status = EMIT_SIZE(rings, &size);
    if (status == ASET_OK) {
        status = aset_emit_setting(sink, &setting);
    }
    if (status == ASET_OK) {
        status = wall(sink, layer, size);
    }
    joints(points);
    for (int depth = 0; depth < (int)size && status == ASET_OK; depth++) {
        status = layer_of(sink, points, layer, depth);
    }
    return status;
}

#else
EMIT_UNSUPPORTED(rings)
#endif
