"""Does quarter_car_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import quarter_car_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "vw", "vb", "stroke",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(vw=0.625, vb=(0.9375, 22.0), stroke=(-0.875, 0.90625)), ((-26241.7,
    27519.191700000003), (-1.21875, 2.46875),)),
    (m.Derivatives(vw=0.0625, vb=(0.03125, -10.0), stroke=(-0.3125, -0.90625)), ((-5532.95,
    12070.00795), (0.9375, 1.0),)),
    (m.Derivatives(vw=-0.09375, vb=(0.5, 18.0), stroke=(-0.5625, 0.1875)), ((-19617.95,
    19637.56795), (-0.78125, 0.78125),)),
    (m.Derivatives(vw=-0.71875, vb=(-0.96875, 44.0), stroke=(-0.59375, 0.09375)), ((-27656.7,
    29623.7942), (0.15625, 1.78125),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(vw=0.0625, vb=-0.15625, stroke=-0.03125), ((-3482.9500000000003, 5613.87045),
    (0.21875, 1.47),)),
    (m.Samples(vw=0.6875, vb=-0.78125, stroke=0.34375), ((-3442.820627820769, 3669.9686368927014),
    (0.14511093990338567, 0.36309391929142515),)),
    (m.Samples(vw=0.4375, vb=0.8125, stroke=-0.125), ((-3464.1755576423493, 3498.946736919306),
    (0.09350536141856979, 0.12131514568342464),)),
    (m.Samples(vw=0.0, vb=-0.25, stroke=-0.375), ((-3517.7486593715716, 3574.868088685956),
    (0.1847460767063368, 0.19977664700523734),)),
    (m.Samples(vw=-0.9375, vb=0.625, stroke=-0.1875), ((-3559.7321930204957, 3587.291118666544),
    (0.2841620608294033, 0.3083284392887748),)),
    (m.Samples(vw=-0.0625, vb=-0.34375, stroke=0.75), ((-3593.8786734223804, 3669.282804315722),
    (0.1582720820435675, 0.48475585526744147),)),
    (m.Samples(vw=-0.75, vb=-0.5625, stroke=-0.1875), ((-3550.297803388998, 3653.9546624659356),
    (0.03836603719216013, 0.07694980514157218),)),
    (m.Samples(vw=0.25, vb=0.96875, stroke=-0.53125), ((-3591.341005808605, 3624.2908951715067),
    (0.17386251224524116, 0.1882543531704085),)),
    (m.Samples(vw=-0.96875, vb=-0.96875, stroke=-0.28125), ((-3607.2482362110804,
    3762.6217586690523), (0.32181009272240546, 0.3491368516363101),)),
    (m.Samples(vw=0.5, vb=-0.34375, stroke=0.3125), ((-3541.8998847677967, 3625.7330817930465),
    (0.29820498568785664, 0.455505037025386),)),
    (m.Samples(vw=0.375, vb=-0.125, stroke=0.9375), ((-3529.3137771374895, 3578.56553205524),
    (0.0366714630553143, 0.4452660283067121),)),
    (m.Samples(vw=-0.625, vb=0.4375, stroke=0.375), ((-3561.5543051285736, 3590.2453682968717),
    (-0.22602310906536896, 0.26149124060086226),)),
    (m.Samples(vw=-0.96875, vb=0.71875, stroke=-0.03125), ((-3642.6539486683782,
    3671.5973329086673), (-0.2888370710779738, 0.32017732028421086),)),
    (m.Samples(vw=0.25, vb=-0.125, stroke=-0.6875), ((-3685.924082317738, 3734.730800204814),
    (-0.1410095561798437, 0.43118696548364566),)),
    (m.Samples(vw=-0.9375, vb=0.53125, stroke=-0.25), ((-3718.9946949248597, 3753.364497406692),
    (0.04301149244616546, 0.08602405085759893),)),
    (m.Samples(vw=0.6875, vb=0.0, stroke=-0.21875), ((-3760.7940738517323, 3797.3022971127657),
    (0.12798531202406374, 0.14372311641561392),)),
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
