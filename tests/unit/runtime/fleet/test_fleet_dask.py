"""A fleet on Dask: the same verdicts as here."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import bondgraph
from tests.unit.runtime.fleet.conftest import Monitored
from tests.unit.runtime.monitoring.watch import MOTOR

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two workers; two threads each, which take turns."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=2, dashboard_address=None
    ) as found:
        yield found


def test_a_scheduler_watches_as_this_process_does(
    bad_logs: Path, monitored: Monitored, cluster: Any
) -> None:
    here = monitored("logs", "-o", "here.parquet")
    there = monitored("logs", "-o", "there.parquet", "--scheduler", cluster.scheduler_address)
    assert there.out == here.out.replace("here.parquet", "there.parquet")
    assert there.err == here.err and there.status == here.status == 0
    assert Path("there.parquet").read_bytes() == Path("here.parquet").read_bytes()


def test_in_python_the_default_client_watches(motors: Path, cluster: Any) -> None:
    model = bondgraph.compile(MOTOR)
    here = bondgraph.monitor(model, motors)
    before = cluster_tasks(cluster)
    with distributed.Client(cluster) as client:
        there = bondgraph.monitor(model, motors)
        assert client.run(lambda: None)
    assert list(there) == list(here)
    assert cluster_tasks(cluster) > before


def cluster_tasks(cluster: Any) -> int:
    """How many tasks the scheduler has had done."""
    return int(cluster.scheduler.transition_counter)


def test_nobody_at_the_address(logs: Path, monitored: Monitored, monkeypatch: Any) -> None:
    monkeypatch.setattr("bondgraph.runtime.fleet.workers._PATIENCE", 0.3)
    done = monitored("logs", "--scheduler", "tcp://127.0.0.1:1")
    assert done.status == 1 and "no scheduler of Dask answers at tcp://127.0.0.1:1" in done.err


def test_without_dask_it_is_said_what_to_install(
    logs: Path, monitored: Monitored, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    done = monitored("logs", "--scheduler", "tcp://127.0.0.1:1")
    assert done.status == 1 and "install bondgraph-arr[fleet]" in done.err
