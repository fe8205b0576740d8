"""Lines of all kinds, sound and broken, to samples."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from threading import Event, Thread

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.runtime.log import Log, LogError, joined
from bondgraph.runtime.log_file import read_log, write_log
from bondgraph.runtime.log_numbers import Form, by_c
from bondgraph.runtime.monitoring.sources.lines import Decoder
from tests.unit.runtime.monitoring.watch import until


def decoder(**form: object) -> Decoder:
    return Decoder(Form("test", **form))  # type: ignore[arg-type]


def one(text: str, **form: object) -> Log:
    (log,) = decoder(**form).feed(text.encode())
    return log


def test_csv_with_a_header() -> None:
    log = one("t,U0[1],speed\n0.1,3,4.5\n0.2,-3e-1,5\n")
    assert log.time.tolist() == [0.1, 0.2]
    assert {k: v.tolist() for k, v in log.columns.items()} == {
        "U0[1]": [3.0, -0.3],
        "speed": [4.5, 5.0],
    }


@pytest.mark.parametrize("mark", [",", ";", "\t"])
def test_separators_and_empty_cells(mark: str) -> None:
    rows = ["t,a,b", "1,2,3", "2,,4", "3,5,", "4,,", "5,nan,true"]
    log = one("".join(row.replace(",", mark) + "\r\n" for row in rows))
    np.testing.assert_array_equal(log.columns["a"], [2, np.nan, 5, np.nan, np.nan])
    np.testing.assert_array_equal(log.columns["b"], [3, 4, np.nan, np.nan, 1])


def test_blocks_are_the_same_in_one_piece_or_line_by_line(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    columns = {f"x[{k}]": rng.normal(size=500) * 10.0 ** rng.integers(-30, 30) for k in range(4)}
    columns["x[1]"][::7] = np.nan
    log = Log(np.arange(500) / 300, columns, {"x[0]": "N.m"}, {"model": "M"})
    write_log(log, tmp_path / "log.csv")
    lines = (tmp_path / "log.csv").read_bytes().splitlines(keepends=True)
    single = decoder()
    parts = [part for line in lines for part in single.feed(line)]
    for found in (joined(parts), joined(decoder().feed(b"".join(lines)))):
        assert found.time.tobytes() == log.time.tobytes()
        for name, column in columns.items():
            np.testing.assert_array_equal(found.columns[name], column)
    assert parts[0].units == {"x[0]": "N.m"}
    assert single.garbage == 0
    read = read_log(tmp_path / "log.csv")
    assert read.time.tobytes() == log.time.tobytes()


def test_json_lines_and_arrays_of_objects() -> None:
    text = '{"t": 1, "a": 2, "who": "me"}\n[{"t": 2, "a": null}, {"t": 3, "b": true}]\n'
    log = one(text)
    assert log.time.tolist() == [1, 2, 3]
    np.testing.assert_array_equal(log.columns["a"], [2, np.nan, np.nan])
    np.testing.assert_array_equal(log.columns["b"], [np.nan, np.nan, 1])
    assert "who" not in log.columns


def test_garbage_is_counted_and_the_rest_stays() -> None:
    found = decoder()
    noise = [
        b"\xff\xfe\x80",
        b"1,2",
        b"1,2,3,4",
        b"xx,yy,zz",
        b'{"t": 1',
        b"{}",
        b"[[1]]",
        b"1,a,3",
    ]
    text = b"3.4,5\nt,a,b\n1,2,3\n" + b"\n".join(noise) + b"\n2,3,4\n"
    log = joined(found.feed(text))
    assert log.time.tolist() == [1, 2]
    assert log.columns["b"].tolist() == [3, 4]
    assert found.garbage == len(noise) + 1
    assert found.example == "1,a,3"


def test_a_row_without_a_time_is_no_sample() -> None:
    found = decoder()
    logs = found.feed(b"t,a\n1,2\nnan,3\n,4\ninf,5\n2,6\n")
    assert joined(logs).time.tolist() == [1, 2]
    assert found.garbage == 3


def test_a_header_may_come_again_and_differ() -> None:
    logs = decoder().feed(b"t,a,b\n1,2,3\nt,b,a\n0,5,4\n")
    assert [log.columns["a"].tolist() for log in logs] == [[2], [4]]
    assert [log.columns["b"].tolist() for log in logs] == [[3], [5]]


def test_a_wish_to_stop_is_not_lost_while_numbers_are_read() -> None:
    heard: list[int] = []
    before = signal.signal(signal.SIGTERM, lambda number, frame: heard.append(number))
    lines = [f"{k},{k},{k}\n" for k in range(20_000)]
    sent = 0
    try:
        over = Event()

        def send() -> None:
            nonlocal sent
            while not over.wait(0.002):
                os.kill(os.getpid(), signal.SIGTERM)
                sent += 1
                until(lambda wanted=sent: len(heard) == wanted)  # type: ignore[misc]

        thread = Thread(target=send)
        thread.start()
        for _ in range(60):
            assert by_c(lines, ",", 3) is not None
        over.set()
        thread.join()
    finally:
        signal.signal(signal.SIGTERM, before)
    assert len(heard) == sent > 3


def test_what_begins_in_the_middle_of_a_line_is_left_out() -> None:
    for first, count in [(b"34,3,4\n", 1), (b't": 1, "a": 9}\n', 1), (b"t,a,b\n", 2)]:
        found = decoder(columns=("t", "a", "b"))
        logs = found.feed(first + b"1.5,3,4\n2.5,3,4\n", whole=False)
        assert joined(logs).time.tolist() == [1.5, 2.5]
        assert found.garbage == (0 if count == 2 else 1)


def test_declared_columns_need_no_header() -> None:
    log = one("7;1;2\n8;3;4\n", columns=("time", "a", "b"))
    assert log.time.tolist() == [7, 8] and log.columns["b"].tolist() == [2, 4]


@pytest.mark.parametrize(
    ("header", "form", "factor"),
    [
        ("t", {"unit": "us"}, 1e-6),
        ("time_ms", {}, 1e-3),
        ("time_ms", {"unit": "s"}, 1.0),
        ("stamp", {"time": "stamp", "unit": "ms"}, 1e-3),
    ],
)
def test_units_of_time(header: str, form: dict[str, str], factor: float) -> None:
    log = one(f"{header},a\n4294967295,1\n", **form)
    assert log.time[0] == pytest.approx(4294967295 * factor, rel=1e-15)


def test_a_rate_makes_times_where_there_are_none() -> None:
    found = decoder(rate=50.0)
    logs = found.feed(b"a,b\n1,2\n3,4\n") + found.feed(b"5,6\n")
    assert joined(logs).time.tolist() == [0, 0.02, 0.04]
    assert one('{"a": 1}\n{"a": 2}\n', rate=4).time.tolist() == [0, 0.25]


@pytest.mark.parametrize("text", ["stamp,a\n1,2\n", '{"stamp": 1, "a": 2}\n'])
def test_no_column_of_time_is_said_with_what_there_is(text: str) -> None:
    found = decoder()
    assert found.feed(text.encode()) == []
    with pytest.raises(LogError, match="stamp, a"):
        found.check()


def test_columns_of_words_are_left_out() -> None:
    log = one("t,state,a\n1,RUN,2\n2,STOP,3\n")
    assert list(log.columns) == ["a"] and log.columns["a"].tolist() == [2, 3]
    assert log.meta["left-out"] == "state (`RUN`)"


def test_quoted_names_and_cells() -> None:
    log = one('"t","a, b"\n"1","2"\n')
    assert log.columns["a, b"].tolist() == [2]


@given(st.binary(max_size=200), st.booleans())
def test_noise_never_breaks_a_stream(noise: bytes, whole: bool) -> None:
    found = decoder(columns=("t", "a"))
    found.feed(noise + b"\n", whole)
    logs = found.feed(b't,a\n1,2\n{"t": 3, "a": 4}\n')
    assert [log.time.tolist() for log in logs] == [[1], [3]]
    assert all(np.isfinite(log.time).all() for log in logs)


@given(st.lists(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 2), min_size=1))
def test_both_forms_give_back_every_double(rows: list[tuple[float, float]]) -> None:
    rows = sorted({row[0]: row for row in rows}.values())  # a time grows
    csv = "t,a\n" + "".join(f"{t!r},{a!r}\n" for t, a in rows)
    lines = "".join(json.dumps({"t": t, "a": a}) + "\n" for t, a in rows)
    for text in (csv, lines):
        log = one(text, unit="s")
        found = np.stack([log.time, log.columns["a"]], axis=1)
        assert found.tobytes() == np.array(rows).tobytes()


def test_declared_columns_take_their_separator_from_the_first_row() -> None:
    found = decoder(columns=("t", "a"))
    assert found.feed(b"# hello\n") == []
    (log,) = found.feed(b"0,5;1,5\n1,5;2,5\n")
    assert log.time.tolist() == [0.5, 1.5] and log.columns["a"].tolist() == [1.5, 2.5]
    with pytest.raises(LogError, match="two columns are called `a`"):
        decoder(columns=("t", "a", "a"))


def test_dates_with_their_zones() -> None:
    """The hour that comes twice in Berlin, when summer ends, is told apart by its zone."""
    rows = ["2024-10-27T02:59:59+02:00,1", "2024-10-27T02:00:00+01:00,2", "2024-10-27T01:00:01Z,3"]
    text = "time,a\n" + "\n".join(rows) + "\n"
    start = 1729990799.0  # date -u -d 2024-10-27T00:59:59 +%s
    assert one(text).time.tolist() == [start, start + 1, start + 2]
    lines = [row.split(",") for row in rows]
    text = "".join(json.dumps({"time": t, "a": float(a)}) + "\n" for t, a in lines)
    assert one(text).time.tolist() == [start, start + 1, start + 2]
    with pytest.raises(LogError, match="are ISO 8601, not numbers in ms"):
        decoder(unit="ms").feed(text.encode())


def test_a_line_that_is_refused_is_known_by_its_number() -> None:
    found = decoder()
    found.feed(b"# note\n\nt,a\n0,1\n1,2\n")
    found.feed(b"2,3\n3\n4,5\n")
    assert found.garbage == 1 and found.example == "3"
    assert found.why == "line 7: 1 cells where the header names 2"
    found.feed(b'{"t": 5, "a": 1}\n{"a": 1}\n')
    assert found.garbage == 2 and found.why == "line 10: no time"
    found.feed(b'{"t": 7\n')
    assert found.garbage == 3 and found.why == "line 11: not JSON"


def test_a_column_that_does_not_run_is_looked_at_again() -> None:
    """A device that waits for its clock: its rows count once the time runs."""
    found = decoder()
    assert found.feed(b"t,a\n0,1\n0,2\n0,3\n") == []
    assert found.garbage == 3 and "does not grow" in found.why
    with pytest.raises(LogError, match="no time, it does not grow"):
        found.check()
    (log,) = found.feed(b"0.1,4\n0.2,5\n")
    assert log.time.tolist() == [0.1, 0.2]


def test_a_header_may_end_in_a_separator_and_may_not_begin_with_one() -> None:
    """As programs write it that put one behind each value; a column without a name is none."""
    log = one("t,a,\n1,2,\n3,4,\n")
    assert (log.time.tolist(), log.columns["a"].tolist()) == ([1.0, 3.0], [2.0, 4.0])
    for bad in (",t,a\n", "t,,a\n", "t,a,a\n", "t\n"):
        made = decoder()
        assert made.feed(bad.encode() + b"1,2,3\n") == []
