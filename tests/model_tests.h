/*
 * model_tests.h - what the tests of the readers of models share: a sink that writes down, a spill file and libraries in
 * memory, and the sweeps that every format must survive: cut off at every byte, failing at every byte, every byte replaced.
 */
#ifndef ASET_TESTS_MODEL_TESTS_H
#define ASET_TESTS_MODEL_TESTS_H

#include "support/support.h"

#include "aset/load.h"

typedef byte_source source;
typedef aset_status (*loader)(const aset_sink *, aset_read, void *, const aset_load_options *, aset_load_report *);

/* ---- a sink that writes down ---- */

typedef struct recorder {
    char *text; /* NULL: only counted and hashed */
    size_t length, capacity;
    uint64_t triangles, hash;  /* the hash is of all triangles' points, as floats */
    unsigned calls, fail_call; /* calls so far, counted from 1; the one that fails, 0: none */
    aset_status failure;
    bool quiet, refuse_all; /* polygon_end says ASET_ERR_GEOMETRY */
} recorder;

static inline void put(recorder *to, const char *text) {
    if (!to->quiet) {
        to->text = text_append(to->text, &to->length, &to->capacity, text);
    }
}

static inline void put_number(recorder *to, aset_real x) {
    char text[64];
    snprintf(text, sizeof text, " %.6g", (double)x);
    put(to, text);
}

static inline void put_vec3(recorder *to, const aset_vec3 *v) {
    put_number(to, v->x);
    put_number(to, v->y);
    put_number(to, v->z);
}

static inline aset_status recorded(recorder *to) {
    return ++to->calls == to->fail_call ? to->failure : ASET_OK;
}

static inline aset_status record_material(void *context, const aset_material *m) {
    recorder *to = context;
    put(to, "m");
    put_number(to, m->fill.r);
    put_number(to, m->fill.g);
    put_number(to, m->fill.b);
    put(to, ",");
    put_number(to, m->diffuse);
    put_number(to, m->specular);
    put_number(to, m->shine);
#if ASET_WITH_REFRACTION
    put_number(to, m->transmittance);
    put_number(to, m->refraction_index);
#else
    put(to, " 0 0");
#endif
    put(to, m->one_sided ? " one; " : "; ");
    return recorded(to);
}

#if ASET_WITH_POLYGONS
static inline aset_status record_begin(void *context, uint32_t n_points, bool with_normals) {
    recorder *to = context;
    assert_int_equal(n_points, 3);
    put(to, with_normals ? "p" : "t");
    return recorded(to);
}

static inline aset_status record_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    recorder *to = context;
    const float x[3] = {(float)point->x, (float)point->y, (float)point->z};
    unsigned char bytes[sizeof x];
    memcpy(bytes, x, sizeof x);
    for (size_t i = 0; i < sizeof bytes; i++) {
        to->hash = (to->hash ^ bytes[i]) * UINT64_C(1099511628211);
    }
    put_vec3(to, point);
    if (normal != NULL) {
        put(to, " /");
        put_vec3(to, normal);
    }
    put(to, ",");
    return recorded(to);
}

static inline aset_status record_end(void *context) {
    recorder *to = context;
    put(to, "; ");
    to->triangles += to->refuse_all ? 0u : 1u;
    return to->refuse_all ? ASET_ERR_GEOMETRY : recorded(to);
}
#endif

static inline aset_sink recorder_sink(recorder *to) {
    aset_sink sink;
    memset(&sink, 0, sizeof sink);
    sink.context = to;
    sink.material = record_material; /* the readers of models call nothing else */
#if ASET_WITH_POLYGONS
    sink.polygon_begin = record_begin;
    sink.polygon_point = record_point;
    sink.polygon_end = record_end;
#endif
    return sink;
}

static inline recorder recorder_start(bool quiet) {
    recorder to;
    memset(&to, 0, sizeof to);
    to.quiet = quiet;
    to.hash = UINT64_C(14695981039346656037);
    put(&to, "");
    return to;
}

/* ---- a spill file in memory ---- */

typedef struct spill_file {
    unsigned char *bytes;
    bool *written;
    uint64_t size;
    unsigned calls, fail_call; /* as of a recorder */
} spill_file;

static inline bool spill_write(void *context, uint64_t offset, const void *bytes, size_t size) {
    spill_file *file = context;
    assert_true(size > 0);
    if (++file->calls == file->fail_call) {
        return false;
    }
    if (offset + size > file->size) {
        file->bytes = realloc(file->bytes, (size_t)(offset + size));
        file->written = realloc(file->written, (size_t)(offset + size));
        assert_true(file->bytes != NULL && file->written != NULL);
        memset(file->written + file->size, 0, (size_t)(offset + size - file->size));
        file->size = offset + size;
    }
    memcpy(file->bytes + offset, bytes, size);
    memset(file->written + offset, 1, size);
    return true;
}

static inline bool spill_read(void *context, uint64_t offset, void *bytes, size_t size) {
    spill_file *file = context;
    assert_true(size > 0 && offset + size <= file->size);
    if (++file->calls == file->fail_call) {
        return false;
    }
    for (size_t i = 0; i < size; i++) {
        assert_true(file->written[offset + i]); /* only what was written is asked for */
    }
    memcpy(bytes, file->bytes + offset, size);
    return true;
}

static inline void spill_free(spill_file *file) {
    free(file->bytes);
    free(file->written);
}

/* ---- libraries in memory ---- */

typedef struct shelf {
    const char *const *books; /* name, text, name, text ..., NULL */
    source open;
    unsigned opened, closed, asked;
    size_t fail_at; /* of every library, if not 0 */
} shelf;

static inline bool shelf_open(void *context, const char *name, aset_read *read, void **stream) {
    shelf *s = context;
    assert_int_equal(s->opened, s->closed); /* one at a time */
    s->asked++;
    for (size_t i = 0; s->books[i] != NULL; i += 2) {
        if (strcmp(s->books[i], name) == 0) {
            s->open = source_of(s->books[i + 1], strlen(s->books[i + 1]), 3);
            s->open.fail_at = s->fail_at != 0 ? s->fail_at : SIZE_MAX;
            s->opened++;
            *read = give;
            *stream = &s->open;
            return true;
        }
    }
    return false;
}

static inline void shelf_close(void *context, void *stream) {
    shelf *s = context;
    assert_ptr_equal(stream, &s->open);
    s->closed++;
}

/* ---- what most cases do ---- */

static unsigned char vertex_block[4096];

/* Options with room for some vertices. */
static inline aset_load_options options_with(aset_vertex_store *store) {
    aset_load_options options;
    memset(&options, 0, sizeof options);
    memset(store, 0, sizeof *store);
    store->block = vertex_block;
    store->size = sizeof vertex_block;
    options.vertices = store;
    return options;
}

/* Reads with options (NULL: those above) in pieces of each size; size_known: says how large the input is. */
static inline void expect_log(loader load, const char *bytes, size_t size, bool size_known, const aset_load_options *given,
                              const char *log, uint64_t skipped) {
    aset_vertex_store store;
    aset_load_options options = options_with(&store);
    options = given != NULL ? *given : options;
    options.size = size_known ? size : 0;
    for (size_t i = 0; i < COUNT_OF(chunks); i++) {
        aset_load_report report;
        recorder to = recorder_start(false);
        source from = source_of(bytes, size, chunks[i]);
        const aset_sink sink = recorder_sink(&to);
        memset(&report, 0xa5, sizeof report);
        const aset_status status = load(&sink, give, &from, &options, &report);
        if (status != ASET_OK) {
            print_error("line %lu: %s: '%s'\n", (unsigned long)report.line, report.what, report.token);
        }
        assert_int_equal(status, ASET_OK);
        assert_string_equal(to.text, log);
        assert_null(report.what);
        assert_null(report.expected);
        assert_string_equal(report.token, "");
        assert_string_equal(report.library, "");
        assert_int_equal(report.triangles, to.triangles);
        assert_int_equal(report.skipped, skipped);
        free(to.text);
    }
}

static inline void expect_text(loader load, const char *text, const char *log) {
    expect_log(load, text, strlen(text), true, NULL, log, 0);
}

static inline void expect_bad_bytes(loader load, const char *bytes, size_t size, bool size_known, size_t offset,
                                    const bad_case *bad) {
    for (size_t i = 0; i < COUNT_OF(chunks); i++) {
        aset_vertex_store store;
        aset_load_options options = options_with(&store);
        aset_load_report report;
        recorder to = recorder_start(true);
        source from = source_of(bytes, size, chunks[i]);
        const aset_sink sink = recorder_sink(&to);
        options.size = size_known ? size : 0;
        memset(&report, 0xa5, sizeof report);
        const aset_status status = load(&sink, give, &from, &options, &report);
        if (status != bad->status || report.what == NULL || strstr(report.what, bad->what) == NULL ||
            report.offset != offset || report.line != bad->line || strcmp(report.token, bad->token) != 0) {
            print_error("for: %s\nstatus %d, line %lu, offset %lu: %s: '%s'\n", bad->text != NULL ? bad->text : "bytes",
                        status, (unsigned long)report.line, (unsigned long)report.offset,
                        report.what != NULL ? report.what : "", report.token);
        }
        assert_int_equal(status, bad->status);
        assert_non_null(report.what);
        assert_non_null(strstr(report.what, bad->what));
        assert_string_equal(report.token, bad->token);
        assert_int_equal(report.offset, offset);
        assert_int_equal(report.line, bad->line);
    }
}

static inline void expect_all_bad(loader load, bool size_known, const bad_case *bad, size_t n) {
    for (size_t i = 0; i < n; i++) {
        size_t size, offset;
        char *text = bad_input(bad + i, &size, &offset);
        expect_bad_bytes(load, text, size, size_known, offset, bad + i);
        free(text);
    }
}

/* One status for an input that may be anything; an error must come with its sentence. */
static inline aset_status load_any(loader load, source from, bool size_known, aset_load_options options) {
    aset_load_report report;
    recorder to = recorder_start(true);
    const aset_sink sink = recorder_sink(&to);
    options.size = size_known ? from.size : 0;
    memset(&report, 0xa5, sizeof report);
    const aset_status status = load(&sink, give, &from, &options, &report);
    assert_int_equal(report.triangles, to.triangles);
    if (status != ASET_OK) {
        assert_non_null(report.what);
        assert_true(report.offset <= from.size || report.library[0] != '\0');
        assert_non_null(memchr(report.token, 0, sizeof report.token));
    } else {
        assert_null(report.what);
        assert_true(report.triangles > 0);
    }
    return status;
}

/* A good input cut off at every byte. may_pass: a shorter file may be whole, too. */
static inline void expect_cuts(loader load, const char *bytes, size_t size, bool may_pass) {
    aset_vertex_store store;
    const aset_load_options options = options_with(&store);
    for (size_t cut = 0; cut < size; cut++) {
        for (size_t i = 0; i < 2 * COUNT_OF(chunks); i++) {
            const aset_status status = load_any(load, source_of(bytes, cut, chunks[i / 2]), i % 2 == 0, options);
            if (!may_pass || status != ASET_OK) {
                assert_int_equal(status, ASET_ERR_SYNTAX);
            }
        }
    }
}

/* A callback that fails at every byte. */
static inline void expect_failures(loader load, const char *bytes, size_t size) {
    aset_vertex_store store;
    const aset_load_options options = options_with(&store);
    for (size_t at = 0; at <= size; at++) {
        for (size_t i = 0; i < COUNT_OF(chunks); i++) {
            source from = source_of(bytes, size, chunks[i]);
            from.fail_at = at;
            assert_int_equal(load_any(load, from, false, options), ASET_ERR_READ);
        }
    }
}

/* Every byte replaced by several others: any status of a broken file, and no more than that. */
static inline void expect_survival(loader load, const char *bytes, size_t size) {
    static const char others[] = {0,   1,   9,   '\n', '\r', ' ', '#', '-', '.',  '/',
                                  '0', '3', '9', '\\', 'e',  'f', 'v', 127, -128, -1};
    aset_vertex_store store;
    const aset_load_options options = options_with(&store);
    char *copy = malloc(size);
    assert_non_null(copy);
    for (size_t at = 0; at < size; at++) {
        for (size_t i = 0; i < COUNT_OF(others); i++) {
            memcpy(copy, bytes, size);
            copy[at] = others[i];
            const aset_status status = load_any(load, source_of(copy, size, SIZE_MAX), i % 2 == 0, options);
            assert_true(status == ASET_OK || status == ASET_ERR_SYNTAX || status == ASET_ERR_UNSUPPORTED ||
                        status == ASET_ERR_NOMEM || status == ASET_ERR_LIMIT);
        }
    }
    free(copy);
}

/* The sink fails at each of its calls: that is the reader's status, but for geometry. */
static inline void expect_sink_errors(loader load, const char *bytes, size_t size, unsigned calls) {
    static const aset_status failures[] = {ASET_ERR_NOMEM, ASET_ERR_LIMIT, ASET_ERR_STOPPED, ASET_ERR_ARGUMENT};
    aset_vertex_store store;
    aset_load_options options = options_with(&store);
    for (unsigned call = 1; call <= calls; call++) {
        for (size_t i = 0; i < COUNT_OF(failures); i++) {
            aset_load_report report;
            recorder to = recorder_start(true);
            const aset_sink sink = recorder_sink(&to);
            source from = source_of(bytes, size, SIZE_MAX);
            to.fail_call = call;
            to.failure = failures[i];
            assert_int_equal(load(&sink, give, &from, &options, &report), failures[i]);
            assert_non_null(report.what);
            assert_int_equal(to.calls, call); /* nothing more after an error */
        }
    }
}

/* ---- binary inputs ---- */

typedef struct bytes_buffer {
    char bytes[4096];
    size_t size;
    bool high_first;
} bytes_buffer;

static inline void add_number(bytes_buffer *to, uint32_t x, unsigned n) {
    for (unsigned i = 0; i < n; i++) {
        assert_true(to->size < sizeof to->bytes);
        const unsigned byte = x >> 8 * (to->high_first ? n - 1 - i : i) & 0xff;
        to->bytes[to->size++] = (char)(byte < 128 ? (int)byte : (int)byte - 256);
    }
}

static inline void add_float(bytes_buffer *to, float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    add_number(to, bits, 4);
}

static inline void add_text(bytes_buffer *to, const char *text) {
    assert_true(to->size + strlen(text) < sizeof to->bytes);
    memcpy(to->bytes + to->size, text, strlen(text));
    to->size += strlen(text);
}

/* ---- one small model in every format: a pyramid on a square, as six triangles ---- */

#define GREY "m 0.8 0.8 0.8, 1 0 0 0 0; "
#define PYRAMID_LOG                                                                                                         \
    GREY "t 0 0 0, 0 2 0, 2 2 0,; t 0 0 0, 2 2 0, 2 0 0,; t 0 0 0, 2 0 0, 1 1 1.5,; t 2 0 0, 2 2 0, 1 1 1.5,; "             \
         "t 2 2 0, 0 2 0, 1 1 1.5,; t 0 2 0, 0 0 0, 1 1 1.5,; "

static const float pyramid_points[5][3] = {{0, 0, 0}, {0, 2, 0}, {2, 2, 0}, {2, 0, 0}, {1, 1, 1.5f}};
static const unsigned char pyramid_triangles[6][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {3, 2, 4}, {2, 1, 4}, {1, 0, 4}};

#endif
