"""A residual program: what the generated code does, in terms that every language can spell.

Three procedures. `configure` computes the coefficients from the parameters, once. `exact`
evaluates the residuals from exact derivatives (and integrals) of the known signals. `step` takes
one sample of each known signal and runs the realisable residual: every term through the same
cascade of first-order stages. All arithmetic is on one type, `real`.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeAlias

from bondgraph.text.source import Span

# ----------------------------------------------------------------- expressions


class Const(NamedTuple):
    """A number, written with the digits that give back the same double."""

    value: float


class Ref(NamedTuple):
    """A value by name. Space says where it lives:

    param: parameters; coef: coefficients of configure; known: sample or derivative `order` of a
    known signal (-1: its integral); state: filter memory; local: a statement of the same
    procedure; residual: the output.
    """

    space: Literal["param", "coef", "known", "state", "local", "residual"]
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
    """A function of `bondgraph.ir.expr.FUNCTIONS`, or table lookup `table:<id>`."""

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


Expression: TypeAlias = Const | Ref | Sum | Product | Function | Choice
Condition: TypeAlias = Compare | Logic | Mode

# ------------------------------------------------------------------ statements


class Assign(NamedTuple):
    """`target = value`, with the model line and the equation that it comes from."""

    target: Ref
    value: Expression
    comment: str
    origin: Span | None




class PolynomialTape(NamedTuple):
    """Coefficients of a residual too long to write out: a table that configure runs.

    Rows are polynomials in p of at most `length` coefficients; `seeds` are unit rows of the known
    signals, `outputs` the rows of each known signal in the residual, written to coefficients
    `name[signal][k]`. Emitted as constant arrays and one loop, never as straight-line code.
    """

    residual: str
    length: int
    rows: int
    scales: tuple[Expression, ...]
    ops: tuple[tuple[int, int, int, int], ...]  # target, source, shift, scale index; adds
    outputs: tuple[tuple[str, int], ...]  # known signal, row


Statement: TypeAlias = Assign | PolynomialTape

# --------------------------------------------------------------------- program


class Field(NamedTuple):
    """A member of one of the structs: identifier, name in the model, unit, meaning."""

    name: str
    path: str
    unit: str
    doc: str
    default: float | None = None
    origin: Span | None = None


class Known(NamedTuple):
    """A known signal: `highest` derivative that exact needs (-1: only its integral),
    `integral` whether its integral is needed too, `counts` of an encoder a turn."""

    name: str
    path: str
    unit: str
    doc: str
    kind: Literal["input", "sensor", "mode"]
    highest: int
    integral: bool
    counts: float | None
    origin: Span | None


class Dropped(NamedTuple):
    """A term that `step` leaves out because it cannot be seen at the sample rate."""

    residual: str
    signal: str
    order: int
    share: float  # of the largest term of the same signal, at the highest visible frequency


class ResidualInfo(NamedTuple):
    """What a residual is, for comments and for warm-up: text, order, stages, samples to wait."""

    name: str
    path: str
    text: str
    order: int
    stages: int
    faults: tuple[str, ...]
    invisible: tuple[str, ...]
    origin: Span | None


class Program(NamedTuple):
    """The residual program of one model. `digest` is a hash of the model and the options."""

    name: str
    title: str
    source: str
    digest: str
    params: tuple[Field, ...]
    knowns: tuple[Known, ...]
    coefs: tuple[Field, ...]
    states: tuple[Field, ...]
    residuals: tuple[ResidualInfo, ...]
    configure: tuple[Statement, ...]
    exact: tuple[Assign, ...]
    first: tuple[Assign, ...]  # step, when it starts: steady state of the first sample
    step: tuple[Assign, ...]
    dropped: tuple[Dropped, ...]
    rate: float  # samples a second that the code was made for
    bandwidth: float  # rad/s, default of configure
    warmup: float  # time constants to wait before a residual is valid
    tables: tuple[tuple[str, tuple[tuple[float, float], ...]], ...]
