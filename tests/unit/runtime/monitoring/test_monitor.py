"""`bondgraph monitor` on files and pipes: what it says, and what a kill does to it."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.log import Log
from bondgraph.runtime.log_file import write_log
from bondgraph.runtime.monitoring.verdict import Verdict, from_json
from bondgraph.text.checked_line import checked_line
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, ROOT, Watch, csv, objects, until

pytestmark = pytest.mark.usefixtures("kept_models")

Start = Callable[..., Watch]
WARM = ("warm-up", "warm-up")  # filters have settled, noise has been learned


def monitored(capsys: pytest.CaptureFixture[str], *words: str) -> list[dict[str, object]]:
    """What the monitor says in this process."""
    own = () if "--bandwidth" in words else ("--bandwidth", "20")  # as of a stream of an hour
    assert main(["monitor", MOTOR, "--json", *own, *words]) == 0
    lines = capsys.readouterr().out.splitlines()
    return [from_json(line)[1]._asdict() for line in lines]


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("logs")
    for suffix in ("csv", "parquet"):
        write_log(motor.log(), folder / f"motor.{suffix}")
    return folder


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_friction_fault_is_found_and_told_from_electrical_ones(
    suffix: str, logs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    said = monitored(capsys, str(logs / f"motor.{suffix}"))
    assert [v["event"] for v in said] == ["start", *WARM, "fault", "update", "stop"]
    assert said[0]["time"] == 0.0
    fault, update = said[3:5]
    assert motor.ONSET < fault["time"] < motor.ONSET + 0.1  # type: ignore[operator]
    assert not fault["group"] and not fault["candidates"]
    assert fault["time"] < update["time"] < motor.ONSET + 1.5  # type: ignore[operator]
    for verdict in (fault, update):
        assert verdict["since"] == pytest.approx(motor.ONSET, abs=0.1)
        assert list(verdict["residuals"]) == ["r2"]  # type: ignore[call-overload]
    assert "f" in update["group"] and not {"R", "L", "U"} & set(update["group"])  # type: ignore[arg-type,operator]
    first = update["candidates"][0]  # type: ignore[index]
    assert first.fault == "f" and first.size == pytest.approx(motor.FAULT, rel=0.05)
    assert first.unit == "N.m.s/rad" and first.probability > 0.9
    assert "6000 samples" in str(said[5]["message"])


def test_text_is_one_line_for_each_verdict(logs: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["monitor", MOTOR, str(logs / "motor.csv"), "--bandwidth", "20"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 6
    assert "Motor: 2 residuals" in lines[0]
    until = re.search(r"the noise of r1 and r2 is learned until (\d\.\d{3} s)", lines[1])
    assert until is not None and lines[2].strip().startswith(until[1])
    assert "watched from now on" in lines[2] and "watched" not in lines[1]
    assert " s  fault " in lines[3] and re.search(r"r2 .* since [23]\.\d{3} s", lines[3])
    assert " s  update " in lines[4] and "J, f or load since " in lines[4]
    assert re.search(r"f \(\d+ %, \+2\.\d+e-05 N\.m\.s/rad\)", lines[4])
    assert "r2 at " in lines[4] and "its threshold" in lines[4]


def test_a_healthy_machine_has_no_fault(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(tmp_path / "log.csv")
    write_log(motor.log().part(0, 3000), path)
    said = monitored(capsys, path)
    assert [v["event"] for v in said] == ["start", *WARM, "stop"]
    assert "not watched" not in str(said[-1]["message"])
    write_log(motor.log().part(0, 1500), path)  # too short for the noise to be learned
    said = monitored(capsys, path)
    assert [v["event"] for v in said] == ["start", "warm-up", "stop"]
    assert "r1 and r2 are not watched" in str(said[-1]["message"])


def test_what_was_said_before_a_kill_is_not_lost_and_not_said_twice(
    logs: Path, tmp_path: Path, watch: Start
) -> None:
    lines = (logs / "motor.csv").read_bytes().splitlines(keepends=True)
    path, journal = tmp_path / "log.csv", str(tmp_path / "j")
    path.write_bytes(b"")
    said: list[dict[str, object]] = []
    # Killed after the warm-up, after the alarm, after the fault is named, and at an unknown moment
    # near the end.
    parts = ((0, 2800, "warm-up"), (2800, 3500, "fault"), (3500, 4800, "update"), (4800, 6100, ""))
    for start, end, event in parts:
        one = watch(str(path), "--follow", "--journal", journal)
        with path.open("ab") as file:
            file.write(b"".join(lines[start:end]))
        word = "from now on" if event == "warm-up" else ""  # what was not learned yet is forgotten
        one.heard(event, word) if event else one.heard("resumed")
        one.kill()
        said += one.said
    last = watch(str(path), "--journal", journal)
    assert last.ended() == 0
    said += last.said
    assert [v["number"] for v in said] == list(range(1, len(said) + 1))
    events = [v["event"] for v in said]
    told = ["start", *WARM, "fault", "update", "stop"]
    assert [e for e in events if e != "resumed"] == told
    update = said[events.index("update")]
    first = update["candidates"][0]  # type: ignore[index]
    assert first["fault"] == "f" and first["size"] == pytest.approx(motor.FAULT, rel=0.05)
    resumed = [v for v in said if v["event"] == "resumed"]
    assert len(resumed) == 4
    assert all("nothing is missed" in str(v["message"]) for v in resumed)
    assert "still latched" not in str(resumed[0]["message"])
    assert "still latched: an unknown fault" in str(resumed[1]["message"])
    for verdict in resumed[2:]:
        assert "still latched" in str(verdict["message"]) and "f" in verdict["group"]  # type: ignore[operator]
    assert "6000 samples" in str(said[-1]["message"])
    # The journal has the same.
    records = [json.loads(line) for line in Path(journal).read_text("utf-8").splitlines()]
    assert [v for r in records for v in r.get("verdicts", [])] == said


def test_a_pipe_that_was_not_watched_says_what_is_missed(tmp_path: Path, watch: Start) -> None:
    log, journal = motor.log(), str(tmp_path / "j")
    first = watch("--journal", journal)
    first.feed(csv(log, 0, 4000, header=True))
    first.heard("fault")
    first.kill()
    records = [json.loads(line) for line in Path(journal).read_text("utf-8").splitlines()]
    known = next(r["position"]["time"] for r in reversed(records) if "position" in r)
    assert motor.ONSET < known < 4.0
    second = watch("--journal", journal)
    second.feed(csv(log, 4750, 5750, header=True))
    assert second.ended() == 0
    resumed = second.heard("resumed")
    count = round(1000 * (4.75 - known)) - 1
    assert f"{4.75 - known:.3f} s of the stream are missed ({count} samples)" in resumed["message"]
    assert "still latched" in resumed["message"] and resumed["since"] is not None
    assert [e for e in second.events() if e != "update"] == ["resumed", "warm-up", "stop"]
    assert second.events().count("update") <= 1
    assert second.said[0]["number"] == first.said[-1]["number"] + 1


def test_a_journal_goes_on_after_a_proper_end(
    logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [str(logs / "motor.csv"), "--journal", str(tmp_path / "j")]
    first = monitored(capsys, *words)
    again = monitored(capsys, *words)
    assert [v["event"] for v in first] == ["start", *WARM, "fault", "update", "stop"]
    assert [v["event"] for v in again] == ["resumed", "stop"]
    other = monitored(capsys, str(logs / "motor.parquet"), *words[1:])
    assert "the source was" in str(other[0]["message"])


def test_a_journal_of_another_model_is_refused(
    logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = str(tmp_path / "j")
    monitored(capsys, str(logs / "motor.csv"), "--journal", journal)
    words = ["monitor", MOTOR, str(logs / "motor.csv"), "--journal", journal, "--bandwidth", "10"]
    assert main(words) == 1
    assert "another model" in capsys.readouterr().err


@pytest.mark.parametrize(
    "change",
    [
        ('"fired"', '"sired"'),
        ('"fired": [false, true]', '"fired": [false, true, false]'),
        ('"fired": [false, true]', '"fired": [false, false]'),
        ('"latched": {', '"latched": 7, "other": {'),
        ('"latched": {"since": ', '"latched": {"from": '),
        ('"history": [[', '"history": [["a", '),
    ],
)
def test_a_journal_with_another_kind_of_state_is_refused(
    change: tuple[str, str], logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = tmp_path / "j"
    words = ["monitor", MOTOR, str(logs / "motor.csv"), "--journal", str(journal)]
    assert main(words) == 0
    lines = journal.read_text("utf-8").replace(*change).splitlines()
    records = [json.loads(line) for line in lines]  # with checksums that are right
    journal.write_bytes(b"".join(checked_line(r) for r in records if r.pop("crc")))
    capsys.readouterr()
    assert main(words) == 1
    assert "another version" in capsys.readouterr().err


def test_a_damaged_journal_is_told_kept_and_gone_on_with(
    logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = tmp_path / "j"
    words = ["monitor", MOTOR, str(logs / "motor.csv"), "--json", "--journal", str(journal)]
    assert main(words) == 0
    said = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    data = journal.read_bytes()
    at = data.index(b'"event": "fault"')
    damaged = data[:at] + b"!" + data[at + 1 :]
    journal.write_bytes(damaged)
    assert main(words) == 0
    printed = capsys.readouterr()
    line = damaged[:at].count(b"\n") + 1
    byte = damaged.rindex(b"\n", 0, at) + 1
    place = f"line {line}, at byte {byte}: its checksum does not match"
    assert place in printed.err
    resumed = json.loads(printed.out.splitlines()[0])
    assert resumed["event"] == "resumed" and place in resumed["message"]
    lost = [v["number"] for v in said if v["event"] == "fault"]
    assert "lost are the verdicts" in resumed["message"]
    kept = [v for r in journal.read_bytes().splitlines() for v in json.loads(r).get("verdicts", ())]
    assert not set(lost) & {v["number"] for v in kept}
    assert [v for v in kept if v in said] == [v for v in said if v in kept] != []
    assert (tmp_path / "j.damaged").read_bytes() == damaged
    assert main(words) == 0  # it is told once
    assert "checksum" not in capsys.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_stop_it_properly(number: signal.Signals, tmp_path: Path, watch: Start) -> None:
    journal = tmp_path / "j"
    one = watch("--journal", str(journal))
    one.feed(csv(motor.log(), 0, 100, header=True))
    one.heard("start")
    until(lambda: b"position" in journal.read_bytes())
    assert one.ended(number) == 0
    assert f"stopped by {number.name}" in one.said[-1]["message"]
    assert json.loads(journal.read_text().splitlines()[-1])["verdicts"] == one.said[-1:]


def test_lines_of_json_and_garbage_between(watch: Start) -> None:
    one = watch("-")
    noise = [b"\x80\x81\n", b'{"t": 0.5, "U"\n', b"hello\n", b"1,2,3\n"]
    rows = [json.dumps(o).encode() + b"\n" for o in objects(motor.log(), 0, 5000)]
    one.feed(b"".join(noise[:3]) + b"".join(rows[:2000]) + noise[3] + b"".join(rows[2000:]))
    one.feed(b'{"t": 5.0, "U": 1.')  # closed in the middle of a line
    assert one.ended() == 0
    assert "f" in one.heard("update")["group"]
    invalid = [v["message"] for v in one.said if v["event"] == "invalid"]
    assert invalid and all("no sample" in text for text in invalid)
    assert "5000 samples" in one.heard("stop")["message"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b"", ["no samples came"]),
        (b"t,U,load,current,speed\n", ["no samples came"]),
        (b"t,U,current\n0,1,2\n", ["load", "speed"]),
        (b"stamp,U,load,current,speed\n0,1,2,3,4\n", ["time", "stamp"]),
        (b'{"stamp": 0, "U": 1}\n', ["time", "stamp"]),
    ],
)
def test_what_cannot_be_watched_is_said_with_names(
    text: bytes, words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(text)
    assert main(["monitor", MOTOR, str(path)]) == 1
    error = capsys.readouterr().err
    assert all(word in error for word in words), error
    assert "Traceback" not in error


@pytest.mark.parametrize(
    "words",
    [
        ["a.csv", "--serial", "/dev/none"],
        ["a.csv", "--mqtt", "localhost/x"],
        ["--follow", "-"],
        ["--mqtt", "localhost"],
        ["-", "--publish", "topic"],
        ["a.csv", "--time-unit", "V"],
        ["a.csv", "--rate", "0"],
        ["-", "--tuning"],
    ],
)
def test_wrong_words_are_wrong_usage(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    try:
        status = main(["monitor", MOTOR, *words])
    except SystemExit as left:
        status = int(left.code or 0)
    assert status == 2
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("words", [["none.csv"], ["--serial", "/dev/none"]])
def test_a_source_that_is_not_there_is_said(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["monitor", MOTOR, *words]) == 1
    error = capsys.readouterr().err
    assert words[-1] in error and "Traceback" not in error


@pytest.mark.parametrize(
    ("package", "words"),
    [
        ("serial", ["--serial", "/dev/none"]),
        ("paho.mqtt.client", ["--mqtt", "localhost/x"]),
        ("paho.mqtt.client", ["-", "--publish", "localhost/x"]),
    ],
)
def test_a_package_that_is_missing_is_named(
    package: str, words: list[str], capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.setitem(sys.modules, package, None)
    assert main(["monitor", MOTOR, *words]) == 1
    error = capsys.readouterr().err
    assert "pip install 'bondgraph-arr[robot]'" in error and error.count("\n") == 1


def test_a_reader_that_goes_away_is_no_failure(logs: Path) -> None:
    code = f"{sys.executable} -m bondgraph monitor {MOTOR} {logs / 'motor.csv'} | head -n 1"
    done = subprocess.run(
        ["sh", "-c", code], capture_output=True, env={**os.environ, "PYTHONPATH": str(ROOT)}
    )
    assert b"start" in done.stdout and done.stderr == b""


def test_a_verdict_is_on_the_disk_before_it_is_said(
    logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = tmp_path / "j"

    def printer(lines: bool) -> Callable[[int, Verdict], None]:
        def say(number: int, verdict: Verdict) -> None:
            last = json.loads(journal.read_text("utf-8").splitlines()[-1])
            assert number in [v["number"] for v in last["verdicts"]]
            if verdict.event == "fault":
                raise KeyboardInterrupt

        return say

    monkeypatch.setattr("bondgraph.cli.monitor._printer", printer)
    words = [str(logs / "motor.csv"), "--journal", str(journal)]
    assert main(["monitor", MOTOR, *words]) == 130
    capsys.readouterr()
    monkeypatch.undo()
    said = monitored(capsys, *words)
    events = [v["event"] for v in said]
    assert events == ["resumed", *events[1:-1], "stop"]
    assert set(events[1:-1]) <= {"update"}  # of a second run that has the fault, at most
    assert "still latched" in str(said[0]["message"])


def test_a_clock_of_32_bits_may_run_over_and_other_names_are_mapped(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = motor.log()
    ticks = (np.arange(log.rows) * 1000 + 2**32 - 1_500_000) % 2**32
    columns = {"volt": log.columns["U"] * 1000, **log.columns}
    del columns["U"]
    path, names = tmp_path / "log.csv", tmp_path / "names.toml"
    write_log(Log(ticks.astype(float), columns, {}, {}), path)
    text = "\n".join(path.read_text().splitlines()[1:]).replace("t,", "time_us,", 1)
    path.write_text(text + "\n")
    names.write_text('U = { column = "volt", unit = "mV" }\n')
    said = monitored(capsys, str(path), "--map", str(names))
    assert [v["event"] for v in said] == ["start", *WARM, "fault", "update", "stop"]
    assert "f" in said[4]["group"]  # type: ignore[operator]
    start = (2**32 - 1_500_000) / 1e6
    assert said[3]["since"] == pytest.approx(start + motor.ONSET, abs=0.1)


def test_the_rate_is_that_of_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = motor.log()
    time, columns = log.time[::4], {k: v[::4] for k, v in log.columns.items()}
    path = str(tmp_path / "log.parquet")
    write_log(log._replace(time=time, columns=columns), path)
    said = monitored(capsys, path, "--bandwidth", "20")
    assert "250 samples a second" in str(said[0]["message"])
    row = 3.0 / 20.0  # s, three time constants of the filter: as close as the onset is told
    assert said[3]["since"] == pytest.approx(motor.ONSET, abs=row)


def test_a_file_that_was_empty_at_first_keeps_its_rate(tmp_path: Path, watch: Start) -> None:
    path, journal = tmp_path / "log.csv", str(tmp_path / "j")
    path.write_bytes(b"")
    first = watch(str(path), "--follow", "--journal", journal)
    assert "1000 samples a second" in first.heard("start")["message"]
    first.kill()
    log = motor.log()
    columns = {k: v[::4] for k, v in log.columns.items()}
    path.write_bytes(csv(log._replace(time=log.time[::4], columns=columns), header=True))
    second = watch(str(path), "--journal", journal)
    assert second.ended() == 0
    assert second.events() == ["resumed", *WARM, "fault", "update", "stop"]


def test_gaps_are_told_and_a_flood_of_them_is_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = motor.log()
    path = str(tmp_path / "log.csv")
    kept = np.concatenate([np.arange(600), np.arange(900, 1600), np.arange(1600, 2900, 100)])
    columns = {k: v[kept] for k, v in log.columns.items()}
    write_log(log._replace(time=log.time[kept], columns=columns), path)
    said = monitored(capsys, path, "--rate", "1000")
    gaps = [str(v["message"]) for v in said if v["event"] == "gap"]
    assert "300 samples lost from 0.599 s to 0.9 s" in gaps[0]
    assert 2 <= len(gaps) <= 6 and "--rate" in gaps[-1]
    assert [v["event"] for v in said[:4]] == ["start", "warm-up", "gap", "warm-up"]


def test_a_model_without_numbers_or_redundancy_is_said(
    logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "m.bg"
    for text, word in (("param R : Ohm; Se:U -> 1:j -> R:R; j -> Df:i", "R"),
                       ("param R = 1 Ohm; Se:U -> 1:j -> R:R", "no residual")):  # fmt: skip
        model.write_text(f"bg 1\nmodel M {{ {text} }}\n")
        assert main(["monitor", str(model), str(logs / "motor.csv")]) == 1
        error = capsys.readouterr().err
        assert word in error and "bug" not in error


def test_a_robot_with_encoders_is_watched(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """At rest, all counts zero: nothing to say; the signals are found by their paths."""
    import bondgraph

    model = str(ROOT / "models" / "khepera.bg")
    graph = bondgraph.compile(model).graph
    names = [*(i.name for i in graph.inputs), *(s.name for s in graph.sensors)]
    rows = ["t," + ",".join(names)]
    rows += [f"{k / 1000}," + ",".join(["0"] * len(names)) for k in range(1000)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(rows) + "\n")
    assert main(["monitor", model, str(path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line[16:].split()[0] for line in lines] == ["start", "warm-up", "stop"]
    assert not lines[0][:16].strip()  # no sample has come yet: in a log with dates 0 s is 1970
    assert all(line[:16].strip().endswith("s") for line in lines[1:])
    assert np.all([r in lines[1] for r in ("r1", "r5")])


def test_lines_that_are_none_are_counted_at_the_first_and_when_they_have_doubled(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [json.dumps(o) + "\n" for o in objects(motor.log(), 0, 3000)]
    path = tmp_path / "log.jsonl"
    path.write_text("what\n" + "".join(rows), encoding="utf-8")
    said = [v["message"] for v in monitored(capsys, str(path)) if v["event"] == "invalid"]
    why = "no header names the columns yet"
    assert said == [f"1 line is no sample, the last is `what` (line 1: {why})"]
    path.write_text("what\nis\nthis\n" + "".join(rows), encoding="utf-8")
    said = [v["message"] for v in monitored(capsys, str(path)) if v["event"] == "invalid"]
    assert said == [f"3 lines are no samples, the last is `this` (line 3: {why})"]
