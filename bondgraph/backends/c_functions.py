"""A procedure in C as one function and those that it calls, each on one page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TypeAlias

from bondgraph.backends import listing
from bondgraph.backends.deviations import LONGEST
from bondgraph.backends.short_functions import Piece, Step, pieces, together
from bondgraph.backends.target import Target
from bondgraph.text.tuples import NamedTuple

#: The lines of each of some statements by number, which stand behind each other, at an indent.
_Write: TypeAlias = Callable[[Sequence[int], int], list[list[str]]]
_Cut: TypeAlias = Callable[[Sequence[Step], int, int], tuple[int | Piece, ...]]

_TAB = 4
_AROUND = 6  # lines of a function beside its statements: what it begins and ends with


class Unit(NamedTuple):
    """A statement with the names in C of what it needs: local values, and other arguments.

    It is a part of what `key` names, and the `comment` says what it computes.
    """

    gives: tuple[str, ...]
    takes: frozenset[str]
    uses: frozenset[str]
    key: str
    comment: str


class Written(NamedTuple):
    """The lines of a procedure, and its functions, each before those that call it.

    A function has the holes of piece.c.j2. The lines themselves use these arguments.
    """

    body: list[str]
    functions: list[dict[str, object]]
    uses: frozenset[str]


class Functions:
    """Writes procedures of one file.

    `arguments` are what is handed to a function that uses it: the declaration by name, in order.
    In `heads` are the lines that a function begins with that uses a name. Local values are numbers
    of type `kind`. Names of functions are not among `taken`; those that give nothing back compute
    the `noun` of what they are a part of.
    """

    def __init__(
        self, target: Target, kind: str, arguments: Mapping[str, str], taken: Iterable[str],
        heads: Mapping[str, str] | None = None, noun: str = "a part",
    ) -> None:  # fmt: skip
        self.target, self.kind, self.arguments = target, kind, arguments
        self.heads, self.noun = heads or {}, noun
        self.taken = set(taken) | target.reserved

    def whole(self, units: Sequence[Unit], write: _Write, around: int = 0) -> Written | None:
        """What is short enough to stand in one function, with so many lines `around`."""
        found = _joined(write(range(len(units)), _TAB))
        return Written(found, [], _used(units)) if len(found) <= LONGEST - around else None

    def procedure(
        self,
        name: str,
        units: Sequence[Unit],
        write: _Write,
        around: int = 0,
        cut: _Cut = pieces,
    ) -> Written:
        """What stands in a function called `name` with so many lines `around`.

        `cut` says where to cut what is too long. How many lines a call takes is seen when it is
        written: then there is less room.
        """
        whole, room = self.whole(units, write, around), LONGEST - around
        if whole is not None:
            return whole
        steps = _steps(units, write(range(len(units)), _TAB))
        for less in range(3, 20, 4):
            one = _Procedure(self, name, units, write)
            members = cut(steps, room - less, LONGEST - _AROUND)
            body = one.body(members)
            if len(body) <= room:
                break
        self.taken |= one.taken
        return Written(body, one.functions, one.used(members))

    def choice(
        self,
        branch: tuple[str, str, str],
        sides: Sequence[tuple[str, Sequence[Unit], _Write]],
        around: int,
    ) -> Written:
        """The same of two procedures, of which one is run; each is a function if they are long."""
        found = [_Procedure(self, *side) for side in sides]
        bodies = [_joined(one.write(range(len(one.units)), 2 * _TAB)) for one in found]
        uses = _used([unit for one in found for unit in one.units])
        if sum(map(len, bodies)) + 3 > LONGEST - around:
            most = LONGEST - _AROUND
            whole = [one.write(range(len(one.units)), _TAB) for one in found]
            steps = [_steps(one.units, own) for one, own in zip(found, whole, strict=True)]
            cut = [pieces(own, most, most) for own in steps]
            calls = [one.call(Piece(own, (), ())) for one, own in zip(found, cut, strict=True)]
            bodies = [[" " * _TAB + line for line in call] for call in calls]
            uses = frozenset()
        if_, else_, end = (f"    {line}" for line in branch)
        yes, no = bodies
        functions = [f for one in found for f in one.functions]
        return Written([if_, *yes, else_, *no, end], functions, uses)


class _Procedure:
    """One procedure, while it is written."""

    def __init__(self, file: Functions, name: str, units: Sequence[Unit], write: _Write) -> None:
        self.file, self.name, self.units, self.write = file, name, units, write
        self.taken = {*file.taken}
        self.functions: list[dict[str, object]] = []

    def body(self, members: Sequence[int | Piece]) -> list[str]:
        """The lines of statements and calls."""
        found: list[str] = []
        run: list[int] = []
        for at, member in enumerate(members):
            if isinstance(member, int):
                run.append(member)
                if at + 1 == len(members) or not isinstance(members[at + 1], int):
                    found += [""] * bool(found) + _joined(self.write(run, _TAB))
                    run = []
            else:
                called = at > 0 and not isinstance(members[at - 1], int)
                apart = bool(found) and (not called or len(member.gives) > 1)
                found += [""] * apart + self.call(member)
        return found

    def call(self, piece: Piece) -> list[str]:
        """The lines that call a function, which is written first."""
        name, several = self._function(piece), len(piece.gives) > 1
        values = [*self._arguments(piece), *piece.takes]
        values += [f"&{v}" for v in piece.gives] if several else []
        left = f"const {self.file.kind} {piece.gives[0]} = " if len(piece.gives) == 1 else ""
        declared = [f"    {self.file.kind} {v};" for v in piece.gives] if several else []
        call = listing.statement(
            f"{left}{name}({{0}});", ", ".join(values), self.file.target, 4
        )
        return [*declared, *([""] if declared else []), *call]

    def used(self, members: Sequence[int | Piece]) -> frozenset[str]:
        """What the statements use that stand there themselves."""
        return _used([self.units[k] for k in members if isinstance(k, int)])

    def _arguments(self, piece: Piece) -> list[str]:
        """The arguments of a function that are no local values."""
        used = _used([self.units[k] for k in piece.numbers()])
        return [name for name in self.file.arguments if name in used]

    def _function(self, piece: Piece) -> str:
        """Writes a function; its name."""
        file, name = self.file, self._free(self._called(piece))
        body = self.body(piece.members)
        used, own = self._arguments(piece), self.used(piece.members)
        heads = [line for use, line in file.heads.items() if use in own]
        several = len(piece.gives) > 1
        ends = [f"    *{v}_out = {v};" for v in piece.gives] if several else []
        if len(piece.gives) == 1:
            ends = [f"    return {piece.gives[0]};"]
        declared = [file.arguments[use] for use in used]
        declared += [f"{file.kind} {v}" for v in piece.takes]
        declared += [f"{file.kind} *{v}_out" for v in piece.gives] if several else []
        kind = file.kind if len(piece.gives) == 1 else "void"
        head = f"static {kind} {name}({{0}})"
        self.functions.append(
            {
                "comment": listing.comment(self._about(piece), file.target, 0),
                "head": listing.statement(head, ", ".join(declared), file.target, 0),
                "body": [*heads, *[""] * bool(heads), *body, *[""] * bool(ends), *ends],
            }
        )
        return name

    def _called(self, piece: Piece) -> str:
        """The name that a function would like to have."""
        given = [v.strip("_") for v in piece.gives]
        if given:
            own = given[0] if len(given) == 1 else f"{given[0]}_to_{given[-1]}"
            return f"{self.name}_{own}"
        return f"{self.name}_{self._part(piece).replace(' ', '_') or 'part'}"

    def _part(self, piece: Piece) -> str:
        """What a function is a part of: `r1`, or `r1_w3 to r1_w6`."""
        keys = dict.fromkeys(self.units[k].key for k in piece.numbers() if self.units[k].key)
        whole = together(keys)
        if not keys or whole in keys:
            return whole
        first, *_, last = [*keys, *keys]
        return f"{first} to {last}"

    def _free(self, wish: str) -> str:
        """A name that no other function has."""
        name, count = wish, 1
        while name in self.taken:
            count += 1
            name = f"{wish}_{count}"
        self.taken.add(name)
        return name

    def _about(self, piece: Piece) -> str:
        """What a function computes, as the comments of its statements say."""
        part = self._part(piece)
        if part and not piece.gives:
            return f"{part}: {self.file.noun}"
        units = [self.units[k] for k in piece.numbers()]
        wanted = [u for u in units if set(u.gives) & set(piece.gives)] or units
        texts = list(dict.fromkeys(u.comment for u in wanted if u.comment))
        said = "; ".join(texts if len(texts) < 3 else (texts[0], "...", texts[-1]))
        return said or f"{part or 'a part'}: {self.file.noun}"


def _used(units: Iterable[Unit]) -> frozenset[str]:
    return frozenset[str]().union(*(unit.uses for unit in units))


def _joined(written: Iterable[Iterable[str]]) -> list[str]:
    return [line for own in written for line in own]


def _steps(units: Sequence[Unit], written: Sequence[Sequence[str]]) -> list[Step]:
    """Statements with the lines that each takes behind the one before it."""
    return [Step(unit.gives, unit.takes, unit.key, unit.comment, len(own))
            for unit, own in zip(units, written, strict=True)]  # fmt: skip
