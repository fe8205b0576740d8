/* sign(value) * sqrt(|value|) */
static real signed_root(real value)
{
    return value < REAL(0.0) ? -MATH(sqrt)(-value) : MATH(sqrt)(value);
}
