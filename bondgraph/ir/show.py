"""Expressions as one line of text, the way a person would type them."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from bondgraph.ir.expr import Expr, Op

_SUM, _PRODUCT, _UNARY, _POWER, _ATOM = range(5)


def number(value: Fraction) -> str:
    """A rational as a decimal where that is exact and short, else as a quotient.

    >>> number(Fraction(3, 2)), number(Fraction(1, 3)), number(Fraction(3, 10**4))
    ('1.5', '1/3', '0.0003')
    """
    if value.denominator == 1:
        return str(value.numerator)
    text = repr(float(value))
    return text if Fraction(text) == value else f"{value.numerator}/{value.denominator}"


def show(node: Expr, name: Callable[[Expr], str | None] = lambda _: None) -> str:
    """The expression as text; `name` may give a name to a node, which then stands for it.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); x = p.symbol("x", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> show(p.add((1, x), (-2, p.div(p.der(x), R))))
    'x - 2*D(x)/R'
    """
    return _text(node, name)[0]


def _wrap(item: tuple[str, int], level: int) -> str:
    text, own = item
    return text if own >= level else f"({text})"


def _text(node: Expr, name: Callable[[Expr], str | None]) -> tuple[str, int]:
    given = name(node)
    if given is not None:
        return given, _ATOM
    if node.op is Op.NUM:
        text = number(node.number)
        return text, _UNARY if text[0] == "-" else _PRODUCT if "/" in text else _ATOM
    if node.op is Op.SYM:
        return node.symbol.name, _ATOM
    if node.op is Op.ADD:
        return _sum(node, name)
    if node.op is Op.MUL:
        return _product(Fraction(1), node, name), _PRODUCT
    args = [_text(a, name) for a in node.args]
    if node.op is Op.DER:
        inner, order = node, 0
        while inner.op is Op.DER and name(inner) is None:
            inner, order = inner.args[0], order + 1
        text = _text(inner, name)[0]
        return (f"D({text})" if order == 1 else f"D({text}, {order})"), _ATOM
    if node.op is Op.INT:
        return f"Int({args[0][0]}, {node.symbol.name})", _ATOM
    if node.op is Op.CMP:
        return f"{_wrap(args[0], _SUM)} {node.name} {_wrap(args[1], _SUM)}", _SUM
    if node.op is Op.LOGIC:
        if node.name == "not":
            return f"not ({args[0][0]})", _SUM
        return f" {node.name} ".join(f"({a[0]})" for a in args), _SUM
    called = {Op.IF: "if"}.get(node.op) or node.name
    return f"{called}({', '.join(a[0] for a in args)})", _ATOM


def _sum(node: Expr, name: Callable[[Expr], str | None]) -> tuple[str, int]:
    terms = list(zip(node.coefficients, node.args, strict=True))
    terms.sort(key=lambda t: t[0] < 0)  # a person writes the positive terms first
    out = ""
    for c, arg in terms:
        size = abs(c)
        if arg.op is Op.NUM:
            text = number(size * arg.number)
        elif arg.op is Op.MUL and name(arg) is None:
            text = _product(size, arg, name)
        elif size == 1:
            text = _wrap(_text(arg, name), _PRODUCT)
        elif size.numerator == 1:
            text = f"{_wrap(_text(arg, name), _PRODUCT)}/{size.denominator}"
        else:
            text = f"{_factor(number(size))}*{_wrap(_text(arg, name), _PRODUCT)}"
        if not out:
            out = f"-{text}" if c < 0 else text
        else:
            out += f" - {text}" if c < 0 else f" + {text}"
    return out, _SUM if len(terms) > 1 else _UNARY if terms[0][0] < 0 else _PRODUCT


def _factor(text: str) -> str:
    return f"({text})" if "/" in text else text


def _product(coefficient: Fraction, node: Expr, name: Callable[[Expr], str | None]) -> str:
    above: list[str] = []
    below: list[str] = []
    if coefficient.numerator != 1 or coefficient.denominator not in (1, 2, 3, 4, 5, 6, 8, 12):
        above.append(_factor(number(coefficient)))
    elif coefficient.denominator != 1:
        below.append(str(coefficient.denominator))
    for base, exponent in zip(node.args, node.exponents, strict=True):
        text = _wrap(_text(base, name), _POWER if abs(exponent) == 1 else _ATOM)
        power = text if abs(exponent) == 1 else f"{text}^{abs(exponent)}"
        (above if exponent > 0 else below).append(power)
    text = "*".join(above) or "1"
    if below:
        text += "/" + (below[0] if len(below) == 1 else f"({'*'.join(below)})")
    return text
