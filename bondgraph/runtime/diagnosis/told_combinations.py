"""What logs tell of parameters that they do not tell apart: a ratio, a product, a sum."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.text.numerals import joined
from bondgraph.text.tuples import NamedTuple

_PART = 0.02  # of a direction: a smaller component is none
_NEAR = 0.05  # an exponent or a factor is that whole number
_MOVE = 0.2  # relative, by which products and sums are told apart


class Combination(NamedTuple):
    """Parameters that the logs do not tell apart.

    `told` is what they tell of them (`R/L`, `R1 + R2`), "" for nothing that has a short name;
    `changes` are by how much some may change together with nothing to be seen, relative to their
    values; in their own unit for those in `zeros`, which are declared to be zero. `more` is how
    many times the motion of these logs would tell, as far as they go: None where in these logs what
    they do not tell does next to nothing. Then `still` are the inputs and switches that never move
    in them, of those that stand in a relation with the parameters.
    """

    parameters: tuple[str, ...]
    told: str
    changes: tuple[dict[str, float], ...]
    zeros: tuple[str, ...] = ()
    more: float | None = None
    still: tuple[str, ...] = ()

    def text(self) -> str:
        """One sentence for people.

        >>> Combination(("R1", "R2"), "R1 + R2", ()).text()
        'only R1 + R2 is told'
        >>> Combination(("k",), "", ({"k": 1.0},)).text()
        'k is not told'
        >>> Combination(("R", "L", "k"), "", ({"R": 0.1, "L": 0.1, "k": -0.05},)).text()
        'R, L and k are not told apart: R +10 % with L +10 % and k -5 % changes nothing'
        >>> Combination(("m", "b", "k"), "", ({"m": 0.1, "b": 0.1, "k": 0.1},)).text()
        'only ratios of m, b and k are told'
        >>> Combination(("R", "z"), "", ({"R": 0.1, "z": -0.02},), ("z",)).text()
        'R and z are not told apart: R +10 % with z -0.02 changes nothing'
        """
        if self.told:
            return f"only {self.told} is told"
        if len(self.parameters) == 1:
            return f"{self.parameters[0]} is not told"
        if self._ratios():
            return f"only ratios of {joined(self.parameters, 'and')} are told"
        moves = []
        for change in self.changes:
            parts = [
                f"{name} {by:+.3g}" if name in self.zeros else f"{name} {100 * by:+.3g} %"
                for name, by in change.items()
            ]
            moves.append(f"{parts[0]} with {joined(parts[1:], 'and')}" if parts[1:] else parts[0])
        what = f"{joined(self.parameters, 'and')} are not told apart"
        return f"{what}: {joined(moves, 'and')} changes nothing"

    def which(self) -> str:
        """Which log would tell.

        What is known of a parameter grows with the motion, and with the root of time.

        >>> Combination(("k",), "", ({"k": 1.0},), more=3.0).which()
        'a log with 3 times the motion would tell, or 9 times as long'
        >>> Combination(("k",), "", ({"k": 1.0},)).which()
        'no log like these would tell: another motion may'
        >>> Combination(("k",), "", ({"k": 1.0},), still=("fan", "u")).which()
        'no log like these would tell: another motion may (fan and u stand still in them)'

        A common factor of all terms of a relation no motion tells. Once one of several is known
        otherwise, the logs tell the others.

        >>> Combination(("m", "k"), "", ({"m": 0.1, "k": 0.1},)).which()
        'no log tells their common factor: declare one that is known without a tolerance'
        >>> Combination(("R", "L"), "R/L", ({"R": 0.1, "L": 0.1},)).which()
        'no log tells their common factor: declare one that is known without a tolerance'
        """
        if self.more is None and len(self.parameters) > 1 and self._ratios():
            return "no log tells their common factor: declare one that is known without a tolerance"
        if self.more is None:
            stand = "stands" if len(self.still) == 1 else "stand"
            what = f" ({joined(self.still, 'and')} {stand} still in them)" if self.still else ""
            return f"no log like these would tell: another motion may{what}"
        much, long = f"{self.more:.2g} times the motion", f"{self.more**2:.2g} times as long"
        return f"a log with {much} would tell, or {long}"

    def _ratios(self) -> bool:
        """Whether all may change by one factor, and by nothing else."""
        if self.zeros or len(self.changes) != 1 or len(self.parameters) != len(self.changes[0]):
            return False
        by = self.changes[0].values()
        return min(by) > 0 and max(by) <= (1.0 + _NEAR) * min(by)


def combinations(
    names: Sequence[str],
    values: Sequence[float],
    scale: Array,
    zeros: Array,
    null: Array,
    cost: Callable[[Sequence[float]], float],
    more: Callable[[Sequence[int]], float | None] = lambda _: None,
) -> tuple[Combination, ...]:
    """What is told of parameters that may change along the rows of `null` and nothing shows.

    These are changes of (value - nominal) / scale; `cost` is what some values leave. What is
    declared zero has in `zeros` a size that a change of it is compared with, others have 0. `more`
    says how many times the motion would tell parameters, by their numbers.
    """
    found = []
    rest = list(range(len(null)))
    while rest:
        group = [rest.pop(0)]
        members = null[group[0]] != 0
        while beside := [k for k in rest if (members & (null[k] != 0)).any()]:
            group += beside
            rest = [k for k in rest if k not in beside]
            members = (null[group] != 0).any(axis=0)
        own = np.flatnonzero(members).tolist()
        one = _named(own, null[group][:, own], names, values, scale, zeros, cost)
        found.append(one._replace(more=more(own)))
    return tuple(found)


def untold(covariance: Array, most: float) -> Array:
    """The directions (n, p) in which a covariance (p, p) is `most` or more, each of few parameters.

    >>> untold(np.array([[50.0, -50.0, 0.0], [-50.0, 50.0, 0.0], [0.0, 0.0, 0.01]]), 1.0).tolist()
    [[1.0, -1.0, 0.0]]
    """
    variance, vectors = np.linalg.eigh(covariance)
    return _sparse(vectors[:, variance >= most].T)


def _sparse(rows: Array) -> Array:
    """The same space of rows, each with as many zeros as elimination gives."""
    found = rows.copy()
    for k in range(len(found)):
        at = int(np.argmax(np.abs(found[k])))  # never where another row has its one: 0.0 is there
        found[k] /= found[k, at]
        for j in range(len(found)):
            if j != k:
                found[j] -= found[j, at] * found[k]
    found[np.abs(found) < _PART * np.abs(found).max(axis=1, initial=1.0, keepdims=True)] = 0.0
    return found


def _named(
    own: list[int],
    null: Array,
    names: Sequence[str],
    values: Sequence[float],
    scale: Array,
    zeros: Array,
    cost: Callable[[Sequence[float]], float],
) -> Combination:
    """What is told of the parameters numbered `own`, that change along the rows of `null`."""
    called = tuple(names[k] for k in own)
    value = np.array([values[k] for k in own])
    absolute = null * scale[own]
    zero = zeros[own]
    size = np.where(zero > 0, zero, np.abs(value))
    own_unit = np.where(zero > 0, zero, 1.0)
    changes = tuple(
        {n: 0.1 * float(x) for n, x in zip(called, own_unit * row / np.abs(row).max(), strict=True)
         if x}
        for row in absolute / size
    )  # fmt: skip
    noughts = tuple(n for n, x in zip(called, zero, strict=True) if x > 0)
    if len(own) - len(null) != 1:
        return Combination(called, "", changes, noughts)
    gradient = np.linalg.svd(absolute / size)[2][-1]  # along which alone something changes
    written = []
    exponents = _whole(gradient)
    if exponents is not None and not noughts:
        step = _MOVE * null[0] * scale[own] / value
        written.append((value * np.exp(step), _product(called, exponents)))
    factors = _whole(gradient / size)
    if factors is not None:
        written.append((value + _MOVE * absolute[0], _sum(called, factors)))

    def moved(point: Array) -> float:
        whole = np.array(values, dtype=float)
        whole[own] = point
        return cost(whole.tolist())

    told = min(written, key=lambda one: moved(one[0]))[1] if written else ""
    return Combination(called, told, changes, noughts)


def _whole(numbers: Array) -> list[int] | None:
    """The numbers as multiples of the smallest of them, None where they are no whole ones."""
    found = numbers / np.abs(numbers).min()
    near = np.rint(found)
    if np.abs(near).max() > 3 or (np.abs(found - near) > _NEAR * np.abs(near)).any():
        return None
    return [int(x) for x in near * np.sign(near[np.argmax(near)])]


def _product(names: Sequence[str], exponents: Sequence[int]) -> str:
    """R/L, k^2/(R*J), 1/(R*C) as R*C."""
    sign = 1 if max(exponents) > 0 else -1
    powers = [(n, sign * e) for n, e in zip(names, exponents, strict=True)]
    over = [n if e == 1 else f"{n}^{e}" for n, e in powers if e > 0]
    under = [n if e == -1 else f"{n}^{-e}" for n, e in powers if e < 0]
    below = f"({'*'.join(under)})" if len(under) > 1 else "".join(under)
    return "*".join(over) + (f"/{below}" if under else "")


def _sum(names: Sequence[str], factors: Sequence[int]) -> str:
    """R1 + R2, 2*a - b."""
    parts: list[str] = []
    for name, factor in zip(names, factors, strict=True):
        sign = ("- " if factor < 0 else "+ ") if parts else ("-" if factor < 0 else "")
        parts.append(sign + (name if abs(factor) == 1 else f"{abs(factor)}*{name}"))
    return " ".join(parts)
