"""The journal: whatever moment the monitor is killed at, what was said is known."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from bondgraph.runtime.monitoring.journal import Journal, JournalError, known_rate
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict

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
        whole = sum(cut >= end for end in ends)
        count = 0 if again.past is None else len(again.past.verdicts)
        assert count == max(0, whole - 1)
        again.write({"time": 9.0}, {}, [(3, _FAULT)])
        again.close()
        lines = path.read_text("utf-8").splitlines()
        assert all(json.loads(line) for line in lines)
        last = opened(path)
        assert last.past is not None and last.past.position == {"time": 9.0}
        assert len(last.past.verdicts) == count + 1
        last.close()


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
    with pytest.raises(JournalError, match=r"another model.*move this one away"):
        opened(path, digest="other")
    assert path.read_bytes() == before


@pytest.mark.parametrize("text", ["hello\n", "hello", "{}\n", '{"a": 1}\n{"b"', "[]\n\n\n"])
def test_other_files_are_refused_and_left_alone(text: str, tmp_path: Path) -> None:
    path = tmp_path / "j"
    path.write_text(text)
    with pytest.raises(JournalError, match="not a journal"):
        opened(path)
    assert path.read_text() == text


def test_damage_in_the_middle_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "j"
    journal = opened(path)
    journal.write({"time": 1.0}, {}, [(1, _FAULT)])
    journal.close()
    lines = path.read_text().splitlines()
    path.write_text("\n".join([lines[0], "\0\0\0", lines[1], ""]))
    with pytest.raises(JournalError, match="damaged"):
        opened(path)
    path.write_text("\n".join([lines[0], '{"verdicts": [3]}', lines[1], ""]))
    with pytest.raises(JournalError, match="none of a journal"):
        opened(path)


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
