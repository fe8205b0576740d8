"""Relations of the plant's own time as relations of a log: each is shifted until all is there.

At the time t a sensor with the delay d says what was at t - d. A relation of what is now would need
what it will say at t + d; so it is looked at later, by the largest delay D of its sensors, where it
needs that sensor at t - (D - d) and an input that acts after c at t - (D + c).
"""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Kind, symbols
from bondgraph.ir.graph import BondGraph, Input, Sensor
from bondgraph.ir.past import past_name
from bondgraph.ir.residuals import Residual, ResidualSet


def log_time(residuals: ResidualSet) -> ResidualSet:
    """The relations with past values as signals of their own, which the graph then has as well."""
    graph = residuals.system.graph
    lags = graph.lags()
    if not lags and not any(i.of for i in graph.inputs):
        return residuals
    shift = _Shift(graph, lags)
    shifted = tuple(map(shift.residual, residuals.residuals))
    graph = graph._replace(
        inputs=(*[i for i in graph.inputs if not i.of], *shift.inputs.values()),
        sensors=(*graph.sensors, *shift.sensors.values()),
    )
    return residuals._replace(system=residuals.system._replace(graph=graph), residuals=shifted)


class _Shift:
    def __init__(self, graph: BondGraph, lags: dict[Expr, Fraction]) -> None:
        self.graph, self.lags = graph, lags
        self.inputs: dict[str, Input] = {}
        self.sensors: dict[str, Sensor] = {}
        self._inputs = {i.symbol: i for i in graph.inputs}
        self._sensors = {s.name: s for s in graph.sensors}

    def residual(self, residual: Residual) -> Residual:
        """A relation, and the steps that lead to it, shifted as a whole."""
        known = [s for s in symbols(residual.expr) if s.kind in KNOWN_SIGNALS]
        late = max([-self.lags.get(s, Fraction(0)) for s in known], default=Fraction(0))
        late = max(late, Fraction(0))
        roots = [residual.expr, residual.raw]
        roots += [e for step in residual.steps for e in (step.value, step.closed)]
        mapping = {
            s: self.past(s, late + self.lags.get(s, Fraction(0)))
            for s in symbols(*roots)
            if s.kind in KNOWN_SIGNALS
        }
        expr, raw, *parts = self.graph.pool.substitute(roots, mapping)
        steps = [
            step._replace(value=parts[2 * k], closed=parts[2 * k + 1])
            for k, step in enumerate(residual.steps)
        ]
        names = {s.symbol.name: new.symbol.name for s, new in mapping.items()}
        orders = {names.get(name, name): order for name, order in residual.orders.items()}
        return residual._replace(expr=expr, raw=raw, steps=tuple(steps), orders=orders)

    def past(self, symbol: Expr, age: Fraction) -> Expr:
        """What the log had of a signal some time ago; a symbol of the same kind."""
        item = self._inputs.get(symbol)
        of, kind = (item.of, Kind.READING) if item is not None and item.of else (None, None)
        base = of or symbol.symbol.name
        kind = kind or symbol.symbol.kind
        if age <= 0:  # below zero in steps alone, of what cancels
            return self.graph.pool.symbol(base, kind)
        name = past_name(base, age)
        found = self.graph.pool.symbol(name, kind)
        if base in self._sensors:
            sensor = self._sensors[base]
            own = self.graph.pool.symbol(name, Kind.SENSOR)
            self.sensors[name] = sensor._replace(name=name, symbol=own, delay=age, of=base)
        elif item is not None:
            self.inputs[name] = item._replace(name=name, symbol=found, delay=age, of=base)
        return found
