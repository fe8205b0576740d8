"""Files that are either the old ones or the new ones, never half of them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole(path: str) -> Iterator[Path]:
    """A file to write to, which takes the place of another one at the end, or vanishes."""
    final = Path(path)
    temporary = final.with_name(f".{final.name}.{os.urandom(6).hex()}.tmp")
    temporary.touch(exist_ok=False)  # a file of our own, not what somebody put there
    try:
        yield temporary
        if final.exists():
            temporary.chmod(final.stat().st_mode)
        temporary.replace(final)
    finally:
        temporary.unlink(missing_ok=True)


def write_whole(path: str, text: str) -> None:
    """Write a text to a file, all of it or nothing."""
    with whole(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
