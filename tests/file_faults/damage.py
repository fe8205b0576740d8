"""Bits that flip and ends that are cut off, in a journal and in a library that is kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

from bondgraph.cache import Cache
from bondgraph.runtime.monitoring.journal import Journal, JournalError
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict

_SAID = [
    Verdict("start", 0.0, message="Motor: 2 residuals, from log.csv"),
    Verdict("warm-up", 0.5, message="r1 and r2 are watched from now on"),
    Verdict("fault", 2.0, 1.5, {"r1": 3.0}, ("R",), (Candidate("R", 1e-3, "Ohm", 1.0),), "R é"),
    Verdict("cleared", 3.0, message="all is well again"),
    Verdict("stop", 4.0, message="the samples end"),
]


def changes(data: bytes, count: int, seed: int = 1) -> Iterator[tuple[str, bytes]]:
    """Each bit of the data flipped and each end of it cut off, or `count` of these by chance."""
    flips = [("flip", bit) for bit in range(8 * len(data))]
    cuts = [("cut", size) for size in range(len(data))]
    every = flips + cuts
    for kind, at in every if count >= len(every) else Random(seed).sample(every, count):
        if kind == "cut":
            yield f"cut to {at}", data[:at]
        else:
            changed = bytearray(data)
            changed[at // 8] ^= 1 << at % 8
            yield f"bit {at}", bytes(changed)


def _opened(path: Path) -> Journal:
    return Journal(str(path), "Motor", "abc", "here", 250.0)


def journal(path: Path, count: int) -> tuple[int, list[str]]:
    """A journal that is damaged in many ways: how many, and what is neither told nor harmless.

    Harmless is a cut between two records: the file is then what it was at an earlier time, with all
    that was said till then. Of anything else it has to be told, and what is left is as it was.
    """
    kept = _opened(path)
    for k, verdict in enumerate(_SAID, start=1):
        position = {"time": verdict.time, "samples": k, "place": {"offset": k}, "back": None}
        kept.write(position, {"fired": [False, True]}, [(k, verdict)])
        kept.write({**position, "samples": k + 1}, {"fired": [False, True]})
    kept.sent(3)
    kept.close()
    data = path.read_bytes()
    ends = {0, *(k + 1 for k, byte in enumerate(data) if byte == 10)}
    said = set(enumerate(map(repr, _SAID), start=1))
    tried, wrong = 0, []
    for what, changed in changes(data, count):
        tried += 1
        for other in path.parent.iterdir():
            other.unlink()
        path.write_bytes(changed)
        try:
            again = _opened(path)
        except JournalError as error:
            if str(path) not in str(error) or path.read_bytes() != changed:
                wrong.append(f"{what}: refused, but {error}")
            continue
        again.close()
        past = again.past
        told = past is not None and past.damage != ""
        cut = what.startswith("cut")
        harmless = cut and (len(changed) in ends or len(changed) < min(ends - {0}))
        found = {(n, repr(v)) for n, v in past.verdicts} if past is not None else set()
        if not told and not harmless:
            wrong.append(f"{what}: not told")
        if not found <= said:
            wrong.append(f"{what}: verdicts that were not said: {found - said}")
        if past is not None and not cut and past.number < len(_SAID):
            wrong.append(f"{what}: number {past.number} is given again")
        if told and not cut and (path.parent / f"{path.name}.damaged").read_bytes() != changed:
            wrong.append(f"{what}: the damaged file is not kept")
    return tried, wrong


def library(cache: Cache, data: bytes, count: int) -> tuple[int, list[str]]:
    """A file of the cache that is damaged in many ways: how many, and which are not detected."""
    path = cache.keep("name", data)
    assert path is not None and list(cache.find("name")) == [path]
    tried, wrong = 0, []
    for what, changed in changes(data, count):
        tried += 1
        path.write_bytes(changed)
        path.chmod(0o600)
        wrong += [f"{what}: {found} would be loaded" for found in cache.find("name")]
        if path.exists():
            wrong.append(f"{what}: it is left where it is")
    return tried, wrong
