"""`bondgraph fit` from a log to a file that the other commands take."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import bondgraph as package
from bondgraph import Log
from bondgraph.cli.fit import _fits
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.errors_in_variables import Wanted
from bondgraph.runtime.diagnosis.fitted import Left, Span
from bondgraph.runtime.diagnosis.parameter_fit import fit
from bondgraph.runtime.diagnosis.tuning import bandwidth_for
from bondgraph.runtime.log_file import write_log
from tests.unit.cli.conftest import Command
from tests.unit.runtime.diagnosis.test_parameter_fit import VIBRATION, vibration

MODEL = """bg 1
model Circuit { param R = 2 Ohm +- 5%; param L = 1 mH
  Se:U -> 1:i; i -> R:R; i -> I:L; i -> Df:y }
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A model, and the log of a circuit with 3 Ohm and 1 mH (by hand: U = R i + L di/dt)."""
    monkeypatch.chdir(tmp_path)
    Path("c.bg").write_text(MODEL)
    t = np.arange(6000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    noise = 0.01 * np.random.default_rng(5).standard_normal(len(t))
    write_log(Log(t, {"U": 3.0 * i + 1e-3 * rate, "y": i + noise}, {}, {}), "log.csv")
    return tmp_path


def test_the_table_the_file_and_the_json_say_the_same(bondgraph: Command, folder: Path) -> None:
    done = bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    row = re.search(r"^  R +2 +(\S+) +(\S+) +Ohm$", done.out, re.MULTILINE)
    assert row is not None
    value, interval = map(float, row.groups())
    assert abs(value - 3.0) <= interval < 0.05
    assert "is explained" in done.out
    data = tomllib.loads((folder / "p.toml").read_text())
    assert f"{data['parameters']['R']:.6g}" == row[1]
    assert list(data["parameters"]) == ["R"]  # L has no tolerance
    found = json.loads(bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml", "--json").out)
    assert found["status"] == "ok"
    (one,) = found["parameters"]
    assert one["value"] == data["parameters"]["R"]
    assert one["error"] == data["standard_errors"]["R"]
    assert abs(found["noise"]["y"] - 0.01) < 0.001


@pytest.mark.parametrize("squared", [0.0, 0.3])
def test_a_log_without_noise_fits_unless_the_law_is_another(
    bondgraph: Command, folder: Path, squared: float
) -> None:
    """What samples are off by is no noise and has a memory; a law that is squared in i is one."""
    t = np.arange(6000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    write_log(Log(t, {"U": 3.0 * i + squared * i**2 + 1e-3 * rate, "y": i}, {}, {}), "log.csv")
    done = bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    assert ("of its largest term, as of samples without noise" in done.out) == (not squared)
    assert ("the model" in done.out) == bool(squared)


def test_an_input_with_noise_looks_like_another_model(
    bondgraph: Command, folder: Path
) -> None:
    """A wind of 8 +- 1 m/s that is read with 0.5 m/s of noise drives a law of its cube."""
    (folder / "w.bg").write_text("""bg 1
model W { input v : m/s; param k = 2; param R = 3 N.m.s/rad +- 5%
  Se:wind = k*v^3; wind -> 1:s; s -> R:R; s -> Df:speed }""")
    draw = np.random.default_rng(5)
    t = np.arange(6000) / 20.0
    v = 8.0 + np.sin(0.5 * t) + 0.5 * np.sin(1.3 * t)
    speed = 2.0 * v**3 / 3.0 + 0.5 * draw.standard_normal(len(t))
    read = v + 0.5 * draw.standard_normal(len(t))
    write_log(Log(t, {"v": read, "speed": speed}, {}, {}), "w.csv")
    done = bondgraph("fit", "w.bg", "w.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    assert "follows the inputs" in done.out
    assert "say with how much (--noise v=DEVIATION)" in done.out
    done = bondgraph("fit", "w.bg", "w.csv", "-o", "p.toml", "--noise", "v=0.5")
    assert done.status == 0, done.err
    assert "DEVIATION" not in done.out
    assert "1 of 1 parameter told" in done.out
    assert abs(tomllib.loads((folder / "p.toml").read_text())["parameters"]["R"] - 3.0) < 0.1


def test_only_inputs_that_a_wrong_residual_reads_may_be_read_with_noise(
    bondgraph: Command, folder: Path
) -> None:
    """Two circuits side by side: the law of the second is another, and its voltage is `b`."""
    (folder / "two.bg").write_text("""bg 1
model Two { input a : V; input b : V; param R = 2 Ohm +- 5%; param S = 2 Ohm +- 5%
  Se:first = a; first -> 1:i; i -> R:R; i -> Df:x
  Se:second = b; second -> 1:j; j -> R:S; j -> Df:y }""")
    draw, t = np.random.default_rng(5), np.arange(6000) / 1000.0
    x, y = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t), np.sin(5.0 * t) + 0.5 * np.sin(17.0 * t)
    noise = 0.01 * draw.standard_normal((2, len(t)))
    columns = {"a": 2.1 * x, "b": 2.1 * y + y**2, "x": x + noise[0], "y": y + noise[1]}
    write_log(Log(t, columns, {}, {}), "two.csv")
    done = bondgraph("fit", "two.bg", "two.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    assert "say with how much (--noise b=DEVIATION)" in done.out


def test_what_a_wrong_law_tells_has_no_interval_either(bondgraph: Command, folder: Path) -> None:
    """R of 3 Ohm and 1.2 V beside it, that turns with the current: the law has no such term."""
    t = np.arange(6000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    noise = np.random.default_rng(3).normal(0.0, 0.002, len(t))
    drive = 3.0 * i + 1.2 * np.tanh(20.0 * i) + 1e-3 * rate
    write_log(Log(t, {"U": drive, "y": i + noise}, {}, {}), "log.csv")
    done = bondgraph("fit", "c.bg", "log.csv", "--free", "R", "-o", "p.toml")
    assert done.status == 0, done.err
    assert "follows the inputs" in done.out
    assert "0 of 1 parameter told" in done.out and "1 fitted without an interval" in done.out
    assert "not told" not in done.out
    text = (folder / "p.toml").read_text()
    assert "# Ohm, no interval: the model leaves something out" in text
    assert not tomllib.loads(text)["standard_errors"]


@pytest.mark.parametrize(
    ("tolerance", "squared", "out"), ((5, 0.0, True), (5, 0.3, True), (60, 0.0, False))
)
def test_what_is_outside_of_its_tolerance_is_told(
    bondgraph: Command, folder: Path, tolerance: int, squared: float, out: bool
) -> None:
    """R is 3 Ohm where 2 are declared; with a law that is another nobody knows that."""
    (folder / "c.bg").write_text(MODEL.replace("5%", f"{tolerance}%").replace("1 mH", "1 mH +- 3%"))
    t = np.arange(6000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    noise = np.random.default_rng(7).normal(0.0, 0.002, len(t))
    drive = 3.0 * i + squared * i**3 + 1e-3 * rate
    write_log(Log(t, {"U": drive, "y": i + noise}, {}, {}), "log.csv")
    done = bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    told = re.search(r"^Outside of declared tolerances: R \+(\S+) % \(\+- 5 %\)", done.out, re.M)
    assert (told is not None) == out
    if told and not squared:
        assert float(told[1]) == pytest.approx(50.0, abs=1.0)
    loose = "only makes the residuals small: leave out of the fit what is known better (--free"
    assert (loose in done.out) == bool(squared)


def test_what_is_fitted_as_next_to_nothing_is_not_said_to_be_known_better(
    bondgraph: Command, folder: Path
) -> None:
    """Of a frictionless bearing b is 0.01 +- 0.09 N.s/m, declared as 0.5: zero is in the interval.

    Such ones were named among those that should be fitted, and others left out.
    """
    text = """bg 1
model M { param m = 2 kg +- 5%; param b = 0.5 N.s/m +- 10%
  Se:F -> 1:v; v -> I:m; v -> R:b; v -> Df:y }"""
    (folder / "m.bg").write_text(text)
    t = np.arange(8000) / 1000.0
    force = 5.0 * np.cos(7.0 * t) + 3.0 * np.cos(23.0 * t)
    speed = 5.0 / 14.0 * np.sin(7.0 * t) + 3.0 / 46.0 * np.sin(23.0 * t)
    noise = 0.05 * np.random.default_rng(1).standard_normal(len(t))
    write_log(Log(t, {"F": force, "y": speed + noise}, {}, {}), "log.csv")
    done = bondgraph("fit", "m.bg", "log.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    (advice,) = (line for line in done.out.splitlines() if " only makes the residuals" in line)
    assert advice.startswith("  b only") and advice.endswith(" (--free m)")
    assert "\n  b is not told\n" in done.out
    assert (folder / "p.toml").read_text().count("not told by the logs") == 1


def test_a_signal_that_is_in_the_log_too_soon_comes_early(
    bondgraph: Command, folder: Path
) -> None:
    """U jumps every 0.4 s and is in the log half a sample before the current does."""
    t = np.arange(6000) / 1000.0
    drive = np.where(np.floor(t / 0.4) % 2 == 0, 1.0, -1.0) * (1.0 + 0.2 * np.floor(t))
    soon = 0.5 * (drive + np.append(drive[1:], drive[-1]))
    noise = np.random.default_rng(3).normal(0.0, 0.001, len(t))
    text = "bg 1\nmodel M { param R = 2 Ohm; Se:U -> 1:i -> R:R; i -> Df:y }"
    (folder / "r.bg").write_text(text)
    write_log(Log(t, {"U": soon, "y": drive / 3.0 + noise}, {}, {}), "log.csv")
    done = bondgraph("fit", "r.bg", "log.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    told = re.findall(r"^  (\S) comes (\S+) ms early in the log$", done.out, re.MULTILINE)
    # straight lines make both half a sample early, which is nothing: all there is is that early
    assert [name for name, _ in told] == ["U"]
    assert float(told[0][1]) == pytest.approx(0.5, abs=0.02)


def test_times_of_a_slow_log_are_told_in_units_that_people_count_in(
    bondgraph: Command, folder: Path
) -> None:
    """A sample each 30 s for two days: `2.17e+04 ms early in the log` and `1.8e+05 s of healthy
    operation` was told of such a one."""
    t = 30.0 * np.arange(6000)
    drive = np.where(np.floor(t / 3600.0) % 2 == 0, 1.0, -1.0) * (1.0 + t / t[-1])
    soon = 0.5 * (drive + np.append(drive[1:], drive[-1]))
    noise = np.random.default_rng(3).normal(0.0, 0.001, len(t))
    text = "bg 1\nmodel M { param R = 2 Ohm; Se:U -> 1:i -> R:R; i -> Df:y }"
    (folder / "r.bg").write_text(text)
    write_log(Log(t, {"U": soon, "y": drive / 3.0 + noise}, {}, {}), "log.csv")
    done = bondgraph("fit", "r.bg", "log.csv", "-o", "p.toml")
    assert done.status == 0, done.err
    assert re.search(r"^  U comes 1[45][.0-9]* s early in the log$", done.out, re.MULTILINE)
    assert re.search(r" told by 2\.0[0-9] days of healthy operation\n", done.out)
    tuned = bondgraph("tune", "r.bg", "log.csv", "-o", "t.json")
    assert re.search(r" tuned on 2\.0[0-9] days for ", tuned.out), tuned.out


def test_a_delay_that_may_be_more_than_is_fitted_is_told_so(
    bondgraph: Command, folder: Path
) -> None:
    """The current of R and L comes four samples late."""
    t = np.arange(4000) / 100.0
    drive, rate = np.sign(np.sin(7.0 * t)), np.exp(-0.01 * 3.0 / 0.06)
    y = np.zeros(len(t))
    for k in range(1, len(t)):
        y[k] = drive[k - 1] / 3.0 + (y[k - 1] - drive[k - 1] / 3.0) * rate
    y = np.roll(y, 4) + np.random.default_rng(1).normal(0.0, 0.005, len(t))
    text = "bg 1\nmodel M { param R = 2 Ohm; param L = 50 mH; Se:U -> 1:i -> R:R"
    text += "; i -> I:L; i -> Df:y }"
    (folder / "rl.bg").write_text(text)
    write_log(Log(t, {"U": drive, "y": y}, {}, {}), "log.csv")
    done = bondgraph("fit", "rl.bg", "log.csv", "-o", "p.toml")
    # of both 15 ms are fitted, and only how far they are apart is known: beside either of them
    late = "  U comes 30 ms early", "  y comes 30 ms late"
    assert sum(f"{one} in the log or more: no more is fitted" in done.out for one in late) == 1
    record = json.loads(bondgraph("fit", "rl.bg", "log.csv", "-o", "p.toml", "--json").out)
    assert sorted(d["bound"] for d in record["delays"]) == [False, True]


def test_what_is_not_told_has_no_interval(bondgraph: Command, folder: Path) -> None:
    text = MODEL.replace("param L", "param S = 1 Ohm; param L")
    text = text.replace("i -> R:R", "i -> R:R; i -> R:S")
    (folder / "c.bg").write_text(text)
    done = bondgraph("fit", "c.bg", "log.csv", "--free", "R,S", "-o", "p.toml")
    assert "only R + S is told" in done.out
    assert done.out.count("not told") == 2
    data = tomllib.loads((folder / "p.toml").read_text())
    assert abs(data["parameters"]["R"] + data["parameters"]["S"] - 3.0) < 0.01
    assert not data["standard_errors"]


def test_a_log_is_read_as_the_other_commands_read_it(bondgraph: Command, folder: Path) -> None:
    """Time in ms under a name of its own; while the circuit is off another one is measured."""
    own = ["--bandwidth", "20"]  # the samples that do not count make the other log longer
    assert bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml", *own).status == 0
    plain = tomllib.loads((folder / "p.toml").read_text())["parameters"]["R"]
    rows = [row for row in (folder / "log.csv").read_text().splitlines() if row[0] not in "#t"]
    lines = ["U;y;clock;on"]
    for time, volts, current in (map(float, row.split(",")) for row in rows):
        lines.append(f"{volts};{current};{1000 * time};1")
    lines += [f"7;1;{6000 + k};0" for k in range(2000)]
    (folder / "other.csv").write_text("\n".join(lines))
    words = ["--time", "clock", "--time-unit", "ms", "--while", "on > 0"]
    done = bondgraph("fit", "c.bg", "other.csv", "-o", "q.toml", *words, *own)
    assert done.status == 0, done.err
    assert "note: other.csv: time is" in done.err
    fitted = tomllib.loads((folder / "q.toml").read_text())["parameters"]["R"]
    assert fitted == pytest.approx(plain, rel=1e-6)
    never = bondgraph("fit", "c.bg", "other.csv", *words[:4], "--while", "on > 1")
    assert never.status == 1 and "holds for no sample" in never.err


def test_a_machine_that_is_on_by_the_day_is_fitted(bondgraph: Command, folder: Path) -> None:
    """On for 400 of each 500 samples, twenty times: a filter for 8000 in a row has not settled."""
    t = np.arange(10_000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    on = (np.arange(len(t)) % 500 >= 100).astype(float)
    noise = 0.01 * np.random.default_rng(5).standard_normal(len(t))
    columns = {"U": on * (3.0 * i + 1e-3 * rate), "y": on * i + noise, "on": on}
    write_log(Log(t, columns, {}, {}), "days.csv")
    done = bondgraph("fit", "c.bg", "days.csv", "--while", "on > 0", "-o", "p.toml")
    assert done.status == 0, done.err
    data = tomllib.loads((folder / "p.toml").read_text())
    error = data["standard_errors"]["R"]
    assert abs(data["parameters"]["R"] - 3.0) <= 3.0 * error < 0.03


@pytest.mark.parametrize(
    ("words", "status", "said"),
    [
        (["log.csv", "--free", "Q"], 2, "no parameter, sensor or input of the model is called `Q`"),
        (["none.csv"], 1, "none.csv"),
        (["short.csv"], 1, "too short to fit parameters: give one of"),
        (["bare.csv"], 1, "no column for y"),
        (["log.csv", "--noise", "z=1"], 2, "no signal that the residuals read"),
        (["log.csv", "--map", "none.toml"], 1, "none.toml"),
        (["log.csv", "--set", "R=2 V"], 1, "unit"),
        (["log.csv", "--parameters", "none.toml"], 1, "none.toml"),
    ],
)
def test_what_is_wrong_is_told_and_nothing_is_written(
    bondgraph: Command, folder: Path, words: list[str], status: int, said: str
) -> None:
    lines = (folder / "log.csv").read_text().splitlines(keepends=True)
    (folder / "short.csv").write_text("".join(lines[:60]))
    t = np.arange(5000) / 1000.0
    write_log(Log(t, {"U": t}, {}, {}), "bare.csv")
    done = bondgraph("fit", "c.bg", *words)
    assert done.status == status
    assert said in done.err
    assert "Traceback" not in done.err
    assert not (folder / "parameters.toml").exists()


def test_a_model_without_a_parameter_to_fit_says_so(bondgraph: Command, folder: Path) -> None:
    (folder / "c.bg").write_text("bg 1\nmodel Bare { Se:U -> 1:i; i -> R:R = 2 Ohm; i -> Df:y }\n")
    done = bondgraph("fit", "c.bg", "log.csv")
    assert done.status == 1
    assert "give one to a parameter" in done.err


@pytest.mark.parametrize("command", ["fit", "tune"])
def test_a_log_without_a_row_is_named(bondgraph: Command, folder: Path, command: str) -> None:
    (folder / "bare.csv").write_text("t,U,y,on\n")
    done = bondgraph(command, "c.bg", "log.csv", "bare.csv")
    assert done.status == 1
    assert "bare.csv: no samples: there are columns, and no rows below them" in done.err
    assert "told" not in done.err and "Traceback" not in done.err


def test_no_pieces_of_logs_are_too_short() -> None:
    """As a program may hand them over, all of whose samples were thrown away."""
    made = package.compile(text=MODEL, rate=1000.0)
    engine, empty = made.engine(), np.empty((0, 2))
    with pytest.raises(ValueError, match="too short to fit parameters"):
        fit(engine, [], Wanted(("R",)), made.diagnosis_model, {})
    for logs in ([], [empty]):
        with pytest.raises(ValueError, match="nothing can be learned"):
            tune(engine, made.diagnosis_model, logs, made.program.digest, 1.0)


@pytest.mark.parametrize("command", ["fit", "tune"])
def test_a_model_without_residuals_says_so(
    bondgraph: Command, folder: Path, command: str
) -> None:
    (folder / "c.bg").write_text("bg 1\nmodel Blind { param R = 2 Ohm; Se:U -> 1:i; i -> R:R }\n")
    done = bondgraph(command, "c.bg", "log.csv")
    assert done.status == 1
    assert "Blind has no residual that could be watched" in done.err


def test_numbers_from_file_and_words_stand_in_for_those_of_the_model(
    bondgraph: Command, folder: Path
) -> None:
    (folder / "p.toml").write_text('[parameters]\nR = "0.003 kOhm"\nL = 2e-3\n')
    words = ["c.bg", "--parameters", "p.toml", "--duration", "0.01", "--json"]
    found = json.loads(bondgraph("simulate", *words).out)
    assert found["parameters"] == {"R": 3.0, "L": 2e-3}
    found = json.loads(bondgraph("simulate", *words, "--set", "R=4 Ohm").out)
    assert found["parameters"] == {"R": 4.0, "L": 2e-3}
    (folder / "s.toml").write_text("duration = 0.01\n[parameters]\nR = 5\n")
    found = json.loads(bondgraph("simulate", "c.bg", "s.toml", *words[1:]).out)
    assert found["parameters"] == {"R": 5.0, "L": 2e-3}  # the scenario is more particular
    done = bondgraph("compile", "c.bg", "--set", "R=4", "-o", "out", "--target", "python")
    assert done.status == 0
    code = "".join(p.read_text() for p in (folder / "out").rglob("*.py"))
    assert re.search(r"R: float = 4\.0", code)


@pytest.mark.parametrize("text", ["x = 1\n", "[parameters]\n", "[parameters]\nQ = 1\n", "R ="])
def test_a_file_of_parameters_without_any_is_wrong(
    bondgraph: Command, folder: Path, text: str
) -> None:
    (folder / "p.toml").write_text(text)
    done = bondgraph("compile", "c.bg", "--parameters", "p.toml")
    assert done.status == 1
    assert "p.toml:" in done.err
    assert "help" in done.err


def test_a_tuning_belongs_to_the_numbers_that_it_was_made_with(
    bondgraph: Command, folder: Path
) -> None:
    assert folder.exists()
    bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml")
    own = ["--parameters", "p.toml"]
    assert bondgraph("tune", "c.bg", "log.csv", *own, "--bandwidth", "20").status == 0
    tuned = ["monitor", "c.bg", "log.csv", "--tuning", "tuning.json", "--bandwidth", "20"]
    watched = bondgraph(*tuned, *own)
    assert watched.status == 0
    assert "fault" not in watched.out
    assert bondgraph(*tuned).status == 1


def test_tune_goes_on_to_faster_filters_while_these_show_more(
    bondgraph: Command, folder: Path
) -> None:
    """A mass on a spring, driven around its 450 rad/s: behind 4 times the usual filter little is
    left of that. The circuit moves at 8 and 21 rad/s, and no filter beyond is tried."""
    (folder / "v.bg").write_text(VIBRATION)
    write_log(vibration(), folder / "v.csv")
    fitted = ["--parameters", "p.toml", "--json"]
    bondgraph("fit", "v.bg", "v.csv", "-o", "p.toml")
    found = json.loads(bondgraph("tune", "v.bg", "v.csv", *fitted).out)
    tried = [one["bandwidth"] for one in found["tried"]]
    usual = bandwidth_for(610.0, 24_400)
    assert tried[-1] == found["bandwidth"] == pytest.approx(16.0 * usual)
    assert found["tried"][-1]["score"] < found["tried"][-2]["score"] - 0.1
    bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml")
    found = json.loads(bondgraph("tune", "c.bg", "log.csv", *fitted).out)
    tried = [one["bandwidth"] for one in found["tried"]]
    assert tried[-1] <= 4.0 * bandwidth_for(1000.0, 6000)


def test_the_watch_has_the_filter_that_told_its_parameters(
    bondgraph: Command, folder: Path
) -> None:
    """Where that is a faster one: so it is of the mass on a spring, not of the circuit."""
    (folder / "v.bg").write_text(VIBRATION)
    write_log(vibration(), folder / "v.csv")
    for model in "cv":
        log = "log.csv" if model == "c" else "v.csv"
        assert bondgraph("fit", f"{model}.bg", log, "-o", f"{model}.toml").status == 0
    found = tomllib.loads((folder / "v.toml").read_text())
    usual, fast = bandwidth_for(610.0, 24_400), found.pop("filter")["bandwidth"]
    assert fast == pytest.approx(16.0 * usual)
    assert "filter" not in tomllib.loads((folder / "c.toml").read_text())
    slow = (folder / "v.toml").read_text().replace(f"[filter]\nbandwidth = {fast!r}\n", "")
    (folder / "slow.toml").write_text(slow)
    took = {}
    for numbers in ("v.toml", "slow.toml"):
        words = ["v.bg", "v.csv", "--parameters", numbers, "--states", "states.csv"]
        assert bondgraph("monitor", *words).status == 0
        first = (folder / "states.csv").read_text().splitlines()[1:]
        took[numbers] = sum(",warming up," in line for line in first)
    ratio = took["slow.toml"] / took["v.toml"]
    assert ratio == pytest.approx(16.0, rel=0.3)  # filters settle and rows end that much sooner
    assert bondgraph("monitor", "v.bg", "v.csv", "v.csv", "--parameters", "v.toml").status == 0


def test_options_take_numbers_by_name() -> None:
    c = package.compile(text=MODEL, parameters={"R": 4.0})
    assert c.options.parameters == (("R", 4.0),)
    assert c.engine(native=False).parameters == {"R": 4.0, "L": 1e-3}
    assert repr(c.residuals["r1"]) == repr(package.compile(text=MODEL).residuals["r1"])
    with pytest.raises(ValueError, match="finite"):
        package.compile(text=MODEL, parameters={"R": float("nan")})
    with pytest.raises(ValueError, match="no value `Q`"):
        assert package.compile(text=MODEL, parameters={"Q": 1.0}).graph
    with pytest.raises(ValueError, match="negative"):
        package.compile(text=MODEL, tolerances={"R": -0.1})
    with pytest.raises(ValueError, match="no value `Q`"):
        assert package.compile(text=MODEL, tolerances={"Q": 0.1}).graph


def _biased(folder: Path, name: str, seed: int, offset: float) -> None:
    """A log of the circuit whose ammeter says so much too much."""
    t = np.arange(20_000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    noise = 0.01 * np.random.default_rng(seed).standard_normal(len(t))
    write_log(Log(t, {"U": 2.0 * i + 1e-3 * rate, "y": i + offset + noise}, {}, {}), folder / name)


def test_an_offset_goes_from_fit_to_every_command_that_reads_logs(
    bondgraph: Command, folder: Path
) -> None:
    _biased(folder, "off.csv", 1, 0.3)
    _biased(folder, "true.csv", 2, 0.0)
    (folder / "live").mkdir()
    _biased(folder / "live", "a.csv", 3, 0.3)
    _biased(folder / "live", "b.csv", 4, 0.3)
    first = bondgraph("fit", "c.bg", "off.csv", "-o", "p.toml")
    assert "an offset of y of 0.3" in first.out
    assert "(--free R,y)" in first.out
    done = bondgraph("fit", "c.bg", "off.csv", "-o", "p.toml", "--free", "R,y")
    assert re.search(r"^  offset of y +0 +0\.\d+ +\S+", done.out, re.MULTILINE), done.out
    data = tomllib.loads((folder / "p.toml").read_text())
    assert data["offsets"]["y"] == pytest.approx(0.3, abs=0.005)
    assert set(data["standard_errors"]) == {"R", "y"}
    own = ["--parameters", "p.toml", "--bandwidth", "20"]
    assert bondgraph("tune", "c.bg", "off.csv", *own).status == 0
    watch = ["--tuning", "tuning.json", *own]
    assert "fault" not in bondgraph("monitor", "c.bg", "live/a.csv", *watch).out
    assert "fault" in bondgraph("monitor", "c.bg", "true.csv", *watch).out
    many = bondgraph("monitor", "c.bg", "live", *watch, "--json")
    assert many.status == 0
    assert "2 logs" in bondgraph("monitor", "c.bg", "live", *watch).out
    assert '"event": "stop"' in many.out
    assert '"event": "fault"' not in many.out
    bare = bondgraph("monitor", "c.bg", "live/a.csv", *watch[:2], *own[2:])
    assert bare.status == 1
    assert "another model" in bare.err


def test_what_was_given_and_is_not_fitted_stays_in_the_file(
    bondgraph: Command, folder: Path
) -> None:
    (folder / "given.toml").write_text("[parameters]\nL = 0.001\n[offsets]\ny = 0.0\nU = 0.125\n")
    done = bondgraph("fit", "c.bg", "log.csv", "--parameters", "given.toml", "-o", "p.toml")
    assert done.status == 0
    data = tomllib.loads((folder / "p.toml").read_text())
    assert data["parameters"]["L"] == 0.001
    assert data["offsets"] == {"y": 0.0, "U": 0.125}


def _smallest(bondgraph: Command, options: list[str]) -> float:
    """The change of R, relative, that is sure to show in the first log."""
    done = bondgraph("tune", "c.bg", "r0.csv", "--json", *options)
    (one,) = [s for s in json.loads(done.out)["faults"] if s["fault"] == "R"]
    return float(one["relative"])


def test_tolerances_go_from_logs_that_differ_to_the_thresholds(
    bondgraph: Command, folder: Path
) -> None:
    """Three circuits of 1.98, 2 and 2.02 Ohm: of a further one 4.303*0.02*sqrt(4/3)/2 = 5 %."""
    text = MODEL.replace("+- 5%", "+- 20%")
    Path("c.bg").write_text(text)
    t = np.arange(6000) / 1000.0
    i = np.sin(8.0 * t) + 0.5 * np.sin(21.0 * t)
    rate = 8.0 * np.cos(8.0 * t) + 10.5 * np.cos(21.0 * t)
    for k, R in enumerate((1.98, 2.0, 2.02)):
        noise = 0.003 * np.random.default_rng(k).standard_normal(len(t))
        write_log(Log(t, {"U": R * i + 1e-3 * rate, "y": i + noise}, {}, {}), f"r{k}.csv")
    done = bondgraph("fit", "c.bg", "r0.csv", "r1.csv", "r2.csv", "-o", "p.toml")
    assert re.search(r"^  R .* Ohm +(4\.9|5|5\.1) %$", done.out, re.MULTILINE), done.out
    assert "instead of R 20 %" in done.out
    found = tomllib.loads((folder / "p.toml").read_text())["tolerances"]
    assert found == {"R": pytest.approx(0.05, rel=0.05)}
    one = package.compile("c.bg", parameters={"R": 2.0}, tolerances=found)
    written = package.compile(text=text.replace("20%", f"{100 * found['R']:.15g}%"))
    assert one.diagnosis_model.tolerances == pytest.approx(written.diagnosis_model.tolerances)
    least = [_smallest(bondgraph, options) for options in ([], ["--parameters", "p.toml"])]
    assert 3.0 < least[0] / least[1] < 4.5  # twice the tolerance, and noise in both
    alone = bondgraph("fit", "c.bg", "r0.csv", "-o", "p.toml")
    assert "one log does not tell how far parameters stand apart" in alone.out
    assert "tolerances" not in tomllib.loads((folder / "p.toml").read_text())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[offsets]\nz = 1\n", "no sensor or input with an offset `z`"),
        ("[offsets]\ny = true\n", "quantity"),
        ('[offsets]\ny = "3 blah"\n', "blah"),
        ("[tolerances]\nR = 5\n", "`R` is 5."),
        ("[tolerances]\nR = -0.1\n", "`R` is -0.1."),
        ("[tolerances]\nQ = 0.1\n", "no parameter `Q`"),
        ("[filter]\nbandwidth = -3\n", "`bandwidth` is -3."),
        ('[filter]\nbandwidth = "3 Hz"\n', "bandwidth"),  # rad/s is what it is in
    ],
)
def test_a_wrong_offset_or_tolerance_is_told(
    bondgraph: Command, folder: Path, text: str, said: str
) -> None:
    (folder / "p.toml").write_text(text)
    done = bondgraph("tune", "c.bg", "log.csv", "--parameters", "p.toml")
    assert done.status == 1
    assert said in done.err.lower() or said in done.err
    assert "p.toml:2" in done.err


def test_a_machine_is_simulated_with_the_offsets_of_its_instruments() -> None:
    twelve = {"U": package.Course.constant(12.0)}
    scenario = package.Scenario("x", duration=0.05, inputs=twelve)
    plain = package.compile(text=MODEL).simulate(scenario).log
    off = package.compile(text=MODEL, offsets={"y": 0.5, "U": 0.25}).simulate(scenario).log
    assert np.allclose(off.columns["y"], plain.columns["y"] + 0.5)
    assert np.allclose(off.columns["U"], 12.25)
    with pytest.raises(ValueError, match="no sensor or input `z`"):
        assert package.compile(text=MODEL, offsets={"z": 1.0}).graph


def test_measured_and_predicted_are_drawn(bondgraph: Command, folder: Path) -> None:
    done = bondgraph("fit", "c.bg", "log.csv", "-o", "p.toml", "--plot", "fit.svg")
    assert done.status == 0
    assert "p.toml and fit.svg" in done.out
    text = (folder / "fit.svg").read_text()
    root = ElementTree.fromstring(text)
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    for word in ("measured", "predicted", "left", "r1: term of R"):
        assert word in text
    assert text.count("<path") > 6


def test_times_of_a_log_with_dates_are_dates() -> None:
    """2020-03-09T10:24:33Z is 1583749473 s: with four digits both ends read 1.584e+09 s."""
    span = Span("a.csv", 1583749473.0, 1583749533.0, 3.0)
    (_, said) = _fits(Left("r1", 40, 1.0, 1.0, 1.0, 0.0, None, (span,), 10.0), offset=False)
    assert "from 2020-03-09T10:24:33.000Z to 2020-03-09T10:25:33.000Z it is" in said


def test_a_residual_that_the_fit_makes_larger_has_no_negative_share_explained() -> None:
    """1.5 times as large: the share 1 - 1.5^2 of its mean square is below zero."""
    (said,) = _fits(Left("r1", 40, 2.0, 3.0, 1.0, 0.0, None, (), 10.0), offset=False)
    assert said.startswith("r1: 1.5 times what it is at the nominal values; what is left is 3 ")
    (said,) = _fits(Left("r1", 40, 2.0, 2.0002, 1.0, 0.0, None, (), 10.0), offset=False)
    assert said.startswith("r1: as large as at the nominal values; what is left is 2 ")


def test_a_residual_that_is_larger_with_its_noise_is_said_to_be() -> None:
    """1.45 times as large with 1.5 times the noise: beside that it is less than it was."""
    left = Left("r1", 40, 2.0, 2.9, 2.9, 0.0, None, (), 10.0, 0.0, 1.5)
    (said,) = _fits(left, offset=False)
    assert "r1: 1.45 times what it is at the nominal values, and its noise 1.5 times: b" in said
    (said,) = _fits(left._replace(louder=1.4), offset=False)
    assert "r1: 1.45 times what it is at the nominal values; what is left" in said
