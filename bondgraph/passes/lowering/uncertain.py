"""By how much the tolerances of parameters can move a residual: first and second order signals.

With theta_i = n_i (1 + d_i), |d_i| <= delta_i, a residual that is affine in each parameter departs
from the nominal one by sum_i w_i, w_i = d_i n_i dr/dtheta_i: the multiplicative (LFT) form of an
uncertain element (Djeziri, Merzouki and Ould Bouamama, 2007). Products of uncertain parameters
and quotients have terms of second order besides, which are signals of their own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

from bondgraph.algebra.sensitivity import sensitivity
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.graph import Value
from bondgraph.ir.normal import Term
from bondgraph.passes.lowering.builder import Builder
from bondgraph.text.tuples import NamedTuple

_FEW = 5  # parameters up to which derivatives of third order are looked at one by one
_NEAR_ZERO = Fraction(9, 10)  # of a parameter in a denominator: further off it has no bound


class Share(NamedTuple):
    """A signal whose amount is a part of the threshold, and the parameters that it is due to."""

    parameters: tuple[str, ...]
    expr: Expr


def shares(builder: Builder, terms: Sequence[Term], most: int) -> list[Share] | None:
    """The uncertain signals of a residual with these terms, weights of the tolerances included.

    The sum of their amounts is exact where no more than two uncertain parameters of a term are
    multiplied. Beyond that the terms of second order are `enlarged`. None if there are more than
    `most` signals.
    """
    pool = builder.pool
    uncertain = [v for v in builder.graph.values if v.tolerance]
    keep = {v.symbol: v for v in uncertain}
    expr = builder.resolve([_sum(builder, terms)], keep)[0]
    inside = set(symbols(expr))
    used = [v for v in uncertain if v.symbol in inside]
    starts = builder.graph.initial_values()

    def slopes(of: Expr, values: Sequence[Value]) -> list[Expr]:
        found = sensitivity(pool, of, [v.symbol for v in values], starts)
        return [found[v.symbol] for v in values]

    first = slopes(expr, used)
    second: list[tuple[Value, Value, Expr]] = []
    for at, (value, slope) in enumerate(zip(used, first, strict=True)):
        for other, bend in zip(used[at:], slopes(slope, used[at:]), strict=True):
            if not is_zero(bend):
                second.append((value, other, bend))
        if len(second) + len(used) > most:
            return None
    bent = list(dict.fromkeys(v for one, other, _ in second for v in (one, other)))
    factor = Fraction(1)
    if second and _third(bent, second, slopes):
        divide = {one.name for one, other, _ in second if one is other}
        factor = enlarged(
            [_tolerance(v) for v in bent if v.name not in divide],
            [_tolerance(v) for v in bent if v.name in divide],
        )
    out = [
        Share((v.name,), pool.scale(_tolerance(v), pool.mul(v.symbol, slope)))
        for v, slope in zip(used, first, strict=True)
        if not is_zero(slope)
    ]
    for one, other, bend in second:
        weight = factor * _tolerance(one) * _tolerance(other)
        if one is other:
            weight /= 2
        product = pool.mul(one.symbol, other.symbol, bend)
        out.append(Share((one.name, other.name), pool.scale(weight, product)))
    return out


def enlarged(multiply: Sequence[Fraction], divide: Sequence[Fraction]) -> Fraction:
    """How much larger all from the second order on is than the second order, at most.

    A product of factors 1 + d and 1/(1 - d) has in order n of the d the part h[n], whose ratios
    h[n+1]/h[n] fall (a Polya frequency sequence: Aissen, Schoenberg and Whitney, 1952). Therefore
    what is behind h[2] grows beside it with each further factor, and what holds for all factors
    together does for any term with some of them.

    Once 1/(1 - sum) stood here, which is more wherever there is a third order: three tolerances
    of 30 % were enlarged by ten, and a threshold of five times the residual lets nothing through.

    >>> third = Fraction(3, 10)
    >>> round(float(enlarged([third] * 3, [])), 3), round(float(enlarged([], [third])), 3)
    (1.1, 1.429)
    """
    whole, first, squares = Fraction(1), Fraction(0), Fraction(0)
    for delta in multiply:
        whole, first, squares = whole * (1 + delta), first + delta, squares - delta**2
    for delta in divide:
        capped = min(delta, _NEAR_ZERO)
        whole, first, squares = whole / (1 - capped), first + capped, squares + capped**2
    second = (first**2 + squares) / 2
    return (whole - 1 - first) / second if second else Fraction(1)


def _tolerance(value: Value) -> Fraction:
    assert value.tolerance is not None
    return abs(value.tolerance)


def _third(
    bent: Sequence[Value],
    second: Sequence[tuple[Value, Value, Expr]],
    slopes: Callable[[Expr, Sequence[Value]], list[Expr]],
) -> bool:
    """Whether terms of third order are there."""
    if len(bent) > _FEW:
        return True
    return any(not is_zero(s) for _, _, bend in second for s in slopes(bend, bent))


def _sum(builder: Builder, terms: Sequence[Term]) -> Expr:
    """The terms as one expression."""
    pool = builder.pool
    parts: list[Expr] = []
    for term in terms:
        signal = pool.der(term.atom, term.order)
        for _ in range(-term.order):
            signal = pool.integral(signal, builder.zero_start)
        parts.append(pool.mul(term.coefficient, signal))
    return pool.add(*[(1, p) for p in parts])
