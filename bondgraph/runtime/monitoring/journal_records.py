"""The records of a journal, read out of its bytes, and what of these is damaged."""

from __future__ import annotations

import json
from typing import Any

from bondgraph.runtime.monitoring.verdict import Verdict, from_record, to_json
from bondgraph.text.checked_line import record_of
from bondgraph.text.tuples import NamedTuple

#: What a record may have besides its number, and of which type that is.
_KINDS: dict[str, type | tuple[type, ...]] = {
    "at": (int, float), "journal": int, "digest": str, "model": str, "source": str,
    "rate": (int, float), "sent": int, "verdicts": list, "position": dict, "state": dict,
}  # fmt: skip


class Damage(NamedTuple):
    """A line that is no record: its number from 1 on, where it begins, its bytes, and why."""

    line: int
    byte: int
    size: int
    why: str


class Found(NamedTuple):
    """What the bytes of a journal are.

    All sound `records` in order, and the verdicts in them with their numbers; `last` is the number
    of the last record. Bytes from `end` on are a line that was not finished. `doubtful` bytes are
    damaged behind the last sound verdict.
    """

    records: tuple[dict[str, Any], ...]
    verdicts: tuple[tuple[int, Verdict], ...]
    damage: tuple[Damage, ...]
    last: int
    end: int
    doubtful: int


def read_records(data: bytes) -> Found:
    """The records of a journal.

    A line is damaged if it is none that a journal writes, or if its number does not follow. A last
    line without a line feed is not finished, unless it is a sound record.
    """
    records: list[dict[str, Any]] = []
    verdicts: list[tuple[int, Verdict]] = []
    damage: list[Damage] = []
    count = byte = doubtful = 0
    torn = False  # the line before is damaged, so that numbers may be missing
    *lines, tail = data.split(b"\n")
    end = len(data) - len(tail)
    for line, text in enumerate([*lines, tail] if tail else lines, start=1):
        size = len(text) + 1
        try:
            record, said = _sound(text, byte == end)
            if record["n"] <= count:
                raise ValueError(f"record {record['n']} is there again")
            if record["n"] > count + 1 and not torn:
                missing = record["n"] - count - 1
                damage.append(Damage(line, byte, 0, f"{missing} records before it are missing"))
            if byte == end:
                damage.append(Damage(line, byte, 0, "its line feed is missing"))
                end = len(data)
            records.append(record)
            verdicts += said
            count, torn = record["n"], False
            doubtful = 0 if said else doubtful
        except ValueError as error:
            if byte == end:
                break
            damage.append(Damage(line, byte, size, str(error)))
            doubtful, torn = doubtful + size, True
        byte += size
    return Found(tuple(records), tuple(verdicts), tuple(damage), count, end, doubtful)


def _sound(text: bytes, last: bool) -> tuple[dict[str, Any], list[tuple[int, Verdict]]]:
    """A record with its verdicts; raises ValueError. The `last` may have a byte for a line feed."""
    try:
        record = record_of(text)
    except ValueError:
        if not last:
            raise
        record = record_of(text[:-1])
    return record, _checked(record)


def _checked(record: dict[str, Any]) -> list[tuple[int, Verdict]]:
    """The verdicts of a record of which all is what a journal writes; else raises ValueError."""
    for key, value in record.items():
        if not isinstance(value, _KINDS.get(key, int)) or isinstance(value, bool):
            raise ValueError(f"`{key}` is none that a journal writes")
    if record.get("n", 0) < 1 or ("position" in record) != ("state" in record):
        raise ValueError("it is no record of a journal")
    if ("position" in record or "verdicts" in record) and "at" not in record:
        raise ValueError("it is not told when it was written")
    position = record.get("position", {})
    if not all(isinstance(position.get(k, 0), int | float) for k in ("time", "samples")):
        raise ValueError("its position is none")
    return [_verdict(one) for one in record.get("verdicts", ())]


def _verdict(said: Any) -> tuple[int, Verdict]:
    """A verdict with its number, if what is written of it is just this."""
    try:
        number, verdict = from_record(said)
        names = [*verdict.group, *(f for pair in verdict.pairs for f in pair.faults)]
        if json.loads(to_json(verdict, number)) == said and all(type(n) is str for n in names):
            return number, verdict
    except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
        raise ValueError("it has something for a verdict that is none") from error
    raise ValueError("it has something for a verdict that is none")
