/* Start-up of a Cortex-M with semihosting: vector table, data and bss, floating-point unit, and a
 * timer of 32 bits of the board, which counts instructions where an emulator's clock does. */
#include <stdint.h>

#include "board.h"

extern uint32_t stack_top, data_load, data_start, data_end, bss_start;
void reset(void);
void fault(void);

#define AT(address) (*(volatile uint32_t *)(address))

__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    &stack_top, (void *)reset, (void *)fault, (void *)fault, (void *)fault,
    (void *)fault, (void *)fault,
};

static void semihost(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

void say(const char *text) { semihost(0x04, text); /* SYS_WRITE0 */ }

static void leave(void)
{
    semihost(0x18, (const void *)0x20026); /* SYS_EXIT, ended by the application */
    for (;;) {
    }
}

void fault(void)
{
    say("fault\n");
    leave();
}

#if defined(MICROBIT) /* TIMER0 of the nRF51, at 16 MHz */
static void start(void)
{
    AT(0x40008508) = 3; /* 32 bits */
    AT(0x40008510) = 0; /* no prescaler */
    AT(0x40008000) = 1;
}

uint32_t ticks(void)
{
    AT(0x40008040) = 1;
    return AT(0x40008540);
}
#else /* timer 0 of the MPS2 boards, at 25 MHz, counts down */
static void start(void)
{
    AT(0x40000008) = 0xFFFFFFFFu;
    AT(0x40000004) = 0xFFFFFFFFu;
    AT(0x40000000) = 1;
}

uint32_t ticks(void) { return ~AT(0x40000004); }
#endif

void reset(void)
{
    const uint32_t *from = &data_load;
    for (uint32_t *to = &data_start; to < &data_end; to++) {
        *to = *from++;
    }
    for (uint32_t *to = &bss_start; to < &bss_end; to++) {
        *to = 0;
    }
#if defined(__ARM_FP)
    AT(0xE000ED88) |= 0xFu << 20; /* CPACR: full access to the FPU */
    __asm__ volatile("dsb\n isb");
#endif
    start();
    main();
    leave();
}
