/*
 * board.c - a small table of text that is filled line by line and then printed with columns of equal width or as Markdown.
 */
#include "board.h"

#include <stdarg.h>
#include <string.h>

void board_add(board *b, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(b->text[b->lines - 1u][b->at++], BOARD_WIDTH, format, arguments);
    va_end(arguments);
    b->columns = b->at > b->columns ? b->at : b->columns;
}

void board_next(board *b) {
    b->lines++;
    b->at = 0;
}

void board_head(board *b, const char *names) {
    memset(b, 0, sizeof *b);
    board_next(b);
    for (size_t n = strcspn(names, "|");; n = strcspn(names, "|")) {
        board_add(b, "%.*s", (int)n, names);
        if (names[n] == '\0') {
            return;
        }
        names += n + 1;
    }
}

void board_pair(board *b, double measured, double published, int digits, bool differs) {
    char own[24] = "-", theirs[24] = "";
    if (measured > 0.0) {
        (void)snprintf(own, sizeof own, "%.*f", digits, measured);
    }
    if (published > 0.0) {
        (void)snprintf(theirs, sizeof theirs, " (%.*f)", digits, published);
    }
    board_add(b, "%s%s%s", own, theirs, differs ? "*" : "");
}

void board_shown(board *b, double measured, double published, int digits) {
    if (published > 0.0) {
        board_add(b, "%.*f (%.*f)", digits, measured, digits, published);
    } else {
        board_add(b, "%.*f", digits, measured);
    }
}

void board_print(FILE *stream, const board *b, bool markdown) {
    size_t width[BOARD_COLUMNS] = {0};
    for (uint32_t k = 0; k < b->columns; k++) {
        for (uint32_t i = 0; i < b->lines; i++) {
            size_t n = strlen(b->text[i][k]);
            width[k] = n > width[k] ? n : width[k];
        }
    }
    for (uint32_t i = 0; i < b->lines; i++) {
        for (uint32_t k = 0; k < b->columns; k++) {
            if (markdown) {
                (void)fprintf(stream, "| %s ", b->text[i][k]);
            } else {
                (void)fprintf(stream, k == 0 ? "%-*s" : "  %*s", (int)width[k], b->text[i][k]);
            }
        }
        (void)fprintf(stream, markdown ? "|\n" : "\n");
        for (uint32_t k = 0; k < b->columns && markdown && i == 0; k++) {
            (void)fprintf(stream, k + 1 < b->columns ? "|---" : "|---|\n");
        }
    }
    (void)fputc('\n', stream);
}
