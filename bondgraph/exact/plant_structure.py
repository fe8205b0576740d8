"""What a plant is before any number is drawn: its symbols, its equations, its parts.

What a relation shows on the part of the plant that its signals hang together with, it shows on the
whole one, and the part is smaller.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from copy import copy
from itertools import chain

from bondgraph.exact.assembly import Assembly, Parts, assemble
from bondgraph.exact.outline import highest_order, outline, rational
from bondgraph.exact.plant_equations import has_sides
from bondgraph.ir.expr import Expr, Kind, Op, topological
from bondgraph.ir.graph import BondGraph

_CONSTANT = (Kind.PARAM, Kind.CONST, Kind.INITIAL, Kind.FREE)


def symbols_of(roots: Iterable[Expr]) -> Iterator[Expr]:
    """The symbols in some expressions, those of each by itself."""
    return chain.from_iterable(outline(root).symbols for root in roots)


class PlantStructure:
    """The symbols of one bond graph, its equations, and the parts that expressions are about.

    `modes` are its boolean inputs, `constants` all else in its equations that does not vary, with
    their `declared` values. `faults` are the symbols that may be faulty, by name, `inputs` the
    known inputs, by name; `readings` names the sensors whose readings a law uses. `limits` are the
    constants and numbers that signals are compared with. Sensors read up to the derivative
    `reach`. `held` are the initial values that states keep, and `asked` is what has to have a value
    besides the sensors, see `holding`.
    """

    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.assembly: Assembly = assemble(graph)
        roots = [
            *[law for _, law in self.assembly.laws],
            *[r.value for r in self.assembly.rates],
            *[reads for _, _, reads in self.assembly.readings],
            *[s.reads for s in graph.sensors],
            *[n.when for n in graph.nodes if n.when is not None],
        ]
        roots += [v.symbol for v in graph.values] + [i.symbol for i in graph.inputs if i.mode]
        found = [n for n in topological(roots) if n.op is Op.SYM]
        self.modes = [n for n in found if n.symbol.kind is Kind.MODE]
        symbols = {v.name: v.symbol for v in graph.sensors}
        symbols |= {v.name: v.symbol for v in graph.inputs}
        symbols |= {v.name: v.symbol for v in graph.values}
        stuck = [i.name for i in graph.inputs if i.mode]  # in the position that they are not told
        self.faults = {name: symbols[name] for name in (*graph.faults, *stuck)}
        self.reach = highest_order([s.reads for s in graph.sensors])
        self.inputs = {i.name: i.symbol for i in graph.inputs if i.known and not i.mode}
        self.readings = {name for name, _, _ in self.assembly.readings}
        self.declared = {v.symbol: v.value for v in graph.values}
        self.limits = _limits(roots)
        self._reads = {s.symbol: s.reads for s in graph.sensors if s.same_as is None}
        self._state_of = _initial_values(graph)
        self._initials: dict[Expr, list[Expr]] = {}
        for initial, state in self._state_of.items():
            self._initials.setdefault(state, []).append(initial)
        self._begins = {i.symbol: state for i, state in self._state_of.items()}
        self.constants = [
            n for n in found if n.symbol.kind in _CONSTANT and n not in self._state_of
        ]
        self.held: tuple[Expr, ...] = ()
        self.asked: tuple[Expr, ...] = ()
        self._forget()

    def _forget(self) -> None:
        """Know no part yet."""
        self._parts: Parts | None = None
        self._cones: dict[Expr, Assembly] = {}
        # by the identity of parts, which are kept
        self._rational: dict[int, bool] = {}
        self._reached: dict[int, frozenset[Expr]] = {}

    def initials(self, state: Expr) -> list[Expr]:
        """The symbols of the initial values of a variable."""
        return self._initials.get(state, [])

    def declared_starts(self) -> list[tuple[Expr, Expr, Expr]]:
        """The declared initial values: the symbol, the state that it is one of, its value."""
        values = self.graph.initial_values()
        starts = self._state_of.items()
        return [(s, state, values[s.symbol]) for s, state in starts if s.symbol in values]

    def holding(self, starts: Mapping[Expr, Expr]) -> PlantStructure:
        """The plant with some states at constant values instead of the rates that they have."""
        whole, pool = self.assembly, self.graph.pool
        held = {whole.place[state][0] for state in starts}

        def put(expr: Expr) -> Expr:
            return pool.substitute([expr], starts)[0]

        rates = [rate for rate in whole.rates if rate.variable not in held]
        dropped = [put(rate.value) for rate in whole.rates if rate.variable in held]
        laws = [(node, put(law)) for node, law in whole.laws]
        laws += [(-1, pool.sub(state, value)) for state, value in starts.items()]
        other = copy(self)
        other.assembly = whole._replace(
            balances=tuple(
                b if b.when is None else b._replace(when=put(b.when)) for b in whole.balances
            ),
            laws=tuple(laws),
            rates=tuple(rate._replace(value=put(rate.value)) for rate in rates),
            readings=tuple((name, at, put(reads)) for name, at, reads in whole.readings),
        )
        other.asked = tuple(dropped)
        other.held = tuple(initial for initial, state in self._state_of.items() if state in starts)
        other._forget()
        return other

    def numbered(self, expr: Expr) -> list[Expr]:
        """The constants with a declared number that the plant or an expression uses."""
        used = dict.fromkeys((*self.constants, *outline(expr).symbols))
        numbers = [s for s in used if (v := self.declared.get(s)) is not None and v.op is Op.NUM]
        return sorted(numbers, key=lambda s: s.id)

    # --------------------------------------------------------------------------- its parts

    def part_for(self, roots: Iterable[Expr]) -> Assembly:
        """The part of the plant that shows the signals in the roots."""
        roots = list(roots)
        seen: dict[Expr, None] = {}
        found = roots
        while found:
            found = [n for n in dict.fromkeys(symbols_of(found)) if n not in seen]
            seen.update(dict.fromkeys(found))
            found = [self._reads[n] for n in found if n in self._reads]
        for root in roots:
            for node in outline(root).nodes if Op.INT in outline(root).ops else ():
                if node.op is Op.INT and node.symbol in self._begins:
                    seen[self._begins[node.symbol]] = None
        seen.update((self._state_of[n], None) for n in list(seen) if n in self._state_of)
        return self._all_parts().about(seen)

    def cone(self, root: Expr) -> Assembly:
        """The sub-plant that a relation can rest on, and no more.

        What does not move the relation there does not move it on the plant.
        """
        found = self._cones.get(root)
        if found is None:
            told = [self._reads.get(s, s) for s in outline(root).symbols]
            place = self.assembly.place
            values = [t for t in told if any(s in place for s in outline(t).symbols)]
            found = self._cones[root] = self._all_parts().resting_on(values)
        return found

    def _all_parts(self) -> Parts:
        if self._parts is None:
            self._parts = Parts(self.assembly)
        return self._parts

    def reached(self, part: Assembly) -> frozenset[Expr]:
        """The symbols that a part of the plant is made of; no other fault can act in it."""
        found = self._reached.get(id(part))
        if found is None:
            roots = _expressions(part)
            roots += [b.when for b in part.balances if b.when is not None]
            own = [symbol for _, symbol, _ in part.shown]
            found = self._reached[id(part)] = frozenset((*symbols_of(roots), *part.place, *own))
        return found

    def rational(self, part: Assembly, roots: Iterable[Expr] = ()) -> bool:
        """Whether a part of the plant, and what is asked of it, are rational.

        A prime field is then as good as the real numbers, and faster.
        """
        if id(part) not in self._rational:
            self._rational[id(part)] = rational(_expressions(part))
        return self._rational[id(part)] and rational(roots)

    def inside(self, part: Assembly, exprs: Iterable[Expr]) -> list[Expr]:
        """Those of the expressions that rest on variables of a part alone."""
        whole = self.assembly.place
        return [e for e in exprs if all(s in part.place for s in outline(e).symbols if s in whole)]


def _expressions(part: Assembly) -> list[Expr]:
    """What laws, rates and sensors of a part say."""
    said = [law for _, law in part.laws] + [r.value for r in part.rates]
    return said + [reads for _, _, reads in (*part.readings, *part.shown)]


def _limits(roots: Iterable[Expr]) -> list[Expr]:
    """The constants and numbers in comparisons, and in functions that have sides."""
    compared = [n for n in topological(roots) if n.op is Op.CMP or has_sides(n)]
    return [
        n for n in topological(compared)
        if n.op is Op.NUM or (n.op is Op.SYM and n.symbol.kind in _CONSTANT)
    ]  # fmt: skip


def _initial_values(graph: BondGraph) -> dict[Expr, Expr]:
    """The symbols of initial values, each with the variable that it is one of."""
    found: dict[Expr, Expr] = {}
    for node in graph.nodes:
        for port in node.ports:
            if port.state is not None:
                name = f"{port.state.symbol.name}.0"  # of one that nobody declared
                found[port.initial or graph.pool.symbol(name, Kind.FREE)] = port.state
    for item in graph.integrals:
        if item.initial.op is Op.SYM:
            found[item.initial] = item.symbol
    return found
