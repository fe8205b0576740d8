"""Runs a page: its files are written, its commands and programs run, in the order of the page.

- A ```sh block runs in a shell, in the page's own folder, with `models` and `tests` of the checkout
  beside it. So do the commands in the first column of a table. Indented lines that begin with
  `bondgraph` do, too.
- A ```python block is a program; `>>>` examples of a page are one session of doctest.
- `<!-- file: NAME -->` before a block writes it to that file.
- A block without a language, directly behind one that ran, is what that printed, standard error
  included. A line `...` in it stands for any lines. `pytest --update` writes it anew, with as many
  lines before and behind the dots as there were; an empty block gets everything.
- `<!-- status: N -->` before a command says that it fails, with this status.
- `<!-- not run: REASON -->` before a block leaves it out.
- A command that would not end by itself is interrupted once it has printed something, as by ^C.
"""

from __future__ import annotations

import doctest
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from tests.docs.pages import ROOT

#: A remark before a block, a fenced block, indented commands, or a table row that is one.
_STEP = re.compile(
    r"(?:^<!-- (?P<mark>file|status|not run): (?P<said>[^>]*?) -->\n+)?"
    r"(?:^```(?P<language>\w*)\n(?P<text>.*?)^```$"
    r"|^(?P<indented>    bondgraph [^\n]*(?:\n    [^\n]*)*)"
    r"|^\| `(?P<row>bondgraph [^`\n]*)` \|)",
    re.MULTILINE | re.DOTALL,
)
_ENDLESS = re.compile(r"bondgraph live|--stream|--follow|--metrics|bondgraph edit")
#: Words that stand for something else, as in the synopsis of a command.
_PLACEHOLDER = re.compile(r"\b(?:MODEL|COMMAND|FILE|CODE|NAME|LOG)\b")
_SECONDS = 300.0


class Step(NamedTuple):
    """One thing that is done: a file written, a command or program run."""

    kind: str  #: file, sh or python
    text: str
    said: str = ""  #: the name of a file, the status of a command that fails
    printed: str | None = None  #: what the page says that it prints
    span: tuple[int, int] = (0, 0)  #: where that stands in the page


class Wrong(Exception):
    """A step that failed, or printed something else than the page says."""


def steps(page: str) -> list[Step]:
    """What there is to do in a page, in its order."""
    found: list[Step] = []
    end = 0
    for match in _STEP.finditer(page):
        directly = found and not page[end : match.start()].strip()
        end = match.end()
        if match["mark"] == "not run":
            continue
        if match["mark"] == "file":
            found.append(Step("file", match["text"], match["said"]))
        elif match["language"] in ("sh", "python"):
            found.append(Step(match["language"], match["text"], match["said"] or "0"))
        elif match["language"] == "" and directly and found[-1].printed is None:
            if found[-1].kind != "file":
                found[-1] = found[-1]._replace(printed=match["text"], span=match.span("text"))
        elif (command := match["indented"] or match["row"]) and not _PLACEHOLDER.search(command):
            found.append(Step("sh", re.sub(r"^    ", "", command, flags=re.MULTILINE), "0"))
    return found


def run(page: Path, folder: Path, update: bool) -> int:
    """Do all steps of a page in a folder; how many there were. Raises `Wrong`."""
    text = page.read_text(encoding="utf-8")
    for name in ("models", "tests", "docs"):
        (folder / name).symlink_to(ROOT / name)
    new: list[tuple[tuple[int, int], str]] = []
    done = steps(text)
    for step in done:
        printed = _do(step, folder)
        if step.printed is None or matches(step.printed, printed):
            continue
        if not update:
            raise Wrong(f"{page.name}: {step.text}\nprints\n{printed}\nand not\n{step.printed}")
        new.append((step.span, renewed(step.printed, printed)))
    for (start, end), other in reversed(new):
        text = text[:start] + other + text[end:]
    if new:
        page.write_text(text, encoding="utf-8")
    return len(done) + _examples(page)


def matches(said: str, printed: str) -> bool:
    """Whether this was printed, as far as it is said: dots stand for any lines."""
    parts = [re.escape(part) for part in re.split(r"^\.\.\.\n", said, flags=re.MULTILINE)]
    return re.fullmatch(r"(?:.*\n)*".join(parts), printed) is not None


def renewed(said: str, printed: str) -> str:
    """What was printed, with dots for as much of it as they stood for."""
    before, dots, behind = said.partition("...\n")
    lines = printed.splitlines(keepends=True)
    head, tail = before.count("\n"), behind.count("\n")
    if not dots or head + tail >= len(lines):
        return printed
    return "".join([*lines[:head], dots, *lines[len(lines) - tail :]])


def _do(step: Step, folder: Path) -> str:
    if step.kind == "file":
        (folder / step.said).parent.mkdir(parents=True, exist_ok=True)
        (folder / step.said).write_text(step.text, encoding="utf-8")
        return ""
    words = [sys.executable, "-c"] if step.kind == "python" else ["sh", "-e", "-c"]
    endless = step.kind == "sh" and _ENDLESS.search(step.text)
    tools = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    env = {**os.environ, "PATH": tools, "PYTHONPATH": str(ROOT), "COLUMNS": "100", "NO_COLOR": "1",
           "PYTHONUNBUFFERED": "1", "BROWSER": "true"}  # fmt: skip
    process = subprocess.Popen(
        [*words, step.text], cwd=folder, env=env, text=True, start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        first = ""
        if endless and process.stdout:
            first = process.stdout.readline()
            os.killpg(process.pid, signal.SIGINT)
        printed, _ = process.communicate(timeout=_SECONDS)
    except subprocess.TimeoutExpired as late:
        raise Wrong(f"no end within {_SECONDS:.0f} s: {step.text}") from late
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
    if process.returncode not in (int(step.said), -signal.SIGINT if endless else 0):
        raise Wrong(f"status {process.returncode}: {step.text}\n{first}{printed}")
    return (first + printed).replace(f"{folder}{os.sep}", "")


def _examples(page: Path) -> int:
    """Run the `>>>` examples of a page as one session; how many there were."""
    at = Path.cwd()
    os.chdir(ROOT)
    try:
        failed, tried = doctest.testfile(str(page), module_relative=False)
    finally:
        os.chdir(at)
    if failed:
        raise Wrong(f"{page.name}: {failed} of {tried} examples in Python")
    return tried
