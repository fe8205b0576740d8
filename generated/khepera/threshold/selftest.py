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
    m__2__me__we=-0.125, m__2__wh__ws=0.0), ((0.05920170145523554, 47.044246792841875), (0.0, 0.0),
    (0.025081931929321316, 0.051245324516260134), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.25, Fx__2=-0.375, m__1__me__we=-0.9375, m__1__wh__ws=0.625,
    m__2__me__we=-0.1875, m__2__wh__ws=-0.0625), ((0.05973526916849506, 2.474628450347884), (0.0,
    0.0), (0.024904015056016634, 0.05147767493746027), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.34375, Fx__2=0.75, m__1__me__we=-0.75, m__1__wh__ws=-0.5625,
    m__2__me__we=-0.1875, m__2__wh__ws=0.25), ((0.06519988685440499, 0.25233376429160725), (0.0,
    0.0), (0.025097994762071498, 0.051793754563722254), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.96875, Fx__2=-0.53125, m__1__me__we=-0.96875, m__1__wh__ws=-0.96875,
    m__2__me__we=-0.28125, m__2__wh__ws=0.5), ((0.08362334725263885, 0.17766120628353402), (0.0,
    0.0), (0.027930998545196404, 0.05736249480096639), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.34375, Fx__2=0.3125, m__1__me__we=0.375, m__1__wh__ws=-0.125,
    m__2__me__we=0.9375, m__2__wh__ws=-0.625), ((0.11737271623593755, 0.24144605799056423), (0.0,
    0.0), (0.0323047828302799, 0.07012647987879553), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.4375, Fx__2=0.375, m__1__me__we=-0.96875, m__1__wh__ws=0.71875,
    m__2__me__we=-0.03125, m__2__wh__ws=0.25), ((0.15950842170039825, 0.33197878448392176), (0.0,
    0.0), (0.03500369615241498, 0.07266009350968862), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.125, Fx__2=-0.6875, m__1__me__we=-0.9375, m__1__wh__ws=0.53125,
    m__2__me__we=-0.25, m__2__wh__ws=0.6875), ((0.20297736188182497, 0.4210023175239686), (0.0,
    0.0), (0.03916816668348243, 0.08047251577454877), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.0, Fx__2=-0.21875, m__1__me__we=0.28125, m__1__wh__ws=-0.34375,
    m__2__me__we=-0.1875, m__2__wh__ws=0.21875), ((0.24886614073402272, 0.5118893838237071), (0.0,
    0.0), (0.0482331038004495, 0.09916681306489988), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.90625, Fx__2=0.21875, m__1__me__we=0.03125, m__1__wh__ws=-0.78125,
    m__2__me__we=0.21875, m__2__wh__ws=0.625), ((0.3036393832489857, 0.6236485651430785), (0.0,
    0.0), (0.06163842722517463, 0.12670888437023092), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.25, Fx__2=-0.90625, m__1__me__we=0.8125, m__1__wh__ws=0.3125,
    m__2__me__we=0.53125, m__2__wh__ws=0.0), ((0.3684603342364435, 0.7586376926708209), (0.0, 0.0),
    (0.07832041722065554, 0.16111289355444736), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.78125, Fx__2=-0.5625, m__1__me__we=0.15625, m__1__wh__ws=0.1875,
    m__2__me__we=-0.625, m__2__wh__ws=-0.21875), ((0.4381018983847598, 0.9012778962875336), (0.0,
    0.0), (0.09506479037313116, 0.19679783832150058), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.53125, Fx__2=-0.09375, m__1__me__we=-0.65625, m__1__wh__ws=-0.03125,
    m__2__me__we=-0.28125, m__2__wh__ws=0.03125), ((0.5105095029307659, 1.0486994861730798), (0.0,
    0.0), (0.10961279979125459, 0.22559819465888659), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.59375, Fx__2=0.375, m__1__me__we=0.625, m__1__wh__ws=-0.03125,
    m__2__me__we=-0.25, m__2__wh__ws=0.28125), ((0.5870034663465624, 1.2055012536136975), (0.0,
    0.0), (0.12358330181133959, 0.2539919783426333), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.28125, Fx__2=-0.6875, m__1__me__we=-0.84375, m__1__wh__ws=-0.09375,
    m__2__me__we=-0.875, m__2__wh__ws=-0.1875), ((0.668033031743762, 1.3718356871937167), (0.0,
    0.0), (0.13774707038783063, 0.28420989770388205), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=-0.65625, Fx__2=-0.125, m__1__me__we=-0.40625, m__1__wh__ws=0.0,
    m__2__me__we=0.65625, m__2__wh__ws=-0.40625), ((0.7533181395471279, 1.5469434890251839), (0.0,
    0.0), (0.1495165463446412, 0.3098703358475407), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(Fx__1=0.65625, Fx__2=-0.71875, m__1__me__we=0.84375, m__1__wh__ws=0.5,
    m__2__me__we=-0.625, m__2__wh__ws=-0.78125), ((0.8407304497421889, 1.7293596653267678), (0.0,
    0.0), (0.15543316549398076, 0.32444822325498496), (0.0, 0.0), (0.0, 0.0),)),
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
