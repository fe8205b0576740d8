"""The normal form: what collects, what cancels, what stays an atom."""

from __future__ import annotations

import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.algebra.normalise import normalise, rewritten, static
from bondgraph.field.prime import P
from bondgraph.field.random_point import RandomPoint
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.notation.line import show
from tests.unit.passes.lowering_models import Bench, cable, drive


def table(bench_or_pool: Bench | Pool, expr: Expr) -> dict[tuple[str, int], str]:
    pool = bench_or_pool.pool if isinstance(bench_or_pool, Bench) else bench_or_pool
    return {(show(t.atom), t.order): show(t.coefficient) for t in normalise(pool, expr).terms}


def test_first_residual_of_the_drive() -> None:
    bench = Bench()
    r1, _ = drive(bench)
    found = table(bench, r1)
    names = {s.name: s for s in sympy.symbols("k Re L Je fe N Js fs R")}
    k, re, ind, je, fe, n, js, fs, r = names.values()
    expected = {
        ("We", 0): k + re * fe / k,
        ("We", 1): re * je / k + ind * fe / k,
        ("We", 2): ind * je / k,
        ("Ws", 0): re * fs / k / n,
        ("Ws", 1): re * js / k / n + ind * fs / k / n,
        ("Ws", 2): ind * js / k / n,
        ("Fx", 0): re * r / k / n,
        ("Fx", 1): ind * r / k / n,
        ("U0", 0): sympy.Integer(-1),
    }
    assert set(found) == set(expected)
    for key, text in found.items():
        value = sympy.sympify(text.replace("^", "**"), locals=names)
        assert sympy.simplify(value - expected[key]) == 0


def test_what_cancels_is_gone() -> None:
    p = Pool()
    w, y = p.symbol("w", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    n, a = p.symbol("N", Kind.PARAM), p.symbol("a", Kind.PARAM)
    torque = p.sub(p.div(p.mul(n, w), n), w)
    product = p.mul(p.add((1, a), (1, n)), p.sub(a, n))
    squares = p.sub(p.power(a, 2), p.power(n, 2))
    expr = p.add((1, torque), (1, p.mul(p.sub(product, squares), y)), (1, p.der(y)))
    assert table(p, expr) == {("y", 1): "1"}


def test_integrals_split_from_their_start_and_distribute() -> None:
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    n, q0 = p.symbol("N", Kind.PARAM), p.symbol("q0", Kind.INITIAL)
    inner = p.integral(p.sub(x, p.mul(n, y)), q0)
    assert table(p, inner) == {("1", 0): "q0", ("x", -1): "1", ("y", -1): "-N"}
    twice = p.integral(inner, q0)
    found = table(p, twice)
    assert found["x", -2] == "1"
    assert found["1", -1] == "q0"
    assert table(p, p.der(p.add((2, inner), (1, x)))) == {
        ("x", 0): "2",
        ("y", 0): "-2*N",
        ("x", 1): "1",
    }


def test_integral_of_a_derivative_is_the_change_since_the_start() -> None:
    p = Pool()
    y, q0 = p.symbol("y", Kind.SENSOR), p.symbol("q0", Kind.INITIAL)
    (term,) = [t for t in normalise(p, p.integral(p.der(y), q0)).terms if t.atom is not p.one]
    assert term.order == 0
    assert term.static


def test_nonlinear_terms_stay_and_equal_ones_meet() -> None:
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    a, zero = p.symbol("a", Kind.PARAM), p.symbol("z", Kind.INITIAL)
    together = p.fn("tanh", p.integral(p.sub(x, p.mul(a, y)), zero))
    apart = p.fn(
        "tanh", p.sub(p.integral(x, zero), p.mul(a, p.integral(y, p.symbol("0", Kind.INITIAL))))
    )
    assert normalise(p, p.sub(together, apart)).terms == ()
    flow = p.mul(a, p.fn("ssqrt", p.sub(x, y)))
    form = normalise(p, p.add((1, p.der(flow)), (3, flow)))
    assert [(t.order, show(t.coefficient)) for t in form.terms] == [(0, "3*a"), (1, "a")]
    assert form.exact


def test_total_derivatives_are_found() -> None:
    p = Pool()
    y, u = p.symbol("y", Kind.SENSOR), p.symbol("u", Kind.INPUT)
    assert table(p, p.mul(y, p.der(y))) == {("y^2", 1): "0.5"}
    assert table(p, p.mul(p.power(y, -2), p.der(y))) == {("1/y", 1): "-1"}
    assert table(p, p.mul(p.fn("cos", y), p.der(y))) == {("sin(y)", 1): "1"}
    assert table(p, p.mul(y, p.add((1, u), (2, p.der(y))))) == {("y*u", 0): "1", ("y^2", 1): "1"}
    mixed = normalise(p, p.mul(u, p.der(y)))
    assert not mixed.exact
    assert [static(t.atom) for t in mixed.terms] == [False]


def test_products_by_parts_where_the_speed_is_measured() -> None:
    # c(th) D(w) with th = Int(w): D(c(th) w) - c'(th) w^2, both static
    p = Pool()
    w, zero = p.symbol("w", Kind.SENSOR), p.symbol("0", Kind.INITIAL)
    angle = p.integral(w, zero)
    form = normalise(p, p.mul(p.fn("cos", angle), p.der(w)))
    assert form.exact
    found = {(show(t.atom), t.order): show(t.coefficient) for t in form.terms}
    assert sorted(found.items()) == [
        (("w*cos(Int(w))", 1), "1"),
        (("w^2*sin(Int(w))", 0), "1"),
    ]


def test_a_long_residual_becomes_a_tape_with_the_same_polynomials() -> None:
    bench = Bench()
    expr = cable(bench, 6)
    written = normalise(bench.pool, expr, limit=10**6)
    taped = normalise(bench.pool, expr, limit=10)
    assert written.tape is None
    assert taped.tape is not None
    point = RandomPoint(1)
    rows = {0: [1]}
    for edge in taped.tape.edges:
        scale = point.value(edge.scale)
        assert scale is not None
        row = rows.setdefault(edge.target, [])
        source = rows[edge.source]
        row += [0] * (len(source) + edge.shift - len(row))
        for i, value in enumerate(source):
            row[i + edge.shift] = (row[i + edge.shift] + scale * value) % P
    for term in written.terms:
        (leaf,) = [f for f in taped.tape.leaves if f.atom is term.atom]
        assert rows[leaf.node][term.order] == point.value(term.coefficient)
    assert sum(f.degree + 1 for f in taped.tape.leaves) == len(written.terms) == 16


def test_linear_cost() -> None:
    bench = Bench()
    tape = normalise(bench.pool, cable(bench, 300)).tape
    assert tape is not None
    assert len(tape.edges) < 5000
    assert max(f.degree for f in tape.leaves) == 602


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32))
def test_rewriting_keeps_the_value(seed: int) -> None:
    """Random expressions with derivatives, at random smooth signals: same value by SymPy."""
    import random

    source = random.Random(seed)
    p = Pool()
    signals = [p.symbol(n, Kind.SENSOR) for n in "xyz"]
    params = [p.symbol(n, Kind.PARAM) for n in "ab"]

    def build(depth: int) -> Expr:
        if depth == 0:
            return source.choice(signals + params)
        kind = source.randrange(5)
        if kind == 0:
            return p.add((source.randint(-3, 3), build(depth - 1)), (2, build(depth - 1)))
        if kind in (1, 2):
            return p.mul(build(depth - 1), build(depth - 1))
        if kind == 3:
            return p.der(build(depth - 1))
        return p.fn(source.choice(["sin", "tanh", "exp"]), source.choice(signals))

    expr = build(4)
    form = normalise(p, expr)
    total = p.zero
    for t in form.terms:
        atom = t.atom
        for _ in range(t.order):
            atom = p.der(atom)
        total = p.add((1, total), (1, p.mul(t.coefficient, atom)))
    for other in (total, rewritten(p, expr)):
        difference = to_sympy(expr) - to_sympy(other)
        point = {TIME: 0.3, sympy.Symbol("a"): 1.3, sympy.Symbol("b"): -0.7}
        size = abs(sympy.N(to_sympy(expr).doit().subs(point)))
        assert abs(sympy.N(difference.doit().subs(point))) < 1e-8 * (1 + size)


TIME = sympy.Symbol("t")
SIGNALS = {
    "x": sympy.sin(TIME) / 2 + 1,
    "y": TIME**3 / 3 - TIME / 5 + 1,
    "z": sympy.cos(2 * TIME) / 3,
}


def to_sympy(node: Expr) -> sympy.Expr:
    from bondgraph.ir.expr import Op

    args = [to_sympy(a) for a in node.args]
    match node.op:
        case Op.NUM:
            return sympy.Rational(node.number.numerator, node.number.denominator)
        case Op.SYM:
            name = node.symbol.name
            return SIGNALS[name] if name in SIGNALS else sympy.Symbol(name)
        case Op.ADD:
            pairs = zip(node.coefficients, args, strict=True)
            return sympy.Add(*[sympy.Rational(c.numerator, c.denominator) * a for c, a in pairs])
        case Op.MUL:
            return sympy.Mul(*[a**e for a, e in zip(args, node.exponents, strict=True)])
        case Op.DER:
            return sympy.diff(args[0], TIME)
        case _:
            return getattr(sympy, node.name)(*args)
