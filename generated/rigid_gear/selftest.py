"""Does rigid_gear_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import rigid_gear_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "T", "w1", "w2",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(T=0.625, w1=(0.9375, 176.0), w2=(-0.875, 58.0)), ((-0.45147916666666665,
    1.7054752291666666), (11.4375, 11.448),)),
    (m.Derivatives(T=0.0625, w1=(0.03125, -80.0), w2=(-0.3125, -58.0)), ((0.9479895833333333,
    0.9489376354166665), (3.78125, 3.785),)),
    (m.Derivatives(T=-0.09375, w1=(0.5, 144.0), w2=(-0.5625, 12.0)), ((-0.5313125, 0.5336269375),
    (7.25, 7.25675),)),
    (m.Derivatives(T=-0.71875, w1=(-0.96875, 352.0), w2=(-0.59375, 6.0)), ((-1.4957916666666666,
    1.5004892916666666), (6.15625, 8.100875),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(T=0.0625, w1=-0.15625, w2=-0.03125), ((0.06270833333333334, 0.090445), (0.21875,
    0.531625),)),
    (m.Samples(T=0.6875, w1=-0.78125, w2=0.34375), ((0.06209385150062287, 0.06832974153608873),
    (0.16783996514395397, 0.29174851499370597),)),
    (m.Samples(T=0.4375, w1=0.8125, w2=-0.125), ((0.061517050749374795, 0.06566236424582728),
    (0.13907489873021536, 0.15634241074822064),)),
    (m.Samples(T=0.0, w1=-0.25, w2=-0.375), ((0.06264618496363648, 0.06600742188103693),
    (0.20135807579567674, 0.2154618506112738),)),
    (m.Samples(T=-0.9375, w1=0.625, w2=-0.1875), ((0.06387722582796232, 0.06795096293093082),
    (0.2678677673613866, 0.2813132114182523),)),
    (m.Samples(T=-0.0625, w1=-0.34375, w2=0.75), ((0.062121068248975946, 0.06933403652905223),
    (0.1981154710865353, 0.3994443352403695),)),
    (m.Samples(T=-0.75, w1=-0.5625, w2=-0.1875), ((0.060711691208317514, 0.06445501002894066),
    (0.11875462138778015, 0.15513176928504907),)),
    (m.Samples(T=0.25, w1=0.96875, w2=-0.53125), ((0.06182344260540022, 0.06589389800430812),
    (0.20600515569493236, 0.2154248433290888),)),
    (m.Samples(T=-0.96875, w1=-0.96875, w2=-0.28125), ((0.06313667353124777, 0.06672952011323167),
    (0.2982945006048253, 0.3325520591068922),)),
    (m.Samples(T=0.5, w1=-0.34375, w2=0.3125), ((0.06269846549015655, 0.06764911190893971),
    (0.275465991407698, 0.37577301142051633),)),
    (m.Samples(T=0.375, w1=-0.125, w2=0.9375), ((0.05897632314055499, 0.06703676015949207),
    (0.11662021742788296, 0.36370628746106465),)),
    (m.Samples(T=-0.625, w1=0.4375, w2=0.375), ((0.05498689576792069, 0.0607891774861323),
    (-0.03828918094969564, 0.07581368932219198),)),
    (m.Samples(T=-0.96875, w1=0.71875, w2=-0.03125), ((0.05299257548199597, 0.05685583012317258),
    (-0.06675343216234955, 0.09515241650313952),)),
    (m.Samples(T=0.25, w1=-0.125, w2=-0.6875), ((0.05365726591143226, 0.05655005492612566),
    (0.026072159832689644, 0.14331761065174142),)),
    (m.Samples(T=-0.9375, w1=0.53125, w2=-0.25), ((0.05473588710746736, 0.05824969531280137),
    (0.1408089007154993, 0.1528840476579501),)),
    (m.Samples(T=0.6875, w1=0.0, w2=-0.21875), ((0.05446643327155145, 0.05770236318735692),
    (0.19894174834428593, 0.20859366444573746),)),
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
