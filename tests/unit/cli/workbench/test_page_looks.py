"""The workbench at four widths, light and dark, by keyboard; other writers; hostile text."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest

from tests.browser import PATH
from tests.unit.cli.workbench.pages import Workbench, shown
from tests.unit.runtime.live.test_hostile_page import TEXT

pytestmark = pytest.mark.skipif(PATH is None, reason="Chromium is not installed (chromium)")

MODEL = f"""\
bg 1

## {TEXT}
model Coil {{
    ## {TEXT}
    param R = 4 Ohm
    param L = 0.5 H
    Se:U -> 1:loop  # {TEXT}
    loop {{
        -> R:R
        -> I:L
        ## {TEXT}
        -> Df:i
    }}
}}
"""

#: Texts of the page that lie over each other, and controls that stick out of the window.
WRONG = """(() => {
  const shown = (e) => e.checkVisibility({ visibilityProperty: true }) && !e.closest(".said, #editor");
  const boxes = [...document.querySelectorAll("#bar *, .tools *, [role=tab], #sum, #legend, .relation h3, .relation .chip, .row > *, .matrix th, .matrix td, #drawing text")]
    .filter((e) => shown(e) && e.textContent.trim() && ![...e.children].some((c) => c.textContent.trim())).map((e) => [e.textContent.trim().slice(0, 30), e.getBoundingClientRect(), e]).filter((b) => b[1].width);
  const out = [];
  boxes.forEach(([a, p, e], i) => boxes.slice(i + 1).forEach(([b, q, f]) => {
    const x = Math.min(p.right, q.right) - Math.max(p.left, q.left), y = Math.min(p.bottom, q.bottom) - Math.max(p.top, q.top);
    if (x > 2 && y > 3 && !e.contains(f) && !f.contains(e)) out.push(`${a} | ${b}`);
  }));
  for (const e of document.querySelectorAll("button, select, #state")) {
    const r = e.getBoundingClientRect();
    if (shown(e) && !e.closest("[role=tabpanel], #problems, [role=tablist], dialog") && (r.left < -1 || r.right > innerWidth + 1)) out.push(`out: ${e.id}`);
  }
  return out;
})()"""  # noqa: E501


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Workbench]:
    """One page for the tests of this file, in their order."""
    folder = tmp_path_factory.mktemp("looks")
    file = folder / "<img src=x onerror=alert(1)>.bg"
    file.write_text(MODEL)
    with shown(file, folder / "profile") as page:
        page.until("document.querySelectorAll('.relation').length === 1")
        yield page


def test_nothing_that_stands_in_a_name_or_comment_runs(page: Workbench) -> None:
    page.point("#drawing [data-node=i]")
    page.until("!document.querySelector('#card').hidden")
    assert "<script>window.owned" in page.text("#card")
    page.point("#drawing [data-node=R]")
    page.until("document.querySelector('.cm-content').textContent.includes('<script>')")
    # What the language server says of a name has the comment in it.
    x, y = page.tab.run("(() => { const e = [...document.querySelectorAll('.cm-line')]"
                        ".find((l) => l.textContent.trim() === '-> R:R').querySelector("
                        "'span:last-child'); const r = e.getBoundingClientRect();"
                        " return [r.right + 12, r.y + r.height / 2]; })()")  # fmt: skip
    page.until("document.querySelector('#problems .sum').textContent === 'no findings'")
    for dx in (0, 1):
        page.tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=x - 6 + dx, y=y)
    page.until("document.querySelector('.cm-tooltip')")
    time.sleep(0.3)
    assert page.tab.run("window.owned || 0") == 0
    assert page.tab.run("document.querySelectorAll('img, iframe, object, [onload]').length") == 0
    assert page.tab.run("document.scripts.length") == 1
    assert page.text("#file") == "<img src=x onerror=alert(1)>.bg"
    assert page.errors() == []


@pytest.mark.parametrize("width", [1400, 1000, 820, 390])
def test_nothing_overlaps_or_sticks_out(page: Workbench, width: int) -> None:
    page.tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=1, y=1)
    for dark in (False, True):
        page.look(width, dark)
        for tab in ("residuals", "signatures", "trial"):
            page.click(f"#tab-{tab}")
            time.sleep(0.3)
            assert page.tab.run("document.documentElement.scrollWidth") <= width
            assert page.tab.run(WRONG) == [], (width, dark, tab)
    page.look(1400, False)


def test_the_keyboard_reaches_everything(page: Workbench) -> None:
    page.write()
    for key in ("F6", "F6"):
        page.tab.call("Input.dispatchKeyEvent", type="keyDown", key=key, code=key,
                      windowsVirtualKeyCode=117)  # fmt: skip
    page.until("document.activeElement.getAttribute('role') === 'tab'")
    chosen = "document.querySelector('[role=tab][aria-selected=true]').id"
    page.press("Home")
    assert page.tab.run(chosen) == "tab-residuals"
    page.press("ArrowRight")
    assert page.tab.run(chosen) == "tab-signatures"
    # In the drawing arrow keys go from element to element; Enter goes to the line.
    page.tab.run("document.querySelector('#drawing').focus()")
    seen = set()
    for key in ("ArrowRight", "ArrowRight", "ArrowDown", "ArrowUp", "ArrowLeft"):
        page.press(key)
        seen.add(page.text("#card .head b"))
    assert "Se:U" in seen and "1:loop" in seen
    page.press("Enter")
    page.until("document.activeElement.classList.contains('cm-content')")
    assert page.tab.run("document.querySelector('#card').hidden")


def test_a_click_goes_to_the_line_and_the_cursor_to_the_element(page: Workbench) -> None:
    page.push("#drawing [data-node=L]")
    page.until("document.querySelector('.cm-activeLine').textContent.trim() === '-> I:L'")
    page.until("document.querySelector('#drawing rect.here')")


def test_a_file_changed_on_the_disk_is_told_and_never_overwritten(page: Workbench) -> None:
    other = MODEL.replace("0.5 H", "0.7 H")
    page.file.write_text(other)
    page.until(f"workbench.text === {other!r}")  # nothing was typed: it is taken
    page.write()
    page.press("End", control=True)
    page.type("# mine")
    page.file.write_text(MODEL)
    page.until("document.querySelector('#notice').textContent.includes('not saved')")
    page.press("s", control=True)
    page.until("document.querySelector('#notice').textContent.includes('Not saved')")
    assert page.file.read_text() == MODEL
    page.push("#notice .buttons button:last-child")  # keep this text
    page.press("s", control=True)
    page.until("document.querySelector('#dirty').hidden")
    assert page.file.read_text() == other + "# mine\n"


def test_what_was_not_saved_is_there_again_after_a_reload(page: Workbench) -> None:
    page.write()
    page.press("End", control=True)
    page.type("# more")
    text = page.typed_text()
    page.load("Page.reload")
    page.until("window.workbench?.answered > 0")
    assert page.typed_text() == text and "# more" not in page.file.read_text()
    assert "not saved" in page.text("#notice")
    page.push("#notice button")
    page.until("document.querySelector('#dirty').hidden")
    assert page.typed_text() == page.file.read_text()


def test_a_text_with_a_mistake_is_not_saved(page: Workbench) -> None:
    before = page.file.read_text()
    page.write()
    page.press("End", control=True)
    page.type("model {")
    page.press("s", control=True)
    page.until("document.querySelector('#notice').textContent.startsWith('Not saved: ')")
    assert page.file.read_text() == before
    page.until("document.querySelector('#problems').dataset.worst === 'error'")
    assert page.errors() == []


def test_a_remedy_is_a_button_that_mends_the_text(page: Workbench) -> None:
    page.tab.run("document.querySelector('#notice button')?.click()")
    page.write()
    for _ in "model {}":  # a bracket that is opened is closed
        page.press("Backspace")
    page.until("document.querySelector('#problems').dataset.worst === 'none'")
    page.press("Home", control=True)
    for _ in range(2):
        page.press("ArrowDown")
    page.press("End")
    page.type("\nmodel X { parm Q = 1 Ohm; Se:U -> R:Q }")
    page.until("workbench.answered === workbench.version")  # else the button may be another one
    page.until("document.querySelector('.remedies button')")
    assert "param" in page.text(".remedies button")
    page.push(".remedies button")
    page.until("workbench.text.includes('model X { param Q = 1 Ohm')")
    assert page.errors() == []
