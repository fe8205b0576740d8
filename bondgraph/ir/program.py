"""A residual program: what the generated code does, in terms that every language can spell.

Three procedures. `configure` computes the coefficients from the parameters, once. `exact`
evaluates the residuals from exact derivatives (and integrals) of the known signals. `step` takes
one sample of each known signal and runs the realisable residual: every term through the same
cascade of first-order stages. All arithmetic is on one type, `real`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Literal, TypeAlias, overload

from bondgraph.ir.tables import backwards
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

# ----------------------------------------------------------------- expressions


class Const(NamedTuple):
    """A number, written with the digits that give back the same double."""

    value: float


class Ref(NamedTuple):
    """A value by name. Space says where it lives:

    param: parameters (only in configure); option: `sample_time` in s, `bandwidth` in rad/s or
    `time_unit` in s (only in configure); coef: coefficients of configure, element `order` of an
    array; state: filter memory; local: a statement of the same procedure; residual: the output.

    known: in step the sample of a known signal (order 0); in exact its derivative `order`, times
    time_unit**order (-1: its integral since the start, -2: the integral of that). start: its
    value when the integrals began (only in exact). integral: a member of `Program.integrals`, the
    integral of a nonlinear expression since the start (only in exact). time: seconds since the
    start over time_unit (only in exact).

    increment, total: of an encoder, only in step and first: counts since the previous sample
    (the difference modulo 2**32, as a signed 32-bit number) and counts since the start (summed
    as 64-bit integers), both converted to real. Both are 0 in first.
    """

    space: Literal[
        "param",
        "option",
        "coef",
        "known",
        "start",
        "integral",
        "time",
        "increment",
        "total",
        "state",
        "local",
        "residual",
    ]
    name: str
    order: int = 0


class Sum(NamedTuple):
    """Terms added (sign True) or subtracted (False), left to right."""

    terms: tuple[tuple[bool, Expression], ...]


class Product(NamedTuple):
    """Factors multiplied left to right, then divided by the divisors one by one."""

    factors: tuple[Expression, ...]
    divisors: tuple[Expression, ...] = ()


class Function(NamedTuple):
    """A function of `ir.functions.FUNCTIONS`, table lookup `table:<id>`, or `root:<name>`.

    `root:<name>` is what the `NewtonBlock` of that name finds; NaN where it finds nothing.
    """

    name: str
    args: tuple[Expression, ...]


class Choice(NamedTuple):
    """`condition ? yes : no`."""

    condition: Condition
    yes: Expression
    no: Expression


class Compare(NamedTuple):
    """A comparison `<`, `<=` or `==` of two values."""

    op: str
    left: Expression
    right: Expression


class Logic(NamedTuple):
    """`and`, `or`, `not` of conditions."""

    op: str
    args: tuple[Condition, ...]


class Mode(NamedTuple):
    """A boolean known input."""

    name: str


class First(NamedTuple):
    """Whether this is the first sample after a start: only where both procedures are one.

    See `backends.blocks`, which makes one of `Program.first` and `Program.step`.
    """


Expression: TypeAlias = Const | Ref | Sum | Product | Function | Choice
Condition: TypeAlias = Compare | Logic | Mode | First


def integer_power(value: Function) -> int | None:
    """The exponent of a `pow` whose exponent is a whole number, else None."""
    if value.name != "pow" or not isinstance(value.args[1], Const):
        return None
    exponent = value.args[1].value
    return int(exponent) if abs(exponent) < 1000 and exponent == int(exponent) else None


def called(value: Function) -> str:
    """What a language has to spell: a function, `power`, `root:<name>`, or how a table is read.

    That is `table:<id>`, for a table of two inputs `map:<id>` or, read backwards, `inverse:<id>`.
    """
    kind, _, which = value.name.partition(":")
    if kind == "table" and len(value.args) > 1:
        return f"{'inverse' if backwards(which) else 'map'}:{which}"
    return value.name if integer_power(value) is None else "power"


# ------------------------------------------------------------------ statements


class Assign(NamedTuple):
    """`target = value`, with the model line and the equation that it comes from."""

    target: Ref
    value: Expression
    comment: str
    origin: Span | None


class Branch(NamedTuple):
    """`target` = `value`, and what only one side of that choice needs.

    Where the condition holds, the statements `yes` are run before `value.yes`, else `no` before
    `value.no`. Their locals are read nowhere else, so that a law need have no value on the side
    that is not taken. A choice whose sides need no statements is an `Assign`.
    """

    target: Ref
    value: Choice
    yes: tuple[Assignment, ...]
    no: tuple[Assignment, ...]
    comment: str
    origin: Span | None


class TapeOp(NamedTuple):
    """`row[target][i + shift] += scale * row[source][i]` for i < length; a `fresh` target is
    set to zero first. `target` and `source` differ; `scale` is an index."""

    target: int
    source: int
    shift: int
    scale: int
    length: int
    fresh: bool


class TapeOutput(NamedTuple):
    """The first `length` coefficients of a row go to the array coefficient `array`."""

    array: str
    row: int
    length: int


class PolynomialTape(NamedTuple):
    """Coefficients of a residual too long to write out: a table that configure runs.

    `rows` polynomials in p with `length` coefficients each; before the first op row 0 is the
    polynomial 1. Run `ops` in order, with factors `scales` (computed once, in the order given),
    then copy `outputs`. Emitted as constant arrays and one loop, never as straight-line code.
    """

    residual: str
    length: int
    rows: int
    scales: tuple[Expression, ...]
    ops: tuple[TapeOp, ...]
    outputs: tuple[TapeOutput, ...]
    comment: str
    origin: Span | None


class NewtonBlock(NamedTuple):
    """The number x at which `value` is zero: Newton's method inside a bracket, from `guess`.

    `body` computes what `value` is made of from the locals `x` and `arguments`, `further` what its
    derivative `slope` needs besides; a slope may be missing where a value is not. `value` grows
    with x if `rising`, else it falls, so that its sign tells on which side the root lies. After
    `most` steps there is no root.
    """

    name: str
    arguments: tuple[str, ...]
    body: tuple[Assignment, ...]
    value: Expression
    further: tuple[Assignment, ...]
    slope: Expression
    rising: bool
    guess: float
    most: int
    comment: str
    origin: Span | None


class DotTerm(NamedTuple):
    """sum over k < length of coef `array`[k] times derivative k of the known `signal`."""

    array: str
    signal: str
    length: int


class Dot(NamedTuple):
    """`target` = the sum of all terms, each one a loop."""

    target: Ref
    terms: tuple[DotTerm, ...]
    comment: str
    origin: Span | None


Assignment: TypeAlias = Assign | Branch
Statement: TypeAlias = Assignment | PolynomialTape | Dot


@overload
def flat(statements: Iterable[Assignment]) -> Iterator[Assign]: ...
@overload
def flat(statements: Iterable[Statement]) -> Iterator[Assign | PolynomialTape | Dot]: ...
def flat(statements: Iterable[Statement]) -> Iterator[Assign | PolynomialTape | Dot]:
    """The statements with those of both sides of every branch before it, itself as its choice.

    This is for who asks what is read and given, not when.
    """
    for statement in statements:
        if isinstance(statement, Branch):
            yield from flat((*statement.yes, *statement.no))
            target, value, _, _, comment, origin = statement
            yield Assign(target, value, comment, origin)
        else:
            yield statement

# --------------------------------------------------------------------- program


class Field(NamedTuple):
    """A member of one of the structs: identifier, name in the model, unit, meaning.

    `size` is the length of an array, 0 for a plain number. `default` is the nominal value of a
    parameter, None where the model gives none and the caller of configure has to.
    """

    name: str
    path: str
    unit: str
    doc: str
    default: float | None = None
    origin: Span | None = None
    size: int = 0


class Known(NamedTuple):
    """A known signal: `highest` derivative that exact needs (-1: only its integral),
    `integral` whether its integral is needed too, `counts` of an encoder a turn.

    A `reading` is the number that a law received of the sensor with the same `path`. The code that
    is emitted has none: there both are the signal of the sensor.
    `lowest` is -2 where exact needs the integral of the integral, -1 where it needs the integral;
    `start` says that exact needs the value at the start; `sampled` that step reads it. Samples in
    logs are `offset` too large, in its unit; the code takes them without it.
    """

    name: str
    path: str
    unit: str
    doc: str
    kind: Literal["input", "sensor", "reading", "mode"]
    highest: int
    integral: bool
    counts: float | None
    origin: Span | None
    lowest: int = 0
    start: bool = False
    sampled: bool = True
    offset: float = 0.0


class Delayed(NamedTuple):
    """A past value of a known signal: `known` is what the signal `of` was `seconds` ago.

    `step` remembers samples for it; between two of them it is on a straight line. It has no value
    before there are samples that old, and what reads it starts when they are there.
    """

    known: Known
    of: str
    seconds: float


class Dropped(NamedTuple):
    """A term that `step` leaves out because it cannot be seen at the sample rate."""

    residual: str
    signal: str
    order: int
    share: float  # of the largest term of the same signal, at the highest visible frequency


def law_pace(pace: float) -> float:
    """bandwidth * sample_time of the filter in front of laws, where that of the filter is `pace`.

    See `passes.lowering.filter.Filter.inner`.

    >>> law_pace(0.01), law_pace(2.0)
    (0.1, 4.0)
    """
    return max(2.0 * pace, math.sqrt(pace))


class ResidualInfo(NamedTuple):
    """What a residual is, for comments and for warm-up.

    `order` is the highest derivative in exact, `stages` the number of first-order stages in step,
    `laws` of those that signals pass before them, in front of laws with derivatives inside.
    `faults` are the faults it sees, `invisible` those of them that step cannot see at the sample
    rate. `settle` is how many time constants (1/bandwidth) step needs before it is valid, after
    `held` time constants of the filter in front of laws; `begins` is the coefficient that has the
    part of these that a sample is.
    `approximate` says why step puts filtered derivatives into a nonlinear term ("" where step is
    the exact residual, filtered); `unavailable` why step has no value at all (never valid),
    `unwritten` why exact has none (no statement of it assigns the residual). `follows` is the
    sensor that step predicts as an observer, "" where it filters derivatives.
    """

    name: str
    path: str
    text: str
    order: int
    stages: int
    faults: tuple[str, ...]
    invisible: tuple[str, ...]
    origin: Span | None
    settle: float = 0.0
    approximate: str = ""
    unavailable: str = ""
    unwritten: str = ""
    follows: str = ""
    laws: int = 0
    held: float = 0.0
    begins: str = ""

    def wait(self, pace: float) -> float:
        """Time constants until step is valid, where bandwidth * sample_time is `pace`."""
        return self.settle + self.held * pace / law_pace(pace)


#: Samples that a residual needs at least to start anew, where its filter is fast.
FEWEST = 40


class Opening(NamedTuple):
    """How a residual starts anew: it is not valid before the state `progress` has come to 1.

    That takes `FEWEST` samples at least. The state falls back to 0 where one of the `modes` has
    changed since the sample before, because that change may make something jump that the residual
    differentiates.
    """

    residual: str
    progress: str
    modes: tuple[str, ...]


class Program(NamedTuple):
    """The residual program of one model. `digest` is a hash of the model and the options.

    `first` runs in place of `step` at the first sample and after every restart; most of its
    statements are those of `step`. A sample or a
    residual that is not finite restarts the program at the next sample that is.
    """

    name: str
    title: str
    source: str
    digest: str
    params: tuple[Field, ...]
    knowns: tuple[Known, ...]
    coefs: tuple[Field, ...]
    states: tuple[Field, ...]
    residuals: tuple[ResidualInfo, ...]
    configure: tuple[Assignment | PolynomialTape, ...]
    exact: tuple[Assignment | Dot, ...]
    first: tuple[Assignment, ...]  # step, when it starts: steady state of the first sample
    step: tuple[Assignment, ...]
    dropped: tuple[Dropped, ...]
    rate: float  # samples a second that the code was made for
    bandwidth: float  # rad/s, default of configure
    warmup: float  # time constants to wait before a residual is valid, laws left out (`wait`)
    tables: tuple[tuple[str, tuple[tuple[float, ...], ...]], ...]  # rows, see `ir.tables`
    integrals: tuple[Field, ...] = ()  # what exact takes besides the known signals
    time_unit: float = 1.0  # s, default of configure
    roots: tuple[NewtonBlock, ...] = ()  # each may use those before it
    bounds: str = ""  # the program whose residuals these results are thresholds of
    openings: tuple[Opening, ...] = ()  # of the residuals that start anew where switches turn
    delayed: tuple[Delayed, ...] = ()  # past values of the known signals

    def waits(self, pace: float) -> dict[str, float]:
        """Time constants until each residual is valid, as `ResidualInfo.wait`, by name."""
        least = dict.fromkeys((o.residual for o in self.openings), FEWEST * pace)
        return {r.name: max(r.wait(pace), least.get(r.name, 0.0)) for r in self.residuals}

    def wait(self, pace: float) -> float:
        """The same until nothing is left of a start of any."""
        begun = max([r.wait(pace) - r.settle for r in self.residuals], default=0.0)
        return max(self.warmup + begun, FEWEST * pace if self.openings else 0.0)

    def __hash__(self) -> int:
        """Of what tells programs apart: what is cached by a program is asked for again and again,
        and to hash all statements takes as long as to write some of them.
        """
        return hash((self.name, self.digest, len(self.exact), len(self.step), len(self.configure)))

    @property
    def read(self) -> tuple[Known, ...]:
        """The known signals and their past values."""
        return (*self.knowns, *[d.known for d in self.delayed])
