"""Signals for any model, and the size of the terms of a step, which errors are measured by."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bondgraph.backends.forty_digits import Evaluation, value
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.ir.program import Program, Ref
from bondgraph.compilation import Compilation


class Terms:
    """The sums of the amounts of all terms in one step of a program, at nominal parameters.

    What the filter remembers counts with its amount, as a signal does: rounding errors of the past
    are not forgiven. That is stricter than the self-test of the generated code.
    """

    def __init__(self, program: Program) -> None:
        self.program = program
        self.spelling = Spelling(program, load("python"))
        start = Evaluation(program)
        start.configure({f.name: value(f.default or 0.0) for f in program.params})
        self.coefs = {r: v for r, v in start.values.items() if r.space == "coef"}

    def sizes(self, monitor: Any, row: dict[str, float]) -> list[float]:
        """For each residual, at the next step of a generated Python monitor; NaN for none."""
        run = Evaluation(self.program)
        run.modes = {k.name: row[k.path] > 0 for k in self.program.knowns if k.kind == "mode"}
        run.values = dict(self.coefs)
        for known in self.program.knowns:
            run.values[Ref("known", known.name)] = value(row[known.path])
        for (_, signal), name in self.spelling.encoders.items():
            encoder = getattr(monitor._e, name)
            path = next(k.path for k in self.program.knowns if k.name == signal)
            increment = int(row[path]) - encoder.count
            run.values[Ref("increment", signal)] = value(increment)
            run.values[Ref("total", signal)] = value(encoder.total + increment)
        for field in self.program.states:
            name = self.spelling.states[field.name]
            run.values[Ref("state", field.name)] = value(getattr(monitor._x, name))
        try:
            run.run(self.program.step)
        except (ArithmeticError, ValueError):
            return [math.nan] * len(self.program.residuals)
        found = [run.values.get(Ref("residual", r.name)) for r in self.program.residuals]
        return [f.size if f is not None else math.nan for f in found]


def worst(engine: Any, other: Any, samples: np.ndarray, every: int) -> float:
    """The largest difference of two engines by the terms of the step, and by the flags.

    `other` runs generated Python. The terms are counted each `every` samples; in between, the
    smaller of the two counts before and behind is taken. Infinite where the flags differ.
    """
    programs = [runnable.program for runnable in other._setting.programs]
    terms = [Terms(p) for p in programs]
    found, sizes, parts = engine.run(samples), [[] for _ in programs], []
    paths = [k.path for k in other.signals]
    for start in range(0, len(samples), every):
        for at, program in enumerate(terms if start else []):
            row = dict(zip(paths, samples[start].tolist(), strict=True))
            sizes[at].append(program.sizes(other._monitors[at]._monitor, row))
        parts.append(other.run(samples[start : start + every]))
    if not np.array_equal(found.valid, np.concatenate([p.valid for p in parts])):
        return math.inf
    errors = []
    for at, name in enumerate(("value", "bound")[: len(programs)]):
        size = np.array(sizes[at])  # at every, 2 every, ...
        around = np.fmin(np.vstack([size[:1], size]), np.vstack([size, size[-1:]]))
        scale = np.repeat(around, every, axis=0)[: len(samples)]
        off = np.abs(getattr(found, name) - np.concatenate([getattr(p, name) for p in parts]))
        errors.append(np.max(np.where(off > 0, off / np.maximum(scale, 1e-300), 0.0), initial=0.0))
    return float(max(errors))


def waves(c: Compilation, count: int) -> np.ndarray:
    """Slow waves and noise around a half, where most laws have a value; encoders that run over."""
    random = np.random.default_rng(7)
    time = np.arange(count) / c.options.rate
    columns = []
    for known in c.engine(native=False).signals:
        wave = np.sin(2 * np.pi * random.uniform(0.2, 3.0) * time + random.uniform(0, 6))
        noisy = 0.6 + 0.3 * wave + 0.01 * random.normal(size=count)
        if known.kind == "mode":
            noisy = (wave > 0).astype(float)
        elif known.counts is not None:
            noisy = 2.0**31 - 200 + np.cumsum(np.rint(5 * wave))
        columns.append(noisy)
    samples = np.column_stack(columns)
    samples[count // 2 + 13, random.integers(samples.shape[1])] = np.nan
    return samples
