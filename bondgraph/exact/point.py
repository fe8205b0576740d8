"""A random point that satisfies the plant's equations and all that follows from them there.

Linear equations are eliminated first; then nonlinear laws are made linear one by one: a law with
one undetermined place is inverted, otherwise an argument of a function gets a random value of a
size at which the function does something. What stays undetermined in the end is random.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from heapq import heapify, heappop, heappush
from math import isfinite
from random import Random

from bondgraph.exact.evaluate import chosen, evaluate, values_of, values_where
from bondgraph.exact.forms import Form, Forms, NotLinear
from bondgraph.exact.knots import together
from bondgraph.exact.known import KnownSample, gradient
from bondgraph.exact.outline import plan
from bondgraph.exact.plant_equations import (
    Equation,
    FormSample,
    Setting,
    coefficient_row,
    reach,
)
from bondgraph.exact.signal_algebra import Taylor
from bondgraph.field import series
from bondgraph.field.balls import zero_of
from bondgraph.field.numbers import INVERSES, Number, Numbers, Undefined
from bondgraph.field.series import Series
from bondgraph.field.sparse import (
    CONSTANT,
    Contradiction,
    Pivot,
    Row,
    add_multiple,
    back_substitute,
    eliminate,
)
from bondgraph.ir.expr import Expr, Op, topological

STRIDE = 1 << 14  # columns are variable * STRIDE + Taylor coefficient


class _PointForms(Forms):
    """Forms that know what the point has determined so far."""

    def __init__(self, point: Point) -> None:
        super().__init__(point.numbers)
        self._point = point

    def try_known(self, form: Form) -> Series | None:
        """The value of a form that the point determines."""
        known = super().try_known(form)
        if known is not None:
            return known[:1]
        row = self._point.reduce(self._point.row(form))
        return None if any(c != CONSTANT for c in row) else [row.get(CONSTANT, 0)]

    def leads(self, *values: Form) -> list[Number]:
        """As of all forms; see `function`."""
        self._wait("decision", values)
        return super().leads(*values)

    def function(self, name: str, args: Sequence[Form], n: int) -> Form:
        """As of all forms; of several open arguments a random one waits for a value.

        A law `0 = min(a, b)` holds on a side where a is zero, and on one where b is.
        """
        self._wait(name, args)
        return super().function(name, args, n)

    def _wait(self, of: str, args: Sequence[Form]) -> None:
        open_ = [at for at, a in enumerate(args) if self.try_known(a) is None]
        if len(open_) > 1:
            at = self._point.random.choice(open_)
            raise NotLinear(args[at], of, at, args)


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
        self.numbers: Numbers = setting.numbers
        self.random = random
        self.pivots: list[Pivot] = []
        self.rank: dict[int, int] = {}

    # ------------------------------------------------------------------ linear bookkeeping

    def row(self, form: Form, order: int = 0) -> Row:
        """A Taylor coefficient of a form, in columns."""
        return coefficient_row(self.numbers, form, order, STRIDE)

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
            add_multiple(self.numbers, row, -x, pivot)
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
        factor = self.numbers.inverse(row.pop(column))
        self.rank[column] = len(self.pivots)
        self.pivots.append(Pivot(column, {c: x * factor for c, x in row.items()}))

    def fix(self, row: Row, value: Number | None = None) -> Number:
        """The value of a row; if it is not determined it is required to be `value`, or random."""
        row = self.reduce(row)
        if any(c != CONSTANT for c in row):
            if value is None:
                value = self.numbers.any(self.random)
            required = dict(row)
            required[CONSTANT] = row.get(CONSTANT, 0) - value
            self.add(required)
            return value
        return row.get(CONSTANT, 0)

    def linear(self, equations: list[Equation], times: list[int]) -> None:
        """Eliminate the linear equations, equation i with its derivatives up to `times[i]`."""
        rows, numbers = [], []
        for number, equation in enumerate(equations):
            if equation.rest is None:
                for order in range(times[number] + 1):
                    rows.append(self.row(equation.form, order))
                    numbers.append(number)
        try:
            self.pivots = eliminate(self.numbers, rows)
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
        for expr in self.setting.shown:
            self.show(expr)

    def values(self, pending: list[tuple[int, Equation]]) -> None:
        """Satisfy nonlinear equations themselves.

        Which law gets a random value first is random too: another attempt takes another.
        """
        self.random.shuffle(pending)
        while pending:
            left, block, law = [], None, self.setting.shown
            for number, equation in pending:
                found = self.satisfied(number, equation)
                if found is not None:
                    left.append((number, equation))
                    if block is None and equation.rest is not None:
                        block, law = found, (equation.rest,)
            if len(left) == len(pending) and block is not None:
                solved = next((n for n, e in pending if self.by_itself(e)), None)
                if solved is not None:
                    pending = [item for item in pending if item[0] != solved]
                    continue
                if self.setting.joint:
                    laws = [e for _, e in pending]
                    values = together(self, laws, STRIDE, self.setting.joint)
                    for column, value in values.items():
                        self.fix({column: 1}, value)
                    return
                self.choose(block, law)
            pending = left

    def choose(self, block: NotLinear, law: tuple[Expr, ...]) -> None:
        """Give the argument that a law waits for a random value."""
        others = [self.reduce(self.row(form)) for form in block.beside if form is not block.form]
        beside = [row[CONSTANT] for row in others if row.keys() == {CONSTANT}]
        argument = self.numbers.argument(self.random, block.of, block.at, self.scales(law), beside)
        self.fix(self.row(block.form), argument)

    def scales(self, law: tuple[Expr, ...]) -> list[float]:
        """The sizes of the numbers in a law."""
        if not self.numbers.real:
            return []
        values = self.setting.values
        found = [abs(float(values[n][0])) for n in topological(law) if n in values]
        found += [abs(float(n.number)) for n in topological(law) if n.op is Op.NUM]
        return [x for x in found if x and isfinite(x)]

    def show(self, expr: Expr) -> None:
        """Fix what a sensor's functions are asked for, so that the sensor has a value."""
        nodes, need = plan(expr, 1)
        while True:
            failure = values_of(nodes, need, _PointSample(self))[1].get(expr)
            if failure is None:
                return
            if not isinstance(failure, NotLinear):
                raise failure
            self.choose(failure, (expr,))

    def satisfied(self, number: int, equation: Equation) -> NotLinear | None:
        """None if the equation could be made true, else the argument that it waits for."""
        assert equation.rest is not None
        sample = _PointSample(self)
        values, failures = values_of(*plan(equation.rest, 1), sample)
        failure = failures.get(equation.rest)
        row = self.row(equation.form)
        if failure is None:
            add_multiple(self.numbers, row, 1, self.row(values[equation.rest]))
            self.add(row, number)
            return None
        if not isinstance(failure, NotLinear):
            raise failure
        row = self.reduce(row)
        if all(c == CONSTANT for c in row) and self.impose(
            equation.rest, -row.get(CONSTANT, 0), values, failures, number
        ):
            return None
        return failure

    def by_itself(self, equation: Equation) -> bool:
        """Satisfy a law by the one quantity that is still open in it, if it is only one."""
        assert equation.rest is not None
        if not self.numbers.real:
            return False
        rest = self.reduce(self.row(equation.form))
        rows: dict[Expr, Row] = {}
        for node in topological([equation.rest]):
            if node.op is Op.SYM and node in self.place:
                variable, sign = self.place[node]
                rows[node] = self.reduce({variable * STRIDE: sign})
            elif node.op is Op.DER:
                return False
        direction = next((r for r in rows.values() if any(c != CONSTANT for c in r)), None)
        if direction is None:
            return False
        lines = {node: self.along(row, direction) for node, row in rows.items()}
        outside = self.along(rest, direction)
        straight = {node: line for node, line in lines.items() if line is not None}
        if outside is None or len(straight) < len(lines):
            return False
        values = self.setting.values
        nodes = topological([equation.rest])
        fixed = {n: values[n][:1] for n in nodes if n.op is Op.SYM and n not in rows}
        found = zero_on_line(self.numbers, equation.rest, fixed, straight, outside, self.random)
        self.add({**direction, CONSTANT: -found})
        return True

    def along(self, row: Row, direction: Row) -> tuple[Number, Number] | None:
        """(a, b) of a row that is a + b z, z being the direction without its constant."""
        start = row.get(CONSTANT, 0)
        open_ = {c: x for c, x in row.items() if c != CONSTANT}
        if not open_:
            return start, 0
        base = {c: x for c, x in direction.items() if c != CONSTANT}
        column = next(iter(base))
        if column not in open_ or len(open_) != len(base):
            return None
        slope = open_[column] * self.numbers.inverse(base[column])
        add_multiple(self.numbers, open_, -slope, base)
        return None if open_ else (start, slope)

    def impose(
        self,
        node: Expr,
        value: Number,
        values: dict[Expr, Form],
        failures: dict[Expr, Exception],
        number: int,
    ) -> bool:
        """Give an expression a value through the only place where it is open, if there is one."""
        if node in values:
            row = self.row(values[node])
            row[CONSTANT] = row.get(CONSTANT, 0) - value
            self.add(row, number)
            return True
        if node.op is Op.IF:
            if node.args[0] not in values or self.is_open(values[node.args[0]]):
                return False
            taken = chosen(node, values, _PointForms(self))
            return self.impose(taken, value, values, failures, number)
        open_args = []
        known: dict[Expr, Number] = {}
        for a in node.args:
            row = self.reduce(self.row(values[a])) if a in values else {0: 1}
            if all(c == CONSTANT for c in row):
                known[a] = row.get(CONSTANT, 0)
            else:
                open_args.append(a)
        if node.op is Op.MUL and not self.numbers.nonzero(value):
            powers = node.factors
            if any(e > 0 and a in known and not self.numbers.nonzero(known[a]) for a, e in powers):
                return True  # one factor is zero, whatever the others are
        if len(open_args) != 1:
            return False
        below = open_args[0]
        inner = _undone(self.numbers, node, value, below, known, self.random)
        return inner is not None and self.impose(below, inner, values, failures, number)

    def is_open(self, form: Form) -> bool:
        """Whether a form is not determined yet."""
        return any(c != CONSTANT for c in self.reduce(self.row(form)))

    def linearised(self, equation: Equation, order: int) -> Row:
        """A Taylor coefficient (from 1) of a nonlinear equation, linear in its newest unknowns.

        What it rests on below them is fixed first.
        """
        assert equation.rest is not None
        row = self.row(equation.form, order)
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
        add_multiple(self.numbers, row, 1, {CONSTANT: rest})
        slopes = gradient(equation.rest, sample, self.place)
        for variable, highest in newest.items():
            slope = slopes.get((variable, highest), 0)
            for k in range(order + 1, order + highest + 1):
                slope = slope * k
            add_multiple(self.numbers, row, slope, {variable * STRIDE + order + highest: 1})
        return row

    # ------------------------------------------------------------------------ completion

    def complete(self, columns: list[int]) -> dict[int, Number]:
        """All values: what is still open is random; `columns` are wanted in any case."""
        values: dict[int, Number] = {}
        wanted = dict.fromkeys(columns)
        for _, row in self.pivots:
            for c in row:
                if c != CONSTANT:
                    wanted[c] = None
        for column in sorted(wanted):
            if column not in self.rank:
                values[column] = self.numbers.any(self.random)
        back_substitute(self.pivots, values)
        return values


def zero_on_line(
    numbers: Numbers,
    law: Expr,
    fixed: Mapping[Expr, Series],
    lines: Mapping[Expr, tuple[Number, Number]],
    outside: tuple[Number, Number],
    random: Random,
) -> Number:
    """A real number z at which `law` + `outside` vanishes; raises `Undefined` without one.

    The symbols of the law are `fixed`, or straight `lines` in z: value at zero and slope, as
    `outside` is. Of several solutions a random one.
    """
    algebra = Taylor(numbers)

    def value(z: Number) -> Number:
        at = {symbol: [start + slope * z] for symbol, (start, slope) in lines.items()}
        found = values_where(law, {**fixed, **at}, algebra, 1)
        return found[law][0] + outside[0] + outside[1] * z

    return zero_of(value, numbers.number(0), random)


def _undone(
    numbers: Numbers,
    node: Expr,
    value: Number,
    below: Expr,
    known: dict[Expr, Number],
    random: Random,
) -> Number | None:
    """What `below` must be for the node to have a value; None if that cannot be said.

    Of several branches a random one.
    """
    if node.op is Op.ADD:
        factor: Number = 1
        for c, a in node.terms:
            if a is below:
                factor = numbers.fraction(c)
            else:
                value -= numbers.fraction(c) * known[a]
        return value * numbers.inverse(factor)
    if node.op is Op.MUL:
        exponent = 1
        for a, e in node.factors:
            if a is below:
                exponent = e
            else:
                value = value * series.power(numbers, [known[a]], -e, 1)[0]
        return _root(numbers, value, exponent, random)
    if node.op is Op.FN and len(node.args) == 1:
        return _inverted(numbers, node.name, value, random)
    return None


def _inverted(numbers: Numbers, name: str, value: Number, random: Random) -> Number | None:
    """An argument at which a function has a value; None if that cannot be said."""
    if name == "abs":
        if numbers.sign(value) < 0:
            raise Undefined("a negative absolute value")
        return random.choice((1, -1)) * value
    inverse = INVERSES.get(name)
    if inverse is None:
        return None
    if inverse in ("cube", "square"):
        found = value**3 if inverse == "cube" else value * value
    else:
        found = numbers.value(inverse, value)
    if numbers.nonzero(numbers.value(name, found) - value):
        raise Undefined("a value that the function does not take")
    if numbers.real and name in ("sin", "cos", "tan", "cosh"):
        found = _elsewhere(numbers, name, found, random)
    return found


def _elsewhere(numbers: Numbers, name: str, found: Number, random: Random) -> Number:
    """Another argument at which a function that is not one to one has the same value."""
    if name == "cosh":
        return random.choice((1, -1)) * found
    half_turn = numbers.angle(-1, 0)
    if name == "tan":
        return found + random.randrange(-1, 2) * half_turn
    other = half_turn - found if name == "sin" else -found
    return random.choice((found, other)) + 2 * random.randrange(-1, 2) * half_turn


def _root(numbers: Numbers, value: Number, exponent: int, random: Random) -> Number:
    """A solution of x**exponent = value; raises `Undefined` if there is none."""
    if exponent in (1, -1):
        return value if exponent == 1 else numbers.inverse(value)
    if exponent % 2 == 0:
        side = random.choice((1, -1)) if numbers.real else 1
        return side * numbers.power(value, Fraction(1, exponent))
    s = numbers.sign(value)
    return s * numbers.power(s * value, Fraction(1, exponent))
