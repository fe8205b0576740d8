"""What a model is silent about is said, and what its author may have meant is not."""

from __future__ import annotations

from pathlib import Path

import pytest

from bondgraph.compilation import compile as open_model
from bondgraph.text.diagnostic import Diagnostic

OURS = {"part-not-measured", "part-not-driven", "value-not-used", "value-without-name"}
MACHINE = "Se:U -> 1:i; i -> R:R; i -> Df:y; param R = 2 Ohm; "


def said(body: str, before: str = "", open_ports: bool = False) -> list[Diagnostic]:
    """What is said of a model with this body."""
    text = "bg 1\n" + before + "\nmodel M {\n" + body.replace("; ", "\n") + "\n}\n"
    compilation = open_model(text=text, open_ports=open_ports)
    assert compilation.graph
    return [d for d in compilation.report.diagnostics if d.code in OURS]


def codes(body: str, before: str = "") -> list[tuple[str, str]]:
    """The codes with how grave they are."""
    return [(d.code, d.severity) for d in said(body, before)]


# ------------------------------------------------------------------------------- parts

SILENT = {
    "driven by what a sensor says of an input": (
        "input set; param S = 1; sensor up = set - z; Sf:n = up -> 0:j; j -> R:S; j -> De:z"
    ),
    "one machine": "",
    "two machines, both driven and measured": "Se:V -> 1:j; j -> R:S; j -> Df:z; param S = 1 Ohm",
    "joined by a signal": "MSe:V = y*R2 -> 1:j; j -> R:S; param S = 1; param R2 = 1 Ohm",
    "joined by an integral of a signal": "MSe:V = k*int(i.f, 0) -> 1:j; j -> R:S; param S = 1; "
    "param k = 1",
    "joined by a common input": "Se:V = U -> 1:j; j -> R:S; param S = 1",
    "joined by a let": "let d = 3*i.f; MSe:V = d -> 1:j; j -> R:S; param S = 1",
    "joined by a sensor that reads both": "Se:V -> 1:j; j -> R:S; param S = 1; "
    "sensor z = i.f + 2*j.f",
    "driven by a number in a law": "1:j; j -> R:S { e = f + 1 V }; j -> Df:z",
    "driven by a law that is not zero at rest": "1:j; j -> R:S { e = exp(f) }; j -> Df:z",
    "driven by a law without a value at rest": "1:j; j -> R:S { e = 1/f }; j -> Df:z",
    "driven by an integral of an input": "input T; Se:F = int(T) -> 1:j; j -> R:S; j -> Df:z; "
    "param S = 1",
    "driven by an integral of a number": "Se:F = int(3) -> 1:j; j -> R:S; j -> Df:z; param S = 1",
    "driven by what is made of an integral": "input T; Se:F = T*sin(2*int(T)) -> 1:j; j -> R:S; "
    "j -> Df:z; param S = 1",
    "driven by an integral of an integral": "input T; Se:F = int(T*int(T)) -> 1:j; j -> R:S; "
    "j -> Df:z; param S = 1",
    "driven by an integral of what a sensor says of an input": (
        "input set; param S = 1; sensor up = set - z; Sf:n = int(up) -> 0:j; j -> R:S; j -> De:z"
    ),
    "driven by a sensor of an integral in a loop": (
        "input set; param S = 1; sensor up = int(set - z - up); Sf:n = up -> 0:j; j -> R:S; "
        "j -> De:z"
    ),
    "a unknown input drives": "input F unknown; Se:F -> 1:j; j -> R:S; j -> Df:z; param S = 1",
}


@pytest.mark.parametrize("case", SILENT)
def test_what_may_be_meant_is_not_mentioned(case: str) -> None:
    assert codes(MACHINE + SILENT[case]) == []


SPOKEN = {
    # the part after MACHINE, code, severity
    "driven, not measured": ("Se:V -> 1:j; j -> R:S", "part-not-measured", "warning"),
    "neither driven nor measured": ("1:j; j -> I:S", "part-not-measured", "warning"),
    "a common param joins nothing": ("Se:V -> 1:j; j -> R:S = R", "part-not-measured", "warning"),
    "measured, not driven": ("1:j; j -> R:S; j -> Df:z", "part-not-driven", "warning"),
    "free at the start": ("1:j; j -> I:S; j -> Df:z", "part-not-driven", "warning"),
    "a source of zero": ("Se:n = 0 -> 1:j; j -> R:S; j -> Df:z", "part-not-driven", "warning"),
    "driven by itself": ("MSe:n = z*S -> 1:j; j -> R:S; j -> Df:z", "part-not-driven", "warning"),
    "an input that only modulates": (
        "input a; 1:j; j -> MR:S { e = a*S*f }; j -> Df:z", "part-not-driven", "warning",
    ),
    "an integral of what rests": (
        "MSe:n = S*int(z*int(z)) -> 1:j; j -> R:S; j -> Df:z", "part-not-driven", "warning",
    ),
    "an integral of an input that only modulates": (
        "input a; 1:j; j -> MR:S { e = int(a)*S*f }; j -> Df:z", "part-not-driven", "warning",
    ),
    "an integral of a source of zero": (
        "const n0 = 0; Se:n = int(n0) -> 1:j; j -> R:S; j -> Df:z", "part-not-driven", "warning",
    ),
    "a diode at rest": (
        "1:j; j -> R:d { e = S*(exp(f) - 1) }; j -> Df:z", "part-not-driven", "warning",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", SPOKEN)
def test_a_part_that_is_a_mistake(case: str) -> None:
    part, code, severity = SPOKEN[case]
    extra = "; param S = 1" if "S = R" not in part else ""
    assert codes(MACHINE + part + extra) == [(code, severity)]


START = {
    "(p0 = 0)": "for ever",
    "(p0 = 1)": "at the start",
    "": "at the start",  # nobody said what it holds
}


@pytest.mark.parametrize("start", START)
def test_whether_it_can_move_is_said_as_it_is(start: str) -> None:
    free = f"1:j; j -> I:m{start}; j -> R:S; j -> Df:z; param m = 1; param S = 2"
    (beside,) = said(MACHINE + free)
    (alone,) = said(free)
    assert START[start] in beside.message and START[start] in alone.message
    assert beside.severity == "warning" and "joins" in beside.message
    # a machine that runs down by itself may be meant, one that cannot move is not
    assert alone.severity == ("warning" if START[start] == "for ever" else "info")
    assert alone.message.startswith("Nothing drives this model: it ")
    assert [p.span.text for p in alone.labels] == ["1:j", "Df:z"]


def test_an_integral_of_the_law_can_hold_something_at_the_start() -> None:
    body = "1:j; j -> R:S {{ e = f + k*int(f, {}) }}; j -> Df:z; param k = 1"
    assert [d.severity for d in said(body.format("0"))] == ["warning"]
    assert [d.severity for d in said(body.format("1"))] == ["info"]


def test_nothing_is_said_of_parts_where_nothing_is_measured() -> None:
    assert codes("Se:U -> R:R; Se:V -> R:S; param R = 1; param S = 1") == []


def test_the_world_drives_and_joins_what_has_ports() -> None:
    body = "port a : in any; port b : out any; a -> 1:i; i -> Df:y; 0:n -> b; n -> C:C; param C = 1"
    assert said(body, open_ports=True) == []
    beside = "port a : in any; 0:n -> R:b; a -> n; param b = 1; "
    assert said(beside + MACHINE, open_ports=True) == []


def test_equal_parts_of_instances_are_said_once() -> None:
    load = "model Load { 1:w; w -> R:b; w -> Sf:n; param b = 1 }"
    (one,) = said(MACHINE + "Load:load[7]", load.replace("; ", "\n"))
    assert one.code == "part-not-measured" and "load[1].b" in one.message


# ------------------------------------------------------------------------------- values


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("param a = 1", "param `a`"),
        ("const a = 1", "const `a`"),
        ("input a", "input `a`"),
        ("input a : bool", "input `a`"),
        ("param a[1..3] = 1", "param `a[1]`"),
        ("param b = 1; param a = 2*b", "param `a`"),
        ("param a = 2; let c = 3*a", None),  # a let is there to be looked at
        ("param a = 1; const b = a; i -> R:x = b", None),
        ("param a = 1; i -> R:a", None),
        ("param a = 1; i -> C:x(q0 = a) = R", None),
        ("param a = 1; sensor z = a*i.f", None),
        ("param a = 1; param b = a; fault worn: R *= b", None),
        ("input a : bool; 1:k when a { <- Se:U2; -> R:x = R }; Se:n = U2 -> i", None),
        ("param a[1..2] = 1; i -> R:x = a[1]", None),
        ("const a = 4; sensor z = int(i.f, 0)/R counts a/turn", None),
    ],
)
def test_a_value_that_nothing_uses(line: str, expected: str | None) -> None:
    found = [d for d in said("Se:U -> 1:i; i -> R:R; i -> Df:y; param R = 2; " + line)]
    found = [d for d in found if d.code == "value-not-used"]
    assert len(found) == (expected is not None)
    if expected is not None:
        assert found[0].severity == "warning" and expected in found[0].message


def test_a_value_is_used_if_one_instance_uses_it() -> None:
    part = "model P(on : bool) { port a : in any; param k = 1; param s = 1\n 1:x <- a; x -> R:r; "
    part += "param r = 2; if on { x -> R:k } }"
    bonds = "; P:p(on = true); P:q(on = false); i -> p.a; i -> q.a"
    (one,) = said(MACHINE + bonds, part.replace("; ", "\n"))
    assert "`s`" in one.message and one.code == "value-not-used"


@pytest.mark.parametrize(("option", "said_of"), [("if on { x -> R:k }", []), ("", ["`k`"])])
def test_what_another_choice_would_use_is_not_mentioned(option: str, said_of: list[str]) -> None:
    part = f"model P(on : bool) {{ port a : in any; param k = 1; a -> 1:x; x -> R:r; {option}; "
    part += "param r = 2 }"
    found = said(MACHINE + "P:p(on = false); i -> p.a", part.replace("; ", "\n"))
    assert [name for d in found for name in ["`k`"] if name in d.message] == said_of


def test_what_an_argument_binds_is_unused_where_it_is_declared() -> None:
    """The mistake is in the part, not with who gives it a value."""
    part = "model P { port a : in any; param k = 1; a -> R:r; param r = 2 }".replace("; ", "\n")
    (one,) = said(MACHINE + "P:p(k = 2*S); param S = 3; i -> p.a", part)
    assert "`k`" in one.message and one.labels[0].span.line == 3


def test_numbers_are_told_once_with_all_elements() -> None:
    numbers = "i -> R:a = 2; i -> I:b = 3*2; i -> C:c = 1/(4); i -> GY:g = 2 -> 1:k; k -> R:R2 = R"
    (one,) = said("Se:U = 5 -> 1:i; i -> R:R; i -> Df:y; param R = 2; " + numbers)
    assert (one.code, one.severity) == ("value-without-name", "info")
    assert "`U`, `a`, `b`, `c` and `g` have" in one.message
    assert "`param U = 5` and `Se:U`" in one.help


@pytest.mark.parametrize(
    "line",
    [
        "const m = 25 kg; i -> I:m",  # who writes const has thought of it
        "const m = 25 kg; i -> I:x = m",
        "i -> C:x = 1/R",
        "i -> Se:ground = 0",
        "i -> R:x { e = 2*f }",
        "i -> MR:x = 2*i.f",
    ],
)
def test_no_number_for_a_value(line: str) -> None:
    assert "value-without-name" not in [c for c, _ in codes(MACHINE.replace(" Ohm", "") + line)]


def test_the_remedy_of_the_note_is_one() -> None:
    before = said(MACHINE.replace(" Ohm", "") + "i -> I:m = 25")
    after = said(MACHINE.replace(" Ohm", "") + "param m = 25; i -> I:m")
    assert [d.code for d in before] == ["value-without-name"] and after == []


def test_elements_of_an_array_are_told_once() -> None:
    (one,) = said(MACHINE + "for k in 1..9 { i -> R:r[k] = k*2 Ohm }")
    assert one.message.startswith("`r[1]` has a number")


# ------------------------------------------------------------------------------- shipped models


def test_the_shipped_models_hear_only_of_the_capacitor_that_is_a_number(root: Path) -> None:
    told = {}
    for path in sorted((root / "models").glob("*.bg")):
        compilation = open_model(path)
        assert compilation.integral
        ours = [d.message for d in compilation.report.diagnostics if d.code in OURS]
        if ours:
            told[path.name] = ours
    capacitor = ["`Cs` has a number for a value: it is no fault candidate."]
    assert told == {"khepera_built.bg": capacitor, "khepera_encoders.bg": capacitor}
