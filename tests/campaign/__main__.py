"""Six machines watched without a tuning: false alarms, missed faults, wrong names.

    python -m tests.campaign healthy --hours 10 [--write]
    python -m tests.campaign faulty --seeds 20 [--times 1.5] [--write]
    python -m tests.campaign double --seeds 5 [--write]
    python -m tests.campaign board --seeds 2 [--write]

Healthy machines are watched for ten minutes each, without what the watch learns from first. Faults
are of three times the smallest size that `tune` tells of other machines; the table of these sizes
comes first, so that they are known before the run. With `--write` a table goes into
`docs/campaign.md`. Seeds of the machines that limits and sizes come from are 1 to 3, of those that
are reported from `--start` on.
"""

from __future__ import annotations

import argparse
import json
import math
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import NamedTuple

import numpy as np

from tests.campaign.calibration import Stated, draw, stated, table
from tests.campaign.double import double
from tests.campaign.faults import TIMES, Kind, kinds, lasting, span
from tests.campaign.machines import MACHINES, Machine, compiled, run
from tests.campaign.on_board import on_board
from tests.campaign.watched import watched
from tests.measured import ROOT, write

PAGE = ROOT / "docs" / "campaign.md"
MINUTES = 10.0  # of a healthy run
START = 5000  # first of the seeds that are reported


class Heard(NamedTuple):
    """Of one run: false alarms, delay (s, None if not seen), the last class, whether it was wrong.

    `ever` says whether a wrong class was named at any time; `said` is what the last verdict with
    candidates says of each class.
    """

    false: int
    watched: float
    delay: float | None
    named: str
    ever: bool
    names: int
    said: tuple[Stated, ...]


def _run(task: tuple[str, int, Kind | None]) -> Heard:
    name, seed, kind = task
    machine = next(m for m in MACHINES if m.name == name)
    if kind is None:
        said, seconds = watched(machine, run(machine, seed, 60.0 * MINUTES))
        alarms = [v for v in said if v.event == "fault"]
        names = sum(bool(v.group) for v in said)
        return Heard(len(alarms), seconds, None, "", bool(names), names, ())
    duration, onset = span(machine)
    said, seconds = watched(machine, run(machine, seed, duration, (lasting(machine, kind),)))
    fired = [v.time for v in said if v.event == "fault"]
    true = [t - onset for t in fired if t >= onset]
    told = [v for v in said if v.event == "update" and v.time >= onset]
    named = [v for v in told if v.group]
    last = told[-1] if told else None
    what = ""
    if last is not None:
        wrong = "pair" if last.pairs else "none"
        what = ("right" if kind.of in last.group else "wrong") if last.group else wrong
    groups = compiled(machine).diagnosis_model.groups
    single = next((v for v in reversed(told) if v.candidates and not v.pairs), None)
    probable = tuple(stated(single, groups, kind.of)) if single else ()
    return Heard(
        len(fired) - len(true), seconds, true[0] if true else None, what,
        any(kind.of not in v.group for v in named), len(named), probable,
    )  # fmt: skip


def _all(tasks: Sequence[tuple[str, int, Kind | None]], jobs: int) -> list[Heard]:
    if jobs == 1:
        return [_run(task) for task in tasks]
    with ProcessPoolExecutor(jobs) as pool:
        return list(pool.map(_run, tasks))


def healthy(machines: Sequence[Machine], hours: float, start: int, jobs: int) -> str:
    """A table of false alarms."""
    lines = [
        "| machine | rate | watched | false alarms | an hour | 95 % confidence | false names |",
        "|---|---|---|---|---|---|---|",
    ]
    for machine in machines:
        runs = math.ceil(60.0 * hours / MINUTES)
        heard = _all([(machine.name, start + k, None) for k in range(runs)], jobs)
        time = sum(h.watched for h in heard) / 3600.0
        alarms = sum(h.false for h in heard)
        lines.append(
            f"| {machine.name} | {machine.rate:g} Hz | {time:.2f} h | {alarms} |"
            f" {alarms / time:.2f} | below {_bound(alarms) / time:.2f} |"
            f" {sum(h.names for h in heard)} |"
        )
        print(lines[-1], file=sys.stderr, flush=True)
    return "\n".join(lines)


def _bound(count: int) -> float:
    """The mean of a Poisson number that is this small once in twenty times."""
    from scipy.special import gammaincinv

    return float(gammaincinv(count + 1, 0.95))


def faulty(
    machines: Sequence[Machine], seeds: int, start: int, jobs: int, times: float
) -> tuple[str, list[Stated]]:
    """A table of what was seen and named of each fault, and all that was said of classes."""
    lines = [
        "| machine | fault | seen | delay | right class at the end | wrong | wrong at times | two"
        " or none named | false before |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    said: list[Stated] = []
    for machine in machines:
        for kind in kinds(machine, times):
            heard = _all([(machine.name, start + k, kind) for k in range(seeds)], jobs)
            delays = [h.delay for h in heard if h.delay is not None]
            count = [sum(h.named == x for h in heard) for x in ("right", "wrong")]
            rest = sum(h.named in ("pair", "none") for h in heard)
            said += [one for h in heard for one in h.said]
            delay = f"{float(np.median(delays)):.2f} s" if delays else ""
            lines.append(
                f"| {machine.name} | {kind.words} | {len(delays)}/{seeds} | {delay} |"
                f" {count[0]} | {count[1]} | {sum(h.ever for h in heard)} | {rest} |"
                f" {sum(h.false for h in heard)} |"
            )
            print(lines[-1], file=sys.stderr, flush=True)
    return "\n".join([*lines, "", *table(said)]), said


def main(words: Sequence[str]) -> int:
    """The command."""
    parser = argparse.ArgumentParser(prog="python -m tests.campaign")
    parser.add_argument("what", choices=("healthy", "faulty", "double", "board", "sizes"))
    parser.add_argument("--hours", type=float, default=10.0, help="of each healthy machine")
    parser.add_argument("--seeds", type=int, default=20, help="of each fault")
    parser.add_argument("--times", type=float, default=TIMES, help="smallest size of faults")
    parser.add_argument("--start", type=int, default=START, help="first seed")
    parser.add_argument("--only", action="append", default=[], help="machines, by name")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--qemu", action="store_true", help="board: on a Cortex-M4F in qemu")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args(words)
    chosen = [m for m in MACHINES if not args.only or m.name in args.only]
    if args.what == "sizes":
        for machine in chosen:
            print(json.dumps({machine.name: [k.words for k in kinds(machine, args.times)]}))
        return 0
    own = [f"--only '{name}'" for name in args.only]
    own += [] if args.start == START else [f"--start {args.start}"]
    if args.what == "healthy":
        text = healthy(chosen, args.hours, args.start, args.jobs)
        own = [f"--hours {args.hours:g}", *own]
    elif args.what == "double":
        text = double(chosen, args.seeds, args.start, args.jobs)
        own = [f"--seeds {args.seeds}", *own]
    elif args.what == "board":
        text = on_board(chosen, args.seeds, args.start, args.jobs, args.qemu)
        own = [f"--seeds {args.seeds}", *own, *(["--qemu"] if args.qemu else [])]
    else:
        text, said = faulty(chosen, args.seeds, args.start, args.jobs, args.times)
        size = [] if args.times == TIMES else [f"--times {args.times:g}"]
        own = [f"--seeds {args.seeds}", *size, *own]
        if args.write:
            draw(said, PAGE.parent / "pictures" / f"calibration_{args.times:g}.svg")
    command = " ".join(["python -m tests.campaign", args.what, *own])
    if args.write:
        write(PAGE, command, text)
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
