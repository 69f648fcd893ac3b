/* ply.h - a PLY file while it is read: what ply_header.c and ply.c share. Private to lib/load. */
#ifndef ASET_LOAD_PLY_H
#define ASET_LOAD_PLY_H

#include "model.h"
#include "vertices.h"

#if ASET_WITH_POLYGONS

#define ELEMENTS_MOST 16u
#define PROPERTIES_MOST 48u
#define FACE_MOST 64u

typedef enum form { TEXT, LOW_FIRST, HIGH_FIRST } form;
typedef enum kind { VERTEX, FACE, OTHER } kind;
typedef enum role { X, Y, Z, NX, NY, NZ, RED, GREEN, BLUE, N_VALUES, INDICES = N_VALUES, SKIP, SKIP_LIST } role;
typedef enum type { INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, N_TYPES } type;

typedef struct property {
    uint8_t role, type, count_type; /* of a list: count and its numbers; of SKIP: nothing */
    uint64_t numbers, bytes;        /* SKIP: so many, together so long */
} property;

typedef struct element {
    kind kind;
    uint32_t count, first, n; /* its properties */
    uint32_t roles;           /* a bit for each */
    aset_place place;         /* of its word */
} element;

typedef struct ply {
    aset_model model;
    aset_vertices vertices;
    form form;
    bool lone_cr; /* lines end with CR alone */
    bool normals, vertex_colours, face_colours;
    uint32_t n_elements, n_properties;
    element elements[ELEMENTS_MOST];
    property properties[PROPERTIES_MOST];
    uint32_t done; /* of the element in hand, for errors */
    const element *here;
    uint32_t indices[FACE_MOST];
    uint32_t n_indices;
    aset_corner corners[3]; /* of the fan: first, last but one, last */
    unsigned char batch[ASET_MODEL_BATCH];
} ply;

#define HAS(element, role) (((element)->roles >> (role)&1u) != 0)

/* Indexed by type. */
typedef struct aset_ply_type {
    const char *name, *other_name;
    uint32_t bytes;
    double largest; /* a colour of this is 1 */
} aset_ply_type;
extern const aset_ply_type aset_ply_types[N_TYPES];

/* An error at the current token. */
static inline aset_status ply_fail(ply *file, const char *what, const char *expected) {
    return aset_reader_fail(&file->model.reader, ASET_ERR_SYNTAX, what, expected);
}

/*
 * Reads the header into a file whose model and counts are set up, and moves behind it. Then there are vertices with x, y
 * and z, and behind them faces, more than none, with indices; and if the input's size is known, it may hold them all.
 */
aset_status aset_ply_read_header(ply *file);
#endif

#endif
