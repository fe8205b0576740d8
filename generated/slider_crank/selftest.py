"""Does slider_crank_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import slider_crank_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "T", "load", "speed",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(T=0.625, load=0.9375, speed=(0.34375, -448.0), speed_integral=0.90625),
    ((1.7262779549820835, 2.9099455634437077),)),
    (m.Derivatives(T=0.0625, load=0.03125, speed=(-0.15625, -160.0), speed_integral=-0.90625),
    ((0.47146767699389597, 0.8537606089810156),)),
    (m.Derivatives(T=-0.09375, load=0.5, speed=(0.28125, -288.0), speed_integral=0.1875),
    ((0.4873285888664079, 0.7321449301990381),)),
    (m.Derivatives(T=-0.71875, load=-0.96875, speed=(0.6875, -304.0), speed_integral=0.09375),
    ((-0.1042380278757128, 1.3523256108159378),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(T=0.0625, load=-0.15625, speed=-0.03125), ((0.06253125, 0.06603361716986102),)),
    (m.Samples(T=0.6875, load=-0.78125, speed=0.34375), ((0.06242502703689034,
    0.06742366844766992),)),
    (m.Samples(T=0.4375, load=0.8125, speed=-0.125), ((0.06254757042323027, 0.06683594701352998),)),
    (m.Samples(T=0.0, load=-0.25, speed=-0.375), ((0.06308194719608497, 0.06661196353080968),)),
    (m.Samples(T=-0.9375, load=0.625, speed=-0.1875), ((0.06356258359381185,
    0.06894454069059057),)),
    (m.Samples(T=-0.0625, load=-0.34375, speed=0.75), ((0.06330918438676375, 0.067663371670256),)),
    (m.Samples(T=-0.75, load=-0.5625, speed=-0.1875), ((0.06291410463469296,
    0.06792709828263717),)),
    (m.Samples(T=0.25, load=0.96875, speed=-0.53125), ((0.06282848130159982,
    0.06680427922242388),)),
    (m.Samples(T=-0.96875, load=-0.96875, speed=-0.28125), ((0.06271153725185329,
    0.06807338274701276),)),
    (m.Samples(T=0.5, load=-0.34375, speed=0.3125), ((0.062039590970589344, 0.06664088133591703),)),
    (m.Samples(T=0.375, load=-0.125, speed=0.9375), ((0.06098354594414903, 0.06590667977579023),)),
    (m.Samples(T=-0.625, load=0.4375, speed=0.375), ((0.06001005893618075, 0.06494746100406806),)),
    (m.Samples(T=-0.96875, load=0.71875, speed=-0.03125), ((0.05922872679777433,
    0.06440229262013214),)),
    (m.Samples(T=0.25, load=-0.125, speed=-0.6875), ((0.058593700660334314,
    0.062325545515255716),)),
    (m.Samples(T=-0.9375, load=0.53125, speed=-0.25), ((0.057987345834581275,
    0.06298257840760524),)),
    (m.Samples(T=0.6875, load=0.0, speed=-0.21875), ((0.057014542567914675, 0.06150410345437696),)),
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
