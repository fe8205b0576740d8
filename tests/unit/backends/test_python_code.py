"""Generated Python as text: it imports what it uses, defines what it calls, and fits on a page."""

from __future__ import annotations

import ast
import builtins
import sys
from functools import cache
from types import ModuleType

import pytest

from bondgraph.backends.emit import emit
from bondgraph.backends.spelling import Spelling
from bondgraph.backends.target import load
from tests.unit.backends import programs
from tests.unit.backends.programs import put, ref

_EACH = pytest.mark.parametrize("make", programs.ALL, ids=lambda m: m.__name__)


@cache
def _files(make: programs.Maker) -> dict[str, str]:
    """The Python files of a program, by their paths."""
    found = emit(make(), ("python",), extras=("tests", "exact", "example"))
    return {str(f.path): str(f.text) for f in found if str(f.path).endswith(".py")}


def _code(make: programs.Maker) -> str:
    """The module itself."""
    return next(text for path, text in _files(make).items() if "/" not in path)


@_EACH
def test_what_is_imported_is_used_and_what_is_used_is_there(make: programs.Maker) -> None:
    for path, text in _files(make).items():
        tree = ast.parse(text)
        imported = [
            (alias.asname or alias.name).partition(".")[0]
            for node in ast.walk(tree)
            if isinstance(node, ast.Import | ast.ImportFrom)
            and getattr(node, "module", "") != "__future__"
            for alias in node.names
        ]
        used = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)}
        assert len(set(imported)) == len(imported) and set(imported) <= used, path
        stored = {
            n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)
        }
        stored |= {n.arg for n in ast.walk(tree) if isinstance(n, ast.arg)}
        stored |= {n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef | ast.ClassDef)}
        stored |= {n.name for n in ast.walk(tree) if isinstance(n, ast.ExceptHandler) and n.name}
        assert used <= stored | set(imported) | set(dir(builtins)) | {"__file__"}, path


@_EACH
def test_helpers_are_there_where_they_are_called_and_nowhere_else(make: programs.Maker) -> None:
    tree = ast.parse(_code(make))
    own = {n.name for n in tree.body if isinstance(n, ast.FunctionDef) if n.name.startswith("_")}
    names = {n.id for n in ast.walk(tree) if isinstance(n, ast.Name)}
    assert own <= names
    assert own or make is not programs.functions  # one of the programs has some


@_EACH
def test_no_line_is_wider_than_the_page(make: programs.Maker) -> None:
    width = load("python").width
    for path, text in _files(make).items():
        assert max(map(len, text.splitlines())) <= width, path


@_EACH
def test_a_parameter_without_a_number_has_to_be_given(
    make: programs.Maker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All others have the number of the model."""
    program, module = make(), ModuleType("generated")
    monkeypatch.setitem(sys.modules, "generated", module)
    exec(compile(_code(make), "generated.py", "exec"), module.__dict__)
    unset = [f.name for f in program.params if f.default is None]
    if unset:
        with pytest.raises(TypeError, match=f"missing {len(unset)} required"):
            module.Parameters()
    names = Spelling(program, load("python")).params
    made = module.Parameters(**{names[name]: 0.5 for name in unset})
    for field in program.params:
        expected = 0.5 if field.default is None else field.default
        assert getattr(made, names[field.name]) == expected


@pytest.mark.parametrize("beyond", [-1, 0, 1])
def test_a_condition_is_broken_only_where_it_is_wider_than_the_page(beyond: int) -> None:
    width = load("python").width
    around = len("        if not math.isfinite(p.):")
    name = "R" * (width + beyond - around)
    program = programs.motor()
    field = program.params[0]._replace(name=name)
    reads = put("coef:R", ref(f"param:{name}"), "R")
    program = program._replace(params=(field,), configure=(reads, *program.configure[2:]))
    text = next(a.text for a in emit(program, ("python",)) if a.path == "motor.py")
    assert (f"        if not math.isfinite(p.{name}):\n" in text) == (beyond <= 0)
    assert max(map(len, text.splitlines())) <= width
