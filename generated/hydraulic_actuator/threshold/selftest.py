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
    (m.Samples(ps=0.0625, spool=-0.15625, p=-0.03125, v=0.6875), ((6.314538397924299e-10,
    1.360463329622781e-09), (7.504687191084529, 15.385190205674618),)),
    (m.Samples(ps=-0.78125, spool=0.34375, p=0.4375, v=0.8125), ((6.312849125744167e-10,
    1.2991521004531375e-09), (7.524174819449452, 15.444422086373205),)),
    (m.Samples(ps=-0.125, spool=0.0, p=-0.25, v=-0.375), ((6.309936696180835e-10,
    1.2954761564393775e-09), (7.555086079616665, 15.515365715071646),)),
    (m.Samples(ps=-0.9375, spool=0.625, p=-0.1875, v=-0.0625), ((6.30601981658369e-10,
    1.2945688423429008e-09), (7.581777385925507, 15.56644368295949),)),
    (m.Samples(ps=-0.34375, spool=0.75, p=-0.75, v=-0.5625), ((6.300668088245076e-10,
    1.29365935787415e-09), (7.596107513308832, 15.602968936080126),)),
    (m.Samples(ps=-0.1875, spool=0.25, p=0.96875, v=-0.53125), ((6.292838479772851e-10,
    1.291867284242498e-09), (7.593394730926548, 15.598433123082486),)),
    (m.Samples(ps=-0.96875, spool=-0.96875, p=-0.28125, v=0.5), ((6.281751883803574e-10,
    1.2898813344654845e-09), (7.579044555924597, 15.56009789413757),)),
    (m.Samples(ps=-0.34375, spool=0.3125, p=0.375, v=-0.125), ((6.267059678956746e-10,
    1.286594533477227e-09), (7.565002102609717, 15.531649462190465),)),
    (m.Samples(ps=0.9375, spool=-0.625, p=0.4375, v=0.375), ((6.250746338245113e-10,
    1.2832486649272973e-09), (7.55343880080936, 15.505998460494581),)),
    (m.Samples(ps=-0.96875, spool=0.71875, p=-0.03125, v=0.25), ((6.235338422939279e-10,
    1.2800573854448262e-09), (7.546248425030565, 15.490895596273557),)),
    (m.Samples(ps=-0.125, spool=-0.6875, p=-0.9375, v=0.53125), ((6.221699063355584e-10,
    1.2772574432635493e-09), (7.547416966806258, 15.493184814933874),)),
    (m.Samples(ps=-0.25, spool=0.6875, p=0.0, v=-0.21875), ((6.209502619302804e-10,
    1.2747227264409192e-09), (7.554132832336439, 15.510783228659978),)),
    (m.Samples(ps=0.28125, spool=-0.34375, p=-0.1875, v=0.21875), ((6.197614029393992e-10,
    1.2722680381285268e-09), (7.560057790646705, 15.52007392132813),)),
    (m.Samples(ps=0.90625, spool=0.21875, p=0.03125, v=-0.78125), ((6.184652836433451e-10,
    1.2696674736180404e-09), (7.5583456127098, 15.5286291747408),)),
    (m.Samples(ps=0.21875, spool=0.625, p=0.25, v=-0.90625), ((6.169680458324105e-10,
    1.2666492098928888e-09), (7.536034097813461, 15.487405055028892),)),
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
