"""Files to the disk: all of them or none, and never over a file that somebody else wrote."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path

from bondgraph.ir.artifact import Artifact

#: Lists what was generated into a folder, with the hash of each file as it was written.
MANIFEST = ".bondgraph.json"


class ForeignFiles(Exception):
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

    Everything is first written to a folder beside it and then moved, so that a failure before
    that leaves everything as it was. Files that an earlier run wrote and this one does not are
    removed; what the manifest does not know, or what was edited since, is never touched. Raises
    `ForeignFiles` if such a file is in the way, OSError if the disk refuses, ValueError for a
    path that leads out of the folder.
    """
    files = {a.path: a.text.encode() for a in artifacts}
    for path in files:
        if Path(path).is_absolute() or ".." in Path(path).parts or path == MANIFEST:
            raise ValueError(f"{path} is not a path below the output folder")
    home = Path(folder)
    known = _manifest(home)
    foreign = tuple(p for p in files if _is_foreign(home / p, known.get(p), files[p]))
    if foreign:
        raise ForeignFiles(home, foreign)
    hashes = {path: sha256(data).hexdigest() for path, data in files.items()}
    manifest = json.dumps({"files": hashes}, indent=1) + "\n"
    home.parent.mkdir(parents=True, exist_ok=True)
    temporary = Path(tempfile.mkdtemp(prefix=f".{home.name}.", dir=home.parent))
    try:
        for path, data in {**files, MANIFEST: manifest.encode()}.items():
            place = temporary / path
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)
        _move(temporary, home, [*files, MANIFEST])
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
    for path in [p for p in known if p not in files]:
        if not _is_foreign(home / path, known[path], None):
            (home / path).unlink(missing_ok=True)
    return tuple(str(home / path) for path in files)


def _move(temporary: Path, home: Path, paths: list[str]) -> None:
    """Move the files in; those that are already as they should be keep their time."""
    home.mkdir(exist_ok=True)
    for path in paths:
        place = home / path
        if place.is_file() and place.read_bytes() == (temporary / path).read_bytes():
            continue
        place.parent.mkdir(parents=True, exist_ok=True)
        (temporary / path).replace(place)


def _manifest(home: Path) -> dict[str, str]:
    """The files that an earlier run wrote, with their hashes."""
    try:
        found = json.loads((home / MANIFEST).read_text(encoding="utf-8"))["files"]
    except (OSError, ValueError, KeyError, TypeError):
        return {}
    if not isinstance(found, dict):
        return {}
    return {p: h for p, h in found.items() if isinstance(h, str) and ".." not in Path(p).parts}


def _is_foreign(place: Path, written: str | None, wanted: bytes | None) -> bool:
    """Whether something other than the generated file stands there."""
    if not place.exists():
        return False
    if not place.is_file():
        return True
    data = place.read_bytes()
    return data != wanted and sha256(data).hexdigest() != written
