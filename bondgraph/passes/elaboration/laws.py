"""The laws of the elements: linear defaults, coefficients, equations in braces, power balance."""

from __future__ import annotations

import re

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols
from bondgraph.ir.graph import Law
from bondgraph.ir.nodes import first_degree, occurs
from bondgraph.ir.syntax import Equation, Node, Number, Part, Ref
from bondgraph.library.dimensions import Term
from bondgraph.library.elements import ElementKind
from bondgraph.passes.elaboration.expressions import Place
from bondgraph.passes.elaboration.problems import Skip, fail, listed
from bondgraph.passes.elaboration.quantities import PURE
from bondgraph.passes.elaboration.scope import (
    Array,
    Bound,
    NodeEntry,
    PortVariables,
    Typed,
    ValueEntry,
)
from bondgraph.passes.elaboration.values import Values
from bondgraph.text.diagnostic import Edit, Label, Remedy, Report, replacing
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: The variables that the relations of a two-port relate: those of one, those of the other.
_Pairs = tuple[tuple[Expr, Expr], tuple[Expr, Expr]]


class Coefficient(NamedTuple):
    """A written coefficient with a tolerance: a constant of its own."""

    node: NodeEntry
    symbol: Expr
    value: Expr
    term: Term


class Read(NamedTuple):
    """An equation of a law as it was read; the dimensions of its sides, unless one is zero."""

    law: Law
    sides: tuple[Term, Term] | None


class Laws:
    """Converts what is written of an element into its laws."""

    def __init__(self, values: Values) -> None:
        self.values = values
        self.pool: Pool = values.pool
        self.report: Report = values.report
        self.coefficients: list[Coefficient] = []
        #: Elements whose coefficient is written as a number other than zero.
        self.nameless: list[NodeEntry] = []
        #: Passive one-ports with a linear law, and e/f, q/e or p/f of it.
        self.linear_ones: list[tuple[NodeEntry, Expr]] = []

    def laws(self, node: NodeEntry) -> tuple[Law, ...]:
        """All laws of an element; raises Skip when they are wrong."""
        element, written = node.element, node.declaration
        assert element is not None and written is not None
        if element.kind in ("De", "Df"):
            if written.law is not None:
                fail(self.report, "law-not-allowed", f"A detector has no law: `{written.type}:"
                     f"{node.name}` reads its junction.", written.law.origin,
                     help="Measure an expression with `sensor name = ...`.")  # fmt: skip
            return ()
        if written.law is not None:
            if written.value is not None:
                fail(self.report, "law-twice", f"`{written.type}:{node.name}` has a coefficient "
                     "and a law.", Label(written.value.origin, "the coefficient"),
                     Label(written.law.origin, "the law"), help="Keep one of them.")  # fmt: skip
            laws = self.written(node, element, written)
        else:
            if not element.coefficient:
                self.no_relation(node, element, written)
            laws = self.linear(node, element, written)
        if element.modulated:
            self.modulation(node, element, laws, written.origin)
        return laws

    def modulation(
        self, node: NodeEntry, element: ElementKind, laws: tuple[Law, ...], origin: Span
    ) -> None:
        """Say where an M stands for nothing: no law holds a signal of another element."""
        own = {v for p in node.ports for v in (p.effort, p.flow, p.state)}
        others = [s for law in laws for s in symbols(law.zero) if s not in own]
        if all(self.values.constant(s) for s in others):
            self.report.info(
                "not-modulated", f"`{node.type}:{node.name}` is driven by no signal.", origin,
                help=f"`{element.kind}` says the same of what does not change.",
            )  # fmt: skip

    def no_relation(self, node: NodeEntry, element: ElementKind, written: Node) -> None:
        """A transformer must say in which direction its modulus goes, an IC what it is."""
        name = node.name
        if element.kind == "IC":
            fail(self.report, "missing-relation", f"`IC:{name}` states no relation.",
                 written.origin, help="It has no default. Write its ports and a law for each in "
                 f"braces, as in `{{ port el; port gap; {element.law}; ... }}`.")  # fmt: skip
        end = written.name.origin.end
        behind = Span(written.origin.source, end, end)
        laws = [f"{{ f1 = {name}*f2 }}", f"{{ f2 = {name}*f1 }}"]
        edits = tuple([Edit(f"write `{law}`", ((behind, f" {law}"),)) for law in laws])
        help = Remedy(
            "Books differ on what the modulus of a transformer is, so write it: "
            f"`{written.type}:{name} {laws[0]}` or `{laws[1]}`; port 1 is where a bond enters.",
            edits,
        )
        fail(self.report, "missing-relation", f"`{written.type}:{name}` states no relation.",
             written.origin, help=help)  # fmt: skip

    # ------------------------------------------------------------------ coefficients

    def coefficient(self, node: NodeEntry, element: ElementKind, written: Node
                    ) -> tuple[Expr, Term]:  # fmt: skip
        """The value after `=`, or the one that has the name of the element."""
        values = self.values
        place = Place(node.scope, node.env, node.path)
        if written.value is not None:
            value = values.quantity(written.value, place)
            bound = Bound(written.value, node.scope, node.env, written.value.origin)
            is_number = value[0].op is Op.NUM and value[0] is not self.pool.zero
            if is_number and next(values.mentioned(bound), None) is None:
                self.nameless.append(node)
            return value if written.tolerance is None else self.uncertain(node, written, value)
        named = node.scope.values.get(node.name)
        entry = named.entries.get(node.place or 0) if isinstance(named, Array) else named
        if not isinstance(entry, ValueEntry) or entry.kind == "detector":
            scope = node.scope
            if node.name in scope.wrong or scope.incomplete:
                raise Skip
            if isinstance(named, Array):
                part = Part(node.name, None, None, written.name.origin)
                if node.place is None:
                    values.lookup.indexed(part, named, scope, node.env)
                values.lookup.out_of_range(part, named, node.place or 0)
            fail(self.report, "missing-value", f"`{written.type}:{node.name}` has no "
                 f"{element.coefficient}: there is no value `{node.name}`.", written.origin,
                 help=f"Declare `param {node.name} = ...`, or write `{written.type}:{node.name} = "
                 f"...`, or a law in braces, `{{ {element.law} }}`.")  # fmt: skip
        values.used.add(entry)
        node_, term = values.received(entry)
        if term is None:
            fail(self.report, "wrong-type", f"`{node.name}` is true or false: a number is needed "
                 "here.", written.origin, help="Use a number.")  # fmt: skip
        return node_, term

    def uncertain(self, node: NodeEntry, written: Node, value: tuple[Expr, Term]
                  ) -> tuple[Expr, Term]:  # fmt: skip
        """A coefficient with a tolerance becomes a constant with a name."""
        expr, term = value
        assert written.tolerance is not None
        if not self.values.constant(expr):
            fail(self.report, "not-constant", "A value that depends on signals has no tolerance.",
                 written.tolerance.origin, help="Give the tolerance to a `param`.")  # fmt: skip
        if expr.op is Op.NUM:
            symbol = self.pool.symbol(f"{node.path}.value", Kind.CONST)
            self.coefficients.append(Coefficient(node, symbol, expr, term))
            return symbol, term
        # the params in it stay as they are: what is uncertain is a factor of one
        symbol = self.pool.symbol(f"{node.path}.factor", Kind.CONST)
        self.coefficients.append(Coefficient(node, symbol, self.pool.one, PURE))
        return self.pool.mul(symbol, expr), term

    def linear(self, node: NodeEntry, element: ElementKind, written: Node) -> tuple[Law, ...]:
        """R e = R f, C q = C e, I p = I f, GY, sources."""
        pool, values = self.pool, self.values
        k, term = self.coefficient(node, element, written)
        origin = written.origin
        port = node.ports[0]
        e, f = self.pair(port)
        if element.kind in ("Se", "Sf"):
            return (self.source(node, element, k, term, origin),)
        if element.kind == "GY":
            other = node.ports[1]
            e2, f2 = self.pair(other)
            what = f"the ratio of `{node.local}` is effort over flow"
            self.values.alike(values.quotient(e, f2), term, origin, what)
            self.values.alike(values.quotient(e2, f), term, origin, what)
            return (
                Law(pool.sub(port.effort, pool.mul(k, other.flow)), None, origin),
                Law(pool.sub(other.effort, pool.mul(k, port.flow)), None, origin),
            )
        self.linear_ones.append((node, k))
        if element.kind == "R":
            self.values.alike(values.quotient(e, f), term, origin,
                              f"the resistance of `{node.local}` is effort over flow")  # fmt: skip
            return (Law(pool.sub(port.effort, pool.mul(k, port.flow)), None, origin),)
        assert port.state is not None
        cause, effect = (port.effort, e) if element.kind == "C" else (port.flow, f)
        stored = values.quantities.integrated(f if element.kind == "C" else e)
        what = "q over e" if element.kind == "C" else "p over f"
        self.values.alike(values.quotient(stored, effect), term, origin,
                          f"the {element.coefficient} of `{node.local}` is {what}")  # fmt: skip
        return (Law(pool.sub(port.state, pool.mul(k, cause)), None, origin),)

    def source(self, node: NodeEntry, element: ElementKind, value: Expr, term: Term, origin: Span
               ) -> Law:  # fmt: skip
        """A source: `e - value` or `f - value`."""
        port = node.ports[0]
        e, f = self.pair(port)
        fixed, own = (port.effort, e) if element.kind == "Se" else (port.flow, f)
        what = f"an {element.coefficient}" if element.kind == "Se" else "a flow"
        self.values.alike(own, term, origin, f"source `{node.local}` gives {what}")
        return Law(self.pool.sub(fixed, value), fixed, origin)

    def pair(self, port: PortVariables) -> tuple[Term, Term]:
        """The dimensions of a port; raises Skip when it is not connected."""
        if port.slot < 0:
            raise Skip
        return self.values.quantities.pair(port.slot)

    def local(self, node: NodeEntry) -> dict[str, Typed]:
        """The names that the law may use of its own ports."""
        names: dict[str, Typed] = {}
        quantities = self.values.quantities
        fixed = node.element is not None and [p.name for p in node.ports] == list(
            node.element.ports
        )
        for port in node.ports:
            e, f = self.pair(port)
            own: list[tuple[str, Expr, Term]] = [("e", port.effort, e), ("f", port.flow, f)]
            if port.state is not None:
                own.append((port.stores, port.state,
                            quantities.integrated(f if port.stores == "q" else e)))  # fmt: skip
            for name, variable, term in own:
                key = f"{name}{port.name}" if fixed else f"{port.name}.{name}"
                names[key] = (variable, term)
        return names

    def written(self, node: NodeEntry, element: ElementKind, written: Node) -> tuple[Law, ...]:
        """The equations in the braces of an element."""
        law = written.law
        assert law is not None
        if law.ports and not element.fields:
            fail(self.report, "ports-not-allowed", f"A {written.type} has fixed ports.",
                 law.ports[0].origin, help="Only R, C, I and IC can be fields with named ports."
                 )  # fmt: skip
        for port in node.ports:
            if element.states and not port.stores:
                of = f"{port.name}." if port.name else ""
                fail(self.report, "storage-unclear", f"`{written.type}:{node.name}` does not say "
                     f"what {f'port `{port.name}`' if port.name else 'it'} stores.", law.origin,
                     help=f"Its laws use either `{of}q` (displacement, charge: q' = f) or `{of}p` "
                     "(momentum, flux: p' = e).")  # fmt: skip
        local = self.local(node)
        place = Place(node.scope, node.env, node.path, local)
        read = [self.equation(q, place, local, node, element) for q in law.equations]
        if element.kind in ("TF", "GY"):
            return self.two_port(node, element, read, written)
        for one in read:
            self.one_unit(node, one)
        found = [one.law for one in read]
        self.note_linear(node, element, found)
        if len(found) != len(node.ports):
            ports = len(node.ports)
            need = "one equation" if ports == 1 else f"{ports} equations, one a port"
            fail(self.report, "wrong-law-count", f"`{written.type}:{node.name}` needs {need}, not "
                 f"{len(found)}.", law.origin, help="Each port has two variables, of which one "
                 "follows from the other." if ports == 1 else "Write one equation for each port."
                 )  # fmt: skip
        return tuple(found)

    def equation(
        self, equation: Equation, place: Place, local: dict[str, Typed], node: NodeEntry,
        element: ElementKind,
    ) -> Read:  # fmt: skip
        """`left = right`; solved for a port variable where the left side is just that."""
        values = self.values
        left, s = values.quantity(equation.left, place)
        right, t = values.quantity(equation.right, place)
        zero = _is_zero(equation.left) or _is_zero(equation.right)
        expr = right if left is self.pool.zero else self.pool.sub(left, right)
        own = [v for v, _ in local.values()]
        present = symbols(expr)
        if not any(v in present for v in own):
            names = [*local]
            fail(self.report, "law-without-variable", "This law contains none of the element's own "
                 "variables.", equation.origin, help=f"The law of `{node.type}:{node.name}` "
                 f"relates {listed(names)}.")  # fmt: skip
        solved = isinstance(equation.left, Ref) and any(left is v for v in own)
        if element.kind in ("Se", "Sf"):
            port = node.ports[0]
            fixed, other = (port.effort, port.flow) if element.kind == "Se" else (
                port.flow, port.effort)  # fmt: skip
            if left is not fixed or occurs(fixed, right) or occurs(other, right):
                letter = element.variables[0]
                fail(self.report, "wrong-variable", f"`{node.type}:{node.name}` fixes its "
                     f"{element.coefficient}: its law is `{letter} = ...`.", equation.origin,
                     help=f"Write `{node.type}:{node.name} {{ {letter} = ... }}`; a relation "
                     "between effort and flow is an `R`.")  # fmt: skip
        direction = left if solved and not occurs(left, right) else None
        law = Law(expr, direction, equation.origin)
        return Read(law, None if zero else (s, t))

    def one_unit(self, node: NodeEntry, read: Read) -> None:
        """Require one unit of both sides."""
        if read.sides is not None:
            what = f"both sides of the law of `{node.local}` have one unit"
            self.values.alike(*read.sides, read.law.origin, what)

    def note_linear(self, node: NodeEntry, element: ElementKind, found: list[Law]) -> None:
        """Note the coefficient of a law in braces that is linear with constants."""
        port = node.ports[0]
        if len(node.ports) != 1 or len(found) != 1 or element.kind not in ("R", "C", "I"):
            return
        cause, effect = {
            "R": (port.effort, port.flow), "C": (port.state, port.effort),
            "I": (port.state, port.flow),
        }[element.kind]  # fmt: skip
        own = symbols(found[0].zero)
        if cause is None or not {cause, effect} <= {*own}:
            return
        parts = linear(self.pool, found[0].zero, (cause, effect))
        if parts is None or parts[0] is self.pool.zero:
            return
        coefficient = self.pool.neg(self.pool.div(parts[1], parts[0]))
        if self.values.constant(coefficient):
            self.linear_ones.append((node, coefficient))

    def hold(self, node: NodeEntry, laws: tuple[Law, ...]) -> None:
        """Refuse a law that a variable of its own element drops out of: e = e*f says e = 0 too."""
        own = [v for p in node.ports for v in (p.effort, p.flow, p.state) if v is not None]
        for law in laws:
            for variable in own:
                terms = law.zero.terms
                if law.zero is not variable and all(_has_factor(t, variable) for _, t in terms):
                    name = variable.symbol.name
                    fail(self.report, "law-cancels", f"The law of `{node.type}:{node.name}` has "
                         f"`{name}` in each of its terms, so that it cancels.", law.origin,
                         help=f"It would hold for `{name}` = 0 whatever the rest is. Divide it by "
                         f"`{name}`, or let another signal be the coefficient.")  # fmt: skip

    def two_port(
        self, node: NodeEntry, element: ElementKind, read: list[Read], written: Node
    ) -> tuple[Law, ...]:
        """One stated relation; the other follows from e1*f1 = e2*f2.

        Power is looked at before units: relations that do not conserve it have odd ones, too.
        """
        assert written.law is not None
        found = [one.law for one in read]
        if len(found) not in (1, 2):
            fail(self.report, "wrong-law-count", f"`{written.type}:{node.name}` needs one relation "
                 f"(the other follows from power conservation), not {len(found)}.",
                 written.law.origin, help=f"Write `{{ {element.law} }}`.")  # fmt: skip
        one, two = node.ports
        if element.kind == "TF":
            pairs = ((one.flow, two.flow), (one.effort, two.effort))
        else:
            pairs = ((one.effort, two.flow), (one.flow, two.effort))
        law = found[0]
        other = self.follows(node, law, pairs)
        if other is None:
            names = ("f1 = m*f2", "e1 = m*e2") if element.kind == "TF" else (
                "e1 = k*f2", "e2 = k*f1")  # fmt: skip
            fail(self.report, "not-a-relation", "This does not relate the two sides of "
                 f"`{written.type}:{node.name}` by a factor.", law.origin, help="Write "
                 f"`{{ {names[0]} }}` or `{{ {names[1]} }}`, with any expression for the factor; a "
                 "general two-port is an `R` field with two named ports.")  # fmt: skip
        if len(found) == 2 and not self.same(other, found[1], pairs):
            help: str | Remedy = "Leave the second one out, it follows from e1*f1 = e2*f2."
            second = _exchanged(law.origin.text)
            if second is not None:
                words = f"What follows from e1*f1 = e2*f2 is `{second}`: write that, or nothing."
                help = replacing(found[1].origin, second, words)
            fail(self.report, "power-not-conserved", f"The two relations of `{written.type}:"
                 f"{node.name}` do not conserve power: the second does not follow from the first.",
                 found[1].origin, Label(law.origin, "the first"), help=help)  # fmt: skip
        for relation in read:
            self.one_unit(node, relation)
        self.conserve(node, law)
        return law, found[1] if len(found) == 2 else other

    def follows(self, node: NodeEntry, law: Law, pairs: _Pairs) -> Law | None:
        """The relation that follows from a stated one by e1*f1 = e2*f2; None for no relation."""
        present = [v for v in symbols(law.zero) if v in (*pairs[0], *pairs[1])]
        for (a, b), (c, d) in (pairs, pairs[::-1]):
            if all(v in (a, b) for v in present) and len(present) == 2:
                parts = linear(self.pool, law.zero, (a, b))
                if parts is None:
                    return None
                # A a + B b = 0 with power a c' = b d' gives A d + B c = 0 (roles exchanged)
                zero = self.pool.add(
                    (1, self.pool.mul(parts[0], d)), (1, self.pool.mul(parts[1], c))
                )
                direction = d if law.direction is a else c if law.direction is b else None
                return Law(zero, direction, law.origin)
        return None

    def same(self, one: Law, other: Law, pairs: _Pairs) -> bool:
        """Whether two relations relate the same two variables by the same factor."""
        for pair in pairs:
            a, b = (linear(self.pool, law.zero, pair) for law in (one, other))
            if a is not None and b is not None:
                return self.pool.mul(a[0], b[1]) is self.pool.mul(a[1], b[0])
        return False

    def conserve(self, node: NodeEntry, law: Law) -> None:
        """The units of the relation that follows: e1*f1 = e2*f2 in power."""
        one, two = (self.pair(p) for p in node.ports)
        values = self.values
        self.values.alike(
            values.product(one[0], one[1]), values.product(two[0], two[1]), law.origin,
            f"`{node.local}` conserves power, effort times flow",
        )  # fmt: skip


def linear(pool: Pool, expr: Expr, pair: tuple[Expr, Expr]) -> tuple[Expr, Expr] | None:
    """The factors (A, B) of `expr` = A a + B b, None where it is no such sum."""
    nothing = {pair[0]: pool.zero, pair[1]: pool.zero}
    try:
        if pool.substitute([expr], nothing)[0] is not pool.zero:
            return None
    except ZeroDivisionError:  # one divided by the other
        return None
    first = pool.substitute([expr], {pair[0]: pool.one, pair[1]: pool.zero})[0]
    second = pool.substitute([expr], {pair[0]: pool.zero, pair[1]: pool.one})[0]
    if first is pool.zero or second is pool.zero or not first_degree(expr, pair, choices=False):
        return None
    return first, second


def _exchanged(relation: str) -> str | None:
    """The relation of a two-port that follows from another one, by e1*f1 = e2*f2.

    >>> _exchanged("e1 = k*f2"), _exchanged("f1 = m*f2")
    ('e2 = k*f1', 'e2 = m*e1')
    """
    variable = r"(?<![\w.])[ef][12]\b"
    own = sorted(set(re.findall(variable, relation)))
    if len(own) != 2:
        return None
    partner = {"e1": "f1", "f1": "e1", "e2": "f2", "f2": "e2"}  # they make a power
    to = {own[0]: partner[own[1]], own[1]: partner[own[0]]}
    return re.sub(variable, lambda found: to[found[0]], relation)


def _is_zero(expr: object) -> bool:
    return isinstance(expr, Number) and expr.value == 0 and expr.unit is None


def _has_factor(term: Expr, variable: Expr) -> bool:
    """Whether a term is the variable times something."""
    return any(a is variable and e > 0 for a, e in term.scaled[1].factors)
