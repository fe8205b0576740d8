"""Values of expressions: what is missing, powers, what is linear, what has changed."""

from fractions import Fraction

import pytest

from bondgraph.exact.dependence import Forward
from bondgraph.exact.evaluate import Incremental, evaluate, terms_needed, values_where
from bondgraph.exact.plant import Plant
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field.numbers import Undefined
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr, Kind
from tests.unit.exact.models import MOTOR, graph, symbols
from tests.unit.exact.random_signals import D, Signals, a, add, b, mul, pool, x, x0, y


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


class Numbered(Signals):
    """Signals of whole numbers: x is 2, y is 0, a is 3, b is -4; what is true is 1."""

    def value(self, symbol: Expr) -> Series:
        told = {x: [2, 1], y: [0, 0], a: [3], b: [-4], _on: [1], _off: [0]}
        return [self.algebra.numbers.number(c) for c in told[symbol]]


_on, _off = (pool.symbol(n, Kind.MODE) for n in ("on", "off"))


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        (_on, True),
        (_off, False),
        (pool.logic("not", _on), False),
        (pool.logic("not", _off), True),
        (pool.logic("and", _on, _off), False),
        (pool.logic("or", _off, _on), True),
        (pool.logic("or", _off, pool.logic("and", _off, _on)), False),
        (pool.compare("==", y, pool.zero), True),
        (pool.compare("==", x, a), False),
        (pool.compare("<=", y, pool.zero), True),
        (pool.compare("<", y, pool.zero), False),
    ],
)
def test_a_condition_takes_its_branch(condition: Expr, expected: bool) -> None:
    taken = evaluate([pool.choose(condition, a, b)], Numbered())[0]
    assert taken == [3 if expected else -4]


def test_what_has_no_value_is_missed_where_it_is_needed_only() -> None:
    """1/y has none: not as a condition, not as the branch that is taken, not above that."""
    none = pool.power(y, -1)
    fine = (
        pool.choose(_off, none, a),
        pool.choose(_on, a, none),
        pool.choose(pool.compare("<", a, x), none, pool.choose(_on, a, none)),
        pool.mul(pool.choose(_on, a, none), pool.one),
    )
    for root in fine:
        assert evaluate([root], Numbered())[0] == [3]
    for root in (
        none,
        pool.choose(_on, none, a),
        pool.choose(_off, a, none),
        pool.choose(pool.compare("<", none, x), a, b),
        pool.fn("abs", pool.choose(_off, a, mul(none, a))),
        add((1, none), (1, pool.choose(_on, a, b))),
    ):
        with pytest.raises(Undefined):
            evaluate([root], Numbered())
    both = (fine[0], pool.sub(x, a))
    assert evaluate(both, Numbered(), 2) == [[3], [-1, 1]]


def test_sums_and_products_are_computed_at_once_and_powers_inverted_once() -> None:
    """3/x^2 - 5 b x + a - 1/2 x^3 is 3/4 + 40 + 3 - 4, and 1/y^2 has no value there either."""
    root = add((3, pool.power(x, -2)), (-5, mul(b, x)), (1, a), (Fraction(-1, 2), pool.power(x, 3)))
    f = Numbered().algebra.numbers
    assert evaluate([root], Numbered())[0] == [f.fraction(Fraction(159, 4))]
    both = add((1, pool.power(x, -1)), (1, mul(a, pool.power(x, -3))))
    assert evaluate([both, a], Numbered()) == [[f.fraction(Fraction(7, 8))], [3]]
    with pytest.raises(Undefined):
        evaluate([pool.power(y, -2)], Numbered())


def test_so_many_coefficients_decide_as_integrals_are_nested() -> None:
    once = pool.integral(x, x0)
    assert terms_needed([x]) == 1
    assert terms_needed([x, once]) == 2
    assert terms_needed([pool.integral(mul(y, once), x0)]) == 3


def test_inside_of_an_equation_no_integral_has_a_beginning() -> None:
    f = Signals().algebra
    assert values_where(mul(x, a), {x: [2], a: [3]}, f, 1)[mul(x, a)] == [6]
    with pytest.raises(Mixed):
        values_where(pool.integral(x, x0), {x: [2]}, f, 1)


def test_branches_that_are_taken_are_told_with_those_inside() -> None:
    inner = pool.choose(_off, x, b)
    outer = pool.choose(pool.compare("<", x, a), inner, pool.choose(_on, a, y))
    root = pool.fn("abs", add((1, outer), (1, pool.choose(pool.logic("not", _on), a, x))))
    sample = Numbered()
    taken = Forward([root], sample).taken([root], sample.algebra)
    beside = pool.choose(pool.logic("not", _on), a, x)
    assert taken == {(outer, True), (inner, False), (beside, False)}
    above = pool.choose(pool.compare("<", inner, a), x, y)  # b < a does not hold in the field
    found = Forward([above], sample).taken([above], sample.algebra)
    assert {node for node, _ in found} == {above, inner}
    straight = Forward([mul(x, a)], sample)
    assert straight.taken([mul(x, a)], sample.algebra) == set()
