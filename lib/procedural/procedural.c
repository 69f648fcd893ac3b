/*
 * procedural.c - the table of procedural scenes, made from the one list in emit.h.
 */
#include "emit.h"

#include <string.h>

static const aset_procedural scenes[] = {
#define ROW(id, name, default_size, largest_size, text) {name, text, default_size, largest_size, aset_procedural_##id},
    ASET_PROCEDURAL_SCENES(ROW)
#undef ROW
};

enum { n_scenes = sizeof scenes / sizeof scenes[0] };

const aset_procedural *aset_procedural_at(size_t index) {
    return index < n_scenes ? &scenes[index] : NULL;
}

const aset_procedural *aset_procedural_find(const char *name) {
    for (size_t i = 0; i < n_scenes && name != NULL; i++) {
        if (strcmp(scenes[i].name, name) == 0) {
            return &scenes[i];
        }
    }
    return NULL;
}
