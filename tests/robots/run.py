"""The campaign as a command: `python -m tests.robots.run --healthy 100 --seeds 20 --jobs 2`.

Its parts can be run by themselves (`--only below`). `--write` puts each table into docs/robots.md,
where the command of the part stands.
"""

from __future__ import annotations

import argparse
import statistics
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any, NamedTuple

from scipy.stats import chi2

from bondgraph.runtime.diagnosis.calibration import Tuned
from bondgraph.runtime.diagnosis.shown_sizes import Shown
from tests import measured
from tests.robots import campaign
from tests.robots.campaign import BUILT, ENCODERS, KINDS, ONSET, Kind, Robot, Seen

PAGE = Path(__file__).parents[2] / "docs" / "robots.md"

_FAULTY = 10_000  # from the first healthy seed to the first one of those with a fault
_TUNED_ON = 900_000  # and to the first one of the robots that only tune

#: The parts of the campaign, each with the options that matter to it.
PARTS = {
    "healthy": "healthy minutes",
    "faulty": "seeds kinds",
    "below": "share seeds kinds",
    "built": "healthy minutes",
    "built-same": "seeds kinds",
    "built-own": "seeds kinds",
}
_ALWAYS = "start tuning seconds alarms"

_DURATION = 18.0  # s, of a faulty one


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


def parsed(words: Sequence[str] | None = None) -> argparse.Namespace:
    """The options of the command line, or of these words."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--start", type=int, default=0, help="the first seed")
    parser.add_argument("--healthy", type=int, default=100)
    parser.add_argument("--minutes", type=float, default=2.0, help="of each healthy robot")
    parser.add_argument("--seeds", type=int, default=20, help="robots for each fault")
    parser.add_argument("--kinds", default="all", help="numbers of faults: 0,6")
    parser.add_argument("--tuning", type=int, default=10, help="robots to tune on")
    parser.add_argument("--seconds", type=float, default=30.0, help="of each of these")
    parser.add_argument("--alarms", type=float, default=2.0, help="false alarms wanted an hour")
    parser.add_argument("--share", type=float, default=0.3, help="size of invisible faults")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", choices=PARTS)
    parser.add_argument("--write", action="store_true", help="put the tables into their page")
    return parser.parse_args(words)


def command(part: str, options: argparse.Namespace) -> str:
    """What has to be typed for a part alone, as far as it is not what is meant without."""
    usual, words = parsed([]), ["python -m tests.robots.run", f"--only {part}"]
    for name in f"{PARTS[part]} {_ALWAYS}".split():
        value = getattr(options, name)
        if value != getattr(usual, name) or name in ("healthy", "seeds"):
            words.append(f"--{name} {value:g}" if isinstance(value, float) else f"--{name} {value}")
    return " ".join(words)


def main() -> None:
    """Run the parts, print what came out as Markdown, and write it into the page."""
    options = parsed()
    for part in PARTS if options.only is None else [options.only]:
        text = ran(part, options)
        print(f"\n{command(part, options)}\n\n{text}", flush=True)
        if options.write:
            measured.write(PAGE, command(part, options), text)


def ran(part: str, options: argparse.Namespace) -> str:
    """Tune, and send the robots of a part through the monitor."""
    first = options.start + _TUNED_ON
    seeds = range(first, first + options.tuning)
    robot = BUILT if part.startswith("built") else ENCODERS
    own = campaign.tuned(seeds, options.seconds, options.alarms, robot)
    with ProcessPoolExecutor(options.jobs) as pool:
        if part in ("healthy", "built"):
            return _healthy(pool, robot, own, options)
        sized, factor = own, options.share if part == "below" else 3.0
        if part == "built-same":  # the sizes that two encoders a drive show
            sized = campaign.tuned(seeds, options.seconds, options.alarms)
        return _faulty(pool, robot, sized, own, factor, options)


def _healthy(
    pool: ProcessPoolExecutor, robot: Robot, tuned: Tuned, options: argparse.Namespace
) -> str:
    duration = 60.0 * options.minutes
    seeds = range(options.start, options.start + options.healthy)
    found = list(pool.map(_one, [_Run(robot, k, duration, None, 0.0, tuned.tuning) for k in seeds]))
    alarms, named = sum(s.alarms for s in found), sum(bool(s.named) for s in found)
    hours = options.healthy * options.minutes / 60.0
    bound = chi2.ppf(0.95, 2 * (alarms + 1)) / 2 / hours
    return "\n".join([
        "| robots | tuned on | filter | watched | false alarms | an hour | with 95 % confidence"
        " | false names |",
        "|---|---|---|---|---|---|---|---|",
        f"| {options.healthy} | {options.tuning}, {tuned.tuning.seconds:.0f} s"
        f" | {tuned.tuning.bandwidth:g} rad/s | {hours:.2f} h | {alarms}"
        f" | {alarms / hours:.2f} | below {bound:.2f} | {named} |",
    ])  # fmt: skip


def _faulty(
    pool: ProcessPoolExecutor, robot: Robot, sized: Tuned, tuned: Tuned, factor: float,
    options: argparse.Namespace,
) -> str:  # fmt: skip
    """A row for each kind; sizes are those of `sized`, the limits those of `tuned`."""
    sizes = {(s.hypothesis.fault, s.hypothesis.kind): s for s in sized.shown}
    groups = {f: g for g in campaign.compiled(robot.model).diagnosis_model.groups for f in g}
    rows = ["| fault | size | detected | delay | right class | until named | wrong at the end"
            " | wrong at times | itself first | false before |",
            "|---|---|---|---|---|---|---|---|---|---|"]  # fmt: skip
    first = options.start + _FAULTY
    wanted = [*range(len(KINDS))] if options.kinds == "all" else options.kinds.split(",")
    for kind in (KINDS[int(k)] for k in wanted):
        shown = sizes.get((kind.target, kind.hypothesis))
        if shown is None or shown.size is None:
            rows.append(f"| {kind.name} | cannot be seen |" + " |" * 8)
            continue
        size = factor * shown.size
        if kind.op == "*=" and size >= 1.0:
            rows.append(f"| {kind.name} | {size:.3g}: there is no such fault |" + " |" * 8)
            continue
        seeds = range(first, first + options.seeds)
        runs = [_Run(robot, k, _DURATION, kind, size, tuned.tuning) for k in seeds]
        rows.append(
            _row(kind, size, shown, groups.get(kind.target, ()), list(pool.map(_one, runs)))
        )
    return "\n".join(rows)


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
