"""A live page of a model, a scenario and files with hostile names: in a browser nothing runs."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.browser import PATH, browser
from tests.unit.runtime.live.rover import MODEL, SCENARIO
from tests.unit.runtime.live.test_page import Page

pytestmark = pytest.mark.skipif(PATH is None, reason="Chromium is not installed (chromium)")

_RUNS = "window.owned=(window.owned||0)+1"
TEXT = (
    f"</title></p></script><script>{_RUNS}</script><img src=x onerror={_RUNS}>"
    f"<svg onload={_RUNS}><a href=javascript:{_RUNS}>x</a><style>*{{display:none}}</style>"
)


class _Hostile(Page):
    """A page of a machine whose log, `name`, is read with a hostile model and scenario."""

    def __init__(self, folder: Path, name: str) -> None:
        doc = f"## {TEXT} \u202e\x1b[31m\n"
        model = folder / "<img src=x onerror=alert(1)>.bg"
        model.write_text(MODEL.replace("## A rover with an encoder on each wheel.\n", doc)
                         .replace("param m =", f"## {TEXT}\n    param m ="))  # fmt: skip
        scenario = folder / "s.toml"
        scenario.write_text(SCENARIO.replace('"errand"', f"'{TEXT}'")
                            .replace('"brake drags"', f"'{TEXT}'"))  # fmt: skip
        header = "t,F[1],F[2],turn[1],turn[2],v[1],v[2]"
        rows = "".join(f"{k / 200},1,1,0,0,0,0\n" for k in range(4000))
        (folder / name).write_text(f"{header}\n{rows}{TEXT}\n")
        words = ["live", model.name, "s.toml", "--log", name, "--port", "0", "--no-browser"]
        self.server = subprocess.Popen(
            [sys.executable, "-m", "bondgraph", *words], cwd=folder,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        )  # fmt: skip
        assert self.server.stdout is not None
        while not (found := re.search(r"http://127\.0\.0\.1:\d+/", self.server.stdout.readline())):
            assert self.server.poll() is None
        self.address = found[0]


def test_nothing_that_stands_in_a_name_or_comment_runs(tmp_path: Path) -> None:
    page = _Hostile(tmp_path, "<svg onload=alert(1)>\u202e.csv")
    try:
        with browser(tmp_path / "profile") as tab:
            page.open(tab)
            page.click("#scenario-faults button")
            page.until("document.querySelector('#active').textContent.startsWith('injected: ')")
            page.until("document.querySelectorAll('#verdicts li').length > 0")
            time.sleep(0.5)
            assert tab.run("window.owned || 0") == 0
            assert tab.run("document.querySelectorAll('img, a, iframe, style, object').length") == 0
            assert tab.run("document.scripts.length") == 1
            assert tab.run("[...document.querySelectorAll('*')].filter((e) =>"
                           " [...e.attributes].some((a) => a.name.startsWith('on'))).length") == 0
            for what in (".doc", "#scenario-faults button", "#active"):
                shown = page.text(what)
                assert "<script>window.owned" in shown and "\u202e" not in shown
            assert "\x1b" not in page.text(".doc")
            assert "<svg onload=alert(1)>\ufffd.csv" in page.text("#real-name")
            assert page.errors() == []
    finally:
        page.server.kill()
        page.server.wait()
        assert page.server.stdout is not None
        page.server.stdout.close()
