"""Adaptive thresholds against plants that are simulated apart from the compiler."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bondgraph
from bondgraph.cli.summary import report
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Program
from bondgraph.passes.lowering.uncertain import enlarged
from tests.sampled import Sampled

_ROOT = Path(__file__).resolve().parents[3]
_TS = 1e-3
_TIME = np.arange(0.0, 2.0, _TS)
_Samples = Mapping[str, np.ndarray]

_RC = """bg 1
model RC {
    param R = 2 Ohm +- 20%
    param C = 0.05 F +- 20%
    Se:U -> 1:loop -> R:R
    loop -> 0:node -> C:C(q0 = 0 C)
    node -> De:u
}
"""

#: The relation has J b/K: products, a quotient, and all orders.
_SHAFT = """bg 1
model Shaft {
    param K = 3 N.m/rad +- 20%
    param J = 0.05 kg.m^2 +- 10%
    param b = 0.2 N.m.s/rad +- 10%
    Se:U -> 1:rotor -> I:J
    rotor -> 0:twist -> C:spring(q0 = 0 rad) = 1/K
    twist -> 1:end -> R:b
    end -> Df:w
}
"""


def _compiled(tmp_path: Path, text: str) -> Compilation:
    path = tmp_path / "model.bg"
    path.write_text(text, encoding="utf-8")
    return bondgraph.compile(path)


def _thresholds(compilation: Compilation) -> Program:
    made = compilation.thresholds
    assert made is not None
    return made


def _run(program: Program, samples: _Samples) -> dict[str, np.ndarray]:
    """The results of step where they are valid, NaN before."""
    run = Sampled(program)
    rows = []
    for k in range(len(_TIME)):
        out = run.step({name: float(x[k]) for name, x in samples.items()})
        rows.append([x if out.valid[name] else np.nan for name, x in out.residuals.items()])
    table = np.array(rows, dtype=float)
    return {r.name: table[:, k] for k, r in enumerate(program.residuals)}


def _plant(slope: Callable[[float, np.ndarray], np.ndarray], size: int) -> np.ndarray:
    found = solve_ivp(
        slope, (0.0, _TIME[-1]), np.zeros(size), "LSODA", _TIME, rtol=1e-10, atol=1e-12
    )
    return np.asarray(found.y)


def _voltage(t: float | np.ndarray) -> np.ndarray:
    return np.asarray(6.0 + 3.0 * np.sin(9.0 * t) + 2.0 * np.sin(31.0 * t))


def _motor(R: float, k: float, f: float) -> _Samples:
    """An armature, 300 uH, that turns 1.4e-8 kg.m2, from its textbook equations."""
    L, J = 300e-6, 1.4e-8

    def load(t: float | np.ndarray) -> np.ndarray:
        return np.asarray(2e-4 * np.sin(5.0 * t))

    def slope(t: float, x: np.ndarray) -> np.ndarray:
        i, w = x
        drop = _voltage(t) - R * i - k * w
        return np.array([drop / L, (k * i - f * w - load(t)) / J])

    i, w = _plant(slope, 2)
    return {"U": _voltage(_TIME), "load": load(_TIME), "current": i, "speed": w}


def _circuit(R: float, C: float) -> _Samples:
    u = _plant(lambda t, x: np.array([(_voltage(t) - x[0]) / (R * C)]), 1)[0]
    return {"U": _voltage(_TIME), "u": u}


def _shaft(K: float, J: float, b: float) -> _Samples:
    """A rotor, a spring and a brake, from their balances."""

    def slope(t: float, x: np.ndarray) -> np.ndarray:
        speed, twist = x
        return np.array([(_voltage(t) - K * twist) / J, speed - K * twist / b])

    return {"U": _voltage(_TIME), "w": K * _plant(slope, 2)[1] / b}


def _ratios(
    compilation: Compilation,
    plant: Callable[..., _Samples],
    nominal: tuple[float, ...],
    tolerances: tuple[float, ...],
    scale: float,
) -> dict[str, float]:
    """The largest |r|/a at the corners of the box, without what the nominal plant shows."""
    residual, bound = compilation.program, _thresholds(compilation)
    rest = _run(residual, plant(*nominal))
    found = dict.fromkeys(rest, 0.0)
    for signs in itertools.product((-1, 1), repeat=len(nominal)):
        moved = [
            n * (1 + s * scale * d) for n, s, d in zip(nominal, signs, tolerances, strict=True)
        ]
        samples = plant(*moved)
        r, a = _run(residual, samples), _run(bound, samples)
        for name in found:
            floor = 3 * np.nanmax(np.abs(rest[name]))
            valid = ~np.isnan(a[name]) & (a[name] > 20 * floor)
            assert valid.any()
            ratio = (np.abs(r[name][valid]) - floor) / a[name][valid]
            found[name] = max(found[name], float(ratio.max()))
    return found


_MOTOR = (17.6, 3.51e-3, 1.19e-5), (0.05, 0.02, 0.1)


def test_affine_thresholds_hold_and_are_reached() -> None:
    """At the corners of the tolerances |r| <= a always, and |r| = a at the worst moment."""
    compilation = bondgraph.compile(_ROOT / "models" / "dc_motor.bg")
    found = _ratios(compilation, _motor, *_MOTOR, 1.0)
    assert all(0.9 < ratio <= 1.0 for ratio in found.values()), found


def test_outside_of_the_tolerances_the_threshold_is_crossed() -> None:
    compilation = bondgraph.compile(_ROOT / "models" / "dc_motor.bg")
    found = _ratios(compilation, _motor, *_MOTOR, 1.5)
    assert all(ratio > 1.2 for ratio in found.values()), found


@pytest.mark.parametrize("law", ["", " { f = e/R }"])
def test_products_and_quotients_of_uncertain_parameters_stay_inside(
    law: str, tmp_path: Path
) -> None:
    """With 20 % tolerances a bound of first order would be crossed by a tenth and more."""
    text = _RC.replace("R:R\n", f"R:R{law}\n")
    found = _ratios(_compiled(tmp_path, text), _circuit, (2.0, 0.05), (0.2, 0.2), 1.0)
    assert all(0.8 < ratio <= 1.0 for ratio in found.values()), found


def test_all_orders_of_three_parameters_stay_inside(tmp_path: Path) -> None:
    compilation = _compiled(tmp_path, _SHAFT)
    found = _ratios(compilation, _shaft, (3.0, 0.05, 0.2), (0.2, 0.1, 0.1), 1.0)
    assert all(0.7 < ratio <= 1.0 for ratio in found.values()), found


@pytest.mark.parametrize(
    ("law", "worst"),
    [("e = a*b*c*f", 0.7**-3 - 1.0), ("f = a*b*c*e", 1.3**3 - 1.0)],  # I - u/(a*b*c), I - a*b*c*u
)
def test_three_wide_tolerances_of_one_term_are_no_more_than_its_worst_corner(
    law: str, worst: float, tmp_path: Path
) -> None:
    """A factor of ten for all that is behind the second order made 3.6 times the term of it."""
    names = "\n".join(f"    param {name} = 2 +- 30%" for name in "abc")
    node = f"Sf:I -> 0:n\n    n -> R:r {{ {law} }}\n    n -> De:u"
    made = _compiled(tmp_path, f"bg 1\nmodel One {{\n{names}\n    {node}\n}}\n")
    samples = {"I": np.full(_TIME.size, 1.0), "u": np.full(_TIME.size, 8.0**law.startswith("e"))}
    term = 1.0 if law.startswith("e") else 8.0
    bound = _run(_thresholds(made), samples)["r1"][-1]
    assert bound == pytest.approx(term * worst, rel=1e-6)


def test_what_is_behind_the_second_order_is_enough_for_any_product() -> None:
    """Of some of the factors too, of up to five of up to 50 %, against the products themselves."""
    draw = random.Random(1)
    for _ in range(2000):
        every = [(draw.random() / 2, draw.random() < 0.5) for _ in range(draw.randint(1, 5))]
        own = [one for one in every if draw.random() < 0.7]
        worst = math.prod(1.0 / (1.0 - d) if divides else 1.0 + d for d, divides in own)
        first = sum(d for d, _ in own)
        squares = sum(d * d if divides else -d * d for d, divides in own)
        ways = [[Fraction(d) for d, divides in every if divides == way] for way in (False, True)]
        room = first + float(enlarged(*ways)) * (first**2 + squares) / 2
        assert worst - 1.0 <= room + 1e-12


def test_a_model_without_tolerances_has_no_thresholds(tmp_path: Path) -> None:
    compilation = _compiled(tmp_path, _RC.replace(" +- 20%", ""))
    assert compilation.thresholds is None
    assert not any("threshold_step" in a.text for a in compilation.artifacts)


def test_too_many_tolerances_are_refused_with_the_reason(tmp_path: Path) -> None:
    """Six cells with a tolerance on each of twelve parts: 90 signals of seven stages."""
    lines = ["Se:U -> 1:a1 -> R:r1 = 1 +- 5%", "a1 -> 0:n1 -> C:c1 = 0.1 +- 5%"]
    for k in range(2, 7):
        lines.append(f"n{k - 1} -> 1:a{k} -> R:r{k} = 2 +- 5%")
        lines.append(f"a{k} -> 0:n{k} -> C:c{k} = 0.{k} +- 5%")
    lines += ["n6 -> De:y", "0:aside -> R:s = 3 +- 5%", "Sf:I -> aside", "aside -> De:z"]
    compilation = _compiled(tmp_path, "bg 1\nmodel Ladder {\n" + "\n".join(lines) + "\n}")
    made = _thresholds(compilation)
    reasons = {r.path: r.unavailable for r in made.residuals}
    assert sorted(bool(reason) for reason in reasons.values()) == [False, True]
    assert any("more than 300 stages" in reason for reason in reasons.values())
    told = [line for line in report(compilation, []) if "no adaptive threshold" in line]
    assert len(told) == 1 and "more than 300 stages" in told[0]
