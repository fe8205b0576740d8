"""Models that the compiler was not written for, each answer judged by an independent simulator."""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from bondgraph.cli.main import main
from tests.adversary import (
    plants_domains,
    plants_laws,
    plants_machines,
    plants_mechanical,
    plants_other,
    plants_power,
    plants_roots,
    plants_unseen,
)
from tests.adversary.fuzz import generate
from tests.adversary.judge import judge, judge_all_modes
from tests.adversary.plant import HERE, Plant, Simulator, counts
from tests.adversary.verdicts import VERDICTS, Verdict

FILES = (
    plants_power,
    plants_mechanical,
    plants_other,
    plants_laws,
    plants_roots,
    plants_domains,
    plants_machines,
    plants_unseen,
)
PLANTS = {p.name: p for file in FILES for p in file.PLANTS}
SLOW = {"double_mtf"}
#: Random plants; with `make judged` those, too, that are judged for up to a minute.
SEEDS = (1, 4, 7, 8) + (2, 5, 10, 11, 13, 14, 16, 19, 21, 22) * ("BONDGRAPH_MORE" in os.environ)
EXIT = {"ok": 0, "no_arr": 0, "error": 1, "refused": 1}

# L, R, U and y of one circuit, called by names that mean something to somebody else.
WORDS = """lambda:int:register:main I:E:S:N pi:D:Int:ssqrt exp:log:Abs:Piecewise e:f:q:p
struct:double:float:volatile print:yield:class:None1 t:dt:self:state gamma:beta:zeta:Symbol
nan:inf:zoo:oo sin:cos:tan:sqrt asm:auto:inline:restrict x_:a_:b_:c_1 step:init:first:known
Min:Max:And:Or Not:Eq:Lt:Ne in:out:when:port model:sensor:input:let errno:stdin:NULL:EOF
M_PI:INFINITY:NAN:real uint32_t:size_t:isfinite:math del:with:is:import j0:jn:y0:near
unix:linux:i386:signed new:delete:this:template async:await:match:case np:sympy:len:id""".split()


def compiled(path: Path, out: Path) -> dict[str, Any]:
    """The JSON of a compilation in this process; its exit status must fit."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        status = main(["compile", str(path), "--json", "-o", str(out), "--with", "tests,exact"])
    answer: dict[str, Any] = json.loads(printed.getvalue())
    assert status == EXIT[answer["status"]]
    assert all(Path(f).is_file() for f in answer["files"])
    assert bool(answer["files"]) == (answer["status"] == "ok")
    return answer


def self_tests(out: Path) -> None:
    """The generated Python and C agree with their golden vectors."""
    for test in sorted((out / "tests").glob("selftest*.py")):
        command = [sys.executable, f"tests/{test.name}"]
        run = subprocess.run(command, cwd=out, capture_output=True, check=False)
        assert run.returncode == 0, run.stdout + run.stderr
    gcc = shutil.which("gcc")
    if gcc is None:
        return
    code = [str(f) for f in (*out.glob("*.c"), *out.glob("exact/*.c"))]
    flags = "-std=c99 -O0 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror".split()
    flags += [f"-I{out}", f"-I{out / 'exact'}"]
    for test in sorted((out / "tests").glob("selftest*.c")):
        made = subprocess.run(
            [gcc, *flags, str(test), *code, "-o", str(out / "selftest"), "-lm"],
            capture_output=True,
            check=False,
        )
        assert made.returncode == 0, made.stderr
        run = subprocess.run([str(out / "selftest")], cwd=out, capture_output=True, check=False)
        assert run.returncode == 0, run.stdout + run.stderr


@pytest.mark.parametrize(
    "name",
    [pytest.param(n, marks=pytest.mark.slow) if n in SLOW else n for n in PLANTS],
)
def test_an_answer_stands_before_the_judge(name: str, tmp_path: Path) -> None:
    plant = PLANTS[name]
    answer = compiled(HERE / "models" / f"{name}.bg", tmp_path)
    assert judge_all_modes(plant, answer) == []
    if answer["status"] == "ok":
        self_tests(tmp_path)


def test_the_judge_sees_a_wrong_answer(tmp_path: Path) -> None:
    plant = PLANTS["dc_iw"]
    answer = compiled(HERE / "models" / "dc_iw.bg", tmp_path)
    other_sign = plant._replace(equations=plant.equations.replace("- f*w", "+ f*w"))
    assert any("does not vanish" in text for text in judge(other_sign, answer))
    answer["arrs"][0]["signature"].remove("R")
    assert any("moves with R" in text for text in judge(plant, answer))
    answer["arrs"][0]["orders"]["yi"] = 0
    assert any("orders" in text for text in judge(plant, answer))


@pytest.mark.parametrize("verdict", VERDICTS, ids=lambda v: v.name)
def test_a_verdict(verdict: Verdict, tmp_path: Path) -> None:
    answer = compiled(HERE / "models" / f"{verdict.name}.bg", tmp_path)
    assert (answer["status"], answer["n_arr"]) == (verdict.status, verdict.n_arr)
    errors = {d["code"] for d in answer["diagnostics"] if d["severity"] == "error"}
    assert errors == ({verdict.code} if verdict.status in ("error", "refused") else set())
    assert not verdict.code or verdict.code in {d["code"] for d in answer["diagnostics"]}


@pytest.mark.parametrize("words", WORDS)
def test_names_that_mean_something_elsewhere(words: str, tmp_path: Path) -> None:
    low, r, u, y = words.split(":")
    plant = Plant(
        "names",
        f"bg 1\nmodel M {{ # ünïcode ∀\n param {low} = 0.7; param {r} = 1.2; input {u}\n"
        f" 1:jj {{ <- Se:s = {u}; -> I:i1 = {low}; -> R:rr = {r}; -> Df:{y} }}\n}}\n",
        "U - D(p) - R*v; p - L*v",
        {"Y": "v"},
        1,
        params="L R",
        inputs="U",
        alias={low: "L", r: "R", u: "U", y: "Y"},
    )
    path = tmp_path / "names.bg"
    path.write_text(plant.text, encoding="utf-8")
    assert judge(plant, compiled(path, tmp_path / "out")) == []
    self_tests(tmp_path / "out")


@pytest.mark.parametrize("seed", SEEDS)
def test_a_random_graph(seed: int, tmp_path: Path) -> None:
    plant = generate(seed, nonlinear=False)
    path = tmp_path / "random.bg"
    path.write_text(plant.text, encoding="utf-8")
    answer = compiled(path, tmp_path / "out")
    sim = Simulator(plant, 6)
    anywhere = [sim.poly(sim.lead(v), True, 0.3) for v in sim.variables]
    if not counts(sim, anywhere).regular:
        # Something runs in a ring that nothing determines: refused, or told of by name.
        codes = {d["code"] for d in answer["diagnostics"]}
        assert answer["status"] == "error" or codes & {"junction-ring", "loop-gain-one"}
        return
    try:
        sim.solve()
    except ArithmeticError:
        return  # dependent storages with initial values that contradict each other
    n = counts(sim).n_arr
    assert judge(plant._replace(n_arr=n, status="ok" if n else "no_arr"), answer) == []
