"""docs/limits.md has the figures that the program has, and what goes beyond them is refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from bondgraph.cli.main import main
from bondgraph.text import limits
from bondgraph.text.foreign_data import WrongData, json_data, toml_data
from tests.docs.pages import ROOT
from tests.unit.runtime.live.rover import MODEL, SCENARIO

#: The first words of the row that says each limit.
ROWS = {
    "MODEL_BYTES": "bytes of a file", "PARTS": "parts of a whole model",
    "UNROLLED": "names of arrays and", "BRACKETS": "brackets or blocks",
    "OPERATORS": "operators inside", "DIGITS": "digits of a number",
    "NAME_LETTERS": "letters of a name",
    "SYNTAX_ERRORS": "errors of syntax", "SHOWN": "findings that are shown",
    "TABLE_BYTES": "bytes of a file with a table", "TABLE_NUMBERS": "numbers in a table",
    "INCIDENCE_CELLS": "cells of an incidence table", "INCIDENCE_MARKS": "marks in an incidence",
    "SCENARIO_BYTES": "characters of a scenario", "MAP_BYTES": "bytes of a map",
    "TUNING_BYTES": "bytes of a tuning", "NESTED": "tables or arrays",
    "SCENARIO_FAULTS": "faults of a scenario", "SCENARIO_CONTROLLERS": "controllers of",
    "FAULT_TIMES": "times that a fault", "RUN_VALUES": "numbers of a simulated log",
    "COLUMNS": "columns of a log", "RATE": "samples a second, rad/s of a filter",
    "LINE_BYTES": "bytes of a line", "PAGES": "pages at once",
    "CONNECTIONS": "connections at once", "WISH_BYTES": "bytes of a wish",
    "WISHES_A_SECOND": "wishes a second", "WISHES": "wishes of all pages",
    "INJECTED": "faults of the virtual machine", "EDIT_BYTES": "characters of a text that a page",
    "EDITORS": "pages that edit at once", "KEYS_A_SECOND": "messages a second of one page that",
}  # fmt: skip


def test_the_page_has_the_figures_of_the_program() -> None:
    page = (ROOT / "docs" / "limits.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([^|]+) \| ([\d,]+) \|", page, re.MULTILINE)
    constants = {n: v for n, v in vars(limits).items() if n.isupper()}
    assert constants.keys() == ROWS.keys() and len(rows) == len(ROWS)
    for name, words in ROWS.items():
        said = [figure for text, figure in rows if text.startswith(words)]
        found = min(said, key=len) if name == "MODEL_BYTES" else said[0]
        if name == "MODEL_BYTES":
            found = next(figure for text, figure in rows if text == words)
        assert found == f"{constants[name]:,}", name


def _model(statement: str) -> str:
    return MODEL.replace("    let heading", f"    {statement}\n    let heading")


def _nodes(count: int) -> str:
    return "".join(f"    foo{k} -> bar{k}\n" for k in range(count))


HEADER = "t,F[1],F[2],turn[1],turn[2],v[1],v[2]"
#: A file that goes one step too far, the command that reads it, and what it says.
BEYOND: dict[str, tuple[Callable[[Path], list[str]], str]] = {}


def _beyond(name: str, said: str) -> Callable[[Callable[[Path], list[str]]], None]:
    def note(make: Callable[[Path], list[str]]) -> None:
        BEYOND[name] = make, said

    return note


def _checked(folder: Path, text: str) -> list[str]:
    (folder / "a.bg").write_text(text)
    return ["check", "a.bg"]


def _simulated(folder: Path, scenario: str) -> list[str]:
    (folder / "a.bg").write_text(MODEL)
    (folder / "s.toml").write_text(scenario)
    return ["simulate", "a.bg", "s.toml", "-o", "o.csv"]


def _watched(folder: Path, log: str, *more: str) -> list[str]:
    (folder / "a.bg").write_text(MODEL)
    (folder / "log.csv").write_text(log)
    return ["monitor", "a.bg", "log.csv", *more]


@_beyond("parts", r"model-too-large.*3,000,000 parts")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model("param q[10000000] = 2"))


@_beyond("unrolled", r"model-too-large.*20,000 statements and names")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model("param q[20001] = 2"))


@_beyond("brackets", r"nesting-too-deep.*100 deep")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model(f"let q = {'(' * 101}1{')' * 101}"))


@_beyond("operators", r"nesting-too-deep.*200")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model(f"let q = {'+'.join('1' * 300)}"))


@_beyond("digits", r"number-form")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model(f"param q = {'1' * 401}"))


@_beyond("letters of a name", r"name-letters.*101 letters")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model(f"param {'q' * 101} = 2"))


@_beyond("exponent of a unit", r"unknown-unit")
def _(folder: Path) -> list[str]:
    return _checked(folder, _model(f"param q = 1 m^{'9' * 5000}"))


@_beyond("syntax errors", r"syntax-many")
def _(folder: Path) -> list[str]:
    return _checked(folder, "bg 1\nmodel M {\n" + "    -> ->\n" * 60 + "}\n")


@_beyond("findings", r"unknown-name.*\d+ more are not shown")
def _(folder: Path) -> list[str]:
    return _checked(folder, f"bg 1\nmodel M {{\n{_nodes(300)}}}\n")


@_beyond("samples a second", r"rate must be from 1e-11 to 1e\+11, not 1e\+12")
def _(folder: Path) -> list[str]:
    rows = "".join(f"{k}e-12,1,1,0,0,0,0\n" for k in range(50))
    return _watched(folder, f"{HEADER}\n{rows}")


@_beyond("rad/s of a filter", r"bandwidth.*a number from 1e-11 to 1e\+11")
def _(folder: Path) -> list[str]:
    (folder / "t.json").write_text(
        '{"bondgraph tuning": 1, "model": "a", "rate": 200, "bandwidth": 1e-320, '
        '"false_alarms": 1, "seconds": 1, "limits": {}}'
    )
    return _watched(folder, f"{HEADER}\n0,1,1,0,0,0,0\n", "--tuning", "t.json")


@_beyond("numbers of a table", r"wrong-table.*200,000 numbers at most")
def _(folder: Path) -> list[str]:
    (folder / "t.csv").write_text("".join(f"{k},{k}\n" for k in range(100_002)))
    return _checked(folder, 'bg 1\nmodel M { Se:U -> R:r { e = table("t.csv", f) } }')


@_beyond("cells", r"table-column.*1,000,000 cells")
def _(folder: Path) -> list[str]:
    head = ",".join(f"x:v{k}" for k in range(1000))
    (folder / "t.csv").write_text(f"equation,{head}\n" + "e,1\n" * 1001)
    return ["isolate", "t.csv"]


@_beyond("marks", r"table-row.*50,000 marks")
def _(folder: Path) -> list[str]:
    head, row = ",".join(f"x:v{k}" for k in range(600)), ",1" * 600
    (folder / "t.csv").write_text(f"equation,{head}\n" + "".join(f"e{k}{row}\n" for k in range(90)))
    return ["isolate", "t.csv"]


@_beyond("scenario", r"scenario-syntax.*10,000,000")
def _(folder: Path) -> list[str]:
    return _simulated(folder, SCENARIO + "#" * 10_000_000)


@_beyond("nested", r"scenario-syntax.*more than 50")
def _(folder: Path) -> list[str]:
    return _simulated(folder, SCENARIO + f"[x]\ny = {'[' * 60}{']' * 60}\n")


@_beyond("digits in TOML", r"scenario-syntax.*400 digits")
def _(folder: Path) -> list[str]:
    return _simulated(folder, f"seed = {'9' * 5000}\n" + SCENARIO)


@_beyond("faults", r"scenario-value.*501 of.*500 are the most")
def _(folder: Path) -> list[str]:
    one = '[[fault]]\nof = "f[2]"\nchange = "*= 3"\nat = "1 s"\n'
    return _simulated(folder, SCENARIO + one * 500)


@_beyond("controllers", r"scenario-value.*201 of.*200 are the most")
def _(folder: Path) -> list[str]:
    return _simulated(folder, SCENARIO + "[[controller]]\n" * 201)


@_beyond("numbers of a run", r"100,000,000 numbers are the most")
def _(folder: Path) -> list[str]:
    return _simulated(folder, SCENARIO.replace('"5 s"', '"1e6 s"'))


@_beyond("columns", r"4001 columns, 4000 are the most")
def _(folder: Path) -> list[str]:
    names = ",".join(f"c{k}" for k in range(4000))
    return _watched(folder, f"t,{names}\n0{',1' * 4000}\n")


@_beyond("map", r"1000000 are read at most")
def _(folder: Path) -> list[str]:
    (folder / "m.toml").write_text("#" * 1_000_001)
    return _watched(folder, f"{HEADER}\n0,1,1,1,1,1,1\n", "--map", "m.toml")


@_beyond("tuning", r"no tuning: more than 50")
def _(folder: Path) -> list[str]:
    (folder / "t.json").write_text("[" * 100_000)
    return _watched(folder, f"{HEADER}\n0,1,1,1,1,1,1\n", "--tuning", "t.json")


@pytest.mark.parametrize("name", BEYOND)
def test_what_goes_beyond_is_refused(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    make, said = BEYOND[name]
    assert main(make(tmp_path)) == 1
    text = " ".join("".join(capsys.readouterr()).split())
    assert re.search(said, text), text[:500]
    assert "this is a bug" not in text


def test_plain_data_is_read_up_to_the_limits() -> None:
    deep = "[" * 50 + "]" * 50
    assert json_data(deep) and toml_data(f"a = {deep[1:-1]}")
    for read, text in (
        (json_data, f"[{deep}]"), (toml_data, f"a = {deep}"), (json_data, "[" * 100_000),
        (toml_data, "a = " + "[" * 100_000), (json_data, "9" * 5000), (json_data, "{"),
        (toml_data, ".".join("a" * 60) + " = 1"),
    ):  # fmt: skip
        with pytest.raises(WrongData):
            read(text)
    with pytest.raises(WrongData) as wrong:
        toml_data(f"a = 1\nb = {'1' * 401}\n")
    assert (wrong.value.line, wrong.value.column) == (2, 5)
