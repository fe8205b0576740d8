"""Where sensors could be added, listed by hand."""

from __future__ import annotations

import pytest

from bondgraph.ir.structural_model import StructuralEquation, StructuralModel
from bondgraph.passes.analysis.candidates import bond_graph_places, table_places
from bondgraph.text.source import Source, Span
from tests.unit.passes.circuits import MOTOR, RC, compiled


@pytest.mark.parametrize(
    ("text", "elements", "places"),
    [
        (RC, False, {"Df at s": "s.f", "De at n": "n.e"}),
        (RC, True, {"Df at s": "s.f", "De at n": "n.e", "De at u": "u.e", "De at R": "R.e",
                    "Df at C": "C.f"}),
        (MOTOR, False, {"Df at el": "el.f", "Df at rotor": "rotor.f"}),
        (MOTOR, True, {"Df at el": "el.f", "Df at rotor": "rotor.f", "De at U": "U.e",
                       "De at L": "L.e", "De at R": "R.e", "De at J": "J.e", "De at b": "b.e"}),
    ],
)  # fmt: skip
def test_junctions_have_a_place_each_and_elements_measure_what_their_junction_does_not_share(
    text: str, elements: bool, places: dict[str, str]
) -> None:
    system = compiled(text).equations
    found = bond_graph_places(system, {}, elements)
    unknowns = [v.symbol.name for v in system.unknowns]
    assert {c.name: unknowns[c.unknown] for c in found} == places
    assert [c.cost for c in found] == [1.0] * len(places)


def test_junctions_that_share_their_variable_are_one_place_with_a_cost_of_its_own() -> None:
    text = RC.replace("-> 0:n;", "-> 0:m -> 0:n;")
    found = bond_graph_places(compiled(text).equations, {"s": 2.5, "R": 9.0})
    (effort,) = [c for c in found if c.name.startswith("De")]
    assert effort.name in ("De at m", "De at n") and effort.cost == 1.0
    assert [c.cost for c in found if c.name == "Df at s"] == [2.5]


def test_of_a_table_all_unknowns_are_places_but_for_derivatives() -> None:
    at = Span(Source("t.csv", ""), 0, 0)
    rows = (((0, 1), ("D", "I")), ((1, 2), ("", "")))
    model = StructuralModel(
        "t", ("dx", "x", "z"), (), (),
        tuple(StructuralEquation(f"e{k}", *row, (), (), at) for k, row in enumerate(rows)),
    )  # fmt: skip
    found = table_places(model, {"z": 4.0, "dx": 9.0})
    assert [(c.name, c.unknown, c.cost) for c in found] == [("x", 1, 1.0), ("z", 2, 4.0)]
