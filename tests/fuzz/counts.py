"""What one process of the fuzzer counts, where it is still there when the process is not."""

from __future__ import annotations

import mmap
import struct
from pathlib import Path


class Counts:
    """In a file that outlives the process: texts, those that nothing was wrong with, the longest
    time of one (s), the memory that was added at most (MB)."""

    _FORM = struct.Struct("=qqdd")

    def __init__(self, path: Path) -> None:
        self.path = path
        if not path.exists():
            path.write_bytes(self._FORM.pack(0, 0, 0.0, 0.0))
        with path.open("r+b") as file:
            self._map = mmap.mmap(file.fileno(), self._FORM.size)

    def read(self) -> tuple[int, int, float, float]:
        """What was counted so far."""
        return self._FORM.unpack_from(self._map)

    def add(self, sound: bool, seconds: float, memory: float) -> None:
        """One more text."""
        texts, good, slowest, most = self.read()
        now = texts + 1, good + sound, max(slowest, seconds), max(most, memory)
        self._FORM.pack_into(self._map, 0, *now)
