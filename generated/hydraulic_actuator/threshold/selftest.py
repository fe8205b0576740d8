"""Does hydraulic_actuator_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import hydraulic_actuator_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "ps", "spool", "p", "v",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(ps=0.625, spool=0.9375, p=0.34375, v=-0.875), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(ps=0.90625, spool=0.0625, p=0.03125, v=-0.15625), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(ps=-0.3125, spool=-0.90625, p=-0.09375, v=0.5), ((math.nan, 0.0), (math.nan,
    0.0),)),
    (m.Derivatives(ps=0.28125, spool=-0.5625, p=0.1875, v=-0.71875), ((math.nan, 0.0), (math.nan,
    0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(ps=-0.96875, spool=0.6875, p=-0.59375, v=0.09375), ((6.31509074311288e-10,
    2.5806093431359925e-09), (7.5, 15.007499999448441),)),
    (m.Samples(ps=0.0625, spool=-0.15625, p=-0.03125, v=0.6875), ((6.314542025654295e-10,
    1.3616817230855954e-09), (7.504656406234683, 15.398967424454153),)),
    (m.Samples(ps=-0.78125, spool=0.34375, p=0.4375, v=0.8125), ((6.312856557229232e-10,
    1.3002196139766956e-09), (7.524077915094715, 15.46022954429008),)),
    (m.Samples(ps=-0.125, spool=0.0, p=-0.25, v=-0.375), ((6.309948177014241e-10,
    1.296504300951991e-09), (7.554982130041955, 15.531838807458277),)),
    (m.Samples(ps=-0.9375, spool=0.625, p=-0.1875, v=-0.0625), ((6.306033512455488e-10,
    1.2956193385426667e-09), (7.581712086142115, 15.581086493461353),)),
    (m.Samples(ps=-0.34375, spool=0.75, p=-0.75, v=-0.5625), ((6.300688518703877e-10,
    1.29472844529866e-09), (7.59608846604537, 15.618319585443185),)),
    (m.Samples(ps=-0.1875, spool=0.25, p=0.96875, v=-0.53125), ((6.292867844055615e-10,
    1.2928689078775586e-09), (7.593443484726638, 15.612415024851291),)),
    (m.Samples(ps=-0.96875, spool=-0.96875, p=-0.28125, v=0.5), ((6.281792812602503e-10,
    1.2909238667844493e-09), (7.579102024492955, 15.572500465423786),)),
    (m.Samples(ps=-0.34375, spool=0.3125, p=0.375, v=-0.125), ((6.267111453415033e-10,
    1.2875418975580992e-09), (7.565046827958469, 15.54390540624209),)),
    (m.Samples(ps=0.9375, spool=-0.625, p=0.4375, v=0.375), ((6.250796194696901e-10,
    1.2842108515696132e-09), (7.553477847608862, 15.518330838091858),)),
    (m.Samples(ps=-0.96875, spool=0.71875, p=-0.03125, v=0.25), ((6.235382229259382e-10,
    1.281025792348003e-09), (7.546262722837082, 15.503576179878063),)),
    (m.Samples(ps=-0.125, spool=-0.6875, p=-0.9375, v=0.53125), ((6.221735399010991e-10,
    1.2782373102181463e-09), (7.547399818339527, 15.506896577808249),)),
    (m.Samples(ps=-0.25, spool=0.6875, p=0.0, v=-0.21875), ((6.20953529601412e-10,
    1.2756896771032631e-09), (7.554110442175043, 15.52481334876512),)),
    (m.Samples(ps=0.28125, spool=-0.34375, p=-0.1875, v=0.21875), ((6.197646947251456e-10,
    1.2732236577836267e-09), (7.560046564363377, 15.533388311210873),)),
    (m.Samples(ps=0.90625, spool=0.21875, p=0.03125, v=-0.78125), ((6.184691267784335e-10,
    1.270614533228035e-09), (7.558374154532028, 15.543587009920142),)),
    (m.Samples(ps=0.21875, spool=0.625, p=0.25, v=-0.90625), ((6.169725233903956e-10,
    1.2676008392375443e-09), (7.53615821635193, 15.501022770917949),)),
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
