"""What an expression is made of, and how many coefficients it asks for."""

from __future__ import annotations

import pytest

from bondgraph.exact.outline import (
    demands,
    highest_order,
    highest_orders,
    integral_depth,
    plan,
    rational,
    static,
)
from bondgraph.exact.switch_modes import assignments
from bondgraph.ir.expr import Expr, Kind, Pool, topological

p = Pool()
x, y = (p.symbol(n, Kind.SENSOR) for n in "xy")
on = p.symbol("on", Kind.MODE)
x0 = p.symbol("x0", Kind.INITIAL)


def _plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


def _integral(of: Expr) -> Expr:
    return p.integral(of, x0)


@pytest.mark.parametrize(
    ("root", "n", "of_x", "of_y"),
    [
        (_plus(p.der(x, 2), y), 3, 5, 3),
        (p.mul(p.der(p.mul(x, p.der(y))), y), 1, 2, 3),
        (_plus(_integral(x), y), 3, 2, 3),
        (_plus(_integral(x), y), 1, 1, 1),  # the value of today is known of an integral
        (_integral(_integral(_plus(x, p.der(y)))), 4, 2, 3),
        (_integral(_integral(_integral(x))), 1, 1, None),
        (p.der(_integral(p.mul(x, y))), 2, 2, 2),
        (_integral(p.der(x)), 1, 2, None),
    ],
)
def test_coefficients_that_each_symbol_must_deliver(
    root: Expr, n: int, of_x: int, of_y: int | None
) -> None:
    nodes, need = plan(root, n)
    assert need[root] == n and need[x] == of_x and need.get(y) == of_y
    assert highest_order([root], n) == max(of_x, of_y or 0) - 1
    assert list(nodes) == topological([root])


def test_of_several_roots_each_asks_for_its_own() -> None:
    roots = [p.der(x), _plus(x, p.der(y, 3)), p.one, y]
    nodes = topological(roots)
    need = demands(nodes, roots, 2)
    assert (need[x], need[y]) == (3, 5)
    assert highest_orders(tuple(roots), 2) == (2, 4, 0, 1)
    assert highest_order(roots, 2) == 4
    assert highest_order([], 3) == 0
    assert demands([x, p.der(x)], [p.der(x), x], 1)[x] == 2


def test_sums_and_products_need_one_number_each_and_nothing_else_does() -> None:
    product = p.mul(_plus(x, p.power(y, -2)), x)
    assert list(static((product,)) or ()) == topological([product])
    assert list(static((product, y)) or ()) == topological([product, y])
    for other in (p.der(x), p.fn("abs", x), _integral(x), p.choose(on, x, y)):
        assert static((other,)) is None and static((product, other)) is None


@pytest.mark.parametrize(
    ("expr", "expected"),
    [
        (p.div(p.der(x), _plus(x, y)), True),
        (_integral(p.mul(x, y)), True),
        (p.choose(on, x, p.mul(x, y)), True),
        (p.choose(p.logic("not", on), x, y), True),
        (p.choose(p.logic("and", on, p.symbol("two", Kind.MODE)), x, p.der(y)), True),
        (p.choose(p.compare("<", x, y), x, y), False),
        (p.choose(p.logic("and", on, p.compare("<", x, y)), x, y), False),
        (p.choose(on, p.fn("sin", x), y), False),
        (p.fn("sqrt", x), False),
        (p.mul(x, p.fn("sin", p.symbol("a", Kind.PARAM))), False),
    ],
)
def test_what_is_rational_but_for_known_decisions(expr: Expr, expected: bool) -> None:
    assert rational([expr]) is expected
    assert rational([p.mul(x, y), expr, y]) is expected


def test_integrals_are_counted_where_one_is_in_the_other() -> None:
    one, two = _integral(x), _integral(p.mul(y, _integral(x)))
    assert [integral_depth([e]) for e in (x, one, two, p.mul(y, two), _plus(two, one))] == [
        0, 1, 2, 2, 2,
    ]  # fmt: skip
    assert integral_depth([x, one, two, y]) == 2 and integral_depth([]) == 0


@pytest.mark.parametrize("count", [0, 1, 3, 6, 7, 8])
def test_all_positions_of_six_switches_are_tried_and_each_of_more_has_both(count: int) -> None:
    switches = [p.symbol(f"s{k}", Kind.MODE) for k in range(count)]
    tried = assignments(switches)
    assert len(tried) == 2 ** min(count, 6)
    assert len({tuple(a[s] for s in switches[:6]) for a in tried}) == len(tried)
    for switch in switches:
        assert sum(a[switch] for a in tried) == len(tried) / 2
    assert all(set(a) == set(switches) for a in tried)
