/* number.h - decimal text to numbers. Private to lib/load. */
#ifndef ASET_LOAD_NUMBER_H
#define ASET_LOAD_NUMBER_H

#include "aset/types.h"

/* A number or other token has fewer bytes than this; sizes the integers of the exact conversion. */
#define ASET_READER_TOKEN 128u

/*
 * Stands for a coordinate that is not finite or too large for a number: beyond what models may have, and safe to compare.
 */
#if ASET_REAL_BITS == 32
#define ASET_NUMBER_OUTSIDE ((aset_real)3e38)
#define ASET_NUMBER_LARGEST ((aset_real)1e15)
#else
#define ASET_NUMBER_OUTSIDE ((aset_real)1e300)
#define ASET_NUMBER_LARGEST ((aset_real)1e150)
#endif

/*
 * A decimal number: sign, digits with or without a point, exponent; the first and the last may be missing. *value is the
 * aset_real nearest to it (ties to the even one), whatever its digits, on every machine. Too small ones become denormal or
 * 0. Returns NULL, or what is wrong and leaves *value: not a number, nan or inf, a nearest value beyond the finite ones,
 * ASET_READER_TOKEN bytes or more.
 */
const char *aset_number_real(const char *text, size_t length, aset_real *value);

/* The same, but nan, inf and numbers that are too large are taken as ASET_NUMBER_OUTSIDE. */
const char *aset_number_coordinate(const char *text, size_t length, aset_real *value);

/* Digits only, up to 2^32 - 1. NULL, or what is wrong. */
const char *aset_number_whole(const char *text, size_t length, uint32_t *value);

#endif
