"""Expressions become Python source over plain floats: what is computed thousands of times a second.

Parts that hold nothing but numbers are computed once, while the source is written.
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
from bondgraph.notation.dialect import CodeSpeller, Dialect
from bondgraph.passes.lowering.procedure import ONE, ZERO, Procedure
from bondgraph.passes.lowering.program_names import Names

#: What the source may call.
NAMES: dict[str, Any] = {**DOUBLES, "nan": math.nan, "inf": math.inf, "__builtins__": {}}

_PYTHON = Dialect(
    "{0}", "{1} if {0} else {2}", "and", "or", "not {0}", "{0} == {1}", "{0} != {1}",
    {"power": "pow({0}, {1})", "table": "{1}({0})",
     "map": "{2}({0}, {1})", "inverse": "{2}({0}, {1})"},
)  # fmt: skip


class Code:
    """Lines of a function body, and what was computed so far.

    `leaves` are names of Python; `outer` is the code of the function around this one. Raises
    KeyError with the name of a symbol that is neither a leaf nor a number.
    """

    def __init__(
        self,
        pool: Pool,
        leaves: Mapping[Expr, str],
        number: Callable[[Expr], float | None],
        outer: Code | None = None,
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
        self._tables: dict[str, str] = outer._tables if outer else {}
        self._speller = CodeSpeller(_PYTHON, lambda ref: ref.name, self._tables)
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
        if name not in self._tables:
            self._tables[name] = f"table{len(self._tables)}"
            self.names[self._tables[name]] = interpolation(self.pool.rows(name), backwards(name))

    def _constant(self, value: Expr) -> Expression:
        number = self.number(value)
        return Const(math.nan if number is None else number)  # divided by a parameter of zero

    def _write(self, statement: Assignment, deeper: int = 0) -> None:
        name, text = statement.target.name, self._speller.expression
        if not isinstance(statement, Branch):
            self.line(f"{name} = {text(statement.value)}", deeper)
            return
        condition, yes, no = statement.value
        for head, side, value in (
            (f"if {text(condition)}:", statement.yes, yes),
            ("else:", statement.no, no),
        ):
            self.line(head, deeper)
            for inner in side:
                self._write(inner, deeper + 1)
            self.line(f"{name} = {text(value)}", deeper + 1)

    def function(
        self, name: str, arguments: str, result: str, **more: object
    ) -> Callable[..., Any]:
        """The function with these lines; `more` are further names that it uses."""
        source = "\n".join([f"def {name}({arguments}):", *self.lines, f"    return {result}"])
        space = {**self.names, **more}
        exec(compile(source, f"<{name} of the virtual machine>", "exec"), space)
        made: Callable[..., Any] = space[name]
        return made
