"""Samples and derivatives with the residuals that the generated code must give for them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import takewhile

from bondgraph.backends.blocks import Line, blocks, lines, recalled
from bondgraph.backends.forty_digits import Evaluation, Value, value
from bondgraph.backends.spelling import DOUBLE_INTEGRAL, INTEGRAL, START, suffixes
from bondgraph.ir.program import Known, Program, Ref
from bondgraph.notation.walk import reads
from bondgraph.text.tuples import NamedTuple

_VECTORS = 4
_SAMPLES = 16
_HELD = 12  # samples that a mode lasts where its end makes residuals start anew
_REMEMBERED = 64  # samples: where a signal is remembered for longer, step is not tried so long
_MANY = 64  # with more derivatives than this one vector does, and they are not scaled

#: Where the values of signals lie: first around zero, then where laws need it.
_REGIONS = ((-1.0, 1.0), (0.25, 1.25), (1.0, 2.0), (-0.125, 0.125), (0.015625, 0.25))


class Vector(NamedTuple):
    """What goes in, by space, name and order; by mode; by encoder; and (residual, size) out."""

    values: dict[Ref, float]
    modes: dict[str, bool]
    counts: dict[str, int]
    results: tuple[tuple[float, float], ...]


class Golden(NamedTuple):
    """`parameters` by name; the vectors of exact and, one after the other, of step.

    A list is empty where no region of signals was found in which all laws have a value.
    """

    parameters: dict[str, float]
    exact: tuple[Vector, ...]
    step: tuple[Vector, ...]


class _Numbers:
    """Numbers that look random and are the same for ever; all are exact in single precision."""

    def __init__(self, seed: int) -> None:
        self._state = seed

    def whole(self, below: int) -> int:
        """A number from 0 to `below` - 1."""
        self._state = (self._state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self._state >> 33) % below

    def between(self, low: float, high: float) -> float:
        """A multiple of 1/64 of the range."""
        return low + (high - low) * (self.whole(63) + 1) / 64.0


def golden(program: Program) -> Golden:
    """The golden vectors of a program, at its nominal parameters."""
    numbers = _Numbers(20080601)
    parameters = {
        f.name: numbers.between(0.5, 2.0) if f.default is None else f.default
        for f in program.params
    }
    start = Evaluation(program)
    try:
        start.configure({name: value(x) for name, x in parameters.items()})
    except (ArithmeticError, ValueError):
        return Golden(parameters, (), ())
    coefs = {ref: found for ref, found in start.values.items() if ref.space == "coef"}
    exact = _in_some_region(lambda region: _exact(program, coefs, numbers, region))
    step = _in_some_region(lambda region: _step(program, coefs, numbers, region))
    return Golden(parameters, tuple(_without_unwritten(program, v) for v in exact), step)


def _without_unwritten(program: Program, vector: Vector) -> Vector:
    """NaN for the residuals that exact does not have."""
    pairs = zip(program.residuals, vector.results, strict=True)
    return vector._replace(
        results=tuple((math.nan, 0.0) if r.unwritten else found for r, found in pairs)
    )


def _in_some_region(
    attempt: Callable[[tuple[float, float]], tuple[Vector, ...]],
) -> tuple[Vector, ...]:
    """The vectors of the first region in which all are finite, else the most before one is not."""
    most: tuple[Vector, ...] = ()
    for region in _REGIONS:
        try:
            found = attempt(region)
        except (ArithmeticError, ValueError):
            continue
        finite = tuple(takewhile(_finite, found))
        if len(finite) == len(found):
            return found
        most = max(most, finite, key=len)
    return most


def _finite(vector: Vector) -> bool:
    return all(math.isfinite(x) for pair in vector.results for x in pair)


def inputs(program: Program) -> Iterator[Ref]:
    """Everything that exact takes, without the modes."""
    sources = {d.of for d in program.delayed} - {ref.name for ref in reads(program.exact)}
    for known in program.read:
        if known.kind != "mode" and known.name not in sources:
            yield from _orders(known)
    for field in program.integrals:
        yield Ref("integral", field.name)
    if any(ref.space == "time" for ref in reads(program.exact)):
        yield Ref("time", "time")


def _orders(known: Known) -> Iterator[Ref]:
    more = suffixes(known)
    for order in range(max(known.highest, -1 if more else 0) + 1):
        yield Ref("known", known.name, order)
    if INTEGRAL in more:
        yield Ref("known", known.name, -1)
    if DOUBLE_INTEGRAL in more:
        yield Ref("known", known.name, -2)
    if START in more:
        yield Ref("start", known.name)


def _results(program: Program, given: dict[Ref, Value]) -> tuple[tuple[float, float], ...]:
    nothing = value(0.0)
    found = [given.get(Ref("residual", r.name), nothing) for r in program.residuals]
    return tuple((float(f.number), f.size) for f in found)


def _exact(
    program: Program, coefs: dict[Ref, Value], numbers: _Numbers, region: tuple[float, float]
) -> tuple[Vector, ...]:
    refs = list(inputs(program))
    scale = _amplitudes(program, coefs, refs, region)
    found: list[Vector] = []
    for _ in range(_VECTORS if len(refs) <= _MANY else 1):
        values = {ref: scale.get(ref, 1.0) * numbers.between(*region) for ref in refs}
        modes = _modes(program, numbers)
        found.append(Vector(values, modes, {}, _run_exact(program, coefs, values, modes)))
    return tuple(found)


def _run_exact(
    program: Program, coefs: dict[Ref, Value], values: dict[Ref, float], modes: dict[str, bool]
) -> tuple[tuple[float, float], ...]:
    run = Evaluation(program)
    run.modes, run.values = modes, coefs | {ref: value(x) for ref, x in values.items()}
    run.run(program.exact)
    return _results(program, run.values)


def _amplitudes(
    program: Program, coefs: dict[Ref, Value], refs: list[Ref], region: tuple[float, float]
) -> dict[Ref, float]:
    """How large each derivative has to be to be felt as much as the signals: powers of two."""
    derivatives = [ref for ref in refs if ref.space == "known" and ref.order > 0]
    if not derivatives or len(derivatives) > _MANY:
        return {}
    modes = {k.name: True for k in program.read if k.kind == "mode"}
    middle, eighth = sum(region) / 2.0, (region[1] - region[0]) / 8.0
    base = dict.fromkeys(refs, middle + eighth)
    try:
        rest = _run_exact(program, coefs, base, modes)
    except ArithmeticError:  # what is alike cancels, in a divisor perhaps
        base = {ref: middle + eighth * (1.0 + k / len(refs)) for k, ref in enumerate(refs)}
        rest = _run_exact(program, coefs, base, modes)

    def moved(ref: Ref) -> list[float]:
        results = _run_exact(program, coefs, base | {ref: base[ref] + 0.125}, modes)
        return [abs(new - old) for (new, _), (old, _) in zip(results, rest, strict=True)]

    plain = [moved(ref) for ref in refs if ref not in derivatives]
    usual = [max([row[k] for row in plain], default=0.0) for k in range(len(rest))]
    found: dict[Ref, float] = {}
    for ref in derivatives:
        felt = [m / u for m, u in zip(moved(ref), usual, strict=True) if m and u]
        if felt:
            found[ref] = 2.0 ** max(-100, min(100, -round(math.log2(max(felt)))))
    return found


def _step(
    program: Program, coefs: dict[Ref, Value], numbers: _Numbers, region: tuple[float, float]
) -> tuple[Vector, ...]:
    run = Evaluation(program)
    run.values = dict(coefs)
    count = {k.name: 2**31 - 40 for k in program.knowns if k.counts is not None}
    total = dict.fromkeys(count, 0)
    found: list[Vector] = []
    kept, parts = lines(program), blocks(program)
    past: dict[str, list[float]] = {name: [] for name in kept}
    ages = [0] * len(parts)
    longest = max([line.length for line in kept.values()], default=0)
    for at in range(max(_SAMPLES, longest + _HELD) if longest < _REMEMBERED else _SAMPLES):
        values: dict[Ref, float] = {}
        for known in program.knowns:
            if known.counts is not None:
                step = numbers.whole(25) - 4 if at else 0
                count[known.name] = (count[known.name] + step + 2**31) % 2**32 - 2**31
                total[known.name] += step
                run.values[Ref("increment", known.name)] = value(float(step))
                run.values[Ref("total", known.name)] = value(float(total[known.name]))
            elif known.kind != "mode":
                values[Ref("known", known.name)] = numbers.between(*region)
        if not program.openings or at % _HELD == 0:
            run.modes = _modes(program, numbers)
        run.values |= {ref: value(x) for ref, x in values.items()}
        early = _recall(program.rate, kept, run, past, values)
        for k, block in enumerate(parts):
            for name in block.residuals:
                run.values[Ref("residual", name)] = value(0.0)
            if early.isdisjoint(block.knowns):
                run.run(block.step if ages[k] else block.first)
                ages[k] += 1
        results = _results(program, run.values)
        found.append(Vector(values, dict(run.modes), dict(count), results))
    return tuple(found)


def _recall(
    rate: float,
    kept: dict[str, Line],
    run: Evaluation,
    past: dict[str, list[float]],
    values: dict[Ref, float],
) -> set[str]:
    """Give a run the past values that there are by this sample; the names of the others."""
    early = set()
    for name, line in kept.items():
        past[name].append(values[Ref("known", name)])
        for one in line.past:
            then = recalled(past[name], one.seconds * rate)
            if math.isnan(then):
                early.add(one.known.name)
            else:
                run.values[Ref("known", one.known.name)] = value(then)
    return early


def _modes(program: Program, numbers: _Numbers) -> dict[str, bool]:
    return {k.name: numbers.whole(2) == 1 for k in program.read if k.kind == "mode"}
