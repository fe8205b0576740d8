"""Names of a model as mathematical letters: base, index, and only as much path as is needed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import combinations

from bondgraph.text.tuples import NamedTuple

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "zeta": "ζ",
    "eta": "η", "theta": "θ", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "xi": "ξ",
    "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "chi": "χ", "psi": "ψ", "omega": "ω",
    "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ", "Sigma": "Σ", "Phi": "Φ",
    "Psi": "Ψ", "Omega": "Ω",
}  # fmt: skip
_WORDS = frozenset({"on", "up"})  # short, but no letter with an index
_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_DEEPEST = 8  # parts of a path that are tried in all combinations


class Letter(NamedTuple):
    """A name as it is typeset: `base` with the index `below`, and `where` in the model it is."""

    base: str
    below: str
    where: tuple[str, ...]


class Spare:
    """Names x1, x2, ... for parts of formulas, none of which looks like one that is `taken`.

    However it is set: x_1, x[1] and m.x1 all become the letter x with a small 1.

    >>> spare = Spare(["x1", "m.x_2", "x[4]", "x5.m"])
    >>> [spare.name(k) for k in (1, 2, 3)]
    ['x3', 'x5', 'x6']
    """

    def __init__(self, taken: Iterable[str]) -> None:
        last = {name.rpartition(".")[2] for name in taken}
        alike = [split_name(name) for name in last if name.startswith("x")]  # the others are not x
        self._taken = {below for base, below in alike if base == "x"}

    def name(self, number: int) -> str:
        """The name with this number, or with the next one that is free; it is taken then."""
        while str(number) in self._taken:
            number += 1
        self._taken.add(str(number))
        return f"x{number}"


def letters(names: Iterable[str]) -> dict[str, Letter]:
    """The letter of every name, no two alike; of a path the fewest parts that keep it apart.

    >>> found = letters(["m[1].el.Re", "m[2].el.Re", "line.R", "tau0", "Fx[2]"])
    >>> found["m[1].el.Re"], found["line.R"].where
    (Letter(base='R', below='e', where=('m₁',)), ())
    >>> found["tau0"].base, found["Fx[2]"].below
    ('τ', 'x,2')
    """
    classes: dict[tuple[str, str], list[tuple[str, ...]]] = {}
    split = {name: (split_name(name), tuple(name.split(".")[:-1])) for name in names}
    for own, path in split.values():
        classes.setdefault(own, []).append(path)
    crowd = {own: _crowd(paths) for own, paths in classes.items()}
    return {
        name: Letter(*own, tuple(indexed(p) for p in _shortest(path, crowd[own])))
        for name, (own, path) in split.items()
    }


def split_name(name: str) -> tuple[str, str]:
    """The base and the index of the last part of a name.

    >>> split_name("Uin"), split_name("load"), split_name("e2"), split_name("m_wheel")
    (('U', 'in'), ('load', ''), ('e', '2'), ('m', 'wheel'))
    """
    last = name.rpartition(".")[2]
    found = re.fullmatch(r"([A-Za-z]+)((?:#?\d+)?)((?:_\w+)?)((?:\[[\d,]+\])?)", last)
    if found is None:
        return indexed(last), ""
    word, digits, after, place = found.groups()
    if after and len(word) > 3 and word not in GREEK:  # words, not a letter with an index
        word, after = word + digits + after, ""
        digits = ""
    head, rest = word, ""
    for greek, sign in GREEK.items():
        if word == greek:
            head = sign
    if (
        head == word
        and word not in _WORDS
        and (len(word) == 2 or (len(word) == 3 and word[0].isupper()))
    ):
        head, rest = (word, "") if word.isupper() and len(word) > 2 else (word[0], word[1:])
    parts = [rest + digits, after[1:], place.strip("[]")]
    return head, ",".join(part for part in parts if part)


def indexed(part: str) -> str:
    """A part of a path, the index of an array as small digits: `m[1]` is `m₁`."""
    return re.sub(r"\[([\d,]+)\]", lambda m: m[1].translate(_BELOW), part)


def _subsets(path: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """Parts of a path in order, few before many, the innermost first."""
    if len(path) > _DEEPEST:
        path = path[-_DEEPEST:]
    for size in range(len(path) + 1):
        yield from reversed(list(combinations(path, size)))


def _crowd(paths: list[tuple[str, ...]]) -> Counter[tuple[str, ...]]:
    """How many paths hold each combination of parts."""
    found: Counter[tuple[str, ...]] = Counter()
    for path in paths:
        found.update(set(_subsets(path)))
    return found


def _shortest(path: tuple[str, ...], crowd: Counter[tuple[str, ...]]) -> tuple[str, ...]:
    return next((parts for parts in _subsets(path) if crowd[parts] == 1), path)
