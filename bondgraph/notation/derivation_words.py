"""A derivation in words and equations: what each of its steps says, before it is set anywhere."""

from __future__ import annotations

import re
from collections.abc import Callable

from bondgraph.ir.derivation import Derivation, DerivationStep
from bondgraph.ir.expr import VARIABLES, Expr, symbols
from bondgraph.notation.dump_stages import equation_name
from bondgraph.notation.formula import Reader
from bondgraph.notation.latex import Latex, letter, lettered
from bondgraph.notation.line import show
from bondgraph.text.numerals import joined, plural
from bondgraph.text.source import Source
from bondgraph.text.tuples import NamedTuple

Shown = Callable[[Expr], str]


class Line(NamedTuple):
    """`left` = `right`; without a left side the one of the line above. `note` stands behind it."""

    left: Expr | None
    right: Expr
    note: str = ""


def title(derivation: Derivation, model: str) -> str:
    """What is derived, where it can be, in which positions of the switches."""
    where = [f"{name} {'on' if on else 'off'}" for name, on in derivation.switches]
    there = f", while {joined(where)}" if where else ""
    return f"Derivation of {derivation.residual} of {model}{there}"


def headline(derivation: Derivation, step: DerivationStep, source: Source, shown: Shown) -> str:
    """What a step does; `shown` spells an expression inside of the sentence."""
    where = "" if step.equation is None else equation_name(step.equation, source)
    unknown = "" if step.unknown is None else shown(step.unknown)
    used = ", ".join(map(str, step.uses))
    match step.move:
        case "solve":
            return f"{where}: solve for {unknown}"
        case "invert":
            return f"{where}: turn it around for {unknown}"
        case "differentiate":
            return f"{where}: differentiate its state for {unknown}"
        case "integrate":
            return f"{where}: integrate it from its start for {unknown}"
        case "iterate":
            return f"{where}: {unknown} has no closed form; it is where this equation holds"
        case "tear":
            return f"{where}: a loop begins; take {unknown} for known (torn) until it is closed"
        case "row":
            return f"{where}: put in what is known; what is left holds torn unknowns"
        case "rise":
            return f"differentiate {used}, so that no integral holds a torn unknown"
        case "untear":
            return f"the loop closes: solve {used} for {unknown}"
        case "put":
            return f"put {unknown} from {step.row} into {used}"
        case "lower":
            risen = f", differentiated {_times(step.times)}," if step.times else ""
            return f"{step.row}{risen} takes the highest derivative of {unknown} out of {used}"
        case "close":
            return f"{where}: left over, all its unknowns are known; put them in"
        case "free":
            divided = f"divide by {shown(step.factor)} and " if step.factor else ""
            return f"{divided}differentiate: an initial value that nobody declared drops out"
        case "since":
            return "it is the derivative of what has a declared start, and has kept that value"
        case "cancel":
            return "multiply out"
        case "scale":
            factor = step.factor
            if factor is None or factor is derivation.pool.one:
                return f"as the compiler writes it, this is {derivation.residual}"
            return f"divided by {shown(factor)}, this is {derivation.residual}"
        case "shift":
            return "in the time of the log, where late sensors and inputs are what they were"


def _times(count: int) -> str:
    return "once" if count == 1 else plural(count, "time")


def lines(step: DerivationStep, zero: Expr) -> list[Line]:
    """The equations of a step, one below the other; `zero` is the number."""
    used = ", ".join(map(str, step.uses))
    with_ = f"with {used}" if used else ""
    last = [Line(None, step.closed, with_)] if step.closed is not step.value else []
    match step.move:
        case "tear":
            return [Line(zero, step.zero)]
        case "row" | "close":
            return [Line(zero, step.zero), *([Line(zero, step.closed, with_)] if last else [])]
        case "iterate":
            return [Line(zero, step.zero), Line(step.unknown, step.closed)]
        case "solve" | "invert" | "differentiate" | "integrate":
            return [Line(zero, step.zero), Line(step.unknown, step.value), *last]
        case "untear":
            return [Line(step.unknown, step.value)]
        case _:
            return [Line(zero, step.closed)]


def remark(step: DerivationStep, shown: Shown) -> str:
    """What drops out in a step, and while what it is right."""
    parts = []
    if step.gone:
        parts.append(f"{joined(step.gone)} cancel" + ("s" if len(step.gone) == 1 else ""))
    if step.divisors:
        zero = "is" if len(step.divisors) == 1 else "are"
        parts.append(f"right while {joined([shown(d) for d in step.divisors])} {zero} not zero")
    return "; ".join(parts)


def ending(derivation: Derivation) -> str:
    """What the derivation shows in the end."""
    name = derivation.residual
    if derivation.stopped:
        return f"Here the replay of {name} stops: {derivation.stopped}."
    factor = show(derivation.factor)
    times = "" if factor == "1" else f" times {factor}"
    return f"SymPy agrees: what it derived is the compiler's {name}{times}."


class LatexLines:
    """The equations of steps in LaTeX."""

    def __init__(self, derivation: Derivation) -> None:
        self._reader = Reader({}, derivation.starts)
        held = symbols(*[e for s in derivation.steps for e in (s.zero, s.closed)], derivation.arr)
        unknown = {s.symbol.name for s in held if s.kind in VARIABLES}
        short = lettered(s.symbol.name for s in held if s.symbol.name not in unknown)
        # of an unknown it is always said whose it is
        self._spell = Latex(lambda n, dots: (letter if n in unknown else short)(n, dots))

    def inline(self, expr: Expr) -> str:
        """An expression inside of a sentence, between dollars."""
        return f"${self.spelled(expr)}$"

    def spelled(self, expr: Expr) -> str:
        """An expression."""
        return self._spell.spell(self._reader.of(expr)).text

    def plain(self, text: str) -> str:
        """A sentence with formulas between dollars, its other signs as LaTeX wants them."""
        pieces = text.split("$")
        return "$".join(
            re.sub(r"([_&%#{}])", r"\\\1", piece) if at % 2 == 0 else piece
            for at, piece in enumerate(pieces)
        )

    def aligned(self, found: list[Line]) -> str:
        """Lines of equations below each other."""
        rows = []
        for line in found:
            left = "" if line.left is None else self.spelled(line.left)
            note = rf" && \text{{{line.note}}}" if line.note else ""
            rows.append(rf"{left} &= {self.spelled(line.right)}{note}")
        return "\\begin{aligned}\n" + " \\\\\n".join(rows) + "\n\\end{aligned}"
