"""One signal for a sensor: what measures and what laws received is one number in a log.

Residuals are lowered with the reading that a law received as an input of its own, so that a wrong
sensor can be told from a law. Who embeds the code has one sample of each sensor.
"""

from __future__ import annotations

from typing import assert_never

from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    Expression,
    Function,
    Known,
    Logic,
    Mode,
    Product,
    Program,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.names import identifier

_OF_SIGNALS = ("known", "start", "increment", "total")


def logged(program: Program) -> Program:
    """The program with every reading as the signal of its sensor.

    It computes the same, operation by operation. The digest has to be made anew.
    """
    received = [k for k in program.knowns if k.kind == "reading"]
    if not received:
        return program
    knowns = {k.name: k for k in program.knowns if k.kind != "reading"}
    names: dict[str, str] = {}
    for known in received:
        name = names[known.name] = identifier(known.path)
        sensor = known._replace(name=name, kind="sensor")
        knowns[name] = _both(knowns[name], sensor) if name in knowns else sensor
    return program._replace(
        knowns=tuple(knowns.values()),
        exact=tuple(
            _dot(s, names) if isinstance(s, Dot) else _assign(s, names) for s in program.exact
        ),
        first=tuple(_assign(s, names) for s in program.first),
        step=tuple(_assign(s, names) for s in program.step),
    )


def _both(one: Known, other: Known) -> Known:
    """What a program needs of a signal that it reads in two places."""
    return one._replace(
        highest=max(one.highest, other.highest),
        integral=one.integral or other.integral,
        lowest=min(one.lowest, other.lowest),
        start=one.start or other.start,
        sampled=one.sampled or other.sampled,
    )


def _assign(statement: Assign, names: dict[str, str]) -> Assign:
    return statement._replace(value=_expression(statement.value, names))


def _dot(statement: Dot, names: dict[str, str]) -> Dot:
    terms = [t._replace(signal=names.get(t.signal, t.signal)) for t in statement.terms]
    return statement._replace(terms=tuple(terms))


def _expression(value: Expression, names: dict[str, str]) -> Expression:
    """The same expression with other names of signals."""

    def all_of(parts: tuple[Expression, ...]) -> tuple[Expression, ...]:
        return tuple(_expression(p, names) for p in parts)

    match value:
        case Const():
            return value
        case Ref(space, name):
            return value._replace(name=names.get(name, name)) if space in _OF_SIGNALS else value
        case Sum(terms):
            return Sum(tuple((sign, _expression(t, names)) for sign, t in terms))
        case Product(factors, divisors):
            return Product(all_of(factors), all_of(divisors))
        case Function(name, args):
            return Function(name, all_of(args))
        case Choice(condition, yes, no):
            return Choice(_condition(condition, names), *all_of((yes, no)))
        case _:
            assert_never(value)


def _condition(value: Condition, names: dict[str, str]) -> Condition:
    match value:
        case Compare(op, left, right):
            return Compare(op, _expression(left, names), _expression(right, names))
        case Logic(op, args):
            return Logic(op, tuple(_condition(a, names) for a in args))
        case Mode():
            return value
        case _:
            assert_never(value)
