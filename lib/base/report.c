/*
 * report.c - formatting of statistics and memory; it counts nothing itself. Its own writing of numbers, since the core has
 * no stdio.
 */
#include "aset/report.h"

#include <string.h>

/* A text that grows in the caller's buffer and goes on counting when that is full. */
typedef struct text {
    char *at;
    size_t size, n;
} text;

static void put(text *t, const char *s) {
    for (; *s != 0; s++) {
        if (t->n + 1 < t->size) {
            t->at[t->n] = *s;
        }
        t->n++;
    }
}

static void put_number(text *t, uint64_t x) {
    char digits[21];
    int i = 20;
    digits[i] = 0;
    do {
        digits[--i] = (char)('0' + x % 10);
        x /= 10;
    } while (x > 0);
    put(t, digits + i);
}

/* A number from 0 to 10^12 with so many decimals, at most 6. */
static void put_decimal(text *t, double x, unsigned decimals) {
    uint64_t scale = 1;
    for (unsigned i = 0; i < decimals; i++) {
        scale *= 10;
    }
    uint64_t units = x > 0 && x < 1e12 ? (uint64_t)(x * (double)scale + 0.5) : 0;
    put_number(t, units / scale);
    put(t, ".");
    for (uint64_t digit = scale / 10; digit > 0; digit /= 10) {
        put_number(t, units / digit % 10);
    }
}

static void put_field(text *t, const char *key, uint64_t x) {
    put(t, "\"");
    put(t, key);
    put(t, "\":");
    put_number(t, x);
}

/* One more member of an object: a comma before all but the first. */
static void put_member(text *t, const char *key, uint64_t x) {
    put(t, ",");
    put_field(t, key, x);
}

static size_t text_end(text *t) {
    if (t->size > 0) {
        t->at[t->n < t->size ? t->n : t->size - 1] = 0;
    }
    return t->n;
}

static double ratio(uint64_t a, uint64_t b) {
    return b > 0 ? (double)a / (double)b : 0;
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

static void json_scene(text *t, const aset_report *r) {
    aset_counts counts = counts_of(r), *c = &counts;
    put(t, "{\"scene\":{");
    put_field(t, "objects", c->objects);
    put_member(t, "polygons", c->polygons);
    put_member(t, "patches", c->patches);
    put_member(t, "spheres", c->spheres);
    put_member(t, "cones", c->cones);
    put_member(t, "materials", c->materials);
    put_member(t, "lights", c->lights);
    put(t, "},\"method\":\"");
    put(t, r->method != NULL ? r->method : "");
    put(t, "\",\"approx\":[");
    put_kinds(t, kinds_of(r->tracer), "\"", "");
    put(t, "]");
#if ASET_WITH_APPROXIMATION
    put_member(t, "approx_depth", r->tracer->approx_depth);
#else
    put_member(t, "approx_depth", 0);
#endif
    put(t, ",\"cells\":\"");
    put(t, r->cells != NULL ? r->cells : "");
    put(t, "\"");
}

static void json_structure(text *t, const aset_tracer *tracer) {
    uint32_t divisions[3];
    aset_structure structure = structure_of(tracer, divisions), *s = &structure;
    put(t, ",\"grid\":[");
    for (int a = 0; a < 3; a++) {
        put(t, a > 0 ? "," : "");
        put_number(t, divisions[a]);
    }
    put(t, "],\"structure\":{");
    put_field(t, "interior", s->interior);
    put_member(t, "leaves", s->leaves);
    put_member(t, "empty", s->leaves - s->nonempty);
    put_member(t, "nonempty", s->nonempty);
    put_member(t, "references", s->references);
    put_member(t, "merged", s->merged);
    put(t, ",\"density\":");
    put_decimal(t, ratio(s->references, s->nonempty), 6);
    put(t, "}");
}

static void json_statistics(text *t, const aset_statistics *given) {
    aset_statistics s;
    memset(&s, 0, sizeof s);
    if (given != NULL) {
        s = *given;
    }
    put(t, ",\"rays\":{");
    put_field(t, "primary", s.primary);
    put_member(t, "primary_hit", s.primary_hit);
    put_member(t, "shadow", s.shadow);
    put_member(t, "shadow_hit", s.shadow_hit);
    put_member(t, "reflected", s.reflected);
    put_member(t, "refracted", s.refracted);
    put_member(t, "secondary_hit", s.secondary_hit);
    put_member(t, "curtailed", s.curtailed);
    put(t, "},\"work\":{");
    put_field(t, "cells_visited", s.cells_visited);
    put_member(t, "nonempty_visited", s.nonempty_visited);
    put_member(t, "tests", s.tests);
    put_member(t, "test_hits", s.test_hits);
    put_member(t, "approx_hits", s.approx_hits);
    put(t, "}");
}

static void json_memory(text *t, const aset_report *r) {
    uint32_t used = 0, capacity = 0, merged = 0;
#if ASET_WITH_APPROXIMATION
#if ASET_WITH_DRAFTS
    if (r->tracer->draft != NULL) {
        used = capacity = r->tracer->draft->n_textures;
    } else
#endif
    if (r->tracer->summary != NULL) {
        used = r->tracer->summary->n_textures;
        capacity = r->tracer->summary->capacity;
        merged = r->tracer->summary->merged;
    }
#endif
    put(t, ",\"textures\":{");
    put_field(t, "used", used);
    put_member(t, "capacity", capacity);
    put_member(t, "merged", merged);
    put(t, "},\"memory\":{");
    put_field(t, "budget", r->arena != NULL ? r->arena->size : 0);
    put_member(t, "used", r->arena != NULL ? r->arena->used : 0);
    put_member(t, "peak", r->arena != NULL ? r->arena->peak : 0);
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        put_member(t, aset_category_name((aset_category)i), r->arena != NULL ? r->arena->peak_by[i] : 0);
    }
    put(t, "}");
}

size_t aset_report_json(char *buffer, size_t size, const aset_report *report) {
    text t = {buffer, size, 0};
    json_scene(&t, report);
    json_structure(&t, report->tracer);
    json_statistics(&t, report->statistics);
    json_memory(&t, report);
    put(&t, ",\"time\":{\"load_s\":");
    put_decimal(&t, report->load_s, 6);
    put(&t, ",\"build_s\":");
    put_decimal(&t, report->build_s, 6);
    put(&t, ",\"render_s\":");
    put_decimal(&t, report->render_s, 6);
    put(&t, "}}\n");
    return text_end(&t);
}

/* A line of the text: a label in a column of its own, then pairs of number and words. */
static void put_label(text *t, const char *label) {
    size_t length = strlen(label);
    put(t, label);
    for (; length < 12; length++) {
        put(t, " ");
    }
}

static void put_counted(text *t, uint64_t x, const char *words) {
    put_number(t, x);
    put(t, words);
}

static void text_scene(text *t, const aset_report *r) {
    aset_counts counts = counts_of(r), *c = &counts;
    put_label(t, "scene");
    put_counted(t, c->objects, " objects: ");
    put_counted(t, c->polygons, " polygons, ");
    put_counted(t, c->patches, " patches, ");
    put_counted(t, c->spheres, " spheres, ");
    put_counted(t, c->cones, " cones; ");
    put_counted(t, c->materials, " materials, ");
    put_counted(t, c->lights, " lights\n");
}

static void text_space(text *t, const aset_report *r) {
    uint32_t n[3];
    aset_structure s = structure_of(r->tracer, n);
    put_label(t, "space");
    put(t, r->method != NULL ? r->method : "");
    put(t, ", ");
    put_counted(t, n[0], " x ");
    put_counted(t, n[1], " x ");
    put_counted(t, n[2], " divisions, ");
    put_counted(t, s.nonempty, " of ");
    put_counted(t, s.leaves, " cells not empty, ");
    put_decimal(t, ratio(s.references, s.nonempty), 2);
    put(t, " objects each\n");
    if (s.merged > 0) {
        put_label(t, "merged");
        put_counted(t, s.merged, " extents of objects share a slice with others\n");
    }
    put_label(t, "approximate");
    put_kinds(t, kinds_of(r->tracer), "", "nothing");
#if ASET_WITH_DRAFTS
    if (r->tracer->draft != NULL) {
        put(t, " from depth ");
        put_counted(t, r->tracer->approx_depth, ", a draft of ");
        put_counted(t, r->tracer->draft->n_words * sizeof(uint32_t), " bytes, ");
        put_counted(t, r->tracer->draft->n_facets, " facets, ");
        put_counted(t, r->tracer->draft->stage.counts.objects, " objects kept exact");
    }
#endif
#if ASET_WITH_APPROXIMATION
    if (r->tracer->summary != NULL) {
        put(t, " from depth ");
        put_counted(t, r->tracer->approx_depth, ", ");
        put_counted(t, r->tracer->summary->n_textures, " textures of at most ");
        put_counted(t, r->tracer->summary->capacity, ", ");
        put_counted(t, r->tracer->summary->merged, " cells shared a near one");
    }
#endif
    put(t, "\n");
}

static void text_statistics(text *t, const aset_statistics *s) {
    uint64_t rays = s->primary + s->shadow + s->reflected + s->refracted;
    put_label(t, "rays");
    put_counted(t, s->primary, " primary (");
    put_counted(t, s->primary_hit, " hit), ");
    put_counted(t, s->shadow, " shadow (");
    put_counted(t, s->shadow_hit, " hit), ");
    put_counted(t, s->reflected, " reflected, ");
    put_counted(t, s->refracted, " refracted, ");
    put_counted(t, s->curtailed, " curtailed\n");
    put_label(t, "a ray");
    put_decimal(t, ratio(s->cells_visited, rays), 2);
    put(t, " cells, ");
    put_decimal(t, ratio(s->nonempty_visited, rays), 2);
    put(t, " of them not empty, ");
    put_decimal(t, ratio(s->tests, rays), 2);
    put(t, " tests, ");
    put_decimal(t, 100 * ratio(s->test_hits, s->tests), 1);
    put(t, " % of which hit\n");
}

static void text_memory(text *t, const aset_arena *arena) {
    put_label(t, "memory");
    put_counted(t, arena->peak, " bytes at the peak of ");
    put_counted(t, arena->size, "\n");
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        put(t, "  ");
        put_label(t, aset_category_name((aset_category)i));
        put_counted(t, arena->peak_by[i], "  ");
        put(t, aset_category_text((aset_category)i));
        put(t, "\n");
    }
}

size_t aset_report_text(char *buffer, size_t size, const aset_report *report) {
    text t = {buffer, size, 0};
    if (report->tracer->scene != NULL) {
        text_scene(&t, report);
    }
    if (report->tracer->scene != NULL || report->tracer->space != NULL) {
        text_space(&t, report);
    }
    if (report->statistics != NULL) {
        text_statistics(&t, report->statistics);
    }
    if (report->arena != NULL) {
        text_memory(&t, report->arena);
    }
    put_label(&t, "time");
    put_decimal(&t, report->load_s, 3);
    put(&t, " s load, ");
    put_decimal(&t, report->build_s, 3);
    put(&t, " s build, ");
    put_decimal(&t, report->render_s, 3);
    put(&t, " s render\n");
    return text_end(&t);
}
