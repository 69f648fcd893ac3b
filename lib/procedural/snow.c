/*
 * snow.c - a winter night of 813 polygons and spheres: a frozen pond with icicles, a snowman, firs, a heap of snowballs,
 * snow blown upwards from it, and three crystals of snow in the sky.
 *
 * Stands for the SNOW scene of Dauenhauer and Semwal, "Approximate Ray Tracing" (Graphics Interface 1990), whose objects
 * were never published. What is known of it and holds here as well (a test says so): 813 polygons and spheres, and 1.3,
 * 2.1 and 3.9 objects per non-empty side of a cell at 100, 50 and 30 divisions. The constants below were found by a
 * search for these three numbers. What brings them about:
 *
 *   - nearly all objects are small and stand in clusters: at 30 divisions several share a cell, at 100 few do;
 *   - a crystal is thick: its branches lie in two layers, apart at 100 divisions, together at 30;
 *   - two far flakes stretch the volume, so that the subject fills the middle of it.
 *
 * The textures of cells stay few: there are three materials, and ice never shares a cell with the others, because the pond
 * lies just below a slice and all that stands on it begins just above. With that slice at 3/10 of the height it is one at
 * 100, 50 and 30 divisions alike.
 */
#include "emit.h"

#if ASET_WITH_POLYGONS && ASET_WITH_SPHERES

#include <math.h>

static const emit_surface ice = {0.64, 0.83, 1.00, 0.58, 0.40, 40.0, 0.0, 0.0};
static const emit_surface white = {1.00, 0.98, 0.96, 0.80, 0.10, 12.0, 0.0, 0.0};
static const emit_surface red = {0.90, 0.10, 0.08, 0.75, 0.10, 30.0, 0.0, 0.0};

/* Half the gap between the pond and what stands on it: the slice lies in its middle. Boxes grow by less, about 3e-5. */
static const double gap = 0.003;

/* The volume: the pond's height is 0, and it goes down by 3 parts of 10 and up by 7 */
static const double volume_height = 2.31;
static const double volume_half_width = 2.24;
static const double volume_front = -1.36;
static const double volume_back = 4.55;

static const double pond_x = 0.887;
static const double pond_y = 0.754;
static const double icicle = 1.01;

/* Crystals, in units of their size: a joint of an arm, the half width and half twist of a needle, half the thickness */
static const double joint_length = 0.0542;
static const double needle_width = 0.0131;
static const double needle_twist = 0.0104;
static const double needle_spine = 0.96;
static const double needle_branch = 1.17;
static const double layer = 0.0525;
static const double left_size = 0.73;
static const double right_size = 0.79;

static const double heap_ball = 0.0256;
static const double drift_ball = 0.0126;
static const double drift_more = 0.0150;
static const double drift_spread = 0.0585;
static const double plume_width = 0.0394;
static const double plume_depth = 1.57;
static const double plume_1x = -0.43;
static const double plume_2x = 1.03;
static const double plume_3x = -0.013;
static const double plume_3z = 1.20;

static const double man_x = -0.28;
static const double man_y = -0.10;

/* What the parts share: where entities go, the first error (nothing is emitted after it), the random numbers' state. */
typedef struct pen {
    const aset_sink *sink;
    aset_status status;
    uint32_t state;
} pen;

/* A crystal's own coordinates: u and v span its plane, w points out of it. Unit length times the crystal's size. */
typedef struct frame {
    emit_point centre, u, v, w;
} frame;

typedef struct flat {
    double x, y;
} flat;

enum { max_joints = 10 };

typedef struct crystal {
    double plate, joint, width; /* radius of the hexagon in the middle; a joint's length; a needle's half width */
    uint32_t n_joints;
    uint32_t branches[max_joints]; /* needles of each of the two branches that leave a joint */
} crystal;

/* cos and sin of 0, 60 ... 300 degrees */
#define HALF_ROOT_3 0.86602540378443864676
static const flat sixth[6] = {{1.0, 0.0},  {0.5, HALF_ROOT_3},   {-0.5, HALF_ROOT_3},
                              {-1.0, 0.0}, {-0.5, -HALF_ROOT_3}, {0.5, -HALF_ROOT_3}};

/* At least 0, below 1: the upper 24 bits of a linear congruential generator (Knuth's multiplier for 32 bits). */
static double chance(pen *p) {
    p->state = p->state * 1664525u + 1013904223u;
    return (double)(p->state >> 8) / 16777216.0;
}

/* Between -1 and 1, most often near 0. */
static double spread(pen *p) {
    double first = chance(p);
    return first + chance(p) - 1.0;
}

static emit_point at(double x, double y, double z) {
    emit_point point;
    point.x = x;
    point.y = y;
    point.z = z;
    return point;
}

static void material(pen *p, const emit_surface *surface) {
    if (p->status == ASET_OK) {
        p->status = aset_emit_material(p->sink, surface);
    }
}

static void ball(pen *p, emit_point centre, double radius) {
    if (p->status == ASET_OK) {
        p->status = aset_emit_sphere(p->sink, &centre, radius);
    }
}

static void polygon(pen *p, const emit_point *points, uint32_t n_points) {
    if (p->status == ASET_OK) {
        p->status = aset_emit_polygon(p->sink, points, NULL, n_points);
    }
}

static void triangle(pen *p, emit_point a, emit_point b, emit_point c) {
    emit_point points[3];
    points[0] = a;
    points[1] = b;
    points[2] = c;
    polygon(p, points, 3);
}

/* A frame whose crystal looks towards -y, turned aside and leaning back by these slopes. */
static frame facing(emit_point centre, double aside, double back, double size) {
    frame f;
    double level = size / sqrt(1.0 + aside * aside);
    double slope = size / sqrt(1.0 + aside * aside + back * back);
    f.centre = centre;
    f.u = at(level, level * aside, 0.0);
    f.w = at(slope * aside, -slope, slope * back);
    f.v.x = (f.w.y * f.u.z - f.w.z * f.u.y) / size;
    f.v.y = (f.w.z * f.u.x - f.w.x * f.u.z) / size;
    f.v.z = (f.w.x * f.u.y - f.w.y * f.u.x) / size;
    return f;
}

/* The point of a frame that arm 0 has at flat, on another arm and out of the plane by height. */
static emit_point in_frame(const frame *f, uint32_t arm, flat point, double height) {
    double x = point.x * sixth[arm].x - point.y * sixth[arm].y;
    double y = point.x * sixth[arm].y + point.y * sixth[arm].x;
    return at(f->centre.x + x * f->u.x + y * f->v.x + height * f->w.x,
              f->centre.y + x * f->u.y + y * f->v.y + height * f->w.y,
              f->centre.z + x * f->u.z + y * f->v.z + height * f->w.z);
}

typedef struct needle {
    flat base;
    uint32_t direction; /* sixths of a turn from the arm's */
    double length, half, twist, height;
} needle;

/* A spine needle is a rhombus, the others are triangles on a broad base; twisted about their length, so that they glint. */
static void emit_needle(pen *p, const frame *f, uint32_t arm, const needle *n, bool spine) {
    flat along = sixth[n->direction];
    double broadest = n->length * (spine ? 0.45 : 0.12);
    flat middle = {n->base.x + broadest * along.x, n->base.y + broadest * along.y};
    flat left = {middle.x - n->half * along.y, middle.y + n->half * along.x};
    flat right = {middle.x + n->half * along.y, middle.y - n->half * along.x};
    flat tip = {n->base.x + n->length * along.x, n->base.y + n->length * along.y};
    emit_point points[4];
    points[0] = in_frame(f, arm, right, n->height - n->twist);
    points[1] = in_frame(f, arm, tip, n->height);
    points[2] = in_frame(f, arm, left, n->height + n->twist);
    points[3] = in_frame(f, arm, n->base, n->height);
    polygon(p, points, spine ? 4 : 3);
}

/* The two branches of joint j, 60 degrees to the left and to the right; the layers change sides from joint to joint. */
static void emit_branches(pen *p, const frame *f, const crystal *c, uint32_t arm, uint32_t j, flat base) {
    double pitch = c->joint * 0.63;
    for (uint32_t side = 0; side < 2; side++) {
        double sign = side == 0 ? -1.0 : 1.0;
        needle n;
        n.base.x = base.x + 0.5 * c->joint;
        n.base.y = base.y;
        n.direction = side == 0 ? 5 : 1;
        n.length = pitch * needle_branch;
        n.half = 0.9 * c->width;
        n.height = j % 2 == 0 ? sign * layer : -sign * layer;
        for (uint32_t i = 0; i < c->branches[j]; i++) {
            n.twist = i % 2 == 0 ? -sign * needle_twist : sign * needle_twist;
            emit_needle(p, f, arm, &n, false);
            n.base.x += pitch * sixth[n.direction].x;
            n.base.y += pitch * sixth[n.direction].y;
        }
    }
}

/* 1 + 6 (n_joints + 2 sum of branches) polygons. */
static void emit_crystal(pen *p, const frame *f, const crystal *c) {
    flat corner = {c->plate, 0.0};
    emit_point plate[6];
    for (uint32_t arm = 0; arm < 6; arm++) {
        plate[arm] = in_frame(f, arm, corner, 0.0);
    }
    polygon(p, plate, 6);
    for (uint32_t arm = 0; arm < 6; arm++) {
        needle n = {{0.6 * c->plate, 0.0}, 0, 0.0, 0.0, 0.0, 0.0};
        n.length = c->joint * needle_spine;
        n.half = c->width;
        for (uint32_t j = 0; j < c->n_joints; j++) {
            n.twist = (j + arm) % 2 == 0 ? -needle_twist : needle_twist;
            emit_needle(p, f, arm, &n, true);
            emit_branches(p, f, c, arm, j, n.base);
            n.base.x += c->joint;
        }
    }
}

/* 325 + 121 + 61 polygons. */
static void emit_crystals(pen *p) {
    const crystal great = {0.075, joint_length, needle_width, 10, {1, 2, 4, 4, 3, 3, 2, 2, 1, 0}};
    const crystal left = {0.050, joint_length, 1.05 * needle_width, 6, {1, 2, 2, 1, 1, 0}};
    const crystal right = {0.050, joint_length, 1.05 * needle_width, 4, {1, 1, 1, 0}};
    frame f = facing(at(0.20, 0.90, 0.76), 0.10, 0.15, 1.0);
    emit_crystal(p, &f, &great);
    f = facing(at(-0.62, 0.20, 0.90), -0.15, 0.20, left_size);
    emit_crystal(p, &f, &left);
    f = facing(at(0.86, 0.10, 0.55), 0.20, 0.20, right_size);
    emit_crystal(p, &f, &right);
}

/* The pond's 24 corners, 15 degrees from each other, from +x to +y. */
static void pond_corners(emit_point corners[24]) {
    const double cos_15 = 0.96592582628906828675, sin_15 = 0.25881904510252076235;
    double x = 1.0, y = 0.0;
    for (uint32_t i = 0; i < 24; i++) {
        double next = x * cos_15 - y * sin_15;
        corners[i] = at(pond_x * x, pond_y * y, -gap);
        y = x * sin_15 + y * cos_15;
        x = next;
    }
}

/* The ice and two icicles below each edge of its front half: 25 polygons. */
static void emit_pond(pen *p, const emit_point corners[24]) {
    polygon(p, corners, 24);
    for (uint32_t i = 0; i < 24; i++) {
        emit_point from = corners[12 + i / 2], to = corners[(13 + i / 2) % 24];
        emit_point middle = at(0.5 * (from.x + to.x), 0.5 * (from.y + to.y), -gap);
        emit_point a = i % 2 == 0 ? from : middle, b = i % 2 == 0 ? middle : to;
        double length = icicle * (0.06 + 0.16 * chance(p));
        triangle(p, a, at(0.49 * (a.x + b.x), 0.49 * (a.y + b.y), -gap - length), b);
    }
}

/* Six flakes: four in the sky, and the two that stretch the volume. */
static void emit_flakes(pen *p) {
    ball(p, at(-0.93, -0.20, 1.10), 0.011);
    ball(p, at(-0.30, 0.10, 1.20), 0.009);
    ball(p, at(0.88, -0.30, 0.95), 0.010);
    ball(p, at(-0.75, 0.00, 0.45), 0.009);
    ball(p, at(-volume_half_width, volume_back, 0.7 * volume_height - 0.015), 0.015);
    ball(p, at(volume_half_width, volume_front, -0.3 * volume_height + 0.015), 0.015);
}

/* Three pyramids on each other, four triangles each. */
static void emit_fir(pen *p, double x, double y, double height) {
    static const flat quarter[4] = {{0.8, 0.6}, {-0.6, 0.8}, {-0.8, -0.6}, {0.6, -0.8}};
    for (uint32_t tier = 0; tier < 3; tier++) {
        double z = height * (0.12 + 0.22 * tier), radius = height * (0.26 - 0.07 * tier);
        double mirror = tier == 1 ? -radius : radius;
        for (uint32_t k = 0; k < 4; k++) {
            flat a = quarter[k], b = quarter[(k + 1) % 4];
            triangle(p, at(x + radius * a.x, y + mirror * a.y, z), at(x + radius * b.x, y + mirror * b.y, z),
                     at(x, y, z + 0.36 * height));
        }
    }
}

/* A pyramid of 16 + 9 + 4 + 1 snowballs; each lies in the hollow of four, so layers are sqrt(2) radii apart. */
static void emit_heap(pen *p) {
    for (uint32_t level = 0; level < 4; level++) {
        for (uint32_t i = 0; i < 4 - level; i++) {
            for (uint32_t j = 0; j < 4 - level; j++) {
                double x = 0.16 + 2.0 * heap_ball * (i + 0.5 * level), y = -0.30 + 2.0 * heap_ball * (j + 0.5 * level);
                ball(p, at(x, y, gap + heap_ball * (1.0 + 1.4142135623730950488 * level)), heap_ball);
            }
        }
    }
}

/* Snow along the shore: six balls at every other corner, 72. */
static void emit_drifts(pen *p, const emit_point corners[24]) {
    for (uint32_t i = 0; i < 72; i++) {
        emit_point corner = corners[i / 6 * 2 + 1];
        double along = drift_spread * ((i % 6) - 2.5 + spread(p));
        double inward = 0.89 + 0.08 * chance(p);
        double radius = drift_ball + drift_more * chance(p);
        ball(p, at(inward * corner.x - along * corner.y, inward * corner.y + along * corner.x, gap + radius), radius);
    }
}

/* Snow blown from the heap into the sky: 124 flakes about a cubic Bezier curve, wider towards its end. */
static void emit_plume(pen *p) {
    const emit_point ends[4] = {
        {0.55, -0.35, 0.05}, {plume_1x, -0.60, 0.20}, {plume_2x, 0.30, 0.85}, {plume_3x, 0.10, plume_3z}};
    for (uint32_t i = 0; i < 124; i++) {
        double s = (i + chance(p)) / 124.0, r = 1.0 - s, width = plume_width * (0.5 + s), radius;
        double weight[4] = {r * r * r, 3.0 * r * r * s, 3.0 * r * s * s, s * s * s};
        emit_point centre = {0.0, 0.0, 0.0};
        for (uint32_t k = 0; k < 4; k++) {
            centre.x += weight[k] * ends[k].x;
            centre.y += weight[k] * ends[k].y;
            centre.z += weight[k] * ends[k].z;
        }
        centre.x += 1.5 * width * spread(p);
        centre.y += plume_depth * width * spread(p);
        centre.z += width * spread(p);
        radius = 0.004 + 0.005 * chance(p);
        ball(p, centre, radius);
    }
}

/* A hexagonal brim, a hexagon on top and six sides between. */
static void emit_hat(pen *p, double x, double y, double z) {
    emit_point brim[6], low[6], high[6];
    for (uint32_t k = 0; k < 6; k++) {
        brim[k] = at(x + 0.075 * sixth[k].x, y + 0.075 * sixth[k].y, z);
        low[k] = at(x + 0.045 * sixth[k].x, y + 0.045 * sixth[k].y, z);
        high[k] = at(low[k].x, low[k].y, z + 0.085);
    }
    polygon(p, brim, 6);
    polygon(p, high, 6);
    for (uint32_t k = 0; k < 6; k++) {
        emit_point side[4];
        side[0] = low[k];
        side[1] = low[(k + 1) % 6];
        side[2] = high[(k + 1) % 6];
        side[3] = high[k];
        polygon(p, side, 4);
    }
}

/* What he wears: hat, nose of 3 triangles, 3 buttons, 2 eyes, arms of 2 triangles and a mitten each. */
static void emit_attire(pen *p) {
    static const flat third[3] = {{0.0, 1.0}, {-HALF_ROOT_3, -0.5}, {HALF_ROOT_3, -0.5}};
    emit_point nose = at(man_x + 0.035, man_y - 0.14, 0.415);
    emit_hat(p, man_x, man_y, 0.482);
    for (uint32_t k = 0; k < 3; k++) {
        flat a = third[k], b = third[(k + 1) % 3];
        triangle(p, at(man_x + 0.012 + 0.016 * a.x, man_y - 0.055, 0.42 + 0.016 * a.y),
                 at(man_x + 0.012 + 0.016 * b.x, man_y - 0.055, 0.42 + 0.016 * b.y), nose);
        ball(p, at(man_x + 0.02, man_y - (k == 1 ? 0.085 : 0.08), 0.25 + 0.035 * k), 0.009);
    }
    ball(p, at(man_x - 0.012, man_y - 0.057, 0.442), 0.008);
    ball(p, at(man_x + 0.036, man_y - 0.052, 0.442), 0.008);
    for (uint32_t side = 0; side < 2; side++) {
        double k = side == 0 ? -1.0 : 1.0;
        emit_point upper = at(man_x + 0.150 * k, man_y - 0.040, 0.350), lower = at(man_x + 0.145 * k, man_y - 0.040, 0.335);
        triangle(p, at(man_x + 0.080 * k, man_y - 0.010, 0.310), at(man_x + 0.085 * k, man_y - 0.010, 0.290),
                 at(man_x + 0.200 * k, man_y - 0.060, 0.380));
        triangle(p, upper, lower, at(man_x + 0.200 * k, man_y - 0.030, 0.340));
        ball(p, at(man_x + 0.200 * k, man_y - 0.060, 0.380), 0.022);
    }
}

static void emit_man(pen *p) {
    ball(p, at(man_x, man_y, gap + 0.115), 0.115);
    ball(p, at(man_x, man_y, 0.29), 0.085);
    ball(p, at(man_x, man_y, 0.42), 0.062);
}

static aset_status emit_sight(const aset_sink *sink) {
    const emit_point from = {0.30, -2.90, 2.05}, to = {0.04, 0.0, 0.41}, up = {0.0, 0.0, 1.0};
    const emit_point lights[2] = {{-3.0, -4.0, 5.0}, {4.0, -3.0, 2.0}};
    aset_status status = aset_emit_background(sink, 0.02, 0.05, 0.16);
    if (status == ASET_OK) {
        status = aset_emit_view(sink, &from, &to, &up, 36.5, 512);
    }
    for (uint32_t i = 0; i < 2 && status == ASET_OK; i++) {
        status = aset_emit_light(sink, &lights[i]);
    }
    return status;
}

aset_status aset_procedural_snow(const aset_sink *sink, uint32_t size) {
    emit_point corners[24];
    pen p;
    p.sink = sink;
    p.state = 7;
    p.status = EMIT_SIZE(snow, &size);
    if (p.status == ASET_OK) {
        p.status = emit_sight(sink);
    }
    pond_corners(corners);
    material(&p, &ice);
    emit_pond(&p, corners);
    emit_crystals(&p);
    emit_flakes(&p);
    material(&p, &white);
    emit_fir(&p, 0.42, 0.35, 0.36);
    emit_fir(&p, 0.62, 0.20, 0.28);
    emit_heap(&p);
    emit_man(&p);
    emit_drifts(&p, corners);
    emit_plume(&p);
    material(&p, &red);
    emit_attire(&p);
    return p.status;
}

#else
EMIT_UNSUPPORTED(snow)
#endif
