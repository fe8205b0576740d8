"""Which filter `tune` takes of those that it tried."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from bondgraph import Log
from bondgraph.cli.tune import _best, _score, _usual
from bondgraph.runtime.diagnosis.calibration import Tuned
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.shown_sizes import Shown
from bondgraph.runtime.diagnosis.tuning import Tuning
from bondgraph.runtime.log_file import write_log
from tests.unit.cli.conftest import MODELS, Command


def _tuned(bandwidth: float, *course: float) -> Tuned:
    """With a filter a change of so many per cent of one parameter shows in the course of time."""
    way = Hypothesis("R", "value", "", 1.0, False)
    shown = Shown(way, course[-1], 1.0, "r1", course=course)
    return Tuned(Tuning("", 100.0, bandwidth, 1.0, 60.0, {}, {}), (shown,), 1.0)


def test_a_fifth_more_that_shows_is_not_worth_another_filter() -> None:
    found = [_tuned(1.0, 0.50), _tuned(2.0, 0.42), _tuned(4.0, 0.37)]
    assert [_best(found, usual).tuning.bandwidth for usual in (1.0, 2.0, 4.0)] == [2.0, 2.0, 4.0]
    assert _best(found, 100.0) is found[2]


def test_what_shows_late_counts_less() -> None:
    slow, fast = _tuned(1.0, 10.0, 0.2), _tuned(4.0, 0.4, 0.3)
    assert _score(fast, [slow, fast]) < _score(slow, [slow, fast])
    assert _best([slow, fast], 1.0) is fast


@pytest.mark.parametrize(("worse", "better"), [(0.1, 0.01), (1000.0, 10.0)])
def test_no_filter_gets_credit_for_more_than_what_is_of_use(worse: float, better: float) -> None:
    found = [_tuned(1.0, worse), _tuned(2.0, better)]
    assert _score(found[0], found) == _score(found[1], found)


def test_a_longer_healthy_log_makes_no_watch_slower() -> None:
    assert _usual(1.0, 1200) == _usual(1.0, 7200) == _usual(1.0, 100_000) == pytest.approx(0.2)
    assert _usual(1000.0, 60_000) == 20.0


def test_what_has_to_show_soon_is_watched_with_a_filter_as_fast() -> None:
    assert _usual(1.0, 7200, 150.0) == pytest.approx(40.0 / 150.0)
    assert _usual(1.0, 7200, 10.0) == pytest.approx(0.4)  # samples have to follow
    assert _usual(1.0, 7200, 5000.0) == _usual(1.0, 7200)


def test_one_log_is_told_to_say_nothing_of_other_days(bondgraph: Command, tmp_path: Path) -> None:
    model, scenario = MODELS / "dc_motor.bg", tmp_path / "healthy.toml"
    inputs = 'U = "6*(1 + 0.2*sin(2*pi*t))"\nload = "0.2 mN.m"'
    scenario.write_text(f'duration = "20 s"\n[inputs]\n{inputs}\n')
    folder = tmp_path / "logs"
    folder.mkdir()
    one, two = folder / "one.csv", folder / "two.csv"
    for log in (one, two):
        assert bondgraph("simulate", model, scenario, "-o", log).status == 0
    words = ("--bandwidth", "20", "-o", tmp_path / "tuning.json")
    alone, both, inside = (
        bondgraph("tune", model, *logs, *words) for logs in ([one], [one, two], [folder])
    )
    assert alone.status == both.status == 0, alone.err
    assert "One log does not tell how far others stand apart" in alone.out
    assert "One log" not in both.out
    assert inside.out == both.out


@pytest.mark.parametrize("command", ["fit", "tune"])
def test_a_folder_without_a_log_is_told(bondgraph: Command, command: str, tmp_path: Path) -> None:
    (tmp_path / "notes.txt").touch()
    done = bondgraph(command, MODELS / "dc_motor.bg", tmp_path)
    assert done.status == 1 and f"no log to read in {tmp_path}" in done.err


def test_what_shows_at_times_is_told_so_and_a_thermometer_in_kelvin(
    bondgraph: Command, tmp_path: Path
) -> None:
    """A fan is off for the first half of a log; a wall of one store heats in closed form."""
    model, log = tmp_path / "wall.bg", tmp_path / "log.csv"
    model.write_text(
        """bg 1
    model Wall {
        input P : W; input Ta : K; input fan
        param C = 2000 J/K; param h0 = 4 W/K; param h1 = 6 W/K
        Sf:P -> 0:wall; wall -> C:C; wall -> De:T
        wall -> 1:out; out -> R:loss { f = (h0 + h1*fan)*e }; out -> Se:Ta
    }"""
    )
    draw, count = np.random.default_rng(4), 8000
    fan = np.where(np.arange(count) < count // 2, 0.0, 1.0)
    power = 60.0 + 20.0 * np.sign(np.sin(np.arange(count) / 160.0))
    wall = np.full(count, 305.0)
    for k in range(count - 1):  # input and fan are held from sample to sample
        loss = 4.0 + 6.0 * fan[k]
        end = 290.0 + power[k] / loss
        wall[k + 1] = end + (wall[k] - end) * math.exp(-loss / 2000.0)
    noisy = wall + 0.05 * draw.standard_normal(count)
    columns = {"P": power, "Ta": np.full(count, 290.0), "fan": fan, "T": noisy}
    write_log(Log(np.arange(float(count)), columns, {}, {}), log)
    words = ("tune", model, log, "--bandwidth", "0.05", "-o", tmp_path / "t.json")
    done = bondgraph(*words)
    assert done.status == 0, done.err
    line = r"^Shows in fewer windows, with some motion only: h1 \((\d+) %"
    told = re.search(line, done.out, re.M)
    assert told is not None, done.out
    assert float(told[1]) == pytest.approx(50.0, abs=10.0)
    record = json.loads(bondgraph(*words, "--json").out)
    faults = {(f["fault"], f["kind"]): f for f in record["faults"]}
    assert faults["h1", "value"]["change"] is None
    assert faults["h0", "value"]["share"] == 1.0
    gain, offset = faults["T", "gain"], faults["T", "offset"]
    assert gain["unit"] == offset["unit"] == "K"
    assert gain["change"] == pytest.approx(offset["change"], rel=0.1)  # it is all of 300 K


_SWAYED = """
duration = "30 s"
[inputs]
U = "4*sin(7*t) + 3*sin(2.1*t)"
load = "2e-4*sin(1.3*t)"
[sampling]
rate = "1 kHz"
[sensors.current]
noise = "5 mA"
[sensors.speed]
noise = "0.2 rad/s"
"""


def test_what_is_told_to_show_in_many_rows_does(bondgraph: Command, tmp_path: Path) -> None:
    """A fifth more, from 15 s on, of a motor that turns to and fro: a mean tells next to nothing.

    The window is 2 s, and what shows in nine of ten may take one more.
    """
    model, script, log, tuning = MODELS / "dc_motor.bg", *(
        tmp_path / name for name in ("s.toml", "log.csv", "t.json")
    )  # fmt: skip
    script.write_text(_SWAYED)
    assert bondgraph("simulate", model, script, "-o", log).status == 0
    told = json.loads(bondgraph("tune", model, log, "-o", tuning, "--json").out)["faults"]
    for name, kind in (("R", "value"), ("f", "value"), ("U", "gain"), ("speed", "gain")):
        (one,) = [f for f in told if (f["fault"], f["kind"]) == (name, kind)]
        assert one["many_rows"] < one["change"] / 3.0, name
        by = 1.2 * one["many_rows"]
        change = f"+= {by!r}" if kind == "value" else f"*= {1.0 + by!r}"
        fault = f'[[fault]]\nof = "{name}"\nchange = "{change}"\nat = "15 s"\n'
        script.write_text(_SWAYED + fault)
        assert bondgraph("simulate", model, script, "--seed", "11", "-o", log).status == 0
        out = bondgraph("monitor", model, log, "--tuning", tuning).out
        alarms = re.findall(r"^ *([\d.]+) s  fault ", out, re.MULTILINE)
        assert alarms and 15.0 < float(alarms[0]) < 19.0, name
