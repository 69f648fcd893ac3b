/*
 * board.h - a small table of text, for `aset tables`.
 */
#ifndef ASET_TOOLS_BOARD_H
#define ASET_TOOLS_BOARD_H

#include "tool.h"

#define BOARD_COLUMNS 10u
#define BOARD_LINES 8u /* the head is the first */
#define BOARD_WIDTH 48u

/* The caller adds no more lines and columns than there are; longer texts are cut. */
typedef struct board {
    char text[BOARD_LINES][BOARD_COLUMNS][BOARD_WIDTH];
    uint32_t lines, columns, at;
} board;

/* Empties it and fills the head: names with a | between. */
void board_head(board *b, const char *names);
void board_next(board *b);
/* The next column of the line. */
void board_add(board *b, const char *format, ...) TOOL_PRINTF(2, 3);
/* "0.75 (1.09)*": measured, published in brackets, a star if they differ; a dash and nothing for what is missing (0). */
void board_pair(board *b, double measured, double published, int digits, bool differs);
/* The same for figures that are no ratios: no star, and 0 is a measured number. */
void board_shown(board *b, double measured, double published, int digits);
void board_print(FILE *stream, const board *b, bool markdown);

#endif
