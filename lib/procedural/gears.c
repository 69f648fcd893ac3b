/*
 * gears.c - a cube of gears that mesh with their neighbours in each layer, every fifth of glass, on a square of ground.
 *
 * A gear is a prism on a concave polygon of 144 points, four for each of 36 teeth, counter-clockwise seen from above:
 *
 *          1 ____ 0           tips at the outer radius
 *        2  /    \            a flank on each side
 *    3 ____/      \____       roots at the inner radius; point 3 ends the root, then comes point 0 of the next tooth
 *
 * Source: E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, and the Standard Procedural
 * Databases 3 that came of it.
 */
#include "elementary.h"
#include "emit.h"

#include <math.h>

#if ASET_WITH_POLYGONS && ASET_WITH_REFRACTION

enum { n_teeth = 36, n_outline = 4 * n_teeth };

/* What all gears of one scene have in common. */
typedef struct wheel {
    double radius, outer, inner, thickness;
    int n_edge; /* gears along each edge of the cube */
} wheel;

/* The outline about centre; turn +1: counter-clockwise seen from above, -1: clockwise from the same tooth. */
static void outline(emit_point points[n_outline], const wheel *all, const emit_point *centre, double phase_deg,
                    double turn) {
    static const double pitch_share[4] = {-0.19, 0.19, 0.3, 0.7};
    const double pitch_deg = 360.0 / n_teeth;
    for (int i = 0; i < n_outline; i++) {
        double angle = EMIT_RAD(phase_deg + turn * pitch_deg * (i / 4 + pitch_share[i % 4]));
        double radius = i % 4 < 2 ? all->outer : all->inner;
        points[i].x = centre->x + radius * aset_emit_cosine(angle);
        points[i].y = centre->y + radius * aset_emit_sine(angle);
        points[i].z = centre->z;
    }
}

/* Bright colours in no obvious order: each part one of seven steps, then all scaled so that the largest is 1. */
static emit_surface surface(int ix, int iy, int iz) {
    emit_surface result = {0, 0, 0, 1, 0, EMIT_DULL, 0, 0};
    double largest;
    result.r = 0.01 + (5 * (3 * ix + 2 * iy + iz + 1)) % 7 / 7.0;
    result.g = 0.01 + (3 * (3 * iy + 2 * iz + ix + 1)) % 7 / 7.0;
    result.b = 0.01 + (2 * (3 * iz + 2 * ix + iy + 1)) % 7 / 7.0;
    largest = fmax(result.r, fmax(result.g, result.b));
    result.r /= largest;
    result.g /= largest;
    result.b /= largest;
    if ((4 * ix + 2 * iy + iz) % 5 == 0) {
        result.diffuse = 0.2;
        result.transmittance = 0.8;
        result.refraction_index = 1.1;
    }
    return result;
}

static aset_status sides(const aset_sink *sink, const emit_point top[n_outline], double thickness) {
    aset_status status = ASET_OK;
    for (int i = 0; i < n_outline && status == ASET_OK; i++) {
        int next = (i + 1) % n_outline;
        emit_point quad[4];
        quad[0] = quad[1] = top[i];
        quad[2] = quad[3] = top[next];
        quad[1].z -= thickness;
        quad[2].z -= thickness;
        status = aset_emit_polygon(sink, quad, NULL, 4);
    }
    return status;
}

static aset_status gear(const aset_sink *sink, const wheel *all, int ix, int iy, int iz) {
    emit_point points[n_outline];
    emit_point centre;
    double phase_deg = (ix + iy + iz) % 2 == 1 ? 180.0 / n_teeth : 0.0; /* half a pitch: tooth meets gap */
    emit_surface material = surface(ix, iy, iz);
    aset_status status = aset_emit_material(sink, &material);
    centre.x = -1.0 + all->radius + 1.9 * all->radius * ix;
    centre.y = -1.0 + all->radius + 1.9 * all->radius * iy;
    centre.z = 1.0 - (double)iz / all->n_edge;
    outline(points, all, &centre, phase_deg, 1.0);
    if (status == ASET_OK) {
        status = aset_emit_polygon(sink, points, NULL, n_outline);
    }
    if (status == ASET_OK) {
        status = sides(sink, points, all->thickness);
    }
    if (status == ASET_OK) {
        centre.z -= all->thickness;
        outline(points, all, &centre, phase_deg, -1.0);
        status = aset_emit_polygon(sink, points, NULL, n_outline);
    }
    return status;
}

static aset_status ground(const aset_sink *sink) {
    static const emit_surface sand = {1, 0.85, 0.7, 0.3, 0.6, EMIT_SHINE_37, 0, 0};
    static const emit_point corners[] = {{2, 2, 0}, {-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}};
    aset_status status = aset_emit_material(sink, &sand);
    return status == ASET_OK ? aset_emit_polygon(sink, corners, NULL, 4) : status;
}

aset_status aset_procedural_gears(const aset_sink *sink, uint32_t size) {
    static const emit_point lights[] = {{2, 4, 4}, {-2, 4, 3}, {2, -2.5, 2.5}, {-1, -4, 2}, {-1.111, -2.121, 2.626}};
    static const emit_setting setting = {{-1.1, -2.1, 2.6}, {0, 0, 0}, {0, 0, 1}, lights, 5};
    wheel all;
    aset_status status = EMIT_SIZE(gears, &size);
    if (status != ASET_OK) {
        return status;
    }
    all.n_edge = (int)size;
    all.radius = 1.0 / (size - 0.05 * (size - 1.0));
    all.outer = 0.995 * all.radius;
    all.inner = 0.9 * all.radius;
    all.thickness = fmin(0.1, 0.5 / size);
    status = aset_emit_setting(sink, &setting);
    if (status == ASET_OK) {
        status = ground(sink);
    }
    for (int i = 0; i < all.n_edge * all.n_edge * all.n_edge && status == ASET_OK; i++) {
        status = gear(sink, &all, i % all.n_edge, i / all.n_edge % all.n_edge, i / all.n_edge / all.n_edge);
    }
    return status;
}

#else
EMIT_UNSUPPORTED(gears)
#endif
