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
    0.0007559855716949857), (-375.2497, 1528.090923928253),)),
    (m.Samples(ps=0.625, spool=-0.1875, load=-0.0625, p=-0.34375, v=0.75), ((0.0007499117730302106,
    0.0007900858673110479), (-366.934326508839, 454.8184916260948),)),
    (m.Samples(ps=-0.75, spool=-0.5625, load=-0.1875, p=0.25, v=0.96875), ((0.0007493744697874668,
    0.0007916184840365555), (-349.3784899542949, 386.38495890274424),)),
    (m.Samples(ps=-0.53125, spool=-0.96875, load=-0.96875, p=-0.28125, v=0.5),
    ((0.000748296449071957, 0.0007897900583079225), (-333.46556504521044, 361.0789751016872),)),
    (m.Samples(ps=-0.34375, spool=0.3125, load=0.375, p=-0.125, v=0.9375), ((0.0007467630549968236,
    0.0007888178191387676), (-318.09715526570017, 349.8278641915043),)),
    (m.Samples(ps=-0.625, spool=0.4375, load=0.375, p=-0.96875, v=0.71875), ((0.0007447371904545117,
    0.0007863072488601435), (-302.0044900397377, 330.4605653140159),)),
    (m.Samples(ps=-0.03125, spool=0.25, load=-0.125, p=-0.6875, v=-0.9375), ((0.0007423484287018723,
    0.0007839870365234811), (-295.53943115598605, 316.4553200546802),)),
    (m.Samples(ps=0.53125, spool=-0.25, load=0.6875, p=0.0, v=-0.21875), ((0.0007399321658889997,
    0.0007803570137362017), (-293.89205245184525, 312.11076311193585),)),
    (m.Samples(ps=0.28125, spool=-0.34375, load=-0.1875, p=0.21875, v=0.90625),
    ((0.0007373678879057721, 0.0007787521909065471), (-283.18045697371326, 311.8487037899264),)),
    (m.Samples(ps=0.21875, spool=0.03125, load=-0.78125, p=0.21875, v=0.625),
    ((0.0007344042597656317, 0.0007751828652289885), (-268.53689202657733, 293.7636213235453),)),
    (m.Samples(ps=0.25, spool=-0.90625, load=0.8125, p=0.3125, v=0.53125), ((0.0007310630056082527,
    0.0007714672657962365), (-256.0975174360158, 279.08587981136833),)),
    (m.Samples(ps=0.0, spool=-0.78125, load=-0.5625, p=0.15625, v=0.1875), ((0.0007274125275802631,
    0.0007670398879612871), (-246.1129763388843, 263.9078924288319),)),
    (m.Samples(ps=-0.625, spool=-0.21875, load=-0.53125, p=-0.09375, v=-0.65625),
    ((0.0007235872863259474, 0.0007636453256330044), (-242.22774029192738, 258.63566230493893),)),
    (m.Samples(ps=-0.03125, spool=-0.28125, load=0.03125, p=-0.59375, v=0.375),
    ((0.0007197361419561782, 0.0007592092944006824), (-237.53493183614924, 256.71631341244984),)),
    (m.Samples(ps=0.625, spool=-0.03125, load=-0.25, p=0.28125, v=0.28125), ((0.0007156949670994558,
    0.0007547913883966662), (-228.30849138236113, 246.0627196535368),)),
    (m.Samples(ps=-0.6875, spool=-0.84375, load=-0.09375, p=-0.875, v=-0.1875),
    ((0.0007114629949852557, 0.0007501388992475105), (-222.07715438568366, 236.19115988819635),)),
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
