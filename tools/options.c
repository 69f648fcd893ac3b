/*
 * options.c - words of the command line into values.
 *
 * Invariant: a reader takes the whole text or nothing, and its error line names the option, the text and what was
 * expected.
 */
#include "tool.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#if ASET_REAL_BITS == 32
#define REAL_MAX_VALUE ((double)FLT_MAX)
#else
#define REAL_MAX_VALUE DBL_MAX
#endif

/* Room for the longest list of words in an error line. */
#define LIST_BYTES 512

/* Reads decimal digits: what follows them, or NULL if there is none or the number exceeds 64 bits. */
static const char *read_digits(const char *text, uint64_t *value) {
    const char *at = text;
    uint64_t sum = 0;
    for (; *at >= '0' && *at <= '9'; at++) {
        uint64_t digit = (uint64_t)(*at - '0');
        if (sum > (UINT64_MAX - digit) / 10u) {
            return NULL;
        }
        sum = sum * 10u + digit;
    }
    *value = sum;
    return at > text ? at : NULL;
}

/* Reads a decimal number: what follows it, or NULL. Takes no blanks, hexadecimal digits, infinities or NaN. */
static const char *read_real(const char *text, double *value) {
    char *end;
    double number = strtod(text, &end);
    size_t length = (size_t)(end - text);
    if (length == 0 || strspn(text, "+-.0123456789eE") < length || !isfinite(number)) {
        return NULL;
    }
    *value = number;
    return end;
}

static bool read_whole(const char *text, uint64_t low, uint64_t high, uint64_t *value) {
    uint64_t number;
    const char *end = read_digits(text, &number);
    if (end == NULL || *end != '\0' || number < low || number > high) {
        return false;
    }
    *value = number;
    return true;
}

/*
 * Reads N or NXxNYxNZ: 1 or 3, how many numbers there are, or 0 if it is neither or a number is not from 1 to high.
 */
static unsigned read_axes(const char *text, uint32_t high, uint64_t number[3]) {
    const char *at = text;
    for (unsigned axis = 0; axis < 3; axis++, at++) {
        at = read_digits(at, &number[axis]);
        if (at == NULL || number[axis] < 1 || number[axis] > high) {
            return 0;
        }
        if (*at == '\0') {
            return axis == 1 ? 0 : axis + 1;
        }
        if (*at != 'x') {
            return 0;
        }
    }
    return 0;
}

/* "first, second, third" */
static void list_words(char *list, size_t size, const tool_word *words) {
    size_t length = 0;
    list[0] = '\0';
    for (const tool_word *word = words; word->name != NULL && length < size; word++) {
        length += (size_t)snprintf(list + length, size - length, "%s%s", word == words ? "" : ", ", word->name);
    }
}

/* The word that equals the first length bytes of text, or NULL. */
static const tool_word *find_word(const tool_word *words, const char *text, size_t length) {
    for (; words->name != NULL; words++) {
        if (strlen(words->name) == length && memcmp(words->name, text, length) == 0) {
            return words;
        }
    }
    return NULL;
}

int tool_option_next(int argc, char **argv, const char *shorts, const struct option *longs) {
    char quiet_shorts[64];
    int length = snprintf(quiet_shorts, sizeof quiet_shorts, ":%s", shorts);
    if (length < 0 || (size_t)length >= sizeof quiet_shorts) {
        tool_error(NULL, 0, "%s: too many short options in the program", argv[0]);
        return '?';
    }
    opterr = 0;
    int before = optind;
    int found = getopt_long(argc, argv, quiet_shorts, longs, NULL);
    if (found != ':' && found != '?') {
        return found;
    }
    /* getopt steps over a long option before it complains, but not over a cluster of short ones */
    const char *word = argv[optind - 1];
    bool is_long = optind > before && strncmp(word, "--", 2) == 0;
    char letter[3] = {'-', (char)optopt, '\0'};
    if (!is_long) {
        word = letter;
    }
    if (found == ':') {
        tool_error(NULL, 0, "%s: %s needs a value", argv[0], word);
    } else if (is_long && optopt != 0) {
        tool_error(NULL, 0, "%s: %s: this option takes no value", argv[0], word);
    } else {
        tool_error(NULL, 0, "%s: there is no option %s; aset %s --help lists them", argv[0], word, argv[0]);
    }
    return '?';
}

bool tool_parse_output(const char *text, const char **path) {
    if (*path != NULL) {
        tool_error(NULL, 0, "--output: it goes to %s already, expected no %s", *path, text);
        return false;
    }
    *path = text;
    return true;
}

bool tool_parse_unsigned(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *value) {
    if (!read_whole(text, low, high, value)) {
        tool_error(NULL, 0, "%s: \"%s\" is not a whole number from %" PRIu64 " to %" PRIu64, option, text, low, high);
        return false;
    }
    return true;
}

bool tool_parse_count(const char *option, const char *text, uint32_t low, uint32_t high, uint32_t *value) {
    uint64_t number;
    if (!tool_parse_unsigned(option, text, low, high, &number)) {
        return false;
    }
    *value = (uint32_t)number;
    return true;
}

bool tool_parse_bytes(const char *option, const char *text, uint64_t low, uint64_t high, uint64_t *value) {
    static const char suffixes[] = "KMG";
    uint64_t number;
    unsigned shift = 0;
    const char *end = read_digits(text, &number);
    if (end != NULL && *end != '\0') {
        for (unsigned i = 0; suffixes[i] != '\0'; i++) {
            if (*end == suffixes[i] || *end == suffixes[i] - 'A' + 'a') {
                shift = 10u * (i + 1u);
            }
        }
        end += shift > 0 ? 1 : 0;
    }
    if (end == NULL || *end != '\0' || number > (UINT64_MAX >> shift) || number << shift < low ||
        number << shift > high) {
        tool_error(NULL, 0, "%s: \"%s\" is not a number of bytes from %" PRIu64 " to %" PRIu64 ", such as 65536, 64K or 1M",
                   option, text, low, high);
        return false;
    }
    *value = number << shift;
    return true;
}

bool tool_parse_real(const char *option, const char *text, double low, double high, double *value) {
    double number;
    const char *end = read_real(text, &number);
    if (end == NULL || *end != '\0' || number < low || number > high) {
        tool_error(NULL, 0, "%s: \"%s\" is not a number from %g to %g", option, text, low, high);
        return false;
    }
    *value = number;
    return true;
}

bool tool_parse_size(const char *option, const char *text, uint32_t high, uint32_t *width, uint32_t *height) {
    uint64_t number[2] = {0, 0};
    const char *end = read_digits(text, &number[0]);
    number[1] = number[0];
    bool right = end != NULL && (*end == '\0' || (*end == 'x' && read_whole(end + 1, 1, high, &number[1])));
    if (!right || number[0] < 1 || number[0] > high) {
        tool_error(NULL, 0, "%s: \"%s\" is not WIDTHxHEIGHT, both from 1 to %" PRIu32 ", such as 640x480, or one number for both",
                   option, text, high);
        return false;
    }
    if (number[0] * number[1] > TOOL_PIXELS_MAX) {
        tool_error(NULL, 0, "%s: %s is more than %u pixels", option, text, TOOL_PIXELS_MAX);
        return false;
    }
    *width = (uint32_t)number[0];
    *height = (uint32_t)number[1];
    return true;
}

bool tool_parse_grid(const char *option, const char *text, uint32_t high, uint32_t grid[3]) {
    uint64_t number[3] = {0, 0, 0};
    unsigned n_axes = strcmp(text, "auto") == 0 ? 3 : read_axes(text, high, number);
    if (n_axes == 0) {
        tool_error(NULL, 0, "%s: \"%s\" is not N, NXxNYxNZ (each from 1 to %" PRIu32 ") or auto", option, text, high);
        return false;
    }
    for (unsigned axis = 0; axis < 3; axis++) {
        grid[axis] = (uint32_t)number[n_axes == 3 ? axis : 0];
    }
    return true;
}

bool tool_parse_vec3(const char *option, const char *text, aset_vec3 *value) {
    double number[3] = {0.0, 0.0, 0.0};
    const char *at = text;
    bool right = true;
    for (unsigned axis = 0; right && axis < 3; axis++) {
        at = read_real(at, &number[axis]);
        right = at != NULL && fabs(number[axis]) <= REAL_MAX_VALUE && *at == (axis < 2 ? ',' : '\0');
        at = right ? at + 1 : at;
    }
    if (!right) {
        tool_error(NULL, 0, "%s: \"%s\" is not X,Y,Z, such as 0,-2.5,1", option, text);
        return false;
    }
    value->x = (aset_real)number[0];
    value->y = (aset_real)number[1];
    value->z = (aset_real)number[2];
    return true;
}

bool tool_parse_range(const char *option, const char *text, uint32_t high, uint32_t *first, uint32_t *end) {
    uint64_t number[2] = {0, 0};
    const char *after = read_digits(text, &number[0]);
    bool right = after != NULL && *after == ':' && read_whole(after + 1, 1, high, &number[1]);
    if (!right || number[0] >= number[1]) {
        tool_error(NULL, 0, "%s: \"%s\" is not FIRST:END with FIRST below END and END at most %" PRIu32, option, text, high);
        return false;
    }
    *first = (uint32_t)number[0];
    *end = (uint32_t)number[1];
    return true;
}

bool tool_parse_word(const char *option, const char *text, const tool_word *words, unsigned *value) {
    const tool_word *word = find_word(words, text, strlen(text));
    if (word == NULL) {
        char list[LIST_BYTES];
        list_words(list, sizeof list, words);
        tool_error(NULL, 0, "%s: \"%s\" is not one of %s", option, text, list);
        return false;
    }
    *value = word->value;
    return true;
}

bool tool_parse_words(const char *option, const char *text, const tool_word *words, unsigned *mask) {
    unsigned bits = 0;
    bool empty = false;
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ",");
        const tool_word *word = find_word(words, at, length);
        if (word == NULL) {
            char list[LIST_BYTES];
            list_words(list, sizeof list, words);
            tool_error(NULL, 0, "%s: \"%.*s\" is not one of %s", option, (int)(length < 256 ? length : 256), at, list);
            return false;
        }
        empty = empty || word->value == 0;
        bits |= word->value;
        at += length;
        if (*at == '\0' && empty && bits != 0) {
            tool_error(NULL, 0, "%s: \"%s\" says nothing and something, expected either", option, text);
            return false;
        }
        if (*at == '\0') {
            *mask = bits;
            return true;
        }
    }
}

bool tool_parse_switch(const char *option, const char *text, bool *value) {
    static const tool_word words[] = {{"on", 1}, {"off", 0}, {NULL, 0}};
    unsigned number;
    if (!tool_parse_word(option, text, words, &number)) {
        return false;
    }
    *value = number == 1;
    return true;
}

bool tool_has_extension(const char *path, const char *extension) {
    size_t length = strlen(path), tail = strlen(extension);
    return length > tail && strcasecmp(path + length - tail, extension) == 0;
}
