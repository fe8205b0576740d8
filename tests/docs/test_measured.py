"""Measured tables stand between their marks, and say which command and which commit they are of."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, ROOT, named
from tests.measured import Measured, measured, write

_PAGE = """# Page

<!-- measured: python -m tests.x --a 1 -->
<!-- end -->

Words.

<!-- measured: python -m tests.x --a 2 -->
Commit `abc1234`.

| two |

<!-- end -->
"""


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_every_mark_has_a_command_a_commit_and_a_table(page: Path) -> None:
    found = measured(page)
    assert len(found) == page.read_text(encoding="utf-8").count("<!-- measured:")
    for one in found:
        module = re.match(r"python -m (tests(\.\w+)+)", one.command)
        assert module is not None
        place = ROOT / module[1].replace(".", "/")
        assert place.with_suffix(".py").exists() or (place / "__main__.py").exists()
        assert re.fullmatch(r"[0-9a-f]{7,}\+?", one.commit)
        assert one.text.startswith("|")


def test_a_table_is_written_where_its_command_stands(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(_PAGE)
    assert measured(page) == [Measured("python -m tests.x --a 2", "abc1234", "| two |")]
    write(page, "python -m tests.x --a 1", "| one |\n")
    one, two = measured(page)
    assert (one.text, two.text) == ("| one |", "| two |")
    write(page, "python -m tests.x --a 1", "| 1 |")
    assert [m.text for m in measured(page)] == ["| 1 |", "| two |"]
    assert "\nWords.\n" in page.read_text()
    with pytest.raises(LookupError, match="no place"):
        write(page, "python -m tests.x --a 3", "| three |")
