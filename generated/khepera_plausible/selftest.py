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
    ((-0.3611403276353277, 1.8407736427860195), (16.125, 16.682410865898085), (-0.08256764155982901,
    1.4478560484958691), (-8.59375, 8.892215637446698), (0.78125, 0.90625),)),
    (m.Samples(robot__Fx__1=-0.09375, robot__Fx__2=0.9375, robot__U0__1=0.3125, robot__U0__2=-0.75,
    robot__Uin=0.375, robot__m__1__me__we=0.03125, robot__m__1__wh__ws=0.28125,
    robot__m__2__me__we=0.65625, robot__m__2__wh__ws=-0.78125, robot__Us=-0.0625),
    ((-0.36114246899234814, 0.45413853846118496), (16.124971874816822, 16.98838485834965),
    (-0.0825655290837505, 0.15555202692142223), (-8.593731941125885, 9.055822372941268),
    (0.7778465346534653, 0.8234751469678937),)),
    (m.Samples(robot__Fx__1=0.28125, robot__Fx__2=-0.875, robot__U0__1=0.84375, robot__U0__2=0.3125,
    robot__Uin=-0.71875, robot__m__1__me__we=-0.90625, robot__m__1__wh__ws=0.6875,
    robot__m__2__me__we=0.5625, robot__m__2__wh__ws=-0.09375, robot__Us=0.21875),
    ((-0.361153690884103, 0.38464978095470415), (16.12480892699958, 17.00527928625625),
    (-0.08255957188899128, 0.09059005729994868), (-8.593648765554226, 9.063753197423429),
    (0.7574931379276542, 0.8181436098729654),)),
    (m.Samples(robot__Fx__1=-0.4375, robot__Fx__2=-0.96875, robot__U0__1=-0.5, robot__U0__2=0.59375,
    robot__Uin=-0.8125, robot__m__1__me__we=0.5, robot__m__1__wh__ws=-0.15625,
    robot__m__2__me__we=0.21875, robot__m__2__wh__ws=0.65625, robot__Us=0.21875),
    ((-0.36117175138418045, 0.3811183471856018), (16.124417680739537, 17.00532701244995),
    (-0.08255678670702461, 0.08739848804739409), (-8.593448504952827, 9.065148071397958),
    (0.7230006995528491, 0.7856702551715358),)),
    (m.Samples(robot__Fx__1=0.9375, robot__Fx__2=-0.21875, robot__U0__1=0.5625,
    robot__U0__2=0.59375, robot__Uin=0.3125, robot__m__1__me__we=0.4375, robot__m__1__wh__ws=0.375,
    robot__m__2__me__we=-0.59375, robot__m__2__wh__ws=-0.3125, robot__Us=-0.625),
    ((-0.36118565855088125, 0.381013522037119), (16.12370025406294, 17.004812284654086),
    (-0.0825497105388707, 0.08714417352029191), (-8.593051672868881, 9.062868939612885),
    (0.707755636195367, 0.7483233676004847),)),
    (m.Samples(robot__Fx__1=0.6875, robot__Fx__2=0.1875, robot__U0__1=0.9375, robot__U0__2=-0.21875,
    robot__Uin=-0.40625, robot__m__1__me__we=0.0, robot__m__1__wh__ws=0.1875,
    robot__m__2__me__we=-0.5, robot__m__2__wh__ws=0.40625, robot__Us=0.125), ((-0.36119861368898315,
    0.3810002353692067), (16.122505755181624, 17.003488152839097), (-0.08252018879596104,
    0.08708517216578367), (-8.59239909743032, 9.062748745124454), (0.6977629503301122,
    0.7463576702886094),)),
    (m.Samples(robot__Fx__1=0.03125, robot__Fx__2=-0.125, robot__U0__1=-0.75, robot__U0__2=0.96875,
    robot__Uin=0.25, robot__m__1__me__we=0.53125, robot__m__1__wh__ws=-0.09375,
    robot__m__2__me__we=0.0, robot__m__2__wh__ws=0.5, robot__Us=-0.78125), ((-0.36121058043932036,
    0.3809516981355561), (16.120745367392225, 17.00135991173699), (-0.0824717827966769,
    0.08706486112984532), (-8.591481236400465, 9.061618975761824), (0.6888963572542683,
    0.7273884099859371),)),
    (m.Samples(robot__Fx__1=-0.84375, robot__Fx__2=0.9375, robot__U0__1=0.3125, robot__U0__2=-0.5,
    robot__Uin=-0.3125, robot__m__1__me__we=-0.125, robot__m__1__wh__ws=-0.09375,
    robot__m__2__me__we=0.90625, robot__m__2__wh__ws=-0.375, robot__Us=0.28125),
    ((-0.36121861027727936, 0.3809913106337152), (16.11834249150332, 16.998697595672954),
    (-0.08240385327183888, 0.0870220351377276), (-8.590224888383181, 9.060848709738922),
    (0.6795865283977481, 0.7285373060689467),)),
    (m.Samples(robot__Fx__1=0.28125, robot__Fx__2=0.5, robot__U0__1=0.75, robot__U0__2=0.5,
    robot__Uin=-0.3125, robot__m__1__me__we=-0.1875, robot__m__1__wh__ws=0.34375,
    robot__m__2__me__we=-0.875, robot__m__2__wh__ws=0.875, robot__Us=-0.5625),
    ((-0.3612171636253369, 0.38099660593536727), (16.11521626659437, 16.995838321272046),
    (-0.082315156502107, 0.08695114105762193), (-8.588600674284638, 9.059850833419574),
    (0.6627259040730402, 0.7063337061212253),)),
    (m.Samples(robot__Fx__1=-0.125, robot__Fx__2=-0.75, robot__U0__1=0.96875, robot__U0__2=-0.25,
    robot__Uin=-0.21875, robot__m__1__me__we=-0.5625, robot__m__1__wh__ws=-0.65625,
    robot__m__2__me__we=0.1875, robot__m__2__wh__ws=0.59375, robot__Us=-0.59375),
    ((-0.36119872475826154, 0.3810098351734315), (16.111278681944203, 16.99276048506141),
    (-0.08222354110239151, 0.08682797702338742), (-8.586599542817801, 9.05822490642492),
    (0.6557907376557524, 0.6965187654515467),)),
    (m.Samples(robot__Fx__1=0.4375, robot__Fx__2=-0.625, robot__U0__1=-0.8125, robot__U0__2=0.3125,
    robot__Uin=-0.75, robot__m__1__me__we=0.84375, robot__m__1__wh__ws=-0.1875,
    robot__m__2__me__we=-0.75, robot__m__2__wh__ws=0.71875, robot__Us=-0.53125),
    ((-0.36114810895944094, 0.38091805671930573), (16.10647317637868, 16.98580669082024),
    (-0.08212731706482566, 0.08673513850219121), (-8.584171330323093, 9.055953752994162),
    (0.6443518121576186, 0.6957805276443575),)),
    (m.Samples(robot__Fx__1=-0.3125, robot__Fx__2=0.78125, robot__U0__1=0.71875,
    robot__U0__2=-0.03125, robot__Uin=0.625, robot__m__1__me__we=-0.375,
    robot__m__1__wh__ws=-0.8125, robot__m__2__me__we=-0.875, robot__m__2__wh__ws=0.1875,
    robot__Us=-0.9375), ((-0.36106609523298233, 0.38088395134950015), (16.100719994635423,
    16.980504318899868), (-0.08201787498541485, 0.08656127180153166), (-8.581347732655479,
    9.051791555835784), (0.6448968257782598, 0.6821238710593643),)),
    (m.Samples(robot__Fx__1=0.9375, robot__Fx__2=0.3125, robot__U0__1=-0.9375,
    robot__U0__2=-0.40625, robot__Uin=0.53125, robot__m__1__me__we=-0.5625,
    robot__m__1__wh__ws=0.15625, robot__m__2__me__we=0.1875, robot__m__2__wh__ws=0.375,
    robot__Us=-0.15625), ((-0.3609499696900885, 0.3807381908489403), (16.093971201355306,
    16.972472939942953), (-0.08189100506351321, 0.08642499957544404), (-8.578180996100858,
    9.048565272059232), (0.6544038193272051, 0.6898165516338091),)),
    (m.Samples(robot__Fx__1=-0.875, robot__Fx__2=-0.96875, robot__U0__1=-0.625,
    robot__U0__2=-0.21875, robot__Uin=0.53125, robot__m__1__me__we=-0.28125,
    robot__m__1__wh__ws=0.9375, robot__m__2__me__we=0.125, robot__m__2__wh__ws=0.78125,
    robot__Us=-0.28125), ((-0.36081409337235093, 0.38065977245594373), (16.086126149758048,
    16.96543490185349), (-0.08175637267485765, 0.08636128192995364), (-8.574691391312255,
    9.045698277828714), (0.6562968130038942, 0.6917752267030772),)),
    (m.Samples(robot__Fx__1=0.5625, robot__Fx__2=-0.0625, robot__U0__1=-0.59375, robot__U0__2=0.875,
    robot__Uin=0.28125, robot__m__1__me__we=0.4375, robot__m__1__wh__ws=0.3125,
    robot__m__2__me__we=-0.03125, robot__m__2__wh__ws=0.84375, robot__Us=-0.75),
    ((-0.3606719818521175, 0.3804217751138057), (16.077167701092442, 16.95532360015145),
    (-0.08161754002897048, 0.08619018865737992), (-8.570916056866613, 9.041651792300902),
    (0.6615557870038171, 0.6975275425678213),)),
    (m.Samples(robot__Fx__1=-0.40625, robot__Fx__2=0.1875, robot__U0__1=0.15625, robot__U0__2=0.5,
    robot__Uin=-0.34375, robot__m__1__me__we=-0.28125, robot__m__1__wh__ws=-0.9375,
    robot__m__2__me__we=0.09375, robot__m__2__wh__ws=0.03125, robot__Us=0.125),
    ((-0.3605170403009301, 0.38029519759805347), (16.06706453338536, 16.946142158761827),
    (-0.08146611572684465, 0.08593524444008037), (-8.566942448528932, 9.035813823284876),
    (0.6540249793403752, 0.6988478124333978),)),
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
