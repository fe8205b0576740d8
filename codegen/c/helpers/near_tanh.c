/* tanh to {{ near.bound }}, without a library: a quotient of polynomials in the square of x. */
static real near_tanh(real x)
{
    const real square = x * x;
    real above = REAL({{ near.above[0] }});
    real below = square + REAL({{ near.below[1] }});

    if (square > REAL({{ near.far }})) {
        return x < REAL(0.0) ? REAL(-1.0) : REAL(1.0);
    }
{% for factor in near.above[1:] %}
    above = above * square + REAL({{ factor }});
{% endfor %}
{% for factor in near.below[2:] %}
    below = below * square + REAL({{ factor }});
{% endfor %}
    return x * above / below;
}
