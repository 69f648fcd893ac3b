/*
 * bench_peers.c - libaset beside Embree 3 (Wald, Woop, Benthin, Johnson and Ernst 2014), in one run: the same scenes,
 * rays and shading, one thread, single-ray calls.
 *
 * Embree gets triangles: polygons by clipping ears (the shortest diagonal first; the areas are compared with the
 * polygon's own), spheres as a globe of --around meridians and half as many parallels, cones as --around facets, both
 * with smooth normals. Its rays are shaded by the library's own functions of directions and lights; what is written anew
 * here is the loop of trace.c and aset_shade_local with rtcOccluded1 in it, and the surface of a hit. First the two pictures
 * are compared: below 25 dB they are not the same picture, and no ratio is printed for that scene.
 *
 * Embree's default triangle test is its fastest and lets some rays slip past edges (eye rays that hit are printed for both);
 * --robust closes them and makes Embree slower. The default is what favours Embree.
 *
 * Builds: ours from a finished scene into a fresh block of memory, Embree's from finished buffers of triangles, which it
 * shares.
 *
 *      bench_peers [--rounds N] [--side N] [--around N] [--robust] [--config TEXT] [NAME[:SIZE] ...]
 */
#include "bench_common.h"

#include <inttypes.h>

#if BENCH_EMBREE && ASET_REAL_BITS == 32 && ASET_WITH_APPROXIMATION && ASET_WITH_REFLECTION && ASET_WITH_REFRACTION && \
    ASET_WITH_PATCHES && ASET_WITH_SPHERES && ASET_WITH_CONES

#include "trace/camera.h"
#include "trace/light.h"
#include "trace/shade.h"

#include <embree3/rtcore.h>

enum { DEPTH = ASET_DEPTH_DEFAULT, OURS = 4, THEIRS = OURS, CONTENDERS = OURS + 1, ARENA_BYTES = 512 << 20 };

#define LEAST_DB 25.0
#define TURN 3.14159265358979323846

typedef struct plan {
    uint32_t rounds, side, around;
    bool robust;
    const char *config; /* of Embree's device */
} plan;

/* --- the scene as triangles: a sink --- */

typedef struct mesh {
    float *points;   /* 3 each */
    float *normals;  /* shading normals at the points; 0, 0, 0: the triangle is flat */
    uint32_t *corners; /* 3 for each triangle */
    aset_vec3 *faces;  /* unit normal of each triangle's polygon, sphere or cone facet */
    uint32_t *material_of;
    aset_material *materials;
    size_t n_points, n_triangles, n_materials, point_room, triangle_room, material_room;
    uint32_t around;
    bool refused; /* something that only one side of shows, or an area that does not fit */
    double worst_area; /* largest relative error of a polygon's area */
    /* the polygon in progress */
    bench_vec *outline, *outline_normals;
    uint32_t n_announced, n_given;
    bool with_normals;
} mesh;

static void *more(void *list, size_t *room, size_t n, size_t bytes) {
    if (n < *room) {
        return list;
    }
    *room = *room > 0 ? 2 * *room : 1024;
    return bench_need(realloc(list, *room * bytes));
}

static uint32_t mesh_point(mesh *m, bench_vec p, bench_vec normal) {
    size_t room = m->point_room;
    m->points = more(m->points, &room, m->n_points + 1, 3 * sizeof *m->points); /* Embree reads a float behind the last */
    m->normals = more(m->normals, &m->point_room, m->n_points + 1, 3 * sizeof *m->normals);
    float *to = m->points + 3 * m->n_points, *normal_to = m->normals + 3 * m->n_points;
    to[0] = (float)p.x, to[1] = (float)p.y, to[2] = (float)p.z;
    normal_to[0] = (float)normal.x, normal_to[1] = (float)normal.y, normal_to[2] = (float)normal.z;
    return (uint32_t)m->n_points++;
}

/* face: NULL takes the triangle's own; a triangle without area is left out, as no ray hits it. */
static void mesh_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c, const bench_vec *face) {
    const float *p[3] = {m->points + 3 * (size_t)a, m->points + 3 * (size_t)b, m->points + 3 * (size_t)c};
    bench_vec at[3];
    for (int i = 0; i < 3; i++) {
        at[i] = bench_make((double)p[i][0], (double)p[i][1], (double)p[i][2]);
    }
    bench_vec own = bench_cross(bench_along(at[1], -1, at[0]), bench_along(at[2], -1, at[0]));
    if (!(bench_length(own) > 0)) {
        return;
    }
    size_t room = m->triangle_room, same = room;
    m->corners = more(m->corners, &room, m->n_triangles, 3 * sizeof *m->corners);
    room = same;
    m->faces = more(m->faces, &room, m->n_triangles, sizeof *m->faces);
    m->material_of = more(m->material_of, &m->triangle_room, m->n_triangles, sizeof *m->material_of);
    uint32_t *to = m->corners + 3 * m->n_triangles;
    to[0] = a, to[1] = b, to[2] = c;
    m->faces[m->n_triangles] = bench_real(bench_unit(face != NULL ? *face : own));
    m->material_of[m->n_triangles++] = (uint32_t)m->n_materials - 1;
}

static aset_status take_background(void *context, const aset_colour *colour) {
    (void)context, (void)colour; /* our scene keeps it, and the view and the lights */
    return ASET_OK;
}

static aset_status take_view(void *context, const aset_view *view) {
    (void)context, (void)view;
    return ASET_OK;
}

static aset_status take_light(void *context, const aset_light *light) {
    (void)context, (void)light;
    return ASET_OK;
}

static aset_status take_material(void *context, const aset_material *material) {
    mesh *m = context;
    m->refused = m->refused || material->one_sided;
    m->materials = more(m->materials, &m->material_room, m->n_materials, sizeof *m->materials);
    m->materials[m->n_materials++] = *material;
    return ASET_OK;
}

static aset_status take_begin(void *context, uint32_t n_points, bool with_normals) {
    mesh *m = context;
    m->n_announced = n_points;
    m->n_given = 0;
    m->with_normals = with_normals;
    m->outline = bench_need(realloc(m->outline, n_points * sizeof *m->outline));
    m->outline_normals = bench_need(realloc(m->outline_normals, n_points * sizeof *m->outline_normals));
    return ASET_OK;
}

static aset_status take_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    mesh *m = context;
    if (m->n_given == m->n_announced) {
        return ASET_ERR_GEOMETRY;
    }
    m->outline[m->n_given] = bench_of(*point);
    m->outline_normals[m->n_given++] = normal != NULL ? bench_of(*normal) : bench_make(0, 0, 0);
    return ASET_OK;
}

/* Twice the area times the normal (Newell). */
static bench_vec outline_area(const mesh *m) {
    bench_vec sum = bench_make(0, 0, 0);
    for (uint32_t i = 2; i < m->n_given; i++) {
        bench_vec before = bench_along(m->outline[i - 1], -1, m->outline[0]);
        bench_vec at = bench_along(m->outline[i], -1, m->outline[0]);
        sum = bench_along(sum, 1, bench_cross(before, at));
    }
    return sum;
}

/* Twice the signed area of a triangle, seen against the normal. */
static double turn_of(bench_vec a, bench_vec b, bench_vec c, bench_vec normal) {
    return bench_dot(normal, bench_cross(bench_along(b, -1, a), bench_along(c, -1, a)));
}

/* May the corner at place k of the n that are left be cut off: is it convex, and holds it no other point that is left? */
static bool is_ear(const mesh *m, const uint32_t *left, uint32_t n, uint32_t k, bench_vec normal) {
    uint32_t before = left[(k + n - 1) % n], at = left[k], after = left[(k + 1) % n];
    bench_vec a = m->outline[before], b = m->outline[at], c = m->outline[after];
    if (!(turn_of(a, b, c, normal) > 0)) {
        return false;
    }
    for (uint32_t i = 0; i < n; i++) {
        if (left[i] != before && left[i] != at && left[i] != after) {
            bench_vec p = m->outline[left[i]];
            if (turn_of(a, b, p, normal) >= 0 && turn_of(b, c, p, normal) >= 0 && turn_of(c, a, p, normal) >= 0) {
                return false;
            }
        }
    }
    return true;
}

/* Of all ears the one with the shortest diagonal, so that triangles stay compact; n if there is none. */
static uint32_t best_ear(const mesh *m, const uint32_t *left, uint32_t n, bench_vec normal) {
    uint32_t best = n;
    double shortest = (double)INFINITY;
    for (uint32_t k = 0; k < n; k++) {
        double length = bench_length(bench_along(m->outline[left[(k + 1) % n]], -1, m->outline[left[(k + n - 1) % n]]));
        if (length < shortest && is_ear(m, left, n, k, normal)) {
            shortest = length;
            best = k;
        }
    }
    return best;
}

static aset_status take_end(void *context) {
    mesh *m = context;
    bench_vec area = outline_area(m), normal = bench_unit(area);
    uint32_t n = m->n_given, *left = bench_need(malloc(n * sizeof *left)), first = (uint32_t)m->n_points;
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) {
        bench_vec given = bench_unit(m->outline_normals[i]);
        mesh_point(m, m->outline[i], m->with_normals && !(bench_length(given) > 0) ? normal : given);
        left[i] = i;
    }
    while (n >= 3 && bench_length(area) > 0) {
        uint32_t k = n == 3 ? 1 : best_ear(m, left, n, normal);
        if (k == n) {
            break; /* only points on one line are left, or the polygon crosses itself: the area tells */
        }
        uint32_t a = left[(k + n - 1) % n], b = left[k], c = left[(k + 1) % n];
        sum += turn_of(m->outline[a], m->outline[b], m->outline[c], normal);
        mesh_triangle(m, first + a, first + b, first + c, &normal);
        memmove(left + k, left + k + 1, (n - k - 1) * sizeof *left);
        n--;
    }
    free(left);
    double error = bench_length(area) > 0 ? fabs(sum / bench_length(area) - 1) : 0;
    m->worst_area = error > m->worst_area ? error : m->worst_area;
    m->refused = m->refused || error > 1e-5;
    return m->n_given == m->n_announced ? ASET_OK : ASET_ERR_GEOMETRY;
}

static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    mesh *m = context;
    uint32_t around = m->around, rows = around / 2, first = (uint32_t)m->n_points;
    bench_vec c = bench_of(*centre);
    m->refused = m->refused || radius < 0;
    for (uint32_t i = 0; i <= rows; i++) { /* the poles' rows are points of which some triangles have no area */
        for (uint32_t j = 0; j < around; j++) {
            double up = TURN * i / rows, about = 2 * TURN * j / around, across = i == 0 || i == rows ? 0 : sin(up);
            bench_vec n = bench_make(across * cos(about), across * sin(about), cos(up));
            mesh_point(m, bench_along(c, (double)radius, n), n);
        }
    }
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < around; j++) {
            uint32_t a = first + i * around + j, b = first + i * around + (j + 1) % around;
            if (i > 0) {
                mesh_triangle(m, a, a + around, b, NULL);
            }
            if (i + 1 < rows) {
                mesh_triangle(m, b, a + around, b + around, NULL);
            }
        }
    }
    return ASET_OK;
}

static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    mesh *m = context;
    uint32_t around = m->around, first = (uint32_t)m->n_points;
    bench_vec from = bench_of(*base), along = bench_along(bench_of(*apex), -1, from), axis = bench_unit(along);
    bench_vec other = fabs(axis.x) < 0.5 ? bench_make(1, 0, 0) : bench_make(0, 1, 0);
    bench_vec u = bench_unit(bench_cross(axis, other)), v = bench_cross(axis, u);
    double slope = ((double)apex_radius - (double)base_radius) / bench_length(along);
    m->refused = m->refused || base_radius < 0 || apex_radius < 0;
    for (uint32_t j = 0; j < around; j++) {
        double about = 2 * TURN * j / around;
        bench_vec out = bench_along(bench_along(bench_make(0, 0, 0), cos(about), u), sin(about), v);
        bench_vec n = bench_unit(bench_along(out, -slope, axis));
        mesh_point(m, bench_along(from, (double)base_radius, out), n);
        mesh_point(m, bench_along(bench_of(*apex), (double)apex_radius, out), n);
    }
    for (uint32_t j = 0; j < around; j++) {
        uint32_t a = first + 2 * j, b = first + 2 * ((j + 1) % around);
        if (base_radius > 0) {
            mesh_triangle(m, a, b, a + 1, NULL);
        }
        if (apex_radius > 0) {
            mesh_triangle(m, a + 1, b, b + 1, NULL);
        }
    }
    return ASET_OK;
}

static aset_sink mesh_sink(mesh *m, uint32_t around) {
    aset_sink sink;
    memset(m, 0, sizeof *m);
    memset(&sink, 0, sizeof sink);
    m->around = around;
    sink.context = m;
    sink.background = take_background;
    sink.view = take_view;
    sink.light = take_light;
    sink.material = take_material;
    sink.polygon_begin = take_begin;
    sink.polygon_point = take_point;
    sink.polygon_end = take_end;
    sink.sphere = take_sphere;
    sink.cone = take_cone;
    return sink;
}

static void mesh_close(mesh *m) {
    free(m->points);
    free(m->normals);
    free(m->corners);
    free(m->faces);
    free(m->material_of);
    free(m->materials);
    free(m->outline);
    free(m->outline_normals);
}

/* --- Embree's scene and rays --- */

typedef struct peer {
    const mesh *m;
    const aset_scene *scene; /* lights, background */
    RTCScene top;
    uint64_t rays;
} peer;

static RTCScene peer_build(RTCDevice device, const mesh *m, bool robust) {
    RTCScene scene = rtcNewScene(device);
    RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m->points, 0, 12, m->n_points);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->corners, 0, 12, m->n_triangles);
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
    rtcCommitScene(scene);
    return scene;
}

static struct RTCRay peer_ray(aset_vec3 origin, aset_vec3 direction, float t_max) {
    struct RTCRay ray;
    memset(&ray, 0, sizeof ray);
    ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
    ray.dir_x = direction.x, ray.dir_y = direction.y, ray.dir_z = direction.z;
    ray.tfar = t_max;
    ray.mask = UINT32_MAX;
    return ray;
}

static bool peer_closest(RTCScene scene, struct RTCRayHit *hit, aset_vec3 origin, aset_vec3 direction) {
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    hit->ray = peer_ray(origin, direction, REAL_INFINITY);
    hit->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, hit);
    return hit->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static bool peer_any(RTCScene scene, aset_vec3 origin, aset_vec3 direction, float t_max) {
    struct RTCIntersectContext context;
    struct RTCRay ray = peer_ray(origin, direction, t_max);
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &ray);
    return ray.tfar < 0; /* Embree's way to say yes */
}

/* --- the same shading: shade.c and trace.c with Embree's rays --- */

static aset_vec3 mesh_normal(const mesh *m, const struct RTCHit *hit) {
    const uint32_t *corner = m->corners + 3 * (size_t)hit->primID;
    const float *a = m->normals + 3 * (size_t)corner[0], *b = m->normals + 3 * (size_t)corner[1],
                *c = m->normals + 3 * (size_t)corner[2];
    if (a[0] == 0 && a[1] == 0 && a[2] == 0) {
        return m->faces[hit->primID];
    }
    float u = hit->u, v = hit->v, w = 1 - u - v;
    return aset_vec_unit(
        vec(w * a[0] + u * b[0] + v * c[0], w * a[1] + u * b[1] + v * c[1], w * a[2] + u * b[2] + v * c[2]));
}

static void peer_shading(shading *s, const mesh *m, const struct RTCRayHit *hit, aset_vec3 origin, aset_vec3 direction) {
    uint32_t triangle = hit->hit.primID;
    s->hit.t = hit->ray.tfar;
    s->hit.point = vec_along(origin, hit->ray.tfar, direction);
    s->hit.geometric = m->faces[triangle];
    s->hit.normal = mesh_normal(m, &hit->hit);
    s->hit.material = m->materials + m->material_of[triangle];
    s->direction = direction;
    s->entering = vec_dot(s->hit.geometric, direction) <= 0;
    s->facing = s->entering ? s->hit.geometric : vec_scale(s->hit.geometric, -1);
    s->normal = s->entering ? s->hit.normal : vec_scale(s->hit.normal, -1);
    s->nudge = (vec_largest(s->hit.point) + hit->ray.tfar) * (aset_real)BENCH_NUDGE;
}

static aset_real peer_highlight(const shading *s, aset_vec3 to_light, aset_real n_dot_l) {
    aset_vec3 mirrored = vec_sub(vec_scale(s->normal, 2 * n_dot_l), to_light);
    aset_real r_dot_v = -vec_dot(mirrored, s->direction);
    return r_dot_v > 0 ? aset_real_power(r_dot_v, s->hit.material->shine) : 0;
}

static aset_colour peer_local(peer *p, const shading *s) {
    const aset_material *m = s->hit.material;
    aset_colour sum = {R(0.1) * m->fill.r, R(0.1) * m->fill.g, R(0.1) * m->fill.b};
    for (uint32_t i = 0; i < p->scene->counts.lights; i++) {
        light_ray towards;
        if (!aset_light_towards(&towards, p->scene, p->scene->lights + i, s->hit.point)) {
            continue;
        }
        aset_real n_dot_l = vec_dot(s->normal, towards.direction);
        if (!(n_dot_l > 0)) {
            continue;
        }
        p->rays++;
        if (peer_any(p->top, aset_shade_start(s, towards.direction, false, 0), towards.direction, towards.distance)) {
            continue;
        }
        aset_real diffuse = m->diffuse * n_dot_l;
        aset_real specular = m->specular > 0 ? m->specular * peer_highlight(s, towards.direction, n_dot_l) : 0;
        sum.r += (m->fill.r * diffuse + specular) * towards.colour.r;
        sum.g += (m->fill.g * diffuse + specular) * towards.colour.g;
        sum.b += (m->fill.b * diffuse + specular) * towards.colour.b;
    }
    return sum;
}

static void peer_leave(aset_waiting *stack, uint32_t *n, const shading *s, aset_vec3 direction, aset_real weight,
                       uint32_t depth) {
    aset_waiting w = {aset_shade_start(s, direction, false, 0), direction, weight, (uint16_t)depth, 0};
    stack[(*n)++] = w;
}

static void add_weighted(aset_colour *sum, aset_real weight, const aset_colour *colour) {
    sum->r += weight * colour->r;
    sum->g += weight * colour->g;
    sum->b += weight * colour->b;
}

static aset_colour peer_tree(peer *p, aset_vec3 origin, aset_vec3 direction) {
    aset_waiting stack[DEPTH + 1];
    aset_colour sum = {0, 0, 0};
    uint32_t n = 1;
    aset_waiting eye = {origin, direction, 1, 0, 0};
    stack[0] = eye;
    while (n > 0) {
        aset_waiting ray = stack[--n];
        struct RTCRayHit hit;
        shading s;
        p->rays++;
        if (!peer_closest(p->top, &hit, ray.origin, ray.direction)) {
            add_weighted(&sum, ray.weight, &p->scene->background);
            continue;
        }
        peer_shading(&s, p->m, &hit, ray.origin, ray.direction);
        aset_colour local = peer_local(p, &s);
        add_weighted(&sum, ray.weight, &local);
        const aset_material *m = s.hit.material;
        uint32_t depth = ray.depth + 1u;
        aset_vec3 refracted;
        if (depth < DEPTH && m->transmittance > 0 && aset_shade_refracted(&s, &refracted)) {
            peer_leave(stack, &n, &s, refracted, ray.weight * m->transmittance, depth);
        }
        if (depth < DEPTH && m->specular > 0) {
            peer_leave(stack, &n, &s, aset_shade_reflected(&s), ray.weight * m->specular, depth);
        }
    }
    return sum;
}

static unsigned char to_byte(aset_real x) {
    return (unsigned char)((x > 0 ? (x < 1 ? x : 1) : 0) * 255 + R(0.5));
}

static void peer_picture(peer *p, unsigned char *pixels, uint32_t side) {
    camera eye;
    if (aset_camera_make(&eye, &p->scene->view, side, side) != ASET_OK) {
        return;
    }
    for (uint32_t row = 0; row < side; row++) {
        for (uint32_t column = 0; column < side; column++, pixels += 3) {
            aset_vec3 origin, direction;
            aset_camera_ray(&eye, 2 * ((aset_real)column + R(0.5)) / (aset_real)side - 1,
                            2 * ((aset_real)row + R(0.5)) / (aset_real)side - 1, &origin, &direction);
            aset_colour c = peer_tree(p, origin, direction);
            pixels[0] = to_byte(c.r);
            pixels[1] = to_byte(c.g);
            pixels[2] = to_byte(c.b);
        }
    }
}

/* --- contenders --- */

static const struct {
    const char *name;
    const aset_method *method;
    int approx_depth; /* below 0: exact */
} ours[OURS] = {{"mset, exact", &aset_mset, -1}, {"grid, exact", &aset_grid, -1}, {"aset, L = 1", &aset_mset, 1},
                {"aset, L = 0", &aset_mset, 0}};

typedef struct figures {
    double build[CONTENDERS][BENCH_ROUNDS_MAX], picture[CONTENDERS][BENCH_ROUNDS_MAX], both[CONTENDERS][BENCH_ROUNDS_MAX];
    double closest[CONTENDERS][BENCH_ROUNDS_MAX], any[CONTENDERS][BENCH_ROUNDS_MAX], random[CONTENDERS][BENCH_ROUNDS_MAX];
    uint64_t rays[CONTENDERS];
    size_t bytes[CONTENDERS], found[CONTENDERS];
} figures;

typedef struct bench_stage {
    bench_scene scene;
    mesh m;
    RTCDevice device;
    bench_rays eye, shadow, random;
    unsigned char *pixels[CONTENDERS];
    figures f;
} bench_stage;

/* Bytes that Embree holds, by its own account. */
static ptrdiff_t held;

static bool count_bytes(void *context, ssize_t bytes, bool after) {
    (void)context, (void)after;
    held += bytes;
    return true;
}

static volatile size_t kept; /* so that no answer is computed in vain */

static double ask_ours(const aset_tracer *t, const bench_rays *r, bool any, bool approximate, size_t *found) {
    double from = bench_seconds();
    *found = 0;
    for (size_t i = 0; i < r->n; i++) {
        aset_hit hit;
        bool is = false;
        if (any) {
            aset_any_hit(&is, t, r->list + i, approximate, NULL);
        } else {
            aset_closest_hit(&is, &hit, t, r->list + i, approximate, NULL);
        }
        *found += is;
    }
    kept = *found;
    return (bench_seconds() - from) / (double)(r->n > 0 ? r->n : 1);
}

static double ask_theirs(const peer *p, const bench_rays *r, bool any, size_t *found) {
    double from = bench_seconds();
    *found = 0;
    for (size_t i = 0; i < r->n; i++) {
        const aset_ray *ray = r->list + i;
        struct RTCRayHit hit;
        shading s;
        bool is = any ? peer_any(p->top, ray->origin, ray->direction, ray->t_max)
                      : peer_closest(p->top, &hit, ray->origin, ray->direction);
        if (is && !any) {
            peer_shading(&s, p->m, &hit, ray->origin, ray->direction); /* ours tells point, normals and material as well */
            kept += s.entering;
        }
        *found += is;
    }
    kept = *found;
    return (bench_seconds() - from) / (double)(r->n > 0 ? r->n : 1);
}

/* One round of one of ours. round below 0: nothing is kept, but the shadow rays are made. */
static bool round_ours(bench_stage *b, const plan *p, unsigned which, int round) {
    aset_arena arena;
    aset_space space;
    aset_summary summary;
    aset_scratch scratch;
    aset_statistics statistics = {0};
    bool approximate = ours[which].approx_depth >= 0;
    double start = bench_seconds();
    void *block = bench_need(malloc(ARENA_BYTES)); /* untouched pages cost nothing */
    aset_arena_init(&arena, block, ARENA_BYTES);
    bool fine = aset_space_build(&space, &b->scene.scene, ours[which].method, NULL, &arena) == ASET_OK &&
                (!approximate || aset_summary_build(&summary, &space, 0, &arena) == ASET_OK);
    double build = bench_seconds() - start;
    size_t bytes = arena.used;
    const aset_tracer tracer = {.scene = &b->scene.scene, .space = &space, .summary = approximate ? &summary : NULL,
                                .curtail = R(0.5), .approx_kinds = ASET_ALL_KINDS,
                                .approx_depth = approximate ? (uint32_t)ours[which].approx_depth : 0};
    const aset_picture picture = {.width = p->side, .height = p->side, .pixels = b->pixels[which],
                                  .stride = 3 * (size_t)p->side};
    start = bench_seconds();
    fine = fine && aset_scratch_init(&scratch, 0, &arena) == ASET_OK &&
           aset_render_rows(&tracer, &b->scene.scene.view, &picture, 0, p->side, &scratch, &statistics) == ASET_OK;
    double drawn = bench_seconds() - start;
    if (fine && round < 0 && which == 0) {
        bench_shadow_rays(&b->shadow, &b->eye, &tracer);
    } else if (fine && round >= 0) {
        size_t ignored;
        figures *f = &b->f;
        bool first = ours[which].approx_depth == 1; /* L = 1: eye and shadow rays are exact, random ones as if of depth 1 */
        f->build[which][round] = build;
        f->picture[which][round] = drawn;
        f->both[which][round] = build + drawn;
        f->closest[which][round] = ask_ours(&tracer, &b->eye, false, approximate && !first, f->found + which);
        f->any[which][round] = ask_ours(&tracer, &b->shadow, true, approximate && !first, &ignored);
        f->random[which][round] = ask_ours(&tracer, &b->random, false, approximate, &ignored);
        f->rays[which] = statistics.primary + statistics.shadow + statistics.reflected + statistics.refracted;
        f->bytes[which] = bytes;
    }
    free(block);
    return fine;
}

static bool round_theirs(bench_stage *b, const plan *p, int round) {
    figures *f = &b->f;
    ptrdiff_t before = held;
    double start = bench_seconds();
    peer e = {&b->m, &b->scene.scene, peer_build(b->device, &b->m, p->robust), 0};
    double build = bench_seconds() - start;
    ptrdiff_t bytes = held - before;
    start = bench_seconds();
    peer_picture(&e, b->pixels[THEIRS], p->side);
    double drawn = bench_seconds() - start;
    if (round >= 0) {
        size_t ignored;
        f->build[THEIRS][round] = build;
        f->picture[THEIRS][round] = drawn;
        f->both[THEIRS][round] = build + drawn;
        f->closest[THEIRS][round] = ask_theirs(&e, &b->eye, false, f->found + THEIRS);
        f->any[THEIRS][round] = ask_theirs(&e, &b->shadow, true, &ignored);
        f->random[THEIRS][round] = ask_theirs(&e, &b->random, false, &ignored);
        f->rays[THEIRS] = e.rays;
        f->bytes[THEIRS] = (size_t)bytes;
    }
    rtcReleaseScene(e.top);
    enum RTCError error = rtcGetDeviceError(b->device);
    if (error != RTC_ERROR_NONE) {
        fprintf(stderr, "bench_peers: Embree reports error %d\n", (int)error);
    }
    return error == RTC_ERROR_NONE;
}

/* --- comparing and printing --- */

/* In dB; 99 when equal. */
static double psnr(const unsigned char *a, const unsigned char *b, size_t n) {
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        double d = (double)a[i] - (double)b[i];
        sum += d * d;
    }
    return sum > 0 ? fmin(99, 10 * log10(255.0 * 255.0 * (double)n / sum)) : 99;
}

/* Into DIRECTORY/NAME-who.ppm, to look at where the pictures differ. */
static void keep_picture(const bench_stage *b, const plan *p, unsigned which, const char *who) {
    const char *directory = getenv("BENCH_PICTURES");
    char path[512];
    if (directory == NULL) {
        return;
    }
    snprintf(path, sizeof path, "%s/%s-%s.ppm", directory, b->scene.source->name, who);
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        perror(path);
        return;
    }
    fprintf(file, "P6\n%" PRIu32 " %" PRIu32 "\n255\n", p->side, p->side);
    fwrite(b->pixels[which], 3, (size_t)p->side * p->side, file);
    fclose(file);
}

static double median_of(const double *list, unsigned n) {
    double copy[BENCH_ROUNDS_MAX];
    memcpy(copy, list, n * sizeof *copy);
    return bench_spread_of(copy, n).median;
}

/* A ratio to Embree's: the median of the rounds, and the middle half. */
static void print_ratio(double (*what)[BENCH_ROUNDS_MAX], unsigned which, unsigned rounds) {
    bench_spread r = bench_ratios(what[which], what[THEIRS], rounds);
    printf(" %.2f (%.2f-%.2f) |", r.median, r.low, r.high);
}

static void print_row(bench_stage *b, const plan *p, unsigned which) {
    figures *f = &b->f;
    unsigned n = p->rounds;
    double picture = median_of(f->picture[which], n);
    printf("| %s | %zu | %.2f | %.1f | %.2f | %.2f | %.2f | %.2f |", which == THEIRS ? "Embree" : ours[which].name,
           f->bytes[which], 1e3 * median_of(f->build[which], n), 1e3 * picture, 1e-6 * (double)f->rays[which] / picture,
           1e-6 / median_of(f->closest[which], n), 1e-6 / median_of(f->any[which], n),
           1e-6 / median_of(f->random[which], n));
    print_ratio(f->build, which, n);
    print_ratio(f->picture, which, n);
    print_ratio(f->both, which, n);
    if (which == 0) {
        printf(" |\n");
    } else {
        printf(" %.1f |\n", psnr(b->pixels[0], b->pixels[which], 3 * (size_t)p->side * p->side));
    }
}

static void print_stage(bench_stage *b, const plan *p) {
    printf("| contender | bytes | build ms | picture ms | Mrays/s in it | eye Mrays/s | shadow Mrays/s | random Mrays/s | "
           "build / Embree | picture / Embree | both / Embree | PSNR dB |\n"
           "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (unsigned which = 0; which < CONTENDERS; which++) {
        print_row(b, p, which);
    }
    printf("\nOf %zu eye rays hit: ours %zu, Embree's %zu.\n", b->eye.n, b->f.found[0], b->f.found[THEIRS]);
    fflush(stdout);
}

static bool stage_open(bench_stage *b, const plan *p) {
    aset_sink sink = mesh_sink(&b->m, p->around);
    aset_status status = bench_scene_open(&b->scene);
    status = status == ASET_OK ? b->scene.source->emit(&sink, b->scene.size) : status;
    if (status != ASET_OK || b->m.refused || !b->scene.scene.has_view) {
        fprintf(stderr, "bench_peers: %s left out: %s\n", b->scene.text,
                status != ASET_OK ? aset_status_text(status)
                : b->m.refused    ? "one-sided surfaces, or a polygon whose triangles have another area than itself"
                                  : "it has no view");
        return false;
    }
    for (unsigned i = 0; i < CONTENDERS; i++) {
        b->pixels[i] = bench_need(malloc(3 * (size_t)p->side * p->side));
    }
    bench_eye_rays(&b->eye, &b->scene.scene.view, p->side);
    bench_random_rays(&b->random, &b->scene.scene, 20000, 20240607);
    return true;
}

static void stage_close(bench_stage *b) {
    for (unsigned i = 0; i < CONTENDERS; i++) {
        free(b->pixels[i]);
    }
    free(b->eye.list);
    free(b->shadow.list);
    free(b->random.list);
    mesh_close(&b->m);
    bench_scene_close(&b->scene);
}

/* Pictures first; then rounds in which each builds, draws and is asked in turn. */
static bool stage_run(bench_stage *b, const plan *p) {
    bool fine = round_ours(b, p, 0, -1) && round_theirs(b, p, -1);
    double db = fine ? psnr(b->pixels[0], b->pixels[THEIRS], 3 * (size_t)p->side * p->side) : 0;
    printf("\n### %s\n\n%" PRIu32 " objects, %zu triangles (areas within %.0e); %zu shadow rays; Embree's picture against "
           "our exact one: %.1f dB.\n\n",
           b->scene.text, b->scene.scene.counts.objects, b->m.n_triangles, b->m.worst_area, b->shadow.n, db);
    keep_picture(b, p, 0, "ours");
    keep_picture(b, p, THEIRS, "embree");
    if (fine && db < LEAST_DB) {
        printf("Below %.0f dB: not the same picture, so no ratios.\n", LEAST_DB);
        return true;
    }
    for (unsigned round = 0; round < p->rounds && fine; round++) {
        for (unsigned turn = 0; turn < CONTENDERS && fine; turn++) {
            unsigned which = round % 2 == 0 ? turn : CONTENDERS - 1 - turn; /* forth, then back: neighbours change sides */
            fine = which == THEIRS ? round_theirs(b, p, (int)round) : round_ours(b, p, which, (int)round);
        }
    }
    if (fine) {
        print_stage(b, p);
    }
    return fine;
}

static bool bench(const plan *p, RTCDevice device, const char *text) {
    static bench_stage b;
    memset(&b, 0, sizeof b);
    b.device = device;
    bool fine = bench_scene_find(&b.scene, text);
    if (fine && stage_open(&b, p)) {
        fine = stage_run(&b, p);
    }
    stage_close(&b);
    return fine;
}

static bool option(plan *p, const char *name, const char *value, bool *took_value) {
    *took_value = true;
    if (strcmp(name, "--robust") == 0) {
        *took_value = false;
        p->robust = true;
        return true;
    }
    if (value == NULL || strcmp(name, "--config") == 0) {
        p->config = value;
        return value != NULL;
    }
    unsigned long n = strtoul(value, NULL, 10);
    if (strcmp(name, "--rounds") == 0 && n >= 1 && n <= BENCH_ROUNDS_MAX) {
        p->rounds = (uint32_t)n;
    } else if (strcmp(name, "--side") == 0 && n >= 1 && n <= 4096) {
        p->side = (uint32_t)n;
    } else if (strcmp(name, "--around") == 0 && n >= 4 && n <= 256) {
        p->around = (uint32_t)n;
    } else {
        return false;
    }
    return true;
}

int main(int argc, char **argv) {
    plan p = {7, 256, 24, false, "threads=1,user_threads=0,frequency_level=simd256"};
    bool fine = true, took_value;
    int i = 1;
    for (; i < argc && argv[i][0] == '-'; i += 1 + took_value) {
        if (!option(&p, argv[i], argv[i + 1], &took_value)) {
            fprintf(stderr, "usage: bench_peers [--rounds N] [--side N] [--around N] [--robust] [--config TEXT] "
                            "[NAME[:SIZE] ...]\n");
            return 2;
        }
    }
    const char *const *texts = i < argc ? (const char *const *)argv + i : bench_defaults;
    int n = i < argc ? argc - i : BENCH_SCENES;
    RTCDevice device = rtcNewDevice(p.config);
    if (device == NULL) {
        fprintf(stderr, "bench_peers: Embree gives no device for \"%s\"\n", p.config);
        return 1;
    }
    rtcSetDeviceMemoryMonitorFunction(device, count_bytes, NULL);
    printf("Embree %s (%s%s), one thread, single rays; %" PRIu32 " x %" PRIu32 " pixels; medians of %" PRIu32 " interleaved "
           "rounds, processor time;\nspheres and cones of %" PRIu32 " facets around. Ratios: ours over Embree's in the same "
           "round, median (middle half); below 1 we are faster.\n",
           RTC_VERSION_STRING, p.config, p.robust ? ", robust" : "", p.side, p.side, p.rounds, p.around);
    for (int k = 0; k < n; k++) {
        bench_scene s;
        if (!bench_scene_find(&s, texts[k])) {
            fprintf(stderr, "bench_peers: %s: no such scene or size\n", texts[k]);
            rtcReleaseDevice(device);
            return 2;
        }
        fine = bench(&p, device, texts[k]) && fine;
    }
    rtcReleaseDevice(device);
    return fine ? 0 : 1;
}

#else

int main(void) {
    printf("bench_peers: compiled without Embree 3 (Debian: libembree-dev), or without a feature that the comparison needs; "
           "nothing to compare with\n");
    return 0;
}

#endif
