"""Does khepera_plausible_residuals.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import khepera_plausible_residuals as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2", "r3", "r4", "r5",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "robot__Fx__1", "robot__Fx__2", "robot__U0__1", "robot__U0__2", "robot__Uin",
    "robot__m__1__me__we", "robot__m__1__wh__ws", "robot__m__2__me__we", "robot__m__2__wh__ws",
    "robot__Us",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2", "r3", "r4", "r5",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(robot__Fx__1=(0.625, 7680.0), robot__Fx__2=(0.34375, -7168.0),
    robot__U0__1=0.90625, robot__U0__2=0.0625, robot__Uin=0.03125, robot__m__1__me__we=(-0.15625,
    -5120.0, -973078528.0), robot__m__1__me__we_integral=-0.09375, robot__m__1__wh__ws=(0.5, 288.0,
    -4718592.0), robot__m__1__wh__ws_integral=0.1875, robot__m__2__me__we=(-0.71875, -15872.0,
    738197504.0), robot__m__2__me__we_integral=-0.59375, robot__m__2__wh__ws=(0.09375, 64.0,
    -1310720.0), robot__m__2__wh__ws_integral=-0.03125, robot__Us=(0.6875, -3355443200.0,
    1548112371908608.0, 0.4375, 0.8125)), ((0.7711063171581194, 4.416457348290093), (-18.392442,
    81.5603132405), (-0.14836851422364664, 2.992461606844352), (25.11133884714793,
    37.4894484950988), (0.029499742249696318, 1.9166005468432536),)),
    (m.Derivatives(robot__Fx__1=(-0.125, 0.0), robot__Fx__2=(-0.25, -3072.0), robot__U0__1=-0.9375,
    robot__U0__2=0.625, robot__Uin=-0.1875, robot__m__1__me__we=(-0.0625, -5632.0, 805306368.0),
    robot__m__1__me__we_integral=-0.75, robot__m__1__wh__ws=(-0.5625, -192.0, 2097152.0),
    robot__m__1__wh__ws_integral=0.96875, robot__m__2__me__we=(-0.53125, -15872.0, -1040187392.0),
    robot__m__2__me__we_integral=-0.28125, robot__m__2__wh__ws=(0.5, -352.0, 2621440.0),
    robot__m__2__wh__ws_integral=0.375, robot__Us=(-0.125, 4026531840.0, -2814749767106560.0,
    0.4375, 0.375)), ((-0.9574430254558403, 2.990231578860926), (5.634431999999999,
    50.86565039799999), (4.057960244878918, 4.301047320679352), (-13.64437, 59.5371594625),
    (-0.727483862301266, 1.9079944004386724),)),
    (m.Derivatives(robot__Fx__1=(-0.96875, 5888.0), robot__Fx__2=(-0.03125, 2048.0),
    robot__U0__1=-0.125, robot__U0__2=-0.6875, robot__Uin=-0.9375, robot__m__1__me__we=(0.53125,
    -4096.0, 738197504.0), robot__m__1__me__we_integral=0.0, robot__m__1__wh__ws=(-0.21875, 288.0,
    -2883584.0), robot__m__1__wh__ws_integral=-0.1875, robot__m__2__me__we=(0.21875, 14848.0,
    234881024.0), robot__m__2__me__we_integral=0.03125, robot__m__2__wh__ws=(-0.78125, 224.0,
    5242880.0), robot__m__2__wh__ws_integral=0.25, robot__Us=(-0.90625, 3489660928.0,
    1407374883553280.0, 0.53125, 0.0)), ((0.20431424218660987, 3.706732493348982),
    (-1.341823999999999, 48.470387246), (-2.5994922970584047, 2.7959005856517596),
    (-7.8020000000000005, 86.92812275), (-1.2423290497133668, 3.0560401287630796),)),
    (m.Derivatives(robot__Fx__1=(-0.78125, -4608.0), robot__Fx__2=(0.15625, 1536.0),
    robot__U0__1=-0.625, robot__U0__2=-0.21875, robot__Uin=-0.53125, robot__m__1__me__we=(-0.09375,
    -10752.0, -33554432.0), robot__m__1__me__we_integral=-0.28125, robot__m__1__wh__ws=(0.03125,
    -608.0, 3145728.0), robot__m__1__wh__ws_integral=0.625, robot__m__2__me__we=(-0.03125, -4096.0,
    301989888.0), robot__m__2__me__we_integral=0.28125, robot__m__2__wh__ws=(-0.6875, -864.0,
    -786432.0), robot__m__2__wh__ws_integral=-0.875, robot__Us=(-0.1875, -2818572288.0,
    -562949953421312.0, -0.40625, 0.0)), ((2.660656246089744, 4.133013952113611),
    (1.3606479999999992, 30.058156472), (1.216932619237892, 2.9653323150363895), (15.490458,
    59.91511954549999), (0.5397511905477467, 1.6031346917382945),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(robot__Fx__1=0.65625, robot__Fx__2=-0.40625, robot__U0__1=0.65625,
    robot__U0__2=-0.71875, robot__Uin=0.84375, robot__m__1__me__we=0.5, robot__m__1__wh__ws=-0.625,
    robot__m__2__me__we=-0.78125, robot__m__2__wh__ws=0.3125, robot__Us=0.0625),
    ((-0.3611403276353277, 1.7499989321965814), (16.125, 16.225715999999995), (-0.08256764155982901,
    1.3932407263221156), (-8.59375, 8.654117999999999), (0.78125, 0.90625),)),
    (m.Samples(robot__Fx__1=-0.09375, robot__Fx__2=0.9375, robot__U0__1=0.3125, robot__U0__2=-0.75,
    robot__Uin=0.375, robot__m__1__me__we=0.03125, robot__m__1__wh__ws=0.28125,
    robot__m__2__me__we=0.65625, robot__m__2__wh__ws=-0.78125, robot__Us=-0.0625),
    ((-0.3611431041149918, 0.4487375887603759), (16.124958813633747, 16.937307376007997),
    (-0.08256556826976644, 0.15230652636973707), (-8.593724141151807, 9.02705599176262),
    (0.7778353025401432, 0.8227478563036092),)),
    (m.Samples(robot__Fx__1=0.28125, robot__Fx__2=-0.875, robot__U0__1=0.84375, robot__U0__2=0.3125,
    robot__Uin=-0.71875, robot__m__1__me__we=-0.90625, robot__m__1__wh__ws=0.6875,
    robot__m__2__me__we=0.5625, robot__m__2__wh__ws=-0.09375, robot__Us=0.21875),
    ((-0.3611538185541883, 0.3836654051135699), (16.12478465124341, 16.974481165811433),
    (-0.08256068449752342, 0.09020517853809229), (-8.593637459955351, 9.046516666182974),
    (0.7574374221898746, 0.8166962506376322),)),
    (m.Samples(robot__Fx__1=-0.4375, robot__Fx__2=-0.96875, robot__U0__1=-0.5, robot__U0__2=0.59375,
    robot__Uin=-0.8125, robot__m__1__me__we=0.5, robot__m__1__wh__ws=-0.15625,
    robot__m__2__me__we=0.21875, robot__m__2__wh__ws=0.65625, robot__Us=0.21875),
    ((-0.3611699785857848, 0.38041966014299283), (16.124390170959156, 16.97589375354793),
    (-0.08255621585234774, 0.08708626816064408), (-8.593438577255931, 9.047293582200457),
    (0.7229441314430713, 0.7840665128853118),)),
    (m.Samples(robot__Fx__1=0.9375, robot__Fx__2=-0.21875, robot__U0__1=0.5625,
    robot__U0__2=0.59375, robot__Uin=0.3125, robot__m__1__me__we=0.4375, robot__m__1__wh__ws=0.375,
    robot__m__2__me__we=-0.59375, robot__m__2__wh__ws=-0.3125, robot__Us=-0.625),
    ((-0.36118469036366113, 0.3802698506154439), (16.12365668319411, 16.97524195578155),
    (-0.0825457277627683, 0.08691962831254642), (-8.593035931994432, 9.046901004889213),
    (0.7077656639967194, 0.7468537803773578),)),
    (m.Samples(robot__Fx__1=0.6875, robot__Fx__2=0.1875, robot__U0__1=0.9375, robot__U0__2=-0.21875,
    robot__Uin=-0.40625, robot__m__1__me__we=0.0, robot__m__1__wh__ws=0.1875,
    robot__m__2__me__we=-0.5, robot__m__2__wh__ws=0.40625, robot__Us=0.125), ((-0.3611976883425019,
    0.38027575439709793), (16.12245314734095, 16.973969533123935), (-0.08251689720332353,
    0.08687643787518486), (-8.592388271934901, 9.04620119703026), (0.6977246376717335,
    0.7454818540067276),)),
    (m.Samples(robot__Fx__1=0.03125, robot__Fx__2=-0.125, robot__U0__1=-0.75, robot__U0__2=0.96875,
    robot__Uin=0.25, robot__m__1__me__we=0.53125, robot__m__1__wh__ws=-0.09375,
    robot__m__2__me__we=0.0, robot__m__2__wh__ws=0.5, robot__Us=-0.78125), ((-0.3612094961164483,
    0.3802869343128297), (16.120687452141816, 16.97208514351109), (-0.08246823839316712,
    0.08682566441007708), (-8.591468866150258, 9.045242600130761), (0.6889106614637414,
    0.7258098229263085),)),
    (m.Samples(robot__Fx__1=-0.84375, robot__Fx__2=0.9375, robot__U0__1=0.3125, robot__U0__2=-0.5,
    robot__Uin=-0.3125, robot__m__1__me__we=-0.125, robot__m__1__wh__ws=-0.09375,
    robot__m__2__me__we=0.90625, robot__m__2__wh__ws=-0.375, robot__Us=0.28125),
    ((-0.36121646768186727, 0.3802973712605546), (16.118279113783803, 16.969538996737565),
    (-0.0823997759755655, 0.08675481829767065), (-8.590208898900165, 9.04397418260283),
    (0.6795472283721788, 0.7275700430396085),)),
    (m.Samples(robot__Fx__1=0.28125, robot__Fx__2=0.5, robot__U0__1=0.75, robot__U0__2=0.5,
    robot__Uin=-0.3125, robot__m__1__me__we=-0.1875, robot__m__1__wh__ws=0.34375,
    robot__m__2__me__we=-0.875, robot__m__2__wh__ws=0.875, robot__Us=-0.5625),
    ((-0.36121393194868345, 0.38029286370360277), (16.115140283880702, 16.966259379887767),
    (-0.08231419720047252, 0.08666257970590956), (-8.588590765418921, 9.042261263599983),
    (0.6627157841043175, 0.704980278637291),)),
    (m.Samples(robot__Fx__1=-0.125, robot__Fx__2=-0.75, robot__U0__1=0.96875, robot__U0__2=-0.25,
    robot__Uin=-0.21875, robot__m__1__me__we=-0.5625, robot__m__1__wh__ws=-0.65625,
    robot__m__2__me__we=0.1875, robot__m__2__wh__ws=0.59375, robot__Us=-0.59375),
    ((-0.36119280096024386, 0.38027651074848534), (16.111201338820745, 16.962105011437245),
    (-0.08222180613668142, 0.08656626954084341), (-8.5865856875863, 9.040219317503666),
    (0.65578517219903, 0.6952452509531485),)),
    (m.Samples(robot__Fx__1=0.4375, robot__Fx__2=-0.625, robot__U0__1=-0.8125, robot__U0__2=0.3125,
    robot__Uin=-0.75, robot__m__1__me__we=0.84375, robot__m__1__wh__ws=-0.1875,
    robot__m__2__me__we=-0.75, robot__m__2__wh__ws=0.71875, robot__Us=-0.53125),
    ((-0.361142782586777, 0.3802184544985649), (16.106388042174594, 16.957012526030642),
    (-0.08212422895688874, 0.08646434754829034), (-8.584158522222598, 9.037693845151756),
    (0.6443271394794, 0.6938317395610306),)),
    (m.Samples(robot__Fx__1=-0.3125, robot__Fx__2=0.78125, robot__U0__1=0.71875,
    robot__U0__2=-0.03125, robot__Uin=0.625, robot__m__1__me__we=-0.375,
    robot__m__1__wh__ws=-0.8125, robot__m__2__me__we=-0.875, robot__m__2__wh__ws=0.1875,
    robot__Us=-0.9375), ((-0.36105972672395303, 0.380137309806693), (16.10063565647914,
    16.95095049071888), (-0.08201411955741551, 0.08634588851794164), (-8.581336148009347,
    9.034720996296114), (0.6449314084619913, 0.6797473747528252),)),
    (m.Samples(robot__Fx__1=0.9375, robot__Fx__2=0.3125, robot__U0__1=-0.9375,
    robot__U0__2=-0.40625, robot__Uin=0.53125, robot__m__1__me__we=-0.5625,
    robot__m__1__wh__ws=0.15625, robot__m__2__me__we=0.1875, robot__m__2__wh__ws=0.375,
    robot__Us=-0.15625), ((-0.36094540053665763, 0.38000901815003174), (16.093875308486272,
    16.943874411147245), (-0.08188902041756144, 0.08621296148742626), (-8.578162777772338,
    9.031377371969382), (0.6544085267359514, 0.6886917343161305),)),
    (m.Samples(robot__Fx__1=-0.875, robot__Fx__2=-0.96875, robot__U0__1=-0.625,
    robot__U0__2=-0.21875, robot__Uin=0.53125, robot__m__1__me__we=-0.28125,
    robot__m__1__wh__ws=0.9375, robot__m__2__me__we=0.125, robot__m__2__wh__ws=0.78125,
    robot__Us=-0.28125), ((-0.36081136364772415, 0.37986849965667174), (16.0860274327715,
    16.935640895482823), (-0.08175463890242647, 0.08607443574955083), (-8.57467382304446,
    9.027712132344401), (0.6563054899760342, 0.6905091235485452),)),
    (m.Samples(robot__Fx__1=0.5625, robot__Fx__2=-0.0625, robot__U0__1=-0.59375, robot__U0__2=0.875,
    robot__Uin=0.28125, robot__m__1__me__we=0.4375, robot__m__1__wh__ws=0.3125,
    robot__m__2__me__we=-0.03125, robot__m__2__wh__ws=0.84375, robot__Us=-0.75),
    ((-0.3606686521390126, 0.37971593891874594), (16.077066086385937, 16.92615774794555),
    (-0.08161441674276786, 0.08592652445694991), (-8.570911460363215, 9.02373689711225),
    (0.6615713377893462, 0.6959405690644287),)),
    (m.Samples(robot__Fx__1=-0.40625, robot__Fx__2=0.1875, robot__U0__1=0.15625, robot__U0__2=0.5,
    robot__Uin=-0.34375, robot__m__1__me__we=-0.28125, robot__m__1__wh__ws=-0.9375,
    robot__m__2__me__we=0.09375, robot__m__2__wh__ws=0.03125, robot__Us=0.125),
    ((-0.36051209150766106, 0.3795600709721007), (16.06696895566647, 16.915508373364112),
    (-0.08146120564690994, 0.08576462037455851), (-8.56693718212842, 9.019548621700048),
    (0.6539909677446534, 0.6980637243841163),)),
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
