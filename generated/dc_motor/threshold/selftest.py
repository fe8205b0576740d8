"""Does motor_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import motor_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "current", "speed",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(current=0.625, speed=0.9375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(current=0.34375, speed=-0.875), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(current=0.90625, speed=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(current=0.03125, speed=-0.15625), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(current=-0.3125, speed=-0.90625), ((0.27506361875, 0.5504023011354882),
    (2.30159375e-05, 4.605489094731618e-05),)),
    (m.Samples(current=-0.09375, speed=0.5), ((0.2750446135500544, 0.5638717567430851),
    (2.3014257049485847e-05, 4.718188365449416e-05),)),
    (m.Samples(current=0.28125, speed=-0.5625), ((0.2749370416825358, 0.5644062646492477),
    (2.300515120413633e-05, 4.722609704239632e-05),)),
    (m.Samples(current=0.1875, speed=-0.71875), ((0.2746691266599538, 0.563884707319855),
    (2.2983011277990992e-05, 4.718302695965289e-05),)),
    (m.Samples(current=-0.96875, speed=0.6875), ((0.2743317062065154, 0.5631526327622338),
    (2.2955087936232182e-05, 4.712273468791916e-05),)),
    (m.Samples(current=-0.59375, speed=0.09375), ((0.27410256810252265, 0.5626768045097348),
    (2.2935334442041233e-05, 4.70816399614529e-05),)),
    (m.Samples(current=0.0625, speed=-0.15625), ((0.2739549504731963, 0.5623877797743859),
    (2.2921639768470425e-05, 4.7054591294660953e-05),)),
    (m.Samples(current=-0.03125, speed=0.6875), ((0.27374850949286816, 0.5619549722269653),
    (2.2902854390078924e-05, 4.7015465163312555e-05),)),
    (m.Samples(current=-0.78125, speed=0.34375), ((0.27351069440168224, 0.5614607760684158),
    (2.2881057622632584e-05, 4.697019036416279e-05),)),
    (m.Samples(current=0.4375, speed=0.8125), ((0.2732744147033823, 0.5610572482783838),
    (2.285882352306565e-05, 4.693114555321036e-05),)),
    (m.Samples(current=-0.125, speed=0.0), ((0.2729425572308386, 0.5603136869180344),
    (2.2828454149300322e-05, 4.6863655252757986e-05),)),
    (m.Samples(current=-0.25, speed=-0.375), ((0.27252247659004125, 0.5594350349788986),
    (2.279073618054718e-05, 4.67848826092558e-05),)),
    (m.Samples(current=-0.9375, speed=0.625), ((0.27214726393824806, 0.558660081316278),
    (2.2756364398666817e-05, 4.6714095180554336e-05),)),
    (m.Samples(current=-0.1875, speed=-0.0625), ((0.27187949082791235, 0.5581141916845659),
    (2.27302325895601e-05, 4.666063369882095e-05),)),
    (m.Samples(current=-0.34375, speed=0.75), ((0.27165813486665985, 0.5576597130335955),
    (2.2707437018813208e-05, 4.6613982431908024e-05),)),
    (m.Samples(current=-0.75, speed=-0.5625), ((0.2714794340674572, 0.5572910758421765),
    (2.2687737996160854e-05, 4.657325011157318e-05),)),
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
