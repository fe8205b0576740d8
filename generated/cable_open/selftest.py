"""Does cable_open_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import cable_open_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Uin", "Us",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Uin=0.625, Us=(0.9375, 1476395008.0, -6.305039478318694e+16)),
    ((0.2945974068608204, 2.690415238126497),)),
    (m.Derivatives(Uin=0.90625, Us=(0.0625, 134217728.0, -1.125899906842624e+16)),
    ((0.9749389170628607, 1.1473619908761796),)),
    (m.Derivatives(Uin=-0.3125, Us=(-0.90625, -402653184.0, 3.602879701896397e+16)),
    ((0.16922100137324547, 1.7855791823141491),)),
    (m.Derivatives(Uin=0.28125, Us=(-0.5625, 805306368.0, -5.17913957147607e+16)),
    ((1.4141477703099596, 1.6984694774578055),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Uin=-0.96875, Us=0.6875), ((-1.65625, 1.65625),)),
    (m.Samples(Uin=-0.59375, Us=0.09375), ((-1.6466584158415842, 1.729881644492689),)),
    (m.Samples(Uin=0.0625, Us=-0.15625), ((-1.6186924076070974, 1.7086942221535346),)),
    (m.Samples(Uin=-0.03125, Us=0.6875), ((-1.5915895876544814, 1.6766972986509676),)),
    (m.Samples(Uin=-0.78125, Us=0.34375), ((-1.5783279126514225, 1.662754419533391),)),
    (m.Samples(Uin=0.4375, Us=0.8125), ((-1.561925379727632, 1.6547481772118673),)),
    (m.Samples(Uin=-0.125, Us=0.0), ((-1.5359466593369857, 1.6181077455644726),)),
    (m.Samples(Uin=-0.25, Us=-0.375), ((-1.5055318740035801, 1.5934236318551813),)),
    (m.Samples(Uin=-0.9375, Us=0.625), ((-1.4899520349144002, 1.5708875853008168),)),
    (m.Samples(Uin=-0.1875, Us=-0.0625), ((-1.4771559550151052, 1.5568006108131187),)),
    (m.Samples(Uin=-0.34375, Us=0.75), ((-1.4599721737276774, 1.5381971406054207),)),
    (m.Samples(Uin=-0.75, Us=-0.5625), ((-1.4437474772182184, 1.5330039825268895),)),
    (m.Samples(Uin=-0.1875, Us=0.25), ((-1.4213465370752834, 1.498030151588583),)),
    (m.Samples(Uin=0.96875, Us=-0.53125), ((-1.3826812591133966, 1.4884351872263129),)),
    (m.Samples(Uin=-0.96875, Us=-0.96875), ((-1.340449947051745, 1.4364699448604088),)),
    (m.Samples(Uin=-0.28125, Us=0.5), ((-1.3216415322586412, 1.3944526583875818),)),
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
