"""Does khepera_encoders_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import khepera_encoders_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2", "r3", "r4", "r5",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "Fx__1", "Fx__2", "load",
)
SPOILT: tuple[str, ...] = (
    "r1", "r3", "r5",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(Fx__1=0.625, Fx__2=0.9375, load=0.34375, m__1__motor=-0.875, m__1__wheel=0.90625,
    m__2__motor=0.0625, m__2__wheel=0.03125), ((math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=-0.15625, Fx__2=-0.3125, load=-0.90625, m__1__motor=-0.09375,
    m__1__wheel=0.5, m__2__motor=0.28125, m__2__wheel=-0.5625), ((math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=0.1875, Fx__2=-0.71875, load=-0.96875, m__1__motor=0.6875,
    m__1__wheel=-0.59375, m__2__motor=0.09375, m__2__wheel=0.0625), ((math.nan, 0.0), (math.nan,
    0.0), (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(Fx__1=-0.15625, Fx__2=-0.03125, load=0.6875, m__1__motor=-0.78125,
    m__1__wheel=0.34375, m__2__motor=0.4375, m__2__wheel=0.8125), ((math.nan, 0.0), (math.nan, 0.0),
    (math.nan, 0.0), (math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(Fx__1=-0.125, Fx__2=0.0, load=-0.25, m__1__motor=2147483608, m__1__wheel=2147483608,
    m__2__motor=2147483608, m__2__wheel=2147483608), ((0.014435375787488464, 0.02911901520551668),
    (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.021249999999999998, 0.04266959120975916),)),
    (m.Samples(Fx__1=-0.375, Fx__2=-0.9375, load=0.625, m__1__motor=2147483618,
    m__1__wheel=2147483618, m__2__motor=2147483606, m__2__wheel=2147483605), ((0.0144353694882241,
    0.029629856531709638), (3.407164805315778e-11, 1.931764216303629e-09), (2.648597097003819e-09,
    1.1555893028536369e-07), (9.833654843628428e-12, 4.251340475329675e-10), (0.021245139364126454,
    0.04370008677983577),)),
    (m.Samples(Fx__1=-0.75, Fx__2=-0.5625, load=-0.1875, m__1__motor=2147483626,
    m__1__wheel=2147483627, m__2__motor=2147483614, m__2__wheel=2147483602), ((0.01443533964570077,
    0.029656332068659426), (1.5633369547535876e-10, 6.100147178146188e-09), (1.8324897715817363e-08,
    2.0321154930722686e-07), (7.522202652386591e-11, 1.4085568387457302e-09), (0.021220681502093622,
    0.043624287209004145),)),
    (m.Samples(Fx__1=-0.96875, Fx__2=-0.28125, load=0.5, m__1__motor=2147483646,
    m__1__wheel=2147483646, m__2__motor=2147483628, m__2__wheel=2147483622), ((0.014435264741931651,
    0.029657850821417264), (5.326477519915075e-10, 2.1486709313910277e-08), (4.739769802173159e-08,
    5.863417254659213e-07), (2.265336260681476e-10, 4.9411845938154885e-09), (0.021186778528865052,
    0.04360938029053472),)),
    (m.Samples(Fx__1=0.9375, Fx__2=-0.625, load=0.4375, m__1__motor=-2147483645,
    m__1__wheel=-2147483641, m__2__motor=2147483641, m__2__wheel=2147483639),
    ((0.014435129009521841, 0.029657687977828084), (1.6075707473771611e-09, 2.5825169452615237e-08),
    (5.844622662959645e-08, 7.472246866514926e-07), (7.093635027417814e-10, 1.8767712439114626e-08),
    (0.02113339845199354, 0.04348929804914326),)),
    (m.Samples(Fx__1=0.25, Fx__2=-0.125, load=-0.6875, m__1__motor=-2147483643,
    m__1__wheel=-2147483634, m__2__motor=-2147483646, m__2__wheel=-2147483641),
    ((0.014434935550901425, 0.029657300538425416), (4.3017473457250015e-09, 2.758573166677434e-08),
    (7.144320396366693e-08, 9.297749969645952e-07), (1.2864034662264918e-09, 2.333914001401545e-08),
    (0.02106514500860948, 0.04338132384448463),)),
    (m.Samples(Fx__1=0.0, Fx__2=-0.21875, load=0.28125, m__1__motor=-2147483642,
    m__1__wheel=-2147483630, m__2__motor=-2147483627, m__2__wheel=-2147483644),
    ((0.01443469355516175, 0.02965679260773981), (1.0132366371307595e-08, 3.724749182195301e-08),
    (9.339325259331211e-08, 1.056056748332216e-06), (1.2434771483410869e-09,
    1.0434913748129336e-07), (0.02100259149330554, 0.04319204610766786),)),
    (m.Samples(Fx__1=0.21875, Fx__2=0.03125, load=-0.78125, m__1__motor=-2147483644,
    m__1__wheel=-2147483616, m__2__motor=-2147483621, m__2__wheel=-2147483646),
    ((0.014434405176204658, 0.029656393308282226), (2.1275478092768002e-08, 5.722433445547985e-08),
    (2.2274578714426638e-07, 1.2478642564512692e-06), (2.098349769112251e-09,
    1.465831821020027e-07), (0.020936164848723158, 0.043130320945462895),)),
    (m.Samples(Fx__1=0.8125, Fx__2=0.3125, load=0.53125, m__1__motor=-2147483639,
    m__1__wheel=-2147483598, m__2__motor=-2147483615, m__2__wheel=-2147483641),
    ((0.014434060646787344, 0.029655931588324046), (4.084620126611195e-08, 9.850115205413345e-08),
    (3.6470393658601743e-07, 1.6085515800217351e-06), (5.3243422433347045e-09,
    2.1378644908780766e-07), (0.02087697942179882, 0.042976543822836964),)),
    (m.Samples(Fx__1=0.1875, Fx__2=-0.625, load=-0.21875, m__1__motor=-2147483637,
    m__1__wheel=-2147483596, m__2__motor=-2147483609, m__2__wheel=-2147483621),
    ((0.014433640073092908, 0.02965496483432674), (7.291419885681278e-08, 1.6628655808765705e-07),
    (5.329599868571413e-07, 2.2810733335521204e-06), (1.0038098887469212e-08,
    1.6460117772328568e-07), (0.020805679128154418, 0.04277486955375536),)),
    (m.Samples(Fx__1=-0.28125, Fx__2=0.03125, load=-0.59375, m__1__motor=-2147483621,
    m__1__wheel=-2147483589, m__2__motor=-2147483605, m__2__wheel=-2147483624),
    ((0.014433119741587742, 0.029654027399346954), (1.2202963170931037e-07, 2.71082003377938e-07),
    (8.452576041655397e-07, 2.810109831845809e-06), (1.6502062728716097e-08, 2.691309209507456e-07),
    (0.020734224184763218, 0.04268489140659384),)),
    (m.Samples(Fx__1=0.28125, Fx__2=0.28125, load=-0.6875, m__1__motor=-2147483614,
    m__1__wheel=-2147483583, m__2__motor=-2147483598, m__2__wheel=-2147483610),
    ((0.01443246886178709, 0.029652733087102326), (1.9260860186455828e-07, 4.198929055388638e-07),
    (1.336129887883044e-06, 3.9871544265529425e-06), (2.5254282068286644e-08,
    1.936676672625094e-07), (0.020675668230460898, 0.04258046696961601),)),
    (m.Samples(Fx__1=-0.65625, Fx__2=-0.125, load=-0.40625, m__1__motor=-2147483609,
    m__1__wheel=-2147483583, m__2__motor=-2147483591, m__2__wheel=-2147483596),
    ((0.014431661530590684, 0.02965104701712649), (2.88660316848938e-07, 6.20792032157983e-07),
    (1.9957503982293425e-06, 5.508482649364242e-06), (3.731416337537191e-08,
    1.4123230737700058e-07), (0.02063213234340373, 0.042448375253110696),)),
    (m.Samples(Fx__1=-0.71875, Fx__2=0.84375, load=0.5, m__1__motor=-2147483604,
    m__1__wheel=-2147483579, m__2__motor=-2147483582, m__2__wheel=-2147483583),
    ((0.014430681256203563, 0.029649077592884973), (4.13853927254026e-07, 8.818373320094535e-07),
    (2.83516028585196e-06, 7.444323113109829e-06), (5.445279616350808e-08, 1.5009988617218998e-07),
    (0.020592281795122274, 0.04238757309629657),)),
    (m.Samples(Fx__1=-0.09375, Fx__2=0.9375, load=0.3125, m__1__motor=-2147483594,
    m__1__wheel=-2147483569, m__2__motor=-2147483586, m__2__wheel=-2147483575),
    ((0.014429515021719094, 0.029646780217071646), (5.716227643910779e-07, 1.2108796614696354e-06),
    (3.865292290380436e-06, 9.639781623861889e-06), (7.932546032514827e-08, 1.9110336928781396e-07),
    (0.020535330006564913, 0.04223914181023609),)),
    (m.Samples(Fx__1=0.65625, Fx__2=-0.78125, load=-0.0625, m__1__motor=-2147483598,
    m__1__wheel=-2147483567, m__2__motor=-2147483576, m__2__wheel=-2147483558),
    ((0.014428156042349045, 0.029643968037857498), (7.65300099208121e-07, 1.6123597863743958e-06),
    (5.090548132173865e-06, 1.2380111980168428e-05), (1.154355441294446e-07, 2.651256038989399e-07),
    (0.020463185041249447, 0.04204598423531439),)),
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
