"""The walk that gives expressions values, with whole numbers and operations that are counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

import pytest

from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import Expr, Kind, Op, Pool

p = Pool()
x, y, z = (p.symbol(name, Kind.SENSOR) for name in "xyz")
VALUES = {x: 3, y: 4}


class Counted:
    """Sums and products of whole numbers; a sine asks for what has no value."""

    def __init__(self, known: Mapping[Expr, int | None] | None = None) -> None:
        self.calls: Counter[Expr] = Counter()
        self.point = Evaluated({Op.ADD: self.sum, Op.MUL: self.product, Op.FN: self.function},
                               VALUES.get, known)  # fmt: skip

    def sum(self, node: Expr, args: list[int]) -> int:
        self.calls[node] += 1
        return sum(int(c) * a for c, a in zip(node.coefficients, args, strict=True))

    def product(self, node: Expr, args: list[int]) -> int:
        self.calls[node] += 1
        found = 1
        for a, e in zip(args, node.exponents, strict=True):
            found *= a**e
        return found

    def function(self, node: Expr, args: list[int]) -> int:
        self.calls[node] += 1
        raise {"sin": ZeroDivisionError, "cos": ValueError, "tan": KeyError}[node.name]


def test_a_value_is_computed_once_however_often_it_is_asked_for() -> None:
    counted = Counted()
    part = p.add((2, x), (1, y))
    whole = p.add((1, p.mul(part, x)), (-1, p.power(part, 2)))
    assert counted.point.value(whole) == 3 * 10 - 100
    assert counted.point.value(part) == 10 and counted.point.value(whole) == -70
    assert counted.calls == {part: 1, p.mul(part, x): 1, p.power(part, 2): 1, whole: 1}


def test_what_is_known_is_not_computed_whatever_it_is_made_of() -> None:
    part = p.add((2, x), (1, z))  # z has no value
    counted = Counted({part: 7, x: 5})
    assert counted.point.value(p.mul(part, x, y)) == 140
    assert counted.calls == {p.mul(part, x, y): 1}
    assert counted.point.value(part) == 7
    assert counted.point.values([]) == {part: 7, x: 5, y: 4, p.mul(part, x, y): 140}


def test_what_is_made_of_something_without_a_value_has_none_and_is_not_computed() -> None:
    counted = Counted({p.mul(x, y): None})
    for nothing in (z, p.add((1, x), (1, z)), p.add((1, z), (1, x), (1, y)), p.der(x),
                    p.add((1, p.mul(x, y)), (1, x))):  # fmt: skip
        assert counted.point.value(nothing) is None
        assert counted.point.value(p.add((1, nothing), (3, p.power(y, 2)))) is None
    assert set(counted.calls) == {p.power(y, 2)}


def test_where_an_operation_has_no_value_others_have_theirs() -> None:
    counted = Counted()
    sine, cosine = p.fn("sin", x), p.fn("cos", x)
    right = p.mul(x, y)
    found = counted.point.values([p.add((1, sine), (1, x)), cosine, right])
    assert found == {x: 3, y: 4, right: 12}
    assert counted.point.value(sine) is None and counted.calls[sine] == 1
    with pytest.raises(KeyError):  # which is a mistake, not a matter of numbers
        counted.point.value(p.fn("tan", x))


def test_a_definition_that_runs_in_a_circle_has_no_value() -> None:
    """x stands for y + 1 and y for 2 x."""
    stands = {x: p.add((1, y), (1, p.one)), y: p.scale(2, x)}
    operations = {Op.ADD: Counted().sum, Op.NUM: lambda node, _: int(node.number)}
    point: Evaluated[int] = Evaluated(operations, lambda node: point.value(stands[node]))
    assert point.value(x) is None and point.value(y) is None
    stands[y] = p.num(7)
    again: Evaluated[int] = Evaluated(operations, lambda node: again.value(stands[node]))
    assert again.value(x) == 8
