"""Does motor_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import motor_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "load", "U", "current", "speed",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(load=0.625, U=0.9375, current=(0.34375, -57344.0), speed=(0.90625, 4194304.0)),
    ((12.087519062499998, 24.2171373184375), (0.682524477875, 0.684997540477875),)),
    (m.Derivatives(load=0.03125, U=-0.15625, current=(-0.3125, -59392.0), speed=(-0.09375,
    33554432.0)), ((23.1616790625, 23.4974969915625), (0.5021078073749999, 0.502580898663625),)),
    (m.Derivatives(load=0.28125, U=-0.5625, current=(0.1875, -47104.0), speed=(-0.96875,
    46137344.0)), ((10.2721003125, 18.0145349128125), (0.926503162875, 0.928489061594125),)),
    (m.Derivatives(load=-0.59375, U=0.09375, current=(0.0625, -10240.0), speed=(-0.03125,
    46137344.0)), ((2.0658596874999997, 4.2700317971874995), (0.05195306912499998,
    1.240538705437875),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(load=-0.78125, U=0.34375, current=0.4375, speed=0.8125), ((-7.359101875,
    8.116912849149164), (-0.78277595625, 0.7882564534374882),)),
    (m.Samples(load=-0.125, U=0.0, current=-0.25, speed=-0.375), ((-7.3582928583594756,
    7.784602357254196), (-0.7827329147757164, 0.82361678167942),)),
    (m.Samples(load=-0.9375, U=0.625, current=-0.1875, speed=-0.0625), ((-7.353667338130031,
    7.762662422514158), (-0.7825294701103023, 0.8267563828298264),)),
    (m.Samples(load=-0.34375, U=0.75, current=-0.75, speed=-0.5625), ((-7.344084731339392,
    7.771366870326627), (-0.7823024669365614, 0.82552981858465),)),
    (m.Samples(load=-0.1875, U=0.25, current=0.96875, speed=-0.53125), ((-7.329260200497115,
    7.759783315784581), (-0.7819404869839588, 0.8248494507625252),)),
    (m.Samples(load=-0.96875, U=-0.96875, current=-0.28125, speed=0.5), ((-7.315389961990712,
    7.724544900317035), (-0.7814215294813388, 0.8257194582966443),)),
    (m.Samples(load=-0.34375, U=0.3125, current=0.375, speed=-0.125), ((-7.299628578491622,
    7.708880070488866), (-0.7809045214662893, 0.8240336089121899),)),
    (m.Samples(load=0.9375, U=-0.625, current=0.4375, speed=0.375), ((-7.283592777443828,
    7.6943396363564105), (-0.7801938619729685, 0.8244934170369664),)),
    (m.Samples(load=-0.96875, U=0.71875, current=-0.03125, speed=0.25), ((-7.267810464793512,
    7.6648974902519456), (-0.7790463202458245, 0.8232039678539923),)),
    (m.Samples(load=-0.125, U=-0.6875, current=-0.9375, speed=0.53125), ((-7.248895728246122,
    7.676371314695807), (-0.7778382958286133, 0.8203483035817024),)),
    (m.Samples(load=-0.25, U=0.6875, current=0.0, speed=-0.21875), ((-7.223621151878875,
    7.617089824138937), (-0.7764840933710779, 0.8191186283332077),)),
    (m.Samples(load=0.28125, U=-0.34375, current=-0.1875, speed=0.21875), ((-7.195142891569471,
    7.591922404429549), (-0.7749334025154636, 0.8175679836544067),)),
    (m.Samples(load=0.90625, U=0.21875, current=0.03125, speed=-0.78125), ((-7.164165695540446,
    7.553330881824739), (-0.773023078055188, 0.8167755524699758),)),
    (m.Samples(load=0.21875, U=0.625, current=0.25, speed=-0.90625), ((-7.1317589299639375,
    7.52679092106426), (-0.7706150119977869, 0.8128610862825493),)),
    (m.Samples(load=0.8125, U=0.3125, current=0.53125, speed=0.0), ((-7.0994539053820125,
    7.501266983534326), (-0.7678300484832299, 0.8110438151732617),)),
    (m.Samples(load=-0.78125, U=-0.5625, current=0.15625, speed=0.1875), ((-7.068451817996071,
    7.456983321291807), (-0.7646781500355592, 0.8075341445427193),)),
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
