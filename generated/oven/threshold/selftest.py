"""Does oven_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import oven_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Ta", "Th", "To",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(on=True, Ta=0.625, Th=0.9375, To=0.34375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(on=True, Ta=0.90625, Th=0.0625, To=0.03125), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(on=False, Ta=-0.3125, Th=-0.90625, To=-0.09375), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(on=False, Ta=0.28125, Th=-0.5625, To=0.1875), ((math.nan, 0.0), (math.nan,
    0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(on=False, Ta=1.8125, Th=1.484375, To=1.375), ((0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(on=False, Ta=1.640625, Th=1.15625, To=1.078125), ((1.5088287912949726e-11,
    3.6066821395235847e-09), (5.854255710224495e-11, 5.398212856784799e-09),)),
    (m.Samples(on=False, Ta=1.453125, Th=1.0625, To=1.40625), ((4.633617457422641e-10,
    3.478276537763814e-08), (6.639915345127305e-10, 5.1055224290770114e-08),)),
    (m.Samples(on=False, Ta=1.171875, Th=1.4375, To=1.296875), ((1.2426998334661917e-09,
    1.40476244968317e-07), (1.4418726815700542e-09, 1.9137603124806306e-07),)),
    (m.Samples(on=False, Ta=1.5, Th=1.828125, To=1.296875), ((5.18097450743683e-09,
    3.9953515826700993e-07), (5.860694736496893e-09, 5.412920463661524e-07),)),
    (m.Samples(on=False, Ta=1.828125, Th=1.140625, To=1.921875), ((6.867806086905577e-09,
    8.314055882543448e-07), (8.82320502391932e-09, 1.2173649824265533e-06),)),
    (m.Samples(on=False, Ta=1.75, Th=1.1875, To=1.109375), ((1.7702159349225655e-08,
    1.1650057079839445e-06), (3.003745500429705e-08, 1.7343839181287306e-06),)),
    (m.Samples(on=False, Ta=1.65625, Th=1.53125, To=1.453125), ((4.828756097427471e-08,
    2.3683148308145955e-06), (9.444299620400182e-08, 3.4174312556495507e-06),)),
    (m.Samples(on=False, Ta=1.96875, Th=1.65625, To=1.125), ((1.8068177319065225e-08,
    3.459175064759109e-06), (1.4635434911680355e-07, 5.1835724471314505e-06),)),
    (m.Samples(on=False, Ta=1.6875, Th=1.515625, To=1.640625), ((9.441710439733369e-08,
    5.740694549820669e-06), (3.686878993610251e-07, 8.649912646129476e-06),)),
    (m.Samples(on=False, Ta=1.828125, Th=1.109375, To=1.46875), ((1.5819375057759406e-07,
    7.072557568420937e-06), (6.313482734081271e-07, 1.1354292008278733e-05),)),
    (m.Samples(on=False, Ta=1.640625, Th=1.0625, To=1.921875), ((1.0564226588300592e-07,
    1.0503615810634557e-05), (7.95551105249329e-07, 1.6844447595477965e-05),)),
    (m.Samples(on=False, Ta=1.65625, Th=1.140625, To=1.046875), ((7.708523016164448e-07,
    1.2282255305215259e-05), (1.7118467335726918e-06, 1.9387519544607276e-05),)),
    (m.Samples(on=False, Ta=1.78125, Th=1.453125, To=1.609375), ((1.600783420172662e-06,
    2.1194256949947014e-05), (2.918919934130283e-06, 3.1917307398710313e-05),)),
    (m.Samples(on=False, Ta=1.28125, Th=1.015625, To=1.25), ((2.5820426410126572e-06,
    2.378034443379694e-05), (4.3841151691982594e-06, 3.578252891532872e-05),)),
    (m.Samples(on=False, Ta=1.796875, Th=1.09375, To=1.75), ((4.123261561009594e-06,
    3.555792051399151e-05), (6.43429283768414e-06, 5.381456484995614e-05),)),
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
