"""Solve one equation for one variable, in closed form, where the solution is unique.

Linear equations and chains of one-to-one functions are turned around here; what holds the
variable more than once in a nonlinear way goes to SymPy.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise

from bondgraph.algebra.in_mode import in_each_mode
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import (
    CONSTANTS,
    Expr,
    Kind,
    Op,
    Pool,
    Rational,
    raised,
    read_backwards,
    topological,
    whole,
)
from bondgraph.text.tuples import NamedTuple

#: Functions that are one to one on the reals (or where they are defined), with their inverses.
INVERSE = {
    "ssqrt": "ssq",
    "ssq": "ssqrt",
    "exp": "log",
    "log": "exp",
    "tanh": "atanh",
    "atanh": "tanh",
    "sinh": "asinh",
    "asinh": "sinh",
    "atan": "tan",
    "asin": "sin",
}


#: How hard it is to have a value that iteration has to find.
ITERATED = 5


class Solution(NamedTuple):
    """`value` of the variable and how hard it is to have: 0 as it stands, 1 where it divides by a
    signal or inverts a nonlinear law, `ITERATED` where iteration has to find it."""

    value: Expr
    hard: int
    inverted: bool


def solve(
    pool: Pool,
    zero: Expr,
    variable: Expr,
    vanishes: Callable[[Expr], bool] = lambda _: False,
    number: Callable[[Expr], float | None] | None = None,
) -> Solution | None:
    """The unique value of `variable` that makes `zero` vanish, or None if there is none to give.

    A coefficient that a mode may turn to zero, or that `vanishes` at the nominal parameters (a
    leak that is nominally nothing), is never divided by. With `number`, the nominal values, an
    equation that has one solution but no closed form gives a ROOT node.

    >>> p = Pool(); e, f = p.symbol("e", Kind.EFFORT), p.symbol("f", Kind.FLOW)
    >>> R = p.symbol("R", Kind.PARAM)
    >>> solve(p, p.sub(e, p.mul(R, f)), f).value
    e/R
    """
    alone = _isolated(pool, zero, variable)
    if alone is not None:
        return Solution(alone, 0, False)
    linear = _plain(pool, zero, variable)
    if linear is None:
        holders = _holders(zero, variable)
        if zero not in holders:
            return None
        linear = affine(pool, zero, variable)
    if linear is not None:
        slope, rest = linear
        if slope is pool.zero or not _dividable(pool, slope, vanishes):
            return None
        value = pool.neg(rest) if slope is pool.one else _quotient(pool, rest, slope)
        return Solution(value, int(not constant(slope)), False)
    value_ = _peel(pool, zero, variable, holders, vanishes)
    if value_ is None:
        from bondgraph.algebra.solve_symbolic import solve_symbolic

        value_ = solve_symbolic(pool, zero, variable)
    if value_ is not None:
        return Solution(value_, 1, True)
    if number is None:
        return None
    from bondgraph.algebra.implicit import invert

    value_ = invert(pool, zero, variable, number)
    return None if value_ is None else Solution(value_, ITERATED, True)


def _isolated(pool: Pool, zero: Expr, variable: Expr) -> Expr | None:
    """The variable from a sum in which it stands by itself, as in the balance of a junction."""
    if zero.op is not Op.ADD or variable not in zero.args:
        return None
    own = zero.coefficients[zero.args.index(variable)]
    factor = -raised(own, -1)
    terms = []
    for c, arg in zip(zero.coefficients, zero.args, strict=True):
        if arg is variable:
            continue
        if arg.op is not Op.SYM and (
            arg.op is not Op.MUL
            or variable in arg.args
            or any(a.op is not Op.SYM for a in arg.args)
        ):
            return None
        terms.append((factor * c, arg))
    return pool.add(*terms)


def _plain(pool: Pool, zero: Expr, variable: Expr) -> tuple[Expr, Expr] | None:
    """`affine` for the usual balance or linear law: a sum of symbols and products of symbols.

    None where the equation is of another form or holds the variable more than once.
    """
    if zero.op is not Op.ADD:
        return None
    found: tuple[Expr, Expr] | None = None
    rest = []
    for c, arg in zip(zero.coefficients, zero.args, strict=True):
        if arg.op is Op.MUL:
            if any(a.op is not Op.SYM for a in arg.args):
                return None
            if variable not in arg.args:
                rest.append((c, arg))
                continue
            if arg.exponents[arg.args.index(variable)] != 1:
                return None
        elif arg.op is not Op.SYM:
            return None
        elif arg is not variable:
            rest.append((c, arg))
            continue
        if found is not None:
            return None
        found = pool.scale(c, pool.div(arg, variable)), pool.zero
    return None if found is None else (found[0], pool.add(*rest))


def constant(expr: Expr, memo: dict[Expr, bool] | None = None) -> bool:
    """Whether an expression is made of parameters and numbers only.

    With a `memo` kept between calls, questions about parts of one large expression stay linear.
    """
    known = {} if memo is None else memo
    for node in topological([expr], stop=known.__contains__):
        if node not in known:
            if node.op is Op.SYM:
                known[node] = node.symbol.kind in CONSTANTS
            else:
                known[node] = node.op is not Op.INT and all(known[a] for a in node.args)
    return known[expr]


def affine(pool: Pool, node: Expr, variable: Expr) -> tuple[Expr, Expr] | None:
    """`slope`, `rest` with node = slope * variable + rest, both free of it; None if not affine."""
    holders = _holders(node, variable)
    if node not in holders:
        return pool.zero, node
    parts: dict[Expr, tuple[Expr, Expr]] = {variable: (pool.one, pool.zero)}
    for item in holders:
        if item is variable:
            continue
        if item.op is Op.ADD:
            slopes, rests = [], []
            for c, arg in zip(item.coefficients, item.args, strict=True):
                slope, rest = parts.get(arg, (pool.zero, arg))
                slopes.append((c, slope))
                rests.append((c, rest))
            parts[item] = pool.add(*slopes), pool.add(*rests)
        elif item.op is Op.MUL:
            inside = [a for a in item.args if a in parts]
            power = item.exponents[item.args.index(inside[0])]
            if len(inside) != 1 or power != 1:
                return None
            slope, rest = parts[inside[0]]
            others = [
                pool.power(a, e)
                for a, e in zip(item.args, item.exponents, strict=True)
                if a is not inside[0]
            ]
            parts[item] = pool.mul(slope, *others), pool.mul(rest, *others)
        elif item.op is Op.IF and item.args[0] not in parts:
            yes, no = (parts.get(a, (pool.zero, a)) for a in item.args[1:])
            slope = pool.choose(item.args[0], yes[0], no[0])
            parts[item] = slope, pool.choose(item.args[0], yes[1], no[1])
        else:
            return None
    return parts[node]


def rest(pool: Pool, zero: Expr, variables: Sequence[Expr]) -> Expr | None:
    """What is left of a linear equation beside its variables; None where it is not linear in them.

    Zero in place of the variables would not do: it is no value of log(2 f) - log(3 f).
    """
    wanted = set(variables)
    for variable in [n for n in topological([zero]) if n in wanted]:
        parts = affine(pool, zero, variable)
        if parts is None or any(n in wanted for n in topological([parts[0]])):
            return None
        zero = parts[1]
    return zero


def _holders(node: Expr, variable: Expr) -> dict[Expr, None]:
    """The nodes below `node` that hold `variable`, itself included, arguments first."""
    found: dict[Expr, None] = {}
    for item in topological([node]):
        if item is variable or any(a in found for a in item.args):
            found[item] = None
    return found


def _dividable(pool: Pool, slope: Expr, vanishes: Callable[[Expr], bool]) -> bool:
    """Whether it is right to divide by a coefficient: not where it is zero in some mode."""
    if slope.op is Op.SYM and slope.symbol.kind in CONSTANTS:
        return not vanishes(slope)
    nodes = topological([slope])
    if any(n.op is Op.FN and n.data in ("sign", "min", "max") for n in nodes):
        return False
    switches = (Op.IF, Op.CMP, Op.LOGIC)
    if any(n.op in switches or (n.op is Op.SYM and n.symbol.kind is Kind.MODE) for n in nodes):
        each = in_each_mode(pool, slope)
        return each is not None and not any(is_zero(s) or vanishes(s) for s in each)
    return not vanishes(slope)


def _quotient(pool: Pool, rest: Expr, slope: Expr) -> Expr:
    """-rest/slope, with the sign taken into a sum and single factors divided out of it."""
    if slope.op is Op.IF:  # a switch: its own quotient in each position
        condition, *slopes = slope.args
        same = rest.op is Op.IF and rest.args[0] is condition
        rests = rest.args[1:] if same else (rest, rest)
        yes, no = (_quotient(pool, r, s) for r, s in zip(rests, slopes, strict=True))
        return pool.choose(condition, yes, no)
    if slope is pool.zero:  # in a position that no setting of the switches reaches
        return pool.zero
    if slope.op is Op.NUM:
        factor = whole(-1 / slope.number)
        if rest.op is Op.ADD:
            terms = zip(rest.coefficients, rest.args, strict=True)
            return pool.add(*[(factor * c, a) for c, a in terms])
        return pool.add((factor, rest))
    if slope.op is Op.ADD and len(slope.args) == 1 and slope.coefficients[0] < 0:
        return pool.div(rest, pool.neg(slope))
    return pool.div(pool.neg(rest), slope)


def _peel(
    pool: Pool,
    zero: Expr,
    variable: Expr,
    holders: dict[Expr, None],
    vanishes: Callable[[Expr], bool],
) -> Expr | None:
    """Turn a chain of one-to-one functions around, from the outside to the variable."""
    node, target = zero, pool.zero
    while node is not variable:
        inside = [a for a in node.args if a in holders]
        if len(inside) != 1:
            return None
        inner = inside[0]
        if node.op is Op.ADD:
            c = node.coefficients[node.args.index(inner)]
            terms: list[tuple[Rational, Expr]] = [(Fraction(1) / c, target)]
            for k, arg in zip(node.coefficients, node.args, strict=True):
                if arg is not inner:
                    terms.append((-Fraction(k) / c, arg))
            target = pool.add(*terms)
        elif node.op is Op.MUL:
            power = node.exponents[node.args.index(inner)]
            others = [
                pool.power(a, -e)
                for a, e in zip(node.args, node.exponents, strict=True)
                if a is not inner
            ]
            if not all(_dividable(pool, pool.power(o, -1), vanishes) for o in others):
                return None
            root = _root(pool, pool.mul(target, *others), power)
            if root is None:
                return None
            target = root
        elif node.op is Op.FN and node.name in INVERSE:
            target = pool.fn(INVERSE[node.name], target)
        elif node.op is Op.FN and node.name == "sqrt":
            target = pool.power(target, 2)
        elif node.op is Op.FN and node.name == "cbrt":
            target = pool.power(target, 3)
        elif node.op is Op.FN and node.name.startswith("table:"):
            inverse = _inverse_table(pool, node.name)
            if inverse is None:
                return None
            target = pool.fn(inverse, target)
        else:
            return None
        node = inner
    return target


def _root(pool: Pool, target: Expr, power: int) -> Expr | None:
    """The only real x with x**power = target; even powers have two, a reciprocal is never zero."""
    if power < 0:
        if target is pool.zero:
            return None
        target, power = pool.power(target, -1), -power
    if power == 1:
        return target
    return pool.fn("cbrt", target) if power == 3 else None


def _inverse_table(pool: Pool, name: str) -> str | None:
    """The table read the other way, where it is strictly monotone."""
    points = pool.tables[name.removeprefix("table:")]
    values = [y for _, y in points]
    steps = [b - a for a, b in pairwise(values)]
    if not steps or not (all(s > 0 for s in steps) or all(s < 0 for s in steps)):
        return None
    own = name.removeprefix("table:")
    inverse = read_backwards(own)
    pool.tables.setdefault(inverse, tuple(sorted((y, x) for x, y in points)))
    return "table:" + inverse
