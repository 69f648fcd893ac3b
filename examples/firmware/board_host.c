/* board_host.c - the host as a board: for the pictures that the real ones are compared with. */
#include "board.h"

#include <stdio.h>

static FILE *file;

int board_open(const char *name) {
    file = fopen(name, "wb");
    return file != NULL ? 0 : -1;
}

int board_write(int number, const void *bytes, size_t n) {
    (void)number;
    return fwrite(bytes, 1, n, file) != n;
}

void board_close(int number) {
    (void)number;
    fclose(file);
}

void board_text(const char *text) {
    fputs(text, stdout);
}

const char board_clock_unit[] = "ticks";

uint64_t board_clock(void) {
    return 0;
}

size_t board_stack_deepest(void) {
    return 0;
}

size_t board_stack_bytes(void) {
    return 0;
}

size_t board_ram_bytes(void) {
    return 0;
}

size_t board_flash_bytes(void) {
    return 0;
}
