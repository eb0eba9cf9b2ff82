/* Start-up of a RISC-V core in machine mode with semihosting: stack, traps, floating-point unit. */
#include <stdint.h>

#include "board.h"

void reset(void);
void begin(void);
void trap(void);

__attribute__((naked, section(".first"), used)) void reset(void)
{
    __asm__ volatile(".option push\n .option arch, +zicsr\n"
                     "la sp, stack_top\n la t0, trap\n csrw mtvec, t0\n"
                     "li t0, 0x6000\n csrs mstatus, t0\n" /* FS: the FPU is on */
                     ".option pop\n tail begin");
}

static void semihost(uint32_t operation, const void *argument)
{
    register uint32_t a0 __asm__("a0") = operation;
    register const void *a1 __asm__("a1") = argument;
    __asm__ volatile(".balign 16\n .option push\n .option norvc\n"
                     "slli x0, x0, 0x1f\n ebreak\n srai x0, x0, 7\n .option pop"
                     : "+r"(a0) : "r"(a1) : "memory");
}

void say(const char *text) { semihost(0x04, text); /* SYS_WRITE0 */ }

static void leave(void)
{
    semihost(0x18, (const void *)0x20026); /* SYS_EXIT, ended by the application */
    for (;;) {
    }
}

__attribute__((aligned(4))) void trap(void)
{
    say("fault\n");
    leave();
}

uint32_t ticks(void)
{
    uint32_t count;
    __asm__ volatile(".option push\n .option arch, +zicsr\n csrr %0, minstret\n .option pop" : "=r"(count));
    return count;
}

void begin(void)
{
    for (uint32_t *to = &bss_start; to < &bss_end; to++) {
        *to = 0;
    }
    main();
    leave();
}
