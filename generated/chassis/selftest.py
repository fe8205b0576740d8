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
    5.50433129375), (-0.02290625, 0.21080515624999996),)),
    (m.Samples(body__Fx__1=-0.125, body__Fx__2=0.0, u=-0.25, yaw=-0.375), ((-0.4037051364518487,
    0.7373976829958513), (-0.021549448309838584, 0.03432218916409588),)),
    (m.Samples(body__Fx__1=-0.9375, body__Fx__2=0.625, u=-0.1875, yaw=-0.0625),
    ((-0.3406233021566657, 0.43160742962712484), (-0.01925391302883851, 0.022549611351409347),)),
    (m.Samples(body__Fx__1=-0.34375, body__Fx__2=0.75, u=-0.75, yaw=-0.5625), ((-0.2553068294727666,
    0.385793840653523), (-0.01683303404345732, 0.020636471460043826),)),
    (m.Samples(body__Fx__1=-0.1875, body__Fx__2=0.25, u=0.96875, yaw=-0.53125),
    ((-0.23022248513993201, 0.28454367730123103), (-0.01397760206254273, 0.017587945264902916),)),
    (m.Samples(body__Fx__1=-0.96875, body__Fx__2=-0.96875, u=-0.28125, yaw=0.5),
    ((-0.22865999597767495, 0.306744068391416), (-0.012444368575849513, 0.014638019445386473),)),
    (m.Samples(body__Fx__1=-0.34375, body__Fx__2=0.3125, u=0.375, yaw=-0.125),
    ((-0.19865676554293463, 0.24639774280232327), (-0.011424195307680051, 0.013739004836600626),)),
    (m.Samples(body__Fx__1=0.9375, body__Fx__2=-0.625, u=0.4375, yaw=0.375), ((-0.2050461037200768,
    0.2503131692734555), (-0.010301194688739516, 0.012237369644491736),)),
    (m.Samples(body__Fx__1=-0.96875, body__Fx__2=0.71875, u=-0.03125, yaw=0.25),
    ((-0.19107323574519405, 0.2397147502851239), (-0.009640745284695166, 0.011515911049830671),)),
    (m.Samples(body__Fx__1=-0.125, body__Fx__2=-0.6875, u=-0.9375, yaw=0.53125),
    ((-0.11020970623545649, 0.246335034469624), (-0.009184151611377317, 0.011000011820982931),)),
    (m.Samples(body__Fx__1=-0.25, body__Fx__2=0.6875, u=0.0, yaw=-0.21875), ((-0.03444693339135188,
    0.07779868127464304), (-0.008207935179518427, 0.010510874182927758),)),
    (m.Samples(body__Fx__1=0.28125, body__Fx__2=-0.34375, u=-0.1875, yaw=0.21875),
    ((0.001784260847476799, 0.048499208566353924), (-0.006917307622809243, 0.008637690784316747),)),
    (m.Samples(body__Fx__1=0.90625, body__Fx__2=0.21875, u=0.03125, yaw=-0.78125),
    ((0.035137491907799925, 0.042723759579154426), (-0.005027515279744564, 0.008444263091335724),)),
    (m.Samples(body__Fx__1=0.21875, body__Fx__2=0.625, u=0.25, yaw=-0.90625), ((0.04602430820012706,
    0.0745598669088934), (-0.0019307443952366662, 0.005611448618776979),)),
    (m.Samples(body__Fx__1=0.8125, body__Fx__2=0.3125, u=0.53125, yaw=0.0), ((0.03233616243891307,
    0.09106166925514009), (0.00015397372629647997, 0.0012405645718703549),)),
    (m.Samples(body__Fx__1=-0.78125, body__Fx__2=-0.5625, u=0.15625, yaw=0.1875),
    ((0.024044197915132563, 0.04743774152540714), (0.0009167166544608031, 0.0014711350300369614),)),
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
