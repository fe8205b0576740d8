"""Every fault beside what was seen since it began: those that are asked for, from the onset on."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from types import MappingProxyType

from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Explained, ExplainedPair
from bondgraph.runtime.diagnosis.row_sums import Moves
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.since_onset import BENT, MOST, SinceOnset
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine, copied


class Comparison:
    """Begins at the onset: `engine` stands before samples that look healthy.

    The last `own` of these are of the first row that is compared. A fault that not all residuals
    see which have fired is none of those that are asked for, and to run it would be in vain. But
    more may fire, or two faults act at once: rows are kept, and a fault that is asked for later is
    compared as if it had been from the first row on.
    """

    def __init__(
        self,
        engine: Engine,
        healthy: Array,
        own: int,
        hypotheses: Sequence[Hypothesis],
        nominal: Mapping[str, float],
        tolerated: Sequence[Hypothesis] = (),
        machine: Mapping[str, float] = MappingProxyType({}),
        dynamic: Mapping[str, Sequence[float]] = MappingProxyType({}),
        before: Sequence[Row] = (),
    ) -> None:
        self._before = tuple(before)
        self._engine = copied(engine)
        self._healthy, self._own = healthy, own
        self._all, self._nominal = tuple(hypotheses), nominal
        self._tolerated, self._machine = tuple(tolerated), machine
        self._dynamic = dynamic
        self._rows: list[tuple[Row, Array]] = []  # with the limits of each residual
        self._asked: set[int] = set()  # rows with which it was asked how well faults explain them
        self._faults: frozenset[str] = frozenset()  # that were asked for
        self._beside: SinceOnset | None = None  # these
        self._count = 0  # rows so far
        self._last: Array | None = None  # residuals of the last row

    def __len__(self) -> int:
        return self._count

    def has(self, row: Row) -> bool:
        """Whether this row was the last one."""
        return self._last is row.value

    def step(self, row: Row, limits: Array) -> None:
        """One more row, and the limits of its residuals, (residuals, columns of `Limit`)."""
        self._last = row.value
        if not self._count:
            row = row._replace(samples=row.samples[self._own :])
        self._count += 1
        one = row._replace(engine=self._engine), limits.copy()
        if self._count <= MOST:
            self._rows.append(one)
        if self._beside is not None:
            self._beside.step(*one)

    def leave_out(self, since: float, which: Mask) -> None:
        """Nothing is known of some residuals in the rows that end since a time."""
        for row, _ in self._rows:
            if row.time >= since:
                row.leave_out(which)  # what runs beside has the same rows

    def explained(self, history: History, faults: Collection[str]) -> list[Explained]:
        """How well at least these faults explain the rows; raises LinAlgError as `explain` does."""
        if self._count <= BENT:
            self._asked.add(self._count)
        if self._beside is None or not self._faults.issuperset(faults):
            self._beside = self._replayed(history, self._faults | frozenset(faults))
        return self._beside.explained(history)

    def _replayed(self, history: History, faults: frozenset[str]) -> SinceOnset:
        """The rows so far beside these faults, asked for as often as it was."""
        own = [h for h in self._all if h.fault in faults]
        beside = SinceOnset(
            self._engine, self._healthy, own, self._nominal, self._tolerated, self._machine,
            self._dynamic, self._before, self._own,
        )  # fmt: skip
        for number, (row, limits) in enumerate(self._rows, 1):
            beside.step(row, limits)
            if number in self._asked and number < self._count:
                beside.explained(history)
        if self._count > MOST:  # the samples behind these rows are not known any more
            beside.explained(history)
            beside.follow(None)
        self._faults = faults
        return beside

    def follow(self, fault: Explained) -> None:
        """Tell which fault explains most: once all rows are known, only this one is run."""
        if self._beside is not None:
            self._beside.follow(fault)

    def moves(self, faults: Iterable[tuple[Hypothesis, float]]) -> Moves | None:
        """See `SinceOnset`."""
        return None if self._beside is None else self._beside.moves(faults)

    def pairs(
        self, history: History, singles: Sequence[Explained]
    ) -> tuple[list[Explained], list[ExplainedPair]]:
        """See `SinceOnset`."""
        return ([], []) if self._beside is None else self._beside.pairs(history, singles)
