/*
 * board.h - all that the two programs ask of a board, and of the host, where they are built too: a file for rows, a line of
 * text, a clock, how deep the stack has been. A port is one file that answers these: board_semihosting.c, board_host.c.
 */
#ifndef FIRMWARE_BOARD_H
#define FIRMWARE_BOARD_H

#include <stddef.h>
#include <stdint.h>

/* Opens a new file to write to. Below 0: it cannot be had. */
int board_open(const char *name);

/* Writes all of it. Not 0: it could not. */
int board_write(int file, const void *bytes, size_t n);
void board_close(int file);

void board_text(const char *text);

/* What has passed since the start, in board_clock_unit; 0, always, where there is no clock. */
uint64_t board_clock(void);
extern const char board_clock_unit[];

/* The most bytes of stack that were ever in use, and those that there are; 0 where nobody knows. */
size_t board_stack_deepest(void);
size_t board_stack_bytes(void);

/* Bytes of RAM that the whole program has besides its stack, and of code and constants; 0 where nobody knows. */
size_t board_ram_bytes(void);
size_t board_flash_bytes(void);

#endif
