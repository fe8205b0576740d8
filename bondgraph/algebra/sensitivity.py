"""How a relation changes with its parameters and signals, as expressions that share their parts.

Where nothing is differentiated or integrated, one reverse pass gives all derivatives at once
(Griewank and Walther, 2008, ch. 3). Elsewhere tangents are carried forward: a derivative of a
tangent is the tangent of the derivative, while the adjoint of D would be a differential operator
whose order grows with the chain. Either way no sum is expanded, and every node costs a constant.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from bondgraph.algebra.derivative import partials, tangent
from bondgraph.algebra.present import tidy
from bondgraph.ir.expr import ZERO_START, Expr, Kind, Op, Pool, Symbol, topological
from bondgraph.ir.nodes import has, holding


def sensitivity(
    pool: Pool,
    expr: Expr,
    wrt: Sequence[Expr],
    starts: Mapping[Symbol, Expr] | None = None,
) -> dict[Expr, Expr]:
    """The derivative of `expr` with respect to each symbol of `wrt`, a number that may change.

    Parameters are constant in time, D and Int pass through: d D(x)/dR = D(dx/dR). For a known
    signal it is the effect of a constant error, so that of D(y) it is zero; `variation` takes
    errors that move. `abs`, `min`, `if`, tables are differentiated piece by piece, a jump gives
    nothing. `starts` (`BondGraph.initial_values`) are the values from which integrals begin,
    which may hold parameters too. In units of `expr` over those of the symbol.

    >>> p = Pool(); y = p.symbol("y", Kind.SENSOR)
    >>> R, L = p.symbol("R", Kind.PARAM), p.symbol("L", Kind.PARAM)
    >>> drop = p.add((1, p.mul(R, y)), (1, p.mul(L, R, p.der(y))))
    >>> sensitivity(p, drop, [R, L, y])
    {R: y + L*D(y), L: R*D(y), y: R}
    """
    begins = starts or {}
    if _static(expr, wrt):
        slopes = _reverse(pool, expr, wrt)
    else:
        slopes = [_forward(pool, expr, {s: pool.one}, begins) for s in wrt]
    return dict(zip(wrt, tidy(pool, *slopes), strict=True))


def variation(
    pool: Pool,
    expr: Expr,
    errors: Mapping[Expr, Expr],
    starts: Mapping[Symbol, Expr] | None = None,
) -> Expr:
    """The first-order change of `expr` when each symbol s is wrong by a signal `errors[s]`.

    The result is linear in the errors; with a symbol of its own as error its normal form is the
    operator that the error goes through, one coefficient an order.

    >>> p = Pool(); y, b = p.symbol("y", Kind.SENSOR), p.symbol("b", Kind.SENSOR)
    >>> variation(p, p.mul(y, p.der(y)), {y: b})
    b*D(y) + y*D(b)
    """
    return tidy(pool, _forward(pool, expr, errors, starts or {}))[0]


def _static(expr: Expr, wrt: Sequence[Expr]) -> bool:
    """Whether no derivative holds any of the symbols, and nothing is integrated."""
    holders = holding([expr], set(wrt).__contains__)
    return not has([expr], Op.INT) and not any(n.op is Op.DER for n in holders)


def _reverse(pool: Pool, expr: Expr, wrt: Sequence[Expr]) -> list[Expr]:
    holders = holding([expr], set(wrt).__contains__)
    adjoints: dict[Expr, list[Expr]] = {expr: [pool.one]}
    total: dict[Expr, Expr] = {}
    for node in reversed(holders):
        own = total[node] = _together(pool, adjoints.get(node, []))
        if own is pool.zero or not node.args:
            continue
        if node.op is Op.IF:
            condition, yes, no = node.args
            own_yes = pool.choose(condition, own, pool.zero)
            pairs = [(yes, own_yes), (no, pool.choose(condition, pool.zero, own))]
        else:
            slopes = zip(node.args, partials(pool, node), strict=True)
            pairs = [(a, _where(pool, own, slope)) for a, slope in slopes if a in holders]
        for a, adjoint in pairs:
            if a in holders and adjoint is not pool.zero:
                adjoints.setdefault(a, []).append(adjoint)
    return [total.get(s, pool.zero) for s in wrt]


def _together(pool: Pool, terms: Sequence[Expr]) -> Expr:
    """The sum of adjoints; choices by one condition are added side by side, so none grows."""
    sides: dict[Expr, list[Expr]] = {}
    for term in terms:
        if term.op is Op.IF:
            sides.setdefault(term.args[0], []).append(term)
    plain = [t for t in terms if t.op is not Op.IF]
    for condition, choices in sides.items():
        yes, no = (_together(pool, [t.args[k] for t in choices]) for k in (1, 2))
        plain.append(pool.choose(condition, yes, no))
    return pool.add(*[(1, t) for t in plain])


def _where(pool: Pool, adjoint: Expr, slope: Expr) -> Expr:
    """adjoint*slope, where the slope need not have a value on a side on which the adjoint is 0."""
    if adjoint is pool.zero or slope is pool.zero:
        return pool.zero
    if adjoint.op is Op.IF and pool.zero in adjoint.args:
        condition, *sides = adjoint.args
        return pool.choose(condition, *[_where(pool, side, slope) for side in sides])
    if adjoint.op is Op.ADD and all(t.op is Op.IF and pool.zero in t.args for t in adjoint.args):
        return _together(pool, [
            pool.scale(c, _where(pool, t, slope)) for c, t in adjoint.terms
        ])  # fmt: skip
    return pool.mul(adjoint, slope)


def _forward(
    pool: Pool, expr: Expr, seeds: Mapping[Expr, Expr], starts: Mapping[Symbol, Expr]
) -> Expr:
    """The tangent of the expression; the values that integrals begin from come first."""
    tangents = dict(seeds)
    _carry(pool, starts.values(), tangents, {})
    begins = {s.symbol: tangent for s, tangent in seeds.items()}
    begins |= {s: tangents[v] for s, v in starts.items() if v in tangents}
    _carry(pool, [expr], tangents, begins)
    return tangents.get(expr, pool.zero)


def _carry(
    pool: Pool, roots: Iterable[Expr], tangents: dict[Expr, Expr], begins: Mapping[Symbol, Expr]
) -> None:
    """Add the tangents of all nodes below the roots that have one."""
    start = pool.symbol(ZERO_START, Kind.INITIAL)
    for node in topological(roots):
        if node in tangents:
            continue
        moving = [a for a in node.args if a in tangents]
        if node.op is Op.INT:
            terms = [(1, begins[node.symbol])] if node.symbol in begins else []
            terms += [(1, pool.integral(tangents[a], start)) for a in moving]
        elif node.op is Op.DER:
            terms = [(1, pool.der(tangents[a])) for a in moving]
        elif moving:
            terms = [(1, tangent(pool, node, tangents))]
        else:
            continue
        if terms:
            tangents[node] = pool.add(*terms)
