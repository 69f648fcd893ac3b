/* texture.h - averages of materials, and the bounded list that shares them. */
#ifndef ASET_APPROX_TEXTURE_H
#define ASET_APPROX_TEXTURE_H

#include "aset/summary.h"

#if ASET_WITH_APPROXIMATION

enum { TEXTURE_PARTS = 8 }; /* fill r g b, Kd, Ks, shine, T, ior */

/* A sum of materials in whole numbers, units of 2^-16: exact, so the order of adding does not matter. */
typedef struct texture_sum {
    uint64_t parts[TEXTURE_PARTS];
    uint32_t n;
} texture_sum;

/* A part takes up to 2^40 units: so many keep a sum in 64 bits. */
#define TEXTURE_OBJECTS_MAX 0xffffffu

void aset_texture_sum_add(texture_sum *sum, const aset_material *material);

/* The average, each part rounded to the nearest unit; n > 0. */
aset_material aset_texture_average(const texture_sum *sum);

/* The number of an equal texture in the summary's list; false if there is none. */
bool aset_texture_find(const aset_summary *summary, const aset_material *texture, uint32_t *number);

/* The number of the texture in the summary's list, which is not empty, that looks most like this one. */
uint32_t aset_texture_nearest(const aset_summary *summary, const aset_material *texture);

/*
 * Averages met lately, by a hash of their sums' parts: most cells are like one seen before, and the list need not be
 * searched. All zero: none.
 */
#define TEXTURE_RECENT 64u

typedef struct texture_recent {
    aset_material textures[TEXTURE_RECENT];
    uint32_t number[TEXTURE_RECENT]; /* in the list; counts only with known */
    bool known[TEXTURE_RECENT];
} texture_recent;

/* Where in it an average of this sum stands. */
unsigned aset_texture_slot(const texture_sum *sum);

/*
 * The number of a sum's average in the summary's list: it is entered if it is new and the list not full, else the nearest's
 * number, and the cell is counted as merged. Cells come in dense order.
 */
uint32_t aset_texture_take(aset_summary *summary, texture_recent *recent, const texture_sum *sum);

#endif
#endif
