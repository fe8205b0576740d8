/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}
