"""The element kinds as data: keywords, ports, law variables, states and causal preferences."""

from __future__ import annotations

from typing import Literal

from bondgraph.text.tuples import NamedTuple


class ElementKind(NamedTuple):
    """What the compiler knows of one keyword.

    `kind` is the keyword without its M (modulated). `ports` are the names of the fixed ports, ""
    for the only one; a kind with `fields` may declare named ports instead. `variables` may stand in
    a law. `states` are the quantities that a port may store: q of a C (q' = f), p of an I (p' = e);
    which one a port of an IC stores is seen from its law. `coefficient` says what a value after `=`
    is, "" where none is allowed, and `law` is an example of a law in braces.
    """

    keyword: str
    kind: str
    ports: tuple[str, ...]
    variables: tuple[str, ...]
    states: tuple[Literal["q", "p"], ...]
    fields: bool
    coefficient: str
    law: str

    @property
    def modulated(self) -> bool:
        """Whether the keyword says that a signal drives the element."""
        return self.keyword != self.kind

    @property
    def passive(self) -> bool:
        """Whether the one-port rule for signs holds: R, C, I and their fields."""
        return self.kind in PASSIVE


#: Kinds of passive elements; those with a state.
PASSIVE = ("R", "C", "I", "IC")
STORAGES = PASSIVE[1:]

_ONE = ("",)
_TWO = ("1", "2")
_PAIRS = ("e1", "f1", "e2", "f2")

_ALL = (
    ElementKind("R", "R", _ONE, ("e", "f"), (), True, "resistance", "e = R*f"),
    ElementKind("MR", "R", _ONE, ("e", "f"), (), True, "resistance", "e = R*f"),
    ElementKind("C", "C", _ONE, ("e", "f", "q"), ("q",), True, "capacitance", "e = q/C"),
    ElementKind("I", "I", _ONE, ("e", "f", "p"), ("p",), True, "inertia", "f = p/I"),
    ElementKind(
        "IC", "IC", _ONE, ("e", "f", "q", "p"), ("q", "p"), True, "", "el.f = el.p*gap.q/k"
    ),
    ElementKind("TF", "TF", _TWO, _PAIRS, (), False, "", "f1 = m*f2"),
    ElementKind("MTF", "TF", _TWO, _PAIRS, (), False, "", "f1 = m*f2"),
    ElementKind("GY", "GY", _TWO, _PAIRS, (), False, "ratio", "e1 = k*f2"),
    ElementKind("MGY", "GY", _TWO, _PAIRS, (), False, "ratio", "e1 = k*f2"),
    ElementKind("Se", "Se", _ONE, ("e",), (), False, "effort", "e = U"),
    ElementKind("MSe", "Se", _ONE, ("e",), (), False, "effort", "e = U"),
    ElementKind("Sf", "Sf", _ONE, ("f",), (), False, "flow", "f = Q"),
    ElementKind("MSf", "Sf", _ONE, ("f",), (), False, "flow", "f = Q"),
    ElementKind("De", "De", _ONE, (), (), False, "detector", ""),
    ElementKind("Df", "Df", _ONE, (), (), False, "detector", ""),
)

#: Every keyword that may stand before `:` beside `0`, `1` and the names of models.
KINDS: dict[str, ElementKind] = {k.keyword: k for k in _ALL}

JUNCTIONS = ("0", "1")

#: Suffixes that make a signal of a node: `x.e`, `gear.f1`.
SIGNALS = frozenset({"e", "f", "p", "q", "e1", "f1", "e2", "f2"})
