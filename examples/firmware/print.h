/* print.h - a line of a report without printf, which would bring more code than the pictures. */
#ifndef FIRMWARE_PRINT_H
#define FIRMWARE_PRINT_H

#include "board.h"

/* "label: number unit". */
static inline void print_number(const char *label, uint64_t number, const char *unit) {
    char digits[21];
    char *at = digits + sizeof digits - 1;
    *at = '\0';
    do {
        *--at = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    board_text(label);
    board_text(": ");
    board_text(at);
    board_text(unit);
    board_text("\n");
}

#endif
