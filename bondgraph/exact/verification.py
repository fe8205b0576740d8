"""What the exact verification of a compile did, for display."""

from __future__ import annotations

from typing import NamedTuple


class Verification(NamedTuple):
    """Residuals and signatures as checked: how often, on what, and by which method.

    `trajectories` counts the healthy and faulty plants that were simulated, `residuals` the
    residuals that vanished on the healthy ones, `faults` the faults whose effect was compared
    with the signature matrix, of `candidates` in all. `method` is a sentence for people.
    """

    trajectories: int
    residuals: int
    faults: int
    candidates: int
    method: str
