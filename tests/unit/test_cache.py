"""The cache takes nothing that others could have written, and nothing damaged."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from bondgraph.cache import Cache, user_cache

_DATA = b"\x7fELF and more" * 1000


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where the cache is to be; nothing there yet."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "own"))
    return tmp_path / "own" / "bondgraph"


def _opened() -> Cache:
    told: list[str] = []
    found = user_cache("so", told.append)
    assert found is not None and told == []
    return found


def _refused() -> str:
    told: list[str] = []
    assert user_cache("so", told.append) is None
    assert len(told) == 1 and "\n" not in told[0]
    return told[0]


def test_what_is_kept_is_found_under_its_name_only(folder: Path) -> None:
    path = _opened().keep("name", _DATA)
    assert path.parent == folder and path.read_bytes() == _DATA
    assert list(_opened().find("name")) == [path]
    assert list(_opened().find("nam")) == list(_opened().find("other")) == []
    assert folder.stat().st_mode & 0o777 == 0o700 and path.stat().st_mode & 0o777 == 0o600


def test_nobody_else_can_write_what_is_kept_whatever_the_mask(folder: Path) -> None:
    before = os.umask(0)
    try:
        path = _opened().keep("name", _DATA)
    finally:
        os.umask(before)
    assert list(_opened().find("name")) == [path]


def _group_writes(path: Path) -> None:
    path.chmod(0o620)


def _others_write(path: Path) -> None:
    path.chmod(0o602)


def _unreadable_link(path: Path) -> None:
    copy = path.with_name("copy")
    path.rename(copy)
    path.symlink_to(copy)


def _pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def _truncated(path: Path) -> None:
    os.truncate(path, 5000)


def _flipped(path: Path) -> None:
    path.write_bytes(_DATA[:-1] + bytes([_DATA[-1] ^ 128]))


@pytest.mark.parametrize(
    "change",
    [_group_writes, _others_write, _unreadable_link, _pipe, _truncated, _flipped],
    ids=lambda f: f.__name__,
)
def test_what_is_not_sound_is_neither_found_nor_left(
    change: Callable[[Path], None], folder: Path
) -> None:
    path = _opened().keep("name", _DATA)
    change(path)
    assert list(_opened().find("name")) == []
    assert not os.path.lexists(path)
    assert list(_opened().find("name")) == []
    assert _opened().keep("name", _DATA) == path
    assert list(_opened().find("name")) == [path]


def test_a_folder_with_the_name_of_a_library(folder: Path) -> None:
    path = _opened().keep("name", _DATA)
    path.unlink()
    path.mkdir()
    assert list(_opened().find("name")) == []
    assert _opened().keep("name", _DATA) is None
    assert list(folder.iterdir()) == [path]


def test_a_library_of_another_user(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = _opened()
    found.keep("name", _DATA)
    monkeypatch.setattr(os, "geteuid", lambda: folder.stat().st_uid + 1)
    assert list(found.find("name")) == []


def test_a_folder_of_another_user(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _opened()
    monkeypatch.setattr(os, "geteuid", lambda: folder.stat().st_uid + 1)
    assert f"{folder} is not used: it belongs to another user" in _refused()


@pytest.mark.parametrize("mode", [0o770, 0o702, 0o720, 0o1777])
def test_a_folder_that_others_can_write_to(mode: int, folder: Path) -> None:
    _opened()
    folder.chmod(mode)
    assert f"chmod go-w {folder}" in _refused()
    folder.chmod(mode & ~0o022)
    _opened()


def test_a_folder_that_others_can_read(folder: Path) -> None:
    _opened()
    folder.chmod(0o755)
    _opened()


def test_a_folder_that_others_could_put_another_one_in_the_place_of(folder: Path) -> None:
    _opened()
    folder.parent.chmod(0o777)
    assert f"others can write to {folder.parent}" in _refused()
    folder.parent.chmod(0o1777)  # as /tmp: what is in it is its owner's
    _opened()


def test_a_folder_that_is_a_link(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir(mode=0o700)
    folder.parent.mkdir()
    folder.symlink_to(tmp_path / "elsewhere")
    assert "it is a link" in _refused()
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_a_file_in_the_place_of_the_folder_is_no_reason_to_speak(folder: Path) -> None:
    folder.parent.mkdir()
    folder.write_text("mine\n")
    told: list[str] = []
    assert user_cache("so", told.append) is None
    assert told == [] and folder.read_text() == "mine\n"


def test_a_write_that_fails_leaves_nothing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*names: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr(os, "replace", full)
    assert _opened().keep("name", _DATA) is None
    assert list(folder.iterdir()) == []


def test_what_a_killed_process_had_begun_goes_with_the_next_file(folder: Path) -> None:
    found = _opened()
    begun = folder / ".bondgraph-0123456789ab.tmp"
    begun.write_bytes(b"half")
    path = found.keep("name", _DATA)
    assert set(folder.iterdir()) == {path}
