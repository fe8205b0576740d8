/* The smaller of two numbers. */
static real least(real left, real right)
{
    return right < left ? right : left;
}
