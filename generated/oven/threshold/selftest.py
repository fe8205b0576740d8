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
    (m.Samples(on=False, Ta=1.640625, Th=1.15625, To=1.078125), ((1.0159044185965402e-11,
    1.8463901323671078e-09), (3.9417091441545766e-11, 2.7693662477115663e-09),)),
    (m.Samples(on=False, Ta=1.453125, Th=1.0625, To=1.40625), ((2.920703651335276e-10,
    1.8044129247117803e-08), (4.845085324404607e-10, 2.66190095817451e-08),)),
    (m.Samples(on=False, Ta=1.171875, Th=1.4375, To=1.296875), ((1.488312096069171e-09,
    7.525218133903599e-08), (1.7719315013278986e-09, 1.0245783265378769e-07),)),
    (m.Samples(on=False, Ta=1.5, Th=1.828125, To=1.296875), ((3.137665836196629e-09,
    2.1155467724167545e-07), (3.499146214808587e-09, 2.865071461372629e-07),)),
    (m.Samples(on=False, Ta=1.828125, Th=1.140625, To=1.921875), ((1.2831802636529444e-08,
    4.644521560458406e-07), (1.508570066836384e-08, 6.710678905580598e-07),)),
    (m.Samples(on=False, Ta=1.75, Th=1.1875, To=1.109375), ((1.898822587758377e-08,
    6.512332858794032e-07), (2.80869739531686e-08, 9.64514045020996e-07),)),
    (m.Samples(on=False, Ta=1.65625, Th=1.53125, To=1.453125), ((5.0037091085293616e-08,
    1.3140787072095358e-06), (9.48445072319373e-08, 1.916342040026755e-06),)),
    (m.Samples(on=False, Ta=1.96875, Th=1.65625, To=1.125), ((3.3542664962563586e-08,
    1.933421644677099e-06), (1.524174971354587e-07, 2.9613209094246175e-06),)),
    (m.Samples(on=False, Ta=1.6875, Th=1.515625, To=1.640625), ((1.00647287148653e-07,
    3.1942174538212217e-06), (3.7528965854290264e-07, 5.01634322924795e-06),)),
    (m.Samples(on=False, Ta=1.828125, Th=1.109375, To=1.46875), ((1.7859514793844728e-07,
    4.081433757692055e-06), (6.450110924763526e-07, 6.828065284091491e-06),)),
    (m.Samples(on=False, Ta=1.640625, Th=1.0625, To=1.921875), ((4.4837650553630973e-08,
    5.6412949537789945e-06), (7.445431126068959e-07, 9.73944544613996e-06),)),
    (m.Samples(on=False, Ta=1.65625, Th=1.140625, To=1.046875), ((7.852256495238741e-07,
    7.507449409614091e-06), (1.704862332681187e-06, 1.2249751133801914e-05),)),
    (m.Samples(on=False, Ta=1.78125, Th=1.453125, To=1.609375), ((1.5876935722428133e-06,
    1.2852384451904134e-05), (2.9006748286095353e-06, 1.9854220302138592e-05),)),
    (m.Samples(on=False, Ta=1.28125, Th=1.015625, To=1.25), ((2.5550578117974606e-06,
    1.54692383992687e-05), (4.35860334760247e-06, 2.3764145698545335e-05),)),
    (m.Samples(on=False, Ta=1.796875, Th=1.09375, To=1.75), ((4.019799580663048e-06,
    2.2811853980065247e-05), (6.330861728627115e-06, 3.4811024491910164e-05),)),
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
