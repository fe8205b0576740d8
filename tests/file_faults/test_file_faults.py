"""A sample of what `python -m tests.file_faults` does: a point of each writer, some damage."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from bondgraph.cache import Cache
from bondgraph.ir.artifact import Artifact
from bondgraph.runtime.c_library import library as compiled
from tests.file_faults import damage
from tests.file_faults.interposer import Operation, unsynced
from tests.measured import ROOT

_SEEN = '__attribute__((visibility("default")))'
_SOURCE = Artifact("seven.c", f"{_SEEN} int seven(void) {{ return 7; }}")
_HAS_COMPILER = shutil.which("cc") is not None


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="LD_PRELOAD is needed")
@pytest.mark.skipif(not _HAS_COMPILER, reason="a C compiler is needed")
def test_files_are_whole_and_the_next_run_works_whatever_happens() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tests.file_faults", "--sample", "1"],
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert " 0 wrong" in done.stdout.splitlines()[-1]


def test_a_rename_before_the_data_are_on_the_disk_is_noticed() -> None:
    wrote, synced = Operation("write", "/d/a.tmp", ""), Operation("sync", "/d/a.tmp", "")
    renamed, named = Operation("rename", "/d/a.tmp", "/d/a"), Operation("sync", "/d", "")
    assert unsynced([wrote, synced, renamed, named]) == []
    assert unsynced([wrote, renamed, named]) == [
        "/d/a.tmp is renamed to /d/a before it is on the disk"
    ]
    assert unsynced([synced, wrote, renamed, named])
    assert unsynced([wrote, synced, renamed]) == ["the name /d/a is not on the disk"]


def test_damage_to_a_journal_is_told_or_harmless(tmp_path: Path) -> None:
    tried, wrong = damage.journal(tmp_path / "journal", 1000)
    assert wrong == [] and tried == 1000


def test_damage_to_a_library_that_is_kept_is_detected(tmp_path: Path) -> None:
    tmp_path.chmod(0o700)
    cache = Cache(tmp_path, "so")
    tried, wrong = damage.library(cache, bytes(range(256)) * 64, 2000)
    assert wrong == [] and tried == 2000


@pytest.mark.skipif(not _HAS_COMPILER, reason="a C compiler is needed")
def test_a_damaged_library_is_compiled_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))

    def loaded() -> int:
        found = compiled([_SOURCE], ["seven.c"], "numbers", lambda lib: lib.seven() == 7, print)
        return int(found.seven())

    assert loaded() == 7
    (path,) = (tmp_path / "bondgraph").glob("*.so")
    data = path.read_bytes()
    for _, changed in damage.changes(data, 5):
        path.unlink()  # the one that is loaded stays as it is
        path.write_bytes(changed)
        path.chmod(0o600)
        assert loaded() == 7
        (again,) = (tmp_path / "bondgraph").glob("*.so")
        assert again.read_bytes()[:4] == b"\x7fELF" and again.stat().st_size == len(data)
