"""Which samples count: those in which a machine is on, by an expression over columns of its log."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress

import numpy as np

from bondgraph.algebra.numeric import evaluate
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.ir.syntax import Ref
from bondgraph.passes.elaboration.expressions import Place
from bondgraph.passes.elaboration.outside import Outside
from bondgraph.passes.elaboration.quantities import PURE
from bondgraph.passes.elaboration.scope import Typed
from bondgraph.runtime.log import LEFT_OUT, Log, LogError, Mask, labelled
from bondgraph.runtime.monitoring.columns import Mapped, called
from bondgraph.runtime.simulation.code import Code
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.source import Source, Span

_TIME = "t"


class _Cells(Outside):
    """Expressions in which every name is a number in a column, as it stands there."""

    def __init__(self, report: Report) -> None:
        super().__init__(Pool(), (), report)
        self.names: dict[str, Expr] = {}

    def reference(self, ref: Ref, place: Place) -> Typed:
        """The number in a column; whether there is one is known with the log."""
        name = ref.origin.text.replace(" ", "")
        return self.names.setdefault(name, self.pool.symbol(name, Kind.INPUT)), PURE


class Operating:
    """Says of each sample of a log whether the machine was on.

    `text` is a condition, or a number that is zero while it is off, over columns: by name without
    the unit, letters that no name can have as `_`; or over signals that the `mapping` finds, and
    the time `t` in s. Numbers are those in the log, without a unit. Where one is missing, what held
    last holds on. `name` is that of the log, for messages. Raises CompileError for a text that is
    no such expression.

    >>> log = Log(np.arange(3.0), {"pump [%]": np.array([0.0, 40.0, np.nan])}, {}, {})
    >>> Operating("pump > 5")(log).tolist()
    [False, True, True]
    """

    def __init__(
        self, text: str, mapping: Mapping[str, Mapped] | None = None, name: str = "log"
    ) -> None:
        report = Report()
        cells = _Cells(report)
        source = Source("--while", text)
        expr = cells.read(Span(source, 0, len(text)), None, "`--while`", False, truth=True)
        if expr is None:
            raise CompileError(tuple(report.diagnostics))
        self.text = text
        self._mapping, self._name = dict(mapping or {}), name
        self._names = list(cells.names)
        leaves = {symbol: f"x{k}" for k, symbol in enumerate(cells.names.values())}
        code = Code(cells.pool, leaves, _number)
        arguments = ", ".join(leaves.values())
        self._holds = code.function("operating", arguments, *code.text([expr]))
        self._on = False  # before the first sample nobody knows

    def __call__(self, log: Log) -> Mask:
        """Whether the machine was on, (n,); raises LogError for a name that is no column."""
        columns = [self._column(name, log) for name in self._names]
        rows = zip(*columns, strict=True) if columns else [()] * log.rows
        found = np.empty(log.rows, dtype=np.bool_)
        for k, row in enumerate(rows):
            if all(x == x for x in row):
                with suppress(ArithmeticError, ValueError):  # no number, as if one was missing
                    self._on = bool(self._holds(*row))
            found[k] = self._on
        return found

    def _column(self, name: str, log: Log) -> list[float]:
        mapped = self._mapping.get(name)
        spelt = {re.sub(r"\W+", "_", labelled(c)[0]).strip("_"): c for c in log.columns}
        column = mapped and called(mapped.column, log.columns)
        column = column or called(name, log.columns) or spelt.get(name)
        if column is None and name != _TIME:
            there = ", ".join(labelled(c)[0] for c in log.columns) or "no column"
            message = f"--while asks for `{name}`, and no column of numbers is called so"
            help = f"there is {there}; or {_TIME}, the time in s"
            if LEFT_OUT in log.meta:  # states in words, often
                help += f"; columns without numbers: {log.meta[LEFT_OUT]}"
            raise LogError(self._name, None, message, help)
        found: list[float] = (log.time if column is None else log.columns[column]).tolist()
        return found


def _number(expr: Expr) -> float | None:
    value = evaluate(expr, {})
    return None if value is None else float(value)
