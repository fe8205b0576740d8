"""Take undeclared initial values out of a relation by differentiating it."""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.algebra.affine import affine
from bondgraph.algebra.cancelled import without
from bondgraph.algebra.summands import summands
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.nodes import constant, decided, holding, linear_terms, rebuilt
from bondgraph.text.tuples import NamedTuple

_Value = Callable[[Expr, int], Expr]
_MOST = 12  # no relation worth having rests on more nested integrals
_SIGNALS = 4  # integrals that signals multiply, which grow the relation more
_LARGE = 400  # nodes
_SWITCHES = 4  # conditions that are taken apart, each of which may double the relation


class Freed(NamedTuple):
    """`expr` is the relation without undeclared initial values, `raw` what was done to it.

    `raw` is made of the relation as it was, its integrals included; `order` is how often it was
    differentiated.
    """

    expr: Expr
    raw: Expr
    order: int


def without_free_integrals(pool: Pool, expr: Expr) -> Freed | None:
    """The relation, differentiated as often as its integrals of unknown start require.

    None where such an integral stands inside a nonlinear function, so that no derivative of the
    relation is free of it. Parameters are constant in time here. A switch is never differentiated:
    where one multiplies such an integral, the relation of each position is differentiated alone.
    """
    return _freed(pool, expr, _SWITCHES)


def _freed(pool: Pool, expr: Expr, switches: int) -> Freed | None:
    raw = expr
    for order in range(_MOST):
        pushed = _push(pool, expr, order)
        if pushed is None:
            inner = _known_changes(pool, expr)
            if inner is not expr and (found := _freed(pool, inner, switches)) is not None:
                same = found.raw is pool.der(inner, found.order)
                return found._replace(raw=pool.der(expr, found.order)) if same else found
            each = _in_each_position(pool, expr, switches)
            return each or _one_by_one(pool, _telling(pool, expr))
        if not _holders(pushed):
            return Freed(pushed, raw, order)
        raw = pool.der(raw)
    return None


def _known_changes(pool: Pool, expr: Expr) -> Expr:
    """The expression with the derivatives in it that are free of such integrals if moved inwards.

    So the current of a capacitor is known although its voltage is not, and what it divides.
    """

    def known(node: Expr, args: tuple[Expr, ...]) -> Expr | None:
        if node.order <= 0 or not _holders(args[0]):
            return None
        pushed = _push(pool, args[0], node.order)
        return None if pushed is None or _holders(pushed) else pushed

    return rebuilt(pool, [expr], known)[0]


def _in_each_position(pool: Pool, expr: Expr, switches: int) -> Freed | None:
    """The relation, in each position of a switch without undeclared initial values."""
    choices = [n for n in topological([expr]) if n.op is Op.IF and decided(n.args[0])]
    if not choices or not switches:
        return None
    condition = choices[-1].args[0]
    found = []
    for position in (1, 2):
        there = {n: n.args[position] for n in choices if n.args[0] is condition}
        try:
            own = _freed(pool, _chosen(pool, expr, there), switches - 1)
        except ZeroDivisionError:  # a position in which the relation has no value
            return None
        if own is None:
            return None
        found.append(own)
    yes, no = found
    return Freed(
        pool.choose(condition, yes.expr, no.expr),
        pool.choose(condition, yes.raw, no.raw),
        max(yes.order, no.order),
    )


def _chosen(pool: Pool, expr: Expr, choices: dict[Expr, Expr]) -> Expr:
    """The expression with choices replaced by one of their branches."""
    new: dict[Expr, Expr] = {}
    for node in topological([expr]):
        branch = choices.get(node)
        new[node] = new[branch] if branch else pool.rebuild(node, tuple(new[a] for a in node.args))
    return new[expr]


def _telling(pool: Pool, expr: Expr) -> Expr:
    """The expression without the integrals of unknown start that cancel in it.

    One cancels if the value is the same whatever signal stands in its place; so may a function of
    one, as its logarithm.
    """
    if len(topological([expr])) > _LARGE:
        return expr
    one, other = (pool.symbol(name, Kind.TEAR) for name in ("?one", "?other"))
    holders = _holders(expr)
    functions = [n for n in reversed(holders) if n.op is Op.FN]
    for node in (*functions, *[n for n in holders if n.op is Op.INT]):
        at = [pool.substitute([expr], {node: x})[0] for x in (one, other)]
        if at[0] is not expr and is_zero(pool.sub(*at)):
            for number in (pool.zero, pool.one):  # zero may stand below a fraction
                free = without(pool, expr, [node], number=number)[0]
                if free is not expr:
                    expr = _flat(pool, free)
                    break
    return expr


def _flat(pool: Pool, expr: Expr) -> Expr:
    """The expression with sums inside sums written as one, so that V - (V - x) becomes x."""

    def opened(node: Expr, args: tuple[Expr, ...]) -> Expr:
        found = summands(pool.rebuild(node, args))
        return pool.add(*[(c, term) for term, c in found.items()])

    return rebuilt(pool, [expr], opened)[0]


def _one_by_one(pool: Pool, expr: Expr) -> Freed | None:
    """The relation without integrals that signals multiply, as the fluxes of a turning machine.

    From c I + b = 0 follows c b' - c' b + c^2 I' = 0, which is c^2 times the derivative of the
    relation divided by c, and divides by nothing.
    """
    raw = expr
    for order in range(_SIGNALS + 1):
        pushed = _inside_out(pool, expr)
        if pushed is None:
            return None
        expr = pushed
        holders = _holders(expr)
        if not holders:
            return Freed(expr, raw, order)
        parts = None
        for node in holders:
            if node.op is Op.INT:
                found = affine(pool, expr, node)
                if found is not None and not _holders(found[0]) and not is_zero(found[0]):
                    parts = node, *found
                    break
        if parts is None:
            return None
        integral, c, b = parts
        change = pool.der(c)
        terms = [pool.mul(c, pool.der(b)), pool.neg(pool.mul(change, b))]
        terms.append(pool.mul(c, c, integral.args[0]))
        expr = pool.add(*[(1, term) for term in terms])
        raw = pool.sub(pool.mul(c, pool.der(raw)), pool.mul(change, raw))
    return None


def _inside_out(pool: Pool, expr: Expr) -> Expr | None:
    """The expression with no free integral below a derivative; None where a function is between."""
    nodes = topological([expr])
    if len(nodes) > _LARGE:
        return None
    new: dict[Expr, Expr] = {}
    for node in nodes:
        args = tuple(new[a] for a in node.args)
        if node.op is Op.DER:
            changed = _change(pool, args[0])
            if changed is None:
                return None
            new[node] = changed
        else:
            new[node] = pool.rebuild(node, args)
    return new[expr]


def _change(pool: Pool, expr: Expr) -> Expr | None:
    """The derivative by the rules of sums and products, as far as free integrals are inside."""
    holders = _holders(expr)
    changed: dict[Expr, Expr] = {}
    for node in holders:
        if node.op is Op.INT:
            changed[node] = node.args[0]
        elif node.op is Op.ADD:
            terms = node.terms
            changed[node] = pool.add(*[(c, changed.get(a) or pool.der(a)) for c, a in terms])
        elif node.op is Op.MUL and all(
            e == 1 for a, e in node.factors if a in holders
        ):
            factors = [pool.power(a, e) for a, e in node.factors]
            slopes = [
                changed.get(a) or pool.der(f) for a, f in zip(node.args, factors, strict=True)
            ]
            products = [
                pool.mul(slope, *factors[:at], *factors[at + 1 :])
                for at, slope in enumerate(slopes)
            ]
            changed[node] = pool.add(*[(1, p) for p in products])
        else:
            return None
    return changed[expr] if expr in holders else pool.der(expr)


def _holders(expr: Expr) -> dict[Expr, None]:
    """The nodes that hold an integral whose start is not declared, arguments first."""
    return holding([expr], lambda n: n.op is Op.INT and n.symbol.kind is Kind.FREE)


def _push(pool: Pool, expr: Expr, order: int) -> Expr | None:
    """The derivative of `order`, moved inwards as far as undeclared integrals make necessary."""
    holders = _holders(expr)
    demand: dict[Expr, set[int]] = {node: set() for node in holders}
    demand.setdefault(expr, set()).add(order)
    for node in reversed(holders):
        for k in demand[node]:
            below = _order_below(node, k, holders)
            if below is None:
                return None
            for arg in node.args:
                if arg in holders:
                    demand[arg].add(below)
    made: dict[tuple[Expr, int], Expr] = {}

    def value(node: Expr, k: int) -> Expr:
        return made[node, k] if node in holders else pool.der(node, k)

    for node in holders:
        for k in sorted(demand[node]):
            made[node, k] = _derived(pool, node, k, holders, value)
    return value(expr, order)


def _order_below(node: Expr, k: int, holders: dict[Expr, None]) -> int | None:
    """Which derivative of its arguments the k-th derivative of a node needs; None: too many."""
    if node.order or k == 0:
        return max(k + node.order, 0)
    terms = linear_terms(node, holders)
    if terms is not None and all(constant(a) for term in terms for a, _ in term.others):
        return k
    return None


def _derived(pool: Pool, node: Expr, k: int, holders: dict[Expr, None], value: _Value) -> Expr:
    if node.order and k + node.order >= 0:
        return value(node.args[0], k + node.order)
    terms = linear_terms(node, holders) if k else None
    if terms is not None:
        return pool.add(*[term.of(pool, value(term.arg, k)) for term in terms])
    return pool.rebuild(node, tuple(value(a, 0) for a in node.args))
