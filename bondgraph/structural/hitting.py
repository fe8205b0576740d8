"""Diagnoses of several faults at once: the minimal sets of faults that explain what has fired."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping

Diagnosis = tuple[str, ...]


def minimal_hitting_sets(
    conflicts: Iterable[Collection[str]], at_most: int | None = None
) -> tuple[Diagnosis, ...]:
    """All minimal sets that share an element with every conflict, the smallest first.

    A conflict is a set of candidates of which one must be at fault (Reiter, 1987; de Kleer and
    Williams, 1987). `at_most` keeps those with so many elements at most. Conflicts are taken in
    one by one: a set that misses the next is extended by each of its elements, and what then
    holds another set is dropped (Berge, 1989). Elements keep the order they were first met in.

    >>> minimal_hitting_sets([("R", "L"), ("L", "C")])
    (('L',), ('R', 'C'))
    """
    order: dict[str, int] = {}
    wanted: list[frozenset[str]] = []
    for conflict in conflicts:
        for element in conflict:
            order.setdefault(element, len(order))
        wanted.append(frozenset(conflict))
    found: list[frozenset[str]] = [frozenset()]
    for conflict in sorted(wanted, key=len):
        hit = [s for s in found if s & conflict]
        grown = {
            s | {e} for s in found if not s & conflict for e in conflict
            if at_most is None or len(s) < at_most
        }  # fmt: skip
        kept = [s for s in grown if not any(h <= s for h in hit)]
        found = hit + kept
    ranked = [tuple(sorted(s, key=order.__getitem__)) for s in found]
    return tuple(sorted(ranked, key=lambda s: (len(s), [order[e] for e in s])))


def diagnoses(
    signatures: Mapping[str, Collection[str]],
    fired: Iterable[str],
    silent: Iterable[str] = (),
    at_most: int | None = None,
) -> tuple[Diagnosis, ...]:
    """The minimal sets of faults that explain which residuals have fired.

    `signatures` gives the faults that each residual sees. Each residual in `fired` is a conflict:
    one of the faults it sees is there. A residual in `silent` clears what it sees (exoneration);
    without `silent` nothing is cleared, which is safe for faults that may cancel each other. Raises
    KeyError for an unknown residual. No diagnosis at all means that a residual has fired although
    everything it sees was cleared.

    >>> diagnoses({"r1": ("L", "R", "sensor"), "r2": ("J", "sensor")}, ("r1", "r2"))
    (('sensor',), ('L', 'J'), ('R', 'J'))
    >>> diagnoses({"r1": ("L", "R", "sensor"), "r2": ("J", "sensor")}, ("r1",), silent=("r2",))
    (('L',), ('R',))
    """
    cleared = {f for name in silent for f in signatures[name]}
    conflicts = [tuple(f for f in signatures[name] if f not in cleared) for name in fired]
    return minimal_hitting_sets(conflicts, at_most)
