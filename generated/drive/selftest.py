"""Does drive_bench_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import drive_bench_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "U0", "Fx", "m__me__we", "m__wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(U0=0.625, Fx=(0.9375, 5632.0), m__me__we=(-0.875, 14848.0, 67108864.0),
    m__me__we_integral=0.03125, m__wh__ws=(-0.15625, -0.01953125, -464.0),
    m__wh__ws_integral=-0.09375), ((-0.9341144247827635, 3.4170119995894908), (10.32725234375,
    44.22061715859375),)),
    (m.Derivatives(U0=0.5, Fx=(0.28125, -9216.0), m__me__we=(0.1875, -11776.0, -1040187392.0),
    m__me__we_integral=0.6875, m__wh__ws=(-0.59375, 0.005859375, 32.0),
    m__wh__ws_integral=-0.15625), ((2.3542204349163103, 3.2016373447435877), (32.183249296875,
    64.90046151632814),)),
    (m.Derivatives(U0=-0.03125, Fx=(0.6875, -12800.0), m__me__we=(0.34375, 7168.0, 872415232.0),
    m__me__we_integral=-0.125, m__wh__ws=(0.0, -0.015625, -192.0), m__wh__ws_integral=-0.9375),
    ((-1.6989875819159543, 2.8975205367663888), (33.623751874999996, 34.345907564375),)),
    (m.Derivatives(U0=0.625, Fx=(-0.1875, -1024.0), m__me__we=(-0.34375, 12288.0, -805306368.0),
    m__me__we_integral=-0.5625, m__wh__ws=(-0.1875, 0.015625, 496.0), m__wh__ws_integral=-0.53125),
    ((0.46908130020655253, 3.1877847818863883), (-13.448251875, 37.028462439375),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(U0=-0.96875, Fx=-0.96875, m__me__we=-0.28125, m__wh__ws=0.5), ((-0.00955625979344722,
    403.3332472105999), (-12.78125, 44.9033275),)),
    (m.Samples(U0=-0.34375, Fx=0.3125, m__me__we=0.375, m__wh__ws=-0.125), ((0.015769154702448076,
    20.22125208244233), (-12.68385711897163, 14.967144264862004),)),
    (m.Samples(U0=0.9375, Fx=-0.625, m__me__we=0.4375, m__wh__ws=0.375), ((0.09331078372656783,
    1.1432104195514716), (-12.573334023746893, 13.319044874276141),)),
    (m.Samples(U0=-0.96875, Fx=0.71875, m__me__we=-0.03125, m__wh__ws=0.25), ((0.20942034547623828,
    0.29974875281491276), (-12.527214108708648, 13.192595954337268),)),
    (m.Samples(U0=-0.125, Fx=-0.6875, m__me__we=-0.9375, m__wh__ws=0.53125), ((0.3413753404554815,
    0.4127279486899411), (-12.508277654943129, 13.168129452377404),)),
    (m.Samples(U0=-0.25, Fx=0.6875, m__me__we=0.0, m__wh__ws=-0.21875), ((0.5012591111006802,
    0.5385135207218926), (-12.417085425713426, 13.144810445587352),)),
    (m.Samples(U0=0.28125, Fx=-0.34375, m__me__we=-0.1875, m__wh__ws=0.21875), ((0.7174092478317918,
    0.7761107047296418), (-12.283277000218654, 12.938505973779835),)),
    (m.Samples(U0=0.90625, Fx=0.21875, m__me__we=0.03125, m__wh__ws=-0.78125), ((1.0207664007027601,
    1.07938741601552), (-12.069213712970543, 12.961954953115638),)),
    (m.Samples(U0=0.21875, Fx=0.625, m__me__we=0.25, m__wh__ws=-0.90625), ((1.4724708731781722,
    1.5521019717461984), (-11.693565227175364, 12.632970520910083),)),
    (m.Samples(U0=0.8125, Fx=0.3125, m__me__we=0.53125, m__wh__ws=0.0), ((2.0737066744186894,
    2.1869970593324415), (-11.4621591364903, 12.099000862262793),)),
    (m.Samples(U0=-0.78125, Fx=-0.5625, m__me__we=0.15625, m__wh__ws=0.1875), ((2.741570759813125,
    2.90631652429398), (-11.414384994692904, 12.018039299746068),)),
    (m.Samples(U0=-0.625, Fx=-0.21875, m__me__we=-0.53125, m__wh__ws=-0.09375),
    ((3.4343392912062054, 3.62317114348395), (-11.355244771934936, 11.985600876818882),)),
    (m.Samples(U0=-0.65625, Fx=-0.03125, m__me__we=-0.28125, m__wh__ws=0.03125),
    ((4.159556953900505, 4.386656036503842), (-11.27612918800962, 11.874402064211829),)),
    (m.Samples(U0=-0.59375, Fx=0.375, m__me__we=0.625, m__wh__ws=-0.03125), ((4.917761275589274,
    5.182666120899422), (-11.211870169295477, 11.81404346579374),)),
    (m.Samples(U0=-0.25, Fx=0.28125, m__me__we=0.28125, m__wh__ws=-0.6875), ((5.732896807778925,
    6.039699965399784), (-11.040069801988185, 11.84833268825083),)),
    (m.Samples(U0=-0.84375, Fx=-0.09375, m__me__we=-0.875, m__wh__ws=-0.1875), ((6.633814985756112,
    6.989413751203096), (-10.855345478129934, 11.512955744606003),)),
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
