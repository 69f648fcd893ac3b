/*
 * tree.c - a tree whose every branch, a cone with a sphere at its tip, bears two smaller ones, on a square of ground.
 *
 * A branch is drawn in its own frame, from the origin to (0, 0, 1). A child's frame lies in its parent's: tilted about x,
 * turned about z, shrunk, and set on the parent's tip; so its base is the parent's tip, of the same radius.
 * Source: E. Haines, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11), 1987, after M. Aono and T. L. Kunii,
 * IEEE CG&A 4(5), 1984; and the Standard Procedural Databases 3 that came of it.
 */
#include "elementary.h"
#include "emit.h"

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES && ASET_WITH_CONES

enum { n_forks = 2 };

#define TAPER 0.67 /* a branch's tip radius over its base radius */

/* Where the frame's axes and its origin lie: the columns of an affine map. */
typedef struct frame {
    emit_point x, y, z, origin;
} frame;

/* A child in its parent's frame, but for the step to the parent's tip. */
static frame fork(double tilt_deg, double turn_deg, double shrink) {
    double cos_a = aset_emit_cosine(EMIT_RAD(tilt_deg)), sin_a = aset_emit_sine(EMIT_RAD(tilt_deg));
    double cos_b = aset_emit_cosine(EMIT_RAD(turn_deg)), sin_b = aset_emit_sine(EMIT_RAD(turn_deg));
    frame result;
    result.x = (emit_point){shrink * cos_b, shrink * sin_b, 0.0};
    result.y = (emit_point){-shrink * sin_b * cos_a, shrink * cos_b * cos_a, shrink * sin_a};
    result.z = (emit_point){shrink * sin_b * sin_a, -shrink * cos_b * sin_a, shrink * cos_a};
    result.origin = (emit_point){0.0, 0.0, 1.0};
    return result;
}

/* The direction d of the frame's own, in the scene. */
static emit_point outward(const frame *f, const emit_point *d) {
    emit_point result;
    result.x = f->x.x * d->x + f->y.x * d->y + f->z.x * d->z;
    result.y = f->x.y * d->x + f->y.y * d->y + f->z.y * d->z;
    result.z = f->x.z * d->x + f->y.z * d->y + f->z.z * d->z;
    return result;
}

/* Depth of recursion: size. */
static aset_status grow(const aset_sink *sink, const frame forks[n_forks], const frame *own, double base_radius,
                        uint32_t depth) {
    double tip_radius = TAPER * base_radius;
    emit_point tip = {own->origin.x + own->z.x, own->origin.y + own->z.y, own->origin.z + own->z.z};
    aset_status status = aset_emit_cone(sink, &own->origin, base_radius, &tip, tip_radius);
    if (status == ASET_OK) {
        status = aset_emit_sphere(sink, &tip, tip_radius);
    }
    for (int i = 0; i < n_forks && depth > 0 && status == ASET_OK; i++) {
        frame next;
        next.x = outward(own, &forks[i].x);
        next.y = outward(own, &forks[i].y);
        next.z = outward(own, &forks[i].z);
        next.origin = tip;
        status = grow(sink, forks, &next, tip_radius, depth - 1);
    }
    return status;
}

static aset_status ground(const aset_sink *sink) {
    static const emit_surface grass = {0.2, 0.7, 0.2, 1, 0, EMIT_DULL, 0, 0};
    static const emit_point corners[] = {{50, 50, 0}, {-50, 50, 0}, {-50, -50, 0}, {50, -50, 0}};
    aset_status status = aset_emit_material(sink, &grass);
    return status == ASET_OK ? aset_emit_polygon(sink, corners, NULL, 4) : status;
}

aset_status aset_procedural_tree(const aset_sink *sink, uint32_t size) {
    static const emit_point lights[] = {{-5, 5, 50},   {30, -30, 30}, {-40, -30, 20},  {10, 30, 40},
                                        {-30, 40, 10}, {50, 25, 20},  {-10, -60, 30}};
    static const emit_setting setting = {{4.5, 0.4, 2}, {0, 0, 1.5}, {0, 0, 1}, lights, 7};
    static const emit_surface bark = {0.55, 0.4, 0.2, 1, 0, EMIT_DULL, 0, 0};
    static const frame trunk = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    frame forks[n_forks];
    aset_status status = EMIT_SIZE(tree, &size);
    forks[0] = fork(40.0, 90.0, 0.65);
    forks[1] = fork(25.0, 230.0, 0.70);
    if (status == ASET_OK) {
        status = aset_emit_setting(sink, &setting);
    }
    if (status == ASET_OK) {
        status = ground(sink);
    }
    if (status == ASET_OK) {
        status = aset_emit_material(sink, &bark);
    }
    return status == ASET_OK ? grow(sink, forks, &trunk, 0.15, size) : status;
}

#else
EMIT_UNSUPPORTED(tree)
#endif
