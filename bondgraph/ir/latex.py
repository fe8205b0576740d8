r"""Expressions in LaTeX: fractions, dots for derivatives, a dotted path as a superscript."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, Symbol, topological

_SUM, _PRODUCT, _ATOM = range(3)
_Power = tuple[tuple[str, int], int]  # a text with its level, and the exponent it gets
_GREEK = frozenset(
    ["alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "kappa", "lambda"]
    + ["mu", "nu", "xi", "rho", "sigma", "tau", "phi", "chi", "psi", "omega"]
)
_NAMED = {"abs": r"\left|%s\right|", "sqrt": r"\sqrt{%s}", "cbrt": r"\sqrt[3]{%s}"}
_PLAIN = frozenset(["exp", "sin", "cos", "tan", "sinh", "cosh", "tanh", "log", "min", "max"])


def letter(name: str) -> str:
    r"""A name of the model as mathematics.

    >>> letter("m[1].el.Re"), letter("tau0"), letter("Uin"), letter("leak")
    ('R_{e}^{m_1.el}', '\\tau_{0}', 'U_{in}', '\\mathit{leak}')
    """
    *path, last = name.split(".")
    base = _base(last)
    if not path:
        return base
    where = ".".join(re.sub(r"\[(\d+)\]", r"_\1", p) for p in path)
    return f"{base}^{{{where}}}"


def _base(name: str) -> str:
    found = re.fullmatch(r"([A-Za-z]+?)(\d*)(?:\[(\d+)\])?", name)
    if found is None:
        escaped = name.replace("_", r"\_")
        return rf"\mathit{{{escaped}}}"
    word, digits, place = found.groups()
    if word.lower() in _GREEK:
        head, rest = "\\" + word, ""
    elif len(word) > 3:  # a word, not a letter with an index
        head, rest = rf"\mathit{{{word}}}", ""
    else:
        head, rest = word[0], word[1:]
    below = ",".join(p for p in (rest + digits, place) if p)
    return f"{head}_{{{below}}}" if below else head


def latex(expr: Expr, starts: Mapping[Symbol, Expr] | None = None) -> str:
    r"""The expression in LaTeX, nested as it is; `starts` as for `show`.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> latex(p.add((1, y), (-2, p.div(p.der(y), R))))
    'y - 2 \\frac{\\dot{y}}{R}'
    """
    begins = starts or {}
    return _nested(expr, {}, begins)[0]


def _nested(
    expr: Expr, given: Mapping[Expr, tuple[str, int]], begins: Mapping[Symbol, Expr]
) -> tuple[str, int]:
    done = dict(given)
    for node in topological([expr, *begins.values()]):
        if node in done:
            continue
        if node.op is Op.INT:
            done[node] = _integral(node, done, begins)
        elif node.op is Op.ROOT:
            done[node] = _root(node, done)
        else:
            done[node] = _tex(node, done)
    return done[expr]


def _root(node: Expr, done: dict[Expr, tuple[str, int]]) -> tuple[str, int]:
    """The unknown, with the equation that it solves below it."""
    root = node.root
    inside = {root.unknown: (letter(root.name), _ATOM)}
    inside.update((p, done[a]) for p, a in zip(root.places, node.args, strict=True))
    zero = _nested(root.zero, inside, {})[0]
    return rf"\underset{{{zero} = 0}}{{{letter(root.name)}}}", _ATOM


def _integral(
    node: Expr, done: dict[Expr, tuple[str, int]], starts: Mapping[Symbol, Expr]
) -> tuple[str, int]:
    area = rf"\int_0^t {_wrap(done[node.args[0]], _PRODUCT)}\,dt"
    start = starts.get(node.symbol)
    begins = letter(node.symbol.name) if start is None else done[start][0]
    return (area if begins == "0" else rf"\left({begins} + {area}\right)"), _PRODUCT


def _wrap(item: tuple[str, int], level: int) -> str:
    return item[0] if item[1] >= level else rf"\left({item[0]}\right)"


def _number(value: Fraction) -> str:
    if value.denominator == 1:
        return str(value.numerator)
    text = repr(float(value))
    if Fraction(text) == value and "e" not in text:
        return text
    return rf"\frac{{{value.numerator}}}{{{value.denominator}}}"


def _tex(node: Expr, done: dict[Expr, tuple[str, int]]) -> tuple[str, int]:
    args = [done[a] for a in node.args]
    match node.op:
        case Op.NUM:
            return _number(node.number), _ATOM if node.number >= 0 else _SUM
        case Op.SYM:
            return letter(node.symbol.name), _ATOM
        case Op.ADD:
            return _sum(node, args)
        case Op.MUL:
            return _product(node, args), _PRODUCT
        case Op.DER:
            return _derivative(node, done), _ATOM
        case Op.FN | Op.INT | Op.ROOT:
            inside = ", ".join(a[0] for a in args)
            if node.name in _NAMED:
                return _NAMED[node.name] % inside, _ATOM
            called = f"\\{node.name}" if node.name in _PLAIN else rf"\mathrm{{{_plain(node.name)}}}"
            return rf"{called}\left({inside}\right)", _ATOM
        case Op.IF:
            rows = rf"{args[1][0]} & \text{{if }} {args[0][0]} \\ {args[2][0]} & \text{{else}}"
            return rf"\begin{{cases}} {rows} \end{{cases}}", _ATOM
        case Op.CMP:
            sign = {"<": "<", "<=": r"\le", "==": "="}[node.name]
            return f"{args[0][0]} {sign} {args[1][0]}", _SUM
        case Op.LOGIC:
            if node.name == "not":
                return rf"\lnot {_wrap(args[0], _ATOM)}", _SUM
            sign = r" \land " if node.name == "and" else r" \lor "
            return sign.join(_wrap(a, _ATOM) for a in args), _SUM


def _plain(name: str) -> str:
    return name.split(":")[0]


def _sum(node: Expr, args: list[tuple[str, int]]) -> tuple[str, int]:
    out = ""
    terms = sorted(zip(node.coefficients, node.args, args, strict=True), key=lambda t: t[0] < 0)
    for c, arg, item in terms:
        size = abs(c)
        if arg.op is Op.NUM:
            text = _number(size * arg.number)
        else:
            text = _wrap(item, _PRODUCT)
            text = text if size == 1 else f"{_number(size)} {text}"
        sign = "-" if c < 0 else "+"
        out = f"{out} {sign} {text}" if out else text if c > 0 else f"-{text}"
    return out, _SUM if len(terms) > 1 or terms[0][0] < 0 else _PRODUCT


def _product(node: Expr, args: list[tuple[str, int]]) -> str:
    above: list[_Power] = []
    below: list[_Power] = []
    for e, item in zip(node.exponents, args, strict=True):
        (above if e > 0 else below).append((item, abs(e)))

    def joined(side: list[_Power]) -> str:
        if len(side) == 1 and side[0][1] == 1:
            return side[0][0][0]
        parts = []
        for item, power in side:
            text = _wrap(item, _PRODUCT if power == 1 else _ATOM)
            parts.append(text if power == 1 else f"{{{text}}}^{{{power}}}")
        return r" \, ".join(parts)

    if not below:
        return joined(above) if len(above) > 1 or above[0][1] > 1 else _wrap(above[0][0], _PRODUCT)
    return rf"\frac{{{joined(above) or '1'}}}{{{joined(below)}}}"


def _derivative(node: Expr, done: dict[Expr, tuple[str, int]]) -> str:
    inner, order = node, 0
    while inner.op is Op.DER:
        inner, order = inner.args[0], order + 1
    if inner.op is Op.SYM and order <= 3:
        return rf"\{'d' * order}ot{{{done[inner][0]}}}"
    power = "" if order == 1 else f"^{{{order}}}"
    return rf"\frac{{d{power}}}{{dt{power}}}\left({done[inner][0]}\right)"
