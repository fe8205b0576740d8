"""The functions that an expression may call, with their units."""

from __future__ import annotations

from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Pool, symbols
from bondgraph.ir.functions import FUNCTIONS, Function
from bondgraph.ir.syntax import Call, Expression, Text
from bondgraph.library.dimensions import Term
from bondgraph.passes.elaboration.expressions import Expressions, Place
from bondgraph.passes.elaboration.problems import Skip, fail, meant
from bondgraph.passes.elaboration.quantities import PURE, Quantities
from bondgraph.passes.elaboration.read_table import read_table
from bondgraph.passes.elaboration.scope import Typed
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_ALIASES = {f.spoken: name for name, f in FUNCTIONS.items() if f.spoken}

#: What is no function of numbers, or is written with others, and how many arguments it takes.
_OTHERS = {
    "int": (1, 2), "der": (1, 1), "delay": (2, 2), "table": (2, 3), "if": (3, 3), "hypot": (2, 2),
    "log10": (1, 1), "min": (2, 64), "max": (2, 64),
}  # fmt: skip


#: What other languages call functions, and how this one writes them.
_ELSEWHERE = {
    word: form
    for words, form in (
        ("integral integrate integ cumtrapz", "int(x)"),
        ("ddt d dt diff deriv derivative pre dot", "der(x)"),
        ("interp interp1 interp1d interp2 lookup table1d table2d spline", 'table("file.csv", x)'),
        ("ifelse iif cond where select switch", "if(condition, a, b)"),
        ("step heaviside", "if(x > 0, 1, 0)"),
        ("clip clamp sat saturate limit limiter", "min(max(x, low), high)"),
        ("sqr square", "x^2"),
        ("root", "sqrt(x)"),
        ("power", "x^n"),
        ("signedsqrt sqrtsigned", "ssqrt(x)"),
    )
    for word in words.split()
}


class Past(NamedTuple):
    """What a known signal `base` said some time ago: `age` in s."""

    base: Expr
    age: Expr
    origin: Span


def names() -> tuple[str, ...]:
    """Every function that can be called."""
    return tuple(sorted({*FUNCTIONS, *_ALIASES, *_OTHERS}))


def form(name: str) -> str:
    """How a function is called.

    >>> form("sin"), form("atan2"), form("if")
    ('sin(x)', 'atan2(x, y)', 'if(condition, a, b)')
    """
    special = {"if": "if(condition, a, b)", "table": 'table("file.csv", x)', "delay": "delay(x, T)"}
    name_ = _ALIASES.get(name, name)
    low, _ = _OTHERS.get(name_) or (len(FUNCTIONS[name_].slopes),) * 2
    return special.get(name, f"{name}({', '.join('xy'[:low])})")


class Calls(Expressions):
    """Converts expressions with calls of functions."""

    def __init__(self, pool: Pool, report: Report, quantities: Quantities) -> None:
        super().__init__(pool, report, quantities)
        #: integrals by integrand and initial value: the same integral is one state
        self.integrals: dict[tuple[Expr, Expr], tuple[Expr, Expr]] = {}
        self.integrands: dict[Expr, Expr] = {}
        self.origins: dict[Expr, Call] = {}
        self._names: dict[str, int] = {}
        self._tables: dict[tuple[str, str, int], str] = {}
        #: past values of known signals: whose and how old, where they are written
        self.past: dict[Expr, Past] = {}

    def call(self, call: Call, place: Place) -> Typed:
        """A call of any function."""
        name = _ALIASES.get(call.name, call.name)
        if name not in FUNCTIONS and name not in _OTHERS:
            other = _ELSEWHERE.get(call.name.lower())
            fail(self.report, "unknown-function", f"There is no function `{call.name}`.",
                 call.origin, help=f"Write `{other}`." if other else meant(call.name, names(),
                 'Write a product with `*`; a characteristic may come from a table: '
                 '`table("file.csv", x)`.', call.origin))  # fmt: skip
        low, high = _OTHERS.get(name) or (len(FUNCTIONS[name].slopes),) * 2
        if not low <= len(call.arguments) <= high:
            needs = f"{low}" if low == high else f"{low} to {high}"
            what = f"{needs} argument{'' if needs == '1' else 's'}"
            fail(self.report, "wrong-arguments", f"`{call.name}` takes {what}, not "
                 f"{len(call.arguments)}.", call.origin, help=f"Give it {what}.")  # fmt: skip
        match name:
            case "if":
                return self.choice(call, place)
            case "int":
                return self.integral(call, place)
            case "der":
                return self.derivative(call, place)
            case "table":
                return self.table(call, place)
            case "delay":
                return self.delay(call, place)
            case "min" | "max":
                return self.extreme(name, call, place)
            case "atan2" | "hypot" | "pow":
                return self.pair(name, call, place)
        node, term = self.quantity(call.arguments[0], place)
        record = FUNCTIONS["log" if name == "log10" else name]
        if record.unit is not None:
            self.defined(record, node, call)
            return self.pool.fn(name, node), self.raised(term, record.unit, call)
        what = f"`{call.name}` takes a pure number"
        if not self.quantities.pure(term, call.arguments[0].origin, what):
            raise Skip
        self.defined(record, node, call)
        if name == "log10":
            ten = self.pool.num(10)
            return self.pool.div(self.pool.fn("log", node), self.pool.fn("log", ten)), PURE
        return self.pool.fn(name, node), PURE

    def defined(self, record: Function, node: Expr, call: Call) -> None:
        """Refuse a number where the function has no real value."""
        if node.op is Op.NUM and not record.domain.holds(node.number):
            fail(self.report, "undefined-value", f"`{call.origin.text}` has no real value.",
                 call.origin, help="Change the argument; `ssqrt` and `cbrt` take negative numbers."
                 )  # fmt: skip

    def choice(self, call: Call, place: Place) -> Typed:
        """`if(condition, a, b)`."""
        condition = self.condition(call.arguments[0], place)
        a, s = self.convert(call.arguments[1], place)
        b, t = self.convert(call.arguments[2], place)
        if (s is None) != (t is None):
            fail(self.report, "wrong-type", "One value of this `if` is a number, the other true or "
                 "false.", call.origin, help="Both must be of one type.")  # fmt: skip
        if s is not None and t is not None:
            self.alike(s, t, call.origin, "both values of an `if` have one unit")
        if condition.op is Op.NUM:
            return (b, t) if condition is self.pool.zero else (a, s)
        if s is None:
            pool = self.pool
            yes, no = self.both(condition, a), self.both(pool.logic("not", condition), b)
            return self.either(yes, no), None
        assert t is not None
        return self.pool.choose(condition, a, b), t if s.unknown else s

    def both(self, a: Expr, b: Expr) -> Expr:
        """`a and b` where b may be known."""
        if b.op is Op.NUM:
            return a if b is self.pool.one else b
        return self.pool.logic("and", a, b)

    def either(self, a: Expr, b: Expr) -> Expr:
        """`a or b` where either may be known."""
        for one, other in ((a, b), (b, a)):
            if one.op is Op.NUM:
                return one if one is self.pool.one else other
        return self.pool.logic("or", a, b)

    def extreme(self, name: str, call: Call, place: Place) -> Typed:
        """`min` and `max` of two or more."""
        node, term = self.quantity(call.arguments[0], place)
        for argument in call.arguments[1:]:
            other, t = self.quantity(argument, place)
            self.alike(term, t, call.origin, f"the arguments of `{name}` have one unit")
            term = t if term.unknown else term
            node = self.pool.fn(name, node, other)
        return node, term

    def pair(self, name: str, call: Call, place: Place) -> Typed:
        """Functions of two arguments."""
        a, s = self.quantity(call.arguments[0], place)
        b, t = self.quantity(call.arguments[1], place)
        if name == "pow":
            return self.power((a, s), (b, t), call)
        self.alike(s, t, call.origin, f"the arguments of `{name}` have one unit")
        if name == "atan2":
            return self.pool.fn("atan2", a, b), PURE
        square = self.pool.add((1, self.pool.power(a, 2)), (1, self.pool.power(b, 2)))
        return self.pool.fn("sqrt", square), s

    def derivative(self, call: Call, place: Place) -> Typed:
        """`der(x)`."""
        node, term = self.quantity(call.arguments[0], place)
        result = self.quantities.differentiated(term)
        if node.kind is Kind.INTEGRAL:
            return self.integrands[node], result
        return self.pool.der(node), result

    def integral(self, call: Call, place: Place) -> Typed:
        """`int(x, x0)`: a state of its own; written twice it is the same one."""
        node, term = self.quantity(call.arguments[0], place)
        result: Term = self.quantities.integrated(term)
        start = self.pool.zero
        if len(call.arguments) == 2:
            start, t = self.quantity(call.arguments[1], place)
            self.alike(result, t, call.arguments[1].origin,
                          "an initial value has the unit of the integral")  # fmt: skip
            if not self.constant(start):
                fail(self.report, "not-constant", "An initial value cannot depend on signals.",
                     call.arguments[1].origin, help="Use numbers and params.")  # fmt: skip
        if node is self.pool.zero:
            return start, result
        known = self.integrals.get((node, start))
        if known is None:
            name = self.unique(f"{place.owner}.int")
            known = (
                self.pool.symbol(name, Kind.INTEGRAL),
                self.pool.symbol(f"{name}.x0", Kind.INITIAL),
            )
            self.integrals[node, start] = known
            self.integrands[known[0]] = node
            self.origins[known[0]] = call
        return known[0], result

    def delay(self, call: Call, place: Place) -> Typed:
        """`delay(x, T)` of known signals: each is another signal, its own past."""
        node, term = self.quantity(call.arguments[0], place)
        age = self.age(call.arguments[1], place)
        mapping: dict[Expr, Expr] = {}
        for symbol in symbols(node):
            if symbol.kind in CONSTANTS:
                continue
            if symbol.kind not in (Kind.INPUT, Kind.READING):
                what = symbol.symbol.name.rpartition(".int")[0] or symbol.symbol.name
                fail(self.report, "delay-inside", f"`{what}` is no known signal: only what is "
                     "logged has a past that can be looked up.", call.origin,
                     help="Delay the whole of what a sensor reads, `sensor y = delay(x, T)`, the "
                     "reading of a sensor, or an input that is a number.")  # fmt: skip
            before = self.past.get(symbol)
            base, ages = (symbol, age) if before is None else (
                before.base, self.pool.add((1, before.age), (1, age)))  # fmt: skip
            own = self.pool.symbol(f"delay({base.symbol.name}, {ages})", symbol.symbol.kind)
            mapping[symbol] = own
            self.past.setdefault(own, Past(base, ages, call.origin))
        return self.pool.substitute([node], mapping)[0], term

    def age(self, argument: Expression, place: Place) -> Expr:
        """The second argument of `delay`: a time that no fault changes."""
        age, term = self.quantity(argument, place)
        self.alike(term, self.quantities.seconds, argument.origin, "a delay is a time")
        if any(s.kind is not Kind.CONST for s in symbols(age)):
            fail(self.report, "delay-time", f"`{argument.origin.text}` may change: a delay is a "
                 "number.", argument.origin, help="Write a number, or declare it `const`."
                 )  # fmt: skip
        return age

    def unique(self, name: str) -> str:
        """The name, with a number from its second use on."""
        number = self._names[name] = self._names.get(name, 0) + 1
        return name if number == 1 else f"{name}_{number}"

    def table(self, call: Call, place: Place) -> Typed:
        """`table("file.csv", x)` or `(..., x, y)`: piecewise linear; its units are not known."""
        file, *inputs = call.arguments
        if not isinstance(file, Text):
            fail(self.report, "wrong-type", "The first argument of `table` is a file name in "
                 "quotes.", file.origin, help='Write `table("file.csv", x)`.')  # fmt: skip
        nodes = [self.quantity(argument, place)[0] for argument in inputs]
        source = place.scope.definition.source
        key = (source.path, file.value, len(nodes))
        name = self._tables.get(key)
        if name is None:
            rows = read_table(file, len(nodes), source, self.report)
            wish = name = file.value.rstrip("'")  # which mark a table read backwards
            while name in self.pool.tables and self.pool.tables[name] != rows:
                name = self.unique(wish)
            self.pool.tables[name] = rows
            self._tables[key] = name
        term = self.quantities.dimensions.fresh(call.origin, f'table("{file.value}")')
        return self.pool.fn(f"table:{name}", *nodes), term
