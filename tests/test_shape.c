/*
 * test_shape.c - a ray against one object of each kind, compared with the same geometry in plain double precision; normals;
 * and that rays do not slip through closed surfaces.
 */
#include "support/support.h"

#define PI 3.14159265358979323846
/* How near to an edge, a rim, a silhouette or the origin a hit has to lie before rounding may decide about it. */
#define NEARLY 1e-3

static aset_vec3 real3(double x, double y, double z) {
    return dvec_real(dvec_make(x, y, z));
}

/* --- the same in double precision --- */

typedef struct answer {
    double t;       /* HUGE_VAL: no hit */
    dvec normal;    /* to the front */
    bool undecided; /* too near to something to tell */
} answer;

static const answer miss = {HUGE_VAL, {0, 0, 0}, false};
static const answer unclear = {HUGE_VAL, {0, 0, 0}, true};

static dvec newell(const thing *t) {
    dvec sum = {0, 0, 0};
    for (uint32_t i = 0; i < t->n_points; i++) {
        dvec a = dvec_of(t->points[i]), b = dvec_of(t->points[(i + 1) % t->n_points]);
        sum.x += (a.y - b.y) * (a.z + b.z);
        sum.y += (a.z - b.z) * (a.x + b.x);
        sum.z += (a.x - b.x) * (a.y + b.y);
    }
    return dvec_unit(sum);
}

static double edge_distance(dvec p, dvec a, dvec b) {
    dvec along = dvec_sub(b, a), to = dvec_sub(p, a);
    double share = dvec_dot(to, along) / dvec_dot(along, along);
    share = share < 0 ? 0 : share > 1 ? 1 : share;
    return dvec_length(dvec_along(to, -share, along));
}

/* Inside by the sum of the angles under which the edges are seen. */
static bool inside_outline(const thing *t, dvec p, dvec n) {
    double sum = 0;
    for (uint32_t i = 0; i < t->n_points; i++) {
        dvec a = dvec_sub(dvec_of(t->points[i]), p), b = dvec_sub(dvec_of(t->points[(i + 1) % t->n_points]), p);
        sum += atan2(dvec_dot(n, dvec_cross(a, b)), dvec_dot(a, b));
    }
    return fabs(sum) > PI;
}

static answer polygon_answer(const thing *t, dvec o, dvec d, bool one_sided) {
    dvec n = newell(t);
    double slope = dvec_dot(n, d);
    if (fabs(slope) < 0.02) {
        return unclear;
    }
    answer a = {dvec_dot(n, dvec_sub(dvec_of(t->points[0]), o)) / slope, n, false};
    dvec p = dvec_along(o, a.t, d);
    for (uint32_t i = 0; i < t->n_points; i++) {
        if (edge_distance(p, dvec_of(t->points[i]), dvec_of(t->points[(i + 1) % t->n_points])) < NEARLY) {
            return unclear;
        }
    }
    if (fabs(a.t) < NEARLY) {
        return unclear;
    }
    return a.t < 0 || (one_sided && slope > 0) || !inside_outline(t, p, n) ? miss : a;
}

static answer sphere_answer(const thing *t, dvec o, dvec d, bool one_sided) {
    dvec c = dvec_of(t->points[0]), f = dvec_sub(o, c);
    double r = fabs((double)t->radii[0]), b = dvec_dot(f, d), under_root = b * b - dvec_dot(f, f) + r * r;
    if (fabs(under_root) < NEARLY * r) {
        return unclear;
    }
    if (under_root < 0) {
        return miss;
    }
    const double roots[2] = {-b - sqrt(under_root), -b + sqrt(under_root)};
    const bool visible[2] = {t->radii[0] > 0, t->radii[0] < 0 || !one_sided};
    for (int i = 0; i < 2; i++) {
        if (fabs(roots[i]) < NEARLY) {
            return unclear;
        }
        if (roots[i] > 0 && visible[i]) {
            dvec n = dvec_unit(dvec_sub(dvec_along(o, roots[i], d), c));
            answer a = {roots[i], t->radii[0] > 0 ? n : dvec_make(-n.x, -n.y, -n.z), false};
            return a;
        }
    }
    return miss;
}

/* The roots of |across(t)|^2 = radius(t)^2 with both sides written out in t. */
static answer cone_answer(const thing *t, dvec o, dvec d, bool one_sided) {
    dvec base = dvec_of(t->points[0]), along = dvec_sub(dvec_of(t->points[1]), base), k = dvec_unit(along);
    double height = dvec_length(along), r0 = fabs((double)t->radii[0]), r1 = fabs((double)t->radii[1]);
    double s = (r1 - r0) / height;
    bool inside_only = t->radii[0] < 0 || t->radii[1] < 0;
    dvec f = dvec_sub(o, base);
    double fk = dvec_dot(f, k), dk = dvec_dot(d, k);
    dvec fa = dvec_along(f, -fk, k), da = dvec_along(d, -dk, k);
    double a = dvec_dot(da, da) - s * s * dk * dk, b = dvec_dot(fa, da) - s * dk * (r0 + s * fk);
    double c = dvec_dot(fa, fa) - (r0 + s * fk) * (r0 + s * fk), under_root = b * b - a * c;
    if (fabs(a) < NEARLY || fabs(under_root) < NEARLY) {
        return unclear;
    }
    if (under_root < 0) {
        return miss;
    }
    double roots[2] = {(-b - sqrt(under_root)) / a, (-b + sqrt(under_root)) / a};
    for (int i = 0; i < 2; i++) {
        double root = (a > 0) == (i == 0) ? roots[0] : roots[1], m = fk + root * dk;
        if (fabs(root) < NEARLY || fabs(m) < NEARLY || fabs(m - height) < NEARLY) {
            return unclear;
        }
        if (root < 0 || m < 0 || m > height) {
            continue;
        }
        dvec n = dvec_unit(dvec_along(dvec_unit(dvec_along(fa, root, da)), -s, k));
        bool from_outside = dvec_dot(n, d) < 0;
        if (inside_only ? from_outside : one_sided && !from_outside) {
            continue;
        }
        answer hit = {root, inside_only ? dvec_make(-n.x, -n.y, -n.z) : n, false};
        return hit;
    }
    return miss;
}

static answer answer_of(const thing *t, dvec o, dvec d, bool one_sided) {
    switch (t->kind) {
    case THING_SPHERE: return sphere_answer(t, o, d, one_sided);
    case THING_CONE: return cone_answer(t, o, d, one_sided);
    default: return polygon_answer(t, o, d, one_sided);
    }
}

/* --- comparing --- */

typedef struct tally {
    uint32_t n, hits, undecided;
} tally;

static dvec middle_of(const stage *s) {
    dvec low = dvec_of(s->scene.low);
    return dvec_along(low, 0.5, dvec_sub(dvec_of(s->scene.high), low));
}

/* One ray from somewhere around or in the object, towards a point around its middle. */
static void compare_ray(const stage *s, const aset_space *space, const thing *t, random_state *r, tally *sum) {
    bool one_sided = s->scene.materials[0].one_sided, found;
    dvec middle = middle_of(s);
    dvec origin = dvec_along(middle, random_chance(r, 0.3) ? 0.3 : 4, dvec_of(random_in_cube(r, 1)));
    dvec target = dvec_along(middle, 1, dvec_of(random_in_cube(r, 0.7)));
    aset_tracer tracer = stage_tracer(s, space);
    aset_ray ray = {dvec_real(origin), dvec_real(dvec_unit(dvec_sub(target, origin))), REAL_INFINITY};
    aset_hit hit;
    answer a = answer_of(t, dvec_of(ray.origin), dvec_unit(dvec_of(ray.direction)), one_sided);
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, NULL), ASET_OK);
    sum->n++;
    if (a.undecided) {
        sum->undecided++;
        return;
    }
    check(found == (a.t < HUGE_VAL), SEED ", ray %" PRIu32 ", t %g", r->seed, sum->n, a.t);
    if (found) {
        sum->hits++;
        double off = dvec_length(dvec_sub(dvec_of(hit.point), dvec_along(dvec_of(ray.origin), a.t, dvec_of(ray.direction))));
        check(fabs((double)hit.t - a.t) < 2e-4 && off < 2e-4, SEED ", ray %" PRIu32 ": t %g, not %g", r->seed, sum->n,
              (double)hit.t, a.t);
        check(dvec_length(dvec_sub(dvec_of(hit.geometric), a.normal)) < 5e-3, SEED ", ray %" PRIu32, r->seed, sum->n);
        check(fabs(dvec_length(dvec_of(hit.normal)) - 1) < 1e-5, SEED ", ray %" PRIu32, r->seed, sum->n);
        check(t->kind == THING_PATCH || memcmp(&hit.normal, &hit.geometric, sizeof hit.normal) == 0, SEED, r->seed);
        check(hit.object == 0 && hit.material == s->scene.materials, SEED, r->seed);
    }
}

static void compare_kind(unsigned kind, uint64_t first_seed) {
    tally sum = {0, 0, 0};
    for (uint64_t i = 0; thing_available(kind) && i < 300; i++) {
        random_state r = random_start(seed_of(first_seed + i));
        aset_material material = plain_material();
        model m;
        stage s;
        aset_space space;
        material.one_sided = random_chance(&r, 0.4);
        model_start(&m);
        m.materials[0] = material;
        while (m.n_things == 0 || m.things[0].kind != kind) {
            m.n_things = 0;
            model_random_thing(&m, &r, 3, random_between(&r, 0.5, 2));
        }
        stage_open_model(&s, &m, 0);
        stage_space(&s, &space, &aset_brute, 1, 1, 1);
        for (int k = 0; k < 100; k++) {
            compare_ray(&s, &space, m.things, &r, &sum);
        }
        stage_close(&s);
        model_free(&m);
    }
    assert_true(sum.undecided * 12 <= sum.n); /* else this test says nothing */
    assert_true(sum.hits * 12 >= sum.n);
}

static void test_shape__polygons_agree_with_double(void **state) {
    (void)state;
    compare_kind(THING_POLYGON, 1000);
}

static void test_shape__patches_agree_with_double(void **state) {
    (void)state;
    compare_kind(THING_PATCH, 2000);
}

static void test_shape__spheres_agree_with_double(void **state) {
    (void)state;
    compare_kind(THING_SPHERE, 3000);
}

static void test_shape__cones_agree_with_double(void **state) {
    (void)state;
    compare_kind(THING_CONE, 4000);
}

/* --- plain cases --- */

/* t on the only object of the model, one-sided or not; -1 without a hit. Frees the model. */
static double only_hit(model *m, bool one_sided, aset_vec3 origin, aset_vec3 direction) {
    stage s;
    m->materials[0].one_sided = one_sided;
    stage_open_model(&s, m, 0);
    aset_real t = object_hit(&s.scene, 0, origin, direction);
    stage_close(&s);
    model_free(m);
    return t < REAL_INFINITY ? (double)t : -1;
}

#if ASET_WITH_SPHERES
static double on_sphere(double radius, bool one_sided, double z, double dz) {
    model m;
    model_start(&m);
    model_sphere(&m, real3(0, 0, 0), radius);
    return only_hit(&m, one_sided, real3(0, 0, z), real3(0, 0, dz));
}

static void test_shape__sides_of_spheres(void **state) {
    (void)state;
    assert_true(on_sphere(2, false, 5, -1) == 3);
    assert_true(on_sphere(2, true, 5, -1) == 3);
    assert_true(on_sphere(2, false, 0, -1) == 2);
    assert_true(on_sphere(2, true, 0, -1) == -1);
    assert_true(on_sphere(2, false, 1, -1) == 3);
    assert_true(on_sphere(2, false, 5, 1) == -1);
    assert_true(on_sphere(-2, false, 5, -1) == 7); /* through the invisible outside */
    assert_true(on_sphere(-2, true, 5, -1) == 7);
    assert_true(on_sphere(-2, false, 0, -1) == 2);
    assert_true(on_sphere(-2, true, 1, -1) == 3);
    assert_true(on_sphere(-2, false, 5, 1) == -1);
}
#endif

#if ASET_WITH_CONES
static double on_cone(double r0, double r1, bool one_sided, aset_vec3 origin, aset_vec3 direction) {
    model m;
    model_start(&m);
    model_cone(&m, real3(0, 0, 0), r0, real3(0, 0, 4), r1);
    return only_hit(&m, one_sided, origin, direction);
}

/* Up to 10^5 times as long as wide: hit by no ray that passes the axis by more than the larger radius, however far it is from there. */
static void test_shape__needles_are_not_hit_from_beside(void **state) {
    (void)state;
    uint32_t n_met = 0, n_passed = 0;
    for (uint64_t i = 0; i < 20000; i++) {
        random_state r = random_start(seed_of(7000 + i));
        double radius = pow(10, -random_between(&r, 1, 5)), other = radius * random_between(&r, 0.5, 1);
        aset_vec3 base = random_in_cube(&r, 1), apex = random_in_cube(&r, 1), origin = random_in_cube(&r, 3);
        dvec axis = dvec_sub(dvec_of(apex), dvec_of(base)), aside = dvec_unit(dvec_cross(axis, dvec_of(random_direction(&r))));
        dvec target = dvec_along(dvec_along(dvec_of(base), random_between(&r, 0.1, 0.9), axis), radius * random_between(&r, 0, 8), aside);
        aset_vec3 direction = dvec_real(dvec_unit(dvec_sub(target, dvec_of(origin))));
        dvec f = dvec_sub(dvec_of(origin), dvec_of(base)), across = dvec_cross(dvec_of(direction), axis);
        double length = dvec_length(axis), n = dvec_length(across), gap = fabs(dvec_dot(across, f)) / n;
        double nearest = dvec_dot(dvec_cross(dvec_of(direction), f), across) / (n * n); /* a share of the axis */
        double rounding = 80 * (double)REAL_UNIT * (dvec_length(f) + length);
        if (length < 0.5 || n < 0.5 * length || dvec_length(f) < 1.5) {
            continue;
        }
        model m;
        model_start(&m);
        model_cone(&m, base, radius, apex, other);
        double t = only_hit(&m, false, origin, direction);
        if (gap > 1.05 * radius + rounding) {
            check(t < 0, SEED ": a needle of radius %g, passed by %g, is hit", r.seed, radius, gap);
            n_passed++;
        } else if (radius > 0.003 && fabs(nearest - 0.5) < 0.1 && gap + rounding < 0.9 * other) { /* not by its ends */
            check(t > 0, SEED ": a cone of radius %g, passed by %g, is missed", r.seed, other, gap);
            n_met++;
        }
    }
    assert_true(n_met > 100 && n_passed > 2000);
}

static void test_shape__sides_and_ends_of_cones(void **state) {
    (void)state;
    aset_vec3 right = real3(1, 0, 0), left = real3(-1, 0, 0), up = real3(0, 0, 1), half = real3(0, 0, 2);
    assert_true(on_cone(1, 1, false, real3(-5, 0, 2), right) == 4);
    assert_true(on_cone(1, 1, true, real3(-5, 0, 2), right) == 4);
    assert_true(on_cone(1, 1, false, half, right) == 1);
    assert_true(on_cone(1, 1, true, half, right) == -1);
    assert_true(on_cone(-1, -1, false, real3(-5, 0, 2), right) == 6);
    assert_true(on_cone(-1, -1, true, real3(-5, 0, 2), right) == 6);
    assert_true(on_cone(-1, -1, true, half, left) == 1);
    assert_true(on_cone(1, 1, false, real3(-5, 0, 5), right) == -1); /* beyond the end */
    assert_true(on_cone(1, 1, false, real3(-5, 0, -1), right) == -1);
    assert_true(on_cone(1, 1, false, real3(0, 0, -3), up) == -1); /* the ends are open */
    assert_true(on_cone(1, 1, false, real3(0, 0, 9), real3(0, 0, -1)) == -1);
    assert_true(on_cone(1, 1, false, real3(0.5, 0.25, -3), up) == -1);
    assert_true(on_cone(1, 1, false, real3(-0.5, 0.25, 2), up) == -1);
    assert_true(on_cone(1, 0, false, real3(0, 0, -3), up) < 0 || on_cone(1, 0, false, real3(0, 0, -3), up) == 7);
    assert_true(fabs(on_cone(2, 0, false, real3(-5, 0, 2), right) - 4) < 1e-5);
    assert_true(fabs(on_cone(0, 2, false, real3(-5, 0, 1), right) - 4.5) < 1e-5);
    assert_true(fabs(on_cone(2, 0, false, real3(1, 0, -3), up) - 5) < 1e-5); /* parallel to the axis, from below */
    assert_true(on_cone(2, 1, true, real3(1.5, 0, -3), up) == -1);           /* ... its inside is invisible */
    assert_true(fabs(on_cone(2, 1, false, real3(1.5, 0, -3), up) - 5) < 1e-5);
    assert_true(fabs(on_cone(2, 1, true, real3(1.5, 0, 9), real3(0, 0, -1)) - 7) < 1e-5);
    /* into the open end and out again through the other, past the wall's plane */
    assert_true(fabs(on_cone(1, 1, false, real3(0, 0, -1), real3(0.6, 0, 0.8)) - 5.0 / 3) < 1e-5);
    /* the mirror cone beyond the apex is not there */
    assert_true(on_cone(2, 0, false, real3(-5, 0, 6), right) == -1);
}
#endif

#if ASET_WITH_POLYGONS
/* A U: the notch in the middle is open. */
static double on_u(double x, double y, bool one_sided, double dz) {
    const aset_vec3 u[8] = {{0, 0, 1}, {6, 0, 1}, {6, 5, 1}, {4, 5, 1}, {4, 2, 1}, {2, 2, 1}, {2, 5, 1}, {0, 5, 1}};
    model m;
    model_start(&m);
    model_polygon(&m, u, NULL, 8);
    return only_hit(&m, one_sided, real3(x, y, 1 - 3 * dz), real3(0, 0, dz));
}

static void test_shape__concave_polygons(void **state) {
    (void)state;
    for (int y = 0; y < 7; y++) {
        for (int x = 0; x < 8; x++) {
            bool in = x < 6 && y < 5 && !(x >= 2 && x < 4 && y >= 2);
            assert_true(on_u(x + 0.5, y + 0.5, false, -1) == (in ? 3 : -1));
            assert_true(on_u(x + 0.5, y + 0.5, true, -1) == (in ? 3 : -1)); /* counter-clockwise from above */
            assert_true(on_u(x + 0.5, y + 0.5, false, 1) == (in ? 3 : -1));
            assert_true(on_u(x + 0.5, y + 0.5, true, 1) == -1);
            assert_true(on_u(-x - 0.5, y + 0.5, false, 1) == -1);
        }
    }
}

/* Rays in the polygon's own plane, and behind the origin. */
static void test_shape__polygons_edge_on_and_behind(void **state) {
    (void)state;
    const aset_vec3 square[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (uint32_t n = 3; n <= 4; n++) {
        for (int i = 0; i < 16; i++) {
            model m;
            model_start(&m);
            model_polygon(&m, square, NULL, n);
            double angle = 2 * PI * i / 16;
            double t = only_hit(&m, false, real3(0.5 - 3 * cos(angle), 0.4 - 3 * sin(angle), 0),
                                real3(cos(angle), sin(angle), 0));
            assert_true(t == -1 || (t > 1 && t < 4)); /* either, but no nonsense */
            model_start(&m);
            model_polygon(&m, square, NULL, n);
            assert_true(only_hit(&m, false, real3(0.5, 0.25, -1), real3(0, 0, -1)) == -1);
            model_start(&m);
            model_polygon(&m, square, NULL, n);
            assert_true(only_hit(&m, false, real3(0.5, 0.25, 0), real3(0, 0, -1)) == -1); /* t = 0 is no hit */
        }
    }
}
#endif

/* --- normals of patches --- */

#if ASET_WITH_PATCHES
/* The shading normal where a ray straight down at (x, y) meets a patch at z = 0. */
static dvec patch_normal_at(const aset_vec3 *points, const aset_vec3 *normals, uint32_t n, double x, double y) {
    model m;
    stage s;
    aset_space space;
    aset_hit hit;
    bool found;
    model_start(&m);
    model_polygon(&m, points, normals, n);
    stage_open_model(&s, &m, 0);
    stage_space(&s, &space, &aset_brute, 1, 1, 1);
    aset_tracer tracer = stage_tracer(&s, &space);
    aset_ray ray = {real3(x, y, 5), {0, 0, -1}, REAL_INFINITY};
    assert_int_equal(aset_closest_hit(&found, &hit, &tracer, &ray, false, NULL), ASET_OK);
    check(found, "at %g %g", x, y);
    assert_true(hit.geometric.z == 1);
    stage_close(&s);
    model_free(&m);
    return dvec_of(hit.normal);
}

static const aset_vec3 patch_points[4] = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
/* of any length */
static const aset_vec3 patch_normals[4] = {{-1, -1, 3}, {10, -10, 20}, {R(0.01), R(0.02), R(0.02)}, {-2, 1, 1}};

static void check_near(dvec a, dvec b, double tolerance) {
    check(dvec_length(dvec_sub(a, b)) < tolerance, "(%g %g %g), not (%g %g %g)", a.x, a.y, a.z, b.x, b.y, b.z);
}

/* The normalised mean of the unit normals, with these weights. */
static dvec weighted(const int corner[3], double a, double b, double c) {
    const double weights[3] = {a, b, c};
    dvec sum = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        sum = dvec_along(sum, weights[i], dvec_unit(dvec_of(patch_normals[corner[i]])));
    }
    return dvec_unit(sum);
}

static void test_shape__patch_normals_are_interpolated(void **state) {
    (void)state;
    random_state r = random_start(seed_of(5000));
    const int lower[3] = {0, 1, 2}, upper[3] = {0, 2, 3};
    for (int i = 0; i < 200; i++) {
        double a = random_between(&r, 0.01, 1), b = random_between(&r, 0.01, 1), c = random_between(&r, 0.01, 1);
        double sum = a + b + c;
        a /= sum, b /= sum, c /= sum;
        double x = 4 * (b + c), y = 4 * c;
        check_near(patch_normal_at(patch_points, patch_normals, 3, x, y), weighted(lower, a, b, c), 1e-4);
        check_near(patch_normal_at(patch_points, patch_normals, 4, x, y), weighted(lower, a, b, c), 1e-4);
        x = 4 * b, y = 4 * (b + c);
        check_near(patch_normal_at(patch_points, patch_normals, 4, x, y), weighted(upper, a, b, c), 1e-4);
    }
}

static void test_shape__patch_normals_at_corners(void **state) {
    (void)state;
    for (int i = 0; i < 4; i++) {
        double x = (double)patch_points[i].x, y = (double)patch_points[i].y;
        dvec n = patch_normal_at(patch_points, patch_normals, 4, x + (2 - x) * 1e-4, y + (2 - y) * 1e-4);
        check_near(n, dvec_unit(dvec_of(patch_normals[i])), 1e-3);
    }
}

/* A normal of 0 stands for the polygon's own; normals that cancel leave it too. */
static void test_shape__patch_normals_of_zero(void **state) {
    (void)state;
    const aset_vec3 none[4] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const aset_vec3 first[3] = {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    const aset_vec3 against[3] = {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}};
    const dvec up = {0, 0, 1};
    for (uint32_t n = 3; n <= 4; n++) {
        check_near(patch_normal_at(patch_points, none, n, 3, 1), up, 1e-6);
    }
    check_near(patch_normal_at(patch_points, first, 3, 2, 1), dvec_unit(dvec_make(2, 0, 2)), 1e-5);
    dvec n = patch_normal_at(patch_points, against, 3, 2, 1);
    assert_true(fabs(dvec_length(n) - 1) < 1e-5);
}

/* Concave patches: every point gets some unit normal, on the side of the corners' normals. */
static void test_shape__patch_normals_of_concave_patches(void **state) {
    (void)state;
    const aset_vec3 points[5] = {{2, 1, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}};
    aset_vec3 normals[5];
    for (int i = 0; i < 5; i++) {
        normals[i] = real3(0.2 * i - 0.4, 0.1, 1);
    }
    for (double x = 0.25; x < 4; x += 0.5) {
        for (double y = 1.125; y < 4; y += 0.5) {
            dvec n = patch_normal_at(points, normals, 5, x, y);
            assert_true(fabs(dvec_length(n) - 1) < 1e-5 && n.z > 0.9);
        }
    }
}
#endif

/* --- closed surfaces --- */

#if ASET_WITH_POLYGONS
static void add_triangle(model *m, dvec a, dvec b, dvec c, int level) {
    if (level == 0) {
        const aset_vec3 points[3] = {dvec_real(a), dvec_real(b), dvec_real(c)};
        model_polygon(m, points, NULL, 3);
        return;
    }
    dvec ab = dvec_unit(dvec_along(a, 1, b)), bc = dvec_unit(dvec_along(b, 1, c)), ca = dvec_unit(dvec_along(c, 1, a));
    add_triangle(m, a, ab, ca, level - 1);
    add_triangle(m, ab, b, bc, level - 1);
    add_triangle(m, ca, bc, c, level - 1);
    add_triangle(m, ab, bc, ca, level - 1);
}

/* The unit sphere in 8 * 4^level triangles, turned so that nothing is axis-parallel unless straight. */
static void add_ball(model *m, int level, bool straight) {
    dvec u = {1, 0, 0}, v = {0, 1, 0}, w = {0, 0, 1};
    if (!straight) {
        u = dvec_unit(dvec_make(1, 0.3, -0.2));
        v = dvec_unit(dvec_cross(dvec_make(0.1, 0.2, 1), u));
        w = dvec_cross(u, v);
    }
    for (int i = 0; i < 8; i++) {
        dvec a = dvec_along(dvec_make(0, 0, 0), (i & 1) != 0 ? -1 : 1, u);
        dvec b = dvec_along(dvec_make(0, 0, 0), (i & 2) != 0 ? -1 : 1, v);
        dvec c = dvec_along(dvec_make(0, 0, 0), (i & 4) != 0 ? -1 : 1, w);
        bool turn = ((i ^ i >> 1 ^ i >> 2) & 1) != 0;
        add_triangle(m, a, turn ? c : b, turn ? b : c, level);
    }
}

/* Each face of the cube as two concave polygons with a zigzag from corner to corner between them. */
static void add_cube(model *m) {
    static const double parts[2][5][2] = {{{-1, -1}, {1, -1}, {1, 1}, {0.3, -0.6}, {-0.2, 0.5}},
                                          {{-1, -1}, {-0.2, 0.5}, {0.3, -0.6}, {1, 1}, {-1, 1}}};
    for (int face = 0; face < 6; face++) {
        double side = face % 2 == 0 ? 1 : -1;
        for (int part = 0; part < 2; part++) {
            aset_vec3 points[5];
            for (int i = 0; i < 5; i++) {
                double p = parts[part][i][0], q = parts[part][i][1];
                points[i] = face / 2 == 0 ? real3(side, p, q) : face / 2 == 1 ? real3(p, side, q) : real3(p, q, side);
            }
            model_polygon(m, points, NULL, 5);
        }
    }
}

/* Whether a ray from inside meets any of the objects. */
static bool leaks(const stage *s, aset_vec3 origin, aset_vec3 direction) {
    for (uint32_t i = 0; i < s->scene.counts.objects; i++) {
        if (object_hit(&s->scene, i, origin, direction) < REAL_INFINITY) {
            return false;
        }
    }
    return true;
}

static void check_tight(model *m, uint64_t seed, uint32_t n_rays) {
    random_state r = random_start(seed);
    stage s;
    stage_open_model(&s, m, 0);
    for (uint32_t i = 0; i < n_rays; i++) {
        aset_vec3 origin = random_in_cube(&r, 0.35);
        check(!leaks(&s, origin, random_direction(&r)), SEED ", ray %" PRIu32, r.seed, i);
    }
    stage_close(&s);
}

/* Rays from inside exactly at corners and at the middles of edges, as exactly as rounding lets one aim. */
static void check_tight_at_corners(model *m, uint64_t seed) {
    random_state r = random_start(seed);
    stage s;
    stage_open_model(&s, m, 0);
    for (uint32_t i = 0; i < m->n_things; i++) {
        const thing *t = m->things + i;
        for (uint32_t k = 0; k < t->n_points; k++) {
            dvec a = dvec_of(t->points[k]), b = dvec_of(t->points[(k + 1) % t->n_points]);
            for (int trial = 0; trial < 12; trial++) {
                dvec o = trial == 0 ? dvec_make(0, 0, 0) : dvec_of(random_in_cube(&r, 0.35));
                o = trial == 1 ? dvec_make(a.x * 0.5, a.y * 0.5, a.z * 0.5) : o;
                dvec target = trial % 3 < 2 ? a : dvec_along(a, 0.5, dvec_sub(b, a));
                aset_vec3 direction = dvec_real(dvec_unit(dvec_sub(target, o)));
                check(!leaks(&s, dvec_real(o), direction), SEED ", polygon %" PRIu32 ", corner %" PRIu32 ", trial %d",
                      r.seed, i, k, trial);
            }
        }
    }
    stage_close(&s);
}

static void test_shape__closed_triangles_do_not_leak(void **state) {
    (void)state;
    for (int straight = 0; straight < 2; straight++) {
        model m;
        model_start(&m);
        add_ball(&m, 2, straight);
        check_tight(&m, seed_of(6000 + (uint64_t)straight), 50000);
        check_tight_at_corners(&m, seed_of(6010 + (uint64_t)straight));
        model_free(&m);
    }
}

static void test_shape__closed_polygons_do_not_leak(void **state) {
    (void)state;
    model m;
    model_start(&m);
    add_cube(&m);
    check_tight(&m, seed_of(6020), 50000);
    check_tight_at_corners(&m, seed_of(6021));
    model_free(&m);
}

/* The same through a space: the walk must not lose what the triangles hold. */
static void test_shape__closed_triangles_do_not_leak_in_a_space(void **state) {
    (void)state;
    random_state r = random_start(seed_of(6030));
    model m;
    stage s;
    aset_space space;
    model_start(&m);
    add_ball(&m, 3, false);
    stage_open_model(&s, &m, 1 << 20);
    stage_space(&s, &space, &aset_mset, 9, 10, 11);
    aset_tracer tracer = stage_tracer(&s, &space);
    for (int i = 0; i < 50000; i++) {
        aset_ray ray = random_ray_from(&r, 0.5);
        aset_hit hit;
        bool closest, any;
        assert_int_equal(aset_closest_hit(&closest, &hit, &tracer, &ray, false, NULL), ASET_OK);
        assert_int_equal(aset_any_hit(&any, &tracer, &ray, false, NULL), ASET_OK);
        check(closest && any, SEED ", ray %d", r.seed, i);
        double radius = dvec_length(dvec_of(hit.point));
        check(radius > 0.97 && radius < 1.001, SEED ", ray %d: %g", r.seed, i, radius);
    }
    stage_close(&s);
    model_free(&m);
}

/* Seen from its front only, a closed surface is opaque from outside and not there from inside. */
static void test_shape__one_sided_closed_surface(void **state) {
    (void)state;
    random_state r = random_start(seed_of(6040));
    model m;
    stage s;
    model_start(&m);
    m.materials[0].one_sided = true;
    add_ball(&m, 1, false);
    stage_open_model(&s, &m, 0);
    for (int i = 0; i < 5000; i++) {
        aset_vec3 inside = random_in_cube(&r, 0.4), outward = random_direction(&r);
        check(leaks(&s, inside, outward), SEED ", ray %d", r.seed, i);
        dvec from = dvec_along(dvec_of(inside), 3, dvec_of(outward));
        aset_vec3 back = {-outward.x, -outward.y, -outward.z};
        uint32_t n = 0;
        for (uint32_t k = 0; k < m.n_things; k++) {
            n += object_hit(&s.scene, k, dvec_real(from), back) < REAL_INFINITY;
        }
        check(n >= 1, SEED ", ray %d", r.seed, i);
    }
    stage_close(&s);
    model_free(&m);
}
#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shape__polygons_agree_with_double),
        cmocka_unit_test(test_shape__patches_agree_with_double),
        cmocka_unit_test(test_shape__spheres_agree_with_double),
        cmocka_unit_test(test_shape__cones_agree_with_double),
#if ASET_WITH_SPHERES
        cmocka_unit_test(test_shape__sides_of_spheres),
#endif
#if ASET_WITH_CONES
        cmocka_unit_test(test_shape__needles_are_not_hit_from_beside),
        cmocka_unit_test(test_shape__sides_and_ends_of_cones),
#endif
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_shape__concave_polygons),
        cmocka_unit_test(test_shape__polygons_edge_on_and_behind),
#endif
#if ASET_WITH_PATCHES
        cmocka_unit_test(test_shape__patch_normals_are_interpolated),
        cmocka_unit_test(test_shape__patch_normals_at_corners),
        cmocka_unit_test(test_shape__patch_normals_of_zero),
        cmocka_unit_test(test_shape__patch_normals_of_concave_patches),
#endif
#if ASET_WITH_POLYGONS
        cmocka_unit_test(test_shape__closed_triangles_do_not_leak),
        cmocka_unit_test(test_shape__closed_polygons_do_not_leak),
        cmocka_unit_test(test_shape__closed_triangles_do_not_leak_in_a_space),
        cmocka_unit_test(test_shape__one_sided_closed_surface),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
