/*
 * elementary.h - the few functions of doubles that the procedural scenes need, without libm, whose last bits differ from one
 * machine to the next (glibc alone has a sine with fused multiplication and one without): scenes are the same everywhere.
 */
#ifndef ASET_PROCEDURAL_ELEMENTARY_H
#define ASET_PROCEDURAL_ELEMENTARY_H

/* Within 2^-51 of the true value for |rad| < 10^5. */
double aset_emit_sine(double rad);
double aset_emit_cosine(double rad);
double aset_emit_tangent(double rad);

/* The natural logarithm of x from 10^-300 to 10^300; within 2^-51 of the true value, or of 2^-51 itself near x = 1. */
double aset_emit_logarithm(double x);

#endif
