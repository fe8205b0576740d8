"""A model from nothing on the page: keystrokes, strokes, residuals, a fault, a row lit up."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from bondgraph.cli.main import main
from tests.browser import PATH
from tests.unit.cli.workbench.pages import Workbench, shown

pytestmark = pytest.mark.skipif(PATH is None, reason="Chromium is not installed (chromium)")


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    """One page for the tests of this file, in their order; its file is not there yet."""
    folder = tmp_path_factory.mktemp("edit")
    with shown(folder / "coil.bg", folder / "profile") as page:
        yield page


def test_a_file_that_is_not_there_begins_with_a_choice_and_writes_nothing(page: Workbench) -> None:
    names = page.tab.run("[...document.querySelectorAll('[data-start]')].map(e => e.dataset.start)")
    assert names[:2] == ["empty", "dc_motor"] and "two_tanks" in names
    page.push("[data-start=empty]")
    page.until("!document.querySelector('dialog[open]')")
    assert page.typed_text() == "bg 1\n\nmodel Machine {\n}\n"
    assert not page.file.exists()


def test_strokes_appear_while_one_types(page: Workbench) -> None:
    page.type("param R = 4 Ohm\nparam L = 0.5 H\nSe:U -> 1:loop\n")
    # A junction to which a source alone belongs has no flow: the drawing says where it clashes.
    page.until("document.querySelector('#drawing .badge')")
    page.until("document.querySelector('#problems').dataset.worst === 'error'")
    page.type("loop { -> R:R; -> I:L; -> Df:i")
    page.until("document.querySelector('#drawing [data-node=i]')")  # the last that is typed
    page.until("document.querySelectorAll('#drawing [data-bond] .stroke').length === 3")
    assert sorted(page.drawn()) == ["L", "R", "U", "i", "loop"]
    # Each stroke tells its reason: the inductor gives the current, so the resistor gets it.
    tips = page.tab.run("[...document.querySelectorAll('#drawing [data-bond]')].map((e) =>"
                        " e.dataset.tip.split('\\n').pop())")  # fmt: skip
    assert {"fixed by the source Se:U", "preferred by I:L", "fixed by the sensor Df:i"} < {*tips}
    assert any(t.startswith("forced at 1:loop") for t in tips)


def test_its_residual_stands_there_as_a_formula_with_its_path(page: Workbench) -> None:
    page.until("document.querySelectorAll('.relation').length === 1")
    formula = page.tab.run("document.querySelector('.relation .formulas').textContent")
    # By hand: U = R i + L di/dt around the loop.
    assert [x in formula for x in ("U", "R", "L", "i")] == 4 * [True]
    page.point(".relation")
    page.until("document.querySelector('#drawing .focused, #drawing svg.focused')")
    assert page.lit() == ["L", "R", "U", "i", "loop"]
    assert page.text("#tab-signatures .count") == "4"


def test_its_derivation_is_replayed_step_by_step(page: Workbench) -> None:
    page.push(".derivation summary")
    page.until("document.querySelectorAll('.derivation li').length > 2")
    steps = page.tab.run("[...document.querySelectorAll('.derivation li .why:first-child')]"
                         ".map((e) => e.textContent)")  # fmt: skip
    # By hand: the laws of R and L for their voltages, then the balance of the loop is left over.
    assert any(s.startswith("law of R") and "solve for" in s for s in steps)
    assert any("differentiate its state" in s for s in steps)
    assert any("left over, all its unknowns are known" in s for s in steps)
    assert page.text(".derivation > .note:last-child").startswith("SymPy agrees")
    page.point(".derivation li:first-child")
    page.until("document.querySelector('#drawing .now, #drawing svg .now')")
    page.push(".derivation summary")


def test_f2_renames_at_all_places(page: Workbench) -> None:
    def rename(new: str) -> None:
        page.write()
        page.press("Home", control=True)
        for _ in range(3):
            page.press("ArrowDown")
        page.press("End")
        page.press("Home")
        for _ in "param R":  # the cursor stands behind the name
            page.press("ArrowRight")
        page.press("F2")
        page.until("document.querySelector('#rename').open")
        page.type(new)
        page.press("Enter")

    assert page.tab.run("workbench.text.match(/\\bR\\b/g).length") == 3
    rename("L")
    page.until("document.querySelector('#notice').textContent.startsWith('Not renamed: ')")
    before = page.typed_text()
    rename("Rc")
    page.until("workbench.text.includes('param Rc')")
    assert page.typed_text() == before.replace("param R ", "param Rc ").replace("R:R", "R:Rc")
    page.press("z", control=True)  # one step back
    page.until(f"workbench.text === {before!r}")
    page.until("workbench.answered === workbench.version")
    page.until("document.querySelectorAll('.relation:not(.stale *)').length === 1")
    page.until("document.querySelector('#drawing [data-node=R]')")


def test_a_row_lights_its_element_and_its_line(page: Workbench) -> None:
    page.push("#tab-signatures")
    page.point("tr[data-fault=R]")
    page.until("document.querySelector('tr[data-fault=R].lit')")
    assert page.lit() == ["R"]
    assert "R:R" in page.text(".cm-lit")


def test_an_injected_fault_fires_the_residual_and_lights_the_row(page: Workbench) -> None:
    assert page.tab.run("document.querySelectorAll('tr.suspected').length") == 0
    page.push("#tab-trial")
    page.until("document.querySelectorAll('.plot').length === 2")
    assert page.tab.run("document.querySelectorAll('.plot.fired').length") == 0
    assert page.text(".verdict").startswith("Healthy")
    page.tab.run("(() => { const t = document.querySelector('#target'); t.value = 'R';"
                 " t.onchange(); })()")  # fmt: skip
    page.push("#inject button[type=submit]")
    page.until("document.querySelector('.plot.fired')")
    assert page.text(".plot.fired b") == "r1"
    assert page.text(".faults li span") == "R × 2 from 5 s"
    page.until("document.querySelector('tr[data-fault=R].suspected.injected')")
    assert "fired" in page.tab.run("document.querySelector('th[data-residual=r1]').className")
    page.until("document.querySelector('#drawing rect.suspect')")


def test_what_is_saved_is_what_the_formatter_writes(page: Workbench) -> None:
    page.write()
    page.press("s", control=True)
    page.until("document.querySelector('#dirty').hidden")
    text = page.file.read_bytes()
    assert text.decode() == page.typed_text()
    assert main(["format", "--check", str(page.file)]) == 0
    assert main(["check", str(page.file)]) == 0
    assert b"    loop { -> R:R; -> I:L; -> Df:i }\n" in text
    assert page.errors() == []
