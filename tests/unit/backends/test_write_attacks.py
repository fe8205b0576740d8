"""A folder that a stranger has prepared: whatever is in it, nothing outside of it is touched."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import NamedTuple

import pytest

from bondgraph.backends.write import MANIFEST, ForeignFiles, write
from bondgraph.ir.artifact import Artifact

_FILES = (Artifact("a.c", "one\n"), Artifact("deep/b.py", "two\n"))
_LOOT = b"all the work of a year\n"
_HASH = sha256(_LOOT).hexdigest()


class Place(NamedTuple):
    """A folder `home` of somebody, with a file `loot` in it, and the folder `out` to write to."""

    home: Path
    loot: Path
    out: Path

    def manifest(self, files: object) -> None:
        """What the stranger says that we wrote."""
        (self.out / MANIFEST).write_text(json.dumps({"files": files}))

    def outside(self) -> dict[str, tuple[int, int, int, str | bytes]]:
        """All that is not in `out`: its kind, its inode, when it was changed, and its content."""
        found: dict[str, tuple[int, int, int, str | bytes]] = {}
        for path in sorted(self.home.parent.rglob("*")):
            if path != self.out and self.out not in path.parents:
                state = path.lstat()
                content = path.read_bytes() if path.is_file() else b""
                found[str(path)] = (state.st_mode, state.st_ino, state.st_mtime_ns, content)
        return found


@pytest.fixture
def place(tmp_path: Path) -> Place:
    home, out = tmp_path / "home", tmp_path / "work" / "out"
    home.mkdir()
    out.mkdir(parents=True)
    (home / "loot").write_bytes(_LOOT)
    return Place(home, home / "loot", out)


#: Names of the file of somebody, as a manifest can say them.
NAMES: dict[str, Callable[[Place], str]] = {
    "absolute": lambda p: str(p.loot),
    "up": lambda p: "../../home/loot",
    "down and up": lambda p: "deep/../../../home/loot",
    "dots": lambda p: "./../../home/loot",
    "slashes": lambda p: "//" + str(p.loot),
    "the folder itself": lambda p: ".",
    "nothing": lambda p: "",
    "its own name": lambda p: "../out/../../home/loot",
    "the manifest": lambda p: MANIFEST,
    "a null": lambda p: f"{p.loot}\0.c",
    "half a character": lambda p: "\ud800",
    "backslashes": lambda p: "..\\..\\home\\loot",
    "very long": lambda p: "x" * 5000,
    "very deep": lambda p: "x/" * 3000 + "x",
}


@pytest.mark.parametrize("name", NAMES)
def test_a_name_in_the_manifest(name: str, place: Place) -> None:
    place.manifest({NAMES[name](place): _HASH})
    before = place.outside()
    write(_FILES, place.out)
    write(_FILES[:1], place.out)
    assert place.outside() == before
    assert json.loads((place.out / MANIFEST).read_text())["files"].keys() == {"a.c"}


def test_hidden_files_are_not_ours(place: Place) -> None:
    """Of a repository whose content everybody can guess, where one compiles into its top."""
    head = place.out / ".git" / "HEAD"
    head.parent.mkdir()
    head.write_text("ref: refs/heads/main\n")
    place.manifest({".git/HEAD": sha256(head.read_bytes()).hexdigest()})
    write(_FILES, place.out)
    assert head.exists()


def test_a_link_that_the_manifest_lists(place: Place) -> None:
    """Neither what it leads to is removed, nor the link: it was not we who made it."""
    (place.out / "old.c").symlink_to(place.loot)
    place.manifest({"old.c": _HASH})
    before = place.outside()
    write(_FILES, place.out)
    assert place.outside() == before
    assert (place.out / "old.c").is_symlink()


def test_a_folder_that_is_a_link_and_the_manifest_lists_what_is_behind(place: Place) -> None:
    (place.out / "sub").symlink_to(place.home)
    (place.out / "real").mkdir()
    (place.out / "real" / "sub").symlink_to(place.home)
    place.manifest({"sub/loot": _HASH, "real/sub/loot": _HASH})
    before = place.outside()
    write(_FILES, place.out)
    assert place.outside() == before


def _link_folder(place: Place) -> None:
    (place.out / "deep").symlink_to(place.home)


def _link_folder_equal(place: Place) -> None:
    (place.home / "b.py").write_text("two\n")
    _link_folder(place)


def _link_folder_to_be_replaced(place: Place) -> None:
    (place.home / "b.py").write_bytes(_LOOT)
    _link_folder(place)
    place.manifest({"deep/b.py": _HASH})


def _link_file(place: Place) -> None:
    (place.out / "a.c").symlink_to(place.loot)
    place.manifest({"a.c": _HASH})


def _link_file_equal(place: Place) -> None:
    (place.home / "same").write_text("one\n")
    (place.out / "a.c").symlink_to(place.home / "same")


def _link_to_nothing(place: Place) -> None:
    (place.out / "a.c").symlink_to(place.home / "new")


def _link_to_itself(place: Place) -> None:
    (place.out / "deep").symlink_to("deep")


def _file_for_folder(place: Place) -> None:
    (place.out / "deep").write_text("a file\n")


def _folder_for_file(place: Place) -> None:
    (place.out / "a.c").mkdir()


def _pipe(place: Place) -> None:
    os.mkfifo(place.out / "a.c")


def _manifest_link(place: Place) -> None:
    (place.home / "list").write_text(json.dumps({"files": {"note": _HASH}}))
    (place.out / "note").write_bytes(_LOOT)
    (place.out / MANIFEST).symlink_to(place.home / "list")


def _manifest_link_to_nothing(place: Place) -> None:
    (place.out / MANIFEST).symlink_to(place.home / "new")


def _manifest_folder(place: Place) -> None:
    (place.out / MANIFEST).mkdir()


def _manifest_pipe(place: Place) -> None:
    os.mkfifo(place.out / MANIFEST)


OBSTACLES = {
    _link_folder: "deep/b.py",
    _link_folder_equal: "deep/b.py",
    _link_folder_to_be_replaced: "deep/b.py",
    _link_file: "a.c",
    _link_file_equal: "a.c",
    _link_to_nothing: "a.c",
    _link_to_itself: "deep/b.py",
    _file_for_folder: "deep/b.py",
    _folder_for_file: "a.c",
    _pipe: "a.c",
    _manifest_link: MANIFEST,
    _manifest_link_to_nothing: MANIFEST,
    _manifest_folder: MANIFEST,
    _manifest_pipe: MANIFEST,
}


@pytest.mark.parametrize("prepare", OBSTACLES, ids=lambda f: f.__name__)
def test_what_is_in_the_way_stops_everything(
    prepare: Callable[[Place], None], place: Place
) -> None:
    prepare(place)
    before, inside = place.outside(), sorted(place.out.rglob("*"))
    with pytest.raises(ForeignFiles) as error:
        write(_FILES, place.out)
    assert error.value.names == (OBSTACLES[prepare],)
    assert place.outside() == before
    assert sorted(place.out.rglob("*")) == inside


def test_a_file_that_shares_its_content_with_one_elsewhere(place: Place) -> None:
    """A hard link: the name goes or is written anew, the other name keeps what it had."""
    for name in ("a.c", "old.c"):
        os.link(place.loot, place.out / name)
    place.manifest({"a.c": _HASH, "old.c": _HASH})
    write(_FILES, place.out)
    assert place.loot.read_bytes() == _LOOT
    assert (place.out / "a.c").read_text() == "one\n" and not (place.out / "old.c").exists()


@pytest.mark.parametrize(
    "text",
    [
        "[" * 100_000,
        '{"files": []}',
        '{"files": {"note": 1}}',
        '{"files": {"note": null}}',
        '{"files": "note"}',
        '["files"]',
        "null",
        "\ufeff{}",
        "",
        '{"files": ' + "1" * 5000 + "}",
        " " * 11_000_000,
    ],
    ids=range(11),
)
def test_a_manifest_that_is_none(text: str, place: Place) -> None:
    (place.out / MANIFEST).write_text(text, encoding="utf-8")
    (place.out / "note").write_bytes(_LOOT)
    write(_FILES, place.out)
    assert (place.out / "note").read_bytes() == _LOOT
    assert json.loads((place.out / MANIFEST).read_text())["files"].keys() == {"a.c", "deep/b.py"}


def test_a_manifest_of_other_bytes(place: Place) -> None:
    (place.out / MANIFEST).write_bytes(bytes(range(256)))
    write(_FILES, place.out)
    assert (place.out / "a.c").exists()


def test_a_folder_that_is_named_by_a_link_is_the_folder_behind_it(place: Place) -> None:
    """Who says `-o out` chose where it leads; links inside are still not followed."""
    link = place.home / "chosen"
    link.symlink_to(place.out)
    before = place.outside()
    assert write(_FILES, link) == (str(link / "a.c"), str(link / "deep/b.py"))
    write(_FILES[:1], link)
    assert place.outside() == before
    assert (place.out / "a.c").exists() and not (place.out / "deep/b.py").exists()


def test_a_link_to_nothing_is_no_folder(place: Place) -> None:
    link = place.home / "chosen"
    link.symlink_to(place.home / "new")
    before = place.outside()
    with pytest.raises(OSError, match="exists"):
        write(_FILES, link)
    assert place.outside() == before


def test_a_failure_leaves_no_new_folder(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(self: Path, data: bytes) -> int:
        raise OSError("no space left")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="no space"):
        write(_FILES, place.out / "new")
    assert list(place.out.iterdir()) == []


@pytest.mark.parametrize("linked", ["generated", "generated/dc_motor"])
def test_a_default_folder_that_is_a_link(
    linked: str,
    place: Place,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    root: Path,
) -> None:
    """A checkout of a stranger chooses nothing: without -o the output stays below here."""
    from bondgraph.cli.main import main

    monkeypatch.chdir(place.out)
    link = place.out / linked
    link.parent.mkdir(exist_ok=True)
    link.symlink_to(place.home)
    before = place.outside()
    assert main(["compile", str(root / "models" / "dc_motor.bg")]) == 1
    assert f"{linked} is a link to {place.home}; say with -o" in capsys.readouterr().err
    assert place.outside() == before
