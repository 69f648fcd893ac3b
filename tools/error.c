/*
 * error.c - what the tool says: error lines and help texts.
 *
 * Invariant: an error is one line, whatever bytes its parts hold, so that a program can read the stream by lines.
 */
#include "tool.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>

/* Longest error line; what is longer (a path of thousands of bytes) is cut, not split. */
#define LINE_MAX_BYTES 8192

/* Bytes from 0x80 stay as they are: they are letters in UTF-8 names. */
static void print_clean(const char *text) {
    for (; *text != '\0'; text++) {
        unsigned char byte = (unsigned char)*text;
        (void)fputc(byte < 0x20 || byte == 0x7f ? '?' : byte, stderr);
    }
}

void tool_error(const char *file, unsigned long line, const char *format, ...) {
    char message[LINE_MAX_BYTES];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (length < 0) {
        message[0] = '\0';
    }
    tool_progress_hide();
    (void)fputs("aset: ", stderr);
    if (file != NULL) {
        print_clean(file);
        if (line > 0) {
            (void)fprintf(stderr, ":%lu", line);
        }
        (void)fputs(": ", stderr);
    }
    print_clean(message);
    (void)fputc('\n', stderr);
}

int tool_help(const char *text) {
    if (fputs(text, stdout) == EOF || fflush(stdout) != 0 || ferror(stdout) != 0) {
        tool_error(tool_output_name("-"), 0, "cannot write: %s", strerror(errno));
        return TOOL_FAILED;
    }
    return TOOL_DONE;
}
