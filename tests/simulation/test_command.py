"""`bondgraph simulate` from the outside: files, failures, interruption, progress."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.log_file import read_log
from bondgraph.runtime.simulation.integrate import Integrator
from tests.simulation.machines import MODELS, example, read

MOTOR = str(MODELS / "dc_motor.bg")


@pytest.fixture(autouse=True)
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def scenario(text: str, name: str = "s.toml") -> str:
    Path(name).write_text(text, encoding="utf-8")
    return name


def test_a_run_writes_its_log_and_the_truth(capsys: pytest.CaptureFixture[str]) -> None:
    name = scenario(
        'duration = "50 ms"\ninputs.U = 12\nsensors.speed.noise = 1\n'
        '[[fault]]\nof = "R"\nchange = "+= 1 Ohm"\nat = 0.01'
    )
    assert main(["simulate", MOTOR, name, "-o", "log.csv", "--truth", "truth.csv", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["status"] == "ok" and said["files"] == ["log.csv", "truth.csv"]
    log, truth = read_log("log.csv"), read_log("truth.csv")
    assert log.rows == truth.rows == said["samples"] == 51
    assert set(log.columns) == {"U", "load", "speed", "current"} == set(said["signals"])
    assert log.units["U"] == "V" and log.meta["model"] == "Motor"
    assert abs(truth.columns["speed"] - log.columns["speed"]).max() > 0.5
    assert (truth.columns["current"] == log.columns["current"]).all()


def test_values_from_the_command_line_come_before_those_of_the_scenario(
    capsys: pytest.CaptureFixture[str],
) -> None:
    name = scenario("duration = 9\ninputs.U = 12\nparameters.R = 3")
    words = ["--set", "R=5", "--input", "U=2", "--duration", "0.01", "--seed", "4", "--json"]
    assert main(["simulate", MOTOR, name, *words]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["parameters"]["R"], said["duration"], said["seed"]) == (5, 0.01, 4)
    assert (read_log("s.csv").columns["U"] == 2).all()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('inputs.U = "if(t > 0.02, sqrt(0.03 - t), 1)"', ("0.03", "`U`")),
        ('inputs.U = "1/0"', ("zero",)),
        ("inputs.V = 1", ("`V`", "`U`")),
        ("sampling.rate = 1e11", ("samples",)),
        ("sampling.rate = 1e12", ("rate",)),
        ("inputs.U = ", ("TOML",)),
    ],
)
def test_what_goes_wrong_is_one_message_and_no_file(
    text: str, words: tuple[str, ...], capsys: pytest.CaptureFixture[str], beside: Path
) -> None:
    assert main(["simulate", MOTOR, scenario(f"duration = 0.1\n{text}")]) == 1
    said = capsys.readouterr()
    assert all(word in said.out + said.err for word in words)
    assert "Traceback" not in said.err
    assert sorted(p.name for p in beside.iterdir()) == ["s.toml"]


def test_a_model_without_numbers_says_which_are_missing(
    capsys: pytest.CaptureFixture[str],
) -> None:
    Path("m.bg").write_text("bg 1\nmodel M { param R : Ohm; Se:U -> 1:i; i -> R:R; i -> Df:y }")
    assert main(["simulate", "m.bg"]) == 1
    assert "`R` has no value" in capsys.readouterr().err
    assert main(["simulate", "m.bg", "--set", "R=2", "--duration", "0.01"]) == 0


def test_an_interrupted_run_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], beside: Path
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Integrator, "run", interrupted)
    assert main(["simulate", MOTOR, "-o", "log.csv"]) == 130
    assert "interrupted" in capsys.readouterr().err
    assert not list(beside.iterdir())


def test_a_long_segment_says_how_far_it_is() -> None:
    machine = example("dc_motor")
    shares: list[float] = []
    machine.simulate(read(machine, 'duration = 3\ninputs.U = "3*sin(9*t)"'), shares.append)
    assert shares[0] == 0 and shares[-1] == 1 and max(shares) == 1
    assert len([s for s in shares if 0.1 < s < 0.9]) > 5


def test_a_terminal_shows_a_bar() -> None:
    pty = pytest.importorskip("pty")
    program = (
        "from bondgraph.cli.console import progress_bar\nimport time\n"
        "with progress_bar('simulating', 0.0) as share:\n"
        "    share(0.5)\n    time.sleep(0.3)\n"
    )
    far, near = pty.openpty()
    subprocess.run([sys.executable, "-c", program], stderr=near, check=True)
    os.close(near)
    seen = os.read(far, 4096).decode()
    os.close(far)
    assert "[============            ] simulating" in seen


def test_a_run_that_cannot_be_compiled_says_so(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("bondgraph.runtime.simulation.native_machine.WORTH", 1)
    monkeypatch.setenv("CC", "no-such-compiler")
    name = scenario("duration = 0.1\ninputs.U = 12")
    assert main(["simulate", MOTOR, name, "--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["samples"] == 101
    (line,) = [line for line in said.err.splitlines() if line.startswith("note: no C")]
    assert "no-such-compiler" in line and "Python" in line
