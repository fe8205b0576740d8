"""Things that belong together: union and find (Galler and Fischer, 1964)."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import Generic, TypeVar

T = TypeVar("T", bound=Hashable)


class Groups(Generic[T]):
    """Groups of things, each with one of its members as root; at first everything is by itself.

    >>> groups = Groups()
    >>> groups.join("a", "b"), groups.join("b", "c"), groups.join("c", "a")
    (True, True, False)
    >>> groups.find("c"), groups.find("d")
    ('a', 'd')
    """

    def __init__(self) -> None:
        self._above: dict[T, T] = {}

    def find(self, member: T) -> T:
        """The root of the group that a member is in."""
        above = self._above
        root = member
        while root in above:
            root = above[root]
        while member != root:
            above[member], member = root, above[member]
        return root

    def join(self, one: T, other: T) -> bool:
        """Make two groups one under the root of the first; whether they were apart."""
        one, other = self.find(one), self.find(other)
        if one != other:
            self._above[other] = one
        return one != other

    def among(self, members: Iterable[T]) -> list[list[T]]:
        """The members in their groups, each group where its first member stands."""
        found: dict[T, list[T]] = {}
        for member in members:
            found.setdefault(self.find(member), []).append(member)
        return list(found.values())
