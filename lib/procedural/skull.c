/*
 * skull.c - a stylised skull of spheres, cones and polygons on a dark mirror, with crossed bones behind it.
 *
 * Stands for "Strange Effects. Skull" (Figure 6) of Dauenhauer and Semwal, "Approximate Ray Tracing" (Graphics Interface
 * 1990). Bone reflects, and so do the table and the teeth: where reflected rays are approximate, blocks of the
 * structure appear in them. The skull looks towards -y, its right and left are mirror images in the plane x = 0.
 *
 * Bones are tubes: a sphere at every corner, a cone (open at both ends) between two corners. Hollows cannot be cut out of
 * spheres; they are black balls that reflect nothing and so show no curvature, each inside a ring of bone.
 */
#include "emit.h"

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES && ASET_WITH_CONES

static const emit_surface bone = {1.00, 0.94, 0.78, 0.72, 0.28, 25.0, 0.0, 0.0};
static const emit_surface ivory = {1.00, 0.98, 0.92, 0.65, 0.35, 60.0, 0.0, 0.0};
static const emit_surface hollow = {0.02, 0.01, 0.02, 0.30, 0.0, EMIT_DULL, 0.0, 0.0};
static const emit_surface ember = {1.00, 0.25, 0.05, 0.90, 0.30, 20.0, 0.0, 0.0};
static const emit_surface table = {0.10, 0.12, 0.20, 0.50, 0.45, 80.0, 0.0, 0.0};

typedef struct pen {
    const aset_sink *sink;
    aset_status status; /* the first error; nothing is emitted behind it */
} pen;

/* A corner of a tube. */
typedef struct knot {
    double x, y, z, radius;
} knot;

static void material(pen *p, const emit_surface *surface) {
    if (p->status == ASET_OK) {
        p->status = aset_emit_material(p->sink, surface);
    }
}

static void polygon(pen *p, const emit_point *points, uint32_t n_points) {
    if (p->status == ASET_OK) {
        p->status = aset_emit_polygon(p->sink, points, NULL, n_points);
    }
}

static emit_point point_of(const knot *k, double mirror) {
    emit_point point;
    point.x = mirror * k->x;
    point.y = k->y;
    point.z = k->z;
    return point;
}

static void ball(pen *p, const knot *k, double mirror) {
    emit_point centre = point_of(k, mirror);
    if (p->status == ASET_OK) {
        p->status = aset_emit_sphere(p->sink, &centre, k->radius);
    }
}

static void shaft(pen *p, const knot *from, const knot *to, double mirror) {
    emit_point base = point_of(from, mirror), apex = point_of(to, mirror);
    if (p->status == ASET_OK) {
        p->status = aset_emit_cone(p->sink, &base, from->radius, &apex, to->radius);
    }
}

/* A ball at each knot and a shaft from each to the next: 2 n - 1 objects, and one shaft more if it is closed. */
static void tube(pen *p, const knot *knots, uint32_t n, bool closed, double mirror) {
    for (uint32_t i = 0; i < n; i++) {
        ball(p, &knots[i], mirror);
        if (i + 1 < n || closed) {
            shaft(p, &knots[i], &knots[(i + 1) % n], mirror);
        }
    }
}

static void tubes(pen *p, const knot *knots, uint32_t n) {
    tube(p, knots, n, false, 1.0);
    tube(p, knots, n, false, -1.0);
}

static void balls(pen *p, const knot *knots, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        ball(p, &knots[i], 1.0);
        if (knots[i].x > 0.0) {
            ball(p, &knots[i], -1.0);
        }
    }
}

static void emit_cranium(pen *p) {
    static const knot parts[] = {
        {0.00, 0.28, 0.62, 0.92}, {0.00, -0.02, 0.70, 0.74}, {0.00, 0.62, 0.50, 0.74}, {0.34, -0.10, 0.60, 0.52},
        {0.00, 0.10, -0.10, 0.45}};
    balls(p, parts, 5);
}

/* The bony ring around an eye's hollow, 12 knots: a rounded square that recedes towards the temple. */
static void emit_orbits(pen *p) {
    static const double x[12] = {0.26, 0.25, 0.16, 0.0, -0.15, -0.22, -0.23, -0.20, -0.12, 0.02, 0.16, 0.24};
    static const double z[12] = {0.00, 0.13, 0.21, 0.23, 0.20, 0.11, 0.00, -0.12, -0.21, -0.23, -0.20, -0.12};
    knot ring[12];
    for (uint32_t i = 0; i < 12; i++) {
        ring[i].x = 0.37 + x[i];
        ring[i].y = -0.80 + 0.9 * ring[i].x * ring[i].x - (z[i] > 0.0 ? 0.25 * z[i] : 0.0);
        ring[i].z = 0.20 + z[i] - 0.15 * x[i];
        ring[i].radius = 0.085;
    }
    tube(p, ring, 12, true, 1.0);
    tube(p, ring, 12, true, -1.0);
}

static void emit_face(pen *p) {
    static const knot brow[] = {{0.06, -0.82, 0.42, 0.10}, {0.34, -0.80, 0.50, 0.11}, {0.64, -0.50, 0.40, 0.10}};
    static const knot nose[] = {{0.06, -0.82, 0.36, 0.08}, {0.08, -0.90, 0.12, 0.06}, {0.16, -0.82, -0.14, 0.06}};
    static const knot cheek[] = {
        {0.22, -0.74, -0.30, 0.13}, {0.52, -0.56, -0.12, 0.14}, {0.74, -0.26, -0.02, 0.09}, {0.78, 0.06, 0.04, 0.08}};
    static const knot jaw[] = {{0.00, -0.62, -0.32, 0.30}, {0.20, -0.58, -0.30, 0.24}};
    static const knot gum[] = {
        {0.00, -0.86, -0.50, 0.09}, {0.14, -0.82, -0.50, 0.09}, {0.26, -0.71, -0.49, 0.09}, {0.35, -0.55, -0.47, 0.09}};
    tubes(p, brow, 3);
    tubes(p, nose, 3);
    tubes(p, cheek, 4);
    balls(p, jaw, 2);
    tubes(p, gum, 4);
}

static void emit_mandible(pen *p) {
    static const knot half[] = {{0.00, -0.86, -1.10, 0.14}, {0.20, -0.80, -1.09, 0.13}, {0.38, -0.60, -1.03, 0.11},
                                {0.52, -0.30, -0.92, 0.11}, {0.60, -0.06, -0.76, 0.12}, {0.66, 0.04, -0.40, 0.10},
                                {0.68, 0.06, -0.04, 0.08}};
    static const knot gum[] = {
        {0.00, -0.84, -0.99, 0.09}, {0.14, -0.80, -0.98, 0.09}, {0.26, -0.69, -0.97, 0.09}, {0.35, -0.53, -0.95, 0.09}};
    static const knot chin[] = {{0.09, -0.90, -1.14, 0.11}};
    tubes(p, half, 7);
    tubes(p, gum, 4);
    balls(p, chin, 1);
}

/* Ten teeth above and ten below along a parabola; a tapering shaft and a rounded end each. */
static void emit_teeth(pen *p) {
    for (uint32_t i = 0; i < 10; i++) {
        double x = 0.074 * (i - 4.5), y = -0.90 + 2.3 * x * x, wide = x * x < 0.004 ? 0.043 : 0.037;
        knot root = {0.0, 0.0, -0.50, 0.030}, end = {0.0, 0.0, -0.69, 0.0};
        root.x = end.x = x;
        root.y = end.y = y;
        end.radius = wide;
        shaft(p, &root, &end, 1.0);
        ball(p, &end, 1.0);
        root.z = -0.98;
        root.y = end.y = y + 0.02;
        end.z = -0.79;
        end.radius = 0.036;
        shaft(p, &root, &end, 1.0);
        ball(p, &end, 1.0);
    }
}

/* The hollows of the eyes, and the nose's as a polygon, a heart upside down. */
static void emit_hollows(pen *p) {
    static const knot eye[] = {{0.36, -0.42, 0.20, 0.27}};
    static const emit_point heart[] = {
        {0.00, -0.945, 0.10},   {-0.06, -0.945, 0.04},  {-0.13, -0.945, -0.10}, {-0.13, -0.945, -0.17},
        {-0.07, -0.945, -0.20}, {0.00, -0.945, -0.14},  {0.07, -0.945, -0.20},  {0.13, -0.945, -0.17},
        {0.13, -0.945, -0.10},  {0.06, -0.945, 0.04}};
    balls(p, eye, 1);
    polygon(p, heart, 10);
}

static void emit_bones(pen *p) {
    static const knot bones[] = {{1.45, 0.95, -1.05, 0.11}, {-1.45, 0.95, 0.95, 0.11}};
    static const knot ends[] = {
        {1.52, 0.95, -1.00, 0.16}, {1.42, 0.95, -1.13, 0.15}, {1.52, 0.95, 0.92, 0.16}, {1.42, 0.95, 1.06, 0.16}};
    shaft(p, &bones[0], &bones[1], 1.0);
    shaft(p, &bones[0], &bones[1], -1.0);
    balls(p, ends, 4);
}

aset_status aset_procedural_skull(const aset_sink *sink, uint32_t size) {
    static const emit_point from = {-1.5, -5.6, 0.7}, to = {0.0, 0.0, -0.02}, up = {0.0, 0.0, 1.0};
    static const emit_point lights[2] = {{-5.0, -5.0, 6.0}, {4.0, -6.0, 0.5}};
    static const emit_point top[4] = {{-2.0, -1.6, -1.30}, {2.0, -1.6, -1.30}, {2.0, 1.6, -1.30}, {-2.0, 1.6, -1.30}};
    static const knot eye[] = {{0.36, -0.70, 0.20, 0.06}};
    pen p;
    p.sink = sink;
    p.status = EMIT_SIZE(skull, &size);
    if (p.status == ASET_OK) {
        p.status = aset_emit_background(sink, 0.03, 0.01, 0.05);
    }
    if (p.status == ASET_OK) {
        p.status = aset_emit_view(sink, &from, &to, &up, 38.0, 512);
    }
    for (uint32_t i = 0; i < 2 && p.status == ASET_OK; i++) {
        p.status = aset_emit_light(sink, &lights[i]);
    }
    material(&p, &bone);
    emit_cranium(&p);
    emit_orbits(&p);
    emit_face(&p);
    emit_mandible(&p);
    emit_bones(&p);
    material(&p, &ivory);
    emit_teeth(&p);
    material(&p, &hollow);
    emit_hollows(&p);
    material(&p, &ember);
    balls(&p, eye, 1);
    material(&p, &table);
    polygon(&p, top, 4);
    return p.status;
}

#else
EMIT_UNSUPPORTED(skull)
#endif
