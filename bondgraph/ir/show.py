"""Expressions as one line of text, the way a person would type them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, Symbol

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


def show(
    node: Expr,
    name: Callable[[Expr], str | None] = lambda _: None,
    starts: Mapping[Symbol, Expr] | None = None,
) -> str:
    """The expression as text.

    `name` may give a name to a node, which then stands for it; `starts` are the values from which
    integrals begin (an integral that begins at zero does not say so).

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); x = p.symbol("x", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> show(p.add((1, x), (-2, p.div(p.der(x), R))))
    'x - 2*D(x)/R'
    """
    return _Printer(name, starts or {}).text(node)[0]


def _wrap(item: tuple[str, int], level: int) -> str:
    text, own = item
    return text if own >= level else f"({text})"


def _factor(text: str) -> str:
    return f"({text})" if "/" in text else text


class _Printer:
    """Texts with the level at which they bind."""

    def __init__(self, name: Callable[[Expr], str | None], starts: Mapping[Symbol, Expr]) -> None:
        self.name = name
        self.starts = starts

    def text(self, node: Expr) -> tuple[str, int]:
        given = self.name(node)
        if given is not None:
            return given, _ATOM
        match node.op:
            case Op.NUM:
                text = number(node.number)
                return text, _UNARY if text[0] == "-" else _PRODUCT if "/" in text else _ATOM
            case Op.SYM:
                return node.symbol.name, _ATOM
            case Op.ADD:
                return self.sum(node)
            case Op.MUL:
                return self.product(Fraction(1), node), _PRODUCT
            case Op.DER:
                return self.derivative(node), _ATOM
            case Op.INT:
                return self.integral(node), _ATOM
            case Op.CMP:
                left, right = (_wrap(self.text(a), _SUM) for a in node.args)
                return f"{left} {node.name} {right}", _SUM
            case Op.LOGIC:
                parts = [f"({self.text(a)[0]})" for a in node.args]
                text = f"not {parts[0]}" if node.name == "not" else f" {node.name} ".join(parts)
                return text, _SUM
            case Op.ROOT:
                return self.root(node), _ATOM
            case Op.FN | Op.IF:
                called = "if" if node.op is Op.IF else node.name
                return f"{called}({', '.join(self.text(a)[0] for a in node.args)})", _ATOM

    def root(self, node: Expr) -> str:
        """`root(x, zero)`: the x at which the second vanishes."""
        root = node.root
        inside: dict[Expr, tuple[str, int]] = {root.unknown: (root.name, _ATOM)}
        inside.update(zip(root.places, map(self.text, node.args), strict=True))
        inner = _Printer(lambda n: _wrap(inside[n], _ATOM) if n in inside else None, self.starts)
        return f"root({root.name}, {inner.text(root.zero)[0]})"

    def derivative(self, node: Expr) -> str:
        inner, order = node, 0
        while inner.op is Op.DER and self.name(inner) is None:
            inner, order = inner.args[0], order + 1
        text = self.text(inner)[0]
        return f"D({text})" if order == 1 else f"D({text}, {order})"

    def integral(self, node: Expr) -> str:
        start = self.starts.get(node.symbol)
        text = self.text(node.args[0])[0]
        if start is None:
            return f"Int({text}, {node.symbol.name})"
        begins = self.text(start)[0]
        return f"Int({text})" if begins == "0" else f"Int({text}, {begins})"

    def sum(self, node: Expr) -> tuple[str, int]:
        terms = list(zip(node.coefficients, node.args, strict=True))
        terms.sort(key=lambda t: t[0] < 0)  # a person writes the positive terms first
        out = ""
        for c, arg in terms:
            size = abs(c)
            if arg.op is Op.NUM:
                text = number(size * arg.number)
            elif arg.op is Op.MUL and self.name(arg) is None:
                text = self.product(size, arg)
            elif size == 1:
                text = _wrap(self.text(arg), _PRODUCT)
            elif size.numerator == 1:
                text = f"{_wrap(self.text(arg), _PRODUCT)}/{size.denominator}"
            else:
                text = f"{_factor(number(size))}*{_wrap(self.text(arg), _PRODUCT)}"
            if not out:
                out = f"-{text}" if c < 0 else text
            else:
                out += f" - {text}" if c < 0 else f" + {text}"
        return out, _SUM if len(terms) > 1 else _UNARY if terms[0][0] < 0 else _PRODUCT

    def product(self, coefficient: Fraction, node: Expr) -> str:
        above: list[str] = []
        below: list[str] = []
        if coefficient.numerator != 1 or coefficient.denominator not in (1, 2, 3, 4, 5, 6, 8, 12):
            above.append(_factor(number(coefficient)))
        elif coefficient.denominator != 1:
            below.append(str(coefficient.denominator))
        for base, exponent in zip(node.args, node.exponents, strict=True):
            text = _wrap(self.text(base), _POWER if abs(exponent) == 1 else _ATOM)
            power = text if abs(exponent) == 1 else f"{text}^{abs(exponent)}"
            (above if exponent > 0 else below).append(power)
        text = "*".join(above) or "1"
        if below:
            text += "/" + (below[0] if len(below) == 1 else f"({'*'.join(below)})")
        return text
