"""Parts that cancel are taken out, and stay where an operation would lose its meaning with them."""

from __future__ import annotations

import pytest

from bondgraph.algebra.cancelled import without
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Pool, topological

p = Pool()
x, y, k, m = (p.symbol(n, Kind.SENSOR) for n in "xykm")


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


def holds(expr: Expr, *parts: Expr) -> bool:
    return any(part in topological([expr]) for part in parts)


#: (x + k) - k, in a form that the pool does not see through
hidden = p.sub(p.sub(p.power(plus(x, k), 2), p.mul(k, plus(p.scale(2, x), k))), p.mul(x, x))


@pytest.mark.parametrize(
    ("expr", "left"),
    [
        (p.sub(plus(x, p.mul(k, y)), p.mul(k, y)), x),
        (plus(hidden, y), y),
        (p.fn("sin", plus(x, hidden)), p.fn("sin", x)),  # its argument stays what it is
        (p.der(plus(x, p.sub(p.mul(k, y), p.mul(k, y)))), p.der(x)),
        # zero for k would divide by zero: one does not, and cancels as well
        (p.div(p.mul(k, x), plus(p.mul(k, y), hidden)), p.div(x, y)),
        (p.div(plus(p.mul(k, x), p.mul(m, x)), plus(k, m, hidden)), x),
    ],
)
def test_a_part_that_cancels_goes(expr: Expr, left: Expr) -> None:
    (found,) = without(p, expr, [k])
    assert is_zero(p.sub(left, expr))
    assert is_zero(p.sub(found, left)) and not holds(found, k)


@pytest.mark.parametrize(
    "expr",
    [
        p.sub(p.fn("log", p.mul(k, x)), p.fn("log", p.mul(k, y))),
        p.fn("atan2", p.mul(k, x), p.mul(k, y)),
        p.choose(p.compare("<", p.mul(k, x), p.mul(k, y)), x, y),
    ],
)
def test_a_part_stays_where_an_argument_would_be_another_one(expr: Expr) -> None:
    assert without(p, expr, [k]) == [expr]


def test_what_stays_does_not_keep_what_can_go() -> None:
    logs = p.sub(p.fn("log", p.mul(k, x)), p.fn("log", p.mul(k, y)))
    (found,) = without(p, plus(logs, p.mul(m, x), p.neg(p.mul(x, m)), hidden), [k, m])
    assert holds(found, k) and not holds(found, m)
    whole = plus(logs, p.sub(p.power(plus(x, m), 2), p.mul(m, plus(p.scale(2, x), m))))
    (found,) = without(p, whole, [k, m])
    assert is_zero(p.sub(found, plus(logs, p.mul(x, x)))) and not holds(found, m)


def test_other_expressions_lose_the_same_parts_unless_they_divide_by_them() -> None:
    expr = plus(y, hidden)
    found = without(p, expr, [k], [plus(x, k), p.div(x, k), x])
    assert found == [found[0], x, p.div(x, k), x]
    assert is_zero(p.sub(found[0], y))


def test_a_number_may_be_given_in_place_of_zero() -> None:
    ratio = p.div(p.mul(k, x), plus(p.mul(k, y), hidden))
    found = without(p, ratio, [k], [plus(x, k)], number=p.num(3))
    assert is_zero(p.sub(found[0], p.div(x, y)))
    assert found[1] is p.add((1, x), (3, p.one))
    # no other number is tried for it then: log(3 x) is another argument than log(k x)
    logs = p.sub(p.fn("log", p.mul(k, x)), p.fn("log", p.mul(k, y)))
    assert without(p, logs, [k], number=p.num(3)) == [logs]
