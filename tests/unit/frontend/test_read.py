"""What stands on the disk: text of all kinds, and what is no text or no file."""

from __future__ import annotations

from pathlib import Path

import pytest

from bondgraph.frontend import read as module
from bondgraph.frontend.read import decode, read
from bondgraph.text.diagnostic import Report


def _code(path: Path) -> str:
    report = Report()
    assert read(str(path), report) is None
    (diagnostic,) = report.diagnostics
    assert diagnostic.help
    assert str(path) in diagnostic.message
    assert diagnostic.labels[0].span.source.path == str(path)
    return diagnostic.code


@pytest.mark.parametrize(
    "data",
    [
        b"bg 1\n# \xc3\xb6\n",
        b"bg 1\r\n# \xc3\xb6\r\n",
        b"bg 1\r# \xc3\xb6\r",
        b"\xef\xbb\xbfbg 1\n# \xc3\xb6\n",
    ],
)
def test_line_ends_and_mark(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.bg").write_bytes(data)
    report = Report()
    source = read(str(tmp_path / "a.bg"), report)
    assert source is not None
    assert source.text == "bg 1\n# ö\n"
    assert report.diagnostics == []


def test_not_text(tmp_path: Path) -> None:
    for data in (b"bg 1\n\0", "bg 1\n".encode("utf-16"), b"bg 1\n\xff"):
        (tmp_path / "a.bg").write_bytes(data)
        assert _code(tmp_path / "a.bg") == "not-text"


def test_the_place_of_a_bad_byte() -> None:
    report = Report()
    assert decode("a.bg", b"\xef\xbb\xbfbg 1\r\n# \xc3\xb6\xe4x", report) is None
    span = report.diagnostics[0].labels[0].span
    assert (span.line, span.column) == (2, 4)


def test_not_there(tmp_path: Path) -> None:
    (tmp_path / "near.bg").write_text("bg 1")
    report = Report()
    assert read(str(tmp_path / "far.bg"), report) is None
    assert report.diagnostics[0].code == "file-not-found"
    assert "`near.bg`" in report.diagnostics[0].help
    assert _code(tmp_path / "no" / "a.bg") == "file-not-found"
    assert _code(tmp_path) == "file-unreadable"
    assert _code(tmp_path / "a\0b") == "file-unreadable"
    assert _code(tmp_path / ("x" * 5000)) == "file-unreadable"
    assert _code(tmp_path / "near.bg" / "a.bg") == "file-unreadable"


def test_forbidden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbid(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    (tmp_path / "a.bg").write_text("bg 1")
    monkeypatch.setattr("builtins.open", forbid)
    assert _code(tmp_path / "a.bg") == "file-unreadable"


def test_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "MODEL_BYTES", 10)
    (tmp_path / "a.bg").write_text("bg 1\n# 12345")
    assert _code(tmp_path / "a.bg") == "file-too-large"
