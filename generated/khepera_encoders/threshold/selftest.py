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
    m__2__motor=2147483608, m__2__wheel=2147483608), ((0.014435375787488464, 0.028885189764953034),
    (0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.021249999999999998, 0.04252125000842868),)),
    (m.Samples(Fx__1=-0.375, Fx__2=-0.9375, load=0.625, m__1__motor=2147483618,
    m__1__wheel=2147483618, m__2__motor=2147483606, m__2__wheel=2147483605), ((0.014435369396120848,
    0.02959413787953203), (3.420311080438122e-11, 1.2803745390432247e-09), (3.861869663365554e-09,
    7.766559158418305e-09), (9.869241139368091e-12, 2.812748937931019e-10), (0.021242660844239227,
    0.043560586997488375),)),
    (m.Samples(Fx__1=-0.75, Fx__2=-0.5625, load=-0.1875, m__1__motor=2147483626,
    m__1__wheel=2147483627, m__2__motor=2147483614, m__2__wheel=2147483602), ((0.014435340461699999,
    0.029631111999830827), (1.568068959433955e-10, 4.155862253560153e-09), (2.2562877490798645e-08,
    5.1375053906389425e-08), (7.564691453019173e-11, 9.721450068918824e-10), (0.021220507333838554,
    0.043560916648172826),)),
    (m.Samples(Fx__1=-0.96875, Fx__2=-0.28125, load=0.5, m__1__motor=2147483646,
    m__1__wheel=2147483646, m__2__motor=2147483628, m__2__wheel=2147483622), ((0.014435268053113489,
    0.029632857085556845), (5.346903485962889e-10, 1.4655198059834705e-08), (5.3818907273359476e-08,
    1.54764066067898e-07), (2.2775709678071767e-10, 3.4272615549905267e-09), (0.02118465990214515,
    0.04349661659429963),)),
    (m.Samples(Fx__1=0.9375, Fx__2=-0.625, load=0.4375, m__1__motor=-2147483645,
    m__1__wheel=-2147483641, m__2__motor=2147483641, m__2__wheel=2147483639),
    ((0.014435136161831136, 0.02963270222412563), (1.6143077000714064e-09, 1.8479924036749957e-08),
    (7.115399858517596e-08, 2.248421962920929e-07), (7.120054484701894e-10, 1.2973717850029608e-08),
    (0.021131462115421547, 0.04338800813163513),)),
    (m.Samples(Fx__1=0.25, Fx__2=-0.125, load=-0.6875, m__1__motor=-2147483643,
    m__1__wheel=-2147483634, m__2__motor=-2147483646, m__2__wheel=-2147483641),
    ((0.014434945014472128, 0.029632325450992245), (4.319284408578181e-09, 2.1368998205850675e-08),
    (9.175257685214597e-08, 2.876435209585726e-07), (1.2877130131970858e-09, 1.669529034960068e-08),
    (0.02106640258927382, 0.04324644056958957),)),
    (m.Samples(Fx__1=0.0, Fx__2=-0.21875, load=0.28125, m__1__motor=-2147483642,
    m__1__wheel=-2147483630, m__2__motor=-2147483627, m__2__wheel=-2147483644),
    ((0.014434703593247741, 0.029631834902985304), (1.0169415753433269e-08, 3.147422013813096e-08),
    (1.20850820212552e-07, 3.972516621697775e-07), (1.239571830628418e-09, 7.081883748650196e-08),
    (0.021001110442806056, 0.043115922855013436),)),
    (m.Samples(Fx__1=0.21875, Fx__2=0.03125, load=-0.78125, m__1__motor=-2147483644,
    m__1__wheel=-2147483616, m__2__motor=-2147483621, m__2__wheel=-2147483646),
    ((0.014434414999043847, 0.029631257881692036), (2.1344134004158626e-08, 5.192702191496174e-08),
    (2.0272467145788373e-07, 5.59498962416336e-07), (2.1097232215734525e-09,
    1.0083870677468131e-07), (0.02093770029954239, 0.04298144754421356),)),
    (m.Samples(Fx__1=0.8125, Fx__2=0.3125, load=0.53125, m__1__motor=-2147483639,
    m__1__wheel=-2147483598, m__2__motor=-2147483615, m__2__wheel=-2147483641),
    ((0.014434068507397865, 0.02963057207769623), (4.0963919825197344e-08, 9.21143357557727e-08),
    (3.488775995173965e-07, 8.625961635174376e-07), (5.342422247856962e-09, 1.4827765182125726e-07),
    (0.020874801855561165, 0.042860896189901354),)),
    (m.Samples(Fx__1=0.1875, Fx__2=-0.625, load=-0.21875, m__1__motor=-2147483637,
    m__1__wheel=-2147483596, m__2__motor=-2147483609, m__2__wheel=-2147483621),
    ((0.014433643957931213, 0.02962970636030475), (7.310246237459984e-08, 1.584413550085475e-07),
    (5.503472966533887e-07, 1.2994541799035717e-06), (1.0063244474419855e-08,
    1.197974331887765e-07), (0.020805633038335065, 0.04271148975065113),)),
    (m.Samples(Fx__1=-0.28125, Fx__2=0.03125, load=-0.59375, m__1__motor=-2147483621,
    m__1__wheel=-2147483589, m__2__motor=-2147483605, m__2__wheel=-2147483624),
    ((0.01443311824087337, 0.029628642651393918), (1.223098560559662e-07, 2.6087995365997046e-07),
    (9.015124996627736e-07, 2.006139739111131e-06), (1.6536207861995807e-08,
    1.9251473997558487e-07), (0.02073524707524991, 0.042565028565078024),)),
    (m.Samples(Fx__1=0.28125, Fx__2=0.28125, load=-0.6875, m__1__motor=-2147483614,
    m__1__wheel=-2147483583, m__2__motor=-2147483598, m__2__wheel=-2147483610),
    ((0.014432462145599385, 0.02962730830806861), (1.92999784769158e-07, 4.071839857361291e-07),
    (1.3993718729934372e-06, 3.04356283819147e-06), (2.5300620164484727e-08,
    1.4995067462918835e-07), (0.020676961916215653, 0.04244520322331546),)),
    (m.Samples(Fx__1=-0.65625, Fx__2=-0.125, load=-0.40625, m__1__motor=-2147483609,
    m__1__wheel=-2147483583, m__2__motor=-2147483591, m__2__wheel=-2147483596),
    ((0.014431649829797633, 0.029625642771545287), (2.8917927017070784e-07, 6.054706339674455e-07),
    (2.065163193371867e-06, 4.4323177948322224e-06), (3.737883086689603e-08, 1.212010811155115e-07),
    (0.020632632838897696, 0.042354401736640145),)),
    (m.Samples(Fx__1=-0.71875, Fx__2=0.84375, load=0.5, m__1__motor=-2147483604,
    m__1__wheel=-2147483579, m__2__motor=-2147483582, m__2__wheel=-2147483583),
    ((0.014430665932263165, 0.029623627455459378), (4.1451547501969694e-07, 8.635852742924584e-07),
    (2.9095499327235158e-06, 6.191227490015378e-06), (5.454660858561481e-08,
    1.3706014606783875e-07), (0.020590217974038587, 0.042276195016159215),)),
    (m.Samples(Fx__1=-0.09375, Fx__2=0.9375, load=0.3125, m__1__motor=-2147483594,
    m__1__wheel=-2147483569, m__2__motor=-2147483586, m__2__wheel=-2147483575),
    ((0.014429497581375753, 0.029621244291040703), (5.724405142873006e-07, 1.1891198258828211e-06),
    (3.9425593364820465e-06, 8.325198792920279e-06), (7.946307427280556e-08,
    1.8041285473278706e-07), (0.020533802280840594, 0.0421589336542711),)),
    (m.Samples(Fx__1=0.65625, Fx__2=-0.78125, load=-0.0625, m__1__motor=-2147483598,
    m__1__wheel=-2147483567, m__2__motor=-2147483576, m__2__wheel=-2147483558),
    ((0.014428136811988016, 0.02961845461267868), (7.662875662360891e-07, 1.5873679398659782e-06),
    (5.168399173093016e-06, 1.0863216454449961e-05), (1.156354657992108e-07, 2.534824085819551e-07),
    (0.020462726076450305, 0.04200699820702593),)),
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
