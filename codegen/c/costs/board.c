/* board.c: start, clock and host of main.c, on a Cortex-M or a RISC-V in qemu, or on a computer. */
#include <stdint.h>

extern uint32_t instructions(void);
extern void print(uint32_t number);
extern void finish(void);

#if defined __arm__ || defined __riscv

extern int main(void);
extern uint32_t stack_top, __bss_start__, __bss_end__, data_start, data_end, data_in_flash;

void begin(void);
void begin(void)
{
    uint32_t *word;

#ifdef __arm__
    const uint32_t *from = &data_in_flash;

    for (word = &data_start; word < &data_end; ++word) {
        *word = *from++;
    }
#endif
    for (word = &__bss_start__; word < &__bss_end__; ++word) {
        *word = 0u;
    }
    main();
    finish();
}

static void host(int what, const void *with);

/* Semihosting: 4 prints. */
void print(uint32_t number)
{
    char text[12];
    int at = 11;

    text[at] = '\0';
    text[--at] = '\n';
    do {
        text[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number);
    host(4, text + at);
}

/* 0x18 ends qemu. */
void finish(void)
{
    host(0x18, (const void *)0x20026);
    for (;;) {
    }
}

#else /* callgrind counts */

#include <stdio.h>
#include <stdlib.h>

uint32_t instructions(void)
{
    return 0u;
}

void print(uint32_t number)
{
    printf("%u\n", number);
}

void finish(void)
{
    exit(0);
}

#endif

#ifdef __arm__

/* The system timer counts down, one at 25 MHz; qemu gives each instruction a nanosecond. */
#define TIMER ((volatile uint32_t *)0xE000E010u)
#define INSTRUCTIONS_A_TICK 40u

uint32_t instructions(void)
{
    static uint32_t ticks, last;

    if (TIMER[0] == 0u) {
        TIMER[1] = 0xFFFFFFu;
        TIMER[2] = 0u;
        TIMER[0] = 5u;
        last = TIMER[2];
    }
    ticks += (last - TIMER[2]) & 0xFFFFFFu;
    last = TIMER[2];
    return ticks * INSTRUCTIONS_A_TICK;
}

static void host(int what, const void *with)
{
    register int r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;

    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void reset(void)
{
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* the floating-point unit, where there is one */
    begin();
}

__attribute__((section(".vectors"), used)) static void *const vectors[4] = {
    &stack_top, (void *)reset, (void *)finish, (void *)finish};

#endif

#ifdef __riscv

uint32_t own_errno[16]; /* what the C library keeps for each thread */

uint32_t instructions(void)
{
    uint32_t found;

    __asm__ volatile(".insn i 0x73, 2, %0, x0, -1022" : "=r"(found)); /* rdinstret */
    return found;
}

static void host(int what, const void *with)
{
    register int a0 __asm__("a0") = what;
    register const void *a1 __asm__("a1") = with;

    __asm__ volatile(".option push\n.option norvc\n.balign 16\nslli x0, x0, 0x1f\nebreak\n"
                     "srai x0, x0, 7\n.option pop" : "+r"(a0) : "r"(a1) : "memory");
}

__asm__(".section .vectors, \"ax\"\n.globl _start\n_start:\nla sp, stack_top\n"
        "la tp, own_errno\ncall begin\n.text\n");

#endif
