"""What Prometheus is told: in its text format, with the states and the account of the watch."""

from __future__ import annotations

import re
import socket
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest

from bondgraph.cli.main import main
from bondgraph.runtime.monitoring.metrics import MetricsServer, exposition
from bondgraph.runtime.monitoring.residual_states import STATES
from bondgraph.runtime.monitoring.snapshot import Snapshot
from bondgraph.text.diagnostic import Trouble
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, Watch, csv, until

_NAME = "[a-zA-Z_:][a-zA-Z0-9_:]*"
_LABEL = r'([a-zA-Z_][a-zA-Z0-9_]*)="((?:[^"\\\n]|\\[\\n"])*)"'
_SAMPLE = re.compile(rf"({_NAME})(?:\{{((?:{_LABEL},?)*)\}})? (\S+)")
_UNITS = ("seconds", "total", "info", "state", "latched")


class Metrics(NamedTuple):
    """Values by name and labels, types by name."""

    values: dict[tuple[str, frozenset[tuple[str, str]]], float]
    types: dict[str, str]

    def of(self, name: str, **labels: str) -> float:
        return self.values[f"bondgraph_{name}", frozenset(labels.items())]


def read(text: str) -> Metrics:
    """What a text says, by the rules of the format and those of `promtool check metrics`."""
    values: dict[tuple[str, frozenset[tuple[str, str]]], float] = {}
    types: dict[str, str] = {}
    helped: list[str] = []
    assert text.endswith("\n")
    for line in text.splitlines():
        if found := re.fullmatch(rf"# HELP ({_NAME}) (\S.*)", line):
            assert found[1] not in helped, f"help twice: {line}"
            helped.append(found[1])
        elif found := re.fullmatch(rf"# TYPE ({_NAME}) (counter|gauge)", line):
            assert helped[-1:] == [found[1]] and found[1] not in types, line
            types[found[1]] = found[2]
            assert (found[2] == "counter") is found[1].endswith("_total"), line
            assert found[1].rpartition("_")[2] in _UNITS, line
        else:
            found = _SAMPLE.fullmatch(line)
            assert found is not None, f"no sample: {line}"
            assert [*types][-1:] == [found[1]], f"not with its kind: {line}"
            labels = [(n, re.sub(r"\\(.)", lambda m: {"n": "\n"}.get(m[1], m[1]), t))
                      for n, t in re.findall(_LABEL, found[2] or "")]  # fmt: skip
            key = found[1], frozenset(labels)
            assert len(dict(labels)) == len(labels) and key not in values, f"twice: {line}"
            values[key] = float(found[5])
    assert set(helped) == set(types)
    return Metrics(values, types)


def _account(**samples: int) -> dict[str, object]:
    names = ("read", "used", "late", "twice", "empty", "untimed", "off", "unmatched")
    return {
        "samples": dict.fromkeys(names, 0) | samples,
        "lines": dict.fromkeys(("garbage", "overflow", "gaps", "lost"), 0),
        "residuals": {"r1": dict.fromkeys(STATES, 7)},
        "verdicts": {"start": 1},
    }


def test_names_of_files_are_escaped() -> None:
    source = 'C:\\logs\n"my" {log},x="y" é'
    states = {"r1": ("blind", 'why "so"')}
    one = Snapshot("Motor", source, 1.5, 10.0, states, True, _account(read=9, used=9))
    text = exposition(one, 12.5, 12.0)
    found = read(text)
    assert found.of("monitor_info", watch="Motor", source=source) == 1.0
    assert found.of("last_sample_age_seconds") == 2.5 and found.of("fault_latched") == 1.0
    assert found.of("monitor_turn_age_seconds") == 0.5
    assert found.of("residual_state", residual="r1", state="blind") == 1.0
    assert sum(found.of("residual_state", residual="r1", state=s) for s in STATES) == 1.0
    with pytest.raises(AssertionError):
        read(text.replace('\\"my\\"', '"my"'))


def test_before_the_first_sample_there_is_no_age() -> None:
    one = Snapshot("Motor", "-", 0.0, None, {"r1": ("warming up", "")}, False, _account())
    assert "last_sample_age" not in exposition(one, 12.5, 12.0)
    assert read(exposition(one, 12.5, 12.0))


def _page(url: str) -> Metrics:
    with urllib.request.urlopen(url, timeout=5.0) as answer:
        assert answer.headers["Content-Type"].startswith("text/plain; version=0.0.4")
        return read(answer.read().decode())


def test_a_watch_tells_its_states_while_it_runs(watch: Callable[..., Watch]) -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    url = f"http://127.0.0.1:{port}/metrics"
    one = watch("-", "--silence", "0.5", "--metrics", str(port))
    one.heard("start")
    log = motor.log()
    one.feed(csv(log, 0, 2800, header=True) + csv(log, 2790, 2800) + b"garbage\n")
    until(lambda: _page(url).of("samples_read_total") == 2810)
    found = _page(url)
    assert found.of("samples_dropped_total", cause="late") == 9
    assert found.of("samples_dropped_total", cause="twice") == 1
    assert found.of("samples_used_total") == 2800
    assert found.of("lines_dropped_total", cause="garbage") == 1
    until(lambda: _page(url).of("residual_state", residual="r2", state="blind") == 1.0)
    assert _page(url).of("last_sample_age_seconds") > 0.4
    one.feed(csv(log, 2800, 6000))
    until(lambda: _page(url).of("fault_latched") == 1.0)
    until(lambda: _page(url).of("samples_read_total") == 6010)
    assert _page(url).of("residual_state", residual="r2", state="alarm") == 1.0
    found = _page(url)
    counted = {s: found.of("residual_samples_total", residual="r1", state=s) for s in STATES}
    assert 5900 < sum(counted.values()) <= 6000
    assert found.of("verdicts_total", event="fault") == 1.0
    with pytest.raises(urllib.error.HTTPError, match="404"):
        urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5.0)
    assert one.ended() == 0
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(url, timeout=5.0)


def test_a_port_that_is_taken_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(csv(motor.log(), 0, 500, header=True))
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert main(["monitor", MOTOR, str(path), "--metrics", str(port)]) == 1
        error = capsys.readouterr().err
        assert f"127.0.0.1:{port}" in error and "--metrics" in error and "Traceback" not in error
        with pytest.raises(Trouble):
            MetricsServer("127.0.0.1", port)


@pytest.mark.parametrize("text", ["x", "70000", "127.0.0.1:", "host"])
def test_what_is_no_port_is_wrong_usage(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(["monitor", MOTOR, "-", "--metrics", text])
    assert left.value.code == 2
    assert "--metrics" in capsys.readouterr().err
