/* step.h: the robot's five residuals, written by hand. */
#ifndef HAND_STEP_H
#define HAND_STEP_H

typedef struct hand_filter {
    double a, b, bend; /* a stage, and (w T)^2/12 */
} hand_filter;

typedef struct hand_drive {
    double e0, s0, x0, e1, s1, x1, e2, s2; /* r1: of We, Ws, Fx by order */
    double n, p2, px, pw, ge, gs;          /* r2: of Ws by order, of Fx, of w; T/24 of the angle */
    double r1[3], r2[3], q, rate1, rate2;
    unsigned age1, age2;
} hand_drive;

typedef struct hand_robot {
    hand_filter f;
    hand_drive drive[2];
    double r3;
    unsigned age3, settle3, settle1;
    int settled; /* all five are valid */
} hand_robot;

typedef struct hand_samples {
    double U0[2], We[2], Ws[2], Fx[2], Uin, Us;
    double *r;  /* five residuals out: r1, r2 of each drive, then the cable's */
    int *valid;
} hand_samples;

void hand_configure(hand_robot *h, double sample_time, double bandwidth);
void hand_step(hand_robot *h, const hand_samples *s);

#endif
