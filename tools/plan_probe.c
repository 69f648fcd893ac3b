/*
 * plan_probe.c - the probes behind `aset plan`: a coarse sample of the picture's own pixels, drawn with each candidate.
 *
 * A probe draws PROBE x PROBE pixels through the same view: the colours along a sparse set of the whole picture's rays, so that
 * the mean squared error and the time for a ray are samples of the picture's own. The candidates differ in method (MSET, SET), in
 * divisions (geometric steps down from the automatic ones) and in what is approximate. The bytes are no estimate: measured.
 * Probing stops when its time is used up and something fits; what was not probed is not chosen.
 */
#include "metrics.h"
#include "plan.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PROBE 64u
#define ROUNDS 3         /* interleaved; the least counts, for noise only adds */
#define PROBE_SECONDS 1.2 /* after which no further candidate is probed */
#define STEPS 5
#define R_CURTAIL ((aset_real)0.5)

/* What is measured is the processor's time: a busy machine makes everything wait, but computes no more. */
static double cpu_seconds(void) {
    return (double)clock() / CLOCKS_PER_SEC;
}

typedef struct level {
    uint32_t kinds, depth;
} level;

/* What may be approximate: nothing, shadows, all from the second ray on, everything. */
static const level levels[] = {{0, 0}, {ASET_SHADOW, 0}, {ASET_ALL_KINDS, 1}, {ASET_ALL_KINDS, 0}};
#define N_LEVELS (sizeof levels / sizeof levels[0])

/* A space and a summary at one number of divisions, in memory of their own. */
typedef struct built {
    void *block;
    aset_space space;
    aset_summary summary;
    double build_s;
    size_t summary_bytes;
} built;

static aset_space_options options_of(const uint32_t grid[3]) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, grid, sizeof options.divisions);
    return options;
}

static bool build(built *b, measured *m, const char *path, const aset_method *method, const uint32_t grid[3],
                  aset_space_size *size) {
    aset_space_options options = options_of(grid);
    aset_arena arena;
    if (!measured_space(m, path, method, &options, size, NULL)) {
        return false;
    }
    size_t bytes = size->total + ASET_BYTES_SUMMARY(size->n_cells, aset_summary_capacity(&m->scene)) + (1u << 20);
    b->block = malloc(bytes);
    double start = cpu_seconds();
    bool done = b->block != NULL && aset_arena_init(&arena, b->block, bytes) == ASET_OK &&
                aset_space_build(&b->space, &m->scene, method, &options, &arena) == ASET_OK;
    size_t before = done ? arena.used : 0;
    done = done && aset_summary_build(&b->summary, &b->space, 0, &arena) == ASET_OK;
    b->build_s = cpu_seconds() - start;
    if (!done) {
        tool_error(path, 0, "plan: the machine has no memory for %u divisions", (unsigned)grid[0]);
        free(b->block);
        return false;
    }
    b->summary_bytes = arena.used - before;
    return true;
}

/* Draws the probe. Seconds. */
static double draw(const measured *m, const aset_view *view, const built *b, const level *l, uint32_t depth,
                   aset_scratch *scratch, uint8_t *rgb) {
    aset_tracer tracer;
    aset_picture picture;
    memset(&tracer, 0, sizeof tracer);
    memset(&picture, 0, sizeof picture);
    tracer.scene = &m->scene;
    tracer.space = &b->space;
    tracer.summary = l->kinds != 0 ? &b->summary : NULL;
    tracer.approx_kinds = l->kinds;
    tracer.approx_depth = l->depth;
    tracer.curtail = R_CURTAIL;
    tracer.depth = depth;
    picture.width = view->width_px;
    picture.height = view->height_px;
    picture.format = ASET_RGB888;
    picture.pixels = rgb;
    picture.stride = (size_t)view->width_px * 3;
    double start = cpu_seconds();
    (void)aset_render_rows(&tracer, view, &picture, 0, view->height_px, scratch, NULL);
    return cpu_seconds() - start;
}

/* What the arena takes in all: a summary may stand where the building scratch was. */
static size_t bytes_of(const measured *m, const plan_setting *s, size_t summary, uint32_t depth) {
    size_t kept = s->size.cells + s->size.references + s->size.voxels + summary;
    return m->scene_bytes + ASET_BYTES_SCRATCH(depth) + (kept > s->size.total ? kept : s->size.total);
}

typedef struct probing {
    const measured *m;
    const plan_wish *wish;
    aset_view view;
    aset_scratch scratch;
    uint8_t exact[PROBE * PROBE * 3], drawn[PROBE * PROBE * 3];
} probing;

/* Every level at one number of divisions; the exact one comes first and is the reference of the others. */
static void probe_levels(plan *p, probing *q, const built *b, const aset_method *method, const uint32_t grid[3],
                         const aset_space_size *size) {
    double least[N_LEVELS], start = tool_seconds();
    uint32_t pixels = q->view.width_px * q->view.height_px;
    double scale = (double)q->wish->width * q->wish->height / pixels;
    for (int round = 0; round < ROUNDS && (round == 0 || tool_seconds() - start < PROBE_SECONDS / 8); round++) {
        for (size_t i = 0; i < N_LEVELS; i++) {
            double seconds = draw(q->m, &q->view, b, &levels[i], q->wish->depth, &q->scratch, i == 0 ? q->exact : q->drawn);
            least[i] = round == 0 || seconds < least[i] ? seconds : least[i];
            if (round == 0) {
                plan_setting *s = &p->settings[p->n + (int)i];
                metrics_difference d = metrics_differ(q->exact, q->drawn, q->view.width_px, q->view.height_px);
                s->psnr = i == 0 ? METRICS_PSNR_MAX : metrics_psnr(&d);
            }
        }
    }
    for (size_t i = 0; i < N_LEVELS; i++) {
        plan_setting *s = &p->settings[p->n++];
        s->method = method;
        memcpy(s->grid, grid, sizeof s->grid);
        s->approx_kinds = levels[i].kinds;
        s->approx_depth = levels[i].depth;
        s->textures = i == 0 ? 0 : b->summary.n_textures;
        s->size = *size;
        s->bytes = bytes_of(q->m, s, i == 0 ? 0 : b->summary_bytes, q->wish->depth);
        s->seconds = b->build_s + least[i] * scale;
        s->fits = s->bytes <= q->wish->memory;
    }
}

/* Is a better than b, given what is asked for? Both fit. */
static bool better(const plan_setting *a, const plan_setting *b, const plan_wish *wish) {
    if (wish->time_ms > 0) {
        bool fast_a = a->seconds * 1000 <= wish->time_ms, fast_b = b->seconds * 1000 <= wish->time_ms;
        if (fast_a != fast_b || !fast_a) {
            return fast_a != fast_b ? fast_a : a->seconds < b->seconds;
        }
    }
    if (wish->error_db > 0) {
        bool good_a = a->psnr >= wish->error_db, good_b = b->psnr >= wish->error_db;
        if (good_a != good_b) {
            return good_a;
        }
        if (good_a) {
            return a->seconds < b->seconds;
        }
    }
    return a->psnr != b->psnr ? a->psnr > b->psnr : a->seconds < b->seconds;
}

/*
 * Divisions to try: a step down from the automatic ones. SET takes the largest of them on every axis: its slices stand where the
 * objects end, and a thin axis may hold many.
 */
static bool step_down(const measured *m, int step, const aset_method *method, uint32_t grid[3]) {
    double scale = 1;
    uint32_t largest = 1;
    for (int i = 0; i < step; i++) {
        scale *= 0.6;
    }
    aset_auto_divisions(&m->scene, 0, grid);
    for (int a = 0; a < 3; a++) {
        grid[a] = grid[a] * scale < 1 ? 1 : (uint32_t)(grid[a] * scale + 0.5);
        largest = grid[a] > largest ? grid[a] : largest;
    }
    if (method == &aset_set) {
        grid[0] = grid[1] = grid[2] = largest;
    }
    return largest > 1 || step == 0;
}

/* The smallest need of all: exact, a single voxel. */
static bool measure_least(plan *p, measured *m, const char *path, const plan_wish *wish) {
    plan_setting least;
    const uint32_t one[3] = {1, 1, 1};
    aset_space_options options = options_of(one);
    memset(&least, 0, sizeof least);
    if (!measured_space(m, path, &aset_mset, &options, &least.size, NULL)) {
        return false;
    }
    p->least_bytes = bytes_of(m, &least, 0, wish->depth);
    return true;
}

static bool any_fits(const plan *p) {
    for (int i = 0; i < p->n; i++) {
        if (p->settings[i].fits) {
            return true;
        }
    }
    return false;
}

/* One candidate's space, at every level. */
static bool probe(plan *p, probing *q, measured *m, const char *path, const aset_method *method,
                  const uint32_t grid[3]) {
    built b;
    aset_space_size size;
    if (!build(&b, m, path, method, grid, &size)) {
        return false;
    }
    probe_levels(p, q, &b, method, grid, &size);
    free(b.block);
    return true;
}

static bool probe_all(plan *p, probing *q, measured *m, const char *path) {
    static const aset_method *const methods[] = {&aset_mset, &aset_set};
    const uint32_t one[3] = {1, 1, 1};
    uint32_t grid[3];
    double start = tool_seconds();
    for (int i = 0; i < STEPS; i++) {
        for (size_t k = 0; k < sizeof methods / sizeof methods[0]; k++) {
            bool late = tool_seconds() - start > PROBE_SECONDS && any_fits(p);
            if (!late && step_down(m, i, methods[k], grid) && !probe(p, q, m, path, methods[k], grid)) {
                return false;
            }
        }
    }
    return any_fits(p) || probe(p, q, m, path, &aset_mset, one);
}

bool plan_make(plan *p, measured *m, const char *path, const plan_wish *wish) {
    probing *q = malloc(sizeof *q);
    aset_waiting *stack = malloc(ASET_BYTES_SCRATCH(wish->depth));
    bool done = q != NULL && stack != NULL;
    memset(p, 0, sizeof *p);
    p->chosen = -1;
    if (!done) {
        tool_error(path, 0, "plan: the machine has no memory for a probe");
    }
    done = done && measure_least(p, m, path, wish);
    if (done && p->least_bytes <= wish->memory) { /* else nothing fits, and there is nothing to probe */
        q->m = m;
        q->wish = wish;
        q->view = m->scene.view;
        q->view.width_px = wish->width >= wish->height ? PROBE : (PROBE * wish->width + wish->height - 1) / wish->height;
        q->view.height_px = wish->height >= wish->width ? PROBE : (PROBE * wish->height + wish->width - 1) / wish->width;
        q->scratch.stack = stack;
        q->scratch.capacity = wish->depth;
        done = probe_all(p, q, m, path);
    }
    free(stack);
    free(q);
    p->exact_seconds = p->n > 0 ? p->settings[0].seconds : 0;
    for (int i = 0; done && i < p->n; i++) {
        if (p->settings[i].fits && (p->chosen < 0 || better(&p->settings[i], &p->settings[p->chosen], wish))) {
            p->chosen = i;
        }
    }
    return done;
}
