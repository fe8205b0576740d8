"""Expressions become source over plain floats: what is computed thousands of times a second.

Parts that hold nothing but numbers are computed once, while the source is written. Python has them
in its text; a compiled language takes them from an array, so that its text does not depend on them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from bondgraph.algebra.interpolation import interpolation
from bondgraph.algebra.numeric import DOUBLES
from bondgraph.ir.expr import Expr, Kind, Op, Pool
from bondgraph.ir.program import Assignment, Branch, Choice, Const, Expression, Mode, Ref
from bondgraph.ir.tables import backwards
from bondgraph.notation.dialect import CodeSpeller, Dialect, Language
from bondgraph.passes.lowering.procedure import ONE, ZERO, Procedure
from bondgraph.passes.lowering.program_names import Names
from bondgraph.text.tuples import NamedTuple

#: What the source may call.
NAMES: dict[str, Any] = {**DOUBLES, "nan": math.nan, "inf": math.inf, "__builtins__": {}}

_PYTHON = Language(
    Dialect(
        "{0}", "{1} if {0} else {2}", "and", "or", "not {0}", "{0} == {1}", "{0} != {1}",
        {"power": "pow({0}, {1})", "table": "{1}({0})",
         "map": "{2}({0}, {1})", "inverse": "{2}({0}, {1})"},
    ),
    "{0} = {1}", "{0} = {1}", "", ("if {0}:", "else:", ""),
)  # fmt: skip


class Numbers:
    """The constants of a compiled source, in the array `p` that it reads them from."""

    def __init__(self) -> None:
        self.values: list[float] = []
        self._places: dict[Expr, int] = {}

    def name(self, value: Expr, number: float) -> str:
        """What an expression that is a number is called in the source."""
        if value not in self._places:
            self._places[value] = self.put([number])
        return f"p[{self._places[value]}]"

    def put(self, numbers: Sequence[float]) -> int:
        """Further numbers, one behind the other; the place of the first."""
        self.values += numbers
        return len(self.values) - len(numbers)


class Shared(NamedTuple):
    """What the functions of one source share: its language, its tables by name, its constants.

    Without `numbers` constants are written out.
    """

    language: Language
    tables: dict[str, str]
    numbers: Numbers | None


class Code:
    """Lines of a function body, and what was computed so far.

    `leaves` are names of the language; `outer` is the code of the function around this one, and
    `shared` what it has in common with others that do not stand around it (Python of its own
    without). Raises KeyError with the name of a symbol that is neither a leaf nor a number.
    """

    def __init__(
        self,
        pool: Pool,
        leaves: Mapping[Expr, str],
        number: Callable[[Expr], float | None],
        outer: Code | None = None,
        shared: Shared | None = None,
    ) -> None:
        self.pool = pool
        self.number = number
        self.lines: list[str] = []
        self.names: dict[str, Any] = outer.names if outer else dict(NAMES)
        self.free: Names = outer.free if outer else Names()
        self._outer = outer
        self._depth: int = outer._depth + 1 if outer else 1
        self._known: dict[Expr, Expression] = {}
        self._meant: dict[Expr, Expr] = outer._meant if outer else {}
        self.shared: Shared = outer.shared if outer else shared or Shared(_PYTHON, {}, None)
        self._speller = CodeSpeller(
            self.shared.language.dialect, lambda ref: ref.name, self.shared.tables
        )
        self._work = Procedure(
            pool, self._leaf, self._write, self.free, "v", self._constant,
            lambda e: number(e) is not None,
        )  # fmt: skip
        for leaf, name in leaves.items():
            self.know(leaf, name)

    def know(self, leaf: Expr, name: str) -> None:
        """From here on a symbol has this name."""
        mode = leaf.kind is Kind.MODE
        self._known[leaf] = Choice(Mode(name), ONE, ZERO) if mode else Ref("local", name)

    def line(self, text: str, deeper: int = 0) -> None:
        """One more line."""
        self.lines.append("    " * (self._depth + deeper) + text)

    def text(self, exprs: Sequence[Expr]) -> list[str]:
        """What to write for expressions; their parts are computed by lines before."""
        exprs = self.pool.substitute(list(exprs), self._meant)
        return [self._speller.expression(v) for v in self._work.values(exprs, None)]

    def define(self, symbol: Expr, value: Expr) -> None:
        """From here on a symbol means this expression."""
        (self._meant[symbol],) = self.pool.substitute([value], self._meant)

    def _leaf(self, node: Expr) -> Expression | None:
        found = self._known.get(node)
        if found is None and self._outer is not None:
            found = self._outer._known.get(node) or self._outer._work.named(node)
        if found is None and node.op in (Op.SYM, Op.DER, Op.INT):
            raise KeyError(repr(node))
        if node.op is Op.FN and node.name.startswith("table:"):
            self._table(node.name.removeprefix("table:"))
        return found

    def _table(self, name: str) -> None:
        tables = self.shared.tables
        if name not in tables:
            tables[name] = f"table{len(tables)}"
        if self.shared.numbers is None and tables[name] not in self.names:
            self.names[tables[name]] = interpolation(self.pool.rows(name), backwards(name))

    def _constant(self, value: Expr) -> Expression:
        number = self.number(value)
        if number is None:
            number = math.nan  # divided by a parameter of zero
        if self.shared.numbers is None:
            return Const(number)
        return Ref("local", self.shared.numbers.name(value, number))

    def _write(self, statement: Assignment, deeper: int = 0) -> None:
        name, text = statement.target.name, self._speller.expression
        language = self.shared.language
        if not isinstance(statement, Branch):
            self.line(language.local.format(name, text(statement.value)), deeper)
            return
        condition, yes, no = statement.value
        before, between, after = language.branch
        if language.declared:
            self.line(language.declared.format(name), deeper)
        for head, side, value in (
            (before.format(text(condition)), statement.yes, yes),
            (between, statement.no, no),
        ):
            self.line(head, deeper)
            for inner in side:
                self._write(inner, deeper + 1)
            self.line(language.assign.format(name, text(value)), deeper + 1)
        if after:
            self.line(after, deeper)

    def function(
        self, name: str, arguments: str, result: str, **more: object
    ) -> Callable[..., Any]:
        """The function with these lines; `more` are further names that it uses."""
        source = "\n".join([f"def {name}({arguments}):", *self.lines, f"    return {result}"])
        space = {**self.names, **more}
        exec(compile(source, f"<{name} of the virtual machine>", "exec"), space)
        made: Callable[..., Any] = space[name]
        return made
