/*
 * whole.h - whole numbers of 64 bits: bytes that may be more than a size_t holds, and dividing. Processors of 32 bits have the compiler's library do it, by a function of 0.7 kB for
 * any two numbers; here most divisors are small.
 */
#ifndef ASET_BASE_WHOLE_H
#define ASET_BASE_WHOLE_H

#include <stddef.h>
#include <stdint.h>

/* So many bytes that no arena has them, and still a multiple of its alignment. */
#define WHOLE_MOST (SIZE_MAX / 8 * 8)

/* Bytes as a size: WHOLE_MOST where a size_t does not hold them. */
static inline size_t whole_bytes(uint64_t bytes) {
    return bytes < WHOLE_MOST ? (size_t)bytes : WHOLE_MOST;
}

/* The same of two sizes together. */
static inline size_t whole_bytes_sum(size_t a, size_t b) {
    return b < WHOLE_MOST && a <= WHOLE_MOST - b ? a + b : WHOLE_MOST;
}

/* a / b, and what is left of a; b is neither 0 nor above 2^63. */
#if UINTPTR_MAX <= UINT32_MAX
uint64_t aset_whole_divide(uint64_t a, uint64_t b, uint64_t *rest);
#else
static inline uint64_t aset_whole_divide(uint64_t a, uint64_t b, uint64_t *rest) {
    *rest = a % b;
    return a / b;
}
#endif

static inline uint64_t whole_quotient(uint64_t a, uint64_t b) {
    uint64_t rest;
    return aset_whole_divide(a, b, &rest);
}

#endif
