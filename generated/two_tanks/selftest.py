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
    (m.Samples(Q=0.0625, p1=-0.15625, p2=-0.03125), ((0.06250042426406871, 0.06251058411475348),
    (-2.474873734152916e-07, 2.976816836806236e-06),)),
    (m.Samples(Q=0.6875, p1=-0.78125, p2=0.34375), ((0.0625622912917835, 0.06569149506976057),
    (-3.6367265245346217e-07, 5.146259100092431e-07),)),
    (m.Samples(Q=0.4375, p1=0.8125, p2=-0.125), ((0.06278093890861317, 0.06608685230296885),
    (-4.456211739338134e-07, 5.575405884244164e-07),)),
    (m.Samples(Q=0.0, p1=-0.25, p2=-0.375), ((0.06311894772632086, 0.06645372552020884),
    (-3.025433790797531e-07, 5.6849631745023e-07),)),
    (m.Samples(Q=-0.9375, p1=0.625, p2=-0.1875), ((0.06336909943469315, 0.0669082498281461),
    (-1.456331154296561e-07, 2.996673570671114e-07),)),
    (m.Samples(Q=-0.0625, p1=-0.34375, p2=0.75), ((0.06339466798694787, 0.06679643880406613),
    (-3.423229861668834e-07, 3.6733438105369967e-07),)),
    (m.Samples(Q=-0.75, p1=-0.5625, p2=-0.1875), ((0.06321719693839686, 0.06671411424944691),
    (-5.295370924686236e-07, 6.810125862374894e-07),)),
    (m.Samples(Q=0.25, p1=0.96875, p2=-0.53125), ((0.06289304190471522, 0.06624506864974498),
    (-3.1475586447541304e-07, 6.857629739918107e-07),)),
    (m.Samples(Q=-0.96875, p1=-0.96875, p2=-0.28125), ((0.062437454942542644, 0.06593236561295512),
    (-7.961726797371345e-08, 3.0082162727259886e-07),)),
    (m.Samples(Q=0.5, p1=-0.34375, p2=0.3125), ((0.061859416622427825, 0.06516249289699842),
    (-1.1424058171214302e-07, 1.3807939247715266e-07),)),
    (m.Samples(Q=0.375, p1=-0.125, p2=0.9375), ((0.06132022780939892, 0.06455724883828422),
    (-5.23889183427422e-07, 5.448258302559567e-07),)),
    (m.Samples(Q=-0.625, p1=0.4375, p2=0.375), ((0.06083842506182294, 0.06417590194298374),
    (-9.359348631849828e-07, 9.849791841723024e-07),)),
    (m.Samples(Q=-0.96875, p1=0.71875, p2=-0.03125), ((0.06016979227614799, 0.06356816112375101),
    (-1.0330349159737531e-06, 1.1092655535237376e-06),)),
    (m.Samples(Q=0.25, p1=-0.125, p2=-0.6875), ((0.05927785412677903, 0.06244667749591827),
    (-7.976381096646786e-07, 1.2837599561813372e-06),)),
    (m.Samples(Q=-0.9375, p1=0.53125, p2=-0.25), ((0.05825987563185047, 0.061525816363731306),
    (-5.04214354127763e-07, 7.377063825279759e-07),)),
    (m.Samples(Q=0.6875, p1=0.0, p2=-0.21875), ((0.057167323978157464, 0.06031634545887683),
    (-3.6565573690780634e-07, 5.446943608906549e-07),)),
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
