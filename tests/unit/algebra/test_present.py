"""Relations as a person reads them: no part is called like something else that is shown."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.present import Parts, closed_form, parts, shared
from bondgraph.backends.report.formulas import Typesetter, readable
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Expr, Kind, Pool, Root
from bondgraph.notation.formula import Reader
from bondgraph.notation.lettering import letters
from bondgraph.notation.line import Line
from bondgraph.text.source import Source

# With the flow f and s = k*f + a: 0 = F - tanh(s)*sin(s) - k*D(f), where s occurs twice.
TWICE = "e = tanh(k*f + {a})*sin(k*f + {a})"
# 1/(1 + 1/(2 + 1/(3 + 1/s))): four fractions inside each other, of which the outermost gets a name.
DEEP = "e = 1 + 1/(1 + 1/(2 + 1/(3 + 1/({a} + k*f))))"


def machine(law: str, a: str = "a", F: str = "F", v: str = "v", more: str = "") -> str:
    return (
        f"param {a} = 0.3; param k = 2; {more}\n"
        f"1:j {{ <- Se:{F}; -> I:m = k; -> R:d {{ {law.format(a=a)} }}; -> Df:{v} }}\n"
    )


def compiled(body: str, before: str = "") -> Compilation:
    return Compilation(Source("test.bg", f"bg 1\n{before}\nmodel M {{\n{body}\n}}\n"))


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (machine(TWICE), "F - tanh(x1)*sin(x1) - k*D(v)\nwhere x1 = a + k*v"),
        (machine(TWICE, a="x1"), "F - tanh(x2)*sin(x2) - k*D(v)\nwhere x2 = x1 + k*v"),
        (machine(TWICE, a="x2"), "F - tanh(x1)*sin(x1) - k*D(v)\nwhere x1 = x2 + k*v"),
        # typeset, x_1 is the same letter as x1
        (machine(TWICE, a="x_1"), "F - tanh(x2)*sin(x2) - k*D(v)\nwhere x2 = x_1 + k*v"),
        (machine(TWICE, F="x1"), "x1 - tanh(x2)*sin(x2) - k*D(v)\nwhere x2 = a + k*v"),
        (machine(TWICE, v="x1"), "F - tanh(x2)*sin(x2) - k*D(x1)\nwhere x2 = a + k*x1"),
        # what does not occur in this relation is read beside it
        (
            machine(TWICE, more="param x1 = 1; let x2 = 2*k"),
            "F - tanh(x3)*sin(x3) - k*D(v)\nwhere x3 = a + k*v",
        ),
        # a past value is written with the name of the signal
        (
            machine("e = tanh(k*delay(x1, 0.1) + a)*sin(k*delay(x1, 0.1) + a)", v="x1"),
            "F - tanh(x2)*sin(x2) - k*D(x1)\nwhere x2 = a + k*delay(x1, 0.1 s)",
        ),
    ],
)  # fmt: skip
def test_a_shared_part_is_called_like_nothing_in_the_model(body: str, expected: str) -> None:
    c = compiled(body)
    (residual,) = c.residuals.residual_set.residuals
    assert str(closed_form(c.graph, residual)) == expected


def test_a_shared_part_is_called_like_nothing_in_an_instance() -> None:
    # w.x1 is set as the letter x with a small 1 where no other x1 is in the model
    c = compiled("W:w", "model W {\n" + machine(TWICE, a="x1") + "}")
    (residual,) = c.residuals.residual_set.residuals
    assert str(closed_form(c.graph, residual)) == (
        "w.F - tanh(x2)*sin(x2) - w.k*D(w.v)\nwhere x2 = w.x1 + w.k*w.v"
    )


@pytest.mark.parametrize(("a", "expected"), [("a", "x1"), ("x1", "x2"), ("x_1", "x2")])
def test_a_part_that_is_nested_too_deep_is_called_like_nothing_else(a: str, expected: str) -> None:
    c = compiled(machine(DEEP, a=a))
    (residual,) = c.residuals.residual_set.residuals
    (name,) = readable(_without_variables(parts(c.graph, residual))).values()
    own = letters([*c.graph.names, name])
    assert name == expected
    assert [own[n][:2] for n in c.graph.names].count(own[name][:2]) == 0


def _without_variables(form: Parts) -> Parts:
    """The parts where none is the value of a variable, which would name it."""
    return form._replace(variables={})


def test_a_shared_part_is_not_called_like_a_table() -> None:
    pool = Pool()
    y = pool.symbol("y", Kind.SENSOR)
    s = pool.add((1, pool.mul(y, y)), (1, y))
    looked_up = pool.fn("table:x1", s)
    assert shared(pool.mul(s, looked_up), {}).named == {s: "x2"}


def _implicit(pool: Pool, value: Expr) -> Expr:
    """The f at which f + f^3 = value."""
    f, place = pool.symbol("?x", Kind.TEAR), pool.symbol("?0", Kind.CONST)
    zero = pool.add((1, f), (1, pool.power(f, 3)), (-1, place))
    variable = pool.symbol("d.f", Kind.FLOW)
    return pool.root(Root("d.f", zero, f, (place,), variable, True, Fraction(0)), value)


def test_two_implicit_numbers_of_one_variable_have_two_names() -> None:
    # as of one law at two moments: d.f + d.f^3 = a, x1 + x1^3 = b
    pool = Pool()
    a, b = pool.symbol("a", Kind.SENSOR), pool.symbol("b", Kind.SENSOR)
    first, second = _implicit(pool, a), _implicit(pool, b)
    form = shared(pool.sub(first, second), {})
    named = readable(form)
    assert named == {first: "d.f", second: "x1"}
    zeros = [Line().spell(Reader(named).vanishing(n, named[n])).text for n in named]
    assert zeros == ["d.f + d.f^3 - a", "x1 + x1^3 - b"]
    relation, *where = Typesetter(["a", "b", "d.f"], {}).equations("", form)
    assert 'data-name="d.f"' in relation and 'data-name="x1"' in relation
    assert [('data-name="d.f"' in w, 'data-name="x1"' in w) for w in where] == [
        (False, True), (True, False),
    ]  # fmt: skip
