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


def test_products_by_parts_of_higher_order() -> None:
    """s D(D(u)) with D(D(s)) = w is D(D(s u)) - 2 D(D(s) u) + w u."""
    p = Pool()
    w, u, zero = p.symbol("w", Kind.SENSOR), p.symbol("u", Kind.INPUT), p.symbol("0", Kind.INITIAL)
    angle = p.integral(w, zero)
    twice = p.integral(angle, zero)
    assert table(p, p.mul(twice, p.der(u, 2))) == {
        (show(p.mul(twice, u)), 2): "1",
        (show(p.mul(angle, u)), 1): "-2",
        (show(p.mul(w, u)), 0): "1",
    }
    # once is too little: the third term would be a derivative times a signal
    form = normalise(p, p.mul(angle, p.der(u, 2)))
    assert [(t.order, static(t.atom)) for t in form.terms] == [(0, False)]


def test_powers_and_products_times_their_rate_and_what_has_no_integral() -> None:
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    both = p.fn("tanh", p.mul(x, y))
    assert table(p, p.mul(p.power(x, 3), p.der(x))) == {("x^4", 1): "0.25"}
    assert table(p, p.mul(p.power(x, -3), p.der(x))) == {("1/x^2", 1): "-0.5"}
    assert table(p, p.mul(both, p.der(both))) == {(show(p.power(both, 2)), 1): "0.5"}
    for factor in (p.power(x, -1), p.fn("atan", x), p.fn("sin", y), p.mul(x, y)):
        (term,) = normalise(p, p.mul(factor, p.der(x))).terms
        assert not static(term.atom) and term.order == 0
    assert table(p, p.mul(p.fn("abs", x), p.der(x))) == {("ssq(x)", 1): "0.5"}


def test_branches_of_a_mode_go_on_by_themselves_where_it_is_held() -> None:
    """if(on, 3 D(x) + y, Int(y)): each part is behind a switch, and its derivative outside."""
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    on, zero = p.symbol("on", Kind.MODE), p.symbol("0", Kind.INITIAL)
    yes, no = p.add((3, p.der(x)), (1, y)), p.integral(y, zero)
    choice = p.choose(on, yes, no)
    form = normalise(p, choice, held=True)
    assert form.exact
    found = {(t.atom, t.order): t.coefficient for t in form.terms}
    assert found == {
        (p.choose(on, x, p.zero), 1): p.num(3),
        (p.choose(on, y, p.zero), 0): p.one,
        (p.choose(on, p.zero, no), 0): p.one,
    }
    (whole,) = normalise(p, choice).terms
    assert whole.atom is choice and not whole.static
    signal = p.choose(p.compare("<", x, y), yes, no)  # which moves with signals
    (term,) = normalise(p, signal, held=True).terms
    assert term.order == 0 and not term.static


def test_a_product_with_a_rate_is_multiplied_out_to_so_many_terms() -> None:
    p = Pool()
    x = p.symbol("x", Kind.SENSOR)
    inputs = [p.symbol(f"u{k}", Kind.INPUT) for k in range(25)]
    for count, terms in ((24, 24), (25, 1)):
        total = p.add(*[(1, u) for u in inputs[:count]])
        assert len(normalise(p, p.mul(total, p.der(x))).terms) == terms
    # a power counts as often as it is taken: 5^2 are too many, 4^2 are not
    for count, terms in ((4, 10), (5, 1)):
        square = p.power(p.add(*[(1, u) for u in inputs[:count]]), 2)
        assert len(normalise(p, p.mul(square, p.der(x))).terms) == terms


def test_short_coefficients_are_merged_so_that_like_terms_meet() -> None:
    p = Pool()
    x = p.symbol("x", Kind.SENSOR)
    params = [p.symbol(f"a{k}", Kind.PARAM) for k in range(7)]
    for count, left in ((6, 5), (7, 2)):
        total = p.add(*[(1, a) for a in params[:count]])
        (term,) = normalise(p, p.sub(p.mul(total, x), p.mul(params[0], x))).terms
        assert len(term.coefficient.args) == left


def test_how_much_work_a_residual_is() -> None:
    """D(a Int(D(x))): a form of one term for each of six parts, put together four times.

    What was looked at before is not looked at again.
    """
    p = Pool()
    x, a, zero = p.symbol("x", Kind.SENSOR), p.symbol("a", Kind.PARAM), p.symbol("0", Kind.INITIAL)
    expr = p.der(p.mul(a, p.integral(p.der(x), zero)))
    assert normalise(p, expr, limit=10).tape is None
    assert normalise(p, expr, limit=9).tape is not None
    squares = p.add((1, p.power(x, 2)), (1, p.integral(p.der(x), zero)))
    sine = p.fn("sin", p.add((1, squares), (-1, p.power(x, 2))))
    assert rewritten(p, sine, limit=3) is sine
    assert rewritten(p, sine) is p.fn("sin", p.integral(p.der(x), zero))


def test_initial_values_that_are_known_are_put_in() -> None:
    p = Pool()
    x, q0 = p.symbol("x", Kind.SENSOR), p.symbol("q0", Kind.INITIAL)
    form = normalise(p, p.integral(x, q0), initials={q0: p.num(7)})
    assert {(show(t.atom), t.order): show(t.coefficient) for t in form.terms} == {
        ("1", 0): "7", ("x", -1): "1",
    }  # fmt: skip
    assert rewritten(p, p.integral(x, q0), initials={q0: p.zero}) is p.integral(
        x, p.symbol("0", Kind.INITIAL)
    )


def test_the_rate_of_a_constant_is_zero() -> None:
    p = Pool()
    x, a = p.symbol("x", Kind.SENSOR), p.symbol("a", Kind.PARAM)
    expr = p.add((1, p.mul(x, p.der(p.fn("exp", a)))), (2, x))
    assert table(p, expr) == {("x", 0): "2"}


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
