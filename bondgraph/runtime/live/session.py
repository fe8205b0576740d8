"""A virtual machine in step with a monitored one: both watched, both told to a page."""

from __future__ import annotations

import math
import time as clocks
from collections.abc import Callable, Mapping
from queue import Empty, SimpleQueue
from typing import Any

import numpy as np

from bondgraph.runtime.live.positions import Places
from bondgraph.runtime.live.samples import Paced
from bondgraph.runtime.live.setup import Heard, Setup, Target, wish
from bondgraph.runtime.live.twin import Twin
from bondgraph.runtime.log import Array, LogError
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.sample_pipeline import Monitor
from bondgraph.runtime.monitoring.verdict import Verdict, described
from bondgraph.runtime.monitoring.watch_parts import Parts, Stop
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.text.diagnostic import CompileError

Say = Callable[[dict[str, Any]], None]

_FRAMES = 20.0  # a second
_APART = 0.8 / _FRAMES  # s on the wall, at least; samples that come oftener share a frame
_PACED = 2.0  # s on the wall between two words on how fast it goes


class Session:
    """Runs in a thread of its own until stopped; `say` hears what a page is to be told.

    `ask` takes the wishes of people, from any thread: inject, clear, reset, pause, go.
    """

    def __init__(self, setup: Setup, targets: Mapping[str, Target], say: Say) -> None:
        self._setup, self._targets, self._say = setup, targets, say
        self._wishes: SimpleQueue[dict[str, Any]] = SimpleQueue()
        self._end = Stop()
        self._round = Stop()
        self.twin = Twin(setup.system, setup.integral, setup.scenario)
        self.places = Places(setup.system, setup.scenario, self.twin.fed.values)
        self._signals = [k.path for k in setup.engine.signals]
        self._turn = {
            k.path: 1.0 if k.counts is None else 2 * math.pi / k.counts
            for k in setup.engine.signals
        }
        own: Engine = setup.engine.configured()
        self._second, self._second_decision = own, setup.decision(own)
        self._source: Paced | None = None
        self._number = 0
        self._trouble = ""  # why the virtual machine stands still
        self._over = ""  # why no more samples come
        self._waiting: dict[str, Any] | None = None  # a frame that is not full
        self._framed = 0.0  # on the wall, when the last one was told
        self._paced = 0.0  # on the wall, when the pace was told
        self._state: dict[str, Any] = {}

    # ---------------------------------------------------------------- from other threads

    def ask(self, message: dict[str, Any]) -> None:
        """Somebody wishes something."""
        self._wishes.put(message)

    def stop(self, reason: str) -> None:
        """End as soon as possible."""
        self._end.ask(reason)
        self._round.ask(reason)

    # ---------------------------------------------------------------------------- rounds

    def run(self) -> None:
        """Watch until stopped; each reset begins a new watch."""
        while not self._end.is_set():
            self._round, self._over = Stop(), ""
            self._begin()
            try:
                self._watch()
                text = "The samples have ended."
            except LogError as error:
                text = f"{error}"
            except OSError as error:
                text = f"{error.strerror or error}"
            if self._end.is_set():
                break
            if not self._round.is_set():
                self._over = text
                self._told("ended", text)
                while not self._round.is_set() and not self._end.is_set():
                    self._between(0.2)

    def _begin(self) -> None:
        self.twin.restart()
        self.places.restart()
        self._second.reset()
        self._second_decision = self._setup.decision(self._second)
        self._trouble, self._waiting = "", None
        self._say({"type": "reset"})
        self._told("waiting", "Waiting for the first sample.")
        self._injected()

    def _watch(self) -> None:
        setup = self._setup
        portion = (setup.speed or 1.0) / _FRAMES
        inner = setup.source()
        source = Paced(inner, portion, setup.speed, self._between)
        source.paused = bool(self._source and self._source.paused)
        self._source = source
        setup.engine.reset()
        own = setup.engine.configured()  # copies may be run beside it: it is that of the residuals
        heard = Heard(setup.decision(own), setup.own, self._hear)
        parts = Parts(
            source,
            setup.columns(),
            setup.clock(),
            setup.engine,
            heard,
            [lambda _, verdict: self._verdict("real", verdict)],
            operating=setup.operating(),
        )
        if self._end.is_set():
            source.close()
            return
        Monitor(parts, setup.what).run(self._round)

    # --------------------------------------------------------------------------- samples

    def _hear(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples of the monitored machine have been decided on: let the virtual one follow."""
        if not len(time):
            return
        told = {n: samples[:, k] for k, n in enumerate(self._signals)}
        real = self.places.real(time, told)
        wanted, shown = self.places.desired(time)
        rows, read, second = self._follow(time, told)
        frame: dict[str, Any] = {
            "type": "frame",
            "t": round(float(time[-1]), 6),
            "real": {"p": real, "r": _strips(batch)},
            "virtual": {"p": self.places.virtual(rows)},
            "desired": {"p": wanted},
        }
        if second is not None:
            frame["virtual"]["r"] = _strips(second)
        if not self.places.names:
            frame["s"] = [
                [_short(float(told[n][-1]) * self._turn[n]),
                 _short(float(read[n][-1]) * self._turn[n]) if n in read else None,
                 _short(shown[n]) if n in shown else None]
                for n in self._signals if n in self.twin.sensors
            ]  # fmt: skip
        self._waiting = frame if self._waiting is None else _merged(self._waiting, frame)
        self._pace()

    def _flush(self) -> None:
        """Tell what has gathered since the last frame."""
        if self._waiting is not None:
            self._framed = clocks.monotonic()
            self._say(self._waiting)
            self._waiting = None

    def _follow(
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
        for verdict in self._second_decision.update(time, batch, table):
            self._verdict("virtual", verdict)
        return rows, read, self._second_decision.decided()

    def _stuck(self, why: str) -> None:
        self._trouble = why
        message = f"the virtual machine stands still: {why}"
        self._verdict("virtual", Verdict("invalid", self.twin.time, message=message))

    def _pace(self) -> None:
        """Tell whether samples keep up with the time on the wall."""
        source, speed = self._source, self._setup.speed
        assert source is not None
        if source.paused:
            return
        pace, now = source.pace, clocks.monotonic()
        slow = speed is not None and pace is not None and pace < 0.85 * speed
        if slow == (self._state["state"] == "slow") and now - self._paced < _PACED:
            return
        self._paced = now
        if slow and pace is not None:
            text = f"slower than it should be: × {pace:.1f} instead of × {speed:g}"
            self._told("slow", text, round(pace, 1))
        else:
            self._told("running", "", speed)

    # ---------------------------------------------------------------------------- wishes

    def _between(self, patience: float = 0.0) -> None:
        """Do what people wish, and tell what nothing more came to for a while."""
        if clocks.monotonic() - self._framed > _APART:
            self._flush()
        while True:
            try:
                message = self._wishes.get(patience > 0, patience or None)
            except Empty:
                return
            patience = 0.0
            self._do(message)

    def _do(self, message: dict[str, Any]) -> None:
        match message.get("do"):
            case "inject":
                fault = wish(message, self._setup, self._targets)
                if isinstance(fault, str):
                    self._say({"type": "refused", "message": f"Not injected: {fault}."})
                    return
                self.twin.inject(fault)
                self._injected()
            case "clear":
                self.twin.clear()
                self._injected()
            case "reset":
                if self._setup.renews:
                    self._round.ask("a reset")
                else:
                    self._begin()
                    if self._over:
                        self._told("ended", self._over)
            case "pause" | "go" as what if self._setup.speed is not None and self._source:
                self._source.paused = what == "pause"
                if what == "pause":
                    self._told("paused", "Both machines stand still.")
                else:
                    self._told("running", "")
            case _:
                self._say({"type": "refused", "message": "That cannot be done here."})

    def _injected(self) -> None:
        self._say({"type": "faults", "active": [f.label for f in self.twin.fed.faults]})

    # ---------------------------------------------------------------------------- saying

    def _told(self, state: str, text: str, pace: float | None = None) -> None:
        self._flush()
        message = {"type": "state", "state": state, "text": text, "pace": pace}
        if message != self._state:
            self._state = message
            self._say(message)

    def _verdict(self, whose: str, verdict: Verdict) -> None:
        self._number += 1
        self._say({
            "type": "verdict",
            "number": self._number,
            "whose": whose,
            "event": verdict.event,
            "time": _short(verdict.time),
            "since": None if verdict.since is None else _short(verdict.since),
            "fired": list(verdict.residuals),
            "group": list(verdict.group),
            "candidates": [
                [c.fault, None if c.size is None else _short(c.size), c.unit,
                 round(c.probability, 4)]
                for c in verdict.candidates
            ],
            "message": verdict.message or described(verdict),
        })  # fmt: skip


def _merged(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    """One frame of two that follow each other: what is at the end, and the range of residuals."""
    for whose in ("real", "virtual"):
        pairs = zip(before[whose].get("r", ()), after[whose].get("r", ()), strict=False)
        for old, new in pairs:
            if None not in (old[0], new[0]):
                new[:2] = [min(old[0], new[0]), max(old[1], new[1])]
                new[2] = max((x[2] for x in (old, new) if x[2] is not None), default=None)
                new[3] = old[3] or new[3]
    return after


def _strips(batch: Batch) -> list[list[float | bool | None]]:
    """Of each residual in these samples the least and the largest value, the whole threshold, and
    whether one of them is further out."""
    found: list[list[float | bool | None]] = []
    for k in range(batch.value.shape[1]):
        good = batch.valid[:, k]
        if not good.any():
            found.append([None, None, None, False])
            continue
        value, bound = batch.value[good, k], batch.bound[good, k]
        out = bool((np.abs(value) > bound).any())
        limit = _short(float(bound.max()))
        found.append([_short(float(value.min())), _short(float(value.max())), limit, out])
    return found


def _short(value: float) -> float | None:
    """A number as a page needs it: five digits, None for what is none."""
    return float(f"{value:.5g}") if math.isfinite(value) else None
