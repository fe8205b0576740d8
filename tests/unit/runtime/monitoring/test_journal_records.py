"""The records of a journal out of its bytes, whatever has happened to these."""

from __future__ import annotations

import json
from typing import Any

import pytest

from bondgraph.runtime.monitoring.journal_records import _checked, read_records
from bondgraph.runtime.monitoring.verdict import Verdict, to_json
from bondgraph.text.checked_line import checked_line

_SAID = Verdict("start", 1.5, message="the residuals warm up")


def _line(n: int, **more: Any) -> bytes:
    """A record as it is written, without its line feed."""
    return checked_line({"n": n, **more}).rstrip(b"\n")


def _verdicts(n: int, *numbers: int) -> bytes:
    said = [json.loads(to_json(_SAID, number)) for number in numbers]
    return _line(n, at=2.0, verdicts=said)


def test_sound_records_are_read_in_their_order() -> None:
    lines = [_line(1, journal=1, digest="x"), _verdicts(2, 7, 8), _line(3, sent=8)]
    data = b"\n".join(lines) + b"\n"
    found = read_records(data)
    assert [r["n"] for r in found.records] == [1, 2, 3] and found.last == 3
    assert found.verdicts == ((7, _SAID), (8, _SAID))
    assert found.damage == () and found.end == len(data) and found.doubtful == 0
    assert read_records(b"") == ((), (), (), 0, 0, 0)


def test_a_line_that_is_no_record_is_told_with_its_place() -> None:
    first, last = _line(1), _line(3)
    data = b"\n".join([first, b"garbage", last]) + b"\n"
    found = read_records(data)
    assert [r["n"] for r in found.records] == [1, 3] and found.last == 3
    (damage,) = found.damage  # the number that is missing is that of the damaged line
    assert (damage.line, damage.byte, damage.size) == (2, len(first) + 1, len(b"garbage\n"))
    assert found.doubtful == len(b"garbage\n")  # no verdict comes behind it


def test_what_is_damaged_before_a_sound_verdict_is_not_in_doubt() -> None:
    lines = [_line(1), b"garbage", _verdicts(3, 7), b"more", b"and more", _line(6)]
    found = read_records(b"\n".join(lines) + b"\n")
    assert [d.line for d in found.damage] == [2, 4, 5]
    assert found.doubtful == len(b"more\nand more\n")
    assert [r["n"] for r in found.records] == [1, 3, 6]


def test_records_that_are_missing_or_there_twice_are_told() -> None:
    lines = [_line(1), _line(4), _line(4), _line(3), _line(5)]
    found = read_records(b"\n".join(lines) + b"\n")
    assert [(d.line, d.size > 0, d.why) for d in found.damage] == [
        (2, False, "2 records before it are missing"),
        (3, True, "record 4 is there again"),
        (4, True, "record 3 is there again"),
    ]
    assert [r["n"] for r in found.records] == [1, 4, 5] and found.last == 5


def test_a_line_that_was_not_finished_is_none_unless_it_is_sound() -> None:
    start = _line(1) + b"\n"
    whole = _line(2)
    for tail in (whole[:-3], b"gar"):
        found = read_records(start + tail)
        assert [r["n"] for r in found.records] == [1] and found.end == len(start)
        assert found.damage == () and found.doubtful == 0
    for tail in (whole, whole + b"x"):  # a byte may stand where the line feed was
        found = read_records(start + tail)
        assert [r["n"] for r in found.records] == [1, 2] and found.end == len(start + tail)
        assert [(d.line, d.byte, d.size, d.why) for d in found.damage] == [
            (2, len(start), 0, "its line feed is missing")
        ]
    # in the middle such a byte is damage
    found = read_records(start + whole + b"x\n" + _line(3) + b"\n")
    assert [r["n"] for r in found.records] == [1, 3] and [d.line for d in found.damage] == [2]


@pytest.mark.parametrize(
    ("record", "why"),
    [
        ({"n": 1, "at": "soon"}, "`at` is none"),
        ({"n": 1, "sent": True}, "`sent` is none"),
        ({"n": 1, "sent": 1.5}, "`sent` is none"),
        ({"n": 1, "verdicts": {}}, "`verdicts` is none"),
        ({"n": 1, "other": "x"}, "`other` is none"),
        ({"n": 0}, "no record"),
        ({}, "no record"),
        ({"n": 1, "at": 1.0, "position": {}}, "no record"),
        ({"n": 1, "at": 1.0, "state": {}}, "no record"),
        ({"n": 1, "position": {}, "state": {}}, "when it was written"),
        ({"n": 1, "verdicts": []}, "when it was written"),
        ({"n": 1, "at": 1, "state": {}, "position": {"time": "x"}}, "its position"),
        ({"n": 1, "at": 1, "state": {}, "position": {"samples": None}}, "its position"),
        ({"n": 1, "at": 1, "verdicts": [3]}, "none"),
        ({"n": 1, "at": 1, "verdicts": [{}]}, "none"),
        ({"n": 1, "at": 1, "verdicts": [json.loads(to_json(_SAID, 1)) | {"more": 1}]}, "none"),
    ],
)
def test_what_a_journal_does_not_write_is_no_record(record: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        _checked(record)


def test_what_a_journal_writes_is_a_record() -> None:
    for record in (
        {"n": 1}, {"n": 1, "at": 2, "journal": 1, "rate": 50.0, "model": "m"},
        {"n": 9, "at": 1.0, "position": {"time": 3.5, "samples": 7}, "state": {"a": []}},
        {"n": 1, "unheard": 5},  # a whole number of a later version
    ):  # fmt: skip
        assert _checked(record) == []
    said = {"n": 1, "at": 1, "verdicts": [json.loads(to_json(_SAID, 4))]}
    assert _checked(said) == [(4, _SAID)]
