"""What occurs in a residual program, found in a small one by reading it."""

from __future__ import annotations

from bondgraph.ir.program import (
    Assign,
    Branch,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    DotTerm,
    Expression,
    First,
    Function,
    Logic,
    Mode,
    PolynomialTape,
    Product,
    Ref,
    Statement,
    Sum,
    TapeOp,
    TapeOutput,
)
from bondgraph.notation.walk import functions, nodes, reads, references


def known(name: str) -> Ref:
    return Ref("known", name)


A, B, C, D = (known(n) for n in "abcd")
#: on and (a < b) ? c - 2 a/d : tanh(b)
CHOICE = Choice(
    Logic("and", (Mode("on"), Compare("<", A, B))),
    Sum(((True, C), (False, Product((Const(2.0), A), (D,))))),
    Function("tanh", (B,)),
)


def test_nodes_come_in_the_order_in_which_they_are_written_parents_first() -> None:
    found = list(nodes([CHOICE, First()]))
    kinds = [type(n).__name__ if not isinstance(n, Ref) else n.name for n in found]
    assert kinds == (
        "Choice Logic Mode Compare a b Sum c Product Const a d Function b First".split()
    )


def test_references_are_those_that_a_person_reads_from_left_to_right() -> None:
    """A mode is a known signal; one that is read twice is told twice."""
    assert references(CHOICE) == [known("on"), A, B, C, A, D, B]
    assert references(First()) == references(Const(3.0)) == []
    assert references(A) == [A]


def test_statements_tell_what_they_write_and_what_they_read() -> None:
    x, y, r = Ref("local", "x"), Ref("local", "y"), Ref("residual", "r1")
    inside = Assign(y, Product((A, Const(2.0))), "", None)
    side = Choice(Compare("==", C, Const(0.0)), y, B)
    op = TapeOp(1, 0, 0, 0, 2, True)
    rate = Ref("option", "sample_time")
    tape = PolynomialTape("r1", 3, 2, (rate,), (op,), (TapeOutput("r1_u", 1, 3),), "", None)
    statements: list[Statement] = [
        tape,
        Branch(x, side, (inside,), (), "", None),
        Dot(r, (DotTerm("r1_u", "u", 3), DotTerm("r1_v", "v", 2)), "", None),
    ]
    found = reads(statements)
    expected = [
        [Ref("coef", "r1_u"), rate],
        [x, y, A, C, B, y],
        [r, Ref("coef", "r1_u"), known("u"), Ref("coef", "r1_v"), known("v")],
    ]
    assert sorted(found) == sorted(ref for part in expected for ref in part)
    assert found[:2] == expected[0] and found[-5:] == expected[2]


def test_functions_that_stand_as_operators_are_none_but_equality_has_a_helper() -> None:
    square = Function("pow", (A, Const(2.0)))
    values: list[Expression | Condition] = [
        CHOICE, square, Compare("==", A, B), Function("table:hill", (Function("exp", (C,)),))
    ]  # fmt: skip
    found = functions(values)
    assert {"tanh", "equal", "table", "exp"} <= found
    assert functions([Compare("<", A, B), Sum(((True, A),))]) == set()
