"""The files of a program: which, equal bytes under any hash seed, honest comments."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest

from bondgraph.backends.emit import EXTRAS, emit
from bondgraph.backends.golden import Golden, golden
from bondgraph.backends.target import load, targets
from bondgraph.backends.templates import codegen
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Field, Program, ResidualInfo
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.source import Source
from tests.unit.backends import programs


def _text(path: str, make: programs.Maker = programs.motor) -> str:
    return {a.path: a.text for a in emit(make(), ("c", "python"), extras=EXTRAS)}[path]


def test_few_files_and_more_where_asked_for() -> None:
    few = ["motor.h", "motor.c", "CMakeLists.txt", "motor.py", "README.md"]
    assert [a.path for a in emit(programs.motor(), ("c", "python"))] == few
    every = [a.path for a in emit(programs.motor(), ("c", "python"), extras=EXTRAS)]
    assert [path for path in every if path in few] == few
    assert sorted(path for path in every if path not in few) == [
        "Kconfig",
        "MISRA.md",
        "exact/motor_exact.c",
        "exact/motor_exact.h",
        "exact/motor_exact.py",
        "example/example.c",
        "example/example.py",
        "examples/motor_watch/motor_watch.ino",
        "idf_component.yml",
        "library.json",
        "library.properties",
        "qemu/link.ld",
        "qemu/start.c",
        "ros2/CMakeLists.txt",
        "ros2/node.cpp",
        "ros2/package.xml",
        "tests/golden.h",
        "tests/selftest.c",
        "tests/selftest.py",
        "zephyr/CMakeLists.txt",
        "zephyr/Kconfig",
        "zephyr/module.yml",
    ]
    assert [a.path for a in emit(programs.motor(), ("python",))][-1] == "README.md"


def test_an_unknown_extra_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"'poem'; there are tests, exact, example"):
        emit(programs.motor(), ("c",), extras=("poem",))
    with pytest.raises(Trouble, match="qemu goes with code in C"):
        emit(programs.motor(), ("python",), extras=("qemu", "example"))


def test_an_unknown_target_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"no target 'cobol'; there are c, python"):
        emit(programs.motor(), ("cobol",))
    assert targets() == ("c", "python")


@pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)
def test_same_bytes_under_any_hash_seed(make: programs.Maker) -> None:
    code = (
        "from tests.unit.backends import programs; from bondgraph.backends.emit import emit;"
        f"print(emit(programs.{make.__name__}(), ('c', 'python')))"
    )
    found = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            check=True,
        ).stdout
        for seed in ("0", "1")
    }
    assert len(found) == 1


@pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)
def test_text_is_tidy(make: programs.Maker) -> None:
    for path, text in emit(make(), ("c", "python"), extras=EXTRAS):
        assert text.endswith("\n") and not text.endswith("\n\n"), path
        for line in text.splitlines():
            assert line == line.rstrip(), (path, line)
            assert "\t" not in line
            assert path.endswith(".md") or len(line) <= 100, (path, line)
        assert "\n\n\n\n" not in text and "models/" not in text


def test_every_statement_says_where_it_comes_from() -> None:
    text = _text("exact/motor_exact.c")
    assert "/* motor.bg:3: U - R*i - L*i' */\n    r[MOTOR_R1] = " in text
    text = _text("exact/motor_exact.py")
    assert "# motor.bg:3: U - R*i - L*i'\n        r.r1 = d.U - c.R * d.i[0] - c.L * d.i[1]" in text


def test_every_field_says_unit_and_meaning() -> None:
    text = _text("motor.h")
    assert "motor_real R;  /* Ohm: resistance, el.R (motor.bg:3) */" in text
    assert '#define MOTOR_DIGEST "0123456789abcdef"' in text
    assert "#define MOTOR_ABI (4u * 256u + (uint32_t)sizeof(motor_real))" in text


@pytest.mark.parametrize(
    ("parameter", "head"),
    [
        ("2", "compute_coefficients(m_coefficients *c, real sample_time, real bandwidth)"),
        ("R", "compute_coefficients(m_coefficients *c, const m_parameters *p, real sample_time,"),
    ],
)
def test_coefficients_are_given_the_parameters_that_they_read(parameter: str, head: str) -> None:
    text = f"bg 1\nmodel M {{ param R = 2; 1:s {{ <- Se:u; -> R:r = {parameter}; -> Df:y }} }}\n"
    artifacts = Compilation(Source("m.bg", text)).artifacts
    code = next(a.text for a in artifacts if a.path == "m.c")
    assert f"static void {head}\n" in code


def test_a_comment_cannot_break_out() -> None:
    evil = Field("R", "R", "", "*/ int x; /* \\ ??/ \n # type: ignore \u202e", 1.0)
    program = programs.motor()._replace(params=(evil, programs.motor().params[1]))
    for path, text in emit(program, ("c", "python"), extras=EXTRAS):
        if path == "README.md":
            continue
        assert "\u202e" not in text and "\\ ?" not in text
        if path.endswith((".c", ".h")):
            assert "*/ int" not in text and "??/" not in text
        else:
            assert "type: ignore" not in text


def test_long_texts_are_cut() -> None:
    info = programs.motor().residuals[0]._replace(text="r1 = " + "x + " * 5000 + "x")
    residuals: tuple[ResidualInfo, ...] = (info, programs.motor().residuals[1])
    program = programs.motor()._replace(residuals=residuals)
    header = {a.path: a.text for a in emit(program, ("c",))}["motor.h"]
    assert "..." in header and len(header) < 10_000


def test_readme_has_both_programs_and_the_matrix() -> None:
    text = _text("README.md")
    assert _text("example/example.c") in text and _text("example/example.py") in text
    assert "| x |  | `U`, `R`, `L`, `i` |" in text
    assert "example/example.c motor.c -o watch" in text and "0.25 s after the first sample" in text


def test_numbers_that_float_cannot_hold_are_told_at_compile_time() -> None:
    tiny = Field("L", "L", "H", "", 1e-60)
    program = programs.motor()._replace(params=(programs.motor().params[0], tiny))
    text = {a.path: a.text for a in emit(program, ("c",))}["motor.c"]
    assert '#error "the model has numbers that float cannot hold: 1e-60"' in text
    assert '#error "the model has' not in _text("motor.c")


def test_templates_are_files_with_holes() -> None:
    for path in codegen().rglob("*.j2"):
        lines = path.read_text().splitlines()
        assert len(lines) <= 90, f"{path} is too long for a template"


def test_targets_describe_themselves() -> None:
    for name in targets():
        target = load(name)
        assert target.words <= target.reserved
        files = [*target.files, *(file for own in target.extras.values() for file in own)]
        assert all((codegen() / template).is_file() for template, _ in files)


def test_vectors_are_computed_for_tests_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """They take longer than all the rest; an example does without them."""
    program = programs.motor()
    made = emit(program, ("c",), extras=("tests", "example"))
    (vectors,) = [a.text for a in made if a.path == "tests/golden.h"]
    assert f"GOLDEN_STEP = {len(golden(program).step)}" in vectors and golden(program).step

    def never(of: Program) -> Golden:
        raise AssertionError(of.name)

    monkeypatch.setattr("bondgraph.backends.emit.golden", never)
    alone = emit(program, ("c",), extras=("example",))
    assert [a for a in made if a.path.startswith("example")] == [
        a for a in alone if a.path.startswith("example")
    ]
    with pytest.raises(AssertionError):
        emit(program, ("c",), extras=("tests",))


def test_an_example_sets_a_parameter_that_the_model_gives_no_number() -> None:
    program = programs.motor()
    first, *others = program.params
    bare = program._replace(params=(first._replace(default=None), *others))
    made = {a.path: a.text for a in emit(bare, ("c",), extras=("example",))}
    assert f"parameters.{first.name} = MOTOR_CONSTANT(1.0);" in made["example/example.c"]
    assert made["example/example.c"].count("parameters.") == 1


def test_the_python_of_thresholds_speaks_of_thresholds() -> None:
    program = programs.motor()
    bound = program._replace(bounds=program.name)
    made = {a.path: a.text for a in emit(program, ("python",), thresholds=bound)}["motor.py"]
    says = re.findall(r"Take one sample of every signal, .*; the (\w+)\.", made)
    assert says == ["residuals", "thresholds"]
    classes = re.findall(r"^class (Monitor|Thresholds)\b", made, re.MULTILINE)
    assert classes == ["Monitor", "Thresholds"]
    alone = {a.path: a.text for a in emit(program, ("python",))}["motor.py"]
    assert "class Thresholds" not in alone and "; the thresholds." not in alone
