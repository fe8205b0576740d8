"""The linear part of the robot's step: its filters, without tanh, first samples and validity.

It is cut out of the generated C, which is otherwise as written: what is counted is what a compiler
makes of the rest. ValueError where the C has another form than the cuts are for.
"""

from __future__ import annotations

import re

#: What corrects the hold between samples, beside a filter by the trapezoid rule alone.
_CORRECTION = (
    (r"    /\* error of order \d \*/\n    const real e\d = c->bend\d \* g\d;\n\n", "", 8),
    (r"\s\+ e0;", ";", 4),
    (r"const real p2_1 = e1 - d2;\n    const real p1_1 = p2_1 \+ e1;\n", "const real p1_1 = -d2;\n",
     4),
    (r"p1_2 = g1 - p2_1;", "p1_2 = g1 + d2;", 4),
    (r"\+ p1_1 \+ e1;", "+ p1_1;", 4),
    (r"= y1 - e1;", "= y1;", 4),
)  # fmt: skip


def of(text: str, corrected: bool = True) -> str:
    """The C of a step in floating point, and what is left of it; perhaps not `corrected`."""
    begin = text.index("/* r1 on one sample")
    end = text.index("#ifndef KHEPERA_NO_THRESHOLDS", begin)
    step = text[begin:end]
    cuts = [
        (r"    const real tanh_ = run_r\d_tanh\(c, x, s, first\);\n\n", "", 2),
        (r"c->r\d_w1_tanh \* tanh_ - (c->r\d_w1_Fx__\d \* s->Fx__\d;)", r"-\1", 2),
        (r"first = x->youngest == 0u && x->age\[\d\] == 0u;", "first = false;", 5),
        (r"    /\* a sum is finite only if .*?\n\}\n", "    (void)k; (void)count_samples;\n}\n", 1),
        *(() if corrected else _CORRECTION),
    ]
    return text[:begin] + _cut(step, cuts) + text[end:]


def of_fixed(text: str) -> str:
    """The same of a step in whole numbers."""
    fade = r"(?<=\{\n)(    /\* sample_time/24 times .*?)(?=    /\* terms of order 0 \*/)"
    tanh = r"\(int64_t\)c->r\d_w1_tanh \* tanh_ \+ (?=\(int64_t\)c->r\d_w1_Fx)"
    run = (
        r"    if \(young && x->age\[\d\] == 0u\) \{\n        (first_r\d)\(c, x, s, r\);\n"
        r"    \} else \{\n(        run_r\d\(c, x, s, r\);\n)    \}\n"
    )
    cuts = [
        (fade, "", 4),
        (tanh, "", 4),
        (run, r"\2    (void)young; (void)\1;" + "\n", 5),
        (r"good = are_within\(samples\)", "good = true", 1),
        (r"    if \(good && x->youngest > .*?\n        for", "    {\n        for", 1),
        (r"    \} else \{\n        count_samples\(.*?\n    \}\n",
         "    }\n    (void)are_within; (void)count_samples;\n", 1),
    ]  # fmt: skip
    return _cut(text, cuts)


def _cut(text: str, cuts: list[tuple[str, str, int]]) -> str:
    for pattern, new, times in cuts:
        text, found = re.subn(pattern, new, text, flags=re.DOTALL)
        if found != times:
            raise ValueError(f"the step is written in another way: {found} of {pattern!r}")
    return text
