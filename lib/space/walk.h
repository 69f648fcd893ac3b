/*
 * walk.h - the one thing every space does: give the non-empty cells along a ray, in order.
 *
 * A walk visits each cell with its dense number, the references met there for the first time by this ray, t of entry and the
 * face of entry. What is done with them is the visitor's affair: the exact visitor tests the references, the approximate
 * one reads the cell's summary. The visitor answers with the t beyond which nothing interests it any more; the walk ends
 * when the next cell begins behind that.
 */
#ifndef ASET_SPACE_WALK_H
#define ASET_SPACE_WALK_H

#include "aset/space.h"
#include "scene/shape.h"

/* Objects handed to the visitor at once; a cell with more comes in several visits. */
#define WALK_BATCH 16

#define NO_CELL UINT32_MAX

/* The face of objects that are met before any cell: the origin lies in their boxes. Never in an approximate walk. */
#define FACE_NONE (-1)

typedef struct walk_cell {
    uint32_t index;  /* dense number of the cell; NO_CELL with FACE_NONE */
    int face;        /* axis * 2, + 1 if the ray goes down that axis; FACE_NONE */
    aset_real t;     /* of entry; may be negative in an exact walk that starts inside */
    uint32_t n;      /* object numbers; 0 unless the walk wants references */
    uint32_t objects[WALK_BATCH];
} walk_cell;

typedef struct walk_request {
    aset_real (*visit)(struct walk_request *walk, const walk_cell *cell); /* the new limit; -REAL_INFINITY ends the walk */
    aset_real limit;      /* the walk ends when the next cell begins behind it */
    bool wants_references; /* false: cells entered at t > 0 only, and no object numbers */
    uint64_t cells, nonempty; /* visited; added once when the walk ends */
} walk_request;

/* A sequential look at one cell: called once or more for a cell, in ascending order of cells. */
typedef void (*cell_look)(void *context, uint32_t cell, const uint32_t *objects, uint32_t n);

struct aset_method {
    const char *name;
    bool by_depth; /* sized by depth and leaf (trees), not by divisions */
    uint32_t faces; /* cells a voxel, if marks on equal slices are all that a walk without references looks at; else 0 */
    /*
     * size->divisions or depth and leaf are given; fills the rest. scratch as in aset_space_measure, never NULL.
     * ASET_ERR_NOMEM: the scratch is too small; size->scratch bytes would do.
     */
    aset_status (*measure)(aset_space_size *size, const aset_scene *scene, uint64_t *scratch, size_t scratch_bytes);
    /* the arena holds size->total bytes; scene, method and divisions are set in space */
    void (*build)(aset_space *space, const aset_space_size *size, aset_arena *arena);
    void (*go)(const aset_space *space, const probe *ray, walk_request *walk);
    void (*each_cell)(const aset_space *space, cell_look look, void *context);
};

#endif
