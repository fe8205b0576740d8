"""The campaign as a command: `python -m tests.robots.run --healthy 100 --seeds 20 --jobs 2`."""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Any, NamedTuple

from scipy.stats import chi2

from bondgraph.runtime.diagnosis.tune import Shown, Tuned
from tests.robots import campaign
from tests.robots.campaign import BUILT, ENCODERS, KINDS, ONSET, Kind, Robot, Seen

_TUNED_ON = 900_000  # the first seed of the robots that only tune
_FAULTY = 10_000  # the first seed of those with a fault
_DURATION = 18.0  # s, of a faulty one

say = partial(print, flush=True)


class _Run(NamedTuple):
    robot: Robot
    seed: int
    duration: float
    kind: Kind | None
    size: float
    tuning: Any


def _one(run: _Run) -> Seen:
    faults = () if run.kind is None else (campaign.fault(run.kind, run.size),)
    scenario = campaign.errands(run.seed, run.duration, *faults, robot=run.robot)
    said = campaign.watched(scenario, run.tuning, run.robot)
    return campaign.seen(said, None if run.kind is None else ONSET)


def main() -> None:
    """Tune, watch the healthy, then the faulty; print what came out, as Markdown."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--healthy", type=int, default=100)
    parser.add_argument("--minutes", type=float, default=2.0, help="of each healthy robot")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--tuning", type=int, default=10, help="robots to tune on")
    parser.add_argument("--alarms", type=float, default=2.0, help="false alarms wanted an hour")
    parser.add_argument("--share", type=float, default=0.3, help="size of invisible faults")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", choices=["healthy", "faulty", "below", "built"])
    args = parser.parse_args()
    seeds = range(_TUNED_ON, _TUNED_ON + args.tuning)
    fine = campaign.tuned(seeds, 30.0, args.alarms)
    with ProcessPoolExecutor(args.jobs) as pool:
        if args.only in (None, "healthy"):
            _healthy(pool, ENCODERS, fine, args)
        if args.only in (None, "faulty"):
            say("\n### Faults of 3 times the smallest size\n")
            _faulty(pool, ENCODERS, fine, fine, 3.0, args.seeds)
        if args.only in (None, "below"):
            say(f"\n### Faults of {args.share:g} times the smallest size\n")
            _faulty(pool, ENCODERS, fine, fine, args.share, args.seeds)
        if args.only in (None, "built"):
            coarse = campaign.tuned(seeds, 30.0, args.alarms, BUILT)
            _healthy(pool, BUILT, coarse, args)
            say("\n### The same faults as above, of 3 times what two encoders a drive show\n")
            _faulty(pool, BUILT, fine, coarse, 3.0, args.seeds)
            say("\n### Faults of 3 times the smallest size of the robot as built\n")
            _faulty(pool, BUILT, coarse, coarse, 3.0, args.seeds)


def _healthy(
    pool: ProcessPoolExecutor, robot: Robot, tuned: Tuned, args: argparse.Namespace
) -> None:
    say(f"\n## The robot with {robot.name}" if robot.load else f"\n## The robot {robot.name}")
    say(f"\nTuned on {args.tuning} robots, {tuned.tuning.seconds:.0f} s in all, for {args.alarms:g}"
        f" false alarms an hour; filter {tuned.tuning.bandwidth:g} rad/s.\n")  # fmt: skip
    runs = [
        _Run(robot, k, 60.0 * args.minutes, None, 0.0, tuned.tuning) for k in range(args.healthy)
    ]
    found = list(pool.map(_one, runs))
    alarms, named = sum(s.alarms for s in found), sum(bool(s.named) for s in found)
    hours = args.healthy * args.minutes / 60.0
    bound = chi2.ppf(0.95, 2 * (alarms + 1)) / 2 / hours
    say(f"Healthy: {args.healthy} robots, {hours:.2f} h: {alarms} false alarms,"
        f" {alarms / hours:.2f} an hour, below {bound:.2f} with 95 % confidence;"
        f" {named} false names.")  # fmt: skip


def _faulty(
    pool: ProcessPoolExecutor, robot: Robot, sized: Tuned, tuned: Tuned, factor: float, seeds: int
) -> None:
    """A row for each kind; sizes are those of `sized`, the limits those of `tuned`."""
    sizes = {(s.hypothesis.fault, s.hypothesis.kind): s for s in sized.shown}
    groups = {f: g for g in campaign.compiled(robot.model).facts.groups for f in g}
    say("| fault | size | detected | delay | right class | until named | wrong at the end"
        " | wrong at times | itself first | false before |")  # fmt: skip
    say("|---|---|---|---|---|---|---|---|---|---|")
    for kind in KINDS:
        shown = sizes.get((kind.target, kind.hypothesis))
        if shown is None or shown.size is None:
            say(f"| {kind.name} | cannot be seen |" + " |" * 8)
            continue
        size = factor * shown.size
        if kind.op == "*=" and size >= 1.0:
            say(f"| {kind.name} | {size:.3g}: there is no such fault |" + " |" * 8)
            continue
        runs = [_Run(robot, _FAULTY + k, _DURATION, kind, size, tuned.tuning) for k in range(seeds)]
        say(_row(kind, size, shown, groups.get(kind.target, ()), list(pool.map(_one, runs))))


def _row(
    kind: Kind, size: float, shown: Shown, group: tuple[str, ...], found: Sequence[Seen]
) -> str:
    cells = [
        kind.name,
        f"{size:.3g} {shown.hypothesis.unit}".strip(),
        f"{sum(s.delay is not None for s in found)}/{len(found)}",
        _median([s.delay for s in found]),
        str(sum(bool(group) and s.last == group for s in found)),
        _median([s.naming for s in found if s.last == group]),
        str(sum(bool(s.last) and s.last != group for s in found)),
        str(sum(any(g != group for g in s.named) for s in found)),
        str(sum(s.best == kind.target for s in found)),
        str(sum(s.alarms for s in found)),
    ]
    return f"| {' | '.join(cells)} |"


def _median(times: Sequence[float | None]) -> str:
    known = [t for t in times if t is not None]
    return f"{statistics.median(known):.2f} s" if known else "-"


if __name__ == "__main__":
    main()
