/*
 * bench_common.h - what the benchmarks share: scenes by rule, their rays, processor time, medians. Public headers only.
 *
 * Time is the processor time of the whole process, which waits for nobody else's turn; what a shared cache or a busy twin
 * core does to it remains, so figures are medians of rounds in which all contenders take turns.
 */
#ifndef ASET_TESTS_BENCH_COMMON_H
#define ASET_TESTS_BENCH_COMMON_H

#include "aset/aset.h"
#include "aset/procedural.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* A secondary ray starts so many units in the last place off its surface: shade.c's number. */
#define BENCH_NUDGE (32.0 / (ASET_REAL_BITS == 32 ? 16777216.0 : 9007199254740992.0))

enum { BENCH_ROUNDS_MAX = 101, BENCH_SCENES = 9 };

/* Small enough for all seven methods in a few minutes; the sizes of the published counts are larger. */
static const char *const bench_defaults[BENCH_SCENES] = {"balls:3", "gears:2", "gears:4", "mount:6", "rings:3",
                                                         "teapot:6", "tetra:6", "tree:8", "snow"};

static inline void *bench_need(void *block) {
    if (block == NULL) {
        fprintf(stderr, "the machine has no memory left\n");
        exit(1);
    }
    return block;
}

static inline double bench_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- medians --- */

typedef struct bench_spread {
    double low, median, high; /* of the middle half */
} bench_spread;

static inline int bench_ascending(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Sorts the list; n at least 1. */
static inline bench_spread bench_spread_of(double *list, unsigned n) {
    qsort(list, n, sizeof *list, bench_ascending);
    double middle = n % 2 == 1 ? list[n / 2] : (list[n / 2 - 1] + list[n / 2]) / 2;
    bench_spread s = {list[n / 4], middle, list[n - 1 - n / 4]};
    return s;
}

/* Of list[k] / base[k], round by round, so that what both felt falls out. n at most BENCH_ROUNDS_MAX. */
static inline bench_spread bench_ratios(const double *list, const double *base, unsigned n) {
    double ratios[BENCH_ROUNDS_MAX];
    for (unsigned k = 0; k < n; k++) {
        ratios[k] = base[k] > 0 ? list[k] / base[k] : 0;
    }
    return bench_spread_of(ratios, n);
}

/* --- scenes --- */

typedef struct bench_scene {
    const char *text; /* NAME or NAME:SIZE */
    const aset_procedural *source;
    uint32_t size; /* 0: the scene's default */
    void *block;
    aset_scene scene;
} bench_scene;

/* False: no such scene or size. */
static inline bool bench_scene_find(bench_scene *s, const char *text) {
    char name[32], *end = NULL;
    const char *colon = strchr(text, ':');
    size_t length = colon != NULL ? (size_t)(colon - text) : strlen(text);
    memset(s, 0, sizeof *s);
    s->text = text;
    if (length >= sizeof name) {
        return false;
    }
    memcpy(name, text, length);
    name[length] = '\0';
    s->source = aset_procedural_find(name);
    if (s->source == NULL) {
        return false;
    }
    unsigned long size = colon != NULL ? strtoul(colon + 1, &end, 10) : 0;
    if (colon != NULL && (end == colon + 1 || *end != '\0' || size == 0 || size > s->source->largest_size)) {
        return false;
    }
    s->size = (uint32_t)size;
    return true;
}

static inline aset_status bench_scene_open(bench_scene *s) {
    aset_counter counter;
    aset_arena arena;
    aset_sink sink = aset_counter_sink(&counter);
    aset_status status = s->source->emit(&sink, s->size);
    if (status != ASET_OK) {
        return status;
    }
    const aset_counts *n = &counter.counts;
    size_t bytes = ASET_BYTES_SCENE(n->objects, n->coordinates, n->materials, n->lights);
    s->block = bench_need(malloc(bytes));
    aset_arena_init(&arena, s->block, bytes);
    status = aset_scene_init(&s->scene, &arena, n);
    sink = aset_scene_sink(&s->scene);
    return status == ASET_OK ? s->source->emit(&sink, s->size) : status;
}

static inline void bench_scene_close(bench_scene *s) {
    free(s->block);
    s->block = NULL;
}

/* --- vectors, in double: the same rays whatever is measured with them --- */

typedef struct bench_vec {
    double x, y, z;
} bench_vec;

static inline bench_vec bench_make(double x, double y, double z) {
    bench_vec v = {x, y, z};
    return v;
}

static inline bench_vec bench_of(aset_vec3 v) {
    return bench_make((double)v.x, (double)v.y, (double)v.z);
}

static inline aset_vec3 bench_real(bench_vec v) {
    aset_vec3 r = {(aset_real)v.x, (aset_real)v.y, (aset_real)v.z};
    return r;
}

/* a + s b */
static inline bench_vec bench_along(bench_vec a, double s, bench_vec b) {
    return bench_make(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline double bench_dot(bench_vec a, bench_vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline bench_vec bench_cross(bench_vec a, bench_vec b) {
    return bench_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double bench_length(bench_vec a) {
    return sqrt(bench_dot(a, a));
}

/* Zero for zero. */
static inline bench_vec bench_unit(bench_vec a) {
    double length = bench_length(a);
    return length > 0 ? bench_make(a.x / length, a.y / length, a.z / length) : a;
}

/* --- rays, of unit direction --- */

typedef struct bench_rays {
    aset_ray *list;
    size_t n, capacity;
} bench_rays;

static inline void bench_rays_add(bench_rays *r, bench_vec origin, bench_vec direction, double t_max) {
    if (r->n == r->capacity) {
        r->capacity = r->capacity > 0 ? 2 * r->capacity : 4096;
        r->list = bench_need(realloc(r->list, r->capacity * sizeof *r->list));
    }
    aset_ray ray = {bench_real(origin), bench_real(direction), (aset_real)t_max};
    r->list[r->n++] = ray;
}

/* One ray through the centre of each pixel of a square picture, row by row. */
static inline void bench_eye_rays(bench_rays *eye, const aset_view *view, uint32_t side) {
    bench_vec from = bench_of(view->from), forward = bench_unit(bench_along(bench_of(view->at), -1, from));
    bench_vec right = bench_unit(bench_cross(forward, bench_of(view->up))), down = bench_cross(forward, right);
    bool parallel = view->height > 0;
    double half = parallel ? (double)view->height / 2 : tan((double)view->angle_deg * (3.14159265358979323846 / 360));
    for (uint32_t row = 0; row < side; row++) {
        for (uint32_t column = 0; column < side; column++) {
            double x = half * ((2 * column + 1.0) / side - 1), y = half * ((2 * row + 1.0) / side - 1);
            bench_vec across = bench_along(bench_along(bench_make(0, 0, 0), x, right), y, down);
            bench_rays_add(eye, parallel ? bench_along(from, 1, across) : from,
                           parallel ? forward : bench_unit(bench_along(forward, 1, across)), (double)INFINITY);
        }
    }
}

/* Towards every light that the surface faces, ending there. */
static inline void bench_rays_to_lights(bench_rays *shadow, const aset_scene *scene, const aset_hit *hit,
                                        bench_vec direction) {
    bench_vec point = bench_of(hit->point), normal = bench_of(hit->normal), facing = bench_of(hit->geometric);
    bool behind = bench_dot(facing, direction) > 0;
    double largest = fmax(fabs(point.x), fmax(fabs(point.y), fabs(point.z)));
    double nudge = (largest + (double)hit->t) * BENCH_NUDGE;
    for (uint32_t i = 0; i < scene->counts.lights; i++) {
        const aset_light *light = scene->lights + i;
        bench_vec way = light->directional ? bench_of(light->position) : bench_along(bench_of(light->position), -1, point);
        bench_vec towards = bench_unit(way);
        if ((behind ? -1 : 1) * bench_dot(normal, towards) > 0) {
            double side = bench_dot(facing, towards) < 0 ? -nudge : nudge;
            bench_rays_add(shadow, bench_along(point, side, facing), towards,
                           light->directional ? (double)INFINITY : bench_length(way));
        }
    }
}

/* The shadow rays of the eye rays' exact hits, in the eye rays' order. */
static inline void bench_shadow_rays(bench_rays *shadow, const bench_rays *eye, const aset_tracer *tracer) {
    for (size_t i = 0; i < eye->n; i++) {
        aset_hit hit;
        bool found = false;
        if (aset_closest_hit(&found, &hit, tracer, eye->list + i, false, NULL) == ASET_OK && found) {
            bench_rays_to_lights(shadow, tracer->scene, &hit, bench_of(eye->list[i].direction));
        }
    }
}

/* splitmix64 (Steele, Lea and Flood 2014) */
static inline double bench_random(uint64_t *state) {
    uint64_t x = *state += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((x ^ (x >> 31)) >> 11) * (1.0 / 9007199254740992.0);
}

/* From anywhere in a box half as large again as the scene's, in any direction, without end. */
static inline void bench_random_rays(bench_rays *r, const aset_scene *scene, size_t n, uint64_t seed) {
    aset_vec3 low = {0, 0, 0}, high = {0, 0, 0};
    aset_scene_bounds(scene, &low, &high);
    bench_vec from = bench_of(low), span = bench_along(bench_of(high), -1, from);
    while (r->n < n) {
        double x = bench_random(&seed), y = bench_random(&seed), z = bench_random(&seed);
        bench_vec at = bench_make(from.x + span.x * (1.5 * x - 0.25), from.y + span.y * (1.5 * y - 0.25),
                                  from.z + span.z * (1.5 * z - 0.25));
        x = 2 * bench_random(&seed) - 1;
        y = 2 * bench_random(&seed) - 1;
        z = 2 * bench_random(&seed) - 1;
        double length = bench_length(bench_make(x, y, z));
        if (length <= 1 && length > 0.01) {
            bench_rays_add(r, at, bench_unit(bench_make(x, y, z)), (double)INFINITY);
        }
    }
}

#endif
