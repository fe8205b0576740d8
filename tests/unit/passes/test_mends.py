"""How a change of a drawing is said, and how it is written where that is plain."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.mends import Change, _edit, _words
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.source import Source
from tests.unit.passes.circuits import compiled

_TEXT = """bg 1
model M {
    0:a { <- Se:u; -> R:r = 2 }
    1:b { <- Sf:v; -> C:c = 3 }
    a -> b
    1:s[2]
    b -> s[1] -> R:q = 4
    b <- s[2] <- Se:w
}
"""


def _at(graph: BondGraph, path: str) -> int:
    return next(k for k, node in enumerate(graph.nodes) if node.path == path)


def _bond(graph: BondGraph, *ends: str) -> int:
    pairs = [{graph.nodes[e.node].path for e in (b.tail, b.head)} for b in graph.bonds]
    return pairs.index(set(ends))


def _change(graph: BondGraph, how: str, *names: str) -> Change:
    """Such a change at a node, or at the bond between two."""
    match how:
        case "cut":
            return Change(cut=_bond(graph, *names))
        case "0" | "1":
            return Change(splice=(_bond(graph, *names), how))
        case _:
            return Change(**{how: _at(graph, *names)})


def _mended(text: str, how: str, *names: str) -> str | None:
    """The text after a change, None where that is not plain."""
    graph = compiled(text).graph
    change = _change(graph, how, *names)
    edit = _edit(graph, change, _words(graph, change, 1))
    if edit is None:
        return None
    for span, new in sorted(edit.changes, key=lambda one: -one[0].start):
        text = text[: span.start] + new + text[span.end :]
    return text


@pytest.mark.parametrize(
    ("how", "names", "words"),
    [
        ("grow", ("a",), "put a C or an R at 0:a{}"),
        ("grow", ("b",), "put an I or an R at 1:b{}"),
        ("turn", ("a",), "make 0:a{} a 1-junction, if its bonds share the flow and not the effort"),
        ("turn", ("b",), "make 1:b{} a 0-junction, if its bonds share the effort and not the flow"),
        ("turn", ("u",), "make Se:u{} an Sf, if it holds a flow"),
        ("turn", ("v",), "make Sf:v{} an Se, if it holds an effort"),
        ("drop", ("r",), "leave out R:r{}"),
        ("cut", ("u", "a"), "leave out the bond between Se:u and 0:a{}"),
        ("0", ("a", "b"), "put a 0-junction with an R or a C between 0:a and 1:b{}"
         "\n    a -> 0:link -> b; link -> R:loss = 1"),
        ("1", ("a", "b"), "put a 1-junction with an R or an I between 0:a and 1:b{}"
         "\n    a -> 1:link -> b; link -> R:loss = 1"),
        ("1", ("b", "s[1]"), "put a 1-junction with an R or an I between 1:b and 1:s[1]{}"),
    ],
)  # fmt: skip
def test_a_change_is_told_with_how_many_places_it_is_made_at(
    how: str, names: tuple[str, ...], words: str
) -> None:
    graph = compiled(_TEXT).graph
    change = _change(graph, how, *names)
    assert _words(graph, change, 1) == words.format("")
    assert _words(graph, change, 2) == words.format(" (and the 1 like it)")
    assert _words(graph, change, 4) == words.format(" (and the 3 like it)")


def test_one_of_several_bonds_between_two_is_told_as_such() -> None:
    graph = compiled(_TEXT.replace("    a -> b\n", "    a -> b\n    a -> b\n")).graph
    assert _words(graph, _change(graph, "cut", "a", "b"), 1) == (
        "leave out one of the 2 bonds between 0:a and 1:b"
    )


@pytest.mark.parametrize(
    ("how", "names", "old", "new"),
    [
        ("grow", ("a",), "-> R:r = 2 }", "-> R:r = 2 }; a -> R:loss = 1"),
        ("turn", ("a",), "0:a", "1:a"),
        ("turn", ("b",), "1:b", "0:b"),
        ("turn", ("u",), "Se:u", "Sf:u"),
        ("turn", ("v",), "Sf:v", "Se:v"),
        ("0", ("a", "b"), "a -> b", "a -> 0:link -> b; link -> R:loss = 1"),
        ("1", ("a", "b"), "a -> b", "a -> 1:link -> b; link -> R:loss = 1"),
    ],
)
def test_a_plain_change_is_written_into_the_text(
    how: str, names: tuple[str, ...], old: str, new: str
) -> None:
    assert _TEXT.count(old) == 1
    mended = _mended(_TEXT, how, *names)
    assert mended == _TEXT.replace(old, new)


def test_a_bond_that_is_drawn_backwards_stays_so() -> None:
    text = _TEXT.replace("a -> b", "b <- a")
    assert _mended(text, "0", "a", "b") == text.replace(
        "b <- a", "b <- 0:link <- a; link -> R:loss = 1"
    )


@pytest.mark.parametrize(
    ("how", "names"),
    [("drop", ("r",)), ("cut", ("a", "b")), ("grow", ("s[1]",)), ("1", ("b", "s[1]")),
     ("0", ("b", "s[2]"))],
)  # fmt: skip
def test_what_is_left_out_or_one_of_an_array_is_for_a_person_to_write(
    how: str, names: tuple[str, ...]
) -> None:
    assert _mended(_TEXT, how, *names) is None


def test_new_nodes_have_names_that_are_free() -> None:
    text = _TEXT.replace("R:r = 2", "R:loss = 2; -> R:loss2 = 2")
    grown = text.replace("loss2 = 2 }", "loss2 = 2 }; a -> R:loss3 = 1")
    assert _mended(text, "grow", "a") == grown
    mended = _mended(_TEXT.replace("R:r = 2", "R:link = 2"), "1", "a", "b")
    assert mended is not None and "a -> 1:link2 -> b; link2 -> R:loss = 1" in mended


def _proposed(text: str) -> list[str]:
    """What would mend the one conflict of a model, without how it is written."""
    with pytest.raises(CompileError) as caught:
        _ = Compilation(Source("m.bg", f"bg 1\nmodel M {{\n{text}\n}}\n")).integral
    (error,) = [d for d in caught.value.diagnostics if d.code == "causality-conflict"]
    return [line[2:] for line in error.help.splitlines() if line.startswith("- ")]


def test_five_changes_are_proposed_and_two_of_a_kind() -> None:
    """That a or b might be of the other kind would be the sixth and the seventh."""
    assert _proposed("Se:a -> 0:j; Se:b -> j; j -> R:r = 1") == [
        "put a 1-junction with an R or an I between Se:b and 0:j",
        "put a 1-junction with an R or an I between Se:a and 0:j",
        "make 0:j a 1-junction, if its bonds share the flow and not the effort",
        "leave out Se:b",
        "leave out Se:a",
    ]


def test_what_is_left_out_must_leave_no_junction_with_one_bond() -> None:
    """Junctions with losses between x, y, z and w would do, too: a third and more of a kind."""
    chain = "Sf:a -> 1:x -> 1:y -> 1:z -> 1:w; Sf:b -> w; y -> R:r = 1; z -> R:s = 2"
    assert _proposed(chain) == [
        "put a 0-junction with an R or a C between Sf:b and 1:w",
        "put a 0-junction with an R or a C between Sf:a and 1:x",
        "make Sf:b an Se, if it holds an effort",
        "make Sf:a an Se, if it holds an effort",
    ]
    assert _proposed(chain + "; x -> R:t = 1; w -> R:u = 1")[2:] == [
        "make 1:w a 0-junction, if its bonds share the effort and not the flow",
        "leave out Sf:b",
        "leave out Sf:a",
    ]


def test_one_change_at_a_place_where_three_meet() -> None:
    """With any one of three pumps gone or lossy the other two are still there."""
    assert _proposed("Se:a -> 0:j; Se:b -> j; Se:c -> j; j -> R:r = 1") == [
        "make 0:j a 1-junction, if its bonds share the flow and not the effort"
    ]
