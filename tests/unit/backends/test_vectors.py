"""What the self-test and the example say of each signal, by its kind."""

from __future__ import annotations

import math

import pytest

from bondgraph.backends.golden import Golden, Vector, golden
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from bondgraph.backends.vectors import Vectors
from tests.unit.backends import programs


def _vectors(make: programs.Maker, language: str, found: Golden | None = None) -> Vectors:
    program = make()
    return Vectors(program, Spelling(program, load(language)), found or golden(program))


def test_c_spoils_real_samples_alone_and_reads_each_by_its_kind() -> None:
    """An encoder, a real signal and a mode; the first and the last are called as words of C."""
    found = _vectors(programs.encoder, "c").c()
    assert found["spoil"] == ["    bad.class_ = (robot_arm_real)NAN;"]
    assert found["from_list"] == [
        "        samples.int_ = (int32_t)data[0];",
        "        samples.class_ = (robot_arm_real)data[1];",
        "        samples.register_ = data[2] > 0.5;",
    ]
    assert found["from_log"] == [
        '    samples->int_ = (int32_t)column(names, line, "int");',
        '    samples->class_ = (robot_arm_real)column(names, line, "class");',
        '    samples->register_ = column(names, line, "register") > 0.5;',
    ]
    values = [line.split("=")[1].split(";")[0].strip() for line in _lines(found["readings"])]
    assert values == ["0", "0", "false"]


def test_python_spoils_real_samples_alone_and_reads_each_by_its_kind() -> None:
    found = _vectors(programs.encoder, "python").python()
    assert found["reals"] == ['    "class_",']
    assert [line.strip() for line in _lines(found["from_log"])] == [
        'int_=int(float(row["int"])),',
        'class_=float(row["class"]),',
        'register=float(row["register"]) > 0.5,',
    ]
    values = [line.split("=")[1].split(",")[0] for line in _lines(found["readings"])]
    assert values == ["0", "0.0", "False"]
    assert found["reads_log"] is True


def test_what_step_does_not_read_is_no_column_of_a_log() -> None:
    """In C it stays as it was; a sample of Python is whole."""
    assert _vectors(programs.silent, "c").c()["from_log"] == []
    found = _vectors(programs.silent, "python").python()
    assert [line.strip() for line in _lines(found["from_log"])] == ["y=0.0,"]
    assert found["reads_log"] is False
    mixed = programs.motor()
    unread = mixed._replace(knowns=(mixed.knowns[0]._replace(sampled=False), *mixed.knowns[1:]))
    assert _vectors(lambda: unread, "python").python()["reads_log"] is True


def test_a_reading_is_told_without_what_stands_in_brackets() -> None:
    """Which is where the signal is in the model."""
    comments = [
        line.split("/* ")[1].removesuffix(" */")
        for line in _lines(_vectors(programs.motor, "c").c()["readings"])
    ]
    assert [text.partition(": ")[2] for text in comments] == [
        "signal U", "signal i", "signal y", "signal y2",
    ]  # fmt: skip


@pytest.mark.parametrize(("make", "wanted"), [
    (programs.motor, [True, True]),
    (programs.encoder, [True]),
    (programs.silent, [False]),  # step has no residual
])  # fmt: skip
def test_a_residual_can_be_spoilt_where_it_reads_what_can_be_no_number(
    make: programs.Maker, wanted: list[bool]
) -> None:
    assert _vectors(make, "c").spoilt() == wanted
    names = [r.name for r, spoilt in zip(make().residuals, wanted, strict=True) if spoilt]
    listed = " ".join(_lines(_vectors(make, "python").python()["spoilt"])).split()
    assert listed == [f'"{name}",' for name in names]


def test_of_an_encoder_and_a_mode_alone_nothing_can_be_spoilt() -> None:
    """Neither counts nor a switch can be other than a number."""
    increment = programs.put("residual:r1", programs.ref("increment:int"))
    arm = programs.encoder()._replace(first=(increment,), step=(increment,), states=())
    assert _vectors(lambda: arm, "c").spoilt() == [False]


def test_only_parameters_without_a_value_have_to_be_set() -> None:
    assert _vectors(programs.motor, "c").unset() == []
    found = _vectors(programs.encoder, "python", _BY_HAND)
    assert found.unset() == [("lambda_", "rad", 0.75)]
    assert found.python()["golden_parameters"] == ["    lambda_=0.75,"]
    c = _vectors(programs.encoder, "c", _BY_HAND).c()
    assert c["golden_parameters"] == ["    parameters->lambda = N(0.75);"]
    (line,) = _lines(c["to_set"])
    assert line.startswith("    parameters.lambda = ROBOT_ARM_CONSTANT(1.0); /* rad: ")


_BY_HAND = Golden(
    {"lambda": 0.75},
    (
        Vector(
            {
                programs.ref("known:int"): 0.5,
                programs.ref("start:int"): 1e-40,  # nothing in single precision
                programs.ref("known:class:-2"): -2.0,
            },
            {"register": True},
            {},
            ((math.nan, 3.0),),
        ),
    ),
    (
        Vector({programs.ref("known:class"): 1.5}, {}, {"int": -7}, ((0.25, 1.0),)),
        Vector({}, {}, {}, ((0.0, 1.0),)),
    ),
)


def test_vectors_are_rows_in_the_order_of_the_members() -> None:
    """What a vector does not say is zero; what cannot be told is no number."""
    row = "N(0.5), N(0.0), N(0.0), N(0.0), N(-2.0), true, N(0.0), N(0.0)"
    tables = _vectors(programs.encoder, "c", _BY_HAND).c()["golden_tables"]
    assert isinstance(tables, list)
    lines = [" ".join(line.strip() for line in table["lines"]) for table in tables]
    assert lines == [
        f"{{{row}}},",
        "{{(robot_arm_real)NAN, N(3.0)}},",
        "{-7, N(1.5), false}, {0, N(0.0), false},",
        "{{N(0.25), N(1.0)}}, {{N(0.0), N(1.0)}},",
    ]
    assert [(table["type"], table["name"], table["exact"]) for table in tables] == [
        ("robot_arm_derivatives", "golden_derivatives[]", True),
        ("golden_result", "golden_exact[][1]", True),
        ("robot_arm_samples", "golden_samples[]", False),
        ("golden_result", "golden_step[][1]", False),
    ]


def test_vectors_of_python_say_which_member_is_which() -> None:
    found = _vectors(programs.encoder, "python", _BY_HAND).python()
    indents = {len(line) - len(line.lstrip()) for line in _lines(found["golden_exact"])}
    assert indents == {4}
    (exact,) = [" ".join(line.strip() for line in _lines(found["golden_exact"]))]
    assert "int_=0.5, int_integral=0.0, int_start=0.0, class_integral=0.0," in exact
    assert "class_double_integral=-2.0, register=True," in exact
    assert exact.endswith("((math.nan, 3.0),)),")
    first = "(m.Samples(int_=-7, class_=1.5, register=False), ((0.25, 1.0),)),"
    assert _lines(found["golden_step"])[0] == f"    {first}"


def test_an_array_of_derivatives_is_one_member() -> None:
    vector = Vector(
        {programs.ref("known:i"): 1.0, programs.ref("known:i:1"): 2.0}, {}, {}, ((0.0, 1.0),) * 2
    )
    found = Golden({}, (vector,), ())
    tables = _vectors(programs.motor, "c", found).c()["golden_tables"]
    assert isinstance(tables, list)
    assert tables[0]["lines"] == ["    {N(0.0), {N(1.0), N(2.0)}, N(0.0), N(0.0)},"]
    assert tables[2]["lines"] == ["    {0},"] and tables[3]["lines"] == ["    {{0}},"]
    (line,) = _lines(_vectors(programs.motor, "python", found).python()["golden_exact"])
    assert "i=(1.0, 2.0), y=0.0," in line


def _lines(found: object) -> list[str]:
    assert isinstance(found, list)
    return found
