"""The journal: whatever moment the monitor is killed at, what was said is known."""

from __future__ import annotations

import json
import os
import stat
import subprocess
import sys
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest

from bondgraph.runtime.monitoring.journal import Journal, JournalError, known_rate
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict, to_json

_FAULT = Verdict("fault", 2.0, 1.5, {"r1": 3.0}, ("R",), (Candidate("R", 1e-3, "Ohm", 1.0),), "R")


def opened(path: Path, digest: str = "abc", source: str = "here") -> Journal:
    return Journal(str(path), "Motor", digest, source, 250.0)


def test_what_was_written_is_known_again(tmp_path: Path) -> None:
    path = tmp_path / "j"
    journal = opened(path)
    assert journal.past is None
    journal.write({"time": 1.0}, {"fired": []}, [(1, Verdict("start", 0.0))])
    journal.write({"time": 2.0, "back": {"offset": 7}}, {"fired": ["r1"]}, [(2, _FAULT)])
    journal.sent(1)
    journal.write({"time": 3.0}, {"fired": ["r2"]})
    journal.close()
    past = opened(path).past
    assert past is not None
    assert past.verdicts == ((1, Verdict("start", 0.0)), (2, _FAULT))
    assert (past.position, past.state) == ({"time": 3.0}, {"fired": ["r2"]})
    assert (past.sent, past.source) == (1, "here")


def test_a_kill_in_any_byte_leaves_whole_lines(tmp_path: Path) -> None:
    path = tmp_path / "j"
    journal = opened(path)
    journal.write({"time": 1.0}, {}, [(1, Verdict("start", 0.0))])
    journal.write({"time": 2.0}, {}, [(2, _FAULT)])
    journal.close()
    data = path.read_bytes()
    ends = [k + 1 for k, byte in enumerate(data) if byte == 10]
    near = {end + k for end in ends for k in (-1, 0, 1)}
    for cut in sorted(near | set(range(0, len(data), 7))):
        path.write_bytes(data[:cut])
        again = opened(path)
        whole = sum(cut >= end - 1 for end in ends)  # but for a line feed
        count = 0 if again.past is None else len(again.past.verdicts)
        assert count == max(0, whole - 1)
        told = "" if again.past is None else again.past.damage
        assert bool(told) == (ends[0] < cut < len(data) and cut not in ends)
        again.write({"time": 9.0}, {}, [(3, _FAULT)])
        again.close()
        lines = path.read_text("utf-8").splitlines()
        assert all(json.loads(line) for line in lines)
        last = opened(path)
        assert last.past is not None and last.past.position == {"time": 9.0}
        assert len(last.past.verdicts) == count + 1
        last.close()


def test_bytes_behind_the_last_whole_record_are_counted(tmp_path: Path) -> None:
    path = tmp_path / "j"
    journal = opened(path)
    journal.write({"time": 1.0}, {}, [(1, Verdict("start", 0.0))])
    journal.close()
    whole = path.read_bytes()
    for rest, words in ((b"{", "1 byte "), (b'{"n": 7', "7 bytes ")):
        path.write_bytes(whole + rest)
        again = opened(path)
        again.close()
        assert again.past is not None
        assert again.past.damage == f"the last {words}of the journal are no whole record"
        assert path.read_bytes() == whole


def test_old_positions_are_cleaned_away_and_verdicts_stay(tmp_path: Path) -> None:
    path = tmp_path / "j"
    journal = opened(path)
    filling = {"x": "y" * 20_000}
    for k in range(200):
        journal.write({"time": float(k)}, filling, [(k, _FAULT)] if k % 20 == 0 else ())
    journal.sent(7)
    assert path.stat().st_size < 1_300_000 < 200 * 20_000
    with pytest.raises(JournalError, match="another monitor"):
        opened(path)  # the lock is on the new file too
    journal.close()
    past = opened(path).past
    assert past is not None
    assert [n for n, _ in past.verdicts] == list(range(0, 200, 20))
    assert past.position == {"time": 199.0} and past.sent == 7
    assert not list(tmp_path.glob("*.new"))


def test_the_rate_is_known_before_the_journal_is_opened(tmp_path: Path) -> None:
    path = tmp_path / "j"
    assert known_rate(str(path)) is None
    opened(path).close()
    assert known_rate(str(path)) == 250.0
    path.write_text("[]\n")
    assert known_rate(str(path)) is None


def test_another_model_is_refused_with_a_remedy(tmp_path: Path) -> None:
    path = tmp_path / "j"
    opened(path).close()
    before = path.read_bytes()
    with pytest.raises(JournalError, match=r"another model.*move it away"):
        opened(path, digest="other")
    assert path.read_bytes() == before


@pytest.mark.parametrize("text", ["hello\n", "hello", "{}\n", '{"a": 1}\n{"b"', "[]\n\n\n"])
def test_other_files_are_refused_and_left_alone(text: str, tmp_path: Path) -> None:
    path = tmp_path / "j"
    path.write_text(text)
    with pytest.raises(JournalError, match="not a journal"):
        opened(path)
    assert path.read_text() == text


def damaged(path: Path, change: Callable[[list[bytes]], list[bytes]]) -> bytes:
    """A journal of five verdicts, a line each after the first, whose lines are changed."""
    journal = opened(path)
    for k in range(1, 6):
        journal.write({"time": float(k)}, {"k": k}, [(k, _FAULT._replace(time=float(k)))])
    journal.close()
    path.write_bytes(b"\n".join(change(path.read_bytes().split(b"\n"))))
    return path.read_bytes()


def flipped(line: int) -> Callable[[list[bytes]], list[bytes]]:
    return lambda lines: [x.replace(b"fault", b"fauLt") if k == line else x
                          for k, x in enumerate(lines)]  # fmt: skip


def test_damage_is_told_with_its_place_and_what_it_cost(tmp_path: Path) -> None:
    path = tmp_path / "j"
    data = damaged(path, flipped(3))
    byte = len(b"\n".join(data.split(b"\n")[:3])) + 1
    journal = opened(path)
    past = journal.past
    assert past is not None
    assert f"line 4, at byte {byte}: its checksum does not match" in past.damage
    assert "lost are the verdicts 3;" in past.damage and f"{path}.damaged" in past.damage
    assert [n for n, _ in past.verdicts] == [1, 2, 4, 5] and past.number == 5
    assert past.position == {"time": 5.0} and past.state == {"k": 5}
    assert (tmp_path / "j.damaged").read_bytes() == data
    journal.close()
    again = opened(path).past  # what was sound is whole again
    assert again is not None and again.damage == ""
    assert again._replace(damage="") == past._replace(damage="")


def test_numbers_that_may_have_been_said_are_not_given_again(tmp_path: Path) -> None:
    path = tmp_path / "j"
    damaged(path, lambda lines: flipped(5)(flipped(4)(lines)))
    past = opened(path).past
    assert past is not None and [n for n, _ in past.verdicts] == [1, 2, 3]
    assert "perhaps with verdicts" in past.damage
    assert past.number >= 5 and past.position == {"time": 3.0}


def test_lines_that_are_gone_doubled_or_joined_are_damage(tmp_path: Path) -> None:
    changes: dict[str, tuple[Callable[[list[bytes]], list[bytes]], list[int]]] = {
        "1 records before it are missing": (lambda x: x[:3] + x[4:], [1, 2, 4, 5]),
        "record 3 is there again": (lambda x: [*x[:3], x[2], *x[3:]], [1, 2, 3, 4, 5]),
        "line 3, at byte": (lambda x: [*x[:2], x[2] + b" " + x[3], *x[4:]], [1, 4, 5]),
        "its line feed is missing": (lambda x: [*x[:-2], x[-2] + b"\x0b"], [1, 2, 3, 4, 5]),
    }
    for k, (word, (change, numbers)) in enumerate(changes.items()):
        path = tmp_path / f"j{k}"
        damaged(path, change)
        past = opened(path).past
        assert past is not None and word in past.damage
        assert [n for n, _ in past.verdicts] == numbers


def test_the_same_damage_is_kept_once_and_another_one_beside_it(tmp_path: Path) -> None:
    path = tmp_path / "j"
    data = damaged(path, flipped(2))
    for _ in range(2):  # killed before it was mended
        path.write_bytes(data)
        opened(path).close()
    assert {p.name for p in tmp_path.iterdir()} == {"j", "j.damaged"}
    path.write_bytes(data.replace(b"fault", b"FAULT"))
    opened(path).close()
    assert {p.name for p in tmp_path.iterdir()} == {"j", "j.damaged", "j.damaged-2"}


def test_without_its_first_record_nobody_knows_of_which_model_it_is(tmp_path: Path) -> None:
    path = tmp_path / "j"
    data = damaged(path, lambda lines: [lines[0].replace(b"Motor", b"motor"), *lines[1:]])
    with pytest.raises(JournalError, match=r"first record is damaged.*move it away"):
        opened(path)
    assert path.read_bytes() == data


def test_the_first_edition_had_no_checksums_and_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "j"
    text = '{"journal": 1, "model": "Motor", "digest": "abc", "source": "here", "rate": 250.0}\n'
    path.write_text(text)
    with pytest.raises(JournalError, match=r"edition 1\); move it away"):
        opened(path)
    assert path.read_text() == text


_DEEP = b'{"n": 2, "at": 1.0, "position": ' + b'{"a": ' * 20_000 + b"1" + b"}" * 20_001
_SAID = json.loads(to_json(_FAULT, 1))


def with_checksum(text: bytes) -> bytes:
    return text[:-1] + f', "crc": "{zlib.crc32(text):08x}"}}'.encode()


@pytest.mark.parametrize(
    "text",
    [
        _DEEP,
        b'{"n": 2, "at": 1e999, "position": {}, "state": {}}',
        b'{"n": 2, "at": Infinity, "position": {}, "state": {}}',
        b'{"n": 2, "at": "1", "position": {}, "state": {}}',
        b'{"n": 2, "at": 1, "position": {"time": "x"}, "state": {}}',
        b'{"n": 2, "at": 1, "position": 3, "state": {}}',
        b'{"n": 2, "at": 1, "position": {}}',
        b'{"n": 2, "sent": 1e3}',
        b'{"n": 2, "sent": true}',
        b'{"n": -2, "sent": 1}',
        b'{"n": 2, "verdicts": []}',
        b'{"n": 2, "unheard of": {}}',
        b'{"sent": 1}',
        *[
            json.dumps({"n": 2, "at": 1.0, "verdicts": [{**_SAID, **change}]}).encode()
            for change in (
                {"time": "2"}, {"since": {}}, {"residuals": [1]}, {"residuals": {"r1": "3"}},
                {"group": "R"}, {"group": [1]}, {"candidates": [{}]}, {"candidates": {"a": 1}},
                {"message": 3}, {"number": 1.5}, {"number": None}, {"pairs": [3]}, {"event": []},
                {"more": 1},
            )
        ],
        b'{"n": 2, "at": 1.0, "verdicts": [3]}',
    ],
    ids=lambda text: text[:60].decode(),
)  # fmt: skip
def test_a_record_that_no_journal_writes_is_damage_whatever_its_checksum(
    text: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "j"
    opened(path).close()
    begin = path.read_bytes()
    path.write_bytes(begin + with_checksum(text) + b"\n")
    past = opened(path).past
    assert past is not None and past.verdicts == ()
    assert f"line 2, at byte {len(begin)}: " in past.damage


def test_after_a_write_that_failed_nothing_more_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "j"
    journal = opened(path)
    journal.write({"time": 1.0}, {}, [(1, _FAULT)])
    before = path.read_bytes()
    real = os.write

    def full(file: int, data: bytes) -> int:
        if len(data) < 40:
            raise OSError(28, "No space left on device")
        return real(file, data[: len(data) // 2])

    with monkeypatch.context() as patched:
        patched.setattr(os, "write", full)
        with pytest.raises(JournalError, match="cannot be written: No space"):
            journal.write({"time": 2.0}, {}, [(2, _FAULT)])
    with pytest.raises(JournalError, match="cannot be written: No space"):
        journal.sent(1)  # what the file has behind its end is not known
    journal.close()
    assert path.read_bytes() == before


def test_what_cannot_be_cleaned_grows_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "j"
    journal = opened(path)

    def denied(*names: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "replace", denied)
    for k in range(80):
        journal.write({"time": float(k)}, {"x": "y" * 20_000})
    journal.close()
    assert path.stat().st_size > 80 * 20_000
    past = opened(path).past
    assert past is not None and past.damage == "" and past.position == {"time": 79.0}
    assert {p.name for p in tmp_path.iterdir()} == {"j"}


def test_a_journal_that_is_gone_when_it_is_cleaned_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "j"
    real = os.fsync

    def broken(file: int) -> None:
        if stat.S_ISDIR(os.fstat(file).st_mode):
            raise OSError(5, "Input/output error")
        real(file)

    journal = opened(path)
    journal.write({"time": 1.0}, {}, [(1, _FAULT)])
    monkeypatch.setattr(os, "fsync", broken)  # the new file has its name, perhaps not for long
    with pytest.raises(JournalError, match="replaced while"):
        for k in range(80):
            journal.write({"time": float(k)}, {"x": "y" * 20_000})
    with pytest.raises(JournalError, match="replaced while"):
        journal.write({"time": 99.0}, {})
    journal.close()
    monkeypatch.setattr(os, "fsync", real)
    past = opened(path).past
    assert past is not None and past.verdicts == ((1, _FAULT),)


def test_what_was_begun_for_another_source_is_no_obstacle(tmp_path: Path) -> None:
    path = tmp_path / "j"
    opened(path).close()
    data = path.read_bytes()
    for size in range(len(data)):
        path.write_bytes(data[:size])
        journal = opened(path, digest="other", source="there")
        assert journal.past is None
        journal.close()


def test_a_pipe_is_no_journal(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "j")
    with pytest.raises(JournalError, match="no regular file"):
        opened(tmp_path / "j")
    assert known_rate(str(tmp_path / "j")) is None


def test_a_journal_that_cannot_be_written_is_said(tmp_path: Path) -> None:
    with pytest.raises(JournalError, match="cannot be written"):
        opened(tmp_path / "no" / "j")


def test_a_killed_writer_frees_the_journal(tmp_path: Path) -> None:
    path = tmp_path / "j"
    code = (
        "import os, sys; from bondgraph.runtime.monitoring.journal import Journal;"
        "j = Journal(sys.argv[1], 'Motor', 'abc', 'there', 250.0); j.write({'time': 1.0}, {});"
        "print('open', flush=True); sys.stdin.read()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"open\n"
        with pytest.raises(JournalError, match="another monitor"):
            opened(path)
        os.kill(process.pid, 9)
        process.wait()
    journal = opened(path)
    assert journal.past is not None and journal.past.source == "there"
    journal.close()
    past = opened(path).past
    assert past is not None and past.source == "here"
