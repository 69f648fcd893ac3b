/*
 * plan_probe.c - the probes behind `aset plan`: rays of the picture's own pixels, drawn with each candidate.
 *
 * Two looks. A coarse one ranks the candidates that fit: method (MSET, grid, SET), divisions (geometric steps down from the
 * automatic ones) and what is approximate; brute force, which takes the fewest bytes of all, stands last. A fine one then
 * draws the chosen setting and the unit of time, MSET exact at automatic divisions, by turns, round after round on new
 * pixels, until the time is used up. A setting that does not hold there what the coarse look promised gives way to the next.
 *
 * Drafts, if they are asked for, are made as render makes them (plan_draft.c), from the finest that fits down.
 *
 * The bytes are no estimate: measured. The error of an approximation is told
 * only where enough runs show one: a mirror that no run has met would pass for exact.
 */
#include "metrics.h"
#include "plan_draft.h"
#include "plan_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COARSE_SECONDS 0.012 /* of the unit's drawing, for one sample */
#define LONG_SECONDS 0.1     /* a candidate's coarse sample; if longer, a part of it has to do */
#define FINE_SECONDS 0.05
#define COARSE_RUNS 300u
#define COARSE_END 0.9      /* wall clock since the start; after it no further candidate is probed once something fits */
#define FINE_END 1.3
#define FINE_TURNS 2u       /* drawings of one sample; the least counts, for noise only adds */
#define PIXELS_MAX 200000u  /* drawn by the fine look at most: the picture may be a small one */
#define DOUBT_MAX 0.2       /* relative standard error of the mean squared error: within 3 dB by more than twice that */
#define MARGIN_DB 0.5       /* above the PSNR asked for */
#define STEPS 5
#define STEP 0.6
#define SET_MOST 160u        /* divisions of SET to begin with; its cells grow by their cube, and 100 slices pass for many */
#define QUICK 4              /* times the unit: what nobody would draw by brute force */
#define SLOWER 1.5          /* than a step before: no coarser divisions of this method, where time counts */

typedef struct level {
    uint32_t kinds, depth;
} level;

/* What may be approximate unless it is given: nothing, shadows, all from the second ray on, everything. */
static const level usual_levels[] = {{0, 0}, {ASET_SHADOW, 0}, {ASET_ALL_KINDS, 1}, {ASET_ALL_KINDS, 0}};

/* A space and a summary at one number of divisions, in memory of their own. */
typedef struct built {
    void *block;
    aset_space space;
    aset_summary summary;
    aset_space_size size;
    double space_s, summary_s; /* to build */
    size_t summary_bytes, flat_bytes; /* flat_bytes: of a streamed picture; 0: it is none, or does not fit */
    double flat_s;                    /* to make that in just these bytes */
} built;

typedef struct probing {
    measured *m;
    const plan_wish *wish;
    const char *path;
    double start, unit_rate; /* unit_rate: seconds for an eye ray, exact */
    built unit;
    level given;
    const level *levels;
    size_t n_levels;
    plan_sample sample;
    uint8_t exact[PLAN_SAMPLE_BYTES], drawn[PLAN_SAMPLE_BYTES];
    bool fine[PLAN_SETTINGS_MAX], refused[PLAN_SETTINGS_MAX];
} probing;

/* Approximate settings are asked for: by an error or a time, as nothing exact fits, or by name. */
static bool wants_approximate(const plan *p, const plan_wish *wish) {
    if (wish->has_approx) {
        return wish->approx_kinds != 0;
    }
    return wish->error_db > 0 || wish->time_ms > 0 || p->exact_bytes > wish->memory;
}

static double elapsed(const probing *q) {
    return tool_seconds() - q->start;
}

/* --- spaces --- */

static aset_space_options options_of(const uint32_t grid[3]) {
    aset_space_options options;
    memset(&options, 0, sizeof options);
    memcpy(options.divisions, grid, sizeof options.divisions);
    return options;
}

/* Builds what was measured into b->size; with_summary also what cells remember. */
static bool build(built *b, const probing *q, const aset_method *method, const uint32_t grid[3], bool with_summary) {
    aset_space_options options = options_of(grid);
    aset_arena arena;
    size_t bytes = b->size.total + (1u << 20);
    if (with_summary) {
        bytes += ASET_BYTES_SUMMARY(b->size.n_cells, aset_summary_capacity(&q->m->scene));
    }
    b->block = malloc(bytes);
    double start = plan_cpu_seconds();
    bool done = b->block != NULL && aset_arena_init(&arena, b->block, bytes) == ASET_OK &&
                aset_space_build(&b->space, &q->m->scene, method, &options, &arena) == ASET_OK;
    b->space_s = plan_cpu_seconds() - start;
    size_t before = done ? arena.used : 0;
    done = done && (!with_summary || aset_summary_build(&b->summary, &b->space, 0, &arena) == ASET_OK);
    b->summary_s = plan_cpu_seconds() - start - b->space_s;
    if (!done) {
        tool_error(q->path, 0, "plan: the machine has no memory for %u divisions", (unsigned)grid[0]);
        free(b->block);
        b->block = NULL;
        return false;
    }
    b->summary_bytes = arena.used - before;
    return true;
}

static bool is_streamed(const built *b, const aset_method *method, uint32_t kinds, uint32_t depth) {
    return b->flat_bytes > 0 && tool_streams(method, kinds, depth);
}

static double build_seconds(const built *b, const aset_method *method, uint32_t kinds, uint32_t depth) {
    return is_streamed(b, method, kinds, depth) ? b->flat_s : b->space_s + (kinds != 0 ? b->summary_s : 0);
}

/* What the arena takes in all: a summary may stand where the building scratch was. */
static size_t bytes_of(const probing *q, const aset_space_size *size, size_t summary) {
    size_t kept = size->cells + size->references + size->voxels + summary;
    return q->m->scene_bytes + ASET_BYTES_SCRATCH(q->wish->depth) + (kept > size->total ? kept : size->total);
}

/* Bytes and seconds of the streamed picture, if it may fit. */
static bool measure_flat(built *b, const probing *q, const aset_method *method, const uint32_t grid[3]) {
    aset_space_options options = options_of(grid);
    b->flat_bytes = 0;
    if (q->wish->holds_scene || !tool_streams(method, ASET_ALL_KINDS, 0) ||
        b->size.cells + ASET_BYTES_SCRATCH(q->wish->depth) > q->wish->memory) {
        return true;
    }
    if (!measured_flat(q->m, q->path, method, &options, &b->flat_bytes)) {
        return false;
    }
    double start = plan_cpu_seconds();
    bool done = measured_flat(q->m, q->path, method, &options, &b->flat_bytes);
    b->flat_s = plan_cpu_seconds() - start;
    b->flat_bytes += ASET_BYTES_SCRATCH(q->wish->depth);
    return done;
}

/* The tracer for one level over what was built. */
static aset_tracer tracer_of(const probing *q, const built *b, uint32_t kinds, uint32_t depth) {
    aset_tracer tracer;
    memset(&tracer, 0, sizeof tracer);
    tracer.scene = &q->m->scene;
    tracer.space = &b->space;
    tracer.summary = kinds != 0 ? &b->summary : NULL;
    tracer.approx_kinds = kinds;
    tracer.approx_depth = depth;
    tracer.curtail = (aset_real)q->wish->curtail;
    tracer.curtail_more = q->wish->curtail_more;
    tracer.depth = q->wish->depth;
    tracer.spd_rules = q->wish->spd_rules;
    return tracer;
}

static double draw(const probing *q, const built *b, uint32_t kinds, uint32_t depth, double limit, uint8_t *rgb) {
    aset_tracer tracer = tracer_of(q, b, kinds, depth);
    return plan_sample_draw(&q->sample, &tracer, limit, rgb);
}

/* As many as there are eye rays. */
static double pixels(const probing *q) {
    return (double)q->wish->width * q->wish->height * q->wish->samples * q->wish->samples;
}

/* --- the coarse look --- */

/* Every level at one number of divisions, or the exact one alone; q->exact holds the sample's exact colours. */
static void probe_levels(plan *p, probing *q, const built *b, const aset_method *method, const uint32_t grid[3],
                         size_t n_levels) {
    for (size_t i = 0; i < n_levels && p->n < PLAN_SETTINGS_MAX; i++) {
        plan_setting *s = &p->settings[p->n];
        plan_errors e = {0, 0, 0};
        const level *l = &q->levels[i];
        double seconds = draw(q, b, l->kinds, l->depth, LONG_SECONDS, q->drawn);
        memset(s, 0, sizeof *s);
        s->method = method;
        memcpy(s->grid, grid, sizeof s->grid);
        s->approx_kinds = l->kinds;
        s->approx_depth = l->depth;
        s->textures = l->kinds == 0 ? 0 : b->summary.n_textures;
        s->size = b->size;
        s->bytes = is_streamed(b, method, s->approx_kinds, s->approx_depth)
                       ? b->flat_bytes
                       : bytes_of(q, &b->size, l->kinds == 0 ? 0 : b->summary_bytes);
        s->seconds = build_seconds(b, method, s->approx_kinds, s->approx_depth) + seconds * pixels(q) / plan_sample_pixels(&q->sample);
        s->psnr = METRICS_PSNR_MAX;
        s->fits = s->bytes <= q->wish->memory;
        if (l->kinds != 0) {
            plan_errors_add(&e, &q->sample, q->exact, q->drawn);
            s->psnr = plan_errors_psnr(&e);
            /* not drawn to the end, or not seen to differ: its error is not known, which matters only if there is a choice */
            q->refused[p->n] =
                (seconds > LONG_SECONDS || e.squares <= 0) && p->exact_bytes <= q->wish->memory && !q->wish->has_approx;
        }
        p->n++;
    }
}

/* Does an exact setting fit, or any where none can? */
static bool any_fits(const plan *p, const plan_wish *wish) {
    for (int i = 0; i < p->n; i++) {
        if (p->settings[i].fits && (p->settings[i].approx_kinds == 0 || p->exact_bytes > wish->memory || wish->has_approx)) {
            return true;
        }
    }
    return false;
}

/*
 * Does something exact fit that is no slower than brute force might be? An approximation may miss the error asked for, or be outdone.
 */
static bool any_exact_quick(const plan *p) {
    for (int i = 0; i < p->n; i++) {
        if (p->settings[i].fits && p->settings[i].approx_kinds == 0 && p->settings[i].seconds < QUICK * p->exact_seconds) {
            return true;
        }
    }
    return false;
}

/*
 * A candidate's levels, if any fits. Approximations take no fewer bytes than the exact picture, but where everything is
 * approximate and no object is held.
 */
static bool probe(plan *p, probing *q, const aset_method *method, const uint32_t grid[3]) {
    built b;
    aset_space_options options = options_of(grid);
    bool approximate = wants_approximate(p, q->wish) && method != &aset_brute && q->wish->cells == CELLS_FLAT;
    if (!measured_space(q->m, q->path, method, &options, &b.size, NULL)) {
        return false;
    }
    b.flat_bytes = 0;
    if (approximate && !measure_flat(&b, q, method, grid)) {
        return false;
    }
    bool fits_flat = b.flat_bytes > 0 && b.flat_bytes <= q->wish->memory;
    p->least_bytes = b.flat_bytes > 0 && b.flat_bytes < p->least_bytes ? b.flat_bytes : p->least_bytes;
    if (bytes_of(q, &b.size, 0) > q->wish->memory && !fits_flat) {
        return true;
    }
    if (!build(&b, q, method, grid, approximate)) {
        return false;
    }
    probe_levels(p, q, &b, method, grid, approximate ? q->n_levels : 1);
    free(b.block);
    return true;
}

/*
 * Divisions to try: a step down from the automatic ones. SET takes the largest of them on every axis: its slices stand where
 * the objects end, and a thin axis may hold many.
 */
static bool step_down(const measured *m, int step, const aset_method *method, uint32_t grid[3]) {
    uint32_t largest = 1;
    double scale = pow(STEP, step);
    aset_auto_divisions(&m->scene, 0, grid);
    for (int a = 0; a < 3; a++) {
        largest = grid[a] > largest ? grid[a] : largest;
    }
    if (method == &aset_set) {
        grid[0] = grid[1] = grid[2] = largest = largest < SET_MOST ? largest : SET_MOST;
    }
    for (int a = 0; a < 3; a++) {
        grid[a] = grid[a] * scale < 1 ? 1 : (uint32_t)(grid[a] * scale + 0.5);
    }
    return largest * scale >= 1.5 || step == 0;
}

/* --- drafts --- */

/* Unless it is given which rays are approximate. */
static const level all_rays = {ASET_ALL_KINDS, 0};

/*
 * A draft at the setting's divisions, or automatic ones, which are put there. False after an error line; if it does not fit, it is not
 * among the plan's settings.
 */
static bool probe_draft(plan *p, probing *q, plan_setting *s) {
    prepared made;
    plan_errors e = {0, 0, 0};
    bool told = false, done = true;
    s->bytes = (size_t)q->wish->memory;
    aset_status status = plan_draft_make(&made, q->m, q->wish, s, &told);
    if (status == ASET_OK) {
        double seconds = plan_draft_seconds(&made, q->wish);
        done = seconds >= 0;
        (void)plan_sample_draw(&q->sample, &made.tracer, INFINITY, q->drawn);
        plan_errors_add(&e, &q->sample, q->exact, q->drawn);
        memcpy(s->grid, made.draft.n, sizeof s->grid);
        s->seconds = made.build_s + seconds * q->wish->samples * q->wish->samples;
        s->psnr = plan_errors_psnr(&e);
        s->fits = true;
        q->refused[p->n] = e.squares <= 0 && p->exact_bytes <= q->wish->memory && !q->wish->has_approx;
        p->settings[p->n++] = *s;
    }
    prepare_free(&made);
    return done && !told;
}

/* As fine as fits, and steps down from there. */
static bool probe_drafts(plan *p, probing *q) {
    const plan_wish *wish = q->wish;
    const level *l = q->levels == &q->given ? &q->given : &all_rays;
    plan_setting s;
    memset(&s, 0, sizeof s);
    s.method = wish->method != NULL ? wish->method : &aset_mset;
    s.approx_kinds = l->kinds;
    s.approx_depth = l->depth;
    s.cells = wish->cells;
    memcpy(s.grid, wish->grid, sizeof s.grid);
    int first = p->n;
    bool done = probe_draft(p, q, &s);
    for (uint32_t most = 2; done && p->n > first && wish->grid[0] == 0 && most > 1 && p->n < PLAN_SETTINGS_MAX && elapsed(q) < COARSE_END;) {
        most = 1;
        for (int a = 0; a < 3; a++) {
            s.grid[a] = (uint32_t)fmax(1, s.grid[a] * STEP + 0.5);
            most = s.grid[a] > most ? s.grid[a] : most;
        }
        done = probe_draft(p, q, &s);
    }
    return done;
}

/* The unit of time, kept for the fine look, and the coarse sample with its exact colours, as large as the time allows. */
static bool probe_unit(plan *p, probing *q) {
    uint32_t grid[3];
    (void)step_down(q->m, 0, &aset_mset, grid);
    aset_space_options options = options_of(grid);
    if (!measured_space(q->m, q->path, &aset_mset, &options, &q->unit.size, NULL) ||
        !build(&q->unit, q, &aset_mset, grid, false)) {
        return false;
    }
    plan_sample_make(&q->sample, 64, 1);
    q->unit_rate = draw(q, &q->unit, 0, 0, INFINITY, q->exact) / plan_sample_pixels(&q->sample);
    uint32_t n = plan_sample_runs(COARSE_SECONDS, q->unit_rate, 64);
    plan_sample_make(&q->sample, n < COARSE_RUNS ? n : COARSE_RUNS, 2);
    q->unit_rate = draw(q, &q->unit, 0, 0, INFINITY, q->exact) / plan_sample_pixels(&q->sample);
    p->exact_seconds = q->unit.space_s + q->unit_rate * pixels(q);
    return true;
}

static const aset_method *const methods[] = {&aset_mset, &aset_grid, &aset_set};
#define N_METHODS (sizeof methods / sizeof methods[0])

/* One step of one method. *last: seconds of its step before, exact, 0 where none fitted; below 0: it only gets slower. */
static bool probe_step(plan *p, probing *q, const aset_method *method, const uint32_t grid[3], double *last) {
    int first = p->n;
    bool time_counts = p->exact_bytes <= q->wish->memory || q->wish->time_ms > 0;
    if (any_fits(p, q->wish) && ((*last < 0 && time_counts) || elapsed(q) > COARSE_END)) {
        return true;
    }
    if (!probe(p, q, method, grid)) {
        return false;
    }
    if (p->n > first) {
        double seconds = p->settings[first].seconds;
        *last = *last > 0 && seconds > SLOWER * *last ? -1 : seconds;
    }
    return true;
}

/* Divisions to try at a step, unless they are given. */
static bool choose_divisions(const probing *q, int step, const aset_method *method, uint32_t grid[3]) {
    if (q->wish->method != NULL && q->wish->method != method) {
        return false;
    }
    if (q->wish->grid[0] == 0) {
        return step_down(q->m, step, method, grid);
    }
    memcpy(grid, q->wish->grid, sizeof q->wish->grid);
    return step == 0;
}

/* May brute force be an answer, and does nothing else do? */
static bool wants_brute(const plan *p, const probing *q) {
    const plan_wish *wish = q->wish;
    bool may_be_exact = !wish->has_approx || wish->approx_kinds == 0;
    bool may = may_be_exact && wish->grid[0] == 0 && (wish->method == NULL || wish->method == &aset_brute);
    return may && !any_exact_quick(p) && p->exact_bytes <= wish->memory;
}

static bool probe_all(plan *p, probing *q) {
    if (q->wish->cells != CELLS_FLAT && wants_approximate(p, q->wish) && !probe_drafts(p, q)) {
        return false;
    }
    if (q->wish->cells != CELLS_FLAT && q->levels == &q->given) {
        return true; /* the rays that the words make approximate are drafts', and were tried */
    }
    const uint32_t one[3] = {1, 1, 1};
    double last[N_METHODS] = {0};
    uint32_t grid[3];
    bool more = true;
    bool all_steps = p->exact_bytes > q->wish->memory; /* of what is approximate coarser may be closer */
    for (int i = 0; more && (i < STEPS || all_steps || !any_fits(p, q->wish)); i++) {
        more = false;
        for (size_t k = 0; k < N_METHODS; k++) {
            if (choose_divisions(q, i, methods[k], grid)) {
                more = true;
                if (!probe_step(p, q, methods[k], grid, &last[k])) {
                    return false;
                }
            }
        }
    }
    return !wants_brute(p, q) || probe(p, q, &aset_brute, one);
}

/* --- the choice --- */

/* Close enough, also if the sample's PSNR is a little too high? */
static bool accurate(const plan_setting *s, const plan_wish *wish) {
    return s->approx_kinds == 0 || s->psnr >= wish->error_db + MARGIN_DB;
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
        bool good_a = accurate(a, wish), good_b = accurate(b, wish);
        if (good_a != good_b) {
            return good_a;
        }
        if (good_a) {
            return a->seconds < b->seconds;
        }
    }
    return a->psnr != b->psnr ? a->psnr > b->psnr : a->seconds < b->seconds;
}

/* The best that fits; of those alone that the fine look has seen, if so asked. -1: none. */
static int choose(const plan *p, const probing *q, bool fine_only) {
    int best = -1;
    for (int i = 0; i < p->n; i++) {
        if (p->settings[i].fits && !q->refused[i] && (!fine_only || q->fine[i]) &&
            (best < 0 || better(&p->settings[i], &p->settings[best], q->wish))) {
            best = i;
        }
    }
    return best;
}

/* --- the fine look --- */

typedef struct pair {
    double unit, other;
} pair;

static double least(double a, double b) {
    return a < b ? a : b;
}

/* One sample, by turns with the unit and the other; what each takes a pixel of it. */
static pair draw_pair(probing *q, const built *b, const plan_setting *s) {
    pair t = {INFINITY, INFINITY};
    for (unsigned i = 0; i < FINE_TURNS; i++) {
        t.unit = least(t.unit, draw(q, &q->unit, 0, 0, INFINITY, q->exact));
        t.other = least(t.other, draw(q, b, s->approx_kinds, s->approx_depth, INFINITY, q->drawn));
    }
    return t;
}

/* Builds the setting again, and the unit; the least of all times counts. */
static bool build_pair(probing *q, built *b, const plan_setting *s) {
    built again = q->unit;
    b->size = s->size;
    b->flat_bytes = 0;
    if (tool_streams(s->method, s->approx_kinds, s->approx_depth) && !measure_flat(b, q, s->method, s->grid)) {
        return false;
    }
    if (!build(b, q, s->method, s->grid, s->approx_kinds != 0)) {
        return false;
    }
    uint32_t grid[3];
    (void)step_down(q->m, 0, &aset_mset, grid);
    if (!build(&again, q, &aset_mset, grid, false)) {
        free(b->block);
        return false;
    }
    q->unit.space_s = least(q->unit.space_s, again.space_s);
    free(again.block);
    again.size = s->size;
    if (!build(&again, q, s->method, s->grid, s->approx_kinds != 0)) {
        free(b->block);
        return false;
    }
    b->space_s = least(b->space_s, again.space_s);
    b->summary_s = least(b->summary_s, again.summary_s);
    free(again.block);
    return true;
}

/* Puts what the fine look saw into the setting; the first look of all also says what the unit takes. */
static void settle(plan *p, probing *q, int chosen, const built *b, const pair *rate, bool first) {
    plan_setting *s = &p->settings[chosen];
    double unit_s = q->unit.space_s + rate->unit * pixels(q);
    double other_s = build_seconds(b, s->method, s->approx_kinds, s->approx_depth) + rate->other * pixels(q);
    if (first) {
        for (int i = 0; i < p->n; i++) {
            p->settings[i].seconds *= unit_s / p->exact_seconds;
        }
        p->exact_seconds = unit_s;
    }
    s->seconds = p->exact_seconds * other_s / unit_s;
    q->fine[chosen] = true;
}

/* Round after round, as long as another one will end before the wall clock's end; one at least. */
static bool refine(plan *p, probing *q, int chosen, double end, bool first) {
    plan_setting *s = &p->settings[chosen];
    pair sum = {0, 0}, rate;
    plan_errors e = {0, 0, 0};
    double drawn = 0, limit = least(PIXELS_MAX, 2 * pixels(q)), now = 0, before;
    built b;
    if (!build_pair(q, &b, s)) {
        return false;
    }
    uint32_t seed = 3, n = plan_sample_runs(FINE_SECONDS, fmax(q->unit_rate, s->seconds / pixels(q)), 16);
    do {
        before = elapsed(q);
        plan_sample_make(&q->sample, n, seed++);
        pair t = draw_pair(q, &b, s);
        sum.unit += t.unit;
        sum.other += t.other;
        drawn += plan_sample_pixels(&q->sample);
        plan_errors_add(&e, &q->sample, q->exact, q->drawn);
        now = elapsed(q);
    } while (2 * now - before < end && drawn < limit);
    rate.unit = sum.unit / drawn;
    rate.other = sum.other / drawn;
    settle(p, q, chosen, &b, &rate, first);
    if (s->approx_kinds != 0) {
        s->psnr = plan_errors_psnr(&e);
        q->refused[chosen] = !(plan_errors_doubt(&e) <= DOUBT_MAX) && plan_sample_pixels(&q->sample) < pixels(q) && !q->wish->has_approx;
    }
    free(b.block);
    return true;
}

/*
 * Its error may be twice its doubt larger and still keep to what is asked for. Few pixels of a draft err much, so that it is told late how
 * much they do.
 */
static bool is_surely_close(const plan_setting *s, const plan_errors *e, const plan_wish *wish) {
    return wish->error_db > 0 && s->psnr - 10 * log10(1 + 2 * plan_errors_doubt(e)) >= wish->error_db;
}

/* A draft again, of the divisions that were found, on new pixels beside the exact picture. Its time stays. */
static bool refine_draft(plan *p, probing *q, int chosen, double end) {
    plan_setting *s = &p->settings[chosen];
    prepared made;
    plan_errors e = {0, 0, 0};
    double drawn = 0, limit = least(PIXELS_MAX, 2 * pixels(q)), now = 0, before;
    bool told;
    q->fine[chosen] = true;
    s->fits = plan_draft_make(&made, q->m, q->wish, s, &told) == ASET_OK;
    if (!s->fits) {
        prepare_free(&made);
        return !told;
    }
    uint32_t seed = 3, n = plan_sample_runs(FINE_SECONDS, fmax(q->unit_rate, s->seconds / pixels(q)), 16);
    do {
        before = elapsed(q);
        plan_sample_make(&q->sample, n, seed++);
        (void)draw(q, &q->unit, 0, 0, INFINITY, q->exact);
        (void)plan_sample_draw(&q->sample, &made.tracer, INFINITY, q->drawn);
        drawn += plan_sample_pixels(&q->sample);
        plan_errors_add(&e, &q->sample, q->exact, q->drawn);
        now = elapsed(q);
    } while (2 * now - before < end && drawn < limit);
    s->psnr = plan_errors_psnr(&e);
    q->refused[chosen] = !(plan_errors_doubt(&e) <= DOUBT_MAX) && drawn < pixels(q) && !q->wish->has_approx && !is_surely_close(s, &e, q->wish);
    prepare_free(&made);
    return true;
}

/* Looks at the best until the best has been looked at, or the time is up and one keeps to the error asked for. */
static bool refine_best(plan *p, probing *q) {
    bool first = true;
    int best = choose(p, q, false);
    while (best >= 0 && !q->fine[best]) {
        double now = elapsed(q);
        double end = now + (FINE_END - now) / 2;
        bool is_draft = p->settings[best].cells != CELLS_FLAT;
        if (!(is_draft ? refine_draft(p, q, best, end) : refine(p, q, best, end, first))) {
            return false;
        }
        first = first && is_draft;
        bool late = elapsed(q) > FINE_END;
        best = choose(p, q, true);
        if (late && best >= 0 && (q->wish->error_db <= 0 || accurate(&p->settings[best], q->wish))) {
            break;
        }
        for (int i = 0; late && i < p->n; i++) { /* no time for surprises: an exact setting is next */
            q->refused[i] = q->refused[i] || (!q->fine[i] && p->settings[i].approx_kinds != 0);
        }
        best = choose(p, q, false);
    }
    p->chosen = choose(p, q, true);
    if (p->chosen >= 0 && p->settings[p->chosen].cells != CELLS_FLAT) {
        plan_setting *s = &p->settings[p->chosen];
        s->bytes = plan_draft_need(q->m, q->wish, s);
    }
    return true;
}

bool plan_make(plan *p, measured *m, const char *path, const plan_wish *wish) {
    probing *q = calloc(1, sizeof *q);
    aset_waiting *stack = malloc(ASET_BYTES_SCRATCH(wish->depth));
    bool done = q != NULL && stack != NULL;
    memset(p, 0, sizeof *p);
    p->chosen = -1;
    p->exact_bytes = p->least_bytes = m->scene_bytes + ASET_BYTES_SCRATCH(wish->depth); /* brute force has nothing more */
    if (!done) {
        tool_error(path, 0, "plan: the machine has no memory for a probe");
    }
    if (done && (p->exact_bytes <= wish->memory || !wish->holds_scene)) { /* else there is nothing to probe */
        q->m = m;
        q->wish = wish;
        q->path = path;
        q->given.kinds = wish->approx_kinds;
        q->given.depth = wish->approx_depth;
        q->levels = wish->has_approx && wish->approx_kinds != 0 ? &q->given : usual_levels;
        q->n_levels = q->levels == &q->given ? 1 : sizeof usual_levels / sizeof usual_levels[0];
        q->start = tool_seconds();
        q->sample.scratch.stack = stack;
        q->sample.scratch.capacity = wish->depth;
        plan_sample_aim(&q->sample, &m->scene.view, wish->width, wish->height);
        done = probe_unit(p, q) && probe_all(p, q) && refine_best(p, q);
        free(q->unit.block);
    }
    free(stack);
    free(q);
    return done;
}
