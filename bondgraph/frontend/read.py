"""Reads a model file from the disk; whatever stands in its place gets an answer."""

from __future__ import annotations

import os
import stat

from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.limits import MODEL_BYTES
from bondgraph.text.regular_file import check_regular
from bondgraph.text.source import Source, Span


def read(path: str, report: Report, origin: Span | None = None) -> Source | None:
    """The text of the file at `path`, decoded from UTF-8, without mark and with plain line ends.

    None, and one error in `report`, if there is no such file, it cannot be read, has more than
    `MODEL_BYTES`, or is not text. The error stands at `origin`, the `import` that asks for the
    file, else at the file itself.
    """
    try:
        status = os.stat(path)
        if stat.S_ISDIR(status.st_mode):
            _refuse(path, report, "file-unreadable", "is a directory, not a model file",
                    "Give a file, such as `models/khepera.bg`.", origin)  # fmt: skip
            return None
        if status.st_size > MODEL_BYTES:
            _refuse(path, report, "file-too-large",
                    f"has {status.st_size} bytes; a model has at most {MODEL_BYTES}",
                    "Is this a log or a packed file? Describe repeated parts as an array of "
                    "submodels, `Cell:cell[n]`.", origin)  # fmt: skip
            return None
        check_regular(path, pipe=origin is None)
        with open(path, "rb") as file:
            data = file.read(MODEL_BYTES + 1)
    except FileNotFoundError:
        _refuse(path, report, "file-not-found", "does not exist", _nearby(path), origin)
        return None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        _refuse(path, report, "file-unreadable", f"cannot be read: {reason}",
                "Check the name and the rights; give a regular file.", origin)  # fmt: skip
        return None
    return decode(path, data, report, origin)


def decode(path: str, data: bytes, report: Report, origin: Span | None = None) -> Source | None:
    """The text in `data`; None, and one error in `report`, if it is not UTF-8 text."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        _refuse(path, report, "not-text", "is written in UTF-16, not in UTF-8",
                "Save it as UTF-8 in the editor.", origin)  # fmt: skip
        return None
    if b"\0" in data:
        _refuse(path, report, "not-text", "is not text: it contains zero bytes",
                "Give the command a model file; a packed file is none.", origin)  # fmt: skip
        return None
    mark = 3 if data.startswith(b"\xef\xbb\xbf") else 0
    data = data[mark:]
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        good = data[: error.start].decode("utf-8")
        good = good.replace("\r\n", "\n").replace("\r", "\n")
        source = Source(path, good)
        labels = [Label(Span(source, len(good), len(good)), f"byte {data[error.start]:#04x} here")]
        if origin is not None:
            labels.insert(0, Label(origin, "imported here"))
        report.error(
            "not-text",
            f"The file `{path}` is not UTF-8 text: its byte {mark + error.start + 1} belongs to no "
            "character.",
            *labels,
            help="Save it as UTF-8 in the editor; if it is no text at all, give a model file.",
        )
        return None
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    return Source(path, text)


def _refuse(
    path: str, report: Report, code: str, what: str, help: str, origin: Span | None
) -> None:
    place = origin or Span(Source(path, ""), 0, 0)
    report.error(code, f"The file `{path}` {what}.", place, help=help)


def _nearby(path: str) -> str:
    """A remedy for a file that is not there: the model files beside it."""
    folder = os.path.dirname(path) or "."
    try:
        names = sorted(name for name in os.listdir(folder) if name.endswith(".bg"))
    except (OSError, ValueError):
        return "Check the name; the folder does not exist either."
    if not names:
        return "Check the name; there is no `.bg` file in that folder."
    from difflib import SequenceMatcher  # only for this message

    meant = os.path.basename(path)
    names.sort(key=lambda name: (-round(SequenceMatcher(None, meant, name).ratio(), 3), name))
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return "Check the name; the folder has " + ", ".join(f"`{n}`" for n in names[:5]) + more + "."
