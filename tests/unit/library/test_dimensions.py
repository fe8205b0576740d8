"""The dimension solver against linear algebra done by hand and by SymPy."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.ir.unit import NONE, Dimension
from bondgraph.library.dimensions import Conflict, Dimensions, Term
from bondgraph.library.units import parse_unit
from bondgraph.text.source import Source, Span

SOURCE = Source("m.bg", "abcdefghijklmnopqrstuvwxyz" * 4)


def at(place: int) -> Span:
    return Span(SOURCE, place, place + 1)


def unit(text: str) -> Dimension:
    found = parse_unit(text)
    assert found is not None
    return found.dimension


def test_unknown_takes_the_known_and_remembers_who_said_so() -> None:
    d = Dimensions()
    x, y, z = (d.fresh(at(i), f"x{i}") for i in range(3))
    assert d.equate(x, y, at(10), "one bond") is None
    assert d.equate(z, y, at(11), "one bond") is None
    assert d.resolve(x) is None
    assert d.equate(y, d.known(unit("V"), at(12), "port a is electrical"), at(13), "") is None
    assert d.resolve(x) == d.resolve(z) == unit("V")
    assert [p.what for p in d.places(z)] == ["port a is electrical"]


@pytest.mark.parametrize("plain", [True, False])
def test_a_conflict_says_which_unit_the_use_of_a_plain_number_gives_it(plain: bool) -> None:
    """k m^2 = J makes k 1/m where J is in m, and k is a number elsewhere."""
    d = Dimensions()
    k = d.fresh(at(0), "`3.14`", plain=plain)
    square = d.known(unit("m^2"), at(1), "")
    assert d.equate(d.product(k, square), d.known(unit("m"), at(2), ""), at(3), "a sum") is None
    conflict = d.equate(k, d.known(NONE, at(4), "`th` is in rad"), at(5), "what it reads")
    assert conflict is not None
    said = {label.span.start: label.text for label in conflict.labels()}
    assert said[4] == "`th` is in rad" and said[1] == "in m^2"
    assert said.get(0) == ("`3.14` has no unit: its use makes it 1/m" if plain else None)


def test_conflict_shows_both_halves() -> None:
    d = Dimensions()
    x, y = d.fresh(at(0), "x"), d.fresh(at(1), "y")
    d.equate(x, d.known(unit("V"), at(2), "a is a voltage"), at(3), "")
    d.equate(y, d.known(unit("N.m"), at(4), "b is a torque"), at(5), "")
    conflict = d.equate(x, y, at(6), "one bond has one effort")
    assert conflict is not None
    assert (conflict.left, conflict.right) == ("V", "N.m")
    assert [(label.span.start, label.text) for label in conflict.labels()] == [
        (6, "one bond has one effort"),
        (2, "a is a voltage"),
        (4, "b is a torque"),
    ]
    assert d.resolve(x) == unit("V")


def test_one_wrong_declaration_is_one_conflict() -> None:
    d = Dimensions()
    wrong = d.known(unit("H"), at(0), "")
    volts, amperes = d.known(unit("V"), at(1), "a"), d.known(unit("A"), at(2), "b")
    first = d.equate(volts, d.product(wrong, amperes), at(3), "e = R*f")
    assert first is not None
    assert [label.text for label in first.labels()] == ["e = R*f", "a", "in H", "b"]
    assert d.equate(wrong, d.known(unit("Ohm"), at(4), "c"), at(5), "") is None
    assert d.equate(d.known(unit("m"), at(6), ""), d.known(NONE, at(7), ""), at(8), "")


def test_law_of_ohm_in_any_order() -> None:
    for known in (("V", "A", None), ("V", None, "Ohm"), (None, "A", "Ohm")):
        d = Dimensions()
        e, f, r = (d.fresh(at(i), "x") for i in range(3))
        d.equate(e, d.product(r, f), at(5), "e = R*f")
        for term, name in zip((e, f, r), known, strict=True):
            if name:
                assert d.equate(term, d.known(unit(name), at(6), name), at(7), "") is None
        assert [d.resolve(t) for t in (e, f, r)] == [unit("V"), unit("A"), unit("Ohm")]


def test_roots() -> None:
    d = Dimensions()
    k, p, q = (d.fresh(at(i), "x") for i in range(3))
    d.equate(q, d.product(k, d.power(p, Fraction(1, 2))), at(3), "f = k*ssqrt(e)")
    d.equate(k, d.known(unit("m^3/s.Pa^-0.5"), at(4), "k"), at(5), "")
    d.equate(q, d.known(unit("m^3/s"), at(6), "q"), at(7), "")
    assert d.resolve(p) == unit("Pa")


def test_an_unknown_in_its_own_equation() -> None:
    d = Dimensions()
    x = d.fresh(at(0), "x")
    assert d.equate(x, d.product(x, d.known(NONE, at(1), "a turn")), at(2), "") is None
    conflict = d.equate(x, d.product(x, d.known(unit("m"), at(1), "l")), at(2), "x = l*x")
    assert conflict is not None
    assert conflict.right == "m.(unit of x)"
    # x^2 = m.x has a solution
    scaled = d.product(x, d.known(unit("m"), at(1), "l"))
    assert d.equate(d.product(x, x), scaled, at(3), "") is None
    assert d.resolve(x) == unit("m")


def test_terms_given_by_the_caller_never_change() -> None:
    d = Dimensions()
    x, y = d.fresh(at(0), "x"), d.fresh(at(1), "y")
    both = d.product(x, y)
    before = dict(both.unknown)
    d.equate(both, d.known(unit("W"), at(2), "power"), at(3), "")
    assert both.unknown == before
    assert d.resolve(both) == unit("W")
    assert d.resolve(x) is None


def test_power_zero_is_no_dimension() -> None:
    d = Dimensions()
    assert d.resolve(d.power(d.fresh(at(0), "x"), 0)) == NONE


def test_long_chains_need_no_recursion() -> None:
    d = Dimensions()
    size = 100_000
    terms = [d.fresh(at(0), "x") for _ in range(size)]
    for left, right in pairwise(terms):
        d.equate(left, right, at(1), "")
    d.equate(terms[0], d.known(unit("Pa"), at(2), "p"), at(3), "")
    assert all(d.resolve(t) == unit("Pa") for t in terms[:: size // 100])
    gears = [d.fresh(at(0), "x") for _ in range(size // 10)]
    ratio = d.known(unit("m"), at(4), "r")
    for left, right in reversed(list(pairwise(gears))):  # each solved for a later one: a chain
        d.equate(left, d.product(right, ratio), at(1), "")
        ratio = d.power(ratio, -1)
    d.equate(gears[0], d.known(unit("m/s"), at(2), "v"), at(3), "")
    # 9999 gears between the first and the last, m and 1/m by turns, m the odd one
    assert d.resolve(gears[-1]) == unit("1/s")
    assert d.resolve(gears[-3]) == unit("1/s")


_Side = tuple[int, dict[int, Fraction]]
_exponents = st.sampled_from([-2, -1, 1, 2, 3, Fraction(1, 2)])
_side = st.tuples(st.integers(-2, 2), st.dictionaries(st.integers(0, 5), _exponents, max_size=3))


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(_side, _side), max_size=8))
def test_agrees_with_linear_algebra(system: list[tuple[_Side, _Side]]) -> None:
    d = Dimensions()
    names = [d.fresh(at(i), f"x{i}") for i in range(6)]

    def term(side: _Side) -> Term:
        out = d.known((side[0], 0, 0, 0, 0, 0, 0), at(9), "k")
        for number, exponent in side[1].items():
            out = d.product(out, d.power(names[number], exponent))
        return out

    rows: list[list[sympy.Rational]] = []
    for left, right in system:
        row = [sympy.Rational(left[1].get(i, 0) - right[1].get(i, 0)) for i in range(6)]
        row.append(sympy.Integer(right[0] - left[0]))
        matrix = sympy.Matrix([*rows, row])
        solvable = matrix.rank() == matrix[:, :6].rank()
        d._doubted.clear()  # every conflict is of interest here
        conflict = d.equate(term(left), term(right), at(8), "")
        assert (conflict is None) == solvable
        if solvable:
            rows.append(row)
    reduced, pivots = sympy.Matrix(rows or [[0] * 7]).rref()
    for number, name in enumerate(names):
        found = d.resolve(name)
        if number in pivots:
            line = reduced.row(pivots.index(number))
            fixed = all(line[j] == 0 for j in range(6) if j != number)
            assert (found is not None) == fixed
            if found is not None:
                assert sympy.Rational(found[0]) == line[6]
        else:
            assert found is None


@pytest.mark.parametrize("turned", [False, True])
def test_union_does_not_care_about_the_order(turned: bool) -> None:
    d = Dimensions()
    x, y = d.fresh(at(0), "x"), d.fresh(at(1), "y")
    first, second = (y, x) if turned else (x, y)
    d.equate(d.power(first, 2), d.power(second, 2), at(2), "")
    d.equate(first, d.known(unit("A"), at(3), "i"), at(4), "")
    assert d.resolve(second) == unit("A")


def test_places_are_few_and_each_once() -> None:
    d = Dimensions()
    out = d.known(NONE, at(0), "n")
    for i in range(50):
        out = d.product(out, d.known(unit("m"), at(i % 5), "m"))
    conflict = d.equate(out, d.known(NONE, at(7), "1"), at(8), "sum")
    assert isinstance(conflict, Conflict)
    places = [label.span.start for label in conflict.labels()]
    assert len(places) <= 5 and len(set(places)) == len(places)
