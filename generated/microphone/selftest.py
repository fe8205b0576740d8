"""Does microphone_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import microphone_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "U0", "pressure", "u", "v",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(U0=0.625, pressure=0.9375, u=(0.34375, -29360128.0), v=(0.90625, 268435456.0),
    v_integral=0.03125), ((8.59465504408632e-07, 9.291442521625626e-07), (-424.68717475000005,
    425.11204961225),)),
    (m.Derivatives(U0=-0.15625, pressure=-0.3125, u=(-0.90625, -3145728.0), v=(0.5, 1207959552.0),
    v_integral=-0.5625), ((7.004820195335344e-08, 1.1131335251355178e-07), (1604.53941675,
    4024.4810438332497),)),
    (m.Derivatives(U0=0.1875, pressure=-0.71875, u=(-0.96875, 23068672.0), v=(-0.59375,
    402653184.0), v_integral=0.0625), ((-2.1107729209812965e-07, 4.427699848557705e-07),
    (-715.1520683750001, 715.8695978183752),)),
    (m.Derivatives(U0=-0.15625, pressure=-0.03125, u=(0.6875, -26214400.0), v=(0.34375,
    1879048192.0), v_integral=0.8125), ((-5.580866026987918e-08, 1.1305428177370822e-07),
    (-5941.548882625, 5947.4904315076255),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(U0=-0.125, pressure=0.0, u=-0.25, v=-0.375), ((1.25e-08, 3.798109525213067e-08),
    (0.0007499308266577125, 0.0007508193810699035),)),
    (m.Samples(U0=-0.9375, pressure=0.625, u=-0.1875, v=-0.0625), ((1.248902437649495e-08,
    1.4408770730487884e-08), (0.011609290286316647, 0.012127664914075185),)),
    (m.Samples(U0=-0.34375, pressure=0.75, u=-0.75, v=-0.5625), ((1.246168791164521e-08,
    1.3193110047155209e-08), (0.048572234669232266, 0.05054485193459889),)),
    (m.Samples(U0=-0.1875, pressure=0.25, u=0.96875, v=-0.53125), ((1.2420113426215661e-08,
    1.3104364865242696e-08), (0.1273927242108025, 0.13362644186535155),)),
    (m.Samples(U0=-0.96875, pressure=-0.96875, u=-0.28125, v=0.5), ((1.2350010379997437e-08,
    1.3026872931552133e-08), (0.23238760865924063, 0.2706765565244762),)),
    (m.Samples(U0=-0.34375, pressure=0.3125, u=0.375, v=-0.125), ((1.2245900388060974e-08,
    1.2911383216318181e-08), (0.3267536900514844, 0.34978351093423254),)),
    (m.Samples(U0=0.9375, pressure=-0.625, u=0.4375, v=0.375), ((1.2125364977743344e-08,
    1.2777041693227635e-08), (0.4037944584036484, 0.4452959460392965),)),
    (m.Samples(U0=-0.96875, pressure=0.71875, u=-0.03125, v=0.25), ((1.1998268213981484e-08,
    1.2653081167290119e-08), (0.45761410239431705, 0.49900362693427824),)),
    (m.Samples(U0=-0.125, pressure=-0.6875, u=-0.9375, v=0.53125), ((1.1863049115136915e-08,
    1.2531542097368752e-08), (0.47554494218233917, 0.5311074038437511),)),
    (m.Samples(U0=-0.25, pressure=0.6875, u=0.0, v=-0.21875), ((1.1732844465128032e-08,
    1.2361671262027777e-08), (0.466096603609007, 0.5150430566172537),)),
    (m.Samples(U0=0.28125, pressure=-0.34375, u=-0.1875, v=0.21875), ((1.161390382681979e-08,
    1.2227925038837708e-08), (0.44913268728995726, 0.4874378631095332),)),
    (m.Samples(U0=0.90625, pressure=0.21875, u=0.03125, v=-0.78125), ((1.151049029941783e-08,
    1.2118081251987382e-08), (0.44648467019423604, 0.4902565239990581),)),
    (m.Samples(U0=0.21875, pressure=0.625, u=0.25, v=-0.90625), ((1.1427739862343305e-08,
    1.2035815501076452e-08), (0.499696314140798, 0.5280526309777847),)),
    (m.Samples(U0=0.8125, pressure=0.3125, u=0.53125, v=0.0), ((1.1354468708434725e-08,
    1.1965121922931034e-08), (0.6159740064091705, 0.6490699111318776),)),
    (m.Samples(U0=-0.78125, pressure=-0.5625, u=0.15625, v=0.1875), ((1.1275554072507057e-08,
    1.1892010728431475e-08), (0.7476264729165957, 0.7974867845756765),)),
    (m.Samples(U0=-0.625, pressure=-0.21875, u=-0.53125, v=-0.09375), ((1.117861566775784e-08,
    1.1785294608831717e-08), (0.869719742213809, 0.9182774232580145),)),
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
