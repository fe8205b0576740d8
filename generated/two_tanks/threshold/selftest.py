"""Does two_tanks_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import two_tanks_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "p1", "p2",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(p1=0.625, p2=0.9375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(p1=0.34375, p2=-0.875), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(p1=0.90625, p2=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(p1=0.03125, p2=-0.15625), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(p1=-0.3125, p2=-0.90625), ((4.6233105022267316e-08, 1.4000966097020692e-07),
    (9.383168693391674e-08, 2.5907751422849873e-07),)),
    (m.Samples(p1=-0.09375, p2=0.5), ((4.622404059622629e-08, 9.723692522438229e-08),
    (9.381449056777464e-08, 1.960857886689372e-07),)),
    (m.Samples(p1=0.28125, p2=-0.5625), ((4.6198076848767934e-08, 9.503046017797715e-08),
    (9.376346309705154e-08, 1.9280814469560398e-07),)),
    (m.Samples(p1=0.1875, p2=-0.71875), ((4.616688865500875e-08, 9.485735015806762e-08),
    (9.369758449319767e-08, 1.9251160545445072e-07),)),
    (m.Samples(p1=-0.96875, p2=0.6875), ((4.612785227113358e-08, 9.478985326864136e-08),
    (9.361450319433565e-08, 1.9235941301688655e-07),)),
    (m.Samples(p1=-0.59375, p2=0.09375), ((4.605784221985221e-08, 9.463769107999257e-08),
    (9.347808140070197e-08, 1.9206211723343107e-07),)),
    (m.Samples(p1=0.0625, p2=-0.15625), ((4.595794481559229e-08, 9.441586758431459e-08),
    (9.329065388764816e-08, 1.9165436963482818e-07),)),
    (m.Samples(p1=-0.03125, p2=0.6875), ((4.5839582084061956e-08, 9.418211481169433e-08),
    (9.306794333898255e-08, 1.9121531542325414e-07),)),
    (m.Samples(p1=-0.78125, p2=0.34375), ((4.569442537494345e-08, 9.388744355249563e-08),
    (9.279494691967443e-08, 1.906540588689188e-07),)),
    (m.Samples(p1=0.4375, p2=0.8125), ((4.551597741403775e-08, 9.351628408173545e-08),
    (9.246097337465268e-08, 1.899654080781611e-07),)),
    (m.Samples(p1=-0.125, p2=0.0), ((4.531115731007551e-08, 9.308263650506014e-08),
    (9.207660811686735e-08, 1.8914784601747603e-07),)),
    (m.Samples(p1=-0.25, p2=-0.375), ((4.5090919880632164e-08, 9.262761603484223e-08),
    (9.166411163193868e-08, 1.88296906485505e-07),)),
    (m.Samples(p1=-0.9375, p2=0.625), ((4.4856364687801935e-08, 9.216040928023987e-08),
    (9.122870211139555e-08, 1.8742629408364057e-07),)),
    (m.Samples(p1=-0.1875, p2=-0.0625), ((4.4598713388548895e-08, 9.161657387077378e-08),
    (9.075636588563254e-08, 1.8643067486587262e-07),)),
    (m.Samples(p1=-0.34375, p2=0.75), ((4.4316014521144276e-08, 9.10426372166601e-08),
    (9.024363199071555e-08, 1.8539336704779948e-07),)),
    (m.Samples(p1=-0.75, p2=-0.5625), ((4.4010094647892006e-08, 9.041275278442038e-08),
    (8.969509998973997e-08, 1.842557229040896e-07),)),
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
