"""Adjoints: how the value of an expression changes with that of every node below it, at a point.

One pass from the roots to the leaves carries them, by the partial derivatives of each node
(reverse mode: Griewank and Walther, 2008, ch. 3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from bondgraph.exact.evaluate import Powers, chosen, values_of_equation, weighed
from bondgraph.exact.outline import outline
from bondgraph.exact.signal_algebra import Algebra, Exponentials
from bondgraph.field.numbers import Number, Numbers
from bondgraph.ir.expr import Expr, Op


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
        found = _slopes_of_root(node, values[node], inner, algebra, n)
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


def static_adjoints(
    root: Expr, values: Mapping[Expr, Number], numbers: Numbers
) -> dict[Expr, Number]:
    """The derivatives of a root that is made of sums and products, where they are not zero."""
    adjoints: dict[Expr, Number] = {root: 1}
    out: dict[Expr, Number] = {}
    raised = Powers(numbers, values).of
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


def _slopes_of_root(node: Expr, value: Any, args: Sequence[Any], algebra: Any, n: int) -> list[Any]:
    """The partial derivatives of a root, by the theorem of the implicit function."""
    root = node.root
    found = values_of_equation(root, args, value, algebra, n)
    steep = _tangent(root.zero, root.unknown, found, algebra, n)
    out = []
    for place in root.places:
        above = _tangent(root.zero, place, found, algebra, n)
        out.append(algebra.combine([(-1, algebra.product([(above, 1), (steep, -1)], n))], n))
    return out


def _tangent(root: Expr, wrt: Expr, values: dict[Expr, Any], algebra: Any, n: int) -> Any:
    """The partial derivative of an expression without D and Int, forwards."""
    tangents: dict[Expr, Any] = {wrt: algebra.number(1)}
    for node in outline(root).nodes:
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
