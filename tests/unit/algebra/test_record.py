"""The tape of a large residual: what it is linear in, and what stays a leaf."""

from __future__ import annotations

from bondgraph.algebra.record import record
from bondgraph.ir.expr import Kind, Pool
from bondgraph.notation.line import show


def test_products_and_powers_of_signals_are_leaves() -> None:
    # r = 2 x y + x^2 + a D(x) + 3 x: of the products nothing is linear in x alone
    pool = Pool()
    x, y = pool.symbol("x", Kind.SENSOR), pool.symbol("y", Kind.SENSOR)
    a = pool.symbol("a", Kind.PARAM)
    product, square = pool.mul(x, y), pool.power(x, 2)
    tape = record(
        pool,
        pool.add((2, product), (1, square), (1, pool.mul(a, pool.der(x))), (3, x)),
    )
    assert {show(leaf.atom): leaf.degree for leaf in tape.leaves} == {
        show(product): 0,
        show(square): 0,
        "x": 1,
    }
    # the polynomials in p that the edges add up, from the residual down
    polynomials: dict[int, dict[int, str]] = {0: {0: "1"}}
    for edge in tape.edges:
        for power, factor in polynomials[edge.source].items():
            terms = polynomials.setdefault(edge.target, {})
            word = show(edge.scale) if factor == "1" else f"{factor}*{show(edge.scale)}"
            terms[power + edge.shift] = word
    found = {show(leaf.atom): polynomials[leaf.node] for leaf in tape.leaves}
    assert found == {show(product): {0: "2"}, show(square): {0: "1"}, "x": {0: "3", 1: "a*1"}}


def test_a_constant_is_a_leaf_that_does_not_move() -> None:
    pool = Pool()
    x, a = pool.symbol("x", Kind.SENSOR), pool.symbol("a", Kind.PARAM)
    tape = record(pool, pool.add((1, x), (-2, a), (1, pool.fn("sin", pool.der(x)))))
    leaves = {show(leaf.atom): leaf for leaf in tape.leaves}
    assert {name: leaf.static for name, leaf in leaves.items()} == {
        "x": True,
        "a": True,
        "sin(D(x))": False,
    }
    (edge,) = [e for e in tape.edges if e.target == leaves["a"].node]
    assert show(edge.scale) == "-2" and edge.shift == 0


def test_a_sum_of_constants_is_a_polynomial_of_one() -> None:
    # r = x - 2 (a + b): what does not move is 1, and its polynomial -2 a - 2 b
    pool = Pool()
    x, a, b = (pool.symbol("x", Kind.SENSOR), *(pool.symbol(n, Kind.PARAM) for n in "ab"))
    tape = record(pool, pool.add((1, x), (-2, pool.add((1, a), (1, b)))))
    leaves = {show(leaf.atom): leaf for leaf in tape.leaves}
    assert set(leaves) == {"x", "1"} and leaves["1"].static and leaves["1"].degree == 0
    into = [e for e in tape.edges if e.target == leaves["1"].node]
    above = {e.target: show(e.scale) for e in tape.edges}
    assert [(above[e.source], show(e.scale), e.shift) for e in into] == [
        ("-2", "a", 0),
        ("-2", "b", 0),
    ]
