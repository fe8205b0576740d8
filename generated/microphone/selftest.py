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
    (m.Samples(U0=-0.125, pressure=0.0, u=-0.25, v=-0.375), ((1.25e-08, 3.834280558813441e-08),
    (0.0007499308266577125, 0.008424125646978363),)),
    (m.Samples(U0=-0.9375, pressure=0.625, u=-0.1875, v=-0.0625), ((1.2491974806840063e-08,
    1.4651949170302416e-08), (0.014151952960962735, 0.017710693999597356),)),
    (m.Samples(U0=-0.34375, pressure=0.75, u=-0.75, v=-0.5625), ((1.2460763192373797e-08,
    1.341225348366301e-08), (0.04688875420675073, 0.06357006102360847),)),
    (m.Samples(U0=-0.1875, pressure=0.25, u=0.96875, v=-0.53125), ((1.242434346188881e-08,
    1.3334263736992925e-08), (0.1259127805095946, 0.15060627868848037),)),
    (m.Samples(U0=-0.96875, pressure=-0.96875, u=-0.28125, v=0.5), ((1.235267431190669e-08,
    1.3270054424014039e-08), (0.2394465930205078, 0.2914433435240407),)),
    (m.Samples(U0=-0.34375, pressure=0.3125, u=0.375, v=-0.125), ((1.2248675712543197e-08,
    1.3055690549365342e-08), (0.32855013614422124, 0.3618875166022368),)),
    (m.Samples(U0=0.9375, pressure=-0.625, u=0.4375, v=0.375), ((1.212406779315335e-08,
    1.3037555304464416e-08), (0.4097039494526821, 0.4613036236496573),)),
    (m.Samples(U0=-0.96875, pressure=0.71875, u=-0.03125, v=0.25), ((1.2001740185569664e-08,
    1.2847033396664404e-08), (0.4624285515250394, 0.5106032286676736),)),
    (m.Samples(U0=-0.125, pressure=-0.6875, u=-0.9375, v=0.53125), ((1.1861831575859771e-08,
    1.2719746984199417e-08), (0.48264967510756207, 0.5444588161421212),)),
    (m.Samples(U0=-0.25, pressure=0.6875, u=0.0, v=-0.21875), ((1.1736250026215586e-08,
    1.2418828980730998e-08), (0.466897948470654, 0.522722435724059),)),
    (m.Samples(U0=0.28125, pressure=-0.34375, u=-0.1875, v=0.21875), ((1.1617151907174281e-08,
    1.2410451512745196e-08), (0.4535273713083643, 0.4937147877354475),)),
    (m.Samples(U0=0.90625, pressure=0.21875, u=0.03125, v=-0.78125), ((1.1514642787808029e-08,
    1.2318346709829681e-08), (0.4424949388231666, 0.5053242273640879),)),
    (m.Samples(U0=0.21875, pressure=0.625, u=0.25, v=-0.90625), ((1.143474144040856e-08,
    1.2142594374462032e-08), (0.4946167490250519, 0.5482442230644319),)),
    (m.Samples(U0=0.8125, pressure=0.3125, u=0.53125, v=0.0), ((1.1360150653067357e-08,
    1.2229302812131838e-08), (0.6184014627399963, 0.6635928229848471),)),
    (m.Samples(U0=-0.78125, pressure=-0.5625, u=0.15625, v=0.1875), ((1.1285029878589098e-08,
    1.2083352227793839e-08), (0.7515727209030197, 0.8147154941966802),)),
    (m.Samples(U0=-0.625, pressure=-0.21875, u=-0.53125, v=-0.09375), ((1.1185018798813548e-08,
    1.2012920534427476e-08), (0.8712790469734543, 0.9328687855948543),)),
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
