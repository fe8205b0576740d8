"""Does khepera_plausible_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import khepera_plausible_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2", "r3", "r4", "r5",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "robot__Fx__1", "robot__Fx__2", "robot__m__1__me__we", "robot__m__1__wh__ws",
    "robot__m__2__me__we", "robot__m__2__wh__ws",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2", "r3", "r4",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(robot__Fx__1=0.625, robot__Fx__2=0.9375, robot__m__1__me__we=0.34375,
    robot__m__1__wh__ws=-0.875, robot__m__2__me__we=0.90625, robot__m__2__wh__ws=0.0625),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(robot__Fx__1=0.03125, robot__Fx__2=-0.15625, robot__m__1__me__we=-0.3125,
    robot__m__1__wh__ws=-0.90625, robot__m__2__me__we=-0.09375, robot__m__2__wh__ws=0.5),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(robot__Fx__1=0.28125, robot__Fx__2=-0.5625, robot__m__1__me__we=0.1875,
    robot__m__1__wh__ws=-0.71875, robot__m__2__me__we=-0.96875, robot__m__2__wh__ws=0.6875),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(robot__Fx__1=-0.59375, robot__Fx__2=0.09375, robot__m__1__me__we=0.0625,
    robot__m__1__wh__ws=-0.15625, robot__m__2__me__we=-0.03125, robot__m__2__wh__ws=0.6875),
    ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(robot__Fx__1=-0.78125, robot__Fx__2=0.34375, robot__m__1__me__we=0.4375,
    robot__m__1__wh__ws=0.8125, robot__m__2__me__we=-0.125, robot__m__2__wh__ws=0.0),
    ((0.09203405910266167, 0.19129232299556143), (0.0, 0.00039039), (0.03967862240272412,
    0.07942220679006504), (0.0, 0.0), (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.25, robot__Fx__2=-0.375, robot__m__1__me__we=-0.9375,
    robot__m__1__wh__ws=0.625, robot__m__2__me__we=-0.1875, robot__m__2__wh__ws=-0.0625),
    ((0.09203406491264171, 0.18903743807679305), (4.396386407609477e-09, 1.957711703652389e-05),
    (0.03967852205764097, 0.08134679795675388), (1.4654621358698256e-09, 2.964875460566481e-09),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.34375, robot__Fx__2=0.75, robot__m__1__me__we=-0.75,
    robot__m__1__wh__ws=-0.5625, robot__m__2__me__we=-0.1875, robot__m__2__wh__ws=0.25),
    ((0.09203430955617582, 0.18893458316609066), (4.9506126417551635e-08, 1.087431416490342e-06),
    (0.03967818322611274, 0.08144654738934291), (1.065287340074792e-10, 1.2248357087145479e-08),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.96875, robot__Fx__2=-0.53125, robot__m__1__me__we=-0.96875,
    robot__m__1__wh__ws=-0.96875, robot__m__2__me__we=-0.28125, robot__m__2__wh__ws=0.5),
    ((0.09203508206541398, 0.18893116705829188), (2.0208672105199538e-07, 4.647566045203006e-07),
    (0.03967765457101378, 0.08145059710664676), (2.351030486773748e-08, 4.94286723404317e-08), (0.0,
    0.0),)),
    (m.Samples(robot__Fx__1=-0.34375, robot__Fx__2=0.3125, robot__m__1__me__we=0.375,
    robot__m__1__wh__ws=-0.125, robot__m__2__me__we=0.9375, robot__m__2__wh__ws=-0.625),
    ((0.09203578385163397, 0.1889321955875835), (4.823165583952993e-07, 9.942794966319032e-07),
    (0.03967664125909861, 0.08144905712005414), (5.994487636853672e-08, 1.5457871244333338e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.4375, robot__Fx__2=0.375, robot__m__1__me__we=-0.96875,
    robot__m__1__wh__ws=0.71875, robot__m__2__me__we=-0.03125, robot__m__2__wh__ws=0.25),
    ((0.09203486605299475, 0.18893075028790132), (8.327439329506181e-07, 1.7468807498748208e-06),
    (0.03967461877500277, 0.08144457436914382), (8.250321461894344e-08, 1.760787534357596e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.125, robot__Fx__2=-0.6875, robot__m__1__me__we=-0.9375,
    robot__m__1__wh__ws=0.53125, robot__m__2__me__we=-0.25, robot__m__2__wh__ws=0.6875),
    ((0.09203094887880256, 0.18892258686454086), (1.1944377411737978e-06, 2.487677205360589e-06),
    (0.039671730528884085, 0.08143872220021241), (1.1695617293310479e-07, 2.407060889434102e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.0, robot__Fx__2=-0.21875, robot__m__1__me__we=0.28125,
    robot__m__1__wh__ws=-0.34375, robot__m__2__me__we=-0.1875, robot__m__2__wh__ws=0.21875),
    ((0.09202355955375309, 0.1889070420409369), (1.5760418796841547e-06, 3.243729389446067e-06),
    (0.03966798977537438, 0.08143097795564239), (1.922040793677929e-07, 3.9588211314367136e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.90625, robot__Fx__2=0.21875, robot__m__1__me__we=0.03125,
    robot__m__1__wh__ws=-0.78125, robot__m__2__me__we=0.21875, robot__m__2__wh__ws=0.625),
    ((0.09201272937086719, 0.18888492366805384), (2.031298367504114e-06, 4.172657899146194e-06),
    (0.039662920195212115, 0.08142047173824199), (3.035943817554051e-07, 6.24744748949781e-07),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.25, robot__Fx__2=-0.90625, robot__m__1__me__we=0.8125,
    robot__m__1__wh__ws=0.3125, robot__m__2__me__we=0.53125, robot__m__2__wh__ws=0.0),
    ((0.09199779003439466, 0.18885434149054217), (2.570353110727075e-06, 5.295087319026169e-06),
    (0.03965608526993541, 0.08140663199139593), (4.42315067055039e-07, 9.108261415397833e-07), (0.0,
    0.0),)),
    (m.Samples(robot__Fx__1=-0.78125, robot__Fx__2=-0.5625, robot__m__1__me__we=0.15625,
    robot__m__1__wh__ws=0.1875, robot__m__2__me__we=-0.625, robot__m__2__wh__ws=-0.21875),
    ((0.09197752053070785, 0.18881254889787363), (3.149783334216399e-06, 6.4819250807497886e-06),
    (0.039646683694677845, 0.08138744873148711), (5.817658083706094e-07, 1.207901834815387e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.53125, robot__Fx__2=-0.09375, robot__m__1__me__we=-0.65625,
    robot__m__1__wh__ws=-0.03125, robot__m__2__me__we=-0.28125, robot__m__2__wh__ws=0.03125),
    ((0.09195152889386402, 0.1887590028872509), (3.75218682520998e-06, 7.708510428592569e-06),
    (0.03963384872404584, 0.08136084411730998), (7.029489566674578e-07, 1.4479070540030621e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.59375, robot__Fx__2=0.375, robot__m__1__me__we=0.625,
    robot__m__1__wh__ws=-0.03125, robot__m__2__me__we=-0.25, robot__m__2__wh__ws=0.28125),
    ((0.09192011331755882, 0.1886944627154791), (4.3885795324237745e-06, 9.013034538027122e-06),
    (0.03961735558527797, 0.0813268693390864), (8.192286772626765e-07, 1.6842480144568754e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.28125, robot__Fx__2=-0.6875, robot__m__1__me__we=-0.84375,
    robot__m__1__wh__ws=-0.09375, robot__m__2__me__we=-0.875, robot__m__2__wh__ws=-0.1875),
    ((0.09188341927491205, 0.18861916103082563), (5.0627359581042656e-06, 1.0396918514959275e-05),
    (0.03959716324749305, 0.08128567488858478), (9.371882342534018e-07, 1.935808760022997e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=-0.65625, robot__Fx__2=-0.125, robot__m__1__me__we=-0.40625,
    robot__m__1__wh__ws=0.0, robot__m__2__me__we=0.65625, robot__m__2__wh__ws=-0.40625),
    ((0.09184133904923765, 0.188532694740318), (5.7723483373925025e-06, 1.1853897540356544e-05),
    (0.03957281761418658, 0.08123573354844087), (1.0354048221785323e-06, 2.149794450575627e-06),
    (0.0, 0.0),)),
    (m.Samples(robot__Fx__1=0.65625, robot__Fx__2=-0.71875, robot__m__1__me__we=0.84375,
    robot__m__1__wh__ws=0.5, robot__m__2__me__we=-0.625, robot__m__2__wh__ws=-0.78125),
    ((0.09179345628783651, 0.1884348195682343), (6.499838558255606e-06, 1.3371814504578151e-05),
    (0.03954359735280908, 0.0811760945990076), (1.08507789826952e-06, 2.2718094512587115e-06), (0.0,
    0.0),)),
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
