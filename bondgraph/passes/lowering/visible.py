"""Which terms of a residual can be seen at a sample rate, and which faults that leaves.

METHOD: a term c p**k y is small when |c| w**k is far below the largest term of the same signal at
the highest frequency that samples show usefully, w = pi rate / 5 (a tenth of the rate in Hz).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.normal import Term
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.numeric import evaluate, sensitivity


class Seen(NamedTuple):
    """The terms that `step` keeps, and of the others the share of the largest one.

    `largest` is that term's size by atom; None where the model has no numbers.
    """

    kept: tuple[Term, ...]
    dropped: tuple[tuple[Term, float], ...]
    largest: dict[Expr, float] | None


def frequency(rate: float) -> float:
    """The highest frequency in rad/s at which a sampled term still counts; rate in Hz."""
    return math.pi * rate / 5


def seen(builder: Builder, terms: tuple[Term, ...], rate: float, resolution: float) -> Seen:
    """Split the terms of a residual into visible and invisible ones.

    Without nominal values nothing is left out.
    """
    w = frequency(rate)
    sizes: list[float] = []
    for term in terms:
        value = evaluate(builder.resolve([term.coefficient])[0], builder.floats)
        if value is None or not math.isfinite(value):
            return Seen(terms, (), None)
        sizes.append(abs(float(value)) * w**term.order)
    largest: dict[Expr, float] = {}
    for term, size in zip(terms, sizes, strict=True):
        largest[term.atom] = max(largest.get(term.atom, 0.0), size)
    kept: list[Term] = []
    dropped: list[tuple[Term, float]] = []
    for term, size in zip(terms, sizes, strict=True):
        top = largest[term.atom]
        if size < resolution * top and len(terms) > 1:
            dropped.append((term, size / top))
        else:
            kept.append(term)
    return Seen(tuple(kept), tuple(dropped), largest)


def unseen_faults(
    builder: Builder,
    faults: tuple[str, ...],
    result: Seen,
    rate: float,
    resolution: float,
) -> tuple[str, ...]:
    """The faults of a residual that do not act on any visible term, or too little to be seen."""
    if result.largest is None:
        return ()
    inside = {s for t in result.kept for s in symbols(t.atom)}
    resolved = builder.resolve([t.coefficient for t in result.kept])
    w = frequency(rate)

    def acts(name: str) -> bool:
        symbol = builder.graph.fault_symbol(name)
        if symbol in inside:
            return True
        for term, coefficient in zip(result.kept, resolved, strict=True):
            if symbol in symbols(coefficient):
                effect = sensitivity(coefficient, name, builder.floats)
                if effect is None:
                    return True
                if _visible(effect * w**term.order, result, term.atom, resolution):
                    return True
        return False

    return tuple(f for f in faults if not acts(f))


def _visible(effect: float, result: Seen, atom: Expr, resolution: float) -> bool:
    assert result.largest is not None
    return abs(effect) >= resolution * result.largest[atom] > 0 or (
        result.largest[atom] == 0 and effect != 0
    )


Effects = Callable[[str], float | None]
