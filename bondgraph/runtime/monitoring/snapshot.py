"""How a watch stands at a moment: for heartbeats, metrics and the topic of the monitor itself."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from bondgraph.text.numerals import plural
from bondgraph.text.tuples import NamedTuple


class Snapshot(NamedTuple):
    """What is known at a moment.

    `time` is that of the newest sample in s, which came at `heard` on the monotonic clock of this
    computer (None before the first one); `residuals` has the state of each by name, and why where
    that is no matter of course. `fault` says whether one is latched. `account` as of `Account`.
    """

    model: str
    source: str
    time: float
    heard: float | None
    residuals: Mapping[str, tuple[str, str]]
    fault: bool
    account: Mapping[str, Any]

    def age(self, now: float) -> float | None:
        """For how many s the newest sample has been here, None before the first one."""
        return None if self.heard is None else max(0.0, now - self.heard)

    def words(self, now: float) -> str:
        """One line for people.

        >>> r = {"r1": ("healthy", ""), "r2": ("blind", "speed has no number")}
        >>> one = Snapshot("Motor", "-", 5.0, 10.0, r, False, {"samples": {"read": 5001}})
        >>> one.words(10.25)
        '5001 samples, the newest 0.2 s ago; r1 healthy; r2 blind: speed has no number'
        """
        age = self.age(now)
        newest = "none has come yet" if age is None else f"the newest {age:.1f} s ago"
        alike: dict[tuple[str, str], list[str]] = {}
        for name, state in self.residuals.items():
            alike.setdefault(state, []).append(name)
        parts = [plural(self.account["samples"]["read"], "sample") + f", {newest}"]
        parts += [
            f"{', '.join(names)} {state}" + (f": {why}" if why else "")
            for (state, why), names in alike.items()
        ]
        return "; ".join(parts)

    def to_record(self) -> dict[str, Any]:
        """What a line of JSON has of it: the account, whether a fault is latched, all states."""
        return {
            **self.account,
            "fault": self.fault,
            "states": {n: {"state": s, "why": why} for n, (s, why) in self.residuals.items()},
        }


def presence(state: str, message: str, snapshot: dict[str, Any] | None = None) -> str:
    """What is retained on the topic of the monitor itself: `watching`, `ended` or `gone`."""
    record = {"state": state, "message": message, "account": snapshot}
    return json.dumps(record, ensure_ascii=False, allow_nan=False)
