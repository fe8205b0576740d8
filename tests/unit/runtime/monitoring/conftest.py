"""Monitors and brokers that end with the test that started them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.unit.runtime.monitoring.broker import Broker
from tests.unit.runtime.monitoring.watch import Nursery, Watch


@pytest.fixture(scope="session")
def nursery() -> Iterator[Nursery]:
    """Where monitors come from."""
    one = Nursery()
    yield one
    one.close()


@pytest.fixture
def watch(nursery: Nursery) -> Iterator[Callable[..., Watch]]:
    """Starts monitors; kills those that are left."""
    started: list[Watch] = []

    def start(*words: str, environment: dict[str, str] | None = None) -> Watch:
        started.append(Watch(nursery, *words, environment=environment))
        return started[-1]

    yield start
    for one in started:
        one.kill()


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Callable[..., Broker]]:
    """Starts brokers; ends them."""
    started: list[Broker] = []

    def start(lasting: bool = False, secure: bool = False) -> Broker:
        started.append(Broker(tmp_path, lasting, secure))
        return started[-1]

    yield start
    for one in started:
        one.kill()
