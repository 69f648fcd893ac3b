/* mtl.h - the named materials of an OBJ's libraries, a bounded number of them kept. Private to lib/load. */
#ifndef ASET_LOAD_MTL_H
#define ASET_LOAD_MTL_H

#include "aset/load.h"

#define ASET_MTL_OWN 8u
/* Bytes of the names of libraries, and of one name of a library or material with its closing 0. */
#define ASET_MTL_NAMES 500u
#define ASET_MTL_NAME 256u

typedef struct aset_mtl {
    const aset_library *library; /* NULL: none */
    aset_material fallback;      /* gives what a material does not say */
    aset_named_material *kept;
    uint32_t n_kept, clock;
    uint32_t names_used;
    char names[ASET_MTL_NAMES]; /* of the libraries, each with its closing 0, in the file's order */
    aset_named_material own[ASET_MTL_OWN];
} aset_mtl;

void aset_mtl_init(aset_mtl *mtl, const aset_load_options *options, const aset_material *fallback);

/* Adds a library by what stands behind "mtllib": one name, or several if that is the name of none. False: too many names. */
bool aset_mtl_add_library(aset_mtl *mtl, const char *names);

/*
 * Finds a material in the libraries added so far. *found is false if it is in none. On an error of a library the report
 * tells its name and place; else it is left alone.
 */
aset_status aset_mtl_find(aset_mtl *mtl, const char *name, aset_material *material, bool *found, aset_load_report *report);

#endif
