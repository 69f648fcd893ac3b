/*
 * ply.c - the Polygon File Format (Greg Turk, "The PLY Polygon File Format", 1994), text and binary of both byte orders.
 *
 * A header names elements, each with a count and properties; then the elements follow in that order, number by number:
 *
 *     element vertex 8            elements[0] = VERTEX, 8 times   properties:  X  Y  Z  SKIP(3 numbers, 12 bytes)
 *     property float x ...        elements[1] = FACE, 12 times    properties:  INDICES  SKIP(1 number, 1 byte)
 *
 * Neighbouring numbers that nobody needs are one property SKIP, so wide elements take little of the table. Vertices go to
 * the store as records of 3, 6 or 9 reals (point; normal if patches are wanted; colour); of a face at most FACE_MOST
 * indices are kept, and these only if its colour stands among its properties, else its triangles leave as its indices come.
 */
#include "ply.h"

#include <string.h>

#if ASET_WITH_POLYGONS

/* ---- numbers of the body ---- */

static aset_status fail_cut(ply *file) {
    static const char *const cut[] = {"the file ends before the last vertex it announces, after",
                                      "the file ends before the last face it announces, after",
                                      "the file ends before the last element it announces, after"};
    const aset_reader *reader = &file->model.reader;
    const uint64_t end = reader->offset + (reader->end - reader->at);
    const aset_status status =
        aset_model_fail_binary(&file->model, end, cut[file->here->kind], file->done, file->here->count);
    reader->report->line = file->form == TEXT ? reader->line : 0;
    return status;
}

static uint32_t take_32(const unsigned char *b, bool high_first) {
    return high_first ? (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | (uint32_t)b[3]
                      : (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | (uint32_t)b[0];
}

static double take_double(const unsigned char *b, bool high_first) {
    const uint64_t first = take_32(b, high_first), second = take_32(b + 4, high_first);
    const uint64_t bits = high_first ? first << 32 | second : second << 32 | first;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* A whole number of 1, 2 or 4 bytes, with its sign. */
static int64_t take_whole(const unsigned char *b, type t, bool high_first) {
    switch (t) {
    case INT8: return b[0] < 0x80 ? b[0] : (int64_t)b[0] - 0x100;
    case UINT8: return b[0];
    case INT16:
    case UINT16: {
        const int64_t x = high_first ? b[0] << 8 | b[1] : b[1] << 8 | b[0];
        return t == UINT16 || x < 0x8000 ? x : x - 0x10000;
    }
    default: {
        const int64_t x = take_32(b, high_first);
        return t == UINT32 || x < INT64_C(0x80000000) ? x : x - INT64_C(0x100000000);
    }
    }
}

/* The next number's bytes, taken. */
static aset_status take_bytes(ply *file, type t, const unsigned char **bytes) {
    size_t n;
    const uint32_t size = aset_ply_types[t].bytes;
    const aset_status status = aset_reader_window(&file->model.reader, size, bytes, &n);
    if (status == ASET_OK && n < size) {
        return fail_cut(file);
    }
    if (status == ASET_OK) {
        aset_reader_advance(&file->model.reader, size);
    }
    return status;
}

static aset_status need_text(ply *file) {
    const aset_status status = aset_reader_next(&file->model.reader);
    return status == ASET_OK && file->model.reader.length == 0 ? fail_cut(file) : status;
}

/* A coordinate, or ASET_NUMBER_OUTSIDE. */
static aset_status read_real(ply *file, type t, aset_real *value) {
    aset_status status;
    if (file->form == TEXT) {
        status = need_text(file);
        const aset_reader *reader = &file->model.reader;
        const char *wrong = status == ASET_OK ? aset_number_coordinate(reader->token, reader->length, value) : NULL;
        return wrong == NULL ? status : ply_fail(file, wrong, "a number");
    }
    const unsigned char *bytes;
    const bool high_first = file->form == HIGH_FIRST;
    status = take_bytes(file, t, &bytes);
    if (status == ASET_OK && t == FLOAT32) {
        *value = aset_model_single(take_32(bytes, high_first));
    } else if (status == ASET_OK) {
        *value =
            aset_model_coordinate(t == FLOAT64 ? take_double(bytes, high_first) : (double)take_whole(bytes, t, high_first));
    }
    return status;
}

/* A whole number; -1 stands for all below 0. */
static aset_status read_whole(ply *file, type t, const char *expected, int64_t *value) {
    aset_status status;
    if (file->form == TEXT) {
        status = need_text(file);
        const aset_reader *reader = &file->model.reader;
        if (status != ASET_OK) {
            return status;
        }
        const size_t sign = reader->token[0] == '-' ? 1 : 0;
        uint32_t size;
        const char *wrong = aset_number_whole(reader->token + sign, reader->length - sign, &size);
        *value = wrong != NULL ? 0 : sign == 1 && size > 0 ? -1 : (int64_t)size;
        return wrong == NULL ? ASET_OK : ply_fail(file, wrong, expected);
    }
    const unsigned char *bytes;
    status = take_bytes(file, t, &bytes);
    if (status == ASET_OK) {
        *value = take_whole(bytes, t, file->form == HIGH_FIRST);
    }
    return status;
}

/* Passes over so many numbers, together of so many bytes. */
static aset_status skip_numbers(ply *file, uint64_t numbers, uint64_t bytes) {
    aset_status status = ASET_OK;
    if (file->form == TEXT) {
        for (; numbers > 0 && status == ASET_OK; numbers--) {
            status = need_text(file);
        }
        return status;
    }
    while (bytes > 0) {
        const unsigned char *from;
        size_t n;
        status = aset_reader_window(&file->model.reader, 1, &from, &n);
        if (status == ASET_OK && n == 0) {
            return fail_cut(file);
        }
        if (status != ASET_OK) {
            return status;
        }
        n = n < bytes ? n : (size_t)bytes;
        aset_reader_advance(&file->model.reader, n);
        bytes -= n;
    }
    return ASET_OK;
}

/* An error about the number just read: the token in text, else the element. */
static aset_status fail_number(ply *file, const char *what, const char *expected) {
    if (file->form == TEXT) {
        return ply_fail(file, what, expected);
    }
    const aset_status status =
        aset_model_fail_binary(&file->model, file->model.reader.offset, what, file->done, file->here->count);
    file->model.reader.report->expected = expected;
    return status;
}

static aset_status read_count(ply *file, const property *list, uint32_t *count) {
    const char *expected = "the length of a list";
    int64_t n = 0;
    const aset_status status = read_whole(file, (type)list->count_type, expected, &n);
    *count = (uint32_t)n;
    return status == ASET_OK && n < 0 ? fail_number(file, "a list of a negative length, in element", expected) : status;
}

static aset_status skip_list(ply *file, const property *list) {
    uint32_t n;
    const aset_status status = read_count(file, list, &n);
    return status == ASET_OK ? skip_numbers(file, n, (uint64_t)n * aset_ply_types[list->type].bytes) : status;
}

/* A colour's part as a share of 1. */
static aset_real share(aset_real value, type t) {
    const aset_real part = (aset_real)(value / (aset_real)aset_ply_types[t].largest);
    return part > 0 && value < ASET_NUMBER_OUTSIDE ? part : 0;
}

/* ---- vertices and faces ---- */

static aset_status read_vertex(ply *file, const element *e) {
    aset_real values[N_VALUES] = {0}, record[9];
    for (uint32_t k = e->first; k < e->first + e->n; k++) {
        const property *p = &file->properties[k];
        aset_status status;
        if (p->role < N_VALUES) {
            status = read_real(file, (type)p->type, &values[p->role]);
            if (status == ASET_OK && p->role >= RED) {
                values[p->role] = share(values[p->role], (type)p->type);
            }
        } else if (p->role == SKIP) {
            status = skip_numbers(file, p->numbers, p->bytes);
        } else {
            status = skip_list(file, p);
        }
        if (status != ASET_OK) {
            return status;
        }
    }
    uint32_t n = 3;
    memcpy(record, &values[X], 3 * sizeof values[0]);
    if (file->normals) {
        memcpy(record + n, &values[NX], 3 * sizeof values[0]);
        n += 3;
    }
    if (file->vertex_colours) {
        memcpy(record + n, &values[RED], 3 * sizeof values[0]);
    }
    file->model.reader.report->vertices++;
    return aset_model_store_answer(&file->model, aset_vertices_add(&file->vertices, 0, record),
                                   aset_vertices_capacity(&file->vertices));
}

static aset_status get_corner(ply *file, uint32_t index, aset_corner *corner) {
    aset_real record[9];
    const aset_status status = aset_vertices_get(&file->vertices, 0, index, record);
    if (status != ASET_OK) {
        return aset_model_store_answer(&file->model, status, 0);
    }
    const aset_real *at = record + 3;
    corner->point = (aset_vec3){record[0], record[1], record[2]};
    corner->has_normal = file->normals;
    if (file->normals) {
        corner->normal = (aset_vec3){at[0], at[1], at[2]};
        at += 3;
    }
    if (file->vertex_colours) {
        corner->colour = (aset_colour){at[0], at[1], at[2]};
    }
    return ASET_OK;
}

static aset_real mean_of(aset_real a, aset_real b, aset_real c) {
    aset_real sum = a + b + c;
    return sum - sum == 0 ? sum / 3 : a / 3 + b / 3 + c / 3; /* the sum may be beyond all numbers, the mean not */
}

/* Corner number n of a face goes to the fan; from the third on, each makes a triangle. */
static aset_status add_corner(ply *file, uint32_t n, uint32_t index) {
    aset_corner *c = file->corners;
    if (n > 2) {
        c[1] = c[2];
    }
    const aset_status status = get_corner(file, index, &c[n < 2 ? n : 2]);
    if (status != ASET_OK || n < 2) {
        return status;
    }
    if (file->vertex_colours) {
        const aset_colour mean = {mean_of(c[0].colour.r, c[1].colour.r, c[2].colour.r),
                                  mean_of(c[0].colour.g, c[1].colour.g, c[2].colour.g),
                                  mean_of(c[0].colour.b, c[1].colour.b, c[2].colour.b)};
        aset_model_fill(&file->model, &mean);
    }
    return aset_model_triangle(&file->model, &c[0], &c[1], &c[2]);
}

static aset_status read_indices(ply *file, const property *list) {
    uint32_t n;
    aset_status status = read_count(file, list, &n);
    if (status != ASET_OK) {
        return status;
    }
    if (file->face_colours && n > FACE_MOST) {
        fail_number(file, "a face of a colour with more points than can be kept, face", "64 or fewer");
        return ASET_ERR_LIMIT;
    }
    file->model.reader.report->skipped += n < 3 ? 1u : 0u;
    file->n_indices = n;
    for (uint32_t i = 0; i < n; i++) {
        int64_t index = 0;
        status = read_whole(file, (type)list->type, "the index of a vertex", &index);
        if (status == ASET_OK && (index < 0 || index >= (int64_t)file->vertices.count[0])) {
            return fail_number(file, "the index of a vertex that is not there, in face", "one from 0 to below their number");
        }
        if (status == ASET_OK && file->face_colours) {
            file->indices[i] = (uint32_t)index;
        } else if (status == ASET_OK) {
            status = add_corner(file, i, (uint32_t)index);
        }
        if (status != ASET_OK) {
            return status;
        }
    }
    return ASET_OK;
}

static aset_status read_face(ply *file, const element *e) {
    aset_real values[N_VALUES] = {0};
    aset_status status = ASET_OK;
    for (uint32_t k = e->first; k < e->first + e->n && status == ASET_OK; k++) {
        const property *p = &file->properties[k];
        if (p->role < N_VALUES) {
            status = read_real(file, (type)p->type, &values[p->role]);
            if (status == ASET_OK) {
                values[p->role] = share(values[p->role], (type)p->type);
            }
        } else if (p->role == INDICES) {
            status = read_indices(file, p);
        } else if (p->role == SKIP) {
            status = skip_numbers(file, p->numbers, p->bytes);
        } else {
            status = skip_list(file, p);
        }
    }
    if (status == ASET_OK && file->face_colours) {
        const aset_colour colour = {values[RED], values[GREEN], values[BLUE]};
        aset_model_fill(&file->model, &colour);
        for (uint32_t i = 0; i < file->n_indices && status == ASET_OK; i++) {
            status = add_corner(file, i, file->indices[i]);
        }
    }
    return status;
}

static aset_status read_other(ply *file, const element *e) {
    aset_status status = ASET_OK;
    for (uint32_t k = e->first; k < e->first + e->n && status == ASET_OK; k++) {
        const property *p = &file->properties[k];
        status = p->role == SKIP ? skip_numbers(file, p->numbers, p->bytes) : skip_list(file, p);
    }
    return status;
}

/* ---- the file ---- */

static aset_status read_elements(ply *file) {
    for (uint32_t i = 0; i < file->n_elements; i++) {
        const element *e = &file->elements[i];
        file->here = e;
        for (file->done = 0; file->done < e->count && e->n > 0; file->done++) {
            file->model.reader.token_offset =
                file->form == TEXT ? file->model.reader.token_offset : file->model.reader.offset;
            const aset_status status = e->kind == VERTEX ? read_vertex(file, e)
                                       : e->kind == FACE ? read_face(file, e)
                                                         : read_other(file, e);
            if (status != ASET_OK) {
                return status;
            }
        }
    }
    return ASET_OK;
}

/* Behind the last element there are blanks at most, and zeros in binary files, which some writers pad. */
static aset_status check_end(ply *file) {
    aset_reader *reader = &file->model.reader;
    const char *what = "more in the file than its header announces";
    if (file->form == TEXT) {
        const aset_status status = aset_reader_next(reader);
        return status == ASET_OK && reader->length > 0 ? ply_fail(file, what, "the end") : status;
    }
    for (;;) {
        const unsigned char *bytes;
        size_t n;
        const aset_status status = aset_reader_window(reader, 1, &bytes, &n);
        if (status != ASET_OK || n == 0) {
            return status;
        }
        for (size_t i = 0; i < n; i++) {
            if (bytes[i] != 0 && bytes[i] != ' ' && bytes[i] != '\t' && bytes[i] != '\n' && bytes[i] != '\r') {
                reader->token_offset = reader->offset + i;
                return ply_fail(file, what, "the end");
            }
        }
        aset_reader_advance(reader, n);
    }
}

/* The store, if it can take all vertices that are announced. */
static aset_status prepare_vertices(ply *file, const aset_load_options *options) {
    const uint32_t reals = 3u + (file->normals ? 3u : 0u) + (file->vertex_colours ? 3u : 0u);
    aset_vertices_init(&file->vertices, options != NULL ? options->vertices : NULL, reals, 1);
    const uint64_t capacity = aset_vertices_capacity(&file->vertices);
    for (uint32_t i = 0; i < file->n_elements; i++) {
        const element *e = &file->elements[i];
        if (e->kind == VERTEX && e->count > capacity && !aset_vertices_can_spill(&file->vertices)) {
            return aset_model_store_answer(&file->model, ASET_ERR_NOMEM, capacity);
        }
    }
    return ASET_OK;
}

aset_status aset_load_ply(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    ply file;
    file.form = TEXT;
    file.n_elements = file.n_properties = file.n_indices = 0;
    file.normals = file.vertex_colours = file.face_colours = false;
    memset(file.corners, 0, sizeof file.corners);
    aset_status status = aset_model_init(&file.model, sink, read, context, options, report);
    if (status != ASET_OK) {
        return status;
    }
    aset_reader_lend(&file.model.reader, file.batch, sizeof file.batch);
    status = aset_ply_read_header(&file);
    if (status == ASET_OK) {
        status = prepare_vertices(&file, options);
    }
    if (status == ASET_OK) {
        status = read_elements(&file);
    }
    if (status == ASET_OK) {
        status = check_end(&file);
    }
    return status == ASET_OK ? aset_model_end(&file.model) : status;
}

#else

aset_status aset_load_ply(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    (void)options;
    return aset_model_switched_off(sink, read, context, report);
}

#endif
