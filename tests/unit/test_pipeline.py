"""What a user holds in a notebook: texts, options, files, names and what they print."""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from pathlib import Path

import pytest

import bondgraph
from bondgraph.text.renamed import RENAMED

_CIRCUIT = """bg 1
model Circuit { param R = 2 Ohm; 1:loop { <- Se:U; -> R:R; -> Df:i } }
"""


def test_a_text_is_what_the_file_with_it_is(tmp_path: Path) -> None:
    file = tmp_path / "circuit.bg"
    file.write_bytes(b"\xef\xbb\xbf" + _CIRCUIT.replace("\n", "\r\n").encode())
    read, typed = bondgraph.compile(file), bondgraph.compile(file, text=_CIRCUIT)
    assert read.artifacts == typed.artifacts
    assert read.source.text == typed.source.text
    marked = bondgraph.compile(text="\ufeff" + _CIRCUIT.replace("\n", "\r\n"))
    assert marked.source.text == _CIRCUIT


def test_imports_of_a_text_are_beside_its_path(tmp_path: Path) -> None:
    (tmp_path / "part.bg").write_text("bg 1\nmodel Part { port p : in electrical; p -> R:r = 1 }\n")
    text = 'bg 1\nimport Part from "part.bg"\nmodel M { 1:j { <- Se:U; -> Part:x; -> Df:i } }\n'
    c = bondgraph.compile(tmp_path / "unsaved.bg", text=text)
    assert [r.text for r in c.residuals] == ["U - i"]
    with pytest.raises(bondgraph.CompileError) as caught:
        _ = bondgraph.compile(text=text).graph
    assert caught.value.diagnostics[0].labels[0].span.source.path == "<text>"


def test_a_text_may_have_several_models() -> None:
    text = _CIRCUIT + "model Other { 1:loop { <- Se:U; -> R:r = 3; -> Df:i } }\n"
    assert bondgraph.compile(text=text, model="Other").graph.name == "Other"
    assert bondgraph.compile("odd:name.bg", text=_CIRCUIT).source.path == "odd:name.bg"


def test_half_a_character_is_a_finding_and_no_traceback() -> None:
    with pytest.raises(bondgraph.CompileError, match="not UTF-8 text"):
        bondgraph.compile(text=_CIRCUIT + "# \udce9")


@pytest.mark.parametrize(
    ("path", "said"),
    [(None, "needs the path"), (_CIRCUIT, "one line"), ("no.bg", "does not exist")],
)
def test_what_is_no_path_is_told(path: str | None, said: str) -> None:
    with pytest.raises((TypeError, bondgraph.CompileError), match=said):
        bondgraph.compile(path)


def test_nothing_of_a_compilation_can_be_set() -> None:
    c = bondgraph.compile(text=_CIRCUIT)
    for name in ("options", "source", "model", "open_ports", "residuals"):
        with pytest.raises(AttributeError, match="with_options"):
            setattr(c, name, None)
    with pytest.raises(AttributeError):
        c.options.rate = 5.0
    names = ["c"]
    listed = bondgraph.compile(text=_CIRCUIT, targets=names)
    names.append("python")
    assert listed.options.targets == ("c",)


def test_other_options_are_another_compilation() -> None:
    c = bondgraph.compile(text=_CIRCUIT, rate=500.0, seed=3)
    slow = c.with_options(rate=50.0)
    assert (c.program.rate, slow.program.rate) == (500.0, 50.0)
    assert slow.options == c.options._replace(rate=50.0)
    assert slow.source is c.source


@pytest.mark.parametrize("model", ["dc_motor", "two_tanks", "khepera_encoders"])
def test_another_rate_keeps_what_it_does_not_change(model: str) -> None:
    c = bondgraph.compile(f"models/{model}.bg")
    assert c.artifacts
    other = c.with_options(rate=50.0, bandwidth=3.0)
    assert other.residuals[0].residual is c.residuals[0].residual
    alone = bondgraph.compile(f"models/{model}.bg", rate=50.0, bandwidth=3.0)
    assert other.artifacts == alone.artifacts
    assert other.report.diagnostics == c.report.diagnostics


@pytest.mark.parametrize(
    "options",
    [{"rate": 0.0}, {"rate": float("nan")}, {"rate": 2e11}, {"bandwidth": -1.0},
     {"bandwidth": 1e-320}, {"resolution": -1.0}],
)  # fmt: skip
def test_a_number_that_is_none_of_a_filter_is_refused(options: dict[str, float]) -> None:
    name = next(iter(options))
    wrong = "a positive number" if name == "resolution" else "from 1e-11 to 1e"
    with pytest.raises(ValueError, match=f"{name} must be {wrong}"):
        bondgraph.compile(text=_CIRCUIT, **options)


def test_a_resolution_of_zero_sees_every_term() -> None:
    assert bondgraph.compile(text=_CIRCUIT, resolution=0.0).program.residuals


@pytest.mark.parametrize("options", [{"targets": "c"}, {"decouple": "R"}, {"rat": 5.0}])
def test_options_that_are_none_are_type_errors(options: dict[str, object]) -> None:
    with pytest.raises(TypeError, match=next(iter(options))):
        bondgraph.compile(text=_CIRCUIT, **options)


def test_a_repr_computes_nothing() -> None:
    c = bondgraph.compile("models/dc_motor.bg")
    before = set(vars(c))
    assert repr(c) == "Compilation(models/dc_motor.bg)"
    assert set(vars(c)) == before
    assert c.graph.name == "Motor"
    assert repr(c) == "Compilation(Motor in models/dc_motor.bg: 9 elements, 2 sensors)"
    assert c.signatures.residuals == ("r1", "r2")
    assert repr(c).endswith("9 elements, 2 sensors, 2 residuals)")
    part = bondgraph.compile("models/khepera.bg:Drive")
    assert repr(part) == "Compilation(Drive in models/khepera.bg)"
    wrong = bondgraph.compile(text="bg 1\nmodel M { 1:j { <- Se:U; -> X:r } }\n")
    with pytest.raises(bondgraph.CompileError):
        _ = wrong.graph
    assert repr(wrong) == "Compilation(<text>: There is no element kind or model `X`.)"


def test_the_method_writes_what_the_command_writes(tmp_path: Path) -> None:
    c = bondgraph.compile("models/dc_motor.bg")
    own, other = tmp_path / "own", tmp_path / "other"
    paths = c.write(own)
    done = subprocess.run(
        [sys.executable, "-m", "bondgraph", "compile", "models/dc_motor.bg", "--json", "-o", other],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    files = [str(other / Path(path).relative_to(own)) for path in paths]
    assert json.loads(done.stdout)["files"] == files
    for path, file in zip(paths, files, strict=True):
        assert Path(path).read_bytes() == Path(file).read_bytes()


def test_one_target_may_be_asked_for(tmp_path: Path) -> None:
    c = bondgraph.compile(text=_CIRCUIT)
    python = c.write(tmp_path, targets=["python"])
    assert {Path(p).suffix for p in python} == {".py", ".md"}
    assert {Path(p).suffix for p in c.write(tmp_path)} == {".py", ".md", ".c", ".h", ".txt"}
    with pytest.raises(ValueError, match="no target 'cobol'"):
        c.write(tmp_path, targets=["cobol"])
    with pytest.raises(TypeError, match="a sequence of names"):
        c.write(tmp_path, targets="python")


def test_what_whole_numbers_have_not_is_refused_not_left_out(tmp_path: Path) -> None:
    known = bondgraph.compile(text=_CIRCUIT).program.knowns
    ranges = {k.path: (-12.0, 12.0) for k in known}
    c = bondgraph.compile(text=_CIRCUIT, real="fixed", ranges=ranges)
    with pytest.raises(ValueError, match="--with tests is for double"):
        c.write(tmp_path, extras=["tests"])
    assert list(tmp_path.iterdir()) == []


def test_what_somebody_else_wrote_stays(tmp_path: Path) -> None:
    c = bondgraph.compile(text=_CIRCUIT)
    (tmp_path / "README.md").write_text("mine")
    with pytest.raises(bondgraph.ForeignFiles, match=r"README\.md"):
        c.write(tmp_path)
    assert [p.name for p in tmp_path.iterdir()] == ["README.md"]
    assert (tmp_path / "README.md").read_text() == "mine"


def test_a_model_without_redundancy_has_no_files(tmp_path: Path) -> None:
    c = bondgraph.compile(text="bg 1\nmodel M { 1:j { <- Se:U; -> R:r = 2 } }\n")
    assert c.write(tmp_path / "out") == ()
    assert not (tmp_path / "out").exists()


def test_old_names_give_what_new_ones_give_and_warn() -> None:
    c = bondgraph.compile("models/dc_motor.bg")
    owners = {"Compilation": c, "Relations": c.residuals}
    assert set(owners) == set(RENAMED)
    for kind, names in RENAMED.items():
        for old, new in names.items():
            words = f"{kind}.{old} is called {new} now"
            with pytest.warns(DeprecationWarning, match=words) as said:
                found = getattr(owners[kind], old)
            assert said[0].filename == __file__
            value: object = owners[kind]
            for part in new.split("."):
                value = getattr(value, part)
            assert found == value
            assert old not in dir(owners[kind])


def test_an_unknown_name_and_a_failing_property_keep_their_own_words(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    c = bondgraph.compile(text=_CIRCUIT)
    with pytest.raises(AttributeError, match="'Compilation' object has no attribute 'residual'"):
        getattr(c, "residual")  # noqa: B009
    monkeypatch.delattr("bondgraph.frontend.parser.parse")
    with pytest.raises(ImportError, match="parse"):
        _ = c.syntax


def test_all_that_is_offered_is_there_and_light_until_it_is_used() -> None:
    program = (
        "import sys, bondgraph\n"
        "heavy = {'numpy', 'sympy', 'scipy', 'networkx', 'bondgraph.compilation'}\n"
        "print(sorted(heavy & set(sys.modules)))\n"
        "print(all(hasattr(bondgraph, name) for name in bondgraph.__all__))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\nTrue\n"
    offered = {n: m for m, names in bondgraph._FROM.items() for n in names}
    assert sorted(offered) == bondgraph.__all__
    assert set(bondgraph.__all__) <= set(dir(bondgraph))
    for name, module in offered.items():
        found = getattr(importlib.import_module(f"bondgraph.{module}"), name)
        assert getattr(bondgraph, name) is found
    with pytest.raises(AttributeError, match="no attribute 'compyle'"):
        getattr(bondgraph, "compyle")  # noqa: B009
