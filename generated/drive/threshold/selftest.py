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
    10.878599168281248), (0.0, 0.0),)),
    (m.Samples(Fx=-0.71875, m__me__we=-0.96875, m__wh__ws=0.6875), ((0.025059021216207355,
    0.59449761616544), (0.0, 0.0),)),
    (m.Samples(Fx=-0.59375, m__me__we=0.09375, m__wh__ws=0.0625), ((0.028840960501025865,
    0.08780071255606894), (0.0, 0.0),)),
    (m.Samples(Fx=-0.15625, m__me__we=-0.03125, m__wh__ws=0.6875), ((0.0344958366602228,
    0.07357232895628542), (0.0, 0.0),)),
    (m.Samples(Fx=-0.78125, m__me__we=0.34375, m__wh__ws=0.4375), ((0.04297441929970559,
    0.08978112597331414), (0.0, 0.0),)),
    (m.Samples(Fx=0.8125, m__me__we=-0.125, m__wh__ws=0.0), ((0.05317829262343619,
    0.11076011228118553), (0.0, 0.0),)),
    (m.Samples(Fx=-0.25, m__me__we=-0.375, m__wh__ws=-0.9375), ((0.05918853085384852,
    0.12860797800746943), (0.0, 0.0),)),
    (m.Samples(Fx=0.625, m__me__we=-0.1875, m__wh__ws=-0.0625), ((0.05727787352944127,
    0.12384582856595369), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, m__me__we=0.75, m__wh__ws=-0.75), ((0.048270500474780854,
    0.1115181618293019), (0.0, 0.0),)),
    (m.Samples(Fx=-0.5625, m__me__we=-0.1875, m__wh__ws=0.25), ((0.033995779924409546,
    0.08902960190342556), (0.0, 0.0),)),
    (m.Samples(Fx=0.96875, m__me__we=-0.53125, m__wh__ws=-0.96875), ((0.01501424367801339,
    0.055224313470337384), (0.0, 0.0),)),
    (m.Samples(Fx=-0.96875, m__me__we=-0.28125, m__wh__ws=0.5), ((0.01809299252559992,
    0.04250450803820953), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, m__me__we=0.3125, m__wh__ws=0.375), ((0.040885021676669284,
    0.08703769181431566), (0.0, 0.0),)),
    (m.Samples(Fx=-0.125, m__me__we=0.9375, m__wh__ws=-0.625), ((0.06269104453331824,
    0.12930766919135916), (0.0, 0.0),)),
    (m.Samples(Fx=0.4375, m__me__we=0.375, m__wh__ws=-0.96875), ((0.09046459453932187,
    0.18583199663806144), (0.0, 0.0),)),
    (m.Samples(Fx=0.71875, m__me__we=-0.03125, m__wh__ws=0.25), ((0.12503544065106714,
    0.25837358405122246), (0.0, 0.0),)),
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
