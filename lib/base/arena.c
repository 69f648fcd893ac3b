/*
 * arena.c - a bump allocator on the caller's block.
 *
 * Invariant: used <= size, used is a multiple of ASET_ALIGN and the sum of used_by; nothing is freed but by going back to
 * a mark.
 */
#include "aset/arena.h"
#include "base/real.h"

#include <string.h>

/* In a hostile build nobody finds zeros in new memory, nor what was there before in memory given back. */
static void poison(unsigned char *from, size_t bytes) {
#if ASET_HOSTILE
    if (bytes > 0) {
        memset(from, 0xa5, bytes);
    }
#else
    (void)from, (void)bytes;
#endif
}

aset_status aset_arena_init(aset_arena *arena, void *block, size_t size) {
    if (arena == NULL || (block == NULL && size > 0) || (uintptr_t)block % ASET_ALIGN != 0) {
        return ASET_ERR_ARGUMENT;
    }
    if (!aset_real_is_sound()) {
        return ASET_ERR_ARITHMETIC;
    }
    memset(arena, 0, sizeof *arena);
    arena->block = block;
    arena->size = size;
    poison(block, size);
    return ASET_OK;
}

bool aset_arena_fits(aset_arena *arena, size_t bytes) {
    size_t left = arena->size - arena->used;
    if (bytes <= left) {
        return true;
    }
    arena->missing = bytes - left;
    return false;
}

void *aset_arena_alloc(aset_arena *arena, size_t bytes, aset_category category) {
    size_t rounded = ASET_ROUND(bytes);
    if (rounded < bytes) {
        arena->missing = bytes;
        return NULL;
    }
    if (!aset_arena_fits(arena, rounded)) {
        return NULL;
    }
    void *start = arena->block != NULL ? arena->block + arena->used : NULL; /* no block: no bytes were asked for */
    arena->used += rounded;
    arena->used_by[category] += rounded;
    if (arena->used > arena->peak) {
        arena->peak = arena->used;
    }
    if (arena->used_by[category] > arena->peak_by[category]) {
        arena->peak_by[category] = arena->used_by[category];
    }
    return start;
}

aset_mark aset_arena_mark(const aset_arena *arena) {
    aset_mark mark;
    mark.used = arena->used;
    memcpy(mark.used_by, arena->used_by, sizeof mark.used_by);
    return mark;
}

void aset_arena_release(aset_arena *arena, const aset_mark *mark) {
    if (arena->used > mark->used) {
        poison(arena->block + mark->used, arena->used - mark->used);
    }
    arena->used = mark->used;
    memcpy(arena->used_by, mark->used_by, sizeof arena->used_by);
}

static const char *const category_names[] = {
#define CATEGORY_NAME(upper, lower, text) #lower,
    ASET_CATEGORIES(CATEGORY_NAME)
#undef CATEGORY_NAME
};

static const char *const category_texts[] = {
#define CATEGORY_TEXT(upper, lower, text) text,
    ASET_CATEGORIES(CATEGORY_TEXT)
#undef CATEGORY_TEXT
};

const char *aset_category_name(aset_category category) {
    return (unsigned)category < ASET_CATEGORY_COUNT ? category_names[category] : NULL;
}

const char *aset_category_text(aset_category category) {
    return (unsigned)category < ASET_CATEGORY_COUNT ? category_texts[category] : NULL;
}
