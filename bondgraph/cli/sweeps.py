"""`simulate --sweep` and `--plot`: one run for each value, and all of them in one picture."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING

from bondgraph.cli import console
from bondgraph.cli.options import amount, check_units, quoted
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.numerals import readable
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.compilation import Compilation
    from bondgraph.runtime.simulation.run import Run
    from bondgraph.runtime.simulation.scenario import Scenario

_RUNS = 64  # of one sweep


class Sweep(NamedTuple):
    """A parameter or a constant input, and what it is in turn, as written: texts of quantities.

    So many `runs` from the first to the second text, or as many as there are texts (0).
    """

    name: str
    texts: tuple[str, ...]
    runs: int


class Setting(NamedTuple):
    """What one run has of a sweep: a label, and the scenario with its values."""

    label: str
    scenario: Scenario


def sweep(text: str) -> Sweep:
    """`R=1..10/5` or `R=1,2,5`, with units if wanted; raises ValueError for anything else.

    >>> sweep("R=1 Ohm..10 Ohm/4"), sweep("v=1 m/s..3 m/s/3").texts, sweep("U=6,12")
    (Sweep(name='R', texts=('1 Ohm', '10 Ohm'), runs=4), ('1 m/s', '3 m/s'), \
Sweep(name='U', texts=('6', '12'), runs=0))
    """
    name, _, values = text.partition("=")
    name = name.strip()
    first, dots, rest = values.partition("..")
    if not dots:
        texts = tuple(part.strip() for part in values.split(","))
        if not name or not all(texts):
            raise ValueError
        return Sweep(name, texts, 0)
    last, _, number = rest.rpartition("/")
    if not name or not first.strip() or not last.strip() or not 2 <= int(number) <= _RUNS:
        raise ValueError
    return Sweep(name, (first.strip(), last.strip()), int(number))


sweep.__name__ = "NAME=FROM..TO/COUNT"


def settings(
    compilation: Compilation, scenario: Scenario, sweeps: Sequence[Sweep]
) -> list[Setting]:
    """The runs of a sweep, every value of each with every one of the others."""
    every = [_values(compilation, own) for own in sweeps]
    runs = 1
    for values in every:
        runs *= len(values)
    if runs > _RUNS:
        raise Trouble(f"the sweep has {runs} runs; up to {_RUNS} are made at once")
    units = _units(compilation)
    found = []
    for chosen in product(*every):
        own = scenario
        words = []
        for item, value in zip(sweeps, chosen, strict=True):
            own = _with(compilation, own, item.name, value)
            unit = units.get(item.name, "")
            unit = "" if unit == "1" else unit
            words.append(f"{item.name} = {readable(value, 4)} {unit}".strip())
        found.append(Setting(", ".join(words), own))
    return found


def _units(compilation: Compilation) -> dict[str, str]:
    from bondgraph.runtime.simulation.parameters import units

    return {**units(compilation.graph), **{i.name: i.unit or "" for i in compilation.graph.inputs}}


def _values(compilation: Compilation, own: Sweep) -> list[float]:
    """The numbers of a sweep, in SI."""
    graph = compilation.graph
    inputs = [i.name for i in graph.inputs if not i.of]
    known = [v.name for v in graph.values]
    if own.name not in (*inputs, *known):
        hint = console.hint(own.name, [*inputs, *known])
        raise Trouble(f"the model has no parameter and no input `{own.name}`{hint}")
    numbers = [_number(compilation, own.name, text, own.name in inputs) for text in own.texts]
    if not own.runs:
        return numbers
    first, last = numbers
    return [first + (last - first) * k / (own.runs - 1) for k in range(own.runs)]


def _number(compilation: Compilation, name: str, text: str, is_input: bool) -> float:
    from bondgraph.text.source import Source

    if is_input:
        try:
            value = amount(text)
        except ValueError:
            raise Trouble(f"--sweep {name}: `{text}` is no number with a unit") from None
        check_units(compilation.graph, [(name, value)])
        return float(value)
    try:
        written = repr(float(text))
    except ValueError:
        written = quoted(text)
    source = Source("--sweep", f"parameters.{quoted(name)} = {written}")
    return compilation.numbers(source)[0][name]


def _with(compilation: Compilation, scenario: Scenario, name: str, value: float) -> Scenario:
    from bondgraph.runtime.simulation.scenario import Course

    own = next((i for i in compilation.graph.inputs if i.name == name and not i.of), None)
    if own is None:
        return scenario._replace(parameters={**scenario.parameters, name: value})
    if any(c.input == name for c in scenario.controllers):
        raise Trouble(f"`{name}` is driven by a controller of the scenario")
    course = Course.constant(value)
    if own.mode:
        return scenario._replace(modes={**scenario.modes, name: course})
    return scenario._replace(inputs={**scenario.inputs, name: course})


def draw(
    compilation: Compilation, path: str, runs: Sequence[tuple[str, Run]], wanted: Sequence[str]
) -> None:
    """Write the picture of some runs; raises Unknown for what is no signal."""
    first = runs[0][1]
    every = [*first.log.columns, *first.truth.columns]
    for name in wanted:
        if name not in every:
            raise console.Unknown(name, "no signal of the machine", every)
    compilation.plot(dict(runs), wanted, title=first.scenario.name).write(path)
