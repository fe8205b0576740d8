/* The search for a root: x, and on which sides it lies, if they are known. */
typedef struct search {
    real x;
    real guess;
    real low;
    real high;
    real wide; /* the next step while a side is open */
    real last; /* the size of the last value, or negative */
    bool rising;
    bool below;
    bool above;
} search;

/*
 * One step from the value and slope at x; true when x is the root. Newton's step where it stays
 * between the sides and halves the value, else half way, else a wider step to the open side.
 */
static bool found_root(search *s, real value, real slope)
{
    const real size = value < REAL(0.0) ? -value : value;
    const bool number = finite_number(size);
    const bool up = number || size > REAL(0.0)
        ? (value > REAL(0.0)) == s->rising
        : s->x > s->guess;
    const bool slow = !(number && (s->last < REAL(0.0) || size <= REAL(0.5) * s->last));
    real after = s->x - value / slope;
    bool near;

    if (size <= REAL(0.0)) {
        return true;
    }
    if (up) {
        s->high = s->x;
        s->above = true;
    } else {
        s->low = s->x;
        s->below = true;
    }
    if (!finite_number(slope) || !finite_number(after)
        || (s->above && after >= s->high) || (s->below && after <= s->low)
        || (slow && s->above && s->below)) {
        if (s->above && s->below) {
            after = s->low + REAL(0.5) * (s->high - s->low);
        } else {
            after = up ? s->x - s->wide : s->x + s->wide;
            s->wide *= REAL(2.0);
        }
    }
    s->last = number ? size : REAL(-1.0);
    slope = s->x + REAL(0.125) * (after - s->x);
    near = (slope >= s->x && slope <= s->x)
        || (s->above && s->below && s->high - s->low <= REAL(1.0e-36) * s->wide);
    s->x = after;
    return near;
}
