"""Beginning, watching, looking before writing, sweeps, pictures, units, completion, manual."""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import bondgraph as package
from bondgraph.cli.man import manual_pages
from bondgraph.cli.usage import COMMANDS, parser_for, subparsers
from bondgraph.runtime.log_file import read_log
from tests.unit.cli.conftest import MODELS, Command

MOTOR = MODELS / "dc_motor.bg"


# ------------------------------------------------------------------------------------- new


def test_new_makes_a_model_whose_commands_all_work(
    bondgraph: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = bondgraph("new", "Pump 2")
    assert done.status == 0 and "go on with: bondgraph check pump_2/pump_2.bg" in done.out
    monkeypatch.chdir(tmp_path / "pump_2")
    lines = Path("README.md").read_text().splitlines()
    commands = [line.strip() for line in lines if line.startswith("    bondgraph ")]
    assert len(commands) == 7
    said = ""
    for command in commands:
        words = re.findall(r'"[^"]*"|\S+', command)[1:]
        done = bondgraph(*[word.strip('"') for word in words])
        assert done.status == 0, (command, done.err)
        said += done.out
    assert bondgraph("format", "--check", "pump_2.bg").status == 0
    assert "L, R or U since 6.0" in said and "R (100 %, +0.6" in said  # 30 % of 2 Ohm
    assert Path("generated/pump_2/pump2.c").exists()


def test_new_never_writes_over_a_file(bondgraph: Command, tmp_path: Path) -> None:
    mine = tmp_path / "README.md"
    mine.write_text("mine")
    done = bondgraph("new", "pump", "-o", tmp_path)
    assert done.status == 1 and "there already; nothing is written" in done.err
    assert mine.read_text() == "mine" and [*tmp_path.iterdir()] == [mine]
    for name in ("", "2", "é"):
        done = bondgraph("new", name, "-o", tmp_path / "other")
        assert done.status == 1 and "is no name for a model" in done.err
    assert not (tmp_path / "other").exists()


# ------------------------------------------------------------------------------- --dry-run


def test_a_dry_run_says_what_would_change_and_writes_nothing(
    bondgraph: Command, tmp_path: Path
) -> None:
    model, out = tmp_path / "m.bg", tmp_path / "out"
    shutil.copy(MOTOR, model)
    words = ("compile", model, "-o", out)
    done = bondgraph(*words, "--dry-run")
    assert done.status == 0 and f"new        {out}/motor.c\n" in done.out
    assert not out.exists()
    assert bondgraph(*words).status == 0
    files = sorted(path for path in out.rglob("*") if path.is_file())
    before = {path: path.read_bytes() for path in files}
    assert f"  the same   {len(files) - 1} files in {out}" in bondgraph(*words, "--dry-run").out
    model.write_text(model.read_text().replace("17.6 Ohm", "18 Ohm"))
    found = json.loads(bondgraph(*words, "--dry-run", "--json").out)
    changed = {Path(c["path"]).name for c in found["changes"] if c["change"] == "changed"}
    assert "motor.c" in changed and found["files"] == []
    found = bondgraph(*words, "--target", "python", "--dry-run").out
    assert f"removed    {out}/motor.c\n" in found
    assert before == {path: path.read_bytes() for path in files}
    (out / "motor.c").write_text("mine")
    done = bondgraph(*words, "--dry-run")
    assert done.status == 1 and f"in the way {out}/motor.c\n" in done.out
    assert bondgraph(*words).status == 1  # as it was told


# --------------------------------------------------------------------------------- --watch


def until(condition: str, path: Path, seconds: float = 60.0) -> str:
    """What a file says once it holds a text."""
    end = time.monotonic() + seconds
    while condition not in (text := path.read_text()):
        if time.monotonic() > end:
            raise AssertionError(text)
        time.sleep(0.05)
    return text


@pytest.mark.parametrize("command", ["check", "draw"])
def test_watch_does_it_again_and_ends_at_an_interrupt(command: str, tmp_path: Path) -> None:
    model, out = tmp_path / "m.bg", tmp_path / "out.txt"
    shutil.copy(MOTOR, model)
    words = [sys.executable, "-m", "bondgraph.cli.main", command, "m.bg", "--watch"]
    with out.open("w") as stream:
        running = subprocess.Popen(words, cwd=tmp_path, stdout=stream, stderr=stream)
        try:
            until("^C ends", out)
            other = tmp_path / "other.bg"  # what is half written would be looked at once more
            other.write_text(MOTOR.read_text().replace("-> R:R", "-> R:Q"))
            other.replace(model)
            until("error", out)
            shutil.copy(MOTOR, other)
            other.replace(model)
            text = until("error", out)
            end = time.monotonic() + 60.0
            while text.count("^C ends") < 3 and time.monotonic() < end:
                time.sleep(0.05)
                text = out.read_text()
            running.send_signal(signal.SIGINT)
            assert running.wait(20) == 0
        finally:
            running.kill()
    assert text.count("^C ends") == 3 and "Traceback" not in out.read_text()


def test_the_input_cannot_be_watched(bondgraph: Command) -> None:
    done = bondgraph("check", "-", "--watch")
    assert done.status == 1 and "name a file" in done.err


# ----------------------------------------------------------------------------------- units


def test_quantities_have_units_wherever_they_are_options(
    bondgraph: Command, tmp_path: Path
) -> None:
    log = tmp_path / "run.csv"
    bondgraph("simulate", MOTOR, "--duration", "250 ms", "--input", "U=12000 mV", "-o", log)
    found = read_log(str(log))
    assert found.time[-1] == pytest.approx(0.25) and found.columns["U"][0] == 12.0
    plain = bondgraph("detect", MOTOR, "--rate", "2000", "--bandwidth", "62.83185307", "--noise",
                      "speed=0.10471975512", "--at", "U=6")  # fmt: skip
    spelled = bondgraph("detect", MOTOR, "--rate", "2 kHz", "--bandwidth", "10 Hz", "--noise",
                        "speed=1 rpm", "--at", "U=6 V")  # fmt: skip
    assert plain.status == 0 and plain.out == spelled.out


@pytest.mark.parametrize(("word", "current"), [("true", 4.0), ("false", 0.0)])
def test_a_switch_is_told_true_or_false(
    bondgraph: Command, tmp_path: Path, word: str, current: float
) -> None:
    model, log = tmp_path / "lamp.bg", tmp_path / "run.csv"
    model.write_text(
        "bg 1\nmodel Lamp {\n input on : bool\n Se:U = if(on, 12, 0)\n"
        " U -> 1:i { -> R:R = 3; -> Df:y }\n}\n"
    )
    assert bondgraph("simulate", model, "--duration", "0.1", "--input", f"on={word}",
                     "-o", log).status == 0  # fmt: skip
    assert read_log(str(log)).columns["y"] == pytest.approx(current)  # 12 V at 3 Ohm


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (("--duration", "4 V"), 2, "in s or with a unit"),
        (("--duration", "-4 s"), 2, "above 0"),
        (("--duration", "4 furlongs"), 2, "in s or with a unit"),
        (("--input", "U=3 A"), 1, "`U` is in V, not in A"),
        (("--input", "U=3 Volt volt"), 2, "NAME=VALUE"),
        (("--input", "U=true"), 1, "`U` is a number, not true or false"),
    ],
)
def test_units_that_do_not_fit_are_refused(
    bondgraph: Command, words: tuple[str, ...], status: int, said: str, tmp_path: Path
) -> None:
    done = bondgraph("simulate", MOTOR, *words, "-o", tmp_path / "run.csv")
    assert done.status == status and said in done.err
    assert not [*tmp_path.iterdir()]


# ----------------------------------------------------------------------- --sweep and --plot


def test_a_sweep_makes_a_run_for_each_value(bondgraph: Command, tmp_path: Path) -> None:
    words = ("simulate", MOTOR, "--input", "U=12", "--duration", "2 s", "-o", tmp_path / "r.csv")
    found = json.loads(bondgraph(*words, "--sweep", "R=10 Ohm..20 Ohm/3", "--json").out)
    assert [run["label"] for run in found["runs"]] == ["R = 10 Ohm", "R = 15 Ohm", "R = 20 Ohm"]
    k, f = 3.51e-3, 1.19e-5
    for resistance, path in zip((10.0, 15.0, 20.0), found["files"], strict=True):
        # at rest k i = f w and U = R i + k w
        speed = 12.0 / (resistance * f / k + k)
        assert read_log(path).columns["speed"][-1] == pytest.approx(speed, rel=1e-3)
    out = bondgraph(*words, "--sweep", "U=6,12", "--sweep", "R=10,20").out
    assert "4 runs of 2 s" in out and "run 4: U = 12 V, R = 20 Ohm" in out


def test_pictures_are_what_their_suffix_says(bondgraph: Command, tmp_path: Path) -> None:
    words = ("simulate", MOTOR, "--input", "U=12", "--duration", "0.5")
    begins = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF", "html": b"<!doctype html>"}
    for suffix, begin in begins.items():
        path = tmp_path / "deep" / f"a.{suffix}"
        done = bondgraph(*words, "--sweep", "R=10,20", "--plot", path, "--show", "speed,J.p")
        assert done.status == 0, done.err
        data = path.read_bytes()
        assert data.startswith(begin)
        if suffix in ("svg", "html"):
            assert b"R = 10 Ohm" in data and b"speed in rad/s" in data and b"J.p" in data
        bondgraph(*words, "--sweep", "R=10,20", "--plot", path, "--show", "speed,J.p")
        assert path.read_bytes() == data
    assert sorted(p.name for p in tmp_path.rglob("*.*")) == ["a.html", "a.pdf", "a.png", "a.svg"]


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (("--plot", "a.gif"), 1, ".png, .svg, .pdf or .html"),
        (("--plot", "a.png", "--show", "spee"), 2, "speed"),
        (("--sweep", "Q=1,2"), 1, "no parameter and no input `Q`"),
        (("--sweep", "R=1..2"), 2, "NAME=FROM..TO/COUNT"),
        (("--sweep", "R=1 V..2 V/3"), 1, "V"),
        (("--sweep", "R=1..2/40", "--sweep", "L=1..2/40"), 1, "1600 runs"),
    ],
)
def test_wrong_sweeps_and_pictures_write_nothing(
    bondgraph: Command, words: tuple[str, ...], status: int, said: str, tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    done = bondgraph("simulate", MOTOR, "--duration", "0.1", *words)
    assert done.status == status and said in done.err
    assert not [*tmp_path.iterdir()]


def test_a_picture_in_python(tmp_path: Path) -> None:
    c = package.compile(MOTOR)
    runs = {
        f"{volt} V": c.simulate(
            package.Scenario("step", duration=0.5, inputs={"U": package.Course.constant(volt)})
        )
        for volt in (6.0, 12.0)
    }
    picture = c.plot(runs, ["speed"])
    assert repr(picture) == "<picture of speed: 6.0 V, 12.0 V>"
    assert picture._repr_svg_().count("6.0 V") == 1
    picture.write(tmp_path / "p.svg")
    assert (tmp_path / "p.svg").read_text() == picture._repr_svg_()
    with pytest.raises(KeyError):
        c.plot(runs, ["nothing"])


# ----------------------------------------------------------------- LaTeX, completion, manual


def test_the_matrix_in_latex_has_the_entries_of_the_matrix(bondgraph: Command) -> None:
    out = bondgraph("dump", MODELS / "khepera.bg", "--stage", "signatures", "--latex").out
    rows = [line for line in out.splitlines() if line.endswith("\\\\")]
    matrix = package.compile(MODELS / "khepera.bg").signatures
    body = [[cell.strip() == "1" for cell in row[:-2].split(" & ")[1:-2]] for row in rows[1:]]
    assert sorted(body) == sorted(map(list, matrix.rows))
    assert len({row.split(" & ")[0] for row in rows}) == len(rows)  # no two faults look alike
    assert out.count("\\hline") == len(matrix.groups) + 3
    done = bondgraph("dump", MOTOR, "--stage", "graph", "--latex")
    assert done.status == 2 and "signatures" in done.err


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_completion_knows_all_commands_and_options(bondgraph: Command, shell: str) -> None:
    out = bondgraph("complete", shell).out
    for name, parser in subparsers(parser_for(None)).items():
        assert name in out
        if shell == "bash":
            for option in parser._option_string_actions:
                assert option in out, (name, option)


def test_bash_completes(bondgraph: Command, tmp_path: Path) -> None:
    if shutil.which("bash") is None:
        pytest.skip("no bash")
    script = tmp_path / "c.bash"
    script.write_text(bondgraph("complete", "bash").out)
    ask = (
        f". {script}; COMP_WORDS=(bondgraph simulate --du); COMP_CWORD=2;"
        " $(complete -p bondgraph | sed 's/.*-F \\([^ ]*\\).*/\\1/') ; echo ${COMPREPLY[@]}"
    )
    done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "--duration"


def test_manual_pages_are_the_help_of_the_commands(bondgraph: Command, tmp_path: Path) -> None:
    done = bondgraph("man", "-o", tmp_path)
    assert done.out == f"{len(COMMANDS) + 1} pages in {tmp_path}\n"
    assert {p.name: p.read_text() for p in tmp_path.iterdir()} == manual_pages()
    page = bondgraph("man", "simulate").out
    assert ".SH OPTIONS" in page and "\\fB\\-\\-sweep NAME=FROM..TO/COUNT\\fR" in page
    for name, parser in subparsers(parser_for(None)).items():
        text = manual_pages()[f"bondgraph-{name}.1"].replace("\\-", "-")
        assert all(option in text for option in parser._option_string_actions), name
        assert not re.search(r"^['.](?!TH|SH|TP|nh|br)", text, re.MULTILINE)
    assert bondgraph("man", "nothing").status == 2


def test_runs_of_a_sweep_differ_by_what_is_swept_only() -> None:
    """The seed is the same: what is drawn at random is, too."""
    from bondgraph.cli.sweeps import settings, sweep
    from bondgraph.runtime.simulation.scenario import Instrument, Scenario

    c = package.compile(MOTOR)
    noisy = Scenario("noisy", duration=0.2, instruments={"current": Instrument(noise=0.1)})
    one, other = (
        c.simulate(own.scenario).log for own in settings(c, noisy, [sweep("J=1e-8,1e-7")])
    )
    assert np.array_equal(one.columns["current"], other.columns["current"])  # nothing moves
