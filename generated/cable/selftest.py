"""Does cable_bench_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import cable_bench_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Uin", "Us",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Uin=0.625, Us=(0.9375, 738197504.0, -1.5762598695796736e+16, 0.90625, 0.0625,
    0.03125, -0.15625, -0.3125, -0.90625, -0.09375, 0.5)), ((-0.05164911463087136,
    2.603927837042722),)),
    (m.Derivatives(Uin=0.28125, Us=(-0.5625, 402653184.0, -1.2947848928690176e+16, -0.96875, 0.6875,
    -0.59375, 0.09375, 0.0625, -0.15625, -0.03125, 0.6875)), ((1.16558629213607,
    1.59153509249451),)),
    (m.Derivatives(Uin=-0.78125, Us=(0.34375, 939524096.0, 1.4636698788954112e+16, -0.125, 0.0,
    -0.25, -0.375, -0.9375, 0.625, -0.1875, -0.0625)), ((-2.225215092491905, 2.2263153075843967),)),
    (m.Derivatives(Uin=-0.34375, Us=(0.75, -1610612736.0, -1.0133099161583616e+16, -0.1875, 0.25,
    0.96875, -0.53125, -0.96875, -0.96875, -0.28125, 0.5)), ((0.1749087037030113,
    2.363677362406714),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Uin=-0.34375, Us=0.3125), ((-0.65625, 0.65625),)),
    (m.Samples(Uin=0.375, Us=-0.125), ((-0.6448019801980198, 0.6880173499381982),)),
    (m.Samples(Uin=0.9375, Us=-0.625), ((-0.6116128320752867, 0.6789542657952709),)),
    (m.Samples(Uin=0.4375, Us=0.375), ((-0.583412577974786, 0.6275192831318056),)),
    (m.Samples(Uin=-0.96875, Us=0.71875), ((-0.5879489625693447, 0.621743056201629),)),
    (m.Samples(Uin=-0.03125, Us=0.25), ((-0.595798983112526, 0.627712320946848),)),
    (m.Samples(Uin=-0.125, Us=-0.6875), ((-0.5812163299815849, 0.6270273524386121),)),
    (m.Samples(Uin=-0.9375, Us=0.53125), ((-0.5786798680017515, 0.6121238442950108),)),
    (m.Samples(Uin=-0.25, Us=0.6875), ((-0.5910451181403307, 0.623339354392503),)),
    (m.Samples(Uin=0.0, Us=-0.21875), ((-0.586457591048443, 0.6222607074869752),)),
    (m.Samples(Uin=0.28125, Us=-0.34375), ((-0.5664906090474836, 0.6104812942246708),)),
    (m.Samples(Uin=-0.1875, Us=0.21875), ((-0.5531071316406028, 0.5840485273768589),)),
    (m.Samples(Uin=0.90625, Us=0.21875), ((-0.5393698617071255, 0.5879051362324457),)),
    (m.Samples(Uin=0.03125, Us=-0.78125), ((-0.5138377852376774, 0.5606497293042804),)),
    (m.Samples(Uin=0.21875, Us=0.625), ((-0.49964050236168384, 0.5332251171623115),)),
    (m.Samples(Uin=0.25, Us=-0.90625), ((-0.48232088845353166, 0.5336065213732734),)),
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
