"""The page of textbook figures: what it says of each drawing holds, its pictures are current."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from pathlib import Path

import pytest

import bondgraph
from bondgraph.backends.drawing.canvas import Point, around
from bondgraph.backends.drawing.scene import Look
from tests.docs.pages import ROOT, sections
from tests.unit.backends.legibility import Drawn, crossings, drawn, missed, overlaps

PAGE = ROOT / "docs" / "drawings.md"
LOOK = Look(title=False, legend=False)
_MODEL = re.compile(r"^\[[\w.]+\]\(\.\./(.+\.bg)\)$", re.MULTILINE)
_PICTURE = re.compile(r"^!\[[^\]]+\]\((pictures/.+\.svg)\)$", re.MULTILINE)
_ITEM = re.compile(r"^- (.+?)\.$", re.MULTILINE | re.DOTALL)
_NEAR = 130.0  # px between a junction and what stands around it
#: The sections of the page that have a figure.
FIGURES = {name: text for name, text in sections(PAGE).items() if _PICTURE.search(text)
           and not text.startswith("# ")}  # fmt: skip


class Layout:
    """A drawing as the page speaks of it."""

    def __init__(self, picture: Drawn) -> None:
        self.picture = picture
        self.number = {picture.name(n): n for n in picture.figure.centre}

    def at(self, name: str) -> Point:
        return self.picture.figure.centre[self.number[name]]

    def bonds(self) -> set[frozenset[int]]:
        return {frozenset((b.tail.node, b.head.node)) for b in self.picture.view.graph.bonds}

    def row(self, *names: str) -> bool:
        places = [self.at(name) for name in names]
        return self.joined(names) and all(
            abs(p[1] - q[1]) < 1 and p[0] < q[0] for p, q in itertools.pairwise(places)
        )

    def upright(self, *names: str) -> bool:
        places = [self.at(name) for name in names]
        return self.joined(names) and all(
            abs(p[0] - q[0]) < 1 and p[1] < q[1] for p, q in itertools.pairwise(places)
        )

    def joined(self, names: tuple[str, ...]) -> bool:
        """Whether each is joined to the next, but for a bridge that others lead to."""
        numbers = [self.number[name] for name in names]
        together = [frozenset(pair) in self.bonds() for pair in itertools.pairwise(numbers)]
        return together[0] and together[-1]

    def above(self, of: str, *names: str) -> bool:
        return all(self.at(name)[1] < self.at(of)[1] - 15 for name in names)

    def below(self, of: str, *names: str) -> bool:
        return all(self.at(name)[1] > self.at(of)[1] + 15 for name in names)

    def around(self, of: str, *names: str) -> bool:
        (x, y), here = self.at(of), self.number[of]
        return all(
            frozenset((here, self.number[name])) in self.bonds()
            and max(abs(self.at(name)[0] - x), abs(self.at(name)[1] - y)) < _NEAR
            for name in names
        )

    def frame(self, path: str, *names: str) -> bool:
        """Whether these and no others stand in the frame, as far as nodes of its own go."""
        (box,) = [f.box for f in self.picture.figure.frames if ".".join(f.path) == path]
        own = {name for name in self.number if name.partition(":")[2].startswith(path + ".")}
        within = {name for name in self.number if box.holds(around(*self.at(name), 1, 1))}
        return within == own and own >= set(names)

    def signal(self, label: str, to: str) -> bool:
        """Whether a text with an arrow acts on an element."""
        return any(
            a.signal.label == label and a.box is not None and not a.ways
            for a in self.picture.arrows
            if a.signal.node == self.number[to]
        )

    def acts(self, origin: str, to: str) -> bool:
        """Whether an arrow leads straight from a node to an element."""
        return any(
            a.box is None and self.begins(a.tip, origin)
            for a in self.picture.arrows
            if a.signal.node == self.number[to]
        )

    def through(self, origin: str, to: str, block: str) -> bool:
        """Whether a way leads from a node to a block, and an arrow from there to an element."""
        arrows = self.picture.arrows
        (arrow,) = [a for a in arrows if a.signal.node == self.number[to]]
        whole = [a for a in arrows if a.box is not None and a.signal.names == arrow.signal.names
                 and a.signal.label == block]  # fmt: skip
        return any(
            any(self.begins(way, origin) for way in a.ways)
            and a.box is not None
            and a.box.grow(5).holds(around(*arrow.tip[0], 0, 0))
            for a in whole
        )

    def begins(self, way: tuple[Point, ...], origin: str) -> bool:
        item = self.picture.view.items[self.number[origin]]
        return around(*self.at(origin), item.w, item.h).grow(6).holds(around(*way[0], 0, 0))


#: How an item of the page is written, and what it says of a layout.
SAYINGS: list[tuple[str, Callable[..., bool]]] = [
    (r"In a row from left to right: (.+)", Layout.row),
    (r"Upright from top to bottom: (.+)", Layout.upright),
    (r"Above (`[^`]+`): (.+)", Layout.above),
    (r"Below (`[^`]+`): (.+)", Layout.below),
    (r"Around (`[^`]+`): (.+)", Layout.around),
    (r"In the frame (`[^`]+`): (.+)", Layout.frame),
    (r"The signal (`[^`]+`) acts on (`[^`]+`)", Layout.signal),
    (r"(`[^`]+`) acts on (`[^`]+`) through (`[^`]+`)", Layout.through),
    (r"(`[^`]+`) acts on (`[^`]+`)", Layout.acts),
]


def holds(layout: Layout, item: str) -> bool:
    """Whether an item of the page is true of a layout; an item that no one understands is not."""
    for form, check in SAYINGS:
        if re.fullmatch(form, item):
            return check(layout, *re.findall(r"`([^`]+)`", item))
    return False


def _compiled(text: str) -> bondgraph.Compilation:
    (model,) = _MODEL.findall(text)
    return bondgraph.compile(str(ROOT / model))


def test_there_are_twelve_figures() -> None:
    assert len(FIGURES) == 12
    assert all(len(_ITEM.findall(text)) >= 2 for text in FIGURES.values())


@pytest.mark.parametrize("name", FIGURES)
def test_a_drawing_is_what_the_textbook_shows(name: str) -> None:
    layout = Layout(drawn(_compiled(FIGURES[name]).integral, LOOK))
    items = [" ".join(item.split()) for item in _ITEM.findall(FIGURES[name])]
    assert [item for item in items if not holds(layout, item)] == []
    for found in (overlaps, crossings, missed):
        assert found(layout.picture) == []


@pytest.mark.parametrize("name", FIGURES)
def test_a_picture_is_the_drawing_of_its_model(name: str, update: bool) -> None:
    (picture,) = _PICTURE.findall(FIGURES[name])
    path = Path(PAGE.parent, picture)
    svg = _compiled(FIGURES[name]).drawing(look=LOOK)
    if update:
        path.write_text(svg, encoding="utf-8")
    assert path.read_text(encoding="utf-8") == svg


def test_an_item_that_is_false_or_not_understood_does_not_hold() -> None:
    crank = Layout(drawn(bondgraph.compile(str(ROOT / "models" / "slider_crank.bg")).integral))
    assert holds(crank, "In a row from left to right: `Se:T`, `1:crank`, `MTF:rod`")
    for wrong in [
        "In a row from left to right: `1:crank`, `Se:T`",
        "In a row from left to right: `I:J`, `1:crank`",
        "Upright from top to bottom: `R:f`, `1:crank`",
        "Upright from top to bottom: `I:J`, `R:f`",
        "Above `1:crank`: `R:f`",
        "Below `1:crank`: `I:J`",
        "Around `1:crank`: `R:c`",
        "The signal `th` acts on `MTF:rod`",
        "`1:piston` acts on `MTF:rod` through `th`",
        "`1:crank` acts on `MTF:rod`",
        "Everything is beautiful",
    ]:
        assert not holds(crank, wrong), wrong
    robot = Layout(drawn(bondgraph.compile(str(ROOT / "models" / "khepera.bg")).integral))
    assert not holds(robot, "In the frame `m[1].el`: `1:m[1].me.rotor`")
