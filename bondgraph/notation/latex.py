r"""Expressions in LaTeX: fractions, dots for derivatives, a dotted path in the subscript."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from bondgraph.ir.expr import Expr, Symbol
from bondgraph.notation.formula import Reader
from bondgraph.notation.lettering import GREEK, Letter, indexed, letters, split_name
from bondgraph.notation.speller import Spelled
from bondgraph.notation.typeset import Letters, Typeset, spoken

_COMMANDS = {sign: "\\" + word for word, sign in GREEK.items()}
_DIGITS, _PLAIN = re.compile("[₀-₉,]*[₀-₉]"), str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")
_FUNCTIONS = frozenset(
    "exp ln sin cos tan arcsin arccos arctan sinh cosh tanh min max".split()
)  # that are commands of LaTeX


def latex(
    expr: Expr,
    starts: Mapping[Symbol, Expr] = MappingProxyType({}),
    spelled: Letters | None = None,
) -> str:
    r"""The expression in LaTeX, nested as it is; `starts` as for a `Reader`.

    Names are `spelled` by `lettered`, or with their whole path.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> latex(p.add((1, y), (-2, p.div(p.der(y), R))))
    'y - 2 \\frac{\\dot{y}}{R}'
    """
    return Latex(spelled or letter).spell(Reader({}, starts).of(expr)).text


def lettered(names: Iterable[str]) -> Letters:
    r"""How names of one model are written, no two alike: of a path the fewest parts that do.

    >>> names = lettered(["m[1].el.Re", "m[2].el.Re", "line.R"])
    >>> names("m[1].el.Re", 0).text, names("line.R", 1).text
    ('R_{e,\\mathrm{m_{1}}}', '\\dot{R}')
    """
    found = letters(names)
    return lambda name, dots: _set(found[name], dots) if name in found else letter(name, dots)


def letter(name: str, dots: int = 0) -> Spelled:
    r"""A name of the model as mathematics, under dots for derivatives, with its whole path.

    >>> [letter(name).text for name in ("m[1].el.Re", "tau0", "Uin", "leak")]
    ['R_{e,\\mathrm{m_{1}.el}}', '\\tau_{0}', 'U_{in}', '\\mathit{leak}']
    """
    path = tuple([indexed(part) for part in name.split(".")[:-1]])
    return _set(Letter(*split_name(name), path), dots)


def _set(own: Letter, dots: int) -> Spelled:
    base = own.base if len(own.base) == 1 else rf"\mathit{{{_safe(own.base)}}}"
    text = _COMMANDS.get(own.base) or base
    if dots:
        text = rf"\{'d' * dots}ot{{{text}}}"
    where = rf"\mathrm{{{_safe('.'.join(own.where))}}}" if own.where else ""
    below = ",".join(part for part in (_safe(own.below), where) if part)
    if below:
        text += f"_{{{below}}}"
    return Spelled(text, width=0.6 * len(own.base) + 0.36 * len(own.below))


def _safe(name: str) -> str:
    """A name, with what LaTeX reads as a sign of its own, and indices of arrays."""
    return _DIGITS.sub(lambda m: f"_{{{m[0].translate(_PLAIN)}}}", name.replace("_", r"\_"))


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
