/*
 * test_oracle.c - closest hits against the same geometry in quadruple precision: how much t errs on each kind of object, in units in
 * the last place of t itself, and that no other object is taken for the nearest one where the gap between them exceeds the bound.
 *
 * The bound. With u half a unit in the last place of 1, a hit lies within BOUND u (|origin| + t + |the object's coordinates|) of
 * the surface, and so t within that divided by the cosine between ray and normal. New rays start four times as far off the surface (shade.c).
 * Rays that pass an edge, a rim or a silhouette within that distance, or graze the surface, are left to rounding and counted.
 *
 * ASET_LONG=1: a million rays instead of ten thousand. ASET_TABLES=FILE: appends the table of errors, in Markdown.
 * Skipped where the compiler has no __float128.
 */
#include "support/support.h"

#include "base/vec.h"

#include <math.h>

#ifdef __SIZEOF_FLOAT128__

__extension__ typedef __float128 quad;

#define BOUND 8
/* Rays that meet the surface flatter than this are left to rounding. */
#define GRAZING 1e-3
/* The same for cones, of quantities that vanish where it is grazed: there is no plain distance. */
#define NEARLY 1e-3

enum { OBJECTS = 10, RAYS_A_SCENE = 200, RAYS = 10000, RAYS_LONG = 1000000 };

/* --- vectors --- */

typedef struct qvec {
    quad x, y, z;
} qvec;

static qvec qmake(quad x, quad y, quad z) {
    qvec v = {x, y, z};
    return v;
}

static qvec qof(aset_vec3 v) {
    return qmake(v.x, v.y, v.z);
}

static qvec qsub(qvec a, qvec b) {
    return qmake(a.x - b.x, a.y - b.y, a.z - b.z);
}

static qvec qalong(qvec a, quad s, qvec b) {
    return qmake(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static quad qdot(qvec a, qvec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static qvec qcross(qvec a, qvec b) {
    return qmake(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static quad qabs(quad x) {
    return x < 0 ? -x : x;
}

/* Newton's steps from the double's root: 53 good bits, 106, all. */
static quad qsqrt(quad x) {
    if (!(x > 0)) {
        return 0;
    }
    quad root = sqrt((double)x);
    root = (root + x / root) / 2;
    return (root + x / root) / 2;
}

static quad qlength(qvec a) {
    return qsqrt(qdot(a, a));
}

static qvec qunit(qvec a) {
    quad length = qlength(a);
    return qmake(a.x / length, a.y / length, a.z / length);
}

/* --- the rays, and what they meet --- */

typedef struct qray {
    qvec origin, direction; /* as given, of nearly unit length */
    qvec unit, right, up;   /* and a frame about it */
    quad length;
} qray;

typedef struct answer {
    bool hit, unclear;
    quad t;     /* in unit lengths */
    quad bound; /* of its error */
} answer;

static const answer missed = {false, false, 0, 0}, unclear = {false, true, 0, 0};

static quad largest_of(const thing *t) {
    double largest = 0;
    uint32_t n = t->kind == THING_SPHERE ? 1 : t->kind == THING_CONE ? 2 : t->n_points;
    for (uint32_t i = 0; i < n; i++) {
        dvec p = dvec_of(t->points[i]);
        largest = fmax(largest, fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))));
    }
    return largest + fmax(fabs((double)t->radii[0]), fabs((double)t->radii[1]));
}

/* How far from the surface a hit at about t may be told. */
static quad slack(const qray *ray, const thing *t, quad at) {
    return BOUND * (quad)REAL_UNIT * (qlength(ray->origin) + qabs(at) + largest_of(t));
}

static answer hit_at(const qray *ray, const thing *t, quad at, quad cosine) {
    quad off = slack(ray, t, at);
    if (qabs(cosine) < GRAZING || qabs(at) < off / qabs(cosine)) {
        return unclear;
    }
    answer a = {at > 0, false, at, off / qabs(cosine)};
    return a;
}

/* The distance of 0 from a segment of the plane across the ray. */
static quad segment_distance(quad ax, quad ay, quad bx, quad by) {
    quad dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
    quad share = square > 0 ? -(ax * dx + ay * dy) / square : 0;
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    quad x = ax + share * dx, y = ay + share * dy;
    return qsqrt(x * x + y * y);
}

static answer polygon_answer(const qray *ray, const thing *t) {
    qvec normal = {0, 0, 0}, first = qof(t->points[0]);
    bool inside = false;
    quad nearest = HUGE_VAL;
    for (uint32_t i = 0; i < t->n_points; i++) {
        qvec p = qof(t->points[i]), q = qof(t->points[(i + 1) % t->n_points]);
        qvec a = qsub(p, ray->origin), b = qsub(q, ray->origin), n = qcross(qsub(p, first), qsub(q, first));
        normal = qalong(normal, 1, n);
        quad ax = qdot(a, ray->right), ay = qdot(a, ray->up), bx = qdot(b, ray->right), by = qdot(b, ray->up);
        quad away = segment_distance(ax, ay, bx, by);
        nearest = away < nearest ? away : nearest;
        if ((ay > 0) != (by > 0) && (ax * by - ay * bx > 0) == (by > ay)) {
            inside = !inside;
        }
    }
    normal = qunit(normal);
    quad cosine = qdot(normal, ray->unit), at = qdot(normal, qsub(first, ray->origin)) / cosine;
    if (nearest < slack(ray, t, at)) {
        return unclear;
    }
    return inside ? hit_at(ray, t, at, cosine) : missed;
}

static answer sphere_answer(const qray *ray, const thing *t) {
    qvec f = qsub(qof(t->points[0]), ray->origin);
    quad middle = qdot(f, ray->unit), radius = qabs(t->radii[0]), past = qlength(qalong(f, -middle, ray->unit));
    if (qabs(past - radius) < slack(ray, t, middle)) {
        return unclear;
    }
    if (past > radius) {
        return missed;
    }
    quad half = qsqrt(radius * radius - past * past), cosine = half / radius;
    answer in = hit_at(ray, t, middle - half, cosine), out = hit_at(ray, t, middle + half, cosine);
    bool sees_entry = t->radii[0] > 0;
    return in.unclear || (sees_entry && in.hit) ? in : out;
}

/* One root of a cone: is it between the ends? */
static answer cone_root(const qray *ray, const thing *t, quad at, qvec base, qvec axis, quad height, quad slope) {
    qvec from_base = qsub(qalong(ray->origin, at, ray->unit), base);
    quad m = qdot(from_base, axis), near = NEARLY * height;
    if (qabs(m) < near || qabs(m - height) < near) {
        return unclear;
    }
    if (m < 0 || m > height) {
        return missed;
    }
    qvec normal = qunit(qalong(qunit(qalong(from_base, -m, axis)), -slope, axis));
    quad cosine = qdot(normal, ray->unit);
    bool inside_only = t->radii[0] < 0 || t->radii[1] < 0;
    return inside_only && cosine < 0 ? missed : hit_at(ray, t, at, cosine);
}

static answer cone_answer(const qray *ray, const thing *t) {
    qvec base = qof(t->points[0]), along = qsub(qof(t->points[1]), base), f = qsub(ray->origin, base);
    quad height = qlength(along), r0 = qabs(t->radii[0]), slope = (qabs(t->radii[1]) - r0) / height;
    qvec axis = qunit(along);
    quad fk = qdot(f, axis), dk = qdot(ray->unit, axis);
    qvec fa = qalong(f, -fk, axis), da = qalong(ray->unit, -dk, axis);
    quad radius = r0 + slope * fk, a = qdot(da, da) - slope * slope * dk * dk, b = qdot(fa, da) - slope * dk * radius;
    quad c = qdot(fa, fa) - radius * radius, under_root = b * b - a * c;
    quad wider = qabs(t->radii[1]) > r0 ? qabs(t->radii[1]) : r0;
    if (qabs(a) < NEARLY || qabs(under_root) < NEARLY * wider * wider) {
        return unclear;
    }
    if (under_root < 0) {
        return missed;
    }
    quad root = qsqrt(under_root), ends[2] = {(-b - root) / a, (-b + root) / a};
    for (int i = 0; i < 2; i++) {
        answer found = cone_root(ray, t, ends[(a > 0) == (i == 0) ? 0 : 1], base, axis, height, slope);
        if (found.hit || found.unclear) {
            return found;
        }
    }
    return missed;
}

static answer answer_of(const qray *ray, const thing *t) {
    switch (t->kind) {
    case THING_SPHERE: return sphere_answer(ray, t);
    case THING_CONE: return cone_answer(ray, t);
    default: return polygon_answer(ray, t);
    }
}

static qray qray_of(const aset_ray *ray) {
    qray q;
    q.origin = qof(ray->origin);
    q.direction = qof(ray->direction);
    q.length = qlength(q.direction);
    q.unit = qunit(q.direction);
    qvec other = qabs(q.unit.x) < 0.6 ? qmake(1, 0, 0) : qmake(0, 1, 0);
    q.right = qunit(qcross(q.unit, other));
    q.up = qcross(q.unit, q.right);
    return q;
}

/* --- comparing --- */

typedef struct errors {
    double *list; /* in units in the last place of t */
    uint32_t n, capacity;
    double most; /* in the bound's unit: off the surface, by u (|origin| + t + |coordinates|) */
} errors;

typedef struct tally {
    errors kinds[THING_KINDS];
    uint64_t rays, unclear, hits;
} tally;

static void note(errors *e, double ulps, double off) {
    if (e->n == e->capacity) {
        e->capacity = e->capacity > 0 ? 2 * e->capacity : 1024;
        e->list = realloc(e->list, e->capacity * sizeof *e->list);
        assert_non_null(e->list);
    }
    e->list[e->n++] = ulps;
    e->most = fmax(e->most, off);
}

/* The distance to the next number above x > 0. */
static double ulp_of(double x) {
    int exponent;
    (void)frexp(x, &exponent);
    return ldexp((double)REAL_UNIT, exponent);
}

static void compare(tally *sum, const model *m, const aset_tracer *tracer, const aset_ray *ray, uint64_t seed) {
    qray q = qray_of(ray);
    answer best = missed, second = missed;
    uint32_t nearest = ASET_NO_OBJECT;
    aset_hit hit;
    bool found;
    assert_int_equal(aset_closest_hit(&found, &hit, tracer, ray, false, NULL), ASET_OK);
    sum->rays++;
    for (uint32_t i = 0; i < m->n_things; i++) {
        answer a = answer_of(&q, m->things + i);
        if (a.unclear) {
            sum->unclear++;
            return;
        }
        if (a.hit && (!best.hit || a.t < best.t)) {
            second = best;
            best = a;
            nearest = i;
        } else if (a.hit && (!second.hit || a.t < second.t)) {
            second = a;
        }
    }
    check(found == best.hit, SEED ", ray %" PRIu64 ": %s", seed, sum->rays, found ? "nothing is there" : "a hit is missed");
    if (!found) {
        return;
    }
    bool apart = !second.hit || second.t - best.t > second.bound + best.bound;
    check(!apart || hit.object == nearest, SEED ", ray %" PRIu64 ": object %" PRIu32 ", not %" PRIu32, seed, sum->rays, hit.object,
          nearest);
    if (hit.object == nearest) {
        const thing *t = m->things + nearest;
        quad true_t = best.t / q.length, error = qabs((quad)hit.t - true_t);
        double off = (double)(error * q.length / best.bound) * BOUND;
        check(off <= BOUND, SEED ", ray %" PRIu64 ": t %.9g errs by %g of the bound", seed, sum->rays, (double)hit.t, off / BOUND);
        note(sum->kinds + t->kind, (double)error / ulp_of((double)true_t), off);
        sum->hits++;
    }
}

static void move(model *m, aset_vec3 by) {
    for (uint32_t i = 0; i < m->n_things; i++) {
        for (int k = 0; k < THING_POINTS_MAX; k++) {
            m->things[i].points[k] = dvec_real(dvec_along(dvec_of(m->things[i].points[k]), 1, dvec_of(by)));
        }
    }
}

/* Somewhere about the middle of an object. */
static dvec random_target(const model *m, random_state *r) {
    const thing *t = m->things + random_below(r, m->n_things);
    uint32_t n = t->kind == THING_SPHERE ? 1 : t->kind == THING_CONE ? 2 : t->n_points;
    dvec sum = dvec_of(random_in_cube(r, 0.3));
    for (uint32_t i = 0; i < n; i++) {
        sum = dvec_along(sum, 1.0 / n, dvec_of(t->points[i]));
    }
    return sum;
}

/* Half of the scenes about the origin, half away from it; rays from inside, outside and far away. */
static void compare_scene(tally *sum, uint64_t seed) {
    random_state r = random_start(seed);
    model m;
    stage s;
    aset_space space;
    model_random(&m, &r, OBJECTS, 3, 0.3, 4);
    m.n_materials = 1; /* two-sided */
    for (uint32_t i = 0; i < m.n_things; i++) {
        m.things[i].material = 0;
    }
    aset_vec3 by = random_chance(&r, 0.5) ? vec(0, 0, 0) : random_in_cube(&r, 100);
    move(&m, by);
    stage_open_model(&s, &m, 1 << 20);
    stage_space(&s, &space, &aset_mset, 6, 6, 6);
    aset_tracer tracer = stage_tracer(&s, &space);
    for (int i = 0; i < RAYS_A_SCENE; i++) {
        aset_ray ray = {{0, 0, 0}, {0, 0, 0}, REAL_INFINITY};
        dvec away = dvec_of(random_direction(&r)), target = random_target(&m, &r);
        double distance = random_chance(&r, 0.4) ? random_between(&r, 0, 3) : pow(10, random_between(&r, 0.7, 2.5));
        ray.origin = dvec_real(dvec_along(dvec_of(by), distance, away));
        ray.direction = dvec_real(dvec_unit(dvec_sub(target, dvec_of(ray.origin))));
        compare(sum, &m, &tracer, &ray, seed);
    }
    stage_close(&s);
    model_free(&m);
}

static int ascending(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static void print_table(tally *sum, FILE *table) {
    static const char *const names[THING_KINDS] = {"polygon", "patch", "sphere", "cone"};
    for (int k = 0; k < THING_KINDS; k++) {
        errors *e = sum->kinds + k;
        if (e->n > 0) {
            qsort(e->list, e->n, sizeof *e->list, ascending);
            (void)fprintf(table, "| %s | %" PRIu32 " | %.2f | %.1f | %.0f | %.1f |\n", names[k], e->n, e->list[e->n / 2],
                          e->list[e->n - 1 - e->n / 1000], e->list[e->n - 1], e->most);
        }
    }
}

static void test_oracle__nearest_objects_and_their_distance(void **state) {
    (void)state;
    static tally sum;
    const char *path = getenv("ASET_TABLES");
    FILE *table = path != NULL ? fopen(path, "a") : NULL;
    uint32_t n = (long_run() ? RAYS_LONG : RAYS) / RAYS_A_SCENE;
    for (uint32_t i = 0; i < n; i++) {
        compare_scene(&sum, seed_of(5000 + i));
    }
    check(sum.unclear * 5 <= sum.rays && sum.hits * 5 >= sum.rays, "%" PRIu64 " of %" PRIu64 " rays are unclear, %" PRIu64 " hit",
          sum.unclear, sum.rays, sum.hits);
    if (table != NULL || long_run()) {
        print_table(&sum, table != NULL ? table : stdout);
        print_message("%" PRIu64 " rays, %" PRIu64 " hits compared, %" PRIu64 " rays left to rounding\n", sum.rays, sum.hits, sum.unclear);
    }
    assert_true(table == NULL || fclose(table) == 0);
    for (int k = 0; k < THING_KINDS; k++) {
        free(sum.kinds[k].list);
    }
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
#ifdef __SIZEOF_FLOAT128__
        cmocka_unit_test(test_oracle__nearest_objects_and_their_distance),
#else
        cmocka_unit_test(test_support__not_compiled),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
