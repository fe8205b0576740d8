"""What residuals keep for ever of their first sample: where the positions that they read began."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import TypeAlias

import numpy as np

from bondgraph.ir.expr import Expr, Kind, Op, Symbol, below, symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import Expression, Program, Ref, Sum, flat
from bondgraph.ir.residuals import ResidualSet
from bondgraph.notation.walk import references
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

_Name: TypeAlias = tuple[str, str]  # of a local or a state: its space and its name
_READS = ("known", "increment", "total")


class Memory(NamedTuple):
    """Residuals that remember where the same signals began.

    `signals` are those of whose first sample something stays for ever, `reads` all that may start
    the residuals anew by having no value; both are paths. `integral` says that what stays is a sum
    over all samples since: no later reading tells it. `begins` are the parameters that only say
    where that begins, and are nothing to other memories; `unknown` those with a tolerance: each log
    begins elsewhere, and its samples have to tell where.
    """

    residuals: tuple[str, ...]
    signals: tuple[str, ...]
    reads: tuple[str, ...]
    integral: bool = False
    begins: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()


def memories(graph: BondGraph, residuals: ResidualSet, program: Program) -> tuple[Memory, ...]:
    """The memories of a program, none of them with a signal or a residual of another one.

    A residual remembers the start of an encoder whose counts it adds up, of whatever it has put
    down with its first sample and compares with ever since, and of what it integrates. Residuals
    that share filters start anew together.
    """
    found = _memories(program)
    given = {p.path for p in program.params}
    law = [n.symbol for n in symbols(*(r.expr for r in residuals.residuals))]
    read = behind(graph, [s for s in law if s.kind is not Kind.INITIAL])  # not as starts alone
    own = {v.symbol: v.name for v in graph.values
           if not v.fault and v.name in given and v.symbol.symbol not in read}  # fmt: skip
    reads = {i.name: _starts(graph, own, r.expr, bool(i.follows))
             for r, i in zip(residuals.residuals, program.residuals, strict=True)}  # fmt: skip
    each = [frozenset[str]().union(*[reads.pop(r) for r in m.residuals]) for m in found]
    loose = {v.name for v in graph.values if v.tolerance}.difference(*reads.values())
    return tuple(
        memory._replace(
            begins=tuple(sorted(of.difference(*each[:k], *each[k + 1 :]))),
            unknown=tuple(sorted(of & loose)),
        )
        for k, (memory, of) in enumerate(zip(found, each, strict=True))
    )


def _starts(
    graph: BondGraph, own: Mapping[Expr, str], relation: Expr, follows: bool
) -> frozenset[str]:
    """Those of its `own` parameters that a relation reads as where something begins.

    What an observer reads so nobody asks: it `follows` the machine from wherever that begins.
    """
    if not own or follows:
        return frozenset(own.values())
    # one that sensors add up stands there as what it began with and what they have added since
    begins = [n.symbol for n in symbols(relation) if n.symbol.kind is Kind.INITIAL]
    found = behind(graph, [*begins, *(n.symbol for n in below([relation]) if n.op is Op.INT)])
    return frozenset(name for node, name in own.items() if node.symbol in found)


def behind(graph: BondGraph, found: Iterable[Symbol]) -> set[Symbol]:
    """These symbols, and all by which their values are declared, or where an integral begins."""
    values = graph.initial_values()
    values |= {v.symbol.symbol: v.value for v in graph.values if v.value is not None}
    todo, done = list(found), set[Symbol]()
    while todo:
        symbol = todo.pop()
        if symbol not in done:
            done.add(symbol)
            todo += [s.symbol for s in symbols(values[symbol])] if symbol in values else []
    return done


def _memories(program: Program) -> tuple[Memory, ...]:
    """As `memories`, whatever is known of where they begin."""
    work = _Work(program)
    reached = {r.name: work.reached(r.name) for r in program.residuals if not r.unavailable}
    joined = _joined({name: {n for n in r if n[0] != "known"} for name, r in reached.items()})
    found: list[tuple[set[str], set[str], set[str], bool]] = []
    for name, names in reached.items():
        signals = work.starts(names)
        if not signals:
            continue
        own, integral = {name}, work.adds(names)
        reads = {s for other in joined[name] for s in work.signals(reached[other])}
        for old in [f for f in found if f[1] & signals]:
            found.remove(old)
            own, signals, reads = own | old[0], signals | old[1], reads | old[2]
            integral |= old[3]
        found.append((own, signals, reads, integral))
    modes = {k.name: k.path for k in program.knowns}
    modes |= {d.known.name: modes[d.of] for d in program.delayed}
    paths = {k.name: modes[k.name] for k in program.read if k.kind != "mode"}
    order = [r.name for r in program.residuals]
    return tuple(
        Memory(
            tuple(r for r in order if r in own),
            tuple(dict.fromkeys(path for name, path in paths.items() if name in signals)),
            tuple(dict.fromkeys(path for name, path in modes.items() if name in reads)),
            integral,
        )
        for own, signals, reads, integral in found
    )


def unknown_starts(memories: Sequence[Memory], later: bool) -> tuple[str, ...]:
    """The parameters of starts that samples have to tell, the first or `later` ones of a log.

    Behind a gap the machine is somewhere in its motion, whatever the model declares.
    """
    found = [name for m in memories for name in (m.begins if later else m.unknown)]
    return tuple(dict.fromkeys(found))


def from_the_start(
    engine: Engine, memories: Sequence[Memory], samples: Array, later: bool
) -> Array:
    """For how many samples each residual counts from a start that can be known, (residuals,).

    At the first sample of a log the machine is where the model declares it to be, or where
    parameters say that the samples tell (`unknown_starts`). It is somewhere from where a signal
    that such a residual reads has no number, and throughout samples that are `later` ones of a
    log, behind a gap, if there is no parameter for it.
    """
    found = np.full(len(engine.residuals), len(samples))
    paths = [k.path for k in engine.signals]
    for memory in memories:
        reads = [paths.index(path) for path in memory.reads]
        whole: Mask = np.asarray(np.isfinite(samples[:, reads]).all(axis=1))
        begins = int(np.argmax(whole)) if whole.any() else len(whole)
        lost = np.flatnonzero(~whole[begins:])
        until = begins + int(lost[0]) if len(lost) else len(whole)
        until = 0 if later and not memory.begins else until
        own = [engine.residuals.index(r) for r in memory.residuals]
        found[own] = np.minimum(found[own], until)
    return found


def counted(
    engine: Engine, memories: Sequence[Memory], samples: Array, later: bool, told: Container[str]
) -> Array:
    """As `from_the_start`, without residuals of whose unknown starts not all are `told`."""
    found = from_the_start(engine, memories, samples, later)
    for memory in memories:
        if not all(name in told for name in unknown_starts([memory], later)):
            found[[engine.residuals.index(r) for r in memory.residuals]] = 0
    return found


def up_to_gaps(residuals: Sequence[str], lost: Array) -> str:
    """What there is to say besides where logs are too short, and seconds of them are `lost` so."""
    names = [name for name, own in zip(residuals, lost.tolist(), strict=True) if own]
    if not names:
        return ""
    count = "counts" if len(names) == 1 else "count"
    return (
        f"; {listed(names, 'and')} {count} up to the first gap of each log only, where what they"
        " keep of its start is known"
    )


class _Work:
    """What the statements of a program are made of."""

    def __init__(self, program: Program) -> None:
        self._made: dict[_Name, list[Ref]] = {}
        self._first: dict[_Name, list[Ref]] = {}
        self._kept: dict[_Name, list[_Name]] = {}  # what a value has in it as it is
        lasting: set[_Name] = set()
        for assign in flat(program.first):
            at = (assign.target.space, assign.target.name)
            self._first.setdefault(at, []).extend(references(assign.value))
            lasting.add(at)
        for assign in flat(program.step):
            at = (assign.target.space, assign.target.name)
            self._made.setdefault(at, []).extend(references(assign.value))
            self._kept.setdefault(at, []).extend(_whole(assign.value))
            lasting.discard(at)
        self._lasting = {at for at in lasting if at[0] == "state"}
        self._sums = {at for at in self._kept if at[0] == "state" and self._stays(at)}

    def _stays(self, state: _Name) -> bool:
        """Whether a state is what it was and something more: the memory of an integral."""
        todo, done = [state], {state}
        while todo:
            for at in self._kept.get(todo.pop(), ()):
                if at == state:
                    return True
                if at[0] == "local" and at not in done:
                    done.add(at)
                    todo.append(at)
        return False

    def adds(self, names: set[_Name]) -> bool:
        """Whether an integral is among what was reached."""
        return bool(names & self._sums)

    def reached(self, residual: str) -> set[_Name]:
        """All states and signals that a residual is made of, sample by sample."""
        return self._closed(("residual", residual), self._made)

    def starts(self, names: set[_Name]) -> set[str]:
        """The signals among what was reached whose start stays in it."""
        found = set()
        for space, name in names:
            if space == "known" and ("total", name) in names:
                found.add(name)
            elif (space, name) in self._lasting:
                found |= self.signals(self._closed((space, name), self._first))
            elif (space, name) in self._sums:
                found |= self.signals(self._closed((space, name), self._made))
        return found

    def signals(self, names: Iterable[_Name]) -> set[str]:
        """The signals among what was reached."""
        return {name for space, name in names if space == "known"}

    def _closed(self, start: _Name, made: Mapping[_Name, list[Ref]]) -> set[_Name]:
        found: set[_Name] = set()
        todo, done = [start], {start}
        while todo:
            at = todo.pop()
            for ref in made.get(at, ()):
                if ref.space in _READS:
                    found |= {("known", ref.name), (ref.space, ref.name)}
                    continue
                name = (ref.space, ref.name)
                if ref.space == "state":
                    found.add(name)
                if name not in done:
                    done.add(name)
                    todo.append(name)
        return found


def _joined(shared: Mapping[str, set[_Name]]) -> dict[str, list[str]]:
    """For each residual those that share a state with it, itself among them."""
    states = {name: {n for n in names if n[0] == "state"} for name, names in shared.items()}
    return {
        name: [other for other in states if other == name or states[other] & own]
        for name, own in states.items()
    }


def _whole(value: Expression) -> Iterator[_Name]:
    """What an expression is a sum of, as it is."""
    match value:
        case Ref(space, name):
            yield space, name
        case Sum(terms):
            for sign, term in terms:
                if sign:
                    yield from _whole(term)
