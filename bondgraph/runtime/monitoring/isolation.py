"""Which fault it is, by magnitude: every candidate explains the residuals, better or worse.

Residuals are r(t) = sum_k s_k(t) d_k + s_j(t) c_j(t) + noise, with the sensitivities s through the
same filter. The d are what parameters are off by within their tolerances, constant and normal with
the deviation of their tolerance; the change c of candidate j is a signal that moves little from one
moment to the next. With both integrated out (Gaussian evidence; MacKay, 1992), candidates are
compared by how probable they make what was seen. A residual that a fault would have to move and
that did not speaks against it by as much as it would have moved, and no more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.hypotheses import Hypothesis

_SCALES = (0.1, 1.0, 10.0, 100.0)  # of the usual change: how large a fault is, nobody knows before
_KEEP = 0.95  # correlation of a fault's change between neighbouring chunks
_CHUNK = 4  # rows in which the change is taken as constant, at least
_PARTS = 15  # chunks at most


class Explained(NamedTuple):
    """How well one fault explains what was seen.

    `evidence` is the logarithm of how much more probable it makes that than a healthy machine
    does, `share` how much of the healthy machine's misfit (in squares) it takes away. `change` is
    that of the one of its hypotheses that explains most by itself, at the end, with its deviation.
    """

    fault: str
    evidence: float
    share: float
    hypothesis: Hypothesis
    change: float
    deviation: float


class Rows(NamedTuple):
    """Residuals at moments far enough apart for their noise to be taken as independent.

    Value and weight (1/variance, 0 where not valid) have the shape (rows, residuals). `rest` are
    the slopes by the parameters with a tolerance, which have been off for ever, `slopes` those by
    the hypotheses, which hold since the onset: (rows, parameters or hypotheses, residuals).
    """

    value: Array
    weight: Array
    rest: Array
    slopes: Array

    def part(self, start: int, stop: int | None = None) -> Rows:
        """Some of the rows."""
        return Rows(*[x[start:stop] for x in self])


class History:
    """What healthy operation has told of parameters that are off within their tolerances.

    `prior` are the standard deviations of the parameters. Kept as information, matrix and vector,
    so that rows are added one after the other and forgotten slowly.
    """

    def __init__(self, prior: Array) -> None:
        self.prior = prior
        self.matrix = np.zeros((len(prior), len(prior)))
        self.vector = np.zeros(len(prior))

    def add(self, value: Array, weight: Array, slopes: Array, keep: float) -> None:
        """One row: residuals, their weights, slopes of the shape (parameters, residuals)."""
        weighted = slopes * weight
        self.matrix = keep * self.matrix + weighted @ slopes.T
        self.vector = keep * self.vector + weighted @ value

    def anew(self, gone: Sequence[int], keep: Sequence[int], more: Sequence[float]) -> History:
        """The same once the parameters `gone` have another value, unknown within their prior.

        What the others owe them is integrated out. Then only the parameters `keep` are kept, and
        such with the deviations `more` come behind them.
        """
        own = list(gone)
        rest = [k for k in range(len(self.prior)) if k not in own]
        matrix, vector = np.zeros_like(self.matrix), np.zeros_like(self.vector)
        owed = self.matrix[np.ix_(rest, own)] @ np.linalg.inv(self.information()[np.ix_(own, own)])
        matrix[np.ix_(rest, rest)] = (
            self.matrix[np.ix_(rest, rest)] - owed @ self.matrix[np.ix_(own, rest)]
        )
        vector[rest] = self.vector[rest] - owed @ self.vector[own]
        kept = list(keep)
        found = History(np.concatenate([self.prior[kept], np.array(more, dtype=float)]))
        found.matrix[: len(kept), : len(kept)] = matrix[np.ix_(kept, kept)]
        found.vector[: len(kept)] = vector[kept]
        return found

    def information(self) -> Array:
        """Prior and history together."""
        return np.diag(1.0 / np.square(self.prior)) + self.matrix

    def expected(self, slopes: Array) -> tuple[Array, Array]:
        """The residuals of the healthy machine as far as it is known, and their variances."""
        if not len(self.prior):
            nothing = np.zeros(slopes.shape[1])
            return nothing, nothing
        spread = np.linalg.inv(self.information())
        return slopes.T @ (spread @ self.vector), np.einsum("pr,pq,qr->r", slopes, spread, slopes)


def inverse(weight: Array) -> Array:
    """Variances from weights, infinite where there is none."""
    return np.where(weight > 0, 1.0 / np.maximum(weight, 1e-300), math.inf)


def explain(rows: Rows, hypotheses: Sequence[Hypothesis], history: History) -> list[Explained]:
    """How well each fault explains the rows since the onset, in the order of the hypotheses.

    Raises numpy.linalg.LinAlgError where numbers are too far apart.
    """
    count = len(rows.value)
    length = max(_CHUNK, -(-count // _PARTS))
    chunks = [rows.part(k, k + length) for k in range(0, count, length)]
    matrix = history.information()
    vector = history.vector.copy()
    inner, cross, score = [], [], []
    misfit = 0.0
    for chunk in chunks:
        weighted = chunk.slopes * chunk.weight[:, None, :]
        rest = chunk.rest * chunk.weight[:, None, :]
        inner.append(np.einsum("tar,tbr->ab", weighted, chunk.slopes))
        cross.append(np.einsum("tar,tbr->ab", rest, chunk.slopes))
        score.append(np.einsum("tar,tr->a", weighted, chunk.value))
        matrix = matrix + np.einsum("tar,tbr->ab", rest, chunk.rest)
        vector = vector + np.einsum("tar,tr->a", rest, chunk.value)
        misfit += float(np.sum(chunk.weight * chunk.value**2))
    factor = np.linalg.inv(matrix)
    misfit -= float(vector @ factor @ vector)
    misfit += float(history.vector @ np.linalg.solve(history.information(), history.vector))
    found = []
    for fault in dict.fromkeys(h.fault for h in hypotheses):
        own = [j for j, h in enumerate(hypotheses) if h.fault == fault]
        coupling = np.concatenate([c[:, own] for c in cross], axis=1)
        information = _diagonal([i[np.ix_(own, own)] for i in inner])
        information -= coupling.T @ factor @ coupling
        seen = np.concatenate([s[own] for s in score]) - coupling.T @ factor @ vector
        found.append(_compared([hypotheses[j] for j in own], information, seen, misfit))
    return found


def _diagonal(blocks: Sequence[Array]) -> Array:
    size = len(blocks[0])
    out = np.zeros((size * len(blocks), size * len(blocks)))
    for k, block in enumerate(blocks):
        out[k * size : (k + 1) * size, k * size : (k + 1) * size] = block
    return out


class _Fit(NamedTuple):
    """One hypothesis, or several at once, where changes have about one size."""

    evidence: float
    share: float
    change: float
    deviation: float


def _compared(
    own: Sequence[Hypothesis], information: Array, score: Array, misfit: float
) -> Explained:
    """Each hypothesis of a fault by itself, and all at once: one as probable as the other."""
    size = len(own)
    alone, every = [], []
    for j in range(size):
        pick = np.arange(j, len(score), size)
        usual = np.array([own[j].usual])
        fits = [
            _fit(s * usual, information[np.ix_(pick, pick)], score[pick], misfit) for s in _SCALES
        ]
        alone.append(max(fits, key=lambda f: f.evidence))
        every += fits
    if size > 1:
        usual = np.array([h.usual for h in own])
        every += [_fit(s * usual, information, score, misfit) for s in _SCALES]
    top = max(f.evidence for f in every)
    best = max(range(size), key=lambda j: alone[j].evidence)
    total = -math.inf
    if math.isfinite(top):
        weights = sum(math.exp(max(f.evidence - top, -700.0)) for f in every)
        total = top + math.log(weights / len(every))
    share = max(every, key=lambda f: f.evidence).share
    chosen = alone[best]
    return Explained(own[0].fault, total, share, own[best], chosen.change, chosen.deviation)


def _fit(usual: Array, information: Array, score: Array, misfit: float) -> _Fit:
    """Evidence for changes with a normal prior that is correlated in time."""
    size = len(usual)
    chunks = len(score) // size
    steps = np.abs(np.subtract.outer(np.arange(chunks), np.arange(chunks)))
    scale = np.tile(usual, chunks)  # in units of the usual change numbers are alike
    information = information * np.outer(scale, scale)
    score = score * scale
    prior = np.kron(_KEEP**steps, np.eye(size))
    inner = np.eye(len(score)) + prior @ information
    sign, log_size = np.linalg.slogdet(inner)
    posterior = np.linalg.solve(inner, prior)
    mean = posterior @ score
    if sign <= 0 or not np.isfinite(mean).all():
        return _Fit(-math.inf, 0.0, 0.0, 0.0)
    gone = float(2 * score @ mean - mean @ information @ mean)
    return _Fit(
        0.5 * float(score @ mean) - 0.5 * float(log_size),
        gone / misfit if misfit > 0 else 0.0,
        float(mean[-1] * usual[-1]),
        math.sqrt(max(float(posterior[-1, -1]), 0.0)) * float(usual[-1]),
    )


def probabilities(found: Sequence[Explained]) -> dict[str, float]:
    """How probable each fault is, all equally probable before.

    They add up to 1, or are all 0 where each of them is impossible.
    """
    top = max((e.evidence for e in found), default=-math.inf)
    if top == -math.inf:
        return {e.fault: 0.0 for e in found}
    weight = {e.fault: math.exp(max(e.evidence - top, -700.0)) for e in found}
    total = sum(weight.values()) or 1.0
    return {fault: w / total for fault, w in weight.items()}
