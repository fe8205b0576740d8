"""`check`, `format --diff`, `compile --check`: libraries, patterns, warnings, SARIF, currency."""

from __future__ import annotations

import io
import json
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest

from tests.unit.cli.conftest import MODELS, Command

LIBRARY = "bg 1\nmodel A { port p : in electrical; R:r; p -> r; param r = 2 Ohm }\n"
OTHER = "model B { param r = 2 Ohm; Se:U -> R:r }\n"
WARNED = "bg 1\nmodel M { param x = 1; param r = 2 Ohm; Se:U -> 1:j { -> R:r; -> Df:i } }\n"
WRONG = "bg 1\nmodel M { parm R = 2 Ohm; Se:U -> R:R }\n"
SCHEMA = (
    MODELS.parent
    / "editors/vscode/node_modules/@microsoft/jest-sarif/lib/schemas/sarif-2.1.0-rtm.5.json"
)


def write(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_each_model_of_a_library_is_checked(bondgraph: Command, tmp_path: Path) -> None:
    done = bondgraph("check", write(tmp_path, "lib.bg", LIBRARY + OTHER))
    assert done.status == 0
    assert [line.split()[1] for line in done.out.splitlines()] == ["A", "B"]
    wrong = write(tmp_path, "wrong.bg", LIBRARY + OTHER.replace("param r = 2 Ohm; ", ""))
    done = bondgraph("check", wrong)
    assert done.status == 1 and done.out.split()[1] == "A" and "missing-value" in done.err


def test_a_pattern_that_no_shell_opened(
    bondgraph: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "deep").mkdir()
    write(tmp_path, "b.bg", LIBRARY)
    write(tmp_path, "a.bg", LIBRARY)
    write(tmp_path / "deep", "c.bg", LIBRARY)
    monkeypatch.chdir(tmp_path)
    assert [line.split(":")[0] for line in bondgraph("check", "*.bg").out.splitlines()] == [
        "a.bg", "b.bg",
    ]  # fmt: skip
    assert bondgraph("check", "**/*.bg").out.count("is sound") == 3
    none = bondgraph("check", "*.bond")
    assert none.status == 1 and "`*.bond` does not exist" in none.err
    named = write(tmp_path, "[x].bg", LIBRARY)
    assert bondgraph("check", named.name).out.startswith("[x].bg")


def test_a_model_from_the_input(bondgraph: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(WRONG))
    done = bondgraph("check", "-")
    assert done.status == 1
    assert "<input>:2:11" in done.err and "Did you mean `param`?" in done.err


def test_warnings_as_errors(bondgraph: Command, tmp_path: Path) -> None:
    path = write(tmp_path, "m.bg", WARNED)
    assert bondgraph("check", path).status == 0
    strict = bondgraph("check", "--strict", path)
    assert strict.status == 1 and "1 warning, which --strict does not let pass" in strict.err
    found = json.loads(bondgraph("check", "--strict", "--json", path).out)
    assert found["status"] == "error" and found["diagnostics"][0]["severity"] == "warning"
    assert bondgraph("check", "--strict", MODELS / "khepera.bg").status == 0


def test_quiet_says_what_is_wrong_only(bondgraph: Command, tmp_path: Path) -> None:
    done = bondgraph("check", "--quiet", MODELS / "rigid_gear.bg")  # it has a note
    assert (done.status, done.out, done.err) == (0, "", "")
    done = bondgraph("check", "--quiet", write(tmp_path, "m.bg", WRONG))
    assert done.status == 1 and "unknown-statement" in done.err


def test_a_command_that_is_nearly_one(bondgraph: Command) -> None:
    done = bondgraph("chek", "models/dc_motor.bg")
    assert done.status == 2
    assert done.err == "error: there is no command `chek`; did you mean `check`?\n"


@pytest.mark.parametrize("text", [LIBRARY, WARNED, WRONG, "bg 1\nmodel M {", "\0"])
def test_sarif(bondgraph: Command, tmp_path: Path, text: str) -> None:
    path = write(tmp_path, "a model.bg", text)
    plain = json.loads(bondgraph("check", "--json", path).out)["diagnostics"]
    log = json.loads(bondgraph("check", "--format", "sarif", path).out)
    (run,) = log["runs"]
    assert [(r["ruleId"], r["locations"][0]["physicalLocation"]["region"]["startLine"])
            for r in run["results"]] == [
        (d["code"], d["labels"][0]["line"]) for d in plain
    ]  # fmt: skip
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert all(rules[r["ruleIndex"]] == r["ruleId"] for r in run["results"])
    assert [len(r.get("fixes", [])) for r in run["results"]] == [len(d["edits"]) for d in plain]
    if not SCHEMA.exists():
        pytest.skip("npm ci in editors/vscode has not been run")
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.validators.validator_for(schema)(schema).validate(log)


def test_what_formatting_would_change(bondgraph: Command, tmp_path: Path) -> None:
    path = write(tmp_path, "m.bg", "bg 1\nmodel M{Se:U->R:r=2}\n")
    before = path.read_bytes()
    done = bondgraph("format", "--diff", path)
    assert done.status == 1 and path.read_bytes() == before
    changed = [line for line in done.out.splitlines() if line[:1] in "+-"]
    assert changed[2:] == ["-model M{Se:U->R:r=2}", "+model M { Se:U -> R:r = 2 }"]
    assert bondgraph("format", path).status == 0
    again = bondgraph("format", "--diff", path)
    assert (again.status, again.out) == (0, "")


def test_whether_generated_code_is_current(bondgraph: Command, tmp_path: Path) -> None:
    model = write(tmp_path, "m.bg", (MODELS / "dc_motor.bg").read_text(encoding="utf-8"))
    folder = tmp_path / "out"
    words = ("compile", model, "-o", folder)
    missing = bondgraph(*words, "--check")
    assert missing.status == 1 and "is not current" in missing.err and not folder.exists()
    assert bondgraph(*words, "--quiet").out == ""
    assert bondgraph(*words, "--check").status == 0
    assert bondgraph(*words, "--check", "--target", "c").status == 1  # Python would be removed
    header = next(folder.rglob("*.h"))
    text = header.read_text(encoding="utf-8")
    header.write_text(text + " ", encoding="utf-8")
    done = bondgraph(*words, "--check", "--json")
    found = json.loads(done.out)
    assert done.status == 1 and found["outdated"] == [str(header)]
    assert header.read_text(encoding="utf-8") == text + " "
    header.write_text(text, encoding="utf-8")
    changed = model.read_text(encoding="utf-8").replace("17.6 Ohm", "18 Ohm")
    model.write_text(changed, encoding="utf-8")
    assert bondgraph(*words, "--check").status == 1


def test_hooks_run_commands_that_there_are() -> None:
    text = (MODELS.parent / ".pre-commit-hooks.yaml").read_text(encoding="utf-8")
    entries = [line.split("bondgraph ")[1] for line in text.splitlines() if "entry:" in line]
    assert len(entries) == 3
    for entry in entries:
        words = [sys.executable, "-m", "bondgraph", *entry.split(), str(MODELS / "dc_motor.bg")]
        done = subprocess.run(words, cwd=MODELS.parent, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr
