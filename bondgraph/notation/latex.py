r"""Expressions in LaTeX: fractions, dots for derivatives, a dotted path as a superscript."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType

from bondgraph.ir.expr import Expr, Symbol
from bondgraph.notation.formula import Reader
from bondgraph.notation.lettering import GREEK, split_name
from bondgraph.notation.speller import Spelled
from bondgraph.notation.typeset import Typeset, spoken

_COMMANDS = {sign: "\\" + word for word, sign in GREEK.items()}
_FUNCTIONS = frozenset(
    "exp ln sin cos tan arcsin arccos arctan sinh cosh tanh min max".split()
)  # that are commands of LaTeX


def latex(expr: Expr, starts: Mapping[Symbol, Expr] = MappingProxyType({})) -> str:
    r"""The expression in LaTeX, nested as it is; `starts` as for a `Reader`.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> latex(p.add((1, y), (-2, p.div(p.der(y), R))))
    'y - 2 \\frac{\\dot{y}}{R}'
    """
    return Latex(letter).spell(Reader({}, starts).of(expr)).text


def letter(name: str, dots: int = 0) -> Spelled:
    r"""A name of the model as mathematics, under dots for derivatives.

    >>> [letter(name).text for name in ("m[1].el.Re", "tau0", "Uin", "leak")]
    ['R_{e}^{m_1.el}', '\\tau_{0}', 'U_{in}', '\\mathit{leak}']
    """
    base, below = split_name(name)
    text = _COMMANDS.get(base) or (base if len(base) == 1 else rf"\mathit{{{_safe(base)}}}")
    if below:
        text += f"_{{{_safe(below)}}}"
    if path := name.rpartition(".")[0]:
        text += f"^{{{_safe(path)}}}"
    return Spelled(rf"\{'d' * dots}ot{{{text}}}" if dots else text, width=0.6 * len(base))


def _safe(name: str) -> str:
    escaped = name.replace("_", r"\_")
    plain = re.sub(r"\[(\d)\]", r"_\1", escaped)
    return re.sub(r"\[([\d,]+)\]", r"_{\1}", plain)


class Latex(Typeset):
    """LaTeX with the signs of amsmath."""

    times = " "
    power = "{{{}}}^{{{}}}"
    bracket = r"\left({}\right)"
    words = MappingProxyType({
        "fraction": r"\frac{{{}}}{{{}}}", "1e": "10^{{{0}}}", "e": r"{1} \cdot 10^{{{0}}}",
        "dash": "-", "times": r" \, ", "pow": "{{{}}}^{{{}}}", "prime": "{{{}}}^{{({})}}",
        "d/dt": r"\frac{{d}}{{dt}}", "dn/dtn": r"\frac{{d^{{{0}}}}}{{dt^{{{0}}}}}",
        "area": r"\int_0^t {}\,dt", "root": r"\underset{{{1} = 0}}{{{0}}}",
        "cases": r"\begin{{cases}} {1} & \text{{if }} {0} \\ {2} & \text{{else}} \end{{cases}}",
        "seconds": r"{}\,\mathrm{{s}}", "call": r"{}\left({}\right)", ",": ", ",
        "abs": r"\left|{}\right|",
        "sqrt": r"\sqrt{{{}}}", "cbrt": r"\sqrt[3]{{{}}}", "<": " < ", "<=": r" \le ",
        "==": " = ", "and": r" \land ", "or": r" \lor ", "not": r"\lnot ",
    })  # fmt: skip

    def called(self, name: str) -> str:
        """A command where LaTeX has one."""
        called = spoken(name)
        return f"\\{called}" if called in _FUNCTIONS else rf"\mathrm{{{_safe(called)}}}"
