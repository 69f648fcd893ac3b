/*
 * flat.c - a stream of entities in, none kept: each object marks the cells that its box touches, or tells them its
 * material.
 *
 * Invariant: which cells an object touches follows from its box and the scene's alone (aset_slices_box), and sums are whole
 * numbers, so what is made depends neither on the order of objects nor on the number of passes.
 */
#include "approx/flat.h"

#include "scene/entity.h"
#include "scene/shape.h"
#include "space/cells.h"

#include <string.h>

#if ASET_WITH_APPROXIMATION

/* Sets what the current material adds to a cell's sum. */
static void set_step(aset_flat *f) {
    uint32_t n = 1;
    f->step[0] = 1;
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        if ((f->differing >> i & 1) != 0) {
            f->step[n++] = f->parts[i];
        }
    }
}

#if ASET_WITH_OBJECTS
/* The material of an object: in which parts does it differ from the first one's? */
static void compare_parts(aset_flat *f) {
    if (f->is_first) {
        memcpy(f->common, f->parts, sizeof f->common);
        f->is_first = false;
    }
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        f->differing |= (unsigned)(f->parts[i] != f->common[i]) << i;
        f->largest_part = f->parts[i] > f->largest_part ? f->parts[i] : f->largest_part;
    }
}

/* The current material's number among those met; flat_several's if there are too many. */
static uint32_t find_number(aset_flat *f) {
    size_t words = f->n_differing;
    for (uint32_t number = 1; number <= f->n_known; number++) {
        if (memcmp(flat_known(f, number), f->step + 1, words * sizeof *f->step) == 0) {
            return number;
        }
    }
    if (f->n_known == f->known_max) {
        return flat_several(f);
    }
    memcpy(flat_known(f, ++f->n_known), f->step + 1, words * sizeof *f->step);
    return f->n_known;
}

/* Cells of one block get the current material's number, or are of several. */
static void number_block(void *context, uint32_t block, uint64_t marks) {
    aset_flat *f = context;
    const aset_cells *cells = &f->space.cells;
    uint32_t rank = cells_rank(cells, block);
    if (rank == NO_CELL) {
        return; /* another source than before: that is told when the pass ends */
    }
    uint64_t all = cells->marks[rank];
    for (marks &= all; marks != 0; marks &= marks - 1) {
        uint32_t cell = cells->first[rank] + bits_count(all & ((marks & (~marks + 1)) - 1));
        uint32_t number = bits_get(f->wide, f->wide_width, cell);
        if (number != f->number) {
            bits_put(f->wide, f->wide_width, cell, number == 0 ? f->number : flat_several(f));
        }
    }
}

/* The sum of a cell of several materials: its number among those in hand. */
static uint64_t *sum_of(const aset_flat *f, uint32_t cell) {
    uint32_t number = f->before[(cell - f->from_cell) / FLAT_GROUP];
    for (uint32_t i = cell - (cell - f->from_cell) % FLAT_GROUP; i < cell; i++) {
        number += bits_get(f->wide, f->wide_width, i) == flat_several(f);
    }
    return flat_sum(f, number);
}

/* Adds the current material to those cells of one block that are of several and in hand. */
static void add_block(void *context, uint32_t block, uint64_t marks) {
    aset_flat *f = context;
    const aset_cells *cells = &f->space.cells;
    uint32_t rank = cells_rank(cells, block);
    if (rank == NO_CELL || cells->first[rank] >= f->until_cell || (uint64_t)cells->first[rank] + 64 <= f->from_cell) {
        return;
    }
    uint64_t all = cells->marks[rank];
    for (marks &= all; marks != 0; marks &= marks - 1) {
        uint32_t cell = cells->first[rank] + bits_count(all & ((marks & (~marks + 1)) - 1));
        if (cell < f->from_cell || cell >= f->until_cell || bits_get(f->wide, f->wide_width, cell) != flat_several(f)) {
            continue;
        }
        uint64_t *sum = sum_of(f, cell);
        f->has_added = true;
        for (uint32_t i = 0; i < f->sum_words; i++) {
            sum[i] += f->step[i];
        }
    }
}

/* Did the object before say the same? Small neighbours do, and marks and numbers are not changed by saying it again. */
static bool is_repeated(aset_flat *f, const voxel_box *box) {
    bool same = f->has_last && memcmp(f->last, box, sizeof f->last) == 0 && f->last_number == f->number;
    memcpy(f->last, box, sizeof f->last);
    f->last_number = f->number;
    f->has_last = true;
    return same;
}

/* An object that the counter has taken, by its bounds as a scene computes them: in its own lengths. */
static aset_status take_object(aset_flat *f, aset_vec3 low, aset_vec3 high) {
    aset_cells *cells = &f->space.cells;
    voxel_box box = aset_slices_box(&f->space.slices, &f->stage, low, high);
    if (f->phase == FLAT_NUMBERS && f->number == 0) {
        f->number = find_number(f);
    }
    bool repeated = is_repeated(f, &box);
    switch (f->phase) {
    case FLAT_BLOCKS:
        f->space.structure.references += aset_cells_references(&box, cells->faces);
        if (!repeated) {
            aset_cells_mark_blocks(cells, &box);
        }
        return ASET_OK;
    case FLAT_MARKS:
        compare_parts(f);
        if (!repeated) {
            aset_cells_mark(cells, &box);
        }
        return ASET_OK;
    case FLAT_NUMBERS:
        if (!repeated) {
            aset_cells_each_block(cells, &box, number_block, f);
        }
        return ASET_OK;
    case FLAT_SUMS:
        if (!repeated || f->has_added) {
            f->has_added = false;
            aset_cells_each_block(cells, &box, add_block, f);
        }
        return ASET_OK;
    default: return ASET_ERR_ARGUMENT;
    }
}
#endif

/* --- the sink --- */

static aset_status take_background(void *context, const aset_colour *colour) {
    aset_flat *f = context;
    return f->stage_sink.background(&f->stage, colour);
}

static aset_status take_view(void *context, const aset_view *view) {
    aset_flat *f = context;
    return f->stage_sink.view(&f->stage, view);
}

static aset_status take_light(void *context, const aset_light *light) {
    aset_flat *f = context;
    aset_status status = f->checks.light(&f->counter, light);
    if (status != ASET_OK || f->passes > 0) {
        return status;
    }
    return f->stage.counts.lights < f->counts.lights ? f->stage_sink.light(&f->stage, light) : ASET_ERR_GEOMETRY;
}

static aset_status take_material(void *context, const aset_material *material) {
    aset_flat *f = context;
    aset_status status = f->checks.material(&f->counter, material);
    if (status == ASET_OK) {
        texture_sum sum;
        memset(&sum, 0, sizeof sum);
        aset_texture_sum_add(&sum, material);
        memcpy(f->parts, sum.parts, sizeof f->parts);
        set_step(f);
        f->number = 0;
    }
    return status;
}

#if ASET_WITH_POLYGONS
static aset_status take_polygon_begin(void *context, uint32_t n_points, bool with_normals) {
    aset_flat *f = context;
    return f->checks.polygon_begin(&f->counter, n_points, with_normals);
}

static aset_status take_polygon_point(void *context, const aset_vec3 *point, const aset_vec3 *normal) {
    aset_flat *f = context;
    return f->checks.polygon_point(&f->counter, point, normal);
}

static aset_status take_polygon_end(void *context) {
    aset_flat *f = context;
    aset_status status = f->checks.polygon_end(&f->counter);
    const aset_outline *outline = &f->counter.outline;
    return status == ASET_OK ? take_object(f, scene_point(&f->stage, outline->low), scene_point(&f->stage, outline->high)) : status;
}
#endif

#if ASET_WITH_SPHERES || ASET_WITH_CONES
/* n coordinates in the scene's own lengths. */
static void scale_whole(const aset_flat *f, aset_real *at, int n) {
    for (int i = 0; i < n; i++) {
        at[i] *= f->stage.scale;
    }
}
#endif

#if ASET_WITH_SPHERES
static aset_status take_sphere(void *context, const aset_vec3 *centre, aset_real radius) {
    aset_flat *f = context;
    aset_real at[ASET_COORDINATES_SPHERE];
    aset_vec3 low, high;
    aset_status status = f->checks.sphere(&f->counter, centre, radius);
    if (status != ASET_OK) {
        return status;
    }
    (void)aset_entity_sphere(at, &low, &high, centre, radius);
    scale_whole(f, at, ASET_COORDINATES_SPHERE);
    aset_sphere_bounds(at, &low, &high);
    return take_object(f, low, high);
}
#endif

#if ASET_WITH_CONES
static aset_status take_cone(void *context, const aset_vec3 *base, aset_real base_radius, const aset_vec3 *apex,
                             aset_real apex_radius) {
    aset_flat *f = context;
    aset_real at[ASET_COORDINATES_CONE];
    aset_vec3 low, high;
    aset_status status = f->checks.cone(&f->counter, base, base_radius, apex, apex_radius);
    if (status != ASET_OK) {
        return status;
    }
    (void)aset_entity_cone(at, &low, &high, base, base_radius, apex, apex_radius);
    scale_whole(f, at, ASET_COORDINATES_CONE);
    aset_cone_bounds(at, &low, &high);
    return take_object(f, low, high);
}
#endif

aset_sink aset_flat_sink(aset_flat *flat) {
    aset_sink sink;
    sink.context = flat;
    sink.background = take_background;
    sink.view = take_view;
    sink.light = take_light;
    sink.material = take_material;
#if ASET_WITH_POLYGONS
    sink.polygon_begin = take_polygon_begin;
    sink.polygon_point = take_polygon_point;
    sink.polygon_end = take_polygon_end;
#endif
#if ASET_WITH_SPHERES
    sink.sphere = take_sphere;
#endif
#if ASET_WITH_CONES
    sink.cone = take_cone;
#endif
    return sink;
}

#endif
