"""Each writer, killed or failed at each of its operations, then run again."""

from __future__ import annotations

import contextlib
import io
import os
import shutil
import signal
import sys
import tempfile
import traceback
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import bondgraph.cli.main
from bondgraph.backends import templates
from bondgraph.runtime.monitoring import journal, sample_pipeline
from bondgraph.runtime.monitoring.journal_records import read_records
from bondgraph.runtime.monitoring.sources import file as file_source
from tests.file_faults.interposer import ENDS, Operation, Point, arm, disarm, points, unsynced
from tests.file_faults.writers import Writer, lines, plant

_SECONDS = 60  # no command may take longer
_DEAD = 137


class Done(NamedTuple):
    """How a run of a command ended, and what it printed."""

    status: int
    out: str
    err: str
    operations: list[Operation]


class Bench:
    """A folder in which commands are run, each in a process of its own, from the same beginnings.

    `root` has the working folder and the caches; what it is made anew from is beside it.
    """

    def __init__(self, root: Path) -> None:
        self.root, self.work = root, root / "work"
        self._beside = root.parent
        # More operations in a short watch: small blocks, a position each, cleaned often.
        file_source._BLOCK = 16384
        sample_pipeline._EVERY = 0.0
        journal._OLD = 4000
        self._empty()
        tempfile.gettempdir()  # tries to write there, once
        plant(self.work, self._must)
        self._save("planted")

    def begin(self, writer: Writer) -> None:
        """Make what stands there before a writer, and keep it."""
        self._restore("planted")
        writer.begin(self.work, self._must)
        self._save("begun")

    def anew(self) -> None:
        """Put what stood there before the writer back."""
        self._restore("begun")

    def run(self, words: Sequence[str], point: Point | None = None) -> Done:
        """Run a command in a process of its own, which is killed or fails at a point."""
        out, err, log = (self._beside / name for name in ("out", "err", "log"))
        child = os.fork()
        if child == 0:
            self._child(list(words), point, out, err, log)
        signal.signal(signal.SIGALRM, lambda *_: os.kill(child, signal.SIGKILL))
        signal.alarm(_SECONDS)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        signal.alarm(0)
        texts = [p.read_text(errors="replace") if p.exists() else "" for p in (out, err, log)]
        operations = [Operation(*line.split("\t")) for line in texts[2].splitlines()]
        return Done(status, texts[0], texts[1], operations)

    def warm(self, words: Sequence[str], cold: bool) -> None:
        """Run a command in this process, so that those forked from it have all in memory."""
        templates.environment.cache_clear()
        os.chdir(self.work)
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            bondgraph.cli.main.main(list(words))
        if cold:
            templates.environment.cache_clear()

    def _child(
        self, words: list[str], point: Point | None, out: Path, err: Path, log: Path
    ) -> None:
        status = 99
        try:
            os.chdir(self.work)
            for number, place in ((1, out), (2, err)):
                os.dup2(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
            log.unlink(missing_ok=True)
            arm(self.root, point)
            status = bondgraph.cli.main.main(words)
            sys.stdout.flush()
        except SystemExit as leaving:
            status = leaving.code if isinstance(leaving.code, int) else 98
        except BaseException:
            traceback.print_exc()
        finally:
            operations = disarm()
            log.write_text("".join("\t".join(one) + "\n" for one in operations))
            sys.stderr.flush()
            os._exit(status)

    def _must(self, words: list[str]) -> None:
        done = self.run(words)
        assert done.status == 0, (words, done)

    def _empty(self) -> None:
        shutil.rmtree(self.root, ignore_errors=True)
        for name in ("work", "cache", "tmp"):
            (self.root / name).mkdir(parents=True, mode=0o700)

    def _save(self, name: str) -> None:
        shutil.rmtree(self._beside / name, ignore_errors=True)
        shutil.copytree(self.root, self._beside / name)

    def _restore(self, name: str) -> None:
        shutil.rmtree(self.root, ignore_errors=True)
        shutil.copytree(self._beside / name, self.root)


class Trial:
    """One writer: what it does when nothing happens, and what is wrong when something does."""

    def __init__(self, bench: Bench, writer: Writer) -> None:
        self._bench, self._writer = bench, writer
        self._words = writer.words.split()
        bench.begin(writer)
        bench.anew()
        bench.warm(self._words, writer.cold)
        bench.anew()
        self._old = self._files()
        done = bench.run(self._words)
        assert done.status == 0, done
        self._new, self._verdicts = self._files(), _faults(lines_of(done, writer))
        self._then = (writer.then or writer.words).split()
        assert bench.run(self._then).status == 0
        self._next = self._files()
        self.operations = done.operations
        self.points = points(done.operations)
        self.wrong = unsynced(done.operations) + self._leftovers()

    def at(self, point: Point) -> list[str]:
        """What is wrong after something happened at a point, and after the next run."""
        self._bench.anew()
        first = self._bench.run(self._words, point)
        wrong = self._ended(first, point)
        wrong += self._standing(first, "then")
        wrong += self._unsaid(first)
        second = self._bench.run(self._then)
        if second.status:
            wrong.append(f"the next run ends with {second.status}: {second.err.strip()[-300:]}")
        if self._files() != self._next:
            wrong.append("the next run leaves other files")
        wrong += self._leftovers()
        return wrong + self._journal([first, second])

    def _ended(self, done: Done, point: Point) -> list[str]:
        if point.kind in ENDS:
            return [] if done.status == _DEAD else [f"ends with {done.status}, not killed"]
        wrong = []
        if done.status not in (0, 1):
            wrong.append(f"ends with {done.status}: {done.err.strip()[-300:]}")
        if "Traceback" in done.err or "this is a bug" in done.err:
            wrong.append(f"a bug is told: {done.err.strip()[-300:]}")
        if done.status == 1 and "error: " not in done.err + done.out and not done.err:
            wrong.append("ends with 1 and says nothing")
        return wrong

    def _standing(self, done: Done, when: str) -> list[str]:
        """What of the outputs is neither old nor new, or is not what was said."""
        now = self._files()
        if done.status == 0 and now != self._new and "error: " not in done.err:
            return [f"{when}: status 0, other files than the new ones, and nothing is said"]
        if done.status == 0:
            return []  # a log of a fleet could not be read
        return [
            f"{when}: {name} is neither old nor new"
            for name in self._writer.outputs
            if now.get(name) not in (self._old.get(name), self._new.get(name))
        ]

    def _files(self) -> dict[str, bytes]:
        work, writer = self._bench.work, self._writer
        names = [work / name for name in writer.outputs]
        if writer.folder:
            names += sorted((work / writer.folder).rglob("*"))
        return {
            str(p.relative_to(work)): p.read_bytes()
            for p in names
            if p.is_file() and not _is_left(p)
        }

    def _leftovers(self) -> list[str]:
        left = [p for p in self._bench.root.rglob("*") if _is_left(p)]
        return [f"left over: {p.relative_to(self._bench.root)}" for p in left]

    def _journal(self, runs: list[Done]) -> list[str]:
        """What was said and is not in the journal, or not what is said without a fault."""
        if not self._writer.journal:
            return []
        kept, wrong = self._kept()
        wrong += [line for run in runs for line in self._unsaid(run)]
        if [v["number"] for v in kept] != list(range(1, len(kept) + 1)):
            wrong.append(f"numbers are {[v['number'] for v in kept]}")
        if self._verdicts and _faults(kept)[-len(self._verdicts) :] != self._verdicts:
            wrong.append(f"faults are {_faults(kept)}, not {self._verdicts}")
        return wrong


    def _kept(self) -> tuple[list[dict[str, Any]], list[str]]:
        """The verdicts in the journal, and what is wrong with it."""
        path = self._bench.work / self._writer.journal
        found = read_records(path.read_bytes() if path.exists() else b"")
        kept = [v for r in found.records for v in r.get("verdicts", ())]
        return kept, [f"the journal is damaged: {d.why}" for d in found.damage]

    def _unsaid(self, done: Done) -> list[str]:
        """What was said and is not in the journal."""
        said = lines_of(done, self._writer)
        kept, wrong = self._kept() if said else ([], [])
        return wrong + [f"said and not in the journal: {v}" for v in said if v not in kept]


def lines_of(done: Done, writer: Writer) -> list[dict[str, Any]]:
    """The verdicts that were printed."""
    return lines(done.out) if writer.journal else []


def _faults(verdicts: Sequence[dict[str, Any]]) -> list[tuple[Any, ...]]:
    events = ("fault", "update", "cleared")
    return [(v["event"], v["time"], v["group"]) for v in verdicts if v["event"] in events]


def _is_left(path: Path) -> bool:
    """Whether a file was begun and left; where the system keeps such files, that is its affair."""
    return path.name.endswith((".tmp", ".part")) and path.parent.name != "tmp"


def campaign(
    bench: Bench,
    writers: Sequence[Writer],
    chosen: Callable[[list[Point]], list[Point]],
    tell: Callable[[str], None],
) -> tuple[list[tuple[str, int, int]], list[str]]:
    """All writers: the name, operations and points of each, and what is wrong, a line each."""
    counts, wrong = [], []
    for writer in writers:
        trial = Trial(bench, writer)
        some = chosen(trial.points)
        found = [f"{writer.name}: {line}" for line in trial.wrong]
        for point in some:
            what, path, _ = trial.operations[point.at]
            place = f"{writer.name}: {point.kind} at {what} {point.at} of {path}"
            here = [f"{place}: {line}" for line in trial.at(point)]
            for line in here:
                tell(line)
            found += here
        counts.append((writer.name, len(trial.operations), len(some)))
        tell(f"{writer.name}: {len(trial.operations)} operations, {len(some)} points,"
             f" {len(found)} wrong")  # fmt: skip
        wrong += found
    return counts, wrong
