"""Expressions as text for SymPy: parsed back, they are the same function."""

from __future__ import annotations

from fractions import Fraction
from math import isnan

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.ir.expr import Expr, Kind, Pool, Root
from bondgraph.notation.parsable import DEEP, Names, Parsable, parsable


def read(text: Parsable) -> sympy.Expr:
    """What SymPy makes of the text, with the shared parts put in."""
    names: dict[str, object] = {s: sympy.Symbol(s) for s in text.symbols}
    for name, part in text.defs:
        names[name] = sympy.parse_expr(part, local_dict=names)
    return sympy.parse_expr(text.expr, local_dict=names)


def test_names_of_the_model_become_identifiers() -> None:
    names = Names(["m[1].wh.ws", "U0[2]", "lambda", "lambda_", "D", "x", "µ"]).by_model
    assert names["m[1].wh.ws"] == "m__1__wh__ws"
    assert names["U0[2]"] == "U0__2"
    assert names["lambda"] == "lambda_" and names["lambda_"] == "lambda__"
    assert names["D"] == "D_" and names["x"] == "x"
    assert all(n.isidentifier() for n in names.values())
    assert len(set(names.values())) == len(names)


def symbols() -> tuple[Pool, Expr, Expr, Names]:
    pool = Pool()
    x, a = pool.symbol("x", Kind.SENSOR), pool.symbol("w.a", Kind.PARAM)
    return pool, x, a, Names(["x", "w.a"])


def test_numbers_are_exact() -> None:
    pool, x, a, names = symbols()
    text = parsable(pool, pool.add((Fraction(1, 3), x), (Fraction(-7, 10), a)), names)
    assert read(text) == sympy.Symbol("x") / 3 - sympy.Rational(7, 10) * sympy.Symbol("w__a")


def test_derivatives_of_any_order_are_one_call() -> None:
    pool, x, a, names = symbols()
    text = parsable(pool, pool.div(pool.der(pool.der(x)), a), names)
    assert text.expr == "D(x, 2)/w__a"


def test_derivative_of_a_derivative_of_a_sum_keeps_its_parts() -> None:
    pool, x, a, names = symbols()
    inner = pool.add((1, pool.mul(x, a)), (1, pool.fn("atan2", x, a)))
    assert parsable(pool, pool.der(pool.der(inner)), names).expr == "D(x*w__a + atan2(x, w__a), 2)"


def test_an_integral_has_the_expression_of_its_initial_value() -> None:
    pool, x, a, names = symbols()
    start = pool.symbol("spring.q0", Kind.INITIAL)
    node = pool.integral(x, start)
    assert parsable(pool, node, names, {start.symbol: pool.mul(a, a)}).expr == "Int(x, w__a**2)"
    half = pool.num(Fraction(1, 2))
    assert parsable(pool, node, names, {start.symbol: half}).expr == "Int(x, 1/2)"


@pytest.mark.parametrize("value", [-2.5, -1.0, 0.25, 3.0])
def test_functions_mean_what_they_mean(value: float) -> None:
    pool, x, _, names = symbols()
    pool.tables["t"] = ((Fraction(-1), Fraction(2)), (Fraction(1), Fraction(4)))
    root = abs(value) ** (1 / 3) * (1 if value > 0 else -1)
    below = pool.compare("<", x, pool.num(0))
    cases = {
        pool.fn("ssq", x): value * abs(value),
        pool.fn("cbrt", x): root,
        pool.fn("max", x, pool.num(1)): max(value, 1),
        pool.fn("table:t", x): min(max(3 + value, 2), 4),
        pool.choose(pool.logic("not", below), x, pool.zero): max(value, 0),
    }
    for expr, expected in cases.items():
        found = read(parsable(pool, expr, names)).subs(sympy.Symbol("x"), sympy.Rational(value))
        assert float(found) == pytest.approx(expected)


@pytest.mark.parametrize("x", [1, 2, 3])
def test_conditions_mean_what_they_mean(x: int) -> None:
    pool, y, _, names = symbols()
    one, two = pool.one, pool.num(2)
    cases = {
        pool.compare("==", y, two): x == 2,
        pool.compare("<", y, two): x < 2,
        pool.compare("<=", y, two): x <= 2,
        pool.logic("or", pool.compare("<", y, two), pool.compare("<", two, y)): x != 2,
        pool.logic("and", pool.compare("<", one, y), pool.compare("<=", y, two)): x == 2,
        pool.compare("<", pool.add((1, y), (1, y)), pool.mul(y, y)): 2 * x < x * x,
    }
    for condition, holds in cases.items():
        text = parsable(pool, pool.choose(condition, pool.num(7), pool.num(5)), names)
        found = read(text).subs(sympy.Symbol("x"), x)
        assert found == (7 if holds else 5), text.expr


def test_text_that_runs_calls_what_sympy_has_no_inverse_of() -> None:
    """And tells which functions have to be there, by what an expression calls them."""
    pool, x, _, names = symbols()
    pool.tables["a b.csv"] = ((Fraction(-1), Fraction(2)), (Fraction(1), Fraction(4)))
    called: dict[str, str] = {}
    third = pool.num(Fraction(1, 3))
    for expr, text in (
        (pool.fn("ssq", x), "ssq(x)"),
        (pool.fn("ssqrt", x), "ssqrt(x)"),
        (pool.fn("cbrt", x), "cbrt(x)"),
        (pool.fn("table:a b.csv", x), "table_a_b_csv(x)"),
        (pool.fn("table:a b.csv'", x), "table_a_b_csv_inverse(x)"),
        (pool.fn("table:a b.csv", pool.fn("abs", x)), "table_a_b_csv(Abs(x))"),
        (pool.fn("pow", x, third), "x**Rational(1, 3)"),
        (pool.fn("max", x, third), "Max(x, Rational(1, 3))"),
        (pool.scale(3, x), "3*x"),
    ):
        assert parsable(pool, expr, names, functions=called).expr == text
    assert called == {
        "ssq": "ssq",
        "ssqrt": "ssqrt",
        "cbrt": "cbrt",
        "table:a b.csv": "table_a_b_csv",
        "table:a b.csv'": "table_a_b_csv_inverse",
    }


def test_two_unknowns_of_one_name_have_a_name_and_an_equation_each() -> None:
    """x + x^3 = i and 2 x = i, whose unknowns are both called x."""
    pool, i, _, _ = symbols()
    u, c = pool.symbol("u", Kind.UNKNOWN), pool.symbol("c", Kind.UNKNOWN)
    cubic = pool.sub(pool.add((1, u), (1, pool.power(u, 3))), c)
    one = pool.root(Root("y", cubic, u, (c,), u, True, Fraction(1, 2)), i)
    two = pool.root(Root("y", pool.sub(pool.scale(2, u), c), u, (c,), u, True, Fraction(0)), i)
    names = Names(["x"])
    text = parsable(pool, pool.add((1, one), (10, two)), names)
    cubed, doubled = sorted(text.implicit, key=lambda row: "**3" not in row[1])
    assert cubed[0] != doubled[0] and {cubed[0], doubled[0]} < set(text.symbols)
    assert {names.known_as[name] for name, _, _ in text.implicit} == {"y"}
    assert (cubed[2], doubled[2]) == (0.5, 0.0)
    for (name, zero, _), value in ((cubed, 3 + 3**3 - 2), (doubled, 2 * 3 - 2)):
        assert eval(zero, {}, {name: 3, "x": 2}) == value
    assert eval(text.expr, {}, {cubed[0]: 3, doubled[0]: 5}) == 3 + 10 * 5


def at(pool: Pool, expr: Expr, **values: Fraction) -> float:
    """What SymPy makes of the text of an expression, at numbers."""
    found = read(parsable(pool, expr, Names(list(values))))
    return float(found.subs({sympy.Symbol(n): sympy.Rational(v) for n, v in values.items()}))


@pytest.mark.parametrize(
    ("x", "value"),
    [(-3, 2), (-1, 2), (0, 3), (Fraction(1, 2), Fraction(7, 2)), (1, 4), (2, -2), (3, -8), (4, -8)],
)
def test_a_table_is_straight_between_its_points_and_stays_at_its_ends(
    x: Fraction, value: Fraction
) -> None:
    pool = Pool()
    pool.tables["t"] = tuple((Fraction(a), Fraction(b)) for a, b in ((-1, 2), (1, 4), (3, -8)))
    table = pool.fn("table:t", pool.symbol("x", Kind.SENSOR))
    assert at(pool, table, x=Fraction(x)) == float(value)


#: z at x = 1, 3 and y = 10, 20: by hand z(2, 15) = (5 + 7 + 9 + 15)/4 = 9.
_MAP = ((0, 10, 20), (1, 5, 7), (3, 9, 15))
_FALLS = ((0, 10, 20), (1, 9, 15), (3, 5, 7))


def _map(name: str, rows: tuple[tuple[int, ...], ...]) -> tuple[Pool, Expr, Expr]:
    pool = Pool()
    pool.tables[name] = tuple(tuple(map(Fraction, row)) for row in rows)
    return pool, pool.symbol("x", Kind.SENSOR), pool.symbol("y", Kind.SENSOR)


@pytest.mark.parametrize(
    ("x", "y", "value"),
    [(2, 15, 9), (1, 10, 5), (3, 20, 15), (1, 12, Fraction(27, 5)), (2, 10, 7), (0, 15, 6),
     (9, 15, 12), (2, 0, 7), (2, 90, 11)],
)  # fmt: skip
def test_a_map_is_bilinear(x: int, y: int, value: Fraction) -> None:
    pool, first, second = _map("m", _MAP)
    found = at(pool, pool.fn("table:m", first, second), x=Fraction(x), y=Fraction(y))
    assert found == float(value)


@pytest.mark.parametrize("rows", [_MAP, _FALLS])
@pytest.mark.parametrize("y", [10, 15])
def test_a_map_that_is_read_backwards_gives_back_its_first_input(
    y: int, rows: tuple[tuple[int, ...], ...]
) -> None:
    """Between the ends; at them, where the map stays what it is, no input can be told."""
    pool, value, second = _map("m'", rows)
    backwards = pool.fn("table:m'", value, second)
    (_, low, high) = (row[1] + (row[2] - row[1]) * Fraction(y - 10, 10) for row in rows)
    z = low + (high - low) / 4
    assert at(pool, backwards, x=z, y=Fraction(y)) == 1.5
    for z in (low, high):
        assert isnan(at(pool, backwards, x=Fraction(z), y=Fraction(y)))


def test_a_long_chain_is_linear_and_can_be_parsed() -> None:
    pool, x, a, names = symbols()
    node, expected = x, 2.0
    for _ in range(1500):
        # Each level uses the one before twice: written out it would have 2**1500 terms.
        node = pool.add((Fraction(1, 2), node), (Fraction(1, 4), pool.fn("tanh", node)))
        expected = expected / 2 + sympy.tanh(expected).evalf() / 4
    text = parsable(pool, pool.mul(node, a), names)
    assert sum(len(part) for _, part in text.defs) < 150_000
    assert max(part.count("(") for _, part in text.defs) < 2 * DEEP
    values: dict[str, object] = {"x": 2.0, "w__a": 1.0, "tanh": sympy.tanh}
    for name, part in text.defs:
        values[name] = eval(part, {}, values)
    assert eval(text.expr, {}, values) == pytest.approx(expected, rel=1e-9)


@st.composite
def expressions(draw: st.DrawFn) -> tuple[Pool, Expr]:
    pool = Pool()
    nodes = [pool.symbol(n, Kind.PARAM) for n in ("a", "b", "c")]
    for _ in range(draw(st.integers(1, 12))):
        one, two = draw(st.sampled_from(nodes)), draw(st.sampled_from(nodes))
        c = Fraction(draw(st.integers(-9, 9)), draw(st.integers(1, 9)))
        match draw(st.sampled_from(["add", "mul", "power", "fn"])):
            case "add":
                nodes.append(pool.add((c, one), (1, two), (2, pool.one)))
            case "mul":
                nodes.append(pool.mul(one, two, pool.num(c)))
            case "power":
                exponent = draw(st.sampled_from([-2, -1, 2, 3]))
                if one is not pool.zero:
                    nodes.append(pool.power(one, exponent))
            case _:
                nodes.append(pool.fn(draw(st.sampled_from(["abs", "ssq", "atan"])), one))
    return pool, nodes[-1]


@given(expressions())
def test_the_text_evaluates_like_the_expression(drawn: tuple[Pool, Expr]) -> None:
    import math

    from bondgraph.ir.expr import Op, topological

    pool, expr = drawn
    values = {"a": 0.7, "b": -1.3, "c": 2.1}
    known: dict[Expr, float] = {}
    try:
        for node in topological([expr]):
            args = [known[a] for a in node.args]
            match node.op:
                case Op.NUM:
                    known[node] = float(node.number)
                case Op.SYM:
                    known[node] = values[node.symbol.name]
                case Op.ADD:
                    known[node] = math.fsum(
                        float(c) * v for c, v in zip(node.coefficients, args, strict=True)
                    )
                case Op.MUL:
                    known[node] = math.prod(v**e for v, e in zip(args, node.exponents, strict=True))
                case _:
                    functions = {"abs": abs, "ssq": lambda v: v * abs(v), "atan": math.atan}
                    known[node] = functions[node.name](args[0])
    except (ZeroDivisionError, OverflowError):
        return
    text = parsable(pool, expr, Names(values))
    scope: dict[str, object] = {"Abs": abs, "atan": math.atan, **values}
    for name, part in text.defs:
        scope[name] = eval(part, {}, scope)
    size = max([1.0, *map(abs, known.values())])
    assert eval(text.expr, {}, scope) == pytest.approx(known[expr], abs=1e-9 * size, rel=1e-9)
