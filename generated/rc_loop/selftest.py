"""Does rc_loop_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import rc_loop_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "U", "ua", "uc",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(U=0.625, ua=(0.9375, 176.0), uc=(-0.875, 928.0)), ((-2.5201933333333333,
    3.7733385266666666), (3.9395207272727273, 8.047464152),)),
    (m.Derivatives(U=0.0625, ua=(0.03125, -80.0), uc=(-0.3125, -928.0)), ((0.4942433333333333,
    1.0160292433333333), (2.936452, 3.291740452),)),
    (m.Derivatives(U=-0.09375, ua=(0.5, 144.0), uc=(-0.5625, 192.0)), ((-1.8531233333333332,
    1.8548827066666667), (3.176762909090909, 4.029043928),)),
    (m.Derivatives(U=-0.71875, ua=(-0.96875, 352.0), uc=(-0.59375, 96.0)), ((-0.6715199999999999,
    3.903868603333333), (-0.5967549090909091, 5.821825464),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(U=0.0625, ua=-0.15625, uc=-0.03125), ((0.3020833333333333, 0.3446393375),
    (-0.38636363636363635, 0.58014151125),)),
    (m.Samples(U=0.6875, ua=-0.78125, uc=0.34375), ((0.3026311967789958, 0.31994289726459774),
    (-0.3871020435028216, 0.4161378867562562),)),
    (m.Samples(U=0.4375, ua=0.8125, uc=-0.125), ((0.3028011422252394, 0.32020742007817343),
    (-0.387630264288641, 0.40996094110740494),)),
    (m.Samples(U=0.0, ua=-0.25, uc=-0.375), ((0.3026205771141604, 0.31881673339278993),
    (-0.38718190229294563, 0.4084242836114207),)),
    (m.Samples(U=-0.9375, ua=0.625, uc=-0.1875), ((0.3021753063770729, 0.31939133741858833),
    (-0.3860452444502679, 0.4077655749407503),)),
    (m.Samples(U=-0.0625, ua=-0.34375, uc=0.75), ((0.30129121850105667, 0.3175153103029108),
    (-0.38513679693200564, 0.4056191935568011),)),
    (m.Samples(U=-0.75, ua=-0.5625, uc=-0.1875), ((0.30106701482088355, 0.31714801824211264),
    (-0.3851539526621025, 0.4057695618814828),)),
    (m.Samples(U=0.25, ua=0.96875, uc=-0.53125), ((0.29996541204117994, 0.3174935026679848),
    (-0.38399571790969533, 0.4065937261610661),)),
    (m.Samples(U=-0.96875, ua=-0.96875, uc=-0.28125), ((0.2987743214362941, 0.3149586579319143),
    (-0.38228641670243146, 0.40320038738328084),)),
    (m.Samples(U=0.5, ua=-0.34375, uc=0.3125), ((0.2983019009654006, 0.31415756109748916),
    (-0.38158784821677116, 0.4017979795276358),)),
    (m.Samples(U=0.375, ua=-0.125, uc=0.9375), ((0.29750530497606387, 0.3133928694960519),
    (-0.381860207962349, 0.40198947624661263),)),
    (m.Samples(U=-0.625, ua=0.4375, uc=0.375), ((0.29637975194970645, 0.3129579505970395),
    (-0.3824823390721274, 0.4033331193133963),)),
    (m.Samples(U=-0.96875, ua=0.71875, uc=-0.03125), ((0.2944279352105347, 0.31146972677023976),
    (-0.382200443063478, 0.40362318196129376),)),
    (m.Samples(U=0.25, ua=-0.125, uc=-0.6875), ((0.29235406054282137, 0.30806775866357344),
    (-0.3809186325553053, 0.4022500114182871),)),
    (m.Samples(U=-0.9375, ua=0.53125, uc=-0.25), ((0.2899718589198088, 0.30639888861903364),
    (-0.3787184287352946, 0.4000660277048675),)),
    (m.Samples(U=0.6875, ua=0.0, uc=-0.21875), ((0.2871137713835992, 0.302446799903536),
    (-0.375896797496176, 0.39625695544152),)),
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
