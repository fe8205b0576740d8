"""Does motor_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import motor_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "current", "speed",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(current=0.625, speed=0.9375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(current=0.34375, speed=-0.875), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(current=0.90625, speed=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(current=0.03125, speed=-0.15625), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(current=-0.3125, speed=-0.90625), ((0.27506361875, 0.5504023011354882),
    (2.30159375e-05, 4.605489094731618e-05),)),
    (m.Samples(current=-0.09375, speed=0.5), ((0.27504473837368887, 0.5643184937432143),
    (2.301426808646211e-05, 4.7219273298285536e-05),)),
    (m.Samples(current=0.28125, speed=-0.5625), ((0.2749376221482727, 0.5648622475900194),
    (2.3005199864529882e-05, 4.7264217966061304e-05),)),
    (m.Samples(current=0.1875, speed=-0.71875), ((0.2746702951918325, 0.5643250675895888),
    (2.2983107115768397e-05, 4.721989566133867e-05),)),
    (m.Samples(current=-0.96875, speed=0.6875), ((0.2743327145092192, 0.5636007205495093),
    (2.2955172199184294e-05, 4.7160214519521134e-05),)),
    (m.Samples(current=-0.59375, speed=0.09375), ((0.2741029809754157, 0.5631324837267285),
    (2.2935372958302272e-05, 4.711965343807556e-05),)),
    (m.Samples(current=0.0625, speed=-0.15625), ((0.27395538948978093, 0.5628362843231303),
    (2.2921681367848603e-05, 4.70919975968084e-05),)),
    (m.Samples(current=-0.03125, speed=0.6875), ((0.27374929218413296, 0.5623925696814643),
    (2.290292479339435e-05, 4.705199726239526e-05),)),
    (m.Samples(current=-0.78125, speed=0.34375), ((0.27351131879437773, 0.561911070739609),
    (2.288111707744496e-05, 4.700767555258587e-05),)),
    (m.Samples(current=0.4375, speed=0.8125), ((0.27327515802281926, 0.5615123410395981),
    (2.28588941319171e-05, 4.6968989249061114e-05),)),
    (m.Samples(current=-0.125, speed=0.0), ((0.2729437835928236, 0.5607425086436502),
    (2.282856458303501e-05, 4.689932152922726e-05),)),
    (m.Samples(current=-0.25, speed=-0.375), ((0.2725237652970429, 0.5598605872439422),
    (2.279085187918974e-05, 4.682026918757367e-05),)),
    (m.Samples(current=-0.9375, speed=0.625), ((0.2721481466711107, 0.5591029276959458),
    (2.2756448451299906e-05, 4.6750858743477096e-05),)),
    (m.Samples(current=-0.1875, speed=-0.0625), ((0.2718800270968585, 0.5585546321849891),
    (2.2730289921199577e-05, 4.6697141572921365e-05),)),
    (m.Samples(current=-0.34375, speed=0.75), ((0.2716586813654956, 0.5581004078774485),
    (2.270749611047532e-05, 4.665050921633068e-05),)),
    (m.Samples(current=-0.75, speed=-0.5625), ((0.27147966894871783, 0.5577439009731929),
    (2.268777271342108e-05, 4.6610692080185196e-05),)),
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
