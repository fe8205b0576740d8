"""What a new model may start from: the models that are shipped, the simplest one first."""

from __future__ import annotations

from pathlib import Path

import bondgraph
from bondgraph.text.tuples import NamedTuple

_FIRST = ("dc_motor", "rc_loop", "quarter_car", "two_tanks", "oven")
_BLANK = """\
bg 1

model Machine {
}
"""


class Start(NamedTuple):
    """A text to start from, and what it teaches."""

    name: str
    doc: str
    text: str


def starts() -> list[Start]:
    """An empty model, then those that are shipped."""
    folder = _folder()
    files = sorted(folder.glob("*.bg")) if folder is not None else []
    order = {name: k for k, name in enumerate(_FIRST)}
    files.sort(key=lambda path: (order.get(path.stem, len(order)), path.stem))
    found = [Start("empty", "A model with nothing in it.", _BLANK)]
    for path in files:
        text = path.read_text(encoding="utf-8")
        if "import " not in text:  # what it is made of would not be there
            found.append(Start(path.stem, _doc(text), text))
    return found


def _folder() -> Path | None:
    """Where the models are: inside the package when installed, else beside it."""
    package = Path(bondgraph.__file__).resolve().parent
    return next((p for p in (package / "models", package.parent / "models") if p.is_dir()), None)


def _doc(text: str) -> str:
    """The first comment of a model, up to a blank line."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#") or not line.strip("# "):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines)
