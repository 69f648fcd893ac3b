/*
 * bench_robust.c - what robust geometry costs: the library's tests of rays against objects beside plain ones, in one program, on
 * the same scene, space and rays, in turns.
 *
 *     robust   polygons in the ray's own frame (Woop, Benthin and Wald 2013), quadratics at the ray's nearest point (Haines et al.
 *              2019), every hit clamped to the object's grown box
 *     plain    triangles by Moeller and Trumbore 1997, other polygons by the plane and then by edges in two coordinates (Haines
 *              1994), quadratics from the ray's origin (Glassner 1989), no clamp, no frame of the ray
 *     bare     the plain ones in a space whose boxes grow by a quarter of the margin, a rounding of the scene's size (with none at
 *              all, what lies in a slice would fall to the other side of it, and the structure be another one)
 *
 * The plain ones are here and not in the library: lib/scene/object.c is compiled once more for this program, under other names for
 * the two functions that are asked (see the Makefile), and these names are taken by functions that choose. So everything else,
 * the walk above all, is the library's own code, and the choice is paid by both sides.
 *
 *      bench_robust [NAME[:SIZE] ...]
 */
#include "bench_common.h"

#include "scene/shape.h"

#include <inttypes.h>

enum { ROUNDS = 9, SIDE = 192, RANDOM = 30000, MEGABYTES = 64, KINDS = 3, CONTENDERS = 3, METHODS = 2 };
/* Of rays a second. */
#define LOSS_MOST 0.15

/* object.c's own, renamed */
aset_real robust_object_nearest(const aset_scene *scene, uint32_t object, const probe *ray, aset_real limit);
probe robust_probe_make(aset_vec3 origin, aset_vec3 direction);

static bool is_plain;

/* --- plain tests --- */

static probe plain_probe_make(aset_vec3 origin, aset_vec3 direction) {
    probe ray = {{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, {0, 0, 0}, {false, false, false},
                 {0, 0, 0}, {0, 0, 0}};
    for (int a = 0; a < 3; a++) {
        ray.moves[a] = real_abs(ray.direction[a]) > R(8.7e-19);
        ray.inverse[a] = ray.moves[a] ? 1 / ray.direction[a] : 0;
    }
    return ray;
}

static aset_vec3 point_at(const aset_real *p) {
    return vec(p[0], p[1], p[2]);
}

static aset_real plain_triangle(const aset_real *p, unsigned stride, aset_vec3 o, aset_vec3 d, bool one_sided) {
    aset_vec3 a = point_at(p), e = vec_sub(point_at(p + stride), a), f = vec_sub(point_at(p + 2 * stride), a);
    aset_vec3 h = vec_cross(d, f), from = vec_sub(o, a);
    aset_real det = vec_dot(e, h);
    if (det == 0 || (one_sided && det < 0)) {
        return REAL_INFINITY;
    }
    aset_real inverse = 1 / det, u = vec_dot(from, h) * inverse;
    if (u < 0 || u > 1) {
        return REAL_INFINITY;
    }
    aset_vec3 q = vec_cross(from, e);
    aset_real v = vec_dot(d, q) * inverse;
    if (v < 0 || u + v > 1) {
        return REAL_INFINITY;
    }
    aset_real t = vec_dot(f, q) * inverse;
    return t > 0 ? t : REAL_INFINITY;
}

/* at: the normal, a box if there are more than eight points, the points. */
static aset_real plain_outline(const aset_real *at, uint32_t n, unsigned stride, const probe *ray, aset_real limit, bool one_sided) {
    uint32_t head = n >= 9 * stride + 9 ? 9 : 3, n_points = (n - head) / stride;
    const aset_real *points = at + head;
    aset_real t_in, t_out;
    if (head == 9 &&
        (!aset_probe_box(ray, point_at(at + 3), point_at(at + 6), &t_in, &t_out) || t_in > limit || t_out < 0)) {
        return REAL_INFINITY;
    }
    aset_vec3 normal = point_at(at), o = probe_origin(ray), d = probe_direction(ray);
    aset_real slope = vec_dot(normal, d), t = vec_dot(normal, vec_sub(point_at(points), o)) / slope;
    if (!(t > 0) || slope == 0 || (one_sided && slope > 0)) {
        return REAL_INFINITY;
    }
    int z = real_abs(normal.x) > real_abs(normal.y) ? 0 : 1;
    z = real_abs(normal.z) > real_abs(vec_at(&normal, z)) ? 2 : z;
    int x = (z + 1) % 3, y = (z + 2) % 3;
    aset_vec3 hit = vec_along(o, t, d);
    aset_real hx = vec_at(&hit, x), hy = vec_at(&hit, y);
    const aset_real *p = points + (size_t)(n_points - 1) * stride;
    bool inside = false, was_above = p[y] > hy;
    for (uint32_t i = 0; i < n_points; i++) {
        const aset_real *q = points + (size_t)i * stride;
        bool is_above = q[y] > hy;
        if (is_above != was_above && hx < (q[x] - p[x]) * (hy - p[y]) / (q[y] - p[y]) + p[x]) {
            inside = !inside;
        }
        was_above = is_above;
        p = q;
    }
    return inside ? t : REAL_INFINITY;
}

static aset_real plain_sphere(const aset_real *at, aset_vec3 o, aset_vec3 d, bool one_sided) {
    aset_vec3 f = vec_sub(o, point_at(at));
    aset_real b = vec_dot(f, d), under_root = b * b - (vec_dot(f, f) - at[3] * at[3]);
    if (!(under_root >= 0)) {
        return REAL_INFINITY;
    }
    aset_real half = real_sqrt(under_root), in = -b - half, out = -b + half;
    if (in > 0 && at[3] > 0) {
        return in;
    }
    return out > 0 && (at[3] < 0 || !one_sided) ? out : REAL_INFINITY;
}

static aset_real plain_cone(const aset_real *at, aset_vec3 o, aset_vec3 d, bool one_sided) {
    aset_real height;
    aset_vec3 base = point_at(at), axis = aset_vec_unit_length(vec_sub(point_at(at + 4), base), &height),
              f = vec_sub(o, base);
    aset_real r0 = real_abs(at[3]), slope = (real_abs(at[7]) - r0) / height;
    bool inside_only = at[3] < 0 || at[7] < 0;
    aset_real fk = vec_dot(f, axis), dk = vec_dot(d, axis), radius = r0 + slope * fk;
    aset_vec3 fa = vec_along(f, -fk, axis), da = vec_along(d, -dk, axis);
    aset_real a = vec_dot(da, da) - slope * slope * dk * dk, b = vec_dot(fa, da) - slope * dk * radius;
    aset_real under_root = b * b - a * (vec_dot(fa, fa) - radius * radius);
    if (!(under_root >= 0) || a == 0) {
        return REAL_INFINITY;
    }
    aset_real root = real_sqrt(under_root), part = 1 / a;
    for (int i = 0; i < 2; i++) {
        aset_real t = (-b + ((a > 0) == (i == 0) ? -root : root)) * part, m = fk + t * dk;
        if (!(t > 0) || m < 0 || m > height) {
            continue;
        }
        if (!one_sided && !inside_only) {
            return t;
        }
        aset_vec3 across = aset_vec_unit(vec_along(fa, t, da));
        bool from_outside = vec_dot(vec_along(across, -slope, axis), d) < 0;
        if (from_outside != inside_only) {
            return t;
        }
    }
    return REAL_INFINITY;
}

static aset_real plain_object_nearest(const aset_scene *scene, uint32_t object, const probe *ray, aset_real limit) {
    shape s = shape_of(scene, object);
    bool one_sided = s.material->one_sided;
    aset_vec3 o = probe_origin(ray), d = probe_direction(ray);
    unsigned stride = s.kind == KIND_PATCH ? 6 : 3;
    switch (s.kind) {
    case KIND_SPHERE: return plain_sphere(s.at, o, d, one_sided);
    case KIND_CONE: return plain_cone(s.at, o, d, one_sided);
    default:
        return s.n == 3 * stride ? plain_triangle(s.at, stride, o, d, one_sided)
                                 : plain_outline(s.at, s.n, stride, ray, limit, one_sided);
    }
}

/* --- who is asked --- */

aset_real aset_object_nearest(const aset_scene *scene, uint32_t object, const probe *ray, aset_real limit) {
    return is_plain ? plain_object_nearest(scene, object, ray, limit) : robust_object_nearest(scene, object, ray, limit);
}

probe aset_probe_make(aset_vec3 origin, aset_vec3 direction) {
    return is_plain ? plain_probe_make(origin, direction) : robust_probe_make(origin, direction);
}

/* --- measuring --- */

static const struct {
    const char *name;
    bool any;
} kinds[KINDS] = {{"eye, closest", false}, {"shadow, any", true}, {"random, closest", false}};

static const char *const contender_names[CONTENDERS] = {"robust", "plain", "bare"};

typedef struct bench {
    bench_scene scene;
    aset_scene bare; /* the same arrays, another margin */
    void *blocks[2];
    aset_space spaces[2];
    aset_tracer tracers[2];
    bench_rays rays[KINDS];
} bench;

static bool build(bench *b, int k, const aset_scene *scene, const aset_method *method) {
    aset_arena arena;
    aset_arena_init(&arena, b->blocks[k], (size_t)MEGABYTES << 20);
    memset(b->tracers + k, 0, sizeof b->tracers[k]);
    b->tracers[k].scene = scene;
    b->tracers[k].space = b->spaces + k;
    return aset_space_build(b->spaces + k, scene, method, NULL, &arena) == ASET_OK;
}

static size_t ask(const bench *b, unsigned contender, unsigned kind) {
    const aset_tracer *tracer = b->tracers + (contender == 2);
    const bench_rays *rays = b->rays + kind;
    size_t n = 0;
    is_plain = contender > 0;
    for (size_t i = 0; i < rays->n; i++) {
        aset_hit hit;
        bool found = false;
        if (kinds[kind].any) {
            aset_any_hit(&found, tracer, rays->list + i, false, NULL);
        } else {
            aset_closest_hit(&found, &hit, tracer, rays->list + i, false, NULL);
        }
        n += found;
    }
    is_plain = false;
    return n;
}

/* Sum of the logarithms of the time of robust tests in that of the others, over scenes, methods and kinds of rays. */
typedef struct total {
    double logs[CONTENDERS];
    unsigned n;
} total;

static void measure(const bench *b, const aset_method *method, total *sum) {
    for (unsigned kind = 0; kind < KINDS; kind++) {
        static double seconds[CONTENDERS][BENCH_ROUNDS_MAX];
        size_t found[CONTENDERS];
        for (unsigned round = 0; round < ROUNDS; round++) {
            for (unsigned turn = 0; turn < CONTENDERS; turn++) {
                unsigned c = round % 2 == 0 ? turn : CONTENDERS - 1 - turn; /* forth, then back */
                double from = bench_seconds();
                found[c] = ask(b, c, kind);
                seconds[c][round] = bench_seconds() - from;
            }
        }
        bench_spread plain = bench_ratios(seconds[1], seconds[0], ROUNDS), bare = bench_ratios(seconds[2], seconds[0], ROUNDS);
        double own = bench_spread_of(seconds[0], ROUNDS).median;
        printf("| %s | %s | %s | %.2f | %.3f | %.3f | %zu of %zu, %+ld, %+ld |\n", b->scene.text, aset_method_name(method),
               kinds[kind].name, 1e-6 * (double)b->rays[kind].n / own, plain.median, bare.median, found[0], b->rays[kind].n,
               (long)found[1] - (long)found[0], (long)found[2] - (long)found[0]);
        sum->logs[1] += log(plain.median);
        sum->logs[2] += log(bare.median);
        sum->n++;
    }
}

static bool bench_one(const char *text, total *sum) {
    static const aset_method *const methods[METHODS] = {&aset_mset, &aset_grid};
    bench b;
    memset(&b, 0, sizeof b);
    if (!bench_scene_find(&b.scene, text) || bench_scene_open(&b.scene) != ASET_OK) {
        fprintf(stderr, "bench_robust: no scene %s\n", text);
        return false;
    }
    b.bare = b.scene.scene;
    b.bare.margin *= R(0.25);
    for (unsigned m = 0; m < METHODS; m++) {
        for (int k = 0; k < 2; k++) {
            b.blocks[k] = b.blocks[k] != NULL ? b.blocks[k] : bench_need(malloc((size_t)MEGABYTES << 20));
            if (!build(&b, k, k == 0 ? &b.scene.scene : &b.bare, methods[m])) {
                return false;
            }
        }
        if (m == 0) {
            bench_eye_rays(b.rays, &b.scene.scene.view, SIDE);
            bench_shadow_rays(b.rays + 1, b.rays, b.tracers);
            bench_random_rays(b.rays + 2, &b.scene.scene, RANDOM, 20240607);
        }
        measure(&b, methods[m], sum);
    }
    for (unsigned k = 0; k < KINDS; k++) {
        free(b.rays[k].list);
    }
    free(b.blocks[0]);
    free(b.blocks[1]);
    bench_scene_close(&b.scene);
    return true;
}

int main(int argc, char **argv) {
    total sum = {{0, 0, 0}, 0};
    printf("| scene | method | rays | robust, million a second | plain: time | bare: time | hits, more with plain, with bare |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < (argc > 1 ? argc - 1 : BENCH_SCENES); i++) {
        if (!bench_one(argc > 1 ? argv[i + 1] : bench_defaults[i], &sum)) {
            return 1;
        }
    }
    bool fine = true;
    printf("\n");
    for (unsigned c = 1; c < CONTENDERS; c++) {
        double loss = 1 - exp(sum.logs[c] / sum.n);
        printf("Rays a second lost by the robust tests against %s: %.1f %% (geometric mean of %u rows; the limit is %.0f %%).\n",
               contender_names[c], 100 * loss, sum.n, 100 * LOSS_MOST);
        fine = fine && loss <= LOSS_MOST;
    }
    return fine ? 0 : 1;
}
