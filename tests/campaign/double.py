"""Two faults at once: what the watch says of those that cannot be taken for a single one.

Which these are is found without the diagnosis, in two ways that both have to say so. The virtual
machine runs with both faults, with each fault of the model alone, and healthy, all with the same
seed, so that noise is the same; of the residuals, that of the healthy run taken off, the part is
taken that no size of a single fault explains, in deviations of the noise: it has to be FAR of them
for each. And a pair is told from a single fault of any course in time by rank, or it is not: then
the verdict has to name that it may be two.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from itertools import combinations
from typing import NamedTuple

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.tuning import bandwidth_for
from bondgraph.runtime.log import Array
from tests.campaign.faults import Kind, every_kind, kinds, lasting, span
from tests.campaign.machines import MACHINES, Machine, compiled, run
from tests.campaign.watched import watched

FAR = 10.0
PAIRS = 10  # a machine
_SEED = 1  # of the run that tells pairs from single faults


class Named(NamedTuple):
    """What the last verdict about two faults names: `single`, `pair`, `none`, or nothing at all.

    Of a `single` fault that may be two, `also` says so.
    """

    what: str
    right: bool  # whether one of both is in the class, or both are in the first pair
    also: bool = False


def _machine(name: str) -> Machine:
    return next(m for m in MACHINES if m.name == name)


@cache
def _effect(machine: Machine, faults: tuple[Kind, ...]) -> Array:
    """The residuals in rows behind the onset, (rows, residuals), NaN where not valid."""
    duration, onset = span(machine)
    samples = run(machine, _SEED, duration, tuple(lasting(machine, k) for k in faults))
    engine = compiled(machine).engine()
    engine = engine.configured(bandwidth=bandwidth_for(machine.rate, len(samples)))
    batch = engine.run(samples)
    rows = slice(round(onset * machine.rate), None, rows_apart(engine))
    return np.asarray(np.where(batch.valid, batch.value, np.nan)[rows])


def apart(machine: Machine, pair: tuple[Kind, Kind]) -> float:
    """How many deviations of the noise the pair is from the nearest single fault."""
    healthy = _effect(machine, ())
    noise = np.nanstd(healthy, axis=0)
    both = (_effect(machine, pair) - healthy) / noise
    nearest = math.inf
    for kind in every_kind(machine):
        own = (_effect(machine, (kind,)) - healthy) / noise
        known = np.isfinite(own) & np.isfinite(both)
        a, b = own[known], both[known]
        size = float(a @ b) / max(float(a @ a), 1e-300)
        nearest = min(nearest, float(np.linalg.norm(b - size * a)))
    return nearest


def told_by_rank(machine: Machine, pair: tuple[Kind, Kind]) -> bool:
    """Whether two faults, each of any course, look like no single one of any course."""
    doubles = compiled(machine).diagnosis_model.doubles()
    return doubles.like_none(kind.of for kind in pair)


def chosen(machine: Machine, by_rank: bool) -> list[tuple[Kind, Kind]]:
    """Pairs that noise lets tell from single faults, by rank or not, evenly among all."""
    every = [p for p in combinations(kinds(machine), 2) if told_by_rank(machine, p) == by_rank]
    found = [p for p in every if apart(machine, p) >= FAR]
    places = np.unique(np.linspace(0, len(found) - 1, min(PAIRS, len(found))).round().astype(int))
    return [found[k] for k in places.tolist()]


def _run(task: tuple[str, int, tuple[Kind, Kind]]) -> Named:
    name, seed, pair = task
    machine = _machine(name)
    duration, onset = span(machine)
    faults = tuple(lasting(machine, k) for k in pair)
    said, _ = watched(machine, run(machine, seed, duration, faults))
    told = [v for v in said if v.event == "update" and v.time >= onset]
    own = {k.of for k in pair}
    if not told:
        return Named("nothing", False)
    last = told[-1]
    if last.pairs:
        groups = compiled(machine).diagnosis_model.groups
        alike = {f: g for g in groups for f in g}
        first = [set(alike.get(f, (f,))) for f in last.pairs[0].faults]
        right = all(any(f in g for g in first) for f in own)
        return Named("pair", right)
    if last.group:
        also = "two others at once" in last.message
        return Named("single", not own.isdisjoint(last.group), also)
    return Named("none", False)


def double(machines: Sequence[Machine], seeds: int, start: int, jobs: int) -> str:
    """A table of what was said of pairs."""
    lines = [
        "| machine | pairs | told by rank | runs | two at once | the right two first | no single"
        " fault | a single one | and says that it may be two | one of both | nothing |",
        "|---" * 11 + "|",
    ]
    for machine in machines:
        for by_rank in (True, False):
            pairs = chosen(machine, by_rank)
            tasks = [(machine.name, start + k, p) for p in pairs for k in range(seeds)]
            if jobs == 1:
                found = [_run(t) for t in tasks]
            else:
                with ProcessPoolExecutor(jobs) as pool:
                    found = list(pool.map(_run, tasks))
            if not found:
                continue
            count = {
                w: sum(n.what == w for n in found) for w in ("pair", "none", "single", "nothing")
            }
            right = {w: sum(n.what == w and n.right for n in found) for w in ("pair", "single")}
            also, rank = sum(n.also for n in found), "yes" if by_rank else "no"
            lines.append(
                f"| {machine.name} | {len(pairs)} | {rank} | {len(found)} | {count['pair']} |"
                f" {right['pair']} | {count['none']} | {count['single']} | {also} |"
                f" {right['single']} | {count['nothing']} |"
            )
            print(lines[-1], flush=True)
    return "\n".join(lines)
