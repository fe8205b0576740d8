"""Does oven_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import oven_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "P", "Ta", "Th", "To",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(on=False, P=0.625, Ta=0.9375, Th=(0.34375, -0.02734375), To=(0.90625,
    0.000244140625)), ((5.53125, 8.28953125), (-2.4447265625, 6.7014212890625),)),
    (m.Derivatives(on=False, P=-0.15625, Ta=-0.3125, Th=(-0.90625, -0.0029296875), To=(0.5,
    0.0010986328125)), ((5.9765625, 5.982539062499999), (-7.26376953125, 7.271033300781249),)),
    (m.Derivatives(on=False, P=0.1875, Ta=-0.71875, Th=(-0.96875, 0.021484375), To=(-0.59375,
    0.0003662109375)), ((-1.078125, 8.836953125), (-1.92958984375, 7.637219433593749),)),
    (m.Derivatives(on=True, P=-0.15625, Ta=-0.03125, Th=(0.6875, -0.0244140625), To=(0.34375,
    0.001708984375)), ((1.3984375, 7.2179921875), (-0.46308593750000004, 5.9690490234375),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(on=True, P=-0.125, Ta=0.0, Th=-0.25, To=-0.375), ((0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(on=True, P=0.625, Ta=-0.1875, Th=-0.0625, To=-0.34375), ((2.466946926959874e-08,
    0.00021426447589332286), (1.0318382692312995e-06, 0.008838107907056246),)),
    (m.Samples(on=True, P=0.75, Ta=-0.75, Th=-0.5625, To=-0.1875), ((0.0004627539251165554,
    0.011703389900718529), (-0.001082384093045449, 0.03324512414816333),)),
    (m.Samples(on=True, P=0.25, Ta=0.96875, Th=-0.53125, To=-0.96875), ((0.001008364602287017,
    0.036487622003754036), (0.021350506381865923, 0.4689469042434316),)),
    (m.Samples(on=True, P=-0.96875, Ta=-0.28125, Th=0.5, To=-0.34375), ((-0.009647011892166154,
    0.08071095046633289), (0.00833797633572248, 0.45760885846768895),)),
    (m.Samples(on=True, P=0.3125, Ta=0.375, Th=-0.125, To=0.9375), ((-0.0143412967437574,
    0.06243914372384422), (-0.253713940268952, 2.070565176339499),)),
    (m.Samples(on=True, P=-0.625, Ta=0.4375, Th=0.375, To=-0.96875), ((-0.02745444441031477,
    0.19407735944675827), (-0.11458763207971959, 4.06660780451794),)),
    (m.Samples(on=True, P=0.71875, Ta=-0.03125, Th=0.25, To=-0.125), ((-0.04834626187692,
    0.24266219964952448), (0.08334153764996903, 1.211101103262793),)),
    (m.Samples(on=True, P=-0.6875, Ta=-0.9375, Th=0.53125, To=-0.25), ((-0.08824223621547637,
    0.660385640855234), (0.023637205842978896, 2.3873567414768506),)),
    (m.Samples(on=True, P=0.6875, Ta=0.0, Th=-0.21875, To=0.28125), ((-0.048882880187418834,
    0.5102010938985483), (-0.4918594634477468, 3.905496144929271),)),
    (m.Samples(on=True, P=-0.34375, Ta=-0.1875, Th=0.21875, To=0.90625), ((-0.002538434764344948,
    0.5846248606384008), (-2.3186070671301757, 16.81527733327529),)),
    (m.Samples(on=True, P=0.21875, Ta=0.03125, Th=-0.78125, To=0.21875), ((0.2130494630952884,
    2.467415905991789), (-3.5891807217649263, 10.095476032787943),)),
    (m.Samples(on=True, P=0.625, Ta=0.25, Th=-0.90625, To=0.8125), ((0.6780992277388751,
    4.329205003356977), (-5.071920183347532, 28.579073705932068),)),
    (m.Samples(on=True, P=0.53125, Ta=0.0, Th=-0.78125, To=-0.5625), ((1.1110027090837449,
    5.338628305658667), (-3.7002934122306987, 30.447726210270226),)),
    (m.Samples(on=True, P=0.15625, Ta=0.1875, Th=-0.625, To=-0.21875), ((1.4054116837839659,
    5.796574606291788), (0.08309334774995623, 14.667400441652331),)),
    (m.Samples(on=True, P=-0.53125, Ta=-0.09375, Th=-0.65625, To=-0.03125), ((1.6361826679034526,
    7.295609325386032), (1.7303819257392685, 5.04179771249421),)),
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
