"""What the parts of a residual program share: parameters, signals and the coefficients so far."""

from __future__ import annotations

import math
from collections.abc import Container
from fractions import Fraction
from functools import cached_property
from typing import Literal

from bondgraph.algebra.derivative import Jets
from bondgraph.algebra.numeric import Valued, declared_zero, nominal
from bondgraph.ir.expr import ZERO_START, Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.graph import BondGraph, Input, Sensor, Value
from bondgraph.ir.nodes import constant
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Choice,
    Delayed,
    Expression,
    Field,
    Known,
    Mode,
    Product,
    Ref,
)
from bondgraph.passes.lowering.procedure import ONE, ZERO, Procedure
from bondgraph.passes.lowering.program_names import OPTION, Names, brief, identifier, spoken
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Signal(NamedTuple):
    """A known signal: `scale` and `offset` of an encoder's counts (None for a plain signal)."""

    name: str
    symbol: Expr
    declared: Input | Sensor
    scale: Expr | None
    offset: Expr | None


class _Coef(NamedTuple):
    ref: Ref
    value: Expr
    comment: str
    origin: Span | None


class Builder:
    """Collects the coefficients that configure computes, one for each constant expression."""

    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.pool: Pool = graph.pool
        self.jets = Jets(graph.pool)
        self.values: dict[str, Fraction | float] = nominal(graph)
        self.floats = {name: float(value) for name, value in self.values.items()}
        #: The faults that are declared to be zero.
        self.absent = declared_zero(graph, self.values)
        self.nominal = Valued(self.floats, self.absent)
        self.fields: list[Field] = []
        self.names = Names()
        self.extent: dict[str, list[int]] = {}  # lowest and highest order that exact needs
        self.starts: dict[str, None] = {}
        self.sampled: dict[str, None] = {}
        self.integrals: dict[Expr, Field] = {}
        self.scaled = False
        self.origin: Span | None = None  # of the residual that is being written
        self.prelude: list[Assign] = []  # statements of configure that come first
        self._wanted: list[_Coef] = []
        self._coefs: dict[Expr, Ref] = {}
        self._constant: dict[Expr, bool] = {}
        self._inlined = _definitions(graph)
        self.signals = {s.symbol: s for s in _signals(self.pool, graph)}

    # ------------------------------------------------------------ options

    def option(self, name: str) -> Expr:
        """An argument of configure (`sample_time`, `bandwidth`, `time_unit`) as a symbol."""
        return self.pool.symbol(OPTION + name, Kind.CONST)

    @property
    def initials(self) -> dict[Expr, Expr]:
        """The initial values that are plain numbers, by symbol."""
        return {s: v for s, v in self._inlined.items() if v.op is Op.NUM}

    @property
    def zero_start(self) -> Expr:
        """The initial value of an integral that starts at zero."""
        return self.pool.symbol(ZERO_START, Kind.INITIAL)

    def is_constant(self, node: Expr) -> bool:
        """Whether configure can compute the value."""
        found = self._constant.get(node)
        if found is None:
            found = self._constant[node] = constant(node)
        return found

    def local(self, name: str, value: Expression, comment: str) -> Expr:
        """A value of configure that others are computed from, as a symbol; `name` once."""
        self.names.new(name)
        self.prelude.append(Assign(Ref("local", name), value, comment, None))
        return self.pool.symbol(f"{OPTION}{name}@", Kind.CONST)

    @cached_property
    def fault_symbols(self) -> dict[str, set[Expr]]:
        """The symbols of each fault candidate: its own, and those of its past values."""
        found = {name: {symbol} for name, symbol in self.graph.fault_symbols().items()}
        for signal in self.signals.values():
            found.get(signal.declared.of or "", set()).add(signal.symbol)
        return found

    @cached_property
    def pace(self) -> Expr:
        """bandwidth * time_unit: its powers stay in range where those of either would not."""
        product = Product((Ref("option", "bandwidth"), Ref("option", "time_unit")))
        return self.local("pace", product, "bandwidth*time_unit")

    # ------------------------------------------------------- coefficients

    def coef(self, value: Expr, wish: str, doc: str, origin: Span | None = None) -> Expression:
        """The coefficient that holds a constant expression; a number stands for itself."""
        if value.op is Op.NUM:
            return self.number(value)
        found = self._coefs.get(value)
        if found is None:
            name = self.names.new(wish)
            found = self._coefs[value] = Ref("coef", name)
            self.fields.append(Field(name, "", "", doc, None, origin))
            self._wanted.append(_Coef(found, value, doc, origin))
        return found

    def expression(self, value: Expr) -> Expression:
        """A value of configure that is written out in one place."""
        return Procedure(self.pool, self.leaf, lambda _: None, Names(), "").value(value, None)

    def number(self, value: Expr) -> Expression:
        """A NUM node as an expression of the program."""
        return Procedure(self.pool, lambda _: None, lambda _: None, Names(), "").value(value, None)

    def hoist(self, value: Expr) -> Expression:
        """A constant part of a procedure as a coefficient."""
        wish = identifier(brief(value)) if value.op is Op.SYM else spoken(value)
        return self.coef(value, wish, brief(value), self.origin)

    def array(self, wish: str, size: int, doc: str, origin: Span) -> str:
        """A new array of coefficients, filled by a tape."""
        name = self.names.new(wish)
        self.fields.append(Field(name, "", "", doc, None, origin, size))
        return name

    def element(self, array: str, at: int) -> Expr:
        """An element of an array of coefficients as a symbol, for use in other coefficients."""
        return self.pool.symbol(f"{OPTION}{array}@{at}", Kind.CONST)

    def configure(self) -> list[Assignment]:
        """The statements that compute all coefficients; each stands after what it rests on."""
        out: list[Assignment] = list(self.prelude)
        resolved = self.resolve([w.value for w in self._wanted])
        work = Procedure(self.pool, self.leaf, out.append, self.names, "")
        places: dict[Expr, Span | None] = {}
        for want, root in zip(self._wanted, resolved, strict=True):
            for node in topological([root], stop=places.__contains__):
                places.setdefault(node, want.origin)
        values = work.values(resolved, places)
        for want, value in zip(self._wanted, values, strict=True):
            out.append(Assign(want.ref, value, want.comment, want.origin))
        return out

    @property
    def used(self) -> list[Expr]:
        """What the coefficients are computed from."""
        return [w.value for w in self._wanted]

    def resolve(self, roots: list[Expr], keep: Container[Expr] = ()) -> list[Expr]:
        """The roots with derived constants and initial values replaced by their definitions.

        The symbols in `keep` stay.
        """
        inlined = self._inlined
        if keep:
            inlined = {s: v for s, v in inlined.items() if s not in keep}
        while True:
            replaced = self.pool.substitute(roots, inlined)
            if replaced == roots:
                return roots
            roots = replaced

    def parameters(self, roots: list[Expr]) -> list[Expr]:
        """The symbols of parameters that the roots depend on."""
        found = symbols(*self.resolve(roots))
        return [s for s in found if not s.symbol.name.startswith(OPTION)]

    def leaf(self, node: Expr) -> Expression | None:
        """What configure is given: parameters and options."""
        if node.op is not Op.SYM:
            return None
        name = node.symbol.name
        if name == ZERO_START:
            return ZERO
        if not name.startswith(OPTION):
            return Ref("param", identifier(name))
        own, mark, at = name.removeprefix(OPTION).partition("@")
        if at:
            return Ref("coef", own, int(at))
        return Ref("local", own) if mark else Ref("option", own)

    # -------------------------------------------------------------- fields

    def param_fields(self, roots: list[Expr]) -> tuple[Field, ...]:
        """The parameters that the roots use, in the order of the model."""
        used = {s.symbol.name: s for s in self.parameters(roots) if s.symbol.name != ZERO_START}
        fields = []
        for v in self.graph.values:
            if used.pop(v.name, None) is not None:
                fields.append(_param(v, self.floats.get(v.name)))
        for name in used:  # initial values that the model leaves open
            doc = "initial value, to be given"
            fields.append(Field(identifier(name), name, "", doc, self.floats.get(name), None))
        return tuple(fields)

    def known_fields(self, exprs: list[Expr]) -> tuple[Known, ...]:
        """The known signals that occur in the residuals, inputs before sensors."""
        used = {n for n in topological(exprs) if n in self.signals}
        late = {self.base(n) for n in used if self.signals[n].declared.of}
        return tuple(
            self._known(s)._replace(sampled=True) if n in late else self._known(s)
            for n, s in self.signals.items()
            if n in used | late and not s.declared.of
        )

    def delayed_fields(self, exprs: list[Expr]) -> tuple[Delayed, ...]:
        """The past values that occur in the residuals."""
        used = {n for n in topological(exprs) if n in self.signals}
        return tuple(
            Delayed(self._known(s), self.signals[self.base(n)].name, float(s.declared.delay))
            for n, s in self.signals.items()
            if n in used and s.declared.of
        )

    def base(self, symbol: Expr) -> Expr:
        """The signal that a past value is one of; any other is its own."""
        of = self.signals[symbol].declared.of
        return symbol if of is None else self.pool.symbol(of, symbol.symbol.kind)

    def _known(self, signal: Signal) -> Known:
        declared = signal.declared
        low, high = self.extent.get(signal.name, [0, 0])
        kind: Literal["input", "sensor", "reading", "mode"] = "sensor"
        counts = None
        if isinstance(declared, Input):
            kind = "mode" if declared.mode else "input"
        elif declared.counts is not None:
            value = self.nominal.value(self.resolve([declared.counts])[0])
            counts = 0.0 if value is None else float(value)
        if signal.symbol.symbol.kind is Kind.READING:
            kind = "reading"
        return Known(
            signal.name,
            declared.name,
            declared.unit or "",
            declared.doc,
            kind,
            high,
            low < 0,
            counts,
            declared.origin,
            min(low, 0),
            signal.name in self.starts,
            signal.name in self.sampled or kind == "mode",
            declared.offset,
        )

    # ------------------------------------------------------------- signals

    def need(self, symbol: Expr, order: int) -> Ref:
        """Derivative `order` of a known signal, for exact."""
        name = self.signals[symbol].name
        extent = self.extent.setdefault(name, [order, order])
        extent[0], extent[1] = min(extent[0], order), max(extent[1], order)
        return Ref("known", name, order)

    def mode(self, symbol: Expr) -> Expression:
        """A boolean input as 1 or 0."""
        return Choice(Mode(self.signals[symbol].name), ONE, ZERO)


def _param(v: Value, default: float | None) -> Field:
    return Field(identifier(v.name), v.name, v.unit or "", v.doc, default, v.origin)


def _definitions(graph: BondGraph) -> dict[Expr, Expr]:
    """Symbols that stand for an expression of parameters: derived constants, initial values."""
    found: dict[Expr, Expr] = {}
    for v in graph.values:
        if v.value is not None and not v.fault and symbols(v.value):
            found[v.symbol] = v.value
    for i in graph.integrals:
        if i.initial.op is Op.SYM:
            found[i.initial] = i.initial_value
    for node in graph.nodes:
        for port in node.ports:
            if port.initial is not None and port.initial_value is not None:
                found[port.initial] = port.initial_value
    return {key: value for key, value in found.items() if key is not value}


def _signals(pool: Pool, graph: BondGraph) -> list[Signal]:
    starts = {i.symbol: i.initial for i in graph.integrals}
    found = [Signal(_called(i), i.symbol, i, None, None) for i in graph.inputs if i.known]
    for s in graph.sensors:
        if s.same_as is not None:
            continue
        scale = offset = None
        if s.counts is not None:
            scale = pool.div(pool.num(Fraction(2 * math.pi)), s.counts)
            offset = starts.get(s.reads)
        found.append(Signal(_called(s), s.symbol, s, scale, offset))
    return [*found, *_received(graph, found)]


def _called(item: Input | Sensor) -> str:
    if item.of is None:
        return identifier(item.name)
    return identifier(f"{item.of}_{float(item.delay):g}_s_ago".replace("-", "m"))


def _received(graph: BondGraph, signals: list[Signal]) -> list[Signal]:
    """The readings of the sensors as signals of their own."""
    own = {s.declared.name: s for s in signals}
    taken = {s.name for s in signals}
    found = []
    for symbol, sensor in graph.readings.items():
        name = f"{own[sensor.name].name}_read"
        while name in taken:
            name += "_"
        taken.add(name)
        found.append(own[sensor.name]._replace(name=name, symbol=symbol))
    return found
