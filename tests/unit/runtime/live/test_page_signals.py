"""Signals and alarms on the live page: legend, cursor, zoom, choice, export, an alarm's course."""

from __future__ import annotations

import csv
import json
import re
import time
from collections.abc import Iterator
from typing import Any

import pytest

from tests.browser import PATH
from tests.unit.runtime.live.test_page import Page, opened

pytestmark = pytest.mark.skipif(PATH is None, reason="Chromium is not installed (chromium)")

_KEYS = {"Enter": ("\r", 13), " ": (" ", 32), "Home": ("", 36), "ArrowLeft": ("", 37),
         "+": ("+", 187)}  # fmt: skip


_CHARTS = "[...document.querySelectorAll('.strip canvas')].map((c) => c.toDataURL())"


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    """One page for the tests of this file, in their order."""
    folder = tmp_path_factory.mktemp("signals")
    with opened(folder) as page:
        page.folder = folder / "files"
        page.folder.mkdir()
        page.tab.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(page.folder))
        page.until("document.querySelector('.strip .limit').textContent.startsWith('threshold')")
        yield page


def _press(page: Page, where: str, key: str) -> None:
    """Press a key where the keyboard is put first."""
    page.tab.run(f"{where}.focus()")
    text, code = _KEYS[key]
    for kind in ("keyDown", "keyUp"):
        more = {"text": text} if text and kind == "keyDown" else {}
        page.tab.call("Input.dispatchKeyEvent", type=kind, key=key, windowsVirtualKeyCode=code,
                      **more)  # fmt: skip


def _mouse(page: Page, kind: str, x: float, y: float, clicks: int = 0) -> None:
    """The pointer at a place of the window."""
    pressed = {"button": "left", "buttons": 1, "clickCount": clicks} if clicks else {}
    page.tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **pressed)


def _place(page: Page, strip: int) -> tuple[float, float, float, float]:
    """Where the chart of a residual is in the window, within its axes: left, top, width, height."""
    what = f"document.querySelectorAll('#strips .u-over')[{strip}]"
    page.tab.run(f"{what}.scrollIntoView({{block: 'center'}})")
    time.sleep(0.2)
    found = page.tab.run(f"(() => {{ const b = {what}.getBoundingClientRect();"
                         " return [b.left, b.top, b.width, b.height]; })()")  # fmt: skip
    left, top, width, height = found
    return left, top, width, height


def _table(page: Page) -> tuple[list[str], list[list[float | None]]]:
    """What the page exports, by its button."""
    for old in page.folder.iterdir():
        old.unlink()
    page.click("#export")
    end = time.monotonic() + 20
    while not (found := list(page.folder.glob("*.csv"))):
        assert time.monotonic() < end, list(page.folder.iterdir())
        time.sleep(0.05)
    assert found[0].name == "Rover_live.csv"
    header, *rows = csv.reader(found[0].read_text().splitlines())
    return header, [[float(x) if x else None for x in row] for row in rows]


def _pause(page: Page, on: bool) -> None:
    page.click("#pause")
    pressed = "document.querySelector('#pause').getAttribute('aria-pressed')"
    page.until(f"{pressed} === '{'true' if on else 'false'}'")
    time.sleep(0.3)


def _number(text: str) -> float:
    return float(text.replace("−", "-"))


def test_axes_have_units_and_ticks_that_differ(page: Page) -> None:
    axes = "import('./charts.js').then((m) => m.axes('N'))"
    assert page.tab.run(f"{axes}.then((a) => a[1].label)") == "N"
    ticks = "(null, [2000, 2000.25, 2000.5], 0, 0, 0.25)"
    assert page.tab.run(f"{axes}.then((a) => a[0].values{ticks})") == ["2000 s", "2000.25 s",
                                                                      "2000.5 s"]  # fmt: skip
    ticks = "(null, [-0.0002, -1e-20, 0.0002], 1, 0, 0.0002)"
    assert page.tab.run(f"{axes}.then((a) => a[1].values{ticks})") == ["−2e−4", "0", "2e−4"]


def test_what_is_old_gets_coarser_and_keeps_what_stood_out(page: Page) -> None:
    code = """import('./record.js').then(({ Record }) => {
      const record = new Record(['least', 'most', 'swing']);
      for (let k = 0; k < 100000; k++) {
        const v = k === 4 ? -7 : k === 99 ? 7 : k % 3 === 0 ? null : 1;
        record.add(k, [v, v, v]);
      }
      const rising = record.t.every((t, k) => k === 0 || t > record.t[k - 1]);
      const [a, b, c] = record.columns;
      const gap = Math.max(...record.t.slice(1).map((t, k) => t - record.t[k]));
      return [rising, gap, record.t.length, Math.min(...a.filter((v) => v !== null)),
        Math.max(...b), c.includes(-7) && c.includes(7), record.first, record.last,
        a.length, b.length, c.length];
    })"""
    rising, gap, rows, least, most, swing, first, last, *lengths = page.tab.run(code)
    assert rising and lengths == [rows] * 3 and rows < 13000
    assert gap <= 32  # 94,000 rows in 6,000 are 16 each, or 32 where these have just doubled
    assert (least, most, swing, first, last) == (-7, 7, True, 0, 99999)


def test_a_sensor_is_chosen_by_keyboard_and_its_legend_names_the_lines(page: Page) -> None:
    assert page.text("#chosen") == page.tab.run(
        "(() => { const n = document.querySelectorAll('#strips .strip').length,"
        " m = document.querySelectorAll('#beside .strip').length; return `${n} of ${n + m}`; })()"
    )
    strip = "[...document.querySelectorAll('#beside .strip')].find((e) => e.querySelector('.name').textContent === 'v[1]')"  # noqa: E501
    assert not page.tab.run(f"{strip}.checkVisibility()")
    _press(page, "document.querySelector('#times summary')", "Enter")
    page.until("document.querySelector('#choice').checkVisibility()")
    box = "[...document.querySelectorAll('#choice label')].find((e) => e.textContent === 'v[1]').querySelector('input')"  # noqa: E501
    _press(page, box, " ")
    page.until(f"{strip}.checkVisibility()")
    page.until(f"/^real 0\\.\\d+$/.test({strip}.querySelector('.which').textContent)")
    lines = page.tab.run(f"[...{strip}.querySelectorAll('.which')].map((e) => [e.firstChild"
                         ".nextSibling.textContent.trim(), getComputedStyle(e.firstChild)"
                         ".borderTopStyle, getComputedStyle(e.firstChild).borderTopColor])"
                         )  # fmt: skip
    assert [one[:2] for one in lines] == [["real", "solid"], ["virtual", "dashed"],
                                          ["desired", "dotted"]]  # fmt: skip
    assert len({one[2] for one in lines}) == 3


def test_an_arrow_moves_to_another_moment_however_far_it_is(page: Page) -> None:
    # 20 s in 400 px: a step of 8 px is 0.4 s, and nothing came between 2 s and 6 s.
    code = """import('./view.js').then(({ View }) => ['ArrowLeft', 'ArrowRight'].map((key) =>
      [0.4, 0.8, 1.2, 2, 6, 6.1, 6.4].map((from) => {
        const times = [0.4, 0.8, 1.2, 2, 6, 6.1, 6.4], near = (x) => times.reduce((best, t, k) =>
          Math.abs(t - x / 20) < Math.abs(times[best] - x / 20) ? k : best, 0);
        let found = null;
        View.prototype.key.call({}, { key, preventDefault() {} }, {
          data: [times], over: { clientWidth: 400 }, cursor: { left: 20 * from },
          scales: { x: { min: 0, max: 20 } }, posToVal: (x) => x / 20, valToPos: (t) => 20 * t,
          posToIdx: near, setCursor: ({ left }) => { found = times[near(left)]; },
        });
        return found;
      })))"""
    assert page.tab.run(code) == [[0.4, 0.4, 0.8, 1.2, 2, 6, 6], [0.8, 1.2, 2, 6, 6.4, 6.4, 6.4]]


def test_the_cursor_reads_what_the_exported_table_has(page: Page) -> None:
    _pause(page, True)
    header, rows = _table(page)
    assert header[0] == "t [s]" and "r1 real least [N]" in header
    assert [n for n in header if n.startswith("v[")] == [
        f"v[1] {one} [m/s]" for one in ("real", "virtual", "desired")
    ]
    assert rows[-1][0] == pytest.approx(float(page.text("#time")), abs=0.006)
    desired = [row[header.index("v[1] desired [m/s]")] for row in rows]
    assert set(desired) == {0.5}
    left, top, width, height = _place(page, 0)
    _mouse(page, "mouseMoved", left + 0.2 * width, top + height / 2)
    page.until("document.querySelector('#cursor').textContent.startsWith('cursor at')")
    at = _number(page.text("#cursor").split()[2])
    (row,) = [r for r in rows if r[0] == pytest.approx(at, rel=1e-5)]
    threshold = row[header.index("r1 real threshold [N]")]
    if threshold is not None:
        found = re.fullmatch(r"threshold ±(\S+) N", page.text("#strips .strip .limit"))
        assert found and _number(found[1]) == pytest.approx(threshold, rel=5e-3)
    shown = [_number(x) for x in re.findall(r"[−\d.e]+", page.text("#strips .strip .value"))]
    wanted = [row[header.index(f"r1 real {end} [N]")] for end in ("least", "largest")]
    assert [shown[0], shown[-1]] == pytest.approx(wanted, rel=5e-3)
    # The same moment in another chart, by the keyboard a little before.
    _press(page, "document.querySelector('#strips')", "ArrowLeft")
    page.until(f"document.querySelector('#cursor').textContent !== 'cursor at {at} s'")
    assert _number(page.text("#cursor").split()[2]) < at


def test_the_cursor_is_under_the_pointer_wherever_the_page_is_scrolled_to(page: Page) -> None:
    # uPlot remembers where a chart is; what moves it without an event has to be noticed, too.
    for moved in ("window.scrollBy(0, 37)", "document.body.style.transform = 'translateX(-23px)'",
                  "document.body.style.transform = ''"):  # fmt: skip
        page.tab.run(moved)
        left, top, width, height = _place(page, 0)
        for part in (0.4, 0.6):
            _mouse(page, "mouseMoved", left + part * width, top + height / 2)
        line = "document.querySelector('#strips .strip .u-cursor-x').getBoundingClientRect().left"
        page.until(f"Math.abs({line} - {left + 0.6 * width}) < 1.5")
    page.tab.run("window.scrollTo(0, 0)")


def test_dragging_zooms_all_charts_and_double_click_follows_again(page: Page) -> None:
    before = page.tab.run(_CHARTS)
    left, top, width, height = _place(page, 0)
    x, y = [left + part * width for part in (0.1, 0.3)], top + height / 2
    _mouse(page, "mouseMoved", x[0], y)
    _mouse(page, "mousePressed", x[0], y, 1)
    _mouse(page, "mouseMoved", (x[0] + x[1]) / 2, y, 1)
    _mouse(page, "mouseMoved", x[1], y, 1)
    _mouse(page, "mouseReleased", x[1], y, 1)
    page.until("document.querySelector('#follow').getAttribute('aria-pressed') === 'false'")
    found = re.fullmatch(r"([\d.]+) to ([\d.]+) s", page.text("#seen"))
    assert found
    start, end = float(found[1]), float(found[2])
    assert end - start == pytest.approx(0.2 * 20, rel=0.03)
    _, rows = _table(page)
    assert rows and all(start <= t <= end for t, *_ in rows if t is not None)
    _pause(page, False)
    time.sleep(0.5)
    assert page.text("#seen") == found[0]  # it does not move on
    after = page.tab.run(_CHARTS)
    shown = page.tab.run("[...document.querySelectorAll('.strip')].map((e) =>"
                         " e.checkVisibility())")  # fmt: skip
    assert all(a != b for a, b, on in zip(before, after, shown, strict=True) if on)
    left, top, width, height = _place(page, 0)
    x[0], y = left + width / 2, top + height / 2
    for clicks in (1, 2):
        _mouse(page, "mousePressed", x[0], y, clicks)
        _mouse(page, "mouseReleased", x[0], y, clicks)
    page.until("document.querySelector('#seen').textContent === 'follows, the last 20 s'")
    _press(page, "document.querySelector('#strips')", "+")
    page.until("document.querySelector('#follow').getAttribute('aria-pressed') === 'false'")
    _press(page, "document.querySelector('#strips')", "Home")
    page.until("document.querySelector('#follow').getAttribute('aria-pressed') === 'true'")
    assert page.errors() == []


def test_an_alarm_has_its_course_and_its_end(page: Page) -> None:
    page.click("#scenario-faults button")
    page.until("document.querySelector('#verdicts .alarm')")
    alarm = "document.querySelector('#verdicts .alarm')"
    assert page.text("#verdicts .alarm .fate") == "still there"
    page.until("document.querySelector('#verdicts .alarm .course .update')")
    page.click("#clear")
    page.until(f"{alarm}.dataset.state === 'cleared'")
    found = re.fullmatch(r"cleared at ([\d.]+) s, after ([\d.]+) s", page.text(".alarm .fate"))
    assert found
    _press(page, f"{alarm}.querySelector('summary')", "Enter")
    page.until(f"{alarm}.querySelector('.course').checkVisibility()")
    course = page.tab.run(f"[...{alarm}.querySelectorAll('.course > li:not([hidden])')].map((e) =>"
                          " [e.className, parseFloat(e.querySelector('.at').textContent),"
                          " e.querySelector('.among')?.textContent ?? ''])")  # fmt: skip
    events = [event for event, *_ in course]
    assert events[0] == "fault" and "update" in events and events[-1] == "cleared"
    times = [at for _, at, _ in course]
    assert times == sorted(times) and times[-1] == float(found[1])
    assert float(found[2]) > 0 and float(found[1]) - float(found[2]) <= times[0]
    named: list[Any] = [among for _, _, among in course if "f[2]" in among]
    assert named and re.search(r"f\[2\] \+[\d.]+ N.s/m \d+ %", " ".join(named))
    assert page.errors() == []


# ----------------------------------------------------------- told by this test, not by a machine


_LINE = """window.WebSocket = class {
  constructor() { this.readyState = 1; window.line = this; }
  send() {}
};"""


def _tell(page: Page, *messages: dict[str, Any]) -> None:
    page.tab.run(f"{json.dumps(messages)}.forEach((m) =>"
                 " window.line.onmessage({data: JSON.stringify(m)}))")  # fmt: skip


def _frame(n: int, t: float) -> dict[str, Any]:
    row = [-0.1 * n, 0.1 * n, 1.0, n > 10]
    return {"type": "frame", "n": n, "t": t, "s": [[t, 2 * t, None]], "desired": {"p": []},
            "real": {"p": [], "r": [row]}, "virtual": {"p": [], "r": [row]}}  # fmt: skip


def _verdict(event: str, at: float, whose: str = "real", **more: Any) -> dict[str, Any]:
    return {"type": "verdict", "number": 1, "whose": whose, "event": event, "time": at,
            "since": None, "fired": [], "group": [], "candidates": [],
            "message": f"{event} at {at:g}", **more}  # fmt: skip


def _hello(frames: list[dict[str, Any]]) -> dict[str, Any]:
    return {"type": "hello", "residuals": [["r1", "V", ["R"]]], "sensors": [["i,j", "A"]],
            "plane": [], "wanted": False, "lacking": {}, "faults": [], "targets": [], "links": {},
            "monitored": "a test", "pace": 1, "state": {}, "active": [], "verdicts": [],
            "paths": {"real": [], "virtual": [], "desired": []}, "frames": frames}  # fmt: skip


@pytest.fixture(scope="module")
def told(page: Page) -> Page:
    """The page without a machine, after those tests that need one."""
    page.tab.call("Page.addScriptToEvaluateOnNewDocument", source=_LINE)
    page.load("Page.reload")
    page.until("window.line")
    _tell(page, _hello([_frame(n, float(n)) for n in (1, 2, 3)]))
    return page


def test_what_is_told_anew_is_neither_twice_nor_lost(told: Page) -> None:
    _tell(told, _hello([_frame(n, float(n)) for n in (2, 3, 4)]), _frame(5, 5.0))
    header, rows = _table(told)
    assert header == ["t [s]", "r1 real least [V]", "r1 real largest [V]", "r1 real threshold [V]",
                      "i,j real [A]", "i,j virtual [A]"]  # fmt: skip
    assert rows == [[n, pytest.approx(-0.1 * n), pytest.approx(0.1 * n), 1, n, 2 * n]
                    for n in (1, 2, 3, 4, 5)]  # fmt: skip
    _tell(told, _hello([_frame(n, float(n)) for n in (12, 13)]))  # of another one: all is new
    assert [t for t, *_ in _table(told)[1]] == [12, 13]
    told.until("document.querySelector('.strip.fired .name')?.textContent === 'r1'")
    assert told.text("#plots .which") == "real 13"


def test_a_course_has_what_else_was_said_and_is_bounded(told: Page) -> None:
    among = [["R", 0.5, "Ohm", 0.8, None], ["U", None, "V", 0.15, 6.7], ["L", None, "", 0.05, None]]
    fault = {"since": 9.5, "candidates": among}
    _tell(told, _verdict("start", 1), _verdict("fault", 10, **fault), _verdict("gap", 11),
          _verdict("gap", 12, "virtual"))  # fmt: skip
    course = "[...document.querySelectorAll('.course > li:not([hidden])')]"
    assert told.tab.run(f"{course}.map((e) => e.className)") == ["fault", "gap"]
    assert told.tab.run("[...document.querySelectorAll('#verdicts > li')].map((e) =>"
                        " e.className)") == ["gap", "alarm", "start"]  # fmt: skip
    assert told.text(".course .among") == "R +0.5 Ohm 80 %U stands at 6.7 V 15 %L 5 %"
    assert told.text(".alarm summary .text") == "most likely R"
    _tell(told, *(_verdict("update", 20 + k, **fault) for k in range(150)))
    assert told.tab.run(f"{course}.length") == 101  # 100 of 152, and a line that says so
    assert told.tab.run(f"{course}.slice(0, 3).map((e) => e.querySelector('.text').firstChild"
                        ".textContent)") == ["fault at 10", "52 more", "update at 71"]  # fmt: skip
    _tell(told, {"type": "state", "state": "ended", "text": "The samples have ended.", "pace": 1})
    assert told.text(".alarm .fate") == "still there at the end"
    _tell(told, _verdict("cleared", 200))
    assert told.text(".alarm .fate") == "cleared at 200.00 s, after 190.50 s"
    _tell(told, _verdict("cleared", 201), _verdict("update", 210, **fault))
    assert told.tab.run("[...document.querySelectorAll('#verdicts > li')].map((e) => e.className +"
                        " (e.dataset.state ?? ''))") == [
        "alarmthere", "cleared", "gap", "alarmcleared", "start"]  # fmt: skip
    assert told.errors() == []
