"""The campaign as a command: `python -m tests.robots.run --healthy 100 --seeds 20 --jobs 2`."""

from __future__ import annotations

import argparse
import statistics
import sys
from concurrent.futures import ProcessPoolExecutor
from typing import Any

from scipy.stats import chi2

from tests.robots import campaign
from tests.robots.campaign import KINDS, ONSET, Kind, Seen

_TUNED_ON = 900_000  # the first seed of the robots that only tune


def _one(job: tuple[int, float, Kind | None, float, Any]) -> Seen:
    seed, duration, kind, size, tuning = job
    faults = () if kind is None else (campaign.fault(kind, size),)
    said = campaign.watched(campaign.errands(seed, duration, *faults), tuning)
    return campaign.seen(said, None if kind is None else ONSET)


def main() -> None:
    """Tune, watch the healthy, then the faulty; print what came out."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--healthy", type=int, default=100)
    parser.add_argument("--minutes", type=float, default=1.0, help="of each healthy robot")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--tuning", type=int, default=10, help="robots to tune on")
    parser.add_argument("--alarms", type=float, default=2.0, help="false alarms wanted an hour")
    parser.add_argument("--share", type=float, default=0.3, help="size of invisible faults")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    seeds = range(_TUNED_ON, _TUNED_ON + args.tuning)
    tuned = campaign.tuned(seeds, 30.0, args.alarms)
    tuning = tuned.tuning
    sizes = {(s.hypothesis.fault, s.hypothesis.kind): s for s in tuned.shown}
    print(f"tuned on {args.tuning} robots, {tuning.seconds:.0f} s, for {args.alarms:g} false alarms"
          f" an hour, filter {tuning.bandwidth:g} rad/s")  # fmt: skip
    groups = {f: g for g in campaign.robot().facts.groups for f in g}
    with ProcessPoolExecutor(args.jobs) as pool:
        healthy = [(k, 60.0 * args.minutes, None, 0.0, tuning) for k in range(args.healthy)]
        found = list(pool.map(_one, healthy))
        alarms, named = sum(s.alarms for s in found), sum(bool(s.named) for s in found)
        hours = args.healthy * args.minutes / 60.0
        bound = chi2.ppf(0.95, 2 * (alarms + 1)) / 2 / hours
        print(f"healthy: {args.healthy} robots, {hours:.2f} h: {alarms} false alarms"
              f" ({alarms / hours:.2f} an hour, below {bound:.2f} with 95 % confidence),"
              f" {named} false names")  # fmt: skip
        sys.stdout.flush()
        for factor in (3.0, args.share):
            print(f"\nfaults of {factor:g} times the smallest size that is sure to show")
            for kind in KINDS:
                shown = sizes[kind.target, kind.hypothesis]
                if shown.size is None:
                    print(f"  {kind.name:<30} cannot be seen")
                    continue
                size = factor * shown.size
                jobs = [(10_000 + k, 25.0, kind, size, tuning) for k in range(args.seeds)]
                runs = list(pool.map(_one, jobs))
                delays = [s.delay for s in runs if s.delay is not None]
                right = sum(s.last == groups[kind.target] for s in runs)
                wrong = sum(bool(s.last) and s.last != groups[kind.target] for s in runs)
                ever = sum(any(g != groups[kind.target] for g in s.named) for s in runs)
                best = sum(s.best == kind.target for s in runs)
                early = sum(s.alarms for s in runs)
                delay = f"{statistics.median(delays):.2f} s" if delays else "-"
                print(f"  {kind.name:<30} {size:9.3g} {shown.hypothesis.unit:<11}"
                      f" detected {len(delays):>2}/{len(runs)}  delay {delay:>7}"
                      f"  right {right:>2}  wrong {wrong:>2}  ever wrong {ever:>2}"
                      f"  itself {best:>2}  false before {early}")  # fmt: skip
                sys.stdout.flush()


if __name__ == "__main__":
    main()
