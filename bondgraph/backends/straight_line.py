"""The statements of a block over variables only, with numbers for coefficients.

Each is a sum of numbers times variables, a product or quotient of two, or a function of one. What
is a number is computed here, what is only another name is replaced, and a product of a number and a
variable that two sums share has a name of its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import TypeAlias

from bondgraph.ir.functions import SIGNED_ROOT
from bondgraph.ir.program import (
    Assign,
    Assignment,
    Choice,
    Compare,
    Const,
    Expression,
    Function,
    Product,
    Ref,
    Sum,
)
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Unrepresentable(Exception):
    """What whole numbers cannot do, or not provably: why, where in the model, and what to do."""

    def __init__(self, why: str, origin: Span | None = None, remedy: str = "") -> None:
        self.why, self.origin, self.remedy = why, origin, remedy
        super().__init__(why)


class Term(NamedTuple):
    """A number times a variable; `name` is that of the coefficients in the number."""

    number: float
    variable: Ref
    name: str


class Linear(NamedTuple):
    """`target` = the sum of the terms + `constant`."""

    target: Ref
    terms: tuple[Term, ...]
    constant: float
    comment: str
    origin: Span | None


class Binary(NamedTuple):
    """`target` = left times right, or left over right, by `what`."""

    target: Ref
    what: str
    left: Ref
    right: Ref
    comment: str
    origin: Span | None


class Call(NamedTuple):
    """`target` = a function of a variable."""

    target: Ref
    function: str
    argument: Ref
    comment: str
    origin: Span | None


Operation: TypeAlias = Linear | Binary | Call


class _Sum(NamedTuple):
    """A sum on its way: terms by variable, each with the name of its number."""

    terms: dict[Ref, tuple[float, str]]
    constant: float = 0.0
    name: str = ""

    @property
    def variable(self) -> Ref | None:
        """The variable that it is, if it is nothing else."""
        if self.constant or len(self.terms) != 1:
            return None
        [(ref, (number, _))] = self.terms.items()
        return ref if number == 1.0 else None


def straight_line(
    statements: Sequence[Assignment], coefficients: Mapping[Ref, float], part: str = "part"
) -> tuple[Operation, ...]:
    """The operations in order; raises `Unrepresentable` for what they have no form for.

    Intermediate values that have no name are called `part` with a number.

    >>> x, y, b = Ref("known", "x"), Ref("local", "y"), Ref("coef", "b")
    >>> value = Sum(((True, Product((Const(2.0), b, x))), (False, x)))
    >>> [one] = straight_line([Assign(Ref("residual", "r"), value, "", None)], {b: 3.0})
    >>> one.terms
    (Term(number=5.0, variable=Ref(space='known', name='x', order=0), name='b'),)
    """
    return tuple(_read(_shared(_Writer(coefficients, part).run(statements))))


def operands(operation: Operation) -> tuple[Ref, ...]:
    """The variables that an operation reads."""
    if isinstance(operation, Linear):
        return tuple(t.variable for t in operation.terms)
    if isinstance(operation, Binary):
        return operation.left, operation.right
    return (operation.argument,)


class _Writer:
    """Makes operations of statements; `known` has what a name stands for so far."""

    def __init__(self, coefficients: Mapping[Ref, float], part: str) -> None:
        self.part = part
        self.known: dict[Ref, _Sum] = {
            ref: _Sum({}, number, ref.name) for ref, number in coefficients.items()
        }
        self.found: list[Operation] = []
        self.comment = ""
        self.origin: Span | None = None

    def run(self, statements: Sequence[Assignment]) -> list[Operation]:
        states: dict[Ref, _Sum] = {}  # that are a number so far
        for statement in statements:
            if not isinstance(statement, Assign):
                raise Unrepresentable("has a choice of two computations", statement.origin)
            self.comment, self.origin = statement.comment, statement.origin
            target, value = statement.target, self._sum(statement.value)
            alias = value.variable is not None and value.variable.space != "state"
            if target.space == "local" and self._renamed(value.variable, target):
                continue
            states.pop(target, None)
            if not value.terms and target.space == "state":
                self.known[target] = states[target] = value
            elif target.space == "local" and (alias or not value.terms):
                self.known[target] = value
            else:
                self.known.pop(target, None)
                self._put(target, value)
        for state, value in states.items():
            self._put(state, value)
        return self.found

    def _put(self, target: Ref, value: _Sum) -> None:
        if self._renamed(value.variable, target):
            return
        terms = tuple(
            Term(number, ref, name) for ref, (number, name) in value.terms.items() if number
        )
        self.found.append(Linear(target, terms, value.constant, self.comment, self.origin))

    def _renamed(self, temporary: Ref | None, target: Ref) -> bool:
        """Whether a target is a temporary that was just made for it, and now has its name."""
        last = self.found[-1] if self.found else None
        if temporary is None or last is None or last.target != temporary:
            return False
        if temporary.name[-1] != "'":
            return False
        self.found[-1] = last._replace(target=target)
        return True

    def _sum(self, node: Expression) -> _Sum:
        match node:
            case Const():
                return _Sum({}, node.value)
            case Ref():
                if node.space == "total":
                    raise Unrepresentable(
                        f"counts the encoder `{node.name}` since the start", self.origin
                    )
                return self.known.get(node, _Sum({node: (1.0, "")}))
            case Sum():
                return self._added(node)
            case Product():
                return self._product(node)
            case Function():
                return self._function(node)
            case Choice(Compare("<", left, right), yes, no):
                low, high = self._sum(left), self._sum(right)
                if low.terms or high.terms:
                    raise Unrepresentable("has a choice of two values", self.origin)
                return self._sum(yes if low.constant < high.constant else no)
            case _:
                raise Unrepresentable("has a choice of two values", self.origin)

    def _added(self, node: Sum) -> _Sum:
        terms: dict[Ref, tuple[float, str]] = {}
        constant, name = 0.0, ""
        for positive, part in node.terms:
            own = self._sum(part)
            sign = 1.0 if positive else -1.0
            constant += sign * own.constant
            name = name or own.name
            for ref, (number, named) in own.terms.items():
                before, old = terms.get(ref, (0.0, ""))
                terms[ref] = before + sign * number, old or named
        return _Sum(terms, constant, name)

    def _product(self, node: Product) -> _Sum:
        number, names = 1.0, list[str]()
        rest: list[_Sum] = []
        for factor in node.factors:
            own = self._sum(factor)
            if own.terms:
                rest.append(own)
            else:
                number, names = number * own.constant, [*names, own.name]
        below: list[_Sum] = []
        for divisor in node.divisors:
            own = self._sum(divisor)
            if own.terms:
                below.append(own)
            elif own.constant:
                number, names = number / own.constant, [*names, own.name]
            else:
                raise Unrepresentable("divides by a number that is 0", self.origin)
        name = "_".join(filter(None, names))
        if not rest and below:
            raise Unrepresentable("divides a number by a signal", self.origin)
        if not rest:
            return _Sum({}, number, name)
        value = rest[0]
        for other in rest[1:]:
            value = self._binary("*", value, other)
        for other in below:
            value = self._binary("/", value, other)
        terms = {r: (number * n, name or own) for r, (n, own) in value.terms.items()}
        return _Sum(terms, number * value.constant)

    def _binary(self, what: str, left: _Sum, right: _Sum) -> _Sum:
        pair = self._variable(left), self._variable(right)
        return self._made(Binary(self._free(), what, *pair, self.comment, self.origin))

    def _function(self, node: Function) -> _Sum:
        if node.name not in ("near_tanh", SIGNED_ROOT):
            name = node.name.partition(":")[0]
            raise Unrepresentable(
                f"needs `{name}`, which has no form in whole numbers yet", self.origin
            )
        argument = self._variable(self._sum(node.args[0]))
        return self._made(Call(self._free(), node.name, argument, self.comment, self.origin))

    def _variable(self, value: _Sum) -> Ref:
        """The variable that a sum is, or a temporary one."""
        if value.variable is not None:
            return value.variable
        made = self._free()
        self._put(made, value)
        return made

    def _made(self, operation: Operation) -> _Sum:
        self.found.append(operation)
        return _Sum({operation.target: (1.0, "")})

    def _free(self) -> Ref:
        count = sum(s.target.name[-1] == "'" for s in self.found)
        return Ref("local", f"{self.part}{count + 1}'")


def _shared(operations: Sequence[Operation]) -> list[Operation]:
    """With a name for each product of a number and a local that occurs in several sums."""
    many = Counter(
        (term.number, term.variable)
        for operation in operations
        if isinstance(operation, Linear)
        for term in operation.terms
        if term.variable.space == "local" and abs(term.number) != 1.0
    )
    made: dict[tuple[float, Ref], Ref] = {}
    found: list[Operation] = []
    for operation in operations:
        if isinstance(operation, Linear):
            terms = []
            for term in operation.terms:
                key = term.number, term.variable
                if many[key] > 1 and key not in made:
                    made[key] = Ref("local", f"{term.name}_{term.variable.name}'")
                    found.append(Linear(made[key], (term,), 0.0, "", None))
                shared = made.get(key)
                terms.append(term if shared is None else Term(1.0, shared, ""))
            operation = operation._replace(terms=tuple(terms))
        found.append(operation)
    return found


def _read(operations: Sequence[Operation]) -> list[Operation]:
    """Without locals that nothing reads: a factor may be 0."""
    wanted: set[Ref] = set()
    found: list[Operation] = []
    for operation in reversed(operations):
        if operation.target.space != "local" or operation.target in wanted:
            found.append(operation)
            wanted.update(operands(operation))
    return found[::-1]
