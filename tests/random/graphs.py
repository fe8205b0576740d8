"""Random bond graphs as text and, independently, as linear equations at a random point.

The equations come from the drawing, not from the text: every bond has an effort and a flow, d/dt
is a random number s, a parameter is a random number, a law that is not linear has a random slope.
"""

from __future__ import annotations

from random import Random
from typing import NamedTuple

from tests.random.elements import Elements, Port
from tests.random.rank import P, Row, relations


class Graph(NamedTuple):
    """A model; `rows` are its equations, `known` the columns of sensors and known inputs.

    `generic` says that no product of signals has slopes that depend on each other, and no switch
    turns: where a factor rests, and in some modes, there are more relations than the rows say.
    """

    text: str
    rows: tuple[Row, ...]
    known: frozenset[str]
    generic: bool

    def relations(self) -> int:
        """How many relations the model has."""
        return relations(self.rows, self.known)


def generate(random: Random) -> Graph:
    """A graph of a random kind: junctions and what links them, elements on them, sensors."""
    return Drawing(random).graph()


class Drawing:
    """Draws a graph as text and, at the same time, as rows; `drawn` are its links."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.kinds: list[str] = []
        self.links: list[tuple[int, int, str]] = []  # from, to, what: bond, TF, GY or any
        self.sums: list[list[tuple[int, str, str]]] = []
        self.whens: list[str] = []
        self.drawn: list[tuple[int, int, str]] = []
        self.turning: dict[str, tuple[str, str]] = {}
        self.count = 0  # of sensors
        self.parts = Elements(random)

    def graph(self) -> Graph:
        """Structure first, then what sits on it."""
        random = self.random
        self.structure()
        self.parts.common = self.any_common
        self.whens = ["" for _ in self.kinds]
        if self.parts.spice(0.15):
            self.parts.generic = False
            for at in random.choices(range(len(self.kinds)), k=random.choice([1, 1, 2])):
                self.whens[at] = f" when {self.parts.mode()} {{ }}"
        self.count = random.choice([0, 1, 1, 2, 2, 3, 4])
        self.sums = [[] for _ in self.kinds]
        self.turning = {what: self.momentum(int(what)) for *_, what in self.links if what in "012"}
        for number, (a, b, what) in enumerate(self.links):
            self.link(number, a, b, what)
        for at in range(len(self.kinds)):
            for _ in range(random.choice([0, 1, 1, 2, 2, 3])):
                self.one_port(at)
        for _ in range(random.choice([0, 0, 0, 1])):
            self.field()
        self.sensors()
        return self.written()

    # ------------------------------------------------------------------------- structures

    def structure(self) -> None:
        """Junctions and links of one of the shapes."""
        shapes = ["tree", "tree", "loops", "loops", "grid", "ring", "body", "ladder"]
        getattr(self, self.random.choice(shapes))()

    def tree(self) -> None:
        """Each junction hangs on an earlier one."""
        for at in range(self.random.randint(1, 7)):
            self.kinds.append(self.random.choice("01"))
            if at:
                self.links.append((self.random.randrange(at), at, "any"))

    def loops(self) -> None:
        """A tree with more links."""
        self.tree()
        if len(self.kinds) > 1:
            for _ in range(self.random.randint(1, 3)):
                a, b = self.random.sample(range(len(self.kinds)), 2)
                self.links.append((a, b, "any"))

    def grid(self) -> None:
        """Nodes of a net, each pair of neighbours joined through a 1-junction of its own."""
        width, height = self.random.choice([(2, 2), (3, 2), (2, 3), (3, 3)])
        self.kinds = ["0"] * (width * height)
        pairs = [(k, k + 1) for k in range(width * height) if (k + 1) % width]
        pairs += [(k, k + width) for k in range(width * (height - 1))]
        for a, b in pairs:
            self.links += [(a, len(self.kinds), "bond"), (len(self.kinds), b, "bond")]
            self.kinds.append("1")

    def ring(self) -> None:
        """Junctions in a circle of gyrators, as of a rigid body, and something outside."""
        size = self.random.randint(2, 5)
        kind = self.random.choice("01")
        self.kinds = [kind] * size
        self.links = [(k, (k + 1) % size, "GY") for k in range(size)]
        if self.random.random() < 0.5:
            self.kinds.append(self.random.choice("01"))
            self.links.append((self.random.randrange(size), size, "any"))

    def body(self) -> None:
        """A rigid body: a ring of gyrators that the angular momenta of the others modulate."""
        self.kinds = ["1"] * 3
        self.links = [(0, 1, "2"), (1, 2, "0"), (2, 0, "1")]  # the axis whose momentum it is
        for _ in range(self.random.choice([0, 0, 1, 2])):
            self.kinds.append(self.random.choice("01"))
            self.links.append((self.random.randrange(3), len(self.kinds) - 1, "any"))

    def ladder(self) -> None:
        """0 and 1 in turn, now and then through a transformer."""
        for at in range(self.random.randint(2, 9)):
            self.kinds.append("01"[at % 2])
            if at:
                self.links.append((at - 1, at, self.random.choice(["bond", "bond", "TF"])))

    # --------------------------------------------------------------------------- contents

    def momentum(self, at: int) -> tuple[str, str]:
        """The column and the text of the momentum of a new inertia at a 1-junction."""
        name = f"J{at}"
        self.parts.line(f"j{at} -> {self.parts.storage('I', False, name, self.port(at, True))}")
        return self.parts.states[-1]

    def link(self, number: int, a: int, b: int, what: str) -> None:
        """A bond or a two-port between junctions."""
        random, parts = self.random, self.parts
        if random.random() < 0.5:
            a, b = b, a
        if what == "any":
            what = random.choice(["bond", "bond", "bond", "TF", "GY"])
        self.drawn.append((a, b, what))
        if what == "bond":
            e, f = parts.bond()
            parts.line(f"j{a} -> j{b}" if random.random() < 0.5 else f"j{b} <- j{a}")
            self.join(a, -1, e, f)
            self.join(b, 1, e, f)
            return
        style = random.choice(["through", "through", "in", "out"])
        e1, f1 = parts.bond()
        e2, f2 = parts.bond()
        self.join(a, 1 if style == "out" else -1, e1, f1)
        self.join(b, -1 if style == "in" else 1, e2, f2)
        first = Port(e1, f1, 1, -1 if style == "out" else 1)
        second = Port(e2, f2, 1, -1 if style == "in" else 1)
        spun = self.turning.get(what)
        node = parts.two_port("GY" if spun else what, number, first, second, spun)
        bare = node.split("{")[0].split("=")[0].split(":")[1].strip()
        if style == "through":
            parts.line(f"j{a} -> {node} -> j{b}")
        else:
            arrow = "->" if style == "in" else "<-"
            parts.line(node)
            # in one piece: port 1 is the one written first
            parts.line(f"j{a} {arrow} {bare}\n  j{b} {arrow} {bare}")

    def one_port(self, at: int) -> None:
        """An element on a junction, its arrow either way."""
        kind = self.kinds[at]
        node = self.parts.one_port(kind, lambda into: self.port(at, into))
        into, text = node
        self.parts.line(f"j{at} {'->' if into else '<-'} {text}")

    def port(self, at: int, into: bool) -> Port:
        """A new bond between a junction and an element; the port's signs count power into it."""
        e, f = self.parts.bond()
        self.join(at, -1 if into else 1, e, f)
        minus = 1 if into else -1
        return Port(e, f, *((minus, 1) if self.kinds[at] == "1" else (1, minus)))

    def field(self) -> None:
        """A field over two or three junctions, one port each."""
        if len(self.kinds) < 2:
            return
        size = min(len(self.kinds), self.random.choice([2, 2, 3]))
        ends = self.random.sample(range(len(self.kinds)), size)
        ports = [self.port(at, True) for at in ends]
        for at, name in zip(ends, self.parts.field(ports), strict=True):
            self.parts.line(f"j{at} -> {name}")

    def sensors(self) -> None:
        """Detectors and measured signals, some of them twice."""
        random, parts = self.random, self.parts
        for _ in range(self.count):
            at = random.randrange(len(self.kinds))
            name = f"y{len(parts.sensors)}"
            if random.random() < 0.75:
                detector = "De" if self.kinds[at] == "0" else "Df"
                if parts.spice(0.1):  # the same instrument behind another detector
                    parts.line(f"j{at} -> {detector}:{name}twice = {name}")
                parts.line(f"j{at} {random.choice(['->', '<-'])} {detector}:{name}")
                parts.reads(name, {f"w{at}": 1})
            else:
                other = random.randrange(len(self.kinds))
                parts.signal(name, *[(f"w{k}", self.common(k)) for k in (at, other)])

    def any_common(self) -> tuple[str, str]:
        """The column and the text of the common variable of some junction, or of a reading."""
        if self.count and self.random.random() < 0.3:
            name = f"y{self.random.randrange(self.count)}"
            return name, name
        at = self.random.randrange(len(self.kinds))
        return f"w{at}", self.common(at)

    def common(self, at: int) -> str:
        return f"j{at}.{'e' if self.kinds[at] == '0' else 'f'}"

    # ---------------------------------------------------------------------------- results

    def join(self, at: int, sign: int, e: str, f: str) -> None:
        """The bond enters (1) or leaves (-1) a junction."""
        self.sums[at].append((sign, e, f))

    def written(self) -> Graph:
        """Text and rows, the junctions included."""
        parts = self.parts
        rows = list(parts.rows)
        for at, (kind, ends) in enumerate(zip(self.kinds, self.sums, strict=True)):
            balance: dict[str, int] = {}
            for sign, e, f in ends:
                common, other = (e, f) if kind == "0" else (f, e)
                rows.append({common: 1, f"w{at}": -1})
                balance[other] = balance.get(other, 0) + sign
            if self.whens[at]:  # on and off at once
                balance[f"w{at}"] = balance.get(f"w{at}", 0) + self.parts.number()
            if any(balance.values()):
                rows.append(balance)
        lines = [f"{kind}:j{at}{self.whens[at]}" for at, kind in enumerate(self.kinds)]
        lines += parts.lines
        if self.random.random() < 0.3:
            self.random.shuffle(lines)
        body = "\n".join(f"  {line}" for line in parts.head + lines)
        return Graph(
            f"bg 1\nmodel M {{\n{body}\n}}\n",
            tuple({c: x % P for c, x in row.items()} for row in rows),
            frozenset((*parts.sensors, *parts.inputs)),
            parts.generic,
        )
