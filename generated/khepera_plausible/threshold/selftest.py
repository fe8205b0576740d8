"""Does khepera_plausible_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import khepera_plausible_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2", "r3", "r4", "r5",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "robot__Fx__1", "robot__Fx__2", "robot__m__1__me__we", "robot__m__1__wh__ws",
    "robot__m__2__me__we", "robot__m__2__wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2", "r3", "r4",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(robot__Fx__1=0.625, robot__Fx__2=0.9375, robot__m__1__me__we=0.34375,
    robot__m__1__wh__ws=-0.875, robot__m__2__me__we=0.90625, robot__m__2__wh__ws=0.0625),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(robot__Fx__1=0.03125, robot__Fx__2=-0.15625, robot__m__1__me__we=-0.3125,
    robot__m__1__wh__ws=-0.90625, robot__m__2__me__we=-0.09375, robot__m__2__wh__ws=0.5),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(robot__Fx__1=0.28125, robot__Fx__2=-0.5625, robot__m__1__me__we=0.1875,
    robot__m__1__wh__ws=-0.71875, robot__m__2__me__we=-0.96875, robot__m__2__wh__ws=0.6875),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(robot__Fx__1=-0.59375, robot__Fx__2=0.09375, robot__m__1__me__we=0.0625,
    robot__m__1__wh__ws=-0.15625, robot__m__2__me__we=-0.03125, robot__m__2__wh__ws=0.6875),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(robot__Fx__1=-0.78125, robot__Fx__2=0.34375, robot__m__1__me__we=0.4375,
    robot__m__1__wh__ws=0.8125, robot__m__2__me__we=-0.125, robot__m__2__wh__ws=0.0),
    ((0.09203405910266167, 0.19804360687373074), (0.0, 0.0004783359750176701), (0.03967862240272412,
    0.07980046932683335), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.25, robot__Fx__2=-0.375, robot__m__1__me__we=-0.9375,
    robot__m__1__wh__ws=0.625, robot__m__2__me__we=-0.1875, robot__m__2__wh__ws=-0.0625),
    ((0.0920340845867405, 0.1895312211849314), (4.367655665674405e-09, 2.40650772581972e-05),
    (0.03967855945328474, 0.08143245458126877), (1.4558852218914684e-09, 3.870285754283472e-09),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.34375, robot__Fx__2=0.75, robot__m__1__me__we=-0.75,
    robot__m__1__wh__ws=-0.5625, robot__m__2__me__we=-0.1875, robot__m__2__wh__ws=0.25),
    ((0.0920343427135728, 0.18910930531138548), (4.9240632851299564e-08, 1.3318014392490498e-06),
    (0.039678226270538255, 0.08151737861979778), (8.64882310034536e-11, 1.6463287383136205e-08),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.96875, robot__Fx__2=-0.53125, robot__m__1__me__we=-0.96875,
    robot__m__1__wh__ws=-0.96875, robot__m__2__me__we=-0.28125, robot__m__2__wh__ws=0.5),
    ((0.09203520842425787, 0.1890929760276171), (2.0136208495804968e-07, 5.085270091039931e-07),
    (0.03967770934170109, 0.08152066759505265), (2.3377226504791565e-08, 5.855930394074057e-08),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.34375, robot__Fx__2=0.3125, robot__m__1__me__we=0.375,
    robot__m__1__wh__ws=-0.125, robot__m__2__me__we=0.9375, robot__m__2__wh__ws=-0.625),
    ((0.0920360374850918, 0.18908959492005514), (4.812418715846084e-07, 1.027297658308093e-06),
    (0.039676769567978186, 0.08151881162422157), (5.984311834686733e-08, 1.6962766109268092e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.4375, robot__Fx__2=0.375, robot__m__1__me__we=-0.96875,
    robot__m__1__wh__ws=0.71875, robot__m__2__me__we=-0.03125, robot__m__2__wh__ws=0.25),
    ((0.09203521903941325, 0.18908959540196704), (8.316109599457648e-07, 1.7922027451143402e-06),
    (0.039674723996743044, 0.08151332949905847), (8.246814851897093e-08, 1.8197315923860823e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.125, robot__Fx__2=-0.6875, robot__m__1__me__we=-0.9375,
    robot__m__1__wh__ws=0.53125, robot__m__2__me__we=-0.25, robot__m__2__wh__ws=0.6875),
    ((0.09203138354532762, 0.18907992391388456), (1.1933553693698132e-06, 2.531653769742916e-06),
    (0.03967186683106282, 0.08150947289043685), (1.167815168380954e-07, 2.533018936901763e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.0, robot__Fx__2=-0.21875, robot__m__1__me__we=0.28125,
    robot__m__1__wh__ws=-0.34375, robot__m__2__me__we=-0.1875, robot__m__2__wh__ws=0.21875),
    ((0.09202403427943427, 0.18906311939211332), (1.5748466969230073e-06, 3.2853310376240527e-06),
    (0.03966820985763047, 0.08149932946205335), (1.9190743389304738e-07, 4.0717089235980114e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.90625, robot__Fx__2=0.21875, robot__m__1__me__we=0.03125,
    robot__m__1__wh__ws=-0.78125, robot__m__2__me__we=0.21875, robot__m__2__wh__ws=0.625),
    ((0.09201330329256525, 0.18904462024074278), (2.029803499626146e-06, 4.22637073294613e-06),
    (0.039663154309080725, 0.08148951320962641), (3.031965589518311e-07, 6.424528107297438e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.25, robot__Fx__2=-0.90625, robot__m__1__me__we=0.8125,
    robot__m__1__wh__ws=0.3125, robot__m__2__me__we=0.53125, robot__m__2__wh__ws=0.0),
    ((0.09199851653318288, 0.1890111260150709), (2.5686902512553618e-06, 5.352328862888897e-06),
    (0.039656396697710684, 0.08147629010051591), (4.4185981758601465e-07, 9.242922666058523e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.78125, robot__Fx__2=-0.5625, robot__m__1__me__we=0.15625,
    robot__m__1__wh__ws=0.1875, robot__m__2__me__we=-0.625, robot__m__2__wh__ws=-0.21875),
    ((0.09197828012224825, 0.18896995569411926), (3.148120579408394e-06, 6.538638007075384e-06),
    (0.039647103495195346, 0.08145667800793867), (5.813885692151673e-07, 1.2231085598158314e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.53125, robot__Fx__2=-0.09375, robot__m__1__me__we=-0.65625,
    robot__m__1__wh__ws=-0.03125, robot__m__2__me__we=-0.28125, robot__m__2__wh__ws=0.03125),
    ((0.0919522792945426, 0.18891491699872004), (3.750477419445213e-06, 7.764997628490859e-06),
    (0.039634320539671204, 0.081427817310302), (7.026394190389479e-07, 1.458936192691656e-06), (0.0,
    0.0),)),
    (m.Samples(robot__Fx__1=-0.59375, robot__Fx__2=0.375, robot__m__1__me__we=0.625,
    robot__m__1__wh__ws=-0.03125, robot__m__2__me__we=-0.25, robot__m__2__wh__ws=0.28125),
    ((0.0919208706841249, 0.1888500177735938), (4.386800206282322e-06, 9.072872784569942e-06),
    (0.03961782979378549, 0.08139482703149511), (8.189056410931812e-07, 1.6981971266359859e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.28125, robot__Fx__2=-0.6875, robot__m__1__me__we=-0.84375,
    robot__m__1__wh__ws=-0.09375, robot__m__2__me__we=-0.875, robot__m__2__wh__ws=-0.1875),
    ((0.09188421860672695, 0.18877349695235143), (5.060889614485098e-06, 1.0461360571686743e-05),
    (0.03959769035031611, 0.08135426539874639), (9.368876869825176e-07, 1.950504838968417e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.65625, robot__Fx__2=-0.125, robot__m__1__me__we=-0.40625,
    robot__m__1__wh__ws=0.0, robot__m__2__me__we=0.65625, robot__m__2__wh__ws=-0.40625),
    ((0.09184218137932149, 0.1886874106984273), (5.770452361930831e-06, 1.1921110474841584e-05),
    (0.039573414862859896, 0.08130292228206075), (1.0352310646797402e-06, 2.166095020150393e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.65625, robot__Fx__2=-0.71875, robot__m__1__me__we=0.84375,
    robot__m__1__wh__ws=0.5, robot__m__2__me__we=-0.625, robot__m__2__wh__ws=-0.78125),
    ((0.09179437192543337, 0.18859042594087577), (6.497995238415809e-06, 1.3449480930829011e-05),
    (0.03954427502210139, 0.08124553278802682), (1.0851116333178791e-06, 2.291100406247514e-06),
    (0.0, 0.0),)),
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
