"""The digest of a program: everything that it computes, and no file that the model came from."""

from __future__ import annotations

from typing import Any

import pytest

from bondgraph.ir.program import (
    Assign,
    Branch,
    Choice,
    Const,
    Field,
    Known,
    Mode,
    Opening,
    Program,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.lower import _plain, digest
from bondgraph.text.source import Source, Span

_HERE, _THERE = (Span(Source(path, "a b c"), 2, 3) for path in ("here.bg", "there.bg"))
_U = Known("U", "U", "V", "voltage", "input", 1, False, None, _HERE)


def _program(origin: Span | None = _HERE, **more: Any) -> Program:
    nothing: dict[str, Any] = dict.fromkeys(Program._fields, ())
    names = dict.fromkeys(("name", "title", "source", "digest", "bounds"), "")
    rates = {"rate": 4.0, "bandwidth": 3.0, "warmup": 0.0, "time_unit": 2.0}
    out = Ref("residual", "r1")
    branch = Branch(
        out, Choice(Mode("on"), Ref("local", "x"), Const(0.5)),
        (Assign(Ref("local", "x"), Sum(((True, Const(2.0)),)), "", origin),), (), "", origin,
    )  # fmt: skip
    own = {
        "knowns": (_U._replace(origin=origin),),
        "params": (Field("R", "R", "Ohm", "", 3.0, origin),),
        "exact": (Assign(out, Const(1.5), "", origin),),
        "step": (branch,),
    }
    return Program(**{**nothing, **rates, **names, **own, **more})


def test_values_are_told_without_places_and_without_what_was_added_and_is_not_used() -> None:
    known = ("Known", "U", "U", "V", "voltage", "input", 1, False, None, 0, False, True)
    assert _plain(_U) == known
    assert _plain(_U._replace(offset=0.25)) == (*known, 0.25)
    assert _plain(_U._replace(start=True)) == (*known[:-2], True, True)
    assert _plain((_U, 3, ("a", Const(2.0)))) == (known, 3, ("a", ("Const", 2.0)))
    assert _plain(Ref("param", "R")) == ("Ref", "param", "R", 0)
    assign = Assign(Ref("param", "R"), Const(2.0), "why", _HERE)
    assert _plain(assign) == ("Assign", ("Ref", "param", "R", 0), ("Const", 2.0), "why")


def test_a_digest_is_of_no_place() -> None:
    own = digest(_program(), "text", ())
    assert len(own) == 16 and int(own, 16) >= 0
    for other in (_program(_THERE), _program(None)):
        assert digest(other, "text", ()) == own
    for name in ("source", "digest", "bounds"):
        assert digest(_program(**{name: "other"}), "text", ()) == own


_OUT = Ref("residual", "r1")


@pytest.mark.parametrize(
    "more",
    [
        {"name": "other"},
        {"rate": 5.0},
        {"time_unit": 1.0},
        {"knowns": (_U._replace(offset=0.5),)},
        {"knowns": (_U._replace(highest=2),)},
        {"exact": (Assign(_OUT, Const(1.25), "", _HERE),)},
        {"step": ()},
        {"first": (Assign(_OUT, Const(1.5), "", _HERE),)},
        {"openings": (Opening("r1", "s", ("on",)),)},
        {"tables": (("t", ((0.0, 1.0),)),)},
    ],
)
def test_a_digest_follows_all_that_is_computed(more: dict[str, Any]) -> None:
    assert digest(_program(**more), "text", ()) != digest(_program(), "text", ())


def test_a_digest_is_of_the_text_whatever_ends_its_lines_and_of_the_tolerances() -> None:
    program = _program()

    def of(text: str, *tolerances: tuple[str, float]) -> str:
        return digest(program, text, tolerances)

    assert of("a\r\nb") == of("a\nb") != of("a\nc")
    assert of("a", ("R", 0.1), ("L", 0.2)) == of("a", ("L", 0.2), ("R", 0.1))
    assert len({of("a"), of("a", ("R", 0.1)), of("a", ("R", 0.2)), of("a", ("L", 0.1))}) == 4
