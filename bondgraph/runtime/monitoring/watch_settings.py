"""How logs are watched: by which model, what their columns are, which samples count."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from bondgraph.runtime.diagnosis.tuning import FASTEST, bandwidth_for
from bondgraph.runtime.log import LogError, Mask
from bondgraph.runtime.log_numbers import Form
from bondgraph.runtime.monitoring.clock import clock_of
from bondgraph.runtime.monitoring.columns import Columns, Mapped
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.operating import Operating
from bondgraph.runtime.monitoring.watch_parts import Decision, Parts
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.moment import often
from bondgraph.text.numerals import plural
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.ir.graph import BondGraph
    from bondgraph.ir.program import Program
    from bondgraph.ir.runnable_code import Runnable
    from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
    from bondgraph.runtime.diagnosis.tuning import Tuning
    from bondgraph.runtime.monitoring.sources.sample_source import Source
    from bondgraph.text.source import Source as Text


_CLOCKS = 1e-3  # by which the clocks of two logs may be apart


class Compiled(Protocol):
    """What a watch has to have of a `Compilation`, which says what these are."""

    @property
    def source(self) -> Text:
        """The text of the model."""

    @property
    def options(self) -> Any:
        """Its `Options`."""

    @property
    def graph(self) -> BondGraph:
        """The flat bond graph."""

    @property
    def program(self) -> Program:
        """The residual program."""

    @property
    def thresholds(self) -> Program | None:
        """The program of the thresholds, None without tolerances."""

    @property
    def runnable_programs(self) -> tuple[Runnable, Runnable | None]:
        """The code of both."""

    @property
    def diagnosis_model(self) -> DiagnosisModel:
        """What a diagnosis has to know."""

    def with_options(self, *, rate: float, bandwidth: float | None) -> Compiled:
        """The same model at another rate, with another filter."""

    def engine(
        self, native: bool | None = None, tell: Callable[[str], None] | None = None
    ) -> Engine:
        """What runs its residuals."""

    def diagnosis(self, engine: Engine, tuning: Tuning | None = None) -> Decision:
        """What says verdicts."""

    def accepting(
        self, engine: Engine, tuning: Tuning | None = None, after: float = math.inf
    ) -> Decision:
        """The same, which accepts faults that have been named for `after` seconds."""


class WatchSettings(NamedTuple):
    """What a watch has besides its samples.

    `form` is what is known of the table of a log, with the rate that somebody asked for; without a
    `tuning` the noise is learned; `mapping` says which column is which signal; while the machine is
    not `operating`, an expression over columns, samples do not count. A fault that has been named
    for so many seconds is `accept`ed, and the watch goes on with that.
    Parameters were `fitted` with a filter of this bandwidth (rad/s), where it is not the usual one.
    """

    compilation: Compiled
    tuning: Tuning | None = None
    form: Form = Form("")
    mapping: Mapping[str, Mapped] | None = None
    operating: str | None = None
    accept: float | None = None
    fitted: float | None = None

    def parts(self, source: Source, engine: Engine, decision: Decision) -> Parts:
        """What a monitor of the samples of a source is made of; raises CompileError."""
        on = self.operating
        return Parts(
            source,
            Columns(engine.signals, self.mapping, source.name),
            clock_of(engine),
            engine,
            decision,
            operating=None if on is None else Operating(on, self.mapping, source.name),
            asked=self.form.rate is not None,
        )


def sample_rate(
    asked: float | None, source: Source, tuning: Tuning | None, usual: float
) -> float:
    """Samples a second: as asked for, of the first samples, of the tuning, else as usual.

    Two logs of one machine hardly differ by less than its clocks do: what is that near to the rate
    of the tuning is it.
    """
    own = source.rate()
    if tuning is not None and (own is None or abs(own / tuning.rate - 1.0) < _CLOCKS):
        own = tuning.rate
    return asked or own or usual


def usual_bandwidth(
    rate: float,
    source: Source,
    grows: bool = False,
    operating: str | None = None,
    mapping: Mapping[str, Mapped] | None = None,
    fitted: float | None = None,
) -> float:
    """The bandwidth (rad/s) of the filter of a watch without a tuning: see `bandwidth_for`.

    Or that with which parameters were `fitted`, no faster than samples can follow.
    Of a file that is on the disk as a whole the length is known, or what it is while the machine is
    `operating`, in pieces; not of one that `grows`.
    """
    if fitted is not None:
        return min(fitted, FASTEST * rate)
    pieces: list[int] = []
    if operating is not None and not grows:
        on = Operating(operating, mapping, source.name)
        with suppress(LogError):  # which is told where its samples come
            pieces = _pieces([on(log) for log in source.whole()])
    samples = float(sum(pieces)) if pieces else None if grows else source.samples()
    return bandwidth_for(rate, samples, pieces)


def _pieces(masks: Sequence[Mask]) -> list[int]:
    """How many samples in a row hold, each time.

    >>> _pieces([np.array([False, True, True]), np.array([True, False, True])])
    [3, 1]
    """
    every = np.concatenate([[False], *masks, [False]])
    turns = np.flatnonzero(every[1:] != every[:-1]).tolist()
    return [end - start for start, end in zip(turns[::2], turns[1::2], strict=True)]


def something_to_watch(compilation: Compiled) -> None:
    """Raises Trouble for a model without a residual."""
    if not compilation.diagnosis_model.sees:
        raise Trouble(
            f"{compilation.graph.name} has no residual that could be watched:"
            " `bondgraph compile` tells why, `bondgraph sensors` where a sensor would help"
        )


def engine_of(compilation: Compiled, tell: Callable[[str], None] | None = None) -> Engine:
    """What runs the residuals; raises Trouble where parameters have no value or a wrong one."""
    try:
        return compilation.engine(tell=tell)
    except ValueError as error:
        raise Trouble(str(error)) from error


def watching(
    compilation: Compiled,
    tuning: Tuning | None,
    tell: Callable[[str], None],
    accept: float | None = None,
) -> tuple[Engine, Callable[[Engine], Decision]]:
    """The engine of a watch, and what makes the decision of one.

    Raises Trouble where there is nothing to watch, or where the tuning is of something else.
    """
    engine = engine_of(compilation, tell)
    something_to_watch(compilation)
    if tuning is not None:
        engine = engine.configured(bandwidth=tuning.bandwidth)
    try:
        compilation.diagnosis(engine, tuning)
    except ValueError as error:
        message = f"the tuning cannot be used: {error}; make it anew with `bondgraph tune`"
        raise Trouble(message) from error
    if accept is not None:
        return engine, lambda own: compilation.accepting(own, tuning, accept)
    return engine, lambda own: compilation.diagnosis(own, tuning)


def what_is_watched(compilation: Compiled, engine: Engine) -> str:
    """How the first verdict of a watch begins."""
    watched = plural(len(compilation.diagnosis_model.sees), "residual")
    return f"{compilation.graph.name}: {watched} at {often(1 / engine.sample_time)}"
