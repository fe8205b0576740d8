"""Does khepera_built_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import khepera_built_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2", "r3",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Fx__1", "Fx__2",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Fx__1=0.625, Fx__2=0.9375, m__1__motor=0.34375, m__2__motor=-0.875), ((math.nan,
    0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=0.90625, Fx__2=0.0625, m__1__motor=0.03125, m__2__motor=-0.15625),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=-0.3125, Fx__2=-0.90625, m__1__motor=-0.09375, m__2__motor=0.5),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=0.28125, Fx__2=-0.5625, m__1__motor=0.1875, m__2__motor=-0.71875),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Fx__1=-0.96875, Fx__2=0.6875, m__1__motor=2147483608, m__2__motor=2147483608),
    ((0.1118741623530356, 0.2238602205986294), (0.07939456683118655, 0.1588685436827116), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.59375, Fx__2=0.09375, m__1__motor=2147483613, m__2__motor=2147483611),
    ((0.11187370518758777, 0.22935474313345316), (0.07939496079058163, 0.16276852719011828), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.03125, Fx__2=0.6875, m__1__motor=2147483631, m__2__motor=2147483616),
    ((0.11187028630774688, 0.22963896825987443), (0.07939716008546473, 0.1629766232291537), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.4375, Fx__2=0.8125, m__1__motor=2147483641, m__2__motor=2147483612),
    ((0.11185958197183686, 0.22963458327076366), (0.0794022224628177, 0.162998375700764), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.25, Fx__2=-0.375, m__1__motor=2147483639, m__2__motor=2147483631),
    ((0.11183907659711523, 0.22959376070215068), (0.07941211157698376, 0.16301831083549198), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.1875, Fx__2=-0.0625, m__1__motor=2147483637, m__2__motor=2147483628),
    ((0.11180939733197082, 0.2295323170055528), (0.07943060047076445, 0.1630570433141092), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.75, Fx__2=-0.5625, m__1__motor=-2147483642, m__2__motor=2147483636),
    ((0.11177047067086204, 0.22945549368341708), (0.0794599637814194, 0.16311675195713016), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.96875, Fx__2=-0.53125, m__1__motor=-2147483645, m__2__motor=-2147483640),
    ((0.1117206559042277, 0.22935387489157394), (0.07950398845080191, 0.16320697723971628), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.28125, Fx__2=0.5, m__1__motor=-2147483625, m__2__motor=-2147483621),
    ((0.11165831733688814, 0.22922957013422926), (0.07957062762303302, 0.16334394546108813), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.375, Fx__2=-0.125, m__1__motor=-2147483617, m__2__motor=-2147483612),
    ((0.11158074060310554, 0.2290727148650218), (0.07966740774726999, 0.16354295162652618), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.4375, Fx__2=0.375, m__1__motor=-2147483608, m__2__motor=-2147483599),
    ((0.1114855422235153, 0.2288794924112617), (0.07979932018138626, 0.16381403252068422), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.03125, Fx__2=0.25, m__1__motor=-2147483600, m__2__motor=-2147483591),
    ((0.11137160612272741, 0.22864753899463408), (0.07997021796485172, 0.16416521247699356), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.9375, Fx__2=0.53125, m__1__motor=-2147483591, m__2__motor=-2147483575),
    ((0.11123798997657335, 0.22837532359482096), (0.08018402187871057, 0.16460442473881187), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.0, Fx__2=-0.21875, m__1__motor=-2147483571, m__2__motor=-2147483574),
    ((0.11108282362026756, 0.22806140092105778), (0.08044390583586399, 0.1651383928174862), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.1875, Fx__2=0.21875, m__1__motor=-2147483574, m__2__motor=-2147483573),
    ((0.11090453390857283, 0.2276960521198373), (0.08075000838570773, 0.16576715851133308), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.03125, Fx__2=-0.78125, m__1__motor=-2147483576, m__2__motor=-2147483559),
    ((0.11070487758523616, 0.22728502212101478), (0.08110222975076664, 0.1664904919794133), (0.0,
    0.0),)),
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
