"""Solutions put back into their equations, at numbers."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from bondgraph.algebra.affine import affine, rest
from bondgraph.algebra.solve import solve
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological

NUMBERS = {"R": 3.0, "k": 0.7, "f": 0.4, "g": -1.3, "c": 2.5}
FUNCTIONS = {
    "ssq": lambda x: x * abs(x),
    "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x),
    "cbrt": lambda x: math.copysign(abs(x) ** (1 / 3), x),
    "abs": abs,
    "sqrt": math.sqrt,
    "exp": math.exp,
    "log": math.log,
    "tanh": math.tanh,
    "atanh": math.atanh,
    "sinh": math.sinh,
    "asinh": math.asinh,
    "atan": math.atan,
    "tan": math.tan,
    "pow": pow,
}


def evaluate(expr: Expr, numbers: dict[str, float]) -> float:
    values: dict[Expr, float] = {}
    for node in topological([expr]):
        args = [values[a] for a in node.args]
        match node.op:
            case Op.NUM:
                values[node] = float(node.number)
            case Op.SYM:
                values[node] = numbers[node.symbol.name]
            case Op.ADD:
                terms = zip(node.coefficients, args, strict=True)
                values[node] = sum(float(c) * a for c, a in terms)
            case Op.MUL:
                factors = zip(args, node.exponents, strict=True)
                values[node] = math.prod(a**e for a, e in factors)
            case Op.FN:
                values[node] = FUNCTIONS[node.name](*args)
            case _:
                raise AssertionError(node.op)
    return values[expr]


@pytest.fixture
def pool() -> Pool:
    return Pool()


def symbols(pool: Pool) -> dict[str, Expr]:
    kinds = {"R": Kind.PARAM, "k": Kind.PARAM, "c": Kind.PARAM, "f": Kind.FLOW, "g": Kind.SENSOR}
    return {name: pool.symbol(name, kind) for name, kind in kinds.items()}


def laws(p: Pool, s: dict[str, Expr]) -> dict[str, tuple[Expr, bool]]:
    """What the equation says g is, in f; and whether inverting it is hard."""
    R, k, c, f = s["R"], s["k"], s["c"], s["f"]
    return {
        "linear": (p.mul(R, f), False),
        "offset": (p.add((2, p.mul(R, f)), (-1, c)), False),
        "negative": (p.add((-1, p.mul(R, f))), False),
        "reciprocal": (p.div(R, f), True),
        "quadratic drag": (p.mul(k, f, p.fn("abs", f)), True),
        "orifice": (p.mul(k, p.fn("ssqrt", p.add((1, f), (3, c)))), True),
        "diode": (p.mul(k, p.add((1, p.fn("exp", p.div(f, c))), (-1, p.one))), True),
        "cubic": (p.add((1, p.mul(k, p.power(f, 3))), (1, c)), True),
        "friction": (p.mul(c, p.fn("tanh", p.mul(k, f))), True),
        "gas": (p.mul(k, p.fn("pow", p.div(c, p.sub(c, f)), p.num(Fraction(13, 10)))), True),
        "gas of any exponent": (p.mul(c, p.fn("pow", p.add((1, f), (1, c)), p.neg(R))), True),
        "rational": (p.div(p.mul(k, f), p.add((1, p.one), (1, f))), True),
        "twice": (p.add((1, p.mul(R, f)), (1, p.mul(k, p.add((1, f), (1, c))))), False),
    }


NAMES = list(laws(q := Pool(), symbols(q)))


@pytest.mark.parametrize("name", NAMES)
def test_solution_satisfies_the_equation(pool: Pool, name: str) -> None:
    s = symbols(pool)
    value, hard = laws(pool, s)[name]
    found = solve(pool, pool.sub(s["g"], value), s["f"])
    assert found is not None
    assert found.hard == hard
    # choose f, let the law give g, and ask the solution for f again
    g = evaluate(value, NUMBERS)
    assert evaluate(found.value, {**NUMBERS, "g": g}) == pytest.approx(NUMBERS["f"], rel=1e-9)


def test_what_has_two_solutions_has_none(pool: Pool) -> None:
    s = symbols(pool)
    f, g, k = s["f"], s["g"], s["k"]
    for value in (
        pool.power(f, 2),
        pool.fn("abs", f),
        pool.fn("cosh", f),
        pool.add((1, f), (1, pool.mul(k, f, f))),
        pool.mul(f, pool.fn("exp", f)),
        pool.fn("sin", f),
        pool.fn("pow", f, f),
    ):
        assert solve(pool, pool.sub(g, value), f) is None


@pytest.mark.parametrize("values", [(1, 3, 2), (-3, -1, -2), (0, 2, 2), (5, 1, 2)])
def test_a_table_that_turns_back_has_no_inverse(pool: Pool, values: tuple[int, ...]) -> None:
    s = symbols(pool)
    pool.tables["curve"] = tuple((Fraction(x), Fraction(y)) for x, y in enumerate(values))
    assert solve(pool, pool.sub(s["g"], pool.fn("table:curve", s["f"])), s["f"]) is None


@pytest.mark.parametrize("values", [(-2, -1, 3), (3, 1, -2)])
def test_a_table_that_goes_one_way_is_read_backwards(pool: Pool, values: tuple[int, ...]) -> None:
    s = symbols(pool)
    pool.tables["curve"] = tuple((Fraction(x), Fraction(y)) for x, y in enumerate(values))
    found = solve(pool, pool.sub(s["g"], pool.fn("table:curve", s["f"])), s["f"])
    assert found is not None and found.value.args == (s["g"],)
    backwards = pool.tables[found.value.name.removeprefix("table:")]
    assert backwards == tuple(sorted((y, x) for x, y in pool.tables["curve"]))


def test_never_divides_by_what_a_mode_may_make_zero(pool: Pool) -> None:
    s = symbols(pool)
    on = pool.symbol("on", Kind.MODE)
    for slope in (on, pool.choose(on, s["R"], pool.zero), pool.sub(pool.one, on)):
        assert solve(pool, pool.sub(s["g"], pool.mul(slope, s["f"])), s["f"]) is None


def test_affine_splits_exactly(pool: Pool) -> None:
    s = symbols(pool)
    expr = pool.add((Fraction(1, 3), pool.mul(s["R"], s["f"])), (2, s["f"]), (-1, s["c"]))
    parts = affine(pool, expr, s["f"])
    assert parts is not None
    slope, left = (evaluate(p, NUMBERS) for p in parts)
    assert slope * 0.4 + left == pytest.approx(evaluate(expr, NUMBERS))
    assert affine(pool, pool.power(s["f"], 2), s["f"]) is None
    assert affine(pool, s["c"], s["f"]) == (pool.zero, s["c"])


def test_what_is_left_of_a_linear_equation(pool: Pool) -> None:
    s = symbols(pool)
    f, g, c = s["f"], s["g"], s["c"]
    logs = pool.sub(pool.fn("log", pool.mul(s["R"], f)), pool.fn("log", pool.mul(s["k"], f)))
    assert rest(pool, pool.add((2, f), (3, g), (1, c)), [f, g]) is c
    assert rest(pool, pool.add((2, f), (1, logs)), [f]) is None  # though its slope is 2
    assert rest(pool, pool.mul(f, g), [f, g]) is None


def test_a_reciprocal_is_never_zero(pool: Pool) -> None:
    x, k = pool.symbol("x", Kind.FLOW), pool.symbol("k", Kind.PARAM)
    assert solve(pool, pool.div(k, x), x) is None
    assert solve(pool, pool.sub(pool.div(k, x), pool.one), x) is not None


def test_a_power_is_undone_where_its_exponent_is_known_not_to_be_zero(pool: Pool) -> None:
    s = symbols(pool)
    f, g, c = s["f"], s["g"], s["c"]
    on = pool.symbol("on", Kind.MODE)

    def root(base: Expr, exponent: Expr) -> Expr | None:
        found = solve(pool, pool.sub(g, pool.fn("pow", base, exponent)), f)
        return None if found is None else found.value

    assert root(f, c) is pool.fn("pow", g, pool.power(c, -1))
    assert root(f, on) is None  # off, the exponent is zero
    assert root(c, f) is None  # a logarithm would be needed
    assert root(c, pool.scale(2, f)) is None
