"""The best isolability against operators written down by hand, one column a fault."""

from __future__ import annotations

import itertools
from typing import Any

import pytest
import sympy as sp

from bondgraph.exact.reactions import Reactions
from bondgraph.exact.trajectory import ExactUnavailable
from bondgraph.field.balls import Imprecise
from bondgraph.passes.analysis import isolability
from tests.unit.passes.relations import compiled

p = sp.Symbol("p")
#: Generic numbers for signals on a healthy trajectory where an operator multiplies by one.
i, w, h1, h2, q = sp.symbols("i w h1 h2 q")

#: Model, and the operator from each fault to two independent relations of it. Multiplying by a
#: signal does not commute with p; no column below has both in one product of two faults compared.
CASES: dict[str, tuple[str, dict[str, tuple[object, object]]]] = {
    # U - R i - L i' - k w,  k i - J w' - f w
    "motor": (
        """model M { param L=1; param R=2; param k=3; param J=4; param f=5
        Se:U -> 1:a; a { -> I:L; -> R:R; -> Df:y; -> GY:k -> b }
        1:b { -> I:J; -> R:f; -> Df:s } }""",
        {
            "L": (1, 0), "R": (1, 0), "U": (1, 0), "J": (0, 1), "f": (0, 1),
            "k": (-w, i), "y": (-2 - p, 3), "s": (-3, -4 * p - 5),
        },
    ),
    # current (a - b)/(R1 + R2) leaves one node and enters the other
    "two resistors in series": (
        """model M { param R1=1; param R2=2; param C=3; param R3=4
        Sf:Q -> 0:a; a { -> C:C; -> De:va; -> 1:s -> b }
        s { -> R:R1; -> R:R2 }
        0:b { -> R:R3; -> De:vb } }""",
        {
            "R1": (1, -1), "R2": (1, -1), "C": (1, 0), "Q": (1, 0), "R3": (0, 1),
            "va": (-sp.Rational(1, 3) - 3 * p, sp.Rational(1, 3)),
            "vb": (sp.Rational(1, 3), -sp.Rational(1, 3) - sp.Rational(1, 4)),
        },
    ),
    # a leak and a wrong pump at one tank cannot be told apart, a leak in the pipe can
    "two tanks": (
        """model M { param A1=1; param leak1=0; param A2=2; param leak2=0; param k=3
        Sf:Q -> 0:t; t { -> C:A1; -> R:l1 { f = leak1*e }; -> De:h1; -> 1:pipe -> u }
        pipe { -> R:v { f = k*e } }
        0:u { -> C:A2; -> R:l2 { f = leak2*e }; -> De:h2 } }""",
        {
            "A1": (1, 0), "leak1": (1, 0), "Q": (1, 0), "A2": (0, 1), "leak2": (0, 1),
            "k": (-1, 1), "h1": (-p - 3, 3), "h2": (3, -2 * p - 3),
        },
    ),
    # the same current twice: y1 - y2, U - R y1; a fault of either gauge has its own direction
    "two gauges": (
        """model M { param R=2
        Se:U -> 1:a; a { -> R:R; -> Df:y1; -> Df:y2 } }""",
        {"R": (0, 1), "U": (0, 1), "y1": (1, -2), "y2": (-1, 0)},
    ),
    # x' = v: the errors of a clock-like integral are proportional to the scale that it has
    "speed and angle": (
        """model M { param m=2; param b=3
        Se:F -> 1:v; v { -> I:m; -> R:b; -> Df:s }
        sensor x = int(v.f) }""",
        {"m": (1, 0), "b": (1, 0), "F": (1, 0), "s": (-2 * p - 3, 1), "x": (0, -p)},
    ),
    # two loads on one shaft behind a gear without inertia of its own
    "gear": (
        """model M { param N=3; param J=2; param b=1
        Se:T -> 1:m; m { -> I:J; -> Df:w1; -> TF:N { f1 = N*f2 } -> l }
        1:l { -> R:b; -> Df:w2 } }""",
        {
            "T": (1, 0), "J": (1, 0), "b": (1, 0),
            "N": (q, h2), "w1": (-2 * p, 1), "w2": (-sp.Rational(1, 3), -3),
        },
    ),
}  # fmt: skip


def proportional(a: tuple[object, object], b: tuple[object, object]) -> bool:
    """Whether two columns are multiples of each other."""
    return bool(sp.simplify(sp.sympify(a[0]) * b[1] - sp.sympify(a[1]) * b[0]) == 0)


@pytest.mark.parametrize("name", CASES)
def test_by_hand(name: str) -> None:
    text, operators = CASES[name]
    c = compiled(text)
    assert c.maximum_isolability is not None
    assert sorted(f for g in c.maximum_isolability for f in g) == sorted(operators)
    group = {f: g for g in c.maximum_isolability for f in g}
    for a, b in itertools.combinations(operators, 2):
        together = group[a] is group[b]
        assert together == proportional(operators[a], operators[b]), (a, b)


def test_one_residual_tells_nothing_apart() -> None:
    c = compiled(
        """model M { param R=1; param L=2; param a=3
        Se:U -> 1:x; x { -> R:R; -> I:L; -> Df:i; -> R:n { e = a*tanh(f) } } }"""
    )
    assert c.maximum_isolability == (("R", "L", "a", "U", "i"),)


def test_products_of_signals() -> None:
    """Q = k sqrt(h) and the torque k i: faults that scale different signals are not parallel,
    those that scale the same law are. Here both constants of a pump sit in one law."""
    c = compiled(
        """model M { param a=1; param b=2; param A=3; param R=4
        Sf:Q -> 0:t; t { -> C:A; -> De:h; -> 1:pipe -> u }
        pipe { -> R:v { f = a*b*ssqrt(e) } }
        0:u { -> R:R; -> De:g } }"""
    )
    best = c.maximum_isolability
    assert best is not None
    assert ("a", "b") in best
    assert ("h",) in best and ("g",) in best and ("R",) in best
    assert ("A", "Q") in best


def test_parameters_behind_a_differential_loop() -> None:
    """v_j = (L_j D + R_j) x with x unmeasured: whatever is wrong in branch j adds to equation j.

    The relations hold L1 and R1 with different signals, after x was eliminated crosswise.
    """
    branches = "".join(
        f"""0:p{j} {{ <- s; -> De:v{j}; -> 1:b{j} }}
        b{j} {{ -> I:L{j}; -> R:R{j} }}
        param L{j} = {j}; param R{j} = {j + 3}
        """
        for j in (1, 2, 3)
    )
    c = compiled(f"model M {{ input d unknown; Se:U = d -> 1:s\n {branches} }}")
    assert c.maximum_isolability is not None
    assert {frozenset(g) for g in c.maximum_isolability} == {
        frozenset((f"L{j}", f"R{j}", f"v{j}")) for j in (1, 2, 3)
    }


def test_parameters_that_two_machines_share() -> None:
    """R and L in two equal circuits: (i1, i2) and (D i1, D i2) are no multiples of each other."""
    c = compiled(
        """model M { param R=1; param L=2
        Se:U1 -> 1:a; a { -> R:r1 = R; -> I:l1 = L; -> Df:i1 }
        Se:U2 -> 1:b; b { -> R:r2 = R; -> I:l2 = L; -> Df:i2 } }"""
    )
    assert ("R", "L") in c.signatures.groups
    best = c.maximum_isolability
    assert best is not None and ("R",) in best and ("L",) in best


def test_a_rank_that_needs_more_digits_is_taken_again(monkeypatch: pytest.MonkeyPatch) -> None:
    text = CASES["two resistors in series"][0]
    expected, own = compiled(text).maximum_isolability, isolability._rank
    asked: list[int] = []

    def rank(numbers: Any, columns: Any) -> int:
        asked.append(1)
        if len(asked) == 1:
            raise Imprecise("a number that needs more digits")
        return own(numbers, columns)

    monkeypatch.setattr(isolability, "_rank", rank)
    assert compiled(text).maximum_isolability == expected
    assert len(asked) > 1


def test_a_mode_in_which_one_of_two_faults_acts() -> None:
    """if(on, E, u) - r i - L i': while it is off the supply is cut off, and L and r are not."""
    c = compiled(
        """model M { input on : bool; param L=0.3; param r=0.2; param C=0.4; param R=2
        1:tr when on { <- Se:E; -> x }
        0:x -> 1:coil; coil { -> I:L; -> R:r; -> Df:i }
        1:fw when not on { -> x; <- o }
        0:o { -> C:C; -> R:R; -> De:u } }"""
    )
    assert ("L", "r", "E") in c.signatures.groups
    assert c.maximum_isolability is not None
    assert {("L", "r"), ("E",)} <= set(c.maximum_isolability)


def test_of_a_plant_without_a_trajectory_nothing_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is one group to be divided, so that nothing is left to be tried by itself."""
    c = compiled(CASES["motor"][0])
    assert c.residuals.residual_set.residuals  # without a point there would be none
    asked: list[int] = []

    def draw(self: Reactions, attempt: Any, *rest: Any) -> Any:
        asked.append(len(attempt.args[1]))
        raise ExactUnavailable("no point")

    monkeypatch.setattr(Reactions, "draw", draw)
    assert c.maximum_isolability is None and asked == [1]
