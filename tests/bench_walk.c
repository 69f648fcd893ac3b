/*
 * bench_walk.c - what the generic walk costs: MSET's exact queries as the library makes them, with a call of the visitor for
 * each non-empty cell and object numbers in batches, against the same brick walk with the tests of objects in its loop.
 *
 * Both sides move the ray near the scene, count the same things and test objects by aset_object_nearest, so what differs is the
 * seam alone: method->go, walk_request, walk_cell, the visitor. First every ray is asked both ways, and any difference in
 * found, t, object or the counts makes the program end with 1; then both are timed in turns, on the same rays, by processor
 * time. The ratio of two turns that follow one another feels little of whatever else the machine does.
 *
 *      bench_walk [-r ROUNDS] [-t MILLISECONDS] [NAME[:SIZE] ...]
 */
#include "aset/aset.h"
#include "aset/procedural.h"
#include "space/bricks.h"
#include "trace/camera.h"
#include "trace/light.h"
#include "scene/approach.h"
#include "trace/query.h"
#include "trace/shade.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PICTURE = 192, RANDOM_RAYS = 30000, ROUNDS_MAX = 101, FACES = 6 };

#define SEED UINT64_C(20240607)

/* --- the fused query --- */

/* Where a ray from outside is made to start: query.c's number. */

typedef struct answer {
    aset_real t;
    uint32_t object;
    bool found;
} answer;

typedef struct fused {
    const aset_scene *scene;
    const probe *ray;
    aset_real end, best; /* best is the limit of the walk, too */
    uint32_t object;
    uint64_t cells, nonempty, tests, hits;
} fused;

/* True: nothing further is of interest. */
static inline bool fused_test(fused *f, uint32_t object, bool any) {
    aset_real t = aset_object_nearest(f->scene, object, f->ray, f->end);
    f->tests++;
    f->hits += t < f->end;
    if (t < f->best || (t == f->best && f->object != ASET_NO_OBJECT && object < f->object)) {
        f->best = t;
        f->object = object;
        return any;
    }
    return false;
}

/* The large objects whose boxes hold the origin's voxel; held keeps a bit for each. */
static inline bool fused_large(fused *f, const aset_space *space, const int32_t voxel[3], uint32_t *held, bool any) {
    for (uint32_t i = 0; i < space->n_large; i++) {
        const aset_large *large = space->large + i;
        bool holds = true;
        for (int a = 0; a < 3; a++) {
            holds = holds && voxel[a] >= large->low[a] && voxel[a] <= large->high[a];
        }
        *held |= (uint32_t)holds << i;
        if (holds && fused_test(f, large->object, any)) {
            return true;
        }
    }
    return false;
}

static inline bool fused_was_held(const aset_space *space, uint32_t object, uint32_t held) {
    for (uint32_t i = 0; held >> i != 0; i++) {
        if ((held >> i & 1) != 0 && space->large[i].object == object) {
            return true;
        }
    }
    return false;
}

/* The objects of one marked cell side. */
static inline bool fused_side(fused *f, const aset_space *space, uint32_t rank, uint64_t marks, unsigned place,
                              uint32_t held, bool any) {
    const aset_references *refs = &space->references;
    uint32_t at = references_begin(refs, rank, marks, place);
    f->nonempty++;
    do {
        uint32_t object = bits_get(refs->objects, refs->width, at++);
        if ((held == 0 || !fused_was_held(space, object, held)) && fused_test(f, object, any)) {
            return true;
        }
    } while (!references_ended(refs, at));
    return false;
}

static inline voxel_box fused_window(const aset_space *space, const int32_t voxel[3]) {
    voxel_box window;
    for (int a = 0; a < 3; a++) {
        int32_t reach = (int32_t)space->reach[a] - 1, last = (int32_t)space->slices.n[a] - 1;
        window.low[a] = voxel[a] > reach ? voxel[a] - reach : 0;
        window.high[a] = last - voxel[a] > reach ? voxel[a] + reach : last;
    }
    return window;
}

static inline unsigned fused_map(const aset_cells *cells, uint32_t first) {
    uint32_t shift = first & 63;
    uint64_t bits = cells->map[first >> 6] >> shift;
    if (shift > 64 - FACES) {
        bits |= cells->map[(first >> 6) + 1] << (64 - shift);
    }
    return (unsigned)bits & 63;
}

/* aset_sides_go with everything in it. any is a constant where this is called. */
static inline void fused_walk(fused *f, const aset_space *space, bool any) {
    const aset_cells *cells = &space->cells;
    const aset_slices *slices = &space->slices;
    const probe *ray = f->ray;
    const uint32_t faces[3] = {ray->direction[0] < 0, 2 + (ray->direction[1] < 0), 4 + (ray->direction[2] < 0)};
    const unsigned mask = 1u << faces[0] | 1u << faces[1] | 1u << faces[2];
    voxel_box window = slices_whole(slices);
    uint32_t held = 0;
    brick_walk bricks;
    dda way;
    if (cells->n_cells == 0) {
        return;
    }
    if (aset_dda_inside(&way, slices, ray)) {
        if (fused_large(f, space, way.voxel, &held, any)) {
            return;
        }
        window = fused_window(space, way.voxel);
    }
    if (!aset_dda_enter(&way, slices, ray, &window) || way.t > f->best) {
        return;
    }
    aset_brick_begin(&bricks, cells, slices, ray, &way);
    bool inside = true, known = true;
    uint64_t n_cells = 1;
    while (inside && way.t <= f->best) {
        if ((fused_map(cells, bricks.block) & mask) == 0) {
            inside = brick_step(&bricks, slices, ray, &way);
            known = false;
            continue;
        }
        n_cells += known ? 0 : aset_brick_land(&bricks, slices, ray, &way);
        known = true;
        uint64_t marks[3];
        uint32_t rank[3];
        bool left;
        for (int a = 0; a < 3; a++) {
            rank[a] = cells_rank(cells, bricks.block + faces[a]);
            marks[a] = rank[a] != NO_CELL ? cells->marks[rank[a]] : 0;
        }
        do {
            unsigned place = cells_place(way.voxel);
            if ((marks[way.axis] >> place & 1) != 0 &&
                fused_side(f, space, rank[way.axis], marks[way.axis], place, way.t > 0 ? 0 : held, any)) {
                f->cells += n_cells;
                return;
            }
            inside = dda_step(&way, slices, ray);
            n_cells += inside && way.t <= f->best;
            left = brick_left(&way);
        } while (inside && !left && way.t <= f->best);
        if (inside && left) {
            inside = brick_cross(&bricks, slices, ray, &way, way.axis);
        }
    }
    f->cells += n_cells + (known ? 0 : aset_brick_count_rest(slices, ray, &way, inside, f->best));
}

static inline answer fused_query(const aset_tracer *tracer, const aset_ray *r, bool any, aset_statistics *statistics) {
    probe ray;
    aset_real moved = aset_approach_ready(&ray, tracer->scene, r->origin, r->direction);
    fused f = {tracer->scene, &ray, r->t_max - moved, r->t_max - moved, ASET_NO_OBJECT, 0, 0, 0, 0};
    fused_walk(&f, tracer->space, any);
    statistics->tests += f.tests;
    statistics->test_hits += f.hits;
    statistics->cells_visited += f.cells;
    statistics->nonempty_visited += f.nonempty;
    answer result = {f.best + moved, f.object, f.object != ASET_NO_OBJECT};
    return result;
}

/* --- the four ways to ask --- */

typedef answer (*asker)(const aset_tracer *tracer, const aset_ray *ray, aset_statistics *statistics);

static answer fused_closest(const aset_tracer *tracer, const aset_ray *ray, aset_statistics *statistics) {
    return fused_query(tracer, ray, false, statistics);
}

static answer fused_any(const aset_tracer *tracer, const aset_ray *ray, aset_statistics *statistics) {
    return fused_query(tracer, ray, true, statistics);
}

static answer generic_closest(const aset_tracer *tracer, const aset_ray *ray, aset_statistics *statistics) {
    query_hit hit;
    bool found = aset_query_closest(&hit, tracer, ray->origin, ray->direction, ray->t_max, false, statistics);
    answer result = {hit.t, hit.object, found};
    return result;
}

/* The library's any-hit tells no t and no object. */
static answer generic_any(const aset_tracer *tracer, const aset_ray *ray, aset_statistics *statistics) {
    answer result = {0, 0,
                     aset_query_any(tracer, ray->origin, ray->direction, ray->t_max, false, REAL_INFINITY, statistics)};
    return result;
}

/* --- rays: directions of unit length --- */

typedef struct rays {
    aset_ray *list;
    size_t n, capacity;
} rays;

static void *need(void *block) {
    if (block == NULL) {
        fprintf(stderr, "bench_walk: out of memory\n");
        exit(1);
    }
    return block;
}

static void rays_add(rays *r, aset_vec3 origin, aset_vec3 direction, aset_real t_max) {
    if (r->n == r->capacity) {
        r->capacity = r->capacity > 0 ? 2 * r->capacity : 4096;
        r->list = need(realloc(r->list, r->capacity * sizeof *r->list));
    }
    aset_ray ray = {origin, direction, t_max};
    r->list[r->n++] = ray;
}

/* Towards every light that the surface faces, as shade.c sends them. */
static void add_shadow_rays(rays *shadow, const aset_tracer *tracer, const query_hit *hit, aset_vec3 direction) {
    shading s;
    aset_shading_make(&s, tracer, hit, direction);
    for (uint32_t i = 0; i < tracer->scene->counts.lights; i++) {
        light_ray towards;
        if (aset_light_towards(&towards, tracer->scene, tracer->scene->lights + i, s.hit.point) &&
            vec_dot(s.normal, towards.direction) > 0) {
            rays_add(shadow, aset_shade_start(&s, towards.direction, false, 0), towards.direction, towards.distance);
        }
    }
}

/* One eye ray through each pixel's centre, and its shadow rays. */
static void add_picture(rays *eye, rays *shadow, const aset_tracer *tracer) {
    aset_statistics ignored = {0};
    camera c;
    if (!tracer->scene->has_view || aset_camera_make(&c, &tracer->scene->view, PICTURE, PICTURE) != ASET_OK) {
        return;
    }
    for (int row = 0; row < PICTURE; row++) {
        for (int column = 0; column < PICTURE; column++) {
            aset_vec3 origin, direction;
            query_hit hit;
            aset_camera_ray(&c, R(2) * ((aset_real)column + R(0.5)) / PICTURE - 1,
                            R(2) * ((aset_real)row + R(0.5)) / PICTURE - 1, &origin, &direction);
            rays_add(eye, origin, direction, REAL_INFINITY);
            if (aset_query_closest(&hit, tracer, origin, direction, REAL_INFINITY, false, &ignored)) {
                add_shadow_rays(shadow, tracer, &hit, direction);
            }
        }
    }
}

/* splitmix64 (Steele, Lea and Flood 2014) */
static double random_below_1(uint64_t *state) {
    uint64_t x = *state += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((x ^ (x >> 31)) >> 11) * (1.0 / 9007199254740992.0);
}

/* From a box half as large again as the scene's, in any direction. */
static void add_random(rays *r, const aset_scene *scene) {
    uint64_t state = SEED;
    aset_vec3 low = vec(0, 0, 0), high = low;
    aset_scene_bounds(scene, &low, &high);
    while (r->n < RANDOM_RAYS) {
        aset_real at[3], to[3];
        for (int a = 0; a < 3; a++) {
            aset_real from = vec_at(&low, a), span = vec_at(&high, a) - from;
            at[a] = from + span * (aset_real)(1.5 * random_below_1(&state) - 0.25);
            to[a] = (aset_real)(2 * random_below_1(&state) - 1);
        }
        aset_real length = aset_vec_length(vec(to[0], to[1], to[2]));
        if (length <= 1 && length > R(0.01)) {
            rays_add(r, vec(at[0], at[1], at[2]), aset_vec_unit(vec(to[0], to[1], to[2])), REAL_INFINITY);
        }
    }
}

/* --- scenes --- */

typedef struct stage {
    void *scene_block, *space_block;
    aset_scene scene;
    aset_space space;
    aset_tracer tracer;
    rays eye, shadow, random;
} stage;

static aset_status stage_scene(stage *s, const aset_procedural *source, uint32_t size) {
    aset_counter counter;
    aset_arena arena;
    aset_sink sink = aset_counter_sink(&counter);
    aset_status status = source->emit(&sink, size);
    if (status != ASET_OK) {
        return status;
    }
    const aset_counts *n = &counter.counts;
    size_t bytes = ASET_BYTES_SCENE(n->objects, n->coordinates, n->materials, n->lights);
    s->scene_block = need(malloc(bytes));
    aset_arena_init(&arena, s->scene_block, bytes);
    status = aset_scene_init(&s->scene, &arena, n);
    sink = aset_scene_sink(&s->scene);
    return status == ASET_OK ? source->emit(&sink, size) : status;
}

static aset_status stage_space(stage *s) {
    aset_space_size size;
    aset_space_options options;
    aset_arena arena;
    aset_status status = aset_space_measure(&size, &s->scene, &aset_mset, NULL, NULL);
    if (status != ASET_OK) {
        return status;
    }
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, size.divisions, sizeof options.divisions);
    s->space_block = need(malloc(size.total));
    aset_arena_init(&arena, s->space_block, size.total);
    return aset_space_build(&s->space, &s->scene, &aset_mset, &options, &arena);
}

static aset_status stage_open(stage *s, const aset_procedural *source, uint32_t size) {
    memset(s, 0, sizeof *s);
    aset_status status = stage_scene(s, source, size);
    status = status == ASET_OK ? stage_space(s) : status;
    if (status == ASET_OK) {
        s->tracer.scene = &s->scene;
        s->tracer.space = &s->space;
        add_picture(&s->eye, &s->shadow, &s->tracer);
        add_random(&s->random, &s->scene);
    }
    return status;
}

static void stage_close(stage *s) {
    free(s->scene_block);
    free(s->space_block);
    free(s->eye.list);
    free(s->shadow.list);
    free(s->random.list);
}

/* --- comparing --- */

/* Does the ray hit this object within its bounds? */
static bool really_hits(const aset_tracer *tracer, const aset_ray *r, uint32_t object) {
    probe ray;
    aset_real end = r->t_max - aset_approach_ready(&ray, tracer->scene, r->origin, r->direction);
    return aset_object_nearest(tracer->scene, object, &ray, end) < end;
}

/*
 * Every ray both ways. The library's any-hit tells no t and no object, so there the object that the fused one ended with is
 * asked by itself. tests: of the two, which may differ where an any-hit ends within a cell of several batches.
 */
static size_t count_differences(const aset_tracer *tracer, const rays *r, bool any, uint64_t tests[2]) {
    size_t different = 0;
    tests[0] = tests[1] = 0;
    for (size_t i = 0; i < r->n; i++) {
        aset_statistics a = {0}, b = {0};
        answer g = any ? generic_any(tracer, r->list + i, &a) : generic_closest(tracer, r->list + i, &a);
        answer f = any ? fused_any(tracer, r->list + i, &b) : fused_closest(tracer, r->list + i, &b);
        bool same = g.found == f.found;
        if (any) {
            same = same && (!f.found || really_hits(tracer, r->list + i, f.object));
        } else {
            same = same && a.tests == b.tests && a.cells_visited == b.cells_visited && a.test_hits == b.test_hits &&
                   (!g.found || (g.object == f.object && memcmp(&g.t, &f.t, sizeof g.t) == 0));
        }
        different += !same;
        tests[0] += a.tests;
        tests[1] += b.tests;
    }
    return different;
}

static volatile aset_real kept; /* so that no answer is computed in vain */

/* Seconds of processor time for times passes over n rays. */
static double time_of(asker ask, const aset_tracer *tracer, const aset_ray *list, size_t n, unsigned times) {
    aset_statistics statistics = {0};
    aset_real sum = 0;
    clock_t from = clock();
    for (unsigned k = 0; k < times; k++) {
        for (size_t i = 0; i < n; i++) {
            sum += ask(tracer, list + i, &statistics).found ? R(1) : R(0);
        }
    }
    double spent = (double)(clock() - from) / CLOCKS_PER_SEC;
    kept = sum;
    return spent;
}

static int ascending(const void *a, const void *b) {
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

typedef struct plan {
    unsigned rounds;
    double seconds; /* of a turn */
} plan;

/*
 * Turns of about plan->seconds each, generic and fused on the same rays, the first of the two changing. Each round takes the
 * next stretch of the rays, or all of them several times if they are soon done. ratios: sorted; ns: each side's per ray.
 */
static void time_rounds(const plan *p, const aset_tracer *tracer, const rays *r, bool any, double *ratios, double ns[2]) {
    const asker askers[2] = {any ? generic_any : generic_closest, any ? fused_any : fused_closest};
    double all = time_of(askers[0], tracer, r->list, r->n, 1), sums[2] = {0, 0};
    all = all > 1e-6 ? all : 1e-6;
    size_t n = all > p->seconds ? (size_t)((double)r->n * p->seconds / all) + 1 : r->n, asked = 0;
    unsigned times = all > p->seconds ? 1 : (unsigned)(p->seconds / all) + 1;
    n = n < r->n ? n : r->n;
    for (unsigned round = 0; round < p->rounds; round++) {
        size_t from = r->n > n ? (size_t)round * n % (r->n - n) : 0;
        double spent[2] = {0, 0};
        for (unsigned turn = 0; turn < 2; turn++) {
            unsigned side = (turn + round) & 1;
            spent[side] = time_of(askers[side], tracer, r->list + from, n, times);
            sums[side] += spent[side];
        }
        asked += n * times;
        ratios[round] = spent[0] / (spent[1] > 1e-9 ? spent[1] : 1e-9);
    }
    qsort(ratios, p->rounds, sizeof *ratios, ascending);
    ns[0] = sums[0] / (double)asked * 1e9;
    ns[1] = sums[1] / (double)asked * 1e9;
}

typedef struct outcome {
    double logarithms;
    unsigned rows;
    bool differs;
} outcome;

static void compare(const plan *p, const char *scene, const stage *s, const char *kind, const rays *r, bool any,
                    outcome *all) {
    double ratios[ROUNDS_MAX], ns[2];
    uint64_t tests[2];
    if (r->n == 0) {
        printf("%-12s %-13s no such rays\n", scene, kind);
        return;
    }
    size_t different = count_differences(&s->tracer, r, any, tests);
    if (different > 0) {
        printf("%-12s %-13s %zu of %zu rays answered differently\n", scene, kind, different, r->n);
        all->differs = true;
        return;
    }
    time_rounds(p, &s->tracer, r, any, ratios, ns);
    double median = ratios[p->rounds / 2];
    printf("%-12s %-13s %7zu %8.1f %8.1f %9.0f %9.0f   %.3f  %.3f to %.3f\n", scene, kind, r->n,
           (double)tests[0] / (double)r->n, (double)tests[1] / (double)r->n, ns[0], ns[1], median, ratios[p->rounds / 4],
           ratios[p->rounds - 1 - p->rounds / 4]);
    fflush(stdout);
    all->logarithms += log(median);
    all->rows++;
}

/* name or name:size. False: no such scene. */
static bool bench_scene(const plan *p, const char *text, outcome *all) {
    char name[32];
    const char *colon = strchr(text, ':');
    size_t length = colon != NULL ? (size_t)(colon - text) : strlen(text);
    unsigned long size = colon != NULL ? strtoul(colon + 1, NULL, 10) : 0;
    if (length >= sizeof name || size > UINT32_MAX) {
        return false;
    }
    memcpy(name, text, length);
    name[length] = '\0';
    const aset_procedural *source = aset_procedural_find(name);
    stage s;
    if (source == NULL) {
        return false;
    }
    aset_status status = stage_open(&s, source, (uint32_t)size);
    if (status == ASET_OK) {
        compare(p, text, &s, "eye, closest", &s.eye, false, all);
        compare(p, text, &s, "shadow, any", &s.shadow, true, all);
        compare(p, text, &s, "random, closest", &s.random, false, all);
        compare(p, text, &s, "random, any", &s.random, true, all);
    } else {
        printf("%-12s left out: %s\n", text, aset_status_text(status));
    }
    stage_close(&s);
    return status == ASET_OK || status == ASET_ERR_UNSUPPORTED;
}

int main(int argc, char **argv) {
    static const char *const defaults[] = {"gears:3", "tetra:6", "balls:3", "teapot:6", "snow"};
    plan p = {15, 0.05};
    outcome all = {0, 0, false};
    int i = 1;
    for (; i + 1 < argc && argv[i][0] == '-'; i += 2) {
        unsigned long n = strtoul(argv[i + 1], NULL, 10);
        if (strcmp(argv[i], "-r") == 0 && n > 0 && n <= ROUNDS_MAX) {
            p.rounds = (unsigned)n;
        } else if (strcmp(argv[i], "-t") == 0 && n > 0 && n <= 10000) {
            p.seconds = (double)n / 1000;
        } else {
            break;
        }
    }
    size_t n_scenes = i < argc ? (size_t)(argc - i) : sizeof defaults / sizeof defaults[0];
    printf("%-12s %-15s %5s %17s %19s   %s\n", "scene", "rays", "n", "tests a ray", "ns a ray", "generic / fused");
    printf("%-12s %-13s %7s %8s %8s %9s %9s   %s\n", "", "", "", "generic", "fused", "generic", "fused",
           "median, middle half");
    for (size_t k = 0; k < n_scenes; k++) {
        const char *text = i < argc ? argv[(size_t)i + k] : defaults[k];
        if (!bench_scene(&p, text, &all)) {
            fprintf(stderr, "bench_walk: %s: no such scene or size; usage: bench_walk [-r ROUNDS] [-t MILLISECONDS] "
                            "[NAME[:SIZE] ...]\n", text);
            return 2;
        }
    }
    if (all.rows > 0) {
        printf("geometric mean of %u ratios: %.3f\n", all.rows, exp(all.logarithms / all.rows));
    }
    return all.differs ? 1 : 0;
}
