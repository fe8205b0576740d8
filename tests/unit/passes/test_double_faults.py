"""Double faults against columns of operators written down by hand, one a fault."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any

import pytest
import sympy as sp

from bondgraph.compilation import Compilation
from bondgraph.exact.reactions import Reactions
from bondgraph.exact.trajectory import ExactUnavailable
from bondgraph.passes.analysis import double_faults
from tests.unit.passes.relations import compiled, t, value

p = sp.Symbol("p")
#: Generic signals: each multiplies a fault of its own, so that columns are scaled from the right.
u1, u2, u3, v1, v2, v3 = sp.symbols("u1 u2 u3 v1 v2 v3")

TANKS = """model M { param A1=1; param A2=2; param A3=3; param k1=5; param k2=7
Sf:Q -> 0:t1; t1 { -> C:A1; -> De:h1; -> 1:p1 -> t2 }
p1 { -> R:v1 { f = k1*e } }
0:t2 { -> C:A2; -> De:h2; -> 1:p2 -> t3 }
p2 { -> R:v2 { f = k2*e } }
0:t3 { -> C:A3; -> De:h3 } }"""

#: Model, and the operator from each fault to independent relations of it.
CASES: dict[str, tuple[str, dict[str, tuple[object, ...]]]] = {
    # Q - A1 h1' - k1 (h1 - h2), k1 (h1 - h2) - A2 h2' - k2 (h2 - h3), k2 (h2 - h3) - A3 h3'
    "three tanks": (
        TANKS,
        {
            "Q": (1, 0, 0), "A1": (1, 0, 0), "A2": (0, 1, 0), "A3": (0, 0, 1),
            "k1": (-1, 1, 0), "k2": (0, -1, 1),
            "h1": (-p - 5, 5, 0), "h2": (5, -2 * p - 12, 7), "h3": (0, 7, -3 * p - 7),
        },
    ),
    # U - R i - L i' of three circuits that share R and L, without what scales a column alone
    "shared by three circuits": (
        "model M { param R=1; param L=2"
        + "".join(
            f"\nSe:U{j} -> 1:a{j}; a{j} {{ -> R:r{j} = R; -> I:l{j} = L; -> Df:i{j} }}"
            for j in (1, 2, 3)
        )
        + "}",
        {
            "U1": (1, 0, 0), "U2": (0, 1, 0), "U3": (0, 0, 1),
            "i1": (1, 0, 0), "i2": (0, 1, 0), "i3": (0, 0, 1),
            "R": (u1, u2, u3), "L": (v1, v2, v3),
        },
    ),
    # R and L of two of them: with U1 and U2 four columns in two dimensions, beside a third circuit
    "shared by two of three": (
        """model M { param R=1; param L=2; param R3=3
        Se:U1 -> 1:a1; a1 { -> R:r1 = R; -> I:l1 = L; -> Df:i1 }
        Se:U2 -> 1:a2; a2 { -> R:r2 = R; -> I:l2 = L; -> Df:i2 }
        Se:U3 -> 1:a3; a3 { -> R:r3 = R3; -> Df:i3 } }""",
        {
            "U1": (1, 0, 0), "U2": (0, 1, 0), "U3": (0, 0, 1), "R3": (0, 0, 1),
            "i1": (1, 0, 0), "i2": (0, 1, 0), "i3": (0, 0, 1),
            "R": (u1, u2, 0), "L": (v1, v2, 0),
        },
    ),
    # two branches with a gauge each, and one for both: U - R i1, U - S i2, i1 + i2 - i
    "a sum with a gauge of its own": (
        """model M { param R=2; param S=3
        Se:U -> 1:s; s { -> Df:i; -> 0:n }
        n { -> 1:a; -> 1:b }
        a { -> R:R; -> Df:i1 }
        b { -> R:S; -> Df:i2 } }""",
        {
            "U": (1, 1, 0), "R": (1, 0, 0), "S": (0, 1, 0),
            "i1": (-2, 0, 1), "i2": (0, -3, 1), "i": (0, 0, 1),
        },
    ),
}  # fmt: skip


def rank(columns: Iterable[tuple[object, ...]]) -> int:
    """Over the rational functions in p."""
    return int(sp.Matrix([list(c) for c in columns]).rank(simplify=True))


def pairs(c: Compilation) -> set[tuple[str, str, str]]:
    """(c, a, b): what it takes for the fault c to look like a and b at once, by group."""
    return {
        (single, a[0], b[0])
        for group in c.double_faults.groups
        for single in group[:1]
        for several in c.double_faults.like(single)
        for a, b in itertools.combinations(several, 2)
    }


@pytest.mark.parametrize("name", CASES)
def test_by_hand(name: str) -> None:
    text, operators = CASES[name]
    c = compiled(text)
    assert sorted(f for g in c.double_faults.groups for f in g) == sorted(operators)
    found = pairs(c)
    firsts = [g[0] for g in c.double_faults.groups]
    for a, b in itertools.combinations(firsts, 2):
        spanned = [operators[a], operators[b]]
        assert rank(spanned) == 2, "a group is what is proportional"
        for single in firsts:
            if single not in (a, b):
                alike = rank([*spanned, operators[single]]) == 2
                assert ((single, a, b) in found) == alike, (single, a, b)


def test_two_dimensions_are_said_as_one_fact() -> None:
    """U - L i' - R i and the same of a second gauge: three groups, any two span everything."""
    c = compiled("model M { param R=2; Se:U -> 1:a; a { -> R:R; -> Df:y1; -> Df:y2 } }")
    assert c.double_faults.any_two
    assert not compiled(TANKS).double_faults.any_two


def test_a_mode_tells_apart() -> None:
    """k u - b v - m v' and y - k u while on, where any two are like the third; off k is silent,
    so that only m moves the one and only y the other, but m and y may leave all as k does."""
    c = compiled(
        """model M { param m=1; param b=2; param k=3; input on : bool; input u
        Se:F = if(on, k*u, 0) -> 1:v; v { -> I:m; -> R:b; -> Df:s }
        sensor y = F.e }"""
    )
    found = pairs(c)
    assert found == {("k", "m", "y")}


def test_no_two_of_which_one_shows_by_itself() -> None:
    """On, E - L i' - r i and C u' + u/R: E is L times something there, and nothing with C as well,
    which would show in the second as no E does; off, L acts alone."""
    c = compiled(
        """model M { input on : bool; param L=0.3; param C=0.4
        1:tr when on { <- Se:E; -> x }
        0:x -> 1:coil
        coil { -> I:L; -> R:rL = 0.2; -> Df:i }
        1:fw when not on { -> x; <- o }
        0:o { -> C:C; -> R:R = 2 }
        sensor u = o.e }"""
    )
    assert {"L", "C", "E"} <= {g[0] for g in c.double_faults.groups}
    assert ("E", "L", "C") not in pairs(c)


def test_in_the_residuals_themselves() -> None:
    """Errors of signals, which enter closed forms of linear models: rank at one complex frequency.

    A residual of exp(p t) in one signal and nothing in the others is that entry of its column.
    """
    sources = TANKS.replace("0:t2 {", "0:t2 { <- Sf:Q2;").replace("0:t3 {", "0:t3 { <- Sf:Q3;")
    c = compiled(sources)
    params = {"A1": 1, "A2": 2, "A3": 3, "k1": 5, "k2": 7}
    signals = ("Q", "Q2", "Q3", "h1", "h2", "h3")
    columns = {}
    for own in signals:
        given = {s: sp.exp(sp.Rational(7, 5) * t) if s == own else sp.Integer(0) for s in signals}
        numbers = {name: sp.Integer(x) for name, x in params.items()}
        columns[own] = tuple(sp.nsimplify(value(r.expr, numbers, given)
                             / sp.exp(sp.Rational(14, 25)).n(40), rational=True,
                             tolerance=1e-25) for r in c.residuals)  # fmt: skip
    group = {f: g[0] for g in c.double_faults.groups for f in g}
    found = pairs(c)
    assert {group[s] for s in signals} - {s for s, *_ in found} == {"h2"}
    for single, a, b in itertools.permutations(signals, 3):
        if a < b:
            alike = rank([columns[s] for s in (a, b, single)]) == 2
            first, second = sorted((a, b), key=list(group).index)
            assert ((group[single], group[first], group[second]) in found) == alike


def test_too_many_are_not_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(double_faults, "_PAIRS", 3)
    found = compiled(TANKS).double_faults
    assert found.reason.endswith("pairs of groups are too many")
    assert found.like("Q") == () and not found.any_two


_GAUGES = "model M { param R=2; Se:U -> 1:a; a { -> R:R; -> Df:y1; -> Df:y2 } }"


_MODES = """model M { param m=1; param b=2; param k=3; input on : bool; input u
Se:F = if(on, k*u, 0) -> 1:v; v { -> I:m; -> R:b; -> Df:s }
sensor y = F.e }"""


@pytest.mark.parametrize(
    ("text", "failing", "told"),
    [(_GAUGES, 0, True), (_GAUGES, 99, False), (_MODES, 1, True), (_MODES, 99, False)],
)
def test_where_no_point_is_found_in_any_mode_the_reason_is_told(
    text: str, failing: int, told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    c = compiled(text)
    assert c.maximum_isolability  # all that comes before needs points as well
    drawn, asked = Reactions.draw, list[object]()

    def draw(self: Reactions, *given: Any) -> Any:
        asked.append(given)
        if len(asked) <= failing:
            raise ExactUnavailable("no point")
        return drawn(self, *given)

    monkeypatch.setattr(Reactions, "draw", draw)
    found = c.double_faults
    assert found.reason == ("" if told else "no point") and bool(found.alike) is told
    assert len(asked) > 1 or text == _GAUGES
