"""Does drive_as_drawn_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import drive_as_drawn_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Fx", "me__we", "wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Fx=0.625, me__we=0.9375, wh__ws=0.34375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx=-0.875, me__we=0.90625, wh__ws=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx=0.03125, me__we=-0.15625, wh__ws=-0.3125), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(Fx=-0.90625, me__we=-0.09375, wh__ws=0.5), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Fx=0.28125, me__we=-0.5625, wh__ws=0.1875), ((0.02363616821654373,
    13.457910250541083), (0.0, 0.0),)),
    (m.Samples(Fx=-0.71875, me__we=-0.96875, wh__ws=0.6875), ((0.024916060782262595,
    0.7404650897362178), (0.0, 0.0),)),
    (m.Samples(Fx=-0.59375, me__we=0.09375, wh__ws=0.0625), ((0.02886261824106712,
    0.09695199429463583), (0.0, 0.0),)),
    (m.Samples(Fx=-0.15625, me__we=-0.03125, wh__ws=0.6875), ((0.03432698703791052,
    0.0894147492340198), (0.0, 0.0),)),
    (m.Samples(Fx=-0.78125, me__we=0.34375, wh__ws=0.4375), ((0.0428281681576532,
    0.10058524508964466), (0.0, 0.0),)),
    (m.Samples(Fx=0.8125, me__we=-0.125, wh__ws=0.0), ((0.053075641415785954, 0.11213812444403913),
    (0.0, 0.0),)),
    (m.Samples(Fx=-0.25, me__we=-0.375, wh__ws=-0.9375), ((0.059226546933268245,
    0.1499283562143213), (0.0, 0.0),)),
    (m.Samples(Fx=0.625, me__we=-0.1875, wh__ws=-0.0625), ((0.05688820810706892,
    0.12577157451614296), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, me__we=0.75, wh__ws=-0.75), ((0.0477997930523501, 0.12782824393512587),
    (0.0, 0.0),)),
    (m.Samples(Fx=-0.5625, me__we=-0.1875, wh__ws=0.25), ((0.0328906944041943, 0.094610997422338),
    (0.0, 0.0),)),
    (m.Samples(Fx=0.96875, me__we=-0.53125, wh__ws=-0.96875), ((0.013799847127218285,
    0.07566461736044894), (0.0, 0.0),)),
    (m.Samples(Fx=-0.96875, me__we=-0.28125, wh__ws=0.5), ((0.02024272579751874,
    0.06041995386808254), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, me__we=0.3125, wh__ws=0.375), ((0.04362395962690807,
    0.1031025534215425), (0.0, 0.0),)),
    (m.Samples(Fx=-0.125, me__we=0.9375, wh__ws=-0.625), ((0.06583823692645775,
    0.15163650126294978), (0.0, 0.0),)),
    (m.Samples(Fx=0.4375, me__we=0.375, wh__ws=-0.96875), ((0.09425646554717647,
    0.21777724302403573), (0.0, 0.0),)),
    (m.Samples(Fx=0.71875, me__we=-0.03125, wh__ws=0.25), ((0.12997367866317025,
    0.2778473829647421), (0.0, 0.0),)),
)

Input = TypeVar("Input")


def check(
    what: str, run: Callable[[Input], m.Residuals], golden: Iterable[tuple[Input, Result]]
) -> bool:
    """Whether all results are right; says so for each residual."""
    worst = dict.fromkeys(RESIDUALS, 0.0)
    for given, results in golden:
        found = run(given)
        for name, (value, size) in zip(RESIDUALS, results, strict=True):
            off = abs(getattr(found, name) - value) / (size or 1.0)
            if math.isnan(value):  # what exact does not have must be NaN
                off = 0.0 if math.isnan(getattr(found, name)) else math.nan
            worst[name] = max(worst[name], off if math.isfinite(off) else 1000.0)
    for name, off in worst.items():
        verdict = "PASS" if off <= TOLERANCE else "FAIL"
        print(f"{verdict} {what} {name}: error {off:.1e} of the terms")
    return max(worst.values()) <= TOLERANCE


def check_restart(monitor: m.Monitor) -> bool:
    """Whether a sample that is not a number is told, and everything starts anew after it."""
    told = True
    for sample, _ in STEP[:1]:
        before = {name: getattr(sample, name) for name in SIGNALS}
        for name in SIGNALS:
            setattr(sample, name, math.nan)
        told = not monitor.step(sample).valid.intersection(SPOILT)
        for name, value in before.items():
            setattr(sample, name, value)
    print(f"{'PASS' if told else 'FAIL'} a sample that is not a number")
    return told


def main() -> int:
    """Run all checks; 0 if they pass."""
    monitor = m.Monitor(PARAMETERS)
    passed = [
        check("exact", monitor.exact, EXACT),
        check("step", monitor.step, STEP),
        check_restart(monitor),
    ]
    monitor.reset()
    passed.append(check("step", monitor.step, STEP))
    print("PASS" if all(passed) else "FAIL")
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
