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
    8.054309976875002), (-0.78277595625, 0.7827968394987499),)),
    (m.Samples(load=-0.125, U=0.0, current=-0.25, speed=-0.375), ((-7.357900814581585,
    7.761962904269102), (-0.7827109655476842, 0.8218952626521993),)),
    (m.Samples(load=-0.9375, U=0.625, current=-0.1875, speed=-0.0625), ((-7.353291636271559,
    7.743346306717752), (-0.782534629739094, 0.8237471258678123),)),
    (m.Samples(load=-0.34375, U=0.75, current=-0.75, speed=-0.5625), ((-7.34337566184536,
    7.734286871307353), (-0.7822877928360916, 0.8235923856442049),)),
    (m.Samples(load=-0.1875, U=0.25, current=0.96875, speed=-0.53125), ((-7.329577864129888,
    7.7171704567115444), (-0.7819208412925203, 0.823211223408985),)),
    (m.Samples(load=-0.96875, U=-0.96875, current=-0.28125, speed=0.5), ((-7.315016173656646,
    7.7023419101744075), (-0.7814278275328129, 0.8226874986362089),)),
    (m.Samples(load=-0.34375, U=0.3125, current=0.375, speed=-0.125), ((-7.299598628123961,
    7.685255225741177), (-0.7808901142265199, 0.8221239669926356),)),
    (m.Samples(load=0.9375, U=-0.625, current=0.4375, speed=0.375), ((-7.28363232774415,
    7.6681763032361765), (-0.7801368245405909, 0.8215225173123628),)),
    (m.Samples(load=-0.96875, U=0.71875, current=-0.03125, speed=0.25), ((-7.267531609938719,
    7.6514994072068125), (-0.7790528761665484, 0.820224394064821),)),
    (m.Samples(load=-0.125, U=-0.6875, current=-0.9375, speed=0.53125), ((-7.248133733961324,
    7.634320555119784), (-0.7778167377893185, 0.818890083387331),)),
    (m.Samples(load=-0.25, U=0.6875, current=0.0, speed=-0.21875), ((-7.2233657678103755,
    7.605566468333914), (-0.7764669400307038, 0.8174637258084667),)),
    (m.Samples(load=0.28125, U=-0.34375, current=-0.1875, speed=0.21875), ((-7.1948145652272375,
    7.575403458264736), (-0.7748986660975431, 0.8158695460151684),)),
    (m.Samples(load=0.90625, U=0.21875, current=0.03125, speed=-0.78125), ((-7.163949750209827,
    7.542294421257411), (-0.7729677157118113, 0.8139738096115433),)),
    (m.Samples(load=0.21875, U=0.625, current=0.25, speed=-0.90625), ((-7.1316607807095815,
    7.508222167596688), (-0.7705828175969697, 0.8113488924116817),)),
    (m.Samples(load=0.8125, U=0.3125, current=0.53125, speed=0.0), ((-7.099534257690864,
    7.4743096627604375), (-0.7677783579637518, 0.8084873803942305),)),
    (m.Samples(load=-0.78125, U=-0.5625, current=0.15625, speed=0.1875), ((-7.068344064926657,
    7.4414329100095955), (-0.7646798318419399, 0.8050768827788238),)),
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
