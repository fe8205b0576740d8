"""One run of a machine as a report shows it: residuals, trajectories, what was said and when."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.text.tuples import NamedTuple

Array: TypeAlias = npt.NDArray[np.float64]


class Trace(NamedTuple):
    """A signal over the time of its episode, each (n,).

    `bound` is the threshold on both sides (None: there is none); where `valid` is False the value
    says nothing. A NaN is no sample.
    """

    name: str
    value: Array
    unit: str = ""
    bound: Array | None = None
    valid: npt.NDArray[np.bool_] | None = None


class Panel(NamedTuple):
    """Signals of one unit over each other in one strip, as a speed wanted and a speed reached."""

    title: str
    unit: str
    traces: tuple[Trace, ...]


class Curve(NamedTuple):
    """A line in a plane: desired, virtual, real; x and y each (n,)."""

    name: str
    x: Array
    y: Array


class Plane(NamedTuple):
    """Curves over the same two axes; `x` and `y` say what they are, with units. Equal scales."""

    title: str
    x: str
    y: str
    curves: tuple[Curve, ...]


class Mark(NamedTuple):
    """A moment in s at which something was done to the machine: a fault set in, or went."""

    time: float
    text: str


class Said(NamedTuple):
    """A verdict from `start` to `end` s (None: to the end of the episode).

    `kind` is fault, invalid, gap or warm-up; `text` the sentence for people, `short` the few words
    for the time line, `since` the onset that the monitor estimates.
    """

    kind: str
    start: float
    end: float | None
    short: str
    text: str
    since: float | None = None


class Episode(NamedTuple):
    """A scenario as it went; `time` in s, (n,), ascending. `facts` are (name, text) for a list."""

    name: str
    doc: str
    time: Array
    residuals: tuple[Trace, ...]
    panels: tuple[Panel, ...] = ()
    planes: tuple[Plane, ...] = ()
    marks: tuple[Mark, ...] = ()
    said: tuple[Said, ...] = ()
    facts: tuple[tuple[str, str], ...] = ()


def envelope(time: Array, value: Array, bins: int) -> tuple[Array, Array]:
    """The least and the largest of each of so many stretches, in their order, so that spikes stay.

    A stretch without a sample is one NaN: the line breaks there. At most 2 `bins` points.

    >>> t = np.arange(10.0); v = np.zeros(10); v[7] = 5
    >>> envelope(t, v, 2)[1].tolist()
    [0.0, 0.0, 0.0, 5.0]
    """
    if len(time) <= 2 * bins:
        return time, value
    edges = np.linspace(0, len(time), bins + 1).astype(int)
    first, size = edges[:-1], np.diff(edges)
    inner = np.arange(size.max())
    within = inner < size[:, None]
    part = np.where(within, value[np.minimum(first[:, None] + inner, len(value) - 1)], np.nan)
    gap = np.isnan(part)
    low = np.where(gap, np.inf, part).argmin(axis=1)
    high = np.where(gap, -np.inf, part).argmax(axis=1)
    flat = (low == high) & (low == 0) & ~gap[np.arange(bins), size - 1]
    high = np.where(flat, size - 1, high)
    open_ = (gap & within).any(axis=1)  # a gap inside of a stretch is shown, too
    hole = (gap & within).argmax(axis=1)
    some = ~gap.all(axis=1)
    parts = [(first + low)[some], (first + high)[some], (first + hole)[open_]]
    order = np.unique(np.concatenate(parts))
    return time[order], value[order]


def coarse(
    inside: npt.NDArray[np.bool_], time: Array, bins: int
) -> tuple[npt.NDArray[np.bool_], Array]:
    """Whether something holds anywhere in each of so many stretches, and when they begin."""
    if len(time) <= bins:
        return inside, time
    edges = np.linspace(0, len(time), bins + 1).astype(int)[:-1]
    found = np.logical_or.reduceat(inside, edges)
    return np.append(found, False), np.append(time[edges], time[-1])


def stretches(inside: npt.NDArray[np.bool_], time: Array) -> list[tuple[float, float]]:
    """From when to when something holds, in s; of a single sample up to the next one.

    >>> stretches(np.array([False, True, True, False]), np.arange(4.0))
    [(1.0, 3.0)]
    """
    if not len(inside):
        return []
    steps = np.diff(np.concatenate([[0], inside.astype(int), [0]]))
    first, last = np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)
    end = np.minimum(last, len(time) - 1)
    return [(float(time[a]), float(time[b])) for a, b in zip(first, end, strict=True)]
