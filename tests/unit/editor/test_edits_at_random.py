"""A small sample of `python -m tests.editor_edits`: no text makes the server fail."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

pytest.importorskip("pygls", reason="the extra `editor` is not installed")

from tests import editor_edits


def test_findings_are_those_of_check_after_each_edit(tmp_path: Path) -> None:
    found = asyncio.run(editor_edits.campaign(90, 3, tmp_path.resolve()))
    assert len(found) >= 8  # kinds of findings, or the edits were too tame


def test_a_difference_would_be_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told = editor_edits.printed
    monkeypatch.setattr(editor_edits, "printed", lambda path: told(path)[:-1])
    with pytest.raises(AssertionError, match="is not"):
        asyncio.run(editor_edits.campaign(90, 3, tmp_path.resolve()))
