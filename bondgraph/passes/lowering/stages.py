"""The entry point that takes samples: every residual through one chain of first-order stages.

With H = 1/(1 + p/wc) is p = wc (1 - H)/H, so that p**k H**n = wc**k H**(n-k) (1-H)**k: the
residual over (1 + p/wc)**n is a polynomial in H whose coefficients are linear in the samples.
Horner's rule makes it r = H(v1 + H(v2 + ... + H vn)). Each stage is exact for input that is
linear between samples (first-order hold): y = s + b0 u, then s = a y + b1 u, with
a = exp(-wc T), b0 = 1 - (1-a)/(wc T), b1 = 1 - a - b0.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import comb

from bondgraph.algebra.derivative import TooManyOperations, operations
from bondgraph.ir.expr import Expr, Kind, Op
from bondgraph.ir.normal import Term
from bondgraph.ir.program import Assign, Assignment, Expression, Field, Product, Ref, Sum
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder, Signal
from bondgraph.passes.lowering.exactly import LARGEST, label, total
from bondgraph.passes.lowering.filter import Filter
from bondgraph.passes.lowering.integrals import gathered
from bondgraph.passes.lowering.procedure import ONE, Procedure, positive_part
from bondgraph.passes.lowering.program_names import Names, identifier, short


class Chain:
    """Writes `first` and `step` of one residual; nothing is shared with another residual."""

    def __init__(
        self,
        builder: Builder,
        filter: Filter,
        residual: Residual,
        stages: int,
        names: Names | None = None,
    ) -> None:
        self.builder = builder
        self.pool = builder.pool
        self.filter = filter
        self.residual = residual
        self.name = identifier(residual.name)
        self.origin = residual.closing.origin
        self.stages = stages
        self.first: list[Assignment] = []
        self.step: list[Assignment] = []
        self.states: list[Field] = []
        self.names = names or Names()
        self._leaves: dict[tuple[Expr, bool], Expression] = {}
        self._atoms: dict[Expr, Expression] = {}
        self._speeds: dict[str, Expression] = {}
        self._filtered: dict[tuple[Expr, int], Expression] = {}
        self._ladders: dict[Expr, list[Expression]] = {}
        self._static = self._procedure(self._sample)
        self._moving = self._procedure(self._smooth)

    # ---------------------------------------------------------- statements

    def run(self, terms: tuple[Term, ...], text: str) -> None:
        """Append the statements of the residual, made of the given terms.

        Raises `TooManyOperations`, before anything is written, if its nonlinear terms need more
        than `LARGEST`.
        """
        inputs: dict[int, list[tuple[bool, Expression]]] = {}
        outside = self._approximate([t for t in terms if not t.static])
        integrals: dict[int, list[Term]] = {}
        by_atom: dict[Expr, list[Term]] = {}
        for term in terms:
            if not term.static:
                continue
            if term.atom is self.pool.one and term.order == 0:
                outside.append(self._signed(term.coefficient, "constant", "constant part"))
            elif term.order < 0:
                integrals.setdefault(-term.order, []).append(term)
            else:
                by_atom.setdefault(term.atom, []).append(term)
        self._prepare([*by_atom, *[t.atom for level in integrals.values() for t in level]])
        for atom, own in by_atom.items():
            self._enter(atom, own, inputs, outside)
        if integrals:
            inputs.setdefault(self.stages, []).append((True, self._integrals(integrals)))
        output: Expression | None = None
        for m in range(self.stages, 0, -1):
            parts = list(inputs.get(m, []))
            if output is not None:
                parts.insert(0, (True, output))
            if parts:
                entry = self._local(f"u{m}", total(parts), f"{self.name}: input of stage {m}")
                output = self._stage(entry, f"{m}", f"{self.name}: stage {m}")
        if output is not None:
            outside.insert(0, (True, output))
        self._both(Assign(Ref("residual", self.name), total(outside), text, self.origin))

    def _both(self, statement: Assignment) -> None:
        self.first.append(statement)
        self.step.append(statement)

    def _local(self, wish: str, value: Expression, comment: str) -> Expression:
        target = Ref("local", self.names.new(f"{self.name}_{wish}"))
        self._both(Assign(target, value, comment, self.origin))
        return target

    def _state(self, wish: str, doc: str) -> Ref:
        name = self.names.new(f"{self.name}_{wish}")
        self.states.append(Field(name, "", "", doc, None, self.origin))
        return Ref("state", name)

    def _stage(self, entry: Expression, wish: str, comment: str) -> Expression:
        """One first-order stage: its output at this sample."""
        coef, f = self.builder.coef, self.filter
        state = self._state(f"s{wish}", f"memory of {comment}")
        output = Ref("local", self.names.new(f"{self.name}_y{wish}"))
        a = coef(f.a, "a", "filter: exp(-bandwidth*sample_time)")
        b0 = coef(f.b0, "b0", "filter: weight of the new sample")
        b1 = coef(f.b1, "b1", "filter: weight of the sample before")
        rest = coef(f.rest, "rest", "filter: 1 - b0, the memory of a constant 1")
        value = _plus(state, Product((b0, entry)))
        kept = _plus(Product((a, output)), Product((b1, entry)))
        self.step.append(Assign(output, value, comment, self.origin))
        self.step.append(Assign(state, kept, f"{comment}: memory", self.origin))
        self.first.append(Assign(output, entry, f"{comment}, at rest", self.origin))
        self.first.append(Assign(state, Product((rest, entry)), f"{comment}: memory", self.origin))
        return output

    def _signed(self, value: Expr, wish: str, doc: str) -> tuple[bool, Expression]:
        sign, size = positive_part(self.pool, value)
        doc = f"{self.residual.name}: {doc}"
        return sign, self.builder.coef(size, f"{self.name}_{wish}", doc, self.origin)

    # -------------------------------------------------------- linear terms

    def _enter(
        self,
        atom: Expr,
        terms: list[Term],
        inputs: dict[int, list[tuple[bool, Expression]]],
        outside: list[tuple[bool, Expression]],
    ) -> None:
        """Put the terms of one atom at the stages of the chain where they belong."""
        signal = self.builder.signals.get(atom)
        if signal is None or signal.scale is None:
            self._weigh(atom, terms, self._static_value(atom), 0, inputs)
            return
        still = [t for t in terms if t.order == 0]
        moving = [t for t in terms if t.order > 0]
        for term in still:
            scaled = self.pool.mul(term.coefficient, signal.scale)
            sign, factor = self._signed(
                scaled, signal.name, f"factor of the counts of {short(atom)}"
            )
            self.builder.sampled[signal.name] = None
            product = Product((factor, Ref("total", signal.name)))
            inputs.setdefault(self.stages, []).append((sign, product))
            if signal.offset is not None:
                value = self.pool.mul(term.coefficient, signal.offset)
                outside.append(self._signed(value, "offset", f"start of {short(atom)}"))
        if moving:
            self._weigh(atom, moving, self._speed(signal), 1, inputs)

    def _weigh(
        self,
        atom: Expr,
        terms: list[Term],
        sample: Expression,
        speed: int,
        inputs: dict[int, list[tuple[bool, Expression]]],
    ) -> None:
        """Add c p**k H**n of a sample, where the sample is H p of the atom if `speed` is 1."""
        n, pool = self.stages, self.pool
        weights: dict[int, list[tuple[Fraction | int, Expr]]] = {}
        for term in terms:
            k = term.order - speed
            scaled = pool.mul(term.coefficient, pool.power(self.filter.rate, k))
            for j in range(k + 1):
                m = n - term.order + j
                weights.setdefault(m, []).append(((-1) ** j * comb(k, j), scaled))
        words = label(self.builder, atom)
        for m in sorted(weights):
            value = pool.add(*weights[m])
            if value is pool.zero:
                continue
            doc = f"factor of {short(atom)} in stage {m}"
            sign, factor = self._signed(value, f"v{m}_{words}", doc)
            product = sample if factor == ONE else Product((factor, sample))
            inputs.setdefault(m, []).append((sign, product))

    def _speed(self, signal: Signal) -> Expression:
        """H p of an encoder, from the counts of this sample: no position is formed."""
        assert signal.scale is not None
        found = self._speeds.get(signal.name)
        if found is not None:
            return found
        coef, f = self.builder.coef, self.filter
        factor = self.pool.mul(f.count, signal.scale)
        gain = coef(factor, f"{signal.name}_gain", f"speed of {signal.declared.name} for one count")
        a = coef(f.a, "a", "filter: exp(-bandwidth*sample_time)")
        state = self._state(f"{signal.name}_speed", f"filtered speed of {signal.declared.name}")
        speed = Ref("local", self.names.new(f"{self.name}_{signal.name}_speed"))
        self.builder.sampled[signal.name] = None
        count = Ref("increment", signal.name)
        comment = f"filtered speed of {signal.declared.name}"
        value = _plus(Product((a, state)), Product((gain, count)))
        self.step.append(Assign(speed, value, comment, self.origin))
        self.step.append(Assign(state, speed, comment, self.origin))
        zero = self.builder.number(self.pool.zero)
        self.first.append(Assign(speed, zero, f"{comment}, at rest", self.origin))
        self.first.append(Assign(state, speed, comment, self.origin))
        self._speeds[signal.name] = speed
        return speed

    # ----------------------------------------------------------- integrals

    def _integrals(self, levels: dict[int, list[Term]]) -> Expression:
        """All integrals of the residual as one: what is integrated is summed first."""
        inner: Expression | None = None
        for level in range(max(levels), 0, -1):
            parts: list[tuple[bool, Expression]] = []
            if inner is not None:
                parts.append((True, inner))
            for term in levels.get(level, []):
                words = label(self.builder, term.atom)
                sign, factor = self._signed(
                    term.coefficient, f"{words}_int", f"factor of {short(term.atom, -level)}"
                )
                sample = self._static_value(term.atom)
                if sample == ONE:
                    parts.append((sign, factor))
                else:
                    product = sample if factor == ONE else Product((factor, sample))
                    parts.append((sign, product))
            inner = self._trapezoid(total(parts), f"{self.name}: integral")
        assert inner is not None
        return inner

    def _trapezoid(self, rate: Expression, comment: str) -> Expression:
        """The integral of a value since the start."""
        half = self.builder.coef(self.filter.half, "half_time", "half the sample time")
        if not isinstance(rate, Ref):
            rate = self._local("rate", rate, f"{comment}, what is integrated")
        state = self._state("q", f"memory of {comment}")
        value = Ref("local", self.names.new(f"{self.name}_int"))
        gain = Product((half, rate))
        self.step.append(Assign(value, _plus(state, gain), comment, self.origin))
        self.step.append(Assign(state, _plus(value, gain), f"{comment}: memory", self.origin))
        zero = self.builder.number(self.pool.zero)
        self.first.append(Assign(value, zero, f"{comment}, at the start", self.origin))
        self.first.append(Assign(state, gain, f"{comment}: memory", self.origin))
        return value

    def _change(self, value: Expression, comment: str) -> Expression:
        """A value minus what it was at the start."""
        state = self._state("start", f"memory of {comment}")
        change = Ref("local", self.names.new(f"{self.name}_change"))
        difference = Sum(((True, value), (False, state)))
        self.first.append(Assign(state, value, comment, self.origin))
        self._both(Assign(change, difference, comment, self.origin))
        return change

    # -------------------------------------------------------------- leaves

    def _procedure(self, leaf: Callable[[Expr], Expression | None]) -> Procedure:
        return Procedure(
            self.pool,
            leaf,
            self._both,
            self.names,
            f"{self.name}_t",
            self.builder.hoist,
            self.builder.is_constant,
        )

    def _prepare(self, atoms: list[Expr]) -> None:
        """Write the static atoms together, so that what they share is computed once."""
        nonlinear = [a for a in dict.fromkeys(atoms) if a not in self.builder.signals]
        start = self.builder.zero_start
        values = self._static.values(
            [gathered(self.pool, a, start) for a in nonlinear], self.origin
        )
        for atom, value in zip(nonlinear, values, strict=True):
            if not isinstance(value, Ref) and value != ONE:
                value = self._local(label(self.builder, atom), value, short(atom))
            self._atoms[atom] = value

    def _static_value(self, atom: Expr) -> Expression:
        found = self._atoms.get(atom)
        return self._plain(atom) if found is None else found

    def _sample(self, node: Expr) -> Expression | None:
        """A leaf of a static value: a sample, or an integral of samples."""
        return self._leaf(node, False)

    def _smooth(self, node: Expr) -> Expression | None:
        """A leaf of a value with derivatives inside: everything comes from the filter."""
        order, inner = 0, node
        while inner.op is Op.DER:
            order, inner = order + 1, inner.args[0]
        if inner in self.builder.signals and inner.symbol.kind is not Kind.MODE:
            return self._state_variable(inner, order)
        return self._leaf(node, True)

    def _leaf(self, node: Expr, smooth: bool) -> Expression | None:
        if node.op is Op.SYM and node in self.builder.signals:
            if node.symbol.kind is Kind.MODE:
                return self.builder.mode(node)
            return self._state_variable(node, 0) if smooth else self._plain(node)
        if node.op is not Op.INT:
            return None
        found = self._leaves.get((node, smooth))
        if found is None:
            found = self._integral(node, self._moving if smooth else self._static)
            self._leaves[node, smooth] = found
        return found

    def _integral(self, node: Expr, procedure: Procedure) -> Expression:
        inner = node.args[0]
        words = short(inner)
        if inner.op is Op.DER:
            value = self._change(procedure.value(inner.args[0], self.origin), f"change of {words}")
        else:
            rate = procedure.value(gathered(self.pool, inner, self.builder.zero_start), self.origin)
            value = self._trapezoid(rate, f"integral of {words}")
        if node.symbol == self.builder.zero_start.symbol:
            return value
        start = self.pool.symbol(node.symbol.name, node.symbol.kind)
        return _plus(self.builder.hoist(start), value)

    def _plain(self, symbol: Expr) -> Expression:
        signal = self.builder.signals[symbol]
        self.builder.sampled[signal.name] = None
        if signal.scale is None:
            return Ref("known", signal.name)
        found = self._leaves.get((symbol, False))
        if found is None:
            factor = self.builder.hoist(signal.scale)
            value: Expression = Product((factor, Ref("total", signal.name)))
            if signal.offset is not None:
                value = _plus(self.builder.hoist(signal.offset), value)
            found = self._leaves[symbol, False] = self._local(signal.name, value, short(symbol))
        return found

    # ---------------------------------------------------- state variables

    def _approximate(self, terms: list[Term]) -> list[tuple[bool, Expression]]:
        """Nonlinear terms of filtered derivatives, in place of the filtered nonlinear terms."""
        pool, jets = self.pool, self.builder.jets
        end = len(pool) + LARGEST
        exprs: list[Expr] = []
        for term in terms:
            expr = jets.of(term.atom, max(term.order, 0), end - len(pool))
            exprs.append(pool.mul(term.coefficient, expr))
        if operations(exprs) > LARGEST:
            raise TooManyOperations
        exprs = [gathered(pool, expr, self.builder.zero_start) for expr in exprs]
        return [(True, value) for value in self._moving.values(exprs, self.origin)]

    def _state_variable(self, symbol: Expr, order: int) -> Expression:
        """p**order H**n of a known signal, from the outputs of its own chain of n stages."""
        found = self._filtered.get((symbol, order))
        if found is not None:
            return found
        n, pool, signal = self.stages, self.pool, self.builder.signals[symbol]
        speed = 1 if signal.scale is not None and order > 0 else 0
        key = pool.der(symbol) if speed else symbol
        if key not in self._ladders:
            start = self._speed(signal) if speed else self._plain(symbol)
            outputs = [start]
            for j in range(1, n + 1 - speed):
                wish = f"{signal.name}_{'d' if speed else ''}{j}"
                outputs.append(self._stage(outputs[-1], wish, f"{short(key)}: stage {j}"))
            self._ladders[key] = outputs
        outputs = self._ladders[key]
        k = order - speed
        terms = []
        for j in range(k + 1):
            weight, value = comb(k, j), outputs[n - order + j]
            weighed = value if weight == 1 else Product((_number(self, weight), value))
            terms.append((j % 2 == 0, weighed))
        result = total(terms)
        if k:
            factor = pool.power(self.filter.rate, k)
            doc = f"filter: bandwidth^{k}"
            result = Product((self.builder.coef(factor, f"bandwidth_{k}", doc), result))
        if not isinstance(result, Ref):
            result = self._local(
                f"{signal.name}_{order}", result, f"{short(symbol, order)}, filtered"
            )
        self._filtered[symbol, order] = result
        return result


def _number(chain: Chain, value: int) -> Expression:
    return chain.builder.number(chain.pool.num(value))


def _plus(left: Expression, right: Expression) -> Expression:
    return Sum(((True, left), (True, right)))
