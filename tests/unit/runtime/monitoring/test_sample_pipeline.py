"""A monitor tells each thing once, in the order in which it is safe, and counts every sample once.

Source, journal, publisher, decision and the clock of the computer are stand-ins that take down what
is asked of them in one list; columns, the grid and the residuals are those of a tank.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.runtime.log import TIME, TIME_UNIT, Array, Log, LogError
from bondgraph.runtime.monitoring import sample_pipeline
from bondgraph.runtime.monitoring.clock import clock_of
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.journal import JournalError, Past
from bondgraph.runtime.monitoring.sample_pipeline import Monitor
from bondgraph.runtime.monitoring.snapshot import Snapshot
from bondgraph.runtime.monitoring.sources.sample_source import Chunk, News, Source
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.monitoring.watch_parts import Parts, Stop
from bondgraph.text.source import Source as Text

STEP = 0.01


@cache
def _compiled() -> Engine:
    text = "bg 1\nmodel M { param C = 2; 0:tank { <- Sf:q; -> C:C; -> De:p } }"
    return Compilation(Text("tank.bg", text), None, Options(1.0 / STEP, bandwidth=20.0)).engine()


def rows(first: int, count: int, columns: Sequence[str] = ("q", "p")) -> Log:
    time: Array = np.asarray(np.arange(first, first + count) * STEP, dtype=np.float64)
    return Log(time, {n: np.ones(count) for n in columns}, {}, {})


class Hour:
    """The clock of the computer: a second goes by with each chunk."""

    now = 100.0

    def monotonic(self) -> float:
        return self.now

    def time(self) -> float:
        return 5000.0 + self.now


class Bench(Source):
    """All that a monitor talks to; `told` is what it did, in order."""

    name = "bench"

    def __init__(self, chunks: Sequence[Chunk], past: Past | None = None) -> None:
        self.given, self.past, self.taken = chunks, past, 0
        self.told: list[tuple[str, Any]] = []
        self.said: list[tuple[int, Verdict]] = []
        self.script: dict[int, list[Verdict]] = {}  # verdicts by the number of the update
        self.updates = 0
        self.why = ""
        self.dropped_lines = 0
        self.hour = Hour()
        self.engine = _compiled().configured()
        self.last = self.engine.configured().run(np.zeros((0, 2)))

    # -- the source

    def chunks(self, stop: Any) -> Iterator[Chunk]:
        for chunk in self.given:
            if stop.is_set():
                return
            self.hour.now += 1.0
            yield chunk

    def go(self, position: dict[str, Any]) -> str:
        self.told.append(("go", position))
        return self.why

    @property
    def dropped(self) -> int:
        return self.dropped_lines

    def close(self) -> None:
        self.told.append(("closed", "source" if not self.taken else "publisher"))

    # -- the decision

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        self.last = batch
        self.told.append(("update", (round(time[0] / STEP), len(time))))
        self.updates += 1
        return self.script.get(self.updates, [])

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        self.told.append(("look", (round(time[0] / STEP), len(time))))

    def decided(self) -> Batch:
        return self.last

    def restart(self) -> None:
        self.told.append(("restart", None))

    def waits(self) -> dict[str, str]:
        return {}

    def state(self) -> dict[str, Any]:
        return {"updates": self.updates}

    def resume(self, state: dict[str, Any]) -> None:
        self.updates = state["updates"]

    # -- those who listen

    def hear(self, number: int, verdict: Verdict) -> None:
        self.told.append(("said", number))
        self.said.append((number, verdict))

    def events(self) -> list[str]:
        return [v.event for _, v in self.said]

    def of(self, what: str) -> list[Any]:
        return [w for name, w in self.told if name == what]

    def watched(self, stop: Stop | None = None, journal: bool = True, **more: Any) -> Monitor:
        self.clock = clock_of(self.engine)
        parts = Parts(
            self, self.columns, self.clock, self.engine, self, [self.hear],
            journal=Book(self) if journal else None, **more,  # type: ignore[arg-type]
        )  # fmt: skip
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sample_pipeline, "clocks", self.hour)
            monitor = Monitor(parts, "a tank")
            monitor.run(stop or Stop())
        return monitor

    def columns(self, log: Log) -> Array:
        missing = [k.path for k in self.engine.signals if k.path not in log.columns]
        if missing:
            raise LogError(self.name, None, f"no column for {missing[0]}")
        return np.column_stack([log.columns[k.path] for k in self.engine.signals])


class Book:
    """A journal that takes down in the list of the bench."""

    def __init__(self, bench: Bench) -> None:
        self.bench, self.past = bench, bench.past

    def write(
        self, position: dict[str, Any], state: dict[str, Any], said: list[tuple[int, Verdict]]
    ) -> None:
        self.bench.told.append(("written", (position, state, [n for n, _ in said])))

    def sent(self, number: int) -> None:
        self.bench.told.append(("sent", number))

    def close(self) -> None:
        self.bench.told.append(("closed", "journal"))


class Paper:
    """A publisher that has taken all but one line."""

    def __init__(self, bench: Bench, news: Sequence[str] = ()) -> None:
        self.bench, self.waiting, self.taken = bench, list(news), 0

    def publish(self, number: int, line: str) -> None:
        self.bench.told.append(("published", number))
        self.taken = number

    def present(self, text: str) -> None:
        self.bench.told.append(("present", text))

    def news(self) -> list[str]:
        found, self.waiting = self.waiting, []
        return found

    def close(self) -> int:
        return 1

    def check(self) -> None:
        self.bench.told.append(("checked", None))


def fault(time: float) -> Verdict:
    return Verdict("fault", time, time - 0.1, {"r1": 2.0}, message="it leaks")


# ------------------------------------------------------------------- a whole watch


def test_what_is_said_has_been_put_down_before_and_is_numbered() -> None:
    bench = Bench([Chunk(rows(0, 50)), Chunk(rows(50, 50)), Chunk(rows(100, 50))])
    bench.script = {2: [fault(0.7), Verdict("update", 0.9 + 1e-12)]}
    bench.watched()
    assert bench.events() == ["start", "fault", "update", "stop"]
    assert [n for n, _ in bench.said] == [1, 2, 3, 4] and bench.said[0][1].time == 0.0
    assert bench.said[2][1].time == 0.9  # to nine digits
    written: set[int] = set()
    for what, how in bench.told:
        if what == "written":
            assert how[2] == sorted(how[2]) and not written & set(how[2])
            written |= set(how[2])
        elif what == "said":
            assert how in written
    assert bench.of("closed") == ["source", "journal"]


def test_every_sample_is_counted_once_and_comes_to_the_decision_in_order() -> None:
    bench = Bench([Chunk(rows(0, 30)), Chunk(), Chunk(rows(30, 45))])
    monitor = bench.watched()
    assert monitor.account.samples["read"] == monitor.account.samples["used"] == 75
    place = 0
    for first, count in bench.of("update"):
        assert first == place
        place += count
    assert place == 75
    last = bench.said[-1][1]
    assert last.message.startswith("the samples end, after 75 samples; blind or warming up: r1")
    assert last.account is not None and last.account["samples"]["read"] == 75
    assert last.account["verdicts"] == {"start": 1, "stop": 1} == dict(monitor.account.verdicts)
    assert last.time == pytest.approx(0.74)


def test_an_observer_and_a_heartbeat_are_told_how_it_stands() -> None:
    bench, seen = Bench([Chunk(rows(20 * k, 20)) for k in range(6)]), list[Snapshot]()
    paper = Paper(bench)
    bench.watched(heartbeat=2.0, observe=seen.append, publisher=paper)
    assert [s.account["samples"]["read"] for s in seen] == [0, 20, 40, 60, 80, 100, 120]
    beats = [v for _, v in bench.said if v.event == "heartbeat"]
    assert [v.account and v.account["samples"]["read"] for v in beats] == [40, 80, 120]
    assert all(v.account is not None and v.account["age"] == 0.0 for v in beats)
    # a heartbeat has the number of what was said last: it is no line of the journal
    assert {n for n, v in bench.said if v.event == "heartbeat"} == {1}
    present = bench.of("present")
    assert len(present) == 1 + 3 + 1 and '"ended"' in present[-1] and '"watching"' in present[0]
    assert bench.of("checked") == [None] and bench.of("published") == [1, 2]
    assert max(bench.of("sent")) == 2  # of the last line too, once the publisher is closed


def test_a_broker_alone_is_told_of_the_beginning_and_of_the_end() -> None:
    bench = Bench([Chunk(rows(0, 20))])
    bench.watched(publisher=Paper(bench))
    first, last = bench.of("present")
    assert '"watching"' in first and "none has come yet" in first
    assert '"ended"' in last and "after 20 samples" in last


def test_while_the_machine_is_off_all_residuals_are_blind() -> None:
    """An alarm alone stays one, as nobody has seen that it has passed."""
    for script, state in ({}, "blind"), ({1: [fault(0.3)]}, "alarm"):
        bench, seen = Bench([Chunk(rows(0, 60)), Chunk(rows(60, 60))]), list[Snapshot]()
        bench.script = script
        bench.watched(
            observe=seen.append, operating=lambda log: np.full(log.rows, log.time[0] < 0.5)
        )
        assert seen[1].residuals["r1"][1] != "the machine is off"
        assert seen[-1].residuals["r1"] == (state, "the machine is off")


@pytest.mark.parametrize(("unit", "second"), [("us", 1e6), ("ms", 1e3)])
def test_a_clock_that_counts_in_32_bits_is_known_to_begin_anew(unit: str, second: float) -> None:
    noted: list[str] = []
    log = rows(0, 20)._replace(meta={TIME_UNIT: unit, TIME: "t_dev"})
    bench = Bench([Chunk(log), Chunk(log)])
    bench.watched(note=noted.append, journal=False)
    assert bench.clock.wraps == 2**32 / second
    assert noted == ["bench: time is t_dev"]  # once
    bench = Bench([Chunk(rows(0, 20))])
    bench.watched()
    assert bench.clock.wraps is None


def test_a_position_is_put_down_each_second_while_samples_come() -> None:
    """Not where none came: the journal of a silent machine does not grow."""
    bench = Bench([Chunk(rows(0, 20)), Chunk(), Chunk(), Chunk(rows(20, 20))])
    bench.watched()
    positions = [how[0]["samples"] for how in bench.of("written")]
    assert positions == [0, 20, 40, 40]  # start, two seconds with samples, stop


def test_the_place_to_go_back_to_is_the_newest_one_after_which_filters_are_warm() -> None:
    """Three warm-ups, and what the clock may hold back, before the newest sample."""
    chunks = [Chunk(rows(20 * k, 20), place={"at": 20 * k + 20}) for k in range(30)]
    bench = Bench(chunks)
    bench.replays = True
    bench.watched()
    engine = bench.engine
    far = (3.0 * engine.warm_up + clock_of(engine).most) / STEP
    known = 0
    for position, _, _ in bench.of("written"):
        if position["place"] is None:
            continue
        newest = round(position["time"] / STEP)
        ends = [20 * k + 19 for k in range(30) if 20 * k + 19 <= newest - far]
        assert position["back"] == ({"at": ends[-1] + 1} if ends else None)
        known += bool(ends)
    assert known > 3


def test_what_a_chunk_brought_is_safe_before_the_source_hears_so() -> None:
    bench = Bench([])
    bench.script = {1: [fault(0.1)]}
    bench.given = [Chunk(rows(0, 20), done=lambda: bench.told.append(("done", None)))]
    bench.watched()
    order = [what for what, how in bench.told if what == "done" or (what, how) == ("said", 2)]
    assert order == ["said", "done"]


# ------------------------------------------------------------------- what goes wrong


def test_news_of_the_line_and_of_the_publisher_are_told() -> None:
    bench = Bench([Chunk(rows(0, 20), news=(News("gap", "the line was cut"),))])
    bench.watched(publisher=Paper(bench, ["the broker was away"]))
    gaps = [v.message for _, v in bench.said if v.event == "gap"]
    assert gaps == ["the line was cut", "verdicts: the broker was away"]


def test_samples_that_no_column_fits_are_counted_once_others_have_come() -> None:
    bench = Bench([Chunk(rows(0, 20)), Chunk(rows(20, 7, ["q"])), Chunk(rows(27, 20))])
    monitor = bench.watched()
    assert monitor.account.samples["unmatched"] == 7
    assert monitor.account.samples["read"] == 47 and monitor.account.thrown == 7
    message = bench.said[-1][1].message
    assert "after 40 samples, 7 of them too late, twice, empty or without a column" in message


def test_a_watch_of_nothing_that_fits_ends_with_the_reason() -> None:
    bench = Bench([Chunk(rows(0, 20, ["q"]))])
    paper = Paper(bench)
    with pytest.raises(LogError, match="no column for p"):
        bench.watched(publisher=paper)
    assert "no column for p" in bench.of("present")[-1] and "stop" not in bench.events()
    assert bench.of("closed") == ["source", "journal"]
    with pytest.raises(LogError, match="no samples came"):
        Bench([Chunk()]).watched()


def test_a_watch_that_is_stopped_says_by_what() -> None:
    stop = Stop()
    stop.ask("a signal")
    bench = Bench([Chunk(rows(0, 20))])
    bench.watched(stop)  # no samples are no error then
    assert bench.said[-1][1].message.startswith("stopped by a signal, after 0 samples")


def test_lines_that_were_dropped_are_counted_by_what_is_new_of_them() -> None:
    bench = Bench([])

    def dropping() -> Iterator[Chunk]:
        for k, lines in enumerate((0, 3, 3, 5)):
            bench.dropped_lines = lines
            yield Chunk(rows(20 * k, 20))

    bench.given = dropping()  # type: ignore[assignment]
    lines = bench.watched().account.lines
    assert lines["overflow"] == 5 and lines["garbage"] == 0


def test_after_a_gap_engine_and_decision_begin_anew() -> None:
    bench = Bench([Chunk(rows(0, 100)), Chunk(rows(400, 100))])
    monitor = bench.watched()
    assert monitor.account.lines["gaps"] == 1 and monitor.account.lines["lost"] == 300
    told = [how for what, how in bench.told if what in ("update", "restart")]
    at = told.index(None)
    assert told.count(None) == 1 and sum(count for _, count in told[:at]) == 100
    assert told[at + 1][0] == 400


def test_a_sample_behind_a_gap_is_computed_though_it_is_the_last_one() -> None:
    """The clock holds the newest sample back until another one comes, or the end."""
    bench = Bench([Chunk(rows(0, 100)), Chunk(rows(400, 1))])
    bench.watched()
    seen = [how for what, how in bench.told if what == "update"]
    assert seen[-1] == (400, 1) and sum(count for _, count in seen) == 101


# ------------------------------------------------------------------- going on


def _past(bench: Callable[..., Bench], **changed: Any) -> Past:
    """What the journal of a watch knows that was killed with a fault latched."""
    one = bench([Chunk(rows(0, 60), place={"at": 60})])
    one.script = {1: [fault(0.3)]}
    one.watched()
    position, state, _ = one.of("written")[-1]
    said = tuple(one.said[:2])
    past = Past("bench", position, state, said, 1, 5090.0, 2, "")
    return past._replace(**changed)


def test_a_watch_goes_on_with_its_numbers_its_account_and_its_fault() -> None:
    past = _past(Bench)
    again = Chunk(rows(40, 20), place={"at": 60}, again=True)
    bench = Bench([again, Chunk(rows(60, 20), place={"at": 80})], past)
    bench.replays = True
    monitor = bench.watched(publisher=Paper(bench))
    assert bench.of("go") == [past.position]
    assert bench.events() == ["resumed", "stop"] and [n for n, _ in bench.said] == [3, 4]
    message = bench.said[0][1].message
    assert message.startswith("after 10 s away, bench goes on where the watch ended")
    assert "still latched: " in message and bench.said[0][1].time == pytest.approx(0.59)
    # samples of before are looked at, not decided on, and not counted again
    assert bench.of("look") and all(first >= 60 for first, _ in bench.of("update"))
    assert monitor.account.samples["read"] == 80 and monitor.states.latched
    assert bench.of("published") == [2, 3, 4]  # what the broker had not taken, first
    # a source that has no place to give yet is where it was
    assert bench.of("written")[0][0]["place"] == {"at": 60}


def test_a_fault_that_has_passed_is_not_latched_after_a_restart() -> None:
    past = _past(Bench)
    cleared = (*past.verdicts, (3, Verdict("cleared", 0.5)))
    bench = Bench([Chunk(rows(60, 20))], past._replace(verdicts=cleared, number=3))
    bench.replays = True
    monitor = bench.watched()
    assert bench.said[0][0] == 4 and "no fault is known" in bench.said[0][1].message
    assert not monitor.states.latched


def test_a_source_that_cannot_go_back_says_what_was_missed() -> None:
    """0.59 s was the newest sample, 1.00 s comes next: 40 samples of 0.01 s are between them."""
    bench = Bench([Chunk(rows(100, 20))], _past(Bench))
    bench.watched()
    assert "at most 0.410 s of the stream are missed (40 samples)" in bench.said[0][1].message
    bench = Bench([Chunk(rows(60, 20))], _past(Bench))
    bench.watched()
    assert "at most 0.010 s of the stream are missed (0 samples)" in bench.said[0][1].message
    bench = Bench([Chunk(rows(10, 20))], _past(Bench))
    bench.watched()
    assert "begins anew at 0.100 s, what was missed is unknown" in bench.said[0][1].message
    bench = Bench([], _past(Bench))
    bench.watched()
    assert "no sample came" in bench.said[0][1].message
    assert bench.events() == ["resumed", "stop"]


def test_another_source_or_one_that_has_changed_begins_from_its_start() -> None:
    for why, source, reason in (
        ("", "other", "the source was other"),
        ("it shrank", "bench", "it shrank"),
    ):
        bench = Bench([Chunk(rows(0, 20))], _past(Bench, source=source))
        bench.replays, bench.why = True, why
        bench.watched()
        assert f"from the start of bench: {reason}" in bench.said[0][1].message
        assert bench.told.index(("restart", None)) < bench.told.index(("said", 3))


def test_a_journal_of_another_version_is_refused() -> None:
    with pytest.raises(JournalError, match="another version"):
        Bench([], _past(Bench, state={"what": 1})).watched()


def test_damage_of_the_journal_is_noted_and_told() -> None:
    noted: list[str] = []
    bench = Bench([Chunk(rows(60, 20))], _past(Bench, damage="a line was lost"))
    bench.replays = True
    bench.watched(note=noted.append)
    assert noted == ["a line was lost"] and "; a line was lost" in bench.said[0][1].message
