/*
 * balls.c - the sphereflake: every sphere carries nine of a third of its radius, over a square floor.
 *
 * The nine directions stand about the pole +z, six on the equator and three above it; a child's own pole is the direction
 * from its parent to it, and its nine are turned from +z to that pole by the shortest way.
 * Source: E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and the Standard Procedural
 * Databases 3 that came of it.
 */
#include "elementary.h"
#include "emit.h"

#include <math.h>

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES

enum { n_children = 9 };

/* A pole this near +z or -z counts as exactly there: the shortest turn to -z has no axis of its own. */
#define POLE 0.9999

static void directions(emit_point result[n_children]) {
    static const double azimuth_deg[3] = {45.0, 15.0, 75.0};
    for (int i = 0; i < n_children; i++) {
        double azimuth = EMIT_RAD(azimuth_deg[i % 3] + 120.0 * (i / 3));
        double across = i % 3 == 0 ? 1.0 / sqrt(3.0) : 1.0;
        result[i].x = across * aset_emit_cosine(azimuth);
        result[i].y = across * aset_emit_sine(azimuth);
        result[i].z = i % 3 == 0 ? sqrt(2.0 / 3.0) : 0.0;
    }
}

/*
 * d turned by the rotation that takes +z to the unit vector pole about a = z x pole. Rodrigues' formula with the cosine
 * pole.z and with a's length, the sine, left in: d cos + a x d + a (a.d) / (1 + cos). At -z: half a turn about y.
 */
static emit_point turned(const emit_point *d, const emit_point *pole) {
    emit_point result = *d;
    if (pole->z <= -POLE) {
        result.x = -d->x;
        result.z = -d->z;
    } else if (pole->z < POLE) {
        double ax = -pole->y, ay = pole->x;
        double along = (ax * d->x + ay * d->y) / (1.0 + pole->z);
        result.x = d->x * pole->z + ay * d->z + ax * along;
        result.y = d->y * pole->z - ax * d->z + ay * along;
        result.z = d->z * pole->z + ax * d->y - ay * d->x;
    }
    return result;
}

static aset_status flake(const aset_sink *sink, const emit_point children[n_children], uint32_t depth,
                         const emit_point *centre, double radius, const emit_point *pole) {
    aset_status status = aset_emit_sphere(sink, centre, radius);
    for (int i = 0; i < n_children && depth > 0 && status == ASET_OK; i++) {
        emit_point direction = turned(&children[i], pole);
        emit_point next;
        next.x = centre->x + radius * (4.0 / 3.0) * direction.x;
        next.y = centre->y + radius * (4.0 / 3.0) * direction.y;
        next.z = centre->z + radius * (4.0 / 3.0) * direction.z;
        status = flake(sink, children, depth - 1, &next, radius / 3.0, &direction);
    }
    return status;
}

aset_status aset_procedural_balls(const aset_sink *sink, uint32_t size) {
    static const emit_point lights[] = {{4, 3, 2}, {1, -4, 4}, {-3, 1, 5}};
    static const emit_setting setting = {{2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, lights, 3};
    static const emit_surface sand = {1, 0.75, 0.33, 0.8, 0, EMIT_DULL, 0, 1};
    static const emit_surface bright = {1, 0.9, 0.7, 0.5, 0.5, EMIT_SHINE_37, 0, 1};
    static const emit_point floor_corners[] = {{12, 12, -0.5}, {-12, 12, -0.5}, {-12, -12, -0.5}, {12, -12, -0.5}};
    static const emit_point origin = {0, 0, 0}, up = {0, 0, 1};
    emit_point children[n_children];
    aset_status status = EMIT_SIZE(balls, &size);
    if (status == ASET_OK) {
        status = aset_emit_setting(sink, &setting);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &sand);
    }
    if (status == ASET_OK) {
        status = aset_emit_polygon(sink, floor_corners, NULL, 4);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &bright);
    }
    if (status == ASET_OK) {
        directions(children);
        status = flake(sink, children, size, &origin, 0.5, &up);
    }
    return status;
}

#else
EMIT_UNSUPPORTED(balls)
#endif
