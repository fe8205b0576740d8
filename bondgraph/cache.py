"""What is kept from run to run: compiled residuals and templates, in a folder of one's own.

To load them is to run them, and a library that is cut short kills the process that touches its
end. So nothing is loaded that others could have written, nor anything whose content has not the
hash that its name says. Because of that hash a name stands for one content for ever: what the
loader has in memory under a name is what is on the disk.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterator
from contextlib import suppress
from hashlib import file_digest, sha256
from pathlib import Path

from bondgraph.text.whole_file import write_bytes

_KEPT = 300  # files of one kind, more than the templates of two installations
_WRITABLE = stat.S_IWGRP | stat.S_IWOTH


class Cache:
    """A folder with files `name.hash.kind`, the hash being that of the content."""

    def __init__(self, folder: Path, kind: str) -> None:
        self.folder = folder
        self.kind = kind

    def find(self, name: str) -> Iterator[Path]:
        """The sound files of this name; those that are not are removed."""
        for path in self._files(f"{name}."):
            sound = _is_sound(path)
            with suppress(OSError):
                if sound:
                    os.utime(path)  # it is used: others are older
                else:
                    path.unlink()
            if sound:
                yield path

    def _files(self, start: str = "") -> list[Path]:
        """The files of this kind whose names begin so."""
        try:
            names = sorted(os.listdir(self.folder))
        except OSError:
            return []
        return [
            self.folder / n for n in names if n.startswith(start) and n.endswith(f".{self.kind}")
        ]

    def keep(self, name: str, data: bytes) -> Path | None:
        """Take a content in, whole or not at all, and forget the oldest; where it is then."""
        path = self.folder / f"{name}.{sha256(data).hexdigest()}.{self.kind}"
        try:
            write_bytes(path, data, private=True)
        except OSError:
            return None
        self._tidy()
        return path

    def _tidy(self) -> None:
        with suppress(OSError):  # another process may be at it
            kept = sorted(self._files(), key=lambda p: p.stat().st_mtime)
            for old in kept[:-_KEPT]:
                old.unlink()


def user_cache(kind: str, tell: Callable[[str], object]) -> Cache | None:
    """The cache of this user, None where there can be none; `tell` is told of one not to trust.

    Its folder is `$XDG_CACHE_HOME/bondgraph`, or `~/.cache/bondgraph`.
    """
    if not hasattr(os, "geteuid"):
        return None  # nothing here says whose a file is
    own = os.environ.get("XDG_CACHE_HOME", "")
    try:
        base = Path(own) if os.path.isabs(own) else Path.home() / ".cache"
        folder = base / "bondgraph"
        base.mkdir(mode=0o700, parents=True, exist_ok=True)
        folder.mkdir(mode=0o700, exist_ok=True)
        why = _mistrust(folder)
    except (OSError, RuntimeError):
        return None
    if why:
        tell(f"the cache {folder} is not used: {why}")
        return None
    return Cache(folder, kind)


def _mistrust(folder: Path) -> str | None:
    """Why others could put a file into a folder, or another folder in its place."""
    state = folder.lstat()
    if stat.S_ISLNK(state.st_mode):
        return "it is a link"
    if state.st_uid != os.geteuid():
        return "it belongs to another user"
    if state.st_mode & _WRITABLE:
        return f"others can write to it (`chmod go-w {folder}`)"
    for above in folder.resolve().parents:
        mode = above.stat().st_mode
        if mode & stat.S_IWOTH and not mode & stat.S_ISVTX:
            return f"others can write to {above}"
    return None


def _is_sound(path: Path) -> bool:
    """Whether a file is ours alone and has the content that its name says."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return False
    try:
        state = os.fstat(descriptor)
        if not stat.S_ISREG(state.st_mode) or state.st_mode & _WRITABLE:
            return False
        if state.st_uid != os.geteuid():
            return False
        with open(descriptor, "rb", closefd=False) as file:
            return path.suffixes[-2:-1] == ["." + file_digest(file, "sha256").hexdigest()]
    except OSError:
        return False
    finally:
        os.close(descriptor)
