"""Does microphone_threshold.py, as it runs here, give what it must? Ends with 0 if so."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable
from typing import TypeVar

import microphone_threshold as m

TOLERANCE = 5e-13

RESIDUALS = (
    "r1", "r2",
)

#: Signals that can be NaN, and the residuals that read one.
SIGNALS: tuple[str, ...] = (
    "U0", "u", "v",
)
SPOILT: tuple[str, ...] = (
    "r1", "r2",
)

PARAMETERS = m.Parameters(
)

Result = tuple[tuple[float, float], ...]

#: What goes in, and for each residual what comes out and the sum of the sizes of its terms.
EXACT: tuple[tuple[m.Derivatives, Result], ...] = (
    (m.Derivatives(U0=0.625, u=0.9375, v=0.34375), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(U0=-0.875, u=0.90625, v=0.0625), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(U0=0.03125, u=-0.15625, v=-0.3125), ((math.nan, 0.0), (math.nan, 0.0),)),
    (m.Derivatives(U0=-0.90625, u=-0.09375, v=0.5), ((math.nan, 0.0), (math.nan, 0.0),)),
)
STEP: tuple[tuple[m.Samples, Result], ...] = (
    (m.Samples(U0=0.28125, u=-0.5625, v=0.1875), ((4.440789473684211e-09, 8.886019739001947e-09),
    (7.500000000000001e-05, 0.00015007500006322284),)),
    (m.Samples(U0=-0.71875, u=-0.96875, v=0.6875), ((4.440481105849702e-09, 9.104224234323683e-09),
    (7.698673306755302e-05, 0.0001576992221686496),)),
    (m.Samples(U0=-0.59375, u=0.09375, v=0.0625), ((4.438777047999524e-09, 9.112258181948276e-09),
    (7.84242421212378e-05, 0.00016097221245223097),)),
    (m.Samples(U0=-0.15625, u=-0.03125, v=0.6875), ((4.434753225636213e-09, 9.103997192296129e-09),
    (7.984978758409744e-05, 0.00016376973702418823),)),
    (m.Samples(U0=-0.78125, u=0.34375, v=0.4375), ((4.428082765342762e-09, 9.091233101293102e-09),
    (8.272065416062433e-05, 0.0001697253959506616),)),
    (m.Samples(U0=0.8125, u=-0.125, v=0.0), ((4.4191996888262455e-09, 9.071964180234859e-09),
    (8.280951620051983e-05, 0.0001699915106800797),)),
    (m.Samples(U0=-0.25, u=-0.375, v=-0.9375), ((4.409387892578707e-09, 9.0518610820537e-09),
    (7.744465341526189e-05, 0.00016662420189962398),)),
    (m.Samples(U0=0.625, u=-0.1875, v=-0.0625), ((4.399263335417349e-09, 9.030829416977978e-09),
    (7.196243189059218e-05, 0.0001490201155837205),)),
    (m.Samples(U0=-0.34375, u=0.75, v=-0.75), ((4.3881452096197665e-09, 9.009139983698045e-09),
    (6.731068913186967e-05, 0.00014438288649737998),)),
    (m.Samples(U0=-0.5625, u=-0.1875, v=0.25), ((4.374835558889785e-09, 8.981478549265957e-09),
    (6.401091631355469e-05, 0.00013198333098412115),)),
    (m.Samples(U0=0.96875, u=-0.53125, v=-0.96875), ((4.360164029694887e-09, 8.950614515229248e-09),
    (5.9880886064860036e-05, 0.0001308622854661849),)),
    (m.Samples(U0=-0.96875, u=-0.28125, v=0.5), ((4.345356671527269e-09, 8.921145633252708e-09),
    (5.685817936951342e-05, 0.00011743306018777885),)),
    (m.Samples(U0=-0.34375, u=0.3125, v=0.375), ((4.329144654948858e-09, 8.887742931532321e-09),
    (5.9195894056395275e-05, 0.00012148548282656861),)),
    (m.Samples(U0=-0.125, u=0.9375, v=-0.625), ((4.3102896248789085e-09, 8.849406909851565e-09),
    (5.702046968816657e-05, 0.00012215786779477833),)),
    (m.Samples(U0=0.4375, u=0.375, v=-0.96875), ((4.2890837258755775e-09, 8.805199634710149e-09),
    (4.957517808241504e-05, 0.0001102009543322129),)),
    (m.Samples(U0=0.71875, u=-0.03125, v=0.25), ((4.266937102359572e-09, 8.75917008644678e-09),
    (4.5763171543857483e-05, 9.473299740529167e-05),)),
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
