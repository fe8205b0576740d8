"""Files reach the disk all or none, and nobody else's file is lost."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from bondgraph.backends.write import MANIFEST, ForeignFiles, changes, write
from bondgraph.ir.artifact import Artifact
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.file_lock import locked

_FILES = (Artifact("a.c", "one\n"), Artifact("deep/b.py", "two\n"))


def test_writes_and_says_what(tmp_path: Path) -> None:
    out = tmp_path / "new" / "out"
    assert write(_FILES, out) == (str(out / "a.c"), str(out / "deep/b.py"))
    assert (out / "a.c").read_text() == "one\n" and (out / "deep/b.py").read_text() == "two\n"
    assert {p.name for p in out.parent.iterdir()} == {"out"}  # nothing is left lying about


def test_again_replaces_keeps_and_removes_its_own(tmp_path: Path) -> None:
    write(_FILES, tmp_path / "out")
    kept = (tmp_path / "out/a.c").stat().st_mtime_ns
    write((Artifact("a.c", "one\n"), Artifact("c.h", "three\n")), tmp_path / "out")
    assert (tmp_path / "out/a.c").stat().st_mtime_ns == kept  # make need not compile it again
    assert (tmp_path / "out/c.h").exists() and not (tmp_path / "out/deep/b.py").exists()


def test_costs_stay_with_the_code_that_they_are_of(tmp_path: Path) -> None:
    out = tmp_path / "out"
    head, costs, tail = "# M\n\n## Use\nthis\n", "\n## What it costs\n| 7 |\n", "\n## More\nthat\n"
    measured = (Artifact("a.c", "one\n"), Artifact("README.md", head + costs + tail))
    plain = (Artifact("a.c", "one\n"), Artifact("README.md", head + tail))
    write(measured, out)
    assert {c.what for c in changes(plain, out)} == {"same"}
    write(plain, out)
    assert (out / "README.md").read_text() == head + costs + tail
    other = (Artifact("a.c", "two\n"), plain[1])
    assert [c.what for c in changes(other, out)] == ["changed", "changed"]
    write(other, out)
    assert (out / "README.md").read_text() == head + tail
    write(measured, out)
    (out / "README.md").write_text(f"mine {costs}")
    with pytest.raises(ForeignFiles, match=r"README\.md"):
        write(plain, out)


@pytest.mark.parametrize("made", ["by somebody", "by us and edited"])
def test_a_foreign_file_stops_everything(made: str, tmp_path: Path) -> None:
    out = tmp_path / "out"
    if made == "by somebody":
        out.mkdir()
    else:
        write(_FILES, out)
    (out / "a.c").write_text("mine\n")
    before = sorted(p.name for p in out.iterdir())
    with pytest.raises(ForeignFiles, match=r"a\.c"):
        write((Artifact("a.c", "changed\n"), Artifact("new.c", "four\n")), out)
    assert (out / "a.c").read_text() == "mine\n"
    assert sorted(p.name for p in out.iterdir()) == before


def test_other_files_in_the_folder_stay(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out/notes.txt").write_text("mine\n")
    write(_FILES, tmp_path / "out")
    write(_FILES[:1], tmp_path / "out")
    assert (tmp_path / "out/notes.txt").read_text() == "mine\n"


def test_an_edited_file_of_ours_is_not_removed(tmp_path: Path) -> None:
    write(_FILES, tmp_path / "out")
    (tmp_path / "out/a.c").write_text("edited\n")
    write(_FILES[1:], tmp_path / "out")
    assert (tmp_path / "out/a.c").read_text() == "edited\n"


def test_a_checkout_without_manifest_is_accepted_where_it_is_equal(tmp_path: Path) -> None:
    write(_FILES, tmp_path / "out")
    (tmp_path / "out" / MANIFEST).unlink()
    write(_FILES, tmp_path / "out")


@pytest.mark.parametrize("path", ["../x", "/x", "a/../../x", MANIFEST])
def test_no_way_out_of_the_folder(path: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="not a path"):
        write((Artifact(path, ""),), tmp_path / "out")


def test_a_full_disk_leaves_everything_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    write(_FILES, out)
    real = Path.write_bytes

    def full(self: Path, data: bytes) -> int:
        if self.name == "c.h":
            raise OSError("no space left")
        return real(self, data)

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="no space"):
        write((Artifact("a.c", "changed\n"), Artifact("c.h", "")), out)
    assert (out / "a.c").read_text() == "one\n"
    assert {p.name for p in tmp_path.iterdir()} == {"out"}


class _Killed(BaseException):
    """What nobody catches, as nobody catches a signal 9."""


def test_after_a_kill_between_two_files_anything_can_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    write(_FILES, out)
    real, moved = Path.replace, 0

    def killed(self: Path, target: Path) -> Path:
        nonlocal moved
        moved += target.parent == out
        if moved == 2:  # the first is the manifest
            raise _Killed
        return real(self, target)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", killed)
        with pytest.raises(_Killed):
            write((Artifact("a.c", "new\n"), Artifact("c.h", "new\n")), out)
    third = (Artifact("c.h", "third\n"),)
    write(third, out)  # neither what was there nor what was begun
    assert (out / "c.h").read_text() == "third\n"
    assert {p.name for p in out.rglob("*") if p.is_file()} == {"c.h", MANIFEST}


def test_a_failure_between_two_files_says_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    write(_FILES, out)

    def denied(self: Path, target: Path) -> Path:
        raise PermissionError(13, "Permission denied", str(self))

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", denied)
        with pytest.raises(Trouble, match="some of its files are new and some are old"):
            write((Artifact("a.c", "new\n"),), out)
    write((Artifact("a.c", "new\n"),), out)
    assert (out / "a.c").read_text() == "new\n" and not (out / "deep/b.py").exists()


def test_two_writers_do_not_mix_their_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    write(_FILES, out)
    monkeypatch.setattr("bondgraph.backends.write._PATIENCE", 0.0)
    other = os.open(out, os.O_RDONLY)
    try:
        assert locked(other)
        with pytest.raises(Trouble, match="another process"):
            write((Artifact("a.c", "changed\n"),), out)
    finally:
        os.close(other)
    assert (out / "a.c").read_text() == "one\n"
