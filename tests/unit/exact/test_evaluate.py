"""Values of expressions: what is missing, powers, what is linear, what has changed."""

from fractions import Fraction

import pytest

from bondgraph.exact.evaluate import Incremental, evaluate
from bondgraph.exact.plant import Plant
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Kind
from tests.unit.exact.models import MOTOR, graph, symbols
from tests.unit.exact.random_signals import D, Signals, a, add, b, mul, pool, x, y


def test_a_branch_without_value_does_no_harm_unless_taken() -> None:
    root = pool.fn("sqrt", x)
    safe = pool.choose(pool.compare(">", x, pool.zero), root, y)
    for seed in range(6):
        evaluate([safe], Signals(3, seed))


def test_powers_with_rational_and_symbolic_exponents() -> None:
    square = pool.power(x, 2)
    half = pool.fn("pow", square, pool.num(Fraction(3, 2)))
    value = evaluate([half, mul(x, x, x)], Signals(3), 3)
    assert value[0] in (value[1], [-v for v in value[1]])
    n = pool.symbol("n", Kind.PARAM)
    back = pool.fn("pow", pool.fn("pow", square, n), pool.power(n, -1))
    assert evaluate([pool.sub(back, square)], Signals(3), 3)[0] == [0, 0, 0]


def test_exponentials_refuse_what_is_not_linear() -> None:
    plant = Plant(graph(MOTOR))
    p, s = plant.graph.pool, symbols(plant.graph)
    with pytest.raises(Mixed):
        evaluate([p.fn("sin", s["w"])], plant.exponential(1))
    with pytest.raises(Mixed):
        evaluate([p.add((1, s["w"]), (1, p.mul(s["w"], s["w"])))], plant.exponential(1))


class Otherwise(Signals):
    """The same signals, but for those that have the values of another point."""

    def __init__(self, *changed: Expr) -> None:
        super().__init__()
        self.changed = changed

    def value(self, symbol: Expr) -> Series:
        own = super().value(symbol)
        return [2 * c for c in own] if symbol in self.changed else own


@pytest.mark.parametrize("changed", [(a,), (x,), (a, y), (b,), ()])
def test_what_rests_on_a_change_is_computed_anew_however_far_above(
    changed: tuple[Expr, ...],
) -> None:
    """Five nodes are between a and the root, two between y and it; b is nowhere in it."""
    inner = add((1, mul(a, x)), (1, pool.one))
    root = add((1, mul(D(mul(inner, inner)), y)), (3, pool.power(y, -1)))
    n = 2
    work = Incremental(root, Signals(), n)
    other = Otherwise(*changed)
    assert work.anew(changed, other) == evaluate([root], other, n)[0]
    assert work.anew((), Signals()) == evaluate([root], Signals(), n)[0]  # nothing was kept of it
    if {a, x, y}.intersection(changed):
        assert work.anew(changed, other) != work.anew((), Signals())
