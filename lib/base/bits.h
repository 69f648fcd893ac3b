/* bits.h - counting bits, and arrays of whole numbers of any width from 1 to 32 bits. */
#ifndef ASET_BASE_BITS_H
#define ASET_BASE_BITS_H

#include <stddef.h>
#include <stdint.h>

/*
 * How many bits are set. The compiler's own way only where it is one instruction: else it would call its run-time library.
 */
static inline unsigned bits_count(uint64_t x) {
#if defined(__GNUC__) && (defined(__POPCNT__) || defined(__aarch64__))
    return (unsigned)__builtin_popcountll(x);
#elif UINTPTR_MAX <= UINT32_MAX
    /* half by half: numbers of 64 bits take two registers and many instructions here */
    uint32_t low = (uint32_t)x, high = (uint32_t)(x >> 32);
    low -= low >> 1 & UINT32_C(0x55555555);
    high -= high >> 1 & UINT32_C(0x55555555);
    low = (low & UINT32_C(0x33333333)) + (low >> 2 & UINT32_C(0x33333333)); /* up to 4 in each 4 bits */
    high = (high & UINT32_C(0x33333333)) + (high >> 2 & UINT32_C(0x33333333));
    low = (low & UINT32_C(0x0f0f0f0f)) + (low >> 4 & UINT32_C(0x0f0f0f0f)) + (high & UINT32_C(0x0f0f0f0f)) +
          (high >> 4 & UINT32_C(0x0f0f0f0f));
    return low * UINT32_C(0x01010101) >> 24;
#else
    x = x - ((x >> 1) & UINT64_C(0x5555555555555555));
    x = (x & UINT64_C(0x3333333333333333)) + ((x >> 2) & UINT64_C(0x3333333333333333));
    x = (x + (x >> 4)) & UINT64_C(0x0f0f0f0f0f0f0f0f);
    return (unsigned)((x * UINT64_C(0x0101010101010101)) >> 56);
#endif
}

/* The number of the lowest set bit; x is not 0. */
static inline unsigned bits_lowest(uint64_t x) {
#if defined(__GNUC__) && (defined(__x86_64__) || defined(__aarch64__))
    return (unsigned)__builtin_ctzll(x);
#else
    return bits_count((x & (~x + 1)) - 1);
#endif
}

/* The bits that hold every number from 0 to largest: 1 to 32. */
static inline unsigned bits_width(uint32_t largest) {
    unsigned width = 1;
    while (width < 32 && largest >> width != 0) {
        width++;
    }
    return width;
}

/* Number index of an array of numbers of width bits, which may lie across two words. */
static inline uint32_t bits_get(const uint64_t *words, unsigned width, size_t index) {
    size_t bit = index * width;
    unsigned shift = (unsigned)(bit & 63);
    uint64_t value = words[bit >> 6] >> shift;
    if (shift + width > 64) {
        value |= words[(bit >> 6) + 1] << (64 - shift);
    }
    return (uint32_t)(value & ((UINT64_C(1) << width) - 1));
}

/* By masks, not as a change of what is there: that may be memory nobody has set. */
static inline void bits_put(uint64_t *words, unsigned width, size_t index, uint32_t value) {
    size_t bit = index * width;
    unsigned shift = (unsigned)(bit & 63);
    uint64_t mask = (UINT64_C(1) << width) - 1;
    uint64_t *word = words + (bit >> 6);
    word[0] = (word[0] & ~(mask << shift)) | (uint64_t)value << shift;
    if (shift + width > 64) {
        unsigned done = 64 - shift;
        word[1] = (word[1] & ~(mask >> done)) | (uint64_t)value >> done;
    }
}

#endif
