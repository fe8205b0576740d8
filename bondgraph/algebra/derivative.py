"""Exact time derivatives of any order of expressions of known signals, by recurrences (jets).

The k-th derivative of a node is made from lower ones of what the node rests on: a product by
Leibniz' rule, a reciprocal y = 1/b from b y = 1, a function y = f(u) from y' = f'(u) u', where the
slope f'(u) is a node like any other. Each pair of node and order is made once, so that a node costs
O(k**2) and a chain of n laws O(n k**2), where repeated differentiation costs 2**k.

Parameters are constant in time. `if`, `abs`, `min`, `max` and tables are differentiated piece by
piece; a jump of a mode or of a sign has no derivative and contributes nothing.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from fractions import Fraction
from itertools import pairwise
from math import comb
from typing import TypeAlias

from bondgraph.algebra.interpolation import interpolation
from bondgraph.ir.expr import CONSTANTS, RATIONAL, Expr, Kind, Op, Pool, topological
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.tables import ROUNDING, backwards, columns, knots

#: A node and the order of its derivative.
_Key: TypeAlias = tuple[Expr, int]

#: A rule asks for the derivatives that it needs, one by one, and returns its own.
_Rule: TypeAlias = Generator[_Key, Expr, Expr]


class TooManyOperations(Exception):
    """The derivative is larger than allowed."""


def differentiate(pool: Pool, expr: Expr, times: int = 1) -> Expr:
    """D(expr, times), with D on known signals (and on what stands under no other rule) only."""
    return Jets(pool).of(expr, times)


class Jets:
    """Derivatives of the expressions of a pool; what was made for one serves all."""

    def __init__(self, pool: Pool) -> None:
        self.pool = pool
        self._made: dict[_Key, Expr] = {}

    def of(self, expr: Expr, order: int = 0, limit: int | None = None) -> Expr:
        """D(expr, order), with every derivative inside moved inwards to the known signals.

        Raises `TooManyOperations` once more than `limit` new nodes were made on the way.
        """
        end = None if limit is None else len(self.pool) + limit
        made = self._made
        goal = (expr, order)
        waiting: list[tuple[_Key, _Rule]] = []
        if goal not in made:
            waiting.append((goal, self._rule(*goal)))
        answer: Expr | None = None
        while waiting:  # not a recursion: a chain may be thousands of nodes deep
            key, rule = waiting[-1]
            try:
                wanted = next(rule) if answer is None else rule.send(answer)
            except StopIteration as stop:
                waiting.pop()
                answer = made[key] = stop.value
                if end is not None and len(self.pool) > end:
                    raise TooManyOperations from None
                continue
            answer = made.get(wanted)
            if answer is None:
                waiting.append((wanted, self._rule(*wanted)))
        return made[goal]

    # --------------------------------------------------------------- rules

    def _rule(self, node: Expr, order: int) -> _Rule:
        if node.op is Op.DER:
            return self._same(node.args[0], order + 1)
        if order == 0:
            return self._inside(node)
        match node.op:
            case Op.NUM | Op.CMP | Op.LOGIC:
                return self._zero()
            case Op.SYM:
                return self._signal(node, order)
            case Op.INT:
                return self._same(node.args[0], order - 1)
            case Op.ADD:
                return self._sum(node, order)
            case Op.MUL:
                return self._product(node, order)
            case Op.IF:
                condition, yes, no = node.args
                return self._choice(condition, yes, no, order)
            case Op.FN:
                return self._function(node, order)
            case Op.ROOT:
                return self._root(node, order)

    def _same(self, node: Expr, order: int) -> _Rule:
        return (yield node, order)

    def _inside(self, node: Expr) -> _Rule:
        args = []
        for a in node.args:
            args.append((yield a, 0))
        return self.pool.rebuild(node, tuple(args))

    def _zero(self) -> _Rule:
        yield from ()
        return self.pool.zero

    def _signal(self, node: Expr, order: int) -> _Rule:
        yield from ()
        if node.symbol.kind in CONSTANTS or node.symbol.kind is Kind.MODE:
            return self.pool.zero
        return self.pool.der(node, order)

    def _sum(self, node: Expr, order: int) -> _Rule:
        terms = []
        for c, a in node.terms:
            terms.append((c, (yield a, order)))
        return self.pool.add(*terms)

    def _choice(self, condition: Expr, yes: Expr, no: Expr, order: int) -> _Rule:
        left = yield yes, order
        right = yield no, order
        return self.pool.choose((yield condition, 0), left, right)

    # ------------------------------------------------------------ products

    def _product(self, node: Expr, order: int) -> _Rule:
        pool = self.pool
        still: list[Expr] = []
        moving: list[tuple[Expr, int]] = []
        slopes: list[Expr] = []
        for a, e in node.factors:
            slope = yield a, 1
            if slope is pool.zero:
                still.append(pool.power((yield a, 0), e))
            else:
                moving.append((a, e))
                slopes.append(slope)
        if not moving:
            return pool.zero
        if order == 1:  # flat, as a person would write it
            factors = []
            for a, e in moving:
                factors.append(((yield a, 0), e))
            return self._slope_of_product(still, factors, slopes)
        if still:
            rest = pool.mul(*[pool.power(a, e) for a, e in moving])
            return pool.mul(*still, (yield rest, order))
        *others, (base, exponent) = moving
        if others:
            left = pool.mul(*[pool.power(a, e) for a, e in others])
            return (yield from self._leibniz(left, pool.power(base, exponent), order))
        if exponent > 0:
            half = exponent // 2
            parts = pool.power(base, half), pool.power(base, exponent - half)
            return (yield from self._leibniz(*parts, order))
        return (yield from self._reciprocal(node, pool.power(base, -exponent), order))

    def _slope_of_product(
        self, still: list[Expr], factors: list[tuple[Expr, int]], slopes: list[Expr]
    ) -> Expr:
        pool = self.pool
        terms = []
        for at, slope in enumerate(slopes):
            rest = [pool.power(a, e - (k == at)) for k, (a, e) in enumerate(factors)]
            terms.append((factors[at][1], pool.mul(*still, *rest, slope)))
        return pool.add(*terms)

    def _leibniz(self, left: Expr, right: Expr, order: int) -> _Rule:
        """(a b)^(k) = sum_i C(k, i) a^(i) b^(k-i)"""
        pool = self.pool
        terms = []
        for i in range(order + 1):
            a = yield left, i
            if a is not pool.zero:
                terms.append((comb(order, i), pool.mul(a, (yield right, order - i))))
        return pool.add(*terms)

    def _reciprocal(self, node: Expr, below: Expr, order: int) -> _Rule:
        """y = 1/b: y^(k) = -y sum_{i>0} C(k, i) b^(i) y^(k-i)"""
        pool = self.pool
        terms = []
        for i in range(1, order + 1):
            b = yield below, i
            if b is not pool.zero:
                terms.append((-comb(order, i), pool.mul(b, (yield node, order - i))))
        return pool.mul((yield node, 0), pool.add(*terms))

    # ----------------------------------------------------------- functions

    def _function(self, node: Expr, order: int) -> _Rule:
        pool, x = self.pool, node.args[0]
        yield x, 1
        if len(node.args) == 1 or node.name.startswith("table:"):
            moving = []
            for at, arg in enumerate(node.args):
                if (yield arg, 1) is not pool.zero:
                    moving.append(at)
            terms = []
            for at in moving:
                slope = _slopes(pool, node)[at]
                terms.append((1, (yield from self._chain(slope, node.args[at], order))))
            return pool.add(*terms)
        y = node.args[1]
        if node.name in ("min", "max"):
            first = pool.compare("<=" if node.name == "min" else ">=", x, y)
            return (yield from self._choice(first, x, y, order))
        if node.name == "atan2":
            square = pool.add((1, pool.power(x, 2)), (1, pool.power(y, 2)))
            turned = pool.sub(pool.mul(y, pool.der(x)), pool.mul(x, pool.der(y)))
            return (yield pool.div(turned, square), order - 1)
        assert node.name == "pow"
        return (yield from self._power(node, x, y, order))

    def _root(self, node: Expr, order: int) -> _Rule:
        """y = root(a): y' = sum_i s_i a_i', by the theorem of the implicit function"""
        terms = []
        for arg, place in zip(node.args, node.root.places, strict=True):
            if (yield arg, 1) is not self.pool.zero:
                slope = root_slope(self.pool, node, place)
                terms.append((1, (yield from self._chain(slope, arg, order))))
        return self.pool.add(*terms)

    def _chain(self, slope: Expr, x: Expr, order: int) -> _Rule:
        """y' = s x': y^(k) = sum_i C(k-1, i) s^(i) x^(k-i)"""
        pool = self.pool
        terms = []
        for i in range(order):
            dx = yield x, order - i
            if dx is not pool.zero:
                terms.append((comb(order - 1, i), pool.mul((yield slope, i), dx)))
        return pool.add(*terms)

    def _power(self, node: Expr, x: Expr, y: Expr, order: int) -> _Rule:
        """x**y: y x**(y-1) x' + x**y log(x) y'"""
        pool = self.pool
        if y.op is Op.NUM and y.number < 0 and order > 1:
            return (yield from self._falling(node, x, y.number, order))
        lowered = pool.fn("pow", x, pool.add(*y.terms, (-1, pool.one)))
        slope = pool.mul(y, lowered)
        base = yield from self._chain(slope, x, order)
        if (yield y, 1) is pool.zero:
            return base
        turned = pool.mul(node, pool.fn("log", x))
        return pool.add((1, base), (1, (yield from self._chain(turned, y, order))))

    def _falling(self, node: Expr, x: Expr, e: Fraction, order: int) -> _Rule:
        """x p' = e p x', for a negative exponent (p has no value at zero in any case)"""
        pool, k = self.pool, order
        terms = []
        for i in range(k):
            dx = yield x, i + 1
            if dx is not pool.zero:
                factor = e * comb(k - 1, i) - (comb(k - 1, i + 1) if i + 1 < k else 0)
                terms.append((factor, pool.mul(dx, (yield node, k - 1 - i))))
        return pool.div(pool.add(*terms), (yield x, 0))


def partial(pool: Pool, expr: Expr, symbol: Expr) -> Expr:
    """The partial derivative of an expression without D and Int with respect to a symbol."""
    slopes: dict[Expr, Expr] = {symbol: pool.one}
    for node in topological([expr]):
        if node is not symbol and any(a in slopes for a in node.args):
            slopes[node] = tangent(pool, node, slopes)
    return slopes.get(expr, pool.zero)


def tangent(pool: Pool, node: Expr, changes: Mapping[Expr, Expr]) -> Expr:
    """How a node of ADD, MUL, FN, IF or ROOT changes with its arguments; see `partials`.

    That of a choice is a choice: on the side that is not taken nothing need have a value.
    """
    if node.op is Op.IF:
        condition, *sides = node.args
        return pool.choose(condition, *[changes.get(a, pool.zero) for a in sides])
    parts = zip(partials(pool, node), node.args, strict=True)
    return pool.add(*[(1, pool.mul(d, changes[a])) for d, a in parts if a in changes])


def root_slope(pool: Pool, node: Expr, place: Expr) -> Expr:
    """The derivative of a root with respect to what stands in one of its places."""
    root = node.root
    own = pool.div(partial(pool, root.zero, place), partial(pool, root.zero, root.unknown))
    mapping = {root.unknown: node, **dict(zip(root.places, node.args, strict=True))}
    return pool.substitute([pool.neg(own)], mapping)[0]


def _table_slopes(pool: Pool, node: Expr) -> list[Expr]:
    """The slopes of a table by its arguments, each a choice by bisection; 0 outside its range.

    Where the table has no value (`opened`) its slope is that lack of a value. A map that is read
    backwards moves with its other input as what it gives has to, to keep the value as it is.
    """
    name, (x, *others) = node.name.removeprefix("table:"), node.args
    rows = pool.tables[name]
    if not others:
        points = [(pool.num(a), pool.num(b)) for a, b in rows]
        return [_slope_of_curve(pool, points, x, node if backwards(name) else None)]
    own = name.rstrip("'")

    def value(first: Expr, second: Expr) -> Expr:
        """What the map itself is; a number at numbers."""
        if first.op is second.op is Op.NUM:
            return pool.num(interpolation(rows)(first.number, second.number))
        exchanged = len(name) - len(own) == 2
        return pool.fn(f"table:{own}", *((second, first) if exchanged else (first, second)))

    knots_x, knots_y = [list(map(pool.num, numbers)) for numbers in knots(rows)]
    first = node if backwards(name) else x
    across = [(y, value(first, y)) for y in knots_y]
    along = [(a, value(a, others[0])) for a in knots_x]
    by_other = _slope_of_curve(pool, across, others[0])
    if not backwards(name):
        return [_slope_of_curve(pool, along, x), by_other]
    falls = columns(rows)[0][0] > columns(rows)[0][1]
    inverse = [(z, a) for a, z in (reversed(along) if falls else along)]
    by_value = _slope_of_curve(pool, inverse, x, node)
    return [by_value, pool.neg(pool.mul(by_other, by_value))]


def _slope_of_curve(
    pool: Pool, points: list[tuple[Expr, Expr]], x: Expr, gap: Expr | None = None
) -> Expr:
    """The slope of what is straight between points; `gap` from its ends on, or zero."""
    edges = [a for a, _ in points]
    pairs = pairwise(points)
    inner = [pool.div(pool.sub(d, b), pool.sub(c, a)) for (a, b), (c, d) in pairs]
    slopes = [pool.zero, *inner, pool.zero]
    if gap is not None:
        slopes[0] = slopes[-1] = gap
        low, high = edges[0], edges[-1]
        edges[0] = pool.add((1 - ROUNDING, low), (ROUNDING, high))
        edges[-1] = pool.add((ROUNDING, low), (1 - ROUNDING, high))

    def pick(low: int, high: int) -> Expr:
        if low == high:
            return slopes[low]
        middle = (low + high) // 2
        return pool.choose(
            pool.compare("<", x, edges[middle]), pick(low, middle), pick(middle + 1, high)
        )

    return pick(0, len(slopes) - 1)


def partials(pool: Pool, node: Expr) -> list[Expr]:
    """The derivatives of a node of ADD, MUL, FN, IF or ROOT with respect to each of its arguments.

    Piece by piece: a jump (of a sign, of a condition) has none and counts as zero.

    >>> from bondgraph.ir.expr import Pool
    >>> p = Pool(); x = p.symbol("x", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> partials(p, p.mul(p.power(R, 2), x))
    [R^2, 2*x*R]
    """
    args = node.args
    match node.op:
        case Op.ADD:
            return [pool.num(c) for c in node.coefficients]
        case Op.MUL:
            pairs = list(zip(args, node.exponents, strict=True))
            return [
                pool.scale(e, pool.mul(*[pool.power(b, f - (b is a)) for b, f in pairs]))
                for a, e in pairs
            ]
        case Op.IF:
            yes, no = (pool.one, pool.zero), (pool.zero, pool.one)
            return [pool.zero, *[pool.choose(args[0], *branch) for branch in (yes, no)]]
        case Op.FN:
            return _slopes(pool, node)
        case Op.ROOT:
            return [root_slope(pool, node, place) for place in node.root.places]
    return [pool.zero for _ in args]


def _slopes(pool: Pool, node: Expr) -> list[Expr]:
    """The derivatives of a function by its arguments."""
    if node.name.startswith("table:"):
        return _table_slopes(pool, node)
    return [slope(pool, node, *node.args) for slope in FUNCTIONS[node.name].slopes]


def operations(roots: Iterable[Expr]) -> int:
    """How many operations the roots take, what they share counted once; D and Int are given."""
    total = 0
    for node in topological(roots, stop=lambda n: n.order != 0):
        if node.op in RATIONAL:
            total += len(node.args)
        elif node.op is Op.ROOT:  # about ten steps of Newton's method
            total += 10 * operations([node.root.zero])
        elif not node.order:
            total += 1
    return total
