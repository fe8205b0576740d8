/* main.c: counts the instructions of a step on a Cortex-M in qemu. */
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

/* In codegen/c/costs/board.c: instructions so far, a number for the host, the end. */
extern uint32_t instructions(void);
extern void print(uint32_t number);
extern void finish(void);

static khepera_memory memory;
static khepera_samples samples;
static khepera_residuals residuals;

static uint32_t counted(int steps)
{
    const uint32_t start = instructions();
    int k;

    for (k = 0; k < STEPS; ++k) {
        __asm__ volatile("" ::: "memory");
        if (steps) {
            khepera_step(&khepera_nominal_coefficients, &memory, &samples, &residuals);
        }
    }
    return instructions() - start;
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
    print(counted(1));
    print(counted(0));
    print(residuals.valid[0] ? 1u : 0u);
    finish();
    return 0;
}
