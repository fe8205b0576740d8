"""Does microphone_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import microphone_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "U0", "u", "v",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(U0=0.625, u=0.9375, v=0.34375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(U0=-0.875, u=0.90625, v=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(U0=0.03125, u=-0.15625, v=-0.3125), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(U0=-0.90625, u=-0.09375, v=0.5), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(U0=0.28125, u=-0.5625, v=0.1875), ((4.440789473684211e-09, 8.886019739001947e-09),
    (7.500000000000001e-05, 0.00015007500006322284),)),
    (m.Samples(U0=-0.71875, u=-0.96875, v=0.6875), ((4.440483131168771e-09, 9.111669970862657e-09),
    (7.698019801980198e-05, 0.00015809923718577903),)),
    (m.Samples(U0=-0.59375, u=0.09375, v=0.0625), ((4.438786194775272e-09, 9.119639293141029e-09),
    (7.842613469267719e-05, 0.00016103025842916353),)),
    (m.Samples(U0=-0.15625, u=-0.03125, v=0.6875), ((4.434770336943667e-09, 9.111063772013247e-09),
    (7.984343895618854e-05, 0.0001641706393978643),)),
    (m.Samples(U0=-0.78125, u=0.34375, v=0.4375), ((4.428108855999326e-09, 9.098294006337793e-09),
    (8.271782630359074e-05, 0.00016999641438757642),)),
    (m.Samples(U0=0.8125, u=-0.125, v=0.0), ((4.419230569592781e-09, 9.078726761516395e-09),
    (8.281252281243053e-05, 0.0001700109737191402),)),
    (m.Samples(U0=-0.25, u=-0.375, v=-0.9375), ((4.409419007570328e-09, 9.058572707488118e-09),
    (7.745979958842201e-05, 0.00016719062150940606),)),
    (m.Samples(U0=0.625, u=-0.1875, v=-0.0625), ((4.399295051132444e-09, 9.037472639212181e-09),
    (7.196554613122552e-05, 0.00014908405844514007),)),
    (m.Samples(U0=-0.34375, u=0.75, v=-0.75), ((4.388181618147069e-09, 9.015838870647775e-09),
    (6.73226640296171e-05, 0.00014483782845572894),)),
    (m.Samples(U0=-0.5625, u=-0.1875, v=0.25), ((4.374880372241957e-09, 8.987867202021315e-09),
    (6.40093439498227e-05, 0.00013214655938348602),)),
    (m.Samples(U0=0.96875, u=-0.53125, v=-0.96875), ((4.360207865318001e-09, 8.956935084452874e-09),
    (5.989529753497472e-05, 0.00013144884668575275),)),
    (m.Samples(U0=-0.96875, u=-0.28125, v=0.5), ((4.345400620596708e-09, 8.927544001365367e-09),
    (5.685281639566829e-05, 0.00011774077075563426),)),
    (m.Samples(U0=-0.34375, u=0.3125, v=0.375), ((4.329195987656077e-09, 8.893851768869836e-09),
    (5.9192364585853076e-05, 0.00012171411858165579),)),
    (m.Samples(U0=-0.125, u=0.9375, v=-0.625), ((4.310349128284019e-09, 8.855363749612494e-09),
    (5.7030139544549054e-05, 0.00012254204052941376),)),
    (m.Samples(U0=0.4375, u=0.375, v=-0.96875), ((4.28914839543969e-09, 8.81085920582054e-09),
    (4.958894866247877e-05, 0.00011079274114415987),)),
    (m.Samples(U0=0.71875, u=-0.03125, v=0.25), ((4.267000388548768e-09, 8.764707505812825e-09),
    (4.57604546295584e-05, 9.489763292390241e-05),)),
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
