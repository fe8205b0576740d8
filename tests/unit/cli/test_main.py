"""The command line as a whole: what it lists, how it fails, what it imports."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from bondgraph.cli.main import plain_check
from bondgraph.cli.usage import COMMANDS, parser_for
from tests.unit.cli.conftest import MODELS, Command

ROOT = MODELS.parent


def test_help_lists_every_command_once() -> None:
    text = parser_for(None).format_help()
    listed = re.findall(r"^    (\w+) ", text, re.MULTILINE)
    assert listed == list(COMMANDS)
    for line in COMMANDS.values():
        assert re.sub(r"\s+", " ", text).count(line) == 1


def test_the_manual_lists_every_command_once_with_the_same_words() -> None:
    manual = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[`bondgraph (\w+)`\]\(#(\w+)\) \| (.+) \|$", manual, re.MULTILINE)
    assert [(name, line) for name, _, line in rows] == list(COMMANDS.items())
    assert re.findall(r"^## (\w+)$", manual, re.MULTILINE)[: len(COMMANDS)] == list(COMMANDS)


def test_the_manual_knows_every_option() -> None:
    manual = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## (\w+)\n(.*?)(?=^## |\Z)", manual, re.MULTILINE | re.DOTALL))
    for name in COMMANDS:
        sub = parser_for(name)
        help_text = next(
            action.choices[name].format_help()
            for action in sub._subparsers._group_actions  # type: ignore[union-attr]
            if action.choices
        )
        for option in set(re.findall(r"(--[a-z]+)", help_text)) - {"--help"}:
            assert option in sections[name], f"docs/cli.md: {name} {option}"


def test_every_command_has_a_module_with_a_docstring() -> None:
    folder = ROOT / "bondgraph" / "cli"
    for name in COMMANDS:
        text = (folder / f"{name}.py").read_text(encoding="utf-8")
        assert text.startswith(f'"""`bondgraph {name}`')


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["nonsense"],
        ["check"],
        ["check", "--nonsense", "a.bg"],
        ["dump", "a.bg"],
        ["dump", "a.bg", "--stage", "nonsense"],
        ["compile", "a.bg", "--rate", "0"],
        ["compile", "a.bg", "--rate", "inf"],
        ["compile", "a.bg", "--bandwidth", "-1"],
        ["compile", "a.bg", "--bits", "80"],
        ["explain", "no-such-code"],
        ["explain", "models/khepera.bg"],
    ],
)
def test_wrong_usage_is_status_2(bondgraph: Command, words: list[str]) -> None:
    done = bondgraph(*words)
    assert done.status == 2
    assert done.out == "" and done.err.strip() and "Traceback" not in done.err


def test_version(bondgraph: Command) -> None:
    done = bondgraph("--version")
    assert done.status == 0 and done.out.startswith("bondgraph")


@pytest.mark.parametrize("command", ["check", "compile", "draw", "dump --stage graph"])
def test_a_missing_file_is_status_1_and_no_traceback(
    bondgraph: Command, tmp_path: Path, command: str
) -> None:
    done = bondgraph(*command.split(), tmp_path / "nowhere.bg")
    assert done.status == 1
    assert "nowhere.bg" in done.err and "Traceback" not in done.err
    assert not list(tmp_path.iterdir())


def test_a_wrong_model_in_json(bondgraph: Command, tmp_path: Path) -> None:
    path = tmp_path / "wrong.bg"
    path.write_text("bg 1\nmodel M {\n    Se:U -> R:nowhere = x\n}\n", encoding="utf-8")
    done = bondgraph("compile", path, "--json", "-o", tmp_path / "out")
    found = json.loads(done.out)
    assert done.status == 1 and found["status"] == "error" and found["message"]
    assert found["arrs"] == [] and found["files"] == [] and found["n_arr"] == 0
    for diagnostic in found["diagnostics"]:
        assert {"code", "message", "labels", "help"} <= set(diagnostic)
    assert not (tmp_path / "out").exists()


def test_a_failure_of_the_compiler_is_called_so(
    bondgraph: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(*_: object) -> None:
        raise RuntimeError("gremlins")

    monkeypatch.setattr("bondgraph.cli.dump.text_of", broken)
    done = bondgraph("dump", MODELS / "dc_motor.bg", "--stage", "graph")
    assert done.status == 1 and "gremlins" in done.err and "bug in bondgraph" in done.err


@pytest.mark.parametrize(
    ("words", "first"),
    [("dump --stage syntax models/khepera.bg", "File"), ("check no_such_model.bg --json", "{")],
)
def test_a_reader_that_leaves_is_no_error(words: str, first: str) -> None:
    """Where there is a result to print, and where there is an error."""
    done = subprocess.run(
        f"{sys.executable} -m bondgraph {words} | head -n 1",
        shell=True,
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == "" and done.stdout.startswith(first)
    gone = subprocess.run(
        f"{sys.executable} -m bondgraph {words} | true",
        shell=True,
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert "Traceback" not in gone.stderr and "Broken" not in gone.stderr


#: Modules that would make `check` start too late; see docs/decisions/light-nouns.md.
HEAVY = {"dataclasses", "inspect", "jinja2", "networkx", "numpy", "scipy", "sympy"}


@pytest.mark.parametrize("words", [["check", "models/khepera.bg"], ["--help"], ["--version"]])
def test_light_commands_import_nothing_heavy(words: list[str]) -> None:
    late = {"argparse", "difflib", "json", "shutil"} if words[0] == "check" else set()
    heavy = sorted(HEAVY | late)
    program = (
        "import sys; from bondgraph.cli.main import main\n"
        "try: status = main(sys.argv[1:])\n"
        "except SystemExit as leaving: status = leaving.code\n"
        f"print('heavy:', status or 0, sorted(set({heavy!r}) & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, *words],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines()[-1] == "heavy: 0 []"


@pytest.mark.parametrize(("command", "given", "found"), [
    ("monitor", None, "1"), ("monitor", "3", "3"), ("fit", None, "1"),
])  # fmt: skip
def test_a_watch_asks_numeric_libraries_for_one_thread_unless_told_otherwise(
    command: str, given: str | None, found: str
) -> None:
    program = (
        "import os, sys; from bondgraph.cli.main import main\n"
        "main(['check', 'none.bg']); before = os.environ.get('OPENBLAS_NUM_THREADS')\n"
        f"main(['{command}', 'none.bg', 'none.csv'])\n"
        "print(before, os.environ['OPENBLAS_NUM_THREADS'])"
    )
    left = {k: v for k, v in os.environ.items() if k != "OPENBLAS_NUM_THREADS"}
    more = {} if given is None else {"OPENBLAS_NUM_THREADS": given}
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={**left, **more, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines()[-1] == f"{given} {found}"


@pytest.mark.parametrize(
    "words", ["check a.bg", "check a.bg:M b.bg --json", "check --json x", "check check"]
)
def test_a_plain_check_is_read_as_the_parser_reads_it(words: str) -> None:
    plain = plain_check(words.split())
    assert plain is not None
    assert vars(plain) == vars(parser_for("check").parse_args(words.split()))


@pytest.mark.parametrize(
    "words", ["", "check", "check --json", "check -h", "check a.bg --help", "check -- -a", "dump a"]
)
def test_whatever_else_goes_to_the_parser(words: str) -> None:
    assert plain_check(words.split()) is None


_FULL = Path("/dev/full")


@pytest.mark.skipif(not _FULL.exists(), reason="there is no /dev/full")
@pytest.mark.parametrize(
    "words",
    [
        ["--version"],
        ["--help"],
        ["draw", "--help"],
        ["check", "models/dc_motor.bg"],
        ["check", "models/dc_motor.bg", "--json"],
        ["check", "models/missing.bg", "--json"],
        ["draw", "models/dc_motor.bg", "-o", "-"],
        ["dump", "--stage", "graph", "models/dc_motor.bg"],
        ["explain", "causality-conflict"],
    ],
    ids=" ".join,
)
def test_a_full_output_is_an_error_in_one_line(words: list[str]) -> None:
    with _FULL.open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "bondgraph", *words],
            cwd=ROOT,
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert done.returncode == 1
    assert done.stderr == "error: the output cannot be written: No space left on device\n"


@pytest.mark.skipif(not _FULL.exists(), reason="there is no /dev/full")
def test_a_full_device_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    from bondgraph.cli.main import main

    assert main(["draw", str(MODELS / "dc_motor.bg"), "-o", str(_FULL)]) == 1
    assert "No space left on device: /dev/full" in capsys.readouterr().err
    assert _FULL.is_char_device()


def test_a_closed_output_is_no_error() -> None:
    command = [sys.executable, "-m", "bondgraph", "check", "models/dc_motor.bg"]
    done = subprocess.run(
        ["sh", "-c", 'exec "$@" >&-', "sh", *command], cwd=ROOT, stderr=subprocess.PIPE, check=False
    )
    assert (done.returncode, done.stderr) == (0, b"")
