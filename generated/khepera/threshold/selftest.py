"""Does khepera_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import khepera_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2", "r3", "r4", "r5",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Fx__1", "Fx__2", "m__1__me__we", "m__1__wh__ws", "m__2__me__we", "m__2__wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1", "r3",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Fx__1=0.625, Fx__2=0.9375, m__1__me__we=0.34375, m__1__wh__ws=-0.875,
    m__2__me__we=0.90625, m__2__wh__ws=0.0625), ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=0.03125, Fx__2=-0.15625, m__1__me__we=-0.3125, m__1__wh__ws=-0.90625,
    m__2__me__we=-0.09375, m__2__wh__ws=0.5), ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=0.28125, Fx__2=-0.5625, m__1__me__we=0.1875, m__1__wh__ws=-0.71875,
    m__2__me__we=-0.96875, m__2__wh__ws=0.6875), ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=-0.59375, Fx__2=0.09375, m__1__me__we=0.0625, m__1__wh__ws=-0.15625,
    m__2__me__we=-0.03125, m__2__wh__ws=0.6875), ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Fx__1=-0.78125, Fx__2=0.34375, m__1__me__we=0.4375, m__1__wh__ws=0.8125,
    m__2__me__we=-0.125, m__2__wh__ws=0.0), ((0.05920170145523554, 58.22029765476422), (0.0, 0.0),
    (0.025081931929321316, 0.051515865802743185), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.25, Fx__2=-0.375, m__1__me__we=-0.9375, m__1__wh__ws=0.625,
    m__2__me__we=-0.1875, m__2__wh__ws=-0.0625), ((0.05968181338052106, 3.0559233813830304), (0.0,
    0.0), (0.024921861063464324, 0.05290631017499655), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.34375, Fx__2=0.75, m__1__me__we=-0.75, m__1__wh__ws=-0.5625,
    m__2__me__we=-0.1875, m__2__wh__ws=0.25), ((0.06480419551711816, 0.29404986023916363), (0.0,
    0.0), (0.025027936065781978, 0.05720339217778841), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.96875, Fx__2=-0.53125, m__1__me__we=-0.96875, m__1__wh__ws=-0.96875,
    m__2__me__we=-0.28125, m__2__wh__ws=0.5), ((0.08308584078562199, 0.20188449522368457), (0.0,
    0.0), (0.02778467513177004, 0.0683877774636532), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.34375, Fx__2=0.3125, m__1__me__we=0.375, m__1__wh__ws=-0.125,
    m__2__me__we=0.9375, m__2__wh__ws=-0.625), ((0.11704553921665015, 0.24787220039541022), (0.0,
    0.0), (0.03247016390477101, 0.08473395457149038), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.4375, Fx__2=0.375, m__1__me__we=-0.96875, m__1__wh__ws=0.71875,
    m__2__me__we=-0.03125, m__2__wh__ws=0.25), ((0.15941216372655267, 0.35176921858506577), (0.0,
    0.0), (0.03493334262909063, 0.07847569463353789), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.125, Fx__2=-0.6875, m__1__me__we=-0.9375, m__1__wh__ws=0.53125,
    m__2__me__we=-0.25, m__2__wh__ws=0.6875), ((0.20283612540257928, 0.43697145763123657), (0.0,
    0.0), (0.03896829288599144, 0.09561472637322276), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.0, Fx__2=-0.21875, m__1__me__we=0.28125, m__1__wh__ws=-0.34375,
    m__2__me__we=-0.1875, m__2__wh__ws=0.21875), ((0.24847987068064678, 0.5235707779299518), (0.0,
    0.0), (0.04815437392526877, 0.10505715110330602), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.90625, Fx__2=0.21875, m__1__me__we=0.03125, m__1__wh__ws=-0.78125,
    m__2__me__we=0.21875, m__2__wh__ws=0.625), ((0.3031161333613874, 0.6453714901121511), (0.0,
    0.0), (0.06144204188742005, 0.14125744103943913), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.25, Fx__2=-0.90625, m__1__me__we=0.8125, m__1__wh__ws=0.3125,
    m__2__me__we=0.53125, m__2__wh__ws=0.0), ((0.36823071664209156, 0.7718814942950251), (0.0, 0.0),
    (0.07829307754218566, 0.16297687471763858), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.78125, Fx__2=-0.5625, m__1__me__we=0.15625, m__1__wh__ws=0.1875,
    m__2__me__we=-0.625, m__2__wh__ws=-0.21875), ((0.43784271905010386, 0.9118401755667856), (0.0,
    0.0), (0.09510415593484427, 0.20314446205477799), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.53125, Fx__2=-0.09375, m__1__me__we=-0.65625, m__1__wh__ws=-0.03125,
    m__2__me__we=-0.28125, m__2__wh__ws=0.03125), ((0.5101919154173088, 1.0560401767995489), (0.0,
    0.0), (0.10958912782726177, 0.22767434433229938), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.59375, Fx__2=0.375, m__1__me__we=0.625, m__1__wh__ws=-0.03125,
    m__2__me__we=-0.25, m__2__wh__ws=0.28125), ((0.5866862555128869, 1.2132242536868827), (0.0,
    0.0), (0.12349093614250563, 0.26129051800021824), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.28125, Fx__2=-0.6875, m__1__me__we=-0.84375, m__1__wh__ws=-0.09375,
    m__2__me__we=-0.875, m__2__wh__ws=-0.1875), ((0.6676995202451113, 1.3813547524822634), (0.0,
    0.0), (0.13778606381565714, 0.2899193584167495), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.65625, Fx__2=-0.125, m__1__me__we=-0.40625, m__1__wh__ws=0.0,
    m__2__me__we=0.65625, m__2__wh__ws=-0.40625), ((0.7530127254121934, 1.554986085301581), (0.0,
    0.0), (0.14962518290048663, 0.32016073567192394), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.65625, Fx__2=-0.71875, m__1__me__we=0.84375, m__1__wh__ws=0.5,
    m__2__me__we=-0.625, m__2__wh__ws=-0.78125), ((0.840571935688321, 1.748745747293443), (0.0,
    0.0), (0.15565951708341144, 0.34270402947725626), (0.0, 0.0), (0.0, 0.0),)),
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
