/*
 * vertices.c - the vertices of a model, in the caller's block or behind it in a spill file.
 *
 *     in memory   [ list 0 ->            free            <- list 1 ]     record i of list 1 is the i-th from the end
 *     spilled     [ slots ][ page of slot 0 ][ page of slot 1 ] ...      a window over the spill file
 *
 * In the spill file page k of list l stands at page number k * n_lists + l, so both lists grow without end. A page may be
 * in the slots of one set only, number of the page modulo the sets, and there the one used least recently makes room: a
 * look-up compares at most WAYS numbers. Only records that were added are ever written, and only these are read back.
 */
#include "vertices.h"

#include <string.h>

#if ASET_WITH_POLYGONS

#define WAYS 8u
#define PAGE_MOST 4096u
#define PAGE_LEAST 256u

/* At the front of the block, aligned. */
typedef struct slot {
    uint32_t page; /* number of the page in the spill file + 1; 0: none */
    uint32_t used; /* the clock at its last use */
    uint32_t changed;
} slot;

void aset_vertices_init(aset_vertices *vertices, const aset_vertex_store *store, uint32_t reals, uint32_t n_lists) {
    memset(vertices, 0, sizeof *vertices);
    if (store != NULL && store->block != NULL) {
        vertices->store = *store;
    }
    vertices->record = reals * (uint32_t)sizeof(aset_real);
    vertices->n_lists = n_lists;
}

uint64_t aset_vertices_capacity(const aset_vertices *vertices) {
    return vertices->store.size / vertices->record;
}

bool aset_vertices_can_spill(const aset_vertices *vertices) {
    const aset_vertex_store *store = &vertices->store;
    return store->read != NULL && store->write != NULL && store->size >= ASET_BYTES_WINDOW;
}

/* ---- the window ---- */

static slot *slots_of(const aset_vertices *vertices) {
    unsigned char *block = vertices->store.block;
    const size_t past = (size_t)((uintptr_t)block % sizeof(uint32_t));
    return (slot *)(void *)(block + (past == 0 ? 0 : sizeof(uint32_t) - past));
}

static size_t page_bytes(const aset_vertices *vertices) {
    return (size_t)vertices->per_page * vertices->record;
}

/* Where a page stands in the spill file, and how many bytes of it are records. */
static uint64_t page_offset(const aset_vertices *vertices, uint32_t page) {
    return (uint64_t)page * page_bytes(vertices);
}

static size_t page_filled(const aset_vertices *vertices, uint32_t page) {
    const uint32_t count = vertices->count[page % vertices->n_lists];
    const uint64_t first = (uint64_t)(page / vertices->n_lists) * vertices->per_page;
    if (first >= count) {
        return 0;
    }
    return (count - first < vertices->per_page ? (size_t)(count - first) : vertices->per_page) * vertices->record;
}

/* Writes a list out of the block of memory, where its records stand in order from first on. */
static bool write_list(aset_vertices *vertices, uint32_t list, const unsigned char *first) {
    for (uint32_t page = list;; page += vertices->n_lists) {
        const size_t size = page_filled(vertices, page);
        if (size == 0) {
            return true;
        }
        if (!vertices->store.write(vertices->store.context, page_offset(vertices, page), first, size)) {
            return false;
        }
        first += size;
    }
}

static void reverse(unsigned char *records, uint32_t count, uint32_t size) {
    unsigned char kept[9 * sizeof(aset_real)]; /* point, normal and colour: no record is larger */
    for (uint32_t i = 0; i < count / 2; i++) {
        unsigned char *low = records + (size_t)i * size, *high = records + (size_t)(count - 1 - i) * size;
        memcpy(kept, low, size);
        memcpy(low, high, size);
        memcpy(high, kept, size);
    }
}

/*
 * Sets up the slots for a block of ASET_BYTES_WINDOW or more: pages are as large as leaves a full set of them, if possible.
 */
static void plan_window(aset_vertices *vertices) {
    const size_t size = vertices->store.size - sizeof(uint32_t);
    size_t page = PAGE_MOST;
    while (page > PAGE_LEAST && size / (page + sizeof(slot)) < WAYS) {
        page /= 2;
    }
    vertices->per_page = (uint32_t)(page / vertices->record);
    const size_t n = size / (page_bytes(vertices) + sizeof(slot));
    vertices->n_slots = n > UINT32_MAX ? UINT32_MAX : (uint32_t)n;
    vertices->n_sets = vertices->n_slots < WAYS ? 1 : vertices->n_slots / WAYS;
}

static bool spill(aset_vertices *vertices) {
    unsigned char *block = vertices->store.block;
    const uint32_t n_1 = vertices->count[1];
    unsigned char *list_1 = block + vertices->store.size - (size_t)n_1 * vertices->record;
    plan_window(vertices);
    reverse(list_1, n_1, vertices->record);
    if (!write_list(vertices, 0, block) || (vertices->n_lists == 2 && !write_list(vertices, 1, list_1))) {
        return false;
    }
    memset(slots_of(vertices), 0, vertices->n_slots * sizeof(slot));
    vertices->pages = (unsigned char *)(slots_of(vertices) + vertices->n_slots);
    vertices->spilled = true;
    return true;
}

/* The slot of a set that has the page, or the one to give to it. */
static uint32_t choose_slot(const aset_vertices *vertices, uint32_t page) {
    const slot *slots = slots_of(vertices);
    const uint32_t ways = vertices->n_slots < WAYS ? vertices->n_slots : WAYS;
    const uint32_t first = page % vertices->n_sets * ways;
    uint32_t oldest = first;
    for (uint32_t i = first; i < first + ways; i++) {
        if (slots[i].page == page + 1) {
            return i;
        }
        oldest = slots[i].used < slots[oldest].used ? i : oldest;
    }
    return oldest;
}

/* Has the page in a slot. False: a callback failed. */
static bool turn_to(aset_vertices *vertices, uint32_t page, uint32_t *number) {
    slot *slots = slots_of(vertices);
    uint32_t *recent = &vertices->recent[page % vertices->n_lists];
    if (slots[*recent].page != page + 1) {
        *recent = choose_slot(vertices, page);
    }
    slot *here = &slots[*recent];
    unsigned char *bytes = vertices->pages + *recent * page_bytes(vertices);
    const aset_vertex_store *store = &vertices->store;
    if (here->page != page + 1) {
        const uint32_t old = here->page - 1;
        if (here->changed != 0 &&
            !store->write(store->context, page_offset(vertices, old), bytes, page_filled(vertices, old))) {
            return false;
        }
        here->page = here->changed = 0;
        const size_t size = page_filled(vertices, page);
        if (size > 0 && !store->read(store->context, page_offset(vertices, page), bytes, size)) {
            return false;
        }
        here->page = page + 1;
    }
    here->used = ++vertices->clock;
    *number = *recent;
    return true;
}

/* A record's bytes in the window; NULL: a callback failed. */
static unsigned char *record_in_window(aset_vertices *vertices, uint32_t list, uint32_t index, bool change) {
    uint32_t number;
    if (!turn_to(vertices, index / vertices->per_page * vertices->n_lists + list, &number)) {
        return NULL;
    }
    if (change) {
        slots_of(vertices)[number].changed = 1;
    }
    return vertices->pages + number * page_bytes(vertices) + (size_t)(index % vertices->per_page) * vertices->record;
}

/* ---- records ---- */

static unsigned char *record_in_memory(const aset_vertices *vertices, uint32_t list, uint32_t index) {
    unsigned char *block = vertices->store.block;
    const size_t at = (size_t)index * vertices->record;
    return list == 0 ? block + at : block + vertices->store.size - at - vertices->record;
}

aset_status aset_vertices_add(aset_vertices *vertices, uint32_t list, const aset_real *record) {
    const uint32_t index = vertices->count[list];
    if (index == UINT32_MAX) {
        return ASET_ERR_LIMIT;
    }
    const uint64_t held = (uint64_t)vertices->count[0] + vertices->count[1];
    if (!vertices->spilled && held >= aset_vertices_capacity(vertices)) {
        if (!aset_vertices_can_spill(vertices)) {
            return ASET_ERR_NOMEM;
        }
        if (!spill(vertices)) {
            return ASET_ERR_READ;
        }
    }
    unsigned char *to =
        vertices->spilled ? record_in_window(vertices, list, index, true) : record_in_memory(vertices, list, index);
    if (to == NULL) {
        return ASET_ERR_READ;
    }
    memcpy(to, record, vertices->record);
    vertices->count[list]++;
    return ASET_OK;
}

aset_status aset_vertices_get(aset_vertices *vertices, uint32_t list, uint32_t index, aset_real *record) {
    const unsigned char *from =
        vertices->spilled ? record_in_window(vertices, list, index, false) : record_in_memory(vertices, list, index);
    if (from == NULL) {
        return ASET_ERR_READ;
    }
    memcpy(record, from, vertices->record);
    return ASET_OK;
}

#endif
