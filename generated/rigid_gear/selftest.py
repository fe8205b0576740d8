"""Does rigid_gear_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import rigid_gear_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "T", "w1", "w2",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(T=0.625, w1=(0.9375, 176.0), w2=(-0.875, 58.0)), ((-0.45147916666666665,
    1.7054752291666666), (11.4375, 11.448),)),
    (m.Derivatives(T=0.0625, w1=(0.03125, -80.0), w2=(-0.3125, -58.0)), ((0.9479895833333333,
    0.9489376354166665), (3.78125, 3.785),)),
    (m.Derivatives(T=-0.09375, w1=(0.5, 144.0), w2=(-0.5625, 12.0)), ((-0.5313125, 0.5336269375),
    (7.25, 7.25675),)),
    (m.Derivatives(T=-0.71875, w1=(-0.96875, 352.0), w2=(-0.59375, 6.0)), ((-1.4957916666666666,
    1.5004892916666666), (6.15625, 8.100875),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(T=0.0625, w1=-0.15625, w2=-0.03125), ((0.06270833333333334, 0.09764124032610601),
    (0.21875, 0.531625),)),
    (m.Samples(T=0.6875, w1=-0.78125, w2=0.34375), ((0.06207522546809136, 0.07049764977869694),
    (0.16800742574257424, 0.2989029368509833),)),
    (m.Samples(T=0.4375, w1=0.8125, w2=-0.125), ((0.0615049203258724, 0.0668817276383993),
    (0.13899985295559256, 0.15993831720009605),)),
    (m.Samples(T=0.0, w1=-0.25, w2=-0.375), ((0.06264522821048368, 0.06657486463153206),
    (0.20122262814459074, 0.22247469897019495),)),
    (m.Samples(T=-0.9375, w1=0.625, w2=-0.1875), ((0.06391044392983689, 0.070092873243712),
    (0.26778257610212364, 0.2857256775322166),)),
    (m.Samples(T=-0.0625, w1=-0.34375, w2=0.75), ((0.06213142389810746, 0.07038541013908695),
    (0.19843292112980432, 0.41315373342637046),)),
    (m.Samples(T=-0.75, w1=-0.5625, w2=-0.1875), ((0.060736618549621445, 0.06624666001930543),
    (0.11869910090941212, 0.15967067849945996),)),
    (m.Samples(T=0.25, w1=0.96875, w2=-0.53125), ((0.06181440405265067, 0.06713790700079823),
    (0.2057669404953644, 0.22622687981932793),)),
    (m.Samples(T=-0.96875, w1=-0.96875, w2=-0.28125), ((0.06316790085460701, 0.0690498289356935),
    (0.29822700107961464, 0.33921728402120055),)),
    (m.Samples(T=0.5, w1=-0.34375, w2=0.3125), ((0.0626865291206049, 0.06900361445314254),
    (0.27561359511764205, 0.3819552767457175),)),
    (m.Samples(T=0.375, w1=-0.125, w2=0.9375), ((0.05897361933689162, 0.06877108254378342),
    (0.116999959570758, 0.3804166673463404),)),
    (m.Samples(T=-0.625, w1=0.4375, w2=0.375), ((0.05501306484977495, 0.06251506092821246),
    (-0.03816340596529669, 0.0835210663255091),)),
    (m.Samples(T=-0.96875, w1=0.71875, w2=-0.03125), ((0.05302694261678401, 0.05884942294545922),
    (-0.06680125931251854, 0.09701010932731895),)),
    (m.Samples(T=0.25, w1=-0.125, w2=-0.6875), ((0.05364447383938635, 0.05776083476514686),
    (0.0257962903768383, 0.1555308265342079),)),
    (m.Samples(T=-0.9375, w1=0.53125, w2=-0.25), ((0.054767432079388, 0.060364193036440396),
    (0.140693888587198, 0.15840264087352882),)),
    (m.Samples(T=0.6875, w1=0.0, w2=-0.21875), ((0.054443353920791866, 0.05923638822380966),
    (0.19886084128844161, 0.21259418180849265),)),
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
