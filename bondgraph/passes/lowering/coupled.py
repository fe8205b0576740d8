"""The chain of stages where switches are turned: each residual starts anew, under a window.

As in `Chain` the residual over (1 + p/wc)**n is H(v1 + H(v2 + ... + H vn)). Here what comes out of
a stage is not taken to be linear between samples: all stages together are exact for inputs v that
are, at the price of n(n+1)/2 products in place of n. The window of a start is a signal that
multiplies all others, and without that what it adds would show.
"""

from __future__ import annotations

from fractions import Fraction
from math import comb

from bondgraph.ir.expr import Expr
from bondgraph.ir.normal import Term
from bondgraph.ir.program import Assign, Expression, Product, Ref
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.exactly import label, total
from bondgraph.passes.lowering.filter import Filter
from bondgraph.passes.lowering.opening import Window
from bondgraph.passes.lowering.procedure import ONE, ZERO
from bondgraph.passes.lowering.program_names import short
from bondgraph.passes.lowering.stages import Chain

#: What enters a stage with a derivative of the window, by stage and order of that derivative.
_Inputs = dict[tuple[int, int], list[tuple[bool, Expression]]]


class CoupledChain(Chain):
    """Writes `first` and `step` of a residual whose terms are all static, under a window."""

    def __init__(
        self,
        builder: Builder,
        filter: Filter,
        residual: Residual,
        stages: int,
        window: Window,
    ) -> None:
        super().__init__(builder, filter, residual, stages, window.names)
        self.window = window

    def run(self, terms: tuple[Term, ...], text: str) -> None:
        """Append the statements of the residual, made of the given terms."""
        n = self.stages
        inputs: _Inputs = {}
        integrals: dict[int, list[Term]] = {}
        by_atom: dict[Expr, list[Term]] = {}
        for term in terms:
            if term.atom is self.pool.one and term.order == 0:
                constant = self._signed(term.coefficient, "constant", "constant part")
                inputs.setdefault((n, 0), []).append(constant)
            elif term.order < 0:
                integrals.setdefault(-term.order, []).append(term)
            else:
                by_atom.setdefault(term.atom, []).append(term)
        self._prepare([*by_atom, *[t.atom for level in integrals.values() for t in level]])
        for atom, own in by_atom.items():
            self._fade(atom, own, inputs)
        if integrals:
            inputs.setdefault((n, 0), []).append((True, self._integrals(integrals)))
        entries = {m: self._entry(m, inputs) for m in sorted({m for m, _ in inputs}, reverse=True)}
        output = self._coupled(entries) if entries else ZERO
        target = Ref("residual", self.name)
        self.step.append(Assign(target, output, text, self.origin))
        self.first.append(Assign(target, ZERO, text, self.origin))

    def _fade(self, atom: Expr, terms: list[Term], inputs: _Inputs) -> None:
        """Put phi c p**k of an atom at the stages of the chain where its parts belong."""
        n, pool = self.stages, self.pool
        signal = self.builder.signals.get(atom)
        weights: dict[tuple[int, int], list[tuple[Fraction | int, Expr]]] = {}
        for term in terms:
            scaled = pool.mul(term.coefficient, pool.power(self.filter.rate, term.order))
            for j in range(term.order + 1):
                k = term.order - j
                for i in range(k + 1):
                    number = (-1) ** (i + j) * comb(term.order, j) * comb(k, i)
                    weights.setdefault((n - k + i, j), []).append((number, scaled))
        sample = self._static_value(atom) if signal is None or signal.scale is None else None
        words = label(self.builder, atom)
        for m, j in sorted(weights):
            value = pool.add(*weights[m, j])
            if value is pool.zero:
                continue
            own = inputs.setdefault((m, j), [])
            if sample is None:
                own += self._counted(atom, value)
                continue
            fading = f" times derivative {j} of the window" if j else ""
            doc = f"factor of {short(atom)} in stage {m}{fading}"
            sign, factor = self._signed(value, f"v{m}_{words}" + f"_{j}" * bool(j), doc)
            own.append((sign, sample if factor == ONE else Product((factor, sample))))

    def _counted(self, atom: Expr, value: Expr) -> list[tuple[bool, Expression]]:
        """An encoder as it stands: its counts since the start, and where it stood then."""
        signal = self.builder.signals[atom]
        assert signal.scale is not None
        self.builder.sampled[signal.name] = None
        doc = f"factor of the counts of {short(atom)}"
        sign, factor = self._signed(self.pool.mul(value, signal.scale), signal.name, doc)
        found: list[tuple[bool, Expression]] = [
            (sign, Product((factor, Ref("total", signal.name))))
        ]
        if signal.offset is not None:
            start = self.pool.mul(value, signal.offset)
            found.append(self._signed(start, "offset", f"start of {short(atom)}"))
        return found

    def _entry(self, m: int, inputs: _Inputs) -> Expression:
        """What enters a stage beside the output of the one before."""
        parts: list[tuple[bool, Expression]] = []
        for j, phi in enumerate(self.window.phi):
            own = inputs.get((m, j))
            if own is None:
                continue
            if len(own) == 1:
                parts.append((own[0][0], Product((phi, own[0][1]))))
            else:
                parts.append((True, Product((phi, total(own)))))
        value = total(parts)
        target = Ref("local", self.names.new(f"{self.name}_v{m}"))
        comment = f"{self.name}: input of stage {m}"
        self.step.append(Assign(target, value, comment, self.origin))
        return target

    def _coupled(self, entries: dict[int, Expression]) -> Expression:
        """All stages: the output of the last one at this sample."""
        coef, filter = self.builder.coef, self.filter
        top = max(entries)
        outputs: dict[int, Ref] = {}
        memories: dict[int, Ref] = {}
        for m in range(top, 0, -1):
            state = memories[m] = self._state(f"s{m}", f"memory of {self.name}: stage {m}")
            kept = self.window.kept
            parts: list[tuple[bool, Expression]] = [
                (True, state if kept == ONE else Product((kept, state)))
            ]
            for i, v in entries.items():
                if i >= m:
                    doc = f"filter: weight of the new sample {i - m} stages further"
                    parts.append((True, Product((coef(filter.new(i - m), f"n{i - m}", doc), v))))
            outputs[m] = Ref("local", self.names.new(f"{self.name}_y{m}"))
            self.step.append(
                Assign(outputs[m], total(parts), f"{self.name}: stage {m}", self.origin)
            )
        for m in range(top, 0, -1):
            parts = []
            for i in range(top, m - 1, -1):
                doc = f"filter: what is left of a memory {i - m} stages further"
                left = coef(filter.left(i - m), f"m{i - m}", doc)
                parts.append((True, Product((left, outputs[i]))))
                if i in entries:
                    doc = f"filter: weight of the sample before {i - m} stages further"
                    old = coef(filter.old(i - m), f"o{i - m}", doc)
                    parts.append((True, Product((old, entries[i]))))
            comment = f"{self.name}: memory of stage {m}"
            self.step.append(Assign(memories[m], total(parts), comment, self.origin))
            self.first.append(Assign(memories[m], ZERO, comment, self.origin))
        return outputs[1]
