"""Signatures by exact derivatives: what cancels, what jumps, what only the past shows."""

from __future__ import annotations

import pytest

from bondgraph.exact.plant import Plant
from bondgraph.passes.analysis.signatures import signatures
from bondgraph.passes.relation.form import relations
from tests.unit.passes.relations import compiled

CASES = {
    # two paths of one torque that cancel in the sum of the balances, but not in their difference
    "cancels": (
        """model M {
        param J1 = 1; param J2 = 2; param c = 3; param kc = 1
        input w
        Se:T -> 1:a
        a { <- MSe:wa = c*w; -> I:J1; -> Df:y1; -> s }
        0:s { -> b; -> C:k = kc }
        1:b { <- MSe:wb = -c*w; -> I:J2; -> Df:y2; -> Se:L }
        }""",
        {"c": 1, "kc": 1},
    ),
    # a mass whose weight is a parameter times a constant
    "weight": (
        """model M {
        param m = 2; const g = 9.81
        Se:F -> 1:v
        v { <- Se:W = -m*g; -> I:m; -> Df:y }
        }""",
        {"m": 1, "F": 1, "y": 1},
    ),
    # friction that only changes sign
    "sign": (
        """model M {
        param m = 2; param Fc = 1; param v0 = 0.1
        Se:F -> 1:v
        v { -> I:m; -> R:dry { e = Fc*sign(f - v0) }; -> Df:y }
        }""",
        {"Fc": 1, "v0": 1, "m": 1},
    ),
    # a limit is seen only on one side of it
    "limit": (
        """model M {
        param C = 2; param top = 1; param R = 3
        Sf:Q -> 0:p
        p { -> C:C; -> R:valve { f = min(e/R, top) }; -> De:y }
        }""",
        {"top": 1, "R": 1, "C": 1},
    ),
    # a parameter of a part that carries nothing
    "still": (
        """model M {
        param R1 = 1; param R2 = 2
        Se:U -> 0:a
        a -> 1:b -> 0:c
        b -> R:R1
        c { -> De:y }
        a -> R:R2
        }""",
        {"R1": 0, "R2": 0, "U": 1, "y": 1},
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_number_of_relations_that_react(name: str) -> None:
    text, expected = CASES[name]
    matrix = compiled(text).signatures
    assert {fault: sum(matrix.row(fault)) for fault in expected} == expected


def test_one_instrument_read_twice_is_no_redundancy() -> None:
    matrix = compiled(
        """model M {
        param m = 2
        Se:F -> 1:v
        v { -> I:m; -> Df:y1; -> Df:y2 = y1 }
        }"""
    ).signatures
    assert matrix.residuals == ("r1",)
    assert "y2" not in matrix.faults


@pytest.mark.parametrize("told", ["y", "((y + 1)^2 - y^2 - 1)/2", "R*y - (R - 1)*y"])
def test_a_source_that_gives_what_its_sensor_reads_tells_nothing(told: str) -> None:
    # each is y: that y is y needs no machine
    matrix = compiled(
        f"""model M {{
        param R = 2; param C = 1
        1:a {{ <- Sf:q = {told}; -> R:R; -> I:C; -> Df:y }}
        }}"""
    ).signatures
    assert matrix.residuals == ()


def test_a_parameter_shared_by_two_elements_is_one_fault() -> None:
    matrix = compiled(
        """model M {
        param R = 2; param C = 3
        Se:U -> 1:a
        a { -> R:r1 = R; -> b; -> Df:i }
        0:b { -> R:r2 = R; -> C:C; -> De:y }
        }"""
    ).signatures
    assert [f for f in matrix.faults if f.startswith("R")] == ["R"]
    assert matrix.row("R") == (True, True)


def test_a_relation_of_very_many_steps_has_the_signature_of_the_same_with_few() -> None:
    c = compiled(
        """model M {
        param m = 2; param k = 3; param b = 1
        Se:F -> 1:v
        v { -> I:m; -> C:k; -> R:b; -> Df:y }
        }"""
    )
    (closing,) = c.reduced.closings
    long = closing._replace(steps=closing.steps * 1000)
    plant = Plant(c.graph)
    matrix = signatures(relations(c.reduced._replace(closings=(long,)), plant), plant)
    assert matrix == c.signatures
    assert set(matrix.signature("r1")) == {"m", "k", "b", "F", "y"}
