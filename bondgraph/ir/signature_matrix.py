"""The fault signature matrix and what follows from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from itertools import combinations, compress
from operator import itemgetter
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


_NONE: Mapping[Any, Any] = MappingProxyType({})


class SignatureMatrix(NamedTuple):
    """Which residual reacts to which fault: `rows[fault][residual]`, exact.

    `orders[residual]` gives the highest derivative of each known signal that the residual sees
    (-1: only under an integral). An entry says what is seen at the declared numbers. `apart` has
    those that are seen only elsewhere, by (residual, fault): the declared values of which any one
    would have to differ, none where it takes several. `unconfirmed` has the residuals whose
    entries no trajectory of the machine confirms, with the reason.
    """

    residuals: tuple[str, ...]
    faults: tuple[str, ...]
    rows: tuple[tuple[bool, ...], ...]
    orders: tuple[dict[str, int], ...]
    apart: Mapping[tuple[str, str], tuple[str, ...]] = _NONE
    unconfirmed: Mapping[str, str] = _NONE

    def seen_by(self, fault: str) -> tuple[str, ...]:
        """The residuals that see a fault; raises KeyError for an unknown name."""
        return tuple(compress(self.residuals, self.row(fault)))

    def row(self, fault: str) -> tuple[bool, ...]:
        """The signature of a fault; raises KeyError for an unknown name."""
        try:
            return self.rows[self.faults.index(fault)]
        except ValueError:
            raise KeyError(fault) from None

    def signature(self, residual: str) -> tuple[str, ...]:
        """The faults that a residual sees."""
        at = self.residuals.index(residual)
        return tuple(compress(self.faults, map(itemgetter(at), self.rows)))

    @property
    def sees(self) -> dict[str, tuple[str, ...]]:
        """The faults that each residual sees."""
        found: dict[str, list[str]] = {residual: [] for residual in self.residuals}
        for fault, row in zip(self.faults, self.rows, strict=True):
            for residual in compress(self.residuals, row):
                found[residual].append(fault)
        return {residual: tuple(faults) for residual, faults in found.items()}

    @property
    def undetectable(self) -> tuple[str, ...]:
        """Faults that no residual sees (Mb = 0)."""
        return tuple(f for f, row in zip(self.faults, self.rows, strict=True) if not any(row))

    @property
    def groups(self) -> tuple[tuple[str, ...], ...]:
        """The detectable faults, those with equal signatures together (Ib = 1 alone in a group)."""
        found: dict[tuple[bool, ...], list[str]] = {}
        for fault, row in zip(self.faults, self.rows, strict=True):
            if any(row):
                found.setdefault(row, []).append(fault)
        return tuple(tuple(g) for g in found.values())

    def only_off_nominal(self, residual: str) -> dict[str, tuple[str, ...]]:
        """The faults that a residual sees only where declared values differ, with these values."""
        found = {fault: values for (name, fault), values in self.apart.items() if name == residual}
        return {fault: found[fault] for fault in self.faults if fault in found} if found else {}

    def confused_with(self, fault: str) -> tuple[str, ...]:
        """The other faults with the same signature."""
        own = self.row(fault)
        return tuple(
            f for f, row in zip(self.faults, self.rows, strict=True) if row == own and f != fault
        )

    def renamed(self, names: Mapping[str, str]) -> SignatureMatrix:
        """The residuals that are keys of `names`, under other names."""
        at = [k for k, name in enumerate(self.residuals) if name in names]
        return SignatureMatrix(
            tuple(names[self.residuals[k]] for k in at),
            self.faults,
            tuple(tuple(row[k] for k in at) for row in self.rows),
            tuple(self.orders[k] for k in at),
            {(names[r], f): own for (r, f), own in self.apart.items() if r in names},
            {names[r]: why for r, why in self.unconfirmed.items() if r in names},
        )

    def beside(self, other: SignatureMatrix) -> SignatureMatrix:
        """The matrix with the residuals of another one, of the same faults, behind its own."""
        return SignatureMatrix(
            self.residuals + other.residuals,
            self.faults,
            tuple(own + more for own, more in zip(self.rows, other.rows, strict=True)),
            self.orders + other.orders,
            {**self.apart, **other.apart},
            {**self.unconfirmed, **other.unconfirmed},
        )

    def to_numpy(self) -> npt.NDArray[np.bool_]:
        """The matrix as an array of shape (faults, residuals)."""
        import numpy as np

        return np.array(self.rows, dtype=bool).reshape(len(self.faults), len(self.residuals))

    def _repr_html_(self) -> str:
        """A table for a notebook: one row a fault, a filled cell where a residual reacts."""
        head = "".join(f"<th>{r}</th>" for r in self.residuals)
        rows = []
        for fault, row in zip(self.faults, self.rows, strict=True):
            cells = "".join(f"<td>{'&#9679;' if hit else ''}</td>" for hit in row)
            rows.append(f"<tr><th style='text-align:left'>{escape(fault)}</th>{cells}</tr>")
        return f"<table><tr><th></th>{head}</tr>{''.join(rows)}</table>"

    def __str__(self) -> str:
        width = max([5, *map(len, self.faults)])
        head = " " * width + "  " + "  ".join(self.residuals) + "  Mb  Ib"
        lines = [head]
        alone = {g[0] for g in self.groups if len(g) == 1}
        for fault, row in zip(self.faults, self.rows, strict=True):
            cells = [
                ("1" if hit else ".").rjust(len(r))
                for hit, r in zip(row, self.residuals, strict=True)
            ]
            verdict = f"{int(any(row)):>4}{int(fault in alone):>4}"
            lines.append(fault.ljust(width) + "  " + "  ".join(cells) + verdict)
        return "\n".join(lines)


class ModeSignature(NamedTuple):
    """The signatures while the machine stays in one mode.

    `modes` gives each boolean input its value; `matrix` is None where the plant has no behaviour
    in that mode, and `reason` then says why. Behind the faults of the model the matrix has a row
    for each boolean input: the switch is in the other position than the one it is told.
    `impossible` are those of which the other position has no behaviour, with the reason.
    """

    modes: dict[str, bool]
    matrix: SignatureMatrix | None
    reason: str
    impossible: Mapping[str, str] = _NONE

    @property
    def name(self) -> str:
        """The mode in words: `on off, diode on`."""
        return ", ".join(f"{n} {'on' if on else 'off'}" for n, on in self.modes.items())

    @property
    def stuck(self) -> dict[str, str]:
        """What each boolean input is as a fault here: `{"on": "on stuck off"}` where told on."""
        return {n: stuck(n, not on) for n, on in self.modes.items()}

    def like(self, whole: SignatureMatrix) -> bool:
        """Whether the faults of the model have the same signatures as in another matrix."""
        return self.matrix is not None and self.matrix.rows[: len(whole.rows)] == whole.rows


def stuck(switch: str, position: bool) -> str:
    """The name of the fault that a switch is in this position whatever it is told.

    >>> stuck("m[1].on", False)
    'm[1].on stuck off'
    """
    return f"{switch} stuck {'on' if position else 'off'}"


class ModeSignatures(NamedTuple):
    """The signatures in each mode, in binary order of the boolean inputs `names`.

    `total` is how many modes there are; fewer are listed where they are too many.
    """

    names: tuple[str, ...]
    modes: tuple[ModeSignature, ...]
    total: int


class Detectability(NamedTuple):
    """How each residual sees each fault: for as long as it lasts, or only while signals change.

    `strong[fault][residual]` says that a constant fault holds the residual away from zero in
    steady operation; None where the machine has no steady operation to decide it by.
    """

    residuals: tuple[str, ...]
    faults: tuple[str, ...]
    strong: tuple[tuple[bool | None, ...], ...]
    matrix: SignatureMatrix

    def weak(self, residual: str) -> tuple[str, ...] | None:
        """The faults that a residual sees only in transients; None where that is not known."""
        at = self.residuals.index(residual)
        if any(row[at] is None for row in self.strong):
            return None
        seen = self.matrix.signature(residual)
        lasting = {f for f, row in zip(self.faults, self.strong, strict=True) if row[at]}
        return tuple(f for f in seen if f not in lasting)

    @property
    def only_weak(self) -> tuple[str, ...]:
        """The detectable faults that every residual that sees them sees only in transients."""
        return tuple(
            fault
            for fault, hits, row in zip(self.faults, self.matrix.rows, self.strong, strict=True)
            if any(hits) and all(s is False for s, hit in zip(row, hits, strict=True) if hit)
        )


class DoubleFaults(NamedTuple):
    """Which two faults at once could look like one alone, by number of its group.

    `groups` are the detectable faults, those together that nothing tells apart. Any two groups in
    a set of `alike[k]` have faults that, each of some course in time, move every residual like a
    fault of group k. Where it is not known `alike` is empty, and `reason` says why.
    """

    groups: tuple[tuple[str, ...], ...]
    alike: tuple[tuple[tuple[int, ...], ...], ...]
    reason: str

    @property
    def any_two(self) -> bool:
        """Whether any two groups look like any other, as where residuals have two dimensions."""
        every = range(len(self.groups))
        others = [(tuple(k for k in every if k != own),) for own in every]
        return len(self.groups) > 2 and list(self.alike) == others

    def looks_like_two(self, fault: str) -> bool:
        """Whether two faults of other groups could look like this one alone, as far as is known."""
        known = bool(self.alike) and any(fault in group for group in self.groups)
        return known and bool(self.like(fault))

    def like_none(self, faults: Iterable[str]) -> bool:
        """Whether some two of these, each of any course, look like no single fault at all.

        As far as is known: of two faults, whether they do.

        >>> doubles = DoubleFaults((("a", "b"), ("c",), ("d",)), ((), (), ((0, 1),)), "")
        >>> [doubles.like_none(some) for some in ("ab", "ac", "ad", "abc", "acd")]
        [False, False, True, False, True]
        """
        some = set(faults)
        own = [k for k, group in enumerate(self.groups) if not some.isdisjoint(group)]
        mistaken = {
            pair for alike in self.alike for several in alike for pair in combinations(several, 2)
        }
        return bool(self.alike) and any(pair not in mistaken for pair in combinations(own, 2))

    def like(self, fault: str) -> tuple[tuple[tuple[str, ...], ...], ...]:
        """Sets of groups: two faults of different groups in a set could look like this one alone.

        Raises KeyError for a fault that is in no group.
        """
        for own, group in enumerate(self.groups):
            if fault in group:
                found = self.alike[own] if self.alike else ()
                return tuple(tuple(self.groups[k] for k in several) for several in found)
        raise KeyError(fault)
