"""Motions chosen by hand, the commands that they need computed backwards: machines repeat them.

`tests.models.plants` gives commands and readings of each model as power series, parameters that
change included; the virtual machine gets the commands and has to show the readings.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import NamedTuple

import numpy as np
import pytest

from bondgraph.ir.expr import Kind
from tests.models import plants
from tests.models.plants import Signals, Values
from tests.models.series import Series, d, t
from tests.models.test_models import nice
from tests.simulation.machines import Array, example, near, run

END = 0.2  # s: where sixteen terms of a series are as exact as the integration
RATE = 100


class Motion(NamedTuple):
    """A model, its signals by hand, and what its storages hold at the start."""

    model: str
    plant: Callable[[Values], Signals]
    start: Callable[[Values, Signals], Mapping[str, object]]


def quarter_car(F: Values) -> Signals:
    """As in `plants`, with the road that the wheel needs."""
    found = plants.quarter_car(F)
    push = F("ks") * found["stroke"] + F("cs") * d(found["stroke"])
    tyre = (d(F("mu") * found["vw"]) + F("mu") * F("g") + push) / F("kt")
    return {**found, "road": found["vw"] + d(tyre), "tyre": tyre}


def ladder(F: Values, cells: int) -> Mapping[str, object]:
    """What the coils and capacitors of a cable hold, from its end to its beginning."""
    R, L, C = (F(f"line.{x}") / cells for x in "RLC")
    voltage = 1 + t**2 - t**5 / 3 + t**9
    current = d(F("line.C") * voltage)
    held: dict[str, object] = {"Cs.q": F("line.C") * voltage}
    for k in range(cells, 0, -1):
        held[f"line.cell[{k}].L2.p"] = L / 2 * current
        voltage = voltage + R / 2 * current + d(L / 2 * current)
        held[f"line.cell[{k}].C.q"] = C * voltage
        current = current + d(C * voltage)
        held[f"line.cell[{k}].L1.p"] = L / 2 * current
        voltage = voltage + R / 2 * current + d(L / 2 * current)
    return held


MOTIONS = [
    Motion("dc_motor", plants.dc_motor,
           lambda F, s: {"L.p": F("L") * s["current"], "J.p": F("J") * s["speed"]}),
    Motion("chassis", plants.chassis,
           lambda F, s: {"body.m.p": F("body.m") * s["u"], "body.Iz.p": F("body.Iz") * s["yaw"]}),
    Motion("rigid_gear", plants.rigid_gear,
           lambda F, s: {"J1.p": F("J1") * s["w1"], "J2.p": F("J2") * s["w2"]}),
    Motion("two_tanks", plants.two_tanks,
           lambda F, s: {f"C{k}.q": F(f"A{k}") / (F("rho") * F("g")) * s[f"p{k}"] for k in (1, 2)}),
    Motion("hydraulic_actuator", plants.hydraulic_actuator,
           lambda F, s: {"oil.q": F("V") / F("B") * s["p"], "m.p": F("m") * s["v"]}),
    Motion("slider_crank", plants.slider_crank,
           lambda F, s: {"J.p": F("J") * s["speed"]}),
    Motion("microphone", plants.microphone,
           lambda F, s: {"mic.el.q": s["u"] * F("eps") * F("A") / F("x0"),
                         "m.p": F("m") * s["v"]}),
    Motion("quarter_car", quarter_car,
           lambda F, s: {"spring.q": s["stroke"], "ms.p": F("ms") * s["vb"],
                         "mu.p": F("mu") * s["vw"], "kt.q": s["tyre"]}),
    Motion("rc_loop", plants.rc_loop,
           lambda F, s: {"Ca.q": F("Ca") * s["ua"], "Cc.q": F("Cc") * s["uc"]}),
    Motion("oven", plants.oven,
           lambda F, s: {"Ch.q": F("Ch") * s["Th"], "Co.q": F("Co") * s["To"]}),
    Motion("cable", partial(plants.ladder, cells=4, capacitor=True), lambda F, s: ladder(F, 4)),
]  # fmt: skip


@pytest.mark.parametrize("change", [0, 1], ids=["healthy", "everything changes"])
@pytest.mark.parametrize("motion", MOTIONS, ids=lambda m: m.model)
def test_a_machine_repeats_the_motion_that_its_commands_were_made_for(
    motion: Motion, change: int
) -> None:
    machine = example(motion.model)
    graph = machine.graph
    names = [v.name for v in graph.values]
    numbers = {name: nice(k) for k, name in enumerate(names)}
    for value in graph.values:
        if value.symbol.symbol.kind is Kind.CONST:
            assert value.value is not None
            numbers[value.name] = value.value.number
    consts = [v.name for v in graph.values if v.symbol.symbol.kind is Kind.CONST]
    rates = {n: change * nice(k + 2) / 2 for k, n in enumerate(names) if n in graph.faults}

    def parameter(name: str) -> Series:
        return Series.of(numbers[name]) + rates.get(name, 0) * t

    signals = motion.plant(parameter)
    start = motion.start(parameter, signals)
    lines = [f"duration = {END}", f"sampling.rate = {RATE}", "[parameters]"]
    lines += [f'"{n}" = {float(v)!r}' for n, v in numbers.items() if n not in consts]
    lines += ["[initial]", *[f'"{n}" = {at_zero(v)!r}' for n, v in start.items()], "[inputs]"]
    lines += [f'"{i.name}" = {course(signals[i.name])}' for i in graph.inputs]
    for name, rate in rates.items():
        if rate:
            lines += ["[[fault]]", f'of = "{name}"', f'change = "+= {float(rate) * END!r}"']
            lines += [f"ramp = {END}"]
    found = run(machine, "\n".join(lines))
    times = found.truth.time
    for sensor in graph.sensors:
        wanted = signals[sensor.name]
        assert isinstance(wanted, Series)
        assert near(found.truth.columns[sensor.name], values(wanted, times)), sensor.name


def at_zero(value: object) -> float:
    assert isinstance(value, Series)
    return float(value.c[0])


def course(signal: Series | bool) -> str:
    """A power series as an expression of time."""
    if isinstance(signal, bool):
        return str(signal).lower()
    terms = [f"({float(c)!r})*t^{k}" for k, c in enumerate(signal.c) if c and k]
    return '"' + " + ".join([f"({float(signal.c[0])!r})", *terms]) + '"'


def values(signal: Series, times: Array) -> Array:
    return np.asarray(np.polyval([float(c) for c in reversed(signal.c)], times), dtype=float)
