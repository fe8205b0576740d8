"""The variables of an FMU and their units: what its description and its C agree on."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Literal

from bondgraph.library.units import parse_unit
from bondgraph.notation.dialect import digits
from bondgraph.text.tuples import NamedTuple

Role = Literal["time", "fixed", "tunable", "setting", "input", "output"]
Type = Literal["real", "integer", "boolean"]

#: The base units in the order of our dimensions, and in that of FMI.
_DIMENSION, _BASE = "m kg s A K mol cd".split(), "kg m s A K mol cd".split()
_FOREIGN = re.compile(r"[^A-Za-z0-9_.\[\],]")
_CAUSALITY = {
    "time": "independent", "fixed": "parameter", "tunable": "parameter", "setting": "parameter",
    "input": "input", "output": "output",
}  # fmt: skip


class Variable(NamedTuple):
    """One variable; its value reference is its place in the list of all.

    `role` says who gives it: a `fixed` parameter before the first step, a `tunable` one at any
    time, as a `setting` that nothing starts anew for. `start` is NaN for a parameter that has no
    value in the model; `unit` is SI, "" for a plain number. A `sampled` output changes at
    communication points only.
    """

    name: str
    type: Type
    role: Role
    start: float
    unit: str
    description: str
    sampled: bool = False

    @property
    def causality(self) -> str:
        """As FMI calls the role."""
        return _CAUSALITY[self.role]

    @property
    def variability(self) -> str:
        """When it may change, in the words of FMI."""
        if self.role in ("fixed", "tunable"):
            return self.role
        if self.role == "setting":
            return "tunable"
        return "continuous" if self.type == "real" and not self.sampled else "discrete"

    @property
    def initial(self) -> str:
        """Where its first value is from, if that is to be said."""
        return "calculated" if self.role == "output" else ""

    @property
    def start_text(self) -> str:
        """The start value for XML, "" for what is computed."""
        if self.role in ("time", "output"):
            return ""
        if self.type == "boolean":
            return "true" if self.start else "false"
        if self.type == "integer":
            return str(int(self.start))
        return "NaN" if math.isnan(self.start) else digits(self.start)

    @property
    def start_code(self) -> str:
        """The start value in C."""
        return "NAN" if math.isnan(self.start) else digits(self.start)


class UnitDefinition(NamedTuple):
    """A unit with its `base`, the attributes of BaseUnit; none where FMI cannot say it."""

    name: str
    base: tuple[tuple[str, str], ...]


def units(variables: Iterable[Variable]) -> list[UnitDefinition]:
    """The units of the variables, each once.

    FMI knows whole exponents only: a unit such as m^3/s.Pa^-0.5 is there by its name alone.

    >>> given = Variable("k", "real", "tunable", 1.0, "N.m/A", "")
    >>> units([given])
    [UnitDefinition(name='N.m/A', base=(('kg', '1'), ('m', '2'), ('s', '-2'), ('A', '-1')))]
    """
    found = []
    for text in dict.fromkeys(v.unit for v in variables if v.unit):
        unit = parse_unit(text)
        base = []
        if unit is not None and all(e.denominator == 1 for e in unit.dimension):
            powers = dict(zip(_DIMENSION, unit.dimension, strict=True))
            base = [(name, str(powers[name])) for name in _BASE if powers[name]]
            if unit.factor != 1:
                base.append(("factor", digits(float(unit.factor))))
        found.append(UnitDefinition(text, tuple(base)))
    return found


class Variables:
    """The list of variables while it grows: no name is there twice."""

    def __init__(self) -> None:
        self.all: list[Variable] = []
        self._taken: set[str] = set()

    def add(self, variable: Variable) -> int:
        """Append a variable, by a name that FMI admits and nobody has; its place."""
        name = structured(variable.name)
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        unit = "" if variable.unit == "1" else variable.unit
        self.all.append(variable._replace(name=name, unit=unit))
        return len(self.all) - 1


def structured(name: str) -> str:
    """A name of the model by the rules of FMI for structured names.

    >>> structured("m[1].wh.ws"), structured("a[1][2]"), structured("θ"), structured("b.2x")
    ('m[1].wh.ws', 'a[1,2]', 'u3b8', 'b._2x')
    """
    text = _FOREIGN.sub(lambda found: f"u{ord(found.group()):x}", name.replace("][", ","))
    return ".".join(f"_{part}" if not part or part[0].isdigit() else part
                    for part in text.split("."))  # fmt: skip
