/* startup.h - what the linker scripts define, and what the startups and the board share. */
#ifndef FIRMWARE_STARTUP_H
#define FIRMWARE_STARTUP_H

#include <stdint.h>

/* Places, not variables: only their addresses mean something. */
extern uint32_t flash_start, flash_end; /* code and constants, and what the data start with */
extern uint32_t data_load, data_start, data_end, bss_start, bss_end;
extern uint32_t ram_start, ram_end;     /* data and bss */
extern uint32_t stack_low, stack_high;

int main(void);

/* Fills the unused stack with a pattern, for board_stack_deepest. */
void stack_paint(void);

/* Ends the program. */
void board_exit(int status);

#endif
