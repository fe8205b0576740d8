"""The report of a model: one page, whole, fetching nothing, the same bytes every time."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

from bondgraph.cli.main import main

ROOT = Path(__file__).parents[3]
MODELS = [ROOT / "models" / f"{name}.bg" for name in "cable chassis rc_loop slider_crank".split()]
VOID = frozenset("br hr img input link meta wbr col".split())


class Page(HTMLParser):
    """What a page holds: elements with attributes, text, and whether all tags are closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open, tag
        assert self.open.pop() == tag, tag

    def handle_data(self, data: str) -> None:
        if not {"style", "script"} & set(self.open):
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def report(model: Path, folder: Path, *more: str, status: int = 0) -> str:
    out = folder / "page.html"
    assert main(["report", str(model), "-o", str(out), *more]) == status
    return out.read_text(encoding="utf-8")


def test_what_shows_of_a_stuck_switch(tmp_path: Path) -> None:
    """The oven: r1 is the balance of its heater, where told on P is missing, told off too much."""
    text = report(ROOT / "models" / "oven.bg", tmp_path)
    told_off, told_on = text.split("<h4>on on</h4>")
    assert "<p>on stuck on: moves r1, like Ch.</p>" in told_off
    assert "<p>on stuck off: moves r1, like Ch or P.</p>" in told_on


@pytest.mark.parametrize("model", MODELS, ids=lambda p: p.stem)
def test_a_page_is_whole_and_fetches_nothing(model: Path, tmp_path: Path) -> None:
    text = report(model, tmp_path)
    page = Page(text)
    for tag, attributes in page.elements:
        for name in ("src", "href", "srcset", "action", "data", "poster", "xlink:href"):
            value = attributes.get(name)
            assert value is None or value.startswith("#"), (tag, value)
        assert tag not in ("link", "iframe", "object", "embed", "base")
    assert not re.search(r"url\(|@import", text)
    policy = next(a["content"] for t, a in page.elements if a.get("http-equiv"))
    assert policy is not None and policy.startswith("default-src 'none'")
    ids = [a["id"] for _, a in page.elements if "id" in a]
    assert len(ids) == len(set(ids))
    links = [a["href"] for t, a in page.elements if t == "a"]
    assert links and all(link is not None and link[1:] in ids for link in links)


def cells(text: str) -> dict[str, list[str]]:
    """The marks of each fault in the signature matrix."""
    matrix = text.split('<table class="matrix')[1].split("</table>")[0]
    rows = re.findall(r'<tr data-fault="([^"]+)">(.*?)</tr>', matrix)
    return {f: re.findall(r'<td(?: class="cell ([\w ]+)")?[ >]', row) for f, row in rows}


def test_the_matrix_says_what_is_seen_and_for_how_long(tmp_path: Path) -> None:
    """By hand: r1 = U - R i - L i' - k w, r2 = k i - J w' - f w - load."""
    marks = cells(report(ROOT / "models" / "dc_motor.bg", tmp_path))
    seen = {fault: (row[0], row[1]) for fault, row in marks.items()}
    assert seen == {
        "L": ("weak", ""), "R": ("strong", ""), "U": ("strong", ""),
        "J": ("", "weak"), "f": ("", "strong"), "load": ("", "strong"),
        "k": ("strong", "strong"), "current": ("strong", "strong"), "speed": ("strong", "strong"),
    }  # fmt: skip


def test_what_is_too_small_for_the_code_is_barred(tmp_path: Path) -> None:
    """The cable settles within a microsecond: at a thousand samples a second nobody sees it."""
    marks = cells(report(ROOT / "models" / "cable_open.bg", tmp_path))
    assert "unseen" in marks["line.L"][0] and "unseen" not in marks["Us"][0]
    fast = cells(report(ROOT / "models" / "cable_open.bg", tmp_path, "--rate", "1e10"))
    assert "unseen" not in fast["line.L"][0]


def test_isolability_is_drawn_as_the_groups_say(tmp_path: Path) -> None:
    """Three faults a group in the motor; a square for each pair that nothing tells apart."""
    text = report(ROOT / "models" / "dc_motor.bg", tmp_path)
    picture = text.split('<svg class="isolability"')[1].split("</svg>")[0]
    found = re.findall(r'<rect class="on" x="([\d.]+)" y="([\d.]+)"', picture)
    squares = [(float(x), float(y)) for x, y in found]
    assert {(y, x) for x, y in squares} == set(squares)
    halves = picture.count('<path class="on"')
    assert len(squares) + halves == 3 * 3 * 3
    # k, and the errors of the two sensors, all move both; {r1} and {r2} lie inside {r1, r2}
    assert picture.count('<circle class="dot"') == 2 * 3 * 3


def test_any_hash_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    pages = []
    for seed in ("0", "7"):
        out = tmp_path / f"{seed}.html"
        subprocess.run(
            [sys.executable, "-m", "bondgraph", "report", "models/chassis.bg", "-o", str(out)],
            cwd=ROOT,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)},
            check=True,
            capture_output=True,
        )
        pages.append(out.read_bytes())
    assert pages[0] == pages[1]


def written(folder: Path, text: str) -> Path:
    path = folder / "model.bg"
    path.write_text(f"bg 1\n{text}", encoding="utf-8")
    return path


MOTOR = """model Motor {
    param R : Ohm
    param L : H
    Se:U -> 1:i -> I:L
    i -> R:R
    i -> Df:current
}
"""


def test_a_model_without_numbers_has_formulas_and_says_what_is_missing(tmp_path: Path) -> None:
    page = Page(report(written(tmp_path, MOTOR), tmp_path))
    assert "1 residual detects 4 of 4 faults" in page.text
    assert "Smallest changes cannot be told: R has no value in the model" in page.text
    assert any(tag == "mfrac" for tag, _ in page.elements)


def test_a_model_without_redundancy_is_a_right_answer(tmp_path: Path) -> None:
    model = written(tmp_path, "model M { param R = 1 Ohm\n Se:U -> 1:i -> R:R }\n")
    page = Page(report(model, tmp_path))
    assert "No residual: the model has no sensor" in page.text
    assert "no sensor around i could contradict the model there" in page.text


def test_a_conflict_is_drawn_with_its_reason(tmp_path: Path) -> None:
    model = written(tmp_path, "model M { param R = 1 Ohm\n Se:U -> 0:a -> R:R; Se:V -> a }\n")
    page = Page(report(model, tmp_path, status=1))
    assert "The effort of 0:a is imposed twice, by Se:U and Se:V." in page.text
    assert "imposed twice, by Se:U and Se:V.." not in page.text
    drawn = [a.get("class") or "" for tag, a in page.elements if tag == "rect"]
    assert "core line-clash" in drawn


def test_what_cannot_be_eliminated_still_has_its_strokes_and_the_reason(tmp_path: Path) -> None:
    text = """model M {
    param A = 1
    param B = 2
    param ra = 3
    Sf:Q -> 0:a { -> C:A; -> R:ra }
    0:b { <- Sf:x = ra.f; -> C:B; -> R:rb { f = e^4 } }
    sensor y = a.e + b.e
}
"""
    model = written(tmp_path, text)
    page = Page(report(model, tmp_path, status=1))
    assert "loop-unsolvable" in page.text and "Why there are no relations" in page.text
    assert len([tag for tag, a in page.elements if tag == "svg"]) == 2
    assert "Analytical redundancy relations" not in page.text


def test_signals_and_noise_that_are_given_are_used(tmp_path: Path) -> None:
    motor = ROOT / "models" / "dc_motor.bg"
    assumed = Page(report(motor, tmp_path)).text
    assert "Nothing was said of what the machine does" in assumed
    assert "every sensor has that of 12-bit samples" in assumed
    given = ["--at", "current=0.5", "--at", "U=6", "--noise", "0.02", "--kappa", "4"]
    told = Page(report(motor, tmp_path, *given)).text
    assert "current at 0.5, U at 6" in told and "4 standard deviations" in told
    assert "current 0.02, speed 0.02" in told and "Nothing was said" not in told
    assert main(["report", str(motor), "-o", "-", "--at", "curent=1"]) == 2


def test_modes_of_a_switched_model_are_told(tmp_path: Path) -> None:
    text = """model M {
    param A = 1
    param k = 2
    param k2 = 3
    input on : bool
    Sf:Q -> 0:t
    t { -> C:A; -> De:h; -> v; -> R:leak = k2 }
    1:v when on { -> R:k; -> Df:q }
}
"""
    page = Page(report(written(tmp_path, text), tmp_path))
    assert "While the machine stays in one mode" in page.text
    assert "on off" in page.text and "on on" in page.text
    assert "undetectable here" in page.text  # what is behind the valve while it is shut


def test_hundreds_of_faults_fit_a_page_of_a_few_megabytes(tmp_path: Path) -> None:
    text = """model Cell {
    port a : in electrical
    port b : out electrical
    param R = 3 Ohm
    param C = 100 uF
    1:left { <- a; -> R:R; -> mid }
    0:mid { -> C:C; -> De:u; -> b }
}
model Line {
    Cell:cell[34]
    Se:U -> cell[1..34] -> R:load = 100
}
"""
    text = report(written(tmp_path, text), tmp_path, "--rate", "50")
    assert len(text) < 3_000_000
    page = Page(text)
    rows = [a for tag, a in page.elements if tag == "tr" and a.get("data-fault") == "cell[20].C"]
    assert rows


SCENARIO = """doc = "The winding warms at six seconds."
duration = "9 s"
seed = 2
[inputs]
U = "12*(1 + 0.2*sin(2*pi*t))"
[sampling]
rate = "500 Hz"
[sensors.current]
noise = "2 mA"
[[fault]]
of = "R"
change = "+= 10 Ohm"
at = "6 s"
until = "8.9 s"
"""


def test_derivations_stand_below_their_residuals_where_they_are_asked_for(tmp_path: Path) -> None:
    model, page = str(ROOT / "models" / "dc_motor.bg"), tmp_path / "m.html"
    assert main(["report", model, "-o", str(page)]) == 0
    assert "SymPy" not in page.read_text()
    assert main(["report", model, "--derive", "-o", str(page)]) == 0
    text = page.read_text()
    first, second = text.split('<details class="derivation">')[1:]
    assert first.startswith("\n<summary>Derivation of r1 of Motor</summary>")
    assert first.partition("</details>")[0].count("<li>") == 8
    assert "storage L, line 15: differentiate its state for L.e" in first
    assert "SymPy agrees: what it derived is the compiler&#39;s r2 times -1." in second
    assert "&lt;math" not in text


def test_a_scenario_is_simulated_watched_and_shown(tmp_path: Path) -> None:
    scenario = tmp_path / "warm.toml"
    scenario.write_text(SCENARIO, encoding="utf-8")
    motor = ROOT / "models" / "dc_motor.bg"
    text = report(motor, tmp_path, "--scenario", str(scenario))
    assert text == report(motor, tmp_path, "--scenario", str(scenario))
    page = Page(text)
    assert "The winding warms at six seconds." in page.text
    assert "9 s at 500 samples a second, seed 2" in page.text
    assert "R += 10 Ohm at 6 s; R += 10 Ohm: over at 8.9 s" in page.text
    assert "Signals are those of the scenario warm (until its fault at 6 s)." in page.text
    assert "standard deviation of current 0.002; white" in page.text
    assert "every other sensor has that of 12-bit samples" in page.text
    # r1 is the balance of the armature: of the faults it sees alone are L, R and U (a sensor error
    # of the current or of the speed, and k, move the balance of the rotor as well)
    verdict = page.text.split("What the monitor said")[1]
    assert re.search(r"[78]\.\d+ s .*L, R or U since [56]\.\d+ s", verdict)
    assert "in rad/s" in page.text and "time in s" in page.text
    ids = [a["id"] for _, a in page.elements if "id" in a]
    assert len(ids) == len(set(ids))


def test_a_wrong_scenario_is_told_like_any_wrong_source(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scenario = tmp_path / "odd.toml"
    scenario.write_text('[inputs]\nV = "1"\n', encoding="utf-8")
    motor = str(ROOT / "models" / "dc_motor.bg")
    out = tmp_path / "p.html"
    assert main(["report", motor, "-o", str(out), "--scenario", str(scenario)]) == 1
    assert "odd.toml" in capsys.readouterr().err
    assert not out.exists()


def test_without_matplotlib_one_line_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    scenario = tmp_path / "warm.toml"
    scenario.write_text(SCENARIO, encoding="utf-8")
    motor = str(ROOT / "models" / "dc_motor.bg")
    out = tmp_path / "p.html"
    assert main(["report", motor, "-o", str(out), "--scenario", str(scenario)]) == 1
    told = capsys.readouterr().err.strip().splitlines()
    assert len(told) == 1 and "pip install 'bondgraph-arr[robot]'" in told[0]
    assert main(["report", motor, "-o", str(out)]) == 0  # without scenarios it is not needed
