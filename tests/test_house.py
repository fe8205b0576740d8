"""How the package is built: no circles, one name a module, each word and each function once."""

from __future__ import annotations

import ast

from tests import house

RECORD = {"ir.functions"}
NUMBERS = {
    "algebra.numeric", "algebra.symbolic", "field.balls", "field.numbers", "field.prime",
    "field.series", "runtime.batch",
}  # fmt: skip
LANGUAGES = {
    "backends.c", "backends.python", "notation.latex", "notation.mathml", "notation.parsable",
}  # fmt: skip


def test_no_modules_import_each_other() -> None:
    assert house.circles(house.modules()) == []


def test_no_two_modules_share_a_name() -> None:
    assert house.names_met_twice(house.modules()) == []


def test_no_file_is_longer_than_an_idea() -> None:
    long = {f.name: f.lines for f in house.modules() if f.lines > 600}
    assert long == {}, "which ideas are in it?"


def test_each_word_of_the_vocabulary_is_defined_once() -> None:
    assert [w for w in house.WORDS if len(house.definitions(house.modules(), w)) != 1] == []


def test_functions_have_names_in_their_record_and_in_tables_only() -> None:
    files = house.modules()
    knowing = {name.removeprefix("bondgraph.") for name in house.knowing_functions(files)}
    assert sorted(knowing - RECORD - NUMBERS - LANGUAGES) == []


def test_files_get_their_names_in_one_place_only() -> None:
    """What puts a file under its name is `text.whole_file`; a journal is appended to by itself."""
    renames = {"replace", "rename", "mkstemp", "mkdtemp", "NamedTemporaryFile", "fsync"}
    found = {
        (file.name.removeprefix("bondgraph."), node.func.attr)
        for file in house.modules()
        for node in ast.walk(file.tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)
        and node.func.attr in renames
        and (node.func.attr != "replace" or len(node.args) == 1 or _of_os(node.func))
    }  # fmt: skip
    assert found == {
        ("backends.write", "replace"),  # out of a folder that is on the disk
        ("runtime.monitoring.journal", "fsync"),
        ("text.whole_file", "fsync"),
        ("text.whole_file", "replace"),
    }


def _of_os(function: ast.Attribute) -> bool:
    """Whether it is of the system, not of a text."""
    return isinstance(function.value, ast.Name) and function.value.id == "os"


def test_what_is_counted_is_found() -> None:
    g = "def g(n):\n    '''Doc.'''\n    return n.op in (Op.A, Op.B, Op.C)"
    one = house.Module("bondgraph.x.a", ast.parse(f"from bondgraph.y.a import f\n{g}"), 0)
    f = "FN = 'asinh cosh'"
    other = house.Module("bondgraph.y.a", ast.parse(f"from bondgraph.x.a import g\n{f}"), 0)
    both = [one, other]
    assert house.circles(both) == [["bondgraph.x.a", "bondgraph.y.a"]]
    assert house.names_met_twice(both) == ["a"]
    assert house.dispatchers(both) == ["bondgraph.x.a.g"]
    assert house.knowing_functions(both) == ["bondgraph.y.a"]
    assert house.definitions(both, "g") == ["bondgraph.x.a"]
    assert house.statements(both) == 5
