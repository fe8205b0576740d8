"""The table of a watch: a row a sample, and nothing of it where the watch does not end."""

from __future__ import annotations

import csv
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.log import Array, LogError
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.residual_states import ResidualStates
from bondgraph.runtime.monitoring.states import States, states_file
from bondgraph.runtime.monitoring.verdict import Verdict

_NAMES = ("r1", "r2")


def _batch(count: int, valid: int, known: int) -> Batch:
    """Residuals 0, 1, 2, ... that are valid from one sample on and have thresholds from another."""
    value = np.tile(np.arange(count, dtype=float)[:, None], (1, 2))
    at = np.arange(count)[:, None]
    bound = np.where(np.tile(at, (1, 2)) >= known, 5.0, np.nan)
    return Batch(value, np.tile(at >= valid, (1, 2)), bound)


class _Told:
    """Two residuals of one signal that is always there."""

    def __init__(self) -> None:
        engine = SimpleNamespace(
            residuals=_NAMES,
            signals=[SimpleNamespace(path="u")],
            reads=np.ones((2, 1), dtype=bool),
            warm_up=1.0,
            sample_time=0.1,
        )
        self.states = ResidualStates(engine)  # type: ignore[arg-type]

    def add(self, table: States, time: Array, batch: Batch, said: list[Verdict]) -> None:
        told, changes = self.states.add(time, np.zeros((len(time), 1)), batch, said)
        assert changes == []
        table.add(time, batch, told)


def _rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_states_follow_each_other_sample_by_sample(tmp_path: Path) -> None:
    path = tmp_path / "states.csv"
    time = np.arange(10) / 10
    with states_file(str(path), _NAMES) as states:
        now = _Told()
        fault = Verdict("fault", 0.6, 0.5, {"r2": 1.2})
        now.add(states, time, _batch(10, 2, 4), [fault, Verdict("gap", 0.6)])
        named = Verdict("update", 1.2, 0.5, {"r2": 1.2, "r1": 1.1}, ("a", "b"))
        now.add(states, time + 1.0, _batch(10, 0, 0), [named, Verdict("cleared", 1.7)])
        assert not path.exists()
    rows = _rows(path)
    assert [r["state"] for r in rows] == [
        *["warming up"] * 2, *["blind"] * 2, *["healthy"] * 2, *["alarm"] * 11, *["healthy"] * 3
    ]  # fmt: skip
    assert [r["active"] for r in rows] == ["0"] * 6 + ["1"] * 11 + ["0"] * 3
    # above its threshold of 5 while r2 is in alarm, and from when it is told itself
    assert [r["r1"] for r in rows[4:12]] == ["4.0", "5.0", "6.0", "7.0", "8.0", "9.0", "0.0", "1.0"]
    assert [r["r1_state"] for r in rows[4:]] == [
        *["healthy"] * 2, *["alarm"] * 4, *["healthy"] * 2, *["alarm"] * 5, *["healthy"] * 3
    ]  # fmt: skip
    assert [r["class"] for r in rows] == [""] * 12 + ["a or b"] * 5 + [""] * 3
    assert rows[1]["r1"] == "" and rows[3]["r1"] == "3.0" and rows[3]["r1_threshold"] == ""
    assert rows[4]["r1_threshold"] == "5.0" and rows[4]["time"] == "0.4"


def test_nothing_is_left_of_a_watch_that_breaks(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError), states_file(str(tmp_path / "s.csv"), _NAMES) as states:
        _Told().add(states, np.zeros(1), _batch(1, 0, 0), [])
        raise RuntimeError
    with pytest.raises(LogError, match=r"\.csv or \.parquet"):
        states_file(str(tmp_path / "s.txt"), _NAMES).__enter__()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", ["csv", "parquet"])
def test_the_command_writes_what_its_verdicts_say(kind: str, tmp_path: Path) -> None:
    scenario = tmp_path / "brush.toml"
    scenario.write_text(
        """duration = "8 s"
        [inputs]
        U = "12*(1 + 0.2*sin(2*pi*t))"
        [sensors.speed]
        noise = "0.1 rad/s"
        [sensors.current]
        noise = "1 mA"
        [[fault]]
        of = "R"
        change = "*= 1.5"
        at = "4 s"
        until = "5 s"
        """
    )
    log, states = tmp_path / "log.csv", tmp_path / f"states.{kind}"
    model = "models/dc_motor.bg"
    assert main(["simulate", model, str(scenario), "-o", str(log)]) == 0
    assert main(["monitor", model, str(log), "--states", str(states)]) == 0
    if kind == "csv":
        rows = _rows(states)
    else:
        parquet = pytest.importorskip("pyarrow.parquet")
        rows = [{n: str(x) for n, x in r.items()} for r in parquet.read_table(states).to_pylist()]
    assert len(rows) == 8001  # the thousand samples of each of eight seconds, and the last one
    active = [float(r["time"]) for r in rows if r["active"] == "1"]
    assert 4.0 < active[0] < 4.2 and 5.0 < active[-1] < 7.5
    assert all(abs(float(r["r1"])) <= float(r["r1_threshold"]) * 1.0001
               for r in rows if r["state"] == "healthy" and float(r["time"]) < 4.0)  # fmt: skip
    assert {r["r2_state"] for r in rows if float(r["time"]) > 3.0} == {"healthy"}
