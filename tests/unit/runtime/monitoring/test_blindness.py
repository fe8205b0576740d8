"""A log in which something becomes blind: it is told at once, with why, and the account adds up."""

from __future__ import annotations

import csv as csv_files
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.log import Log
from bondgraph.runtime.monitoring.residual_states import STATES
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, csv, objects

_AT, _END = 3000, 6000  # samples: what happens begins once noise is known; the log ends
_BACK = 4500  # where all is as before, if it ever is
_OWN = ("--bandwidth", "20")

Rows = list[str]


def _rows(log: Log) -> Rows:
    return csv(log, header=True).decode().splitlines(keepends=True)


@pytest.fixture(scope="module")
def rows() -> Rows:
    return _rows(motor.log(6.0, 1.0))


def watched(
    capsys: pytest.CaptureFixture[str], path: Path, *words: str
) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """What is said of a log, and the account at its end, of which all adds up."""
    assert main(["monitor", MOTOR, str(path), "--json", *_OWN, *words]) == 0
    said = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    account = said[-1]["account"]
    samples, lines = account["samples"], account["lines"]
    assert samples["read"] == sum(samples.values()) - samples["read"]
    assert sum(account["verdicts"].values()) == len(said) == said[-1]["number"]
    grids = {name: sum(found.values()) for name, found in account["residuals"].items()}
    assert len(set(grids.values())) == 1
    assert all(n >= 0 for n in (*samples.values(), *lines.values()))
    return said, account


def _cells(rows: Rows, cell: str, start: int, stop: int, columns: tuple[int, ...] = (4,)) -> Rows:
    found = list(rows)
    for k in range(start + 1, stop + 1):
        cells = found[k].rstrip("\n").split(",")
        for at in columns:
            cells[at] = cell
        found[k] = ",".join(cells) + "\n"
    return found


@pytest.mark.parametrize("cell", ["nan", "", "inf", "-inf", "null", "1e999"])
@pytest.mark.parametrize("stop", [_BACK, _END])
def test_a_signal_without_numbers_is_named_with_what_is_blind(
    cell: str, stop: int, rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("".join(_cells(rows, cell, _AT, stop)))
    said, account = watched(capsys, path)
    (told,) = [v for v in said if v["event"] == "invalid"]
    assert told["message"].startswith("speed has no number") and told["time"] == 3.0
    assert "r1 and r2 are blind" in told["message"]
    assert [f["blind"] >= stop - _AT for f in account["residuals"].values()] == [True, True]
    again = [v for v in said if v["event"] == "warm-up" and "value again" in v["message"]]
    if stop == _END:
        assert again == []
        assert {s["state"] for s in account["states"].values()} == {"blind"}
        assert all("speed has no number" in s["why"] for s in account["states"].values())
    else:
        (back,) = again
        assert 4.5 < back["time"] < 5.0
        assert f"from 3.000 s to {back['time']:.3f} s may have been missed" in back["message"]
        assert {s["state"] for s in account["states"].values()} == {"healthy"}


def test_what_is_absent_in_json_and_behind_a_new_header_is_the_same(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    short = [row.rsplit(",", 1)[0] + "\n" for row in rows]
    path.write_text("".join([*rows[: _AT + 1], short[0], *short[_AT + 1 :]]))
    lines = [json.dumps(o) for o in objects(motor.log(6.0, 1.0), 0, _END)]
    for k in range(_AT, _END):
        lines[k] = json.dumps({n: x for n, x in json.loads(lines[k]).items() if n != "speed"})
    (tmp_path / "log.jsonl").write_text("\n".join(lines) + "\n")
    for name in ("log.csv", "log.jsonl"):
        said, account = watched(capsys, tmp_path / name)
        (told,) = [v for v in said if v["event"] == "invalid"]
        assert told["message"].startswith("speed has no number") and told["time"] == 3.0
        assert account["residuals"]["r2"]["blind"] >= _END - _AT


def test_only_residuals_that_read_the_signal_are_blind(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("".join(_cells(rows, "", _AT, _END, (1,))))  # U: r1 reads it
    said, account = watched(capsys, path)
    (told,) = [v for v in said if v["event"] == "invalid"]
    assert told["message"].endswith("since 3.000 s: r1 is blind")
    assert account["states"]["r2"] == {"state": "healthy", "why": ""}
    assert account["residuals"]["r2"]["blind"] < account["residuals"]["r1"]["blind"] - 2999


def test_a_clock_that_stands_still_is_told_and_begins_anew(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    stamp = rows[_AT].split(",")[0]
    for stop in (_BACK, _END):
        still = [f"{stamp},{row.split(',', 1)[1]}" for row in rows[_AT + 1 : stop + 1]]
        path.write_text("".join([*rows[: _AT + 1], *still, *rows[stop + 1 :]]))
        said, account = watched(capsys, path)
        count = stop - _AT
        (late,) = [v for v in said if v["event"] == "late"]
        assert f"{count} samples are thrown away, from 2.999 s on" in late["message"]
        assert account["samples"]["twice"] == count
        gaps = [v["message"] for v in said if v["event"] == "gap"]
        if stop == _END:
            assert "the clock stands still at 2.999 s" in late["message"] and gaps == []
            assert {s["state"] for s in account["states"].values()} == {"blind"}
        else:
            assert gaps[0].startswith("the clock stood still at 2.999 s for 1500 samples")
            assert "from 2.999 s to about 4.962 s may be missed" in gaps[0]


def test_a_clock_that_goes_on_where_it_stood_begins_anew_too(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The device has missed ticks: its time goes on, the machine has gone on further."""
    path = tmp_path / "log.csv"
    times = [float(row.split(",")[0]) for row in rows[1:]]
    later = [min(t, 2.999) if t < 4.5 else t - 1.5 for t in times]
    moved = [f"{t!r},{row.split(',', 1)[1]}" for t, row in zip(later, rows[1:], strict=True)]
    path.write_text("".join([rows[0], *moved]))
    said, account = watched(capsys, path)
    (gap,) = [v for v in said if v["event"] == "gap"]
    assert gap["message"].startswith("the clock stood still at 2.999 s for 1500 samples")
    assert account["lines"]["gaps"] == 1 and account["samples"]["twice"] == 1500
    assert not [v for v in said if v["event"] == "fault"]


def test_samples_that_come_twice_are_no_clock_that_stands_still(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("".join([*rows[:_AT], *[rows[_AT]] * 500, *rows[_AT + 1 :]]))
    said, account = watched(capsys, path)
    assert account["samples"]["twice"] == 499 and account["lines"]["gaps"] == 0
    assert [v["event"] for v in said if v["event"] in ("late", "gap")] == ["late"]


def test_samples_without_any_number_are_thrown_away_and_told(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("".join(_cells(rows, "", _AT, _BACK, (1, 2, 3, 4))))
    said, account = watched(capsys, path)
    (late,) = [v for v in said if v["event"] == "late"]
    assert "1500 samples are thrown away, from 3 s on: 1500 without any number" in late["message"]
    (gap,) = [v for v in said if v["event"] == "gap"]
    assert "1500 samples lost from 2.999 s to 4.5 s" in gap["message"]
    assert account["samples"]["empty"] == account["lines"]["lost"] == 1500


def test_what_flaps_is_no_flood(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = rows
    for start in range(1000, _END, 700):  # blind for 0.1 s, watched for a little after each
        found = _cells(found, "", start, start + 100)
    path = tmp_path / "log.csv"
    path.write_text("".join(found))
    said, _ = watched(capsys, path)
    blind = [v for v in said if v["event"] == "invalid"]
    assert 2 <= len(blind) <= 4
    assert len(said) < 20


def test_a_slow_signal_at_the_start_is_no_news(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    for count, told in ((300, False), (2000, True)):
        path.write_text("".join(_cells(rows, "", 0, count)))
        said, _ = watched(capsys, path)
        assert any(v["event"] == "invalid" for v in said) is told


Break = Callable[[Rows], Rows]


@pytest.mark.parametrize(
    "what",
    [
        lambda rows: _cells(rows, "nan", _AT, _BACK),
        lambda rows: [*rows[:_AT], *rows[_BACK:]],
        lambda rows: [*rows[:_AT], *rows[_AT - 10 : _AT], "garbage\n", *rows[_AT:]],
    ],
)
def test_the_table_of_states_has_what_the_account_counts(
    what: Break, rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, table = tmp_path / "log.csv", tmp_path / "states.csv"
    path.write_text("".join(what(rows)))
    _, account = watched(capsys, path, "--states", str(table))
    with table.open(encoding="utf-8") as file:
        found = list(csv_files.DictReader(file))
    for name, counts in account["residuals"].items():
        states = [row[f"{name}_state"] for row in found]
        assert counts == {state: states.count(state) for state in STATES}
    times = np.array([float(row["time"]) for row in found])
    span = round((times[-1] - times[0]) / account["step"]) + 1
    assert len(found) + account["lines"]["lost"] == span


def test_the_account_goes_on_over_restarts(
    rows: Rows, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, journal = tmp_path / "log.csv", tmp_path / "journal"
    whole = [*_cells(rows, "", _AT, _BACK)[: _AT + 800], "garbage\n", *rows[_AT + 800 :]]
    path.write_text("".join(whole))
    _, straight = watched(capsys, path)
    for count in (1500, _AT + 400, len(whole)):
        path.write_text("".join(whole[:count]))
        words = ["--json", *_OWN, "--journal", str(journal)]
        assert main(["monitor", MOTOR, str(path), *words]) == 0
    said = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    account = said[-1]["account"]
    assert account["samples"] == straight["samples"] and account["lines"] == straight["lines"]
    assert sum(account["verdicts"].values()) == len(said) == said[-1]["number"]
    of = {name: sum(f.values()) for name, f in account["residuals"].items()}
    assert of == {name: sum(f.values()) for name, f in straight["residuals"].items()}
