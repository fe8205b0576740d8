"""The virtual twin in a thread of its own: it follows a watch, and does what people wish.

So nobody who injects a fault, and no machine that is hard to integrate, can hold up the watch.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from queue import Empty, Full, Queue
from threading import Event
from typing import Any

import numpy as np

from bondgraph.runtime.live.messages import Messages, short, strips
from bondgraph.runtime.live.portions import Portion, Portions
from bondgraph.runtime.live.positions import Places
from bondgraph.runtime.live.setup import Setup, Target, wish
from bondgraph.runtime.live.twin import Twin
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.limits import INJECTED, WISHES

Refuse = Callable[[str], None]

_A_TURN = 4  # wishes that are done before the next samples
_LOOK = 0.05  # s between two looks at wishes, where no samples come


class Follower:
    """The twin with its watch; `control` does what concerns both machines: reset, pause, go."""

    def __init__(
        self,
        setup: Setup,
        targets: Mapping[str, Target],
        messages: Messages,
        control: Callable[[str], bool],
    ) -> None:
        self._setup, self._targets = setup, targets
        self._messages, self._control = messages, control
        self._wishes: Queue[tuple[dict[str, Any], Refuse]] = Queue(WISHES)
        self.portions = Portions(setup.speed is not None)
        self.twin = Twin(setup.system, setup.integral, setup.scenario)
        self.places = Places(setup.system, setup.scenario, self.twin.fed.values)
        self._signals = [k.path for k in setup.engine.signals]
        self._turn = {
            k.path: 1.0 if k.counts is None else 2 * np.pi / k.counts for k in setup.engine.signals
        }
        self._shown = [n for n in self._signals if n in self.twin.sensors]
        own: Engine = setup.engine.configured()
        self._second, self._decision = own, setup.decision(own)
        self._round = self._skipped = self._skipped_told = 0
        self._trouble = ""  # why the virtual machine stands still

    def ask(self, message: dict[str, Any], refuse: Refuse | None = None) -> None:
        """Somebody wishes something; from any thread, never waits."""
        refuse = refuse or self._messages.refused
        try:
            self._wishes.put_nowait((message, refuse))
        except Full:
            refuse("Too much is wished at once: try again.")

    def run(self, end: Event) -> None:
        """Follow until the end."""
        while not end.is_set():
            self._listen()
            portion = self.portions.take(_LOOK)
            self._messages.flush()
            if portion is None:
                continue
            if portion.frame is None:
                self._begin(portion.round)
            elif portion.round == self._round:
                self._follow(portion, portion.frame)

    # --------------------------------------------------------------------------- samples

    def _begin(self, number: int) -> None:
        self._round, self._trouble = number, ""
        self._skipped = self._skipped_told = 0
        self.twin.restart()
        self._second.reset()
        self._decision = self._setup.decision(self._second)
        self._injected()

    def _follow(self, portion: Portion, frame: dict[str, Any]) -> None:
        """Go on to further samples, and tell the frame of them."""
        if portion.skipped:
            self._skip(portion.skipped)
        rows, read, decided = self._advance(portion.time, portion.told)
        frame["virtual"]["p"] = self.places.virtual(rows)
        if decided is not None:
            frame["virtual"]["r"] = strips(decided)
        for name, values in zip(self._shown, frame["s"], strict=True):
            if name in read:
                values[1] = short(float(read[name][-1]) * self._turn[name])
        self._messages.frame(self._round, frame)

    def sensors(
        self, told: Mapping[str, Array], wanted: Mapping[str, float]
    ) -> list[list[float | None]]:
        """What sensors show at the last of some samples: real, virtual (not known yet), desired."""
        real = {n: short(float(told[n][-1]) * self._turn[n]) for n in self._shown}
        return [[real[n], None, short(wanted[n]) if n in wanted else None] for n in self._shown]

    def _skip(self, count: int) -> None:
        """Samples were left out: what the filters know is of before."""
        self._second.reset()
        self._decision.restart()
        self._skipped += count
        if self._skipped >= 2 * self._skipped_told:
            self._skipped_told = self._skipped
            text = f"the virtual machine is too slow: it left out {self._skipped} samples"
            self._verdict(Verdict("gap", self.twin.time, message=text))

    def _advance(
        self, time: Array, told: Mapping[str, Array]
    ) -> tuple[list[dict[str, float]], dict[str, Array], Batch | None]:
        """The virtual machine goes on, and is watched as the real one is."""
        if self._trouble:
            return [], {}, None
        try:
            commands = {n: c for n, c in told.items() if n not in self.twin.sensors}
            rows, read = self.twin.advance(time, commands)
        except (SimulationError, CompileError) as error:
            self._stuck(str(error))
            return [], {}, None
        except KeyError as error:
            self._stuck(f"`{error.args[0]}` has no value: give it one in the scenario")
            return [], {}, None
        names = self._signals[: self._setup.own]
        table = np.column_stack([read[n] if n in read else told[n] for n in names])
        batch = self._second.run(table)
        for verdict in self._decision.update(time, batch, table):
            self._verdict(verdict)
        return rows, read, self._decision.decided()

    def _stuck(self, why: str) -> None:
        self._trouble = why
        message = f"the virtual machine stands still: {why}"
        self._verdict(Verdict("invalid", self.twin.time, message=message))

    def _verdict(self, verdict: Verdict) -> None:
        self._messages.verdict(self._round, "virtual", verdict)

    # ---------------------------------------------------------------------------- wishes

    def _listen(self) -> None:
        """Do a few of the wishes: samples come next."""
        for _ in range(_A_TURN):
            try:
                message, refuse = self._wishes.get_nowait()
            except Empty:
                return
            why = self._do(message)
            if why:
                refuse(why)

    def _do(self, message: dict[str, Any]) -> str:
        """Do what is wished; or why it cannot be done."""
        match message.get("do"):
            case "inject":
                fault = wish(message, self._setup.scenario.faults, self._targets)
                if isinstance(fault, str):
                    return f"Not injected: {fault}."
                if len(self.twin.fed.faults) >= INJECTED:
                    return f"Not injected: {INJECTED} faults are already; take all back first."
                self.twin.inject(fault)
                self._injected()
            case "clear":
                self.twin.clear()
                self._injected()
            case "reset" | "pause" | "go" as what if self._control(what):
                pass
            case _:
                return "That cannot be done here."
        return ""

    def _injected(self) -> None:
        self._messages.faults(self._round, [f.label for f in self.twin.fed.faults])
