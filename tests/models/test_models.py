"""Each model of models/ against its machine by hand: what vanishes, what sees which fault."""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import bondgraph
from bondgraph.cli.result import result
from tests.models import plants, series
from tests.models.plants import Signals, Values
from tests.models.series import Series, t

MODELS = Path(__file__).resolve().parents[2] / "models"


class Case(NamedTuple):
    """A model, its machine by hand, and how many relations it must give."""

    model: str
    plant: Callable[[Values], Signals]
    relations: int


CASES = [
    Case("dc_motor", plants.dc_motor, 2),
    Case("chassis", plants.chassis, 2),
    Case("cable", partial(plants.ladder, cells=4, capacitor=True), 1),
    Case("cable_open", partial(plants.ladder, cells=1, capacitor=False), 1),
    Case("two_tanks", plants.two_tanks, 2),
    Case("quarter_car", plants.quarter_car, 2),
    Case("hydraulic_actuator", plants.hydraulic_actuator, 2),
    Case("rigid_gear", plants.rigid_gear, 2),
    Case("rc_loop", plants.rc_loop, 2),
    Case("microphone", plants.microphone, 2),
    Case("slider_crank", plants.slider_crank, 1),
    Case("oven", plants.oven, 2),
    Case("khepera_encoders", plants.khepera_encoders, 5),
    Case("khepera_built", plants.khepera_built, 3),
]


def compiled(model: str) -> tuple[bondgraph.Compilation, dict[str, Any]]:
    compilation = bondgraph.compile(MODELS / f"{model}.bg")
    return compilation, result(compilation, [])


def nice(number: int) -> Fraction:
    """Values of ordinary size that have nothing to do with each other."""
    return Fraction(_PRIMES[number + 3], _PRIMES[number + 2] + 1)


_PRIMES = [p for p in range(2, 400) if all(p % k for k in range(2, p))]
_INTEGER = re.compile(r"\b\d+\b")


def choose(*pieces: tuple[Series, bool]) -> Series:
    """`Piecewise`, where every condition is known."""
    return next(value for value, condition in pieces if condition)


def relation(arr: dict[str, Any], known: dict[str, Any]) -> Series:
    """The text of a relation with everything known put in."""
    scope: dict[str, Any] = {
        "D": series.d,
        "Int": series.since_start,
        "Abs": series.magnitude,
        "Piecewise": choose,
        "exactly": Fraction,
        **{name: getattr(series, name) for name in ("sqrt", "ssqrt", "sign", "sin", "cos", "tanh")},
        **known,
    }
    for name, part in arr.get("defs", []):
        scope[name] = eval(_INTEGER.sub(r"exactly(\g<0>)", part), scope)
    return Series.of(eval(_INTEGER.sub(r"exactly(\g<0>)", arr["expr"]), scope))


def size(x: Series) -> float:
    return float(max(abs(c) for c in x.c[:4]))


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.model)
def test_relations_vanish_and_faults_move_exactly_what_the_matrix_says(case: Case) -> None:
    compilation, found = compiled(case.model)
    names: dict[str, str] = found["names"]
    faults = compilation.graph.faults
    params = [v.name for v in compilation.graph.values]
    numbers = {name: nice(i) for i, name in enumerate(params)}
    for value in compilation.graph.values:
        if value.name not in faults and value.value is not None and not value.value.args:
            numbers[value.name] = value.value.number
    change = Fraction(1, 3) + t / 5 + t**2 / 7

    def residuals(fault: str | None) -> list[float]:
        signals = case.plant(
            lambda name: Series.of(numbers[name]) * (1 + change if name == fault else 1)
        )
        if fault in signals:
            signals[fault] += change
        known = {plain: {**numbers, **signals}[name] for plain, name in names.items()}
        return [size(relation(arr, known)) for arr in found["arrs"]]

    assert found["n_arr"] == len(found["arrs"]) == case.relations
    healthy = residuals(None)
    for fault in faults:
        moved = residuals(fault)
        row = compilation.signatures.row(fault)
        for k, (still, now) in enumerate(zip(healthy, moved, strict=True)):
            if row[k]:
                assert now > 1e-12 and now > 1e20 * still, (fault, found["arrs"][k]["name"])
            else:
                assert now < 1e-20, (fault, found["arrs"][k]["name"])
    assert max(healthy) < 1e-20


ALL = sorted(path.stem for path in MODELS.glob("*.bg"))


@pytest.mark.parametrize("model", ALL)
def test_every_model_compiles_verified(model: str) -> None:
    compilation = bondgraph.compile(MODELS / f"{model}.bg")
    assert compilation.verification
    assert not [d for d in compilation.report.diagnostics if d.severity != "info"]


@pytest.mark.parametrize("model", ALL)
def test_every_model_says_what_it_teaches(model: str) -> None:
    text = (MODELS / f"{model}.bg").read_text(encoding="utf-8")
    comment = re.match(r"(?:#.*\n)+", text)
    assert comment and "teaches" in comment.group()


def test_every_model_has_a_case_or_is_tested_with_the_paper() -> None:
    with_the_paper = {"drive", "drive_fig6", "khepera", "khepera_plausible"}
    assert {c.model for c in CASES} | with_the_paper == set(ALL)


def test_a_long_cable_in_shared_parts_is_the_chain_of_its_cells(tmp_path: Path) -> None:
    """For constant parameters D is multiplication by p: then the cable is a chain of two-ports."""
    cells = 60
    path = tmp_path / "long.bg"
    path.write_text(
        f'bg 1\nimport Cable from "{MODELS / "khepera.bg"}"\nmodel Long {{\n'
        f"    Se:Uin -> Cable:line(n = {cells}) -> 0:out\n"
        "    out { -> C:Cs = line.C; -> De:Us }\n}\n",
        encoding="utf-8",
    )
    found = result(bondgraph.compile(path), [])
    arr = found["arrs"][0]
    assert arr["defs"] and arr["orders"] == {"Uin": 0, "Us": 2 * cells + 2}
    p, R, L, C, Us = Fraction(1, 3), Fraction(7, 2), Fraction(3, 5), Fraction(2, 7), Fraction(1)
    voltage, current = Us, p * C * Us
    for _ in range(cells):
        voltage += (R + p * L) / (2 * cells) * current
        current += p * C / cells * voltage
        voltage += (R + p * L) / (2 * cells) * current

    def residual(Uin: Fraction) -> Fraction:
        scope: dict[str, Any] = {
            "D": lambda x, n: x * p ** int(n),
            "exactly": Fraction,
            **{"line__R": R, "line__L": L, "line__C": C, "Us": Us, "Uin": Uin},
        }
        for name, part in [*arr["defs"], ["", arr["expr"]]]:
            scope[name] = eval(_INTEGER.sub(r"exactly(\g<0>)", part), scope)
        value: Fraction = scope[""]
        return value

    assert residual(voltage) == 0
    assert residual(voltage + 1) != 0
