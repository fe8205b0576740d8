"""Does chassis_bench_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import chassis_bench_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "body__Fx__1", "body__Fx__2", "u", "yaw",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(body__Fx__1=0.625, body__Fx__2=0.9375, u=(0.34375, -3.5), yaw=(0.90625, 0.25)),
    ((2.437465625, 2.4384094093749997), (-0.008153125, 0.033186278124999996),)),
    (m.Derivatives(body__Fx__1=0.03125, body__Fx__2=-0.15625, u=(-0.3125, -3.625), yaw=(-0.09375,
    2.0)), ((0.78128125, 1.09468753125), (-0.007803124999999999, 0.015412271874999998),)),
    (m.Derivatives(body__Fx__1=0.28125, body__Fx__2=-0.5625, u=(0.1875, -2.875), yaw=(-0.96875,
    2.75)), ((0.43748125, 1.5632375187499998), (0.0014093750000000016, 0.033342684375),)),
    (m.Derivatives(body__Fx__1=-0.59375, body__Fx__2=0.09375, u=(0.0625, -0.625), yaw=(-0.03125,
    2.75)), ((-0.34375625, 0.8439125062499999), (-0.029684375, 0.029745340624999998),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(body__Fx__1=-0.78125, body__Fx__2=0.34375, u=0.4375, yaw=0.8125), ((-0.43754375,
    6.4988380442354075), (-0.02290625, 0.25428478049925524),)),
    (m.Samples(body__Fx__1=-0.125, body__Fx__2=0.0, u=-0.25, yaw=-0.375), ((-0.40382564597425086,
    0.795455261751158), (-0.02155454632715747, 0.03680104126464273),)),
    (m.Samples(body__Fx__1=-0.9375, body__Fx__2=0.625, u=-0.1875, yaw=-0.0625),
    ((-0.34071877833314396, 0.4438405813497119), (-0.0192565347711494, 0.022869059181954088),)),
    (m.Samples(body__Fx__1=-0.34375, body__Fx__2=0.75, u=-0.75, yaw=-0.5625), ((-0.2555087432192184,
    0.40610729918987926), (-0.016837590559844656, 0.021058333597856558),)),
    (m.Samples(body__Fx__1=-0.1875, body__Fx__2=0.25, u=0.96875, yaw=-0.53125),
    ((-0.23012325123727606, 0.3087147961065143), (-0.013982098892958683, 0.01797846032920304),)),
    (m.Samples(body__Fx__1=-0.96875, body__Fx__2=-0.96875, u=-0.28125, yaw=0.5),
    ((-0.22870237645343466, 0.3200765270919364), (-0.012444954032384105, 0.015062973307111156),)),
    (m.Samples(body__Fx__1=-0.34375, body__Fx__2=0.3125, u=0.375, yaw=-0.125),
    ((-0.19864944484422214, 0.25814049139426787), (-0.011426641578250104, 0.013938115304091756),)),
    (m.Samples(body__Fx__1=0.9375, body__Fx__2=-0.625, u=0.4375, yaw=0.375), ((-0.20504081790588916,
    0.26505364614730537), (-0.010303036513784492, 0.012571328523286747),)),
    (m.Samples(body__Fx__1=-0.96875, body__Fx__2=0.71875, u=-0.03125, yaw=0.25),
    ((-0.19112561256874322, 0.24653690690494962), (-0.0096408262354246, 0.011803712451121077),)),
    (m.Samples(body__Fx__1=-0.125, body__Fx__2=-0.6875, u=-0.9375, yaw=0.53125),
    ((-0.11038377631481622, 0.269364479258741), (-0.009184588203877334, 0.011383372971713511),)),
    (m.Samples(body__Fx__1=-0.25, body__Fx__2=0.6875, u=0.0, yaw=-0.21875), ((-0.03449652431533925,
    0.08309865538257828), (-0.008210163289652232, 0.010760671105979905),)),
    (m.Samples(body__Fx__1=0.28125, body__Fx__2=-0.34375, u=-0.1875, yaw=0.21875),
    ((0.0017246649089983786, 0.055611453689915546), (-0.006918715957284932, 0.00886227197365999),)),
    (m.Samples(body__Fx__1=0.90625, body__Fx__2=0.21875, u=0.03125, yaw=-0.78125),
    ((0.03507894633677641, 0.04773146337517821), (-0.005032607552714033, 0.008952094726676508),)),
    (m.Samples(body__Fx__1=0.21875, body__Fx__2=0.625, u=0.25, yaw=-0.90625), ((0.04601275844555384,
    0.0832868906751705), (-0.0019351922924378936, 0.0061845551580753675),)),
    (m.Samples(body__Fx__1=0.8125, body__Fx__2=0.3125, u=0.53125, yaw=0.0), ((0.032359992763530354,
    0.10638459612251232), (0.0001527052815061176, 0.0013943183664952552),)),
    (m.Samples(body__Fx__1=-0.78125, body__Fx__2=-0.5625, u=0.15625, yaw=0.1875),
    ((0.024086421691684498, 0.05603929850558495), (0.0009167427501627085, 0.0016889322667771151),)),
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
