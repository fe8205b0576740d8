"""What is spelled means what was meant: Python reads it back to the same value."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.backends.target import load
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.program import (
    Choice,
    Compare,
    Condition,
    Const,
    Expression,
    Function,
    Logic,
    Mode,
    Product,
    Ref,
    Sum,
)
from bondgraph.notation.dialect import CodeSpeller, digits

_NAMES = {"a": 3.0, "b": -0.75, "c": 0.1}
_MODES = {"on": True, "off": False}

_leaves: st.SearchStrategy[Expression] = st.one_of(
    st.sampled_from([Const(x) for x in (1.0, -1.0, 2.0, -0.5, 0.1, 1e-30, -3e22)]),
    st.sampled_from([Ref("local", name) for name in _NAMES]),
)


def _more(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    compare = st.builds(Compare, st.sampled_from(["<", "<=", "=="]), inner, inner)
    modes = st.sampled_from([Mode(m) for m in _MODES])
    simple: st.SearchStrategy[Condition] = st.one_of(compare, modes)
    pair = st.tuples(simple, simple)
    logic = st.one_of(
        st.builds(Logic, st.sampled_from(["and", "or"]), pair),
        st.builds(lambda c: Logic("not", (c,)), simple),
    )
    nested = st.one_of(
        st.builds(Logic, st.sampled_from(["and", "or"]), st.tuples(logic, simple)),
        st.builds(lambda c: Logic("not", (c,)), logic),
    )
    condition: st.SearchStrategy[Condition] = st.one_of(simple, logic, nested)
    terms = st.lists(st.tuples(st.booleans(), inner), max_size=4).map(tuple)
    factors = st.lists(inner, max_size=3).map(tuple)
    return st.one_of(
        st.builds(Sum, terms),
        st.builds(Product, factors, factors),
        st.builds(Choice, condition, inner, inner),
    )


_expressions = st.recursive(_leaves, _more, max_leaves=12)


def _holds(node: Condition) -> bool:
    if isinstance(node, Mode):
        return _MODES[node.name]
    if isinstance(node, Compare):
        left, right = _value(node.left), _value(node.right)
        return {"<": left < right, "<=": left <= right, "==": left == right}[node.op]
    held = [_holds(a) for a in node.args]
    return {"and": all(held), "or": any(held), "not": not held[0]}[node.op]


def _value(node: Expression) -> float:
    """The value, rounded after every operation in the order that the program states."""
    if isinstance(node, Const):
        return node.value
    if isinstance(node, Ref):
        return _NAMES[node.name]
    if isinstance(node, Sum):
        total = None
        for positive, term in node.terms:
            x = _value(term) if positive else -_value(term)
            total = x if total is None else total + x
        return 0.0 if total is None else total
    if isinstance(node, Product):
        product = 1.0
        for factor in node.factors:
            product *= _value(factor)
        for divisor in node.divisors:
            product /= _value(divisor)
        return product
    assert isinstance(node, Choice)
    return _value(node.yes) if _holds(node.condition) else _value(node.no)


@settings(max_examples=60)
@given(_expressions)
def test_python_reads_the_same_value(node: Expression) -> None:
    text = CodeSpeller(load("python").dialect, lambda ref: ref.name).expression(node)
    try:
        wanted = _value(node)
    except ZeroDivisionError:
        with pytest.raises(ZeroDivisionError):
            eval(text, dict(_NAMES, **_MODES))
        return
    found = eval(text, dict(_NAMES, **_MODES))
    assert found == wanted or (math.isnan(found) and math.isnan(wanted))


_A, _B, _C = (Ref("local", name) for name in "abc")


@pytest.mark.parametrize(
    ("node", "text"),
    [
        (Sum(((True, _A), (False, Sum(((True, _B), (True, _C)))))), "a - (b + c)"),
        (Sum(((True, Sum(((True, _A), (True, _B)))), (True, _C))), "a + b + c"),
        (Sum(((False, _A), (False, Const(-2.0)))), "-a + 2.0"),
        (Sum(((True, _A), (True, Product((Const(-2.0), _B))))), "a - 2.0 * b"),
        (Product((Product((_A, _B), (_C,)), _A)), "a * b / c * a"),
        (Product((_A, Product((_B, _C)))), "a * (b * c)"),
        (Product((Const(1.0), _A), (Sum(((True, _B), (True, _C))),)), "a / (b + c)"),
        (Product((), (_A, _B)), "1.0 / a / b"),
        (Product((_A, Const(-1.0))), "a * (-1.0)"),
        (Sum(()), "0.0"),
    ],
)
def test_no_bracket_more_than_needed(node: Expression, text: str) -> None:
    assert CodeSpeller(load("python").dialect, lambda ref: ref.name).expression(node) == text


def test_c_of_a_choice_and_of_powers() -> None:
    speller = CodeSpeller(load("c").dialect, lambda ref: ref.name)
    both = Logic("and", (Compare("<", _A, _B), Logic("or", (Mode("on"), Compare("==", _A, _C)))))
    choice = Choice(both, Const(0.1), _B)
    assert speller.expression(choice) == "(a < b && (on || equal(a, c))) ? REAL(0.1) : b"
    assert speller.expression(Function("pow", (_A, Const(2.0)))) == "a * a"
    power = Function("pow", (Sum(((True, _A), (True, _B))), Const(-3.0)))
    assert speller.expression(power) == "power(a + b, -3)"
    assert speller.expression(Function("pow", (_A, Const(0.3)))) == "MATH(pow)(a, REAL(0.3))"


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=0.0))
def test_digits_give_the_same_double_and_a_point(value: float) -> None:
    assert float(digits(value)) == value
    assert "." in digits(value)


@pytest.mark.parametrize("folder", ["c", "python"])
def test_every_function_is_spelled(folder: str) -> None:
    target = load(folder)
    every = set(FUNCTIONS) | {"near_tanh", "power", "root", "table", "map", "inverse"}
    assert set(target.dialect.functions) == every
    assert set(target.configure.functions) == every
