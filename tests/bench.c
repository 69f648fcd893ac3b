/*
 * bench.c - what each method costs: its build, and rays a second, closest hit and any hit, exact and approximate, by the
 * public headers alone.
 *
 * Four kinds of work: the eye rays of a square picture (closest), the shadow rays of their hits (any), and seeded random
 * rays, both ways. In every round all methods do the same work in turn; ratios are taken within a round. Brute force is
 * asked every k-th ray only. All exact methods must find the same number of hits, or the program ends with 1.
 *
 * --once does each piece of work once and prints only how many rays it was, for bench-instructions.sh: each is one call
 * of bench_pass, whose instructions callgrind tells.
 *
 *      bench [OPTION...] [NAME[:SIZE] ...]
 */
#include "bench_common.h"

#include <inttypes.h>

static const char usage[] =
    "usage: bench [OPTION...] [NAME[:SIZE] ...]\n"
    "  --rounds N   rounds over all methods (7)          --side N     eye rays of a picture of N x N (256)\n"
    "  --random N   random rays (20000)                  --seed N     of the random rays (20240607)\n"
    "  --brute N    about how many rays brute force gets (500)\n"
    "  --grid N     divisions of set, mset and grid (automatic)\n"
    "  --tree N     depth of octree, arts and excell (automatic, at most 6)   --leaf N     objects in a leaf (1)\n"
    "  --memory N   megabytes for each method's space and summary (64)\n"
    "  --csv        comma-separated values               --once       each piece of work once, untimed (for callgrind)\n";

enum { METHODS = 7, CONTENDERS = 2 * METHODS, KINDS = 4, WORKS = KINDS + 1 };

static const aset_method *const methods[METHODS] = {&aset_mset, &aset_set, &aset_grid, &aset_octree,
                                                    &aset_arts, &aset_excell, &aset_brute};

typedef struct plan {
    uint32_t rounds, side, random, brute, grid, tree, leaf, seed, memory;
    bool csv, once;
} plan;

typedef struct contender {
    const aset_method *method;
    bool approximate;
    void *block;
    aset_arena arena;
    aset_space space;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
    aset_tracer tracer;
    size_t bytes; /* of space and summary, built */
} contender;

/* The kinds of rays asked, in the order of the columns. */
static const struct {
    const char *name;
    bool any;
} kinds[KINDS] = {{"eye, closest", false}, {"shadow, any", true}, {"random, closest", false}, {"random, any", true}};

typedef struct stage {
    bench_scene scene;
    contender list[CONTENDERS];
    unsigned n;
    bench_rays eye, shadow, random;
    const bench_rays *rays[KINDS];
} stage;

/* --- one piece of work --- */

typedef struct job {
    contender *c;
    const plan *p;
    const aset_scene *scene;
    const bench_rays *rays; /* NULL: build */
    size_t step;            /* every step-th ray */
    bool any, empty;        /* empty: only the loop */
    size_t asked, found;
    aset_status status;
} job;

static void build(job *j) {
    contender *c = j->c;
    aset_space_options options;
    memset(&options, 0, sizeof options);
    options.divisions[0] = options.divisions[1] = options.divisions[2] = j->p->grid;
    options.depth = j->p->tree;
    options.leaf = j->p->leaf;
    j->status = aset_arena_init(&c->arena, c->block, (size_t)j->p->memory << 20);
    if (j->status == ASET_OK) {
        j->status = aset_space_build(&c->space, j->scene, c->method, &options, &c->arena);
    }
#if ASET_WITH_APPROXIMATION
    if (j->status == ASET_OK && c->approximate) {
        j->status = aset_summary_build(&c->summary, &c->space, 0, &c->arena);
    }
#endif
}

static void ask(job *j) {
    for (size_t i = 0; i < j->rays->n; i += j->step) {
        aset_hit hit;
        bool found = false;
        if (j->empty) {
            found = j->rays->list[i].t_max > 0;
        } else if (j->any) {
            aset_any_hit(&found, &j->c->tracer, j->rays->list + i, j->c->approximate, NULL);
        } else {
            aset_closest_hit(&found, &hit, &j->c->tracer, j->rays->list + i, j->c->approximate, NULL);
        }
        j->asked++;
        j->found += found;
    }
}

void bench_pass(job *j);

void bench_pass(job *j) {
    j->asked = j->found = 0;
    if (j->rays == NULL) {
        build(j);
    } else {
        ask(j);
    }
}

/* Through this the compiler can neither copy the function into its callers nor drop what it does. */
static void (*volatile const pass)(job *j) = bench_pass;

/* --- the stage --- */

static job job_of(const plan *p, stage *s, contender *c, unsigned work) {
    job j = {c, p, &s->scene.scene, NULL, 1, false, false, 0, 0, ASET_OK};
    if (work > 0) {
        j.rays = s->rays[work - 1];
        j.any = kinds[work - 1].any;
    }
    if (j.rays != NULL && c != NULL && c->method == &aset_brute && j.rays->n > p->brute) {
        j.step = j.rays->n / p->brute | 1; /* odd, so that it does not run down one column of the picture */
    }
    return j;
}

static aset_status contender_open(contender *c, const plan *p, stage *s, const aset_method *method, bool approximate) {
    memset(c, 0, sizeof *c);
    c->method = method;
    c->approximate = approximate;
    c->block = bench_need(malloc((size_t)p->memory << 20));
    job j = job_of(p, s, c, 0);
    build(&j);
    if (j.status == ASET_OK) {
        c->bytes = c->arena.used;
        c->tracer.scene = &s->scene.scene;
        c->tracer.space = &c->space;
#if ASET_WITH_APPROXIMATION
        c->tracer.summary = approximate ? &c->summary : NULL;
        c->tracer.curtail = (aset_real)0.5;
#endif
    }
    return j.status;
}

static aset_status stage_open(stage *s, const plan *p) {
    aset_status status = bench_scene_open(&s->scene);
    for (unsigned approximate = 0; approximate <= ASET_WITH_APPROXIMATION; approximate++) {
        for (unsigned m = 0; m < METHODS && status == ASET_OK; m++) {
            if (approximate == 0 || methods[m] != &aset_brute) { /* one cell: an approximate ray has nothing to choose */
                status = contender_open(s->list + s->n++, p, s, methods[m], approximate == 1);
            }
        }
    }
    if (status != ASET_OK) {
        return status;
    }
    if (s->scene.scene.has_view) {
        bench_eye_rays(&s->eye, &s->scene.scene.view, p->side);
        bench_shadow_rays(&s->shadow, &s->eye, &s->list[0].tracer);
    }
    bench_random_rays(&s->random, &s->scene.scene, p->random, p->seed);
    s->rays[0] = &s->eye;
    s->rays[1] = &s->shadow;
    s->rays[2] = s->rays[3] = &s->random;
    return ASET_OK;
}

static void stage_close(stage *s) {
    for (unsigned i = 0; i < s->n; i++) {
        free(s->list[i].block);
    }
    free(s->eye.list);
    free(s->shadow.list);
    free(s->random.list);
    bench_scene_close(&s->scene);
}

/* --- measuring --- */

typedef struct figures {
    double seconds[CONTENDERS][WORKS][BENCH_ROUNDS_MAX]; /* a build; a ray */
    size_t found[CONTENDERS][WORKS];
} figures;

/* Seconds of one build or one ray; short work is done again until it makes a few milliseconds. */
static double time_job(job *j) {
    double from = bench_seconds(), spent;
    unsigned times = 0;
    do {
        pass(j);
        times++;
        spent = bench_seconds() - from;
    } while (spent < 0.005);
    double n = j->rays != NULL ? (double)(j->asked > 0 ? j->asked : 1) : 1;
    return spent / (n * times);
}

static void measure(figures *f, const plan *p, stage *s) {
    for (unsigned work = 0; work < WORKS; work++) {
        for (unsigned round = 0; round < p->rounds; round++) {
            for (unsigned turn = 0; turn < s->n; turn++) {
                unsigned i = round % 2 == 0 ? turn : s->n - 1 - turn; /* forth, then back */
                job j = job_of(p, s, s->list + i, work);
                f->seconds[i][work][round] = time_job(&j);
                f->found[i][work] = j.found;
            }
        }
    }
}

/* Do all exact methods that were asked every ray find as much as the first? */
static bool agree(const figures *f, const stage *s) {
    bool same = true;
    for (unsigned i = 1; i < s->n; i++) {
        for (unsigned work = 1; work < WORKS; work++) {
            if (!s->list[i].approximate && s->list[i].method != &aset_brute && f->found[i][work] != f->found[0][work]) {
                fprintf(stderr, "bench: %s: %s finds %zu hits of %s rays, %s %zu\n", s->scene.text,
                        aset_method_name(s->list[i].method), f->found[i][work], kinds[work - 1].name,
                        aset_method_name(s->list[0].method), f->found[0][work]);
                same = false;
            }
        }
    }
    return same;
}

/* --- printing --- */

static const char *label(const contender *c, char text[32]) {
    snprintf(text, 32, "%s%s", aset_method_name(c->method), c->approximate ? ", approx." : "");
    return text;
}

static void print_table(figures *f, const plan *p, const stage *s) {
    char text[32];
    const uint32_t *n = s->list[0].space.slices.n;
    printf("\n%s: %" PRIu32 " objects; %zu eye rays, %zu shadow rays, %zu random rays; divisions of mset %" PRIu32
           " x %" PRIu32 " x %" PRIu32 "\n",
           s->scene.text, s->scene.scene.counts.objects, s->eye.n, s->shadow.n, s->random.n, n[0], n[1], n[2]);
    printf("%-17s %10s | %-21s", "", "", "build");
    for (unsigned k = 0; k < KINDS; k++) {
        printf(" | %-21s", kinds[k].name);
    }
    printf("\n%-17s %10s | %8s %4s %7s", "method", "bytes", "ms", "+-%", "x mset");
    for (unsigned k = 0; k < KINDS; k++) {
        printf(" | %8s %4s %7s", "Mrays/s", "+-%", "x mset");
    }
    printf("\n");
    for (unsigned i = 0; i < s->n; i++) {
        printf("%-17s %10zu", label(s->list + i, text), s->list[i].bytes);
        for (unsigned work = 0; work < WORKS; work++) {
            double copy[BENCH_ROUNDS_MAX];
            memcpy(copy, f->seconds[i][work], sizeof copy);
            bench_spread t = bench_spread_of(copy, p->rounds);
            bench_spread ratio = bench_ratios(f->seconds[i][work], f->seconds[0][work], p->rounds);
            double percent = 50 * (t.high - t.low) / t.median;
            if (work > 0 && s->rays[work - 1]->n == 0) {
                printf(" | %8s %4s %7s", "", "", "");
            } else {
                printf(" | %8.*f %4.0f %7.2f", work == 0 ? 3 : 4, work == 0 ? 1e3 * t.median : 1e-6 / t.median, percent,
                       ratio.median);
            }
        }
        printf("\n");
    }
    fflush(stdout);
}

static void print_csv(figures *f, const plan *p, const stage *s) {
    for (unsigned i = 0; i < s->n; i++) {
        for (unsigned work = 0; work < WORKS; work++) {
            const contender *c = s->list + i;
            double copy[BENCH_ROUNDS_MAX];
            memcpy(copy, f->seconds[i][work], sizeof copy);
            bench_spread t = bench_spread_of(copy, p->rounds);
            bench_spread ratio = bench_ratios(f->seconds[i][work], f->seconds[0][work], p->rounds);
            if (work == 0 || s->rays[work - 1]->n > 0) {
                printf("%s,%" PRIu32 ",%s,%s,%zu,\"%s\",%.6g,%.6g,%.6g,%.4f,%.4f,%.4f\n", s->scene.text,
                       s->scene.scene.counts.objects, aset_method_name(c->method), c->approximate ? "approximate" : "exact",
                       c->bytes, work == 0 ? "build" : kinds[work - 1].name, t.median, t.low, t.high, ratio.median,
                       ratio.low, ratio.high);
            }
        }
    }
    fflush(stdout);
}

/* Each piece of work once, in the order printed; the first is the bare loop. */
static void once(const plan *p, stage *s) {
    char text[32];
    job bare = job_of(p, s, NULL, 3);
    bare.empty = true;
    pass(&bare);
    printf("%s|loop|random, closest|%zu\n", s->scene.text, bare.asked);
    for (unsigned i = 0; i < s->n; i++) {
        for (unsigned work = 0; work < WORKS; work++) {
            job j = job_of(p, s, s->list + i, work);
            pass(&j);
            printf("%s|%s|%s|%zu\n", s->scene.text, label(s->list + i, text), work == 0 ? "build" : kinds[work - 1].name,
                   work == 0 ? (size_t)1 : j.asked);
        }
    }
    fflush(stdout);
}

/* False: exact methods differ. */
static bool bench(const plan *p, const char *text) {
    static figures f;
    stage s;
    bool fine = true;
    memset(&s, 0, sizeof s);
    memset(&f, 0, sizeof f);
    bench_scene_find(&s.scene, text);
    aset_status status = stage_open(&s, p);
    if (status != ASET_OK) {
        fprintf(stderr, "bench: %s left out: %s\n", text, aset_status_text(status));
        fine = status == ASET_ERR_UNSUPPORTED;
    } else if (p->once) {
        once(p, &s);
    } else {
        measure(&f, p, &s);
        fine = agree(&f, &s);
        (p->csv ? print_csv : print_table)(&f, p, &s);
    }
    stage_close(&s);
    return fine;
}

/* --- the command line --- */

static bool option(plan *p, const char *name, const char *value, bool *took_value) {
    const struct {
        const char *name;
        uint32_t *value, low, high;
    } numbers[] = {{"--rounds", &p->rounds, 1, BENCH_ROUNDS_MAX}, {"--side", &p->side, 1, 4096},
                   {"--random", &p->random, 1, 100000000},        {"--seed", &p->seed, 0, UINT32_MAX},
                   {"--brute", &p->brute, 1, 100000000},          {"--grid", &p->grid, 1, ASET_DIVISIONS_MAX},
                   {"--tree", &p->tree, 1, ASET_DEPTH_TREE_MAX},  {"--leaf", &p->leaf, 1, UINT32_MAX},
                   {"--memory", &p->memory, 1, 2047}};
    *took_value = false;
    if (strcmp(name, "--csv") == 0 || strcmp(name, "--once") == 0) {
        *(name[2] == 'c' ? &p->csv : &p->once) = true;
        return true;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        if (strcmp(name, numbers[i].name) == 0 && value != NULL && value[0] >= '0' && value[0] <= '9') {
            char *end;
            unsigned long n = strtoul(value, &end, 10);
            *numbers[i].value = (uint32_t)n;
            *took_value = true;
            return *end == '\0' && n >= numbers[i].low && n <= numbers[i].high;
        }
    }
    return false;
}

int main(int argc, char **argv) {
    plan p = {7, 256, 20000, 500, 0, 0, 0, 20240607, 64, false, false};
    bool fine = true, took_value;
    int i = 1;
    for (; i < argc && argv[i][0] == '-'; i += 1 + took_value) {
        if (strcmp(argv[i], "--help") == 0) {
            fputs(usage, stdout);
            return 0;
        }
        if (!option(&p, argv[i], argv[i + 1], &took_value)) {
            fprintf(stderr, "bench: %s: no such option, or its number is missing or out of range\n%s", argv[i], usage);
            return 2;
        }
    }
    const char *const *texts = i < argc ? (const char *const *)argv + i : bench_defaults;
    int n = i < argc ? argc - i : BENCH_SCENES;
    for (int k = 0; k < n; k++) {
        bench_scene s;
        if (!bench_scene_find(&s, texts[k])) {
            fprintf(stderr, "bench: %s: no such scene or size; expected NAME[:SIZE], say gears:3\n",
                    texts[k]);
            return 2;
        }
    }
    if (p.csv && !p.once) {
        printf("scene,objects,method,answers,bytes,work,seconds,seconds_low,seconds_high,ratio,ratio_low,ratio_high\n");
    } else if (!p.once) {
        printf("Medians of %" PRIu32 " interleaved rounds, processor time, one thread; +-%%: half the width of the middle "
               "half of the rounds; x mset: time\nover mset's exact one in the same round, median. approx.: every ray takes "
               "the first cell's texture; its build contains the summary.\n",
               p.rounds);
    }
    for (int k = 0; k < n; k++) {
        fine = bench(&p, texts[k]) && fine;
    }
    return fine ? 0 : 1;
}
