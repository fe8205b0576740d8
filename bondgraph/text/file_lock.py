"""Locks on files and folders, by which processes know that another one is at work there.

A lock belongs to an open descriptor and its duplicates, and ends with the last of them, so with the
process at the latest: what is not locked is nobody's work any more. Others are not kept from
reading or writing, only from the same lock.
"""

from __future__ import annotations

import errno
import time

#: What the system says where somebody else has the lock; anything else means that there are none.
_HELD = {errno.EWOULDBLOCK, errno.EAGAIN, errno.EACCES}
_PAUSE = 0.02  # s between two tries


def locked(file: int, patience: float = 0.0) -> bool | None:
    """Lock an open file or folder: False where another one has it, None where there are no locks.

    A lock that is held is tried again for so many seconds (`patience`).
    """
    try:
        import fcntl
    except ImportError:  # not on this system
        return None
    end = time.monotonic() + patience
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except OSError as error:
            if error.errno not in _HELD:
                return None
            if time.monotonic() >= end:
                return False
        time.sleep(_PAUSE)
