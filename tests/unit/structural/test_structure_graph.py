"""The structure of bond graphs: what is extracted, and that it is a bound on what residuals do."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.passes.analysis.candidates import bond_graph_places
from bondgraph.structural.mso import mso_sets
from bondgraph.structural.placement import Placing
from bondgraph.structural.structural_isolability import isolability
from bondgraph.text.source import Source

MODELS = Path(__file__).parents[3] / "models"

CIRCUIT = """bg 1
model Circuit {
    input load : A unknown
    param R = 2 Ohm
    param C = 1 uF
    Se:U -> 1:i
    i -> R:R
    i -> Df:current
    i -> 0:node
    node -> C:C
    node -> Sf:load
    node -> De:voltage
}
"""


def test_extraction_by_hand() -> None:
    model = Compilation(Source("circuit.bg", CIRCUIT)).structure
    named = {
        e.name: (
            {model.unknowns[v]: m for v, m in zip(e.unknowns, e.marks, strict=True)},
            {model.knowns[k] for k in e.knowns},
            {model.faults[f] for f in e.faults},
        )
        for e in model.equations
    }
    assert set(model.faults) == {"R", "C", "U", "current", "voltage"}
    assert named["sensor current"][1:] == ({"current"}, {"current"})
    states, _, _ = named["state C"]
    assert sorted(states.values()) == ["D", "I"]
    assert [v for v, m in states.items() if m == "I"] == ["C.q"]
    assert named["law C"][2] == {"C"}
    assert named["law R"][2] == {"R"}
    assert len(named["balance node"][0]) == 3
    # two sensors and one unknown input leave one relation: U, R, current, voltage
    sets = mso_sets(model)
    assert sets.number == sets.redundancy == 1
    assert {model.faults[f] for f in isolability(model).undetectable} == {"C"}


@pytest.mark.parametrize("name", sorted(p.stem for p in MODELS.glob("*.bg")))
def test_structure_bounds_what_the_residuals_tell_apart(name: str) -> None:
    compilation = bondgraph.compile(str(MODELS / f"{name}.bg"))
    matrix, structure = compilation.signatures, compilation.structure
    best = isolability(structure)
    assert structure.faults == matrix.faults
    assert len(best.groups) >= len(matrix.groups)
    assert {structure.faults[f] for f in best.undetectable} <= set(matrix.undetectable)
    for i, j in permutations(range(len(matrix.faults)), 2):
        rows = zip(matrix.rows[i], matrix.rows[j], strict=True)
        if any(sees and not other for sees, other in rows):
            assert best.isolable(i, j), (matrix.faults[i], matrix.faults[j])
    # nor can combinations of the residuals and their derivatives, which know the laws; modes are
    # nothing that structure knows of: a fault that acts in one of them alone is told by that
    switched = any(i.mode for i in compilation.graph.inputs)
    groups = () if switched else compilation.maximum_isolability or ()
    of = {fault: k for k, group in enumerate(groups) for fault in group}
    for i, j in permutations(range(len(matrix.faults)), 2):
        known = [of.get(matrix.faults[f]) for f in (i, j)]
        assert None in known or known[0] == known[1] or best.isolable(i, j)
    sets = mso_sets(structure, 1000)
    assert sets.redundancy == len(matrix.residuals)
    assert sets.complete and sets.number >= sets.redundancy


def test_places_of_the_robot() -> None:
    compilation = bondgraph.compile(str(MODELS / "khepera.bg"))
    system = compilation.equations
    places = bond_graph_places(system, {"out": 3.0})
    names = [p.name for p in places]
    assert "De at out" in names and "Df at m[1].el.i" in names
    assert places[names.index("De at out")].cost == 3.0
    assert len({p.unknown for p in places}) == len(places)
    more = bond_graph_places(system, {}, elements=True)
    assert {p.unknown for p in places} < {p.unknown for p in more}
    assert "De at m[1].el.L" in [p.name for p in more]


def test_a_placed_sensor_is_one_in_the_model() -> None:
    """The prediction for a place against the structure of the model with that sensor."""
    compilation = Compilation(Source("circuit.bg", CIRCUIT))
    structure = compilation.structure
    places = bond_graph_places(compilation.equations, {}, elements=True)
    placing = Placing(structure, places, faulty=True)
    at = [p.name for p in places].index("Df at C")
    predicted = placing.isolability([at])
    text = CIRCUIT.replace("node -> C:C", "node -> 1:c\n c -> C:C\n c -> Df:extra")
    built = Compilation(Source("circuit.bg", text)).structure
    found = isolability(built)
    faults = [*structure.faults, *["extra"] * len(places)]
    assert {frozenset(faults[f] for f in g) for g in predicted.groups} == {
        frozenset(built.faults[f] for f in g) for g in found.groups
    }
