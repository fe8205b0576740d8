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
    511.7537540260629), (-12.78125, 1686.776149392966),)),
    (m.Samples(U0=-0.34375, Fx=0.3125, m__me__we=0.375, m__wh__ws=-0.125), ((0.00749558801360473,
    25.83681247022701), (-12.684180473981616, 98.36479833295013),)),
    (m.Samples(U0=0.9375, Fx=-0.625, m__me__we=0.4375, m__wh__ws=0.375), ((0.09183272995258229,
    1.8032612863082693), (-12.573374514980344, 21.153008909155577),)),
    (m.Samples(U0=-0.96875, Fx=0.71875, m__me__we=-0.03125, m__wh__ws=0.25), ((0.20633163122197132,
    0.5778555995523118), (-12.527319331288306, 16.17664552588661),)),
    (m.Samples(U0=-0.125, Fx=-0.6875, m__me__we=-0.9375, m__wh__ws=0.53125), ((0.3420909080200976,
    0.958058612390996), (-12.508237064785908, 18.5466760776698),)),
    (m.Samples(U0=-0.25, Fx=0.6875, m__me__we=0.0, m__wh__ws=-0.21875), ((0.4920492767848153,
    0.7762290500138254), (-12.417436082287, 15.784374416980647),)),
    (m.Samples(U0=0.28125, Fx=-0.34375, m__me__we=-0.1875, m__wh__ws=0.21875), ((0.7142051316844158,
    1.0170988289702065), (-12.283378143724518, 15.28847640884531),)),
    (m.Samples(U0=0.90625, Fx=0.21875, m__me__we=0.03125, m__wh__ws=-0.78125), ((1.0044216473451542,
    1.8823563404996557), (-12.069821739594312, 20.69184570495732),)),
    (m.Samples(U0=0.21875, Fx=0.625, m__me__we=0.25, m__wh__ws=-0.90625), ((1.454854638626406,
    2.502184009716075), (-11.694179650832904, 22.10673909605982),)),
    (m.Samples(U0=0.8125, Fx=0.3125, m__me__we=0.53125, m__wh__ws=0.0), ((2.0685221162650005,
    2.2548521032808697), (-11.462255547434951, 13.03220753631579),)),
    (m.Samples(U0=-0.78125, Fx=-0.5625, m__me__we=0.15625, m__wh__ws=0.1875), ((2.7390617032468105,
    3.1518724942942895), (-11.414389368895732, 13.877749588915037),)),
    (m.Samples(U0=-0.625, Fx=-0.21875, m__me__we=-0.53125, m__wh__ws=-0.09375), ((3.428248972137392,
    3.7795108630212835), (-11.355403824916065, 13.083241316597698),)),
    (m.Samples(U0=-0.65625, Fx=-0.03125, m__me__we=-0.28125, m__wh__ws=0.03125),
    ((4.155341657594741, 4.484423905765314), (-11.276218330431028, 12.289157734713287),)),
    (m.Samples(U0=-0.59375, Fx=0.375, m__me__we=0.625, m__wh__ws=-0.03125), ((4.9129059331673695,
    5.282868258181661), (-11.21199289272727, 12.16403694973195),)),
    (m.Samples(U0=-0.25, Fx=0.28125, m__me__we=0.28125, m__wh__ws=-0.6875), ((5.719558463289837,
    6.79600215609439), (-11.040524647864425, 18.489215019588094),)),
    (m.Samples(U0=-0.84375, Fx=-0.09375, m__me__we=-0.875, m__wh__ws=-0.1875), ((6.627486496255351,
    7.270263805671121), (-10.85550796661316, 13.997022510832606),)),
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
