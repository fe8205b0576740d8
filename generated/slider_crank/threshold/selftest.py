"""Does slider_crank_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import slider_crank_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "speed",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(speed=0.625), ((math.nan, 0.0),)),
    (m.Derivatives(speed=0.9375), ((math.nan, 0.0),)),
    (m.Derivatives(speed=0.34375), ((math.nan, 0.0),)),
    (m.Derivatives(speed=-0.875), ((math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(speed=0.90625), ((9.062500000000001e-05, 0.00018134062498039718),)),
    (m.Samples(speed=0.0625), ((9.061672875755525e-05, 0.0001859208114874454),)),
    (m.Samples(speed=0.03125), ((9.058366501571294e-05, 0.00018608545011879367),)),
    (m.Samples(speed=-0.15625), ((9.051607189792232e-05, 0.00018595914850094087),)),
    (m.Samples(speed=-0.3125), ((9.040981568216928e-05, 0.00018574256254550668),)),
    (m.Samples(speed=-0.90625), ((9.025573209689492e-05, 0.00018543705131779468),)),
    (m.Samples(speed=-0.09375), ((9.0050549299726e-05, 0.00018499413702796665),)),
    (m.Samples(speed=0.5), ((8.981228111610567e-05, 0.0001844973168996946),)),
    (m.Samples(speed=0.28125), ((8.955977972496675e-05, 0.00018397663477859674),)),
    (m.Samples(speed=-0.5625), ((8.928696276315864e-05, 0.00018342722607191908),)),
    (m.Samples(speed=0.1875), ((8.898339920194082e-05, 0.00018278982170419206),)),
    (m.Samples(speed=-0.71875), ((8.864796302436221e-05, 0.0001821130597544979),)),
    (m.Samples(speed=-0.96875), ((8.826916999234731e-05, 0.0001813398186170631),)),
    (m.Samples(speed=0.6875), ((8.785131938848777e-05, 0.0001804572843472503),)),
    (m.Samples(speed=-0.59375), ((8.741356690861774e-05, 0.0001795660126234294),)),
    (m.Samples(speed=0.09375), ((8.695472047595286e-05, 0.00017860878629897173),)),
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
