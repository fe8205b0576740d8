/* The whole root of |value| times 2^shift, with the sign of the value. */
static int32_t signed_root(int32_t value, int shift)
{
    uint64_t rest = (uint64_t)(value < 0 ? -(int64_t)value : value) << shift;
    uint64_t found = 0u, bit = (uint64_t)1 << 62;

    while (bit > rest) {
        bit >>= 2;
    }
    for (; bit != 0u; bit >>= 2) {
        if (rest >= found + bit) {
            rest -= found + bit;
            found = (found >> 1) + bit;
        } else {
            found >>= 1;
        }
    }
    return value < 0 ? -(int32_t)found : (int32_t)found;
}
