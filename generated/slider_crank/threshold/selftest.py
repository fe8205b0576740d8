"""Does slider_crank_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import slider_crank_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "speed",
)
SPOILT: tuple[str, ...] = (
    "r1",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(speed=0.625), ((math.nan, 0.0),)),
    (m.Derivatives(speed=0.9375), ((math.nan, 0.0),)),
    (m.Derivatives(speed=0.34375), ((math.nan, 0.0),)),
    (m.Derivatives(speed=-0.875), ((math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(speed=0.90625), ((9.062500000000001e-05, 0.00018134062498039718),)),
    (m.Samples(speed=0.0625), ((9.061667407218282e-05, 0.00018577425910929913),)),
    (m.Samples(speed=0.03125), ((9.058350236325655e-05, 0.00018593833970100416),)),
    (m.Samples(speed=-0.15625), ((9.051579358537363e-05, 0.00018581397330101723),)),
    (m.Samples(speed=-0.3125), ((9.040940653620933e-05, 0.00018559979163481846),)),
    (m.Samples(speed=-0.90625), ((9.025515168864793e-05, 0.0001852957064560898),)),
    (m.Samples(speed=-0.09375), ((9.004982258089067e-05, 0.0001848600315684561),)),
    (m.Samples(speed=0.5), ((8.981150843848296e-05, 0.0001843651560151099),)),
    (m.Samples(speed=0.28125), ((8.955898886798775e-05, 0.0001838460325162593),)),
    (m.Samples(speed=-0.5625), ((8.928608693397712e-05, 0.00018329723779990142),)),
    (m.Samples(speed=0.1875), ((8.89824385354944e-05, 0.00018266463896431993),)),
    (m.Samples(speed=-0.71875), ((8.864691340251887e-05, 0.00018198818569785874),)),
    (m.Samples(speed=-0.96875), ((8.826796321879517e-05, 0.00018121801550608486),)),
    (m.Samples(speed=0.6875), ((8.785005744925218e-05, 0.0001803412049372028),)),
    (m.Samples(speed=-0.59375), ((8.741227891240924e-05, 0.0001794507260213044),)),
    (m.Samples(speed=0.09375), ((8.695337172567222e-05, 0.00017849862531305865),)),
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
