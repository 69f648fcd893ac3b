/*
 * flat_pass.c - what happens between the passes of the flat way: where each pass puts what it finds, and what to do when
 * there is no room.
 *
 * The map of blocks is the divisions'. All else is taken only when its size is known: marks when the blocks are counted,
 * numbers when the cells are, sums when it is known which cells have objects of several materials. Sums are made for as many
 * cells at a time as there is room for, in the order of dense numbers, which is the order of the texture list: so the list
 * is the same whatever that number is. A cell's texture is known at once, but not how many bits its number will take; it
 * stands in the bits that the longest possible list would need until the last cell has its own.
 */
#include "approx/flat.h"

#include "approx/summary.h"
#include "base/whole.h"
#include "scene/shape.h"
#include "space/cells.h"

#include <string.h>

#if ASET_WITH_APPROXIMATION

/* Readings for sums, at most. */
#define SUM_PASSES 8u

static size_t left_of(const aset_flat *f) {
    size_t left = f->arena->size - f->arena->used;
    return left > f->options.reserve ? left - f->options.reserve : 0;
}

/* Is there room for so many bytes? The most that is ever asked for is the least that is enough. */
static bool fits(aset_flat *f, size_t bytes) {
    size_t more = whole_bytes_sum(bytes, f->options.reserve), total = whole_bytes_sum(f->arena->used - f->mark.used, more);
    f->least = total > f->least ? total : f->least;
    return aset_arena_fits(f->arena, more);
}

/* The first pass: over divisions whose map fits. */
static aset_status begin_blocks(aset_flat *f) {
    const uint32_t *n = f->options.divisions;
    uint32_t faces = f->space.method->faces;
    f->least = 0;
    while (!fits(f, whole_bytes(ASET_BYTES_CELLS(n[0], n[1], n[2], faces, 0)))) {
        f->least = 0;
        if (!f->is_auto || !aset_slices_coarsen(f->options.divisions, false)) {
            return ASET_ERR_NOMEM;
        }
    }
    memset(&f->space.structure, 0, sizeof f->space.structure);
    aset_slices_make(&f->space.slices, &f->stage, n);
    aset_cells_take_map(&f->space.cells, &f->space.slices, faces, f->arena);
    f->space.structure.leaves = aset_cells_in_all(n, faces);
    f->phase = FLAT_BLOCKS;
    return ASET_OK;
}

/* No room for need bytes: once more with coarser divisions if they are ours to choose. */
static aset_status begin_again(aset_flat *f, size_t need) {
    size_t whole = whole_bytes_sum(f->arena->used - f->stage_mark.used, need);
    aset_arena_release(f->arena, &f->stage_mark);
    if (!f->is_auto || !aset_slices_coarsen(f->options.divisions, whole / 8 > left_of(f))) {
        return ASET_ERR_NOMEM;
    }
    return begin_blocks(f);
}

static aset_status end_blocks(aset_flat *f) {
    aset_cells_rank_blocks(&f->space.cells);
    size_t need = whole_bytes(ASET_ROUND_64(12 * (uint64_t)f->space.cells.n_blocks));
    if (!fits(f, need)) {
        return begin_again(f, need);
    }
    aset_cells_take_marks(&f->space.cells, f->arena);
    f->is_first = true;
    f->differing = 0;
    f->largest_part = 0;
    f->phase = FLAT_MARKS;
    return ASET_OK;
}

/* The numbers, in place, in the bits that the list needs, which are no more; the list behind them. */
static void pack(aset_flat *f) {
    aset_summary *summary = &f->summary;
    uint32_t n_cells = f->space.cells.n_cells;
    const aset_material *list = summary->textures;
    size_t list_bytes = summary->n_textures * sizeof *list;
    summary->width = summary->n_textures > 1 ? bits_width(summary->n_textures - 1) : 1;
    f->arena->used = f->work_mark.used; /* not aset_arena_release: what is given back is read still */
    memcpy(f->arena->used_by, f->work_mark.used_by, sizeof f->arena->used_by);
    size_t bytes = (size_t)ASET_BYTES_PACKED(n_cells, summary->width);
    summary->of_cell = aset_arena_alloc(f->arena, bytes, ASET_CATEGORY_TEXTURES);
    for (uint32_t i = 0; i < n_cells; i++) {
        bits_put(summary->of_cell, summary->width, i, bits_get(f->wide, f->wide_width, i));
    }
    unsigned over = (unsigned)((uint64_t)n_cells * summary->width & 63);
    if (over > 0) {
        summary->of_cell[bytes / 8 - 1] &= (UINT64_C(1) << over) - 1;
    }
    summary->textures = aset_arena_alloc(f->arena, list_bytes, ASET_CATEGORY_TEXTURES);
    if (list_bytes > 0) {
        memmove(summary->textures, list, list_bytes);
    }
    f->phase = FLAT_DONE;
}

/* Every object looks alike: one texture, whose number is 0 in every cell as in cleared memory. */
static void pack_one(aset_flat *f) {
    texture_sum sum;
    memcpy(sum.parts, f->common, sizeof sum.parts);
    sum.n = 1;
    aset_material texture = aset_texture_average(&sum);
    f->summary.textures = &texture;
    f->summary.n_textures = 1;
    pack(f);
}

/* Words for every cell, and the materials met. False: there is no room; then *need is what they take. */
static bool take_numbers(aset_flat *f, size_t *need) {
    uint32_t n_cells = f->space.cells.n_cells, most = f->summary.capacity < n_cells ? f->summary.capacity : n_cells;
    bool single = f->n_differing == 0;
    f->known_max = single ? 0 : f->counts.materials < FLAT_KNOWN_MAX ? f->counts.materials : FLAT_KNOWN_MAX;
    f->wide_width = single ? 1 : bits_width(most - 1 > flat_several(f) ? most - 1 : flat_several(f));
    size_t known = (size_t)f->known_max * f->n_differing * sizeof *f->known;
    size_t wide = (size_t)ASET_BYTES_PACKED(n_cells, f->wide_width);
    *need = wide + (single ? ASET_ROUND(sizeof(aset_material)) : known);
    if (!fits(f, *need)) {
        return false;
    }
    f->wide = aset_arena_alloc(f->arena, wide, ASET_CATEGORY_SCRATCH);
    f->known = aset_arena_alloc(f->arena, known, ASET_CATEGORY_SCRATCH);
    memset(f->wide, 0, wide);
    f->n_known = 0;
    return true;
}

static aset_status end_marks(aset_flat *f) {
    size_t need;
    if (!aset_cells_rank_marks(&f->space.cells) ||
        (f->counts.objects > 0 && f->largest_part >= whole_quotient(UINT64_MAX, f->counts.objects))) {
        return ASET_ERR_LIMIT;
    }
    f->work_mark = aset_arena_mark(f->arena);
    f->summary.n_textures = f->summary.merged = 0;
    if (f->space.cells.n_cells == 0) {
        pack(f);
        return ASET_OK;
    }
    f->n_differing = bits_count(f->differing);
    f->sum_words = f->n_differing + 1;
    if (!take_numbers(f, &need)) {
        return begin_again(f, need);
    }
    if (f->n_differing == 0) {
        pack_one(f);
    } else {
        f->phase = FLAT_NUMBERS;
    }
    return ASET_OK;
}

/* The cells from until_cell on whose sums there is room for; where their sums are. */
static void begin_sums(aset_flat *f) {
    uint32_t cell = f->from_cell = f->until_cell, n = 0;
    for (; cell < f->space.cells.n_cells; cell++) {
        bool several = bits_get(f->wide, f->wide_width, cell) == flat_several(f);
        if (several && n == f->sums_max) {
            break;
        }
        if (f->n_mixed > 0 && (cell - f->from_cell) % FLAT_GROUP == 0) {
            f->before[(cell - f->from_cell) / FLAT_GROUP] = n;
        }
        n += several;
    }
    f->until_cell = cell;
    memset(f->sums, 0, (size_t)n * f->sum_words * sizeof *f->sums);
}

/* The parts of a number of objects, of which those that differ are given. */
static texture_sum whole_sum(const aset_flat *f, uint32_t n, const uint64_t *differing) {
    texture_sum sum;
    sum.n = n;
    for (int i = 0; i < TEXTURE_PARTS; i++) {
        sum.parts[i] = (f->differing >> i & 1) != 0 ? *differing++ : f->common[i] * n;
    }
    return sum;
}

/* Textures for the cells in hand. */
static aset_status settle(aset_flat *f) {
    texture_recent recent;
    uint32_t n = 0;
    memset(&recent, 0, sizeof recent);
    for (uint32_t cell = f->from_cell; cell < f->until_cell; cell++) {
        uint32_t number = bits_get(f->wide, f->wide_width, cell);
        const uint64_t *words = number == flat_several(f) ? flat_sum(f, n++) : NULL;
        if (number == 0 || (words != NULL && words[0] == 0)) {
            return ASET_ERR_GEOMETRY; /* the object that marked it is not there any more */
        }
        texture_sum sum = words != NULL ? whole_sum(f, (uint32_t)words[0], words + 1)
                                        : whole_sum(f, 1, flat_known(f, number));
        bits_put(f->wide, f->wide_width, cell, aset_texture_take(&f->summary, &recent, &sum));
    }
    return ASET_OK;
}

/* Room for the list of textures and for sums of some cells. False: there is none; then *need is what they take. */
static bool take_sums(aset_flat *f, size_t *need) {
    uint32_t n = f->n_mixed, least = n / SUM_PASSES + 64 < n ? n / SUM_PASSES + 64 : n, capacity = f->summary.capacity;
    uint64_t most = (uint64_t)f->n_known + n;
    size_t list = ASET_ROUND((most < capacity ? most : capacity) * sizeof *f->summary.textures);
    size_t before = n > 0 ? ASET_ROUND((f->space.cells.n_cells + FLAT_GROUP - 1) / FLAT_GROUP * sizeof *f->before) : 0;
    size_t per_cell = f->sum_words * sizeof *f->sums;
    *need = whole_bytes((uint64_t)list + before + (uint64_t)least * per_cell);
    if (!fits(f, *need)) {
        return false;
    }
    size_t room = (left_of(f) - list - before) / per_cell;
    f->sums_max = room < n ? (uint32_t)room : n;
    f->summary.textures = aset_arena_alloc(f->arena, list, ASET_CATEGORY_SCRATCH);
    f->before = aset_arena_alloc(f->arena, before, ASET_CATEGORY_SCRATCH);
    f->sums = aset_arena_alloc(f->arena, f->sums_max * per_cell, ASET_CATEGORY_SCRATCH);
    return true;
}

static aset_status end_numbers(aset_flat *f) {
    size_t need;
    f->n_mixed = 0;
    for (uint32_t cell = 0; cell < f->space.cells.n_cells; cell++) {
        f->n_mixed += bits_get(f->wide, f->wide_width, cell) == flat_several(f);
    }
    if (!take_sums(f, &need)) {
        return begin_again(f, need);
    }
    f->until_cell = 0;
    begin_sums(f);
    f->phase = FLAT_SUMS;
    if (f->n_mixed > 0) {
        return ASET_OK;
    }
    aset_status status = settle(f);
    pack(f);
    return status;
}

static aset_status end_sums(aset_flat *f) {
    aset_status status = settle(f);
    if (status == ASET_OK && f->until_cell < f->space.cells.n_cells) {
        begin_sums(f);
    } else if (status == ASET_OK) {
        pack(f);
    }
    return status;
}

/* Did the pass bring what the counter was told? */
static bool same_source(const aset_flat *f) {
    const aset_counts *a = &f->counts, *b = &f->counter.counts;
    bool same = a->objects == b->objects && a->coordinates == b->coordinates && a->lights == b->lights;
    return same && (a->objects == 0 || (vec_largest(vec_sub(f->low, f->counter.low)) == 0 &&
                                        vec_largest(vec_sub(f->high, f->counter.high)) == 0));
}

aset_status aset_flat_pass(aset_flat *flat, bool *again) {
    aset_status status = ASET_ERR_ARGUMENT;
    if (flat == NULL || again == NULL) {
        return status;
    }
    *again = false;
    if (flat->phase == FLAT_DONE || flat->phase == FLAT_FAILED) {
        return status; /* whatever it had is no longer ours to release */
    }
    static aset_status (*const ends[])(aset_flat *) = {end_blocks, end_marks, end_numbers, end_sums};
    flat->passes++;
    status = same_source(flat) ? ends[flat->phase](flat) : ASET_ERR_GEOMETRY;
    flat->checks = aset_counter_sink(&flat->counter);
    flat->has_last = false;
    flat->number = 0;
    if (status != ASET_OK) {
        aset_arena_release(flat->arena, &flat->mark);
        flat->phase = FLAT_FAILED;
    }
    *again = status == ASET_OK && flat->phase != FLAT_DONE;
    return status;
}

/* Divisions and capacity, checked; automatic ones are filled in. */
static aset_status choose(aset_flat *f) {
    uint32_t *n = f->options.divisions;
    f->is_auto = n[0] == 0 && n[1] == 0 && n[2] == 0;
    if (f->is_auto) {
        aset_slices_auto_divisions(&f->stage, f->counts.objects, left_of(f), n);
    }
    for (int a = 0; a < 3; a++) {
        if (n[a] < 1 || n[a] > ASET_DIVISIONS_MAX) {
            return ASET_ERR_ARGUMENT;
        }
    }
    f->summary.capacity = f->options.textures > 0 ? f->options.textures : aset_summary_capacity_for(f->counts.materials);
    return f->summary.capacity <= ASET_TEXTURES_MAX ? ASET_OK : ASET_ERR_ARGUMENT;
}

aset_status aset_flat_init(aset_flat *flat, aset_arena *arena, const aset_counter *counter, const aset_method *method,
                           const aset_space_options *options) {
    if (flat == NULL || arena == NULL || counter == NULL || method == NULL || method->faces == 0) {
        return ASET_ERR_ARGUMENT;
    }
    aset_counts limits;
    memset(&limits, 0, sizeof limits);
    limits.lights = counter->counts.lights;
    memset(flat, 0, sizeof *flat);
    flat->counts = counter->counts;
    flat->low = counter->low;
    flat->high = counter->high;
    flat->arena = arena;
    flat->mark = aset_arena_mark(arena);
    flat->phase = FLAT_FAILED;
    if (options != NULL) {
        flat->options = *options;
    }
    aset_status status = aset_scene_init(&flat->stage, arena, &limits);
    if (status != ASET_OK) {
        return status;
    }
    if (flat->counts.objects > 0) { /* in its own lengths, as a scene has them */
        aset_real scale = aset_scene_scale_for(flat->low, flat->high);
        flat->stage.scale = scale;
        flat->stage.low = vec_scale(flat->low, scale);
        flat->stage.high = vec_scale(flat->high, scale);
        flat->stage.margin = aset_object_margin(flat->stage.low, flat->stage.high);
    }
    flat->stage_mark = aset_arena_mark(arena);
    flat->stage_sink = aset_scene_sink(&flat->stage);
    flat->checks = aset_counter_sink(&flat->counter);
    flat->space.method = method;
    flat->space.is_flat = true;
    status = aset_slices_precise(&flat->stage) ? choose(flat) : ASET_ERR_PRECISION;
    status = status == ASET_OK ? begin_blocks(flat) : status;
    if (status != ASET_OK) {
        aset_arena_release(arena, &flat->mark);
    }
    return status;
}

aset_status aset_flat_finish(aset_scene *stage, aset_space *space, aset_summary *summary, aset_flat *flat) {
    if (stage == NULL || space == NULL || summary == NULL || flat == NULL || flat->phase != FLAT_DONE) {
        return ASET_ERR_ARGUMENT;
    }
    *stage = flat->stage;
    *space = flat->space;
    *summary = flat->summary;
    space->scene = stage;
    space->structure.nonempty = space->cells.n_cells;
    summary->space = space;
    summary->answers = &aset_summary_answers;
    flat->phase = FLAT_FAILED; /* of whatever still comes */
    return ASET_OK;
}

#endif
