/* main.c: counts the instructions of a step on a Cortex-M in qemu, by its clock of one ns each. */
#include <stdint.h>

#include "khepera.h"

#define STEPS 10000
#define SETTLED 2000

/* A sample: in whole numbers it is times a power of two. */
#ifdef FIXED
#define OF(name, x) ((int32_t)((x) * (float)(1 << KHEPERA_BITS_##name)))
#else
#define OF(name, x) (x)
#endif

/* The system timer, which counts down at the clock of the board, and what makes the FPU work. */
#define TIMER ((volatile uint32_t *)0xE000E010u)
#define COPROCESSORS (*(volatile uint32_t *)0xE000ED88u)

extern uint32_t _estack, _sbss, _ebss;

void reset(void);
int main(void);

static void forever(void)
{
    for (;;) {
    }
}

void reset(void)
{
    volatile uint32_t *word;

#ifndef FIXED
    COPROCESSORS |= 0xFu << 20;
#endif
    for (word = &_sbss; word < &_ebss; ++word) {
        *word = 0u;
    }
    main();
    forever();
}

__attribute__((section(".vectors"), used)) static void *const vectors[16] = {
    &_estack, (void *)reset, (void *)forever, (void *)forever};

/* What the host does for the program: 4 prints, 0x18 ends it. */
static void host(int what, const void *with)
{
    register int r0 __asm__("r0") = what;
    register const void *r1 __asm__("r1") = with;

    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
}

static void print(uint32_t number)
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

static khepera_memory memory;
static khepera_samples samples;
static khepera_residuals residuals;

static uint32_t ticks(int steps)
{
    const uint32_t start = TIMER[2];
    int k;

    for (k = 0; k < STEPS; ++k) {
        __asm__ volatile("" ::: "memory");
        if (steps) {
            khepera_step(&khepera_nominal_coefficients, &memory, &samples, &residuals);
        }
    }
    return (start - TIMER[2]) & 0xFFFFFFu;
}

int main(void)
{
    int k;

    khepera_reset(&memory);
    samples.U0__1 = samples.U0__2 = OF(U0__1, 3.0f);
    samples.m__1__me__we = samples.m__2__me__we = OF(m__1__me__we, 40.0f);
    samples.m__1__wh__ws = samples.m__2__wh__ws = OF(m__1__wh__ws, 1.6f);
    samples.Uin = samples.Us = OF(Uin, 5.0f);
    for (k = 0; k < SETTLED; ++k) {
        khepera_step(&khepera_nominal_coefficients, &memory, &samples, &residuals);
    }
    TIMER[1] = 0xFFFFFFu;
    TIMER[2] = 0u;
    TIMER[0] = 5u;
    print(ticks(1));
    print(ticks(0));
    print(residuals.valid[0] ? 1u : 0u);
    host(0x18, (const void *)0x20026);
    return 0;
}
