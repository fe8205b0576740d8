"""Does two_tanks_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import two_tanks_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Q", "p1", "p2",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Q=0.625, p1=(0.9375, 180224.0), p2=(-0.875, 1.8125)), ((0.34151096108190415,
    0.9087733365395292), (-3.000491442698838e-07, 6.684136106218443e-06),)),
    (m.Derivatives(Q=0.0625, p1=(0.03125, -81920.0), p2=(-0.3125, -1.8125)), ((0.19135721615066045,
    0.19148783403163583), (4.113592291452182e-06, 4.749626868401997e-06),)),
    (m.Derivatives(Q=-0.09375, p1=(0.5, 147456.0), p2=(-0.5625, 0.375)), ((-0.3256954924151316,
    0.3259280569918725), (1.397066942905218e-06, 3.5738325634481787e-06),)),
    (m.Derivatives(Q=-0.71875, p1=(-0.96875, 360448.0), p2=(-0.59375, 0.1875)),
    ((-1.2857241118903846, 1.2862940896279942), (-2.5922754485387137e-07, 3.720254716742819e-06),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Q=0.0625, p1=-0.15625, p2=-0.03125), ((0.06250042426406871, 0.06294866775166912),
    (-2.474873734152916e-07, 3.4272374205330474e-06),)),
    (m.Samples(Q=0.6875, p1=-0.78125, p2=0.34375), ((0.06254146273560758, 0.06705823049439846),
    (-3.6324111266588407e-07, 5.883302707072397e-07),)),
    (m.Samples(Q=0.4375, p1=0.8125, p2=-0.125), ((0.06276846735702907, 0.06701031451300583),
    (-4.458045220058144e-07, 5.839144735078288e-07),)),
    (m.Samples(Q=0.0, p1=-0.25, p2=-0.375), ((0.06312109206136973, 0.06659306049468736),
    (-3.0295378952124563e-07, 6.241449076813431e-07),)),
    (m.Samples(Q=-0.9375, p1=0.625, p2=-0.1875), ((0.06340251979035033, 0.06874341407454675),
    (-1.4584195007768303e-07, 3.3357668076412306e-07),)),
    (m.Samples(Q=-0.0625, p1=-0.34375, p2=0.75), ((0.06339892102823479, 0.06702187974262393),
    (-3.414537273767567e-07, 4.734189953100925e-07),)),
    (m.Samples(Q=-0.75, p1=-0.5625, p2=-0.1875), ((0.06324434844782151, 0.06817421070420596),
    (-5.297365126924985e-07, 7.178536901286551e-07),)),
    (m.Samples(Q=0.25, p1=0.96875, p2=-0.53125), ((0.06288682756838034, 0.06677935116386496),
    (-3.153704116398063e-07, 7.637020889697983e-07),)),
    (m.Samples(Q=-0.96875, p1=-0.96875, p2=-0.28125), ((0.06247181915332069, 0.0677709428737108),
    (-7.984959502450734e-08, 3.49069180724374e-07),)),
    (m.Samples(Q=0.5, p1=-0.34375, p2=0.3125), ((0.0618447642850573, 0.06612702003018969),
    (-1.1381945673068361e-07, 1.8754166205492513e-07),)),
    (m.Samples(Q=0.375, p1=-0.125, p2=0.9375), ((0.06130968986763756, 0.06530277636347297),
    (-5.228447558197109e-07, 6.762465511230425e-07),)),
    (m.Samples(Q=-0.625, p1=0.4375, p2=0.375), ((0.0608611759492819, 0.06538453467903207),
    (-9.355980773270295e-07, 1.0493793983206137e-06),)),
    (m.Samples(Q=-0.96875, p1=0.71875, p2=-0.03125), ((0.060203937965049796, 0.06538388605865768),
    (-1.0331876114065277e-06, 1.1215602239070272e-06),)),
    (m.Samples(Q=0.25, p1=-0.125, p2=-0.6875), ((0.0592712869949783, 0.06293067298176294),
    (-7.984643663971738e-07, 1.3783128404981835e-06),)),
    (m.Samples(Q=-0.9375, p1=0.53125, p2=-0.25), ((0.05829279685602137, 0.06325586442124019),
    (-5.045368973117566e-07, 7.820808715063452e-07),)),
    (m.Samples(Q=0.6875, p1=0.0, p2=-0.21875), ((0.05714597300687942, 0.06158513755259882),
    (-3.65909320415119e-07, 5.7979442702234e-07),)),
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
