/*
 * obj.c - Wavefront OBJ (Wavefront's "Advanced Visualizer Manual", appendix B: "Object Files"), line by line.
 *
 * Points, and normals if patches are wanted, go to the vertex store as they come, since a face may name any of them; a face
 * goes to the sink triangle by triangle as its corners come. A name of a material takes effect at the next face that is
 * drawn.
 */
#include "model.h"
#include "mtl.h"
#include "vertices.h"

#include <string.h>

#if ASET_WITH_POLYGONS

enum { POINTS, NORMALS };

typedef struct obj {
    aset_model model;
    aset_vertices vertices;
    aset_mtl mtl;
    aset_corner corners[3]; /* of the fan: first, last but one, last */
    char name[ASET_MTL_NAME]; /* of the material for the next faces, where is_named: it is looked for when one comes */
    bool is_named;
} obj;

static aset_status fail(obj *file, const char *what, const char *expected) {
    return aset_reader_fail(&file->model.reader, ASET_ERR_SYNTAX, what, expected);
}

/* ---- points and normals ---- */

/* Three coordinates on this line into a list of the store; what else is on the line is passed over. */
static aset_status read_record(obj *file, uint32_t list, const char *expected) {
    aset_reader *reader = &file->model.reader;
    aset_real record[3];
    for (int i = 0; i < 3; i++) {
        aset_status status = aset_reader_next(reader);
        if (status == ASET_OK && reader->starts_line) {
            return fail(file, reader->length == 0 ? "the file ends within a vertex" : "a vertex is not complete before this",
                        expected);
        }
        const char *wrong = status == ASET_OK ? aset_number_coordinate(reader->token, reader->length, &record[i]) : NULL;
        if (wrong != NULL) {
            return fail(file, wrong, expected);
        }
        if (status != ASET_OK) {
            return status;
        }
    }
    file->model.reader.report->vertices += list == POINTS ? 1u : 0u;
    const aset_status status = aset_model_store_answer(&file->model, aset_vertices_add(&file->vertices, list, record),
                                                       aset_vertices_capacity(&file->vertices));
    return status == ASET_OK ? aset_reader_skip_line(reader) : status;
}

/* ---- corners of faces ---- */

/* A whole number with a sign from text[*at] on, 0 if there is none; beyond 2^33 it only stays large. */
static int64_t take_index(const char *text, size_t *at) {
    const bool negative = text[*at] == '-';
    size_t i = *at + (negative ? 1 : 0);
    int64_t sum = 0;
    if (text[i] < '0' || text[i] > '9') {
        return 0;
    }
    for (; text[i] >= '0' && text[i] <= '9'; i++) {
        sum = sum * 10 + (text[i] - '0');
        sum = sum > INT64_C(1) << 33 ? INT64_C(1) << 33 : sum;
    }
    *at = i;
    return negative ? -sum : sum;
}

/*
 * A corner: v, v/vt, v//vn or v/vt/vn, where numbers behind a slash may be missing (v/ and v/vt/ are written, too). *normal
 * is 0 if there is none. False: it is not one.
 */
static bool take_corner(const char *text, int64_t *point, int64_t *normal) {
    size_t at = 0;
    *point = take_index(text, &at);
    *normal = 0;
    const bool has_point = at > 0;
    if (text[at] == '/') {
        at++;
        (void)take_index(text, &at);
    }
    if (text[at] == '/') {
        at++;
        *normal = take_index(text, &at);
    }
    return has_point && text[at] == '\0';
}

/* From the file's number, counted from 1 or back from the end, to ours. */
static bool resolve(int64_t number, uint32_t count, uint32_t *index) {
    const int64_t at = number > 0 ? number - 1 : number + (int64_t)count;
    if (number == 0 || at < 0 || at >= (int64_t)count) {
        return false;
    }
    *index = (uint32_t)at;
    return true;
}

/* The corner that the current token names. */
static aset_status get_corner(obj *file, aset_corner *corner) {
    int64_t point, normal;
    uint32_t index;
    aset_real record[3] = {0, 0, 0};
    const char *form = "v, v/vt, v//vn or v/vt/vn";
    if (!take_corner(file->model.reader.token, &point, &normal)) {
        return fail(file, "not a corner of a face", form);
    }
    if (!resolve(point, file->vertices.count[POINTS], &index)) {
        return fail(file, "a vertex that is not there", "the number of a vertex before the face, from 1, or from -1 down");
    }
    aset_status status = aset_vertices_get(&file->vertices, POINTS, index, record);
    corner->point = (aset_vec3){record[0], record[1], record[2]};
    corner->has_normal = file->model.smooth && normal != 0;
    if (status == ASET_OK && corner->has_normal) {
        corner->has_normal = resolve(normal, file->vertices.count[NORMALS], &index); /* one that is not there is none */
    }
    if (status == ASET_OK && corner->has_normal) {
        status = aset_vertices_get(&file->vertices, NORMALS, index, record);
        corner->normal = (aset_vec3){record[0], record[1], record[2]};
    }
    return aset_model_store_answer(&file->model, status, 0);
}

/* ---- materials ---- */

static aset_status read_library_names(obj *file) {
    char names[ASET_MTL_NAME];
    size_t length;
    aset_reader *reader = &file->model.reader;
    const aset_status status = aset_reader_rest(reader, names, sizeof names, &length);
    if (status == ASET_OK && length > 0 && !aset_mtl_add_library(&file->mtl, names)) {
        return aset_reader_fail(reader, ASET_ERR_LIMIT, "more names of material libraries than can be kept", "500 bytes");
    }
    return status;
}

/* The material that was named last, of the libraries that have been named by now. */
static aset_status find_material(obj *file) {
    bool found = true;
    aset_model *model = &file->model;
    file->is_named = false;
    aset_status status = aset_mtl_find(&file->mtl, file->name, &model->wanted, &found, model->reader.report);
    model->reader.report->unknown_materials += status == ASET_OK && !found ? 1u : 0u;
    if (status == ASET_ERR_UNSUPPORTED && model->reader.report->what == NULL) {
        return aset_reader_fail(&model->reader, status, "transmission was switched off when the library was compiled",
                                "materials that are opaque");
    }
    return status;
}

static aset_status read_material_name(obj *file) {
    size_t length;
    aset_status status = file->is_named ? find_material(file) : ASET_OK; /* no face had it: it is told if there is none */
    if (status == ASET_OK) {
        status = aset_reader_rest(&file->model.reader, file->name, sizeof file->name, &length);
        file->model.wanted = file->model.fallback;
        file->is_named = status == ASET_OK && length > 0;
    }
    return status;
}

/* ---- faces ---- */

static aset_status read_face(obj *file) {
    aset_reader *reader = &file->model.reader;
    aset_corner *c = file->corners;
    if (file->is_named) {
        const aset_status named = find_material(file);
        if (named != ASET_OK) {
            return named;
        }
    }
    for (uint64_t n = 0;; n++) {
        aset_status status = aset_reader_keep(reader);
        if (status != ASET_OK || reader->starts_line) {
            reader->report->skipped += status == ASET_OK && n < 3 ? 1u : 0u;
            return status;
        }
        status = aset_reader_next(reader);
        if (n > 2) {
            c[1] = c[2];
        }
        if (status == ASET_OK) {
            status = get_corner(file, &c[n < 2 ? n : 2]);
        }
        if (status == ASET_OK && n >= 2) {
            status = aset_model_triangle(&file->model, &c[0], &c[1], &c[2]);
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

/* ---- the file ---- */

/* The line whose first word is the current token. */
static aset_status read_line(obj *file) {
    aset_reader *reader = &file->model.reader;
    if (aset_reader_is(reader, "v")) {
        return read_record(file, POINTS, "v x y z");
    }
    if (aset_reader_is(reader, "f")) {
        return read_face(file);
    }
    if (file->model.smooth && aset_reader_is(reader, "vn")) {
        return read_record(file, NORMALS, "vn x y z");
    }
    if (aset_reader_is(reader, "usemtl")) {
        return read_material_name(file);
    }
    if (aset_reader_is(reader, "mtllib")) {
        return read_library_names(file);
    }
    return aset_reader_skip_line(reader);
}

aset_status aset_load_obj(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    obj file;
    aset_status status = aset_model_init(&file.model, sink, read, context, options, report);
    if (status != ASET_OK) {
        return status;
    }
    aset_reader *reader = &file.model.reader;
    aset_vertices_init(&file.vertices, options != NULL ? options->vertices : NULL, 3, file.model.smooth ? 2 : 1);
    aset_mtl_init(&file.mtl, options, &file.model.fallback);
    memset(file.corners, 0, sizeof file.corners);
    file.is_named = false;
    reader->joiner = '\\';
    reader->cut = "the file ends within a line";
    status = aset_reader_skip_mark(reader);
    while (status == ASET_OK) {
        status = aset_reader_next(reader);
        if (status == ASET_OK && reader->length == 0) {
            status = file.is_named ? find_material(&file) : ASET_OK;
            return status == ASET_OK ? aset_model_end(&file.model) : status;
        }
        if (status == ASET_OK) {
            status = read_line(&file);
        }
    }
    return status;
}

#else

aset_status aset_load_obj(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    (void)options;
    return aset_model_switched_off(sink, read, context, report);
}

#endif
