"""Does hydraulic_actuator_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import hydraulic_actuator_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "ps", "spool", "load", "p", "v",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(ps=0.625, spool=0.9375, load=0.34375, p=(-0.875, 3892314112.0), v=(0.0625, 0.5)),
    ((-0.0006986845726296588, 0.0006994694583665245), (37.84445, 37.8819507),)),
    (m.Derivatives(ps=-0.15625, spool=-0.3125, load=-0.90625, p=(-0.09375, 2147483648.0),
    v=(0.28125, -9.0)), ((-0.0005829115975739584, 0.0005835038935657701), (-113.406175,
    338.74382507499996),)),
    (m.Derivatives(ps=0.1875, spool=-0.71875, load=-0.96875, p=(0.6875, -2550136832.0), v=(0.09375,
    1.0)), ((0.0003500380522545527, 0.0005005514449023749), (61.5307, 63.53180054999999),)),
    (m.Derivatives(ps=-0.15625, spool=-0.03125, load=0.6875, p=(-0.78125, 1476395008.0), v=(0.4375,
    13.0)), ((-0.0005960665757473683, 0.0005966631989045325), (500.688125, 501.188125625),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(ps=-0.125, spool=0.0, load=-0.25, p=-0.375, v=-0.9375), ((0.0007500000000375001,
    0.0007507500024650375), (-375.2497, 564.0628003),)),
    (m.Samples(ps=0.625, spool=-0.1875, load=-0.0625, p=-0.34375, v=0.75), ((0.0007498667845856472,
    0.000787565316397215), (-366.88480323472106, 404.1809195060278),)),
    (m.Samples(ps=-0.75, spool=-0.5625, load=-0.1875, p=0.25, v=0.96875), ((0.0007493237023521919,
    0.0007889754656786991), (-349.3247292522804, 380.89065281011716),)),
    (m.Samples(ps=-0.53125, spool=-0.96875, load=-0.96875, p=-0.28125, v=0.5),
    ((0.0007482582869481715, 0.000787880948209593), (-333.42797350496664, 359.17915436987494),)),
    (m.Samples(ps=-0.34375, spool=0.3125, load=0.375, p=-0.125, v=0.9375), ((0.0007467133764189382,
    0.0007863121667000787), (-318.04838653028105, 346.8871122356805),)),
    (m.Samples(ps=-0.625, spool=0.4375, load=0.375, p=-0.96875, v=0.71875), ((0.0007446935422455791,
    0.0007841610917467534), (-301.9643537263703, 328.0834092770434),)),
    (m.Samples(ps=-0.03125, spool=0.25, load=-0.125, p=-0.6875, v=-0.9375), ((0.0007423491746932387,
    0.000781563621864316), (-295.5497698549328, 313.49876122192956),)),
    (m.Samples(ps=0.53125, spool=-0.25, load=0.6875, p=0.0, v=-0.21875), ((0.0007399139763953923,
    0.0007789761939064338), (-293.880933141706, 311.16142683123945),)),
    (m.Samples(ps=0.28125, spool=-0.34375, load=-0.1875, p=0.21875, v=0.90625),
    ((0.0007373199425088433, 0.0007763904065914458), (-283.136952335226, 309.0716026346997),)),
    (m.Samples(ps=0.21875, spool=0.03125, load=-0.78125, p=0.21875, v=0.625),
    ((0.0007343640925128423, 0.0007732622486948003), (-268.50368766860163, 291.67819610454114),)),
    (m.Samples(ps=0.25, spool=-0.90625, load=0.8125, p=0.3125, v=0.53125), ((0.0007310256509300841,
    0.0007697231573030346), (-256.0686081849861, 277.3169761128416),)),
    (m.Samples(ps=0.0, spool=-0.78125, load=-0.5625, p=0.15625, v=0.1875), ((0.000727384678294372,
    0.000765828025761019), (-246.09562238020746, 263.1421362770623),)),
    (m.Samples(ps=-0.625, spool=-0.21875, load=-0.53125, p=-0.09375, v=-0.65625),
    ((0.00072358228771363, 0.0007617780210870562), (-242.23607478182544, 256.602749092529),)),
    (m.Samples(ps=-0.03125, spool=-0.28125, load=0.03125, p=-0.59375, v=0.375),
    ((0.0007197039952484375, 0.0007577502586123859), (-237.51279723732185, 255.40560804286707),)),
    (m.Samples(ps=0.625, spool=-0.03125, load=-0.25, p=0.28125, v=0.28125), ((0.0007156656853251679,
    0.0007534951028927655), (-228.29026199146125, 245.06753520095634),)),
    (m.Samples(ps=-0.6875, spool=-0.84375, load=-0.09375, p=-0.875, v=-0.1875),
    ((0.0007114465913406456, 0.00074900350459146), (-222.07365908990758, 235.48632095392597),)),
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
