"""Expressions become Python source over plain floats: what is computed thousands of times a second.

Parts that hold nothing but numbers are computed once, while the source is written. The branches of
`if` are written as branches, so that the one not taken may be undefined.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from bondgraph.algebra.interpreter import interpolation
from bondgraph.algebra.numeric import DOUBLES
from bondgraph.ir.expr import Expr, Op, Pool

_INLINE = 40  # letters of a subexpression that is written where it is used


#: What the source may call.
NAMES: dict[str, Any] = {**DOUBLES, "nan": math.nan, "inf": math.inf, "__builtins__": {}}


class Code:
    """Lines of a function body, and the names of what was computed so far."""

    def __init__(
        self, pool: Pool, leaves: Mapping[Expr, str], number: Callable[[Expr], float | None]
    ) -> None:
        self.pool = pool
        self.number = number
        self.lines: list[str] = []
        self.known: dict[Expr, str] = dict(leaves)
        self.names = dict(NAMES)
        self.tables: dict[str, str] = {}
        self._count = 0
        self._depth = 0

    def line(self, text: str) -> None:
        """One more line, at the present depth."""
        self.lines.append("    " * (self._depth + 1) + text)

    def fresh(self, stem: str = "v") -> str:
        """A name that nothing has yet."""
        self._count += 1
        return f"{stem}{self._count}"

    def assign(self, target: Expr, value: str) -> str:
        """Keep a value under the name of a symbol."""
        name = self.fresh()
        self.line(f"{name} = {value}")
        self.known[target] = name
        return name

    def write(self, expr: Expr) -> str:
        """What to write for an expression; its parts are computed by lines before."""
        found = self.known.get(expr)
        if found is not None:
            return found
        number = self.number(expr)
        if number is not None:
            text = repr(float(number))
            return f"({text})" if text.startswith("-") else text
        if expr.op is Op.IF:
            return self._branches(expr)
        text = self._text(expr)
        if len(text) > _INLINE or expr.op is Op.FN:
            return self.assign(expr, text)
        return f"({text})"

    def _branches(self, expr: Expr) -> str:
        condition, *branches = expr.args
        name = self.fresh()
        self.line(f"if {self.condition(condition)}:")
        for k, branch in enumerate(branches):
            if k:
                self.line("else:")
            before = dict(self.known)
            self._depth += 1
            self.line(f"{name} = {self.write(branch)}")
            self._depth -= 1
            self.known = before
        self.known[expr] = name
        return name

    def condition(self, expr: Expr) -> str:
        """A condition as Python writes it."""
        if expr.op is Op.CMP:
            left, right = (self.write(a) for a in expr.args)
            return f"({left} {expr.name} {right})"
        if expr.op is Op.LOGIC:
            parts = [self.condition(a) for a in expr.args]
            joined = f" {expr.name} ".join(parts)
            return f"(not {parts[0]})" if expr.name == "not" else f"({joined})"
        return f"({self.write(expr)} != 0)"

    def _text(self, expr: Expr) -> str:
        match expr.op:
            case Op.ADD:
                return self._sum(expr)
            case Op.MUL:
                return self._product(expr)
            case Op.FN:
                return self._function(expr)
            case Op.CMP | Op.LOGIC:
                return f"(1.0 if {self.condition(expr)} else 0.0)"
            case _:
                raise KeyError(repr(expr))

    def _sum(self, expr: Expr) -> str:
        text = ""
        for c, arg in expr.terms:
            own = self.write(arg)
            size = abs(float(c))
            term = own if size == 1 else f"{size!r}*{own}"
            if c < 0:
                text += f" - {term}" if text else f"-{term}"
            else:
                text += f" + {term}" if text else term
        return text

    def _product(self, expr: Expr) -> str:
        above, below, scale = "", "", 1.0
        for arg, exponent in expr.factors:
            number = self.number(arg)
            if number is not None and (number or exponent > 0):
                scale *= number**exponent
                continue
            own = self.write(arg)
            size = abs(exponent)
            factor = "*".join([own] * size) if size <= 3 else f"{own}**{size}"
            if exponent > 0:
                above += f"*{factor}" if above else factor
            else:
                below += f"*{factor}" if below else factor
        if scale != 1.0 or not above:
            above = f"{scale!r}*{above}" if above else repr(scale)
        return f"{above}/({below})" if below else above

    def _function(self, expr: Expr) -> str:
        args = ", ".join(self.write(a) for a in expr.args)
        if not expr.name.startswith("table:"):
            return f"{expr.name}({args})"
        if expr.name not in self.tables:
            self.tables[expr.name] = f"table{len(self.tables)}"
            rows = self.pool.rows(expr.name.removeprefix("table:"))
            self.names[self.tables[expr.name]] = interpolation(rows)
        return f"{self.tables[expr.name]}({args})"

    def function(
        self, name: str, arguments: str, result: str, **more: object
    ) -> Callable[..., Any]:
        """The function with these lines; `more` are further names that it uses."""
        source = "\n".join([f"def {name}({arguments}):", *self.lines, f"    return {result}"])
        space = {**self.names, **more}
        exec(compile(source, f"<{name} of the virtual machine>", "exec"), space)
        made: Callable[..., Any] = space[name]
        return made
