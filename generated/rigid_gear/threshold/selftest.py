"""Does rigid_gear_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import rigid_gear_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "w1", "w2",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(w1=0.625, w2=0.9375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(w1=0.34375, w2=-0.875), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(w1=0.90625, w2=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(w1=0.03125, w2=-0.15625), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(w1=-0.3125, w2=-0.90625), ((0.00018229166666666667, 0.0003647656248920275), (0.0,
    0.0),)),
    (m.Samples(w1=-0.09375, w2=0.5), ((0.00018226654658040062, 0.00037398056998034834), (0.0,
    0.0),)),
    (m.Samples(w1=0.28125, w2=-0.5625), ((0.000182180744389261, 0.00037426299083295343), (0.0,
    0.0),)),
    (m.Samples(w1=0.1875, w2=-0.71875), ((0.00018204239158859607, 0.0003739950970823814), (0.0,
    0.0),)),
    (m.Samples(w1=-0.96875, w2=0.6875), ((0.00018186258908240338, 0.00037364571254927385), (0.0,
    0.0),)),
    (m.Samples(w1=-0.59375, w2=0.09375), ((0.0001816292472806659, 0.00037314102875731853), (0.0,
    0.0),)),
    (m.Samples(w1=0.0625, w2=-0.15625), ((0.00018134261688613416, 0.0003725406940864723), (0.0,
    0.0),)),
    (m.Samples(w1=-0.03125, w2=0.6875), ((0.00018099336093433042, 0.00037184243135470385), (0.0,
    0.0),)),
    (m.Samples(w1=-0.78125, w2=0.34375), ((0.00018056895914097363, 0.0003709559425954337), (0.0,
    0.0),)),
    (m.Samples(w1=0.4375, w2=0.8125), ((0.00018006598922169244, 0.00036994274218710843), (0.0,
    0.0),)),
    (m.Samples(w1=-0.125, w2=0.0), ((0.0001794802748666526, 0.00036869353554036153), (0.0, 0.0),)),
    (m.Samples(w1=-0.25, w2=-0.375), ((0.00017884061462159045, 0.00036736926050910527), (0.0,
    0.0),)),
    (m.Samples(w1=-0.9375, w2=0.625), ((0.00017817326934298965, 0.0003660209948632131), (0.0,
    0.0),)),
    (m.Samples(w1=-0.1875, w2=-0.0625), ((0.000177471621384985, 0.00036455464678015467), (0.0,
    0.0),)),
    (m.Samples(w1=-0.34375, w2=0.75), ((0.00017672370976305808, 0.000363039963935974), (0.0,
    0.0),)),
    (m.Samples(w1=-0.75, w2=-0.5625), ((0.00017593746233840444, 0.00036139849051929914), (0.0,
    0.0),)),
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
