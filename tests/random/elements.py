"""Random elements: for each the text of its law, and its law as rows of numbers."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import NamedTuple

from tests.random.rank import P, Row

_MONOTONE = [
    "e = {a}*f*abs(f)",
    "f = {a}*ssqrt(e)",
    "e = {a}*tanh({b}*f) + f",
    "e = {a}*f + {b}*f^3",
    "f = {a}*(exp(e) - 1)",
    "e = {a}*sign(f) + {b}*f",
    "0 = e - {a}*f*abs(f)",
    "0 = {a}*f + sinh(f) - e",
    "f = {a}*atan(e)",
]
_OTHER = ["e = {a}*f^3 - {b}*f", "f = {a}*e*(e - 1)", "e = {a}*f*exp(f)", "f = {a}*sin(e) + e"]


class Port(NamedTuple):
    """The variables of a bond at an element: its port has effort = sign_e * e, flow alike."""

    e: str
    f: str
    sign_e: int
    sign_f: int

    def effort(self, factor: int = 1) -> dict[str, int]:
        return {self.e: factor * self.sign_e}

    def flow(self, factor: int = 1) -> dict[str, int]:
        return {self.f: factor * self.sign_f}


class Elements:
    """Collects the lines of the text and the rows while elements are drawn."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.head: list[str] = []
        self.lines: list[str] = []
        self.rows: list[Row] = []
        self.values: dict[str, int] = {}
        self.sensors: list[str] = []
        self.inputs: list[str] = []
        self.generic = True
        self.s = self.number()
        self._bonds = 0
        self._elements = 0

    def number(self) -> int:
        """A random field element."""
        return self.random.randrange(2, P)

    def line(self, text: str) -> None:
        self.lines.append(text)

    def bond(self) -> tuple[str, str]:
        self._bonds += 1
        return f"e{self._bonds}", f"f{self._bonds}"

    def param(self, shared: bool = False, zero: bool = False) -> str:
        """A parameter, now and then one that exists, now and then with the nominal value 0."""
        random = self.random
        if shared and self.values and random.random() < 0.15:
            return random.choice(list(self.values))
        name = f"p{len(self.values)}"
        self.values[name] = self.number()
        value = random.choice(["1", "2", "3", "5", "0.5", "0.25", "1.7"])
        self.head.append(f"param {name} = {'0' if zero and random.random() < 0.1 else value}")
        return name

    def input(self, kind: str = "") -> str:
        """An input; kind is empty (known), `unknown` or `: bool`."""
        name = f"u{sum(line.startswith('input') for line in self.head)}"
        self.head.append(f"input {name} {kind}".strip().replace(" :", ":").replace(":", " :"))
        if not kind:
            self.inputs.append(name)
        return name

    def equation(self, *parts: Row) -> None:
        """The sum of the parts is zero."""
        row: dict[str, int] = {}
        for part in parts:
            for c, x in part.items():
                row[c] = row.get(c, 0) + x
        self.rows.append({c: x for c, x in row.items() if x % P})

    # --------------------------------------------------------------------------- two-ports

    def two_port(self, what: str, number: int, first: Port, second: Port) -> str:
        """A transformer or gyrator; (rarely) an input modulates it."""
        name = self.param(shared=True)
        m = self.values[name]
        text = name
        if self.random.random() < 0.08:
            self.generic = False
            text = f"({name} + {self.input()})"
        if what == "GY":
            self.equation(first.effort(), second.flow(-m))
            self.equation(second.effort(), first.flow(-m))
            return f"{'GY' if text == name else 'MGY'}:g{number} = {text}"
        law = self.random.choice(["f1 = {}*f2", "f2 = {}*f1", "e1 = {}*e2", "e2 = {}*e1"])
        turn = m if law[:2] in ("f1", "e2") else pow(m, -1, P)
        self.equation(first.flow(), second.flow(-turn))
        self.equation(second.effort(), first.effort(-turn))
        return f"{'TF' if text == name else 'MTF'}:t{number} {{ {law.format(text)} }}"

    # --------------------------------------------------------------------------- one-ports

    def one_port(self, junction: str, port: Callable[[bool], Port]) -> tuple[bool, str]:
        """An element for a junction: whether its arrow points into it, and its text."""
        random = self.random
        self._elements += 1
        name = f"x{self._elements}"
        into = random.random() < 0.7
        kind = random.choice(["R", "R", "C", "I", "law", "store", "source", "source", "switch"])
        if kind == "source":
            fits = "Se" if junction == "1" else "Sf"
            other = "Sf" if junction == "1" else "Se"
            return into, self.source(fits if random.random() < 0.85 else other, name, port(into))
        at = port(into)
        if kind == "R":
            value = self.param(shared=True, zero=True)
            self.equation(at.effort(), at.flow(-self.values[value]))
            return into, f"R:{name} = {value}"
        if kind == "law":
            laws = _MONOTONE if random.random() < 0.85 else _OTHER
            law = random.choice(laws)
            text = law.format(a=self.param(), b=self.param() if "{b}" in law else "")
            self.equation(at.effort(), at.flow(self.number()))
            return into, f"R:{name} {{ {text} }}"
        if kind == "switch" and random.random() < 0.3:
            self.generic = False
            return into, f"R:{name} {{ 0 = if({self.input(': bool')}, e, f) }}"
        return into, self.storage(random.choice("CI"), kind == "store", name, at)

    def source(self, kind: str, name: str, at: Port) -> str:
        """A known or unknown input, or a number."""
        own = {at.e: 1} if kind == "Se" else {at.f: 1}
        draw = self.random.random()
        if draw < 0.1:
            self.equation(own)
            return f"{kind}:{name} = 5"
        source = self.input("unknown" if draw < 0.35 else "")
        self.equation(own, {source: -1})
        return f"{kind}:{name} = {source}"

    def storage(self, kind: str, bent: bool, name: str, at: Port) -> str:
        """A C or an I, with or without initial value; `bent` is a law that is not linear."""
        state, left = ("q", "e") if kind == "C" else ("p", "f")
        rate, out = (at.flow, at.effort) if kind == "C" else (at.effort, at.flow)
        start = f"({state}0 = {self.random.choice(['0', '0.5'])})"
        start = start if self.random.random() < 0.4 else ""
        self.equation({name: self.s}, rate(-1))
        if bent:
            self.equation(out(), {name: self.number()})
            law = self.random.choice(["{s}/{a} + {s}^3", "{a}*sinh({s})", "{a}*{s}*abs({s})"])
            return f"{kind}:{name}{start} {{ {left} = {law.format(s=state, a=self.param())} }}"
        value = self.param(shared=True)
        self.equation({name: 1}, out(-self.values[value]))
        return f"{kind}:{name}{start} = {value}"

    # -------------------------------------------------------------------- fields, sensors

    def field(self, ports: list[Port]) -> list[str]:
        """A linear field with a full symmetric matrix, or a nonlinear C of two ports."""
        self._elements += 1
        kind = self.random.choice("RCI")
        name = f"x{self._elements}"
        names = [f"a{k}" for k in range(len(ports))]
        state, left = {"R": ("f", "e"), "C": ("q", "e"), "I": ("p", "f")}[kind]
        matrix: dict[tuple[int, int], str] = {}
        laws = []
        for i, at in enumerate(ports):
            row = at.flow() if kind == "I" else at.effort()
            terms = []
            for k, other in enumerate(ports):
                key = (min(i, k), max(i, k))
                matrix[key] = value = matrix.get(key) or self.param()
                terms.append(f"{value}*{names[k]}.{state}")
                own = other.flow() if kind == "R" else {f"{name}.{k}": 1}
                row = {**row, **{c: row.get(c, 0) - x * self.values[value] for c, x in own.items()}}
            self.equation(row)
            if kind != "R":
                rate = at.flow(-1) if kind == "C" else at.effort(-1)
                self.equation({f"{name}.{i}": self.s}, rate)
            laws.append(f"{names[i]}.{left} = {' + '.join(terms)}")
        declared = "; ".join([*[f"port {n}" for n in names], *laws])
        self.line(f"{kind}:{name} {{ {declared} }}")
        return [f"{name}.{n}" for n in names]

    def reads(self, name: str, row: Row) -> None:
        """A sensor."""
        self.sensors.append(name)
        self.equation({name: -1}, row)

    def signal(self, name: str, one: tuple[str, str], two: tuple[str, str]) -> None:
        """A measured sum, integral or product of two signals."""
        what = self.random.choice(["sum", "integral", "product", "function"])
        if what == "sum":
            self.lines.append(f"sensor {name} = {one[1]} + 2*{two[1]}")
            row = {one[0]: 1}
            row[two[0]] = row.get(two[0], 0) + 2
        elif what == "integral":
            self.lines.append(f"sensor {name} = int({one[1]})")
            row = {one[0]: pow(self.s, -1, P)}
        elif what == "product":
            self.generic = False
            self.lines.append(f"sensor {name} = {one[1]}*{two[1]}")
            row = {one[0]: self.number(), two[0]: self.number()}
        else:
            self.lines.append(f"sensor {name} = {one[1]} + {one[1]}^3")
            row = {one[0]: self.number()}
        self.reads(name, row)
