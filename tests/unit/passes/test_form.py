"""Relations in their final form: what says nothing is none, what cancels is gone, and names."""

from __future__ import annotations

from typing import NamedTuple

import pytest

from bondgraph.algebra.zero import is_zero
from bondgraph.compilation import Compilation
from bondgraph.exact.plant import Plant
from bondgraph.ir.expr import Expr, Kind, Pool, symbols
from bondgraph.ir.residuals import Closing, ResidualSet
from bondgraph.passes.relation.form import _by_name, relations, with_further
from bondgraph.text.source import Source

_TEXT = """bg 1
model Coils {
    param L = 2; param R = 3; param M = 5; param S = 7
    1:a { <- Se:U; -> I:L; -> R:R; -> Df:i }
    1:b { <- Se:V; -> I:M; -> R:S; -> Df:j }
}
"""


class _Two(NamedTuple):
    """A model of two coils, each with a relation of its own."""

    compiled: Compilation
    plant: Plant

    @property
    def pool(self) -> Pool:
        return self.compiled.graph.pool

    def symbol(self, name: str) -> Expr:
        graph = self.compiled.graph
        known = {v.name: v.symbol for v in graph.values} | {s.name: s.symbol for s in graph.sensors}
        return {**known, **{i.name: i.symbol for i in graph.inputs}}[name]

    def nothing(self) -> Expr:
        """(R + S)^2 - R^2 - 2 R S - S^2, which no sum shows to be zero."""
        p, r, s = self.pool, self.symbol("R"), self.symbol("S")
        squares = (1, p.power(r, 2)), (2, p.mul(r, s)), (1, p.power(s, 2))
        return p.sub(p.power(p.add((1, r), (1, s)), 2), p.add(*squares))

    def formed(self, *exprs: Expr) -> ResidualSet:
        """The relations that are left of some, each made from the first of the model."""
        return relations(
            self.compiled.reduced._replace(closings=tuple(self.closing(e) for e in exprs)),
            self.plant,
        )

    def closing(self, expr: Expr) -> Closing:
        return self.compiled.reduced.closings[0]._replace(expr=expr)


@pytest.fixture(scope="module")
def two() -> _Two:
    compiled = Compilation(Source("m.bg", _TEXT))
    return _Two(compiled, Plant(compiled.graph))


def test_relations_are_named_in_their_order_and_further_ones_go_on(two: _Two) -> None:
    p, i, j = two.pool, two.symbol("i"), two.symbol("j")
    found = relations(two.compiled.reduced, two.plant)
    assert [r.name for r in found.residuals] == ["r1", "r2"]
    again = two.compiled.reduced.closings[1]
    more = with_further(found, [again, two.closing(p.sub(i, j)), again], two.plant)
    assert more.residuals[:2] == found.residuals  # what is there already is no further one
    (third,) = more.residuals[2:]
    assert third.name == "r3" and is_zero(p.sub(third.expr, p.sub(i, j)))


def test_what_depends_on_nothing_or_on_constants_alone_is_no_relation(two: _Two) -> None:
    p, i = two.pool, two.symbol("i")
    fixed = p.symbol("pi", Kind.CONST)
    assert two.formed(p.mul(i, two.nothing()), fixed, p.add((2, fixed), (1, p.one))).residuals == ()
    (alone,) = two.formed(p.mul(fixed, i)).residuals
    assert set(symbols(alone.expr)) >= {i}


def test_the_second_of_two_that_are_the_same_is_left_out(two: _Two) -> None:
    p, i, j = two.pool, two.symbol("i"), two.symbol("j")
    found = two.formed(p.sub(i, j), p.sub(p.scale(2, i), p.scale(2, j)), p.sub(i, j), i).residuals
    assert [r.name for r in found] == [f"r{k}" for k in range(1, len(found) + 1)]
    assert len({r.expr for r in found}) == len(found) and found[-1].name != "r4"


def test_that_a_reading_is_what_its_sensor_says_is_no_relation(two: _Two) -> None:
    p, i = two.pool, two.symbol("i")
    reading = p.symbol("i", Kind.READING)
    assert p.logged([reading])[0] is i
    assert two.formed(p.sub(i, reading)).residuals == ()
    (found,) = two.formed(p.add((3, i), (-1, reading))).residuals
    assert found.orders == {"i": 0}


def test_what_cancels_is_gone_with_its_symbols(two: _Two) -> None:
    p, i, j = two.pool, two.symbol("i"), two.symbol("j")
    R, U = two.symbol("R"), two.symbol("U")
    kept = p.sub(U, p.mul(R, i))
    (found,) = two.formed(p.add((1, kept), (1, p.mul(two.nothing(), p.der(j))))).residuals
    assert is_zero(p.sub(found.expr, kept)) or is_zero(p.add((1, found.expr), (1, kept)))
    assert set(symbols(found.expr)) == {U, R, i} and found.orders == {"U": 0, "i": 0}
    # where parts cancel only each by itself, no other one is taken
    both = p.add((1, kept), (1, p.mul(two.nothing(), p.der(j))), (1, p.mul(two.nothing(), j)))
    (other,) = two.formed(both).residuals
    assert other.expr is found.expr


def test_a_sensor_and_its_reading_have_one_order() -> None:
    p = Pool()
    i, reading = p.symbol("i", Kind.SENSOR), p.symbol("i", Kind.READING)
    u = p.symbol("u", Kind.INPUT)
    assert _by_name({i: 1, reading: 2, u: 0}) == {"i": 2, "u": 0}
    assert _by_name({i: 2, reading: -1}) == {"i": 2}
    assert _by_name({u: -1}) == {"u": -1}
