"""Files, pipes and the queue before the monitor: nothing is lost without being told."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from threading import Event, Thread

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.tuning import FASTEST, bandwidth_for
from bondgraph.runtime.log import Log, LogError
from bondgraph.runtime.log_file import write_log
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.sources.file import LinesFile, file_source
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.sources.sample_source import (
    Block,
    Chunk,
    Cutter,
    Intake,
    News,
    Source,
    decoded,
    rate_of,
)
from bondgraph.runtime.monitoring.sources.streams import Pipe
from bondgraph.runtime.monitoring.watch_settings import usual_bandwidth


@pytest.fixture
def lines_file() -> Iterator[Callable[..., LinesFile]]:
    opened: list[LinesFile] = []

    def open_file(path: object, follow: bool = False) -> LinesFile:
        opened.append(LinesFile(str(path), Form("x"), follow))
        return opened[-1]

    yield open_file
    for source in opened:
        source.close()


def times(chunks: Iterator[Chunk]) -> list[float]:
    return [t for chunk in chunks if chunk.log is not None for t in chunk.log.time.tolist()]


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_filter_settles_while_the_machine_is_on(suffix: str, tmp_path: Path) -> None:
    """On for 400 of each 500 samples, twenty times: of these it has settled in half at least.

    A filter that is 30 times slower than the samples needs 276 of them, 20 times slower 184.
    """
    path = str(tmp_path / f"log{suffix}")
    t = np.arange(10_000.0)
    on = (t % 500.0 >= 100.0).astype(float)
    write_log(Log(60.0 * t, {"a": np.sin(t), "pump": 100.0 * on}, {}, {}), path)
    rate = 1.0 / 60.0
    with closing(file_source(path, Form(path))) as source:
        _asked(rate, source)
        assert times(source.chunks(Event()))[-1] == 60.0 * t[-1], "nothing of it is lost"


def _asked(rate: float, source: Source) -> None:
    assert usual_bandwidth(rate, source) == bandwidth_for(rate, 1e4) == rate / 30
    assert usual_bandwidth(rate, source, False, "pump > 5") == rate / 20
    assert usual_bandwidth(rate, source, False, "a > -2") == rate / 30
    assert usual_bandwidth(rate, source, True, "pump > 5") == bandwidth_for(rate)
    assert usual_bandwidth(rate, source, False, "none > 5") == rate / 30, "told with the samples"
    assert usual_bandwidth(rate, source, True, fitted=rate / 10) == rate / 10
    assert usual_bandwidth(rate, source, fitted=rate) == FASTEST * rate, "samples can follow it"

@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_a_file_goes_on_from_any_place(suffix: str, tmp_path: Path) -> None:
    path = str(tmp_path / f"log{suffix}")
    count = 60_000
    write_log(Log(np.arange(count) / 1000, {"a": np.arange(count) / 7}, {}, {}), path)
    source = file_source(path, Form(path))
    chunks = list(source.chunks(Event()))
    assert len(chunks) > 1
    assert times(iter(chunks)) == (np.arange(count) / 1000).tolist()
    seen = 0
    for at, chunk in enumerate(chunks[:-1]):
        assert chunk.log is not None and chunk.place is not None
        seen += chunk.log.rows
        for until in chunks[at:]:
            again = file_source(path, Form(path))
            assert again.go({"back": chunk.place, "place": until.place}) == ""
            rest = [c for c in again.chunks(Event()) if c.log is not None]
            assert times(iter(rest)) == (np.arange(seen, count) / 1000).tolist()
            assert [c.place for c in rest if c.again][-1:] in ([until.place], [])
            warm = times(c for c in rest if c.again)
            end = until.log.time[-1] if until.log is not None else None
            assert (warm[-1] if warm else chunk.log.time[-1]) == end
            assert rest[0].log is not None and rest[0].log.columns["a"][0] == seen / 7
            again.close()
    source.close()


@pytest.mark.parametrize("end", ["\n", ""])
def test_a_place_is_the_number_of_bytes_of_the_lines_so_far(
    end: str, tmp_path: Path, lines_file: Callable[..., LinesFile], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("bondgraph.runtime.monitoring.sources.file._BLOCK", 50)
    path = tmp_path / "log.csv"
    lines = ["t,a\n", *[f"{k},{k * k}\n" for k in range(100)]]
    text = "".join(lines).removesuffix("\n") + end
    path.write_text(text)
    chunks = list(lines_file(path).chunks(Event()))
    assert len(chunks) > 10
    seen = 0
    for chunk in chunks:
        assert chunk.log is not None and chunk.place is not None
        seen += chunk.log.rows
        assert chunk.place["rows"] == seen
        assert chunk.place["offset"] == min(len("".join(lines[: seen + 1])), len(text))
    assert seen == 100


def test_a_header_in_between_begins_another_log(
    tmp_path: Path, lines_file: Callable[..., LinesFile]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,a\n1,2\n2,3\nt,b\n3,5\n")
    logs = [chunk.log for chunk in lines_file(path).chunks(Event()) if chunk.log is not None]
    found = [(log.time.tolist(), {k: v.tolist() for k, v in log.columns.items()}) for log in logs]
    assert found == [([1.0, 2.0], {"a": [2.0, 3.0]}), ([3.0], {"b": [5.0]})]


def test_a_signal_that_is_called_as_time_usually_is_is_none_in_a_log_of_our_own(
    tmp_path: Path, lines_file: Callable[..., LinesFile]
) -> None:
    path = tmp_path / "log.csv"
    write_log(Log(np.arange(4.0), {"t": np.full(4, 20.5)}, {}, {}), str(path))
    (log,) = [chunk.log for chunk in lines_file(path).chunks(Event()) if chunk.log is not None]
    assert log.time.tolist() == [0.0, 1.0, 2.0, 3.0]
    assert log.columns["t"].tolist() == [20.5] * 4


def test_the_rate_is_that_of_the_first_samples(
    tmp_path: Path, lines_file: Callable[..., LinesFile]
) -> None:
    path = tmp_path / "log.csv"
    early = "".join(f"{k / 50},1\n" for k in range(20))
    late = "".join(f"{10 + k / 8},1\n" for k in range(20))
    path.write_text(f"t,a\n{early}t,b\n{late}")
    assert lines_file(path).rate() == 50.0


@pytest.mark.parametrize(
    ("true", "digits", "read"),
    [
        (995.0, 9, 995.0),  # the times tell that it is not 1000
        (995.0, 3, 1000.0),  # each is a whole number of ms: here they cannot
        (1000.05, 9, 1000.0),  # within the tolerance of a crystal
        (610.35, 7, 610.35),
        (610.35, 3, 600.0),  # 40 steps of 1 or 2 ms leave that open
        (1 / 3, 6, 1 / 3),
        (0.1, 0, 0.1),
        (257.0, 12, 257.0),
    ],
)
def test_a_rate_is_as_exact_as_the_times_tell(true: float, digits: int, read: float) -> None:
    found = rate_of(np.round(np.arange(40) / true, digits))
    assert found == pytest.approx(read, rel=1e-6)


def test_jitter_and_lost_samples_do_not_change_a_round_rate() -> None:
    draw = np.random.default_rng(3)
    for rate in (1.0, 50.0, 200.0):
        grid = np.flatnonzero(draw.random(900) > 0.05) / rate  # one in twenty is lost
        assert rate_of(grid) == rate
        assert rate_of(grid + draw.uniform(-0.2, 0.2, len(grid)) / rate) == rate
        twice = grid[draw.random(len(grid)) < 0.05]  # and one in twenty comes twice
        again = np.sort(np.append(grid, twice + 0.03 / rate))
        assert rate_of(again) == rate
        assert rate_of(again + draw.uniform(-0.2, 0.2, len(again)) / rate) == rate
        walk = np.cumsum(draw.normal(1.0, 0.02, 500)) / rate  # each step is uncertain by itself
        assert rate_of(walk) == pytest.approx(rate, rel=5e-3)


def test_another_file_is_known_by_what_it_begins_with(
    tmp_path: Path, lines_file: Callable[..., LinesFile]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,a\n1,2\n2,3\n")
    (chunk,) = lines_file(path).chunks(Event())
    assert chunk.place is not None
    path.write_text("t,a\n7,2\n8,3\n9,3\n")
    source = lines_file(path)
    assert "another file" in source.go({"place": chunk.place})
    assert times(source.chunks(Event())) == [7, 8, 9]
    path.write_text("t,a\n1,2\n")
    assert "another file" in lines_file(path).go({"place": chunk.place})


def test_a_table_that_became_shorter_is_told(tmp_path: Path) -> None:
    path = str(tmp_path / "log.parquet")
    write_log(Log(np.arange(5.0), {"a": np.arange(5.0)}, {}, {}), path)
    assert "5 samples" in file_source(path, Form(path)).go({"place": {"row": 6}})
    source = file_source(path, Form(path))
    assert source.go({"place": {"row": 5}, "back": {"row": 3}}) == ""  # to its very end
    assert times(source.chunks(Event())) == [3.0, 4.0]


def test_a_last_line_without_an_end_counts_once(
    tmp_path: Path, lines_file: Callable[..., LinesFile]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,a\n1,2\n2,3")
    chunks = list(lines_file(path).chunks(Event()))
    assert times(iter(chunks)) == [1, 2]
    source = lines_file(path)
    assert chunks[-1].place is not None
    assert (
        source.go({"place": chunks[-1].place, "back": chunks[-1].place}) == ""
        and times(source.chunks(Event())) == []
    )


def test_a_missing_file_and_a_followed_table_are_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot be read"):
        file_source(str(tmp_path / "none.csv"), Form("x"))
    with pytest.raises(LogError, match="followed"):
        file_source(str(tmp_path / "none.parquet"), Form("x"), follow=True)


def test_a_growing_file_is_followed_through_cut_and_replacement(
    tmp_path: Path, lines_file: Callable[..., LinesFile]
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t,a\n1,2\n2,")
    stop = Event()
    chunks = lines_file(path, follow=True).chunks(stop)
    seen: list[float] = []
    told: list[str] = []

    def until(count: int) -> None:
        for chunk in chunks:
            if chunk.log is not None:
                seen.extend(chunk.log.time.tolist())
            told.extend(news.message for news in chunk.news)
            if len(seen) >= count:
                return

    until(1)
    with path.open("a") as file:  # the line goes on
        file.write("3\n3,4\n")
    until(3)
    path.write_text("t,a\n0,1\n")  # cut
    until(4)
    (tmp_path / "new.csv").write_text("t,a\n0.5,1\n")
    with path.open("a") as file:  # one more line in the last moment
        file.write("1,1\n")
    os.replace(tmp_path / "new.csv", path)
    until(6)
    stop.set()
    assert seen == [1, 2, 3, 0, 1, 0.5]
    assert ["was cut" in text for text in told] == [True, False]
    assert "was replaced" in told[1]
    assert times(chunks) == []


def test_a_pipe_gives_all_lines_and_ends() -> None:
    reading, writing = os.pipe()
    text = b"t,a\n" + b"".join(b"%d,%d\n" % (k, 2 * k) for k in range(20_000)) + b"20000,1"

    def write() -> None:
        with os.fdopen(writing, "wb") as file:
            file.write(text)

    thread = Thread(target=write)
    thread.start()
    source = Pipe(Form("x"), reading)
    assert times(source.chunks(Event())) == list(range(20_001))
    thread.join()
    os.close(reading)


def test_what_is_too_much_drops_the_oldest_and_is_told() -> None:
    intake = Intake(most=100)
    for k in range(50):
        intake.put(Block(b"%09d\n" % k))
    intake.say("gap", "gone")
    intake.put(Block(b"%09d\n" % 50))
    items = intake.take(0)
    assert items is not None
    lines = b"".join(item.lines for item in items if isinstance(item, Block))
    assert lines == b"".join(b"%09d\n" % k for k in range(41, 51))
    assert intake.dropped == 41
    assert items[-2] == News("gap", "gone")
    assert intake.take(0) == []


def test_a_sender_that_can_wait_waits() -> None:
    intake = Intake(most=95, waits=True)

    def send() -> None:
        for k in range(50):
            intake.put(Block(b"%09d\n" % k))
        intake.end()

    thread = Thread(target=send)
    thread.start()
    found: list[bytes] = []
    while (items := intake.take()) is not None:
        size = sum(len(item.lines) for item in items if isinstance(item, Block))
        assert size <= 100
        found += [item.lines for item in items if isinstance(item, Block)]
    thread.join()
    assert b"".join(found) == b"".join(b"%09d\n" % k for k in range(50))


def test_what_may_have_come_before_counts_once() -> None:
    intake, done = Intake(), []
    decoder = Decoder(Form("x", columns=("t", "a")))
    blocks = [
        (b"1,0\n2,0\n", False),
        (b"1,0\n2,0\n", True),
        (b"2,0\n3,0\n", True),
        (b"4,0\n", False),
    ]
    for k, (lines, again) in enumerate(blocks):
        intake.put(Block(lines, again=again, done=lambda k=k: done.append(k)))  # type: ignore[misc]
    intake.end()
    chunks = list(decoded(intake, decoder, Event(), last=0.0))
    assert times(iter(chunks)) == [1, 2, 3, 4]
    assert done == []
    for chunk in chunks:
        if chunk.done is not None:
            chunk.done()
    assert done == [0, 1, 2, 3]


def test_pieces_are_cut_into_lines_and_noise_without_end_is_forgotten() -> None:
    cutter = Cutter(whole=False)
    assert cutter.cut(b"half") is None
    assert cutter.cut(b" a line\nnext") == Block(b"half a line\n", whole=False)
    assert cutter.cut(b" one\n") == Block(b"next one\n")
    assert cutter.cut(b"x" * (1 << 20)) is None
    assert cutter.cut(b"x") is None
    assert cutter.rest == b""
    assert cutter.cut(b"x\n1,2\n") == Block(b"x\n1,2\n", whole=False)
