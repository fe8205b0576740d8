"""Monitors and brokers that end with the test that started them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.unit.runtime.monitoring.broker import Broker
from tests.unit.runtime.monitoring.watch import Watch


@pytest.fixture
def watch() -> Iterator[Callable[..., Watch]]:
    """Starts monitors; kills those that are left."""
    started: list[Watch] = []

    def start(*words: str, **more: object) -> Watch:
        started.append(Watch(*words, **more))
        return started[-1]

    yield start
    for one in started:
        if one.process.poll() is None:
            one.kill()
        else:
            one.ended()


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Callable[[bool], Broker]]:
    """Starts brokers; ends them."""
    started: list[Broker] = []

    def start(lasting: bool) -> Broker:
        started.append(Broker(tmp_path, lasting))
        return started[-1]

    yield start
    for one in started:
        one.kill()
