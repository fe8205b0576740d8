"""A file is the old one or the new one, and what was begun by others who are gone goes too."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from bondgraph.text.file_lock import locked
from bondgraph.text.whole_file import aside, folder_aside, naming, whole, write_bytes, write_whole

_BEGUN = ".bondgraph-0123456789ab.tmp"


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    write_whole(tmp_path / "a", "old\n")
    with pytest.raises(KeyError), whole(tmp_path / "a") as temporary:
        temporary.write_text("half")
        raise KeyError
    assert (tmp_path / "a").read_text() == "old\n"
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


def test_a_file_keeps_its_mode_and_a_private_one_is_private(tmp_path: Path) -> None:
    write_whole(tmp_path / "a", "old\n")
    (tmp_path / "a").chmod(0o640)
    write_whole(tmp_path / "a", "new\n")
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o640
    write_bytes(tmp_path / "a", b"own", private=True)
    assert (tmp_path / "a").stat().st_mode & 0o777 == 0o600


def test_only_what_nobody_works_on_is_removed(tmp_path: Path) -> None:
    (tmp_path / _BEGUN).write_text("of a process that was killed")
    others = [tmp_path / name for name in (".bondgraph-1.tmp", "x.tmp", f"{_BEGUN}.txt")]
    for other in others:
        other.write_text("not ours")
    with whole(tmp_path / "long") as temporary, folder_aside(tmp_path) as folder:
        write_whole(tmp_path / "short", "")
        assert temporary.exists() and folder.exists()
        assert not (tmp_path / _BEGUN).exists()
    assert set(tmp_path.iterdir()) == {*others, tmp_path / "long", tmp_path / "short"}


def test_a_link_with_the_name_of_something_begun_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "own").write_text("mine\n")
    (tmp_path / _BEGUN).symlink_to(tmp_path / "own")
    write_whole(tmp_path / "a", "")
    assert (tmp_path / "own").read_text() == "mine\n"


def test_a_folder_that_was_begun_goes_with_what_is_in_it(tmp_path: Path) -> None:
    (tmp_path / _BEGUN / "deep").mkdir(parents=True)
    write_whole(tmp_path / "a", "")
    assert [p.name for p in tmp_path.iterdir()] == ["a"]


def test_a_folder_that_another_process_takes_for_something_left_is_made_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain, taken = os.open, []

    def taking(path: str | Path, flags: int, mode: int = 0o777, **more: int) -> int:
        if not taken and Path(path).suffix == ".tmp":
            taken.append(Path(path))
            Path(path).rmdir()  # between mkdir and the lock
        return plain(path, flags, mode, **more)

    monkeypatch.setattr(os, "open", taking)
    with folder_aside(tmp_path) as folder:
        assert folder.is_dir()
    assert len(taken) == 1
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(FileNotFoundError), folder_aside(tmp_path / "missing"):
        pass


def test_a_duplicate_keeps_the_lock(tmp_path: Path) -> None:
    with aside(tmp_path / "a") as (_, file):
        own = os.dup(file)
    other = os.open(tmp_path / "a", os.O_RDONLY)
    assert locked(other) is False
    os.close(own)
    assert locked(other) is True
    os.close(other)


def test_a_pipe_is_written_to_and_not_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a")
    reader = os.open(tmp_path / "a", os.O_RDONLY | os.O_NONBLOCK)
    write_whole(tmp_path / "a", "text\n")
    assert os.read(reader, 100) == b"text\n" and (tmp_path / "a").is_fifo()
    os.close(reader)


def test_failures_name_the_file_that_the_user_knows(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as missing:
        write_whole(tmp_path / "no" / "a", "")
    assert missing.value.filename == str(tmp_path / "no" / "a")
    with pytest.raises(IsADirectoryError) as folder:
        write_whole(tmp_path, "")
    assert folder.value.filename == str(tmp_path)
    with pytest.raises(OSError, match="no room") as nameless, naming("a"):
        raise OSError("no room")
    assert nameless.value.filename == "a" and nameless.value.errno
    with pytest.raises(OSError, match="no room") as other, naming("a", "b"):
        raise OSError(28, "no room", "c")
    assert other.value.filename == "c"
