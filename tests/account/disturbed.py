"""A replay of a motor that is well, with a disturbance every minute, and what has to come of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from random import Random
from typing import NamedTuple

import numpy as np

from bondgraph.runtime.log import Array

RATE = 1000  # samples a second
MINUTE = 60 * RATE  # samples
_R, _K, _J, _F = 17.6, 3.51e-3, 1.4e-8, 1.19e-5
_HEAD = "t,U,load,current,speed\n"
_NAMES = ("U", "load", "current", "speed")

#: Signals that each residual of models/dc_motor.bg reads.
READS = {"r1": ("U", "current", "speed"), "r2": ("load", "current", "speed")}


def motor(minutes: int, seed: int) -> Array:
    """The columns U, load, current, speed of a motor in quasi-steady motion, with noise.

    The voltage varies so slowly that the inductance and the inertia do not matter beside the noise.
    """
    t = np.arange(minutes * MINUTE) / RATE
    noise = np.random.default_rng(seed)
    volts = 6.0 + 2.0 * np.sin(0.5 * t)
    slope = 1.0 * np.cos(0.5 * t)
    speed = _K * volts / (_K**2 + _R * _F)
    current = _F * speed / _K
    lag = _J * _R / (_K**2 + _R * _F)  # s, of the speed behind the voltage
    speed = speed - lag * _K * slope / (_K**2 + _R * _F)
    current = (volts - _K * speed) / _R
    return np.column_stack([
        volts,
        np.zeros(len(t)),
        current + noise.normal(0.0, 1e-3, len(t)),
        speed + noise.normal(0.0, 0.5, len(t)),
    ])  # fmt: skip


class Expected(NamedTuple):
    """What the account has to say: of samples and lines by name, and of each residual.

    `blind` counts samples of the grid that each residual is blind for, `pieces` how often the
    filters begin, `grid` the samples on the grid, `causes` how often there was which disturbance.
    """

    samples: Counter[str]
    lines: Counter[str]
    blind: Counter[str]
    pieces: int
    grid: int
    causes: Counter[str]


class Replay:
    """The lines of a replay; what is expected is known once all were taken."""

    def __init__(self, minutes: int, seed: int) -> None:
        self._minutes, self._draw = minutes, Random(seed)
        self._data = motor(minutes, seed)
        self._samples: Counter[str] = Counter()
        self._lines: Counter[str] = Counter()
        self._blind: Counter[str] = Counter()
        self._causes: Counter[str] = Counter()
        self._pieces, self._missing = 1, 0

    @property
    def expected(self) -> Expected:
        """What the account has to say."""
        grid = self._minutes * MINUTE - self._missing
        return Expected(self._samples, self._lines, self._blind, self._pieces, grid, self._causes)

    def lines(self) -> Iterator[str]:
        """The text, a minute at a time."""
        yield _HEAD
        for minute in range(self._minutes):
            start = minute * MINUTE
            rows = [self._row(k) for k in range(start, start + MINUTE)]
            cause = self._draw.choice(list(_DISTURBANCES))
            at = self._draw.randrange(10 * RATE, 40 * RATE)
            count = self._draw.randrange(200, 5 * RATE)
            self._causes[cause] += 1
            self._samples["used"] += MINUTE
            yield "".join(_DISTURBANCES[cause](self, rows, at, count))

    def _row(self, k: int) -> str:
        return ",".join([repr(k / RATE), *map(repr, self._data[k].tolist())]) + "\n"

    # Each takes the rows of a minute, where it begins in them, and for how many it lasts.

    def _without(self, rows: list[str], at: int, count: int) -> list[str]:
        """Samples are lost."""
        self._samples["used"] -= count
        self._lines["lost"] += count
        self._gap(count)
        return rows[:at] + rows[at + count :]

    def _gap(self, missing: int) -> None:
        self._pieces += 1
        self._lines["gaps"] += 1
        self._missing += missing

    def _cell(self, text: str) -> Callable[[list[str], int, int], list[str]]:
        def change(rows: list[str], at: int, count: int) -> list[str]:
            which = self._draw.randrange(len(_NAMES))
            for name, reads in READS.items():
                if _NAMES[which] in reads:
                    self._blind[name] += count
            for k in range(at, at + count):
                cells = rows[k].rstrip("\n").split(",")
                cells[which + 1] = text
                rows[k] = ",".join(cells) + "\n"
            return rows

        return change

    def _nan(self, rows: list[str], at: int, count: int) -> list[str]:
        """A signal is no number."""
        return self._cell(self._draw.choice(["nan", "", "inf", "null"]))(rows, at, count)

    def _absent(self, rows: list[str], at: int, count: int) -> list[str]:
        """A column is not there."""
        for name in READS:
            self._blind[name] += count
        short = [row.rsplit(",", 1)[0] + "\n" for row in rows[at : at + count]]
        return [*rows[:at], "t,U,load,current\n", *short, _HEAD, *rows[at + count :]]

    def _empty(self, rows: list[str], at: int, count: int) -> list[str]:
        """No signal has a number."""
        self._without(rows, at, count)
        self._samples["empty"] += count
        none = [row.split(",")[0] + ",,,,\n" for row in rows[at : at + count]]
        return rows[:at] + none + rows[at + count :]

    def _still(self, rows: list[str], at: int, count: int) -> list[str]:
        """The clock stands still, and is set right."""
        self._without(rows, at, count)
        self._samples["twice"] += count
        stamp = rows[at - 1].split(",")[0]
        none = [f"{stamp},{row.split(',', 1)[1]}" for row in rows[at : at + count]]
        return rows[:at] + none + rows[at + count :]

    def _twice(self, rows: list[str], at: int, count: int) -> list[str]:
        """Samples come twice."""
        self._samples["twice"] += count
        double = [row for row in rows[at : at + count] for _ in range(2)]
        return rows[:at] + double + rows[at + count :]

    def _late(self, rows: list[str], at: int, count: int) -> list[str]:
        """Samples come behind later ones."""
        few = min(count, 40)  # a clock that goes back further begins anew
        self._samples["late"] += few - 1
        self._samples["twice"] += 1
        return rows[: at + few] + rows[at : at + few] + rows[at + few :]

    def _garbage(self, rows: list[str], at: int, count: int) -> list[str]:
        """Lines are none."""
        self._lines["garbage"] += count
        odd = ["\ufffd\x00\n", "garbage\n", "1,2\n", "{]\n", "x,y\n"]
        return rows[:at] + [odd[k % len(odd)] for k in range(count)] + rows[at:]


_DISTURBANCES: dict[str, Callable[[Replay, list[str], int, int], list[str]]] = {
    "a signal without numbers": Replay._nan,
    "a column that is absent": Replay._absent,
    "samples lost": Replay._without,
    "samples without any number": Replay._empty,
    "a clock that stands still": Replay._still,
    "samples that come twice": Replay._twice,
    "samples that come late": Replay._late,
    "lines that are none": Replay._garbage,
}
