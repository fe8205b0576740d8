"""Broken models: each gets one error, with place and remedy, and leaves nothing behind.

A model says what it expects in its first line: `# expect: CODE at LINE`, with `, compile` where
only compiling (and not checking) finds it; `at FILE:LINE` names a place in an imported file.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from bondgraph import errors
from bondgraph.cli.main import main

HERE = Path(__file__).parent
_EXPECT = re.compile(r"# expect: ([a-z-]+) at (?:([\w.]+):)?(\d+)(, compile)?\n")

YAML = """\
# a model as BondGraphTools saves it
version: 0.1
root: /
models:
  /:
    components:
    - R1 BG/R r=10.0
    - C1 BG/C C=1.0
    - kvl BG/1
    netlist:
    - R1 kvl.0
    - C1 kvl.1
"""
#: Files that cannot say what they expect, or that no editor would keep as they are.
FILES: dict[str, tuple[str, bytes]] = {
    "yaml.bg": ("not-bondgraph-yaml", YAML.encode()),
    "json.bg": ("not-bondgraph-json", b'{"models": {"M": {"bonds": [[1, 2]]}}}\n'),
    "modelica.bg": ("not-bondgraph-modelica", b"model M\n  Real x;\nequation\n  x = 1;\nend M;\n"),
    "empty.bg": ("empty-file", b""),
    "blank.bg": ("empty-file", b"\n\n   \n\t\n"),
    "comments.bg": ("empty-file", b"# a model\n# will come\n"),
    "binary.bg": ("not-text", bytes(range(256)) * 4),
    "zip.bg": ("not-text", b"PK\x03\x04\x14\x00\x08\x08\x08\x00\x1c\xb5\xf6\xde"),
    "utf16.bg": ("not-text", "bg 1\nmodel M { Se:U -> R:r = 1 Ohm }\n".encode("utf-16")),
    "latin1.bg": ("not-text", "bg 1\n# Rückkopplung\nmodel M {}\n".encode("latin-1")),
    "mark_only.bg": ("empty-file", b"\xef\xbb\xbf"),
}
#: Cases that each proposed change makes sound.
MENDED = {
    "array_by_indices", "displacement_called_x", "gyrator_with_a_relation_of_a_transformer",
    "if_then_in_a_law", "input_with_a_value", "junction_declared_with_each_bond",
    "junction_switched_after_its_bond",
    "product_with_a_number_without_sign", "product_without_sign", "several_params_in_a_line",
    "transformer_turned_round", "two_port_declared_on_both_sides", "unit_divided_by_a_value",
    "values_by_indices",
}  # fmt: skip


class Case(NamedTuple):
    """A broken model and what is to be said about it."""

    path: Path
    code: str
    place: str
    line: int
    commands: tuple[str, ...]


def _cases() -> list[Case]:
    found = []
    for path in sorted(HERE.glob("*.bg")):
        expected = _EXPECT.match(path.read_text(encoding="utf-8"))
        if expected is not None:
            code, place, line, only = expected.groups()
            commands = ("compile",) if only else ("check", "compile")
            found.append(Case(path, code, place or path.name, int(line), commands))
    return found


CASES = _cases()


def _single_error(printed: str) -> dict[str, Any]:
    answer = json.loads(printed)
    assert answer["status"] == "error"
    wrong = [d for d in answer["diagnostics"] if d["severity"] == "error"]
    assert len(wrong) == 1, [d["message"] for d in wrong]
    assert answer["message"] == wrong[0]["message"]
    assert wrong[0]["help"].strip(), "no remedy"
    assert wrong[0]["labels"], "no place"
    assert errors.page(wrong[0]["code"]) is not None
    return dict(wrong[0])


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.path.stem)
def test_one_error_with_place_and_remedy(
    case: Case,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("BONDGRAPH_TRACEBACK", "1")
    monkeypatch.chdir(tmp_path)
    for command in case.commands:
        options = ["-o", str(tmp_path / "out")] if command == "compile" else []
        assert main([command, "--json", str(case.path), *options]) == 1
        error = _single_error(capsys.readouterr().out)
        assert error["code"] == case.code, error["message"]
        first = error["labels"][0]
        assert Path(first["path"]).name == case.place
        assert first["line"] == case.line
        assert (first["end_line"], first["end_column"]) > (first["line"], first["column"]) or (
            "expected" in first["text"]
        ), "the place is empty"
    assert list(tmp_path.iterdir()) == [], "something was written"


def _changed(text: str, edit: dict[str, Any]) -> str:
    lines = text.splitlines(keepends=True)
    starts = [sum(map(len, lines[:n])) for n in range(len(lines) + 1)]
    for change in sorted(edit["changes"], key=lambda c: (-c["line"], -c["column"])):
        start = starts[change["line"] - 1] + change["column"] - 1
        end = starts[change["end_line"] - 1] + change["end_column"] - 1
        text = text[:start] + change["text"] + text[end:]
    return text


@pytest.mark.parametrize("case", CASES, ids=lambda c: c.path.stem)
def test_a_change_that_is_proposed_takes_the_error_away(
    case: Case, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """Not always all of them: what is read at last may have more errors, but none there."""
    text = case.path.read_text(encoding="utf-8")
    assert main([case.commands[0], "--json", str(case.path)]) == 1
    error = _single_error(capsys.readouterr().out)
    for number, edit in enumerate(error["edits"]):
        path = tmp_path / f"{number}.bg"
        path.write_text(_changed(text, edit), encoding="utf-8")
        main([case.commands[0], "--json", str(path)])
        left = json.loads(capsys.readouterr().out)["diagnostics"]
        assert (error["code"], error["message"]) not in [(d["code"], d["message"]) for d in left]
        if case.path.stem in MENDED:
            assert [d["message"] for d in left if d["severity"] == "error"] == []


@pytest.mark.parametrize("name", FILES)
def test_files_that_are_no_models(
    name: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("BONDGRAPH_TRACEBACK", "1")
    code, data = FILES[name]
    path = tmp_path / name
    path.write_bytes(data)
    for command in ("check", "compile"):
        assert main([command, "--json", str(path)]) == 1
        error = _single_error(capsys.readouterr().out)
        assert error["code"] == code
        assert error["labels"][0]["path"] == str(path)
    assert os.listdir(tmp_path) == [name], "something was written"


@pytest.mark.parametrize("path", ["no/such/file.bg", ".", "models"])
def test_paths_that_are_no_files(path: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--json", path]) == 1
    error = _single_error(capsys.readouterr().out)
    assert error["code"] in ("file-not-found", "file-unreadable")


@pytest.mark.parametrize("case", CASES[:: max(1, len(CASES) // 4)], ids=lambda c: c.path.stem)
def test_in_a_terminal(case: Case) -> None:
    """As a user sees it: exit status 1, the error with its line on stderr, no traceback."""
    run = subprocess.run(
        [sys.executable, "-m", "bondgraph", case.commands[0], str(case.path)],
        capture_output=True,
        text=True,
        cwd=HERE.parents[1],
    )
    assert run.returncode == 1
    assert f"error[{case.code}]" in run.stderr
    assert f"{case.place}:{case.line}:" in run.stderr
    assert "help" in run.stderr
    assert "Traceback" not in run.stderr + run.stdout


def test_many_kinds() -> None:
    assert len({c.path for c in CASES}) + len(FILES) >= 60
    assert len({c.code for c in CASES} | {code for code, _ in FILES.values()}) >= 35


def test_expectations_are_all_read() -> None:
    helpers = {"import_cycle_other.bg", "import_parts.bg"}
    assert {p.name for p in HERE.glob("*.bg")} - {c.path.name for c in CASES} == helpers
