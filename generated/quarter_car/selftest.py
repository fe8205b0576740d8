"""Does quarter_car_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import quarter_car_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "vw", "vb", "stroke",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(vw=0.625, vb=(0.9375, 22.0), stroke=(-0.875, 0.90625)), ((-26241.7,
    27519.191700000003), (-1.21875, 2.46875),)),
    (m.Derivatives(vw=0.0625, vb=(0.03125, -10.0), stroke=(-0.3125, -0.90625)), ((-5532.95,
    12070.00795), (0.9375, 1.0),)),
    (m.Derivatives(vw=-0.09375, vb=(0.5, 18.0), stroke=(-0.5625, 0.1875)), ((-19617.95,
    19637.56795), (-0.78125, 0.78125),)),
    (m.Derivatives(vw=-0.71875, vb=(-0.96875, 44.0), stroke=(-0.59375, 0.09375)), ((-27656.7,
    29623.7942), (0.15625, 1.78125),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(vw=0.0625, vb=-0.15625, stroke=-0.03125), ((-3482.9500000000003, 6404.743163267032),
    (0.21875, 1.7534036403803326),)),
    (m.Samples(vw=0.6875, vb=-0.78125, stroke=0.34375), ((-3443.2153334640398, 3910.904938503167),
    (0.14530948763193144, 0.40868812788435344),)),
    (m.Samples(vw=0.4375, vb=0.8125, stroke=-0.125), ((-3463.8904606032606, 3705.5047453938932),
    (0.0934460232980458, 0.137043112393193),)),
    (m.Samples(vw=0.0, vb=-0.25, stroke=-0.375), ((-3517.568269241214, 3771.53989220488),
    (0.18451143211127286, 0.23219693792984736),)),
    (m.Samples(vw=-0.9375, vb=0.625, stroke=-0.1875), ((-3559.4227667790647, 3789.087735436991),
    (0.2841260802879216, 0.3295103571175631),)),
    (m.Samples(vw=-0.0625, vb=-0.34375, stroke=0.75), ((-3594.4043900808347, 3880.6758673584413),
    (0.15878289456673542, 0.5487962652571828),)),
    (m.Samples(vw=-0.75, vb=-0.5625, stroke=-0.1875), ((-3550.286238829682, 3853.5201733487124),
    (0.03825153867042341, 0.09974214189897869),)),
    (m.Samples(vw=0.25, vb=0.96875, stroke=-0.53125), ((-3590.7842607195753, 3846.090779535123),
    (0.17355469601175266, 0.23564398729589323),)),
    (m.Samples(vw=-0.96875, vb=-0.96875, stroke=-0.28125), ((-3607.2808240140203,
    3978.5614618503387), (0.3216647204850058, 0.3797591100644045),)),
    (m.Samples(vw=0.5, vb=-0.34375, stroke=0.3125), ((-3542.1746736581204, 3824.5812665892745),
    (0.2984241582179481, 0.48542958107332257),)),
    (m.Samples(vw=0.375, vb=-0.125, stroke=0.9375), ((-3529.9037578982793, 3790.040083686288),
    (0.03728396469976634, 0.5254384171061348),)),
    (m.Samples(vw=-0.625, vb=0.4375, stroke=0.375), ((-3561.6391210593615, 3791.61460150469),
    (-0.22576835100756618, 0.3001366707995147),)),
    (m.Samples(vw=-0.96875, vb=0.71875, stroke=-0.03125), ((-3642.4251751577376,
    3870.4887921855006), (-0.28884037069617846, 0.3285943018188324),)),
    (m.Samples(vw=0.25, vb=-0.125, stroke=-0.6875), ((-3685.556196513574, 3937.5335462260623),
    (-0.14149911364477522, 0.48837268604767153),)),
    (m.Samples(vw=-0.9375, vb=0.53125, stroke=-0.25), ((-3718.6922500562814, 3953.783699164845),
    (0.042899816866813455, 0.11376280114628518),)),
    (m.Samples(vw=0.6875, vb=0.0, stroke=-0.21875), ((-3760.701055575857, 3982.113401483041),
    (0.12783403756510567, 0.16515549940709806),)),
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
