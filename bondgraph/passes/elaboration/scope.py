"""What a model instance holds while it is opened: its nodes, values, ports and bonds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Literal, TypeAlias

from bondgraph.ir.expr import Expr
from bondgraph.ir.syntax import (
    Argument,
    Arrow,
    Expression,
    Input,
    Let,
    Model,
    Node,
    Param,
    Port,
    Ref,
    Sensor,
)
from bondgraph.library.elements import ElementKind
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.library.dimensions import Term
    from bondgraph.passes.elaboration.files import Definition

#: The `for` variables that hold where something stands.
Env: TypeAlias = Mapping[str, int]

#: An expression with its dimension; None instead of a dimension marks a truth value.
Typed: TypeAlias = "tuple[Expr, Term | None]"

ValueKind = Literal["param", "const", "input", "let", "sensor", "detector"]


class Bound(NamedTuple):
    """An expression together with where its names are to be looked up."""

    value: Expression
    scope: Scope
    env: Env
    origin: Span


class Given:
    """One argument in the round brackets of a node, on its way to what it binds.

    `parts` is the rest of its target; `root` is the argument as written, which knows if it was
    used.
    """

    __slots__ = ("argument", "bound", "parts", "root", "used")

    def __init__(
        self,
        parts: tuple[tuple[str, int | None], ...],
        bound: Bound,
        argument: Argument,
        root: Given | None = None,
    ) -> None:
        self.parts = parts
        self.bound = bound
        self.argument = argument
        self.root: Given = root or self
        self.used = False

    def inner(self) -> Given:
        """The same argument as seen by the node that the first part names."""
        return Given(self.parts[1:], self.bound, self.argument, self.root)


class PortVariables:
    """The variables of one port of an element, and the group of bonds that share its units."""

    __slots__ = ("effort", "flow", "initial", "initial_value", "name", "slot", "state", "stores")

    def __init__(self, name: str) -> None:
        self.name = name
        self.effort: Expr
        self.flow: Expr
        self.stores: Literal["q", "p", ""] = ""
        self.state: Expr | None = None
        self.initial: Expr | None = None
        self.initial_value: Expr | None = None
        self.slot = -1


class NodeEntry:
    """A junction or an element of one instance."""

    __slots__ = (
        "bonds", "common", "declaration", "doc", "element", "env", "givens", "name", "number",
        "origin", "path", "place", "ports", "scope", "slot", "type", "when",
    )  # fmt: skip

    def __init__(
        self, type: str, element: ElementKind | None, name: str, place: int | None,
        scope: Scope, env: Env, origin: Span, doc: str,
    ) -> None:  # fmt: skip
        self.type = type
        self.element = element
        self.name = name
        self.place = place
        self.path: str = scope.path + (name if place is None else f"{name}[{place}]")
        self.scope = scope
        self.env = env
        self.origin = origin
        self.doc = doc
        self.declaration: Node | None = None
        self.when: Bound | None = None
        self.givens: list[Given] = []
        self.bonds: list[RawEnd] = []
        self.ports: list[PortVariables] = []
        self.common: Expr | None = None
        self.number = -1
        self.slot = -1

    @property
    def named_ports(self) -> tuple[str, ...]:
        """The ports that the law of a field declares."""
        law = self.declaration.law if self.declaration is not None else None
        if law is None or self.element is None or not self.element.fields:
            return ()
        return tuple([p.name for p in law.ports])

    @property
    def local(self) -> str:
        """The name as its own model writes it."""
        return self.name if self.place is None else f"{self.name}[{self.place}]"


class ValueEntry:
    """A name of the value namespace of one instance."""

    __slots__ = (
        "declaration", "env", "given", "kind", "local", "node", "open", "origin", "path", "scope",
        "typed", "wrong",
    )  # fmt: skip

    def __init__(
        self, kind: ValueKind, name: str, place: int | None, scope: Scope, env: Env,
        declaration: Param | Input | Let | Sensor | Node, origin: Span,
    ) -> None:  # fmt: skip
        self.kind = kind
        self.local = name if place is None else f"{name}[{place}]"
        self.path: str = scope.path + self.local
        self.scope = scope
        self.env = env
        self.declaration = declaration
        self.origin = origin
        self.given: Bound | None = None
        self.node: NodeEntry | None = None
        self.typed: Typed | None = None
        self.open = False
        self.wrong = False


class PortEntry:
    """A port of a model instance, with the bonds that meet it inside and outside.

    `bond` is the number of the flat bond on its inner side.
    """

    __slots__ = ("bond", "declaration", "inside", "name", "outside", "path", "scope")

    def __init__(self, declaration: Port, scope: Scope) -> None:
        self.declaration = declaration
        self.name = declaration.name
        self.scope = scope
        self.path: str = scope.path + declaration.name
        self.inside: list[RawEnd] = []
        self.outside: list[RawEnd] = []
        self.bond = -1

    @property
    def origin(self) -> Span:
        """Where the port is declared."""
        return self.declaration.origin

    def ends(self, side: str) -> list[RawEnd]:
        """The bonds that meet the port on one side, "inside" or "outside"."""
        return self.inside if side == "inside" else self.outside


class RawBond:
    """A bond as written; its ends may be ports of models."""

    __slots__ = ("done", "head", "label", "origin", "tail")

    def __init__(self, label: str | None, origin: Span) -> None:
        self.label = label
        self.origin = origin
        self.tail: RawEnd
        self.head: RawEnd
        self.done = False


class RawEnd:
    """Where a written bond ends: `at` a node (`key` the named port) or a model port (its side)."""

    __slots__ = ("at", "bond", "key", "origin", "port")

    def __init__(self, bond: RawBond, at: NodeEntry | PortEntry, key: str, origin: Span) -> None:
        self.bond = bond
        self.at = at
        self.key = key
        self.origin = origin
        self.port = -1

    @property
    def other(self) -> RawEnd:
        """The other end of the same bond."""
        return self.bond.head if self.bond.tail is self else self.bond.tail


class Array:
    """Several entries under one name, by their indices."""

    __slots__ = ("entries", "origin")

    def __init__(self, origin: Span) -> None:
        self.entries: dict[int, NodeEntry | Scope | ValueEntry] = {}
        self.origin = origin


#: What a name of the node namespace can be.
Named: TypeAlias = "NodeEntry | Scope | PortEntry | ValueEntry | Array"


class Link(NamedTuple):
    """A chain to be connected once every instance is open.

    `items` are nodes just declared, references, or None for the junction in whose body it stands.
    """

    items: tuple[tuple[NodeEntry | Scope, ...] | Ref | None, ...]
    arrows: tuple[Arrow, ...]
    env: Env
    junction: NodeEntry | Ref | None
    origin: Span
    origins: tuple[Span, ...]


class Scope:
    """One instance of a model.

    What could not be declared leaves its name in `wrong`; `unlinked` says that bonds are missing
    for such a reason, `incomplete` that whole statements are. `unrolled` is the number of parts
    that its loops and arrays make, `times` how many instances it counts for in the size of the
    model.
    """

    __slots__ = (
        "definition", "generics", "givens", "incomplete", "items", "links", "name", "nodes",
        "origin", "parent", "path", "place", "ports", "times", "unlinked", "unrolled", "values",
        "wrong",
    )  # fmt: skip

    def __init__(
        self, definition: Definition, parent: Scope | None, name: str, place: int | None,
        origin: Span,
    ) -> None:  # fmt: skip
        self.definition = definition
        self.parent = parent
        self.name = name
        self.place = place
        local = name if place is None else f"{name}[{place}]"
        self.path: str = "" if parent is None else f"{parent.path}{local}."
        self.origin = origin
        self.generics: dict[str, int | bool] = {}
        self.givens: list[Given] = []
        self.nodes: dict[str, NodeEntry | Scope | PortEntry | ValueEntry | Array] = {}
        self.values: dict[str, NodeEntry | Scope | PortEntry | ValueEntry | Array] = {}
        self.ports: dict[str, PortEntry] = {}
        self.items: list[NodeEntry | ValueEntry | Scope] = []
        self.links: list[Link] = []
        self.wrong: set[str] = set()
        self.unlinked = False
        self.incomplete = False
        self.unrolled = 0
        self.times = 1

    @property
    def model(self) -> Model:
        """The model that this is an instance of."""
        return self.definition.model

    @property
    def local(self) -> str:
        """The name as the parent model writes it."""
        return self.name if self.place is None else f"{self.name}[{self.place}]"


def flattened(top: Scope) -> Iterator[NodeEntry | ValueEntry | Scope]:
    """Everything in the order of the model, each instance where it is declared."""
    stack: list[Iterator[NodeEntry | ValueEntry | Scope]] = [iter((top,))]
    while stack:
        item = next(stack[-1], None)
        if item is None:
            stack.pop()
            continue
        yield item
        if isinstance(item, Scope):
            stack.append(iter(item.items))
