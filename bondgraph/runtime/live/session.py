"""A monitored machine and its virtual twin: the watch of one, the following of the other."""

from __future__ import annotations

from collections.abc import Mapping
from threading import Event, Thread
from typing import Any

import numpy as np

from bondgraph.runtime.live.follower import Follower
from bondgraph.runtime.live.messages import FRAMES, Messages, Say, strips
from bondgraph.runtime.live.portions import Portion
from bondgraph.runtime.live.samples import Paced
from bondgraph.runtime.live.setup import Heard, Setup, Target
from bondgraph.runtime.log import Array, LogError
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.sample_pipeline import Monitor
from bondgraph.runtime.monitoring.watch_parts import Parts, Stop

_NOTHING = np.empty(0)


class Session:
    """Runs until stopped; `say` hears what a page is to be told, from two threads.

    The watch is in the thread that calls `run`, the twin in another one: see `Follower`.
    """

    def __init__(self, setup: Setup, targets: Mapping[str, Target], say: Say) -> None:
        self._setup = setup
        self._messages = Messages(say)
        self._end = Stop()
        self._round = Stop()
        self._anew = Event()  # a real machine is to reckon anew
        self._number = 0  # of the round
        self._follower = Follower(setup, targets, self._messages, self._control)
        self.places = self._follower.places
        self.ask = self._follower.ask
        self._signals = [k.path for k in setup.engine.signals]
        self._source: Paced | None = None
        self._over = ""  # why no more samples come
        self._failed: BaseException | None = None  # of the other thread

    def stop(self, reason: str) -> None:
        """End as soon as possible; from any thread."""
        self._end.ask(reason)
        self._round.ask(reason)

    # ---------------------------------------------------------------------------- rounds

    def run(self) -> None:
        """Watch until stopped; each reset begins a new watch."""
        twin = Thread(target=self._follow, name="twin", daemon=True)
        twin.start()
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
                self._alone(self._follower.portions.finish(self._round))
                self._messages.state("ended", text)
                while not self._round.wait(0.1) and not self._end.is_set():
                    self._between()
        if self._failed is not None:
            raise self._failed

    def _follow(self) -> None:
        try:
            self._follower.run(self._end)
        except BaseException as error:
            self._failed = error
            self.stop("a failure")

    def _begin(self) -> None:
        self.places.restart()
        self._number = self._messages.begin()
        self._messages.state("waiting", "Waiting for the first sample.")
        self._follower.portions.begin(Portion(self._number, None, _NOTHING, {}))

    def _watch(self) -> None:
        setup = self._setup
        inner = setup.source()
        source = Paced(inner, (setup.speed or 1.0) / FRAMES, setup.speed, self._between)
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
            [lambda _, verdict: self._messages.verdict(self._number, "real", verdict)],
            operating=setup.operating(),
        )
        if self._end.is_set():
            source.close()
            return
        Monitor(parts, setup.what).run(self._round)

    def _hear(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples of the monitored machine have been decided on: let the virtual one follow."""
        if not len(time):
            return
        samples = samples.copy()  # read by another thread
        told = {n: samples[:, k] for k, n in enumerate(self._signals)}
        wanted, shown = self.places.desired(time)
        frame: dict[str, Any] = {
            "type": "frame",
            "t": round(float(time[-1]), 6),
            "real": {"p": self.places.real(time, told), "r": strips(batch)},
            "virtual": {"p": []},
            "desired": {"p": wanted},
            "s": self._follower.sensors(told, shown),
        }
        portion = Portion(self._number, frame, time.copy(), told)
        self._alone(self._follower.portions.put(portion, self._round))
        source = self._source
        if source is not None and not source.paused:
            self._messages.pace(source.pace, self._setup.speed)

    def _alone(self, late: list[Portion]) -> None:
        """Tell frames of what the twin was too slow for, without it."""
        for portion in late:
            if portion.frame is not None:
                self._messages.frame(portion.round, portion.frame)

    # ---------------------------------------------------------------------------- wishes

    def _control(self, what: str) -> bool:
        """Do what concerns both machines, from the thread of the twin; False: not with these."""
        source = self._source
        if what == "reset":
            if self._setup.renews:
                self._round.ask("a reset")
            else:
                self._anew.set()
            return True
        if self._setup.speed is None or source is None:
            return False
        source.paused = what == "pause"
        if source.paused:
            self._messages.state("paused", "Both machines stand still.")
        else:
            self._messages.state("running", "")
        return True

    def _between(self) -> None:
        """Begin anew if somebody wishes so, between two portions of samples."""
        if self._anew.is_set():
            self._anew.clear()
            self._begin()
            if self._over:
                self._messages.state("ended", self._over)
