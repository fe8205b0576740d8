"""Which terms of a residual can be seen at a sample rate, and which faults that leaves.

A term c p**k y is seen if at some frequency up to w = pi rate / 5 (a tenth of the rate in Hz) its
size |c| w**k reaches a given part of the largest term of the same signal there (METHOD 4.5). To
look at the highest frequency alone would be wrong: there a small friction hides behind a large
inertia, but at constant speed it is all there is. A parameter that is declared zero, a leak say,
counts with the size one: the fault is that it does not stay zero.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from bondgraph.ir.expr import Expr, symbols
from bondgraph.ir.normal import Term
from bondgraph.passes.lowering.builder import Builder
from bondgraph.text.tuples import NamedTuple

#: theta dc/dtheta of a term for a parameter, None where that has no number
Effect = Callable[[Term, str], float | None]


class Spectrum(NamedTuple):
    """The terms of one signal: log of |c| w**k at the highest frequency w, by order k."""

    logs: Mapping[int, float]

    def share(self, order: int, size: float) -> float:
        """The largest ratio, over all frequencies up to w, of a term to the largest term.

        `size` is |c| w**order of the term at the highest frequency.
        """
        if not size:
            return 0.0
        own = math.log(size)
        if not self.logs:
            return math.inf
        best = -math.inf
        for x in self._corners(order):
            top = max(level + k * x for k, level in self.logs.items())
            best = max(best, own + order * x - top)
        return math.exp(min(best, 700.0))

    def _corners(self, order: int) -> list[float]:
        """Where a term of this order can stand out: logs of frequency over the highest."""
        corners = [0.0]
        if order <= min(self.logs):
            corners.append(-1e3)  # towards zero frequency the lowest order is all there is
        for low, a in self.logs.items():
            for high, b in self.logs.items():
                if low <= order <= high and low < high:
                    corners.append(min((a - b) / (high - low), 0.0))
        return corners


class Seen(NamedTuple):
    """The terms that `step` keeps, and the others with their share of the largest term.

    `spectra` has the sizes by atom, None where the model has no numbers; `effect` tells how much
    a term depends on a parameter.
    """

    kept: tuple[Term, ...]
    dropped: tuple[tuple[Term, float], ...]
    spectra: dict[Expr, Spectrum] | None
    effect: Effect


def frequency(rate: float) -> float:
    """The highest frequency in rad/s at which a sampled term still counts; rate in Hz."""
    return math.pi * rate / 5


def seen(builder: Builder, terms: tuple[Term, ...], rate: float, resolution: float) -> Seen:
    """Split the terms of a residual into visible and invisible ones.

    Without nominal values nothing is left out.
    """
    w = frequency(rate)
    resolved = builder.resolve([t.coefficient for t in terms])
    coefficients = {(t.atom, t.order): c for t, c in zip(terms, resolved, strict=True)}

    effects: dict[Expr, dict[str, float] | None] = {}

    def effect(term: Term, name: str) -> float | None:
        coefficient = coefficients[term.atom, term.order]
        if coefficient not in effects:
            effects[coefficient] = builder.nominal.sensitivities({coefficient: 1.0})
        found = effects[coefficient]
        own = None if found is None else found.get(name, 0.0)
        return None if own is None or math.isnan(own) else own

    sizes: list[float] = []
    for term in terms:
        value = builder.nominal.value(coefficients[term.atom, term.order])
        try:
            size = math.inf if value is None else abs(float(value)) * w**term.order
        except OverflowError:
            size = math.inf
        if not math.isfinite(size):
            return Seen(terms, (), None, effect)
        sizes.append(size)
    return split(terms, sizes, rate, resolution, effect, builder.absent)


def split(
    terms: tuple[Term, ...],
    sizes: list[float],
    rate: float,
    resolution: float,
    effect: Effect,
    zero: tuple[str, ...],
) -> Seen:
    """The visible terms, given the size of every term at the highest frequency.

    A term is visible too if one of the parameters `zero` would make it so.
    """
    logs: dict[Expr, dict[int, float]] = {}
    for term, size in zip(terms, sizes, strict=True):
        own = logs.setdefault(term.atom, {})
        if size:
            own[term.order] = math.log(size)
    spectra = {atom: Spectrum(own) for atom, own in logs.items()}
    w = frequency(rate)
    kept: list[Term] = []
    dropped: list[tuple[Term, float]] = []
    for term, size in zip(terms, sizes, strict=True):
        share = spectra[term.atom].share(term.order, size)
        if share < resolution and zero:
            would = [_share(effect(term, name), spectra[term.atom], term.order, w) for name in zero]
            share = max(share, *would)
        # a coefficient that happens to be zero now may be set to another value later
        if share < resolution and (size or len(logs[term.atom])):
            dropped.append((term, share))
        else:
            kept.append(term)
    return Seen(tuple(kept), tuple(dropped), spectra, effect)


def unseen_faults(
    builder: Builder, faults: tuple[str, ...], result: Seen, rate: float, resolution: float
) -> tuple[str, ...]:
    """The faults of a residual that act on no visible term, or too little to be seen."""
    if result.spectra is None:
        return ()
    spectra, w = result.spectra, frequency(rate)
    inside = {s for t in result.kept for s in symbols(*builder.resolve([t.atom]))}

    def acts(name: str) -> bool:
        if not inside.isdisjoint(builder.fault_symbols[name]):
            return True
        return any(
            _share(result.effect(t, name), spectra[t.atom], t.order, w) >= resolution
            for t in result.kept
        )

    return tuple(f for f in faults if not acts(f))


def _share(effect: float | None, spectrum: Spectrum, order: int, w: float) -> float:
    """The largest ratio of what a parameter does to a term to the largest term of its signal."""
    if effect is None:
        return math.inf
    try:
        return spectrum.share(order, abs(effect) * w**order)
    except OverflowError:
        return math.inf
