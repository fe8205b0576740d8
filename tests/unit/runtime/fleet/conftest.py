"""Logs of a fleet of motors, a command to watch them, and what a single watch says of each."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.log import Log
from bondgraph.runtime.log_file import write_log
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR


def every_second(log: Log) -> Log:
    """The same at half the rate."""
    columns = {name: column[::2] for name, column in log.columns.items()}
    return log._replace(time=log.time[::2], columns=columns)


@pytest.fixture(scope="session")
def motors(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two healthy motors, one at half the rate of all others, and two with a friction fault."""
    folder = tmp_path_factory.mktemp("motors")
    healthy, friction = motor.log(3.0, 1.0), motor.log(4.5)
    write_log(healthy, folder / "a_healthy.csv")
    write_log(friction, folder / "b_friction.csv")
    (folder / "more").mkdir()
    write_log(every_second(healthy), folder / "more" / "c_healthy.parquet")
    write_log(friction, folder / "more" / "d_friction.parquet")
    return folder


@pytest.fixture
def logs(motors: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of them, `logs` in the working folder."""
    monkeypatch.chdir(tmp_path)
    return Path(shutil.copytree(motors, "logs"))


@pytest.fixture
def bad_logs(logs: Path) -> Path:
    """The same with six that cannot be watched, and one that is damaged in the middle."""
    text = (logs / "a_healthy.csv").read_text()
    rows = text.splitlines(keepends=True)
    (logs / "damaged.csv").write_text("".join([*rows[:1800], "\x00%!\n@@@@\n", *rows[1900:]]))
    (logs / "empty.csv").write_text("")
    (logs / "header.csv").write_text("t,U,load,current,speed\n")
    (logs / "columns.csv").write_text("t,U,amps\n" + "".join(f"0.{k},1,1\n" for k in range(9)))
    (logs / "cut.parquet").write_bytes((logs / "more/c_healthy.parquet").read_bytes()[:20_000])
    whole = bytearray((logs / "more/d_friction.parquet").read_bytes())
    whole[4:40_000] = np.random.default_rng(1).bytes(39_996)
    (logs / "noise.parquet").write_bytes(whole)
    (logs / "gone.csv").symlink_to("nowhere.csv")
    return logs


class Outcome(NamedTuple):
    """What a command did."""

    status: int
    out: str
    err: str

    @property
    def lines(self) -> list[dict[str, Any]]:
        """The lines of JSON."""
        return [json.loads(line) for line in self.out.splitlines()]


Monitored = Callable[..., Outcome]
_SAID: dict[bytes, str] = {}  # by what is in the log
_LOG = "{log}"  # where its path is said


@pytest.fixture
def monitored(capsys: pytest.CaptureFixture[str], kept_models: None) -> Monitored:
    """Runs `bondgraph monitor dc_motor.bg ...` in this process."""

    def run(*words: object) -> Outcome:
        try:
            status = main(["monitor", MOTOR, *map(str, words)])
        except SystemExit as leaving:
            status = int(leaving.code or 0)
        return Outcome(status, *capsys.readouterr())

    return run


@pytest.fixture
def alone(monitored: Monitored) -> Callable[..., list[dict[str, Any]]]:
    """What a watch of nothing but this log says; without words it is kept for the next test."""

    def run(log: Path, *words: object) -> list[dict[str, Any]]:
        key = b"" if words else sha256(log.read_bytes()).digest()
        said = _SAID.get(key)
        if said is None:
            done = monitored(log, "--json", *words)
            assert done.status == 0, done.err
            said = done.out.replace(str(log.resolve()), _LOG)
            if key:
                _SAID[key] = said
        lines = said.replace(_LOG, str(log.resolve())).splitlines()
        return [json.loads(line) for line in lines]

    return run
