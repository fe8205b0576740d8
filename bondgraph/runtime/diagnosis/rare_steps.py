"""Where commands and switches make steps that are rare: sensors may answer to these with a peak."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.log import Array, Mask

_LATE = 2  # samples behind a step in which sensors answer to it
_NEAR = 3.0  # times as small as a step are those that still come near to it
_RARE = 0.1  # share of the steps of a command that are about as large as one that is rare


def sizes(steered: Array) -> Array:
    """Of the steps to each sample of what is `steered`, (n, commands); no number makes none."""
    found = np.abs(np.diff(steered, axis=0, prepend=steered[:1]))
    return np.where(np.isfinite(found), found, 0.0)


def _pulses(steered: Array) -> Mask:
    """Which steps the next one takes back, or take the last one back: those of a pulse."""
    steps = np.diff(steered, axis=0, prepend=steered[:1], append=steered[-1:])
    larger = np.maximum(np.abs(steps[1:]), np.abs(steps[:-1]))
    back = _NEAR * np.abs(steps[1:] + steps[:-1]) < larger
    return np.asarray(back | np.concatenate([np.zeros_like(back[:1]), back[:-1]]))


def rare_steps(steered: Array, commands: int = 0) -> Mask:
    """Which steps of what is `steered`, (n, commands), are rare: few others come near to them.

    Those of a command that is held over some samples, of a converter or of a noisy reading are not.
    Nor are those of a pulse of one of so many `commands`, the first ones: a machine that such a
    pulse moves does so with it.

    >>> on = np.zeros((40, 1))
    >>> on[25:] = 1.0
    >>> np.flatnonzero(rare_steps(on)).tolist()
    [25]
    >>> np.flatnonzero(rare_steps(np.arange(40)[:, None] // 4 % 2 * 1.0)).tolist()
    []
    """
    steps = sizes(steered)
    usual = len(steps) - 1 - int(_RARE * len(steps))
    rare = np.asarray(steps > _NEAR * np.partition(steps, usual, axis=0)[usual])
    rare[:, :commands] &= ~_pulses(steered[:, :commands])
    return rare


def answered(steps: Array) -> Array:
    """The largest of the steps (n,) to a sample and to as many before it as sensors may be late."""
    behind = [np.concatenate([np.zeros(k), steps[: len(steps) - k]]) for k in range(_LATE + 1)]
    return np.asarray(np.max(behind, axis=0))


def answers(rare: Mask) -> Mask:
    """At which samples, (n, 1), sensors may answer to such steps.

    >>> answers(np.arange(9)[:, None] == 4)[:, 0].nonzero()[0].tolist()
    [4, 5, 6]
    """
    return answered(np.where(rare.any(axis=1), 1.0, 0.0))[:, None] > 0.0
