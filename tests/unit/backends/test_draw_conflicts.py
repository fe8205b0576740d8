"""Figures of conflicts: members boxed, forced strokes where they are forced, the rest grey."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import pytest

from bondgraph.backends.figure import draw_conflicts
from bondgraph.passes.causality.conflicts import conflicts
from tests.unit.passes.causality_graphs import build

SVG = "{http://www.w3.org/2000/svg}"
GRAPHS = {
    "twice": ("Se:a -> 0:n <- Se:b; n -> R:r; n -> De:y", 1, {"a", "n", "b"}),
    "far": ("Se:a -> TF:t -> 0:m; Se:b -> m; m -> C:c", 1, {"a", "t", "m", "b"}),
    "ring": (
        "Se:tx -> 1:x; Se:ty -> 1:y; Se:tz -> 1:z; x -> GY:a -> y -> GY:b -> z -> GY:c -> x; "
        "R:r -> 0:w -> De:v",
        1,
        {"tx", "ty", "tz", "x", "y", "z", "a", "b", "c"},
    ),
    "two": ("Se:a -> 0:n <- Se:b; Sf:c -> 1:m <- Sf:d; n -> 1:l -> m", 2, set("anbcmd")),
    "bond": ("Se:a -> Se:b; Sf:q -> 0:n -> C:c", 1, {"a", "b"}),
    "parallel": ("0:a -> 0:b; a -> b; b -> a", 1, {"a", "b"}),
}


def tree(text: str) -> ElementTree.Element:
    graph = build(text)
    return ElementTree.fromstring(draw_conflicts(graph, conflicts(graph), "a < b"))


def by_class(root: ElementTree.Element, name: str) -> list[ElementTree.Element]:
    return [e for e in root.iter() if name in e.attrib.get("class", "").split()]


def words(element: ElementTree.Element) -> str:
    """The text of an element without its tooltip."""
    hint = element.find(f"{SVG}title")
    told = "".join(element.itertext())
    return told.removeprefix(hint.text or "") if hint is not None else told


@pytest.mark.parametrize("case", GRAPHS)
def test_exactly_the_members_are_boxed_and_all_else_is_grey(case: str) -> None:
    text, count, members = GRAPHS[case]
    root = tree(text)
    assert len(by_class(root, "core")) == len(members) + count  # one more where it shows
    boxed = [(float(r.attrib["x"]), float(r.attrib["y"]), float(r.attrib["width"]),
              float(r.attrib["height"])) for r in by_class(root, "core")]  # fmt: skip
    for label in by_class(root, "label"):
        x, y = float(label.attrib["x"]), float(label.attrib["y"])
        inside = any(a < x < a + w and b < y < b + h for a, b, w, h in boxed)
        name = words(label).partition(":")[2]
        assert inside == (name in members)
        grey = all("faint" in t.attrib["class"] for t in label.iter(f"{SVG}tspan"))
        assert grey != inside
    for junction in by_class(root, "junction"):  # the members have their name in a label
        assert "faint" in junction.attrib["class"]


@pytest.mark.parametrize("case", GRAPHS)
def test_what_is_wrong_is_said_below_and_numbered(case: str) -> None:
    text, count, _ = GRAPHS[case]
    found = conflicts(build(text))
    assert len(found) == count
    root = tree(text)
    said = " ".join(words(note) for note in by_class(root, "note"))
    for conflict in found:
        assert conflict.finding.message in said
    badges = [words(b) for b in by_class(root, "badge")]
    names = ["conflict 1", "conflict 2"] if count == 2 else ["conflict"]
    assert [b for b in badges if b.startswith("conflict")] == names
    assert re.findall(r"Conflict[ 12]*:", said) == [f"{n.capitalize()}:" for n in names]


def test_both_strokes_stand_at_the_junction_that_gets_two_efforts() -> None:
    root = tree(GRAPHS["twice"][0])
    (n,) = [e for e in by_class(root, "label") if words(e) == "0:n"]
    x, y = float(n.attrib["x"]), float(n.attrib["y"])
    bars = [
        [tuple(map(float, p.split(","))) for p in re.findall(r"[-\d.]+,[-\d.]+", e.attrib["d"])]
        for e in by_class(root, "thick")
        if e.tag == f"{SVG}path" and "bond" not in e.attrib["class"]
    ]
    assert len(bars) == 2
    far = {e: float(e.attrib["x"]) for e in by_class(root, "label") if words(e)[:2] == "Se"}
    for bar in bars:
        at = sum(p[0] for p in bar) / 2, sum(p[1] for p in bar) / 2
        here = (at[0] - x) ** 2 + (at[1] - y) ** 2
        for source in far:
            sx, sy = float(source.attrib["x"]), float(source.attrib["y"])
            assert here < (at[0] - sx) ** 2 + (at[1] - sy) ** 2


def test_only_the_bonds_between_members_are_thick() -> None:
    root = tree(GRAPHS["far"][0])
    thick = {g.findtext(f"{SVG}title") for g in root.iter(f"{SVG}g") if by_class(g, "thick")} - {
        None
    }
    assert thick == {"bond 1: a -> t", "bond 2: t -> m", "bond 3: b -> m"}


def test_the_same_graph_gives_the_same_text_with_both_colour_schemes() -> None:
    graph = build(GRAPHS["ring"][0])
    svg = draw_conflicts(graph, conflicts(graph), "a < b")
    assert svg == draw_conflicts(graph, conflicts(graph), "a < b")
    assert svg.count(".clash{") == 2
    assert "a &lt; b" in svg
