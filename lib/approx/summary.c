/*
 * summary.c - one texture for each non-empty cell, made through the space's own listing of its cells: no space knows of it.
 *
 * Two passes over the cells: the first makes the list of textures, in the arena's free bytes where it will stay, and so
 * tells how many bits the number of a texture takes; the second writes each cell's number. Cells are looked at in the order
 * of their dense numbers, after averaging, so the list is the same whatever the order in which the objects were added.
 */
#include "approx/summary.h"

#include "approx/texture.h"
#include "scene/entity.h"
#include "space/walk.h"

#include <string.h>

#if ASET_WITH_APPROXIMATION

#define AUTO_TEXTURES_MIN 16u
#define AUTO_TEXTURES_MAX 4096u
#define AUTO_TEXTURES_PER_MATERIAL 32u

uint32_t aset_summary_capacity_for(uint32_t n_materials) {
    uint32_t capacity = AUTO_TEXTURES_MIN;
    while (capacity < AUTO_TEXTURES_MAX && capacity / AUTO_TEXTURES_PER_MATERIAL < n_materials) {
        capacity *= 2;
    }
    return capacity;
}

uint32_t aset_summary_capacity(const aset_scene *scene) {
    return aset_summary_capacity_for(scene->counts.materials);
}

typedef struct filling {
    aset_summary *summary;
    bool numbers; /* the second pass */
    bool overflow; /* the first pass met more textures than there is room for, but not more than asked for */
    bool too_many; /* objects in a cell: their parts' sum may have left its bits */
    uint32_t room;
    texture_sum sum;
    uint32_t cell; /* the cell that sum belongs to */
    texture_recent recent;
} filling;

/* The first pass: the list grows until it is full. */
static void enter_texture(filling *f) {
    aset_summary *summary = f->summary;
    unsigned slot = aset_texture_slot(&f->sum);
    aset_material texture = aset_texture_average(&f->sum);
    uint32_t number;
    if (f->recent.known[slot] && entity_same_look(&texture, &f->recent.textures[slot])) {
        return;
    }
    f->recent.textures[slot] = texture;
    f->recent.known[slot] = true;
    if (aset_texture_find(summary, &texture, &number) || summary->n_textures == summary->capacity) {
        return;
    }
    if (summary->n_textures == f->room) {
        f->overflow = true;
        return;
    }
    summary->textures[summary->n_textures++] = texture;
}

static void finish_cell(filling *f) {
    if (f->sum.n == 0) {
        return;
    }
    f->too_many = f->too_many || f->sum.n > TEXTURE_OBJECTS_MAX;
    if (f->numbers) { /* none is entered any more: those that are not in the list did not fit */
        bits_put(f->summary->of_cell, f->summary->width, f->cell, aset_texture_take(f->summary, &f->recent, &f->sum));
    } else {
        enter_texture(f);
    }
    memset(&f->sum, 0, sizeof f->sum);
}

static void look_at_cell(void *context, uint32_t cell, const uint32_t *objects, uint32_t n) {
    filling *f = context;
    if (cell != f->cell) {
        finish_cell(f);
        f->cell = cell;
    }
    for (uint32_t i = 0; i < n; i++) {
        aset_texture_sum_add(&f->sum, shape_of(f->summary->space->scene, objects[i]).material);
    }
}

static aset_status pass(aset_summary *summary, bool numbers, uint32_t room) {
    filling f;
    memset(&f, 0, sizeof f);
    f.summary = summary;
    f.numbers = numbers;
    f.room = room;
    summary->space->method->each_cell(summary->space, look_at_cell, &f);
    finish_cell(&f);
    return f.too_many ? ASET_ERR_LIMIT : f.overflow ? ASET_ERR_NOMEM : ASET_OK;
}

/* The first pass, in the arena's free bytes. On ASET_ERR_NOMEM missing is a bound: the list's length is not known then. */
static aset_status list_textures(aset_summary *summary, const aset_space *space, uint32_t capacity, aset_arena *arena,
                                 size_t *bytes) {
    if (summary == NULL || space == NULL || arena == NULL || space->is_flat || capacity > ASET_TEXTURES_MAX) {
        return ASET_ERR_ARGUMENT;
    }
    size_t left = arena->size - arena->used, room = left / sizeof *summary->textures;
    memset(summary, 0, sizeof *summary);
    summary->space = space;
    summary->answers = &aset_summary_answers;
    summary->capacity = capacity > 0 ? capacity : aset_summary_capacity(space->scene);
    summary->textures = arena->block != NULL ? (aset_material *)(void *)(arena->block + arena->used) : NULL;
    *bytes = ASET_BYTES_SUMMARY(space->cells.n_cells, summary->capacity);
    aset_status status = pass(summary, false, room < UINT32_MAX ? (uint32_t)room : UINT32_MAX);
    if (status == ASET_ERR_NOMEM) {
        arena->missing = *bytes - left;
    }
    if (status != ASET_OK) {
        return status;
    }
    summary->width = summary->n_textures > 1 ? bits_width(summary->n_textures - 1) : 1;
    *bytes = ASET_ROUND(summary->n_textures * sizeof *summary->textures) +
             (size_t)ASET_BYTES_PACKED(space->cells.n_cells, summary->width);
    return ASET_OK;
}

aset_status aset_summary_measure(size_t *bytes, const aset_space *space, uint32_t capacity, aset_arena *arena) {
    aset_summary summary;
    return bytes != NULL ? list_textures(&summary, space, capacity, arena, bytes) : ASET_ERR_ARGUMENT;
}

aset_status aset_summary_build(aset_summary *summary, const aset_space *space, uint32_t capacity, aset_arena *arena) {
    aset_summary made;
    size_t bytes;
    aset_status status = summary != NULL ? list_textures(&made, space, capacity, arena, &bytes) : ASET_ERR_ARGUMENT;
    if (status == ASET_OK && !aset_arena_fits(arena, bytes)) {
        status = ASET_ERR_NOMEM;
    }
    if (status != ASET_OK) {
        return status;
    }
    size_t numbers = (size_t)ASET_BYTES_PACKED(space->cells.n_cells, made.width);
    /* the arena gives the first free bytes, where the list stands already, and does not clear them */
    made.textures = aset_arena_alloc(arena, made.n_textures * sizeof *made.textures, ASET_CATEGORY_TEXTURES);
    made.of_cell = aset_arena_alloc(arena, numbers, ASET_CATEGORY_TEXTURES);
    if (numbers > 0) { /* of an arena without a block there is no address */
        memset(made.of_cell, 0, numbers);
    }
    *summary = made;
    (void)pass(summary, true, 0);
    return ASET_OK;
}

#endif
