"""Does quarter_car_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import quarter_car_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "vw", "vb",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(vw=0.625, vb=0.9375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(vw=0.34375, vb=-0.875), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(vw=0.90625, vb=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(vw=0.03125, vb=-0.15625), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(vw=-0.3125, vb=-0.90625), ((59.375, 181.37187496661227), (0.0, 0.0),)),
    (m.Samples(vw=-0.09375, vb=0.5), ((59.363358984413296, 124.95145656858158), (0.0, 0.0),)),
    (m.Samples(vw=0.28125, vb=-0.5625), ((59.331347708096956, 122.04482634938225), (0.0, 0.0),)),
    (m.Samples(vw=0.1875, vb=-0.71875), ((59.29693265957143, 121.83051601996272), (0.0, 0.0),)),
    (m.Samples(vw=-0.96875, vb=0.6875), ((59.25041862945312, 121.76495482599825), (0.0, 0.0),)),
    (m.Samples(vw=-0.59375, vb=0.09375), ((59.1521674105817, 121.54110764682822), (0.0, 0.0),)),
    (m.Samples(vw=0.0625, vb=-0.15625), ((59.00700332217849, 121.21936132514503), (0.0, 0.0),)),
    (m.Samples(vw=-0.03125, vb=0.6875), ((58.834897034194114, 120.87731964695661), (0.0, 0.0),)),
    (m.Samples(vw=-0.78125, vb=0.34375), ((58.62349341526738, 120.4519479492194), (0.0, 0.0),)),
    (m.Samples(vw=0.4375, vb=0.8125), ((58.36461332088821, 119.91134561819), (0.0, 0.0),)),
    (m.Samples(vw=-0.125, vb=0.0), ((58.07339263092704, 119.2921926158127), (0.0, 0.0),)),
    (m.Samples(vw=-0.25, vb=-0.375), ((57.76591811344512, 118.65937464837239), (0.0, 0.0),)),
    (m.Samples(vw=-0.9375, vb=0.625), ((57.43375740191741, 118.00640822595969), (0.0, 0.0),)),
    (m.Samples(vw=-0.1875, vb=-0.0625), ((57.06146623798342, 117.21028990199139), (0.0, 0.0),)),
    (m.Samples(vw=-0.34375, vb=0.75), ((56.65290859043229, 116.38450468638997), (0.0, 0.0),)),
    (m.Samples(vw=-0.75, vb=-0.5625), ((56.21364919056852, 115.47532017436971), (0.0, 0.0),)),
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
