"""Does oven_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import oven_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Ta", "Th", "To",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Ta=0.625, Th=0.9375, To=0.34375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Ta=-0.875, Th=0.90625, To=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Ta=0.03125, Th=-0.15625, To=-0.3125), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Ta=-0.90625, Th=-0.09375, To=0.5), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Ta=0.28125, Th=-0.5625, To=0.1875), ((0.15, 0.3001499999334577), (0.1575,
    0.34518749993416936),)),
    (m.Samples(Ta=-0.71875, Th=-0.96875, To=0.6875), ((0.1500178853344015, 0.3075518573127757),
    (0.15750604400955637, 0.3244291086596744),)),
    (m.Samples(Ta=-0.59375, Th=0.09375, To=0.0625), ((0.1500551769618983, 0.3080184177829668),
    (0.15750251730673173, 0.3233960752772907),)),
    (m.Samples(Ta=-0.15625, Th=-0.03125, To=0.6875), ((0.15007738455111932, 0.3080796502666149),
    (0.15745467976034203, 0.32324367044724955),)),
    (m.Samples(Ta=-0.78125, Th=0.34375, To=0.4375), ((0.15006930012356492, 0.3080773206801086),
    (0.15734843810734891, 0.3230426622819107),)),
    (m.Samples(Ta=0.8125, Th=-0.125, To=0.0), ((0.15002283145141584, 0.3079710581714108),
    (0.15718553414100844, 0.32267825513510934),)),
    (m.Samples(Ta=-0.25, Th=-0.375, To=-0.9375), ((0.14991498757072297, 0.30778451502139437),
    (0.15697168850963011, 0.3222740189445101),)),
    (m.Samples(Ta=0.625, Th=-0.1875, To=-0.0625), ((0.14973543801193145, 0.30738797237243987),
    (0.15671006550550257, 0.3217056233816379),)),
    (m.Samples(Ta=-0.34375, Th=0.75, To=-0.75), ((0.1494685621258451, 0.3068914926504096),
    (0.1563809444617275, 0.32108625087784337),)),
    (m.Samples(Ta=-0.5625, Th=-0.1875, To=0.25), ((0.1491058004254712, 0.30609656553547004),
    (0.15596098075040746, 0.3201830038312974),)),
    (m.Samples(Ta=0.96875, Th=-0.53125, To=-0.96875), ((0.14867810787940336, 0.3052455893590337),
    (0.1554813579790043, 0.31921316764315977),)),
    (m.Samples(Ta=-0.96875, Th=-0.28125, To=0.5), ((0.14821567429470814, 0.3042635952686089),
    (0.1549788259840394, 0.31817093606109054),)),
    (m.Samples(Ta=-0.34375, Th=0.3125, To=0.375), ((0.14773660415097195, 0.30328549652864906),
    (0.1544449612458058, 0.317073005063878),)),
    (m.Samples(Ta=-0.125, Th=0.9375, To=-0.625), ((0.14720522014197124, 0.30224759963245995),
    (0.15383953438334216, 0.31587093901370605),)),
    (m.Samples(Ta=0.4375, Th=0.375, To=-0.96875), ((0.1465503876515048, 0.30090488322549874),
    (0.15312430522421167, 0.31439960798942973),)),
    (m.Samples(Ta=0.71875, Th=-0.03125, To=0.25), ((0.14578620561177313, 0.29927972600572783),
    (0.15232916732292937, 0.3127147515375772),)),
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
