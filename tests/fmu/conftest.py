"""The FMUs of the models, made once for all tests."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.fmu.instances import Folder


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Folder]:
    """The FMUs of a model, by its name or its text."""
    found: dict[str, Folder] = {}

    def of(model: str) -> Folder:
        if model not in found:
            found[model] = Folder(tmp_path_factory.mktemp("fmus"), model)
        return found[model]

    return of
