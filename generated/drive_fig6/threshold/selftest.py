"""Does drive_as_drawn_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import drive_as_drawn_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Fx", "me__we", "wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Fx=0.625, me__we=0.9375, wh__ws=0.34375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx=-0.875, me__we=0.90625, wh__ws=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx=0.03125, me__we=-0.15625, wh__ws=-0.3125), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(Fx=-0.90625, me__we=-0.09375, wh__ws=0.5), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Fx=0.28125, me__we=-0.5625, wh__ws=0.1875), ((0.02363616821654373,
    10.878599168281248), (0.0, 0.0),)),
    (m.Samples(Fx=-0.71875, me__we=-0.96875, wh__ws=0.6875), ((0.025058208857719432,
    0.5944984001772861), (0.0, 0.0),)),
    (m.Samples(Fx=-0.59375, me__we=0.09375, wh__ws=0.0625), ((0.02883476329011956,
    0.08779605801604733), (0.0, 0.0),)),
    (m.Samples(Fx=-0.15625, me__we=-0.03125, wh__ws=0.6875), ((0.034471576778140924,
    0.0735384800513769), (0.0, 0.0),)),
    (m.Samples(Fx=-0.78125, me__we=0.34375, wh__ws=0.4375), ((0.042907515726416434,
    0.08966942721737932), (0.0, 0.0),)),
    (m.Samples(Fx=0.8125, me__we=-0.125, wh__ws=0.0), ((0.05302964245933749, 0.11049160172973799),
    (0.0, 0.0),)),
    (m.Samples(Fx=-0.25, me__we=-0.375, wh__ws=-0.9375), ((0.0589035782991074, 0.12807141079967876),
    (0.0, 0.0),)),
    (m.Samples(Fx=0.625, me__we=-0.1875, wh__ws=-0.0625), ((0.056788129668903, 0.12310351455420702),
    (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, me__we=0.75, wh__ws=-0.75), ((0.047497161952447804, 0.1103164058557145),
    (0.0, 0.0),)),
    (m.Samples(Fx=-0.5625, me__we=-0.1875, wh__ws=0.25), ((0.03285421028505166,
    0.08718065147763406), (0.0, 0.0),)),
    (m.Samples(Fx=0.96875, me__we=-0.53125, wh__ws=-0.96875), ((0.013418387211901599,
    0.05255347666348016), (0.0, 0.0),)),
    (m.Samples(Fx=-0.96875, me__we=-0.28125, wh__ws=0.5), ((0.02022647298902803,
    0.046754757131861696), (0.0, 0.0),)),
    (m.Samples(Fx=-0.34375, me__we=0.3125, wh__ws=0.375), ((0.04363426032826745,
    0.0926798147964367), (0.0, 0.0),)),
    (m.Samples(Fx=-0.125, me__we=0.9375, wh__ws=-0.625), ((0.06612949583029024,
    0.13637177919605512), (0.0, 0.0),)),
    (m.Samples(Fx=0.4375, me__we=0.375, wh__ws=-0.96875), ((0.09466093490777758,
    0.1944550756631444), (0.0, 0.0),)),
    (m.Samples(Fx=0.71875, me__we=-0.03125, wh__ws=0.25), ((0.13004914093790704,
    0.26867715847249424), (0.0, 0.0),)),
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
