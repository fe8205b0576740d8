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
import re
import stat
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Set
from contextlib import contextmanager
from hashlib import file_digest, sha256
from pathlib import Path
from typing import Literal

from bondgraph.ir.artifact import Artifact, BinaryArtifact
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.file_lock import locked
from bondgraph.text.printable import printable
from bondgraph.text.tuples import NamedTuple
from bondgraph.text.whole_file import (
    folder_aside,
    naming,
    opened_folder,
    sync_files,
    sync_folder,
    write_whole,
)

#: Lists what was generated into a folder, with the hash of each file as it was written.
MANIFEST = ".bondgraph.json"

#: In a README what `compile --costs` has measured.
COSTS = re.compile(r"\n## What it costs\n.*?(?=\n## |\Z)", re.DOTALL)

#: A manifest has some hundred bytes a file; one of more bytes than this is not ours.
_LARGEST = 10_000_000
_PATIENCE = 10.0  # s that another process has to write its files
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


def write(
    artifacts: Iterable[Artifact | BinaryArtifact], folder: str | os.PathLike[str]
) -> tuple[str, ...]:
    """Write the files below `folder`, and return their paths (folder included), in order.

    Everything is first written to a folder inside and then moved, so that a failure before that
    leaves everything as it was. While files are moved the manifest lists both the new and the old
    ones: wherever a process is killed, the next one knows them all as ours, and what it writes is
    whole again. Files that an earlier run wrote and this one does not are removed; what the
    manifest does not know, what was edited since, and what is behind a link is never touched. What
    was measured of the very same C stays in the README.
    `folder` itself may be a link: it was named by who called. Raises `ForeignFiles` if something is
    in the way, `Trouble` where another process writes there or the disk refuses while files are
    moved, OSError if it refuses before, ValueError for a path that leads out of the folder.
    """
    files = _contents(artifacts)
    for path in files:
        if not _is_below(path):
            raise ValueError(f"{path} is not a path below the output folder")
    home = Path(folder)
    known = _manifest(home)
    files = _with_costs(home, files, known)
    _refuse_foreign(home, files, known)
    is_new = not home.exists()
    home.mkdir(parents=True, exist_ok=True)
    try:
        with _alone(home):
            _fill(home, files)
        if is_new:
            sync_folder(home.parent)
    finally:
        if is_new and not any(home.iterdir()):
            home.rmdir()
    return tuple(str(home / path) for path in files)


class Change(NamedTuple):
    """What `write` would do to a file: new, changed, same, removed, or foreign: it would refuse."""

    path: str
    what: Literal["new", "changed", "same", "removed", "foreign"]


def changes(
    artifacts: Iterable[Artifact | BinaryArtifact], folder: str | os.PathLike[str]
) -> tuple[Change, ...]:
    """What `write` would do below a folder, file by file, in order; nothing is touched.

    Raises OSError for a folder that cannot be read.
    """
    home = Path(folder)
    known = _manifest(home)
    files = _with_costs(home, _contents(artifacts), known)
    found = []
    for path, data in files.items():
        own = _hash(data)
        if _is_foreign(home, path, known.get(path, set()) | {own}):
            found.append(Change(path, "foreign"))
        elif _at(home, path) == "nothing":
            found.append(Change(path, "new"))
        else:
            found.append(Change(path, "same" if _stands(home, path, {own}) else "changed"))
    old = [p for p in known if p not in files and _stands(home, p, known[p])]
    return (*found, *[Change(path, "removed") for path in old])


def outdated(
    artifacts: Iterable[Artifact | BinaryArtifact], folder: str | os.PathLike[str]
) -> tuple[str, ...]:
    """The paths below `folder` that are not what `write` would leave there; nothing is written.

    These are files that are missing or other ones, and files of an earlier run that are not among
    the artifacts.
    """
    return tuple(str(Path(folder) / c.path) for c in changes(artifacts, folder) if c.what != "same")


def _contents(artifacts: Iterable[Artifact | BinaryArtifact]) -> dict[str, bytes]:
    """The bytes of each file, by its path."""
    return {
        a.path: a.data if isinstance(a, BinaryArtifact) else printable(a.text).encode()
        for a in artifacts
    }


def _with_costs(
    home: Path, files: dict[str, bytes], known: Mapping[str, set[str]]
) -> dict[str, bytes]:
    """The files, with the README that stands there if only the costs of the same C are more."""
    readme = "README.md"
    code = [path for path in files if path.endswith((".c", ".h"))]
    if not code or readme not in files or not _stands(home, readme, known.get(readme, set())):
        return files
    if not all(_stands(home, path, {_hash(files[path])}) for path in code):
        return files
    standing = (home / readme).read_bytes()
    same = COSTS.sub("", standing.decode("utf-8")).encode() == files[readme]
    return {**files, readme: standing} if same else files


def _refuse_foreign(home: Path, files: Mapping[str, bytes], known: Mapping[str, set[str]]) -> None:
    """Raise `ForeignFiles` if something is in the way that is not ours."""
    ours = {path: known.get(path, set()) | {_hash(data)} for path, data in files.items()}
    foreign = [path for path in files if _is_foreign(home, path, ours[path])]
    if _at(home, MANIFEST) == "obstacle":
        foreign.append(MANIFEST)
    if foreign:
        raise ForeignFiles(home, tuple(foreign))


@contextmanager
def _alone(home: Path) -> Iterator[None]:
    """Keep other compilers from writing into a folder; wait a little for one that does."""
    file = opened_folder(home)
    try:
        if file is not None and locked(file, _PATIENCE) is False:
            raise Trouble(f"{home}: another process writes into it; try again, or name another")
        yield
    finally:
        if file is not None:
            os.close(file)


def _fill(home: Path, files: Mapping[str, bytes]) -> None:
    """Write all files to a folder of their own, then move them; see `write`."""
    known = _manifest(home)  # again: another process may just have finished
    _refuse_foreign(home, files, known)
    hashes = {path: _hash(data) for path, data in files.items()}
    manifest = json.dumps({"files": hashes}, indent=1) + "\n"
    new = [p for p in files if not _stands(home, p, {hashes[p]})]  # others keep their times: make
    old = [p for p in known if p not in files and _stands(home, p, known[p])]
    with folder_aside(home) as temporary:
        for path in new:
            place = temporary / path
            place.parent.mkdir(parents=True, exist_ok=True)
            with naming(home / path):
                place.write_bytes(files[path])
        sync_files(temporary / path for path in new)
        if new or old:
            before = {path: sorted(known[path]) for path in known}
            write_whole(home / MANIFEST, json.dumps({"files": hashes, "before": before}) + "\n")
        try:
            for path in new:
                place = home / path
                place.parent.mkdir(parents=True, exist_ok=True)
                (temporary / path).replace(place)
            for path in old:
                (home / path).unlink()
            for touched in sorted({(home / p).parent for p in new + old}):
                sync_folder(touched)
        except OSError as error:
            raise Trouble(
                f"{home}: {error.strerror or error}: {error.filename2 or error.filename}; some of"
                " its files are new and some are old: mend this and write into it again"
            ) from error
    if not _stands(home, MANIFEST, {_hash(manifest.encode())}):
        write_whole(home / MANIFEST, manifest)


def _hash(data: bytes) -> str:
    return sha256(data).hexdigest()


def _manifest(home: Path) -> Mapping[str, set[str]]:
    """The hashes of the files that earlier runs wrote; what cannot be a file is left out.

    There are several of a file if a run did not come to its end. Raises OSError.
    """
    known: defaultdict[str, set[str]] = defaultdict(set)
    if _at(home, MANIFEST) != "file":
        return known
    place = home / MANIFEST
    try:
        if place.stat().st_size > _LARGEST:
            return known
        found = json.loads(place.read_text(encoding="utf-8"))
    except (ValueError, RecursionError):
        return known
    for part in ("files", "before"):
        listed = found.get(part) if isinstance(found, dict) else None
        for path, hashes in listed.items() if isinstance(listed, dict) else ():
            several = hashes if isinstance(hashes, list) else [hashes]
            if _is_below(path):
                known[path].update(h for h in several if isinstance(h, str))
    return known


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


def _is_foreign(home: Path, path: str, own: Set[str]) -> bool:
    """Whether something stands there, or on the way there, that has none of our `own` hashes."""
    standing = _at(home, path)
    if standing == "file":
        with open(home / path, "rb") as file:
            return file_digest(file, "sha256").hexdigest() not in own
    return standing == "obstacle"


def _stands(home: Path, path: str, written: Set[str]) -> bool:
    """Whether a file stands there as it was `written`."""
    return _at(home, path) == "file" and not _is_foreign(home, path, written)
