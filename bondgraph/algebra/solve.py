"""Solve one equation for one variable, in closed form, where the solution is unique.

Linear equations and chains of one-to-one functions are turned around here; what holds the
variable more than once in a nonlinear way goes to SymPy.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from bondgraph.algebra.affine import affine
from bondgraph.algebra.implicit import invert
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
    topological,
    whole,
)
from bondgraph.ir.functions import FUNCTIONS, root
from bondgraph.ir.nodes import constant, holding
from bondgraph.ir.tables import read_backwards, reading
from bondgraph.text.tuples import NamedTuple

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
    holders = holding([zero], lambda n: n is variable)
    if zero not in holders:
        return None
    linear = affine(pool, zero, variable, holders)
    if linear is not None:
        slope, rest = linear
        if slope is pool.zero or not _dividable(pool, slope, vanishes):
            return None
        value = pool.neg(rest) if slope is pool.one else _quotient(pool, rest, slope)
        return Solution(value, int(not constant(slope)), False)
    value_ = _peel(pool, zero, variable, holders, vanishes)
    if value_ is None:
        from bondgraph.algebra.solve_symbolic import solve_symbolic  # SymPy is slow to import

        value_ = solve_symbolic(pool, zero, variable)
    if value_ is not None:
        return Solution(value_, 1, True)
    if number is None:
        return None
    value_ = invert(pool, zero, variable, number)
    return None if value_ is None else Solution(value_, ITERATED, True)


def _isolated(pool: Pool, zero: Expr, variable: Expr) -> Expr | None:
    """The variable from a sum in which it stands by itself, as in the balance of a junction."""
    if zero.op is not Op.ADD or variable not in zero.args:
        return None
    own = zero.coefficients[zero.args.index(variable)]
    factor = -raised(own, -1)
    terms = []
    for c, arg in zero.terms:
        if arg is variable:
            continue
        if arg.op is not Op.SYM and any(
            a is variable or a.op is not Op.SYM for a, _ in arg.factors
        ):
            return None
        terms.append((factor * c, arg))
    return pool.add(*terms)


def _dividable(pool: Pool, slope: Expr, vanishes: Callable[[Expr], bool]) -> bool:
    """Whether it is right to divide by a coefficient: not where it is zero in some mode."""
    if slope.kind in CONSTANTS:
        return not vanishes(slope)
    nodes = topological([slope])
    if any(n.op is Op.FN and n.data in ("sign", "min", "max") for n in nodes):
        return False
    switches = (Op.IF, Op.CMP, Op.LOGIC)
    if any(n.op in switches or (n.kind is Kind.MODE) for n in nodes):
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
        return pool.add(*[(factor * c, a) for c, a in rest.terms])
    if slope.scaled[0] < 0:
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
            for k, arg in node.terms:
                if arg is not inner:
                    terms.append((-Fraction(k) / c, arg))
            target = pool.add(*terms)
        elif node.op is Op.MUL:
            power = node.exponents[node.args.index(inner)]
            others = [
                pool.power(a, -e)
                for a, e in node.factors
                if a is not inner
            ]
            if not all(_dividable(pool, pool.power(o, -1), vanishes) for o in others):
                return None
            root = _root(pool, pool.mul(target, *others), power)
            if root is None:
                return None
            target = root
        elif node.op is Op.FN and node.name == "pow":
            base, exponent = node.args
            if inner is not base or not _dividable(pool, exponent, vanishes):
                return None  # of an unknown exponent a logarithm would be needed
            target = pool.fn("pow", target, pool.power(exponent, -1))
        elif node.op is Op.FN and node.name in FUNCTIONS:
            inverse = FUNCTIONS[node.name].inverse
            if inverse is None:
                return None
            if isinstance(inverse, int):
                target = pool.power(target, inverse)
            else:
                target = pool.fn(inverse, target)
        elif node.op is Op.FN and node.name.startswith("table:"):
            found = _other_reading(pool, node, target, node.args.index(inner))
            if found is None:
                return None
            target = found
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
    undoing = root(power)
    return None if undoing is None else pool.fn(undoing, target)


def _other_reading(pool: Pool, node: Expr, value: Expr, at: int) -> Expr | None:
    """The argument number `at` of a table that has a value, where it is strictly monotone in it."""
    name, args = reading(node.name.removeprefix("table:"), node.args, value, at)
    own = name.rstrip("'")
    rows = read_backwards(pool.tables[own], len(name) - len(own)) if own != name else ()
    if rows is None:
        return None
    if rows:
        pool.tables.setdefault(name, rows)
    return pool.fn(f"table:{name}", *args)
