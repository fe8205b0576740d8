"""Files that are either the old ones or the new ones, never half of them: all writers go here.

A file is written aside, in the folder of the one whose place it takes, put on the disk, and
renamed; then the name is put on the disk. So a process may be killed at any moment, the power may
fail, the disk may be full: under its name there is the old file or the new one. What a killed
process had begun is known by its name and because nobody holds its lock; the next one that writes
into the folder removes it.
"""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TypeVar

from bondgraph.text.file_lock import locked
from bondgraph.text.printable import printable

_Opened = TypeVar("_Opened", int, int | None)

_BEGUN = re.compile(r"\.bondgraph-[0-9a-f]{12}\.tmp")
#: What a system says that cannot put names on the disk by themselves.
_NO_SYNC = {errno.EINVAL, errno.ENOTSUP, errno.EBADF}


@contextmanager
def whole(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A file to write to, which takes the place of another one at the end, or vanishes.

    What is no regular file (a device, a named pipe) is written to as it stands. Raises OSError that
    names the file, not the one aside.
    """
    final = Path(path)
    if final.exists() and not final.is_file():
        yield final
        return
    with aside(final) as (temporary, _):
        yield temporary


@contextmanager
def aside(path: str | os.PathLike[str], private: bool = False) -> Iterator[tuple[Path, int]]:
    """The file aside and a descriptor of it that has its lock; else as `whole`.

    A duplicate of the descriptor keeps the lock when the file has taken its place. What is
    `private` can be read and written by its owner alone; else a file keeps the mode that it had.
    """
    final = Path(path)
    with naming(final):
        remove_leftovers(final.parent)
        temporary, file = _begun(final.parent, lambda p: _created(p, 0o600 if private else 0o666))
    opened = ExitStack()
    opened.callback(os.close, file)
    try:
        with naming(final, temporary):
            yield temporary, file
        with naming(final):
            with suppress(FileNotFoundError):
                if not private:
                    temporary.chmod(stat.S_IMODE(final.stat().st_mode))
            os.fsync(file)
            if os.name == "nt":  # it renames nothing that is open
                opened.close()
            os.replace(temporary, final)
    except BaseException:
        with suppress(OSError):
            temporary.unlink()
        raise
    finally:
        opened.close()
    with naming(final):
        sync_folder(final.parent)


@contextmanager
def folder_aside(home: Path) -> Iterator[Path]:
    """A private folder in `home` to write to; it is gone at the end, with what is left in it."""
    remove_leftovers(home)
    temporary, file = _begun(home, _made)
    try:
        yield temporary
    finally:
        shutil.rmtree(temporary, ignore_errors=True)
        if file is not None:
            os.close(file)


def write_whole(path: str | os.PathLike[str], text: str) -> None:
    """Write a text of ours to a file, printably, all of it or nothing; raises OSError."""
    with whole(path) as temporary, naming(path):
        temporary.write_text(printable(text), encoding="utf-8", newline="\n")


def write_bytes(path: str | os.PathLike[str], data: bytes, private: bool = False) -> None:
    """Write bytes to a file, all of them or nothing; raises OSError. `private` as in `aside`."""
    with aside(path, private) as (temporary, _), naming(path):
        temporary.write_bytes(data)


def sync_files(paths: Iterable[Path]) -> None:
    """Put what was written to files on the disk; many at once are quicker. Raises OSError."""
    for path in paths:
        with open(path, "r+b") as file, naming(path):
            os.fsync(file.fileno())


def sync_folder(folder: str | os.PathLike[str]) -> None:
    """Put the names in a folder on the disk, as far as the system can; raises OSError."""
    file = opened_folder(folder)
    if file is None:
        return
    try:
        os.fsync(file)
    except OSError as error:
        if error.errno not in _NO_SYNC:
            raise
    finally:
        os.close(file)


def remove_leftovers(folder: Path) -> None:
    """Remove what killed processes had begun in a folder, as far as that can be done."""
    with suppress(OSError):
        for name in filter(_BEGUN.fullmatch, os.listdir(folder)):
            with suppress(OSError):
                _remove_left(folder / name)


@contextmanager
def naming(
    path: str | os.PathLike[str], other: str | os.PathLike[str] | None = None
) -> Iterator[None]:
    """Have the failures of the system name the file `path`, which the user knows.

    Without `other` all of them do, else those only that name the file `other`.
    """
    try:
        yield
    except OSError as error:
        if other is not None and error.filename != os.fspath(other):
            raise
        why = error.strerror or str(error)
        raise OSError(error.errno or errno.EIO, why, os.fspath(path)) from error


def opened_folder(folder: str | os.PathLike[str]) -> int | None:
    """A descriptor of a folder, to be locked or put on the disk; None where there can be none."""
    try:
        return os.open(folder, os.O_RDONLY)
    except PermissionError:  # not for us to read, or not on this system
        return None


def _begun(folder: Path, make: Callable[[Path], _Opened]) -> tuple[Path, _Opened]:
    """Something new in a folder, open and with its lock if that can be."""
    while True:
        path = folder / f".bondgraph-{os.urandom(6).hex()}.tmp"
        file = make(path)
        if file is None:
            return path, file
        try:
            # Before it was locked another process may have taken it for something left.
            if locked(file) is not False and os.path.samestat(os.fstat(file), os.lstat(path)):
                return path, file
        except FileNotFoundError:
            pass
        except BaseException:
            os.close(file)
            raise
        os.close(file)


def _created(path: Path, mode: int) -> int:
    return os.open(path, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_APPEND, mode)


def _made(path: Path) -> int | None:
    while True:
        path.mkdir(0o700)
        try:
            return opened_folder(path)
        except FileNotFoundError:
            continue  # another process has taken it for something left
        except OSError:
            with suppress(OSError):
                path.rmdir()
            raise


def _remove_left(path: Path) -> None:
    """Remove a file or folder that was begun, if nobody is at it."""
    file = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    try:
        if not locked(file):
            return
        if stat.S_ISDIR(os.fstat(file).st_mode):
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink()
    finally:
        os.close(file)
