"""What a healthy machine may do: be off within tolerances, begin anywhere within a count."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from bondgraph.algebra.numeric import declared_zero
from bondgraph.ir.expr import Expr, Op, below, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import Program
from bondgraph.ir.residuals import ResidualSet
from bondgraph.ir.signature_matrix import DoubleFaults, ModeSignatures, SignatureMatrix, stuck
from bondgraph.runtime.diagnosis.dissipation import dissipating_signs
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import ALL, COUNT, Hypothesis, Stuck
from bondgraph.runtime.diagnosis.remembered import Memory, behind, memories
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.parameters import Values, units
from bondgraph.text.tuples import NamedTuple

_COUNT = 1.0  # counts by which the first one of an encoder may be off


class Nature(NamedTuple):
    """How the code of a residual is off where nothing is wrong.

    `modes` are the switches that it reads, `anew` those with which it starts anew. `approximate`
    says that it puts filtered derivatives into a nonlinear law, `stages` and `laws` how long its
    filters are, `order` the highest derivative in it. `drifts` if it adds up readings, and their
    noise, for ever.
    """

    modes: tuple[str, ...]
    approximate: bool
    stages: int
    laws: int
    order: int
    drifts: bool
    anew: tuple[str, ...] = ()


class DiagnosisModel(NamedTuple):
    """What a diagnosis knows of the machine.

    `faults` that some residual sees, with the nominal value of a parameter and None for a signal;
    `tolerances` relative; `sees` for each residual its faults; `groups` the faults that structure
    does not tell apart; `memories` are what residuals keep of their first sample; `natures` by
    residual; `switches` that may be stuck, by the name of the fault. `accepted` are faults that the
    machine is known to have, with the kind of their hypothesis and the deviation of what is known:
    what is nominal is so with them. `dynamic` are the parameters that are multiplied with what
    changes, as those of storages are, and how many derivatives may stand in front of each:
    `SinceOnset` tries these. `signs` are those that parameters may have which are declared to be
    zero, whatever they are now: 1 or -1 where an R would deliver power with the other, else 0 for
    either.
    `reads` are by residual the parameters that may move it; any may move one that is not there.
    `doubles` tells which two faults at once could look like a third one, when it is asked.
    """

    faults: Mapping[str, float | None]
    tolerances: Mapping[str, float]
    units: Mapping[str, str]
    sees: Mapping[str, Sequence[str]]
    groups: Sequence[tuple[str, ...]]
    memories: tuple[Memory, ...]
    natures: Mapping[str, Nature]
    switches: Mapping[str, Stuck]
    doubles: Callable[[], DoubleFaults]
    accepted: Mapping[tuple[str, str], float] = MappingProxyType({})
    dynamic: Mapping[str, Sequence[float]] = MappingProxyType({})
    signs: Mapping[str, int] = MappingProxyType({})
    reads: Mapping[str, frozenset[str]] = MappingProxyType({})

    @property
    def nominal(self) -> dict[str, float]:
        """The nominal values of the parameters among the faults."""
        return {f: v for f, v in self.faults.items() if v is not None}


def diagnosis_model(
    graph: BondGraph,
    residuals: ResidualSet,
    matrix: SignatureMatrix,
    program: Program,
    modes: ModeSignatures,
    doubles: Callable[[], DoubleFaults],
) -> DiagnosisModel:
    """What a diagnosis knows of a model, as far as the code sees its faults at its sample rate."""
    values = Values(graph)
    numbers = {v.name: values.constant(v.symbol) for v in graph.values}
    known = switches(modes, program)
    sees = {
        r.name: (
            *(f for f in r.faults if f not in r.invisible),
            *(f for f, s in known.items() if r.name in s.ever([r.name])),
        )
        for r in program.residuals
        if not r.unavailable
    }
    seen = {f for faults in sees.values() for f in faults}
    return DiagnosisModel(
        {f: numbers.get(f) for f in matrix.faults if f in seen},
        {v.name: float(v.tolerance) for v in graph.values if v.tolerance},
        units(graph),
        sees,
        grouped(matrix, modes, known),
        memories(graph, residuals, program),
        _natures(graph, residuals, program),
        known,
        doubles,
        dynamic=dynamic(graph, residuals),
        signs=dict.fromkeys(declared_zero(graph, numbers), 0) | dissipating_signs(graph),
        reads=parameters_read(graph, residuals, program),
    )


def switches(found: ModeSignatures, program: Program) -> dict[str, Stuck]:
    """The switches that residuals read, on and off, with what shows of it in each mode.

    A mode that the machine cannot be in is left out: what is told is wrong then. So are all where
    they are too many to be listed.
    """
    read = {k.path for k in program.knowns if k.kind == "mode"}
    modes = tuple(name for name in found.names if name in read)
    residuals = {r.path: r.name for r in program.residuals}
    listed = found.modes if len(found.modes) == found.total else ()
    out = {}
    for signal, position in ((m, p) for m in modes for p in (False, True)):
        moves: dict[tuple[bool, ...], frozenset[str]] = {}
        for mode, rows in ((m, m.matrix) for m in listed):
            told = tuple(mode.modes[m] for m in modes)
            if rows is not None:
                other = mode.modes[signal] is not position and signal in rows.faults
                own = rows.seen_by(signal) if other else ()
                moves[told] = moves.get(told, frozenset()).union(residuals[r] for r in own)
        if any(moves.values()) or not moves:
            out[stuck(signal, position)] = Stuck(signal, position, modes, moves)
    return out


def grouped(
    matrix: SignatureMatrix, found: ModeSignatures, known: Mapping[str, Stuck]
) -> list[tuple[str, ...]]:
    """The faults that structure does not tell apart, a switch with one like it in every mode."""
    listed = [(m, m.matrix) for m in found.modes if m.matrix is not None]
    none = (False,) * len(matrix.residuals)
    groups = list(matrix.groups)
    looks: dict[tuple[tuple[bool, ...], ...], int] = {}
    for k, group in enumerate(groups):
        for fault in group:
            looks.setdefault(tuple(rows.row(fault) for _, rows in listed), k)
    for name, switch in known.items():
        own = tuple(
            rows.row(switch.signal)
            if name in m.stuck.values() and switch.signal in rows.faults
            else none
            for m, rows in listed
        )
        at = looks.setdefault(own, len(groups))
        groups[at:] = [(*groups[at], name), *groups[at + 1 :]] if at < len(groups) else [(name,)]
    return groups


def dynamic(graph: BondGraph, residuals: ResidualSet) -> dict[str, tuple[float, ...]]:
    """The parameters that relations multiply with a derivative or differentiate.

    And how many derivatives may stand in front of each when it becomes another. With none what is
    measured goes on; with one it jumps, as of a storage that keeps its charge, and as of what
    resists behind a derivative. `ALL` is one where there is no more, and stands for two and more.
    """
    names = {v.symbol: v.name for v in graph.values if not v.delivery}
    degrees: dict[Expr, int] = {}
    holds: dict[Expr, dict[str, _Derivatives]] = {}
    for node in topological([r.expr for r in residuals.residuals]):
        found: dict[str, _Derivatives] = {names[node]: _Derivatives()} if node in names else {}
        for one in node.args:
            # the terms of a sum do not touch each other
            others = [a for a in node.args if a is not one and node.op is not Op.ADD]
            for name, own in holds[one].items():
                own = own.under(node.op is Op.DER, max((degrees[a] for a in others), default=0))
                found[name] = own.most(found.get(name, own))
        holds[node] = found
        degrees[node] = max((degrees[a] for a in node.args), default=0) + (node.op is Op.DER)
    every: dict[str, _Derivatives] = {}
    for r in residuals.residuals:
        for name, own in holds[r.expr].items():
            every[name] = own.most(every.get(name, own))
    return {name: own.ways for name, own in every.items() if own.front or own.behind}


class _Derivatives(NamedTuple):
    """How many there are in front of a parameter at most, and of what it is multiplied with."""

    front: int = 0
    behind: int = 0

    def under(self, derivative: bool, others: int) -> _Derivatives:
        """The same with one in front of that, or what it is multiplied with."""
        return _Derivatives(self.front + derivative, max(self.behind, others))

    def most(self, other: _Derivatives) -> _Derivatives:
        """Of two places."""
        return _Derivatives(*map(max, self, other))

    @property
    def ways(self) -> tuple[float, ...]:
        """See `dynamic`."""
        if self.front + self.behind <= 1:
            return (0, ALL) if self.front else (0,)
        return (0, 1, ALL)[: min(self.front, 2) + 1]


def parameters_read(
    graph: BondGraph, residuals: ResidualSet, program: Program
) -> dict[str, frozenset[str]]:
    """By residual the parameters that may move it: those of its relation, and of where it begins.

    An observer solves the machine: what it reads nobody asks, and it is left out.
    """
    names = {v.symbol.symbol: v.name for v in graph.values}
    found = {}
    for residual, info in zip(residuals.residuals, program.residuals, strict=True):
        if info.follows:
            continue
        nodes = below([residual.expr])
        done = behind(graph, [n.symbol for n in nodes if n.op in (Op.SYM, Op.INT)])
        found[info.name] = frozenset(names[s] for s in done if s in names)
    return found


def _natures(graph: BondGraph, residuals: ResidualSet, program: Program) -> dict[str, Nature]:
    modes = {i.symbol: i.name for i in graph.inputs if i.mode}
    path = {k.name: k.path for k in program.knowns}
    anew = {o.residual: tuple(path[m] for m in o.modes) for o in program.openings}
    found = {}
    for residual, info in zip(residuals.residuals, program.residuals, strict=True):
        nodes = topological([residual.expr])
        found[info.name] = Nature(
            tuple(modes[n] for n in nodes if n in modes),
            bool(info.approximate),
            info.stages,
            info.laws,
            info.order,
            any(n.op is Op.INT for n in nodes),
            anew.get(info.name, ()),
        )
    return found


def centred(model: DiagnosisModel, residuals: Sequence[str]) -> list[bool]:
    """Which residuals may stand elsewhere than at zero: the mean of their noise is where they do.

    Not those that drift, nor those that stand elsewhere with each position of a switch, or after
    each start.
    """
    remembers = {r for m in model.memories for r in m.residuals}
    natures = [(r, model.natures[r]) for r in residuals]
    return [not (n.drifts or n.modes or r in remembers) for r, n in natures]


def tolerated(
    known: Sequence[Hypothesis], model: DiagnosisModel
) -> tuple[tuple[Hypothesis, ...], Array]:
    """What may be off for ever while all is well, and by how much (standard deviations).

    Parameters within their tolerances, and encoders by one count: where within a count an encoder
    stands when it begins to count, nobody knows. What was accepted by what its estimate may be off.
    """
    found, most = [], []
    for one in known:
        if (one.fault, one.kind) in model.accepted:
            most.append(math.sqrt(3.0) * model.accepted[one.fault, one.kind])
        elif one.kind == "value" and model.tolerances.get(one.fault):
            most.append(model.tolerances[one.fault] * abs(model.faults[one.fault] or 0.0))
        elif one.kind == "offset" and one.unit == COUNT:
            most.append(_COUNT)
        else:
            continue
        found.append(one)
    keep = [k for k, size in enumerate(most) if size > 0]
    return tuple(found[k] for k in keep), np.array([most[k] for k in keep]) / math.sqrt(3.0)


def drifting(known: Sequence[Hypothesis]) -> list[int]:
    """Which of what is tolerated drifts in a healthy machine: its parameters, and no count."""
    return [at for at, one in enumerate(known) if one.kind == "value"]


def directions(
    known: Sequence[Hypothesis], model: DiagnosisModel
) -> tuple[tuple[Hypothesis, ...], Array]:
    """The faults that move residuals with the machine, and the whole of what each changes.

    Parameters that are not declared to be zero, and gains of signals that are not counted.
    """
    whole = {h: model.faults[h.fault] if h.kind == "value" else 1.0 for h in known
             if h.kind == "value" or (h.kind == "gain" and h.level > 0.0)}  # fmt: skip
    found = {h: size for h, size in whole.items() if size and not h.zero}
    return tuple(found), np.array(list(found.values()))


def as_it_is(
    known: Sequence[Hypothesis], nominal: Mapping[str, float], history: History
) -> dict[str, float]:
    """The values that tolerated parameters of this machine have most probably, by healthy rows.

    Within their tolerances. What healthy rows do not tell is as it is declared.
    """
    off = history.fit_within().tolist()
    return {h.fault: nominal[h.fault] - d
            for h, d in zip(known, off, strict=True) if h.kind == "value"}  # fmt: skip


def slack(known: Sequence[Hypothesis], slopes: Array) -> Array:
    """What the first counts of encoders add to the adaptive threshold; slopes (..., known, r)."""
    own = [k for k, h in enumerate(known) if h.unit == COUNT and h.kind == "offset"]
    return np.asarray(_COUNT * np.abs(slopes[..., own, :]).sum(axis=-2))

