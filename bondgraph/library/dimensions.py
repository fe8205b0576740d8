"""Solves for the dimensions of a model: who has which, who fixed it, and where two disagree."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.groups import Groups
from bondgraph.ir.unit import NONE, Dimension, over, raised, times, whole
from bondgraph.library.units import describe
from bondgraph.text.diagnostic import Label
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_MOST_PLACES = 3  # more would bury the two that matter


class Place(NamedTuple):
    """Where `dimension` was fixed, and by what (`the port is electrical`).

    Of a `plain` number its use has fixed it.
    """

    origin: Span
    what: str
    dimension: Dimension = NONE
    plain: bool = False


class Term:
    """A product of a known dimension and unknown ones with exponents.

    `places` are the declarations that the known part comes from. Made by `Dimensions`.
    """

    __slots__ = ("known", "places", "unknown")

    def __init__(
        self, known: Dimension, unknown: dict[int, Fraction | int], places: tuple[Place, ...]
    ) -> None:
        self.known = known
        self.unknown = unknown
        self.places = places

    def __repr__(self) -> str:
        return f"Term({self.known}, {self.unknown})"


class Conflict(NamedTuple):
    """Two sides that must agree and do not: what each is, and who fixed it."""

    left: str
    right: str
    left_places: tuple[Place, ...]
    right_places: tuple[Place, ...]
    origin: Span
    what: str

    def labels(self) -> tuple[Label, ...]:
        """The place of the disagreement first, then what fixed either side, each place once."""
        labels = [Label(self.origin, self.what or f"{self.left} against {self.right}")]
        seen = {_key(self.origin)}
        for place in (*self.left_places, *self.right_places):
            if _key(place.origin) not in seen:
                seen.add(_key(place.origin))
                labels.append(Label(place.origin, place.what or f"in {describe(place.dimension)}"))
        return tuple(labels)


class Dimensions:
    """A set of unknown dimensions with what is known about them so far.

    Two unknowns made equal become one (union-find); an equation with several unknowns is solved
    for one of them. The usual equations, unknown = unknown and unknown = known, take amortised
    near-constant time. A number whose unit its use decides is just a fresh unknown; so is 0.
    """

    def __init__(self) -> None:
        self._groups = Groups[int]()
        self._value: list[Term | None] = []
        self._births: list[Place] = []
        self._plain: set[int] = set()
        self._doubted: set[tuple[str, int, int]] = set()

    # ------------------------------------------------------------------ terms

    def fresh(self, origin: Span, what: str, plain: bool = False) -> Term:
        """A new unknown dimension; `what` names whose it is (`flow of bond b3`).

        A `plain` number has no unit where it is written: a conflict says which its use gives it.
        """
        number = len(self._value)
        if plain:
            self._plain.add(number)
        self._value.append(None)
        self._births.append(Place(origin, what))
        return Term(NONE, {number: 1}, ())

    def known(self, dimension: Dimension, origin: Span, what: str) -> Term:
        """A dimension that the model states; `what` says how (empty: `in` and the unit)."""
        return Term(dimension, {}, (Place(origin, what, dimension),))

    def product(self, left: Term, right: Term) -> Term:
        """The dimension of left times right."""
        return self._joined(left, right, 1)

    def quotient(self, left: Term, right: Term) -> Term:
        """The dimension of left over right."""
        return self._joined(left, right, -1)

    def power(self, base: Term, exponent: Fraction | int) -> Term:
        """The dimension of base to a rational power."""
        if not exponent:
            return Term(NONE, {}, ())
        unknown = {v: whole(e * exponent) for v, e in base.unknown.items()}
        return Term(raised(base.known, exponent), unknown, base.places)

    # -------------------------------------------------------------- equations

    def equate(self, left: Term, right: Term, origin: Span, what: str) -> Conflict | None:
        """State that two terms have one dimension; a Conflict if that cannot be.

        `origin` and `what` say where and why (`the terms of a sum have one unit`). A conflict
        leaves everything as it was. A declaration that was in a conflict may be the wrong one:
        it is not held against anything else, so that one wrong unit is one error.
        """
        left, right = self._normal(left), self._normal(right)
        if len(left.unknown) == 1 == len(right.unknown) and self._united(left, right):
            return None
        rest = self._joined(left, right, -1)
        if not rest.unknown:
            if rest.known == NONE:
                return None
            keys = {_key(p.origin) for p in (*left.places, *right.places)}
            if keys & self._doubted:
                return None
            self._doubted |= keys
            sides = self._say(left), self._say(right)
            return Conflict(*sides, left.places, right.places, origin, what)
        # the simplest exponent keeps fractions out, the newest unknown has fewest followers
        chosen = max(rest.unknown, key=lambda v: (abs(rest.unknown[v]) == 1, v))
        others = {v: e for v, e in rest.unknown.items() if v != chosen}
        exponent = Fraction(-1) / rest.unknown[chosen]
        value = self.power(Term(rest.known, others, rest.places), exponent)
        places = value.places
        if value.known != NONE and not places:
            places = (Place(origin, what, value.known),)
        self._value[chosen] = Term(value.known, value.unknown, places)
        return None

    def resolve(self, term: Term) -> Dimension | None:
        """The dimension of `term`, or None as long as nothing fixes it."""
        normal = self._normal(term)
        return None if normal.unknown else normal.known

    def places(self, term: Term) -> tuple[Place, ...]:
        """The declarations that fix (the known part of) `term`."""
        return self._normal(term).places

    def text(self, term: Term) -> str:
        """The dimension as a readable unit, with the names of what is open in it."""
        return self._say(self._normal(term))

    # ---------------------------------------------------------------- helpers

    def _united(self, left: Term, right: Term) -> bool:
        """Make two bare unknowns one, if that is what the terms are."""
        (a, first), (b, second) = *left.unknown.items(), *right.unknown.items()
        if first != second or left.known != right.known:
            return False
        if a != b:
            self._groups.join(a, b)
        return True

    def _joined(self, left: Term, right: Term, sign: int) -> Term:
        known = left.known
        if right.known is not NONE:
            known = times(known, right.known) if sign > 0 else over(known, right.known)
        unknown = left.unknown
        if right.unknown:
            unknown = dict(unknown)
            _collect(unknown, right.unknown, sign)
        return Term(known, unknown, _merged(left.places, right.places))

    def _normal(self, term: Term) -> Term:
        """The same term in open unknowns only, each the root of its class."""
        stale = False
        for number in term.unknown:
            root = self._groups.find(number)
            if self._value[root] is not None:
                self._settle(root)
                stale = True
            elif root != number:
                stale = True
        return self._substituted(term) if stale else term

    def _settle(self, root: int) -> None:
        """Write the value of a class in open unknowns only; a stack, as chains may be long."""
        stack = [root]
        while stack:
            value = self._value[stack[-1]]
            if value is None or self._is_settled(stack[-1]):
                stack.pop()
                continue
            stale = [r for v in value.unknown if not self._is_settled(r := self._groups.find(v))]
            if stale:
                stack.extend(stale)
            else:
                self._value[stack.pop()] = self._substituted(value)

    def _is_settled(self, root: int) -> bool:
        value = self._value[root]
        return value is None or all(
            self._groups.find(v) == v and self._value[v] is None for v in value.unknown
        )

    def _substituted(self, term: Term) -> Term:
        """Put the settled values in."""
        known, places = term.known, term.places
        unknown: dict[int, Fraction | int] = {}
        for number, exponent in term.unknown.items():
            root = self._groups.find(number)
            value = self._value[root]
            if value is None:
                _collect(unknown, {root: 1}, exponent)
            else:
                power = value.known if exponent == 1 else raised(value.known, exponent)
                known = power if known is NONE else times(known, power)
                _collect(unknown, value.unknown, exponent)
                places = _merged(places, value.places)
                if number in self._plain and not value.unknown and value.known != NONE:
                    birth = self._births[number]
                    said = f"{birth.what} has no unit: its use makes it {describe(value.known)}"
                    places = _merged(places, (Place(birth.origin, said, value.known, True),))
        return Term(known, unknown, places)

    def _say(self, term: Term) -> str:
        if not term.unknown:
            return describe(term.known)
        parts = [] if term.known == NONE else [describe(term.known)]
        for number, exponent in term.unknown.items():
            power = "" if exponent == 1 else f"^{exponent}"
            parts.append(f"(unit of {self._births[number].what}){power}")
        return ".".join(parts)


def _collect(
    into: dict[int, Fraction | int], unknown: dict[int, Fraction | int], factor: Fraction | int
) -> None:
    for number, exponent in unknown.items():
        total = into.get(number, 0) + exponent * factor
        if total:
            into[number] = whole(total)
        else:
            del into[number]


def _merged(left: tuple[Place, ...], right: tuple[Place, ...]) -> tuple[Place, ...]:
    if not right or left == right:
        return left
    if not left:
        return right
    seen = {_key(p.origin) for p in left}
    every = (*left, *[p for p in right if _key(p.origin) not in seen])
    declared = [p for p in every if not p.plain][:_MOST_PLACES]
    return (*declared, *[p for p in every if p.plain][:1])


def _key(span: Span) -> tuple[str, int, int]:
    return span.source.path, span.start, span.end
