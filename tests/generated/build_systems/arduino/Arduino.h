/* As much of Arduino as the sketch asks for: a clock that runs, a line that is printed. */
#include <stdio.h>

static unsigned long ticks;
static unsigned long micros() { return ticks += 500; }
static struct {
    void begin(long) {}
    void println(const char *text) { puts(text); }
} Serial;
