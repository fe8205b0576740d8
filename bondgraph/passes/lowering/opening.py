"""How a residual starts anew where a switch is turned: its terms fade in under a window.

While phi rises from 0 to 1, step filters phi r in place of r. From r = sum_k p**k g_k follows
phi r = sum_k sum_j (-1)**j C(k,j) p**(k-j) (phi^(j) g_k), which needs no derivative of a signal at
the start: phi and its derivatives vanish there (a modulating function: Shinbrot, 1957). So what was
before the start is forgotten at once and not by the decay of the filter.
"""

from __future__ import annotations

from fractions import Fraction
from math import comb, factorial, perm

from bondgraph.ir.expr import Expr
from bondgraph.ir.program import (
    FEWEST,
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Expression,
    Field,
    Function,
    Logic,
    Mode,
    Opening,
    Product,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.filter import Filter
from bondgraph.passes.lowering.procedure import ONE, ZERO
from bondgraph.passes.lowering.program_names import Names
from bondgraph.text.source import Span


class Window:
    """Writes what the chains of one residual have to know of the time since its last start.

    `over` is that time in time constants until the residual is valid, after `held` of the filter in
    front of laws. With an `order` phi is there too, and enough of its derivatives for terms of that
    order: it is a polynomial that joins 0 and 1 so smoothly that sampling it costs nothing.
    Without, the filter goes on and only waits.
    """

    def __init__(
        self,
        builder: Builder,
        filter: Filter,
        name: str,
        origin: Span,
        modes: tuple[Expr, ...],
        over: float,
        held: float,
        order: int | None,
    ) -> None:
        self.names = Names()
        self.first: list[Assign] = []
        self.step: list[Assign] = []
        self.states: list[Field] = []
        self.order, self.over, self.held = order, over, held
        self._builder, self._filter = builder, filter
        self._name, self._origin = name, origin
        signals = [builder.signals[mode] for mode in modes]
        progress = self._state("open", f"how far {name} has come since its last start, to 1")
        #: 1, or 0 at the sample at which a mode is another one than before.
        self.kept: Expression = self._kept([s.name for s in signals])
        self._fade(progress, over)
        self.opening = Opening(name, progress.name, tuple(s.name for s in signals))

    def _state(self, wish: str, doc: str) -> Ref:
        name = self.names.new(f"{self._name}_{wish}")
        self.states.append(Field(name, "", "", doc, None, self._origin))
        return Ref("state", name)

    def _write(
        self, wish: str, value: Expression, comment: str, start: Expression | None = None
    ) -> Ref:
        """A local value; `start` is what it is on the first sample, if that is something else."""
        target = Ref("local", self.names.new(f"{self._name}_{wish}"))
        for out, own in ((self.step, value), (self.first, value if start is None else start)):
            out.append(Assign(target, own, f"{self._name}: {comment}", self._origin))
        return target

    def _keep(self, state: Ref, value: Expression, start: Expression, comment: str) -> None:
        comment = f"{self._name}: {comment}"
        self.step.append(Assign(state, value, comment, self._origin))
        self.first.append(Assign(state, start, comment, self._origin))

    def _kept(self, modes: list[str]) -> Expression:
        same: list[Condition] = []
        for mode in modes:
            before = self._state(mode, f"{mode} at the sample before")
            same.append(Compare("==", before, Choice(Mode(mode), ONE, ZERO)))
        if not same:
            return ONE
        condition = same[0] if len(same) == 1 else Logic("and", tuple(same))
        named = " and ".join(modes)
        kept = self._write("kept", Choice(condition, ONE, ZERO), f"0 where {named} changes", ONE)
        for state, mode in zip(self.states[1:], modes, strict=True):
            now = Choice(Mode(mode), ONE, ZERO)
            self._keep(Ref("state", state.name), now, now, f"{mode} for the next sample")
        return kept

    def _fade(self, progress: Ref, over: float) -> None:
        """How far the start is gone, and phi with the derivatives that `order` asks for."""
        pool, coef = self._builder.pool, self._builder.coef
        steps = pool.scale(1 / Fraction(over), self._filter.pace)
        if self.held:
            parts = (over, self._filter.pace), (self.held, self._filter.inner.pace)
            took = [(Fraction(n), pool.power(pace, -1)) for n, pace in parts]
            steps = pool.power(pool.add(*took), -1)
        steps = pool.fn("min", steps, pool.num(Fraction(1, FEWEST)))
        pace = coef(steps, f"{self._name}_pace", "part of the start that a sample is")
        ahead = Function("min", (ONE, Sum(((True, progress), (True, pace)))))
        value = ahead if self.kept == ONE else Product((self.kept, ahead))
        u = self._write("u", value, "how much of the start is over", ZERO)
        self._keep(progress, u, u, "the same, for the next sample")
        self.phi: list[Expression] = []
        if self.order is None:
            return
        rest = self._write("rest", Sum(((True, ONE), (False, u))), "how much is to come")
        slope = pool.div(steps, self._filter.turn)
        for j in range(self.order + 1):
            shape = _shape(self.order + 1, j, u, rest)
            if j:
                doc = f"1/w of the filter as part of the start, to the power {j}"
                scale = coef(pool.power(slope, j), f"{self._name}_slope{j}", doc)
                shape = Product((scale, shape))
            what = f"derivative {j} of the window" if j else "the window"
            self.phi.append(self._write(f"phi{j}", shape, what))


def _shape(smooth: int, j: int, u: Expression, rest: Expression) -> Expression:
    """Derivative j of the polynomial S of degree 2 `smooth` + 1 that joins 0 and 1.

    Its first `smooth` derivatives vanish at both ends: S' is proportional to (u (1-u))**smooth, and
    S is u**(smooth+1) sum_i C(smooth+i, i) (1-u)**i, a sum of positive terms.
    """
    if j == 0:
        terms = [comb(smooth + i, i) for i in range(smooth + 1)]
        return Product((_power(u, smooth + 1), _horner(terms, rest)))
    m = j - 1
    height = factorial(2 * smooth + 1) // factorial(smooth) ** 2
    # by Leibniz' rule, with what all terms share in front
    terms = [
        (-1) ** (m - i) * comb(m, i) * perm(smooth, i) * perm(smooth, m - i) for i in range(m + 1)
    ]
    shared = (_power(u, smooth - m), _power(rest, smooth - m))
    if m == 0:
        return Product((Const(float(height)), *shared))
    parts = []
    for i, number in enumerate(terms):
        factors = [Const(float(abs(number) * height))]
        factors += [_power(x, e) for x, e in ((u, m - i), (rest, i)) if e]  # type: ignore[misc]
        parts.append((number > 0, Product(tuple(factors))))
    parts.sort(key=lambda p: not p[0])
    return Product((Sum(tuple(parts)), *shared))


def _power(value: Expression, exponent: int) -> Expression:
    return value if exponent == 1 else Function("pow", (value, Const(float(exponent))))


def _horner(numbers: list[int], x: Expression) -> Expression:
    """sum_i numbers[i] x**i."""
    *less, last = numbers
    found: Expression = Const(float(last))
    for number in reversed(less):
        found = Sum(((True, Const(float(number))), (True, Product((x, found)))))
    return found
