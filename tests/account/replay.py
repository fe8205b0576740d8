"""A replay through the command, and whether its account is what was done to the samples."""

from __future__ import annotations

import io
import json
import time
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, NamedTuple

from bondgraph.cli.main import main
from bondgraph.runtime.monitoring.residual_states import STATES
from tests.account.disturbed import RATE, Expected, Replay
from tests.measured import ROOT

MOTOR = str(ROOT / "models" / "dc_motor.bg")


class Outcome(NamedTuple):
    """What was said, what was expected, what is wrong, and how many s it took to watch."""

    said: list[dict[str, Any]]
    expected: Expected
    wrong: list[str]
    seconds: float


def tuned(folder: Path) -> Path:
    """Limits, so that no residual is blind for its noise."""
    log, found = folder / "healthy.csv", folder / "tuning.json"
    lines = Replay(1, 99)
    rows = [lines._row(k) for k in range(60 * RATE)]
    log.write_text("t,U,load,current,speed\n" + "".join(rows))
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        assert main(["tune", MOTOR, str(log), "-o", str(found), "--bandwidth", "20"]) == 0
    return found


def replayed(folder: Path, tuning: Path, minutes: int, seed: int) -> Outcome:
    """Write a disturbed log, watch it, and compare."""
    replay, path = Replay(minutes, seed), folder / f"{seed}.csv"
    with path.open("w", encoding="utf-8") as file:
        file.writelines(replay.lines())
    out, start = io.StringIO(), time.monotonic()
    with redirect_stdout(out), redirect_stderr(io.StringIO()):
        status = main(["monitor", MOTOR, str(path), "--json", "--tuning", str(tuning)])
    seconds = time.monotonic() - start
    path.unlink()
    said = [json.loads(line) for line in out.getvalue().splitlines()]
    wrong = [f"exit status {status}"] if status else []
    return Outcome(said, replay.expected, wrong + differences(said, replay.expected), seconds)


def differences(said: list[dict[str, Any]], expected: Expected) -> list[str]:
    """Where the account is not what was done."""
    account = said[-1]["account"]
    samples, lines = account["samples"], account["lines"]
    wrong = []
    read = sum(expected.samples.values())
    for name, found in samples.items():
        wanted = read if name == "read" else expected.samples[name]
        if found != wanted:
            wrong.append(f"samples {name}: {found}, {wanted} were made so")
    for name, found in lines.items():
        if found != expected.lines[name]:
            wrong.append(f"lines {name}: {found}, {expected.lines[name]} were made so")
    if samples["read"] != sum(samples.values()) - samples["read"]:
        wrong.append(f"samples do not add up: {samples}")
    for name, states in account["residuals"].items():
        if set(states) != set(STATES) or sum(states.values()) != expected.grid:
            wrong.append(f"{name}: {states} of {expected.grid} samples on the grid")
        if states["blind"] != expected.blind[name]:
            wrong.append(f"{name} blind for {states['blind']} samples, not {expected.blind[name]}")
    events = [v["event"] for v in said]
    counted = {event: events.count(event) for event in events}
    if counted != account["verdicts"]:
        wrong.append(f"verdicts {account['verdicts']}, said were {counted}")
    faults = [v["message"] for v in said if v["event"] == "fault"]
    wrong += [f"a false alarm: {text}" for text in faults]
    return wrong
