/* value * |value| */
static real signed_square(real value)
{
    return value < REAL(0.0) ? -(value * value) : value * value;
}
