/*
 * vertices.h - the vertices of a model, numbered from 0: in the caller's block, or behind it in a spill file. Private to
 * lib/load.
 */
#ifndef ASET_LOAD_VERTICES_H
#define ASET_LOAD_VERTICES_H

#include "aset/load.h"

/* Two lists of records of the same size: points, and normals that have numbers of their own. */
typedef struct aset_vertices {
    aset_vertex_store store;
    uint32_t record;   /* bytes of a record */
    uint32_t n_lists;  /* 1 or 2 */
    uint32_t count[2]; /* records in each list */
    bool spilled;
    uint32_t per_page, n_slots, n_sets, clock; /* of the window, when spilled */
    uint32_t recent[2];                        /* the slot used last for each list */
    unsigned char *pages;                      /* of slot 0 */
} aset_vertices;

/* store may be NULL. Records of so many reals. */
void aset_vertices_init(aset_vertices *vertices, const aset_vertex_store *store, uint32_t reals, uint32_t n_lists);

/* Records that the block holds, both lists together. */
uint64_t aset_vertices_capacity(const aset_vertices *vertices);

/* Whether there is a limit: aset_vertices_capacity. */
bool aset_vertices_can_spill(const aset_vertices *vertices);

/* Adds a record to a list. ASET_ERR_NOMEM; ASET_ERR_LIMIT beyond 2^32 - 1; ASET_ERR_READ: a callback failed. */
aset_status aset_vertices_add(aset_vertices *vertices, uint32_t list, const aset_real *record);

/* Copies record number index, which must be there, to record. ASET_ERR_READ: a callback failed. */
aset_status aset_vertices_get(aset_vertices *vertices, uint32_t list, uint32_t index, aset_real *record);

#endif
