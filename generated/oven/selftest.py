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
    (m.Samples(on=True, P=0.625, Ta=-0.1875, Th=-0.0625, To=-0.34375), ((7.261214260039873e-08,
    0.006334891084050172), (3.0093332843185337e-06, 0.2613035048870288),)),
    (m.Samples(on=True, P=0.75, Ta=-0.75, Th=-0.5625, To=-0.1875), ((0.00046132020314620074,
    0.24130317273371638), (-0.0010750203335562077, 0.6099732075712456),)),
    (m.Samples(on=True, P=0.25, Ta=0.96875, Th=-0.53125, To=-0.96875), ((0.0010080577577467659,
    0.5402851770325047), (0.021239983930377106, 7.316932497113784),)),
    (m.Samples(on=True, P=-0.96875, Ta=-0.28125, Th=0.5, To=-0.34375), ((-0.009586118002014463,
    0.9428307190037309), (0.008515530089516598, 5.010565687044975),)),
    (m.Samples(on=True, P=0.3125, Ta=0.375, Th=-0.125, To=0.9375), ((-0.014363717763325772,
    0.4149830457629787), (-0.252324977232382, 21.267029152126707),)),
    (m.Samples(on=True, P=-0.625, Ta=0.4375, Th=0.375, To=-0.96875), ((-0.027359811366272437,
    1.6940767442821603), (-0.11659438068751854, 33.35931803539151),)),
    (m.Samples(on=True, P=0.71875, Ta=-0.03125, Th=0.25, To=-0.125), ((-0.0483048963489999,
    1.6579538764077384), (0.08385500718314132, 7.076535721863546),)),
    (m.Samples(on=True, P=-0.6875, Ta=-0.9375, Th=0.53125, To=-0.25), ((-0.08804169525369872,
    4.60396184572998), (0.02358160186966369, 16.262741156830888),)),
    (m.Samples(on=True, P=0.6875, Ta=0.0, Th=-0.21875, To=0.28125), ((-0.049315409671455965,
    2.708242179990413), (-0.48861349966230216, 24.048768863019898),)),
    (m.Samples(on=True, P=-0.34375, Ta=-0.1875, Th=0.21875, To=0.90625), ((-0.0024471178933870947,
    3.211358858573081), (-2.310214059837078, 97.37578041542903),)),
    (m.Samples(on=True, P=0.21875, Ta=0.03125, Th=-0.78125, To=0.21875), ((0.21161905579455592,
    13.873137624359304), (-3.5891116720902296, 35.858718919088886),)),
    (m.Samples(on=True, P=0.625, Ta=0.25, Th=-0.90625, To=0.8125), ((0.6765088001492043,
    20.444698024179512), (-5.063131898468151, 136.72320501322596),)),
    (m.Samples(on=True, P=0.53125, Ta=0.0, Th=-0.78125, To=-0.5625), ((1.1098189242563201,
    22.14384982910306), (-3.7176308600151358, 122.41258180039392),)),
    (m.Samples(on=True, P=0.15625, Ta=0.1875, Th=-0.625, To=-0.21875), ((1.4047827985695407,
    21.843264201299554), (0.07469547701024676, 57.871554044013905),)),
    (m.Samples(on=True, P=-0.53125, Ta=-0.09375, Th=-0.65625, To=-0.03125), ((1.6354790802841397,
    26.90976012831727), (1.7277552057419716, 12.750886267162318),)),
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
