"""The syntax tree of a `.bg` file: what was written, and where, before anything is understood."""

from __future__ import annotations

from fractions import Fraction
from typing import TypeAlias

from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

# ---------------------------------------------------------------- expressions


class Number(NamedTuple):
    """A literal quantity: `value` is exact, `unit` as written or None, `text` the digits alone."""

    value: Fraction
    unit: str | None
    text: str
    origin: Span


class Text(NamedTuple):
    """A string literal."""

    value: str
    origin: Span


class Truth(NamedTuple):
    """`true` or `false`."""

    value: bool
    origin: Span


class Part(NamedTuple):
    """One name of a dotted reference with its index: `cell[1..n]`."""

    name: str
    first: Expression | None
    last: Expression | None  # upper end of a range index
    origin: Span


class Ref(NamedTuple):
    """A dotted reference: `m[1].el.Re`."""

    parts: tuple[Part, ...]
    origin: Span


class Unary(NamedTuple):
    """`-x` or `not x`."""

    op: str
    operand: Expression
    origin: Span


class Binary(NamedTuple):
    """`a op b`; op is one of `+ - * / ^ < <= > >= == != and or`."""

    op: str
    left: Expression
    right: Expression
    origin: Span


class Call(NamedTuple):
    """`name(arguments)`; `if(c, a, b)` too."""

    name: str
    arguments: tuple[Expression, ...]
    origin: Span


Expression: TypeAlias = Number | Text | Truth | Ref | Unary | Binary | Call


class Tolerance(NamedTuple):
    """`+- 5%` (relative; the value of the quantity is 1/20) or `+- 2 Ohm` (absolute)."""

    quantity: Number
    relative: bool
    origin: Span


class Equation(NamedTuple):
    """`left = right` in a law."""

    left: Expression
    right: Expression
    origin: Span


# ----------------------------------------------------------------- statements


class Law(NamedTuple):
    """The braces of an element: named ports (fields) and equations."""

    ports: tuple[Part, ...]
    equations: tuple[Equation, ...]
    origin: Span


class Argument(NamedTuple):
    """`name = value` in the round brackets of a node; the name may be dotted or indexed."""

    target: Ref
    value: Expression
    origin: Span


class Node(NamedTuple):
    """`TYPE:name[index](arguments) = value { law }`: a declaration."""

    type: str
    name: Part
    arguments: tuple[Argument, ...]
    value: Expression | None
    tolerance: Tolerance | None
    law: Law | None
    origin: Span


class Arrow(NamedTuple):
    """`->` or `<-`, with the bond number of a figure if one is written."""

    forward: bool
    label: str | None
    origin: Span


class Chain(NamedTuple):
    """`node arrow node arrow node`; inside a junction body `nodes[0]` is None: the junction."""

    nodes: tuple[Node | Ref | None, ...]
    arrows: tuple[Arrow, ...]
    doc: str
    origin: Span


class Junction(NamedTuple):
    """`1:name when c { ... }` (type "0" or "1"), or `name { ... }` reopening one (type "")."""

    type: str
    name: Ref
    when: Expression | None
    body: tuple[Statement, ...]
    doc: str
    origin: Span


class Port(NamedTuple):
    """`port name : in domain`."""

    name: str
    direction: str
    domain: str
    doc: str
    origin: Span


class Param(NamedTuple):
    """`param name = value +- tol`, `param name : unit`, or the same with `const`."""

    keyword: str
    name: Part
    unit: str | None
    value: Expression | None
    tolerance: Tolerance | None
    doc: str
    origin: Span


class Input(NamedTuple):
    """`input name : unit unknown`; a `bool` one is a mode."""

    name: Part
    unit: str | None
    boolean: bool
    unknown: bool
    doc: str
    origin: Span


class Sensor(NamedTuple):
    """`sensor name : unit = expression counts n/turn`."""

    name: Part
    unit: str | None
    value: Expression
    counts: Expression | None
    doc: str
    origin: Span


class Let(NamedTuple):
    """`let name = expression`."""

    name: Part
    value: Expression
    doc: str
    origin: Span


class Fault(NamedTuple):
    """`fault name : target += value`."""

    name: Part
    target: Ref
    op: str
    value: Expression
    doc: str
    origin: Span


class For(NamedTuple):
    """`for i in a..b { ... }`."""

    variable: str
    first: Expression
    last: Expression
    body: tuple[Statement, ...]
    origin: Span


class If(NamedTuple):
    """`if c { ... } else { ... }`, decided when the model is built; `else if` is an If in it."""

    condition: Expression
    body: tuple[Statement, ...]
    otherwise: tuple[Statement, ...]
    origin: Span


Statement: TypeAlias = (
    Port | Param | Input | Sensor | Let | Fault | For | If | Junction | Chain
)  # a lone `TYPE:name` is a Chain of one node


class Generic(NamedTuple):
    """A structural argument of a model: `n : int = 1`."""

    name: str
    type: str
    default: Expression | None
    origin: Span


class Model(NamedTuple):
    """`model Name(generics) { statements }`."""

    name: str
    generics: tuple[Generic, ...]
    body: tuple[Statement, ...]
    doc: str
    origin: Span
    name_origin: Span


class Import(NamedTuple):
    """`import A, B from "file.bg"`."""

    names: tuple[str, ...]
    path: str
    origin: Span


class File(NamedTuple):
    """A whole file; `edition` is the number after `bg`."""

    edition: int
    imports: tuple[Import, ...]
    models: tuple[Model, ...]
    doc: str
    origin: Span
