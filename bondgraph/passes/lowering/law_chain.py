"""The chain of a residual in which laws hold derivatives: friction of a measured position.

A law of filtered signals is not the filtered law. So signals pass the inner filter, which is faster
(`Filter.inner`), and what a law makes of them and their derivatives passes the stages of the chain,
like a sample. All other terms pass both filters behind each other, so that what is linear is exact
(docs/decisions/laws-of-derivatives.md).
"""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import comb

from bondgraph.algebra.derivative import TooManyOperations, operations
from bondgraph.ir.expr import Expr, Kind, Op, topological
from bondgraph.ir.normal import Term
from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Const,
    Expression,
    Function,
    Product,
    Ref,
)
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.exactly import LARGEST, label, total
from bondgraph.passes.lowering.filter import Filter, settle
from bondgraph.passes.lowering.integrals import gathered
from bondgraph.passes.lowering.opening import Window
from bondgraph.passes.lowering.procedure import ONE, ZERO, positive_part
from bondgraph.passes.lowering.program_names import short
from bondgraph.passes.lowering.stages import Chain, Parts, plus

_BEGINS = "begins"  # the coefficient of how fast laws begin, among what stages share


class LawChain(Chain):
    """Writes `first` and `step` of a residual with laws of derivatives, behind `laws` stages."""

    def __init__(
        self,
        builder: Builder,
        filter: Filter,
        residual: Residual,
        stages: int,
        laws: int,
        window: Window | None = None,
    ) -> None:
        super().__init__(builder, filter, residual, stages, window)
        self.laws = laws
        self.held = settle(laws) if window is None else window.held
        self._kept = ONE if window is None else window.kept
        self._filtered: dict[tuple[Expr, int], Expression] = {}
        self._ladders: dict[Expr, list[Expression]] = {}
        self._moving = self._procedure(self._smooth)

    def run(self, terms: tuple[Term, ...], text: str) -> None:
        """Append the statements of the residual, made of the given terms.

        Raises `TooManyOperations`, before anything is written, if its laws need more than
        `LARGEST`.
        """
        self.highest = max([max(t.order, 0) for t in terms], default=0)
        moving = self._moved([t for t in terms if not t.static])
        others = self._output(tuple(t for t in terms if t.static))
        output = self._with_laws(others, moving)
        self._both(Assign(Ref("residual", self.name), output, text, self.origin))

    def _moved(self, terms: list[Term]) -> Parts:
        """Terms with derivatives inside, as w**k c of what their laws are, by their degree k."""
        pool, jets, orders, bare = self.pool, self.builder.jets, Parts(), Parts()
        assert self.laws >= law_stages(terms)
        end = len(pool) + LARGEST
        exprs = [jets.of(t.atom, 0, end - len(pool)) for t in terms]
        if operations(exprs) > LARGEST:
            raise TooManyOperations
        exprs = [gathered(pool, expr, self.builder.zero_start) for expr in exprs]
        values = self._moving.values(exprs, self.origin)
        integrals: dict[int, list[Term]] = {}
        for term, value in zip(terms, values, strict=True):
            self._atoms[term.atom] = value
            if term.order < 0:
                integrals.setdefault(-term.order, []).append(term)
            else:
                k, words = term.order, label(self.builder, term.atom)
                told = f"factor of {short(term.atom, k)}"
                weight = pool.mul(term.coefficient, pool.power(self.filter.rate, k))
                sign, factor = self._signed(weight, f"w{k}_{words}" if k else words, told)
                orders.add(k, sign, value if factor == ONE else Product((factor, value)))
        if integrals:
            self._integrated(integrals, orders, bare)
        return self._bent(orders, bare)

    def _with_laws(self, others: Expression, moving: Parts) -> Expression:
        """All other terms, which pass what the signals in laws do, and the laws, as those do."""
        passed = others
        if others != ZERO:
            value = others if isinstance(others, Ref) else self._local("others", others, "no laws")
            rungs = self._rungs(value, "others", f"{self.name}, all but laws")
            passed = self._derivative(rungs, 0, 0)
        self._hold()
        laws = self._horner(moving, [], self._held_stage)
        return laws if others == ZERO else plus(passed, laws) if moving else passed

    def _hold(self) -> None:
        """While the signals of laws settle, what laws make of that stays out of all memory.

        The first derivatives are those of a start that never was: an exponential of them would be
        remembered for longer than anybody waits. So each sample is the first one until `begun`.
        """
        if _BEGINS in self.gains:
            self.begins = self.gains[_BEGINS].name
            return
        part = self.pool.scale(1 / Fraction(self.held), self.filter.inner.pace)
        doc = f"{self.name}: part of the start of laws that a sample is"
        pace = self.builder.coef(part, f"{self.name}_begins", doc, self.origin)
        assert isinstance(pace, Ref)
        self.gains[_BEGINS], self.begins = pace, pace.name
        state = self._state("begun", f"how far the signals of the laws in {self.name} have settled")
        ahead: Expression = Function("min", (ONE, plus(state, pace)))
        if self._kept != ONE:
            ahead = Product((self._kept, ahead))
        begun = Ref("local", self.names.new(f"{self.name}_begun_now"))
        self.first.append(Assign(begun, ZERO, f"{self.name}: laws begin", self.origin))
        self.step.append(Assign(begun, ahead, f"{self.name}: laws begin", self.origin))
        self._both(Assign(state, begun, f"{self.name}: the same, for the next sample", self.origin))
        a, b = self.filter.coefficients(self.builder)
        held = Compare("<", begun, ONE)
        comment = f"{self.name}: a stage behind laws; it is at rest until these have begun"
        at_rest: dict[str, tuple[Expression, Expression]] = {
            "keep": (ZERO, ONE),
            "b": (ONE, b),
            "a": (Product((Const(-1.0), b)), a),
        }
        for name, (rest, usual) in at_rest.items():
            wish = f"held_{name}"
            gain = self.gains[wish] = Ref("local", self.names.new(f"{self.name}_{wish}"))
            self._both(Assign(gain, Choice(held, rest, usual), comment, self.origin))

    def _held_stage(self, entry: Expression, wish: str, comment: str) -> Expression:
        """One first-order stage behind laws, at rest until these have begun."""
        keep, b, a = (self.gains[f"held_{name}"] for name in ("keep", "b", "a"))
        state = self._empty(f"slaw{wish}", f"memory of {comment}, laws")
        output = Ref("local", self.names.new(f"{self.name}_ylaw{wish}"))
        new = Product((b, entry))
        value = plus(Product((keep, state)), new)
        self._both(Assign(output, value, f"{comment}, laws", self.origin))
        kept = plus(Product((a, output)), new)
        self._both(Assign(state, kept, f"{comment}, laws: memory", self.origin))
        return output

    def _smooth(self, node: Expr) -> Expression | None:
        """A leaf of a law: everything comes from the inner filter."""
        order, inner = 0, node
        while inner.op is Op.DER:
            order, inner = order + 1, inner.args[0]
        if order and inner in self.builder.signals and inner.symbol.kind is not Kind.MODE:
            return self._state_variable(inner, order)
        return self._leaf(node, lambda symbol: self._state_variable(symbol, 0), self._moving)

    def _state_variable(self, symbol: Expr, order: int) -> Expression:
        """p**order F H**n of a known signal, for a law: n stages of the inner filter."""
        found = self._filtered.get((symbol, order))
        if found is not None:
            return found
        signal = self.builder.signals[symbol]
        speed = 1 if signal.scale is not None and order > 0 else 0
        key = self.pool.der(symbol) if speed else symbol
        if key not in self._ladders:
            start = self._speed(signal, self.filter.inner) if speed else self._plain(symbol)
            wish = f"{signal.name}_{'d' if speed else ''}"
            self._ladders[key] = self._rungs(start, wish, short(key), speed)
        result = self._derivative(self._ladders[key], order, speed)
        if not isinstance(result, Ref):
            result = self._local(
                f"{signal.name}_{order}", result, f"{short(symbol, order)}, filtered"
            )
        self._filtered[symbol, order] = result
        return result

    def _rungs(self, start: Expression, wish: str, told: str, speed: int = 0) -> list[Expression]:
        """A value and what comes out of each stage of the inner filter."""
        outputs = [start]
        for j in range(1, self.laws + 1 - speed):
            comment = f"{told}: stage {j} before laws"
            outputs.append(self._through(self.filter.inner, outputs[-1], f"{wish}{j}", comment))
        return outputs

    def _derivative(self, outputs: list[Expression], order: int, speed: int) -> Expression:
        """p**order F H**n of what passed the stages of the inner filter."""
        pool = self.pool
        weights: dict[int, list[tuple[int, Expr]]] = {}
        for m, number, factor in self._powers(order, speed):
            weights.setdefault(m, []).append((number, factor))
        terms = []
        for m in sorted(weights, reverse=True):
            sign, value = positive_part(pool, pool.add(*weights[m]))
            doc = f"filter before laws: factor of stage {m} in derivative {order}"
            weight = self.builder.coef(value, f"d{order}_{m}", doc)
            terms.append((sign, outputs[m] if weight == ONE else Product((weight, outputs[m]))))
        return total(terms)

    def _powers(self, order: int, speed: int) -> list[tuple[int, int, Expr]]:
        """p**order F H**n as a polynomial in H, over H D if `speed` is 1.

        Each term as the power of H, a number and a factor; a power may come twice.
        """
        inner = self.filter.inner
        n, k, off = self.laws, order - speed, self.laws - 1 - order
        scale = self.pool.power(inner.rate, k)
        found = [(n - order + j, (-1) ** j * comb(k, j), scale) for j in range(k + 1)]
        if off:
            bend = self.pool.mul(scale, inner.bend)
            found += [
                (n - order - 2 + j, -off * (-1) ** j * comb(k + 2, j), bend) for j in range(k + 3)
            ]
        return found


def order(term: Term) -> int:
    """The highest derivative that a term needs, those inside its atom counted."""
    return max(term.order, 0) + _inside([term])


def law_stages(terms: Iterable[Term]) -> int:
    """The stages that signals pass before the laws of some terms: none where no derivative is in.

    Elsewhere one more than the highest derivative, as of the filter that all terms pass.
    """
    highest = _inside(terms)
    return highest + 1 if highest else 0


def _inside(terms: Iterable[Term]) -> int:
    """The highest derivative that is inside the atom of a term."""
    depth: dict[Expr, int] = {}
    deepest = 0
    for node in reversed(topological([t.atom for t in terms if not t.static])):
        own = depth.get(node, 0)
        deepest = max(deepest, own)
        below = own + 1 if node.op is Op.DER else own
        if node.op is Op.INT:
            below = max(own - 1, 0)
        for arg in node.args:
            depth[arg] = max(depth.get(arg, 0), below)
    return deepest
