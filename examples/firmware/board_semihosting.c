/*
 * board_semihosting.c - files and text by semihosting: the debugger, or QEMU, does what the operation's number says (Arm,
 * "Semihosting for AArch32 and AArch64"; RISC-V International, "RISC-V Semihosting" takes the same numbers). On a board of
 * your own, replace this file: board_write goes to the display.
 */
#include "board.h"
#include "startup.h"

enum { SYS_OPEN = 0x01, SYS_CLOSE = 0x02, SYS_WRITE0 = 0x04, SYS_WRITE = 0x05, SYS_EXIT_EXTENDED = 0x20 };
enum { MODE_WRITE_BINARY = 5, STOPPED_APPLICATION_EXIT = 0x20026 };

#if defined(__arm__)
static intptr_t call(intptr_t operation, const void *block) {
    register intptr_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = block;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}
#else
/* RISC-V: these three instructions, uncompressed and within one page, mean a call; both arguments are where they belong. */
intptr_t call(intptr_t operation, const void *block);
__asm__(".pushsection .text.call, \"ax\"\n.option push\n.option norvc\n.balign 16\n.globl call\ncall:\n"
        "slli zero, zero, 0x1f\nebreak\nsrai zero, zero, 7\nret\n.option pop\n.popsection");
#endif

int board_open(const char *name) {
    intptr_t n = 0;
    while (name[n] != '\0') {
        n++;
    }
    const intptr_t block[3] = {(intptr_t)name, MODE_WRITE_BINARY, n};
    return (int)call(SYS_OPEN, block);
}

int board_write(int file, const void *bytes, size_t n) {
    const intptr_t block[3] = {file, (intptr_t)bytes, (intptr_t)n};
    return call(SYS_WRITE, block) != 0; /* it tells what it did not write */
}

void board_close(int file) {
    const intptr_t block[1] = {file};
    (void)call(SYS_CLOSE, block);
}

void board_text(const char *text) {
    (void)call(SYS_WRITE0, text);
}

void board_exit(int status) {
    const intptr_t block[2] = {STOPPED_APPLICATION_EXIT, status};
    for (;;) {
        (void)call(SYS_EXIT_EXTENDED, block);
    }
}

/* ---- what the startup and the linker script know ---- */

#define STACK_PAINT 0xa5a5a5a5u

void stack_paint(void) {
    volatile uint32_t *here = &stack_low, *end = __builtin_frame_address(0);
    while (here < end - 16) { /* below this frame, and the few words that this function may still push */
        *here++ = STACK_PAINT;
    }
}

size_t board_stack_deepest(void) {
    const volatile uint32_t *at = &stack_low;
    while (at < &stack_high && *at == STACK_PAINT) {
        at++;
    }
    return (size_t)((const char *)&stack_high - (const char *)at);
}

size_t board_stack_bytes(void) {
    return (size_t)((const char *)&stack_high - (const char *)&stack_low);
}

size_t board_ram_bytes(void) {
    return (size_t)((const char *)&ram_end - (const char *)&ram_start);
}

size_t board_flash_bytes(void) {
    return (size_t)((const char *)&flash_end - (const char *)&flash_start);
}
