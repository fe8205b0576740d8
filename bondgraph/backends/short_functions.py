"""Where a run of statements that is too long for one function is cut into several that are not.

A piece is a stretch of the run, so that nothing changes its order. It takes values that were
computed before it, and gives back those that are read after it: the fewer, the better the cut. It
does not begin or end in the midst of what one comment is about, rather where another part of a
residual begins (`key`), and best where one value leaves. Which pieces are best together is found by
dynamic programming; where the calls alone are too many lines they are cut in turn.
"""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Iterator, Mapping, Sequence, Set
from itertools import accumulate, groupby, takewhile
from math import inf
from typing import TypeAlias

from bondgraph.text.tuples import NamedTuple

_NONE = frozenset[str]()
_SHORTEST = 7  # lines that are worth a function
_LINE = 0.15  # what a line costs that is left
_MOST_TAKEN, _MOST_GIVEN = 12, 8  # values
_PRICE = 8.0  # of a function, in values that are handed over; a whole part has none
_SAME_KEY, _OTHER_KEY = 4.0, 6.0  # what cuts in between cost
_EACH_GIVEN = 4.0  # after the first, which is returned
_NOTHING_GIVEN = 6.0  # and it is no part that has a name


class Step(NamedTuple):
    """A statement: the local values it `gives` and `takes`, the lines it needs."""

    gives: tuple[str, ...]
    takes: frozenset[str]
    key: str
    comment: str
    lines: int


class Piece(NamedTuple):
    """A function: statements by number, and functions that it calls."""

    members: tuple[int | Piece, ...]
    takes: tuple[str, ...]
    gives: tuple[str, ...]

    def numbers(self) -> Iterator[int]:
        """Its statements, with those of what it calls."""
        for member in self.members:
            yield from (member,) if isinstance(member, int) else member.numbers()


class _Cut(NamedTuple):
    """A stretch that can be a function: what it costs, the lines of its call."""

    end: int
    cost: float
    call: int


#: How a stretch to the end begins: what all its cuts cost; what it begins with stands up to here,
#: a function if that is more than one statement; the lines that are left behind that.
_Way: TypeAlias = tuple[float, int, int]


def pieces(steps: Sequence[Step], room: int, most: int) -> tuple[int | Piece, ...]:
    """The members of a function with `room` lines, which calls others with at most `most`.

    What cannot be cut stays too long.

    >>> reads = ["a", "b", "c", "d", "e", "d e"]
    >>> steps = [Step((x,), frozenset(y.split()), "", x, 3) for x, y in zip("bcdefg", reads)]
    >>> pieces(steps, 13, 20)
    (Piece(members=(0, 1, 2), takes=('a',), gives=('d',)), 3, 4, 5)
    """
    return _cut(list(range(len(steps))), list(steps), room, most)


def parts(
    steps: Sequence[Step], room: int, most: int, depth: int = 1, after: frozenset[str] = _NONE
) -> tuple[int | Piece, ...]:
    """The same where each part is a function, down to parts of parts, if it is as long as one.

    Where that does not suffice the rest is cut anywhere. The values `after` are read later.

    >>> keys = ["", *["a"] * 4, *["b_1"] * 3, *["b_2"] * 3]
    >>> steps = [Step((), frozenset(), key, str(k), 3) for k, key in enumerate(keys)]
    >>> [m if isinstance(m, int) else m.members for m in parts(steps, 9, 20)]
    [0, (1, 2, 3, 4), (5, 6, 7, 8, 9, 10)]
    """
    members: list[int | Piece] = []
    left: list[Step] = []
    handed = _Handed(steps, after)
    for key, run in groupby(range(len(steps)), lambda at: steps[at].key.split("_")[:depth]):
        numbers = list(run)
        own = [steps[k] for k in numbers]
        lines, whole = sum(step.lines for step in own), len(key) == depth and key != [""]
        if not whole or lines < _SHORTEST:
            members += numbers
            left += own
            continue
        takes, gives = handed.over(numbers[0], numbers[-1] + 1)
        inside: Iterable[int | Piece] = range(len(own))
        if lines > most:
            inside = parts(own, most, most, depth + 1, frozenset(gives))
        members.append(Piece(tuple(_moved(inside, numbers[0])), takes, gives))
        left.append(_called(own, takes, gives))
    return _cut(members, left, room, most, after)


def _moved(members: Iterable[int | Piece], by: int) -> Iterator[int | Piece]:
    """Members of a stretch by the numbers of the whole."""
    for member in members:
        if isinstance(member, int):
            yield member + by
        else:
            yield member._replace(members=tuple(_moved(member.members, by)))


def _cut(
    members: list[int | Piece],
    steps: list[Step],
    room: int,
    most: int,
    after: frozenset[str] = _NONE,
) -> tuple[int | Piece, ...]:
    while sum(step.lines for step in steps) > room:
        cuts = list(_chosen(steps, room, most, after))
        if not cuts:
            break
        handed = _Handed([*steps], after)
        for start, end in reversed(cuts):
            takes, gives = handed.over(start, end)
            members[start:end] = [Piece(tuple(members[start:end]), takes, gives)]
            steps[start:end] = [_called(steps[start:end], takes, gives)]
    return tuple(members)


def _called(steps: Sequence[Step], takes: tuple[str, ...], gives: tuple[str, ...]) -> Step:
    """The call of a function with these statements as a statement."""
    key = together(step.key for step in steps if step.key)
    return Step(gives, frozenset(takes), key, "", _call(takes, gives))


class _Handed:
    """What stretches of some statements take and give; the values `after` are read behind all."""

    def __init__(self, steps: Sequence[Step], after: frozenset[str]) -> None:
        self.steps = steps
        self.place: dict[str, int] = {}  # of each value in the order in which they are computed
        self.given: dict[str, int] = {}  # by which statement
        self.last = {v: at for at, step in enumerate(steps) for v in step.takes}
        self.last |= dict.fromkeys(after, len(steps))
        for at, step in enumerate(steps):
            for v in step.gives:
                self.place.setdefault(v, len(self.place))
                self.given.setdefault(v, at)

    def over(self, start: int, end: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """What a stretch takes and gives, in the order in which it is computed."""
        own = self.steps[start:end]
        inside = {v for step in own for v in step.gives}
        taken = {v for step in own for v in step.takes} - inside
        before = {v for v in taken if self.given.get(v, start) < start}
        return (
            (*sorted(taken - before), *sorted(before, key=self.place.__getitem__)),
            tuple(v for step in own for v in step.gives if self.last.get(v, -1) >= end),
        )


def together(keys: Iterable[str]) -> str:
    """What several keys are parts of, in words.

    >>> together(["r1_w1", "r1_w2"]), together(["r1_w1"]), together(["r1", "filter"])
    ('r1', 'r1_w1', '')
    """
    words = [key.split("_") for key in dict.fromkeys(keys)]
    same = zip(*words, strict=False)
    return "_".join(column[0] for column in takewhile(lambda own: len({*own}) == 1, same))


def _call(takes: Collection[str], gives: Collection[str]) -> int:
    """The lines of a call, with those that declare what it gives if it is more than one value."""
    letters = 40 + sum(len(v) + 2 for v in (*takes, *gives))
    return 1 + letters // 90 + (len(gives) + 2 if len(gives) > 1 else 0)


def _chosen(
    steps: Sequence[Step], room: int, most: int, after: frozenset[str]
) -> Iterator[tuple[int, int]]:
    """The cheapest cuts that leave no more lines than there is room for, or else the fewest lines.

    From the end: for each number of lines that are left the cheapest way to get there, where the
    fewest lines that the statements before can be still fit in.
    """
    count = len(steps)
    starts = [list(cuts) for cuts in _cuts(steps, most, after)]
    fewest = _fewest(steps, starts)
    ways: list[dict[int, _Way]] = [{} for _ in range(count)] + [{0: (0.0, count, 0)}]
    for at in range(count - 1, -1, -1):
        lines, price = steps[at].lines, _LINE * steps[at].lines
        found = {left + lines: (cost + price, at + 1, left)
                 for left, (cost, _, _) in ways[at + 1].items()}  # fmt: skip
        for end, own, call in starts[at]:
            behind = ways[end]
            fit = room - fewest[at] - call
            for left in behind:  # the fewest first: of what does not fit no more can be of use
                cost, known = own + behind[left][0], found.get(left + call)
                if known is None or cost < known[0]:
                    found[left + call] = (cost, end, left)
                if left > fit:
                    break
        ways[at] = _worthwhile(found, room - fewest[at])
    left, at = min(ways[0].items(), key=lambda item: (item[0] > room, item[1][0]))[0], 0
    while at < count:
        _, end, left = ways[at][left]
        if end > at + 1:
            yield at, end
        at = end


def _fewest(steps: Sequence[Step], starts: Sequence[Sequence[_Cut]]) -> list[int]:
    """The fewest lines that the statements before each can be."""
    found = [0, *accumulate(step.lines for step in steps)]
    for at, step in enumerate(steps):
        found[at + 1] = min(found[at + 1], found[at] + step.lines)
        for end, _, call in starts[at]:
            found[end] = min(found[end], found[at] + call)
    return found


def _worthwhile(ways: Mapping[int, _Way], room: int) -> dict[int, _Way]:
    """The ways than which no other is cheaper and leaves fewer lines; one that is too long."""
    found: dict[int, _Way] = {}
    cheapest = inf
    for left in sorted(ways):
        way = ways[left]
        if way[0] < cheapest and (left <= room or not found):
            found[left] = way
            cheapest = way[0]
        if left > room:
            break
    return found


def _cuts(
    steps: Sequence[Step], most: int, after: frozenset[str]
) -> Iterator[Iterator[_Cut]]:
    """The stretches that can be a function, from each statement on."""
    last = {v: at for at, step in enumerate(steps) for v in step.takes}  # where it is read last
    last |= dict.fromkeys(after, len(steps))
    ends = _ends(steps)
    for start in range(len(steps)):
        yield _from(steps, start, most, ends, last) if start in ends else iter(())


def _from(
    steps: Sequence[Step], start: int, most: int, ends: Container[int], last: Mapping[str, int]
) -> Iterator[_Cut]:
    """The stretches that begin with a statement."""
    lines, inside, taken, keys = 0, set[str](), set[str](), set[str]()
    gives: list[str] = []
    for end in range(start + 1, len(steps) + 1):
        step = steps[end - 1]
        lines += step.lines
        taken |= step.takes - inside
        if lines > most or len(taken) > _MOST_TAKEN:
            break
        inside.update(step.gives)
        keys.add(step.key)
        gives = [v for v in (*gives, *step.gives) if last.get(v, -1) >= end]
        if end not in ends or lines < _SHORTEST or end - start in (1, len(steps)):
            continue
        if len(gives) <= _MOST_GIVEN and (call := _call(taken, gives)) < lines:
            yield _Cut(end, _cost(steps, start, end, keys, len(taken), len(gives)), call)


def _ends(steps: Sequence[Step]) -> set[int]:
    """Where a stretch may begin and end: not in the midst of what one comment is about.

    But that is not endless.
    """
    found, last = {0, len(steps)}, 0
    for at in range(1, len(steps)):
        if not steps[at].comment or steps[at].comment != steps[at - 1].comment or at - last > 9:
            found.add(at)
            last = at
    return found


def _cost(
    steps: Sequence[Step], start: int, end: int, keys: Set[str], takes: int, gives: int
) -> float:
    """What a stretch costs with these keys, which takes and gives so many values."""
    before = steps[start - 1].key if start else ""
    behind = steps[end].key if end < len(steps) else ""
    cost = takes + takes**2 / 16.0 + _EACH_GIVEN * max(0, gives - 1)
    if len(keys) > 1 or steps[start].key in ("", before, behind):
        named = len(keys) - ("" in keys)
        cost += _PRICE + _OTHER_KEY * max(0, named - 1)
        cost += _NOTHING_GIVEN * (gives == 0 and not named)
    for one, other in ((before, steps[start].key), (steps[end - 1].key, behind)):
        if one and one == other:
            cost += _SAME_KEY
    return cost
