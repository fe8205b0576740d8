"""A few kills of each source: see `python -m tests.kills` for two hundred."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from tests.kills.campaign import episode, tuned
from tests.kills.sources import KINDS
from tests.unit.runtime.monitoring.watch import Nursery


@pytest.fixture(scope="module")
def tuning(tmp_path_factory: pytest.TempPathFactory) -> Path:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        return tuned(tmp_path_factory.mktemp("kills"))


@pytest.fixture(scope="module")
def nursery() -> Iterator[Nursery]:
    one = Nursery()
    yield one
    one.close()


@pytest.mark.parametrize("kind", KINDS)
def test_a_few_kills_lose_nothing(
    kind: str, tmp_path: Path, tuning: Path, nursery: Nursery
) -> None:
    found = episode(kind, tmp_path, tuning, nursery, Random(kind), kills=2)
    assert found.wrong == ()
    assert found.kills == 2 and found.verdicts >= 6
