/*
 * facet.h - how a draft lies in its words, and how a facet is read.
 *
 * A voxel is 4 x 4 x 4 columns' sizes large; all lengths here are in columns. A facet stands on one side of a voxel, which is
 * named by the axis a that its surface mostly faces and by the direction (side = 2 a, + 1 if it faces down the axis). Over the two
 * other axes u = a + 1 and v = a + 2 (modulo 3) it is a plane and a footprint:
 *
 *        a ^      ____            w_a = height + slope_u (w_u - 2) + slope_v (w_v - 2)
 *          |  ___/    \___        for w in the voxel, 0 to 4 on each axis;
 *          | /            \       of the 16 columns (w_u, w_v), those whose middle the surface covers
 *          +--|--|--|--|--> u
 *
 * Slopes are within -1 to 1, since a is the axis that the normal (in columns) is longest along.
 *
 *   map, rank      a bit for each block of 4 x 4 x 4 voxels; set bits before each word of it
 *   marks          two words a block that is not empty: a bit for each voxel, the lowest for the lowest (x fastest)
 *   first          of each such block: the number of its first facet
 *   starts         a bit for each facet: is it its voxel's first? One more bit, set, ends them
 *   facets         a number of a surface, a number of a footprint, a height, packed; two words of padding
 *   surfaces       side 3 bits, slopes 5 and 5, texture 19: in ascending order, each once
 *   footprints     16 bits each, in ascending order, each once
 *   textures       8 floats each: fill, Kd, Ks, shine, T, index of refraction
 *   lights, kept   the stage
 */
#ifndef ASET_APPROX_FACET_H
#define ASET_APPROX_FACET_H

#include "aset/draft.h"
#include "base/bits.h"
#include "base/vec.h"
#include "space/answers.h"

#include <string.h>

#if ASET_WITH_DRAFTS

#define FACET_MAGIC 0x41534454u   /* in the other byte order it reads 0x54445341 */
#define FACET_VERSION 1u

enum {
    WORD_MAGIC, WORD_VERSION, WORD_N_WORDS, WORD_CHECK,
    WORD_N, WORD_LOW = WORD_N + 3, WORD_SIZE = WORD_LOW + 3,
    WORD_BLOCKS = WORD_SIZE + 3, WORD_FACETS, WORD_SURFACES, WORD_FOOTPRINTS, WORD_TEXTURES, WORD_LIGHTS, WORD_KEPT,
    WORD_KEPT_WORDS, WORD_HAS_VIEW, WORD_BACKGROUND, WORD_VIEW = WORD_BACKGROUND + 3, WORD_SPARE = WORD_VIEW + 13,
    WORDS_HEADER = 40
};

enum { TEXTURE_WORDS = 8, LIGHT_WORDS = 7, KEPT_HEAD_WORDS = 1 + TEXTURE_WORDS, KEPT_WORDS_MAX = KEPT_HEAD_WORDS + 6 * ASET_KEPT_POINTS_MAX };

#define LIGHT_HAS_COLOUR 1u
#define LIGHT_DIRECTIONAL 2u

/* Height codes cover -1 to 5: a plane may lie a little outside of the voxel that it stands for. */
#define HEIGHT_BITS 5u
#define HEIGHT_LOW R(-1)
#define HEIGHT_STEP (R(6) / (1 << HEIGHT_BITS))
#define SLOPE_BITS 5u
#define SLOPE_MASK ((1u << SLOPE_BITS) - 1)
#define SLOPE_STEPS ((1 << (SLOPE_BITS - 1)) - 1)
#define SURFACE_TEXTURE_SHIFT (3u + 2u * SLOPE_BITS)

typedef struct facet {
    int axis;
    bool down;
    aset_real height, slope_u, slope_v;
    uint32_t texture;
    uint32_t footprint;
} facet;

static inline uint32_t word_of_float(aset_real x) {
#if ASET_REAL_BITS == 64
    float f = x > FLT_MAX ? INFINITY : x < -FLT_MAX ? -INFINITY : (float)x + 0.0f;
#else
    float f = x + 0.0f; /* -0 becomes 0: equal numbers, equal words */
#endif
    uint32_t word;
    memcpy(&word, &f, sizeof word);
    return word;
}

static inline aset_real float_of_word(uint32_t word) {
    float f;
    memcpy(&f, &word, sizeof f);
    return (aset_real)f;
}

/* The bits of record number index: width of them, fewer than 64. */
static inline uint64_t words_get(const uint32_t *words, unsigned width, size_t index) {
    size_t bit = index * width;
    unsigned shift = (unsigned)(bit & 31u);
    const uint32_t *w = words + (bit >> 5);
    uint64_t value = ((uint64_t)w[0] | (uint64_t)w[1] << 32) >> shift;
    if (shift + width > 64) {
        value |= (uint64_t)w[2] << (64 - shift);
    }
    return value & ((UINT64_C(1) << width) - 1);
}

static inline void words_put(uint32_t *words, unsigned width, size_t index, uint64_t value) {
    size_t bit = index * width;
    unsigned shift = (unsigned)(bit & 31u);
    uint32_t *w = words + (bit >> 5); /* into cleared words; the last two of a section are padding */
    uint64_t low = value << shift;
    w[0] |= (uint32_t)low;
    w[1] |= (uint32_t)(low >> 32);
    if (shift > 0 && shift + width > 64) {
        w[2] |= (uint32_t)(value >> (64 - shift));
    }
}

static inline aset_real slope_of(uint32_t code) {
    return (aset_real)((int32_t)code - SLOPE_STEPS) * (R(1) / SLOPE_STEPS);
}

static inline facet facet_read(const aset_draft *draft, uint32_t number) {
    uint64_t record = words_get(draft->facets, draft->width, number);
    uint32_t surface = draft->surfaces[record & ((1u << draft->surface_width) - 1)];
    uint32_t rest = (uint32_t)(record >> draft->surface_width); /* number of a footprint, height */
    uint32_t print = rest & ((1u << draft->footprint_width) - 1), height = rest >> draft->footprint_width;
    facet f;
    f.axis = (int)(surface >> 1 & 3u);
    f.down = (surface & 1u) != 0;
    f.slope_u = slope_of(surface >> 3 & SLOPE_MASK);
    f.slope_v = slope_of(surface >> (3 + SLOPE_BITS) & SLOPE_MASK);
    f.texture = surface >> SURFACE_TEXTURE_SHIFT;
    f.footprint = draft->footprints[print >> 1] >> (print & 1u) * 16 & 0xffffu;
    f.height = HEIGHT_LOW + ((aset_real)(int32_t)height + R(0.5)) * HEIGHT_STEP;
    return f;
}

/* The axis behind one in turn: u of a, v of u. */
static inline unsigned facet_next(unsigned axis) {
    static const unsigned char next[4] = {1, 2, 0, 0};
    return next[axis & 3u];
}

/* A normal in the scene's lengths, of any length but 0, on the side that the facet faces. */
static inline aset_vec3 facet_faces(const aset_draft *draft, const facet *f) {
    aset_real n[3], towards = f->down ? R(-1) : R(1);
    unsigned u = facet_next((unsigned)f->axis), v = facet_next(u);
    n[f->axis] = towards * draft->per_size[f->axis];
    n[u] = -towards * f->slope_u * draft->per_size[u];
    n[v] = -towards * f->slope_v * draft->per_size[v];
    return vec(n[0], n[1], n[2]);
}

/* That of unit length. */
static inline aset_vec3 facet_normal(const aset_draft *draft, const facet *f) {
    return aset_vec_unit(facet_faces(draft, f));
}

static inline bool starts_bit(const uint32_t *starts, uint32_t facet_number) {
    return (starts[facet_number >> 5] >> (facet_number & 31u) & 1u) != 0;
}

static inline bool draft_has_block(const aset_draft *draft, uint32_t block) {
    return (draft->map[block >> 5] >> (block & 31u) & 1u) != 0;
}

/* The number among those that are not empty of a block that is not. */
static inline uint32_t draft_dense_block(const aset_draft *draft, uint32_t block) {
    return draft->rank[block >> 5] + bits_count(draft->map[block >> 5] & ((UINT32_C(1) << (block & 31u)) - 1));
}

/* The voxels of a block that is not empty: a bit for each. */
static inline uint64_t draft_marks(const aset_draft *draft, uint32_t dense) {
    return (uint64_t)draft->marks[2 * dense] | (uint64_t)draft->marks[2 * dense + 1] << 32;
}

/* The facets of the k-th marked voxel of a block, counted from 0. */
static inline void draft_find_facets(const aset_draft *draft, uint32_t block, unsigned k, uint32_t *first, uint32_t *end) {
    uint32_t at = draft->first[block], word = at >> 5;
    uint32_t bits = draft->starts[word] & 0xffffffffu << (at & 31u);
    for (unsigned n; k >= (n = bits_count(bits)); bits = draft->starts[++word]) {
        k -= n;
    }
    for (; k > 0; k--) {
        bits &= bits - 1;
    }
    *first = word * 32 + bits_lowest(bits);
    bits &= bits - 1;
    while (bits == 0) {
        bits = draft->starts[++word]; /* there is a bit behind the last facet's */
    }
    *end = word * 32 + bits_lowest(bits);
}

/* Sets what follows from the header's words: sizes and where the sections are. True: they end with the last word. */
bool aset_draft_bind(aset_draft *draft, const uint32_t *words, size_t n_words);

/* Sets what follows from the marks: whether rays may close seams. */
void aset_draft_bind_marks(aset_draft *draft);

/* Gives the stage's entities to a sink. */
aset_status aset_draft_read_stage(const aset_draft *draft, const aset_sink *sink);

/* Rays against a draft. */
extern const struct aset_answers aset_draft_answers;

aset_material aset_draft_material(const aset_draft *draft, uint32_t texture);

uint32_t aset_draft_checksum(const uint32_t *words, size_t n_words);

#endif
#endif
