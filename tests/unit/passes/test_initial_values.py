"""Declared initial values that no machine begins with, and those that only look like it."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source


def _told(*lines: str) -> list[str]:
    """The messages about initial values of a model with these lines."""
    text = "\n".join(["bg 1", "model M {", *lines, "}", ""])
    compilation = Compilation(Source("m.bg", text))
    assert compilation.equations
    return [
        d.message
        for d in compilation.report.diagnostics
        if d.code == "initial-values-contradict" and d.severity == "warning"
    ]


def test_two_capacitors_in_parallel() -> None:
    (message,) = _told(
        "Sf:I -> 0:bus",
        "bus -> C:C1(q0 = 0.2 C) = 0.1 F",
        "bus -> C:C2(q0 = 0.3 C) = 0.2 F",
        "bus -> De:y",
    )
    assert "C:C1 begins with a voltage of 2 V and C:C2 begins with a voltage of 1.5 V" in message


@pytest.mark.parametrize("q0", ["(q0 = 0.4 C)", ""])
def test_the_same_voltage_or_none_is_no_contradiction(q0: str) -> None:
    lines = ["Sf:I -> 0:bus", "bus -> C:C1(q0 = 0.2 C) = 0.1 F"]
    assert _told(*lines, f"bus -> C:C2{q0} = 0.2 F", "bus -> De:y") == []


@pytest.mark.parametrize(("p0", "count"), [("1 kg.m/s", 0), ("1.1 kg.m/s", 1)])
def test_two_masses_behind_a_lever(p0: str, count: int) -> None:
    """2 kg.m/s of 2 kg are 1 m/s, through the lever 1/3 m/s, and so 1 kg.m/s of 3 kg."""
    told = _told(
        "Se:F -> 1:v",
        "v -> I:m1(p0 = 2 kg.m/s) = 2 kg",
        "v -> TF:n { f1 = 3*f2 } -> 1:w",
        f"w -> I:m2(p0 = {p0}) = 3 kg",
        "v -> Df:y",
    )
    assert len(told) == count


def test_what_a_switch_joins_may_begin_differently() -> None:
    told = _told(
        "input joined : bool",
        "Sf:I -> 0:left",
        "left -> C:C1(q0 = 0.2 C) = 0.1 F",
        "left -> 1:switch when joined { -> 0:right }",
        "right -> C:C2(q0 = 0.3 C) = 0.2 F",
        "right -> De:y",
    )
    assert told == []


def test_a_bent_law_counts_with_its_value() -> None:
    """q^3 at 2 is 8, and 0.8/0.1 is 8 too."""
    lines = ["Sf:I -> 0:bus", "bus -> C:C1(q0 = 2) { e = q^3 }", "bus -> De:y"]
    assert _told(*lines, "bus -> C:C2(q0 = 0.8) = 0.1") == []
    (message,) = _told(*lines, "bus -> C:C2(q0 = 0.7) = 0.1")
    assert "effort of 8" in message
    assert "effort of 7" in message


def test_a_source_of_a_constant_contradicts_too() -> None:
    (message,) = _told(
        "Se:U = 5 V -> 0:bus", "bus -> C:C(q0 = 0.2 C) = 0.1 F", "bus -> 1:i", "i -> R:R = 1 Ohm",
        "i -> Df:y",
    )  # fmt: skip
    assert "C:C begins with a voltage of 2 V, but what is around it gives it another" in message


def test_a_source_that_is_not_known_yet_contradicts_nothing() -> None:
    told = _told(
        "Se:U -> 0:bus", "bus -> C:C(q0 = 0.2 C) = 0.1 F", "bus -> 1:i", "i -> R:R = 1 Ohm",
        "i -> Df:y",
    )  # fmt: skip
    assert told == []


@pytest.mark.parametrize(
    ("law", "count"),
    [
        ("e = z*f", 1),  # no resistance: the voltages of 2 V and 1.5 V are one
        ("e = (1 - one)*f*f", 0),  # not linear: an unknown of its own
        ("e = one*f", 0),  # what flows takes up the difference
        ("e = f/z", 0),  # no number says what that is
        ("e = z*f + 0.5*one", 0),  # 0.5 V between them
        ("e = z*f + 0.5*one^-3", 0),
        ("e = z*f + 0.25/one^2", 1),
        ("e = z*f - 0.5*one", 1),
    ],
)
def test_a_law_between_two_capacitors_says_how_far_they_are_apart(law: str, count: int) -> None:
    """Looked at because a third one shares the state of the first, and agrees with it."""
    told = _told(
        "param z = 0; param one = 1",
        "Sf:I -> 0:left",
        "left -> C:C1(q0 = 0.2 C) = 0.1 F",
        "left -> C:C3(q0 = 0.4 C) = 0.2 F",
        "left -> 1:w -> 0:right",
        f"w -> R:r {{ {law} }}",
        "right -> C:C2(q0 = 0.3 C) = 0.2 F",
        "right -> De:y",
    )
    assert len(told) == count


@pytest.mark.parametrize("pairs", [1, 3, 5])
def test_no_more_than_three_contradictions_are_told(pairs: int) -> None:
    lines = []
    for k in range(pairs):
        lines += [
            f"Sf:I{k} -> 0:bus{k}",
            f"bus{k} -> C:A{k}(q0 = 0.2 C) = 0.1 F",
            f"bus{k} -> C:B{k}(q0 = 0.3 C) = 0.2 F",
            f"bus{k} -> De:y{k}",
        ]
    assert len(_told(*lines)) == min(pairs, 3)
