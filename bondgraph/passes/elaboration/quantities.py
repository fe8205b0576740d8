"""Units in the graph: which ports share theirs, what fixes them, and how a conflict is told."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.groups import Groups
from bondgraph.ir.unit import NONE, Dimension
from bondgraph.library.dimensions import Conflict, Dimensions, Term
from bondgraph.library.units import DOMAINS, describe, parse_unit, suggest_unit
from bondgraph.passes.elaboration.bonds import FlatBond, FlatEnd
from bondgraph.passes.elaboration.problems import fail, written
from bondgraph.passes.elaboration.scope import PortEntry
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Span

#: The dimension of a pure number; it needs no place.
PURE = Term(NONE, {}, ())

_SECOND: Dimension = (0, 0, 1, 0, 0, 0, 0)


class Quantities:
    """The dimensions of all efforts and flows; all bonds of a junction share theirs."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.dimensions = Dimensions()
        self._groups = Groups[int]()
        self._owner: list[FlatEnd] = []
        self._pairs: dict[int, tuple[Term, Term]] = {}
        self._seeds: dict[tuple[int, str], None] = {}
        self._units: dict[str, tuple[Dimension, Fraction]] = {}
        self.domain: dict[int, str] = {}
        self.bond_slot: list[int] = []
        self._stated: set[Span] = set()

    # ------------------------------------------------------------------ groups

    def group(self, bonds: list[FlatBond]) -> None:
        """Give every junction and port its group: bonds join what they connect."""
        for bond in bonds:
            a, b = self._slot(bond.tail), self._slot(bond.head)
            self._groups.join(*sorted((self.find(a), self.find(b))))
            self.bond_slot.append(a)

    def _slot(self, end: FlatEnd) -> int:
        holder = end.node if end.port < 0 else end.node.ports[end.port]
        if holder.slot < 0:
            holder.slot = len(self._owner)
            self._owner.append(end)
        return holder.slot

    def find(self, slot: int) -> int:
        """The group of a slot."""
        return self._groups.find(slot)

    def pair(self, slot: int) -> tuple[Term, Term]:
        """The dimensions of effort and flow in the group of a slot."""
        root = self.find(slot)
        pair = self._pairs.get(root)
        if pair is None:
            node = self._owner[root].node
            fresh = self.dimensions.fresh
            pair = (
                fresh(node.origin, f"the effort of {node.local}"),
                fresh(node.origin, f"the flow of {node.local}"),
            )
            self._pairs[root] = pair
        elif pair[0].unknown or pair[1].unknown:
            settled = self.settled(pair[0]), self.settled(pair[1])
            if settled != pair:
                pair = self._pairs[root] = settled
        return pair

    def known(self, dimension: Dimension, origin: Span, what: str) -> Term:
        """A dimension that the model states."""
        self._stated.add(origin)
        return self.dimensions.known(dimension, origin, what)

    def settled(self, term: Term) -> Term:
        """The same dimension without unknowns, once nothing in it is open."""
        dimension = self.dimensions.resolve(term) if term.unknown else None
        return term if dimension is None else Term(dimension, {}, self.dimensions.places(term))

    def seed(self, port: PortEntry) -> None:
        """What the domain of a model port says of the bond through it."""
        name = port.declaration.domain
        domain = DOMAINS.get(name)
        if domain is None or port.bond < 0:
            return
        root = self.find(self.bond_slot[port.bond])
        if (root, name) in self._seeds:
            return
        self._seeds[root, name] = None
        effort, flow = self.pair(root)
        said = f"port `{port.name}` is {name}"
        meets = (port.outside or port.inside)[0].bond.origin
        for term, dimension, what in (
            (effort, domain.effort, domain.effort_name),
            (flow, domain.flow, domain.flow_name),
        ):
            if dimension is not None:
                known = self.known(dimension, port.origin, said)
                conflict = self.dimensions.equate(term, known, meets, f"{said}: its {what}")
                if conflict is not None:
                    self.tell(conflict, f"Port `{port.name}` is {name}, its bond is not",
                              "Both sides of a bond are of one domain: connect another port, or "
                              "put a transducer (GY or TF) between them.")  # fmt: skip
                    return
        if domain.effort is not None:
            self.domain.setdefault(root, name)

    def domain_of(self, slot: int) -> str | None:
        """The domain of a group, as declared or as its units show."""
        if slot < 0:
            return None
        root = self.find(slot)
        if root not in self.domain and root in self._pairs:
            effort, flow = (self.dimensions.resolve(t) for t in self._pairs[root])
            for name, domain in DOMAINS.items():
                if effort is not None and (domain.effort, domain.flow) == (effort, flow):
                    self.domain[root] = name
                    break
        return self.domain.get(root)

    # ------------------------------------------------------------------ equations

    def same(self, left: Term, right: Term, origin: Span, what: str, help: str = "") -> bool:
        """Require one dimension of both; a conflict is reported, once."""
        if left is right:
            return True
        if not left.unknown and not right.unknown and left.known == right.known:
            return True
        conflict = self.dimensions.equate(left, right, origin, what)
        if conflict is None:
            return True
        if not any(p.origin in self._stated for p in conflict.left_places + conflict.right_places):
            return True  # only plain numbers meet here: q + f is theirs to add
        self.tell(conflict, what, help)
        return False

    def pure(self, term: Term, origin: Span, what: str) -> bool:
        """Require a pure number."""
        return self.same(term, PURE, origin, what, "Divide by a quantity of the same unit.")

    def tell(self, conflict: Conflict, what: str, help: str) -> None:
        """Report two units that should be one."""
        what = what[0].upper() + what[1:]
        self.report.error(
            "unit-mismatch", f"{what}: {conflict.left} against {conflict.right}.",
            *conflict.labels(),
            help=help or f"One side is in {conflict.left}, the other in {conflict.right}: correct "
            "the unit of a param, or the expression.",
        )  # fmt: skip

    @property
    def seconds(self) -> Term:
        """The dimension of a time."""
        return _SECONDS

    def integrated(self, term: Term) -> Term:
        """The dimension times seconds."""
        return self.dimensions.product(term, _SECONDS)

    def differentiated(self, term: Term) -> Term:
        """The dimension over seconds."""
        return self.dimensions.quotient(term, _SECONDS)

    def unit(self, text: str, origin: Span) -> tuple[Dimension, Fraction]:
        """Dimension and factor of a unit as written; raises Skip if it is none."""
        found = self._units.get(text)
        if found is None:
            unit = parse_unit(text)
            if unit is None:
                other = suggest_unit(text)
                fail(self.report, "unknown-unit", f"`{text}` is no unit.", Label(origin),
                     help=written(origin, text, other) if other else "Units are names joined with "
                     "`.` and `/`, as in `N.m/A` or `m^3/s`.")  # fmt: skip
            found = self._units[text] = (unit.dimension, unit.factor)
        return found

    def show(self, term: Term | None, written: str | None) -> tuple[Dimension | None, str | None]:
        """Dimension and SI unit of a quantity: as it was written where that is SI already.

        In a model that states no unit at all the unit of time is open too: nothing has one.
        """
        if term is None or not self._stated:
            return None, None
        dimension = self.dimensions.resolve(term)
        if dimension is None:
            return None, None
        if written is not None:
            unit = parse_unit(written)
            if unit is not None and unit.factor == 1 and unit.dimension == dimension:
                return dimension, written
        return dimension, describe(dimension)


_SECONDS = Term(_SECOND, {}, ())
