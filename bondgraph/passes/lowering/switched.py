"""What a switch that is turned does to a residual, and how its chain deals with that."""

from __future__ import annotations

from bondgraph.algebra.normalise import LIMIT, normalise
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import Expr
from bondgraph.ir.normal import NormalForm, Term
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.filter import FORGOTTEN, Filter, settle
from bondgraph.passes.lowering.jumps import Jumps
from bondgraph.passes.lowering.law_chain import LawChain, order
from bondgraph.passes.lowering.opening import Window
from bondgraph.passes.lowering.program_names import identifier
from bondgraph.passes.lowering.stages import Chain
from bondgraph.passes.lowering.windowed import WindowedChain

_HIGHEST = 4  # order up to which a residual fades in; above, the filter has to forget


class Switched:
    """Decides for each residual of a model with boolean inputs; without these it does nothing.

    A residual whose terms all have the same order zero holds at every sample by itself, whatever
    jumps between two of them. Any other one mixes what is filtered with what is differentiated,
    and starts anew at every mode that may make more jump than the input of its filters.
    """

    def __init__(self, builder: Builder, filter: Filter, system: EquationSystem) -> None:
        self._builder, self._filter = builder, filter
        #: The modes that some residual starts anew at.
        self.read: dict[Expr, None] = {}
        some = any(i.mode for i in system.graph.inputs)
        self._jumps = Jumps(system) if some else None

    def form(self, expr: Expr, form: NormalForm) -> NormalForm:
        """The normal form of a relation for `step`: between two starts a mode stays as it is."""
        if self._jumps is None or form.exact:
            return form
        builder = self._builder
        held = normalise(builder.pool, expr, LIMIT, builder.initials, held=True)
        return form if held.tape is not None else held

    def window(
        self, residual: Residual, terms: tuple[Term, ...], stages: int, laws: int
    ) -> Window | None:
        """How a residual with these terms starts anew; None if it never needs to.

        With `laws` the terms hold derivatives in one of their forms, and fade in in none.
        """
        if self._jumps is None or not (laws or any(t.order > 0 for t in terms)):
            return None
        goes_on = self._jumps.goes_on
        modes = tuple(m for m in self._jumps.modes if not all(goes_on(m, t) for t in terms))
        highest = max(order(t) for t in terms)
        fades = not laws and all(map(self._fades, terms)) and highest <= min(_HIGHEST, stages - 1)
        if not fades and not modes:
            return None
        self.read |= dict.fromkeys(modes)
        over = float(stages) if fades else settle(stages, FORGOTTEN)
        held = settle(laws, FORGOTTEN) if laws else 0.0
        return Window(
            self._builder,
            self._filter,
            identifier(residual.name),
            residual.closing.origin,
            modes,
            over,
            held,
            highest if fades else None,
        )

    def chain(self, residual: Residual, stages: int, laws: int, window: Window | None) -> Chain:
        """The chain that goes with a window."""
        if window is None or window.order is None:
            if laws:
                return LawChain(self._builder, self._filter, residual, stages, laws, window)
            return Chain(self._builder, self._filter, residual, stages, window)
        return WindowedChain(self._builder, self._filter, residual, stages, window)

    def _fades(self, term: Term) -> bool:
        """Whether a term can be multiplied by a window; counts are never made a position."""
        signal = self._builder.signals.get(term.atom)
        counts = signal is not None and signal.scale is not None
        return term.static and not (counts and term.order > 0)
