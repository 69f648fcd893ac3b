/*
 * bins.c - the bins of a bake (baker.h): found by hashing, and thrown away from the top when they are too many.
 *
 * There are bins for the blocks between floor and ceiling only, in the order in which blocks lie in the map. When the bins are full, the
 * ceiling comes down and those above it go; what was below has missed nothing, so the pass goes on, and the next one begins at
 * the ceiling. Collisions take the next free slot, so an emptied slot makes all bins behind it in its run be placed anew.
 */
#include "approx/baker.h"

#if ASET_WITH_DRAFTS

/* No bin is where it was. */
static void forget_recent(aset_baker *b) {
    memset(b->recent_keys, 0xff, sizeof b->recent_keys); /* BIN_EMPTY, which no sample asks for */
}

void aset_bins_clear(aset_baker *b) {
    memset(b->keys, 0xff, b->capacity * sizeof *b->keys); /* BIN_EMPTY */
    b->n_bins = 0;
    forget_recent(b);
}

/* The block that a key's voxel is in. */
static uint32_t block_of(const aset_baker *b, uint32_t key) {
    uint32_t voxel = key / 6;
    return baker_block_at(b, voxel % b->n[0], voxel / b->n[0] % b->n[1], voxel / b->n[0] / b->n[1]);
}

/* Puts a bin where its key's search finds it: at or before its place, all before which is in order. */
static void settle_bin(aset_baker *b, uint32_t slot) {
    uint32_t key = b->keys[slot];
    b->keys[slot] = BIN_EMPTY;
    uint32_t to = baker_slot(b, key);
    b->keys[to] = key;
    if (to != slot) {
        memcpy(baker_bin(b, to), baker_bin(b, slot), b->bin_bytes);
    }
}

/* After some were emptied: every search must find its key again. start: was empty before that, too, so no run of bins crosses it. */
static void settle_bins(aset_baker *b, uint32_t start) {
    for (uint32_t i = 1; i < b->capacity; i++) {
        uint32_t slot = start + i < b->capacity ? start + i : start + i - b->capacity;
        if (b->keys[slot] != BIN_EMPTY) {
            settle_bin(b, slot);
        }
    }
}

/* Parts in which blocks are counted to find a ceiling. */
#define PARTS 256u

/*
 * The highest ceiling below which no more than half of the bins are, and these: found by counting the bins in equal parts of the
 * blocks in question, then in parts of the part where half is passed. One block at least. *empty: a slot that holds no bin.
 */
static uint32_t find_ceiling(const aset_baker *b, uint32_t *kept, uint32_t *empty) {
    uint32_t low = b->floor_block, high = b->ceiling_block, below = 0; /* bins below low */
    for (;;) {
        uint32_t in_part[PARTS] = {0}, size = (high - low + PARTS - 1) / PARTS, part = 0;
        for (uint32_t i = 0; i < b->capacity; i++) {
            if (b->keys[i] == BIN_EMPTY) {
                *empty = i;
                continue;
            }
            uint32_t block = block_of(b, b->keys[i]);
            if (block >= low && block < high) {
                in_part[(block - low) / size]++;
            }
        }
        while (low + size <= high && below + in_part[part] <= b->capacity / 2) {
            below += in_part[part++];
            low += size;
        }
        if (size == 1) {
            bool is_first = low == b->floor_block; /* one block is more than half: it alone, then */
            *kept = below + (is_first ? in_part[part] : 0);
            return low + is_first;
        }
        high = low + size < high ? low + size : high;
    }
}

/* Lowers the ceiling until half of the bins are free. False: one block alone is too much. */
static bool lower_ceiling(aset_baker *b) {
    uint32_t empty = 0, kept = 0, low = find_ceiling(b, &kept, &empty);
    if (low >= b->ceiling_block || kept + 1 >= b->capacity - b->capacity / 8) {
        return false;
    }
    b->ceiling_block = low;
    for (uint32_t i = 0; i < b->capacity; i++) {
        if (b->keys[i] != BIN_EMPTY && block_of(b, b->keys[i]) >= low) {
            b->keys[i] = BIN_EMPTY;
        }
    }
    settle_bins(b, empty);
    forget_recent(b);
    b->n_bins = kept;
    memset(b->marks + low, 0, (baker_blocks(b) - low) * sizeof *b->marks);
    return true;
}

bin *aset_bins_find(aset_baker *b, uint32_t key) {
    uint32_t slot = baker_slot(b, key);
    if (b->keys[slot] == key) {
        return baker_bin(b, slot);
    }
    if (b->n_bins >= b->capacity - b->capacity / 8) {
        if (!lower_ceiling(b)) {
            b->failure = ASET_ERR_NOMEM;
            return NULL;
        }
        if (block_of(b, key) >= b->ceiling_block) {
            return NULL;
        }
        slot = baker_slot(b, key);
    }
    bin *it = baker_bin(b, slot);
    memset(it, 0, b->bin_bytes);
    b->keys[slot] = key;
    b->n_bins++;
    uint32_t voxel = key / 6, x = voxel % b->n[0], y = voxel / b->n[0] % b->n[1], z = voxel / b->n[0] / b->n[1];
    b->marks[baker_block_at(b, x, y, z)] |= UINT64_C(1) << (x % 4 + 4 * (y % 4) + 16 * (z % 4));
    return it;
}

#endif
