/* main.c: run one of the two steps on the same samples; `main generated|hand STEPS`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "khepera.h"
#include "signals.h"

int main(int count, char **words)
{
    const int hand = count > 1 && strcmp(words[1], "hand") == 0;
    const long steps = count > 2 ? atol(words[2]) : 10;
    static double r[5];
    static int valid[5];
    static hand_robot robot;
    static khepera_memory memory;
    static khepera_samples given;
    static khepera_residuals out;
    hand_samples s;
    long n;

    memset(&s, 0, sizeof s);
    s.r = r;
    s.valid = valid;
    hand_configure(&robot, 0.001, 20.0);
    khepera_reset(&memory);
    for (n = 0; n < steps; ++n) {
        signals(0.001 * (double)(n % 64), &s);
        if (hand) {
            hand_step(&robot, &s);
        } else {
            given.U0__1 = s.U0[0], given.U0__2 = s.U0[1], given.Uin = s.Uin, given.Us = s.Us;
            given.Fx__1 = s.Fx[0], given.Fx__2 = s.Fx[1];
            given.m__1__me__we = s.We[0], given.m__2__me__we = s.We[1];
            given.m__1__wh__ws = s.Ws[0], given.m__2__wh__ws = s.Ws[1];
            khepera_step(&khepera_nominal_coefficients, &memory, &given, &out);
        }
    }
    for (n = 0; n < 5; ++n) {
        printf("%.12g %d\n", hand ? r[n] : out.value[n], hand ? valid[n] : (int)out.valid[n]);
    }
    return 0;
}
