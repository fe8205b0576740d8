"""The page of `bondgraph edit` in a browser, with a person who types and points."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.browser import Tab, browser
from tests.unit.runtime.live.test_page import Page

_CODES = {"Enter": 13, "Tab": 9, "Escape": 27, "End": 35, "Home": 36, "ArrowUp": 38,
          "ArrowDown": 40, "ArrowLeft": 37, "ArrowRight": 39, "Delete": 46,
          "Backspace": 8, "F2": 113}  # fmt: skip


class Workbench(Page):
    """One page and the server behind it."""

    def __init__(self, file: Path, *words: str) -> None:
        command = [sys.executable, "-m", "bondgraph", "edit", file.name, "--port", "0",
                   "--no-browser", *words]  # fmt: skip
        self.file = file
        self.server = subprocess.Popen(
            command, cwd=file.parent, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        assert self.server.stdout is not None
        self.first = self.server.stdout.readline()
        found = re.search(r"http://127\.0\.0\.1:\d+/", self.first)
        assert found, self.first
        self.address = found[0]

    def open(self, tab: Tab) -> None:
        """Show it, until it has drawn the model or asks what to start from."""
        self.tab = tab
        for domain in ("Runtime", "Log"):
            tab.call(f"{domain}.enable")
        self.look(1400, False)
        self.load("Page.navigate", url=self.address)
        self.until("workbench.answered > 0 || document.querySelector('dialog[open]')")

    def close(self) -> None:
        """End the server."""
        self.server.kill()
        self.server.wait()
        assert self.server.stdout is not None
        self.server.stdout.close()

    # ------------------------------------------------------------------------ a person

    def write(self) -> None:
        """Have the cursor in the text."""
        self.tab.run("document.querySelector('.cm-content').focus()")

    def type(self, text: str) -> None:
        """Press the keys of a text, one after the other."""
        for letter in text:
            if letter == "\n":
                self.press("Enter")
                continue
            self.tab.call("Input.dispatchKeyEvent", type="keyDown", text=letter, key=letter)
            self.tab.call("Input.dispatchKeyEvent", type="keyUp", key=letter)

    def press(self, key: str, control: bool = False) -> None:
        """Press one key."""
        code = _CODES.get(key, ord(key[0].upper()))
        own = {"key": key, "code": key, "windowsVirtualKeyCode": code,
               "modifiers": 2 if control else 0}  # fmt: skip
        text = {"text": "\r"} if key == "Enter" else {}
        self.tab.call("Input.dispatchKeyEvent", type="keyDown", **own, **text)
        self.tab.call("Input.dispatchKeyEvent", type="keyUp", **own)

    def point(self, what: str) -> tuple[float, float]:
        """Move the pointer to the middle of something."""
        x, y = self.tab.run(
            f"(() => {{ const e = document.querySelector({what!r}); e.scrollIntoView({{block:"
            " 'nearest'}); const r = e.getBoundingClientRect();"
            " return [r.x + r.width / 2, r.y + r.height / 2]; })()"
        )
        self.tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        return x, y

    def push(self, what: str) -> None:
        """Click with the pointer."""
        x, y = self.point(what)
        for kind in ("mousePressed", "mouseReleased"):
            self.tab.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left",
                          clickCount=1)  # fmt: skip

    def drawn(self) -> list[str]:
        """The elements and junctions of the drawing."""
        found: list[str] = self.tab.run(
            "[...document.querySelectorAll('#drawing [data-node]')].map((e) => e.dataset.node)"
        )
        return found

    def lit(self) -> list[str]:
        """Those of them that stand out from the rest."""
        found: list[str] = self.tab.run(
            "[...document.querySelectorAll('#drawing [data-node].lit')].map((e) => e.dataset.node)"
        )
        return sorted(found)

    def typed_text(self) -> str:
        """What stands in the editor."""
        return str(self.tab.run("workbench.text"))


@contextmanager
def shown(file: Path, profile: Path) -> Iterator[Workbench]:
    """A page of the file, in a browser of its own."""
    page = Workbench(file)
    try:
        with browser(profile) as tab:
            page.open(tab)
            yield page
    finally:
        page.close()
