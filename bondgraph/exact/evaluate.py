"""Evaluate expressions on a sample of all signals, and differentiate them there, exactly.

Evaluation is linear in nodes times orders: one pass from the roots says how many coefficients
each node has to deliver, one pass from the leaves delivers them. Sensitivities are one reverse
pass more (Griewank and Walther, 2008, ch. 3).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from random import Random
from typing import Any, NamedTuple, Protocol, TypeAlias

from bondgraph.exact.outline import demands, integral_depth, outline, plan, static
from bondgraph.exact.signal_algebra import Algebra, Exponentials, Mixed, Taylor, Values, compare
from bondgraph.field.balls import zero_of
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.series import Series
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, Rational, Symbol, topological


class Assignment(Protocol):
    """What every symbol is at a point, in one of the algebras."""

    @property
    def algebra(self) -> Values[Any]:
        """The algebra that the values belong to."""
        ...

    def value(self, symbol: Expr) -> Any:
        """The value of a SYM node; raises KeyError for one that the sample does not know."""
        ...

    def start(self, initial: Symbol) -> Number:
        """The value with which integrals from this initial value begin."""
        ...


class Sample(Assignment, Protocol):
    """A point with a past, at which expressions can be differentiated."""

    @property
    def algebra(self) -> Algebra[Any, Any]:
        """The algebra that the values belong to."""
        ...

    def earlier(self, steps: int) -> Sample:
        """The same plant with the same constants at an earlier time, all signals different."""
        ...


#: An IF node, and whether its condition holds.
Side: TypeAlias = tuple[Expr, bool]


class Sensitivity(NamedTuple):
    """What a residual depends on at a point.

    `depends[symbol]` for every SYM node below the root: whether the derivative with respect to it
    (as a function of time, the past included) is not zero. `orders[signal]` for the known signals
    with dependence: the highest derivative, -1 where only the past of the signal matters. `dead`
    are the nodes below the root that do not influence it. `starts` are the initial values of the
    integrals that influence it, `lasting` the symbols of which a constant change shows, too.
    """

    depends: dict[Expr, bool]
    orders: dict[Expr, int]
    dead: frozenset[Expr]
    starts: tuple[Symbol, ...]
    lasting: frozenset[Expr]


def terms_needed(roots: Sequence[Expr]) -> int:
    """How many coefficients of the roots say whether they vanish on a plant, faulty or not."""
    return integral_depth(roots) + 1


def evaluate(roots: Sequence[Expr], sample: Assignment, n: int = 1) -> list[Any]:
    """The values of the roots, `n` Taylor coefficients each (one number for exponentials).

    Raises `Undefined` if a value that a root rests on does not exist at this point, `Mixed` if
    an operation leads out of the sample's algebra.
    """
    if n == 1 and isinstance(sample.algebra, Taylor):
        numbers = _numbers(tuple(roots), sample)
        if numbers is not None:
            return [[numbers[root]] for root in roots]
    nodes: Sequence[Expr]
    if len(roots) == 1:
        nodes, need = plan(roots[0], n)
    else:
        nodes = topological(roots)
        need = demands(nodes, roots, n)
    values, failures = values_of(nodes, need, sample)
    for root in roots:
        if root in failures:
            raise failures[root]
    return [values[root] for root in roots]


def _numbers(roots: tuple[Expr, ...], sample: Assignment) -> dict[Expr, Number] | None:
    """Sums and products at the point itself; None for others, and where a value is missing."""
    nodes = static(roots)
    if nodes is None:
        return None
    numbers, values = sample.algebra.numbers, dict[Expr, Number]()
    powers = _Powers(numbers, values)
    try:
        for node in nodes:
            total: Number
            if node.op is Op.ADD:
                total = 0
                for c, a in zip(node.coefficients, node.args, strict=True):
                    total += weighed(numbers, c) * values[a]
            elif node.op is Op.MUL:
                total = 1
                for a, e in zip(node.args, node.exponents, strict=True):
                    total *= values[a] if e == 1 else powers.of(a, e)
            elif node.op is Op.SYM:
                total = sample.value(node)[0]
            else:
                total = numbers.fraction(node.number)
            values[node] = total
    except Undefined:
        return None
    return values


def weighed(numbers: Numbers, coefficient: Rational) -> Number:
    """A rational number as one of these; a whole one stays an int, which multiplies faster."""
    return coefficient if isinstance(coefficient, int) else numbers.fraction(coefficient)


class _Powers:
    """Integer powers of values; a pivot is divided by again and again, and inverted once."""

    def __init__(self, numbers: Numbers, values: Mapping[Expr, Number]) -> None:
        self.numbers, self.values = numbers, values
        self.inverses: dict[Expr, Number] = {}

    def of(self, node: Expr, exponent: int) -> Number:
        """The value of a node to a power; raises `Undefined` for a negative one of zero."""
        if exponent > 0:
            base = self.values[node]
        elif node in self.inverses:
            base = self.inverses[node]
        else:
            base = self.inverses[node] = self.numbers.inverse(self.values[node])
        return base if exponent in (1, -1) else base ** abs(exponent)


def _number_slopes(root: Expr, values: dict[Expr, Number], numbers: Numbers) -> dict[Expr, Number]:
    """The derivatives of a root that is made of sums and products, where they are not zero."""
    adjoints: dict[Expr, Number] = {root: 1}
    out: dict[Expr, Number] = {}
    raised = _Powers(numbers, values).of
    for node in reversed(outline(root).nodes):
        adjoint = adjoints.pop(node, 0)
        if not numbers.nonzero(adjoint):
            continue
        out[node] = adjoint
        if node.op is Op.ADD:
            for c, a in zip(node.coefficients, node.args, strict=True):
                adjoints[a] = adjoints.get(a, 0) + weighed(numbers, c) * adjoint
        elif node.op is Op.MUL:
            powers = [raised(a, e) for a, e in node.factors]
            for at, (a, e) in enumerate(node.factors):
                slope = adjoint if e == 1 else adjoint * e * raised(a, e - 1)
                for k, power in enumerate(powers):
                    if k != at:
                        slope *= power
                adjoints[a] = adjoints.get(a, 0) + slope
    return out


def values_of(
    nodes: Sequence[Expr], need: dict[Expr, int], sample: Assignment
) -> tuple[dict[Expr, Any], dict[Expr, Exception]]:
    """The values of the nodes (arguments first), and why others have none.

    A branch that is not taken may lack a value; what is built on a missing one is missing.
    """
    values: dict[Expr, Any] = {}
    failures: dict[Expr, Exception] = {}
    _add_values(values, failures, nodes, need, sample)
    return values, failures


def _add_values(
    values: dict[Expr, Any],
    failures: dict[Expr, Exception],
    nodes: Iterable[Expr],
    need: dict[Expr, int],
    sample: Assignment,
) -> None:
    algebra = sample.algebra
    for node in nodes:
        try:
            if failures:
                _check(node, values, failures, algebra)
            values[node] = node_value(node, values, sample, algebra, need[node])
        except (Undefined, Mixed) as failure:
            failures[node] = failure


class Incremental:
    """A relation at a point, evaluated again and again with little that is different.

    What does not rest on what has changed is computed once.
    """

    def __init__(self, root: Expr, sample: Assignment, n: int) -> None:
        self._root = root
        self._nodes, self._need = plan(root, n)
        self._values, self._failures = values_of(self._nodes, self._need, sample)
        self._users: dict[Expr, list[Expr]] = {}
        for node in self._nodes:
            for a in node.args:
                self._users.setdefault(a, []).append(node)

    def anew(self, changed: Iterable[Expr], sample: Assignment) -> Any:
        """The value of the root at a point that differs in these nodes; raises as `evaluate`."""
        above = set(changed)
        stack = list(above)
        while stack:
            for user in self._users.get(stack.pop(), ()):
                if user not in above:
                    above.add(user)
                    stack.append(user)
        values, failures = dict(self._values), dict(self._failures)
        for node in above:
            values.pop(node, None)
            failures.pop(node, None)
        ordered = sorted(above.intersection(self._need), key=lambda node: node.id)
        _add_values(values, failures, ordered, self._need, sample)
        if self._root in failures:
            raise failures[self._root]
        return values[self._root]


def _check(
    node: Expr, values: dict[Expr, Any], failures: dict[Expr, Exception], algebra: Any
) -> None:
    """Raise the failure of an argument that the node needs."""
    needed: tuple[Expr, ...] = node.args
    if node.op is Op.IF:
        needed = node.args[:1]
        if needed[0] not in failures:
            needed = (chosen(node, values, algebra),)
    for a in needed:
        if a in failures:
            raise failures[a]


def node_value(
    node: Expr, values: dict[Expr, Any], sample: Assignment, algebra: Values[Any], n: int
) -> Any:
    """The value of one node from those of its arguments."""
    op = node.op
    if op is Op.ADD:
        numbers = algebra.numbers
        return algebra.combine([(weighed(numbers, c), values[a]) for c, a in node.terms], n)
    if op is Op.MUL:
        return algebra.product([(values[a], e) for a, e in node.factors], n)
    if op is Op.SYM:
        return sample.value(node)
    if op is Op.NUM:
        return algebra.number(algebra.numbers.fraction(node.number))
    if op is Op.DER:
        return algebra.der(values[node.args[0]])
    if op is Op.INT:
        return algebra.integral(values[node.args[0]], sample.start(node.symbol))
    if op is Op.FN:
        if node.name == "pow" and node.args[1].op is Op.NUM:
            return algebra.rational(values[node.args[0]], node.args[1].number, n)
        return algebra.function(node.name, [values[a] for a in node.args], n)
    if op is Op.ROOT:
        return root_value(node, [values[a] for a in node.args], sample, n)
    if op is Op.IF:
        return values[chosen(node, values, algebra)]
    return algebra.number(int(holds(node, values, algebra)))


def chosen(node: Expr, values: dict[Expr, Any], algebra: Values[Any]) -> Expr:
    """The branch that an IF node takes."""
    condition, yes, no = node.args
    (truth,) = algebra.leads(values[condition])
    return yes if algebra.numbers.nonzero(truth) else no


def holds(node: Expr, values: dict[Expr, Any], algebra: Values[Any]) -> bool:
    """Whether a comparison or a logical node is true."""
    if node.op is Op.CMP:
        left, right = algebra.leads(*[values[a] for a in node.args])
        return compare(algebra.numbers, node.name, left, right)
    truths = [algebra.numbers.nonzero(x) for x in algebra.leads(*[values[a] for a in node.args])]
    if node.name == "not":
        return not truths[0]
    return all(truths) if node.name == "and" else any(truths)


# ------------------------------------------------------------------------------- reverse mode


def slopes(
    node: Expr, values: dict[Expr, Any], algebra: Algebra[Any, Any], n: int, jumps: bool
) -> list[tuple[Expr, Any]]:
    """The arguments of a node without memory, with its partial derivatives there.

    With `jumps` what a decision rests on has a slope as well.
    """
    args = node.args
    if node.op is Op.IF:
        return _slopes_of_choice(node, values, algebra, n, jumps)
    if jumps and node.op is Op.FN and node.name == "sign":
        return [(args[0], algebra.number(_JUMP))]
    if node.op is Op.ADD:
        return [(a, algebra.number(weighed(algebra.numbers, c))) for c, a in node.terms]
    if node.op is Op.MUL:
        out = []
        for at, (a, e) in enumerate(zip(args, node.exponents, strict=True)):
            factors = [
                (values[b], f - (k == at))
                for k, (b, f) in enumerate(zip(args, node.exponents, strict=True))
                if f != 1 or k != at
            ]
            slope = algebra.product(factors, n)
            out.append((a, slope if e == 1 else algebra.combine([(e, slope)], n)))
        return out
    if node.op is Op.FN:
        if node.name == "pow" and args[1].op is Op.NUM:
            exponent = args[1].number
            slope = algebra.rational(values[args[0]], exponent - 1, n)
            return [(args[0], algebra.combine([(algebra.numbers.fraction(exponent), slope)], n))]
        inner = [values[a] for a in args]
        return list(zip(args, algebra.slopes(node.name, inner, values[node], n), strict=True))
    if node.op is Op.ROOT:
        inner = [values[a] for a in args]
        found = root_slopes(node, values[node], inner, algebra, n)
        return list(zip(args, found, strict=True))
    if node.op is Op.CMP and jumps:
        return [(args[0], algebra.number(_JUMP)), (args[1], algebra.number(-_JUMP))]
    return [(a, algebra.number(_JUMP)) for a in args] if jumps else []


#: A decision has no derivative; its argument counts as seen, with this weight.
_JUMP = 0x5DEECE66D


def _slopes_of_choice(
    node: Expr, values: dict[Expr, Any], algebra: Algebra[Any, Any], n: int, jumps: bool
) -> list[tuple[Expr, Any]]:
    """The branch that is taken counts fully, the condition by what it changes."""
    taken = chosen(node, values, algebra)
    out = [(taken, algebra.number(1))]
    if not jumps:
        return out
    condition, yes, no = node.args
    other = no if taken is yes else yes
    if other not in values:
        out.append((condition, algebra.number(1)))
    elif not isinstance(algebra, Exponentials):
        out.append((condition, algebra.combine([(1, values[yes]), (-1, values[no])], n)))
    elif values[yes] != values[no]:
        out.append((condition, algebra.number(1)))
    return out


def pull(
    nodes: Sequence[Expr],
    need: dict[Expr, int],
    values: dict[Expr, Any],
    algebra: Algebra[Any, Any],
    adjoints: dict[Expr, Any],
    jumps: bool = False,
) -> None:
    """Carry adjoints from the roots, where `adjoints` holds some, down to every node below.

    With `jumps` what a decision rests on counts as having an influence.
    """

    vanishes, join = algebra.vanishes, algebra.join
    for node in reversed(nodes):
        adjoint = adjoints.get(node)
        if adjoint is None or not node.args or vanishes(adjoint):
            continue
        if node.op is Op.DER:
            parts = [(node.args[0], algebra.back_der(adjoint, values[node.args[0]]))]
        elif node.op is Op.INT:
            parts = [(node.args[0], algebra.back_integral(adjoint))]
        elif node.op is Op.ADD:
            numbers = algebra.numbers
            parts = [(a, algebra.times(adjoint, weighed(numbers, c))) for c, a in node.terms]
        else:
            found = slopes(node, values, algebra, need[node], jumps)
            parts = [(a, algebra.back(adjoint, slope, need[a])) for a, slope in found]
        for argument, part in parts:
            if not vanishes(part):
                known = adjoints.get(argument)
                adjoints[argument] = part if known is None else join(known, part)


class Forward:
    """The values below some roots at a point, of which each is to be differentiated by itself."""

    def __init__(self, roots: Sequence[Expr], sample: Sample) -> None:
        self.numbers: dict[Expr, Number] | None = None
        if isinstance(sample.algebra, Taylor):
            self.numbers = _numbers(tuple(roots), sample)
        if self.numbers is None:
            nodes = topological(roots)
            self.need = demands(nodes, roots, 1)
            self.values, self.failures = values_of(nodes, self.need, sample)

    def taken(self, roots: Sequence[Expr], algebra: Values[Any]) -> set[Side]:
        """The branches that the values of the roots come from."""
        if self.numbers is not None:
            return set()  # without a branch
        found: set[Side] = set()

        def inside(node: Expr) -> tuple[Expr, ...]:
            if node.op is not Op.IF:
                return node.args
            branch = chosen(node, self.values, algebra)
            found.add((node, branch is node.args[1]))
            return (node.args[0], branch)

        reached = set(roots)
        left = list(reached)
        for node in left:  # it grows as we go
            new = [arg for arg in inside(node) if arg not in reached]
            reached.update(new)
            left += new
        return found


def sensitivities(
    root: Expr, sample: Sample, jumps: bool = False, forward: Forward | None = None
) -> Sensitivity:
    """What the value of `root` depends on at a point, by reverse mode.

    With `jumps` what a decision rests on counts as having an influence.

    Signals and parameters are functions of time. An integral carries dependence on the past: it
    is followed at earlier points of the same plant, one more for each nested integral, with
    random weights. Raises like `evaluate`. What several roots share is computed once with a
    `forward` of them all.
    """
    forward = forward or Forward([root], sample)
    if isinstance(sample.algebra, Exponentials):
        while True:
            try:
                return _sensitivities(root, sample, jumps, forward)
            except Mixed as failure:
                if "cancel" not in str(failure) or sample.algebra.terms > 1 << 14:
                    raise
                sample.algebra.terms *= 4
    return _sensitivities(root, sample, jumps, forward)


def _decides(node: Expr) -> bool:
    """Whether the node's value rests on arguments that have no derivative here."""
    return node.op is Op.IF or (node.op is Op.FN and node.name in ("sign", "min", "max"))


def _static_sensitivities(root: Expr, values: dict[Expr, Number], numbers: Numbers) -> Sensitivity:
    """Of sums and products: what is seen is seen at once, and as long as it lasts."""
    found = _number_slopes(root, values, numbers)
    nodes = outline(root).nodes
    inside = outline(root).symbols
    orders = {v: 0 for v in inside if v in found and v.symbol.kind in KNOWN_SIGNALS}
    dead = frozenset(v for v in nodes if v not in found)
    lasting = frozenset(v for v in inside if v in found)
    return Sensitivity({v: v in found for v in inside}, orders, dead, (), lasting)


def _sensitivities(root: Expr, sample: Sample, jumps: bool, forward: Forward) -> Sensitivity:
    if forward.numbers is not None:
        return _static_sensitivities(root, forward.numbers, sample.algebra.numbers)
    nodes = outline(root).nodes
    integrals = [v for v in nodes if v.op is Op.INT]
    depth = integral_depth([root]) if integrals else 0
    algebra = sample.algebra
    alive: dict[Expr, None] = {}
    seen: dict[Expr, None] = {}
    orders: dict[Expr, int] = {}
    memory: dict[Expr, Number] = {}  # weight with which the past of an integral enters
    starts: dict[Symbol, None] = {}
    lasting: set[Expr] = set()
    for back in range(depth + 1):
        point = sample.earlier(back) if back else sample
        top = [root] if back == 0 else [v.args[0] for v in integrals if memory.get(v)]
        if not top:
            break
        below: Sequence[Expr]
        if back:
            below = topological(top)
            need = demands(below, top, 1)
            values, failures = values_of(below, need, point)
        else:
            below, need, values, failures = nodes, forward.need, forward.values, forward.failures
        for node in top:
            if node in failures:
                raise failures[node]
        adjoints: dict[Expr, Any] = {}
        if back == 0:
            adjoints[root] = algebra.seed(1)
        for node in integrals:
            weight = memory.get(node)
            if back and weight:
                part = algebra.seed(weight)
                known = adjoints.get(node.args[0])
                adjoints[node.args[0]] = part if known is None else algebra.join(known, part)
        pull(below, need, values, algebra, adjoints, jumps)
        for node, adjoint in adjoints.items():
            if algebra.vanishes(adjoint):
                continue
            alive[node] = seen[node] = None
            if node.op is Op.SYM and algebra.lasting(adjoint):
                lasting.add(node)
            if node.op is Op.INT and algebra.numbers.nonzero(algebra.start_of(adjoint)):
                share = algebra.start_of(adjoint) * (7919 + 2 * back)
                memory[node] = memory.get(node, 0) + share
                starts[node.symbol] = None
            elif node.op is Op.SYM and node.symbol.kind in KNOWN_SIGNALS:
                orders[node] = max(orders.get(node, -1), -1 if back else algebra.order(adjoint))
            elif jumps and _decides(node):
                alive.update(dict.fromkeys(topological(node.args)))
    depends = {v: v in seen for v in nodes if v.op is Op.SYM}
    orders = {v: orders[v] for v in nodes if v in orders}
    dead = frozenset(v for v in nodes if v not in alive)
    return Sensitivity(depends, orders, dead, tuple(starts), frozenset(lasting))


# ------------------------------------------------------ equations without a closed solution
#
# On a healthy plant the solution is known: it is the variable that the root stands for, and it has
# to solve the equation. Where a fault acts it is found between two numbers at which the equation
# has different signs.


class _Inside:
    """The sample on which the equation of a root is looked at."""

    def __init__(self, algebra: Any, values: Mapping[Expr, Any]) -> None:
        self.algebra = algebra
        self._values = values

    def value(self, symbol: Expr) -> Any:
        return self._values[symbol]

    def start(self, initial: Symbol) -> Number:
        raise Mixed("an integral inside a root")


def root_value(node: Expr, args: Sequence[Any], sample: Any, n: int) -> Any:
    """The root as a series: its value at the point, then one coefficient after the other.

    A sample of a field without a plant (it has no `truly`) gets a random number, as if an
    argument were free to make the equation true. Raises `Undefined` where no solution is found,
    `Mixed` for exponentials.
    """
    algebra = sample.algebra
    if not isinstance(algebra, Taylor):
        if isinstance(algebra, Exponentials) and not any(degree for _, degree in args):
            raise Undefined("a root of constants among exponentials")
        raise Mixed("an equation without a closed solution")
    root = node.root
    inside = dict(zip(root.places, args, strict=True))
    nodes = topological([root.zero])

    def zero(x: Series, size: int) -> tuple[Series, dict[Expr, Any]]:
        point = _Inside(algebra, {**inside, root.unknown: x})
        found, failures = values_of(nodes, dict.fromkeys(nodes, size), point)
        if root.zero in failures:
            raise failures[root.zero]
        return found[root.zero], found

    lead = _lead(node, [a[0] for a in args], sample, lambda x: zero([x], 1)[0][0])
    series = [lead]
    if n > 1 and any(len(a) > 1 for a in args):
        steep = tangent(root.zero, root.unknown, zero(series, 1)[1], algebra, 1)[0]
        factor = -algebra.numbers.inverse(steep)
        for k in range(1, n):
            value = zero(series, k + 1)[0]
            series.append(value[k] * factor if k < len(value) else 0)
    return series


def root_slopes(node: Expr, value: Any, args: Sequence[Any], algebra: Any, n: int) -> list[Any]:
    """The partial derivatives of a root, by the theorem of the implicit function."""
    root = node.root
    point = _Inside(algebra, {**dict(zip(root.places, args, strict=True)), root.unknown: value})
    nodes = topological([root.zero])
    found, failures = values_of(nodes, dict.fromkeys(nodes, n), point)
    if root.zero in failures:
        raise failures[root.zero]
    steep = tangent(root.zero, root.unknown, found, algebra, n)
    out = []
    for place in root.places:
        above = tangent(root.zero, place, found, algebra, n)
        out.append(algebra.combine([(-1, algebra.product([(above, 1), (steep, -1)], n))], n))
    return out


def tangent(root: Expr, wrt: Expr, values: dict[Expr, Any], algebra: Any, n: int) -> Any:
    """The partial derivative of an expression without D and Int, forwards."""
    tangents: dict[Expr, Any] = {wrt: algebra.number(1)}
    for node in topological([root]):
        if node is wrt or not any(a in tangents for a in node.args):
            continue
        if node not in values:
            continue  # on a side that is not taken
        parts = [
            (1, algebra.product([(slope, 1), (tangents[a], 1)], n))
            for a, slope in slopes(node, values, algebra, n, False)
            if a in tangents
        ]
        tangents[node] = algebra.combine(parts, n) if parts else algebra.number(0)
    return tangents.get(root, algebra.number(0))


# ---------------------------------------------------------------------- the value at the point


def _lead(node: Expr, leads: list[Number], sample: Any, zero: Callable[[Number], Number]) -> Number:
    """The solution at the point."""
    numbers: Numbers = sample.algebra.numbers
    truly = getattr(sample, "truly", None)
    if truly is None and not numbers.real:
        key = (node.root.zero, *leads)
        if key not in numbers.roots:
            numbers.roots[key] = numbers.any(Random(len(numbers.roots)))
        return numbers.roots[key]
    found: Number | None = truly(node.root.variable) if truly else None
    if found is not None and not numbers.nonzero(zero(found)):
        return found
    if truly and sample.healthy:
        raise Undefined("a variable of the plant that does not solve its equation")
    if not numbers.real:
        raise Mixed("an equation without a closed solution in a field")
    start = numbers.fraction(node.root.guess) if found is None else numbers.number(1) * found
    return zero_of(zero, start)


def solve(
    numbers: Numbers,
    zero: Expr,
    fixed: Mapping[Expr, Series],
    lines: Mapping[Expr, tuple[Number, Number]],
    outside: tuple[Number, Number],
    random: Random,
) -> Number:
    """A real number z at which `zero` + `outside` vanishes; raises `Undefined` without one.

    The symbols of `zero` are `fixed`, or straight `lines` in z: value at zero and slope, as
    `outside` is. Of several solutions a random one.
    """
    algebra = Taylor(numbers)
    nodes = topological([zero])
    need = dict.fromkeys(nodes, 1)

    def value(z: Number) -> Number:
        at = {symbol: [start + slope * z] for symbol, (start, slope) in lines.items()}
        found, failures = values_of(nodes, need, _Inside(algebra, {**fixed, **at}))
        if zero in failures:
            raise failures[zero]
        return found[zero][0] + outside[0] + outside[1] * z

    return zero_of(value, numbers.number(0), random)
