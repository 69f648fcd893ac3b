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
    sink = aset_counter_sink(&m->counter);
    (void)aset_scene_emit(&sink, &m->scene); /* what a scene has taken a counter takes */
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

bool tool_streams(const aset_method *method, uint32_t approx_kinds, uint32_t approx_depth) {
    return approx_kinds == ASET_ALL_KINDS && approx_depth == 0 && (method == &aset_mset || method == &aset_grid);
}

/* Makes the flat one in size bytes. On ASET_ERR_NOMEM *size is enough for the next try; on ASET_OK it is the least. */
static aset_status try_flat(const measured *m, const aset_method *method, const aset_space_options *options, size_t *size) {
    aset_arena arena;
    aset_flat flat;
    bool again = true;
    void *block = malloc(*size);
    aset_status status = block != NULL ? aset_arena_init(&arena, block, *size) : ASET_ERR_LIMIT;
    if (status == ASET_OK) {
        status = aset_flat_init(&flat, &arena, &m->counter, method, options);
    }
    while (status == ASET_OK && again) {
        aset_sink sink = aset_flat_sink(&flat);
        status = aset_scene_emit(&sink, &m->scene);
        status = status == ASET_OK ? aset_flat_pass(&flat, &again) : status;
    }
    *size = status == ASET_OK ? flat.least : status == ASET_ERR_NOMEM ? *size + arena.missing : *size;
    free(block);
    return status;
}

bool measured_flat(const measured *m, const char *path, const aset_method *method, const aset_space_options *options,
                   size_t *bytes) {
    aset_space_options chosen = *options;
    aset_status status = ASET_ERR_NOMEM;
    if (chosen.divisions[0] == 0) {
        aset_auto_divisions(&m->scene, 0, chosen.divisions);
    }
    *bytes = *bytes > 0 ? *bytes : SCRATCH;
    while (status == ASET_ERR_NOMEM) {
        status = try_flat(m, method, &chosen, bytes);
    }
    if (status != ASET_OK) {
        tool_error(path, 0, "%s: %s", aset_method_name(method),
                   status == ASET_ERR_LIMIT ? "the machine has no memory to measure its cells" : aset_status_text(status));
    }
    return status == ASET_OK;
}
