"""The generated C against MISRA C:2012, as far as cppcheck checks it, and the Power of 10."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Any

import pytest

import bondgraph
from bondgraph.backends.deviations import LONGEST, deviations, long_functions
from bondgraph.backends.emit import emit
from bondgraph.backends.write import write
from bondgraph.ir.artifact import Artifact
from tests.unit.backends import programs
from tests.unit.backends.compilers import run
from tests.unit.backends.fixed_models import RANGES

_ROOT = Path(__file__).parents[2]
#: A model, and programs that need the helpers there are: tables, counts, exponents.
_MODELS = ["dc_motor"]
_PROGRAMS = {make.__name__: make for make in (programs.encoder, programs.functions)}
_ROW = re.compile(r"^\| (\d+\.\d+) \| \w+ \| (.*?) \| .* \|$", re.MULTILINE)
_FOUND = re.compile(r"^(\S+?):(\d+): misra-c2012-(\d+\.\d+)$", re.MULTILINE)
#: Loops that count: to a number, to a name of the model's sizes, to a length that is handed over.
_FOR = re.compile(
    r"for \((\w+) = \w+; (?:op->fresh && )?\1 < \w+(?:\[\w\]\.\w+| \* \w+| - 1u?)?; \+\+\1\) \{"
)

#: A valve whose opening is known, as a map, read forwards; and for its pressure, which is not
#: measured. The flow is told late.
_TEXTS = {
    "forwards": """bg 1
model Forwards {
    input w
    0:n { <- Sf:i; -> C:b = 2; -> De:p; -> 1:s { -> R:v { f = table("map.csv", e, w) } } }
    sensor y = delay(s.f, 20 ms)
}
""",
    "backwards": """bg 1
model Backwards {
    input w
    0:n { <- Sf:i; -> C:b = 2; -> 1:s { -> R:v { f = table("map.csv", e, w) }; -> Df:y } }
}
""",
}

#: The same in whole numbers: a model, by the name of its folder, with tanh, roots, encoders.
_WHOLE = {f"whole_{name}": name for name in ("khepera", "hydraulic_actuator", "khepera_built")}
_ALL = [*_MODELS, *_PROGRAMS, *_TEXTS, *_WHOLE]

_Places = set[tuple[str, str, int]]


def _compiled(model: str, folder: Path) -> list[str]:
    program = _PROGRAMS.get(model)
    if program is not None:
        write(emit(program(), ("c",), extras=["exact", "misra"]), folder)
    elif model in _WHOLE:
        path = _ROOT / "models" / f"{_WHOLE[model]}.bg"
        c = bondgraph.compile(path, real="fixed", ranges=RANGES[_WHOLE[model]], targets=("c",))
        c.write(folder, extras=["misra"])
    else:
        path = _ROOT / "models" / f"{model}.bg"
        if model in _TEXTS:
            path = folder.with_suffix(".bg")
            path.write_text(_TEXTS[model])
            path.with_name("map.csv").write_text("e\\w, 1, 2, 5\n0, 1, 2, 3\n4, 2, 4, 7\n10, 5, 8, 14\n")
        bondgraph.compile(path, targets=("c",)).write(folder, extras=["exact", "misra"])
    return [str(path.relative_to(folder)) for path in sorted(folder.rglob("*.c"))]


def _recorded(folder: Path) -> _Places:
    """Rule, file and line of all deviations; line 0 is the whole file."""
    found: _Places = set()
    for rule, where in _ROW.findall((folder / "MISRA.md").read_text(encoding="utf-8")):
        for path, lines in re.findall(r"`([^`]+)`: ([^;]+)", where):
            found |= {(rule, path, int(x) if x.isdigit() else 0) for x in lines.split(", ")}
    return found


def _checked(folder: Path, sources: list[str]) -> _Places:
    """The same of what cppcheck finds."""
    command = ("cppcheck", "--addon=misra", "--std=c99", "--quiet", "-I.", "-Iexact")
    form = "--template={file}:{line}: {id}"
    told = run("sh", "-c", '"$@" 2>&1', "sh", *command, form, *sources, cwd=folder)
    return {(rule, path, int(line)) for path, line, rule in _FOUND.findall(told)}


@pytest.mark.skipif(shutil.which("cppcheck") is None, reason="needs cppcheck")
def test_the_record_is_what_cppcheck_finds(tmp_path: Path) -> None:
    """Nothing is found that is not recorded, and no rule is recorded that is kept everywhere."""
    rules = set()
    for model in _ALL:
        folder = tmp_path / model
        checked, recorded = _checked(folder, _compiled(model, folder)), _recorded(folder)
        whole = {(rule, path) for rule, path, line in recorded if not line}
        assert {f for f in checked - recorded if f[:2] not in whole} == set(), model
        rules |= {rule for rule, _, _ in checked}
        assert len(checked) > 20  # the addon has run
    assert rules == {d.rule for d in deviations()}


def test_loops_are_bounded_and_long_functions_are_named(tmp_path: Path) -> None:
    for model in [*_ALL, "khepera_encoders"]:
        folder = tmp_path / model
        for source in _compiled(model, folder):
            text = (folder / source).read_text(encoding="utf-8")
            code = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
            assert not re.search(r"\b(?:goto|malloc|setjmp)\b|\(\*\w+\)\(", code)
            told = re.findall(rf"`{source}`: ([\d, ]+)", _record(folder).partition("Power of")[2])
            excused = {int(line) for lines in told for line in lines.split(", ")}
            for at, line in enumerate(text.split("\n"), 1):
                loop = re.search(r"\bfor \(.*|\bwhile \(.*", line)
                if loop and not line.lstrip().startswith(("*", "/*")):
                    assert _FOR.fullmatch(loop[0]) or at in excused, line
            for name, body in _functions(text):
                count = len(body)
                row = f"| `{source}` | `{name}` | {count} |"
                assert (count > LONGEST) == (row in _record(folder)), row
                assert not re.search(rf"\b{name}\(", "\n".join(body))


def _record(folder: Path) -> str:
    return (folder / "MISRA.md").read_text(encoding="utf-8")


def _functions(text: str) -> list[tuple[str, list[str]]]:
    """Functions and their lines, from brace to brace."""
    found, name, start = [], "", -1
    lines = text.split("\n")
    for at, line in enumerate(lines):
        if line == "{":
            head = "\n".join(lines[max(0, at - 8) : at])
            name, start = re.findall(r"(\w+)\(", head)[-1], at
        elif line == "}" and start >= 0:
            found.append((name, lines[start + 1 : at]))
            start = -1
    return found


def test_a_long_function_is_found() -> None:
    text = "static int f(int x)\n{\n" + "    x = 1;\n" * 61 + "}\n\nint g(void)\n{\n    f(1);\n}\n"
    assert list(long_functions({"a.c": text})) == [("a.c", "f", 61)]


def test_no_generated_function_is_long() -> None:
    """Of all models that are shipped, with thresholds and `diagnose`: the longest has one page."""
    lengths = {
        (path.name, name): len(body)
        for path in (_ROOT / "generated").rglob("*.[ch]")
        for name, body in _functions(path.read_text(encoding="utf-8"))
    }
    assert len(lengths) > 500
    assert max(lengths.values()) <= LONGEST, max(lengths, key=lengths.__getitem__)


@pytest.mark.parametrize(
    ("path", "options", "name"),
    [
        ("tests/adversary/models/induction.bg", {}, "run_r2"),
        ("models/khepera.bg", {"form": "observer"}, "run_r5"),
        ("models/khepera.bg", {"form": "observer", "real": "fixed"}, "run_r5"),
    ],
)
def test_long_procedures_are_cut(path: str, options: dict[str, Any], name: str) -> None:
    """What would be longest, in each way of writing it; exact residuals, too."""
    ranges = {"ranges": RANGES["khepera"]} if options.get("real") else {}
    c = bondgraph.compile(_ROOT / path, targets=("c",), **options, **ranges)
    extras = () if ranges else ("exact", "tests", "example")
    texts = [file.text for file in c.with_options(extras=extras).artifacts
             if isinstance(file, Artifact) and file.path.endswith((".c", ".h"))]  # fmt: skip
    found = [one for text in texts for one in _functions(text)]
    assert any(called.startswith(f"{name}_") for called, _ in found)
    assert [(called, len(body)) for called, body in found if len(body) > LONGEST] == []
