"""What a compiled file of state equations holds: the lines of its functions, and their tables."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.graph import Input
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class RateTable(NamedTuple):
    """A table of the model by its name, and what it is called in the lines."""

    name: str
    called: str
    rows: tuple[tuple[Fraction | float, ...], ...]


class RateSource(NamedTuple):
    """State equations over time, in lines of the language that is compiled.

    `inputs` set the entries of `u` that are courses of the time `t`; `rates` and `outputs` the
    entries of `r`, from the constants `p`, the states `x` and the inputs `u`. The numbers are how
    many `states`, `signals` and `results` (outputs) there are.
    """

    tables: tuple[RateTable, ...]
    inputs: tuple[str, ...]
    rates: tuple[str, ...]
    outputs: tuple[str, ...]
    states: int
    signals: int
    results: int


class OpenParameter(NamedTuple):
    """A parameter of a machine that may be set while it runs, or only before (`fixed`).

    `value` is that of the model, in SI; NaN where it has none.
    """

    name: str
    value: float
    unit: str
    doc: str
    origin: Span
    fixed: bool


class MachineSensor(NamedTuple):
    """A sensor of a machine: `counts` a turn of an encoder, 0.0 for a plain number."""

    name: str
    unit: str
    doc: str
    origin: Span
    counts: float


class OpenMachine(NamedTuple):
    """State equations whose parameters stay open: what it takes to run them elsewhere.

    In `source` the constants `p` begin with the `parameters`; `constants` are the others. The
    states have names, values at the start, and a `scale`: how much of each goes with a unit of
    effort or flow. `signals` are the names of the inputs `u`, None for what stays zero; `inputs`
    those of the model. The outputs are the `sensors`.
    """

    source: RateSource
    parameters: tuple[OpenParameter, ...]
    constants: tuple[float, ...]
    states: tuple[str, ...]
    start: tuple[float, ...]
    scale: tuple[float, ...]
    signals: tuple[str | None, ...]
    inputs: tuple[Input, ...]
    sensors: tuple[MachineSensor, ...]
