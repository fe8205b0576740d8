"""Drawings: well-formed, nothing over anything else, strokes where they belong, same bytes."""

from __future__ import annotations

import itertools
import math
import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from bondgraph.backends.drawing.arrange import arrange
from bondgraph.backends.drawing.canvas import Box, around, between, cross, inside
from bondgraph.backends.drawing.layout import parts
from bondgraph.backends.drawing.scene import scene
from bondgraph.backends.figure import draw
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.expr import Pool
from bondgraph.passes.causality.assign import assign
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source, Span
from tests.unit.backends.legibility import drawn, overlaps
from tests.unit.passes.causality_graphs import assemble, build, receivers

SVG = "{http://www.w3.org/2000/svg}"
MOTOR = "Se:U -> 1:i -> I:L; i -> R:Re; i -> GY:k -> 1:w -> I:J; w -> R:f; w -> Df:speed"
GRAPHS = [
    MOTOR,
    "Se:u -> R:r",
    "C:c -> I:l; 1:alone -> R:s",
    "Se:u -> 1:feed -> R:r0; feed -> 0:b -> 1:p -> R:r1; b -> 1:q -> R:r2; p -> 0:a -> C:c1; "
    "a -> 1:s -> R:r3; s -> 0:d -> C:c2; q -> d; d -> De:y",
    "1:a -> GY:x -> 1:b -> GY:y -> 1:c -> GY:z -> a; a -> I:i; b -> I:j; c -> R:k",
    "1:a -> GY:g -> a; a -> I:m; a -> R:r",
    "0:hub -> R:r1; hub -> R:r2; hub -> R:r3; hub -> R:r4; hub -> R:r5; hub -> R:r6; "
    "hub -> R:r7; hub -> R:r8; hub -> R:r9; hub -> C:c; hub -> De:y; Sf:q -> hub",
    "1:a -> 0:b; b -> 1:c; c -> a; a -> I:a_very_long_name_of_an_inertia; b -> C:x; c -> R:y",
]


def causal(text: str) -> CausalGraph:
    result = assign(build(text), "integral", Report())
    assert result is not None
    return result


def models() -> list[CausalGraph]:
    return [causal(text) for text in GRAPHS]


def tree(svg: str) -> ElementTree.Element:
    return ElementTree.fromstring(svg)


@pytest.mark.parametrize("text", GRAPHS)
def test_nothing_lies_upon_anything_else(text: str) -> None:
    assert overlaps(drawn(causal(text))) == []


@pytest.mark.parametrize("text", GRAPHS)
def test_bonds_run_from_tail_to_head_and_are_long_enough_to_read(text: str) -> None:
    view = scene(causal(text), frozenset())
    figure, _ = arrange(view)
    assert [w.bond for w in figure.wires] == list(range(len(view.graph.bonds)))
    for wire in figure.wires:
        bond = view.graph.bonds[wire.bond]
        for node, end in ((bond.tail.node, wire.points[0]), (bond.head.node, wire.points[-1])):
            item, centre = view.items[node], figure.centre[node]
            assert around(*centre, item.w, item.h).grow(14).holds(Box(*end, *end))
        length = sum(math.dist(p, q) for p, q in itertools.pairwise(wire.points))
        assert length >= 25


def test_strokes_stand_at_the_end_that_receives_the_effort() -> None:
    graph = causal(MOTOR)
    view = scene(graph, frozenset())
    figure, _ = arrange(view)
    root = tree(draw(graph, "motor"))
    bars = [p.attrib["d"] for p in root.iter(f"{SVG}path") if "stroke" in p.attrib["class"]]
    drawn = [b for b in range(len(graph.strokes)) if b != 7]  # the tachometer is a plain arrow
    assert len(bars) == len(drawn)
    at = receivers(graph)
    for b, bar in zip(drawn, bars, strict=True):
        points = [tuple(map(float, p[1:].split(","))) for p in bar.split()]
        middle = tuple(sum(c) / 2 for c in zip(*points, strict=True))
        assert math.dist(points[0], points[1]) == pytest.approx(13, abs=0.3)
        ends = (graph.graph.bonds[b].tail.node, graph.graph.bonds[b].head.node)
        nearest = min(ends, key=lambda n: math.dist(middle, figure.centre[n]))
        assert nearest == at[b]


def test_power_runs_from_left_to_right_and_sources_stand_on_the_left() -> None:
    figure, _ = arrange(scene(causal(MOTOR), frozenset()))
    x = {name: figure.centre[i][0] for i, name in enumerate("U i L Re k w J f speed".split())}
    assert x["U"] < x["i"] < x["k"] < x["w"]
    assert x["L"] == pytest.approx(x["i"]) == x["Re"]


def test_the_tooltip_tells_the_reason_of_a_stroke() -> None:
    titles = [t.text or "" for t in tree(draw(causal(MOTOR), "motor")).iter(f"{SVG}title")]
    assert any(t.startswith("bond 1: U -> i") and "source Se:U" in t for t in titles)
    assert any("I:L receives the effort" in t and "preferred by I:L" in t for t in titles)
    assert any("forced at 1:i by bond 2" in t for t in titles)


def test_dualised_sensors_and_dependent_storages_show() -> None:
    graph = build(MOTOR)
    derivative = assign(graph, "derivative", Report())
    assert derivative is not None
    text = draw(derivative, "motor")
    assert ">SSf<" in text and ">Df<" not in text
    assert text.count('class="derived') == 2
    assert "dashed outline" in text and "grey arrow" not in text
    integral = draw(causal(MOTOR), "motor")
    assert 'class="derived' not in integral
    assert "dashed outline" not in integral and "grey arrow" in integral


def test_a_bond_that_closes_a_ring_has_no_stroke() -> None:
    svg = draw(causal("C:u -> 0:a -> 0:b; a <- b; b -> R:r"), "ring")
    assert svg.count('class="stroke') == 3
    assert svg.count("stroke-dasharray=") == 1
    assert "closes a ring of like junctions at 0:b" in svg


def test_text_is_escaped_and_both_colour_schemes_are_there() -> None:
    svg = draw(causal("Se:u -> R:r"), "a < b & c")
    assert "a &lt; b &amp; c" in svg
    assert "prefers-color-scheme:dark" in svg
    assert tree(svg).findtext(f"{SVG}title") == "a < b & c"


def _named(paths: list[tuple[str, str]], bonds: list[tuple[int, int]]) -> CausalGraph:
    span = Span(Source("x.bg", " "), 0, 1)
    kinds = [(kind, path, False, span) for kind, path in paths]
    graph = assemble(span.source, Pool(), kinds, [(a, b, span) for a, b in bonds])
    result = assign(graph, "integral", Report())
    assert result is not None
    return result


def test_submodels_have_frames_and_single_nodes_their_path() -> None:
    graph = _named(
        [("Se", "U"), ("1", "m.el.i"), ("R", "m.el.R"), ("GY", "m.k"), ("1", "m.me.w"),
         ("I", "m.me.J"), ("TF", "ge.N"), ("R", "load")],
        [(0, 1), (1, 2), (1, 3), (3, 4), (4, 5), (4, 6), (6, 7)],
    )  # fmt: skip
    view = scene(graph, frozenset())
    figure, unframed = arrange(view)
    assert not unframed
    boxes = {".".join(frame.path): frame.box for frame in figure.frames}
    assert sorted(boxes) == ["m", "m.el", "m.me"]
    assert boxes["m"].holds(boxes["m.el"]) and boxes["m"].holds(boxes["m.me"])
    assert not boxes["m.el"].meets(boxes["m.me"])
    for n, at in figure.centre.items():
        path = view.items[n].path
        for name, box in boxes.items():
            within = box.holds(around(*at, view.items[n].w, view.items[n].h))
            assert within == (".".join(path).startswith(name + "."))
    assert [item.name for item in view.items if item.name] == ["U", "R", "k", "J", "ge.N", "load"]


def test_a_frame_that_would_enclose_a_stranger_is_left_out_and_names_get_longer() -> None:
    # s is split by a node that is not its own
    graph = _named(
        [("Se", "U"), ("1", "s.a"), ("0", "t"), ("1", "s.b"), ("R", "s.r"), ("C", "c")],
        [(0, 1), (1, 2), (2, 3), (3, 4), (2, 5)],
    )
    svg = draw(graph, "split")
    assert 'class="frame' not in svg
    assert ">:s.r<" in svg


def _ladder(cells: int) -> CausalGraph:
    paths = [("Se", "U")]
    bonds = []
    last = 0
    for i in range(cells):
        n = len(paths)
        paths += [(kind, f"cell[{i + 1}].{kind}x") for kind in ("1", "I", "R", "0", "C")]
        bonds += [(last, n), (n, n + 1), (n, n + 2), (n, n + 3), (n + 3, n + 4)]
        last = n + 3
    return _named(paths, bonds)


def test_a_long_ladder_is_broken_into_lines() -> None:
    graph = _ladder(60)
    figure, unframed = arrange(scene(graph, frozenset()))
    assert not unframed
    assert figure.size[0] < 2200
    assert len({round(y) for _, y in figure.centre.values()}) > 9
    assert all(frame.path[0].startswith("cell[") for frame in figure.frames)
    assert len(figure.frames) == 60  # lines break between cells, not inside


def test_too_many_nodes_give_a_picture_that_says_so() -> None:
    svg = draw(_ladder(4001), "huge")
    assert "too many for one picture" in svg
    assert tree(svg).tag == f"{SVG}svg"


def test_same_bytes_under_any_hash_seed() -> None:
    code = (
        "from tests.unit.backends.test_figure import models\n"
        "from bondgraph.backends.figure import draw\n"
        "import hashlib\n"
        "text = ''.join(draw(m, 't') for m in models())\n"
        "print(hashlib.sha256(text.encode()).hexdigest())"
    )
    root = Path(__file__).parents[3]
    found = {
        subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True, text=True, check=True, cwd=root,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(root)},
        ).stdout
        for seed in ("0", "7")
    }  # fmt: skip
    assert len(found) == 1


def test_columns_follow_the_arrows_even_round_a_circle() -> None:
    bonds = [(0, 1, 0), (1, 2, 1), (2, 0, 2), (2, 3, 3)]
    (part,) = parts([0, 1, 2, 3], bonds, lambda node, host: False)
    assert [part.column[n] for n in range(4)] == [0, 1, 2, 3]
    back = part.routes[2].vertices
    assert (back[0], back[-1]) == (2, 0) and len(back) == 3  # one bend in column 1
    assert part.row[back[1]] != part.row[1]


def _columns(bonds: list[tuple[int, int, int]]) -> tuple[dict[int, int], dict[int, float]]:
    (part,) = parts(sorted({n for bond in bonds for n in bond[:2]}), bonds)
    return part.column, part.row


def test_the_end_of_a_side_branch_stands_below_what_it_hangs_on() -> None:
    # 2 joins 1, 3 and 4: the row goes on with the bond written first
    column, row = _columns([(0, 1, 0), (1, 2, 1), (2, 3, 2), (2, 4, 3)])
    assert [column[n] for n in range(5)] == [0, 1, 2, 3, 2]
    assert row[0] == row[1] == row[2] == row[3] == row[4] - 1
    # a branch that is longer goes on, whatever is written first
    column, row = _columns([(0, 1, 0), (1, 2, 1), (2, 3, 2), (2, 4, 3), (4, 5, 4)])
    assert column[3] == column[2] and row[2] == row[4] == row[5]


def test_the_middle_of_a_bridge_stands_between_its_ends() -> None:
    upper, lower = [(0, 1), (1, 3), (3, 5), (5, 7)], [(0, 2), (2, 4), (4, 6), (6, 7)]
    bonds = [*upper, *lower, (3, 8), (8, 4)]
    column, row = _columns([(*ends, b) for b, ends in enumerate(bonds)])
    assert column[3] == column[4] == column[8]
    assert abs(row[3] - row[8]) == abs(row[4] - row[8]) == 1
    assert row[0] == row[7] == row[8]


def test_power_runs_to_the_left_where_bonds_would_cross_otherwise() -> None:
    # two sources that feed the same three: one of them stands on the right
    bonds = [(0, 2, 0), (0, 3, 1), (0, 4, 2), (1, 2, 3), (1, 3, 4), (1, 4, 5)]
    column, _ = _columns(bonds)
    assert sorted({column[0], column[1]}) == [0, 2]


def test_geometry() -> None:
    box = Box(0, 0, 10, 10)
    assert inside((-10, 5), (20, 5), box) == pytest.approx((1 / 3, 2 / 3))
    assert inside((-10, 11), (20, 11), box) is None
    assert between((5, 5), (35, 5), box, Box(30, 0, 40, 10)) == ((10, 5), (30, 5))
    assert cross((0, 0), (2, 2), (0, 2), (2, 0))
    assert not cross((0, 0), (2, 2), (2, 2), (4, 0))
