"""Episodes of kills, and what has to be so at the end of each."""

from __future__ import annotations

import json
import time
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from bondgraph.cli.main import main
from bondgraph.runtime.log_file import write_log
from bondgraph.runtime.monitoring.journal_records import read_records
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.kills.sources import FEEDERS, Feeder
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, Nursery, Watch

_KILLS = 8  # in an episode
_LONGEST = 0.4  # s that a monitor watches
_EARLY = 0.01  # of the kills, each hundredth of a second until it says something
_WAITED = 3.0  # s for what a monitor says first


class Episode(NamedTuple):
    """What came of one: kills, verdicts in the journal, what was printed and what published.

    `unsaid` are verdicts that were put down and not printed any more, `twice` those that the
    broker got more than once.
    """

    kills: int
    verdicts: int
    unsaid: int
    twice: int
    wrong: tuple[str, ...]


def tuned(folder: Path) -> Path:
    """Limits of the motor, so that each watch begins with the same ones."""
    write_log(motor.log(20.0, 1.0), folder / "healthy.csv")
    found = folder / "tuning.json"
    assert main(["tune", MOTOR, str(folder / "healthy.csv"), "-o", str(found)]) == 0
    return found


def episode(
    kind: str, folder: Path, tuning: Path, nursery: Nursery, draw: Random, kills: int = _KILLS
) -> Episode:
    """Kill monitors of one kind of source, each at a random moment, and let the last one end."""
    feeder = FEEDERS[kind](folder, motor.log(FEEDERS[kind].seconds))
    started: list[Watch] = []
    try:
        return _episode(feeder, folder, tuning, nursery, draw, kills, started)
    except AssertionError as error:  # something was waited for in vain
        said = [v for one in started for v in one.said]
        return Episode(kills, 0, 0, 0, (f"{error}: {said[-3:]} {started[-1].errors}",))
    finally:
        for one in started:
            one.kill()
        feeder.close()


def _episode(
    feeder: Feeder, folder: Path, tuning: Path, nursery: Nursery, draw: Random, kills: int,
    started: list[Watch],
) -> Episode:  # fmt: skip
    journal = folder / "journal"
    words = ["--journal", str(journal), "--tuning", str(tuning)]
    wrong: list[str] = []
    said: list[dict[str, Any]] = []

    def start(*more: str) -> Watch:
        given = [*feeder.words, *words, *more]
        started.append(Watch(nursery, *given, environment=feeder.environment))
        return started[-1]

    for k in range(kills):
        one = start()
        if k == 0:
            one.heard("start")
            feeder.begin(one)
        else:
            feeder.attach(one)
        end = time.monotonic() + _WAITED
        while draw.random() > _EARLY and not one.said and time.monotonic() < end:
            time.sleep(0.01)
        time.sleep(draw.uniform(0.0, _LONGEST))
        one.kill()
        said += one.said
        wrong += one.torn
    last = start("--heartbeat", "0.1")
    feeder.attach(last)
    status = feeder.finish(last)
    said += [v for v in last.said if v["event"] != "heartbeat"]
    wrong += last.torn
    if status != 0 and status is not None:
        wrong.append(f"the last watch ended with {status}: {last.errors}")
    return _judged(feeder, journal.read_bytes(), said, wrong, kills)


def _judged(
    feeder: Feeder, journal: bytes, said: list[dict[str, Any]], wrong: list[str], kills: int
) -> Episode:
    found = read_records(journal)
    records = [json.loads(line) for line in journal.splitlines()]
    kept = {v["number"]: v for r in records for v in r.get("verdicts", ())}
    numbers = [n for n, _ in found.verdicts]
    if found.damage or numbers != list(range(1, len(numbers) + 1)):
        wrong.append(f"the journal has {found.damage}, verdicts {numbers}")
    printed = [v["number"] for v in said]
    if printed != sorted(set(printed)):
        wrong.append(f"printed twice or out of order: {printed}")
    wrong += [f"printed and not in the journal: {v}" for v in said if kept.get(v["number"]) != v]
    events = [v.event for _, v in found.verdicts]
    rest = [e for e in events if e not in ("resumed", "gap", "late", "invalid", "heartbeat")]
    if events.count("fault") != 1 or "cleared" in events:
        wrong.append(f"not one fault: {events}")
    named = [v for _, v in found.verdicts if v.event == "update"]
    if not any(_meant(v) for v in named):
        wrong.append(f"the fault is not named: {named}")
    account = kept[numbers[-1]].get("account") if numbers else None
    if account is None or sum(account["verdicts"].values()) != len(numbers):
        wrong.append(f"the account does not add up: {account}, {len(numbers)} verdicts")
    elif account["samples"]["read"] != sum(account["samples"].values()) / 2:
        wrong.append(f"the account does not add up: {account}")
    files = not hasattr(feeder, "machine")
    if feeder.keeps and files and account is not None:
        while rest[-2:] == ["stop", "stop"]:  # one that had ended was started again
            rest.pop()
        if rest != ["start", "warm-up", "fault", "update", "stop"]:
            wrong.append(f"other verdicts than those of a watch that nobody kills: {rest}")
        if account["samples"]["read"] != motor.log(feeder.seconds).rows:
            wrong.append(f"samples lost or counted twice: {account['samples']}")
    twice = 0 if files else _published(feeder, kept, wrong)
    return Episode(kills, len(numbers), len(kept) - len(printed), twice, tuple(wrong))


def _meant(verdict: Verdict) -> bool:
    """Whether it can be the friction, alone or with another fault."""
    pairs = [fault for pair in verdict.pairs for fault in pair.faults]
    return "f" in (*verdict.group, *(c.fault for c in verdict.candidates), *pairs)


def _published(feeder: Any, kept: dict[int, Any], wrong: list[str]) -> int:
    """What the broker got: all verdicts, in their order, and of each number the same one."""
    end = time.monotonic() + 5.0
    while set(feeder.machine.numbers()) != set(kept) and time.monotonic() < end:
        time.sleep(0.01)
    got = list(feeder.machine.verdicts)
    if feeder.machine.numbers() != sorted(kept):
        wrong.append(f"published {feeder.machine.numbers()} of {sorted(kept)}")
    wrong += [f"published otherwise: {v}" for v in got if kept.get(v["number"]) != v]
    return len(got) - len({v["number"] for v in got})
