"""Draws random networks: structures, what sits on them, controllers, twins and sensors."""

from __future__ import annotations

from fractions import Fraction
from random import Random

from tests.real import laws
from tests.real.build import Build, Junction, Law, Model
from tests.real.nodes import Node, fn, node, sym


def of_seed(seed: int) -> Model:
    """The model with a number."""
    return Drawing(Random(f"real {seed}")).model()


class Drawing:
    """One random model; `bent` is the share of laws that are not linear."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.build = Build(random)
        self.bent = random.choice((0.2, 0.4, 0.4, 0.6))
        self.seen = random.choice((0.4, 0.6, 0.6, 0.8))

    def chance(self, p: float) -> bool:
        return self.random.random() < p

    def model(self) -> Model:
        shapes = ["tree"] * 4 + ["ladder"] * 3 + ["tanks"] * 3 + ["ring"] * 2 + ["machine"] * 2
        getattr(self, self.random.choice([*shapes, "bridge", "bridge", "bare", "bare"]))()
        self.sources()
        self.extras()
        self.sensors()
        if self.chance(0.3):
            self.controller()
        return self.build.model()

    # ------------------------------------------------------------------------- structures

    def filled(self, kind: str, storage: float = 0.5) -> Junction:
        """A junction with what makes its common variable exist."""
        j = self.build.junction(kind)
        if self.chance(storage):
            self.storage(j)
        else:
            self.build.element(j, "R", laws.resistor(self.build, self.bent))
        if self.chance(0.3):
            self.build.element(j, "R", laws.resistor(self.build, self.bent))
        return j

    def storage(self, j: Junction) -> None:
        kind = "C" if (j.kind == "0") != self.chance(0.15) else "I"
        start = self.random.choice(("0", "0.5", "1", "2")) if self.chance(0.15) else None
        self.build.element(j, kind, laws.storage(self.build, kind, self.bent), start)

    def link(self, a: Junction, b: Junction) -> None:
        if self.chance(0.15):
            ratio = self.build.coefficient()
            self.build.two_port(a, b, self.random.choice(("TF", "TF", "GY")), ratio)
        else:
            self.build.bond(a, b)

    def tree(self) -> None:
        """Each junction hangs on an earlier one, mostly of the other kind."""
        made = [self.filled(self.random.choice("01"))]
        for _ in range(self.random.randint(0, 4)):
            parent = self.random.choice(made)
            other = "10"[int(parent.kind)]
            made.append(self.filled(other if self.chance(0.9) else parent.kind))
            a, b = (parent, made[-1]) if self.chance(0.7) else (made[-1], parent)
            self.link(a, b)

    def bare(self) -> None:
        """One or two junctions."""
        first = self.filled(self.random.choice("01"))
        if self.chance(0.5):
            self.build.bond(first, self.filled("10"[int(first.kind)]))

    def ladder(self) -> None:
        """0 and 1 in turn."""
        kind = self.random.choice("01")
        last = self.filled(kind)
        for _ in range(self.random.randint(2, 5)):
            kind = "10"[int(kind)]
            here = self.filled(kind, 0.6)
            self.link(last, here)
            last = here

    def valve(self, a: Junction, b: Junction, law: Law | None = None) -> Law:
        """A resistor between two 0-junctions."""
        j = self.build.junction("1")
        self.build.bond(a, j)
        self.build.bond(j, b)
        law = law or laws.resistor(self.build, self.bent)
        self.build.element(j, "R", law)
        return law

    def twins(self, a: Junction, b: Junction) -> None:
        """Two equal elements side by side."""
        law = self.valve(a, b)
        if self.chance(0.3):
            self.valve(a, b, law)

    def tanks(self) -> None:
        """Stores in a row with valves between."""
        made = []
        for _ in range(self.random.randint(1, 3)):
            j = self.build.junction("0")
            self.storage(j)
            if made:
                self.twins(made[-1], j)
            made.append(j)
        self.build.element(made[-1], "R", laws.resistor(self.build, self.bent))

    def ring(self) -> None:
        """Nodes in a circle, a resistor between each two."""
        made = [self.filled("0") for _ in range(3)]
        for a, b in zip(made, [*made[1:], made[0]], strict=True):
            self.twins(a, b)

    def bridge(self) -> None:
        """Wheatstone's, balanced or not: a source, four arms, a link across."""
        build = self.build
        top, left, right = (build.junction("0") for _ in range(3))
        feed = build.junction("1")
        build.source(feed, build.input())
        build.element(feed, "R", laws.resistor(build, 0.2))
        build.bond(feed, top)
        balanced = self.chance(0.6)
        values = self.random.choice(
            (("1", "2", "3", "6"), ("2", "1", "4", "2"), ("1", "1", "1", "1"))
        )
        arms = [build.param(v if balanced else None, 0) for v in values]
        pairs = ((top, left), (left, None), (top, right), (right, None))
        for (a, b), k in zip(pairs, arms, strict=True):
            law = Law("e", k * laws.F, {"f": laws.E / k})
            if b is None:
                build.element(a, "R", law)
            else:
                self.valve(a, b, law)
        across = build.junction("1")
        build.bond(left, across)
        build.bond(across, right)
        if self.chance(0.3):
            self.storage(across)
        build.element(across, "R", laws.resistor(build, 0.3))
        if self.chance(0.4):
            self.storage(self.random.choice((left, right)))
        build.detector(self.random.choice((across, left, right)))

    def machine(self) -> None:
        """Electric and mechanical sides with a gyrator and perhaps a gear between."""
        build = self.build
        coil, shaft = build.junction("1"), build.junction("1")
        for j in (coil, shaft):
            self.build.element(j, "I", laws.storage(build, "I", self.bent / 2))
            self.build.element(j, "R", laws.resistor(build, self.bent))
        build.source(coil, build.input())
        build.two_port(coil, shaft, "GY", build.coefficient())
        if self.chance(0.5):
            arm = build.junction("1")
            ratio = build.coefficient()
            if self.chance(0.5):
                angle = build.integrated(shaft.common, self.random.choice(("0", "0.5")))
                ratio = ratio * fn(self.random.choice(("sin", "cos")), angle)
            build.two_port(shaft, arm, "TF", ratio)
            build.element(arm, "R", laws.resistor(build, self.bent))
            if self.chance(0.5):
                self.storage(arm)

    # ---------------------------------------------------------------------------- contents

    def sources(self) -> None:
        """Known inputs, now and then unknown ones or a number."""
        for _ in range(self.random.choice((1, 1, 1, 2))):
            j = self.random.choice(self.build.junctions)
            self.build.source(j, self.build.input())
        if self.chance(0.2):
            j = self.random.choice(self.build.junctions)
            self.build.source(j, self.build.input(unknown=True))
        if self.chance(0.1):
            j = self.random.choice(self.build.junctions)
            self.build.source(j, node(Fraction(self.random.choice((1, 2, 5)))))

    def extras(self) -> None:
        """Couplings that are declared as nothing, laws that other signals modulate."""
        build = self.build
        if self.chance(0.25):
            j, other = self.random.choice(build.junctions), self.random.choice(build.junctions)
            x, y = ("e", "f") if j.kind == "1" else ("f", "e")
            none = build.param("0")
            if other is j or self.chance(0.5):
                build.element(j, "R", Law(x, none * sym(y)))
            else:
                law = build.coefficient() * sym(y) + none * other.common
                build.element(j, "R", Law(x, law))
        if self.chance(0.2):
            j, other = self.random.choice(build.junctions), self.random.choice(build.junctions)
            if other is not j:
                x, y = ("e", "f") if j.kind == "1" else ("f", "e")
                build.element(j, "R", Law(x, self.modulated(sym(y), other.common)))

    def modulated(self, x: Node, other: Node) -> Node:
        """A law that another signal moves."""
        k = self.build.coefficient()
        laws_of = (
            (k + fn("abs", other)) * x,
            k * fn("exp", other) * x,
            k * (1 + other**2) * fn("ssqrt", x),
        )
        return self.random.choice(laws_of)

    def quantity(self) -> Node:
        """The common variable of a junction, or a variable of an element."""
        if self.chance(0.7):
            return self.random.choice(self.build.junctions).common
        return self.random.choice(self.build.quantities)

    def sensors(self) -> None:
        """Detectors on junctions, and functions of what there is."""
        build = self.build
        for j in list(build.junctions):
            if self.chance(self.seen):
                build.detector(j)
        for _ in range(self.random.choice((0, 0, 1, 1, 2))):
            a, b = self.quantity(), self.quantity()
            while b.data == a.data:
                b = self.quantity()
            if self.chance(0.3):
                for reads in laws.related(build, a, b):
                    build.sensor(reads)
            else:
                build.sensor(laws.readings(build, a, b))
        if self.chance(0.1):
            j = self.random.choice(build.junctions)
            build.sensor(fn("sin", build.integrated(j.common, "0.5")))
        if not build.sensors:
            build.detector(self.random.choice(build.junctions))

    def controller(self) -> None:
        """A source that acts on a reading, and perhaps a log of what it was told."""
        build = self.build
        y = sym(self.random.choice(build.sensors))
        gap = build.input() - y
        command: Node = build.param() * gap
        if self.chance(0.4):
            command = command + build.param() * build.integrated(gap)
        if self.chance(0.3):
            command = fn("min", fn("max", command, -2), 2)
        command = build.let(command)
        build.source(self.random.choice(build.junctions), command, readings=True)
        if self.chance(0.7):
            build.sensor(command)
