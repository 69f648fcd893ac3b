/*
 * ply_header.c - the header of a PLY file, and whether what it announces can be.
 *
 *     ply | format FORM 1.0 | { element NAME COUNT { property TYPE NAME, or property list TYPE TYPE NAME } } | end_header
 */
#include "ply.h"

#if ASET_WITH_POLYGONS

const aset_ply_type aset_ply_types[N_TYPES] = {
    {"char", "int8", 1, 127},       {"uchar", "uint8", 1, 255},        {"short", "int16", 2, 32767},
    {"ushort", "uint16", 2, 65535}, {"int", "int32", 4, 2147483647.0}, {"uint", "uint32", 4, 4294967295.0},
    {"float", "float32", 4, 1},     {"double", "float64", 8, 1},
};

/* ---- its lines ---- */

static aset_status need(ply *file, const char *expected) {
    aset_reader *reader = &file->model.reader;
    const aset_status status = aset_reader_next(reader);
    return status == ASET_OK && reader->length == 0 ? aset_reader_fail(reader, ASET_ERR_SYNTAX, reader->cut, expected)
                                                    : status;
}

/* The current token begins it. */
static aset_status read_form(ply *file) {
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const char *expected = "format ascii, binary_little_endian or binary_big_endian";
    if (!aset_reader_is(&file->model.reader, "format")) {
        return ply_fail(file, "another word than the format's", expected);
    }
    aset_status status = need(file, expected);
    for (int i = 0; status == ASET_OK && i < 3; i++) {
        if (aset_reader_is(&file->model.reader, names[i])) {
            file->form = (form)i;
            status = need(file, "1.0");
            return status == ASET_OK && !aset_reader_is(&file->model.reader, "1.0")
                       ? ply_fail(file, "an unknown version", "1.0")
                       : status;
        }
    }
    return status == ASET_OK ? ply_fail(file, "an unknown format", expected) : status;
}

static aset_status read_element(ply *file) {
    aset_reader *reader = &file->model.reader;
    if (file->n_elements == ELEMENTS_MOST) {
        return aset_reader_fail(reader, ASET_ERR_LIMIT, "more kinds of elements than can be kept", "16 or fewer");
    }
    element *to = &file->elements[file->n_elements];
    aset_status status = need(file, "element name count");
    if (status != ASET_OK) {
        return status;
    }
    if (aset_reader_is(reader, "tristrips")) {
        return aset_reader_fail(reader, ASET_ERR_UNSUPPORTED, "triangle strips are not read", "faces");
    }
    to->kind = aset_reader_is(reader, "vertex") ? VERTEX : aset_reader_is(reader, "face") ? FACE : OTHER;
    for (uint32_t i = 0; i < file->n_elements && to->kind != OTHER; i++) {
        if (file->elements[i].kind == to->kind) {
            return ply_fail(file, "an element that the file already has", NULL);
        }
    }
    to->place = aset_reader_place(reader);
    to->first = file->n_properties;
    to->n = to->roles = 0;
    file->n_elements++;
    return aset_reader_whole(reader, &to->count, 0, UINT32_MAX, "", "the number of elements, a whole number");
}

static aset_status read_type(ply *file, type *to) {
    const aset_status status = need(file, "the type of a property");
    for (int i = 0; status == ASET_OK && i < N_TYPES; i++) {
        if (aset_reader_is(&file->model.reader, aset_ply_types[i].name) ||
            aset_reader_is(&file->model.reader, aset_ply_types[i].other_name)) {
            *to = (type)i;
            return ASET_OK;
        }
    }
    return status == ASET_OK ? ply_fail(file, "an unknown type", "char uchar short ushort int uint float or double")
                             : status;
}

/* What the number named by the current token is used for. */
static role role_of(const aset_reader *reader, kind of) {
    static const struct {
        const char *name;
        role role;
    } names[] = {
        {"x", X},
        {"y", Y},
        {"z", Z},
        {"nx", NX},
        {"ny", NY},
        {"nz", NZ},
        {"red", RED},
        {"green", GREEN},
        {"blue", BLUE},
        {"r", RED},
        {"g", GREEN},
        {"b", BLUE},
        {"diffuse_red", RED},
        {"diffuse_green", GREEN},
        {"diffuse_blue", BLUE},
    };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (aset_reader_is(reader, names[i].name)) {
            return of == VERTEX || (of == FACE && names[i].role >= RED) ? names[i].role : SKIP;
        }
    }
    return SKIP;
}

static bool is_whole_type(type t) {
    return t < FLOAT32;
}

static aset_status add_property(ply *file, element *to, const property *p) {
    property *last = to->n > 0 ? &file->properties[file->n_properties - 1] : NULL;
    if (p->role == SKIP && last != NULL && last->role == SKIP) {
        last->numbers += p->numbers;
        last->bytes += p->bytes;
        return ASET_OK;
    }
    if (file->n_properties == PROPERTIES_MOST) {
        return aset_reader_fail(&file->model.reader, ASET_ERR_LIMIT, "more properties than can be kept", "48 or fewer");
    }
    file->properties[file->n_properties++] = *p;
    to->n++;
    to->roles |= 1u << p->role;
    return ASET_OK;
}

static aset_status read_property(ply *file) {
    aset_reader *reader = &file->model.reader;
    if (file->n_elements == 0) {
        return ply_fail(file, "a property before any element", "element");
    }
    element *to = &file->elements[file->n_elements - 1];
    type count_type = UINT8, number_type = UINT8;
    aset_status status = aset_reader_keep(reader);
    const bool list = status == ASET_OK && aset_reader_is(reader, "list");
    if (status == ASET_OK && list) {
        status = aset_reader_next(reader);
        if (status == ASET_OK) {
            status = read_type(file, &count_type);
        }
        if (status == ASET_OK && !is_whole_type(count_type)) {
            return ply_fail(file, "a list whose count is not whole", "a type of whole numbers");
        }
    }
    if (status == ASET_OK) {
        status = read_type(file, &number_type);
    }
    const aset_place number_place = aset_reader_place(reader);
    if (status == ASET_OK) {
        status = need(file, "the name of a property");
    }
    if (status != ASET_OK) {
        return status;
    }
    property p = {SKIP, (uint8_t)number_type, (uint8_t)count_type, 1, aset_ply_types[number_type].bytes};
    const bool indices = aset_reader_is(reader, "vertex_indices") || aset_reader_is(reader, "vertex_index");
    p.role = (uint8_t)(!list ? role_of(reader, to->kind) : indices && to->kind == FACE ? INDICES : SKIP_LIST);
    if (p.role < SKIP && HAS(to, p.role)) {
        p.role = list ? SKIP_LIST : SKIP; /* the first of a kind counts */
    }
    if (p.role == INDICES && !is_whole_type(number_type)) {
        return aset_reader_fail_at(reader, &number_place, ASET_ERR_SYNTAX, "indices that are not whole",
                                   "a type of whole numbers");
    }
    return add_property(file, to, &p);
}

static aset_status read_header(ply *file) {
    aset_reader *reader = &file->model.reader;
    reader->comment = -1;
    reader->cut = "the file ends within its header";
    for (bool has_form = false;;) {
        aset_status status = need(file, has_form ? "end_header" : "format");
        if (status != ASET_OK || (has_form && aset_reader_is(reader, "end_header"))) {
            return status;
        }
        if (aset_reader_is(reader, "comment") || aset_reader_is(reader, "obj_info")) {
            status = aset_reader_skip_line(reader);
        } else if (!has_form) {
            status = read_form(file);
            has_form = true;
        } else if (aset_reader_is(reader, "element")) {
            status = read_element(file);
        } else if (aset_reader_is(reader, "property")) {
            status = read_property(file);
        } else {
            return ply_fail(file, "not a line of a header", "element, property, comment or end_header");
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

/* ---- what it promises ---- */

static aset_status fail_element(ply *file, const element *at, aset_status status, const char *what, const char *expected) {
    return aset_reader_fail_at(&file->model.reader, &at->place, status, what, expected);
}

static aset_status check_vertices(ply *file, const element *vertices) {
    const uint32_t point = 1u << X | 1u << Y | 1u << Z, normal = 1u << NX | 1u << NY | 1u << NZ;
    const uint32_t colour = 1u << RED | 1u << GREEN | 1u << BLUE;
    if ((vertices->roles & point) != point) {
        return fail_element(file, vertices, ASET_ERR_SYNTAX, "vertices without x, y and z", NULL);
    }
    file->normals = file->model.smooth && (vertices->roles & normal) == normal;
    file->vertex_colours = !file->face_colours && (vertices->roles & colour) == colour;
    return ASET_OK;
}

/*
 * The bytes that all elements need at least: a list may be empty, a number of text is a digit and a byte between it and the
 * next.
 */
static bool size_suffices(const ply *file, uint64_t size) {
    uint64_t left = file->form == TEXT ? size + 1 : size;
    for (uint32_t i = 0; i < file->n_elements; i++) {
        const element *e = &file->elements[i];
        uint64_t each = 0;
        for (uint32_t k = e->first; k < e->first + e->n; k++) {
            const property *p = &file->properties[k];
            const bool list = p->role == INDICES || p->role == SKIP_LIST;
            each += file->form == TEXT ? 2 * p->numbers : list ? aset_ply_types[p->count_type].bytes : p->bytes;
        }
        if (each != 0 && left / each < e->count) {
            return false;
        }
        left -= each * e->count;
    }
    return true;
}

static aset_status check_header(ply *file) {
    const element *vertices = NULL, *faces = NULL;
    const uint32_t colour = 1u << RED | 1u << GREEN | 1u << BLUE;
    for (uint32_t i = 0; i < file->n_elements; i++) {
        const element *e = &file->elements[i];
        vertices = e->kind == VERTEX ? e : vertices;
        faces = e->kind == FACE ? e : faces;
        if (e->kind == FACE && vertices == NULL) {
            return fail_element(file, e, ASET_ERR_UNSUPPORTED, "faces before the vertices", NULL);
        }
    }
    if (faces == NULL || faces->count == 0) {
        return aset_model_end(&file->model);
    }
    if (!HAS(faces, INDICES)) {
        return fail_element(file, faces, ASET_ERR_SYNTAX, "faces without a list of vertex_indices", NULL);
    }
    file->face_colours = (faces->roles & colour) == colour;
    const aset_status status = check_vertices(file, vertices);
    if (status != ASET_OK) {
        return status;
    }
    aset_reader *reader = &file->model.reader;
    if (file->model.size > reader->offset && !size_suffices(file, file->model.size - reader->offset)) {
        return aset_reader_fail(reader, ASET_ERR_SYNTAX, "the header announces more than the file holds, before", NULL);
    }
    return ASET_OK;
}

/* Moves behind the header's last line. */
static aset_status leave_header(ply *file) {
    aset_reader *reader = &file->model.reader;
    if (file->form == TEXT || !file->lone_cr) {
        const aset_status status = aset_reader_skip_line(reader);
        if (status != ASET_OK) {
            return status;
        }
    } else {
        const unsigned char *bytes;
        size_t n;
        aset_status status = aset_reader_window(reader, 1, &bytes, &n);
        while (status == ASET_OK && n > 0 && (bytes[0] == ' ' || bytes[0] == '\t')) {
            aset_reader_advance(reader, 1);
            status = aset_reader_window(reader, 1, &bytes, &n);
        }
        if (status != ASET_OK) {
            return status;
        }
        aset_reader_advance(reader, n > 0 && bytes[0] == '\r' ? 1 : 0); /* an LF behind it is data */
    }
    if (file->form != TEXT) {
        aset_model_binary(&file->model);
    }
    return ASET_OK;
}

/* How much of it is looked at for the way in which its lines end. */
#define FIRST_LINE 32u

static aset_status begin(ply *file) {
    aset_reader *reader = &file->model.reader;
    const unsigned char *bytes;
    size_t n;
    aset_status status = aset_reader_skip_mark(reader);
    if (status == ASET_OK) {
        status = aset_reader_peek(reader, FIRST_LINE, &bytes, &n);
    }
    if (status != ASET_OK) {
        return status;
    }
    size_t end = 3; /* of "ply" and blanks */
    while (end < n && (bytes[end] == ' ' || bytes[end] == '\t')) {
        end++;
    }
    file->lone_cr = end + 1 < n && bytes[end] == '\r' && bytes[end + 1] != '\n';
    reader->cut = "the file ends within its header";
    status = need(file, "ply");
    return status == ASET_OK && !aset_reader_is(reader, "ply") ? ply_fail(file, "not a PLY file by its first word", "ply")
                                                               : status;
}

aset_status aset_ply_read_header(ply *file) {
    aset_status status = begin(file);
    if (status == ASET_OK) {
        status = read_header(file);
    }
    if (status == ASET_OK) {
        status = leave_header(file);
    }
    return status == ASET_OK ? check_header(file) : status;
}

#endif
