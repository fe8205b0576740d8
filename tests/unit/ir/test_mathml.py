"""Formulas in MathML mean what the expressions mean, wherever they are broken."""

from __future__ import annotations

import math
from fractions import Fraction
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.ir.expr import Expr, Kind, Op, Pool, Root, topological
from bondgraph.ir.lettering import letters
from bondgraph.ir.mathml import Box, Typist, atom
from bondgraph.ir.mathml_pieces import pieces
from tests.unit.ir.mathml_reader import AREA, RATE, evaluate

VALUES = {"x": 0.7, "y": -1.3, "R": 2.5, "k": 0.4}
_ONE = {"tanh": math.tanh, "exp": math.exp, "abs": abs, "sin": math.sin,
        "ssq": lambda x: x * abs(x), "sqrt": lambda x: math.sqrt(x), "sign": lambda x: x and
        math.copysign(1, x), "ssqrt": lambda x: math.copysign(math.sqrt(abs(x)), x)}  # fmt: skip


def letter(name: str, dots: int = 0) -> Box:
    xml = f'<mi data-name="{name}">{name}</mi>'
    over = {1: "˙", 2: "¨"}
    return atom(f"<mover>{xml}<mo>{over[dots]}</mo></mover>" if dots else xml, 0.6)


def value(expr: Expr) -> float:
    """The expression as numbers, with D and Int as factors; not a word about MathML."""
    done: dict[Expr, float] = {}
    for n in topological([expr]):
        args = [done[a] for a in n.args]
        match n.op:
            case Op.NUM:
                done[n] = float(n.number)
            case Op.SYM:
                done[n] = VALUES[n.symbol.name]
            case Op.ADD:
                done[n] = sum(float(c) * a for c, a in zip(n.coefficients, args, strict=True))
            case Op.MUL:
                done[n] = math.prod(a**e for a, e in zip(args, n.exponents, strict=True))
            case Op.DER:
                done[n] = RATE * args[0]
            case Op.INT:
                done[n] = AREA * args[0]
            case Op.FN:
                done[n] = _ONE[n.name](args[0])
    return done[expr]


@st.composite
def expressions(draw: st.DrawFn) -> Expr:
    """Sums, products, powers, functions, derivatives and integrals inside each other."""
    p = Pool()
    found = [p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR), p.symbol("R", Kind.PARAM),
             p.symbol("k", Kind.PARAM)]  # fmt: skip
    coefficients = st.fractions(-4, 4, max_denominator=5)
    for _ in range(draw(st.integers(2, 12))):
        a, b, c = (draw(st.sampled_from(found)) for _ in range(3))
        match draw(st.sampled_from("+++**/dif^")):
            case "+":
                made = p.add((draw(coefficients), a), (draw(coefficients), b), (1, c))
            case "*":
                made = p.mul(a, b, p.power(c, draw(st.integers(1, 3))))
            case "/":
                made = a if b is p.zero else p.div(a, b)
            case "d":
                made = p.der(a)
            case "i":
                made = p.integral(a, p.symbol("0", Kind.INITIAL))
            case "f":
                made = p.fn(draw(st.sampled_from(sorted(_ONE))), a)
            case _:
                made = p.power(p.add((1, a), (2, b)), draw(st.sampled_from([2, 3])))
        found.append(made)
    return found[-1]


@settings(max_examples=120)
@given(expressions(), st.sampled_from([1.0, 4.0, 9.0, 1000.0]))
def test_what_is_read_is_what_is_meant(expr: Expr, room: float) -> None:
    try:
        wanted = value(expr)
        scale = max((abs(value(n)) for n in topological([expr])), default=1.0)
    except (ArithmeticError, ValueError, TypeError):
        return  # a root of something negative, a division by zero
    if not 1e-6 < scale < 1e9 or isinstance(wanted, complex):
        return
    read = evaluate(pieces(Typist(letter), expr, room), VALUES)
    assert read == pytest.approx(wanted, rel=1e-5, abs=1e-6 * scale)


def test_a_long_sum_is_broken_and_a_short_one_is_not() -> None:
    p = Pool()
    terms = [p.mul(p.symbol(f"a{k}", Kind.PARAM), p.symbol("x", Kind.SENSOR)) for k in range(9)]
    total = p.add(*[(1, t) for t in terms])
    assert len(pieces(Typist(letter), total, 100)) == 1
    broken = pieces(Typist(letter), total, 4)
    assert len(broken) == 9
    below = p.div(total, p.symbol("R", Kind.PARAM))
    assert "mfrac" in pieces(Typist(letter), below, 4)[0]  # 1/R ( ... )


def test_named_parts_stand_for_themselves_and_are_set_on_their_own_line() -> None:
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    part = p.add((1, x), (2, y))
    whole = p.mul(part, p.der(part))
    typist = Typist(letter, {part: "s"})
    assert evaluate([typist.box(whole).xml], {"s": 3.0}) == pytest.approx(3 * RATE * 3)
    assert evaluate([typist.box(part, own=True).xml], VALUES) == pytest.approx(value(part))


def test_a_number_without_a_formula_is_told_by_its_equation() -> None:
    p = Pool()
    u, c = p.symbol("u", Kind.UNKNOWN), p.symbol("c", Kind.UNKNOWN)
    root = Root("R", p.sub(p.add((1, u), (1, p.power(u, 3))), c), u, (c,), u, True, Fraction(0))
    node = p.root(root, p.symbol("x", Kind.SENSOR))
    typist = Typist(letter)
    assert evaluate([typist.box(node).xml], VALUES) == VALUES["R"]
    inner = pieces(typist.inside(node), root.zero, 100)
    assert evaluate(inner, VALUES) == pytest.approx(2.5 + 2.5**3 - 0.7)


def test_cases_conditions_and_odd_names_are_well_formed() -> None:
    p = Pool()
    x, odd = p.symbol("x", Kind.SENSOR), p.symbol("a<b&c", Kind.PARAM)
    either = p.logic("or", p.compare("<", x, p.one), p.logic("not", p.compare("==", x, p.zero)))
    expr = p.choose(either, p.fn("table:t1", x), p.add((1, p.der(p.der(p.der(x)))), (1, odd)))

    def escaped(name: str, dots: int) -> Box:
        return letter(name.replace("&", "&amp;").replace("<", "&lt;"), dots)

    for room in (1.0, 100.0):
        text = "".join(pieces(Typist(escaped), expr, room))
        ElementTree.fromstring(f"<math>{text.replace('&#x2061;', '')}</math>")


NAMES = st.lists(
    st.lists(st.sampled_from(["a", "b[1]", "b[2]", "el", "R"]), min_size=1, max_size=4),
    min_size=1,
    max_size=12,
)


@given(NAMES)
def test_no_two_names_get_the_same_letter(paths: list[list[str]]) -> None:
    names = dict.fromkeys(".".join(p) for p in paths)
    assert len(set(letters(names).values())) == len(names)
