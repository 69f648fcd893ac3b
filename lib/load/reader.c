/*
 * reader.c - bytes to tokens.
 *
 *     input   ... taken ... | bytes[at .. end) | not yet asked for ...
 *                           ^ offset, line: always those of bytes[at]
 *
 * Only take() and the two quick_... functions move forward in text, so offset and line cannot disagree with the bytes. A
 * line ends with LF, CRLF or CR: CR counts it and an LF right behind is the same end. (Files with CR alone are rare, but
 * were it not an end, a comment in one would swallow all that follows.)
 */
#include "reader.h"

#include <string.h>

/* ---- places and errors ---- */

static void copy_token(char to[32], const char *token) {
    size_t i = 0;
    for (; i + 1 < 32 && token[i] != '\0'; i++) {
        to[i] = token[i] >= ' ' && token[i] <= '~' ? token[i] : '?';
    }
    to[i] = '\0';
}

aset_place aset_reader_place(const aset_reader *reader) {
    aset_place place;
    place.offset = reader->token_offset;
    place.line = reader->token_line;
    copy_token(place.token, reader->token);
    return place;
}

aset_status aset_reader_fail_at(aset_reader *reader, const aset_place *place, aset_status status, const char *what,
                                const char *expected) {
    aset_load_report *report = reader->report;
    report->offset = place->offset;
    report->line = place->line;
    report->what = what;
    report->expected = expected;
    copy_token(report->token, place->token);
    return status;
}

aset_status aset_reader_fail(aset_reader *reader, aset_status status, const char *what, const char *expected) {
    const aset_place place = aset_reader_place(reader);
    return aset_reader_fail_at(reader, &place, status, what, expected);
}

/* At the next byte, which is shown as token. */
static aset_status fail_at_byte(aset_reader *reader, const char *token, aset_status status, const char *what,
                                const char *expected) {
    aset_place place;
    place.offset = reader->offset;
    place.line = reader->line;
    copy_token(place.token, token);
    return aset_reader_fail_at(reader, &place, status, what, expected);
}

/* ---- bytes ---- */

/* Asks once for bytes behind bytes[end); there must be room. */
static aset_status fill(aset_reader *reader) {
    const size_t room = reader->capacity - reader->end;
    const ptrdiff_t got = reader->read(reader->context, reader->bytes + reader->end, room);
    if (got < 0) {
        return fail_at_byte(reader, "", ASET_ERR_READ, "the input could not be read", NULL);
    }
    if ((size_t)got > room) {
        return fail_at_byte(reader, "", ASET_ERR_READ, "the read callback gave more bytes than it was asked for", NULL);
    }
    reader->ended = got == 0;
    reader->end += (size_t)got;
    return ASET_OK;
}

/* The next byte, not taken; -1 at the end of the input. */
static aset_status look(aset_reader *reader, int *byte) {
    if (reader->at == reader->end && !reader->ended) {
        reader->at = reader->end = 0;
        const aset_status status = fill(reader);
        if (status != ASET_OK) {
            return status;
        }
    }
    *byte = reader->at < reader->end ? reader->bytes[reader->at] : -1;
    return ASET_OK;
}

static bool is_line_end(int byte) {
    return byte == '\n' || byte == '\r';
}

static bool is_blank(int byte) {
    return byte == ' ' || byte == '\t' || is_line_end(byte);
}

/* The next byte, which must be a byte of text or -1. */
static aset_status look_text(aset_reader *reader, int *byte) {
    const aset_status status = look(reader, byte);
    if (status != ASET_OK) {
        return status;
    }
    if (*byte >= 0 && (*byte < ' ' || *byte == 127) && !is_blank(*byte)) {
        return fail_at_byte(reader, "?", ASET_ERR_SYNTAX, "a control byte in the text", "a text file");
    }
    return ASET_OK;
}

/* Moves behind the byte that look() has shown. */
static void take(aset_reader *reader, int byte) {
    reader->at++;
    reader->offset++;
    if (byte == '\r' || (byte == '\n' && !reader->after_cr)) {
        reader->line++;
    }
    reader->after_cr = byte == '\r';
}

/* Takes what is in the buffer of the line's rest, up to its end or to a byte that needs a closer look. */
static void quick_rest(aset_reader *reader) {
    const unsigned char *from = reader->bytes + reader->at, *end = reader->bytes + reader->end, *p = from;
    while (p < end && ((*p >= ' ' && *p != 127) || *p == '\t')) {
        p++;
    }
    if (p > from) {
        reader->at += (size_t)(p - from);
        reader->offset += (uint64_t)(p - from);
        reader->after_cr = false;
    }
}

/* Stops before the line's end, or at the input's. *last is the last byte taken, -1 if there is none or it is a comment's. */
static aset_status skip_to_line_end(aset_reader *reader, int *last) {
    bool commented = false;
    *last = -1;
    for (;;) {
        int byte;
        const size_t before = reader->at;
        quick_rest(reader);
        const size_t n = reader->at - before;
        commented = commented || (reader->joiner >= 0 && n > 0 && memchr(reader->bytes + before, reader->comment, n) != NULL);
        *last = commented ? -1 : n > 0 ? reader->bytes[reader->at - 1] : *last;
        const aset_status status = look_text(reader, &byte);
        if (status != ASET_OK || byte < 0 || is_line_end(byte)) {
            return status;
        }
        take(reader, byte);
        commented = commented || byte == reader->comment;
        *last = commented ? -1 : byte;
    }
}

/* Takes the line's end, which is next: LF, CR or CRLF. */
static aset_status take_line_end(aset_reader *reader) {
    int byte = reader->bytes[reader->at];
    aset_status status = ASET_OK;
    take(reader, byte);
    /* bytes behind the line may be binary, so the LF of a CRLF must go now */
    if (byte == '\r' && (status = look(reader, &byte)) == ASET_OK && byte == '\n') {
        take(reader, byte);
    }
    return status;
}

/* The next byte is a joiner: is it one before a line's end? Then both are taken. */
static aset_status take_joint(aset_reader *reader, bool *joint) {
    const unsigned char *bytes;
    size_t n;
    aset_status status = aset_reader_peek(reader, 2, &bytes, &n);
    *joint = status == ASET_OK && n == 2 && is_line_end(bytes[1]);
    if (*joint) {
        take(reader, reader->joiner);
        reader->joined++;
        status = take_line_end(reader);
    }
    return status;
}

/* Stops before the next token's first byte, which is *byte, or at the end with -1. */
static aset_status skip_blanks(aset_reader *reader, int *byte) {
    for (;;) {
        aset_status status = look_text(reader, byte);
        if (status == ASET_OK && *byte >= 0 && *byte == reader->comment) {
            int last;
            status = skip_to_line_end(reader, &last);
        } else if (status == ASET_OK && is_blank(*byte)) {
            take(reader, *byte);
        } else if (status == ASET_OK && *byte >= 0 && *byte == reader->joiner) {
            bool joint;
            status = take_joint(reader, &joint);
            if (status != ASET_OK || !joint) {
                return status;
            }
        } else {
            return status;
        }
        if (status != ASET_OK) {
            return status;
        }
    }
}

void aset_reader_init(aset_reader *reader, aset_read read, void *context, aset_load_report *report) {
    memset(report, 0, sizeof *report);
    report->what = report->expected = NULL;
    reader->comment = '#';
    reader->joiner = -1;
    reader->joined = 0;
    reader->bytes = reader->buffer;
    reader->capacity = sizeof reader->buffer;
    reader->cut = "the file ends too early";
    reader->token[0] = '\0';
    reader->length = 0;
    reader->starts_line = true;
    reader->token_offset = 0;
    reader->token_line = 1;
    reader->has_token = reader->kept = reader->ended = reader->after_cr = false;
    reader->line = 1;
    reader->offset = 0;
    reader->at = reader->end = 0;
    reader->read = read;
    reader->context = context;
    reader->report = report;
}

void aset_reader_lend(aset_reader *reader, unsigned char *block, size_t capacity) {
    reader->bytes = block;
    reader->capacity = capacity;
}

aset_status aset_reader_skip_line(aset_reader *reader) {
    for (;;) {
        int byte = -1, last = -1;
        aset_status status = skip_to_line_end(reader, &last);
        if (status == ASET_OK) {
            status = look(reader, &byte);
        }
        if (status != ASET_OK || byte < 0) {
            return status;
        }
        status = take_line_end(reader);
        if (status != ASET_OK || last < 0 || last != reader->joiner) {
            return status;
        }
    }
}

aset_status aset_reader_rest(aset_reader *reader, char *text, size_t size, size_t *length) {
    size_t n = 0; /* bytes so far, blanks at the end too, without which they are *length */
    bool full = false; /* blanks have found no room: it is the end, or the name is too long */
    *length = 0;
    for (;;) {
        int byte = -1, last = -1;
        aset_status status = look_text(reader, &byte);
        bool joint = false;
        if (status == ASET_OK && byte >= 0 && byte == reader->joiner) {
            status = take_joint(reader, &joint);
        }
        bool comment = byte == reader->comment && (n == 0 || full || n > *length);
        if (status == ASET_OK && byte >= 0 && comment) { /* "Material #25" and "#0000ff" are names */
            const unsigned char *ahead;
            size_t there;
            status = aset_reader_peek(reader, 2, &ahead, &there);
            comment = status == ASET_OK && (there < 2 || is_blank(ahead[1]) || is_line_end(ahead[1]));
        }
        if (status == ASET_OK && byte >= 0 && comment) {
            status = skip_to_line_end(reader, &last);
        }
        if (status != ASET_OK || byte < 0 || is_line_end(byte) || comment) {
            text[*length] = '\0';
            return status;
        }
        if (joint) {
            byte = ' ';
        } else {
            take(reader, byte);
        }
        if (is_blank(byte) && (n == 0 || n + 1 >= size)) {
            full = n > 0;
            continue;
        }
        if (full || n + 1 >= size) {
            text[*length] = '\0';
            return aset_reader_fail(reader, ASET_ERR_LIMIT, "a name too long to be kept", NULL);
        }
        text[n++] = (char)byte;
        *length = is_blank(byte) ? *length : n;
    }
}

aset_status aset_reader_window(aset_reader *reader, size_t wanted, const unsigned char **bytes, size_t *n) {
    if (wanted > reader->capacity) {
        wanted = reader->capacity;
    }
    if (reader->end - reader->at < wanted) {
        memmove(reader->bytes, reader->bytes + reader->at, reader->end - reader->at);
        reader->end -= reader->at;
        reader->at = 0;
    }
    while (reader->end - reader->at < wanted && !reader->ended) {
        const aset_status status = fill(reader);
        if (status != ASET_OK) {
            return status;
        }
    }
    *bytes = reader->bytes + reader->at;
    *n = reader->end - reader->at;
    return ASET_OK;
}

aset_status aset_reader_peek(aset_reader *reader, size_t wanted, const unsigned char **bytes, size_t *n) {
    const aset_status status = aset_reader_window(reader, wanted, bytes, n);
    if (status == ASET_OK) {
        const size_t most = wanted < reader->capacity ? wanted : reader->capacity;
        *n = *n < most ? *n : most;
    }
    return status;
}

void aset_reader_advance(aset_reader *reader, size_t n) {
    reader->at += n;
    reader->offset += n;
    reader->after_cr = false;
}

aset_status aset_reader_skip_mark(aset_reader *reader) {
    const unsigned char *bytes;
    size_t n;
    int byte;
    aset_status status = look(reader, &byte); /* of other texts no more is asked for */
    if (status != ASET_OK || byte != 0xef) {
        return status;
    }
    status = aset_reader_peek(reader, 3, &bytes, &n);
    if (status == ASET_OK && n == 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) {
        aset_reader_advance(reader, 3);
    }
    return status;
}

/* ---- tokens ---- */

/* The current token begins at the next byte. */
static void begin_token(aset_reader *reader, bool at_end) {
    const uint32_t line_before = reader->token_line + reader->joined;
    reader->token_offset = reader->offset;
    reader->token_line = reader->line;
    reader->starts_line = at_end || !reader->has_token || reader->line != line_before;
    reader->has_token = true;
    reader->joined = 0;
    reader->length = 0;
}

/* Takes the next token if all of it and the byte behind it are in the buffer, and nothing before it needs a closer look. */
static bool quick_token(aset_reader *reader) {
    const unsigned char *p = reader->bytes + reader->at, *end = reader->bytes + reader->end;
    const unsigned char *from = p;
    uint32_t lines = 0;
    if (reader->after_cr) {
        return false;
    }
    for (; p < end && (*p == ' ' || *p == '\t' || *p == '\n'); p++) {
        lines += *p == '\n' ? 1u : 0u;
    }
    const unsigned char *first = p;
    const int comment = reader->comment, joiner = reader->joiner;
    while (p<end && * p> ' ' && *p != 127 && *p != comment && *p != joiner) {
        p++;
    }
    const size_t length = (size_t)(p - first);
    if (p == end || length == 0 || length >= sizeof reader->token || !is_blank(*p)) {
        return false;
    }
    reader->offset += (uint64_t)(first - from);
    reader->line += lines;
    begin_token(reader, false);
    memcpy(reader->token, first, length);
    reader->token[length] = '\0';
    reader->length = (uint32_t)length;
    reader->offset += length;
    reader->at += (size_t)(p - from);
    return true;
}

/* The rest of a token of which byte is the next. */
static aset_status take_token(aset_reader *reader, int byte) {
    bool joint = false;
    while (byte >= 0 && !is_blank(byte) && byte != reader->comment) {
        aset_status status = ASET_OK;
        if (byte == reader->joiner) {
            status = take_joint(reader, &joint);
        }
        if (status != ASET_OK || joint) {
            return status;
        }
        if (reader->length + 1 == sizeof reader->token) {
            return aset_reader_fail(reader, ASET_ERR_SYNTAX, "a word too long for any number or name", NULL);
        }
        reader->token[reader->length++] = (char)byte;
        reader->token[reader->length] = '\0';
        take(reader, byte);
        status = look_text(reader, &byte);
        if (status != ASET_OK) {
            return status;
        }
    }
    return ASET_OK;
}

aset_status aset_reader_next(aset_reader *reader) {
    if (reader->kept) {
        reader->kept = false;
        return ASET_OK;
    }
    if (quick_token(reader)) {
        return ASET_OK;
    }
    int byte;
    const aset_status status = skip_blanks(reader, &byte);
    if (status != ASET_OK) {
        return status;
    }
    if (byte >= 0 && quick_token(reader)) {
        return ASET_OK;
    }
    begin_token(reader, byte < 0);
    reader->token[0] = '\0';
    return take_token(reader, byte);
}

aset_status aset_reader_keep(aset_reader *reader) {
    const aset_status status = aset_reader_next(reader);
    reader->kept = status == ASET_OK;
    return status;
}

bool aset_reader_is(const aset_reader *reader, const char *word) {
    size_t i = 0;
    while (word[i] != '\0' && reader->token[i] == word[i]) {
        i++;
    }
    return word[i] == reader->token[i]; /* both at their end */
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool aset_reader_is_numeric(const aset_reader *reader) {
    const char c = reader->token[0];
    return is_digit(c) || c == '+' || c == '-' || c == '.';
}

/* ---- numbers as tokens ---- */

/* The next token, which must be there. */
static aset_status need_token(aset_reader *reader, const char *expected) {
    const aset_status status = aset_reader_next(reader);
    if (status == ASET_OK && reader->length == 0) {
        return aset_reader_fail(reader, ASET_ERR_SYNTAX, reader->cut, expected);
    }
    return status;
}

aset_status aset_reader_real(aset_reader *reader, aset_real *value, const char *expected) {
    const aset_status status = need_token(reader, expected);
    if (status != ASET_OK) {
        return status;
    }
    const char *wrong = aset_number_real(reader->token, reader->length, value);
    return wrong == NULL ? ASET_OK : aset_reader_fail(reader, ASET_ERR_SYNTAX, wrong, expected);
}

aset_status aset_reader_coordinate(aset_reader *reader, aset_real *value, const char *expected) {
    const aset_status status = need_token(reader, expected);
    if (status != ASET_OK) {
        return status;
    }
    const char *wrong = aset_number_coordinate(reader->token, reader->length, value);
    return wrong == NULL ? ASET_OK : aset_reader_fail(reader, ASET_ERR_SYNTAX, wrong, expected);
}

aset_status aset_reader_whole(aset_reader *reader, uint32_t *value, uint32_t low, uint32_t high, const char *outside,
                              const char *expected) {
    const aset_status status = need_token(reader, expected);
    if (status != ASET_OK) {
        return status;
    }
    const char *wrong = aset_number_whole(reader->token, reader->length, value);
    if (wrong == NULL && (*value < low || *value > high)) {
        wrong = outside;
    }
    return wrong == NULL ? ASET_OK : aset_reader_fail(reader, ASET_ERR_SYNTAX, wrong, expected);
}
