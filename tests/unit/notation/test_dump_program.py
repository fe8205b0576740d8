"""Programs as text, from programs that are written by hand."""

from __future__ import annotations

import re

from bondgraph.ir.program import Branch, Choice, Compare, Const, Delayed, Dropped, Opening
from bondgraph.notation.dump_program import dump_program
from tests.unit.backends import programs
from tests.unit.backends.programs import known, put, ref, times


def _sections(text: str) -> dict[str, list[str]]:
    """The lines below each heading, without blanks at both ends and with single ones inside."""
    found: dict[str, list[str]] = {}
    for line in text.splitlines():
        if line and line[0] != " ":
            found[line] = rows = []
        elif line:
            rows.append(" ".join(line.split()))
    return found


def test_a_program_has_its_signals_parameters_and_procedures() -> None:
    found = _sections(dump_program(programs.motor()))
    assert list(found) == [
        "program Motor, 1000 samples a second, bandwidth 20 rad/s",
        "params", "knowns", "residuals", "configure", "exact", "first", "step",
    ]  # fmt: skip
    assert found["params"] == ["R el.R 17.6 Ohm", "L el.L 0.0003 H"]
    assert found["knowns"] == [
        "U input highest D 0 V", "i sensor highest D 1 A", "y sensor highest D 0 V",
        "y2 sensor highest D 0 V",
    ]  # fmt: skip
    assert found["residuals"] == [
        f"{name}: order 1, 2 stages, settled after 5 time constants" for name in ("r1", "r2")
    ]
    assert found["configure"][:2] == ["coef.R = param.R # line 3", "coef.L = param.L # line 3"]
    assert found["configure"][2] == "local.phase = option.bandwidth * option.sample_time"
    assert found["exact"] == [
        "residual.r1 = known.U - coef.R * known.i - coef.L * known.i[1] # line 3",
        "residual.r2 = known.y - known.y2 # line 3",
    ]


def test_what_there_is_to_say_of_a_residual_stands_below_it() -> None:
    first = programs.residual("r1", settle=7.5)._replace(
        approximate="a law is bent", unavailable="its order is too high", unwritten="too long",
        invisible=("i", "u"), laws=2, held=3.0,
    )  # fmt: skip
    program = programs.program(
        "M",
        (first, programs.residual("r2")),
        knowns=(known("y"),),
        delayed=(Delayed(known("y_old", 1), "y", 0.25),),
        openings=(Opening("r1", "open", ("on", "up")), Opening("r2", "open2", ())),
        dropped=(Dropped("r1", "y", 3, 0.00123),),
    )
    found = _sections(dump_program(program))
    assert found["knowns"] == [
        "y sensor highest D 0 V", "y_old y 0.25 s ago highest D 1",
    ]  # fmt: skip
    assert found["residuals"] == [
        "r1: order 1, 2 stages, settled after 7.5 time constants; before laws 2 stages,"
        " for 3 of theirs first",
        "approximate: a law is bent",
        "unavailable: its order is too high",
        "not in exact: too long",
        "invisible: i, u",
        "r2: order 1, 2 stages, settled after 5 time constants",
        "r1 is valid when open is 1, anew where on or up changes",
        "r2 is valid when open2 is 1",
    ]
    (left_out,) = [rows for title, rows in found.items() if title.startswith("left out of step")]
    assert left_out == ["r1 D(y, 3) 0.001"]


def test_loops_and_tapes_are_told_in_short() -> None:
    found = _sections(dump_program(programs.ladder(5)))
    assert "y_polynomial, one = tape of 11 steps # line 3" in found["configure"]
    dot = "local.chain = y_polynomial . D(y, 0..5) + one . D(U, 0..0) # line 3"
    assert found["exact"][0] == dot
    assert _sections(dump_program(programs.encoder()))["params"] == [
        "lambda lambda given at configure rad"
    ]


def test_a_choice_whose_sides_need_work_has_a_line_for_each() -> None:
    inside = put("local:a", times(Const(2.0), ref("known:y")), at=None)
    branch = Branch(
        ref("residual:r1"),
        Choice(Compare("<", ref("known:y"), Const(1.0)), ref("local:a"), Const(5.0)),
        (inside,), (), "", programs.line(2),
    )  # fmt: skip
    program = programs.program("M", (programs.residual("r1"),), step=(branch,))
    lines = dump_program(program).splitlines()
    own = [re.sub(" +=", " =", line) for line in lines[lines.index("step") + 1 :]]
    assert own == [
        "  if known.y < 1.0  # line 2", "    local.a = 2.0 * known.y", "    residual.r1 = local.a",
        "  else", "    residual.r1 = 5.0",
    ]  # fmt: skip
