"""Decide whether an expression grows or falls with a variable, whatever everything else is.

Interval arithmetic on values and slopes (Moore, 1966; forward mode): signals may be any number,
parameters have their nominal sign. What grows everywhere has one zero at most, and a bracket finds
it. The answer errs towards None.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import reduce
from itertools import pairwise

from bondgraph.algebra.affine import affine
from bondgraph.algebra.numeric import DOUBLES
from bondgraph.algebra.zero import is_zero
from bondgraph.field.evaluation import Evaluated
from bondgraph.ir.expr import CONSTANTS, Expr, Op, Pool, topological
from bondgraph.ir.functions import ALL, FUNCTIONS, POSITIVE, Function, Interval
from bondgraph.ir.tables import Rows, backwards, columns, is_map, knots, turned

_INF = math.inf


ONE = Interval(1.0, 1.0, False, False)
ZERO = Interval(0.0, 0.0, False, False)
_NEGATIVE = Interval(-_INF, 0.0)


def direction(
    pool: Pool, expr: Expr, variable: Expr, number: Callable[[Expr], float | None]
) -> int | None:
    """1 if the expression strictly grows with the variable, -1 if it falls, None if unknown.

    `number` gives the nominal value of a parameter or None. It is enough that a parameter keeps
    its sign; where that does not decide, its nominal value has to.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); f = p.symbol("f", Kind.FLOW); a = p.symbol("a", Kind.PARAM)
    >>> law = p.add((1, p.fn("tanh", p.mul(a, f))), (1, f))
    >>> direction(p, law, f, lambda _: 2.0), direction(p, law, f, lambda _: None)
    (1, None)
    """
    for exact in (False, True):
        found = _sign(slope_range(pool, expr, variable, number, exact))
        if found is not None:
            return found
    return None


def _sign(slope: Interval | None) -> int | None:
    if slope is None:
        return None
    if slope.low > 0 or (slope.low == 0 and slope.open_low):
        return 1
    if slope.high < 0 or (slope.high == 0 and slope.open_high):
        return -1
    return None


def slope_range(
    pool: Pool,
    expr: Expr,
    variable: Expr,
    number: Callable[[Expr], float | None],
    exact: bool = False,
    given: Mapping[Expr, Interval] | None = None,
) -> Interval | None:
    """The slopes that the expression may have; None where it may jump or cannot be followed.

    It jumps where it divides by what may be zero: on either side of such a pole a root may lie.
    """
    given = {variable: _domain(expr, variable), **(given or {})}

    def symbol(node: Expr) -> Interval:
        return _given(node, number, exact) if node.symbol.kind in CONSTANTS else ALL

    point = Evaluated(_RANGES, symbol, given)
    values = point.values([expr])
    slopes: dict[Expr, Interval] = {variable: ONE}
    for node in topological([expr]):
        if node in given or not any(a in slopes for a in node.args):
            continue
        slope = _slope(pool, node, variable, values, slopes)
        if slope is None:
            return None
        slopes[node] = slope
    return slopes.get(expr, ZERO)


def _domain(expr: Expr, variable: Expr) -> Interval:
    """The numbers that the variable may be: positive, where some function needs that throughout."""
    for node in topological([expr], stop=lambda n: n.op is Op.IF):
        own = node.op is Op.FN and node.args[0] is variable
        if own and (node.name == "pow" or _record(node).domain.low == 0):
            return POSITIVE
    return ALL


def _given(node: Expr, number: Callable[[Expr], float | None], exact: bool) -> Interval:
    x = number(node)
    if x is None:
        return ALL
    if exact:
        return Interval(x, x, False, False)
    if not x:
        return ZERO
    return POSITIVE if x > 0 else _NEGATIVE


def _function(node: Expr, args: list[Interval]) -> Interval:
    if node.name == "pow" and args[0].low >= 0:
        return POSITIVE
    record = _record(node)
    return _through(node.name, args[0]) if record.grows else record.values


def _through(name: str, a: Interval) -> Interval:
    """A growing function at the ends of a range."""

    def at(x: float) -> float:
        try:
            return float(DOUBLES[name](x))
        except OverflowError:
            return math.copysign(_INF, x)

    return Interval(at(a.low), at(a.high), a.open_low, a.open_high)


def _slope(
    pool: Pool,
    node: Expr,
    variable: Expr,
    values: Mapping[Expr, Interval],
    slopes: Mapping[Expr, Interval],
) -> Interval | None:
    """The slope of a node from those of its arguments; None where it may jump."""
    args = node.args
    match node.op:
        case Op.ADD:
            terms = zip(node.coefficients, args, strict=True)
            return add(*[scale(float(c), slopes[a]) for c, a in terms if a in slopes])
        case Op.MUL:
            total = ZERO
            for at, (a, e) in enumerate(zip(args, node.exponents, strict=True)):
                if a in slopes:
                    if e < 0 and values[a].low < 0 < values[a].high:
                        return None
                    part = times(scale(e, _raised(a, values[a], e - 1)), slopes[a])
                    for k, (b, f) in enumerate(zip(args, node.exponents, strict=True)):
                        if k != at:
                            part = times(part, _raised(b, values[b], f))
                    total = add(total, part)
            return total
        case Op.FN:
            return _slope_of_function(pool, node, values, slopes)
        case Op.ROOT:
            return _slope_of_root(pool, node, slopes)
        case Op.IF:
            if args[0] in slopes and not _continuous(pool, node, variable):
                return None
            return join(*[slopes.get(a, ZERO) for a in args[1:]])
        case Op.CMP | Op.LOGIC:
            return ZERO  # only the choice that it decides can jump
        case _:
            return None


def _slope_of_function(
    pool: Pool, node: Expr, values: Mapping[Expr, Interval], slopes: Mapping[Expr, Interval]
) -> Interval | None:
    if node.name in ("min", "max"):
        return join(*[slopes.get(a, ZERO) for a in node.args])
    if node.name == "pow" and node.args[1].op is Op.NUM and values[node.args[0]].low >= 0:
        return times(scale(float(node.args[1].number), POSITIVE), slopes[node.args[0]])
    a = node.args[0]
    if node.name == "abs" and values[a].low >= 0:
        return slopes[a]
    if node.name.startswith("table:"):
        ranges = zip(_slopes_of_table(pool, node.name), node.args, strict=True)
        return add(*[times(own, slopes[b]) for own, b in ranges if b in slopes])
    own = _record(node).rates
    return None if own is None else times(own, slopes[a])


def _record(node: Expr) -> Function:
    """What is known of a function; of a table nothing."""
    return FUNCTIONS.get(node.name, Function(()))


def _slopes_of_table(pool: Pool, name: str) -> list[Interval]:
    """Between its points; beyond its ends a table is constant, or has no value: see `opened`."""
    name = name.removeprefix("table:")
    rows, read = pool.tables[name], backwards(name)
    if not is_map(rows):
        return [_steps(rows, 0 if read else 1)]
    other = _steps(turned(rows), 1)
    if not read:
        return [_steps(rows, 1), other]
    own = _steps(rows, -1)
    return [own, scale(-1.0, times(other, own))]


def _steps(rows: Rows, power: int) -> Interval:
    """The slopes of a table along its first input, or those of what undoes it, to the power -1.

    With the power 1 nothing of them is left beyond its ends.
    """
    numbers = knots(rows)[0]
    found = [0.0] if power == 1 else []
    for column in columns(rows):
        steps = zip(pairwise(numbers), pairwise(column), strict=True)
        found += [float(((d - c) / (b - a)) ** (power or 1)) for (a, b), (c, d) in steps]
    return Interval(min(found), max(found), False, False)


def _slope_of_root(pool: Pool, node: Expr, slopes: Mapping[Expr, Interval]) -> Interval | None:
    """By the theorem of the implicit function, with anything in the other places."""
    root = node.root
    own = slope_range(pool, root.zero, root.unknown, lambda _: None)
    # the root was found monotone with the ranges of its own arguments
    below = POSITIVE if root.rising else _NEGATIVE
    if own is not None and _sign(own) is not None:
        below = own
    total = ZERO
    for arg, place in zip(node.args, root.places, strict=True):
        if arg in slopes:
            above = slope_range(pool, root.zero, place, lambda _: None)
            if above is None:
                return None
            total = add(total, times(scale(-1.0, times(above, power(below, -1))), slopes[arg]))
    return total


def _continuous(pool: Pool, node: Expr, variable: Expr) -> bool:
    """Whether a choice does not jump where its comparison changes, as in a dead zone."""
    condition, yes, no = node.args
    if condition.op is not Op.CMP or condition.name == "==":
        return False
    parts = affine(pool, pool.sub(*condition.args), variable)
    if parts is None or is_zero(parts[0]):
        return False
    edge = pool.neg(pool.div(parts[1], parts[0]))
    try:
        return is_zero(pool.substitute([pool.sub(yes, no)], {variable: edge})[0])
    except ZeroDivisionError:
        return False


# ------------------------------------------------------------------------------ arithmetic


def add(*terms: Interval) -> Interval:
    """The sum; a bound is met at single points if that of any term is."""
    if not terms:
        return ZERO
    return Interval(
        sum(t.low for t in terms),
        sum(t.high for t in terms),
        any(t.open_low for t in terms),
        any(t.open_high for t in terms),
    )


def scale(c: float, a: Interval) -> Interval:
    """A number times a range."""
    if not c:
        return ZERO
    low, high = c * a.low, c * a.high
    if c < 0:
        return Interval(high, low, a.open_high, a.open_low)
    return Interval(low, high, a.open_low, a.open_high)


def times(a: Interval, b: Interval) -> Interval:
    """The product."""
    corners = []
    for x, x_open in ((a.low, a.open_low), (a.high, a.open_high)):
        for y, y_open in ((b.low, b.open_low), (b.high, b.open_high)):
            product = 0.0 if not x or not y else x * y
            if product:
                met = not (x_open or y_open)
            else:  # zero is met on a stretch if a factor that is zero is
                met = (not x and not x_open) or (not y and not y_open)
            corners.append((product, met))
    low, high = min(c for c, _ in corners), max(c for c, _ in corners)
    inside = (a.low < 0 < a.high) or (b.low < 0 < b.high)
    return Interval(
        low,
        high,
        not any(met for c, met in corners if c == low) and not (low == 0 and inside),
        not any(met for c, met in corners if c == high) and not (high == 0 and inside),
    )


def power(a: Interval, exponent: int) -> Interval:
    """An integer power; one that is zero inside is so at single points."""
    if exponent == 0:
        return ONE
    if exponent < 0:
        base = power(a, -exponent)
        if base.low >= 0:
            low, high = (1 / x if x else _INF for x in (base.high, base.low))
            return Interval(low, high, base.open_high or not base.high, base.open_low)
        if base.high <= 0:
            return scale(-1.0, power(scale(-1.0, base), -1))
        return ALL
    if exponent % 2:
        return Interval(_raise(a.low, exponent), _raise(a.high, exponent), a.open_low, a.open_high)
    if a.low >= 0 or a.high <= 0:
        size = a if a.low >= 0 else scale(-1.0, a)
        low, high = _raise(size.low, exponent), _raise(size.high, exponent)
        return Interval(low, high, size.open_low, size.open_high)
    far = max((abs(a.low), not a.open_low), (abs(a.high), not a.open_high))
    return Interval(0.0, _raise(far[0], exponent), True, not far[1])


def _raised(node: Expr, a: Interval, exponent: int) -> Interval:
    """An integer power of a node with a range. What has pieces may be zero all along one."""
    found = power(a, exponent)
    if a.low < 0 < a.high and found.low == 0 and _has_pieces(node):
        return found._replace(open_low=False)
    return found


def _has_pieces(node: Expr) -> bool:
    """Whether an expression is another function in one place than in another."""
    return any(
        n.op is Op.IF or (n.op is Op.FN and (n.name not in FUNCTIONS or _record(n).bends))
        for n in topological([node])
    )


def _raise(x: float, exponent: int) -> float:
    try:
        return float(x**exponent)
    except OverflowError:
        return math.copysign(_INF, x) if exponent % 2 else _INF


def _product(node: Expr, args: list[Interval]) -> Interval:
    return reduce(times, map(_raised, node.args, args, node.exponents), ONE)


def join(*ranges: Interval) -> Interval:
    """Whatever one of the ranges holds."""
    low, high = min(r.low for r in ranges), max(r.high for r in ranges)
    return Interval(
        low,
        high,
        all(r.open_low for r in ranges if r.low == low),
        all(r.open_high for r in ranges if r.high == high),
    )


_RANGES: dict[Op, Callable[[Expr, list[Interval]], Interval]] = {
    **dict.fromkeys(Op, lambda *_: ALL),
    Op.NUM: lambda node, _: scale(float(node.number), ONE),
    Op.ADD: lambda node, args: add(*map(scale, map(float, node.coefficients), args)),
    Op.MUL: _product,
    Op.FN: _function,
    Op.IF: lambda _, args: join(*args[1:]),
}
