"""`bondgraph monitor` on many logs: what a single watch says of each, whatever befalls others."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow.parquet
import pytest

from bondgraph.cli.fleet import lines
from bondgraph.cli.monitor import Alarms
from bondgraph.runtime.fleet.watched_log import WatchedLog
from bondgraph.runtime.monitoring.verdict import Pair, Verdict
from tests.unit.runtime.fleet.conftest import Monitored
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, ROOT

Alone = Callable[..., list[dict[str, Any]]]
NAMES = ["a_healthy.csv", "b_friction.csv", "more/c_healthy.parquet", "more/d_friction.parquet"]
FAULTY = {"logs/b_friction.csv", "logs/more/d_friction.parquet"}
BAD = {"columns.csv", "cut.parquet", "empty.csv", "gone.csv", "header.csv", "noise.parquet"}


def by_log(said: list[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Lines of JSON, those of each log without its name."""
    found: dict[str, list[dict[str, Any]]] = {}
    for line in said:
        found.setdefault(line.pop("log"), []).append(line)
    return found


def rows(path: Path | str) -> list[dict[str, str]]:
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("words", [[], ["--isolate"], ["--while", "U > 4.5"], ["--set", "R=18"]])
def test_each_log_has_the_verdicts_of_a_watch_of_its_own(
    words: list[str], logs: Path, monitored: Monitored, alone: Alone
) -> None:
    done = monitored("logs", "--json", *words)
    found = by_log(done.lines)
    assert done.status == 0
    assert list(found) == [f"logs/{name}" for name in NAMES]
    for name, said in found.items():
        assert said == alone(Path(name), *words)


def test_rate_map_and_tuning_are_those_of_a_single_watch(
    logs: Path, tmp_path: Path, monitored: Monitored, alone: Alone
) -> None:
    from bondgraph.cli.main import main

    Path("map.toml").write_text('speed = { column = "speed", scale = 1.0 }\n')
    assert main(["tune", MOTOR, "logs/a_healthy.csv", "-o", "tuning.json"]) == 0
    words = ["--map", "map.toml", "--tuning", "tuning.json", "--rate", "1000"]
    full = [f"logs/{name}" for name in NAMES[:2]]
    monitored(*full)
    found = by_log(monitored(*full, "--json", *words).lines)
    assert [found[name] for name in full] == [alone(Path(name), *words) for name in full]


def test_the_table_says_what_came_of_each(
    logs: Path, monitored: Monitored, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    out = monitored("logs").out.splitlines()
    assert out[0] == "Motor: 4 logs, 2 with an alarm, 2 healthy"
    assert out[2].split() == "log from to s lasts s verdict class since s worst".split()
    cells = [line.split() for line in out[3:]]
    assert [c[0] for c in cells] == NAMES
    spans = ["0.0 3.0 3.0", "0.0 4.5 4.5", "0.0 3.0 3.0", "0.0 4.5 4.5"]
    assert [" ".join(c[1:4]) for c in cells] == spans
    assert [c[4] for c in cells] == ["healthy", "1", "healthy", "1"]
    for k in (1, 3):
        assert cells[k][5:10] == "alarm J, f or load".split()
        assert float(cells[k][10]) == pytest.approx(motor.ONSET, abs=0.1)
        assert cells[k][11] == "r2" and float(cells[k][12].rstrip("x")) > 2.0
    assert all(float(cells[k][6].rstrip("x")) < 1.0 for k in (0, 2))


@pytest.mark.parametrize("columns", [100, 80, 66])
def test_a_narrow_table_is_cut_and_notes_go_below(columns: int) -> None:
    pair = Verdict("update", 4.0, 3.0, pairs=(Pair(("R1", "R3"), (1.0, 2.0), ("", ""), 0.9),))
    group = tuple(f"machine.part[{k}].el.R" for k in range(3))
    long = "a_long_folder_name/and_a_long_name_of_a_log_in_it_{}.parquet"
    logs = [
        WatchedLog(long.format(1), (Verdict("fault", 3.5, 3.0), pair), 0.0, 9.0, "r1", 12.5),
        WatchedLog(long.format(2), (Verdict("fault", 3.5, 3.0, {}, group), Verdict("cleared", 5.0)),
                   0.0, 9.0, "r2", 1.5, ("2 gaps", "r1 not watched")),
        WatchedLog("b.csv", error="words " * 30),
        WatchedLog("c.csv", start=0.0, end=1.0),
    ]  # fmt: skip
    table = lines("M", logs, columns)
    assert max(map(len, table)) <= columns
    text = "\n".join(table)
    assert "R1 with R" in text and "1 alarm" in text and "not watched" in text
    assert ("from" in text) == (columns > 66)
    assert "\n      cleared, 2 gaps, r1 not watched" in text
    assert text.count("words") == 30
    assert table[0] == "M: 4 logs, 2 with an alarm, 1 not watched, 1 bad"


@pytest.mark.parametrize("jobs", [1, 2])
def test_bad_logs_are_told_and_end_nothing(
    jobs: int, bad_logs: Path, monitored: Monitored, alone: Alone
) -> None:
    done = monitored("logs", "--jobs", jobs, "--json")
    found = by_log(done.lines)
    assert done.status == 0
    bad = {Path(name).name for name, said in found.items() if "error" in said[-1]}
    assert bad == BAD
    for name in BAD:
        assert f"error: logs/{name}: " in done.err
    assert "Traceback" not in done.err
    assert "no column for load" in found["logs/columns.csv"][-1]["error"]
    for name in [*NAMES, "damaged.csv"]:
        assert found[f"logs/{name}"] == alone(bad_logs / name)
    text = monitored("logs", "--jobs", jobs).out
    assert "6 bad" in text and "2 lines left out" in text and "1 gap" in text


def test_nothing_but_bad_logs_is_a_failure(bad_logs: Path, monitored: Monitored) -> None:
    done = monitored("logs/empty.csv", "logs/gone.csv", "nothing*.csv")
    assert done.status == 1
    assert "3 bad" in done.out and "nothing*.csv: cannot be read" in done.err
    Path("nothing").mkdir()
    done = monitored("nothing")
    assert done.status == 1 and "no log to watch in nothing" in done.err


def test_a_fault_that_was_latched_before_a_restart_is_an_alarm() -> None:
    for verdict, alarm in (
        (Verdict("resumed", 5.0, 3.0), True),
        (Verdict("resumed", 5.0), False),
        (Verdict("warm-up", 5.0), False),
        (Verdict("fault", 5.0, 3.0), True),
    ):
        alarms = Alarms()
        alarms(1, verdict)
        assert alarms.any == alarm


def test_fail_on_fault(logs: Path, monitored: Monitored) -> None:
    assert monitored("logs", "--fail-on-fault").status == 3
    healthy = [logs / NAMES[0], logs / NAMES[2]]
    assert monitored(*healthy, "--fail-on-fault").status == 0
    assert monitored(logs / NAMES[1], "--fail-on-fault").status == 3
    assert monitored(logs / NAMES[0], "--fail-on-fault").status == 0
    assert monitored(logs / NAMES[1]).status == 0


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_the_output_has_a_row_for_each_verdict(
    suffix: str, logs: Path, bad_logs: Path, monitored: Monitored, alone: Alone
) -> None:
    path = f"verdicts.{suffix}"
    assert monitored("logs", "--output", path).status == 0
    assert not Path(f"{path}.part").exists()
    table = rows(path) if suffix == "csv" else pyarrow.parquet.read_table(path).to_pylist()
    for name in NAMES:
        own = [r for r in table if r["log"] == f"logs/{name}"]
        said = alone(logs / name)
        assert [r["event"] for r in own] == [v["event"] for v in said]
        for row, verdict in zip(own, said, strict=True):
            assert float(row["time"]) == verdict["time"]
            since = row["since"] or None
            assert (since if since is None else float(since)) == verdict["since"]
            assert row["class"] == " or ".join(verdict["group"])
            assert json.loads(row["candidates"]) == verdict["candidates"]
            assert json.loads(row["residuals"]) == verdict["residuals"]
            assert row["message"] == verdict["message"]
    last = {r["log"]: r["event"] for r in table}
    assert {name.removeprefix("logs/") for name, e in last.items() if e == "error"} == BAD
    assert {r["log"] for r in table if r["event"] == "fault"} == FAULTY


def test_one_job_and_two_write_the_same(logs: Path, monitored: Monitored) -> None:
    one = monitored("logs", "--output", "one.parquet", "--jobs", 1).out
    two = monitored("logs", "--output", "two.parquet", "--jobs", 2).out
    assert Path("one.parquet").read_bytes() == Path("two.parquet").read_bytes()
    assert one.replace("one.parquet", "two.parquet") == two


def test_what_is_done_is_not_done_again(logs: Path, monitored: Monitored) -> None:
    first = monitored("logs", "-o", "v.csv")
    before = Path("v.csv").read_text()
    again = monitored("logs", "-o", "v.csv")
    assert "4 of 4 logs were watched before" in again.err and again.out == first.out
    assert Path("v.csv").read_text() == before
    os.utime(logs / NAMES[0], (1, 1))  # changed, as far as anybody knows
    shutil.copy(logs / NAMES[1], logs / "e.csv")
    assert "3 of 5 logs were" in monitored("logs", "-o", "v.csv").err
    assert {r["log"] for r in rows("v.csv")} == {f"logs/{name}" for name in [*NAMES, "e.csv"]}
    words = [logs / NAMES[0], "-o", "w.csv"]  # anew with each other setting
    for other in ([], ["--set", "R=18"], ["--while", "U > 4"], ["--bandwidth", "15"]):
        assert "watched before" not in monitored(*words, *other).err
    assert "1 of 1 log was" in monitored(*words, "--bandwidth", "15").err


def test_each_log_has_the_states_of_a_watch_of_its_own(
    bad_logs: Path, monitored: Monitored
) -> None:
    done = monitored("logs", "--states", "logs/states", "-o", "v.csv")
    assert done.out.endswith("Written to v.csv and logs/states\n")
    written = {str(p.relative_to("logs/states")) for p in Path("logs/states").rglob("*.*")}
    whole = {f"logs/{name}" for name in [*NAMES, "damaged.csv"]}
    assert whole <= written and not written & {"logs/empty.csv", "logs/gone.csv"}
    for name in NAMES[1:3]:
        alone = f"alone{Path(name).suffix}"
        assert monitored(bad_logs / name, "--states", alone).status == 0
        assert Path("logs/states/logs", name).read_bytes() == Path(alone).read_bytes()
    Path("logs/states/logs", NAMES[0]).unlink()
    again = monitored("logs", "--states", "logs/states", "-o", "v.csv")
    assert "4 of 11 logs were watched before" in again.err  # bad ones have none
    assert Path("logs/states/logs", NAMES[0]).exists()


@pytest.mark.parametrize(
    ("folder", "names"),
    [("logs", ["logs"]), (".", ["logs/*.csv"]), ("logs/more", ["logs/more/c_healthy.parquet"])],
)
def test_states_are_not_written_among_logs(
    folder: str, names: list[str], logs: Path, monitored: Monitored
) -> None:
    before = {p: p.read_bytes() for p in logs.rglob("*.*")}
    done = monitored(*names, "--jobs", 1, "--states", folder)
    assert done.status == 1 and done.out == ""
    assert f"{folder} is where logs are ({names[0]}): name another folder" in done.err
    assert {p: p.read_bytes() for p in logs.rglob("*.*")} == before


def test_states_that_cannot_be_written_are_told_and_end_nothing(
    logs: Path, monitored: Monitored
) -> None:
    Path("states/logs/more").mkdir(parents=True)
    Path("states/logs/a_healthy.csv").mkdir()
    done = monitored("logs", "--states", "states")
    assert done.status == 0 and "4 logs" in done.out and "1 bad" in done.out
    path = Path("states/logs/a_healthy.csv").resolve()
    assert f"error: logs/a_healthy.csv: its states cannot be written to {path}: " in done.err
    assert Path("states/logs/b_friction.csv").stat().st_size > 10_000
    Path("plain").touch()
    done = monitored("logs", "--states", "plain/states")
    assert done.status == 1 and done.out == "" and done.err.count("\n") == 1
    assert "--states plain/states cannot be made: " in done.err


def test_an_output_in_the_folder_of_the_logs_is_no_log(logs: Path, monitored: Monitored) -> None:
    for _ in range(2):
        assert "4 logs" in monitored("logs", "-o", "logs/v.parquet").out


def test_a_file_that_is_no_table_of_verdicts_is_not_replaced(
    logs: Path, monitored: Monitored
) -> None:
    for name, text in (("mine.csv", "a,b\n1,2\n"), ("mine.parquet", "nothing")):
        Path(name).write_text(text)
        done = monitored("logs", "-o", name)
        assert done.status == 1 and "no table of verdicts" in done.err
        assert Path(name).read_text() == text
    done = monitored("logs", "-o", "v.json")
    assert done.status == 1 and "written as .csv or .parquet" in done.err
    assert not list(Path().glob("*.part"))


@pytest.mark.parametrize("jobs", ["1", "2"])
def test_killed_in_the_middle_and_started_again_it_writes_the_same(
    jobs: str, motors: Path, tmp_path: Path
) -> None:
    (tmp_path / "many").mkdir()
    for k in range(4):
        shutil.copy(motors / NAMES[k % 2], tmp_path / "many" / f"{k:02}.csv")

    def command(output: str) -> list[str]:
        words = ["monitor", MOTOR, "many", "--jobs", jobs, "-o", output]
        return [sys.executable, "-m", "bondgraph", *words]

    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    how: dict[str, Any] = {"cwd": tmp_path, "env": environment, "text": True}
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run(command("whole.csv"), check=True, **quiet, **how)
    kept = tmp_path / "killed.csv.part"
    with subprocess.Popen(command("killed.csv"), **quiet, **how) as process:
        while len(list(kept.glob("*.json"))) < 2:
            assert process.poll() is None
            time.sleep(0.001)
        process.send_signal(signal.SIGKILL)
    done = len(list(kept.glob("*.json")))
    assert 2 <= done < 4 and not (tmp_path / "killed.csv").exists()
    again = subprocess.run(command("killed.csv"), check=True, capture_output=True, **how)
    assert f"note: {done} of 4 logs were watched before" in again.stderr
    assert (tmp_path / "killed.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()
    assert not kept.exists()


def test_interrupted_it_says_what_is_kept(
    logs: Path, monitored: Monitored, monkeypatch: pytest.MonkeyPatch
) -> None:
    from bondgraph.runtime.fleet.kept_results import KeptResults

    keep = KeptResults.keep

    def stopped(self: KeptResults, found: WatchedLog) -> None:
        keep(self, found)
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(KeptResults, "keep", stopped)
        done = monitored("logs", "-o", "v.csv")
    assert done.status == 130 and "kept in v.csv.part" in done.err
    assert not Path("v.csv").exists() and len(list(Path("v.csv.part").iterdir())) == 1
    assert "1 of 4 logs was watched before" in monitored("logs", "-o", "v.csv").err


def test_a_damaged_record_of_what_is_done_counts_as_none(logs: Path, monitored: Monitored) -> None:
    Path("v.csv.part").mkdir()
    Path("v.csv.part/0000.json").write_text('{"log": "a')
    Path("v.csv.part/of_somebody.txt").write_text("keep me")
    done = monitored("logs", "-o", "v.csv")
    assert done.status == 0 and "watched before" not in done.err
    assert [p.name for p in Path("v.csv.part").iterdir()] == ["of_somebody.txt"]


@pytest.mark.parametrize(
    "words",
    [["--follow"], ["--serial", "/dev/x"], ["--mqtt", "h/t"], ["--journal", "j"],
     ["--publish", "h/t"], ["--states", "s.csv"],
     ["--states", "logs/a_healthy.csv"], ["-"], ["--jobs", "2", "--scheduler", "tcp://x"]],
)  # fmt: skip
def test_what_is_for_one_machine_is_refused(
    words: list[str], logs: Path, monitored: Monitored
) -> None:
    done = monitored("logs", *words)
    assert done.status == 2 and done.out == ""
    assert done.err.startswith("error: ") and done.err.count("\n") == 1


def test_what_is_wrong_with_the_model_is_told_before_any_log(
    logs: Path, monitored: Monitored
) -> None:
    done = monitored("logs", "--while", "U >", "-o", "v.csv")
    assert done.status == 1 and "--while" in done.err
    Path("map.toml").write_text('nothing = "a"\n')
    done = monitored("logs", "--map", "map.toml", "-o", "v.csv")
    assert done.status == 1 and "the residuals read no signal `nothing`" in done.err
    assert not list(Path().glob("v.csv*"))


def test_what_a_folder_has_besides_is_told(logs: Path, monitored: Monitored) -> None:
    (logs / "notes.txt").write_text("x")
    (logs / "_SUCCESS").write_text("")
    (logs / ".hidden.csv").write_text("")
    done = monitored("logs", "logs/a_healthy.csv", "logs/more/*.parquet")
    assert "note: logs: 1 file is left out, no log by the name" in done.err
    assert "Motor: 4 logs" in done.out  # each once


def test_times_of_other_programs_are_noted_once(logs: Path, monitored: Monitored) -> None:
    for name in ("x.csv", "y.csv"):
        whole = (logs / NAMES[0]).read_text().splitlines(keepends=True)
        plain = [line for line in whole if not line.startswith("#")]
        (logs / name).write_text("".join(plain))
    err = monitored("logs/x.csv", "logs/y.csv").err
    assert err.count("note:") == 1
    assert "logs/x.csv and logs/y.csv: time is the column `t`" in err
