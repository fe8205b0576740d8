"""Combine relations so that a chosen fault, whatever its course, drops out of them.

The fault is an unknown signal s. A relation in which it enters as sum a_k D^k s + rest is a row
over differential operators; two rows are reduced against each other by Euclid's algorithm, which
for constant coefficients is the polynomial null space r_c = M2(p) r1 - M1(p) r2 and for others
that of Ore (1933). Where the fault enters otherwise, one relation is solved for it.
"""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.algebra.derivative import Jets, TooManyOperations
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.solve import solve
from bondgraph.algebra.zero import is_zero
from bondgraph.exact.plant import ExactUnavailable, Plant
from bondgraph.exact.reactions import Reactions
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.nodes import constant, holding, occurs
from bondgraph.ir.residuals import Closing, ReducedSystem, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.passes.elimination.initial import without_free_integrals
from bondgraph.text.diagnostic import Report
from bondgraph.text.tuples import NamedTuple

_INTEGRALS = 3  # times a relation is differentiated to bring the fault out of integrals
_LIMIT = 4000  # nodes of a combined relation
_GATES = 12  # parts that are tried in place of the fault
_STEPS = 60  # of Euclid's algorithm


class _Operator(NamedTuple):
    """sum of coefficients[k] * D^k s + rest = 0."""

    coefficients: list[Expr]
    rest: Expr

    @property
    def order(self) -> int:
        return len(self.coefficients) - 1


def decouple(
    reduced: ReducedSystem,
    residuals: ResidualSet,
    matrix: SignatureMatrix,
    faults: tuple[str, ...],
    plant: Plant,
    report: Report,
    seed: int = 1,
) -> ReducedSystem:
    """The relations, and behind them new ones that do not react to the faults, one fault each.

    Of n relations that see a fault n - 1 combinations are free of it. Reports `not-decoupled`
    where there is none or none could be found in closed form. KeyError for a name that is no
    fault candidate. (Staroswiecki and Comtet-Varga, 2001; Frisk and Nyberg, 2001.)
    """
    exprs = _moving(reduced, residuals)
    found: list[Closing] = []
    for fault in faults:
        symbol = residuals.system.graph.fault_symbol(fault)
        at = matrix.residuals
        seen = [at.index(r) for r in at if fault in matrix.signature(r)]
        rows = [(residuals.residuals[k], exprs[k]) for k in seen]
        work = _Decoupling(reduced, plant, seed, fault, symbol)
        own = work.combined(rows)
        found += own
        if not own:
            _say(report, residuals, fault, [r for r, _ in rows])
    return reduced._replace(closings=(*reduced.closings, *found))


_LONG = 2000  # nodes


def _moving(reduced: ReducedSystem, residuals: ResidualSet) -> list[Expr]:
    """The residuals in the form that shows what a parameter does that moves.

    Differentiating takes an undeclared initial value away only while its parameter is constant.
    A long relation is left as it is: there the random points are exponentials, without integrals.
    """
    closings = {id(c.equation): c for c in reduced.closings}
    out = []
    for residual in residuals.residuals:
        raw = closings[id(residual.closing)].raw
        nodes = topological([raw])
        moved = any(n.op is Op.INT and n.symbol.kind is Kind.FREE for n in nodes)
        out.append(raw if moved and len(nodes) <= _LONG else residual.expr)
    return out


def _say(report: Report, residuals: ResidualSet, fault: str, seen: list[Residual]) -> None:
    if not seen:
        why = "no relation sees it, so all are free of it"
    elif len(seen) == 1:
        why = f"only {seen[0].name} sees it, and a combination needs two relations that do"
    else:
        names = ", ".join(r.name for r in seen)
        why = f"{names} hold it in a way that has no solution in closed form"
    graph = residuals.system.graph
    origins = [v.origin for v in graph.values if v.name == fault]
    origins += [i.origin for i in graph.inputs if i.name == fault]
    origins += [s.origin for s in graph.sensors if s.name == fault]
    report.info(
        "not-decoupled",
        f"No combination of the relations was made to be free of `{fault}`: {why}.",
        *origins[:1],
        help="One sensor more gives one relation more to combine." if seen else "",
    )


class _Decoupling:
    """The search for combinations that are free of one fault."""

    def __init__(
        self, reduced: ReducedSystem, plant: Plant, seed: int, fault: str, symbol: Expr
    ) -> None:
        self.graph = reduced.system.graph
        self.pool = self.graph.pool
        self.plant = plant
        self.seed = seed
        self.fault = fault
        self.symbol = symbol
        self.signal = self.pool.symbol(f"{fault}?", Kind.INPUT)  # it may move
        self.nominal = Nominal(self.graph)

    def combined(self, rows: list[tuple[Residual, Expr]]) -> list[Closing]:
        """One relation for each but the simplest that can be combined with all the others."""
        rows = sorted(rows, key=lambda row: len(topological([row[1]])))
        best: list[Closing] = []
        for first in rows:
            found = []
            for other in rows:
                closing = None if other is first else self._combination(first, other)
                if closing is not None:
                    found.append(closing)
            if len(found) > len(best):
                best = found
            if len(best) == len(rows) - 1:
                break
        return best

    def _combination(
        self, first: tuple[Residual, Expr], other: tuple[Residual, Expr]
    ) -> Closing | None:
        for expr in self._candidates(first[1], other[1]):
            closing = self._closing(first[0], other[0], cleared(self.pool, expr))
            if closing is not None:
                return closing
        return None

    def _candidates(self, a: Expr, b: Expr) -> Iterator[Expr]:
        """Combinations of two relations that hold the fault nowhere, the best first."""
        pool, unknown = self.pool, self.signal
        forms = [(self.symbol, unknown), (self.symbol, pool.power(unknown, -1))]
        forms += [(gate, unknown) for gate in self._gates(a, b)]
        for place, value in forms:
            replaced = self._replaced([a, b], place, value)
            if replaced is None:
                continue
            left, right = replaced
            one, two = self._row(left), self._row(right)
            if one is not None and two is not None:
                free = self._euclid(one, two)
                if free is not None:
                    yield free
            for giving, taking in ((left, right), (right, left)):
                found = solve(pool, giving, unknown, self.nominal.vanishes)
                if found is not None and not occurs(unknown, found.value):
                    yield from self._replaced([taking], unknown, found.value) or ()

    def _replaced(self, exprs: list[Expr], place: Expr, value: Expr) -> list[Expr] | None:
        """The expressions with another value in a place; None where that divides by zero."""
        try:
            return self.pool.substitute(exprs, {place: value})
        except ZeroDivisionError:
            return None

    def _gates(self, a: Expr, b: Expr) -> list[Expr]:
        """Parts of both relations through which alone the fault enters them, the largest first.

        The flow into a tank of unknown area, for instance: it can be solved for as a whole.
        """
        one, other = (holding([root], lambda n: n is self.symbol) for root in (a, b))
        common = [n for n in reversed(one) if n in other and n not in (a, b)]
        gates = []
        for node in common[:_GATES]:
            closed = self._replaced([a, b], node, self.signal) or [a]
            if node is not self.symbol and not occurs(self.symbol, *closed):
                gates.append(node)
        return gates

    # -------------------------------------------------------------- operators

    def _row(self, expr: Expr) -> _Operator | None:
        """The relation as an operator on the fault; integrals of the fault are differentiated."""
        for times in range(_INTEGRALS + 1):
            if times:
                try:
                    expr = Jets(self.pool).of(expr, 1, _LIMIT)
                except TooManyOperations:
                    return None
            row = operator(self.pool, expr, self.signal)
            if row is not None:
                return self._trimmed(row)
        return None

    def _trimmed(self, row: _Operator) -> _Operator:
        coefficients = list(row.coefficients)
        while coefficients and is_zero(coefficients[-1]):
            coefficients.pop()
        return _Operator(coefficients, row.rest)

    def _euclid(self, a: _Operator, b: _Operator) -> Expr | None:
        """A combination of the rows in which every coefficient of the fault is zero."""
        for _ in range(_STEPS):
            if a.order < b.order:
                a, b = b, a
            if not b.coefficients:
                return b.rest
            a = self._trimmed(self._less(a, b))
            if len(topological([a.rest])) > _LIMIT:
                return None
        return None

    def _less(self, a: _Operator, b: _Operator) -> _Operator:
        """Row a with its leading term taken away by row b, which is of no higher order."""
        pool = self.pool
        for _ in range(a.order - b.order):
            b = _shifted(pool, b)
        high, low = a.coefficients[-1], b.coefficients[-1]
        if constant(low) and not self.nominal.vanishes(low):
            left, right = pool.one, pool.div(high, low)
        elif constant(high) and not self.nominal.vanishes(high):
            left, right = pool.div(low, high), pool.one
        else:
            left, right = self._without_common_factor(low, high)
        size = len(a.coefficients)
        padded = [pool.zero] * (size - len(b.coefficients))
        coefficients = [
            pool.sub(pool.mul(left, x), pool.mul(right, y))
            for x, y in zip(a.coefficients, [*b.coefficients, *padded], strict=True)
        ]
        rest = pool.sub(pool.mul(left, a.rest), pool.mul(right, b.rest))
        return _Operator(coefficients[:-1], rest)

    def _without_common_factor(self, a: Expr, b: Expr) -> tuple[Expr, Expr]:
        """Two coefficients divided by the factors that both have and that are whole nodes."""
        mine, other = _factors(a), _factors(b)
        for base in [x for x in mine if x in other]:
            power = min(mine[base], other[base])
            shared = self.pool.power(base, -power)
            a, b = self.pool.mul(a, shared), self.pool.mul(b, shared)
        return a, b

    # ---------------------------------------------------------------- results

    def _closing(self, first: Residual, other: Residual, expr: Expr) -> Closing | None:
        """The combination as a relation, if it is one and does not react to the fault."""
        if occurs(self.signal, expr) or occurs(self.symbol, expr):
            return None
        if is_zero(expr) or len(topological([expr])) > _LIMIT:
            return None
        free = without_free_integrals(self.pool, expr)
        if free is None or is_zero(free.expr):
            return None
        influence = Reactions(self.plant, self.seed).at_free_signals(free.expr).depends
        if not any(influence.values()) or not self._sound(free.raw, first.expr, other.expr):
            return None
        steps = {id(s.variable): s for r in (first, other) for s in r.steps}
        name = f"{other.closing.name} combined with {first.closing.name}, free of {self.fault}"
        equation = other.closing._replace(name=name)
        return Closing(equation, free.expr, tuple(steps.values()), free.order, free.raw, self.fault)

    def _sound(self, expr: Expr, *sources: Expr) -> bool:
        """Whether no fault that the new relation does not hold moves it all the same.

        Operators were moved past parameters as if these were constant.
        """
        reactions = Reactions(self.plant, self.seed)
        gone = [s for s in symbols(*sources) if s not in set(symbols(expr))]
        try:
            return not reactions.movers(expr, [*gone, self.symbol])
        except ExactUnavailable:
            return True


def operator(pool: Pool, expr: Expr, symbol: Expr) -> _Operator | None:
    """The expression as sum a_k D^k s + rest; None if s stands in a nonlinear place or integral.

    >>> p = Pool(); s, y = p.symbol("s", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    >>> row = operator(p, p.add((1, p.der(p.mul(y, s))), (3, y)), s)
    >>> row.coefficients, row.rest
    ([D(y), y], 3*y)
    """
    rows: dict[Expr, _Operator] = {symbol: _Operator([pool.one], pool.zero)}
    for node in topological([expr]):
        inside = [a for a in node.args if a in rows]
        if node in rows or not inside:
            continue
        row = rows[inside[0]]
        if node.op is Op.ADD:
            terms = [
                (c, rows.get(a) or _Operator([], a))
                for c, a in node.terms
            ]
            size = max(len(r.coefficients) for _, r in terms)
            rows[node] = _Operator(
                [
                    pool.add(*[(c, r.coefficients[k]) for c, r in terms if k < len(r.coefficients)])
                    for k in range(size)
                ],
                pool.add(*[(c, r.rest) for c, r in terms]),
            )
        elif node.op is Op.MUL:
            power = node.exponents[node.args.index(inside[0])]
            if len(inside) > 1 or power != 1:
                return None
            others = pool.div(node, inside[0])
            rows[node] = _Operator(
                [pool.mul(c, others) for c in row.coefficients], pool.mul(row.rest, others)
            )
        elif node.op is Op.DER:
            rows[node] = _shifted(pool, row)
        elif node.op is Op.IF and node.args[0] not in rows:
            yes, no = (rows.get(a) or _Operator([], a) for a in node.args[1:])
            size = max(len(yes.coefficients), len(no.coefficients))
            left, right = (
                [*r.coefficients, *[pool.zero] * (size - len(r.coefficients))] for r in (yes, no)
            )
            choose = pool.choose
            rows[node] = _Operator(
                [choose(node.args[0], x, y) for x, y in zip(left, right, strict=True)],
                choose(node.args[0], yes.rest, no.rest),
            )
        else:
            return None
    return rows.get(expr) or _Operator([], expr)


def cleared(pool: Pool, expr: Expr) -> Expr:
    """The relation times the signals that its terms are divided by: it then has a value always.

    >>> p = Pool(); x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    >>> cleared(p, p.sub(x, p.div(y, x)))
    x^2 - y
    """
    terms = expr.terms if expr.op is Op.ADD else [(1, expr)]
    below: dict[Expr, int] = {}
    flat = []
    for c, term in terms:
        flat.append((c, term))
        if term.op is Op.MUL:
            for base, power in term.factors:
                if power < 0 and not constant(base):
                    below[base] = max(below.get(base, 0), -power)
    factor = pool.mul(*[pool.power(base, power) for base, power in below.items()])
    if factor is pool.one:
        return expr
    return pool.add(*[(c, pool.mul(term, factor)) for c, term in flat])


def _shifted(pool: Pool, row: _Operator) -> _Operator:
    """D(sum a_k D^k s + rest), parameters constant."""
    own = [pool.zero if constant(c) else pool.der(c) for c in row.coefficients]
    coefficients = [
        pool.add((1, x), (1, y))
        for x, y in zip([*own, pool.zero], [pool.zero, *row.coefficients], strict=True)
    ]
    return _Operator(coefficients, pool.der(row.rest))


def _factors(node: Expr) -> dict[Expr, int]:
    """The factors of a product with positive powers."""
    if node.op is Op.ADD and len(node.args) == 1:
        node = node.args[0]
    if node.op is Op.MUL:
        return {a: e for a, e in node.factors if e > 0}
    return {} if node.op is Op.NUM else {node: 1}
