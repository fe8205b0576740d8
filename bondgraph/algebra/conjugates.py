"""A variable that is known up to a choice of two, and relations in which the choice is no matter.

x**2 = z has two solutions, and so has cos(x) = z. Either is an element of the field of known
signals with one root added: x = a + b*r with r**2 = d. A relation that holds x is then A + B*r = 0,
and its norm A**2 - B**2*d = 0, the product with its conjugate, holds whichever sign the root has:
the resultant of the relation and the equation of x, of least degree.
"""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from typing import NamedTuple

from bondgraph.algebra.cleared import cleared, divisors
from bondgraph.algebra.powers import powers
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Pool, topological
from bondgraph.ir.nodes import constant, holding

_SWITCHES = 4  # conditions in each of whose positions a relation is looked at by itself


class Element(NamedTuple):
    """rational + root * r."""

    rational: Expr
    root: Expr


class TwoValued(NamedTuple):
    """What is known of a variable: r**2 = `square`, and the value of each node of `values`."""

    variable: Expr
    square: Expr
    values: dict[Expr, Element]


def two_valued(pool: Pool, zero: Expr, variable: Expr) -> TwoValued | None:
    """The variable from an equation that is quadratic in it, in its sine or in its cosine.

    None for any other equation. What is left of the equation must be free of the variable.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y = p.symbol("x", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    >>> two_valued(p, p.sub(y, p.power(x, 2)), x).square
    y
    """
    found = powers(pool, zero, variable, 2)
    if found is not None:
        if len(found) < 3 or is_zero(found[2]):
            return None
        c, b, a = found
        half = pool.scale(Fraction(-1, 2), pool.div(b, a))
        square = pool.sub(pool.power(half, 2), pool.div(c, a))
        return TwoValued(variable, square, {variable: Element(half, pool.one)})
    cosine, sine = pool.fn("cos", variable), pool.fn("sin", variable)
    for own, other, sign in ((cosine, sine, -1), (sine, cosine, 1)):
        if _besides(zero, own, variable):
            continue
        terms = powers(pool, zero, own, 1)
        if terms is None or len(terms) < 2 or is_zero(terms[1]):
            continue
        value = pool.neg(pool.div(terms[0], terms[1]))
        square = pool.sub(pool.one, pool.power(value, 2))
        rate = pool.scale(sign, pool.div(pool.der(value), square))
        rational, root = Element(value, pool.zero), Element(pool.zero, pool.one)
        slope = Element(pool.zero, rate)  # x' = +-y'/r = +-y' r/d
        return TwoValued(variable, square, {own: rational, other: root, pool.der(variable): slope})
    return None


def _besides(expr: Expr, inside: Expr, variable: Expr) -> bool:
    """Whether a variable stands anywhere but inside one node."""
    return variable in topological([expr], stop=lambda n: n is inside)


def norm(pool: Pool, expr: Expr, known: TwoValued) -> Expr | None:
    """The relation without the two-valued variable, for either of its values.

    None where the variable stands where neither value can be told from the other any more: inside
    an integral, or a function that is not even. Signals that it would be divided by are multiplied
    out.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y = p.symbol("x", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    >>> root = two_valued(p, p.sub(y, p.power(x, 2)), x)
    >>> norm(p, p.add((3, p.der(x)), (-1, y)), root)
    y^3 - 2.25*D(y)^2
    """
    try:
        found = _element(pool, expr, known)
    except ZeroDivisionError:  # by what vanishes for both values
        return None
    if found is None:
        return None
    whole = _product(pool, found, known.square, _SWITCHES)
    below = [d for d in divisors(topological([whole])) if not constant(d)]
    return cleared(pool, whole, below)


def _product(pool: Pool, own: Element, square: Expr, switches: int) -> Expr:
    """An element times its conjugate; itself in a position of a switch in which it has no root."""
    if is_zero(own.root):
        return own.rational
    if is_zero(own.rational):  # the root is zero where nothing else can be
        moving = holding([own.root], lambda n: n.kind in KNOWN_SIGNALS)
        return own.root if moving else pool.mul(own.root, square)
    choices = [n for n in topological([own.root]) if n.op is Op.IF] if switches else []
    if choices:
        condition = choices[-1].args[0]
        same = [n for n in topological([*own]) if n.op is Op.IF and n.args[0] is condition]
        with suppress(ZeroDivisionError):  # in a position in which the relation has no value
            yes, no = (
                Element(*pool.substitute([*own], {n: n.args[position] for n in same}))
                for position in (1, 2)
            )
            sides = [_product(pool, side, square, switches - 1) for side in (yes, no)]
            return pool.choose(condition, *sides)
    return pool.sub(pool.power(own.rational, 2), pool.mul(pool.power(own.root, 2), square))


def _element(pool: Pool, expr: Expr, known: TwoValued) -> Element | None:
    """An expression as rational + root * r."""
    values = dict(known.values)
    zero, square = pool.zero, known.square
    for node in topological([expr], stop=values.__contains__):
        inside = [a for a in node.args if a in values]
        if node in values or not inside:
            if node is known.variable and node not in values:
                return None
            continue
        own = [values.get(a) or Element(a, zero) for a in node.args]
        if node.op is Op.ADD:
            weighted = list(zip(node.coefficients, own, strict=True))
            values[node] = Element(
                pool.add(*[(c, part.rational) for c, part in weighted]),
                pool.add(*[(c, part.root) for c, part in weighted]),
            )
        elif node.op is Op.MUL:
            product = Element(pool.one, zero)
            for base, power in zip(own, node.exponents, strict=True):
                factor = base if power > 0 else _inverse(pool, base, square)
                for _ in range(abs(power)):
                    product = _times(pool, product, factor, square)
            values[node] = product
        elif node.op is Op.DER:
            a, b = own[0]
            turned = pool.scale(Fraction(1, 2), pool.div(pool.mul(b, pool.der(square)), square))
            values[node] = Element(pool.der(a), pool.add((1, pool.der(b)), (1, turned)))
        elif node.op is Op.IF and node.args[0] not in values:
            _, yes, no = own
            condition = node.args[0]
            values[node] = Element(
                pool.choose(condition, yes.rational, no.rational),
                pool.choose(condition, yes.root, no.root),
            )
        else:
            return None
    return values.get(expr) or Element(expr, zero)


def _times(pool: Pool, x: Element, y: Element, square: Expr) -> Element:
    mul = pool.mul
    return Element(
        pool.add((1, mul(x.rational, y.rational)), (1, mul(x.root, y.root, square))),
        pool.add((1, mul(x.rational, y.root)), (1, mul(x.root, y.rational))),
    )


def _inverse(pool: Pool, x: Element, square: Expr) -> Element:
    """The conjugate over the norm; ZeroDivisionError of zero."""
    size = pool.sub(pool.power(x.rational, 2), pool.mul(pool.power(x.root, 2), square))
    return Element(pool.div(x.rational, size), pool.neg(pool.div(x.root, size)))
