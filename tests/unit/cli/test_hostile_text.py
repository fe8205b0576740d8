"""Text from outside on its way through the commands: nothing of it comes out raw, anywhere."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from bondgraph.cli.main import main
from bondgraph.text.printable import printable
from tests.unit.runtime.live.rover import MODEL, SCENARIO

RAW = "\x1b]0;owned\x07\x1b[2J\u202e\u2066\x9b1m\x7f"
SCRIPT = "</p></title></script><script>alert(1)</script><img src=x onerror=alert(2)>"
DOC = f"## A rover */ \\\n## {RAW} {SCRIPT} ]]> -->\n"


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a model and a scenario full of it, under hostile names."""
    model = MODEL.replace("## A rover with an encoder on each wheel.\n", DOC)
    model = model.replace("param d =", f"## {RAW} */ {SCRIPT}\n    param d =")
    (tmp_path / "m.bg").write_text(model)
    scenario = SCENARIO.replace('"errand"', '"e \\u001b[31m \\u202e <script>alert(1)</script>"')
    label = '"\\u001b]0;x\\u0007 $\\\\frac{ <img src=x onerror=alert(1)>"'
    scenario = scenario.replace('"brake drags"', label)
    (tmp_path / "s.toml").write_text(scenario.replace('"1000 s"', '"2 s"'))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _clean(text: str) -> None:
    assert printable(text) == text


def test_names_of_files_that_are_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    for words in (
        ["check", f"{RAW}.bg"], ["compile", f"{RAW}.bg"], ["draw", f"{RAW}.bg"],
        ["monitor", f"{RAW}.bg", f"{RAW}.csv"], ["live", f"{RAW}.bg", f"{RAW}.toml"],
        ["check", os.fsdecode(b"\xff\xfe.bg")], ["format", f"{RAW}.bg"],
        ["check", "--json", f"{RAW}.bg"], ["explain", RAW], ["isolate", f"{RAW}.csv"],
    ):  # fmt: skip
        assert main(words) in (1, 2)
        out, err = capsys.readouterr()
        assert out + err
        _clean(out + err)


def test_what_a_model_says_in_error(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for text in (f"bg 1\nmodel M {{ {RAW} }}", f'bg 1\nimport A from "{RAW}"\nmodel M {{ }}',
                 f"{RAW}", f'bg 1\nmodel M {{ R:r = "{RAW}" }} # {RAW}'):  # fmt: skip
        (place / "a.bg").write_text(text)
        assert main(["check", "a.bg"]) == 1
        _clean(capsys.readouterr().err)


def test_files_that_are_made_of_a_model(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for words in (
        ["compile", "m.bg", "--with", "tests,exact,example", "-o", "out"],
        ["report", "m.bg", "--scenario", "s.toml", "-o", "r.html"],
        ["draw", "m.bg", "-o", "m.svg"],
        ["simulate", "m.bg", "s.toml", "-o", "run.csv"],
    ):
        assert main(words) == 0, capsys.readouterr()
        out, err = capsys.readouterr()
        _clean(out + err)
    files = [p for p in place.rglob("*") if p.is_file() and p.suffix not in (".bg", ".toml")]
    assert len(files) > 10
    for file in files:
        text = file.read_text(encoding="utf-8")
        _clean(text)
        if file.suffix in (".html", ".svg"):
            assert "<script>alert" not in text and "<img src=x" not in text
        if file.suffix in (".c", ".h"):
            inside = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
            assert "owned" not in inside and "alert" not in inside


def test_what_a_log_says(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    header = "t,F[1],F[2],turn[1],turn[2],v[1],v[2]"
    rows = "".join(f"{k / 200},1,1,0,0,0,0\n" for k in range(50))
    name = "log\x1b[2J\u202e.csv"
    (place / name).write_text(f"{header}\n{rows}{RAW}\n0.9,{RAW},1\n" * 2)
    main(["monitor", "m.bg", name, "--json"])
    main(["monitor", "m.bg", name])
    out, err = capsys.readouterr()
    assert "stop" in out
    _clean(out + err)
    (place / name).write_text(f"t,{RAW}\n0,1\n")
    assert main(["monitor", "m.bg", name]) == 1
    _clean("".join(capsys.readouterr()))
    (place / "map.toml").write_text('"F[1]" = "\\u001b[31m\\u202e"\n"\\u001b" = "x"\n')
    assert main(["monitor", "m.bg", name, "--map", "map.toml"]) == 1
    _clean("".join(capsys.readouterr()))


def test_a_fleet_of_hostile_names(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = place / "logs"
    folder.mkdir()
    header = "t,F[1],F[2],turn[1],turn[2],v[1],v[2]"
    rows = "".join(f"{k / 200},1,1,0,0,0,0\n" for k in range(50))
    for name in ("a\x1b[2J\u202e.csv", os.fsdecode(b"\xff.csv"), "b.csv"):
        (folder / name).write_text(f"{header}\n{rows}")
    os.mkfifo(folder / "c.csv")
    main(["monitor", "m.bg", "logs", "-o", "v.csv"])
    out, err = capsys.readouterr()
    _clean(out + err)
    text = (place / "v.csv").read_text(encoding="utf-8")
    _clean(text)
    assert "it is a pipe, no regular file" in text


def test_formatting_keeps_what_a_person_wrote(place: Path) -> None:
    (place / "a.bg").write_text("bg 1\n# \u202e x \u200d\nmodel   M { Se:U -> R:r = 1 Ohm }\n")
    assert main(["format", "a.bg"]) == 0
    assert "# \u202e x \u200d\n" in (place / "a.bg").read_text()
