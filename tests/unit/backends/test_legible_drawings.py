"""Drawings of all models: nothing lies upon anything else, and nothing crosses that need not."""

from __future__ import annotations

from pathlib import Path

import pytest

import bondgraph
from bondgraph.backends.drawing.scene import Look
from tests.unit.backends.legibility import crossings, drawn, fewest_crossings, missed, overlaps

ROOT = Path(__file__).parents[3]
MODELS = sorted((ROOT / "models").glob("*.bg"))
#: Models of the adversary that are wrong on purpose: there is nothing to draw in them.
WRONG = {"empty_model", "only_param", "se_se", "se_se_across", "self_int", "sf_sf_through"}
ADVERSARY = sorted(
    path for path in (ROOT / "tests" / "adversary" / "models").glob("*.bg")
    if path.stem not in WRONG
)  # fmt: skip
OTHERS = [
    *sorted((ROOT / "tests" / "case_studies").glob("*.bg")),
    *sorted((ROOT / "tests" / "textbook").glob("*.bg")),
    *sorted((ROOT / "tests" / "cases").rglob("*.bg")),
    *ADVERSARY[::6],
    *[path for path in ADVERSARY if path.stem == "h_bridge_legs"],
]
#: Crossings that the layout leaves although another one had fewer. Signals of the steam generator
#: lead from the flows of water to those of heat, round the field that joins both. Three gyrators in
#: a ring are each turned by what stands opposite. The motor of the bridge would have to stand
#: within the bridge, with its shaft.
LEFT = {"steam_generator": 2, "gyrator_ring": 1, "h_bridge_legs": 1}


@pytest.mark.parametrize("path", MODELS + OTHERS, ids=lambda p: f"{p.parent.name}-{p.stem}")
def test_a_drawing_has_no_overlap_no_crossing_and_all_arrows(path: Path) -> None:
    compilation = bondgraph.compile(str(path), open_ports=True)
    for graph in (compilation.integral, compilation.derivative):
        picture = drawn(graph)
        assert overlaps(picture) == []
        assert missed(picture) == []
        found = crossings(picture)
        if found:
            assert len(found) <= fewest_crossings(picture) + LEFT.get(path.stem, 0), found


@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_values_and_numbers_have_room_too(path: Path) -> None:
    causal = bondgraph.compile(str(path), open_ports=True).integral
    assert overlaps(drawn(causal, Look(values=True, numbers=True))) == []


def test_what_is_wrong_is_found() -> None:
    good = drawn(bondgraph.compile(str(ROOT / "models" / "slider_crank.bg")).integral)
    names = {node.path: n for n, node in enumerate(good.view.graph.nodes)}
    figure = good.figure
    rod, friction = names["rod"], names["f"]
    upon = {**figure.centre, friction: figure.centre[rod]}
    said = overlaps(good._replace(figure=figure._replace(centre=upon)))
    assert "R:f lies upon MTF:rod" in said or "MTF:rod lies upon R:f" in said
    (x, y), (to, _) = figure.centre[names["crank"]], figure.centre[rod]
    between = {**figure.centre, friction: ((x + to - 30) / 2, y)}
    said = overlaps(good._replace(figure=figure._replace(centre=between)))
    assert "1:crank - MTF:rod runs through R:f" in said
    nameless = good._replace(figure=figure._replace(tags={}))
    assert "1:crank has no name" in overlaps(nameless)
    small = good._replace(figure=figure._replace(size=(10.0, 10.0)))
    assert any("off the paper" in line for line in overlaps(small))
    (down,) = [
        wire.points for wire in figure.wires
        if good.view.graph.bonds[wire.bond].head.node == friction
    ]  # fmt: skip
    level = (down[0][1] + down[1][1]) / 2
    across = figure.wires[0]._replace(points=((down[0][0] - 9, level), (down[0][0] + 9, level)))
    crossed = figure._replace(wires=(across, *figure.wires[1:]))
    assert crossings(good._replace(figure=crossed)) == ["Se:T - 1:crank crosses 1:crank - R:f"]
    assert missed(good._replace(arrows=())) == ["MTF:rod has no arrow"]
    (arrow,) = good.arrows
    short = arrow._replace(tip=((0.0, 0.0), (5.0, 5.0)))
    assert missed(good._replace(arrows=(short,))) == [
        "the arrow to MTF:rod does not reach it", "the arrow to MTF:rod does not begin at its text",
    ]  # fmt: skip


def test_how_many_crossings_a_graph_needs() -> None:
    # Three junctions, each joined with three others: one of the two graphs of Kuratowski.
    three = "; ".join(f"0:a{i} -> 1:b{i}" for i in range(3))
    more = "; ".join(f"a{i} -> b{j}" for i in range(3) for j in range(3) if i != j)
    rest = "; ".join(f"a{i} -> C:c{i} = 1; b{i} -> I:l{i} = 1" for i in range(3))
    text = f"bg 1\nmodel Three {{ {three}; {more}; {rest} }}"
    picture = drawn(bondgraph.compile(text=text).integral)
    assert fewest_crossings(picture) == 1 <= len(crossings(picture))
    motor = drawn(bondgraph.compile(str(ROOT / "models" / "dc_motor.bg")).integral)
    assert fewest_crossings(motor) == 0 == len(crossings(motor))
