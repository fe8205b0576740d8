"""What the parser understands, statement by statement; the trees are written down by hand."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from bondgraph.ir import syntax
from tests.unit.frontend.trees import bare, good, inside, read, show, value


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("a + b*c", "(a + (b * c))"),
        ("a - b - c", "((a - b) - c)"),
        ("a/b/c", "((a / b) / c)"),
        ("2^3^2", "(2 ^ (3 ^ 2))"),
        ("-x^2", "(- (x ^ 2))"),
        ("x^-2*3", "((x ^ (- 2)) * 3)"),
        ("-a*b", "((- a) * b)"),
        ("a*-b + c", "((a * (- b)) + c)"),
        ("x<-1", "(x < (- 1))"),
        ("x<-1 + 2", "(x < ((- 1) + 2))"),
        ("x<-y^2", "(x < (- (y ^ 2)))"),
        ("not a < b", "(not (a < b))"),
        ("not a and b", "((not a) and b)"),
        ("a or b and c == d", "(a or (b and (c == d)))"),
        ("if(x > 0, 1, -1)", "if((x > 0), 1, (- 1))"),
        ("m[1].wh.R*m[j + 1].wh.ws", "(m[1].wh.R * m[(j + 1)].wh.ws)"),
        ("cell[1..n].x", "cell[1..n].x"),
        ("5 m/x", "5_m/x"),
        ("5 m / x", "(5_m / x)"),
        ("5 m*x", "(5_m * x)"),
        ("2 m^3/s.Pa^-0.5", "2_m^3/s.Pa^-0.5"),
        ("300 uH/2", "(300_uH / 2)"),
        ("1/s", "(1 / s)"),
        ("5 1/s", "5_1/s"),
        ("5 m^2.s", "5_m^2.s"),
        ("3 and x", "(3 and x)"),
        ("20 °C", "20_°C"),
        ("4 µm", "4_µm"),
        ("true", "True"),
        ('table("a b.csv", x)', 'table("a b.csv", x)'),
        ("f()", "f()"),
        ("(a)", "a"),
        ("port + model*out", "(port + (model * out))"),
    ],
)
def test_expressions(text: str, tree: str) -> None:
    assert show(value(text)) == tree


@pytest.mark.parametrize(
    ("text", "exact"),
    [
        ("3.51e-3", Fraction(351, 100_000)),
        ("0.1", Fraction(1, 10)),
        ("2E5", Fraction(200_000)),
        ("1.50", Fraction(3, 2)),
        ("007", Fraction(7)),
        ("1e400", Fraction(10**400)),
        ("1.25e-400", Fraction(125, 10**402)),
    ],
)
def test_numbers_are_exact(text: str, exact: Fraction) -> None:
    number = value(text)
    assert isinstance(number, syntax.Number)
    assert number.value == exact
    assert number.text == text


def _one(text: str) -> Any:
    (statement,) = inside(text)
    return bare(statement)


def _ref(name: str) -> Any:
    return ("Ref", (("Part", name, None, None),))


def _part(name: str) -> Any:
    return ("Part", name, None, None)


def _num(value: int, unit: str | None = None) -> Any:
    return ("Number", Fraction(value), unit, str(value))


def _node(type: str, name: str, **more: Any) -> Any:
    rest = {"arguments": (), "value": None, "tolerance": None, "law": None, **more}
    return ("Node", type, _part(name), *rest.values())


def test_chain() -> None:
    assert _one("Se:U -[7]-> 1:i <- load") == (
        "Chain",
        (_node("Se", "U"), _node("1", "i"), _ref("load")),
        (("Arrow", True, "7"), ("Arrow", False, None)),
        "",
    )


def test_an_arrow_ends_the_value_of_a_node() -> None:
    assert _one("R:a = x <- b") == (
        "Chain",
        (_node("R", "a", value=_ref("x")), _ref("b")),
        (("Arrow", False, None),),
        "",
    )


def test_element_with_everything() -> None:
    tolerance = ("Tolerance", ("Number", Fraction(1, 20), None, "5"), True)
    law = ("Law", (_part("el"),), (("Equation", _ref("e"), _ref("f")),))
    assert _one("C:x(q0 = 0 rad) = 2 +- 5% { port el; e = f }") == (
        "Chain",
        (
            _node(
                "C", "x", arguments=(("Argument", _ref("q0"), _num(0, "rad")),),
                value=_num(2), tolerance=tolerance, law=law,
            ),
        ),
        (),
        "",
    )  # fmt: skip


def test_absolute_tolerance() -> None:
    (param,) = inside("param R = 10 Ohm ± 2 Ohm")
    assert isinstance(param, syntax.Param)
    assert param.tolerance is not None
    assert not param.tolerance.relative
    assert (param.tolerance.quantity.value, param.tolerance.quantity.unit) == (2, "Ohm")


def test_junction_body() -> None:
    assert _one("1:sw when on { <- a; if b { -> c }; param R = 1 }") == (
        "Junction",
        "1",
        _ref("sw"),
        _ref("on"),
        (
            ("Chain", (None, _ref("a")), (("Arrow", False, None),), ""),
            ("If", _ref("b"), (("Chain", (None, _ref("c")), (("Arrow", True, None),), ""),), ()),
            ("Param", "param", _part("R"), None, _num(1), None, ""),
        ),
        "",
    )


def test_a_chain_may_end_with_the_braces_of_a_junction() -> None:
    def tree(body: str) -> Any:
        return bare(inside(body))

    assert tree("## of U\nSe:U -> 1:i { -> I:L; <- b }") == tree(
        "## of U\nSe:U -> 1:i; i { -> I:L; <- b }"
    )
    assert tree("a <- m.p { -> 0:n { } }") == tree("a <- m.p; m.p { -> 0:n; n { } }")
    assert tree("a -> 1:s when on { -> b }") == tree("1:s when on { }; a -> s; s { -> b }")
    loop = "for j in 1..2 {{ {} }}"
    assert tree(loop.format("a -> 0:k[j] { -> b }")) == tree(
        loop.format("a -> 0:k[j]; k[j] { -> b }")
    )


def test_reopened_junction() -> None:
    assert _one("m[1].out { }") == (
        "Junction",
        "",
        ("Ref", (("Part", "m", _num(1), None), _part("out"))),
        None,
        (),
        "",
    )


def test_declarations() -> None:
    assert [bare(s) for s in inside(
        "port shaft : out rotation\nparam L : H\nconst g[2] = 9\ninput road : m/s unknown\n"
        "input on : bool\nlet a = b\nfault cut : line.R += 100 Ohm\n"
        "sensor th : rad = x counts 24*n/turn"
    )] == [
        ("Port", "shaft", "out", "rotation", ""),
        ("Param", "param", _part("L"), "H", None, None, ""),
        ("Param", "const", ("Part", "g", _num(2), None), None, _num(9), None, ""),
        ("Input", _part("road"), "m/s", False, True, ""),
        ("Input", _part("on"), None, True, False, ""),
        ("Let", _part("a"), _ref("b"), ""),
        ("Fault", _part("cut"), ("Ref", (_part("line"), _part("R"))), "+=", _num(100, "Ohm"), ""),
        ("Sensor", _part("th"), "rad", _ref("x"), ("Binary", "*", _num(24), _ref("n")), ""),
    ]  # fmt: skip


def test_loop_and_else_if() -> None:
    assert _one("for j in 1..n { R:r }")[:4] == ("For", "j", _num(1), _ref("n"))
    branches = _one("if a { R:x }\nelse if b { R:y } else { R:z }")
    assert branches[3][0][:2] == ("If", _ref("b"))
    assert len(branches[3][0][3]) == 1


def test_file() -> None:
    file = good(
        '## The file.\nbg 1\nimport A, B from "parts.bg"\n'
        "## One.\n##\n##  Two.\n# not this\nmodel M(n : int = 1, fast : bool) {\n"
        "    param a = 1  ## not documentation of b\n    ## Of c.\n    let c = 1; let d = 2\n}\n"
    )
    assert file.edition == 1
    assert file.doc == "The file."
    assert bare(file.imports) == (("Import", ("A", "B"), "parts.bg"),)
    (model,) = file.models
    assert model.doc == "One.\n\n Two."
    assert model.name_origin.text == "M"
    assert bare(model.generics) == (
        ("Generic", "n", "int", _num(1)),
        ("Generic", "fast", "bool", None),
    )
    assert [getattr(s, "doc", None) for s in model.body] == ["", "Of c.", ""]


def test_places() -> None:
    text = "bg 1\nmodel M {\n    a -> R:r = 2 Ohm + x # c\n}\n"
    chain = good(text).models[0].body[0]
    assert isinstance(chain, syntax.Chain)
    assert str(chain.origin) == "test.bg:3:5"
    assert chain.origin.text == "a -> R:r = 2 Ohm + x"
    node = chain.nodes[1]
    assert isinstance(node, syntax.Node)
    assert node.origin.text == "R:r = 2 Ohm + x"
    assert node.value is not None
    assert node.value.origin.text == "2 Ohm + x"
    assert node.name.origin.text == "r"
    assert chain.arrows[0].origin.text == "->"


def test_brackets_are_part_of_the_place_they_group() -> None:
    whole = value("(a + b)*(c + d)")
    assert whole.origin.text.startswith("a + b)") or whole.origin.text.startswith("(a + b)")


def test_line_ends_after_which_a_statement_goes_on() -> None:
    assert len(inside("a ->\n\n # why\n b")) == 1
    assert len(inside("let x =\n 1 +\n 2*\n 3")) == 1
    assert len(inside("let x = f(1\n,\n2\n)\nlet y = m[\n1\n]")) == 2
    assert len(inside("if a {\n}\n\nelse {\n}")) == 1


def test_carriage_returns_and_tabs_are_blanks() -> None:
    assert bare(good("bg 1\r\nmodel M {\r\n\tR:r\r\n}\r\n")) == bare(good("bg 1\nmodel M { R:r }"))


def test_a_file_of_another_edition_is_not_read() -> None:
    tree, report = read("bg 99\nmodel M { nonsense nonsense }")
    assert tree is None
    assert [d.code for d in report.diagnostics] == ["unknown-edition"]


def test_the_good_part_of_a_wrong_model_is_kept() -> None:
    body = "a -> \n param r = 2\n let x = 3 3\n let y = 4\n"
    tree, report = read("bg 1\nmodel M {\n" + body + "}\nmodel N { }")
    assert tree is not None
    assert [m.name for m in tree.models] == ["M", "N"]
    assert [type(s).__name__ for s in tree.models[0].body] == ["Param", "Let"]
    assert len(report.diagnostics) == 2
