"""What a fit finds: parameters with how sure they are, and what is left of the residuals."""

from __future__ import annotations

from bondgraph.runtime.diagnosis.told_combinations import Combination
from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

SURE = 1.96  #: deviations within which 95 % are
MUCH = 2.0  #: times its noise: with more left of it a residual says that something else is there
_FOLLOWS = 0.2  # share that follows the inputs, above which that is another law
_SAMPLED = 1e-4  # of the largest term: no sampled law is better


class Fitting(NamedTuple):
    """One parameter: `value` in SI, and its standard `error`, None where the logs cannot tell it.

    `bound` says that it would have had to change its sign to fit better, `doubted` that what tells
    it is wrong by more than noise: no error that is reckoned from noise would hold. In 95 of 100
    further logs it is within the relative `tolerance`; None where that of the model is no wider, or
    where the logs cannot tell it.
    """

    name: str
    nominal: float
    value: float
    error: float | None
    unit: str
    bound: bool
    doubted: bool = False
    tolerance: float | None = None

    @property
    def interval(self) -> float | None:
        """Half of the interval that has the truth in 95 of 100 cases."""
        return None if self.error is None else SURE * self.error


class Span(NamedTuple):
    """A time of a log, in s, in which a residual is `times` what is usual."""

    log: str
    start: float
    end: float
    times: float


class Left(NamedTuple):
    """What is left of one residual, in so many `rows` as it is valid in.

    `before` and `after` are the root mean square of the filtered residual, at the nominal and at
    the fitted parameters; `noise` what the sensors make of it. `memory` is the correlation of one
    row of it with the next once that of the noise is taken off: 0 where nothing else is in it.
    `follows` is the share of its mean square that functions of the inputs explain (`left_over`),
    None where that cannot be told. `term` is the root mean square of the largest of its terms.
    `lost` are the seconds behind gaps, in which nobody knows where what it remembers stood. The
    noise is `louder` times that at the nominal values.
    """

    residual: str
    rows: int
    before: float
    after: float
    noise: float
    memory: float
    follows: float | None
    spans: tuple[Span, ...]
    term: float
    lost: float = 0.0
    louder: float = 1.0

    @property
    def nothing(self) -> bool:
        """Whether it is no more than samples of signals in motion are off by, without any noise."""
        return self.after <= _SAMPLED * self.term

    @property
    def explained(self) -> float:
        """The share of its mean square that the fitted parameters take off."""
        return 1.0 - (self.after / self.before) ** 2 if self.before else 0.0

    @property
    def times(self) -> float:
        """How many times the noise of the sensors it is."""
        return self.after / self.noise if self.noise else 0.0

    @property
    def much(self) -> bool:
        """Whether it is more than noise: a disturbance, or a law that is another."""
        return self.times > MUCH

    @property
    def wrong(self) -> bool:
        """Whether the law is another: nobody knows by how much its parameters are wrong.

        That follows the inputs, so that it is told from noise where it is less than that as well.
        """
        if self.follows is None:
            return self.much
        if self.nothing:
            return False
        return self.follows > _FOLLOWS and self.follows * self.times**2 > _FOLLOWS * MUCH**2


class Delay(NamedTuple):
    """By how much a signal that jumps is in the log before it acts, in s, with its standard error.

    Below zero it is there too late. A step at a sample is half a sample early where straight lines
    join samples, one that a sensor reads at the next sample is late: without this, parameters would
    have to make up for it. What is at its `bound` may be more, for which parameters make up.
    """

    signal: str
    value: float
    error: float
    bound: bool


class Terms(NamedTuple):
    """What one residual of one log is made of, at the rows (n,) that were fitted, in its unit.

    `term` is the one of the `parameter` that makes most of it, `others` are all others with the
    sign turned: the residual is the difference. NaN where it is not valid; `time` in s.
    """

    residual: str
    parameter: str
    log: str
    time: Array
    term: Array
    others: Array


class Suspect(NamedTuple):
    """An offset that was not fitted, and would take off a `share` of what is left (mean square).

    Its `value` is in the unit of the signal: what the log has is so much above what is there.
    """

    signal: str
    value: float
    error: float
    unit: str
    share: float


class Start(NamedTuple):
    """What the parameter of an unknown start is where a log begins, or `later` behind a gap of it.

    At a `time` in s, in the unit of the parameter; `error` None where the samples cannot tell it.
    """

    name: str
    log: str
    time: float
    later: bool
    value: float
    error: float | None
    unit: str

    @property
    def interval(self) -> float | None:
        """Half of the interval that has the truth in 95 of 100 cases."""
        return None if self.error is None else SURE * self.error


class Fitted(NamedTuple):
    """Parameters from so many `logs`; `noise` by signal, as seen or given, `seconds` of use.

    `starts` are where logs begin that nobody knows, each by itself, and what is behind their gaps.
    `offsets` are those of signals that were asked for, with a nominal value of zero; `suspects`
    others that would explain what is left, the most likely one first. The filter was of this
    `bandwidth` (rad/s), `faster` than the usual one if that tells more; with it the relative errors
    of all that is fitted are in the geometric mean exp(`spread`), what no log tells among them.
    """

    parameters: tuple[Fitting, ...]
    starts: tuple[Start, ...]
    offsets: tuple[Fitting, ...]
    suspects: tuple[Suspect, ...]
    combinations: tuple[Combination, ...]
    left: tuple[Left, ...]
    delays: tuple[Delay, ...]
    noise: dict[str, float]
    seconds: float
    correlation: Array  # (p, p), of the errors
    terms: tuple[Terms, ...]
    bandwidth: float
    spread: float
    logs: int
    faster: bool = False

    @property
    def values(self) -> dict[str, float]:
        """The fitted values of parameters in SI units, by name."""
        return {p.name: p.value for p in self.parameters}

    def begun(self, log: str, time: float) -> dict[str, float]:
        """What was told of the starts of a log, or of what is behind a gap of it at a time (s)."""
        own = [s for s in self.starts if s.error is not None and (s.log, s.time) == (log, time)]
        return {s.name: s.value for s in own}

    @property
    def tolerances(self) -> dict[str, float]:
        """The relative tolerances that are narrower than those of the model, by name."""
        return {p.name: p.tolerance for p in self.parameters if p.tolerance is not None}

    @property
    def offset_values(self) -> dict[str, float]:
        """The fitted offsets in the units of their signals, by name."""
        return {p.name: p.value for p in self.offsets}
