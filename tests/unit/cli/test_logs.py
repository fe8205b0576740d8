"""Logs as data loggers write them, read by `monitor` and `tune`: what is taken and said."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.time_column import Pace

MODEL = """bg 1
model Tank {
  input Tin : K
  param C = 5000 J/K +- 5%
  param R = 0.02 K/W +- 5%
  Se:Tin -> 1:path -> 0:water
  path -> R:R
  water -> C:C
  water -> De:T1
}
"""
_ROWS = 4000


def _tank(fault: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time in s, supply and water in K: the exact solution between steps of the supply.

    A step of 1 s, of 2 s one time in twenty. From half of the rows on the sensor is off by `fault`.
    """
    rng = np.random.default_rng(7)
    time = np.cumsum(np.where(rng.random(_ROWS) < 0.05, 2.0, 1.0))
    supply = 320.0 + 10.0 * np.sin(time / 400.0)
    water = np.empty(_ROWS)
    water[0] = supply[0]
    for k in range(1, _ROWS):
        share = np.exp(-(time[k] - time[k - 1]) / (5000 * 0.02))
        mean = 0.5 * (supply[k] + supply[k - 1])
        water[k] = mean + (water[k - 1] - mean) * share
    water += rng.normal(0.0, 0.01, _ROWS)
    water[_ROWS // 2 :] += fault
    return time, supply, water


@pytest.fixture
def at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tank.bg").write_text(MODEL)
    return tmp_path


Monitored = Callable[..., tuple[int, list[tuple[str, str]], str]]


@pytest.fixture
def monitored(at: Path, capsys: pytest.CaptureFixture[str]) -> Monitored:
    """The status, the verdicts, and what is on the error stream."""

    def run(text: str | bytes, *words: str) -> tuple[int, list[tuple[str, str]], str]:
        Path("log.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
        status = main(["monitor", "tank.bg", "log.csv", "--json", *words])
        said = capsys.readouterr()
        lines = [json.loads(line) for line in said.out.splitlines() if line]
        return status, [(v["event"], v["message"]) for v in lines], said.err

    return run


def _csv(names: str, columns: Iterable[Iterable[object]], mark: str = ",") -> str:
    rows = [mark.join(map(str, row)) for row in zip(*columns, strict=True)]
    return "\n".join([names, *rows]) + "\n"


def _iso(time: np.ndarray, zone: str) -> list[str]:
    start = datetime(2024, 3, 31, 0, 30, tzinfo=UTC)
    return [
        (start + timedelta(seconds=float(t))).replace(tzinfo=None).isoformat() + zone for t in time
    ]


def _germans(water: np.ndarray) -> list[str]:
    return [f"{t - 273.15:.4f}".replace(".", ",") for t in water]


@pytest.mark.parametrize("zone", ["", "Z", "+02:00"])
@pytest.mark.parametrize("fault", [0.0, 5.0])
def test_a_logger_in_an_office(monitored: Monitored, zone: str, fault: float) -> None:
    """Semicolons, also at the end of a row, decimal commas, a mark of UTF-8, dates, degrees."""
    time, supply, water = _tank(fault)
    columns = (_iso(time, zone), [f"{x:.4f}" for x in supply], _germans(water))
    text = _csv("Zeit;Tin [K];T1 [°C]", columns, ";").replace("Zeit", "Timestamp")
    text = text.replace(".", ",").replace("\n", ";\r\n")
    status, said, errors = monitored("\ufeff" + text)
    events = [event for event, _ in said]
    assert status == 0 and "gap" not in events and "invalid" not in events
    assert ("fault" in events) == (fault != 0.0)
    assert "1 samples a second" in said[0][1]
    assert "time is the column `Timestamp`, as ISO 8601" in said[0][1]
    assert errors.count("note: ") == 1 and "`Timestamp`, as ISO 8601" in errors


@pytest.mark.parametrize(
    ("name", "scale", "words", "unit"),
    [
        ("time", 1.0, [], "s as nothing says otherwise"),
        ("t_ms", 1e3, [], "ms as its name says"),
        ("Time (min)", 1 / 60, [], "min as its name says"),
        ("time [us]", 1e6, [], "us as its name says"),
        ("stamp", 1e3, ["--time", "stamp", "--time-unit", "ms"], "ms as told"),
        ("stamp", 1e9, ["--map", "map.toml"], "ns as told"),
    ],
)
def test_units_of_time(
    monitored: Monitored, name: str, scale: float, words: list[str], unit: str
) -> None:
    time, supply, water = _tank()
    Path("map.toml").write_text('time = { column = "stamp", unit = "ns" }\n')
    text = _csv(f"{name},Tin,T1", ([repr(float(t)) for t in time * scale], supply, water))
    status, said, errors = monitored(text, *words)
    assert status == 0 and "1 samples a second" in said[0][1]
    assert [e for e, _ in said if e in ("gap", "fault", "invalid")] == []
    assert f"time is the column `{name}`, in {unit}" in errors


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
def test_a_clock_that_counts_from_1970_says_its_unit_by_its_numbers(
    monitored: Monitored, unit: str
) -> None:
    time, supply, water = _tank()
    scale = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}[unit]
    stamps = [(1_700_000_000 + int(t)) * scale for t in time]
    status, said, errors = monitored(_csv("timestamp,Tin,T1", (stamps, supply, water)))
    assert status == 0 and "1 samples a second" in said[0][1]
    assert f"in {unit} since 1970" in errors


@pytest.mark.parametrize(
    ("scale", "words", "names"),
    [
        (1e3, ["--rate", "1"], ["1000 s apart", "1 s apart", "in ms, not in s (--time-unit ms)"]),
        (1e3, ["--rate", "1", "--time-unit", "us"], ["in ms, not in us"]),
        (1.0, ["--rate", "1", "--time-unit", "ms"], ["0.001 s apart", "in s, not in ms"]),
        (1.0, ["--rate", "5"], ["1 a second", "--rate asks for 5 a second", "--rate 1)"]),
    ],
)
def test_steps_that_do_not_fit_the_rate_are_an_error(
    monitored: Monitored, scale: float, words: list[str], names: list[str]
) -> None:
    time, supply, water = _tank()
    text = _csv("time,Tin,T1", (time * scale, supply, water))
    status, _, errors = monitored(text, *words)
    assert status == 1
    for name in names:
        assert name in errors
    assert main(["tune", "tank.bg", "log.csv", *words]) == 1


def test_a_rate_that_the_log_nearly_has_is_none(monitored: Monitored) -> None:
    time, supply, water = _tank()
    status, _, _ = monitored(_csv("time,Tin,T1", (time, supply, water)), "--rate", "1.02")
    assert status == 0
    status, _, _ = monitored(_csv("time,Tin,T1", (time / 10, supply, water)), "--rate", "1")
    assert status == 0  # thinned


@pytest.mark.parametrize("name", ["T", "Ts", "t"])
def test_a_temperature_is_no_time(monitored: Monitored, name: str) -> None:
    time, supply, water = _tank()
    text = _csv(f"{name},time,Tin,T1", (water, time, supply, water))
    status, said, errors = monitored(text)
    assert status == 0 and "1 samples a second" in said[0][1]
    assert "time is the column `time`" in errors
    alone = _csv(f"{name},Tin,T1", (water, supply, water))
    status, said, errors = monitored(alone)
    assert status == 1 and f"the column `{name}` is no time, it does not grow" in errors
    status, said, errors = monitored(alone, "--rate", "1")
    assert status == 0 and "no column, 1 samples a second as told" in errors


@pytest.mark.parametrize(
    ("line", "cause"),
    [
        ("{t},{s},{w},9", "log.csv:2: 4 cells where the header names 3"),
        ("{t},{s},warm?", None),  # a column of words is named when it is missed
        ("never,{s},{w}", "log.csv:2: `never` in the column time is not a number"),
        (",{s},{w}", "log.csv:2: the column `time` is no time, it does not grow: it has no"),
    ],
)
def test_a_log_of_which_nothing_can_be_read_stops_at_once(
    monitored: Monitored, line: str, cause: str | None
) -> None:
    time, supply, water = _tank()
    rows = zip(time, supply, water, strict=True)
    body = [line.format(t=t, s=s, w=w) for t, s, w in rows]
    status, said, errors = monitored("\n".join(["time,Tin,T1", *body]) + "\n")
    assert status == 1
    assert (cause or "columns without numbers: T1 (`warm?`)") in errors
    assert [e for e, _ in said if e == "invalid"] == []


def test_a_line_that_is_refused_says_why_with_its_number(monitored: Monitored) -> None:
    time, supply, water = _tank()
    lines = _csv("time,Tin,T1", (time, supply, water)).splitlines(keepends=True)
    lines.insert(1001, "1,2\n")
    _, said, _ = monitored("".join(lines))
    (told,) = [m for e, m in said if e == "invalid"]
    assert "`1,2` (line 1002: 2 cells where the header names 3)" in told


def test_units_in_headers_and_maps(monitored: Monitored) -> None:
    time, supply, water = _tank()
    degf, degc = (supply - 273.15) * 9 / 5 + 32, water - 273.15
    status, said, _ = monitored(_csv("time,Tin (degF),T1 [degC]", (time, degf, degc)))
    assert status == 0 and "fault" not in [e for e, _ in said]
    Path("map.toml").write_text(
        'Tin = { column = "in", unit = "degF" }\nT1 = { column = "out", unit = "degC" }\n'
    )
    text = _csv("time,in,out [K]", (time, degf, degc))
    status, said, _ = monitored(text, "--map", "map.toml")
    assert status == 0 and "fault" not in [e for e, _ in said]
    status, said, errors = monitored(_csv("time,Tin [K],T1 [bar]", (time, supply, degc)))
    assert status == 1 and "T1 is in K, its column T1 [bar] is in bar" in errors


def _pumped() -> str:
    """A log in which the sensors tell nothing of use while the pump is off."""
    time, supply, water = _tank()
    off = (np.arange(_ROWS) // 500) % 4 == 2
    water = np.where(off, 290.0, water)
    return _csv("time,pump speed [%],Tin,T1", (time, np.where(off, 0.0, 40.0), supply, water))


def test_while_leaves_out_when_a_machine_is_off(monitored: Monitored) -> None:
    status, said, _ = monitored(_pumped())
    assert "fault" in [e for e, _ in said]
    status, said, _ = monitored(_pumped(), "--while", "pump_speed > 5")
    events = [e for e, _ in said]
    assert status == 0 and "fault" not in events and events.count("gap") == 2
    gap = next(m for e, m in said if e == "gap")
    assert "the machine was off from " in gap and "the residuals warm up" in gap
    assert "1000 of them while the machine was off" in said[-1][1]


def test_while_is_the_same_in_tune(at: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("log.csv").write_text(_pumped())
    tune = ["tune", "tank.bg", "log.csv", "--bandwidth", "0.02", "--json"]
    sigmas = []
    for words in ([], ["--while", "pump_speed > 5 and t >= 0"]):
        assert main([*tune, *words]) == 0
        found = json.loads(capsys.readouterr().out)
        sigmas.append(found["limits"][0]["sigma"])
        assert found["times"] == {"log.csv": "the column `time`, in s as nothing says otherwise"}
    assert sigmas[1] < 0.2 * sigmas[0]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("pump >", "a value"),
        ("pump_speed > 5 bar", "unit"),
        ("pomp > 0", "no column of numbers is called so; there is pump speed, Tin, T1"),
        ("", "empty"),
    ],
)
def test_a_wrong_while_is_told(
    at: Path, capsys: pytest.CaptureFixture[str], words: str, message: str
) -> None:
    Path("log.csv").write_text(_pumped())
    for command in ("monitor", "tune"):
        assert main([command, "tank.bg", "log.csv", "--while", words]) == 1
        errors = capsys.readouterr().err
        assert message in errors and "Traceback" not in errors


def test_while_over_words_says_that_there_are_no_numbers(
    at: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    head, *rows = _pumped().splitlines()
    text = "\n".join([f"{head},state", *(f"{row},RUN" for row in rows)])
    Path("log.csv").write_text(text + "\n")
    for command in ("monitor", "tune"):
        assert main([command, "tank.bg", "log.csv", "--while", "state == RUN"]) == 1
        errors = capsys.readouterr().err
        assert "--while asks for `state`, and no column of numbers is called so" in errors
        assert "columns without numbers: state (`RUN`)" in errors


def test_a_machine_that_was_never_on(monitored: Monitored) -> None:
    status, said, _ = monitored(_pumped(), "--while", "pump_speed > 200")
    assert status == 0 and [e for e, _ in said] == ["start", "stop"]
    assert f"{_ROWS} samples, {_ROWS} of them while the machine was off" in said[-1][1]
    assert main(["tune", "tank.bg", "log.csv", "--while", "pump_speed > 200"]) == 1


@pytest.mark.parametrize("form", ["jsonl", "parquet"])
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("stamp", ["--time", "stamp", "--time-unit", "ms", "--while", "on > 0 and T1 > 20"]),
        ("t_ms", ["--while", "on"]),
        ("time [ms]", ["--map", "map.toml", "--while", "on > 0.5"]),
        ("date", []),
    ],
)
def test_other_files_take_the_same_options(
    at: Path, capsys: pytest.CaptureFixture[str], form: str, name: str, words: list[str]
) -> None:
    import pyarrow
    import pyarrow.parquet

    time, supply, water = _tank()
    Path("map.toml").write_text('time = { column = "time", unit = "ms" }\nT1 = "T1"\n')
    times = _iso(time, "+01:00") if name == "date" else [1e3 * float(t) for t in time]
    on = (np.arange(_ROWS) < 3000).tolist()
    columns = {"T": water.tolist(), name: times, "Tin": supply.tolist(), "on": on,
               "T1 [degC]": (water - 273.15).tolist()}  # fmt: skip
    path = f"log.{form}"
    if form == "jsonl":
        rows = zip(*columns.values(), strict=True)
        lines = [json.dumps(dict(zip(columns, row, strict=True))) for row in rows]
        Path(path).write_text("\n".join(lines))
    else:
        pyarrow.parquet.write_table(pyarrow.table(columns), path)
    assert main(["monitor", "tank.bg", path, "--json", *words]) == 0
    said = capsys.readouterr()
    assert f"time is the column `{name}`" in said.err
    verdicts = [json.loads(line) for line in said.out.splitlines()]
    assert "1 samples a second" in verdicts[0]["message"]
    assert [v for v in verdicts if v["event"] in ("fault", "gap", "invalid")] == []
    assert ("1000 of them while" in verdicts[-1]["message"]) == bool(words)
    assert main(["tune", "tank.bg", path, "--json", "--bandwidth", "0.02", *words]) == 0
    found = json.loads(capsys.readouterr().out)
    assert f"the column `{name}`" in found["times"][path]


def test_a_row_of_units_below_the_header(monitored: Monitored) -> None:
    time, supply, water = _tank(5.0)
    _, plain, _ = monitored(_csv("time,Tin,T1", (time, supply, water)))
    columns = (time * 1e3, supply, water - 273.15)
    for units in ("ms,K,degC", "[ms],,[°C]"):
        status, said, errors = monitored(_csv(f"time,Tin,T1\n{units}", columns))
        assert status == 0 and "in ms as the file says" in errors
        assert [e for e, _ in said] == [e for e, _ in plain] and "fault" in [e for e, _ in said]
    assert main(["tune", "tank.bg", "log.csv", "--bandwidth", "0.02"]) == 0


@pytest.mark.parametrize("code", ["latin-1", "utf-16"])
def test_another_code_is_told(monitored: Monitored, code: str) -> None:
    text = _csv("time,Tin,T1 [°C]", _tank())
    status, _, errors = monitored(text.encode(code))
    assert status == 1 and "log.csv:1: not UTF-8; save it as UTF-8" in errors


@pytest.mark.parametrize(("asked", "first"), [(True, "the time is probably"), (False, "give the")])
def test_a_rate_that_nobody_gave_is_doubted_first(asked: bool, first: str) -> None:
    pace = Pace(0.001, "log.csv", asked)
    pace.look(Log(np.arange(10.0), {}, {}, {}))  # not yet enough steps
    with pytest.raises(LogError, match="1 s apart, 1 a second") as error:
        pace.look(Log(np.arange(10.0, 20.0), {}, {}, {}))
    assert error.value.help.startswith(first)
