"""What a compiled file of state equations holds: the lines of its functions, and their tables."""

from __future__ import annotations

from fractions import Fraction

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
