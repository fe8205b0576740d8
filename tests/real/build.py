"""Collects one model: every call adds lines of .bg text and, apart from them, equations."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from random import Random
from types import MappingProxyType
from typing import NamedTuple

from tests.real.nodes import Node, der, integral, node, number, replaced, sym, text, total
from tests.real.plant import Equation, Plant, state_equation, wrong

Points = tuple[tuple[Fraction, Fraction], ...]
_VALUES = ("1", "2", "3", "0.5", "0.25", "1.5", "4", "0.8", "1.2", "5", "0.2")


class Model(NamedTuple):
    """A model as text, the files it needs, and the same as a plant."""

    text: str
    files: Mapping[str, str]
    plant: Plant


class Junction(NamedTuple):
    """`ends` are the signs and the variables of bonds that its balance sums."""

    name: str
    kind: str
    ends: list[tuple[int, Node]]

    @property
    def common(self) -> Node:
        return sym(self.name + (".e" if self.kind == "0" else ".f"))


class Law(NamedTuple):
    """An equation of an element in e, f, q, p (or e1 ...) and what it gives explicitly."""

    left: str
    right: Node
    inverse: Mapping[str, Node] = MappingProxyType({})


def equal(name: str, value: Node, inverse: Mapping[str, Node] | None = None) -> Equation:
    """name = value, and what that gives for others."""
    return Equation(sym(name) - value, {name: value, **(inverse or {})})


class Build:
    """One model in the making."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.head: list[str] = []
        self.body: list[str] = []
        self.equations: list[Equation] = []
        self.declared: dict[str, Fraction] = {}
        self.params: list[str] = []
        self.inputs: list[str] = []
        self.unknown: list[str] = []
        self.sensors: list[str] = []
        self.sources: list[str] = []
        self.states: list[str] = []
        self.starts: dict[str, Fraction] = {}
        self.files: dict[str, str] = {}
        self.junctions: list[Junction] = []
        self.quantities: list[Node] = []  # what a sensor may show of elements
        self._counts: dict[str, int] = {}

    # ------------------------------------------------------------------------------ names

    def fresh(self, stem: str) -> str:
        self._counts[stem] = self._counts.get(stem, 0) + 1
        return f"{stem}{self._counts[stem]}"

    def param(self, value: str | None = None, share: float = 0.06) -> Node:
        """A parameter; now and then one that another law has already."""
        if value is None and self.params and self.random.random() < share:
            return sym(self.random.choice(self.params))
        name = self.fresh("k")
        value = value or self.random.choice(_VALUES)
        self.head.append(f"param {name} = {value}")
        self.declared[name] = Fraction(value)
        self.params.append(name)
        return sym(name)

    def const(self, value: str) -> Node:
        name = self.fresh("c")
        self.head.append(f"const {name} = {value}")
        self.declared[name] = Fraction(value)
        return sym(name)

    def coefficient(self) -> Node:
        """Mostly a parameter, sometimes a constant or just a number."""
        draw = self.random.random()
        if draw < 0.8:
            return self.param()
        value = self.random.choice(_VALUES)
        return self.const(value) if draw < 0.9 else node(Fraction(value))

    def input(self, unknown: bool = False) -> Node:
        name = self.fresh("d" if unknown else "u")
        self.head.append(f"input {name}{' unknown' if unknown else ''}")
        (self.unknown if unknown else self.inputs).append(name)
        return sym(name)

    def let(self, value: Node) -> Node:
        name = self.fresh("s")
        self.body.append(f"let {name} = {text(value)}")
        self.equations.append(equal(name, value))
        return sym(name)

    def integrated(self, rate: Node, start: str = "0") -> Node:
        """The integral of a signal from its start."""
        name = self.fresh("h")
        self.body.append(f"let {name} = {text(integral(rate, Fraction(start)))}")
        slope = der(sym(name))
        self.equations.append(Equation(slope - rate, {}))
        self.states.append(name)
        self.starts[name] = Fraction(start)
        return sym(name)

    def table(self, points: Points) -> str:
        name = self.fresh("t") + ".csv"
        self.files[name] = "".join(f"{number(x)},{number(y)}\n" for x, y in points)
        return name

    # -------------------------------------------------------------------------- structure

    def junction(self, kind: str) -> Junction:
        made = Junction(self.fresh("n"), kind, [])
        self.body.append(f"{kind}:{made.name}")
        self.junctions.append(made)
        return made

    def _variables(self, a: Junction, b: Junction) -> tuple[Node, Node]:
        """Effort and flow of a bond between junctions."""
        both = []
        for kind in "01":
            common = [j.common for j in (a, b) if j.kind == kind]
            if len(common) == 2:
                one, other = (str(x.data) for x in common)
                self.equations.append(
                    Equation(common[0] - common[1], {one: common[1], other: common[0]})
                )
            both.append(common[0] if common else sym(self.fresh("b")))
        return both[0], both[1]

    def bond(self, a: Junction, b: Junction) -> None:
        if a.kind == b.kind:
            e, f = self._variables(a, b)
        else:
            e, f = (x.common for x in sorted((a, b), key=lambda j: j.kind))
        self.body.append(f"{a.name} -> {b.name}")
        a.ends.append((-1, f if a.kind == "0" else e))
        b.ends.append((1, f if b.kind == "0" else e))

    def _end(self, j: Junction, sign: int) -> tuple[Node, Node]:
        """A new bond at a junction: its effort and flow; the sign is +1 where it ends there."""
        other = sym(self.fresh("b"))
        j.ends.append((sign, other))
        return (j.common, other) if j.kind == "0" else (other, j.common)

    def two_port(self, a: Junction, b: Junction, kind: str, ratio: Node) -> None:
        """A transformer, f1 = ratio*f2, or a gyrator, e1 = ratio*f2, from one junction to another.

        What a ratio holds that moves is a transformer's or gyrator's modulation.
        """
        e1, f1 = self._end(a, -1)
        e2, f2 = self._end(b, 1)
        name = self.fresh("w")
        x1, x2, y1, y2 = (f1, f2, e2, e1) if kind == "TF" else (e1, f2, e2, f1)
        for left, right in ((x1, x2), (y1, y2)):
            product, quotient = ratio * right, left / ratio
            self.equations.append(
                Equation(left - product, {str(left.data): product, str(right.data): quotient})
            )
        if kind == "TF":
            self.body.append(
                f"{a.name} -> TF:{name} {{ f1 = {text(ratio * sym('f2'))} }} -> {b.name}"
            )
        else:
            self.body.append(f"{a.name} -> GY:{name} = {text(ratio)} -> {b.name}")

    def element(self, j: Junction, kind: str, law: Law, start: str | None = None) -> str:
        """An R, C or I with its law on a junction, now and then drawn the other way."""
        back = self.random.random() < 0.1
        name = self.fresh(kind.lower())
        own = sym(f"{name}.{'f' if j.kind == '0' else 'e'}")
        j.ends.append((-1, own))  # the power into the element is e*f, whichever way it is drawn
        e, f = (j.common, own) if j.kind == "0" else (own, j.common)
        local: dict[str, Node] = {"e": e, "f": f}
        state = f"{name}.{'q' if kind == 'C' else 'p'}"
        if kind != "R":
            local[state[-1]] = sym(state)
            self.states.append(state)
            through = f if kind == "C" else e
            self.equations.append(state_equation(state, str(through.data)))
            self.quantities.append(sym(state))
        self.equations.append(_of_law(law, local))
        self.quantities.append(own)
        begins = f"({state[-1]}0 = {start})" if start is not None else ""
        if start is not None:
            self.starts[state] = Fraction(start)
        arrow = "<-" if back else "->"
        written = f"{{ {law.left} = {text(law.right)} }}"
        self.body.append(f"{j.name} {arrow} {kind}:{name}{begins} {written}")
        return name

    def source(self, j: Junction, value: Node, readings: bool = False) -> None:
        """An effort source on a 1-junction, a flow source on a 0-junction."""
        out = self.random.random() < 0.1
        e, f = self._end(j, -1 if out else 1)
        kind, fixed = ("Se", e) if j.kind == "1" else ("Sf", f)
        name = self.fresh("pump" if kind == "Sf" else "drive")
        arrow = "->" if out else "<-"
        self.body.append(f"{j.name} {arrow} {kind}:{name} = {text(value)}")
        if readings:
            self.sources.append(name)
            value = value + sym(wrong(name))
        self.equations.append(equal(str(fixed.data), value))

    # ---------------------------------------------------------------------------- sensors

    def detector(self, j: Junction) -> Node:
        name = self.fresh("y")
        self.body.append(f"{j.name} -> {'De' if j.kind == '0' else 'Df'}:{name}")
        return self._reading(name, j.common)

    def sensor(self, value: Node) -> Node:
        name = self.fresh("y")
        self.body.append(f"sensor {name} = {text(value)}")
        return self._reading(name, value)

    def _reading(self, name: str, value: Node) -> Node:
        self.sensors.append(name)
        self.equations.append(equal(name, value + sym(wrong(name))))
        return sym(name)

    # ----------------------------------------------------------------------------- result

    def model(self) -> Model:
        for j in self.junctions:
            balance = total(*j.ends)
            solved: dict[str, Node] = {}
            for k, (sign, x) in enumerate(j.ends):
                rest = [(-sign * s, y) for i, (s, y) in enumerate(j.ends) if i != k]
                if rest:
                    solved[str(x.data)] = total(*rest)
            self.equations.append(Equation(balance, solved))
        lines = [f"  {line}" for line in [*self.head, *self.body]]
        written = "\n".join(["bg 1", "model M {", *lines, "}", ""])
        plant = Plant(
            tuple(self.equations),
            self.declared,
            tuple(self.params),
            tuple(self.inputs),
            tuple(self.unknown),
            tuple(self.sensors),
            tuple(self.sources),
            tuple(self.states),
            self.starts,
        )
        return Model(written, self.files, plant)


def _of_law(law: Law, local: Mapping[str, Node]) -> Equation:
    """The equation of a law in the variables of the plant."""
    zero = replaced(sym(law.left) - law.right, local)
    solved = {
        str(local[name].data): replaced(value, local)
        for name, value in {law.left: law.right, **law.inverse}.items()
    }
    return Equation(zero, solved)
