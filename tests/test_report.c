/*
 * test_report.c - the report as JSON, read back by a small parser, and as text; buffers that are too small; the sentences of
 * statuses; adding statistics.
 */
#include "support/support.h"

/* --- reading JSON: just enough, and strict --- */

static const char *value_end(const char *p);

static const char *string_end(const char *p) {
    if (p == NULL || *p != '"') {
        return NULL;
    }
    for (p++; *p != '"'; p++) {
        if (*p == 0 || *p == '\\' || (unsigned char)*p < ' ') {
            return NULL; /* a report needs no escapes */
        }
    }
    return p + 1;
}

static const char *number_end(const char *p) {
    const char *start = p + (*p == '-');
    p = start + strspn(start, "0123456789");
    if (p == start || (*start == '0' && p > start + 1)) {
        return NULL;
    }
    if (*p == '.') {
        const char *fraction = p + 1;
        p = fraction + strspn(fraction, "0123456789");
        return p > fraction ? p : NULL;
    }
    return p;
}

/* What stands between brackets: values, or for an object members. */
static const char *list_end(const char *p, char close) {
    for (p++; *p != close; p++) {
        if (close == '}') {
            p = string_end(p);
            if (p == NULL || *p++ != ':') {
                return NULL;
            }
        }
        p = value_end(p);
        if (p == NULL || (*p != ',' && *p != close)) {
            return NULL;
        }
        if (*p == close) {
            break;
        }
        if (p[1] == close) {
            return NULL; /* a comma before the end */
        }
    }
    return p + 1;
}

/* Behind the value that begins at p, NULL if none does. */
static const char *value_end(const char *p) {
    switch (*p) {
    case '{': return list_end(p, '}');
    case '[': return list_end(p, ']');
    case '"': return string_end(p);
    default: return number_end(p);
    }
}

/* The value of one member of an object, NULL without it. */
static const char *member(const char *p, const char *key, size_t length) {
    if (p == NULL || *p != '{') {
        return NULL;
    }
    for (p++; *p == '"';) {
        const char *name = p + 1, *value = string_end(p) + 1, *end = value_end(value);
        if ((size_t)(value - 2 - name) == length && memcmp(name, key, length) == 0) {
            return value;
        }
        p = end + (*end == ',');
    }
    return NULL;
}

/* A member of members: "rays.primary". */
static const char *at_path(const char *json, const char *path) {
    while (json != NULL && *path != 0) {
        size_t length = strcspn(path, ".");
        json = member(json, path, length);
        path += length + (path[length] == '.');
    }
    return json;
}

static void check_number(const char *json, const char *path, double expected) {
    const char *value = at_path(json, path);
    check(value != NULL, "%s is not there", path);
    check(fabs(strtod(value, NULL) - expected) <= 1e-6 * (1 + fabs(expected)) / 2, "%s is %g, not %g", path,
          strtod(value, NULL), expected);
}

static void check_text(const char *json, const char *path, const char *expected) {
    const char *value = at_path(json, path);
    check(value != NULL && (size_t)(value_end(value) - value) == strlen(expected) &&
              memcmp(value, expected, strlen(expected)) == 0, "%s is not %s", path, expected);
}

/* --- something to report --- */

typedef struct subject {
    model m;
    stage s;
    aset_space space;
#if ASET_WITH_APPROXIMATION
    aset_summary summary;
#endif
    aset_tracer tracer;
    aset_statistics statistics;
    aset_report report;
} subject;

static void subject_open(subject *x) {
    random_state r = random_start(seed_of(1));
    memset(x, 0, sizeof *x);
    model_random(&x->m, &r, 30, 5, 0.2, 3);
    stage_open_model(&x->s, &x->m, 100000);
    stage_space(&x->s, &x->space, &aset_mset, 3, 4, 5);
    x->tracer = stage_tracer(&x->s, &x->space);
#if ASET_WITH_APPROXIMATION
    assert_int_equal(aset_summary_build(&x->summary, &x->space, 3, &x->s.arena), ASET_OK);
    x->tracer.summary = &x->summary;
    x->tracer.approx_kinds = ASET_SHADOW | ASET_REFRACTED;
    x->tracer.approx_depth = 2;
#endif
    uint64_t number = UINT64_C(1234567890123456789); /* each another, none below 2^32 */
    uint64_t *counts[] = {&x->statistics.primary, &x->statistics.primary_hit, &x->statistics.shadow,
                          &x->statistics.shadow_hit, &x->statistics.reflected, &x->statistics.refracted,
                          &x->statistics.secondary_hit, &x->statistics.curtailed, &x->statistics.cells_visited,
                          &x->statistics.nonempty_visited, &x->statistics.tests, &x->statistics.test_hits,
                          &x->statistics.approx_hits};
    assert_int_equal(sizeof x->statistics, COUNT_OF(counts) * sizeof *counts[0]); /* a new count belongs here too */
    for (size_t i = 0; i < COUNT_OF(counts); i++) {
        *counts[i] = number / (i + 1);
    }
    x->report.tracer = &x->tracer;
    x->report.arena = &x->s.arena;
    x->report.statistics = &x->statistics;
    x->report.method = aset_method_name(&aset_mset);
    x->report.cells = "flat";
    x->report.load_s = 0.125;
    x->report.build_s = 12.0000004;
    x->report.render_s = 3661.9999996;
}

static void subject_close(subject *x) {
    stage_close(&x->s);
    model_free(&x->m);
}

static void json_of(const subject *x, char *buffer, size_t size) {
    size_t length = aset_report_json(buffer, size, &x->report);
    assert_true(length < size && strlen(buffer) == length);
    const char *end = value_end(buffer);
    assert_non_null(end);
    assert_string_equal(end, "\n");
}

static void check_scene_and_structure(const subject *x, const char *json) {
    const aset_counts *c = &x->s.scene.counts;
    check_number(json, "scene.objects", 30);
    check_number(json, "scene.polygons", c->polygons);
    check_number(json, "scene.patches", c->patches);
    check_number(json, "scene.spheres", c->spheres);
    check_number(json, "scene.cones", c->cones);
    check_number(json, "scene.materials", c->materials);
    check_number(json, "scene.lights", 2);
    check_text(json, "method", "\"mset\"");
    check_text(json, "cells", "\"flat\"");
    check_text(json, "grid", "[3,4,5]");
    const aset_structure *s = &x->space.structure;
    check_number(json, "structure.interior", 0);
    check_number(json, "structure.leaves", (double)s->leaves);
    check_number(json, "structure.nonempty", (double)s->nonempty);
    check_number(json, "structure.empty", (double)(s->leaves - s->nonempty));
    check_number(json, "structure.references", (double)s->references);
    check_number(json, "structure.density", (double)s->references / (double)s->nonempty);
}

static void test_report__json_has_every_number(void **state) {
    (void)state;
    subject x;
    char json[4096], digits[32];
    subject_open(&x);
    json_of(&x, json, sizeof json);
    check_scene_and_structure(&x, json);
    static const char *const counts[] = {"rays.primary", "rays.primary_hit", "rays.shadow", "rays.shadow_hit",
                                         "rays.reflected", "rays.refracted", "rays.secondary_hit", "rays.curtailed",
                                         "work.cells_visited", "work.nonempty_visited", "work.tests", "work.test_hits",
                                         "work.approx_hits"};
    for (size_t i = 0; i < COUNT_OF(counts); i++) { /* to the last of 19 digits */
        snprintf(digits, sizeof digits, "%" PRIu64, UINT64_C(1234567890123456789) / (i + 1));
        check_text(json, counts[i], digits);
    }
#if ASET_WITH_APPROXIMATION
    check_text(json, "approx", "[\"shadow\",\"refracted\"]");
    check_number(json, "approx_depth", 2);
    check_number(json, "textures.used", x.summary.n_textures);
    check_number(json, "textures.capacity", 3);
    assert_true(x.summary.merged > 0);
    check_number(json, "textures.merged", x.summary.merged);
#else
    check_text(json, "approx", "[]");
    check_number(json, "textures.used", 0);
#endif
    check_number(json, "memory.budget", (double)x.s.arena.size);
    check_number(json, "memory.used", (double)x.s.arena.used);
    check_number(json, "memory.peak", (double)x.s.arena.peak);
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        char path[64];
        snprintf(path, sizeof path, "memory.%s", aset_category_name((aset_category)i));
        check_number(json, path, (double)x.s.arena.peak_by[i]);
    }
    check_text(json, "time.load_s", "0.125000");
    check_text(json, "time.build_s", "12.000000");
    check_text(json, "time.render_s", "3662.000000");
    subject_close(&x);
}

static void test_report__json_names_the_kinds(void **state) {
    (void)state;
#if ASET_WITH_APPROXIMATION
    subject x;
    char json[4096];
    subject_open(&x);
    static const char *const names[4] = {"\"primary\"", "\"shadow\"", "\"reflected\"", "\"refracted\""};
    for (uint32_t kinds = 0; kinds <= ASET_ALL_KINDS; kinds++) {
        char expected[80] = "[";
        for (int i = 0; i < 4; i++) {
            if ((kinds >> i & 1) != 0) {
                strcat(expected, strlen(expected) > 1 ? "," : "");
                strcat(expected, names[i]);
            }
        }
        x.tracer.approx_kinds = kinds;
        json_of(&x, json, sizeof json);
        check_text(json, "approx", strcat(expected, "]"));
    }
    x.tracer.summary = NULL; /* then nothing is approximate */
    json_of(&x, json, sizeof json);
    check_text(json, "approx", "[]");
    check_number(json, "textures.capacity", 0);
    subject_close(&x);
#endif
}

static void test_report__json_without_parts(void **state) {
    (void)state;
    subject x;
    char json[4096];
    subject_open(&x);
    x.report.arena = NULL;
    x.report.statistics = NULL;
    x.report.method = x.report.cells = NULL;
    json_of(&x, json, sizeof json);
    check_number(json, "memory.budget", 0);
    check_number(json, "memory.scratch", 0);
    check_number(json, "rays.primary", 0);
    check_number(json, "work.approx_hits", 0);
    check_text(json, "method", "\"\"");
    check_number(json, "scene.objects", 30);
    x.tracer.space = NULL;
    x.tracer.scene = NULL;
    x.report.render_s = -1; /* no time is below 0 */
    json_of(&x, json, sizeof json);
    check_number(json, "scene.objects", 0);
    check_text(json, "grid", "[0,0,0]");
    check_number(json, "structure.density", 0);
    check_text(json, "time.render_s", "0.000000");
    const aset_counts counts = {.objects = 7, .spheres = 7};
    x.report.counts = &counts; /* the text has what the JSON has */
    json_of(&x, json, sizeof json);
    check_number(json, "scene.objects", 7);
    assert_true(aset_report_text(json, sizeof json, &x.report) < sizeof json);
    assert_non_null(strstr(json, "7 objects: 0 polygons, 0 patches, 7 spheres"));
    subject_close(&x);
}

typedef size_t (*writer)(char *buffer, size_t size, const aset_report *report);

/* Any size: the same length is told, as much as fits is there, closed by 0, and nothing behind it is touched. */
static void check_sizes(writer write, const aset_report *report) {
    char whole[4096], part[4096];
    size_t length = write(whole, sizeof whole, report);
    assert_true(length > 500 && length < sizeof whole);
    assert_int_equal(write(NULL, 0, report), length);
    for (size_t size = 0; size <= length + 3; size++) {
        memset(part, '#', sizeof part);
        check(write(part, size, report) == length, "size %zu", size);
        size_t kept = size > length ? length : size > 0 ? size - 1 : 0;
        check(memcmp(part, whole, kept) == 0, "size %zu", size);
        check(size == 0 || part[kept] == 0, "size %zu", size);
        check(part[size > length ? length + 1 : size] == '#', "size %zu", size);
    }
}

static void test_report__buffers_of_any_size(void **state) {
    (void)state;
    subject x;
    subject_open(&x);
    check_sizes(aset_report_json, &x.report);
    check_sizes(aset_report_text, &x.report);
    subject_close(&x);
}

static void test_report__text(void **state) {
    (void)state;
    subject x;
    char text[4096], expected[128];
    subject_open(&x);
    x.statistics.primary = 1000;
    x.statistics.shadow = 500;
    x.statistics.reflected = x.statistics.refracted = 250;
    x.statistics.tests = 5000;
    x.statistics.test_hits = 1250;
    size_t length = aset_report_text(text, sizeof text, &x.report);
    assert_int_equal(length, strlen(text));
    snprintf(expected, sizeof expected, "30 objects: %" PRIu32 " polygons", x.s.scene.counts.polygons);
    assert_non_null(strstr(text, expected));
    snprintf(expected, sizeof expected, "%" PRIu64 " of %" PRIu64, x.space.structure.nonempty, x.space.structure.leaves);
    assert_non_null(strstr(text, expected));
    snprintf(expected, sizeof expected, "%zu bytes at the peak of %zu", x.s.arena.peak, x.s.arena.size);
    assert_non_null(strstr(text, expected));
    assert_non_null(strstr(text, "mset, 3 x 4 x 5"));
    assert_non_null(strstr(text, "2.50 tests")); /* for each of 2000 rays */
    assert_non_null(strstr(text, "25.0 %"));
    assert_non_null(strstr(text, "0.125 s"));
#if ASET_WITH_APPROXIMATION
    assert_non_null(strstr(text, "shadow,refracted from depth 2"));
#endif
    for (int i = 0; i < ASET_CATEGORY_COUNT; i++) {
        assert_non_null(strstr(text, aset_category_text((aset_category)i)));
    }
    assert_true(length > 0 && text[length - 1] == '\n');
    x.report.arena = NULL;
    x.report.statistics = NULL;
    x.tracer.space = NULL;
    x.tracer.scene = NULL;
    aset_report_text(text, sizeof text, &x.report);
    assert_null(strstr(text, "peak"));
    assert_null(strstr(text, "rays"));
    assert_null(strstr(text, "cells"));
    assert_null(strstr(text, "objects"));
    assert_non_null(strstr(text, "3662.000 s"));
    subject_close(&x);
}

/* A draft in the place of space and summary; counts of the caller's own; extents that share a slice; no name at all. */
static void test_report__drafts_and_other_parts(void **state) {
    (void)state;
    subject x;
    char text[4096], json[4096];
    subject_open(&x);
    const aset_counts own = {.objects = 7654, .spheres = 7654};
    x.report.counts = &own;
    x.space.structure.merged = 4321;
    x.report.method = NULL;
    aset_report_text(text, sizeof text, &x.report);
    assert_non_null(strstr(text, "7654 objects"));
    assert_non_null(strstr(text, "4321 extents of objects share a slice"));
    json_of(&x, json, sizeof json);
    check_number(json, "scene.objects", 7654);
#if ASET_WITH_DRAFTS
    aset_draft draft;
    memset(&draft, 0, sizeof draft);
    draft.n[0] = 2, draft.n[1] = 3, draft.n[2] = 5;
    draft.n_words = 100;
    draft.n_facets = 61;
    draft.n_textures = 9;
    draft.stage.counts.objects = 4;
    x.tracer.draft = &draft;
    x.tracer.summary = NULL;
    x.tracer.space = NULL;
    aset_report_text(text, sizeof text, &x.report);
    assert_non_null(strstr(text, "2 x 3 x 5 divisions, 61 of 180 cells not empty"));
    assert_non_null(strstr(text, "from depth 2, a draft of 400 bytes, 61 facets, 4 objects kept exact"));
    json_of(&x, json, sizeof json);
    check_number(json, "structure.leaves", 180);
    check_number(json, "structure.nonempty", 61);
    check_number(json, "textures.used", 9);
    check_text(json, "grid", "[2,3,5]");
    check_text(json, "approx", "[\"shadow\",\"refracted\"]");
#endif
#if ASET_WITH_APPROXIMATION
    x.tracer = stage_tracer(&x.s, &x.space);
    x.tracer.approx_kinds = ASET_ALL_KINDS; /* but nothing that it could be read from */
    json_of(&x, json, sizeof json);
    check_text(json, "approx", "[]");
    aset_report_text(text, sizeof text, &x.report);
    assert_non_null(strstr(text, "nothing"));
    assert_null(strstr(text, "textures of at most"));
#endif
    subject_close(&x);
}

static void test_report__every_status_has_a_sentence(void **state) {
    (void)state;
    for (int i = 0; i >= ASET_ERR_PRECISION; i--) {
        const char *text = aset_status_text((aset_status)i);
        assert_true(text != NULL && strlen(text) > 3);
        for (int k = 0; k > i; k--) {
            assert_string_not_equal(text, aset_status_text((aset_status)k));
        }
    }
    assert_non_null(aset_status_text((aset_status)1));
    assert_non_null(aset_status_text((aset_status)-1000));
    assert_string_not_equal(aset_status_text((aset_status)-1000), aset_status_text(ASET_OK));
}

static void test_report__statistics_add_up(void **state) {
    (void)state;
    aset_statistics a, b;
    uint64_t numbers[sizeof a / sizeof(uint64_t)], sums[sizeof a / sizeof(uint64_t)];
    for (size_t i = 0; i < COUNT_OF(numbers); i++) {
        numbers[i] = UINT64_C(3) << (i + 20);
        sums[i] = numbers[i] + 1000 + i;
    }
    memcpy(&a, numbers, sizeof a); /* nothing but counts of 64 bits */
    memcpy(&b, numbers, sizeof b);
    for (size_t i = 0; i < COUNT_OF(numbers); i++) {
        numbers[i] = 1000 + i;
    }
    memcpy(&b, numbers, sizeof b);
    aset_statistics_add(&a, &b);
    assert_memory_equal(&a, sums, sizeof a);
    assert_memory_equal(&b, numbers, sizeof b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_report__json_has_every_number),
        cmocka_unit_test(test_report__json_names_the_kinds),
        cmocka_unit_test(test_report__json_without_parts),
        cmocka_unit_test(test_report__buffers_of_any_size),
        cmocka_unit_test(test_report__text),
        cmocka_unit_test(test_report__drafts_and_other_parts),
        cmocka_unit_test(test_report__every_status_has_a_sentence),
        cmocka_unit_test(test_report__statistics_add_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
