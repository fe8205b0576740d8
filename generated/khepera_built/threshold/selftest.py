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
    ((0.1118741623530356, 0.22567236784837857), (0.07939456683118655, 0.16015458363996404), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.59375, Fx__2=0.09375, m__1__motor=2147483613, m__2__motor=2147483611),
    ((0.1118737312597563, 0.2296410449584647), (0.07939490883928449, 0.1629704107631304), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.03125, Fx__2=0.6875, m__1__motor=2147483631, m__2__motor=2147483616),
    ((0.11187040760072971, 0.2298790513096069), (0.0793970169144678, 0.16312906618662124), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.4375, Fx__2=0.8125, m__1__motor=2147483641, m__2__motor=2147483612),
    ((0.11185976257861363, 0.22987924090293094), (0.07940213745804969, 0.16315337063313445), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.25, Fx__2=-0.375, m__1__motor=2147483639, m__2__motor=2147483631),
    ((0.11183925747557821, 0.2298330807963664), (0.07941169140917913, 0.16320083851297626), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.1875, Fx__2=-0.0625, m__1__motor=2147483637, m__2__motor=2147483628),
    ((0.11180957765922443, 0.2297669245838718), (0.07943019920903964, 0.1632327221054816), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.75, Fx__2=-0.5625, m__1__motor=-2147483642, m__2__motor=2147483636),
    ((0.11177074687785675, 0.22971888222712636), (0.07945940092399024, 0.1632986892202949), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.96875, Fx__2=-0.53125, m__1__motor=-2147483645, m__2__motor=-2147483640),
    ((0.11172092746476327, 0.22960983866860646), (0.07950304640988426, 0.16342663938359486), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.28125, Fx__2=0.5, m__1__motor=-2147483625, m__2__motor=-2147483621),
    ((0.1116587018000181, 0.22951634793819697), (0.07956929545242425, 0.16359174011888394), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.375, Fx__2=-0.125, m__1__motor=-2147483617, m__2__motor=-2147483612),
    ((0.1115811792135194, 0.22936005768642861), (0.0796658352377534, 0.16379709501331283), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.4375, Fx__2=0.375, m__1__motor=-2147483608, m__2__motor=-2147483599),
    ((0.11148603949316559, 0.229176748060034), (0.0797974322780602, 0.16408998068481664), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.03125, Fx__2=0.25, m__1__motor=-2147483600, m__2__motor=-2147483591),
    ((0.11137215616582266, 0.2289521828089671), (0.07996809066420889, 0.1644501345644978), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.9375, Fx__2=0.53125, m__1__motor=-2147483591, m__2__motor=-2147483575),
    ((0.11123859493429687, 0.22869001669472608), (0.08018151369951107, 0.16491898483847958), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.0, Fx__2=-0.21875, m__1__motor=-2147483571, m__2__motor=-2147483574),
    ((0.11108353578857219, 0.22840940091107403), (0.08044126438688415, 0.16544493691109594), (0.0,
    0.0),)),
    (m.Samples(Fx__1=-0.1875, Fx__2=0.21875, m__1__motor=-2147483574, m__2__motor=-2147483573),
    ((0.11090523250470401, 0.22803165904474004), (0.08074724795002536, 0.1660751251926148), (0.0,
    0.0),)),
    (m.Samples(Fx__1=0.03125, Fx__2=-0.78125, m__1__motor=-2147483576, m__2__motor=-2147483559),
    ((0.11070556106098266, 0.2276087120192601), (0.0810991374178459, 0.16682922247731383), (0.0,
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
