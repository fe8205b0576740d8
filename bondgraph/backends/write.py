"""Files to the disk: all of them or none, never over what somebody else wrote, nor elsewhere.

The folder may come from a stranger, with a manifest and links of his choice. So the manifest is a
hint and never an order: a name in it counts only if it is a plain path below the folder, every
folder on the way to a file is looked at and none may be a link, and what is read, replaced or
removed is a regular file. Links are refused, not followed and not removed.
"""

from __future__ import annotations

import errno
import json
import os
import shutil
import stat
import tempfile
from collections.abc import Iterable
from hashlib import file_digest, sha256
from pathlib import Path
from typing import Literal

from bondgraph.ir.artifact import Artifact
from bondgraph.text.diagnostic import Trouble

#: Lists what was generated into a folder, with the hash of each file as it was written.
MANIFEST = ".bondgraph.json"

#: A manifest has some hundred bytes a file; one of more bytes than this is not ours.
_LARGEST = 10_000_000
#: What the system says of a place where nothing stands, or can.
_NOTHING = {errno.ENOENT, errno.ENOTDIR, errno.ENAMETOOLONG}


class ForeignFiles(Trouble):
    """The output folder has files in the way that were not generated, or were edited since."""

    def __init__(self, folder: Path, names: tuple[str, ...]) -> None:
        self.folder = folder
        self.names = names
        super().__init__(
            f"{folder} has files that bondgraph did not write as they are: {', '.join(names)}; "
            "move them away, or choose another folder"
        )


def write(artifacts: Iterable[Artifact], folder: str | os.PathLike[str]) -> tuple[str, ...]:
    """Write the files below `folder`, and return their paths (folder included), in order.

    Everything is first written to a folder inside and then moved, so that a failure before that
    leaves everything as it was. Files that an earlier run wrote and this one does not are removed;
    what the manifest does not know, what was edited since, and what is behind a link is never
    touched. `folder` itself may be a link: it was named by who called. Raises `ForeignFiles` if
    something is in the way, OSError if the disk refuses, ValueError for a path that leads out of
    the folder.
    """
    files = {a.path: a.text.encode() for a in artifacts}
    for path in files:
        if not _is_below(path):
            raise ValueError(f"{path} is not a path below the output folder")
    home = Path(folder)
    known = _manifest(home)
    hashes = {path: sha256(data).hexdigest() for path, data in files.items()}
    foreign = [p for p in files if _is_foreign(home, p, known.get(p), hashes[p])]
    if _at(home, MANIFEST) == "obstacle":
        foreign.append(MANIFEST)
    if foreign:
        raise ForeignFiles(home, tuple(foreign))
    manifest = json.dumps({"files": hashes}, indent=1) + "\n"
    _fill(home, {**files, MANIFEST: manifest.encode()})
    for path, written in known.items():
        if path not in files and _is_ours(home, path, written):
            (home / path).unlink()
    return tuple(str(home / path) for path in files)


def _fill(home: Path, files: dict[str, bytes]) -> None:
    """Write all files to a folder of their own, then move them; a new `home` goes if that fails."""
    is_new = not home.exists()
    home.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(prefix=".bondgraph.", dir=home))
    try:
        for path, data in files.items():
            place = temporary / path
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
        for path, data in files.items():
            place = home / path
            if _at(home, path) == "file" and place.read_bytes() == data:
                continue  # it keeps its time: make need not compile it again
            place.parent.mkdir(parents=True, exist_ok=True)
            (temporary / path).replace(place)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        if is_new and not any(home.iterdir()):
            home.rmdir()


def _manifest(home: Path) -> dict[str, str]:
    """The files that an earlier run wrote, with their hashes; what cannot be one is left out."""
    if _at(home, MANIFEST) != "file":
        return {}
    place = home / MANIFEST
    try:
        if place.stat().st_size > _LARGEST:
            return {}
        found = json.loads(place.read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return {}
    if not isinstance(found, dict):
        return {}
    return {p: h for p, h in found.items() if isinstance(h, str) and _is_below(p)}


def _is_below(path: str) -> bool:
    """Whether it is the one plain way to write a path below the folder, with no hidden name in it.

    Hidden files are other programs' affairs (`.git/HEAD`), but for the manifest.

    >>> names = "a.c", "a/b.c", "", ".", "/a", "../a", "a/../b", "./a", "a//b", ".git/HEAD"
    >>> [name for name in names if _is_below(name)]
    ['a.c', 'a/b.c']
    """
    if any(not part or part.startswith(".") for part in path.split("/")):
        return False
    if "\0" in path or "\\" in path or Path(path).is_absolute() or Path(path).drive:
        return False
    try:
        os.fsencode(path)
    except UnicodeError:  # half a character
        return False
    return True


def _at(home: Path, path: str) -> Literal["nothing", "file", "obstacle"]:
    """What stands at a path below `home`: a regular file in real folders, or something in the way.

    No link is followed, neither at the end of the path nor on the way there.
    """
    *folders, name = path.split("/")
    place = home
    try:
        for folder in folders:
            place = place / folder
            if not stat.S_ISDIR(place.lstat().st_mode):
                return "obstacle"
        return "file" if stat.S_ISREG((place / name).lstat().st_mode) else "obstacle"
    except OSError as error:
        if error.errno in _NOTHING:
            return "nothing"
        raise


def _is_foreign(home: Path, path: str, *own: str | None) -> bool:
    """Whether something stands there, or on the way there, that has none of our `own` hashes."""
    standing = _at(home, path)
    if standing == "file":
        with open(home / path, "rb") as file:
            return file_digest(file, "sha256").hexdigest() not in own
    return standing == "obstacle"


def _is_ours(home: Path, path: str, written: str) -> bool:
    """Whether a file stands there as it was `written`; not if it cannot be looked at."""
    try:
        return _at(home, path) == "file" and not _is_foreign(home, path, written)
    except OSError:
        return False
