"""Tables of the documentation that a command measures and writes, each between two marks.

    <!-- measured: python -m tests.random.run --start 0 --count 40 -->
    Commit `4a85d8d`.

    | ... |

    <!-- end -->

The command is all that it takes to measure again. Most pages keep a small sample beside a long
campaign, and a test measures the sample again and compares.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
#: What the runs of the fuzzer add to: results, no code.
LEDGER = "tests/fuzz/campaign.json"
_BLOCK = re.compile(
    r"<!-- measured: (?P<command>[^\n]*) -->\nCommit `(?P<commit>.*?)`\.\n\n"
    r"(?P<text>.*?)\n\n<!-- end -->\n",
    re.DOTALL,
)


class Measured(NamedTuple):
    """What a command said, and of which commit."""

    command: str
    commit: str
    text: str


def measured(page: Path) -> list[Measured]:
    """The tables of a page."""
    return [Measured(**m.groupdict()) for m in _BLOCK.finditer(page.read_text(encoding="utf-8"))]


def write(page: Path, command: str, text: str) -> None:
    """Put what was measured just now where its command stands; LookupError where it does not."""
    whole = page.read_text(encoding="utf-8")
    mark = f"<!-- measured: {command} -->\n"
    head, found, rest = whole.partition(mark)
    if not found or "<!-- end -->\n" not in rest:
        raise LookupError(f"{page.name} has no place for this: {mark}<!-- end -->")
    tail = rest.split("<!-- end -->\n", 1)[1]
    block = f"{mark}Commit `{commit()}`.\n\n{text.strip()}\n\n<!-- end -->\n"
    page.write_text(head + block + tail, encoding="utf-8")


def commit() -> str:
    """The commit of the checkout; `+` behind it if the code has been changed since."""
    git = ["git", "-C", str(ROOT)]
    name = subprocess.run(
        [*git, "rev-parse", "--short", "HEAD"], capture_output=True, check=True, text=True
    )
    code = ["bondgraph", "codegen", "tests", f":!{LEDGER}"]
    same = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", *code])
    return name.stdout.strip() + ("+" if same.returncode else "")
