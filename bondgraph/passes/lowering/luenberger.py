"""The observer form of a residual: its states are integrated, and one sensor corrects them.

    x' = f(x, u) + l (y - h(x, u)),   r = k (y - h(x, u)),

where f and h are the relation solved for its states (`ir.residuals.Observer`), into which its
value w enters as x' = f + b w. With A = df/dx, c = dh/dx, n states and a bandwidth wc the gain
l = (A + v)^n b / (c A^(n-1) b) puts all poles at -v, v^2n = wc^2n + det(A)^2 (Ackermann, 1972):
at the bandwidth, but no slower than the machine's own poles are in the (geometric) mean, so that a
fault cannot lead the states far away. Then r = w through 1/(1 + p/v)^n, with
k = 1/(c (l c - A)^-1 b). No derivative is formed, and nonlinear laws get the states as they are.
The gain follows the states.

Between two samples the known signals are linear. The step is Rosenbrock's method of second order
in the form of Verwer, Spee, Blom and Hundsdorfer (1999), which forgets at once what is much faster
than the samples.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from bondgraph.algebra.derivative import TooManyOperations, operations
from bondgraph.algebra.sensitivity import sensitivity
from bondgraph.ir.expr import Expr, Kind, Pool, symbols
from bondgraph.ir.program import Assign, Assignment, Expression, Ref
from bondgraph.ir.residuals import Observer
from bondgraph.passes.lowering.exactly import LARGEST
from bondgraph.passes.lowering.procedure import ZERO, Procedure
from bondgraph.passes.lowering.program_names import brief, identifier
from bondgraph.passes.lowering.stages import Chain

_GAMMA = Fraction(2928932188134525, 10**16)  # 1 - 1/sqrt(2), where the method is L-stable
#: Slopes above this share of 1/sample_time are too fast for the samples, and left to themselves.
_STEEPEST = Fraction(1, 2)


class Luenberger(Chain):
    """Writes `first` and `step` of one residual as an observer.

    The first sample finds the machine at rest, and w = 0. Raises `TooManyOperations`, before
    anything is written, where a step takes more than `LARGEST`.
    """

    def follow(self, observer: Observer, text: str) -> None:
        """Append the statements of the residual."""
        now = _Later(self, observer)
        self._write(now, now.value, {}, text)

    def bound(self, observer: Observer, text: str) -> tuple[str, ...]:
        """Append how far tolerances can move the residual; the parameters that have some.

        s = theta dx/dtheta follows s' = (A - l c) s + theta (df/dtheta - l dh/dtheta), and moves
        the residual by k (c s + theta dh/dtheta): the amounts times the tolerances are added up.
        What parameters do together, and through the gain, is of second order and left out.
        """
        pool, builder, n = self.pool, self.builder, len(observer.states)
        tolerance = {v.symbol: abs(v.tolerance) for v in builder.graph.values if v.tolerance}
        parts = [*observer.rates, *observer.entry, *observer.starts, observer.output]
        *parts, output = builder.resolve(parts, tolerance)  # parameters inside derived constants
        rates, entry, starts = (tuple(parts[k : k + n]) for k in (0, n, 2 * n))
        observer = observer._replace(rates=rates, entry=entry, starts=starts, output=output)
        inside = set(symbols(*parts, output))
        if inside.isdisjoint(tolerance):
            self._both(Assign(Ref("residual", self.name), ZERO, text, self.origin))
            return ()
        now = _Later(self, observer)
        further: dict[Expr, tuple[Expr, Expr]] = {}
        amounts: list[tuple[Fraction, Expr]] = []
        for theta in tolerance:
            if theta in inside:
                moved = [pool.symbol(f"{brief(x)} by {brief(theta)}", Kind.EFFORT)
                         for x in observer.states]  # fmt: skip
                after, error = now.moved(moved, theta)
                at_rest = [pool.mul(theta, *_slopes(pool, x, [theta])) for x in starts]
                further |= dict(zip(moved, zip(at_rest, after, strict=True), strict=True))
                amounts.append((tolerance[theta], pool.fn("abs", error)))
        self._write(now, pool.add(*amounts), further, text)
        return tuple(theta.symbol.name for theta in tolerance if theta in inside)

    def _write(
        self, now: _Later, value: Expr, further: Mapping[Expr, tuple[Expr, Expr]], text: str
    ) -> None:
        """Statements for a value, and for all that is remembered: at rest, and a sample later."""
        pairs = list(zip(now.observer.starts, now.states, strict=True))
        kept = dict(zip(now.observer.states, pairs, strict=True)) | dict(further)
        kept |= {last: (u, u) for u, last in now.before.items()}
        if operations([value, *[new for _, new in kept.values()]]) > LARGEST:
            raise TooManyOperations
        memory: dict[Expr, Ref] = {}
        for node in kept:
            name = identifier(brief(node).replace(" ", "_"))
            memory[node] = self._state(name, f"{self.name}: {brief(node)}")
        self._remember(self.first, memory, [at for at, _ in kept.values()], self.pool.zero, text)
        self._remember(self.step, memory, [new for _, new in kept.values()], value, text)

    def _remember(
        self,
        out: list[Assignment],
        memory: Mapping[Expr, Ref],
        new: Sequence[Expr],
        value: Expr,
        text: str,
    ) -> None:
        """The statements of one entry point: everything is read before anything is kept."""

        def leaf(node: Expr) -> Expression | None:
            return memory.get(node) or self._sample(node)

        made = self.builder.hoist, self.builder.is_constant
        work = Procedure(self.pool, leaf, out.append, self.names, f"{self.name}_", *made)
        *found, shown = work.values([*new, value], self.origin)
        kept = []
        for state, expression in zip(memory.values(), found, strict=True):
            now = Ref("local", self.names.new(f"{state.name}_now"))
            out.append(Assign(now, expression, f"{state.name} at this sample", self.origin))
            kept.append(Assign(state, now, f"{state.name}: memory", self.origin))
        out += [*kept, Assign(Ref("residual", self.name), shown, text, self.origin)]


class _Later:
    """An observer from one sample to the next: its `states` there, and the `value` that is seen.

    What is taken at the sample before is in the symbols `before` of the known signals.
    """

    def __init__(self, chain: Chain, observer: Observer) -> None:
        self.pool = pool = chain.pool
        self.observer = observer
        self.time = time = chain.builder.option("sample_time")
        known = symbols(*observer.rates, observer.output, *observer.entry, *observer.starts)
        told = [s for s in dict.fromkeys((*known, observer.measured)) if s in chain.builder.signals]
        self.before = {u: pool.symbol(f"{u.symbol.name} before", Kind.INPUT) for u in told}
        xs, put = observer.states, pool.substitute
        error = pool.sub(observer.measured, observer.output)
        self.gain = gain = self._then(_gain(chain, observer))
        rates = [_sum(pool, (1, f), (g, error)) for f, g in zip(observer.rates, gain, strict=True)]
        self.closed = closed = [self._then(_slopes(pool, f, xs)) for f in rates]  # A - l c

        # with W = 1 - gamma T df/dx: W k1 = f + gamma T df/dt,
        # W k2 = f(x + T k1) - 2 k1 - gamma T df/dt
        change = [pool.sub(u, last) for u, last in self.before.items()]
        drift = [pool.scale(_GAMMA, pool.dot(self._then(_slopes(pool, f, told)), change))
                 for f in rates]  # fmt: skip
        solve = _Solver(pool, _one_minus(pool, pool.scale(_GAMMA, time), closed))
        one = solve([_sum(pool, (1, f), (1, d))
                     for f, d in zip(self._then(rates), drift, strict=True)])  # fmt: skip
        tried = {x: _sum(pool, (1, x), (time, k)) for x, k in zip(xs, one, strict=True)}
        two = solve([_sum(pool, (1, f), (-2, k), (-1, d))
                     for f, k, d in zip(put(rates, tried), one, drift, strict=True)])  # fmt: skip
        half = pool.scale(Fraction(1, 2), time)
        self.states = [_sum(pool, (1, x), (half, _sum(pool, (3, k), (1, m))))
                       for x, k, m in zip(xs, one, two, strict=True)]  # fmt: skip
        self.slopes = self._then(_slopes(pool, observer.output, xs))
        entry = self._then(observer.entry)
        bordered = [*[[*row, b] for row, b in zip(closed, entry, strict=True)],
                    [*self.slopes, pool.zero]]  # fmt: skip
        self.scale = pool.div(_determinant(pool, closed), _determinant(pool, bordered))
        seen = put([error], dict(zip(xs, self.states, strict=True)))[0]
        self.value = pool.mul(self.scale, seen)

    def moved(self, before: Sequence[Expr], theta: Expr) -> tuple[list[Expr], Expr]:
        """theta dx/dtheta a sample later, by the implicit rule of Euler, and theta dr/dtheta."""
        pool, observer, time = self.pool, self.observer, self.time
        *own, output = [
            pool.mul(theta, slope)
            for f in (*observer.rates, observer.output)
            for slope in self._then(_slopes(pool, f, [theta]))
        ]
        right = [_sum(pool, (1, s), (time, _sum(pool, (1, f), (-1, pool.mul(g, output)))))
                 for s, f, g in zip(before, own, self.gain, strict=True)]  # fmt: skip
        after = _Solver(pool, _one_minus(pool, time, self.closed))(right)
        error = _sum(pool, (1, pool.dot(self.slopes, after)), (1, output))
        return after, pool.mul(self.scale, error)

    def _then(self, exprs: Sequence[Expr]) -> list[Expr]:
        """Expressions at the sample before."""
        return self.pool.substitute(exprs, self.before)


def _gain(chain: Chain, observer: Observer) -> list[Expr]:
    """l, for slopes that the samples can follow."""
    pool, n, wc = chain.pool, len(observer.states), chain.filter.bandwidth
    limit = pool.div(pool.num(_STEEPEST), chain.builder.option("sample_time"))

    def followed(slope: Expr) -> Expr:
        if chain.builder.is_constant(slope):
            return slope
        return pool.fn("max", pool.neg(limit), pool.fn("min", limit, slope))

    rows = [[followed(a) for a in _slopes(pool, f, observer.states)] for f in observer.rates]
    own = _determinant(pool, rows)
    pace = pool.fn("pow", _sum(pool, (1, pool.power(wc, 2 * n)), (own, own)),
                   pool.num(Fraction(1, 2 * n)))  # fmt: skip
    reached, moved = list(observer.entry), list(observer.entry)
    for _ in range(n - 1):
        reached = [pool.dot(row, reached) for row in rows]
    for _ in range(n):
        moved = [_sum(pool, (1, pool.dot(row, moved)), (pace, v))
                 for row, v in zip(rows, moved, strict=True)]  # fmt: skip
    share = pool.dot(_slopes(pool, observer.output, observer.states), reached)
    return [pool.div(v, share) for v in moved]


class _Solver:
    """A small linear system near the identity, factored once with the pivots of its diagonal."""

    def __init__(self, pool: Pool, rows: Sequence[Sequence[Expr]]) -> None:
        self._pool, self._rows = pool, [list(row) for row in rows]
        for k, pivot in enumerate(self._rows):
            for row in self._rows[k + 1 :]:
                row[k] = pool.div(row[k], pivot[k])
                for j in range(k + 1, len(row)):
                    row[j] = _sum(pool, (1, row[j]), (-1, pool.mul(row[k], pivot[j])))

    def __call__(self, right: Sequence[Expr]) -> list[Expr]:
        """x with rows x = right."""
        pool, found = self._pool, list(right)
        for k, row in enumerate(self._rows):
            found[k] = pool.sub(found[k], pool.dot(row[:k], found[:k]))
        for k in reversed(range(len(found))):
            rest = pool.dot(self._rows[k][k + 1 :], found[k + 1 :])
            found[k] = pool.div(pool.sub(found[k], rest), self._rows[k][k])
        return found


def _determinant(pool: Pool, rows: Sequence[Sequence[Expr]]) -> Expr:
    """By expansion along the first row: most entries are zero."""
    if not rows:
        return pool.one
    terms = []
    for k, x in enumerate(rows[0]):
        if x is not pool.zero:
            minor = _determinant(pool, [[*row[:k], *row[k + 1 :]] for row in rows[1:]])
            terms.append(((-1) ** k, pool.mul(x, minor)))
    return pool.add(*terms)


def _one_minus(pool: Pool, factor: Expr, rows: Sequence[Sequence[Expr]]) -> list[list[Expr]]:
    return [
        [_sum(pool, (int(i == j), pool.one), (-1, pool.mul(factor, x))) for j, x in enumerate(row)]
        for i, row in enumerate(rows)
    ]


def _slopes(pool: Pool, expr: Expr, wrt: Sequence[Expr]) -> list[Expr]:
    return list(sensitivity(pool, expr, wrt).values())


def _sum(pool: Pool, *terms: tuple[int | Expr, Expr]) -> Expr:
    """The sum of factor times value."""
    return pool.add(*[
        (f, x) if isinstance(f, int) else (1, pool.mul(f, x)) for f, x in terms
    ])  # fmt: skip
