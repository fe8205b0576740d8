"""How large a model may become when its arrays and loops are unrolled."""

from __future__ import annotations

from bondgraph.ir.syntax import Statement
from bondgraph.passes.elaboration.problems import Abort
from bondgraph.passes.elaboration.scope import Scope
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span

#: Names and statements of the whole model: a million bonds, as arrays of submodels, are within it.
MOST = 3_000_000
#: Names of arrays and statements of loops that one instance unrolls itself: a typing error in a
#: size must not cost more than a second or two.
MOST_UNROLLED = 20_000
#: A statement of so many characters counts once, a longer one more.
_USUAL = 40


class Size:
    """Counts the parts of a model and gives up, with an error, when they are too many."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.made = 0

    def count(self, number: int, scope: Scope, origin: Span) -> None:
        """Keep the size of the model within bounds; the first of an array counts for all."""
        self.made += number * scope.times
        if self.made > MOST:
            self.report.error(
                "model-too-large", f"The model has more than {MOST:,} parts.", origin,
                help="Check the sizes of arrays and `for` loops.",
            )  # fmt: skip
            raise Abort

    def unroll(self, number: int, scope: Scope, origin: Span) -> None:
        """Keep within bounds what loops and arrays of names make of one instance."""
        self.count(number, scope, origin)
        scope.unrolled += number
        if scope.unrolled > MOST_UNROLLED:
            self.report.error(
                "model-too-large", f"`{scope.model.name}` unrolls into more than "
                f"{MOST_UNROLLED:,} statements and names.", origin,
                help="Check the sizes of loops and arrays. Describe a part that repeats so often "
                "as a model, and use an array of it: `Cell:cell[n]`.",
            )  # fmt: skip
            raise Abort


def weight(body: tuple[Statement, ...]) -> int:
    """What a body costs each time it is unrolled: its statements, long ones several times."""
    return max(1, sum([1 + (s.origin.end - s.origin.start) // _USUAL for s in body]))
