"""Causality as propositional logic, written down from the books, for a SAT and a MaxSAT solver.

One variable a bond: true where the stroke is at the head, so that the head receives the effort.
Nothing of the compiler is used but the nouns of the graph. Literals are those of DIMACS.
"""

from __future__ import annotations

from collections.abc import Container
from itertools import combinations, product

from pysat.examples.rc2 import RC2
from pysat.formula import WCNF
from pysat.solvers import Cadical153

from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph
from tests.unit.passes.causality_graphs import superfluous

Clause = list[int]


def received(graph: BondGraph) -> list[list[int]]:
    """For each node and each bond end at it the literal "this node receives the effort here"."""
    literals: list[list[int]] = [[] for _ in graph.nodes]
    idle = superfluous(graph)
    for variable, bond in enumerate(graph.bonds, 1):
        if variable - 1 in idle:
            continue
        literals[bond.tail.node].append(-variable)
        literals[bond.head.node].append(variable)
    return literals


def law_of(kind: str, efforts: list[int]) -> list[Clause]:
    """What a node demands of its bonds (Karnopp, Margolis and Rosenberg 2012, chapter 5)."""
    flows = [-x for x in efforts]
    match kind:
        case "0" | "TF":
            return _exactly_one(efforts)
        case "1":
            return _exactly_one(flows)
        case "GY":
            a, b = efforts
            return [[a, -b], [-a, b]]
        case "Se" | "Df":  # gives effort; an ideal Df gives the effort zero
            return [[x] for x in flows]
        case "Sf" | "De":
            return [[x] for x in efforts]
        case _:
            return []


def _exactly_one(literals: list[int]) -> list[Clause]:
    return [literals, *[[-a, -b] for a, b in combinations(literals, 2)]]


def hard(
    graph: BondGraph, free: frozenset[str] = frozenset(), off: Container[int] = ()
) -> list[Clause]:
    """What all nodes demand, but for nodes of the `free` kinds.

    A junction that is `off` is a source of zero to all its bonds.
    """
    literals = received(graph)
    zero = {"1": "Sf", "0": "Se"}
    return [
        clause
        for n, node in enumerate(graph.nodes)
        if node.kind not in free
        for clause in law_of(zero[node.kind] if n in off else node.kind, literals[n])
    ]


def modes(graph: BondGraph) -> list[set[int]]:
    """The junctions that are off, for every combination of the conditions that switch them."""
    whens = {n: node.when for n, node in enumerate(graph.nodes) if node.when is not None}
    atoms = {x for when in whens.values() for x in topological([when]) if x.op is Op.SYM}
    names = sorted(atoms, key=lambda x: x.id)
    found = []
    for values in product((True, False), repeat=len(names)):
        truth = dict(zip(names, values, strict=True))
        found.append({n for n, when in whens.items() if not _holds(when, truth)})
    return found


def _holds(when: Expr, truth: dict[Expr, bool]) -> bool:
    match when.op, when.data:
        case Op.SYM, _:
            return truth[when]
        case Op.LOGIC, "not":
            return not _holds(when.args[0], truth)
        case Op.LOGIC, "and":
            return all(_holds(a, truth) for a in when.args)
        case Op.LOGIC, "or":
            return any(_holds(a, truth) for a in when.args)
    raise ValueError(f"a condition that no mode decides: {when}")


def satisfiable(graph: BondGraph, nodes: list[int]) -> bool:
    """Whether strokes exist that suit these nodes, whatever the others say."""
    literals = received(graph)
    clauses = [c for n in nodes for c in law_of(graph.nodes[n].kind, literals[n])]
    with Cadical153(bootstrap_with=clauses) as solver:
        return bool(solver.solve())


def integral(graph: BondGraph) -> list[int]:
    """The literals of the storage ports in integral causality: I takes effort, C takes flow."""
    literals = received(graph)
    signs = {"I": 1, "C": -1}
    return [
        signs[node.kind] * x
        for n, node in enumerate(graph.nodes)
        if node.kind in signs
        for x in literals[n]
    ]


def dualised(graph: BondGraph) -> list[int]:
    """The literals of the detectors as sources, in order: De gives effort, Df gives flow."""
    literals = received(graph)
    signs = {"De": -1, "Df": 1}
    return [
        signs[node.kind] * x
        for n, node in enumerate(graph.nodes)
        if node.kind in signs
        for x in literals[n]
    ]


def answering_flow(graph: BondGraph, nodes: list[int]) -> list[int]:
    """The literals of elements that answer with a flow."""
    literals = received(graph)
    return [x for n in nodes for x in literals[n]]


def most(clauses: list[Clause], groups: list[list[int]]) -> list[int] | None:
    """How many literals of each group can be true at best, the first group being worth most.

    None where the clauses cannot all hold. Exact: core-guided MaxSAT (RC2; Ignatiev, Morgado and
    Marques-Silva 2019).
    """
    formula = WCNF()
    for clause in clauses:
        formula.append(clause)
    weight = 1
    for group in reversed(groups):
        for literal in group:
            formula.append([literal], weight=weight)
        weight *= len(group) + 1
    with RC2(formula) as solver:
        model = solver.compute()
    if model is None:
        return None
    true = set(model)
    return [sum(x in true for x in group) for group in groups]


def first_fit(clauses: list[Clause], literals: list[int]) -> list[bool]:
    """Which literals hold if each in turn is granted where it can be, beside those before it."""
    given: list[int] = []
    answers = []
    with Cadical153(bootstrap_with=clauses) as solver:
        for literal in literals:
            answers.append(bool(solver.solve(assumptions=[*given, literal])))
            given.append(literal if answers[-1] else -literal)
    return answers
