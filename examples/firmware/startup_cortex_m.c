/*
 * startup_cortex_m.c - from reset to main on a Cortex-M: the table of vectors, the FPU, data and bss, a painted stack, the
 * SysTick timer as a clock. (Arm, "ARMv7-M Architecture Reference Manual": B1.5 exceptions, B3.2 system control, B3.3 SysTick.)
 */
#include "board.h"
#include "startup.h"

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
#define CPACR REGISTER(0xe000ed88) /* who may use the coprocessors: 10 and 11 are the FPU */
#define SYST_CSR REGISTER(0xe000e010)
#define SYST_RVR REGISTER(0xe000e014)
#define SYST_CVR REGISTER(0xe000e018)
#define SYST_RANGE 0x1000000u

static volatile uint32_t wraps; /* of the 24 bits of SysTick */

#ifdef INSTRUCTIONS_A_TICK /* under qemu -icount 0 an instruction takes 1 ns of the board's time, and a tick so many of them */
const char board_clock_unit[] = "instructions";
#else
#define INSTRUCTIONS_A_TICK 1
const char board_clock_unit[] = "cycles";
#endif

uint64_t board_clock(void) {
    uint32_t high, low;
    do {
        high = wraps;
        low = SYST_CVR; /* counts down */
    } while (high != wraps);
    return ((uint64_t)high * SYST_RANGE + (SYST_RANGE - 1 - low)) * INSTRUCTIONS_A_TICK;
}

static void on_tick(void) {
    wraps++;
}

/* With the stack from its upper end: it may be what is full. */
__attribute__((naked)) static void on_fault(void) {
    __asm__ volatile("ldr r0, =stack_high\nmsr msp, r0\nb on_fault_told");
}

__attribute__((used)) void on_fault_told(void) {
    board_text("firmware: a fault: the stack is full, or an address is wrong\n");
    board_exit(2);
}

static void on_reset(void) {
    CPACR |= 0xfu << 20;
    __asm__ volatile("dsb\nisb" : : : "memory");
    stack_paint();
    for (uint32_t *to = &data_start, *from = &data_load; to < &data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = &bss_start; to < &bss_end;) {
        *to++ = 0;
    }
    SYST_RVR = SYST_RANGE - 1;
    SYST_CVR = 0;
    SYST_CSR = 7; /* on, with its interrupt, by the processor's clock */
    board_exit(main());
}

typedef void (*vector)(void);

/* The first word is the stack's upper end; 1 reset, 2 to 6 faults, 15 SysTick. */
__attribute__((section(".vectors"), used)) static const struct {
    uint32_t *stack;
    vector table[15];
} vectors = {&stack_high,
             {on_reset, on_fault, on_fault, on_fault, on_fault, on_fault, on_fault, on_fault, on_fault, on_fault, on_fault,
              on_fault, on_fault, on_fault, on_tick}};
