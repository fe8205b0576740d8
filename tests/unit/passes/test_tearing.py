"""Relations of loops hold for signals that satisfy the equations, and there are as many as can be.

Torn variables are polynomials of time by chance. Each equation has a sensor of its own, whose
signal is what the equation makes of them; so the reference is the Taylor series of a relation, in
fractions, and nothing is solved for.
"""

from __future__ import annotations

import random
from fractions import Fraction
from functools import cache

import pytest

from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.passes.elimination.tearing import Loops, _Row
from tests.unit.passes.relations import compiled

Series = list[Fraction]

_LENGTH = 9
_COMPARED = 4  # a derivative takes a coefficient away


def times(left: Series, right: Series) -> Series:
    return [sum((left[i] * right[n - i] for i in range(n + 1)), Fraction()) for n in range(_LENGTH)]


def inverse(of: Series) -> Series:
    found = [1 / of[0]]
    for n in range(1, _LENGTH):
        found.append(-sum((of[i] * found[n - i] for i in range(1, n + 1)), Fraction()) / of[0])
    return found


class Bench:
    """Loops over rows each of which has a sensor: `row` says what the sensor reads."""

    def __init__(self, seed: int = 1, patient: bool = False) -> None:
        self.graph = compiled("model M { 1:j { <- Se:u; -> R:R = 1; -> Df:i } }").graph
        self.pool = self.graph.pool
        self.loops = Loops(self.pool, Nominal(self.graph), patient)
        self.rng = random.Random(seed)
        self.signals: dict[Expr, Series] = {}
        self.rows: dict[Expr, int] = {}

    def tear(self, name: str) -> Expr:
        symbol = self.loops.tear(self.pool.symbol(name, Kind.FLOW))
        self.signals[symbol] = self.drawn()
        return symbol

    def known(self, name: str) -> Expr:
        symbol = self.pool.symbol(name, Kind.INPUT)
        self.signals[symbol] = self.drawn()
        return symbol

    def drawn(self) -> Series:
        return [Fraction(self.rng.randint(1, 9)) for _ in range(_LENGTH)]

    def row(self, reads: Expr) -> Expr:
        """An equation: the sensor of the row reads this."""
        number = len(self.rows)
        sensor = self.pool.symbol(f"s{number}", Kind.SENSOR)
        self.signals[sensor] = self.series(reads)
        self.rows[sensor] = number
        self.loops.row(number, self.pool.sub(reads, sensor))
        return sensor

    def derivative(self, of: Expr, times: int) -> Expr:
        for _ in range(times):
            of = self.pool.der(of)
        return of

    def series(self, expr: Expr) -> Series:
        """An expression of the signals as a series in time."""

        @cache
        def at(node: Expr) -> Series:
            match node.op:
                case Op.NUM:
                    return [node.number] + [Fraction()] * (_LENGTH - 1)
                case Op.SYM:
                    return self.signals[node]
                case Op.ADD:
                    parts = [[c * x for x in at(a)] for c, a in node.terms]
                    return [sum(column) for column in zip(*parts, strict=True)]
                case Op.MUL:
                    found = at(self.pool.one)
                    for base, exponent in node.factors:
                        factor = at(base) if exponent > 0 else inverse(at(base))
                        for _ in range(abs(exponent)):
                            found = times(found, factor)
                    return found
                case Op.DER:
                    return [n * x for n, x in enumerate(at(node.args[0]))][1:] + [Fraction()]
            raise AssertionError(node.op)

        return at(expr)

    def holds(self, expr: Expr) -> bool:
        return not any(self.series(expr)[:_COMPARED])

    def checked(self, count: int) -> list[Expr]:
        """All relations, of which there are so many; each is true, and says what it is made of."""
        found = self.loops.relations()
        assert len(found) == count
        for rows, expr in found:
            assert self.holds(expr)
            inside = symbols(expr)
            assert not any(s.symbol.kind is Kind.TEAR for s in inside)
            assert {self.rows[s] for s in inside if s in self.rows} <= set(rows)
            assert len(set(rows)) == len(rows)
        return [expr for _, expr in found]


@pytest.mark.parametrize("patient", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_a_loop_gives_a_relation_for_each_equation_it_has_too_many(
    seed: int, patient: bool
) -> None:
    """Linear rows with derivatives: those of two torn variables, then one and two more."""
    bench = Bench(seed, patient)
    pool, rng = bench.pool, bench.rng
    tears = [bench.tear(n) for n in "xy"]
    known = bench.known("u")
    for _ in range(2 + 1 + seed % 2):
        orders = [(t, rng.randint(0, 1)) for t in tears]
        terms = [(rng.choice((-2, 1, 3)), bench.derivative(t, k)) for t, k in orders]
        if rng.random() < 0.3:
            terms.append((2, pool.mul(known, tears[0])))
        bench.row(pool.add(*terms, (1, known)))
    relations = bench.checked(1 + seed % 2)
    assert all(any(s in bench.rows for s in symbols(r)) for r in relations)
    assert bench.loops.lost == [] and bench.loops.identities == 0


def test_an_algebraic_loop_gives_the_value_of_what_was_torn() -> None:
    bench = Bench()
    pool, loops = bench.pool, bench.loops
    x, y, u = bench.tear("x"), bench.tear("y"), bench.known("u")
    bench.row(pool.add((2, x), (1, pool.mul(u, y))))
    bench.row(pool.add((1, x), (-1, y), (1, pool.power(u, 2))))
    assert loops.open_in(x) and not loops.open_in(u)
    bench.checked(0)
    values = loops.solutions()
    for tear in (x, y):
        assert bench.series(values[tear])[:_COMPARED] == bench.signals[tear][:_COMPARED]
        assert not loops.open_in(tear)
    # a further equation is a relation at once, made of those that gave the values too
    bench.row(pool.add((1, pool.der(x)), (1, pool.mul(u, y))))
    bench.checked(1)
    ((rows, _),) = loops.relations()
    assert set(rows) == {0, 1, 2}
    assert set(loops.rows_for(pool.symbol("y", Kind.FLOW))) == {0, 1}
    assert loops.rows_for(pool.symbol("z", Kind.FLOW)) == ()


def test_a_value_that_equations_give_together_is_put_into_the_others() -> None:
    bench = Bench()
    pool, loops = bench.pool, bench.loops
    u = bench.known("u")
    variable = pool.symbol("x", Kind.FLOW)
    loops.give(variable, (7, 8), pool.power(u, 2))
    x = pool.symbol("x?", Kind.TEAR)
    bench.signals[x] = bench.series(pool.power(u, 2))
    bench.row(pool.add((3, pool.der(x)), (1, u)))
    bench.checked(1)
    ((rows, _),) = loops.relations()
    assert rows == (7, 8, 0) and loops.rows_for(variable) == (7, 8)


def test_what_says_nothing_of_the_machine_is_counted_and_no_relation() -> None:
    """The same equation again, of the same sensor."""
    bench = Bench()
    pool = bench.pool
    x = bench.tear("x")
    sensor = bench.row(pool.add((2, x), (1, bench.known("u"))))
    again = pool.sub(pool.add((2, x), (1, pool.symbol("u", Kind.INPUT))), sensor)
    bench.loops.row(1, again)
    bench.checked(0)
    assert bench.loops.identities == 1


def test_a_row_without_torn_variables_is_a_relation_as_it_stands() -> None:
    bench = Bench()
    sensor = bench.row(bench.pool.der(bench.known("u")))
    assert bench.loops.relations() == [
        ((0,), bench.pool.sub(bench.pool.der(bench.pool.symbol("u", Kind.INPUT)), sensor))
    ]


def test_the_patient_divide_by_no_signal_while_a_derivative_can_be_taken_out() -> None:
    """x' + 2 x, x' + 5 x and u x: two of them give x without u, the third would divide by u.

    Both ways the relations are true.
    """
    divided = {}
    for patient in (False, True):
        bench = Bench(patient=patient)
        pool = bench.pool
        x, u = bench.tear("x"), bench.known("u")
        bench.row(pool.add((1, pool.der(x)), (2, x)))
        bench.row(pool.add((1, pool.der(x)), (5, x)))
        bench.row(pool.add((1, pool.mul(u, x)), (1, u)))
        relations = bench.checked(2)
        below = [e for r in relations for n in _nodes(r) for _, e in n.factors if e < 0]
        divided[patient] = bool(below)
        assert bench.loops.raised is patient
    assert divided == {False: True, True: False}


def _nodes(expr: Expr) -> list[Expr]:
    return [n for n in topological([expr]) if n.op is Op.MUL]


@pytest.mark.parametrize("patient", [False, True])
def test_of_two_values_the_choice_is_no_matter(patient: bool) -> None:
    """x^2 = s0 and x - x^3 = s1: by hand s0 (1 - s0)^2 = s1^2, whichever root x is."""
    bench = Bench(patient=patient)
    pool = bench.pool
    x = bench.tear("x")
    first = bench.row(pool.power(x, 2))
    second = bench.row(pool.sub(x, pool.power(x, 3)))
    (relation,) = bench.checked(1)
    by_hand = pool.sub(
        pool.mul(first, pool.power(pool.sub(pool.one, first), 2)), pool.power(second, 2)
    )
    # as polynomials they are one but for a factor: at other signals, that satisfy nothing
    bench.signals |= {first: bench.drawn(), second: bench.drawn()}
    ratio = times(bench.series(relation), inverse(bench.series(by_hand)))
    assert ratio[0] and not any(ratio[1:])


def test_what_divides_by_a_torn_variable_is_multiplied_with_it() -> None:
    """u/x' + 1 is u + x' after that: linear, and free of its divisor."""
    bench = Bench()
    pool = bench.pool
    x, u = bench.tear("x"), bench.known("u")
    bench.row(pool.add((1, pool.div(u, pool.add((1, x), (1, pool.der(x))))), (2, u)))
    bench.row(pool.add((1, pool.der(x)), (4, x)))
    bench.checked(1)


def test_a_loop_that_cannot_be_solved_is_told_with_what_it_costs() -> None:
    """Three rows tie two variables by x x' and its like: one relation is there, and not found."""
    bench = Bench()
    pool = bench.pool
    x, y = bench.tear("x"), bench.tear("y")
    both = pool.mul(x, pool.der(x), pool.der(y))
    bench.row(pool.add((1, both), (1, pool.mul(y, pool.der(y)))))
    bench.row(pool.add((1, pool.mul(x, pool.der(y))), (2, both)))
    bench.row(pool.add((1, pool.mul(y, pool.der(x), pool.der(y))), (1, both)))
    assert bench.loops.relations() == []
    (lost,) = bench.loops.lost
    assert set(lost.rows) == {0, 1, 2} and lost.about == (2,)


def test_a_row_that_divides_by_what_the_loop_makes_zero_is_dropped_with_none_in_its_place() -> None:
    """x is a: of 1/(x - a) nothing is left, y + x is y + a, and x - 2 holds no variable more."""
    p = Pool()
    x, y = (p.symbol(name, Kind.TEAR) for name in "xy")
    a = p.symbol("a", Kind.PARAM)
    loops = object.__new__(Loops)
    loops.pool, loops.variable, loops.tears = p, {x: x, y: y}, {}
    loops.solved, loops.plain = {}, []
    untouched = _Row((5,), p.mul(y, a))
    loops.pending = [
        _Row((2,), p.add((1, y), (1, x))),
        _Row((1,), p.power(p.sub(x, a), -1)),
        _Row((3, 0), p.sub(x, p.num(2))),
        untouched,
    ]
    loops._record(x, _Row((0,), a))
    assert loops.solved == {x: _Row((0,), a)}
    assert loops.pending == [_Row((0, 2), p.add((1, y), (1, a))), untouched]
    assert loops.plain == [_Row((0, 3), p.sub(a, p.num(2)))]
