/*
 * stl.c - stereolithography files (3D Systems, "StereoLithography Interface Specification", 1988), binary and text.
 *
 *     binary   80 bytes of anything | n, 4 bytes | n times: normal, 3 points (12 floats), 2 bytes; low bytes first
 *     text     solid NAME  { facet normal x y z  outer loop  { vertex x y z }  endloop  endfacet }  endsolid NAME
 *
 * Nothing is kept but the facet in hand. Which of the two it is: see load.h; a size that fits is the only proof of the
 * binary form, since writers put "solid" into its 80 bytes too.
 */
#include "model.h"

#include <string.h>

#if ASET_WITH_POLYGONS

#define HEADER 84u
#define FACET 50u

typedef struct stl {
    aset_model model;
    unsigned char batch[ASET_MODEL_BATCH];
} stl;

static uint32_t low_first(const unsigned char *b) {
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* ---- binary ---- */

static void decode_point(const unsigned char *bytes, aset_vec3 *point) {
    point->x = aset_model_single(low_first(bytes));
    point->y = aset_model_single(low_first(bytes + 4));
    point->z = aset_model_single(low_first(bytes + 8));
}

static aset_status read_facets(aset_model *model, uint32_t n) {
    aset_corner corners[3];
    memset(corners, 0, sizeof corners);
    for (uint32_t done = 0; done < n;) {
        const unsigned char *bytes;
        size_t size;
        aset_status status = aset_reader_window(&model->reader, FACET, &bytes, &size);
        if (status == ASET_OK && size < FACET) {
            return aset_model_fail_binary(model, model->reader.offset + size,
                                          "the file ends before the last triangle it announces, after", done, n);
        }
        size_t at = 0;
        for (; status == ASET_OK && at + FACET <= size && done < n; at += FACET, done++) {
            decode_point(bytes + at + 12, &corners[0].point);
            decode_point(bytes + at + 24, &corners[1].point);
            decode_point(bytes + at + 36, &corners[2].point);
            model->reader.token_offset = model->reader.offset + at;
            status = aset_model_triangle(model, &corners[0], &corners[1], &corners[2]);
        }
        if (status != ASET_OK) {
            return status;
        }
        model->reader.report->vertices = (uint64_t)done * 3;
        aset_reader_advance(&model->reader, at);
    }
    return ASET_OK;
}

static aset_status read_binary(aset_model *model) {
    const unsigned char *bytes;
    size_t size;
    aset_model_binary(model);
    aset_status status = aset_reader_peek(&model->reader, HEADER, &bytes, &size);
    if (status != ASET_OK) {
        return status;
    }
    if (size < HEADER) {
        return aset_model_fail_binary(model, size, "neither text nor a whole binary header, bytes", size, HEADER);
    }
    const uint32_t n = low_first(bytes + 80);
    const uint64_t whole = HEADER + (uint64_t)n * FACET;
    if (model->size != 0 && model->size != whole) {
        return aset_model_fail_binary(model, 80, "a binary file of another size than its count of triangles tells, bytes",
                                      model->size, whole);
    }
    aset_reader_advance(&model->reader, HEADER);
    status = read_facets(model, n);
    if (status == ASET_OK) {
        status = aset_reader_window(&model->reader, 1, &bytes, &size);
    }
    if (status == ASET_OK && size > 0) {
        return aset_model_fail_binary(model, whole, "bytes behind the last triangle that the file announces", n, n);
    }
    return status == ASET_OK ? aset_model_end(model) : status;
}

/* ---- text ---- */

/* The current token is this word of small letters, in any case. */
static bool is_word(const aset_reader *reader, const char *word) {
    size_t i = 0;
    for (; word[i] != '\0'; i++) {
        const char c = reader->token[i];
        if (c != word[i] && c != word[i] - 'a' + 'A') {
            return false;
        }
    }
    return reader->token[i] == '\0';
}

/* Takes the next token, which must be there. */
static aset_status need(aset_reader *reader, const char *expected) {
    const aset_status status = aset_reader_next(reader);
    return status == ASET_OK && reader->length == 0 ? aset_reader_fail(reader, ASET_ERR_SYNTAX, reader->cut, expected)
                                                    : status;
}

static aset_status need_word(aset_reader *reader, const char *word) {
    const aset_status status = need(reader, word);
    return status == ASET_OK && !is_word(reader, word)
               ? aset_reader_fail(reader, ASET_ERR_SYNTAX, "another word than the form of a facet has there", word)
               : status;
}

/* Passes over the facet's normal, whatever its numbers (many programs print nan), up to "outer". */
static aset_status skip_normal(aset_reader *reader) {
    const char *expected = "outer";
    for (int i = 0; i < 5; i++) {
        const aset_status status = need(reader, expected);
        if (status != ASET_OK || is_word(reader, expected)) {
            return status;
        }
    }
    return aset_reader_fail(reader, ASET_ERR_SYNTAX, "a facet without a loop", expected);
}

static aset_status read_point(aset_reader *reader, aset_vec3 *point) {
    const char *expected = "vertex x y z";
    aset_status status = aset_reader_coordinate(reader, &point->x, expected);
    if (status == ASET_OK) {
        status = aset_reader_coordinate(reader, &point->y, expected);
    }
    return status == ASET_OK ? aset_reader_coordinate(reader, &point->z, expected) : status;
}

/* The points up to "endloop", as a fan. */
static aset_status read_loop(aset_model *model) {
    aset_reader *reader = &model->reader;
    aset_corner corners[3];
    memset(corners, 0, sizeof corners);
    for (uint64_t n = 0;; n++) {
        aset_status status = need(reader, "vertex or endloop");
        if (status == ASET_OK && is_word(reader, "endloop")) {
            reader->report->skipped += n < 3 ? 1u : 0u;
            return ASET_OK;
        }
        if (status == ASET_OK && !is_word(reader, "vertex")) {
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, "neither another point nor the end of the loop",
                                    "vertex or endloop");
        }
        if (n > 2) {
            corners[1] = corners[2];
        }
        if (status == ASET_OK) {
            status = read_point(reader, &corners[n < 2 ? n : 2].point);
        }
        if (status == ASET_OK) {
            reader->report->vertices++;
            status = n < 2 ? ASET_OK : aset_model_triangle(model, &corners[0], &corners[1], &corners[2]);
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

static aset_status read_facet(aset_model *model) {
    aset_status status = skip_normal(&model->reader);
    if (status == ASET_OK) {
        status = need_word(&model->reader, "loop");
    }
    if (status == ASET_OK) {
        status = read_loop(model);
    }
    return status == ASET_OK ? need_word(&model->reader, "endfacet") : status;
}

/* Behind "solid". */
static aset_status read_solid(aset_model *model) {
    aset_reader *reader = &model->reader;
    aset_status status = aset_reader_skip_line(reader);
    while (status == ASET_OK) {
        status = need(reader, "facet or endsolid");
        if (status != ASET_OK) {
            return status;
        }
        if (is_word(reader, "endsolid")) {
            return aset_reader_skip_line(reader);
        }
        if (!is_word(reader, "facet")) {
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, "not a part of a solid", "facet or endsolid");
        }
        status = read_facet(model);
    }
    return status;
}

static aset_status read_text(aset_model *model) {
    aset_reader *reader = &model->reader;
    reader->comment = -1;
    reader->cut = "the file ends within a solid";
    aset_status status = aset_reader_skip_mark(reader);
    while (status == ASET_OK) {
        status = aset_reader_next(reader);
        if (status == ASET_OK && reader->length == 0) {
            return aset_model_end(model);
        }
        if (status == ASET_OK && !is_word(reader, "solid")) {
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, "not the beginning of a solid", "solid");
        }
        if (status == ASET_OK) {
            status = read_solid(model);
        }
    }
    return status;
}

/* ---- which of the two ---- */

static bool is_blank(unsigned char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static bool begins_with_solid(const unsigned char *bytes, size_t size) {
    static const char word[] = "solid";
    size_t at = size >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* UTF-8's mark */
    while (at < size && is_blank(bytes[at])) {
        at++;
    }
    if (size - at < 5) {
        return false;
    }
    for (size_t i = 0; i < 5; i++) {
        if (bytes[at + i] != word[i] && bytes[at + i] != word[i] - 'a' + 'A') {
            return false;
        }
    }
    return true;
}

static bool looks_like_text(const unsigned char *bytes, size_t size) {
    for (size_t i = 80; i < size; i++) {
        if ((bytes[i] < ' ' && !is_blank(bytes[i])) || bytes[i] == 127) {
            return false;
        }
    }
    return begins_with_solid(bytes, size);
}

aset_status aset_load_stl(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    stl file;
    aset_model *model = &file.model;
    const unsigned char *bytes;
    size_t size;
    aset_status status = aset_model_init(model, sink, read, context, options, report);
    if (status != ASET_OK) {
        return status;
    }
    aset_reader_lend(&model->reader, file.batch, sizeof file.batch);
    status = aset_reader_peek(&model->reader, sizeof file.batch, &bytes, &size);
    if (status != ASET_OK) {
        return status;
    }
    const bool fits = size >= HEADER && model->size == HEADER + (uint64_t)low_first(bytes + 80) * FACET;
    if (size == 0) {
        return aset_model_end(model);
    }
    return !fits && looks_like_text(bytes, size) ? read_text(model) : read_binary(model);
}

#else

aset_status aset_load_stl(const aset_sink *sink, aset_read read, void *context, const aset_load_options *options,
                          aset_load_report *report) {
    (void)options;
    return aset_model_switched_off(sink, read, context, report);
}

#endif
