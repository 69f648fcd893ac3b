/*
 * kind.c - which kind of scene a file is: by its name's ending, and models else by how they begin, for programs that hand over
 * copies under names of their own.
 *
 * The formats give themselves away: a PLY begins with its name; a binary STL has 84 bytes and 50 for each triangle that it
 * announces, a text one begins with "solid" and has a facet; an OBJ is lines of words, of which the first that is no comment
 * tells. NFF, whose v looks alike, needs its name, or is what comes on standard input and is nothing else. A baked draft begins with a
 * word of its own.
 */
#include "tool.h"

#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* Longer comments than this at the start of an OBJ without a name hide what it is. */
#define LOOK_BYTES 4096u

typedef struct look {
    char bytes[LOOK_BYTES + 1]; /* closed by a 0 */
    size_t n;
    uint64_t size; /* of the whole file */
} look;

static bool look_into(look *l, FILE *file) {
    struct stat status;
    if (file == NULL || fstat(fileno(file), &status) != 0) {
        return false;
    }
    l->n = fread(l->bytes, 1, LOOK_BYTES, file);
    if (l->n >= 3 && memcmp(l->bytes, "\xef\xbb\xbf", 3) == 0) { /* the mark of a text in UTF-8 */
        l->n -= 3;
        memmove(l->bytes, l->bytes + 3, l->n);
    }
    l->bytes[l->n] = '\0';
    l->size = (uint64_t)status.st_size;
    return true;
}

static bool look_at(look *l, const char *path) {
    struct stat status;
    if (stat(path, &status) != 0 || !S_ISREG(status.st_mode)) {
        return false;
    }
    FILE *file = fopen(path, "rb");
    bool done = look_into(l, file);
    if (file != NULL) {
        (void)fclose(file);
    }
    return done;
}

static bool is_binary_stl(const look *l) {
    const unsigned char *count = (const unsigned char *)l->bytes + 80;
    if (l->n < 84) {
        return false;
    }
    uint64_t n = count[0] | (uint64_t)count[1] << 8 | (uint64_t)count[2] << 16 | (uint64_t)count[3] << 24;
    return l->size == 84 + 50 * n;
}

/* Whether a line's first word, which ends where rest begins, is one that an OBJ begins with. NFF's v stands alone. */
static bool is_obj_word(const char *word, size_t length, const char *rest) {
    static const char *const words[] = {"mtllib", "usemtl", "o", "g", "vn", "vt", "vp"};
    if (length == 1 && word[0] == 'v') {
        rest += strspn(rest, " \t");
        return *rest != '\0' && strchr("+-.0123456789", *rest) != NULL;
    }
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        if (strlen(words[i]) == length && memcmp(words[i], word, length) == 0) {
            return true;
        }
    }
    return false;
}

/* The first line that is neither blank nor a comment decides. */
static bool is_obj(const char *at) {
    for (;;) {
        at += strspn(at, " \t\r\n");
        size_t length = strcspn(at, " \t\r\n");
        if (*at != '#') {
            return is_obj_word(at, length, at + length);
        }
        at += strcspn(at, "\r\n");
    }
}

static tool_kind kind_of_bytes(const look *l) {
    const char *start = l->bytes + strspn(l->bytes, " \t\r\n");
    if (strncmp(l->bytes, "TDSA", 4) == 0 || strncmp(l->bytes, "ASDT", 4) == 0) { /* the lowest byte first, or last */
        return TOOL_KIND_DRAFT;
    }
    if (strncmp(l->bytes, "ply", 3) == 0 && (l->bytes[3] == '\n' || l->bytes[3] == '\r')) {
        return TOOL_KIND_PLY;
    }
    if (is_binary_stl(l) || (strncasecmp(start, "solid", 5) == 0 && (strstr(start, "facet") != NULL || strstr(start, "FACET") != NULL))) {
        return TOOL_KIND_STL;
    }
    return strlen(l->bytes) == l->n && is_obj(l->bytes) ? TOOL_KIND_OBJ : TOOL_KIND_NONE;
}

tool_kind tool_kind_of(const char *path) {
    static const char *const extensions[] = {".nff", ".obj", ".stl", ".ply", ".draft"};
    look l;
    if (strcmp(path, "-") == 0) {
        tool_kind kind = look_into(&l, tool_input_open(path)) ? kind_of_bytes(&l) : TOOL_KIND_NONE;
        return kind != TOOL_KIND_NONE ? kind : TOOL_KIND_NFF;
    }
    for (unsigned i = 0; i < sizeof extensions / sizeof extensions[0]; i++) {
        if (tool_has_extension(path, extensions[i])) {
            return (tool_kind)(TOOL_KIND_NFF + i);
        }
    }
    return look_at(&l, path) ? kind_of_bytes(&l) : TOOL_KIND_NONE;
}

bool tool_is_draft(const char *path) {
    return tool_kind_of(path) == TOOL_KIND_DRAFT;
}
