/*
 * input.c - what a command reads, to be read more than once: a file, or standard input.
 *
 * What cannot be read twice goes through a temporary file. Standard input is kept so, once for all who look at it: the kind of scene
 * is told by its first bytes before it is loaded.
 */
#include "tool.h"

#include <errno.h>
#include <string.h>

static FILE *standard; /* standard input, once it was opened */
static bool has_failed; /* and said so */

static FILE *make_seekable(const char *path, FILE *stream) {
    char buffer[16384];
    size_t n;
    FILE *copy = tmpfile();
    if (copy == NULL) {
        tool_error(path, 0, "no temporary file to keep the input in: %s", strerror(errno));
        return NULL;
    }
    while ((n = fread(buffer, 1, sizeof buffer, stream)) > 0) {
        if (fwrite(buffer, 1, n, copy) != n) {
            tool_error(path, 0, "the temporary file for the input cannot be written: %s", strerror(errno));
            (void)fclose(copy);
            return NULL;
        }
    }
    if (ferror(stream) || fflush(copy) != 0) {
        tool_error(path, 0, "cannot be read: %s", strerror(errno));
        (void)fclose(copy);
        return NULL;
    }
    return copy;
}

static FILE *open_once(const char *path, bool is_standard) {
    FILE *stream = is_standard ? stdin : fopen(path, "rb");
    if (stream == NULL) {
        tool_error(path, 0, "cannot be opened: %s", strerror(errno));
        return NULL;
    }
    bool done = tool_input_note(stream, path);
    FILE *input = done && fseek(stream, 0, SEEK_SET) == 0 ? stream : done ? make_seekable(path, stream) : NULL;
    if (input != stream && !is_standard) {
        (void)fclose(stream);
    }
    return input;
}

FILE *tool_input_open(const char *path) {
    if (strcmp(path, "-") != 0) {
        return open_once(path, false);
    }
    if (standard == NULL && !has_failed) {
        standard = open_once(path, true);
        has_failed = standard == NULL;
    }
    if (standard != NULL) {
        rewind(standard);
    }
    return standard;
}

void tool_input_close(FILE *input) {
    if (input != NULL && input != standard) {
        (void)fclose(input);
    }
}
