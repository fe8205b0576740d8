"""Drawings as in a textbook: arrows of signals, blocks, values, numbers, boxes, other formats."""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

import bondgraph
from bondgraph.backends.drawing.canvas import Box, Canvas
from bondgraph.backends.drawing.detour import detour
from bondgraph.backends.drawing.pixels import pixels
from bondgraph.backends.drawing.scene import Look
from bondgraph.backends.drawing.shapes import Area, Stroke, Words, shapes
from bondgraph.backends.drawing.signals import Signal, signals
from bondgraph.backends.drawing.tikz import tikz
from bondgraph.cli.main import main
from tests.unit.backends.legibility import drawn

MODELS = sorted((Path(__file__).parents[3] / "models").glob("*.bg"))
CONTROLLED = """\
bg 1
model Heating {
    input goal : K
    param G = 2 W/K
    param C = 100 J/K
    param K = 5 W/K
    Sf:burner = K*(goal - y) -> 0:room -> C:C
    room -> R:loss = 1/G
    room -> De:y
}
"""


def _named(path: str) -> dict[str, Signal]:
    graph = bondgraph.compile(path, open_ports=True).graph
    return {graph.nodes[s.node].path: s for s in signals(graph)}


def test_what_acts_on_a_law_is_found() -> None:
    # The ratio of the crank depends on its angle, the integral of its speed.
    crank = bondgraph.compile("models/slider_crank.bg").graph
    (rod,) = signals(crank)
    assert crank.nodes[rod.node].path == "rod" and rod.names == ("th",) and rod.block
    assert [crank.nodes[n].path for n in rod.origins] == ["crank"]
    # The spool is an input; sources of inputs of their own have no arrow.
    assert {k: (s.names, s.block) for k, s in _named("models/hydraulic_actuator.bg").items()} == {
        "orifice": (("spool",), False)
    }
    assert _named("models/dc_motor.bg") == {}
    assert {k: s.names for k, s in _named("models/oven.bg").items()} == {"power": ("on", "P")}


def test_a_controller_is_a_block_that_gets_its_sensor() -> None:
    compilation = bondgraph.compile(text=CONTROLLED)
    (found,) = signals(compilation.graph)
    nodes = compilation.graph.nodes
    assert nodes[found.node].path == "burner" and found.block and found.label == "f(y, goal)"
    assert [nodes[n].path for n in found.origins] == ["y"]
    (arrow,) = drawn(compilation.integral).arrows
    assert arrow.box is not None and len(arrow.ways) == 1
    svg = compilation.drawing()
    assert "f(y, goal)" in svg and 'class="block' in svg and "thin arrow: signal" in svg
    assert "thin arrow" not in bondgraph.compile("models/dc_motor.bg").drawing()


def test_a_detour_goes_round_texts_and_lines_and_gives_up_in_time() -> None:
    here, to, paper = Box(0, 90, 20, 110), Box(280, 90, 300, 110), Box(0, 0, 300, 200)
    texts, lines = Canvas(), Canvas()

    def length(most: int = 5000) -> float:
        way, seen = detour(here, to, paper, texts, lines, most)
        assert way is not None and seen <= most
        assert all(texts.room_for_line(p, q) for p, q in itertools.pairwise(way))
        assert sum(lines.crossings(p, q) for p, q in itertools.pairwise(way)) == crossed
        return sum(math.dist(p, q) for p, q in itertools.pairwise(way))

    crossed = 0
    free = length()
    assert free == pytest.approx(260, abs=12)  # straight, but for the grid
    lines.line((150, -20), (150, 150))  # below it: a bond with its end at 150
    below = length()
    assert below == pytest.approx(2 * math.hypot(130, 50), rel=0.1)
    texts.box(Box(140, 150, 160, 300))  # no way below without crossing, nor above: the bond is long
    lines.line((150, -20), (150, -100))
    crossed = 1
    assert length() == pytest.approx(260, rel=0.1)
    assert detour(here, to, paper, texts, lines, 5) == (None, 5)
    for side in (Box(260, 70, 320, 80), Box(260, 120, 320, 130), Box(260, 70, 265, 130)):
        texts.box(side)
    texts.box(Box(310, 70, 320, 130))
    assert detour(here, to, paper, texts, lines, 5000)[0] is None


def test_values_numbers_and_boxes_on_request() -> None:
    motor = bondgraph.compile("models/dc_motor.bg")
    plain, full = motor.drawing(), motor.drawing(look=Look(values=True, numbers=True))
    assert "17.6 Ohm" in full and "17.6 Ohm" not in plain
    assert "0.00351 N.m/A" in full  # the modulus of the gyrator
    numbers = {t for t in re.findall(r'class="small faint"[^>]*>(\d+)<', full)}
    assert numbers == {str(b.number) for b in motor.graph.bonds}
    robot = bondgraph.compile("models/khepera.bg")
    boxes = robot.drawing(look=Look(boxes=True))
    names = re.findall(r'class="label kind ink" data-node="[^"]*"[^>]*><title>[^<]*</title>([^<]*)',
                       boxes)  # fmt: skip
    assert names == ["m[1]", "m[2]", "body", "line"]
    assert boxes.count('class="stroke') == 7  # on the bonds that go in and out, not De:Us
    assert ">rotor<" not in boxes


def test_without_title_and_legend() -> None:
    motor = bondgraph.compile("models/dc_motor.bg")
    alone = motor.drawing(look=Look(title=False, legend=False))
    assert 'class="start' not in alone and "half arrow" not in alone
    whole, small = (float(ElementTree.fromstring(s).attrib["height"])
                    for s in (motor.drawing(), alone))  # fmt: skip
    assert small < whole - 40


@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_shapes_are_what_the_svg_has(path: Path) -> None:
    svg = bondgraph.compile(str(path), open_ports=True).drawing(look=Look(values=True))
    size, found = shapes(svg)
    root = ElementTree.fromstring(svg)
    assert size == (float(root.attrib["width"]), float(root.attrib["height"]))
    space = "{http://www.w3.org/2000/svg}"
    lines = [e for e in root.iter() if e.tag in (f"{space}path", f"{space}polyline")]
    assert len([s for s in found if isinstance(s, Stroke)]) == len(
        [e for e in lines if e.get("class") != "hit"]
    )
    areas = [e for e in root.iter() if e.tag in (f"{space}rect", f"{space}polygon")]
    assert len([s for s in found if isinstance(s, Area)]) == len(areas)
    said = sorted("".join(p.text for p in s.pieces) for s in found if isinstance(s, Words))
    texts = []
    for e in root.iter(f"{space}text"):
        title = e.find(f"{space}title")
        whole = "".join(e.itertext())
        texts.append(whole[len(title.text or "") :] if title is not None else whole)
    assert said == sorted(texts)
    for shape in found:
        points = (shape.at,) if isinstance(shape, Words) else shape.points
        assert all(-1 <= x <= size[0] + 1 and -1 <= y <= size[1] + 1 for x, y in points)
        assert all(map(math.isfinite, itertools.chain(*points)))


def test_tikz_is_well_formed_and_escaped() -> None:
    text = 'bg 1\nmodel A_B { Se:U_0 -> R:r_1 = 2 Ohm }'
    made = tikz(bondgraph.compile(text=text).drawing(look=Look(values=True)))
    assert made.count("{") == made.count("}") and r"\textbf{A\_B}" in made
    assert made.count("\\begin{tikzpicture}") == made.count("\\end{tikzpicture}") == 1
    drawn = [line for line in made.splitlines() if line.startswith(("\\path", "\\node"))]
    assert drawn and all(line.endswith(";") for line in drawn)
    assert not re.search(r"[^\x00-\x7f]", made)  # any engine sets it
    bends = tikz(bondgraph.compile("models/slider_crank.bg").drawing())
    assert r"10\(^{-" in tikz(
        bondgraph.compile("models/dc_motor.bg").drawing(look=Look(values=True))
    )
    assert "polyline" not in bends


def test_pictures_are_the_same_bytes_each_time() -> None:
    pytest.importorskip("matplotlib")
    svg = bondgraph.compile("models/slider_crank.bg").drawing()
    png, pdf = pixels(svg, "png"), pixels(svg, "pdf")
    assert png.startswith(b"\x89PNG") and pdf.startswith(b"%PDF")
    assert png == pixels(svg, "png") and pdf == pixels(svg, "pdf")
    assert b"CreationDate" not in pdf


def test_the_ending_says_what_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    heads = {"svg": b"<svg", "png": b"\x89PNG", "pdf": b"%PDF", "tikz": b"% A bond graph"}
    for kind, head in heads.items():
        file = tmp_path / "deep" / f"m.{kind.upper() if kind == 'png' else kind}"
        assert main(["draw", "models/dc_motor.bg", "-o", str(file)]) == 0
        assert file.read_bytes().startswith(head)
    capsys.readouterr()
    for name in ("m.jpg", "m", "m.svg.gz"):
        assert main(["draw", "models/dc_motor.bg", "-o", str(tmp_path / name)]) == 1
        assert "a figure is written as .svg, .png, .pdf or .tikz" in capsys.readouterr().err
        assert not (tmp_path / name).exists()
