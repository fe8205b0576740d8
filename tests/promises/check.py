"""Where checks are entered, each under the stage whose promise it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

Check = Callable[[Any], Iterator[str]]

#: The checks of each stage, by the name of its type; `Analysis` is residuals and matrix together.
CHECKS: dict[str, list[Check]] = {}


def promise(stage: str) -> Callable[[Check], Check]:
    """Enter a check among those of a stage."""

    def entered(check: Check) -> Check:
        CHECKS.setdefault(stage, []).append(check)
        return check

    return entered
