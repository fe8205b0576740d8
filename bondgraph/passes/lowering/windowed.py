"""The chain of stages where switches are turned: each residual starts anew, under a window.

What is filtered is phi r with the window phi of `opening`, that is
sum_k sum_j (-1)**j C(k,j) p**(k-j) (phi^(j) c g_k), by the same stages as r elsewhere (`Chain`):
the products with the window are summed by the order k-j.
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
from bondgraph.passes.lowering.law_chain import order
from bondgraph.passes.lowering.opening import Window
from bondgraph.passes.lowering.procedure import ONE
from bondgraph.passes.lowering.program_names import short
from bondgraph.passes.lowering.stages import Chain, Parts


class WindowedChain(Chain):
    """Writes `first` and `step` of a residual whose terms are all static, under a window."""

    def __init__(
        self,
        builder: Builder,
        filter: Filter,
        residual: Residual,
        stages: int,
        window: Window,
    ) -> None:
        super().__init__(builder, filter, residual, stages, window)
        self.window = window

    def run(self, terms: tuple[Term, ...], text: str) -> None:
        """Append the statements of the residual, made of the given terms."""
        self.highest = max(map(order, terms), default=0)
        faded = [Parts() for _ in self.window.phi]  # by the derivative of the window
        integrals: dict[int, list[Term]] = {}
        by_atom: dict[Expr, list[Term]] = {}
        for term in terms:
            if term.atom is self.pool.one and term.order == 0:
                faded[0].add(0, *self._signed(term.coefficient, "constant", "constant part"))
            elif term.order < 0:
                integrals.setdefault(-term.order, []).append(term)
            else:
                by_atom.setdefault(term.atom, []).append(term)
        self._prepare([*by_atom, *[t.atom for level in integrals.values() for t in level]])
        for atom, own in by_atom.items():
            self._fade(atom, own, faded)
        bare = Parts()
        if integrals:
            self._integrated(integrals, faded[0], bare)
        orders = Parts()
        for phi, parts in zip(self.window.phi, faded, strict=True):
            for k, own_parts in sorted(parts.items()):
                if len(own_parts) == 1:
                    ((sign, value),) = own_parts
                    orders.add(k, sign, Product((phi, value)))
                else:
                    orders.add(k, True, Product((phi, total(own_parts))))
        output = self._horner(self._bent(orders, bare), [])
        self._both(Assign(Ref("residual", self.name), output, text, self.origin))

    def _fade(self, atom: Expr, terms: list[Term], faded: list[Parts]) -> None:
        """Add w**k c of an atom, with each derivative of the window that goes with it."""
        pool, signal = self.pool, self.builder.signals.get(atom)
        weights: dict[tuple[int, int], list[tuple[Fraction | int, Expr]]] = {}
        for term in terms:
            scaled = pool.mul(term.coefficient, pool.power(self.filter.rate, term.order))
            for j in range(term.order + 1):
                number = (-1) ** j * comb(term.order, j)
                weights.setdefault((term.order - j, j), []).append((number, scaled))
        sample = self._static_value(atom) if signal is None or signal.scale is None else None
        words = label(self.builder, atom)
        for k, j in sorted(weights):
            value = pool.add(*weights[k, j])
            if value is pool.zero:
                continue
            if sample is None:
                for part in self._counted(atom, value):
                    faded[j].add(k, *part)
                continue
            fading = f" times derivative {j} of the window" if j else ""
            doc = f"factor of {short(atom, k)}{fading}"
            wish = f"w{k}_{words}" + f"_{j}" * bool(j)
            sign, factor = self._signed(value, wish if k or j else words, doc)
            faded[j].add(k, sign, sample if factor == ONE else Product((factor, sample)))

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

    def _slope(self, rate: Expression, bare: Parts) -> None:
        """phi D of what is integrated is D of phi times it, less phi' times it."""
        phi, change, *_ = self.window.phi
        bare.add(1, False, Product((phi, rate)))
        bare.add(0, True, Product((change, rate)))

    def _stage(self, entry: Expression, wish: str, comment: str) -> Expression:
        """One first-order stage, which forgets where the window is closed."""
        a, b = self.filter.coefficients(self.builder)
        state = self._empty(f"s{wish}", f"memory of {comment}")
        kept = state if self.window.kept == ONE else Product((self.window.kept, state))
        new = Product((b, entry))
        output = self._within(f"y{wish}", total([(True, kept), (True, new)]), comment)
        memory = total([(True, Product((a, output))), (True, new)])
        self._both(Assign(state, memory, f"{comment}: memory", self.origin))
        return output
