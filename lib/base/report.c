/*
 * report.c - formatting of statistics and memory; it counts nothing itself. Its own writing of numbers, since the core has
 * no stdio.
 */
#include "aset/report.h"

#include "base/whole.h"

#include <float.h>
#include <string.h>

/* A text that grows in the caller's buffer and goes on counting when that is full. */
typedef struct text {
    char *at;
    size_t size, n;
} text;

static void put_char(text *t, char c) {
    if (t->n + 1 < t->size) {
        t->at[t->n] = c;
    }
    t->n++;
}

static void put(text *t, const char *s) {
    for (; *s != 0; s++) {
        put_char(t, *s);
    }
}

/* With so many digits at least. */
static void put_number(text *t, uint64_t x, unsigned least) {
    char digits[21];
    unsigned i = 20;
    digits[i] = 0;
    do {
        uint64_t digit;
        x = aset_whole_divide(x, 10, &digit);
        digits[--i] = (char)('0' + digit);
    } while (x > 0 || i > 20 - least);
    put(t, digits + i);
}

/* A number of so many decimals, at most 6, given in units of the last one. */
static void put_decimal(text *t, uint64_t units, unsigned decimals) {
    uint32_t scale = 1;
    for (unsigned i = 0; i < decimals; i++) {
        scale *= 10;
    }
    uint64_t fraction;
    put_number(t, aset_whole_divide(units, scale, &fraction), 1);
    put_char(t, '.');
    put_number(t, fraction, decimals);
}

/*
 * The pattern with its numbers in their places: # is the next one, @3 the next one with three decimals, as put_decimal takes
 * it. ' stands for ", for the sake of JSON.
 */
static void fill(text *t, const char *pattern, const uint64_t *numbers) {
    for (; *pattern != 0; pattern++) {
        if (*pattern == '#') {
            put_number(t, *numbers++, 1);
        } else if (*pattern == '@') {
            put_decimal(t, *numbers++, (unsigned)(*++pattern - '0'));
        } else {
            put_char(t, *pattern == '\'' ? '"' : *pattern);
        }
    }
}

static size_t text_end(text *t) {
    if (t->size > 0) {
        t->at[t->n < t->size ? t->n : t->size - 1] = 0;
    }
    return t->n;
}

/* a / b in units of 10^-decimals, to the nearest; 0 for b = 0. */
static uint64_t ratio(uint64_t a, uint64_t b, unsigned decimals) {
    if (b == 0) {
        return 0;
    }
    for (; b > UINT64_MAX / 10; b /= 2) {
        a /= 2;
    }
    uint64_t rest, units = aset_whole_divide(a, b, &rest);
    for (; decimals > 0; decimals--) {
        units = units * 10 + aset_whole_divide(rest * 10, b, &rest);
    }
    return units + (rest >= b - rest);
}

/*
 * A time in units of 10^-decimals s; 0 for what is not finite, below 0 or over 10^12. From the number's bits, since nothing else
 * in the core computes in double: where the processor does not either, that would be 3 kB.
 */
static uint64_t time_units(double seconds, unsigned decimals) {
    const double most = 1e12;
#if DBL_MANT_DIG == 53
    uint64_t bits, most_bits; /* numbers that are not negative are in the order of their bits; the others lie above */
    memcpy(&bits, &seconds, sizeof bits);
    memcpy(&most_bits, &most, sizeof most_bits);
    if (bits > most_bits) {
        return 0;
    }
    uint64_t mantissa = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1) << 52;
    unsigned shift = 1075 - (unsigned)(bits >> 52); /* mantissa / 2^shift */
    if (shift > 60) {
        mantissa = shift < 124 ? mantissa >> (shift - 60) : 0;
        shift = 60;
    }
    return ratio(mantissa, UINT64_C(1) << shift, decimals);
#else
    double units = seconds;
    for (; decimals > 0; decimals--) {
        units *= 10;
    }
    return seconds > 0 && seconds <= most ? (uint64_t)(units + 0.5) : 0;
#endif
}

static void put_kinds(text *t, uint32_t kinds, const char *quote, const char *none) {
    static const char *const names[] = {"primary", "shadow", "reflected", "refracted"};
    bool first = true;
    for (unsigned i = 0; i < 4; i++) {
        if ((kinds >> i & 1) != 0) {
            put(t, first ? "" : ",");
            put(t, quote);
            put(t, names[i]);
            put(t, quote);
            first = false;
        }
    }
    put(t, first ? none : "");
}

/* --- what there is to report, from wherever it stands --- */

static uint32_t kinds_of(const aset_tracer *tracer) {
#if ASET_WITH_APPROXIMATION
    bool can = tracer->summary != NULL;
#if ASET_WITH_DRAFTS
    can = can || tracer->draft != NULL;
#endif
    return can ? tracer->approx_kinds : 0;
#else
    (void)tracer;
    return 0;
#endif
}

static aset_counts counts_of(const aset_report *r) {
    const aset_counts none = {0, 0, 0, 0, 0, 0, 0, 0};
    return r->counts != NULL ? *r->counts : r->tracer->scene != NULL ? r->tracer->scene->counts : none;
}

/* Divisions and structure: of the space, or of a draft that has none. A draft's leaves are the sides of its voxels. */
static aset_structure structure_of(const aset_tracer *tracer, uint32_t divisions[3]) {
    aset_structure s = {0, 0, 0, 0, 0};
    memset(divisions, 0, 3 * sizeof *divisions);
    if (tracer->space != NULL) {
        memcpy(divisions, tracer->space->slices.n, 3 * sizeof *divisions);
        return tracer->space->structure;
    }
#if ASET_WITH_DRAFTS
    if (tracer->draft != NULL) {
        memcpy(divisions, tracer->draft->n, 3 * sizeof *divisions);
        s.leaves = 6 * (uint64_t)divisions[0] * divisions[1] * divisions[2];
        s.nonempty = s.references = tracer->draft->n_facets;
    }
#endif
    return s;
}

static uint32_t depth_of(const aset_tracer *tracer) {
#if ASET_WITH_APPROXIMATION
    return tracer->approx_depth;
#else
    (void)tracer;
    return 0;
#endif
}

static const char *word_of(const char *word) {
    return word != NULL ? word : "";
}

/* --- JSON --- */

static void json_scene(text *t, const aset_report *r) {
    const aset_counts c = counts_of(r);
    const uint64_t numbers[] = {c.objects, c.polygons, c.patches, c.spheres, c.cones, c.materials, c.lights};
    const uint64_t depth = depth_of(r->tracer);
    fill(t, "{'scene':{'objects':#,'polygons':#,'patches':#,'spheres':#,'cones':#,'materials':#,'lights':#},'method':'", numbers);
    put(t, word_of(r->method));
    fill(t, "','approx':[", NULL);
    put_kinds(t, kinds_of(r->tracer), "\"", "");
    fill(t, "],'approx_depth':#,'cells':'", &depth);
    put(t, word_of(r->cells));
}

static void json_structure(text *t, const aset_tracer *tracer) {
    uint32_t n[3];
    const aset_structure s = structure_of(tracer, n);
    const uint64_t numbers[] = {n[0], n[1], n[2], s.interior, s.leaves, s.leaves - s.nonempty, s.nonempty, s.references, s.merged,
                                ratio(s.references, s.nonempty, 6)};
    fill(t, "','grid':[#,#,#],'structure':{'interior':#,'leaves':#,'empty':#,'nonempty':#,'references':#,'merged':#,'density':@6}",
         numbers);
}

static void json_statistics(text *t, const aset_statistics *s) {
    uint64_t numbers[sizeof *s / sizeof(uint64_t)] = {0}; /* its counts, all of 64 bits, in their order */
    if (s != NULL) {
        memcpy(numbers, s, sizeof numbers);
    }
    fill(t, ",'rays':{'primary':#,'primary_hit':#,'shadow':#,'shadow_hit':#,'reflected':#,'refracted':#,'secondary_hit':#,"
            "'curtailed':#},'work':{'cells_visited':#,'nonempty_visited':#,'tests':#,'test_hits':#,'approx_hits':#}", numbers);
}

static void json_memory(text *t, const aset_report *r) {
    uint64_t numbers[6] = {0};
#if ASET_WITH_APPROXIMATION
#if ASET_WITH_DRAFTS
    if (r->tracer->draft != NULL) {
        numbers[0] = numbers[1] = r->tracer->draft->n_textures;
    } else
#endif
    if (r->tracer->summary != NULL) {
        numbers[0] = r->tracer->summary->n_textures;
        numbers[1] = r->tracer->summary->capacity;
        numbers[2] = r->tracer->summary->merged;
    }
#endif
    if (r->arena != NULL) {
        numbers[3] = r->arena->size;
        numbers[4] = r->arena->used;
        numbers[5] = r->arena->peak;
    }
    fill(t, ",'textures':{'used':#,'capacity':#,'merged':#},'memory':{'budget':#,'used':#,'peak':#", numbers);
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        const uint64_t bytes = r->arena != NULL ? r->arena->peak_by[i] : 0;
        fill(t, ",'", NULL);
        put(t, aset_category_name((aset_category)i));
        fill(t, "':#", &bytes);
    }
}

size_t aset_report_json(char *buffer, size_t size, const aset_report *report) {
    text t = {buffer, size, 0};
    const uint64_t times[] = {time_units(report->load_s, 6), time_units(report->build_s, 6), time_units(report->render_s, 6)};
    json_scene(&t, report);
    json_structure(&t, report->tracer);
    json_statistics(&t, report->statistics);
    json_memory(&t, report);
    fill(&t, "},'time':{'load_s':@6,'build_s':@6,'render_s':@6}}\n", times);
    return text_end(&t);
}

/* --- text: lines with a label in a column of its own --- */

static void put_label(text *t, const char *label) {
    size_t end = t->n + 12;
    put(t, label);
    while (t->n < end) {
        put_char(t, ' ');
    }
}

static void text_scene(text *t, const aset_report *r) {
    const aset_counts c = counts_of(r);
    const uint64_t numbers[] = {c.objects, c.polygons, c.patches, c.spheres, c.cones, c.materials, c.lights};
    put_label(t, "scene");
    fill(t, "# objects: # polygons, # patches, # spheres, # cones; # materials, # lights\n", numbers);
}

static void text_space(text *t, const aset_report *r) {
    uint32_t n[3];
    const aset_structure s = structure_of(r->tracer, n);
    const uint64_t numbers[] = {n[0], n[1], n[2], s.nonempty, s.leaves, ratio(s.references, s.nonempty, 2)};
    put_label(t, "space");
    put(t, word_of(r->method));
    fill(t, ", # x # x # divisions, # of # cells not empty, @2 objects each\n", numbers);
    if (s.merged > 0) {
        put_label(t, "merged");
        fill(t, "# extents of objects share a slice with others\n", &s.merged);
    }
    put_label(t, "approximate");
    put_kinds(t, kinds_of(r->tracer), "", "nothing");
#if ASET_WITH_DRAFTS
    const aset_draft *draft = r->tracer->draft;
    if (draft != NULL) {
        const uint64_t about[] = {r->tracer->approx_depth, draft->n_words * sizeof(uint32_t), draft->n_facets,
                                  draft->stage.counts.objects};
        fill(t, " from depth #, a draft of # bytes, # facets, # objects kept exact", about);
    }
#endif
#if ASET_WITH_APPROXIMATION
    const aset_summary *summary = r->tracer->summary;
    if (summary != NULL) {
        const uint64_t about[] = {r->tracer->approx_depth, summary->n_textures, summary->capacity, summary->merged};
        fill(t, " from depth #, # textures of at most #, # cells shared a near one", about);
    }
#endif
    put_char(t, '\n');
}

static void text_statistics(text *t, const aset_statistics *s) {
    const uint64_t rays = s->primary + s->shadow + s->reflected + s->refracted;
    const uint64_t counts[] = {s->primary, s->primary_hit, s->shadow, s->shadow_hit, s->reflected, s->refracted, s->curtailed};
    const uint64_t ratios[] = {ratio(s->cells_visited, rays, 2), ratio(s->nonempty_visited, rays, 2), ratio(s->tests, rays, 2),
                               ratio(s->test_hits, s->tests, 3)}; /* with one decimal it is a percentage */
    put_label(t, "rays");
    fill(t, "# primary (# hit), # shadow (# hit), # reflected, # refracted, # curtailed\n", counts);
    put_label(t, "a ray");
    fill(t, "@2 cells, @2 of them not empty, @2 tests, @1 % of which hit\n", ratios);
}

static void text_memory(text *t, const aset_arena *arena) {
    const uint64_t numbers[] = {arena->peak, arena->size};
    put_label(t, "memory");
    fill(t, "# bytes at the peak of #\n", numbers);
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        const uint64_t bytes = arena->peak_by[i];
        put(t, "  ");
        put_label(t, aset_category_name((aset_category)i));
        fill(t, "#  ", &bytes);
        put(t, aset_category_text((aset_category)i));
        put_char(t, '\n');
    }
}

size_t aset_report_text(char *buffer, size_t size, const aset_report *report) {
    text t = {buffer, size, 0};
    const uint64_t times[] = {time_units(report->load_s, 3), time_units(report->build_s, 3), time_units(report->render_s, 3)};
    bool has_scene = report->counts != NULL || report->tracer->scene != NULL, has_space = has_scene || report->tracer->space != NULL;
#if ASET_WITH_DRAFTS
    has_space = has_space || report->tracer->draft != NULL;
#endif
    if (has_scene) {
        text_scene(&t, report);
    }
    if (has_space) {
        text_space(&t, report);
    }
    if (report->statistics != NULL) {
        text_statistics(&t, report->statistics);
    }
    if (report->arena != NULL) {
        text_memory(&t, report->arena);
    }
    put_label(&t, "time");
    fill(&t, "@3 s load, @3 s build, @3 s render\n", times);
    return text_end(&t);
}
