"""How far sensors go where an input moves much: what such a move explains of a spike.

A voltage behind a resistance has a peak wherever its current has one, and a current that was usual
may turn as sharply as it never did. A peak of the voltage there is no error of its sensor.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.plain import array, numbers

_LATE = 2  # samples behind a move in which a sensor answers to it
_LARGE = 0.5  # of the largest move of an input: from there on what sensors do may be its doing


class InputMoves:
    """Of each sensor, how far it goes beside each input, by healthy samples; `drive` says which of
    the signals are inputs.

    Signals are told by their bends, by how much samples are off the middle of the two beside them.
    That is linear: a machine that passes on what an input does has bends in proportion, whatever
    they look like. So how far a sensor goes is the root of the mean square of its bends beside the
    input's, of large ones: beside small ones a sensor has noise, and a command that is made of it
    would look like its cause. It is too much rather than too little, as noise is part of it.
    """

    def __init__(self, drive: Mask) -> None:
        self._inputs = np.flatnonzero(drive)
        self._sensors = ~drive
        self._largest = np.zeros(len(self._inputs))  # bend of each input
        self._squares = np.zeros((2, len(drive), len(self._inputs)))  # sums: of sensors, of inputs

    def learn(self, bends: Array, sensors: Mask, inputs: Mask) -> None:
        """Healthy samples more, the bends (n, signals) of them and of so many on either side as a
        sensor may be late; of these `sensors`, and beside these `inputs`."""
        own = bends[_LATE : len(bends) - _LATE]
        moves = np.where(inputs[self._inputs], np.nan_to_num(own[:, self._inputs]), 0.0)
        most = moves.max(axis=0, initial=0.0)
        grown = most > self._largest / _LARGE  # of what was large before little is so now
        self._largest[grown], self._squares[:, :, grown] = most[grown], 0.0
        large = np.where(moves >= _LARGE * self._largest, moves, 0.0)
        answers = _most(bends[_LATE:])
        known = np.isfinite(answers) & sensors
        answers = np.where(known, answers, 0.0)
        self._squares[0] += np.square(answers).T @ (1.0 * (large > 0.0))
        self._squares[1] += (1.0 * known).T @ np.square(large)

    def explain(self, bends: Array, most: Array) -> Array:
        """How far sensors may be bent at samples (n, signals) by what inputs do there or did just
        before, with `bends` as above; by a unit of an input no further than `most`, (signals,
        inputs).

        By an input of which no move is known a sensor may go as far as that.
        """
        moves = np.nan_to_num(_most(bends[:-_LATE, self._inputs]))
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.sqrt(self._squares[0] / self._squares[1])
        share = np.where(self._squares[1] > 0.0, share, np.inf)
        found = np.zeros((len(moves), len(self._sensors)))
        for at, move in enumerate(moves.T):
            passes = np.where(self._sensors, np.minimum(share, most)[:, at], 0.0)
            moving = move > 0.0
            found[moving] = np.maximum(found[moving], move[moving, None] * passes)
        return found

    def state(self) -> list[Any]:
        """What is known, as plain JSON."""
        return [numbers(self._largest), numbers(self._squares)]

    def resume(self, state: Any) -> None:
        """Go on from a state; raises TypeError or ValueError for one of another kind."""
        largest, squares = state
        self._largest = array(largest, self._largest.shape)
        self._squares = array(squares, self._squares.shape)


def passed_on(engine: Engine, names: Sequence[str], sample: Array, sizes: Array) -> Array:
    """How far a signal goes at most, in one sample, for a unit that another one goes in it.

    Where relations tell all sensors, these do what keeps all relations at zero: (signals, signals),
    of sensors by inputs. Elsewhere each alone may be what does, in the relations that have both: by
    how much the other one moves such a residual in that sample, over by how much the signal itself
    does; infinite where none has both. Near a `sample` of all signals, with the `sizes` of those
    that have these names. An encoder is a sensor, too: it may answer as well.
    """
    kinds, own = {k.path: k.kind for k in engine.signals}, len(names)
    others = [n for n, kind in kinds.items() if kind == "sensor" and n not in names]
    names, sizes = [*names, *others], np.concatenate([sizes, np.ones(len(others))])
    sizes = np.where(np.isfinite(sizes) & (sizes > 0.0), sizes, 1.0)  # of what stands still as well
    known = [Hypothesis(name, "offset", "", float(size), False)
             for name, size in zip(names, sizes, strict=True)]  # fmt: skip
    rests = engine.configured(bounds=False)
    rests.run(np.repeat(sample[None], math.ceil(rests.warm_up / rests.sample_time) + 1, axis=0))
    moved = Bank(rests, known, {}, sample).run(sample[None])[0]
    size = np.abs(moved)
    both = (size[:, None] > 0.0) & (size[None] > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where(both, size[None] / size[:, None], 0.0).max(axis=2, initial=0.0)
    found = np.where(both.any(axis=2), ratio, math.inf)
    sensors = [at for at, name in enumerate(names) if kinds[name] == "sensor"]
    inputs = [at for at, name in enumerate(names) if kinds[name] == "input"]
    scaled = moved * sizes[:, None] / np.maximum((size * sizes[:, None]).max(axis=0), 1e-300)
    told = len(sensors) > 0 and np.isfinite(scaled).all()
    if told and np.linalg.matrix_rank(scaled[sensors]) == len(sensors):
        made = np.abs(scaled[inputs] @ np.linalg.pinv(scaled[sensors])).T  # (sensors, inputs)
        found[np.ix_(sensors, inputs)] = made * sizes[sensors, None] / sizes[inputs]
    return found[:own, :own]


def _most(bends: Array) -> Array:
    """The largest bend of each sample and of as many behind it as a sensor may be late."""
    count = len(bends) - _LATE
    found = bends[:count]
    for late in range(1, _LATE + 1):
        found = np.fmax(found, bends[late : late + count])
    return found
