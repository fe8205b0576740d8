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
    (m.Samples(U=0.0625, ua=-0.15625, uc=-0.03125), ((0.3020833333333333, 0.37168106996233813),
    (-0.38636363636363635, 0.604421756042319),)),
    (m.Samples(U=0.6875, ua=-0.78125, uc=0.34375), ((0.30256615636811207, 0.3260115922410912),
    (-0.38699762872326837, 0.424487125588372),)),
    (m.Samples(U=0.4375, ua=0.8125, uc=-0.125), ((0.30284665806669875, 0.32448896437718805),
    (-0.3877414348158421, 0.416235927571352),)),
    (m.Samples(U=0.0, ua=-0.25, uc=-0.375), ((0.30262482164151416, 0.32066401440330194),
    (-0.38720810216290474, 0.4127361287878981),)),
    (m.Samples(U=-0.9375, ua=0.625, uc=-0.1875), ((0.30225711572152597, 0.3239105662452447),
    (-0.38614315614031336, 0.4131197481847133),)),
    (m.Samples(U=-0.0625, ua=-0.34375, uc=0.75), ((0.301267330105059, 0.32017025924110465),
    (-0.38503541021660614, 0.4125273106899342),)),
    (m.Samples(U=-0.75, ua=-0.5625, uc=-0.1875), ((0.30107395447383856, 0.32107388583102475),
    (-0.3851277028275772, 0.41077593233629217),)),
    (m.Samples(U=0.25, ua=0.96875, uc=-0.53125), ((0.3000347670476017, 0.32228483221387183),
    (-0.38416527507025977, 0.4159673441313276),)),
    (m.Samples(U=-0.96875, ua=-0.96875, uc=-0.28125), ((0.2987669304488516, 0.320699159494985),
    (-0.38222719591390336, 0.4110116644669497),)),
    (m.Samples(U=0.5, ua=-0.34375, uc=0.3125), ((0.29826857698638826, 0.31702869063785266),
    (-0.3815318420474124, 0.4061970935399904),)),
    (m.Samples(U=0.375, ua=-0.125, uc=0.9375), ((0.29747499951204537, 0.3160998815938776),
    (-0.38176179973798036, 0.40877331813062706),)),
    (m.Samples(U=-0.625, ua=0.4375, uc=0.375), ((0.2964274330924488, 0.3164722413000188),
    (-0.38250157561606735, 0.40876945211460425),)),
    (m.Samples(U=-0.96875, ua=0.71875, uc=-0.03125), ((0.29451198309410964, 0.3160782272339094),
    (-0.3822914871401782, 0.4086771011530156),)),
    (m.Samples(U=0.25, ua=-0.125, uc=-0.6875), ((0.292362971447159, 0.31017041665323036),
    (-0.3809899416965503, 0.4075850054992032),)),
    (m.Samples(U=-0.9375, ua=0.53125, uc=-0.25), ((0.2900483932430835, 0.3105096664218744),
    (-0.37881236000588764, 0.405155444029859),)),
    (m.Samples(U=0.6875, ua=0.0, uc=-0.21875), ((0.28710452068200515, 0.30426338141467274),
    (-0.37593165884772173, 0.39799826811817746),)),
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
