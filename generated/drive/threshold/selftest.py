"""Does drive_bench_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import drive_bench_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Fx", "m__me__we", "m__wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Fx=0.625, m__me__we=0.9375, m__wh__ws=0.34375), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(Fx=-0.875, m__me__we=0.90625, m__wh__ws=0.0625), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(Fx=0.03125, m__me__we=-0.15625, m__wh__ws=-0.3125), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(Fx=-0.90625, m__me__we=-0.09375, m__wh__ws=0.5), ((math.nan, 0.0), (math.nan,
    0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Fx=0.28125, m__me__we=-0.5625, m__wh__ws=0.1875), ((0.02363616821654373,
    13.457910250541083), (0.0, 0.0),)),
    (m.Samples(Fx=-0.71875, m__me__we=-0.96875, m__wh__ws=0.6875), ((0.024916460528918535,
    0.7404168196535851), (0.0, 0.0),)),
    (m.Samples(Fx=-0.59375, m__me__we=0.09375, m__wh__ws=0.0625), ((0.028867051805764328,
    0.0968708297164472), (0.0, 0.0),)),
    (m.Samples(Fx=-0.15625, m__me__we=-0.03125, m__wh__ws=0.6875), ((0.03434742216327307,
    0.08934262581825568), (0.0, 0.0),)),
    (m.Samples(Fx=-0.78125, m__me__we=0.34375, m__wh__ws=0.4375), ((0.04288858926054015,
    0.10057917733709462), (0.0, 0.0),)),
    (m.Samples(Fx=0.8125, m__me__we=-0.125, m__wh__ws=0.0), ((0.05321454191149029,
    0.11228435134105634), (0.0, 0.0),)),
    (m.Samples(Fx=-0.25, m__me__we=-0.375, m__wh__ws=-0.9375), ((0.0594983903429859,
    0.15032028261489896), (0.0, 0.0),)),
    (m.Samples(Fx=0.625, m__me__we=-0.1875, m__wh__ws=-0.0625), ((0.05736189634055109,
    0.1263581589583912), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, m__me__we=0.75, m__wh__ws=-0.75), ((0.0485544011923471,
    0.1288559192456692), (0.0, 0.0),)),
    (m.Samples(Fx=-0.5625, m__me__we=-0.1875, m__wh__ws=0.25), ((0.03401101828647996,
    0.09632896383497742), (0.0, 0.0),)),
    (m.Samples(Fx=0.96875, m__me__we=-0.53125, m__wh__ws=-0.96875), ((0.015371920060320458,
    0.07816963420461381), (0.0, 0.0),)),
    (m.Samples(Fx=-0.96875, m__me__we=-0.28125, m__wh__ws=0.5), ((0.018135463092942717,
    0.05609244047434174), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, m__me__we=0.3125, m__wh__ws=0.375), ((0.040904129051155,
    0.09741226415231762), (0.0, 0.0),)),
    (m.Samples(Fx=-0.125, m__me__we=0.9375, m__wh__ws=-0.625), ((0.062433708074803106,
    0.14451224675695631), (0.0, 0.0),)),
    (m.Samples(Fx=0.4375, m__me__we=0.375, m__wh__ws=-0.96875), ((0.09009792093093007,
    0.20907661209460554), (0.0, 0.0),)),
    (m.Samples(Fx=0.71875, m__me__we=-0.03125, m__wh__ws=0.25), ((0.12500024066133814,
    0.2674422588995249), (0.0, 0.0),)),
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
