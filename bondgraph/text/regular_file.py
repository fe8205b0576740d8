"""Files that are files: no folder, device or pipe is read in place of one, nothing without end."""

from __future__ import annotations

import errno
import os
import stat

_KINDS = (
    (stat.S_ISDIR, errno.EISDIR, "it is a folder"),
    (stat.S_ISCHR, errno.ENODEV, "it is a device"),
    (stat.S_ISBLK, errno.ENODEV, "it is a device"),
    (stat.S_ISSOCK, errno.ENODEV, "it is a socket"),
    (stat.S_ISFIFO, errno.ESPIPE, "it is a pipe"),
)


def check_regular(
    path: str | os.PathLike[str], most: int | None = None, pipe: bool = False
) -> None:
    """Raise OSError, with the reason, for what is no regular file or has more than `most` bytes.

    A `pipe` may be allowed: one that a person named, who knows that somebody writes to it.
    """
    status = os.stat(path)
    for is_one, number, what in _KINDS:
        if is_one(status.st_mode) and not (pipe and number == errno.ESPIPE):
            raise OSError(number, f"{what}, no regular file", os.fspath(path))
    if most is not None and status.st_size > most:
        size = f"it has {status.st_size} bytes, {most} are read at most"
        raise OSError(errno.EFBIG, size, os.fspath(path))
