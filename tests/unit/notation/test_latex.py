"""Formulas in LaTeX, one by one."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.ir.expr import Kind, Pool
from bondgraph.notation.latex import latex, letter


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("Re", "R_{e}"),
        ("yaw", r"\mathit{yaw}"),
        ("R_L", "R_{L}"),
        ("omega", r"\omega"),
        ("Omega2", r"\Omega_{2}"),
        ("wheel_left", r"\mathit{wheel\_left}"),
        ("Fx[2]", "F_{x,2}"),
        ("m[12].el.k", r"k_{\mathrm{m_{12}.el}}"),
        ("a[1,2].C", r"C_{\mathrm{a_{1,2}}}"),
        ("my_part.R", r"R_{\mathrm{my\_part}}"),
    ],
)
def test_one_rule_says_what_is_an_index(name: str, text: str) -> None:
    assert letter(name).text == text


def test_signs_of_latex() -> None:
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    third = p.der(p.der(p.der(x)))
    cases = {
        p.scale(Fraction(1, 2), x): r"\frac{1}{2} x",
        p.scale(Fraction(3, 10**9), x): r"3 \cdot 10^{-9} x",
        p.scale(Fraction(1, 10**9), x): "10^{-9} x",
        third: "{x}^{(3)}",
        p.der(p.mul(x, y)): r"\frac{d}{dt}\left(x \, y\right)",
        p.fn("pow", p.add((1, x), (1, y)), p.num(Fraction(1, 5))): r"{\left(x + y\right)}^{0.2}",
        p.power(p.fn("tanh", x), 2): r"{\left(\tanh\left(x\right)\right)}^{2}",
        p.fn("ssq", p.sub(x, y)): r"\left(x - y\right)\left|x - y\right|",
        p.fn("log", p.fn("asin", x)): r"\ln\left(\arcsin\left(x\right)\right)",
        p.fn("table:cell_a.csv", x): r"\mathrm{cell\_a.csv}\left(x\right)",
        p.fn("delay", x, p.num(2)): r"\mathrm{delay}\left(x, 2\,\mathrm{s}\right)",
        p.compare("<=", x, y): r"x \le y",
    }
    assert {latex(e): text for e, text in cases.items()} == {t: t for t in cases.values()}
