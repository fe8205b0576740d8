"""Solve an equation for a variable numerically, where it has one solution but no closed form.

The value is a ROOT node: generated code finds it by Newton's method inside a bracket, and the
theorem of the implicit function differentiates it. One solution there is where the equation grows
or falls with the variable all over; an equation that may have several is not solved.
"""

from __future__ import annotations

from collections.abc import Callable, Container
from fractions import Fraction

from bondgraph.algebra.monotone import direction
from bondgraph.algebra.nominal import defined
from bondgraph.ir.expr import Expr, Kind, Op, Pool, Root, topological
from bondgraph.ir.nodes import holding

#: Numbers at which a law is tried to be defined, nearest to rest first.
_GUESSES = (Fraction(0), Fraction(1), Fraction(-1), Fraction(1, 1000), Fraction(300))

_UNKNOWN = "?x"
_SMALL = 40  # nodes; SymPy takes too long over more


def invert(
    pool: Pool,
    zero: Expr,
    variable: Expr,
    number: Callable[[Expr], float | None],
    meant: Expr | None = None,
) -> Expr | None:
    """The variable as a ROOT node, or None where it is not certain that there is one solution.

    `number` gives the nominal value of a parameter, of which the signs count. `meant` is the
    variable of the model where `variable` is a symbol that stands for it.

    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR); f = p.symbol("f", Kind.FLOW)
    >>> invert(p, p.sub(y, p.add((1, p.fn("sinh", f)), (1, f))), f, lambda _: None)
    root(f, y - (f + sinh(f)))
    """
    holders = holding([zero, variable], lambda n: n is variable)
    if any(n.order or _switched(n, holders) for n in holders):
        return None
    way = direction(pool, zero, variable, number) or _by_symbols(pool, zero, variable, number)
    if way is None:
        return None
    unknown = pool.symbol(_UNKNOWN, Kind.TEAR)
    mapping = {variable: unknown}
    for node in holders:
        for arg in node.args:
            if arg not in holders and arg not in mapping and arg.op is not Op.NUM:
                mapping[arg] = pool.symbol(f"?{len(mapping) - 1}", Kind.CONST)
    inner = pool.substitute([zero], mapping)[0]
    places = list(mapping.items())[1:]
    meant = meant or variable
    name = _name(pool, meant.symbol.name, inner)
    guess = _guess(zero, variable)
    root = Root(name, inner, unknown, tuple(p for _, p in places), meant, way > 0, guess)
    return pool.root(root, *[a for a, _ in places])


def _switched(node: Expr, holders: Container[Expr]) -> bool:
    """Whether a mode or another signal decides between branches that hold the variable."""
    return node.op is Op.IF and node.args[0] not in holders


def _name(pool: Pool, name: str, inner: Expr) -> str:
    """What a person calls the unknown; another equation for the same variable gets a mark."""
    while pool.roots.setdefault(name, inner) is not inner:
        name += "'"
    return name


def _by_symbols(
    pool: Pool, zero: Expr, variable: Expr, number: Callable[[Expr], float | None]
) -> int | None:
    """`direction` by the sign of the slope, once SymPy has simplified it."""
    from bondgraph.algebra.solve_symbolic import simplified_slope  # SymPy is slow to import

    if len(topological([zero])) > _SMALL:
        return None
    slope = simplified_slope(pool, zero, variable, lambda s: (number(s) or 0.0) > 0)
    if slope is None:
        return None
    antiderivative = pool.symbol("?slope", Kind.TEAR)  # d(slope x)/dx at any x is the slope
    return direction(pool, pool.mul(slope, antiderivative), antiderivative, number)


def _guess(zero: Expr, variable: Expr) -> Fraction:
    """A number at which no logarithm, root or quotient of the variable alone is undefined."""
    for guess in _GUESSES:
        if defined(zero, variable, float(guess)):
            return guess
    return Fraction(0)
