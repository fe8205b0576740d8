"""The report as a browser shows it: nothing cut off or overlapping, legible in dark and light."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from bondgraph.backends.report.page import page
from bondgraph.cli.detect import situation_of
from bondgraph.cli.reporting.collect import collect
from bondgraph.cli.reporting.seen import assumed
from bondgraph.compilation import compile
from tests.browser import PATH, Tab, browser
from tests.unit.backends.episodes import episode

ROOT = Path(__file__).parents[3]
PAPER = 665  # px, the text of a page of A4
pytestmark = pytest.mark.skipif(PATH is None, reason="chromium is not installed")

OVERLAPS = """(() => {
  const found = [];
  for (const svg of document.querySelectorAll("svg")) {
    const boxes = [...svg.querySelectorAll("text")].map((e) => [e.getBoundingClientRect(), e]);
    boxes.forEach(([a, e], i) => boxes.slice(i + 1).forEach(([b, f]) => {
      const x = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (x > 1.5 && y > 0.4 * Math.min(a.height, b.height))
        found.push([e.textContent, f.textContent]);
    }));
  }
  return found;
})()"""

CONTRAST = """(() => {
  const light = (c) => {
    const [r, g, b] = c.match(/[\\d.]+/g).map(Number).map((v) => v / 255).map(
      (v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const paper = light(getComputedStyle(document.documentElement).backgroundColor);
  const ratio = (c) => {
    const own = light(c);
    return (Math.max(own, paper) + 0.05) / (Math.min(own, paper) + 0.05);
  };
  const worst = {};
  for (const e of document.querySelectorAll("main *")) {
    if (![...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim())) continue;
    if (["title", "desc"].includes(e.tagName)) continue;
    const style = getComputedStyle(e);
    const c = e.closest("svg") ? style.fill : style.color;
    worst[c] = ratio(c);
  }
  return [paper, Math.min(...Object.values(worst))];
})()"""

OUTSIDE = """(() => [...document.querySelectorAll("main *")].filter((e) => {
  if (e.closest("svg") && e.tagName !== "svg" || e.classList.contains("said")) return false;
  const b = e.getBoundingClientRect();
  return b.width && (b.right > document.documentElement.clientWidth + 1 || b.left < -1);
}).map((e) => e.tagName + " " + e.textContent.slice(0, 60)))()"""


@pytest.fixture(scope="module")
def tab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Tab]:
    with browser(tmp_path_factory.mktemp("profile")) as found:
        yield found


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the robot with a run that nobody simulated."""
    args = argparse.Namespace(at=[], swing=[], noise=[], frequency=1.0, kappa=5.0, bits=12)
    model = compile(ROOT / "models/khepera.bg")
    content = collect(model, lambda p: assumed(args, situation_of(args, model.graph, p), p))
    path = tmp_path_factory.mktemp("report") / "robot.html"
    text = page(content._replace(episodes=(episode("A run"),)))
    assert len(text) < 1_500_000
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("width", [1200, 390])
def test_the_page_never_scrolls_sideways(tab: Tab, robot: Path, width: int) -> None:
    tab.open(robot, width)
    tab.run("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    wide = tab.run("document.documentElement.scrollWidth")
    assert wide == width


@pytest.mark.parametrize("width", [1200, 390])
def test_the_contents_stay_in_view_and_cover_no_heading(tab: Tab, robot: Path, width: int) -> None:
    tab.open(robot, width)
    tab.run("document.getElementById('signatures').scrollIntoView()")
    top = "document.querySelector('{}').getBoundingClientRect().{}"
    assert tab.run(top.format("nav", "top")) == 0
    assert tab.run(top.format("#signatures h2", "top")) > tab.run(top.format("nav", "bottom"))
    tab.open(robot, PAPER, media="print")
    assert tab.run("getComputedStyle(document.querySelector('nav')).position") == "static"


def test_on_paper_nothing_is_cut_off_and_paths_are_open(
    tab: Tab, robot: Path, tmp_path: Path
) -> None:
    tab.open(robot, PAPER, media="print")
    assert tab.run(OUTSIDE) == []
    assert tab.run("document.querySelector('.path').getBoundingClientRect().height") > 100
    tab.pdf(tmp_path / "robot.pdf")
    data = (tmp_path / "robot.pdf").read_bytes()
    assert data.startswith(b"%PDF") and data.count(b"/Type /Page\n") > 5


def test_labels_in_figures_do_not_overlap(tab: Tab, robot: Path) -> None:
    tab.open(robot, 1200)
    assert tab.run("document.querySelectorAll('svg text').length") > 200
    assert tab.run(OVERLAPS) == []


@pytest.mark.parametrize("dark", [False, True])
def test_all_text_has_contrast(tab: Tab, robot: Path, dark: bool) -> None:
    tab.open(robot, 1200, dark)
    paper, worst = tab.run(CONTRAST)
    assert (paper < 0.05) == dark
    assert worst >= 4.5


def test_formulas_are_set(tab: Tab, robot: Path) -> None:
    tab.open(robot, 1200)
    shapes: list[Any] = tab.run(
        """[...document.querySelectorAll(".formulas mfrac")].map((e) => {
          const [a, b] = [...e.children].map((c) => c.getBoundingClientRect());
          return a.height > 0 && a.bottom <= b.top + 1;
        })"""
    )
    assert len(shapes) > 5 and all(shapes)


def test_nothing_is_fetched_and_nothing_goes_wrong(tab: Tab, robot: Path) -> None:
    tab.call("Network.enable")
    tab.call("Log.enable")
    tab.call("Runtime.enable")
    tab.open(robot, 1200)
    tab.run("document.body.offsetHeight")
    asked = [e["params"]["request"]["url"] for e in tab.events("Network.requestWillBeSent")]
    assert asked == [robot.resolve().as_uri()]
    assert tab.events("Log.entryAdded") + tab.events("Runtime.exceptionThrown") == []


def test_pointing_at_an_element_lights_up_its_faults(tab: Tab, robot: Path) -> None:
    tab.open(robot, 1200)

    def point(selector: str, kind: str = "mouseMoved") -> None:
        x, y = tab.run(
            f"""(() => {{ const e = document.querySelector({selector!r});
            e.scrollIntoView({{ block: "center" }}); const b = e.getBoundingClientRect();
            return [b.x + b.width / 2, b.y + b.height / 2]; }})()"""
        )
        tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def lit() -> list[str]:
        found = tab.run("[...document.querySelectorAll('tr.lit')].map((e) => e.dataset.fault)")
        return list(dict.fromkeys(found))

    point("text[data-node='m[1].wh.fs']")
    assert lit() == ["m[1].wh.fs"]
    assert tab.run("document.getElementById('told').textContent") == "m[1].wh.fs; seen by r1, r2"
    point("[data-name='line.R']")
    assert lit() == ["line.R"]
    point("text[data-node='line.cell[1].R1']")
    assert lit() == ["line.R"]  # half of the resistance of the line
    point("h1")
    assert lit() == []


def test_without_scripts_the_page_says_as_much(tab: Tab, robot: Path) -> None:
    tab.open(robot, 1200)
    high = tab.run("document.querySelector('main').scrollHeight")
    tab.call("Emulation.setScriptExecutionDisabled", value=True)
    try:
        tab.open(robot, 1200)
        metrics = tab.call("Page.getLayoutMetrics")
        assert abs(metrics["cssContentSize"]["height"] - high) < 5
    finally:
        tab.call("Emulation.setScriptExecutionDisabled", value=False)
