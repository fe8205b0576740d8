"""A random point that satisfies the plant's equations and all that follows from them there.

Linear equations are eliminated first; then nonlinear laws are made linear one by one: a law with
one undetermined place is inverted, otherwise an argument of a function gets a random value. What
stays undetermined in the end, inputs and states alike, is random.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from heapq import heapify, heappop, heappush
from random import Random

from bondgraph.exact import series
from bondgraph.exact.equations import (
    Equation,
    FormSample,
    Setting,
    coefficient_row,
    reach,
)
from bondgraph.exact.evaluate import chosen, evaluate, values_of
from bondgraph.exact.field import INVERSES, P, Undefined, inverse, of_fraction, root, sign
from bondgraph.exact.forms import Form, Forms, NotLinear
from bondgraph.exact.implicit import solve
from bondgraph.exact.known import KnownSample, gradient
from bondgraph.exact.linear import (
    CONSTANT,
    Contradiction,
    Pivot,
    Row,
    add_multiple,
    back_substitute,
    eliminate,
)
from bondgraph.exact.polynomials import trim
from bondgraph.exact.series import Series
from bondgraph.ir.expr import Expr, Op, topological

STRIDE = 1 << 14  # columns are variable * STRIDE + Taylor coefficient


class _PointForms(Forms):
    """Forms that know what the point has determined so far."""

    def __init__(self, point: Point) -> None:
        super().__init__(point.setting.functions)
        self._point = point

    def try_known(self, form: Form) -> Series | None:
        """The value of a form that the point determines."""
        known = super().try_known(form)
        if known is not None:
            return known[:1]
        row = self._point.reduce(coefficient_row(form, 0, STRIDE))
        return None if any(c != CONSTANT for c in row) else [row.get(CONSTANT, 0)]


class _PointSample(FormSample):
    """The sample on which nonlinear laws are looked at while the point is being found."""

    def __init__(self, point: Point) -> None:
        super().__init__(point.place, point.setting)
        self.algebra: Forms = _PointForms(point)


class Point:
    """Coefficients of all variables, found step by step."""

    def __init__(
        self, place: Mapping[Expr, tuple[int, int]], setting: Setting, random: Random
    ) -> None:
        self.place = place
        self.setting = setting
        self.random = random
        self.pivots: list[Pivot] = []
        self.rank: dict[int, int] = {}

    # ------------------------------------------------------------------ linear bookkeeping

    def reduce(self, row: Row) -> Row:
        """The row in columns that are not determined by others."""
        rank = self.rank
        queue = [rank[c] for c in row if c in rank]
        if not queue:
            return row
        heapify(queue)
        row = dict(row)
        while queue:
            column, pivot = self.pivots[heappop(queue)]
            x = row.pop(column, None)
            if x is None:
                continue
            for c in pivot:
                if c not in row and c in rank:
                    heappush(queue, rank[c])
            add_multiple(row, -x, pivot)
        return row

    def add(self, row: Row, number: int = -1) -> None:
        """Require that the row is zero; raises `Contradiction(number)`."""
        row = self.reduce(row)
        columns = [c for c in row if c != CONSTANT]
        if not columns:
            if row:
                raise Contradiction(number)
            return
        column = max(columns, key=lambda c: (c % STRIDE, c))
        factor = inverse(row.pop(column))
        self.rank[column] = len(self.pivots)
        self.pivots.append(Pivot(column, {c: x * factor % P for c, x in row.items()}))

    def fix(self, row: Row) -> int:
        """The value of a row; a random one is required if it is not determined."""
        row = self.reduce(row)
        if any(c != CONSTANT for c in row):
            value = self.random.randrange(1, P)
            required = dict(row)
            required[CONSTANT] = (row.get(CONSTANT, 0) - value) % P
            self.add(required)
            return value
        return row.get(CONSTANT, 0)

    def linear(self, equations: list[Equation], times: list[int]) -> None:
        """Eliminate the linear equations, equation i with its derivatives up to `times[i]`."""
        rows, numbers = [], []
        for number, equation in enumerate(equations):
            if equation.rest is None:
                for order in range(times[number] + 1):
                    rows.append(coefficient_row(equation.form, order, STRIDE))
                    numbers.append(number)
        try:
            self.pivots = eliminate(rows)
        except Contradiction as failure:
            raise Contradiction(numbers[failure.row]) from None
        self.rank = {p.column: at for at, p in enumerate(self.pivots)}

    # -------------------------------------------------------------------- nonlinear laws

    def nonlinear(self, equations: list[Equation], times: list[int]) -> None:
        """Satisfy the nonlinear equations and their derivatives, the earliest needed first."""
        todo: dict[int, list[tuple[int, int]]] = {}
        for number, equation in enumerate(equations):
            if equation.rest is not None:
                for order in range(times[number] + 1):
                    todo.setdefault(order - times[number], []).append((number, order))
        for stage in sorted(todo):
            values = [(i, equations[i]) for i, order in todo[stage] if order == 0]
            self.values(values)
            for i, order in todo[stage]:
                if order:
                    self.add(self.linearised(equations[i], order), i)

    def values(self, pending: list[tuple[int, Equation]]) -> None:
        """Satisfy nonlinear equations themselves.

        Which law gets a random value first is random too: another attempt takes another.
        """
        self.random.shuffle(pending)
        while pending:
            left, block = [], None
            for number, equation in pending:
                found = self.satisfied(number, equation)
                if found is not None:
                    left.append((number, equation))
                    block = block or found
            if len(left) == len(pending) and block is not None:
                solved = next((n for n, e in pending if self.by_itself(e)), None)
                if solved is not None:
                    pending = [item for item in pending if item[0] != solved]
                    continue
                self.fix(coefficient_row(block, 0, STRIDE))
            pending = left

    def satisfied(self, number: int, equation: Equation) -> Form | None:
        """None if the equation could be made true, else a form whose value it waits for."""
        assert equation.rest is not None
        sample = _PointSample(self)
        nodes = topological([equation.rest])
        values, failures = values_of(nodes, dict.fromkeys(nodes, 1), sample)
        failure = failures.get(equation.rest)
        row = coefficient_row(equation.form, 0, STRIDE)
        if failure is None:
            add_multiple(row, 1, coefficient_row(values[equation.rest], 0, STRIDE))
            try:
                self.add(row, number)
            except Contradiction:
                if not self.tuned(equation):
                    raise
            return None
        if not isinstance(failure, NotLinear):
            raise failure
        row = self.reduce(row)
        if all(c == CONSTANT for c in row) and self.impose(
            equation.rest, -row.get(CONSTANT, 0) % P, values, failures, number
        ):
            return None
        return failure.form

    def by_itself(self, equation: Equation) -> bool:
        """Satisfy a law by the one quantity that is still open in it, if it is only one."""
        assert equation.rest is not None
        rest = self.reduce(coefficient_row(equation.form, 0, STRIDE))
        rows: dict[Expr, Row] = {}
        for node in topological([equation.rest]):
            if node.op is Op.SYM and node in self.place:
                variable, sign_ = self.place[node]
                rows[node] = self.reduce({variable * STRIDE: sign_ % P})
            elif node.op is Op.DER:
                return False
        free = {c for row in (rest, *rows.values()) for c in row if c != CONSTANT}
        if len(free) != 1:
            return False
        (column,) = free
        values = self.setting.values
        leaves = {
            n: [values[n][0]]
            for n in topological([equation.rest])
            if n.op is Op.SYM and n not in rows and n in values
        }
        leaves |= {n: [row.get(CONSTANT, 0), row.get(column, 0)] for n, row in rows.items()}
        try:
            found = solve(
                equation.rest,
                {n: trim(v) or [0] for n, v in leaves.items()},
                trim([rest.get(CONSTANT, 0), rest.get(column, 0)]),
                self.setting.functions,
            )
        except (Undefined, KeyError):
            return False
        self.add({column: 1, CONSTANT: -found % P})
        return True

    def tuned(self, equation: Equation) -> bool:
        """Satisfy a law that contradicts the others by a parameter that it alone uses."""
        assert equation.rest is not None
        nodes = topological([equation.rest])
        values = self.setting.values
        for symbol in [n for n in nodes if n in self.setting.private]:
            first = values[symbol]
            found = []
            for step in range(3):  # the law must be linear in the parameter
                values[symbol] = [(first[0] + step) % P, *first[1:]]
                results, failures = values_of(nodes, dict.fromkeys(nodes, 1), _PointSample(self))
                if equation.rest in failures:
                    break
                row = coefficient_row(equation.form, 0, STRIDE)
                add_multiple(row, 1, coefficient_row(results[equation.rest], 0, STRIDE))
                found.append(self.reduce(row).get(CONSTANT, 0))
            values[symbol] = first
            if len(found) < 3 or (found[2] - 2 * found[1] + found[0]) % P or found[1] == found[0]:
                continue
            change = -found[0] * inverse(found[1] - found[0]) % P
            values[symbol] = [(first[0] + change) % P, *first[1:]]
            self.setting.tuned[symbol] = (self.setting.tuned.get(symbol, 0) + change) % P
            return True
        return False

    def impose(
        self,
        node: Expr,
        value: int,
        values: dict[Expr, Form],
        failures: dict[Expr, Exception],
        number: int,
    ) -> bool:
        """Give an expression a value through the only place where it is open, if there is one."""
        if node in values:
            row = coefficient_row(values[node], 0, STRIDE)
            row[CONSTANT] = (row.get(CONSTANT, 0) - value) % P
            self.add(row, number)
            return True
        if node.op is Op.IF:
            if node.args[0] not in values or self.is_open(values[node.args[0]]):
                return False
            taken = chosen(node, values, _PointForms(self))
            return self.impose(taken, value, values, failures, number)
        open_args = []
        known: dict[Expr, int] = {}
        for a in node.args:
            row = self.reduce(coefficient_row(values[a], 0, STRIDE)) if a in values else {0: 1}
            if all(c == CONSTANT for c in row):
                known[a] = row.get(CONSTANT, 0)
            else:
                open_args.append(a)
        if node.op is Op.MUL and not value:
            powers = zip(node.args, node.exponents, strict=True)
            if any(e > 0 and known.get(a) == 0 for a, e in powers):
                return True  # one factor is zero, whatever the others are
        if len(open_args) != 1:
            return False
        below = open_args[0]
        inner = _undone(node, value, below, known, self.setting)
        return inner is not None and self.impose(below, inner, values, failures, number)

    def is_open(self, form: Form) -> bool:
        """Whether a form is not determined yet."""
        return any(c != CONSTANT for c in self.reduce(coefficient_row(form, 0, STRIDE)))

    def linearised(self, equation: Equation, order: int) -> Row:
        """A Taylor coefficient (from 1) of a nonlinear equation, linear in its newest unknowns.

        What it rests on below them is fixed first.
        """
        assert equation.rest is not None
        row = coefficient_row(equation.form, order, STRIDE)
        variables: dict[int, Series] = {}
        newest: dict[int, int] = {}
        for variable, highest in reach(self.place, equation.rest).items():
            known = [self.fix({variable * STRIDE + k: 1}) for k in range(order + highest)]
            top = self.reduce({variable * STRIDE + order + highest: 1})
            if all(c == CONSTANT for c in top):
                known.append(top.get(CONSTANT, 0))
            else:
                newest[variable] = highest
            variables[variable] = known
        sample = KnownSample(self.place, self.setting, variables)
        value = evaluate([equation.rest], sample, order + 1)[0]
        rest = value[order] if order < len(value) else 0
        add_multiple(row, 1, {CONSTANT: rest} if rest else {})
        slopes = gradient(equation.rest, sample, self.place)
        for variable, highest in newest.items():
            slope = slopes.get((variable, highest), 0)
            for k in range(order + 1, order + highest + 1):
                slope = slope * k % P
            if slope:
                add_multiple(row, slope, {variable * STRIDE + order + highest: 1})
        return row

    # ------------------------------------------------------------------------ completion

    def complete(self, columns: list[int]) -> dict[int, int]:
        """All values: what is still open is random; `columns` are wanted in any case."""
        values: dict[int, int] = {}
        wanted = dict.fromkeys(columns)
        for _, row in self.pivots:
            for c in row:
                if c != CONSTANT:
                    wanted[c] = None
        for column in sorted(wanted):
            if column not in self.rank:
                values[column] = self.random.randrange(1, P)
        back_substitute(self.pivots, values)
        return values


def _undone(
    node: Expr, value: int, below: Expr, known: dict[Expr, int], setting: Setting
) -> int | None:
    """What `below` must be for the node to have a value; None if that cannot be said."""
    if node.op is Op.ADD:
        factor = 1
        for c, a in zip(node.coefficients, node.args, strict=True):
            if a is below:
                factor = of_fraction(c)
            else:
                value -= of_fraction(c) * known[a]
        return value * inverse(factor) % P
    if node.op is Op.MUL:
        exponent = 1
        for a, e in zip(node.args, node.exponents, strict=True):
            if a is below:
                exponent = e
            else:
                value = value * series.power([known[a]], -e, 1)[0] % P
        return _root(value, exponent)
    if node.op is Op.FN and len(node.args) == 1:
        name = INVERSES.get(node.name)
        if name is None:
            return None
        if name in ("cube", "square"):
            found = pow(value, 3 if name == "cube" else 2, P)
        else:
            found = setting.functions.value(name, value)
        if setting.functions.value(node.name, found) != value % P:
            raise Undefined("a value that the function does not take")  # atan beyond a right angle
        return found
    return None


def _root(value: int, exponent: int) -> int:
    """A solution of x**exponent = value; raises `Undefined` if there is none."""
    if exponent in (1, -1):
        return value if exponent == 1 else inverse(value)

    if exponent % 2 == 0:
        return root(value, Fraction(1, exponent))
    s = sign(value)
    return s * root(s * value, Fraction(1, exponent)) % P
