/*
 * cells.c - building marks and references in their final place.
 *
 * The build takes no byte beyond the result: blocks are counted before (measure), marks are set in place, and the references
 * of each cell are first counted in the array that will hold the object numbers (a count never exceeds the number of
 * objects, so it fits), then laid out as start bits, then filled in. The numbers in a cell ascend: objects come in order.
 * Cost: four passes over the objects' boxes, each proportional to the references.
 */
#include "space/cells.h"

#include "base/whole.h"

#include <string.h>

/* The first and last block that a box of voxels touches, as bricks. */
static void bricks_of(const voxel_box *box, uint32_t low[3], uint32_t high[3]) {
    for (int a = 0; a < 3; a++) {
        low[a] = (uint32_t)box->low[a] / 4;
        high[a] = (uint32_t)box->high[a] / 4;
    }
}

/* The bits of one axis' voxels of a brick that lie between low and high, as numbers 0 to 3. */
static void clip(int32_t low, int32_t high, uint32_t brick, unsigned *from, unsigned *to) {
    int32_t base = (int32_t)(brick * 4);
    *from = low > base ? (unsigned)(low - base) : 0;
    *to = high < base + 3 ? (unsigned)(high - base) : 3;
}

/* The marks that a box sets in one brick: a box of bits. */
static uint64_t brick_marks(const voxel_box *box, uint32_t x, uint32_t y, uint32_t z) {
    unsigned x0, x1, y0, y1, z0, z1;
    clip(box->low[0], box->high[0], x, &x0, &x1);
    clip(box->low[1], box->high[1], y, &y0, &y1);
    clip(box->low[2], box->high[2], z, &z0, &z1);
    uint64_t row = ((UINT64_C(2) << x1) - (UINT64_C(1) << x0)) & 15, layer = 0, marks = 0;
    for (unsigned i = y0; i <= y1; i++) {
        layer |= row << (4 * i);
    }
    for (unsigned i = z0; i <= z1; i++) {
        marks |= layer << (16 * i);
    }
    return marks;
}

static void each_block(const uint32_t bricks[3], uint32_t faces, const voxel_box *box, uint32_t face, cells_action act,
                       void *context) {
    uint32_t low[3], high[3];
    bricks_of(box, low, high);
    for (uint32_t z = low[2]; z <= high[2]; z++) {
        for (uint32_t y = low[1]; y <= high[1]; y++) {
            for (uint32_t x = low[0]; x <= high[0]; x++) {
                uint32_t brick = (z * bricks[1] + y) * bricks[0] + x;
                act(context, brick * faces + face, brick_marks(box, x, y, z));
            }
        }
    }
}

/* The same for every block of every layer of an object's box, of what lies from z_low to z_high. */
static void each_object_block(const uint32_t bricks[3], uint32_t faces, const voxel_box *box, int32_t z_low, int32_t z_high,
                              cells_action act, void *context) {
    for (uint32_t face = 0; face < faces; face++) {
        voxel_box part = faces == 1 ? *box : cells_face_box(box, face);
        part.low[2] = part.low[2] > z_low ? part.low[2] : z_low;
        part.high[2] = part.high[2] < z_high ? part.high[2] : z_high;
        if (part.low[2] <= part.high[2]) {
            each_block(bricks, faces, &part, face, act, context);
        }
    }
}

void aset_cells_each_block(const aset_cells *cells, const voxel_box *box, cells_action act, void *context) {
    each_object_block(cells->bricks, cells->faces, box, 0, INT32_MAX, act, context);
}

uint64_t aset_cells_in_all(const uint32_t n[3], uint32_t faces) {
    uint64_t x = n[0], y = n[1], z = n[2];
    return faces == 1 ? x * y * z : 2 * ((x + 1) * y * z + (y + 1) * x * z + (z + 1) * x * y);
}

uint64_t aset_cells_references(const voxel_box *box, uint32_t faces) {
    uint64_t n[3];
    for (int a = 0; a < 3; a++) {
        n[a] = (uint64_t)(box->high[a] - box->low[a] + 1);
    }
    return faces == 1 ? n[0] * n[1] * n[2] : 2 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]);
}

typedef struct chunk {
    uint64_t *marks;
    uint32_t base, n; /* blocks base to base + n - 1 */
} chunk;

static void mark_chunk(void *context, uint32_t block, uint64_t marks) {
    chunk *c = context;
    if (block - c->base < c->n) {
        c->marks[block - c->base] |= marks;
    }
}

/* Does any block of the box lie in the chunk? Blocks ascend with the brick, so the box's corners bound them. */
static bool chunk_touched(const chunk *c, const uint32_t bricks[3], uint32_t faces, const voxel_box *box) {
    uint32_t low[3], high[3];
    bricks_of(box, low, high);
    uint32_t from = ((low[2] * bricks[1] + low[1]) * bricks[0] + low[0]) * faces;
    uint32_t to = ((high[2] * bricks[1] + high[1]) * bricks[0] + high[0]) * faces + faces - 1;
    return from <= c->base + (c->n - 1) && to >= c->base;
}

static void count_bricks(const aset_slices *slices, uint32_t bricks[3]) {
    for (int a = 0; a < 3; a++) {
        bricks[a] = (slices->n[a] + 3) / 4;
    }
}

aset_status aset_cells_measure(const aset_scene *scene, const aset_slices *slices, uint32_t faces, uint64_t *scratch,
                               size_t scratch_bytes, aset_space_size *size) {
    uint32_t bricks[3];
    uint64_t references = 0, n_blocks = 0, n_cells = 0;
    count_bricks(slices, bricks);
    for (uint32_t i = 0; i < scene->counts.objects; i++) {
        voxel_box box = aset_slices_object_box(slices, scene, i);
        references += aset_cells_references(&box, faces);
    }
    uint64_t all = (uint64_t)bricks[0] * bricks[1] * bricks[2] * faces;
    if (all > UINT32_MAX - 64 || references > UINT32_MAX - 2) {
        return ASET_ERR_LIMIT;
    }
    chunk c = {scratch, 0, 0};
    uint64_t at_once = scratch_bytes / 8;
    for (uint64_t base = 0; base < all && scene->counts.objects > 0; base += c.n) {
        c.base = (uint32_t)base;
        c.n = (uint32_t)(all - base < at_once ? all - base : at_once);
        memset(scratch, 0, (size_t)c.n * 8);
        uint32_t layer = bricks[0] * bricks[1] * faces;
        int32_t z_low = (int32_t)(c.base / layer * 4), z_high = (int32_t)((c.base + (c.n - 1)) / layer * 4 + 3);
        for (uint32_t i = 0; i < scene->counts.objects; i++) {
            voxel_box box = aset_slices_object_box(slices, scene, i);
            if (chunk_touched(&c, bricks, faces, &box)) {
                each_object_block(bricks, faces, &box, z_low, z_high, mark_chunk, &c);
            }
        }
        for (uint32_t k = 0; k < c.n; k++) {
            n_blocks += scratch[k] != 0;
            n_cells += bits_count(scratch[k]);
        }
    }
    size->n_blocks = (uint32_t)n_blocks;
    size->n_cells = (uint32_t)n_cells;
    size->n_references = (uint32_t)references;
    size->cells = whole_bytes(ASET_BYTES_CELLS(slices->n[0], slices->n[1], slices->n[2], faces, n_blocks));
    size->references = whole_bytes(ASET_BYTES_REFERENCES(n_blocks, references, scene->counts.objects));
    return ASET_OK;
}

/* --- marks --- */

static size_t map_words(const aset_cells *cells) {
    return ((size_t)cells->bricks[0] * cells->bricks[1] * cells->bricks[2] * cells->faces + 63) / 64;
}

void aset_cells_take_map(aset_cells *cells, const aset_slices *slices, uint32_t faces, aset_arena *arena) {
    count_bricks(slices, cells->bricks);
    cells->faces = faces;
    size_t words = map_words(cells);
    cells->map = aset_arena_alloc(arena, 12 * words, ASET_CATEGORY_CELLS);
    cells->map_rank = (uint32_t *)(void *)(cells->map + words);
    memset(cells->map, 0, 8 * words);
}

static void mark_map(void *context, uint32_t block, uint64_t marks) {
    aset_cells *cells = context;
    (void)marks;
    cells->map[block >> 6] |= UINT64_C(1) << (block & 63);
}

void aset_cells_mark_blocks(aset_cells *cells, const voxel_box *box) {
    aset_cells_each_block(cells, box, mark_map, cells);
}

void aset_cells_rank_blocks(aset_cells *cells) {
    size_t words = map_words(cells);
    uint32_t n = 0;
    for (size_t i = 0; i < words; i++) {
        cells->map_rank[i] = n;
        n += bits_count(cells->map[i]);
    }
    cells->n_blocks = n;
}

void aset_cells_take_marks(aset_cells *cells, aset_arena *arena) {
    size_t n = cells->n_blocks;
    cells->marks = aset_arena_alloc(arena, 12 * n, ASET_CATEGORY_CELLS);
    cells->first = (uint32_t *)(void *)(cells->marks + n);
    memset(cells->marks, 0, 8 * n);
}

static void mark_cells(void *context, uint32_t block, uint64_t marks) {
    aset_cells *cells = context;
    uint32_t rank = cells_rank(cells, block);
    if (rank != NO_CELL) {
        cells->marks[rank] |= marks;
    }
}

void aset_cells_mark(aset_cells *cells, const voxel_box *box) {
    aset_cells_each_block(cells, box, mark_cells, cells);
}

bool aset_cells_rank_marks(aset_cells *cells) {
    uint64_t n = 0;
    for (uint32_t i = 0; i < cells->n_blocks; i++) {
        cells->first[i] = (uint32_t)n;
        n += bits_count(cells->marks[i]);
    }
    cells->n_cells = (uint32_t)n;
    return n <= UINT32_MAX - 2;
}

/* --- references --- */

typedef struct build {
    aset_cells *cells;
    aset_references *references;
    uint32_t object;
} build;

static void count_references(void *context, uint32_t block, uint64_t marks) {
    build *b = context;
    aset_references *refs = b->references;
    uint32_t rank = cells_rank(b->cells, block);
    for (; marks != 0; marks &= marks - 1) {
        uint64_t below = (marks & (~marks + 1)) - 1;
        uint32_t cell = b->cells->first[rank] + bits_count(b->cells->marks[rank] & below);
        bits_put(refs->objects, refs->width, cell, bits_get(refs->objects, refs->width, cell) + 1);
    }
}

/* The first reference behind the cell that begins at from. */
static uint32_t references_end(const aset_references *refs, uint32_t from) {
    uint32_t at = from + 1;
    while (at < refs->n) {
        uint64_t starts = refs->starts[at >> 6] >> (at & 63);
        if (starts != 0) {
            return at + bits_lowest(starts);
        }
        at = (at | 63) + 1;
    }
    return refs->n;
}

/* Puts the object into the first free place of each cell; places fill from the front, so halving finds it. */
static void place_references(void *context, uint32_t block, uint64_t marks) {
    build *b = context;
    aset_references *refs = b->references;
    const uint32_t free_place = (uint32_t)((UINT64_C(1) << refs->width) - 1);
    uint32_t rank = cells_rank(b->cells, block);
    for (; marks != 0; marks &= marks - 1) {
        uint32_t low = references_begin(refs, rank, b->cells->marks[rank], bits_lowest(marks));
        uint32_t high = references_end(refs, low) - 1;
        while (low < high) {
            uint32_t middle = low + (high - low) / 2;
            if (bits_get(refs->objects, refs->width, middle) == free_place) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        bits_put(refs->objects, refs->width, low, b->object);
    }
}

/* Counts, which stand where the object numbers will be, become start bits; then every place is free. */
static void lay_out(const aset_cells *cells, aset_references *refs) {
    uint32_t at = 0, cell = 0;
    memset(refs->starts, 0, (size_t)ASET_BYTES_PACKED(refs->n, 1));
    for (uint32_t i = 0; i < cells->n_blocks; i++) {
        refs->first[i] = at;
        for (unsigned k = bits_count(cells->marks[i]); k > 0; k--) {
            refs->starts[at >> 6] |= UINT64_C(1) << (at & 63);
            at += bits_get(refs->objects, refs->width, cell++);
        }
    }
    memset(refs->objects, 0xff, (size_t)ASET_BYTES_PACKED(refs->n, refs->width));
}

/* A pass over all boxes. */
static void each_box(build *b, const aset_scene *scene, const aset_slices *slices, cells_action act, void *context) {
    for (b->object = 0; b->object < scene->counts.objects; b->object++) {
        voxel_box box = aset_slices_object_box(slices, scene, b->object);
        aset_cells_each_block(b->cells, &box, act, context);
    }
}

void aset_cells_build(aset_cells *cells, aset_references *references, const aset_scene *scene, const aset_slices *slices,
                      const aset_space_size *size, uint32_t faces, aset_arena *arena) {
    build b = {cells, references, 0};
    aset_cells_take_map(cells, slices, faces, arena);
    each_box(&b, scene, slices, mark_map, cells);
    aset_cells_rank_blocks(cells);
    aset_cells_take_marks(cells, arena);
    each_box(&b, scene, slices, mark_cells, cells);
    (void)aset_cells_rank_marks(cells); /* no more cells than references, which measure has bounded */

    references->n = size->n_references;
    references->width = bits_width(scene->counts.objects);
    references->first = aset_arena_alloc(arena, 4 * (size_t)cells->n_blocks, ASET_CATEGORY_REFERENCES);
    references->starts = aset_arena_alloc(arena, (size_t)ASET_BYTES_PACKED(references->n, 1), ASET_CATEGORY_REFERENCES);
    size_t bytes = (size_t)ASET_BYTES_PACKED(references->n, references->width);
    references->objects = aset_arena_alloc(arena, bytes, ASET_CATEGORY_REFERENCES);
    memset(references->objects, 0, bytes);
    each_box(&b, scene, slices, count_references, &b);
    lay_out(cells, references);
    each_box(&b, scene, slices, place_references, &b);
}

void aset_cells_each(const aset_references *references, cell_look look, void *context) {
    uint32_t cell = 0;
    for (uint32_t at = 0; at < references->n; at++) {
        uint32_t object = bits_get(references->objects, references->width, at);
        cell += at > 0 && references_ended(references, at);
        look(context, cell, &object, 1);
    }
}
