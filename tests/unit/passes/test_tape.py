"""Tables of large residuals: run by hand, they give the polynomials of the tape."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random
from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.normal import Edge, Leaf, Tape
from bondgraph.passes.lowering.tape import Large, large

_POOL = Pool()
_UNIT = _POOL.symbol("time_unit", Kind.PARAM)
_SCALES = [_POOL.num(Fraction(k, 2)) for k in (1, -3, 5, 7)]
_ATOMS = [_POOL.symbol(f"y{k}", Kind.SENSOR) for k in range(3)]


def _builder(numbers: bool = True) -> Any:
    """Which keeps the arrays that it is asked for."""
    arrays: dict[str, int] = {}

    def array(wish: str, length: int, doc: str, origin: object) -> str:
        arrays[wish] = length
        return wish

    nominal = SimpleNamespace(value=lambda expr: expr.number if numbers else None)
    signals = {atom: SimpleNamespace(name=atom.symbol.name) for atom in _ATOMS}
    return SimpleNamespace(
        pool=_POOL, option=lambda name: _UNIT, array=array, arrays=arrays, nominal=nominal,
        resolve=list, signals=signals,
    )  # fmt: skip


def _random_tape(seed: int) -> Tape:
    """Nodes in order, each fed by some before it; the last three are leaves that all lead to."""
    draw, nodes = Random(seed), 9
    edges: list[Edge] = []
    for target in range(1, nodes):
        sources = set(draw.sample(range(target), min(target, draw.randint(1, 2))))
        if target == nodes - 1:
            sources |= set(range(nodes - 3)) - {edge.source for edge in edges}
        for source in sorted(sources):
            edges.append(Edge(target, source, draw.randint(0, 2), draw.choice(_SCALES)))
    degrees = [0] * nodes
    for edge in edges:
        degrees[edge.target] = max(degrees[edge.target], degrees[edge.source] + edge.shift)
    own = zip(_ATOMS, range(nodes - 3, nodes), strict=True)
    return Tape(tuple(edges), tuple(Leaf(a, n, degrees[n], True) for a, n in own), nodes)


def _polynomials(tape: Tape, length: int) -> list[list[Fraction]]:
    found = [[Fraction(0)] * length for _ in range(tape.nodes)]
    found[0][0] = Fraction(1)
    for edge in tape.edges:
        for k in range(length - edge.shift):
            found[edge.target][k + edge.shift] += edge.scale.number * found[edge.source][k]
    return found


def _made(tape: Tape, builder: Any) -> Large:
    residual: Any = SimpleNamespace(name="r1", closing=SimpleNamespace(origin=None))
    return large(builder, residual, tape, 100.0, 3)


def _number(scale: Expr, unit: Fraction) -> Fraction:
    """A factor of the table with a number for the unit of time."""
    (found,) = _POOL.substitute([scale], {_UNIT: _POOL.num(unit)})
    return found.number


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("unit", [Fraction(1), Fraction(2)])
def test_a_table_gives_the_polynomials_of_the_leaves_in_the_unit_of_time(
    seed: int, unit: Fraction
) -> None:
    tape, builder = _random_tape(seed), _builder()
    made = _made(tape, builder)
    statement = made.statement
    assert statement.length == 1 + max(leaf.degree for leaf in tape.leaves)
    rows = [[Fraction(0)] * statement.length for _ in range(statement.rows)]
    rows[0][0] = Fraction(1)
    for op in statement.ops:
        assert op.target != op.source
        if op.fresh:
            rows[op.target] = [Fraction(0)] * statement.length
        for k in range(op.length):  # what is behind it is zero
            factor = _number(made.scales[op.scale], unit)
            rows[op.target][k + op.shift] += factor * rows[op.source][k]
        assert not any(rows[op.source][op.length :])
    wanted = _polynomials(tape, statement.length)
    outputs = {out.array: out for out in statement.outputs}
    for leaf in tape.leaves:
        array, length = made.arrays[leaf.atom]
        assert builder.arrays[array] == length == leaf.degree + 1 == outputs[array].length
        found = rows[outputs[array].row][:length]
        assert found == [x * unit**-k for k, x in enumerate(wanted[leaf.node][:length])]
    assert len(set(made.scales)) == len(made.scales)


def test_rows_are_used_again_but_not_those_of_leaves() -> None:
    """A chain takes two rows, however long it is, and one for each leaf on the way."""
    edges = tuple(Edge(k + 1, k, 1, _SCALES[k % 4]) for k in range(8))
    alone = Tape(edges, (Leaf(_ATOMS[0], 8, 8, True),), 9)
    assert _made(alone, _builder()).statement.rows == 2
    both = Tape(edges, (Leaf(_ATOMS[1], 3, 3, True), Leaf(_ATOMS[0], 8, 8, True)), 9)
    assert _made(both, _builder()).statement.rows == 3


@pytest.mark.parametrize("seed", range(6))
def test_the_unit_of_time_is_the_least_in_which_the_first_coefficient_is_largest(
    seed: int,
) -> None:
    """Of powers of two. Where there is no first one the largest one stands for it."""
    tape = _random_tape(seed)
    unit = Fraction(_made(tape, _builder()).time_unit)
    start = Fraction(1) / (Fraction("3.141592653589793") * 20)  # of the highest frequency

    def fits(unit: Fraction) -> bool:
        for polynomial in _polynomials(tape, 20):
            low = [abs(x) * start**-k for k, x in enumerate(polynomial)]
            first = low[0] or max(low)
            if any(x * (start / unit) ** k > first for k, x in enumerate(low)):
                return False
        return True

    assert unit.numerator == 1 or unit.denominator == 1
    assert fits(unit) and not fits(unit / 2)


def test_what_has_no_derivatives_or_cancels_tells_nothing_of_the_unit_of_time() -> None:
    leaf = (Leaf(_ATOMS[0], 2, 1, True),)
    static = Tape((Edge(1, 0, 0, _SCALES[2]), Edge(2, 1, 0, _SCALES[1])), leaf, 3)
    assert _made(static, _builder()).time_unit == 1.0
    nothing = (Edge(1, 0, 1, _POOL.num(1)), Edge(1, 0, 1, _POOL.num(-1)))
    alone = (Edge(2, 0, 0, _SCALES[1]), Edge(2, 0, 1, _SCALES[0]))
    with_it, without = (_made(Tape(e + alone, leaf, 3), _builder()) for e in (nothing, ()))
    assert with_it.time_unit == without.time_unit < 1.0


def test_without_numbers_nothing_is_known_of_sizes() -> None:
    made = _made(_random_tape(1), _builder(numbers=False))
    assert made.low is None and made.time_unit == 1.0
    assert made.seen(_builder(), 100.0, 0.01) == (
        f"it has derivatives up to order {made.statement.length - 1} and no numbers"
    )


def test_low_orders_are_kept_in_units_of_the_highest_frequency() -> None:
    """Of 100 samples a second: 2 pi times 10 of them; two orders more than are asked for."""
    tape = _random_tape(1)
    low = _made(tape, _builder()).low
    assert low is not None and low.shape == (9, 5)
    for found, polynomial in zip(low.tolist(), _polynomials(tape, 20), strict=True):
        expected = [float(x) * (2.0 * math.pi * 10.0) ** k for k, x in enumerate(polynomial[:5])]
        assert found == pytest.approx(expected)
