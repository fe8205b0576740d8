"""How a relation that was derived by hand is written down, and the books its laws are from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from tests.adversary.plant import NOTHING

CIRCUITS = "Kirchhoff's laws: Desoer & Kuh, Basic Circuit Theory"
DIODE = "Kirchhoff's laws and Shockley's diode: Sedra & Smith, Microelectronic Circuits"
COILS = "Faraday's law of coupled coils: Fitzgerald, Kingsley & Umans, Electric Machinery"
CONVERTER = (
    "averaged voltage of the coil and current of the capacitor: Erickson & Maksimovic, "
    "Fundamentals of Power Electronics"
)
SWITCHED = "Kirchhoff's or Newton's laws in each mode: Borutzky, Bond Graph Methodology"
MACHINE = (
    "voltage law of the armature and torque balance of the rotor: Karnopp, Margolis & Rosenberg, "
    "System Dynamics"
)
FIELDS = (
    "energy of a two-port store and its partial derivatives: Karnopp, Margolis & Rosenberg, "
    "System Dynamics"
)
NEWTON = "Newton's and Euler's laws: Karnopp, Margolis & Rosenberg, System Dynamics"
RIGID = "Euler's equations of the rigid body: Goldstein, Classical Mechanics"
VIRTUAL = "virtual power of a mechanism of one degree of freedom: Goldstein, Classical Mechanics"
FRICTION = (
    "Newton's law with friction that falls with speed: Armstrong-Helouvry, Dupont & Canudas de "
    "Wit, A survey of models, analysis tools and compensation methods for the control of machines "
    "with friction"
)
VEHICLE = "Newton's law of body and wheel: Gillespie, Fundamentals of Vehicle Dynamics"
ROBOT = (
    "voltage law, torque balances and law of the shaft: Merzouki, Fawaz & Ould Bouamama, "
    "Adaptive Monitoring of Mobile Robot"
)
TANKS = (
    "volume balance of each tank, Torricelli's law of each opening: Samantaray & Ould Bouamama, "
    "Model-based Process Supervision; Blanke, Kinnaert, Lunze & Staroswiecki, Diagnosis and "
    "Fault-Tolerant Control"
)
OIL = "continuity of a compressible volume, orifice: Merritt, Hydraulic Control Systems"
HEAT = (
    "energy balance of a lumped capacity: Incropera & DeWitt, Fundamentals of Heat and Mass "
    "Transfer"
)
REACTION = (
    "mole balances and mass action: Oster, Perelson & Katchalsky, Network thermodynamics; "
    "Levenspiel, Chemical Reaction Engineering"
)
REDUNDANT = (
    "one quantity measured twice: Samantaray & Ould Bouamama, Model-based Process Supervision"
)


class Relation(NamedTuple):
    """One relation: in words, as an expression that vanishes, and the faults that it must see.

    `form` may have steps `x = ...;` before the expression; `D(x, k)` is the k-th derivative and
    `Int(x, a)` the integral from the value a.
    """

    words: str
    form: str
    signature: str


class Form(NamedTuple):
    """What is expected of one model: all of its relations, and the faults that nothing sees.

    `positive` names the signals that the random points must keep above zero, `modes` those that
    are on or off, `values` those of parameters that a law binds (a speed below that of light).
    `starts` is added to the start of every integral, a number for each point: where most start, at
    0, too much vanishes.
    """

    model: str
    domain: str
    source: str
    relations: list[Relation]
    undetectable: str = ""
    positive: str = ""
    modes: str = ""
    values: Mapping[str, float] = NOTHING
    starts: tuple[float, ...] = (1.4, 0.3, -1.6)
