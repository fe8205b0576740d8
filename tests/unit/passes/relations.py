"""Compare relations with formulas derived by hand, at signals that are no solution of anything."""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

from bondgraph.compilation import Compilation
from bondgraph.text.source import Source
from bondgraph.views import Relation

t = sp.Symbol("t", real=True)

#: Three sets of motions, as many as a common ratio needs to be no accident; the first four are for
#: most relations, the others for those of more signals.
_MOTIONS = [
    [2 - 3 * t + t**2 / 2 + t**3, 1 + t / 3 - 2 * t**2, 3 + t**4 / 5 - t, t**3 / 7 + 2 * t - 1,
     1 + t, 2 - t**2, 3 * t - t**3, 1 - t / 4 + t**2, 2 + t**3 / 3, t - 5],
    [1 + t**2 - t**4 / 7, 3 - t + t**3 / 4, 1 / sp.Integer(3) + t**2, t - 4 + t**5 / 9,
     t**2 - 3, 1 + 2 * t, 2 - t / 5, t**3 + 1, 4 - t, 1 + t**2 / 6],
    [t - t**3 + 4, t / 2 + t**2 - 1, 5 * t - t**4, 2 + t + t**2 / 3,
     3 - t**2, t + 7, 1 - t**3, 2 * t - 3, t**2 + t, 5 - t / 2],
]  # fmt: skip
_AT = sp.Rational(2, 5)


def compiled(text: str) -> Compilation:
    """A compilation of a model given as text (without its first line)."""
    return Compilation(Source("model.bg", "bg 1\n" + text))


def value(expr: sp.Expr, params: dict[str, sp.Expr], signals: dict[str, sp.Expr]) -> sp.Expr:
    """A SymPy form of a relation at given parameters and signals."""
    known = {f: signals[f.func.__name__] for f in expr.atoms(sp.core.function.AppliedUndef)}
    named = {s: params[s.name] for s in expr.free_symbols if s.name in params}
    given = expr.subs(named).subs(known).replace(_is(sp.Derivative), lambda d: d.doit())
    return sp.N(given.replace(_is(sp.Integral), integral).doit().subs(t, _AT), 40)


def integral(node: sp.Expr) -> sp.Expr:
    """An integral as it is: of fractions a number at the time of comparison, else in closed form.

    SymPy has closed forms for fractions, with roots of polynomials that take all digits away.
    """
    inside = node.function
    if inside.is_rational_function(t) and not inside.is_polynomial(t):
        return sp.N(node.subs(t, _AT), 40)
    return node.doit()


def _is(kind: type) -> Callable[[object], bool]:
    return lambda node: isinstance(node, kind)


def is_multiple(
    relation: Relation,
    by_hand: Callable[..., sp.Expr],
    params: dict[str, sp.Expr],
    signals: tuple[str, ...],
) -> bool:
    """Whether a relation is a constant, not zero, times `by_hand(**params, **signals)`."""
    ratios = []
    for motions in _MOTIONS:
        given = dict(zip(signals, motions, strict=False))
        hand = sp.N(sp.sympify(by_hand(**params, **given)).subs(params).subs(t, _AT), 40)
        ratios.append(value(relation.expr, params, given) / hand)
    return abs(ratios[0]) > 1e-15 and all(abs(r / ratios[0] - 1) < 1e-25 for r in ratios)
