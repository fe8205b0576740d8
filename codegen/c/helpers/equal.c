/* The same number; the model asks for it. */
static bool equal(real left, real right)
{
    return left <= right && left >= right;
}
