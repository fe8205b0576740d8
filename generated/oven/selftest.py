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
    (m.Samples(on=True, P=-0.125, Ta=0.0, Th=-0.25, To=-0.375), ((-0.625, 1201.8274999999999), (0.8,
    13512.7028),)),
    (m.Samples(on=False, P=0.625, Ta=-0.1875, Th=-0.0625, To=-0.34375), ((-5.050793772678586,
    67.89132515675867), (-4.7321361373131605, 802.3733250388716),)),
    (m.Samples(on=True, P=-0.75, Ta=-0.5625, Th=-0.1875, To=0.25), ((-10.747093439631186,
    23.800540350698085), (-120.65226496868344, 172.43484602191748),)),
    (m.Samples(on=False, P=-0.53125, Ta=-0.96875, Th=-0.96875, To=-0.28125), ((5.156027319544581,
    43.198327275587545), (-242.34641901684031, 361.8982288175223),)),
    (m.Samples(on=True, P=-0.34375, Ta=0.3125, Th=0.375, To=-0.125), ((7.03419996779597,
    41.40231987263938), (-293.4132303632597, 366.43002219627874),)),
    (m.Samples(on=False, P=-0.625, Ta=0.4375, Th=0.375, To=-0.96875), ((-22.671838520113575,
    26.157315072822804), (-220.47009338992333, 593.991189032527),)),
    (m.Samples(on=False, P=-0.03125, Ta=0.25, Th=-0.125, To=-0.6875), ((-39.40371593726186,
    47.879704124916344), (-51.71208176900208, 344.9044880206735),)),
    (m.Samples(on=False, P=0.53125, Ta=-0.25, Th=0.6875, To=0.0), ((-62.91997169247808,
    66.45411037564415), (-60.71618877620556, 103.78119481936362),)),
    (m.Samples(on=False, P=0.28125, Ta=-0.34375, Th=-0.1875, To=0.21875), ((-83.88739190299856,
    97.74045730764496), (-228.96739632078763, 242.57551294036034),)),
    (m.Samples(on=False, P=0.21875, Ta=0.03125, Th=-0.78125, To=0.21875), ((-69.46823074954442,
    112.41715891432224), (-429.00012603786627, 451.67067010686605),)),
    (m.Samples(on=False, P=0.25, Ta=-0.90625, Th=0.8125, To=0.3125), ((-79.28356163939907,
    86.9531497838788), (-637.6187085957367, 670.6870386038588),)),
    (m.Samples(on=False, P=0.0, Ta=-0.78125, Th=-0.5625, To=0.15625), ((-93.59607149301378,
    126.51633913110355), (-826.6331584641491, 870.6326389797011),)),
    (m.Samples(on=True, P=-0.625, Ta=-0.21875, Th=-0.53125, To=-0.09375), ((-75.80801593874254,
    108.75984063697871), (-936.1783675623496, 1020.9550707677421),)),
    (m.Samples(on=False, P=-0.03125, Ta=-0.28125, Th=0.03125, To=-0.59375), ((-72.69741871521622,
    79.4069331551099), (-908.5833577364368, 1178.8334122266274),)),
    (m.Samples(on=False, P=0.625, Ta=-0.03125, Th=-0.25, To=0.28125), ((-76.23085293358172,
    92.70026824244155), (-948.688291735817, 1020.6395818962114),)),
    (m.Samples(on=True, P=-0.6875, Ta=-0.84375, Th=-0.09375, To=-0.875), ((-76.68966653511316,
    86.66079435513193), (-936.0297412465171, 1309.0203441391375),)),
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
