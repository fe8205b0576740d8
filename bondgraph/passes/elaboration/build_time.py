"""What is decided when the model is built: numbers of instances, indices, conditions of `if`."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from bondgraph.ir.syntax import Binary, Call, Expression, Number, Part, Ref, Text, Truth, Unary
from bondgraph.passes.elaboration.problems import fail, meant, rough
from bondgraph.passes.elaboration.scope import Env, Scope, ValueEntry
from bondgraph.text.diagnostic import Report

_MOST_DEEP = 100
_MOST_BITS = 64

_HELP = (
    "Sizes, indices and conditions of `if` are fixed when the model is built: use numbers, "
    "`for` variables and the structural arguments `(n : int)` of the model."
)
_WHILE_RUNNING = (
    "What depends on signals is chosen while the machine runs: in a law with "
    "`if(condition, a, b)`, or by a switched junction, `1:name when condition { ... }`."
)


def structural(
    expr: Expression, scope: Scope, env: Env, report: Report, depth: int = 0
) -> Fraction | bool:
    """The value of a build-time expression; raises Skip when it has none."""
    if depth > _MOST_DEEP:
        fail(report, "expression-too-deep", "This expression is nested too deeply.", expr.origin,
             help="Split it into several `let`s.")  # fmt: skip
    match expr:
        case Number():
            if expr.unit is not None:
                fail(report, "not-structural", f"`{expr.text}` has a unit, a size has none.",
                     expr.origin, help="Leave the unit out.")  # fmt: skip
            return expr.value
        case Truth():
            return expr.value
        case Ref():
            return _name(expr, scope, env, report)
        case Unary():
            value = structural(expr.operand, scope, env, report, depth + 1)
            if expr.op == "not":
                return not _truth(value, expr.operand, report)
            return -_number(value, expr.operand, report)
        case Binary():
            return _binary(expr, scope, env, report, depth)
        case Call():
            return _call(expr, scope, env, report, depth)
        case Text():
            fail(report, "not-structural", "A text is not a size.", expr.origin, help=_HELP)


def decided(expr: Expression, scope: Scope, env: Env, report: Report) -> Fraction | bool:
    """A build-time value of a size that a computer counts with; raises Skip when it is none."""
    value = structural(expr, scope, env, report)
    return value if isinstance(value, bool) else _number(value, expr, report)


def whole_number(expr: Expression, scope: Scope, env: Env, report: Report) -> int:
    """A build-time integer; raises Skip when it is none."""
    value = structural(expr, scope, env, report)
    number = _number(value, expr, report)
    if number.denominator != 1:
        fail(report, "not-an-integer", f"`{expr.origin.text}` is {rough(number)}: an integer is "
             "needed here.", expr.origin, help="Use a whole number.")  # fmt: skip
    return number.numerator


def truth(expr: Expression, scope: Scope, env: Env, report: Report) -> bool:
    """A build-time condition; raises Skip when it is none."""
    return _truth(structural(expr, scope, env, report), expr, report)


def index(part: Part, scope: Scope, env: Env, report: Report) -> int | None:
    """The one index of a part of a reference, None where none is written."""
    if part.first is None:
        return None
    if part.last is not None:
        fail(report, "range-not-allowed", f"A range `{part.origin.text}` cannot stand here.",
             part.origin, help="A range names several nodes in a chain of bonds; elsewhere give "
             "one index, inside a `for` if need be.")  # fmt: skip
    return whole_number(part.first, scope, env, report)


def references(expr: Expression) -> Iterator[Ref]:
    """The references in an expression, as they stand in it."""
    stack: list[Expression] = [expr]
    while stack:
        item = stack.pop()
        match item:
            case Ref():
                yield item
            case Unary():
                stack.append(item.operand)
            case Binary():
                stack += (item.right, item.left)
            case Call():
                stack += reversed(item.arguments)
            case Number() | Text() | Truth():
                pass


def mentions(expr: Expression | None, env: Env) -> bool:
    """Whether an expression uses one of the `for` variables."""
    if expr is None or not env:
        return False
    return any(len(r.parts) == 1 and r.parts[0].name in env for r in references(expr))


def _name(ref: Ref, scope: Scope, env: Env, report: Report) -> Fraction | bool:
    part = ref.parts[0]
    if len(ref.parts) == 1 and part.first is None:
        if part.name in env:
            return Fraction(env[part.name])
        if part.name in scope.generics:
            value = scope.generics[part.name]
            return value if isinstance(value, bool) else Fraction(value)
        if any(g.name == part.name for g in scope.model.generics):
            fail(report, "not-structural", f"`{part.name}` has no value yet.", ref.origin,
                 help="A structural argument can use those before it only.")  # fmt: skip
    known = (*env, *scope.generics)
    if part.name in scope.values:
        entry = scope.values[part.name]
        signal = isinstance(entry, ValueEntry) and entry.kind not in ("param", "const")
        fail(report, "not-structural", f"`{ref.origin.text}` is not known when the model is built.",
             ref.origin, help=_WHILE_RUNNING if signal else _HELP)  # fmt: skip
    if part.name in scope.nodes:
        fail(report, "not-structural", f"`{ref.origin.text}` is not known when the model is built.",
             ref.origin, help=_WHILE_RUNNING)  # fmt: skip
    fail(report, "unknown-name", f"There is no structural argument or `for` variable "
         f"`{ref.origin.text}`.", ref.origin,
         help=meant(part.name, known, _HELP, ref.origin))  # fmt: skip


def _number(value: Fraction | bool, expr: Expression, report: Report) -> Fraction:
    if isinstance(value, bool):
        fail(report, "not-an-integer", f"`{expr.origin.text}` is true or false: a number is needed "
             "here.", expr.origin, help="Use a number.")  # fmt: skip
    if value.numerator.bit_length() > _MOST_BITS or value.denominator.bit_length() > _MOST_BITS:
        fail(report, "number-too-large", f"`{expr.origin.text}` is too large for a size.",
             expr.origin, help="Use a smaller number.")  # fmt: skip
    return value


def _truth(value: Fraction | bool, expr: Expression, report: Report) -> bool:
    if not isinstance(value, bool):
        fail(report, "not-a-condition", f"`{expr.origin.text}` is a number: a condition is needed "
             "here.", expr.origin, help="Compare it with something, as in `n > 1`.")  # fmt: skip
    return value


def _binary(expr: Binary, scope: Scope, env: Env, report: Report, depth: int) -> Fraction | bool:
    left = structural(expr.left, scope, env, report, depth + 1)
    if expr.op in ("and", "or"):
        first = _truth(left, expr.left, report)
        second = _truth(structural(expr.right, scope, env, report, depth + 1), expr.right, report)
        return (first and second) if expr.op == "and" else (first or second)
    right = structural(expr.right, scope, env, report, depth + 1)
    if expr.op in ("==", "!=") and isinstance(left, bool) and isinstance(right, bool):
        return (left is right) == (expr.op == "==")
    a, b = _number(left, expr.left, report), _number(right, expr.right, report)
    match expr.op:
        case "+":
            return a + b
        case "-":
            return a - b
        case "*":
            return a * b
        case "<":
            return a < b
        case "<=":
            return a <= b
        case ">":
            return a > b
        case ">=":
            return a >= b
        case "==":
            return a == b
        case "!=":
            return a != b
    if (expr.op == "/" and b == 0) or (expr.op == "^" and a == 0 and b < 0):
        fail(report, "division-by-zero", f"`{expr.right.origin.text}` divides by zero.",
             expr.right.origin, help="Guard it with an `if`.")  # fmt: skip
    if expr.op == "/":
        return a / b
    if b.denominator != 1 or abs(b) > _MOST_BITS:
        fail(report, "not-structural", "This power is no build-time number.", expr.origin,
             help=_HELP)  # fmt: skip
    return Fraction(a ** int(b))


def _call(expr: Call, scope: Scope, env: Env, report: Report, depth: int) -> Fraction | bool:
    name, arguments = expr.name, expr.arguments
    if name == "if" and len(arguments) == 3:
        condition = _truth(structural(arguments[0], scope, env, report, depth + 1), arguments[0],
                           report)  # fmt: skip
        return structural(arguments[1 if condition else 2], scope, env, report, depth + 1)
    if name in ("min", "max") and arguments:
        values = [_number(structural(a, scope, env, report, depth + 1), a, report)
                  for a in arguments]  # fmt: skip
        return min(values) if name == "min" else max(values)
    if name == "abs" and len(arguments) == 1:
        return abs(_number(structural(arguments[0], scope, env, report, depth + 1), arguments[0],
                           report))  # fmt: skip
    fail(report, "not-structural", f"`{expr.origin.text}` is not known when the model is built.",
         expr.origin, help=_HELP)  # fmt: skip
