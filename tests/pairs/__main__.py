"""Are faults of the size that `detect --pairs` tells really told apart? `python -m tests.pairs`.

Four machines stand still or run steadily, with white noise on their sensors and no tolerances. A
pair (a, b) is confirmed where, over 200 runs of the residual code with noise that was drawn, fault
a of the size that is told for it is not taken for b: nothing here comes from the sensitivities or
the covariance of `detect`. What a fault does to the signals is had from the virtual machine, in the
steady state with and without the fault; what noise does to the residuals from runs without one.

Of the residuals r the test is what no size of b explains, in standard deviations: z = u'r, with u
along the part of the effect of a that is across that of b, in the metric of the noise. Fault a is
told where z is beyond half of kappa. So with kappa = 5 a run in 160 errs, of a and of b.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.batch import Lanes
from bondgraph.runtime.log import Array
from bondgraph.runtime.separation import separation
from bondgraph.runtime.smallest import Situation, noise

HERE = Path(__file__).parent
SEEDS, HEALTHY, KAPPA = 200, 4000, 5.0


class Machine(NamedTuple):
    """A model, what it is driven with, and the noise of its sensors.

    It begins in its steady state, or is run for so many seconds where positions go on for ever.
    """

    path: Path
    inputs: Mapping[str, float]
    noise: Mapping[str, float]
    rate: float
    run: float = 0.0
    static: tuple[str, ...] = ()


MACHINES = {
    "bridge": Machine(HERE / "bridge.bg", {"U": 10.0},
                      {"one": 2e-3, "two": 2e-3, "current": 1e-4}, 200.0),
    "redundant": Machine(HERE / "redundant.bg", {"U": 12.0},
                         {"current": 5e-3, "speed1": 0.1, "speed2": 0.1}, 500.0),
    "belt": Machine(HERE / "belt.bg", {"U": 12.0},
                    {"current": 1e-3, "fast": 0.02, "slow": 0.01}, 500.0),
    "robot": Machine(HERE.parents[1] / "models" / "khepera_plausible.bg",
                     {"robot.U0[1]": 4.0, "robot.U0[2]": 3.0, "robot.Uin": 5.0},
                     {"robot.m[1].me.we": 0.5, "robot.m[1].wh.ws": 0.02, "robot.m[2].me.we": 0.5,
                      "robot.m[2].wh.ws": 0.02, "robot.Us": 5e-3}, 500.0, 2.0, ("robot.line",)),
}  # fmt: skip


def steady(c: Compilation, machine: Machine, wrong: Mapping[str, float]) -> Array:
    """The signals of the program in the steady state, of a machine with these numbers."""
    known, inputs = [k.path for k in c.program.knowns], machine.inputs
    own = {i.name for i in c.graph.inputs}
    driven = {n: inputs.get(n, 0.0) + wrong.get(n, 0.0) for n in own}
    scenario = bondgraph.Scenario(
        "steady",
        duration=machine.run or 3.0 / c.program.rate,
        start="initial" if machine.run else "steady",
        static=machine.static,
        parameters={n: v for n, v in wrong.items() if n not in own},
        inputs={n: bondgraph.Course.constant(v) for n, v in driven.items()},
        sampling=bondgraph.Sampling(rate=c.program.rate),
    )
    truth = c.simulate(scenario).log.columns
    # what is told of an input is what was meant, not what came
    return np.array([inputs.get(n, 0.0) if n in own else truth[n][-1] for n in known])


def residuals(
    c: Compilation, signals: Array, deviations: Mapping[str, float], runs: int, seed: int
) -> Array:
    """The residuals of so many runs with noise, when all has settled: (runs, residuals)."""
    draw, program = np.random.default_rng(seed), c.program
    names = [k.name for k in program.knowns]
    spread = [deviations.get(k.path, 0.0) for k in program.knowns]
    lanes, found = Lanes(program, {}), dict[str, Any]()
    states: dict[str, Any] | None = None
    for _ in range(int(2 * program.warmup / program.bandwidth * program.rate) + 2):
        told = {n: x + s * draw.standard_normal(runs)
                for n, x, s in zip(names, signals, spread, strict=True)}  # fmt: skip
        found, states = lanes.sample(told, {}, {}, {}, states)
    return np.array([np.broadcast_to(found[r.name], runs) for r in program.residuals]).T


class Pair(NamedTuple):
    """Fault a of a size beside b: how far it stands out, and how often one is taken for the other.

    `wrong` counts runs with a in which b is not ruled out, and runs with b, of the size that tells
    it from a, in which it is. `share` is the larger one of both sizes beside the values of their
    parameters.
    """

    a: str
    b: str
    size: float
    share: float
    mean: float
    wrong: int


def pairs(machine: Machine, seeds: int = SEEDS) -> Iterator[Pair]:
    """Every pair of faults that `detect --pairs` tells a size of, tried."""
    c = bondgraph.compile(machine.path, rate=machine.rate)
    program = c.program
    known = [k.path for k in program.knowns]
    values = {p.path: p.default or 0.0 for p in program.params}
    healthy = steady(c, machine, {})
    situation = Situation(dict(zip(known, healthy, strict=True)), noise=machine.noise, kappa=KAPPA)
    told = separation(program, {}, situation)
    used = [k for k, sigma in enumerate(noise(program, situation).values()) if sigma is not None]
    at_rest = residuals(c, healthy, machine.noise, HEALTHY, 1)[:, used]
    covariance = np.cov(at_rest.T).reshape(len(used), len(used))
    floor = 1e-12 * np.trace(covariance) * np.eye(len(used))
    white = np.linalg.inv(np.linalg.cholesky(covariance + floor))

    @cache
    def signals(fault: str, size: float) -> Array:
        if fault in machine.noise:
            return np.asarray(healthy + size * (np.array(known) == fault))
        return steady(c, machine, {fault: values.get(fault, 0.0) + size})

    def standing(fault: str, size: float, runs: int, seed: int) -> Array:
        """The residuals beside those of the healthy machine, in standard deviations."""
        own = residuals(c, signals(fault, size), machine.noise if seed else {}, runs, seed)
        return np.asarray((own[:, used] - at_rest.mean(axis=0)) @ white.T)

    sizes = {f: {g: x for g, x in zip(told.faults, row, strict=True) if x is not None}
             for f, row in zip(told.faults, told.changes, strict=True)}  # fmt: skip
    for a, (fault, others) in enumerate(sizes.items()):
        for b, other in enumerate(told.faults):
            if other not in others:
                continue
            size, back = others[other], sizes[other].get(fault, min(sizes[other].values()))
            one, two = (standing(f, x, 1, 0)[0] for f, x in ((fault, size), (other, back)))
            across = one - two * (one @ two) / (two @ two)
            u = across / np.linalg.norm(across)
            seed = 1000 * a + 10 * b + 2
            there = standing(fault, size, seeds, seed) @ u
            absent = standing(other, back, seeds, seed + 1) @ u
            wrong = int(np.sum(there < KAPPA / 2) + np.sum(np.abs(absent) > KAPPA / 2))
            share = max(x / abs(values[f]) if values.get(f) else 0.0
                        for f, x in ((fault, size), (other, back)))  # fmt: skip
            yield Pair(fault, other, size, share, float(there.mean()), wrong)


def main() -> None:
    """The table: a row a machine, with the extremes over its pairs."""
    print("| Machine | sizes, of a parameter | pairs | mean of z | runs | wrong |")
    print("|---" * 6 + "|")
    for name, machine in MACHINES.items():
        found = list(pairs(machine))
        for what, own in (
            ("below a tenth", [p for p in found if p.share < 0.1]),
            ("larger", [p for p in found if p.share >= 0.1]),
        ):
            if own:
                means, wrong = [p.mean for p in own], sum(p.wrong for p in own)
                runs = 2 * SEEDS * len(own)
                print(f"| {name} | {what} | {len(own)} | {min(means):.2f} to {max(means):.2f}"
                      f" | {runs} | {100 * wrong / runs:.2f} % |", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
