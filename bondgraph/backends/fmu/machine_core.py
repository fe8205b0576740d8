"""The machine in an FMU: inputs and parameters in, what its sensors show out."""

from __future__ import annotations

import math
import textwrap

from bondgraph.backends.fmu.fmu_variables import Role, Variable, Variables
from bondgraph.backends.fmu.package import Core
from bondgraph.backends.identifiers import snake
from bondgraph.backends.listing import place, table
from bondgraph.backends.rates import rate_holes
from bondgraph.backends.target import load
from bondgraph.ir.rate_source import MachineSensor, OpenMachine
from bondgraph.notation.dialect import digits
from bondgraph.text.source import Span

_LONG = 200  # letters of a description
_INTERVAL = 1e-3  # s, the communication step to propose


def machine_core(name: str, machine: OpenMachine, beyond: float, singular: float) -> Core:
    """The machine of a model called `name`; the numbers are those of `rate_holes`."""
    listed = Variables()
    listed.add(Variable("time", "real", "time", 0.0, "s", "time"))
    inputs = {
        i.name: listed.add(
            Variable(i.name, "real", "input", 0.0, i.unit or "", _about(i.doc, "", i.origin))
        )
        for i in machine.inputs
    }
    first = len(listed.all)
    for own in machine.parameters:
        role: Role = "fixed" if own.fixed else "tunable"
        said = _about(own.doc, "", own.origin)
        listed.add(Variable(own.name, "real", role, own.value, own.unit, said))
    start = len(listed.all)
    for state, value in zip(machine.states, machine.start, strict=True):
        said = f"{state} at the start, in SI units"
        listed.add(Variable(f"start.{state}", "real", "fixed", value, "", said))
    given = []
    for k, sensor in enumerate(machine.sensors):
        at = listed.add(_output(sensor))
        given.append(f"value[{at}] = {_reading(sensor, k)};")
    own_holes = {
        "places": {"parameter": first, "start": start},
        "parameters": machine.parameters,
        "constants": machine.constants,
        "constants_text": _numbers(machine.constants, 8),
        "scale": _numbers(machine.scale or (1.0,), 4),
        "taken": [
            f"u[{k}] = {'0.0' if name is None else f'value[{inputs[name]}]'};"
            for k, name in enumerate(machine.signals)
        ],
        "given": given,
        "counted": any(s.counts for s in machine.sensors),
    }
    return Core(
        "machine",
        name,
        f"{snake(name)}_machine",
        f"The machine {name}: its sensors without noise, from inputs that stand still during a"
        " step. A fault is a parameter that is changed.",
        tuple(listed.all),
        rate_holes(machine.source, beyond, singular) | own_holes,
        (),
        (),
        "",
        digits(_INTERVAL),
    )


def _about(doc: str, more: str, origin: Span) -> str:
    parts = [" ".join(doc.split()).rstrip("."), more, place(origin)]
    return textwrap.shorten(", ".join(p for p in parts if p), _LONG)


def _output(sensor: MachineSensor) -> Variable:
    if not sensor.counts:
        said = _about(sensor.doc, "", sensor.origin)
        return Variable(sensor.name, "real", "output", 0.0, sensor.unit, said)
    said = _about(sensor.doc, f"{sensor.counts:g} counts a turn", sensor.origin)
    return Variable(sensor.name, "integer", "output", 0.0, "", said)


def _reading(sensor: MachineSensor, number: int) -> str:
    """What a sensor shows of its true value: an encoder the counts that have passed."""
    if not sensor.counts:
        return f"r[{number}]"
    return f"whole(floor(r[{number}] * {digits(sensor.counts / (2 * math.pi))}))"


def _numbers(values: tuple[float, ...], indent: int) -> list[str]:
    texts = ["NAN" if math.isnan(v) else digits(v) for v in values]
    return table(texts, load("c"), indent)
