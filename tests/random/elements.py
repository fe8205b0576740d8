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
    "e = {a}*f + {b}*f*abs(f)",
    "e = {a}*f + max(f, 0)",
    "e = {a}*f + min(max(f, -1), 1)",
    "e = if(f < 0, {a}*f, {b}*f)",
    "f = {a}*e + {b}*(exp(e) - 1)",
    "0 = {a}*e + e^3 - {b}*f - tanh(f)",
    "e = {a}*f/sqrt(1 + f^2)",
    "f = {a}*e/(1 + abs(e))",
    "e = {a}*sign(f)*sqrt(abs(f))",
    "0 = f*abs(f)/{a} - e",
    "e = {a}*f + {b}*tanh(f/0.1)",
]
#: Laws that another signal modulates: an input, or the integral {th} of a signal.
_MODULATED = [
    "e = ({a} + {th}^2)*f",
    "f = {a}*(1 + {th})*ssqrt(e)",
    "e = {a}*exp({th})*f",
    "f = {a}*{th}*e",
]
_STORED = [
    "{s}/{a} + {s}^3",
    "{a}*sinh({s})",
    "{a}*{s}*abs({s})",
    "{s} + {a}*tanh({s})",
    "{a}*(max({s} - 1, 0) + min({s} + 1, 0))",
]
_RATIOS = ["{p}*cos({th})", "({p} + {th}^2)", "{p}*{th}", "({p} + sin({th}))"]
_OTHER = ["e = {a}*f^3 - {b}*f", "f = {a}*e*(e - 1)", "e = {a}*f*exp(f)", "f = {a}*sin(e) + e"]
_OTHER += ["e = {a}*sign(f)", "e = {a}*(max(f - 1, 0) + min(f + 1, 0))"]
#: Fields of two ports that are not linear: a transistor, the entropy flows of a heat conductor,
#: a joint with friction that the force in it loads.
#: Each with the signals that its two laws hold.
_FIELDS = [
    ("a0.f = {a}*(exp(a0.e) - 1); a1.f = {b}*a1.e - {a}*(exp(a0.e) - 1)", ("e0 f0", "e0 e1 f1")),
    ("a0.f = {a}*(a0.e - a1.e)/a0.e; a1.f = {b}*(a1.e - a0.e)/a1.e", ("e0 e1 f0", "e0 e1 f1")),
    ("a0.e = {a}*tanh(a0.f)*a1.e; a1.f = {b}*a1.e", ("e0 f0 e1", "e1 f1")),
]


def _times(factor: int, row: Row) -> Row:
    return {c: factor * x for c, x in row.items()}


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
        self.spiced = random.random() < 0.5
        self.common: Callable[[], tuple[str, str]] = lambda: ("", "")
        self.states: list[tuple[str, str]] = []
        self.ports: list[tuple[str, Port]] = []
        self.modes: list[str] = []
        self.s = self.number()
        self._bonds = 0
        self._integrals = 0
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

    def mode(self) -> str:
        """A condition on a known boolean, now and then one that switches something else, too."""
        if not self.modes or self.random.random() < 0.6:
            self.modes.append(self.input(": bool"))
        name = self.random.choice(self.modes)
        return f"not {name}" if self.random.random() < 0.25 else name

    def equation(self, *parts: Row) -> None:
        """The sum of the parts is zero."""
        row: dict[str, int] = {}
        for part in parts:
            for c, x in part.items():
                row[c] = row.get(c, 0) + x
        self.rows.append({c: x for c, x in row.items() if x % P})

    def spice(self, chance: float) -> bool:
        """Whether to draw something rarer; half of the graphs are without."""
        return self.spiced and self.random.random() < chance

    def integral(self) -> tuple[str, str]:
        """The column and the text of the integral of a signal."""
        column, text = self.common()
        self._integrals += 1
        name = f"h{self._integrals}"
        self.equation({name: self.s}, {column: -1})
        start = self.random.choice(["", "", ", 0.5"])
        if self.random.random() < 0.5:
            return name, f"int({text}{start})"
        self.lines.append(f"let {name} = int({text}{start})")
        return name, name

    # --------------------------------------------------------------------------- two-ports

    def two_port(
        self,
        what: str,
        number: int,
        first: Port,
        second: Port,
        spun: tuple[str, str] | None = None,
    ) -> str:
        """A transformer or gyrator; (rarely) an input or an integral modulates it, or what `spun`
        is the column and the text of."""
        if spun:
            self.generic = False
            bends = [{spun[0]: self.number()} for _ in range(2)]
            self.equation(first.effort(), second.flow(self.number()), bends[0])
            self.equation(second.effort(), first.flow(self.number()), bends[1])
            return f"MGY:g{number} = {spun[1]}"
        name = self.param(shared=True)
        m = self.values[name]
        text = name
        if self.random.random() < 0.08:
            self.generic = False
            text = f"({name} + {self.input()})"
        bent: list[Row] = [{}, {}]
        if text == name and self.spice(0.15):
            self.generic = False
            if self.random.random() < 0.3:
                text = f"if({self.mode()}, {name}, {self.param()})"
            else:
                column, th = self.integral()
                text = self.random.choice(_RATIOS).format(p=name, th=th)
                bent = [{column: self.number()}, {column: self.number()}]
        if what == "GY":
            self.equation(first.effort(), second.flow(-m), bent[0])
            self.equation(second.effort(), first.flow(-m), bent[1])
            return f"{'GY' if text == name else 'MGY'}:g{number} = {text}"
        law = self.random.choice(["f1 = {}*f2", "f2 = {}*f1", "e1 = {}*e2", "e2 = {}*e1"])
        turn = m if law[:2] in ("f1", "e2") else pow(m, -1, P)
        self.equation(first.flow(), second.flow(-turn), bent[0])
        self.equation(second.effort(), first.effort(-turn), bent[1])
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
        self.ports.append((name, at))
        if kind == "R" and self.spice(0.15):
            return into, self.modulated(name, at)
        if kind == "R":
            value = self.param(shared=True, zero=True)
            if self.spice(0.3):  # a leak
                self.equation(at.flow(), at.effort(-self.values[value]))
                return into, f"R:{name} {{ f = {value}*e }}"
            self.equation(at.effort(), at.flow(-self.values[value]))
            return into, f"R:{name} = {value}"
        if kind == "law":
            laws = _MONOTONE if random.random() < 0.85 else _OTHER
            law = random.choice(laws)
            text = law.format(a=self.param(), b=self.param(zero=True) if "{b}" in law else "")
            self.equation(at.effort(), at.flow(self.number()))
            return into, f"R:{name} {{ {text} }}"
        if kind == "switch" and random.random() < 0.3:
            self.generic = False
            self.equation(at.effort(), at.flow(self.number()))  # of both positions at once
            return into, f"R:{name} {{ 0 = if({self.mode()}, e, f) }}"
        return into, self.storage(random.choice("CI"), kind == "store", name, at)

    def modulated(self, name: str, at: Port) -> str:
        """A resistor that an input or an integrated signal modulates."""
        column, th = (self.input(),) * 2 if self.random.random() < 0.4 else self.integral()
        self.generic = False
        law = self.random.choice(_MODULATED).format(a=self.param(), th=th)
        self.equation(at.effort(), at.flow(self.number()), {column: self.number()})
        return f"R:{name} {{ {law} }}"

    def source(self, kind: str, name: str, at: Port) -> str:
        """A known or unknown input, a number, or a function of signals."""
        own = {at.e: 1} if kind == "Se" else {at.f: 1}
        if self.spice(0.2):
            column, text = self.common()
            value = self.param()
            if self.random.random() < 0.6:
                self.equation(own, {column: -self.values[value]})
                return f"M{kind}:{name} = {value}*{text}"
            other, th = self.integral()
            self.generic = False
            self.equation(own, {column: self.number()}, {other: self.number()})
            return f"M{kind}:{name} = {value}*{text}*{th}"
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
        self.states.append((name, f"{name}.{state}"))
        if bent:
            self.equation(out(), {name: self.number()})
            law = self.random.choice(_STORED)
            return f"{kind}:{name}{start} {{ {left} = {law.format(s=state, a=self.param())} }}"
        value = self.param(shared=True)
        self.equation({name: 1}, out(-self.values[value]))
        return f"{kind}:{name}{start} = {value}"

    # -------------------------------------------------------------------- fields, sensors

    def field(self, ports: list[Port]) -> list[str]:
        """A linear field with a full symmetric matrix, or a nonlinear C of two ports."""
        self._elements += 1
        name = f"x{self._elements}"
        names = [f"a{k}" for k in range(len(ports))]
        if len(ports) == 2 and self.spice(0.4):
            self.movable_plate(name, *ports)
            return [f"{name}.{n}" for n in names]
        kind = self.random.choice("RCI")
        if len(ports) == 2 and self.spice(0.5):
            self.mixed(kind, name, *ports)
            return [f"{name}.{n}" for n in names]
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

    def mixed(self, kind: str, name: str, one: Port, two: Port) -> None:
        """A field whose second port answers the other way round, or (an R) one of the devices."""
        if kind == "R" and self.random.random() < 0.5:
            self.device(name, one, two)
            return
        a, b, c = (self.param() for _ in range(3))
        x, y, z = (self.values[v] for v in (a, b, c))
        out, state = {"R": "ef", "C": "eq", "I": "fp"}[kind]
        outs = [p.flow() if kind == "I" else p.effort() for p in (one, two)]
        states: list[Row] = [p.flow() for p in (one, two)]
        if kind != "R":
            states = [{f"{name}.{k}": 1} for k in (0, 1)]
            for k, p in enumerate((one, two)):
                self.equation({f"{name}.{k}": self.s}, p.flow(-1) if kind == "C" else p.effort(-1))
        self.equation(outs[0], _times(-x, states[0]), _times(-y, outs[1]))
        self.equation(states[1], _times(y, states[0]), _times(-z, outs[1]))
        laws = f"a0.{out} = {a}*a0.{state} + {b}*a1.{out}"
        laws += f"; a1.{state} = {c}*a1.{out} - {b}*a0.{state}"
        self.line(f"{kind}:{name} {{ port a0; port a1; {laws} }}")

    def device(self, name: str, one: Port, two: Port) -> None:
        """A resistive field of two ports that is not linear."""
        law, signals = self.random.choice(_FIELDS)
        columns = {"e0": one.effort(), "f0": one.flow(), "e1": two.effort(), "f1": two.flow()}
        for held in signals:
            self.equation(*[_times(self.number(), columns[s]) for s in held.split()])
        text = law.format(a=self.param(), b=self.param())
        self.line(f"R:{name} {{ port a0; port a1; {text} }}")

    def movable_plate(self, name: str, one: Port, two: Port) -> None:
        """A capacitor whose plates move: W = q0^2 q1/(2 p)."""
        slope = self.number()
        for number, at in enumerate((one, two)):
            self.equation({f"{name}.{number}": self.s}, at.flow(-1))
        self.equation(one.effort(), {f"{name}.0": self.number(), f"{name}.1": slope})
        self.equation(two.effort(), {f"{name}.0": slope})
        p = self.param()
        laws = f"a0.e = a0.q*a1.q/{p}; a1.e = a0.q^2/(2*{p})"
        self.line(f"C:{name} {{ port a0; port a1; {laws} }}")

    def reads(self, name: str, row: Row) -> None:
        """A sensor."""
        self.sensors.append(name)
        self.equation({name: -1}, row)

    def signal(self, name: str, one: tuple[str, str], two: tuple[str, str]) -> None:
        """A measured sum, integral or product of two signals."""
        what = self.random.choice(["sum", "integral", "product", "function", "rate", "port"])
        if self.states and self.spice(0.3):
            column, text = self.random.choice(self.states)
            self.lines.append(f"sensor {name} = {text}")
            row = {column: 1}
        elif self.spice(0.2):
            self.generic = False
            column, th = self.integral()
            self.lines.append(f"sensor {name} = {one[1]}*{th}")
            row = {one[0]: self.number(), column: self.number()}
        elif what == "sum":
            self.lines.append(f"sensor {name} = {one[1]} + 2*{two[1]}")
            row = {one[0]: 1}
            row[two[0]] = row.get(two[0], 0) + 2
        elif what == "integral":
            self.lines.append(f"sensor {name} = int({one[1]})")
            row = {one[0]: pow(self.s, -1, P)}
        elif what == "rate":  # an acceleration
            self.lines.append(f"sensor {name} = der({one[1]})")
            row = {one[0]: self.s}
        elif what == "port" and self.ports:
            element, at = self.random.choice(self.ports)
            variable = self.random.choice("ef")
            self.lines.append(f"sensor {name} = {element}.{variable}")
            row = dict(at.effort() if variable == "e" else at.flow())
        elif what == "product":
            self.generic = False
            self.lines.append(f"sensor {name} = {one[1]}*{two[1]}")
            row = {one[0]: self.number()}
            row[two[0]] = row.get(two[0], 0) + self.number()
        else:
            self.lines.append(f"sensor {name} = {one[1]} + {one[1]}^3")
            row = {one[0]: self.number()}
        self.reads(name, row)
