/* signals.h: what the steps are run on. */
#ifndef HAND_SIGNALS_H
#define HAND_SIGNALS_H

#include <math.h>

#include "step.h"

static void signals(double t, hand_samples *s)
{
    int j;

    for (j = 0; j < 2; ++j) {
        s->U0[j] = 3.0 + sin(6.28 * t + j);
        s->We[j] = 40.0 + 5.0 * sin(5.0 * t + j);
        s->Ws[j] = s->We[j] / 25.0 + 1e-3 * sin(3.0 * t);
        s->Fx[j] = 0.06;
    }
    s->Uin = 5.0;
    s->Us = 5.0 - 0.01 * sin(9.0 * t);
}

#endif
