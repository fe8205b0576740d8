"""A residual program in whole numbers: what each statement does with 32-bit and 64-bit integers.

A value x is kept as the whole number nearest below x * 2**bits. Nothing here overflows: that was
proven before a statement was made. Products and their sums are of 64 bits; a shift to the right
rounds towards minus infinity, a quotient towards zero.
"""

from __future__ import annotations

from typing import TypeAlias

from bondgraph.ir.program import Program, Ref
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: Bits of a sample beside its sign, where its range has both signs.
SAMPLE_BITS = 29
#: Bits behind the point of the sums of `diagnose`, and of the root of what is added for loudness.
SUM_BITS, ROOT_BITS = 18, 24


class Factor(NamedTuple):
    """A whole number times a variable; `name` says what it is, `bits` how it is scaled."""

    value: int
    variable: Ref
    name: str
    bits: int


class Accumulate(NamedTuple):
    """`target` = ((sum of products + offset) >> shift) + plain variables + `constant`."""

    target: Ref
    products: tuple[Factor, ...]
    offset: int
    shift: int
    plain: tuple[tuple[bool, Ref], ...]
    constant: int


class Count(NamedTuple):
    """`target`, of 64 bits, = the sum of small whole numbers times variables; no rounding."""

    target: Ref
    terms: tuple[tuple[int, Ref], ...]


class Window(NamedTuple):
    """`target` = such a sum, held within -limit to limit, then >> shift."""

    target: Ref
    terms: tuple[tuple[int, Ref], ...]
    limit: int
    shift: int


class Multiply(NamedTuple):
    """`target` = (left * right) >> shift."""

    target: Ref
    left: Ref
    right: Ref
    shift: int


class Divide(NamedTuple):
    """`target` = (above * 2**shift) / below."""

    target: Ref
    above: Ref
    below: Ref
    shift: int


class SignedRoot(NamedTuple):
    """`target` = the whole root of |argument| * 2**shift, with the sign of the argument."""

    target: Ref
    argument: Ref
    shift: int


class Sigmoid(NamedTuple):
    """`target` = tanh of the argument, which has `bits`, by `algebra.cubic_tanh`."""

    target: Ref
    argument: Ref
    bits: int


Instruction: TypeAlias = Accumulate | Count | Window | Multiply | Divide | SignedRoot | Sigmoid


class Explained(NamedTuple):
    """An instruction with the comment and the model line of the statement that it is of."""

    instruction: Instruction
    comment: str
    origin: Span | None


class Guard(NamedTuple):
    """An integral that starts anew when it leaves -limit to limit; a `wide` one has 64 bits."""

    state: Ref
    limit: int
    wide: bool


class FixedBlock(NamedTuple):
    """Residuals that share memory, with what they do with a first sample and with others."""

    name: str
    residuals: tuple[str, ...]
    knowns: tuple[str, ...]
    states: tuple[str, ...]
    first: tuple[Explained, ...]
    step: tuple[Explained, ...]
    guards: tuple[Guard, ...]


class Limits(NamedTuple):
    """What a sample may be, as a whole number, scaled by 2**bits; `low` to `high` in its unit.

    Of an encoder: by how many counts it may turn from one sample to the next; what it turns is
    scaled after that.
    """

    bits: int
    least: int
    most: int
    low: float
    high: float


class Deviation(NamedTuple):
    """How far a residual of whole numbers is from that of real ones at most, and at what scale.

    `fixed` at any time, `hourly` more for each hour since its start; `largest` is what it can be.
    """

    bits: int
    fixed: float
    hourly: float
    largest: float


class WholeLimit(NamedTuple):
    """How far a residual may be from zero while the machine is well, in whole numbers.

    `ir.residual_limit.ResidualLimit` says what each is. `mean`, `level` and `bound` are at the
    scale of the residual. What a row adds is times 2**SUM_BITS: what it is off times `unit` >>
    `unit_shift`, less a half; and, less `drift`, the square of what it is out times `loud` >>
    `loud_shift`, which is times 2**ROOT_BITS.
    """

    mean: int
    level: int
    bound: int
    unit: int
    loud: int
    drift: int
    height: int
    unit_shift: int
    loud_shift: int


class FixedProgram(NamedTuple):
    """The program of whole numbers, for the parameters of the model.

    By name `samples` has the limits of each signal, `residuals` the scale and deviation of each
    residual, `bits` the scale of every variable; `settle` the samples until one is valid. `limits`
    are those of a tuning, by residual in order, none without one.
    """

    program: Program
    blocks: tuple[FixedBlock, ...]
    samples: dict[str, Limits]
    residuals: dict[str, Deviation]
    bits: dict[Ref, int]
    settle: tuple[int | None, ...]
    limits: tuple[WholeLimit, ...] = ()
