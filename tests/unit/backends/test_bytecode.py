"""Compiled templates are taken from the cache as long as they are those of the templates."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from bondgraph.backends import templates


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Templates of the test's own, and an empty cache beside them."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(templates, "codegen", lambda: tmp_path)
    templates.environment.cache_clear()
    yield tmp_path
    templates.environment.cache_clear()


def _filled(html: bool = False) -> str:
    """What a new process makes of the template."""
    templates.environment.cache_clear()
    return templates.environment(html).get_template("t.j2").render(x="<a>")


def _compiled(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names of the templates that Jinja compiles from now on."""
    found: list[str] = []
    own = templates.environment().__class__.compile

    def compile_(self: object, source: str, name: str, filename: str) -> object:
        found.append(name)
        return own(self, source, name, filename)  # type: ignore[call-overload]

    monkeypatch.setattr(templates.environment().__class__, "compile", compile_)
    return found


def test_a_template_is_compiled_once_for_all_processes(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "t.j2").write_text("one {{ x }}\n")
    compiled = _compiled(monkeypatch)
    assert [_filled(), _filled()] == ["one <a>\n"] * 2
    assert compiled == ["t.j2"]


def test_a_changed_template_is_compiled_anew(folder: Path) -> None:
    (folder / "t.j2").write_text("one {{ x }}")
    assert _filled() == "one <a>"
    (folder / "t.j2").write_text("two {{ x }}")
    assert _filled() == "two <a>"
    (folder / "t.j2").write_text("one {{ x }}")
    assert _filled() == "one <a>"


def test_a_page_and_code_of_one_template_are_kept_apart(folder: Path) -> None:
    (folder / "t.j2").write_text("{{ x }}")
    assert [_filled(True), _filled(False)] * 2 == ["&lt;a&gt;", "<a>"] * 2


@pytest.mark.parametrize("damage", [b"", b"j2", b"\0" * 500])
def test_damaged_code_is_compiled_anew(folder: Path, damage: bytes) -> None:
    (folder / "t.j2").write_text("{{ x }}")
    assert _filled() == "<a>"
    kept = list((folder / "cache" / "bondgraph").glob("*.template"))
    assert len(kept) == 1
    kept[0].write_bytes(damage)
    assert _filled() == "<a>"


def test_without_a_cache_templates_are_compiled(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "t.j2").write_text("{{ x }}")
    (folder / "cache").write_text("a file where the folder should be")
    assert _filled() == "<a>"
