"""`bondgraph.monitor`: files, frames and dicts in, verdicts and columns out; where it runs."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow
import pyarrow.csv
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.fleet.watcher import Item, LogFile
from bondgraph.runtime.fleet.workers import watched
from bondgraph.runtime.log import Log
from bondgraph.runtime.monitoring.columns import Mapped
from bondgraph.runtime.monitoring.watch_settings import WatchSettings
from bondgraph.text.diagnostic import CompileError, Trouble
from tests.unit.runtime.fleet.deadly import DeadlyLog
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR


@pytest.fixture(scope="module")
def model() -> Compilation:
    return bondgraph.compile(MOTOR)


def columns(log: Log) -> dict[str, Any]:
    return {"t": log.time, **log.columns}


def kinds(found: bondgraph.Fleet) -> list[list[str]]:
    return [[v.event for v in said] for said in found.verdicts]


WATCHED = ["start", "warm-up", "warm-up", "stop"]
FOUND = ["start", "warm-up", "warm-up", "fault", "update", "stop"]


def test_paths_frames_and_logs_together(model: Compilation, motors: Path) -> None:
    paths = [motors / "a_healthy.csv", motors / "more"]
    found = bondgraph.monitor(model, [*paths, columns(motor.log()), motor.log()])
    assert kinds(found) == [WATCHED, WATCHED, FOUND, FOUND, FOUND]
    table = found.table()
    assert table["state"] == ["healthy", "healthy", "fault", "fault", "fault"]
    assert table["log"][3:] == ["log 4", "log 5"]
    assert table["class"][2:] == ["J or f or load"] * 3
    assert table["since"][2:] == pytest.approx([motor.ONSET] * 3, abs=0.1)
    assert table["end"] == pytest.approx([2.999, 2.998, 4.499, 5.999, 5.999])
    assert {len(column) for column in found.rows().values()} == {2 * 4 + 3 * 6}
    assert repr(found) == "Fleet(2 healthy, 3 fault)"
    assert found[0].state == "healthy" and len(found) == 5 and len(list(found)) == 5


def test_names_are_those_that_are_given(model: Compilation, motors: Path) -> None:
    logs = {"mill 3": motors / "a_healthy.csv", "mill 4": columns(motor.log(5.0, 1.0))}
    assert bondgraph.monitor(model, logs).table()["log"] == ["mill 3", "mill 4"]


def test_states_of_tables_and_of_files(
    model: Compilation, motors: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(motors)
    logs = {"mill 3": "a_healthy.csv", "mill 4": columns(motor.log())}
    found = bondgraph.monitor(model, logs, states=tmp_path / "states")
    tables = [pyarrow.csv.read_csv(tmp_path / "states" / f"{n}.csv").to_pydict() for n in logs]
    active = [[t for t, a in zip(x["time"], x["active"], strict=True) if a] for x in tables]
    (alarm,) = [v.time for v in found.verdicts[1] if v.event == "fault"]
    assert active[0] == [] and active[1][0] == pytest.approx(alarm, abs=2e-3)
    with pytest.raises(ValueError, match="is where logs are"):
        bondgraph.monitor(model, "a_healthy.csv", states=motors)


def test_dates_and_words_in_columns(model: Compilation) -> None:
    log = motor.log()
    steps = np.rint(log.time * 1000).astype("timedelta64[ms]")
    dates = np.datetime64("2026-03-01T12:00:00", "ms") + steps
    words = np.array(["x"] * log.rows)
    table = {"time": dates, "comment": words, **log.columns}
    told: list[str] = []
    found = bondgraph.monitor(model, table, tell=told.append)
    assert kinds(found) == [FOUND]
    start = np.datetime64("2026-03-01T12:00:00").astype(float)
    assert found[0].start == start
    assert found.table()["since"] == pytest.approx([start + motor.ONSET], abs=0.1)
    assert told == ["log 1: time is the column `time`, as ISO 8601"]
    texts = {"time": np.datetime_as_string(dates).tolist(), **log.columns}
    assert bondgraph.monitor(model, texts).verdicts == found.verdicts


def test_columns_under_other_names_and_without_time(model: Compilation) -> None:
    log = motor.log(5.0, 1.0)
    table = {"rpm" if name == "speed" else name: x for name, x in log.columns.items()}
    found = bondgraph.monitor(model, table, columns={"speed": Mapped("rpm")}, rate=1000.0)
    assert kinds(found) == [WATCHED]


def test_a_table_of_arrow_is_a_frame(model: Compilation) -> None:
    found = bondgraph.monitor(model, pyarrow.table(columns(motor.log())))
    assert kinds(found) == [FOUND]


def test_pandas_and_polars(model: Compilation, motors: Path) -> None:
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    log = motor.log()
    indexed = pandas.DataFrame(log.columns, index=pandas.to_timedelta(log.time, unit="s"))
    zoned = pandas.to_datetime(log.time + 1.7e9, unit="s", utc=True)
    frames = [
        pandas.DataFrame(columns(log)),
        polars.DataFrame(columns(log)),
        indexed,
        pandas.DataFrame(log.columns, index=zoned),
        pandas.DataFrame({"time": zoned, **log.columns}),
    ]
    found = bondgraph.monitor(model, frames)
    assert kinds(found) == [FOUND] * 5
    assert found[3].start == pytest.approx(1.7e9)
    for kind in (pandas, polars):
        assert kind.DataFrame(found.table()).shape[0] == 5
        assert kind.DataFrame(found.rows()).shape[0] == 30


def test_what_cannot_be_watched(model: Compilation, motors: Path) -> None:
    lame = {"t": [0, 1, 2], "U": [1, 2]}
    found = bondgraph.monitor(model, [lame, motors / "a_healthy.csv", motors / "none.csv"])
    assert found.table()["state"] == ["bad", "healthy", "bad"]
    assert found[0].error == "the columns have different lengths: t 3, U 2"
    assert "No such file" in found[2].error
    with pytest.raises(Trouble, match="no log can be watched; log 1: the columns have different"):
        bondgraph.monitor(model, lame)
    with pytest.raises(ValueError, match="no log to watch"):
        bondgraph.monitor(model, [])
    with pytest.raises(CompileError):
        bondgraph.monitor(bondgraph.compile(text="bg 1\nmodel M { 1:j { <- X:U } }"), lame)


def test_a_compilation_is_the_same_in_another_process(model: Compilation) -> None:
    with_parameter = model.with_options(parameters={"R": 18.0}, rate=200.0, isolate=True)
    copy = pickle.loads(pickle.dumps(with_parameter))
    assert copy.options == with_parameter.options
    assert copy.program.digest == with_parameter.program.digest
    assert Path(copy.source.path).is_absolute()


def test_one_process_and_two_find_the_same(model: Compilation, motors: Path) -> None:
    logs = [motors, columns(motor.log()), motors / "none.csv"]
    shares: list[float] = []
    one = bondgraph.monitor(model, logs, progress=shares.append)
    two = bondgraph.monitor(model, logs, jobs=2)
    assert list(one) == list(two)
    assert shares == pytest.approx([k / 6 for k in range(1, 7)])


def test_a_process_that_dies_is_one_bad_log(model: Compilation, motors: Path) -> None:
    path = motors / "a_healthy.csv"
    healthy = [LogFile(f"m{k}", str(path)) for k in range(4)]
    items: list[Item] = [*healthy[:2], DeadlyLog("x"), healthy[2], DeadlyLog("y"), healthy[3]]
    found = dict(watched(WatchSettings(model), items, 2))
    assert sorted(found) == list(range(6))
    assert [found[k].state for k in range(6)] == ["healthy", "healthy", "bad", "healthy", "bad",
                                                  "healthy"]  # fmt: skip
    assert "died" in found[2].error
