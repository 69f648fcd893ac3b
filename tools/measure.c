/* measure.c - what a scene and a method need, found out in memory of its own: for error lines and `aset info`. */
#include "prepare.h"

#include <stdlib.h>
#include <string.h>

/*
 * Scratch for counting: the more, the fewer passes over the objects; trees list what they divide, on every level at the
 * most.
 */
#define SCRATCH (4u << 20)
#define SCRATCH_OBJECT (sizeof(aset_box) + 4u * (3u * ASET_DEPTH_TREE_MAX + 1u))

bool measured_open(measured *m, tool_source *source, const aset_counts *counts) {
    m->scene_bytes = ASET_BYTES_SCENE(counts->objects, counts->coordinates, counts->materials, counts->lights);
    size_t size = m->scene_bytes + SCRATCH + counts->objects * SCRATCH_OBJECT;
    m->block = malloc(size);
    if (m->block == NULL || aset_arena_init(&m->arena, m->block, size) != ASET_OK ||
        aset_scene_init(&m->scene, &m->arena, counts) != ASET_OK) {
        tool_error(source->path, 0, "the machine has no memory for the scene's %zu bytes", m->scene_bytes);
        free(m->block);
        return false;
    }
    aset_sink sink = aset_scene_sink(&m->scene);
    if (!tool_source_read(source, &sink)) {
        free(m->block);
        return false;
    }
    return true;
}

static size_t counts_scratch(const measured *m) {
    return m->scene.counts.objects * SCRATCH_OBJECT;
}

/* The summary's bytes, from a space built for it. */
static bool measure_summary(measured *m, const aset_method *method, const aset_space_options *options,
                            const aset_space_size *size, size_t *bytes) {
    size_t bound = size->total + counts_scratch(m) + ASET_BYTES_SUMMARY(size->n_cells, aset_summary_capacity(&m->scene));
    void *block = malloc(bound);
    aset_arena arena;
    aset_space space;
    bool done = block != NULL && aset_arena_init(&arena, block, bound) == ASET_OK &&
                aset_space_build(&space, &m->scene, method, options, &arena) == ASET_OK &&
                aset_summary_measure(bytes, &space, 0, &arena) == ASET_OK;
    free(block);
    return done;
}

bool measured_space(measured *m, const char *path, const aset_method *method, const aset_space_options *options,
                    aset_space_size *size, size_t *summary_bytes) {
    aset_space_options chosen = *options;
    if (chosen.divisions[0] == 0) {
        aset_auto_divisions(&m->scene, 0, chosen.divisions);
    }
    aset_status status = aset_space_measure(size, &m->scene, method, &chosen, &m->arena);
    if (status != ASET_OK) {
        tool_error(path, 0, "%s: %s", aset_method_name(method),
                   status == ASET_ERR_LIMIT ? "these divisions give more cells than can be counted, expected fewer"
                                            : aset_status_text(status));
        return false;
    }
    if (summary_bytes != NULL && !measure_summary(m, method, &chosen, size, summary_bytes)) {
        tool_error(path, 0, "%s: the machine has no memory to measure %zu bytes", aset_method_name(method), size->total);
        return false;
    }
    return true;
}
