/*
 * reader.h - bytes to tokens, and tokens to numbers: what the readers of all formats stand on. Private to lib/load.
 *
 * One token is current at a time, with its place. Tokens are separated by spaces, tabs and line ends (LF, CRLF or CR); a
 * comment runs from its byte, wherever that stands, to the end of the line. Other control bytes are not text and are
 * refused, in comments too; bytes from 128 up are taken as they come. Between tokens a caller may skip lines or read raw
 * bytes (binary files with a text header). The functions that return a status have filled the report when it is not ASET_OK,
 * so a caller only passes it on.
 */
#ifndef ASET_LOAD_READER_H
#define ASET_LOAD_READER_H

#include "aset/load.h"

#include "number.h"

/* Bytes asked for at once, and the farthest that aset_reader_peek can see; 1 is enough for tokens, 2 with a joiner, 3 for a mark. */
#ifndef ASET_READER_BUFFER
#define ASET_READER_BUFFER 1024u
#endif

typedef struct aset_place {
    uint64_t offset;
    uint32_t line;
    char token[32]; /* as in aset_load_report */
} aset_place;

/*
 * About 1.3 kB, meant for the stack. Callers set comment, joiner and cut, and read the token's fields; the rest is the
 * reader's.
 */
typedef struct aset_reader {
    int comment;     /* the byte that starts a comment, '#' after init; -1: the format has none */
    int joiner;      /* the byte that, before a line's end, joins the next line to it; -1, as after init: there is none */
    const char *cut; /* what is wrong if the input ends where a number is needed: "the file ends within a ..." */

    char token[ASET_READER_TOKEN]; /* the current token, ends with 0; "" at the end of the input */
    uint32_t length;               /* its bytes, 0 at the end of the input */
    bool starts_line;              /* no other token stands before it on its line; true at the end of the input */
    uint64_t token_offset;
    uint32_t token_line;

    bool has_token, kept; /* a token was read; the current token is the next one too */
    bool ended, after_cr; /* the callback has said 0; the last byte taken was CR */
    uint32_t line;        /* of the next byte */
    uint32_t joined;      /* line ends since the current token that a joiner has undone */
    uint64_t offset;      /* of the next byte */
    size_t at, end;       /* unread bytes in bytes */
    unsigned char *bytes; /* buffer, or a larger one that was lent */
    size_t capacity;
    aset_read read;
    void *context;
    aset_load_report *report;
    unsigned char buffer[ASET_READER_BUFFER];
} aset_reader;

/* Starts at the input's first byte and clears the report, which must stay valid as long as the reader is used. */
void aset_reader_init(aset_reader *reader, aset_read read, void *context, aset_load_report *report);

/* Right after init: bytes are read into this block of capacity bytes instead. */
void aset_reader_lend(aset_reader *reader, unsigned char *block, size_t capacity);

/* Right after init, or lend: skips the mark of three bytes that some editors begin a text in UTF-8 with. */
aset_status aset_reader_skip_mark(aset_reader *reader);

/* Makes the next token the current one; its length is 0 at the end of the input. ASET_ERR_READ, ASET_ERR_SYNTAX. */
aset_status aset_reader_next(aset_reader *reader);

/* The same, but the next aset_reader_next gives this token once more: for looking whether it is on the same line, say. */
aset_status aset_reader_keep(aset_reader *reader);

/* The current token is this word. */
bool aset_reader_is(const aset_reader *reader, const char *word);

/* The current token begins with a digit, a sign or a point; aset_reader_real may refuse it still. */
bool aset_reader_is_numeric(const aset_reader *reader);

/* Takes the next token as a real number. expected is put in the report with an error. */
aset_status aset_reader_real(aset_reader *reader, aset_real *value, const char *expected);

/* Takes the next token as a coordinate: a real number, or ASET_NUMBER_OUTSIDE for one that is not finite or too large. */
aset_status aset_reader_coordinate(aset_reader *reader, aset_real *value, const char *expected);

/* Takes the next token as a whole number from low to high; outside is what is wrong with any other whole number. */
aset_status aset_reader_whole(aset_reader *reader, uint32_t *value, uint32_t low, uint32_t high, const char *outside,
                              const char *expected);

/* The following start behind the current token, which must not be a kept one. */

/* Skips the rest of the line and its end, and the lines that are joined to it. */
aset_status aset_reader_skip_line(aset_reader *reader);

/*
 * Takes the rest of the line as one name: without the blanks around it and without a comment, which here must follow a
 * blank. It ends with 0 in text, of size bytes; *length is 0 if there is none, and longer ones are ASET_ERR_LIMIT.
 */
aset_status aset_reader_rest(aset_reader *reader, char *text, size_t size, size_t *length);

/*
 * Shows the next bytes without taking them: *n of them, which is wanted (or the buffer's size if that is less) unless the
 * input ends.
 */
aset_status aset_reader_peek(aset_reader *reader, size_t wanted, const unsigned char **bytes, size_t *n);

/* The same, but *n is all that is in the buffer, wanted or more, unless the input ends. */
aset_status aset_reader_window(aset_reader *reader, size_t wanted, const unsigned char **bytes, size_t *n);

/* Takes n of the bytes shown, lines not counted. */
void aset_reader_advance(aset_reader *reader, size_t n);

/* The current token's place. */
aset_place aset_reader_place(const aset_reader *reader);

/* Fills the report and returns status: at the current token, or at a place kept from earlier. expected may be NULL. */
aset_status aset_reader_fail(aset_reader *reader, aset_status status, const char *what, const char *expected);
aset_status aset_reader_fail_at(aset_reader *reader, const aset_place *place, aset_status status, const char *what,
                                const char *expected);

#endif
