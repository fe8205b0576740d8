"""A model of which one relation cannot be had: what every command says, and does all the same.

A swing whose angle at the start is not declared, beside a coil and a tank.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.adversary.judge import judge
from tests.adversary.plant import Plant
from tests.adversary.test_adversary import compiled, self_tests
from tests.unit.cli.conftest import Command
from tests.unit.cli.test_report import Page

TEXT = """bg 1
model Three {
    param m = 2
    param L = 1
    param A = 2
    1:v { <- Se:F; -> I:m; -> C:pend { e = q + 2*sin(q) }; -> Df:y }
    1:a { <- Se:U; -> R:R = 2; -> I:L; -> Df:i }
    0:t { <- Sf:Q; -> C:A; -> R:out { f = ssqrt(e) }; -> De:p }
}
"""
WHY = "The relation at `v` needs the initial value of `pend`, which the model does not declare."
SEES = "the relation at `v` might see it, and could not be had"
THREE = Plant(
    "three",
    TEXT,
    "F - D(P) - q - 2*sin(q); P - m*v; v - D(q); "
    "U - D(l) - 2*j; l - L*j; Q - D(z) - sqrt(h); z - A*h",
    {"y": "v", "i": "j", "p": "h"},
    2,
    params="m L A",
    inputs="F U Q",
)


@pytest.fixture
def three(tmp_path: Path) -> Path:
    path = tmp_path / "three.bg"
    path.write_text(TEXT, encoding="utf-8")
    return path


def test_the_others_stand_before_the_judge(three: Path, tmp_path: Path) -> None:
    answer = compiled(three, tmp_path / "out")
    assert judge(THREE, answer) == []
    self_tests(tmp_path / "out")


def test_what_could_be_told_apart_at_best_is_not_known(three: Path, bondgraph: Command) -> None:
    done = bondgraph("isolate", three)
    assert "Told apart at best by the structure" in done.out
    assert "by the laws themselves" not in done.out
    assert json.loads(bondgraph("isolate", three, "--json").out)["best"] is None


def test_json_names_it(three: Path, tmp_path: Path, bondgraph: Command) -> None:
    done = bondgraph("compile", three, "--json", "-o", tmp_path / "out")
    found = json.loads(done.out)
    assert (done.status, found["status"], found["n_arr"]) == (0, "ok", 2)
    assert found["missing"] == [{"about": "v", "reason": WHY, "elements": ["pend"]}]
    (finding,) = [d for d in found["diagnostics"] if d["severity"] != "info"]
    assert (finding["severity"], finding["code"]) == ("warning", "initial-value-needed")
    assert "`(q0 = 0)`" in finding["help"] and finding["labels"][0]["line"] == 6
    assert found["message"].endswith("; 1 relation could not be had")
    assert found["undetectable"] == ["m", "F", "y"]
    assert set(found["reasons"].values()) == {SEES}
    assert found["files"] and all(Path(f).is_file() for f in found["files"])


def test_a_whole_answer_misses_nothing(tmp_path: Path, bondgraph: Command) -> None:
    path = tmp_path / "whole.bg"
    path.write_text(TEXT.replace("C:pend ", "C:pend(q0 = 0) "), encoding="utf-8")
    found = json.loads(bondgraph("compile", path, "--json", "-o", tmp_path / "out").out)
    assert (found["n_arr"], found["missing"], found["undetectable"]) == (3, [], [])


def test_nothing_at_all_is_refused_with_an_empty_list(tmp_path: Path, bondgraph: Command) -> None:
    path = tmp_path / "swing.bg"
    lines = TEXT.splitlines(keepends=True)
    path.write_text("".join([*lines[:3], lines[5], lines[8]]), encoding="utf-8")
    done = bondgraph("compile", path, "--json", "-o", tmp_path / "out")
    found = json.loads(done.out)
    assert (done.status, found["status"], found["missing"]) == (1, "refused", [])
    assert not (tmp_path / "out").exists()


def test_the_terminal_says_it_in_words(three: Path, tmp_path: Path, bondgraph: Command) -> None:
    done = bondgraph("compile", three, "-o", tmp_path / "out")
    assert done.status == 0
    assert "Missing\n  balance of v, line 6\n" in done.out
    words = " ".join(done.out.split())  # lines are as wide as the terminal
    assert f"Missing balance of v, line 6 {WHY}" in words
    assert f"m, F, y {SEES}" in words
    assert "warning[initial-value-needed]" in done.err


def test_explain_tells_why_and_what_to_do(three: Path, bondgraph: Command) -> None:
    for name in ("v", "pend"):
        done = bondgraph("explain", three, name)
        assert done.status == 0
        words = " ".join(done.out.split())  # lines are as wide as the terminal
        assert f"missing balance of v, line 6 {WHY}" in words and "(q0 = 0)" in words
    assert f"undetectable: {SEES}" in bondgraph("explain", three, "m").out
    assert "missing" not in bondgraph("explain", three, "a").out
    assert "missing: balance of v" in bondgraph("dump", three, "--stage", "residuals").out


def test_the_report_has_it_beside_the_relations(
    three: Path, tmp_path: Path, bondgraph: Command
) -> None:
    page = tmp_path / "three.html"
    assert bondgraph("report", three, "-o", page).status == 0
    text = Page(page.read_text(encoding="utf-8")).text
    assert "Missing balance of v, line 6 The relation at v needs the initial value of pend" in text
    assert SEES.replace("`", "") in text.replace("`", "")


def test_what_is_there_detects_and_watches(three: Path, tmp_path: Path, bondgraph: Command) -> None:
    """Half a volt is lost on the way to the coil: integrated by hand, found by the monitor."""
    found = json.loads(bondgraph("detect", three, "--at", "p=1", "--json").out)
    assert {f["residual"] for f in found["faults"]} == {"r1", "r2"}
    time = np.arange(0, 6, 1e-3)

    def rates(t: float, x: np.ndarray) -> list[float]:
        u = 3 + np.sin(7 * t) - (0.5 if t >= 4 else 0.0)
        q = 1 + 0.2 * np.sin(5 * t)
        f = 0.5 * np.sin(3 * t)
        return [(f - x[1] - 2 * np.sin(x[1])) / 2, x[0], u - 2 * x[2],
                (q - np.sqrt(x[3])) / 2]  # fmt: skip

    x = solve_ivp(rates, (0, 6), [0.1, 0.4, 1.5, 1.0], "RK45", time, rtol=1e-9, max_step=0.01).y
    signals = {
        "time": time, "F": 0.5 * np.sin(3 * time), "U": 3 + np.sin(7 * time),
        "Q": 1 + 0.2 * np.sin(5 * time), "y": x[0], "i": x[2], "p": x[3],
    }  # fmt: skip
    noise = np.random.default_rng(1)
    for name in ("y", "i", "p"):
        signals[name] = signals[name] + 1e-3 * noise.standard_normal(len(time))
    log = tmp_path / "log.csv"
    rows = np.column_stack(list(signals.values()))
    np.savetxt(log, rows, delimiter=",", header=",".join(signals), comments="", fmt="%.9g")
    done = bondgraph("monitor", three, log, "--json")
    verdicts = [json.loads(line) for line in done.out.splitlines()]
    faults = [v for v in verdicts if v["event"] == "fault"]
    assert done.status == 0 and faults
    assert 4 <= faults[0]["time"] < 4.5
    assert set(faults[0]["residuals"]) == {"r1"}
    named = {c["fault"] for v in verdicts for c in v["candidates"]}
    assert "U" in named <= {"L", "U", "i"}  # what r1 sees
