/* draft_lanes.h - rays of a beam side by side: a number of each in an array, so that compilers do several at a time. */
#ifndef ASET_APPROX_DRAFT_LANES_H
#define ASET_APPROX_DRAFT_LANES_H

#include "base/vec.h"

/*
 * Rays of a beam: half a voxel's outline in a usual picture. Whether what they meet is lit together, too. Programs that are compiled for
 * size have narrow beams, and hits lit one by one.
 */
#if defined(__OPTIMIZE_SIZE__)
#define DRAFT_BEAM 8
#define DRAFT_SHADES_BEAMS 0
/* Files that were not all compiled so do not link. */
#define aset_draft_beam_start aset_draft_beam_start_8
#define aset_draft_beam_visit aset_draft_beam_visit_8
#else
#define DRAFT_BEAM 16
#define DRAFT_SHADES_BEAMS 1
#endif

/*
 * Work that is compiled twice: a DRAFT_WORK becomes a part of whatever calls it; a DRAFT_WIDE_WORK, which calls it for AVX2, so has it in wide
 * registers, and is called if DRAFT_HAS_WIDE. AVX2 has no fused a * b + c: numbers stay what they are. DRAFT_RARE_WORK: both call the same.
 */
#if ASET_WIDE
#define DRAFT_WORK static inline __attribute__((always_inline))
#define DRAFT_WIDE_WORK __attribute__((target("avx2"), flatten)) static
#define DRAFT_RARE_WORK static __attribute__((noinline))
#define DRAFT_HAS_WIDE (__builtin_cpu_supports("avx2") != 0)
#else
#define DRAFT_WORK static
#define DRAFT_WIDE_WORK static
#define DRAFT_RARE_WORK static
#define DRAFT_HAS_WIDE false
#endif

#define EACH_RAY(i) for (int i = 0; i < DRAFT_BEAM; i++)

/* The vector of ray i, of rays' vectors side by side. */
static inline aset_vec3 draft_lane(aset_real (*v)[DRAFT_BEAM], uint32_t i) {
    return vec(v[0][i], v[1][i], v[2][i]);
}

static inline void draft_set_lane(aset_real (*v)[DRAFT_BEAM], uint32_t i, aset_vec3 a) {
    v[0][i] = a.x;
    v[1][i] = a.y;
    v[2][i] = a.z;
}

/* Lengths of vectors side by side. How many of these are no usual ones. */
static inline int32_t draft_lane_lengths(aset_real *restrict length, aset_real (*restrict v)[DRAFT_BEAM]) {
    aset_real square[DRAFT_BEAM];
    int32_t unusual = 0;
    EACH_RAY(i) {
        square[i] = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
        unusual += !((square[i] > VEC_SQUARE_MIN) & (square[i] < VEC_SQUARE_MAX));
    }
    EACH_RAY(i) {
        length[i] = real_sqrt(square[i]);
    }
    return unusual;
}

/* Divides each by its length. */
static inline void draft_lanes_divide(aset_real (*restrict v)[DRAFT_BEAM], const aset_real *restrict length) {
    EACH_RAY(i) {
        aset_real per_length = 1 / length[i];
        v[0][i] *= per_length;
        v[1][i] *= per_length;
        v[2][i] *= per_length;
    }
}

#endif
