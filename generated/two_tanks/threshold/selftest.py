"""Does two_tanks_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import two_tanks_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "p1", "p2",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(p1=0.625, p2=0.9375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(p1=0.34375, p2=-0.875), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(p1=0.90625, p2=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(p1=0.03125, p2=-0.15625), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(p1=-0.3125, p2=-0.90625), ((4.6233105022267316e-08, 1.4000966097020692e-07),
    (9.383168693391674e-08, 2.5907751422849873e-07),)),
    (m.Samples(p1=-0.09375, p2=0.5), ((4.622398066868119e-08, 9.71530433134236e-08),
    (9.3814376877619e-08, 1.9591983982434344e-07),)),
    (m.Samples(p1=0.28125, p2=-0.5625), ((4.619796650850775e-08, 9.495339305634086e-08),
    (9.376324205933018e-08, 1.9265267165072488e-07),)),
    (m.Samples(p1=0.1875, p2=-0.71875), ((4.61667977309805e-08, 9.47805105713054e-08),
    (9.36973796118193e-08, 1.9235671812939716e-07),)),
    (m.Samples(p1=-0.96875, p2=0.6875), ((4.6127693972019255e-08, 9.471167833817569e-08),
    (9.361417681900061e-08, 1.922032943861921e-07),)),
    (m.Samples(p1=-0.59375, p2=0.09375), ((4.605755168490274e-08, 9.456389595232266e-08),
    (9.347753480698961e-08, 1.919139441128431e-07),)),
    (m.Samples(p1=0.0625, p2=-0.15625), ((4.5957598261236917e-08, 9.434603633649243e-08),
    (9.329000834020156e-08, 1.9151193586744377e-07),)),
    (m.Samples(p1=-0.03125, p2=0.6875), ((4.583918229068807e-08, 9.41119212901768e-08),
    (9.306718745083392e-08, 1.9107224734588048e-07),)),
    (m.Samples(p1=-0.78125, p2=0.34375), ((4.569391665632574e-08, 9.381901410733891e-08),
    (9.27939970775049e-08, 1.905155029658141e-07),)),
    (m.Samples(p1=0.4375, p2=0.8125), ((4.55153759014344e-08, 9.345066908466119e-08),
    (9.245984882064661e-08, 1.8983108468152352e-07),)),
    (m.Samples(p1=-0.125, p2=0.0), ((4.531049656426566e-08, 9.302130669353096e-08),
    (9.207536684072683e-08, 1.8902229054640177e-07),)),
    (m.Samples(p1=-0.25, p2=-0.375), ((4.509024167081078e-08, 9.256702096426334e-08),
    (9.166284840357374e-08, 1.8817222360840798e-07),)),
    (m.Samples(p1=-0.9375, p2=0.625), ((4.485563589775531e-08, 9.209896033779928e-08),
    (9.12273590976092e-08, 1.8730045304230116e-07),)),
    (m.Samples(p1=-0.1875, p2=-0.0625), ((4.459791055670002e-08, 9.156014241481177e-08),
    (9.075491047905202e-08, 1.863131719750513e-07),)),
    (m.Samples(p1=-0.34375, p2=0.75), ((4.431515075712704e-08, 9.098659402068958e-08),
    (9.024207777144354e-08, 1.852758003505702e-07),)),
    (m.Samples(p1=-0.75, p2=-0.5625), ((4.400917155146276e-08, 9.035852769133053e-08),
    (8.96934679302031e-08, 1.841423163106586e-07),)),
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
