/*
 * One communication step of the machine, in as many steps as its tolerance asks for: the method
 * RODAS, of order 4 with an estimate of order 3, for stiff machines too (Hairer and Wanner, Solving
 * Ordinary Differential Equations II, 1996, section IV.7; the numbers are those of their table).
 */

/* Steps of integration within one communication step, at most; the shortest of them, relative. */
#define MOST_STEPS 1000000
#define SHORTEST 1e-15
/* Which part of the relative tolerance counts for a state that is about zero; see `scale`. */
#define ABSOLUTE 0.1

static bool rates(component *c, const double *x, double *rate)
{
    double sum = 0.0;
    int k;

    feclearexcept(TROUBLE);
    if (!rates_at(c->m.own.p, x, c->m.own.u, rate) || fetestexcept(TROUBLE)) {
        return false;
    }
    for (k = 0; k < STATES; ++k) {
        sum += fabs(rate[k]);
    }
    return sum < BEYOND;
}

/*
 * How the rates change with the states: by central differences, on one side where the other has no
 * rates. `rate`, `trial` and two k are used up.
 */
static bool differentiate(component *c)
{
    workspace *w = &c->work;
    int i, j;

    memcpy(w->trial, c->m.own.x, sizeof w->trial);
    if (!rates(c, w->trial, w->rate)) {
        return false;
    }
    for (j = 0; j < STATES; ++j) {
        const double own = w->trial[j], h = 1e-6 * fmax(fabs(own), scale[j]);
        const double *up = w->rate, *down = w->rate;
        double width = 0.0;

        w->trial[j] = own + h;
        if (rates(c, w->trial, w->k[0])) {
            up = w->k[0];
            width += h;
        }
        w->trial[j] = own - h;
        if (rates(c, w->trial, w->k[1])) {
            down = w->k[1];
            width += h;
        }
        w->trial[j] = own;
        if (!(width > 0.0)) {
            return false;
        }
        for (i = 0; i < STATES; ++i) {
            w->slopes[i * STATES + j] = (up[i] - down[i]) / width;
        }
    }
    return true;
}

/*
 * I/(gamma h) - slopes, as triangular factors with row pivots. A determinant that is not positive
 * tells of a motion that grows within less than a step, which the method would damp: false too.
 */
static bool factorise(workspace *w, double diagonal)
{
    double *a = w->system;
    bool positive = true;
    int i, j, k;

    for (k = 0; k < STATES * STATES; ++k) {
        a[k] = -w->slopes[k];
    }
    for (k = 0; k < STATES; ++k) {
        a[k * STATES + k] += diagonal;
    }
    for (k = 0; k < STATES; ++k) {
        int pivot = k;

        for (i = k + 1; i < STATES; ++i) {
            pivot = fabs(a[i * STATES + k]) > fabs(a[pivot * STATES + k]) ? i : pivot;
        }
        w->order[k] = pivot;
        if (!(fabs(a[pivot * STATES + k]) > 0.0)) {
            return false;
        }
        positive ^= (pivot != k) ^ (a[pivot * STATES + k] < 0.0);
        for (j = 0; j < STATES; ++j) {
            const double other = a[k * STATES + j];
            a[k * STATES + j] = a[pivot * STATES + j];
            a[pivot * STATES + j] = other;
        }
        for (i = k + 1; i < STATES; ++i) {
            const double share = a[i * STATES + k] / a[k * STATES + k];
            a[i * STATES + k] = share;
            for (j = k + 1; share != 0.0 && j < STATES; ++j) {
                a[i * STATES + j] -= share * a[k * STATES + j];
            }
        }
    }
    return positive;
}

/* The right side becomes the solution. */
static void substitute(const workspace *w, double *right)
{
    const double *a = w->system;
    int i, j;

    for (i = 0; i < STATES; ++i) {
        const double other = right[i];
        right[i] = right[w->order[i]];
        right[w->order[i]] = other;
    }
    for (i = 0; i < STATES; ++i) {
        for (j = 0; j < i; ++j) {
            right[i] -= a[i * STATES + j] * right[j];
        }
    }
    for (i = STATES - 1; i >= 0; --i) {
        for (j = i + 1; j < STATES; ++j) {
            right[i] -= a[i * STATES + j] * right[j];
        }
        right[i] /= a[i * STATES + i];
    }
}

#define GAMMA 0.25

/* The six stages of a step of length h; `trial` is the state after it, k[5] the estimated error. */
static bool stages(component *c, double h)
{
    static const double a[4][4] = {
        {1.544},
        {0.9466785280815826, 0.2557011698983284},
        {3.314825187068521, 2.896124015972201, 0.9986419139977817},
        {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950}};
    static const double b[5][5] = {
        {-5.6688},
        {-2.430093356833875, -0.2063599157091915},
        {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
        {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
        {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136,
            -6.058818238834054}};
    workspace *w = &c->work;
    int s, i, j;

    for (s = 0; s < 6; ++s) {
        for (i = 0; i < STATES; ++i) {
            double sum = s == 5 ? w->trial[i] + w->k[4][i] : c->m.own.x[i];
            for (j = 0; j < s && s < 5; ++j) {
                sum += a[s - 1][j] * w->k[j][i];
            }
            w->trial[i] = sum;
        }
        if (!rates(c, w->trial, w->k[s])) {
            return false;
        }
        for (i = 0; i < STATES; ++i) {
            for (j = 0; j < s; ++j) {
                w->k[s][i] += b[s - 1][j] * w->k[j][i] / h;
            }
        }
        substitute(w, w->k[s]);
    }
    for (i = 0; i < STATES; ++i) {
        w->trial[i] += w->k[5][i];
    }
    return true;
}

/* The estimated error of the last step, in tolerances; not a number where a state is none. */
static double error_of_step(const component *c)
{
    const workspace *w = &c->work;
    double sum = 0.0;
    int i;

    for (i = 0; i < STATES; ++i) {
        const double size = fmax(fabs(c->m.own.x[i]), fabs(w->trial[i])) + ABSOLUTE * scale[i];
        const double part = w->k[5][i] / (c->m.tolerance * size);
        sum += part * part;
    }
    return sqrt(sum / ROOM);
}

static bool integrate(component *c, double step)
{
    workspace *w = &c->work;
    double done = 0.0, h = c->m.own.h > 0.0 ? c->m.own.h : step;
    bool fresh = true;
    long k;

    for (k = 0; STATES > 0 && done < step; ++k) {
        const bool last = h >= step - done;
        const double own = last ? step - done : h;
        double error = HUGE_VAL;

        if (k >= MOST_STEPS || !(own > SHORTEST * step)) {
            return refuse(c, "the machine cannot go on at %.9g s: a law has no value or jumps"
                " there, or what it holds grows without bound", c->m.time + done);
        }
        if (fresh && !differentiate(c)) {
            return refuse(c, "at %.9g s a law or a loop of the machine has no value",
                c->m.time + done);
        }
        fresh = false;
        if (factorise(w, 1.0 / (GAMMA * own)) && stages(c, own)) {
            error = error_of_step(c);
        }
        if (error <= 1.0) {
            memcpy(c->m.own.x, w->trial, sizeof w->trial);
            done = last ? step : done + own;
            fresh = true;
        }
        error = error < HUGE_VAL ? fmax(pow(error, 0.25) / 0.9, 1.0 / 6.0) : 5.0;
        if (!last || error > 1.0) {
            h = own / fmin(error, 5.0);
        } else {
            h = fmax(h, own / error);
        }
    }
    c->m.own.h = h;
    return true;
}
