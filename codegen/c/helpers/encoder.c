/* Takes a count; the difference to the one before is right also when the counter runs over. */
static void count_on({{ stem }}_encoder *encoder, int32_t count, bool first)
{
    const uint32_t step = first ? 0u : (uint32_t)count - encoder->count;

    encoder->increment = step <= INT32_MAX ? (int32_t)step : -(int32_t)(UINT32_MAX - step) - 1;
    encoder->total = first ? 0 : encoder->total + encoder->increment;
    encoder->count = (uint32_t)count;
}
