/*
 * model.h - what the readers of STL, PLY and OBJ share: materials and triangles to the sink, and counts and errors to the
 * report. Private to lib/load.
 */
#ifndef ASET_LOAD_MODEL_H
#define ASET_LOAD_MODEL_H

#include "reader.h"

/* Bytes that a binary file is read in at once, on the stack. */
#define ASET_MODEL_BATCH 4096u

#if ASET_WITH_POLYGONS
typedef struct aset_corner {
    aset_vec3 point, normal;
    aset_colour colour;
    bool has_normal;
} aset_corner;

typedef struct aset_model {
    aset_reader reader;
    const aset_sink *sink;
    aset_material fallback, given; /* for what has none; the sink's current one, if has_material */
    aset_material wanted;          /* the one of the next triangle */
    bool has_material, smooth;
    uint64_t size; /* of the input, 0: unknown */
} aset_model;

/* Starts with the fallback as the material wanted. ASET_ERR_ARGUMENT, ASET_ERR_UNSUPPORTED: patches were switched off. */
aset_status aset_model_init(aset_model *model, const aset_sink *sink, aset_read read, void *context,
                            const aset_load_options *options, aset_load_report *report);

/* A triangle of the wanted material, left out and counted if it cannot be. Errors are at the current token. */
aset_status aset_model_triangle(aset_model *model, const aset_corner *a, const aset_corner *b, const aset_corner *c);

/* The material of the next triangles is the fallback with this fill. */
void aset_model_fill(aset_model *model, const aset_colour *fill);

/* Fills the report for what a sink or a vertex store said: ASET_OK, or an error at the current token. */
aset_status aset_model_answer(aset_model *model, aset_status status);
aset_status aset_model_store_answer(aset_model *model, aset_status status, uint64_t capacity);

/* At the end of the input: ASET_OK, or that there was no triangle. */
aset_status aset_model_end(aset_model *model);

/* From here on there are no lines. */
void aset_model_binary(aset_model *model);

/* An error in binary data at this offset, with the words "part of whole" as the token. */
aset_status aset_model_fail_binary(aset_model *model, uint64_t offset, const char *what, uint64_t part, uint64_t whole);

/* Writes a number in decimal and the words behind it; cut if it does not fit. */
void aset_model_count_text(char text[32], uint64_t number, const char *words);

/* An IEEE 754 single given by its bits, as a coordinate or colour. */
aset_real aset_model_single(uint32_t bits);

/* A coordinate that the library takes, or ASET_NUMBER_OUTSIDE. */
aset_real aset_model_coordinate(double value);

#else

/* What all readers of models say then. */
aset_status aset_model_switched_off(const aset_sink *sink, aset_read read, void *context, aset_load_report *report);

#endif

#endif
