"""What each command does to models: results, files, exit status."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest
import sympy

import bondgraph as package
from bondgraph.runtime.diagnosis.tuning import Tuning
from tests.unit.cli.conftest import MODELS, Command

MOTOR = MODELS / "dc_motor.bg"
WriteModel = Callable[[str], Path]

LOOP = """bg 1
model Stuck {
    Se:U -> 1:a -> 0:b -> 1:c
    a -> R:r1 { 0 = e - f - f^5 + tanh(f) }
    b -> R:r3 { 0 = f - sin(e) - e^3 - exp(e) }
    c -> R:r4 { 0 = e - f^7 - cosh(f)*e }
    c -> C:C = 1
    sensor y = r4.e*r4.f + tanh(r3.f)
    sensor z = r4.e*r3.f + tanh(r4.f)
}
"""


def test_check_says_what_is_sound(bondgraph: Command) -> None:
    done = bondgraph("check", MOTOR)
    assert (done.status, done.err) == (0, "")
    assert done.out.endswith("Motor is sound (9 elements, 2 junctions, 10 bonds, 2 sensors)\n")


def test_check_takes_a_part_with_open_ports_but_compile_does_not(
    bondgraph: Command, tmp_path: Path
) -> None:
    part = f"{MODELS / 'khepera.bg'}:Gear"
    assert bondgraph("check", part).status == 0
    done = bondgraph("compile", part, "-o", tmp_path / "out")
    assert done.status == 1 and "port" in done.err
    assert not (tmp_path / "out").exists()


def test_check_goes_on_after_a_wrong_model(bondgraph: Command, model: WriteModel) -> None:
    done = bondgraph("check", model("bg 1\nmodel M {\n    R:x = y\n}\n"), MOTOR)
    assert done.status == 1 and "Motor is sound" in done.out and "error" in done.err


def test_check_json(bondgraph: Command, model: WriteModel) -> None:
    found = json.loads(bondgraph("check", MOTOR, "--json").out)
    assert found["status"] == "ok" and found["diagnostics"] == []
    found = json.loads(bondgraph("check", model("bg 1\nmodel M {"), "--json").out)
    assert found["status"] == "error" and found["diagnostics"][0]["labels"][0]["line"] == 2


def test_compile_writes_below_the_folder_it_is_told(bondgraph: Command, tmp_path: Path) -> None:
    done = bondgraph("compile", MOTOR, "-o", tmp_path / "out")
    assert done.status == 0 and "2 residuals detect 9 of 9 faults, in 3 groups" in done.out
    written = {p.name for p in (tmp_path / "out").rglob("*") if p.is_file()}
    assert {"motor.c", "motor.h", "README.md"} & written
    assert len([name for name in written if name.endswith((".c", ".py", ".h"))]) == 3


def test_compile_writes_to_generated_by_default(
    bondgraph: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    found = json.loads(bondgraph("compile", MOTOR, "--json").out)
    assert found["files"]
    for path in found["files"]:
        assert path.startswith(os.path.join("generated", "dc_motor")) and Path(path).is_file()


def test_compile_json_is_read_by_sympy(bondgraph: Command, tmp_path: Path) -> None:
    found = json.loads(bondgraph("compile", MOTOR, "--json", "-o", tmp_path).out)
    assert found["status"] == "ok" and found["n_arr"] == len(found["arrs"]) == 2
    by_faults = {tuple(sorted(arr["signature"])): arr for arr in found["arrs"]}
    armature = by_faults[tuple(sorted(["L", "R", "k", "U", "current", "speed"]))]
    names = {name: sympy.Symbol(name) for name in armature["symbols"]}
    expr = sympy.parse_expr(armature["expr"], local_dict=names)
    L, R, k, U, current, speed = sympy.symbols("L R k U current speed")
    flow = sympy.Function("flow")(sympy.Symbol("t"))
    # Written by hand: U = L i' + R i + k w.
    expected = L * sympy.Derivative(flow) + R * current + k * speed - U
    derivative = sympy.Function("D")
    found_expr = expr.replace(
        derivative, lambda x, n: sympy.diff(x.subs(current, flow), sympy.Symbol("t"), n)
    )
    ratio = sympy.simplify(found_expr / expected)
    assert ratio.is_number and ratio != 0
    assert armature["orders"] == {"U": 0, "current": 1, "speed": 0}
    assert found["undetectable"] == []
    assert sorted(map(sorted, found["groups"])) == [
        ["J", "f", "load"],
        ["L", "R", "U"],
        ["current", "k", "speed"],
    ]


def test_no_redundancy_is_a_right_answer(
    bondgraph: Command, model: WriteModel, tmp_path: Path
) -> None:
    path = model("bg 1\nmodel M {\n    Se:U -> 1:j -> R:R = 3 Ohm\n}\n")
    done = bondgraph("compile", path, "--json", "-o", tmp_path / "out")
    found = json.loads(done.out)
    assert done.status == 0 and found["status"] == "no_arr"
    assert found["n_arr"] == 0 and found["files"] == [] and found["undetectable"] == ["U"]
    assert not (tmp_path / "out").exists()
    assert "no residual" in bondgraph("compile", path, "-o", tmp_path / "out").out


def test_a_loop_that_cannot_be_solved_is_refused(
    bondgraph: Command, model: WriteModel, tmp_path: Path
) -> None:
    done = bondgraph("compile", model(LOOP), "--json", "-o", tmp_path / "out")
    found = json.loads(done.out)
    assert done.status == 1 and found["status"] == "refused" and "loop" in found["message"]
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_written_is_told(bondgraph: Command, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    done = bondgraph("compile", MOTOR, "-o", tmp_path / "file" / "out")
    assert done.status == 1 and "file" in done.err and "bug" not in done.err


def test_what_is_wanted_besides_the_code_adds_up(bondgraph: Command, tmp_path: Path) -> None:
    bondgraph("compile", MOTOR, "-o", tmp_path, "--with", "tests", "--with", "exact,tests")
    assert {p.name for p in tmp_path.iterdir() if p.is_dir()} == {"tests", "exact"}


def test_unknown_target_is_wrong_usage(bondgraph: Command, tmp_path: Path) -> None:
    done = bondgraph("compile", MOTOR, "--target", "cobol", "-o", tmp_path / "out")
    assert done.status == 2 and "cobol" in done.err and "python" in done.err


def test_two_compilations_write_the_same_bytes(bondgraph: Command, tmp_path: Path) -> None:
    for folder in ("a", "b"):
        assert bondgraph("compile", MOTOR, "-o", tmp_path / folder).status == 0
    one = {p.relative_to(tmp_path / "a"): p.read_bytes() for p in (tmp_path / "a").rglob("*.*")}
    two = {p.relative_to(tmp_path / "b"): p.read_bytes() for p in (tmp_path / "b").rglob("*.*")}
    assert one == two


def test_format_rewrites_in_place_and_check_only_looks(
    bondgraph: Command, model: WriteModel
) -> None:
    ugly = "bg 1\nmodel   M{\nSe:U->1:j;j->R:R=3 Ohm\n}\n"
    path = model(ugly)
    assert bondgraph("format", path, "--check").status == 1
    assert path.read_text() == ugly
    assert bondgraph("format", path).status == 0
    assert path.read_text() != ugly
    assert bondgraph("format", path, "--check").status == 0
    assert bondgraph("check", path).status == 0


def test_format_leaves_a_wrong_file_alone(bondgraph: Command, model: WriteModel) -> None:
    path = model("bg 1\nmodel M {\n")
    done = bondgraph("format", path)
    assert done.status == 1 and done.err and path.read_text() == "bg 1\nmodel M {\n"
    assert [p.name for p in path.parent.iterdir()] == ["model.bg"]


def test_format_from_stdin(bondgraph: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    import io

    monkeypatch.setattr("sys.stdin", io.StringIO("bg 1\nmodel M{Se:U->1:j}\n"))
    done = bondgraph("format", "-")
    assert done.status == 0 and "Se:U -> 1:j" in done.out


@pytest.mark.parametrize(
    ("stage", "part"),
    [
        ("syntax", "Model name='Motor'"),
        ("graph", "armature -> L"),
        ("integral", "preferred by L"),
        ("derivative", "dualised"),
        ("causal", "preferred derivative causality"),
        ("equations", "balance"),
        ("residuals", "left over is"),
        ("signatures", "groups"),
        ("program", "configure"),
    ],
)
def test_dump_prints_every_stage(bondgraph: Command, stage: str, part: str) -> None:
    done = bondgraph("dump", MOTOR, "--stage", stage)
    assert done.status == 0 and part in done.out


def test_explain_a_residual_follows_its_path(bondgraph: Command) -> None:
    out = bondgraph("explain", MODELS / "khepera.bg", "r1").out
    # The current is taken from the torque, through the gyrator and against the strokes.
    assert "m[1].el.i.f = m[1].el.k.e2/m[1].el.k" in out and "bicausal" in out
    assert "Highest derivatives" in out and "m[1].el.Re" in out


def test_explain_other_things(bondgraph: Command) -> None:
    assert "one flow" in bondgraph("explain", MOTOR, "armature").out
    assert "moves r" in bondgraph("explain", MOTOR, "load").out
    bond = bondgraph("explain", MODELS / "khepera.bg", "20").out
    assert "body.surge -[20]-> body.m" in bond and "stroke" in bond
    undetectable = bondgraph("explain", MODELS / "khepera.bg", "body.m").out
    assert "undetectable" in undetectable and "body.surge" in undetectable
    assert "\\dot" in bondgraph("explain", MOTOR, "r1", "--latex").out
    assert bondgraph("explain", "causality-conflict").out.startswith("# causality-conflict")


def test_explain_says_which_two_faults_look_like_one(bondgraph: Command) -> None:
    """The motor has two residuals; the robot two for each side, and one for its line."""
    assert "any two other faults that could be told apart" in bondgraph("explain", MOTOR, "k").out
    out = bondgraph("explain", MODELS / "khepera.bg", "m[1].me.K").out
    sets = out.partition("could be any two, at once, of\n")[2]
    assert "m[1].ge.N, m[1].wh.Js or 3 more" in sets
    assert "m[2]" not in sets and "line" not in sets
    assert "no two faults of other" in bondgraph("explain", MODELS / "khepera.bg", "line.L").out


def test_explain_derives_a_residual(bondgraph: Command, tmp_path: Path) -> None:
    out = bondgraph("explain", MOTOR, "r1", "--derive").out
    assert " 7  storage L, line 15: differentiate its state for L.e\n" in out
    assert "           = L*D(current)  (with 5)\n" in out
    assert out.endswith("\n\nSymPy agrees: what it derived is the compiler's r1.\n")
    drive = bondgraph("explain", MODELS / "drive.bg", "r1", "--derive").out
    assert max(map(len, drive.splitlines())) < 110
    latex = bondgraph("explain", MOTOR, "r1", "--derive", "--latex").out
    assert latex.count("\\begin{aligned}") == latex.count("\\end{aligned}") == 8
    path = tmp_path / "r1.ipynb"
    assert bondgraph("explain", MOTOR, "r1", "--derive", "-o", path).out == f"written to {path}\n"
    assert json.loads(path.read_text())["nbformat"] == 4


def test_explain_derives_nothing_else(bondgraph: Command, tmp_path: Path) -> None:
    done = bondgraph("explain", MOTOR, "load", "--derive")
    assert done.status == 2 and "no residual" in done.err
    done = bondgraph("explain", MOTOR, "r1", "--derive", "-o", tmp_path / "r1.docx")
    assert done.status == 1 and ".ipynb, .py" in done.err and not list(tmp_path.iterdir())
    done = bondgraph("explain", MOTOR, "r1", "-o", tmp_path / "r1.py")
    assert done.status == 2 and "--derive" in done.err
    crank = MODELS.parent / "tests" / "adversary" / "models" / "two_links.bg"
    done = bondgraph("explain", crank, "r2", "--derive", "-o", tmp_path / "r2.py")
    assert done.status == 0 and "note: Here the replay of r2 stops" in done.err


def test_explain_suggests_a_name(bondgraph: Command) -> None:
    done = bondgraph("explain", MOTOR, "armatur")
    assert done.status == 2 and "armature" in done.err


def test_draw_marks_a_conflict_and_fails(bondgraph: Command, tmp_path: Path) -> None:
    model, path = tmp_path / "m.bg", tmp_path / "m.svg"
    model.write_text("bg 1\nmodel M {\n    Se:a -> 0:n <- Se:b\n    n -> R:r = 1\n}\n")
    drawn = bondgraph("draw", model, "-o", path)
    assert drawn.status == 1
    assert "error[causality-conflict]: The effort of 0:n is imposed twice" in drawn.err
    assert drawn.out == f"{path}: M with its conflict marked\n"
    assert "Conflict: The effort of 0:n is imposed twice" in path.read_text()


def test_draw_writes_a_figure(bondgraph: Command, tmp_path: Path) -> None:
    path = tmp_path / "figures" / "motor.svg"
    assert bondgraph("draw", MOTOR, "-o", path).status == 0
    assert path.read_text().startswith("<svg")
    derivative = bondgraph("draw", MOTOR, "--derivative", "-o", "-")
    assert derivative.out.startswith("<svg") and derivative.out != path.read_text()


@pytest.mark.parametrize("how", (("--isolate",), ("--form", "observer:r1")))
def test_a_tuning_says_which_residuals_it_is_for(
    bondgraph: Command, tmp_path: Path, how: tuple[str, ...]
) -> None:
    """Who tuned with `--isolate` or `--form` need not say so again wherever the tuning is used."""
    found, log, out = tmp_path / "tuning.json", tmp_path / "log.csv", tmp_path / "out"
    (tmp_path / "run.toml").write_text('duration = "8 s"\n'
                                       '[inputs]\nU = "6*(1 + 0.3*sin(t))"\nload = 0\n'
                                       "[sensors.current]\nnoise = 0.001\n"
                                       "[sensors.speed]\nnoise = 0.5\n")  # fmt: skip
    assert bondgraph("simulate", MOTOR, tmp_path / "run.toml", "-o", log).status == 0
    assert bondgraph("tune", MOTOR, log, *how, "-o", found).status == 0
    plain, same = package.compile(MOTOR), package.compile(MOTOR, **(
        {"isolate": True} if how[0] == "--isolate" else {"form": ("r1",)}
    ))  # fmt: skip
    tuning = Tuning.from_json(found.read_text())
    assert plain.tuned(tuning).program.digest == same.tuned(tuning).program.digest
    with pytest.raises(ValueError, match="the residuals with isolate="):
        plain.diagnosis(plain.engine(native=False).configured(bandwidth=tuning.bandwidth), tuning)
    done = bondgraph("compile", MOTOR, "--tuning", found, "-o", out, "--json")
    assert done.status == 0
    assert len(json.loads(done.out)["arrs"]) == len(same.residuals)
    for words in (("monitor", MOTOR, log), ("monitor", MOTOR, log, "--jobs", "1")):
        done = bondgraph(*words, "--tuning", found)
        assert done.status == 0 and "fault" not in done.out


def test_code_takes_limits_of_its_own_tuning_only(bondgraph: Command, tmp_path: Path) -> None:
    found, out = tmp_path / "tuning.json", tmp_path / "out"
    learned = ("tune", MOTOR, "--simulate", tmp_path / "run.toml", "--runs", "1", "-o", found)
    (tmp_path / "run.toml").write_text('duration = "8 s"\n'
                                       '[inputs]\nU = "6*(1 + 0.3*sin(t))"\nload = 0\n'
                                       "[sensors.current]\nnoise = 0.001\n"
                                       "[sensors.speed]\nnoise = 0.5\n")  # fmt: skip
    assert bondgraph(*learned).status == 0
    for wrong, why in (
        (("compile", MODELS / "quarter_car.bg", "--tuning", found), "of another model"),
        (("compile", MOTOR, "--isolate", "--tuning", found), "the residuals with isolate=False"),
        (("compile", MOTOR, "--form", "observer", "--tuning", found), "form='derivative'"),
        (("compile", MOTOR, "--rate", "500", "--tuning", found), "--rate 1000, not for 500"),
        (("compile", MOTOR, "--tuning", tmp_path / "run.toml"), "this is no tuning"),
        (("compile", MOTOR, "--tuning", tmp_path / "none.json"), "none.json"),
    ):
        done = bondgraph(*wrong, "-o", out)
        assert done.status == 1 and why in done.err and not out.exists()
    done = bondgraph("compile", MOTOR, "--tuning", found, "-o", out)
    bandwidth = json.loads(found.read_text())["bandwidth"]
    assert done.status == 0
    assert f"#define MOTOR_BANDWIDTH MOTOR_CONSTANT({bandwidth})" in (
        out / "motor.h"
    ).read_text()
