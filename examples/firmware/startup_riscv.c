/*
 * startup_riscv.c - from reset to main on one hart in machine mode: the stack, the FPU, data and bss, a painted stack; the
 * counter of instructions as a clock. (RISC-V International, "The RISC-V Instruction Set Manual", volume II: 3.1 machine CSRs.)
 */
#include "board.h"
#include "startup.h"

const char board_clock_unit[] = "instructions";

static uint32_t instructions_low(void) {
    uintptr_t n;
    __asm__ volatile("csrr %0, minstret" : "=r"(n));
    return (uint32_t)n;
}

static uint32_t instructions_high(void) {
    uintptr_t n = 0;
#if __riscv_xlen == 32
    __asm__ volatile("csrr %0, minstreth" : "=r"(n));
#else
    __asm__ volatile("csrr %0, minstret" : "=r"(n));
    n >>= 32;
#endif
    return (uint32_t)n;
}

uint64_t board_clock(void) {
    uint32_t high, low;
    do {
        high = instructions_high();
        low = instructions_low();
    } while (high != instructions_high());
    return (uint64_t)high << 32 | low;
}

/* With a stack of its own choice: the program's may be what is full. */
__attribute__((naked, aligned(4))) static void on_trap(void) {
    __asm__ volatile("la sp, stack_high\nj on_trap_told");
}

__attribute__((used)) void on_trap_told(void) {
    board_text("firmware: a fault: the stack is full, or an address is wrong\n");
    board_exit(2);
}

__attribute__((used)) void on_start(void) {
    __asm__ volatile("csrs mstatus, %0" : : "r"(1u << 13)); /* the FPU: initial */
    __asm__ volatile("csrw mtvec, %0" : : "r"(on_trap));
    stack_paint();
    for (uint32_t *to = &data_start, *from = &data_load; to < &data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = &bss_start; to < &bss_end;) {
        *to++ = 0;
    }
    board_exit(main());
}

__attribute__((naked, section(".vectors"), used)) void start(void) {
    __asm__ volatile(".option push\n.option norelax\nla gp, __global_pointer$\n.option pop\nla sp, stack_high\nj on_start");
}
