"""What a monitor says: a verdict, as a line of JSON and as a line of text for people."""

from __future__ import annotations

import json
import math
from typing import Any

from bondgraph.text.moment import moment
from bondgraph.text.numerals import listed
from bondgraph.text.printable import json_text
from bondgraph.text.tuples import NamedTuple

#: What a verdict can be about, in the order of a watch.
EVENTS = (
    "start", "resumed", "warm-up", "fault", "update", "cleared", "accepted", "refused",
    "invalid", "late", "gap", "heartbeat", "stop",
)  # fmt: skip


class Candidate(NamedTuple):
    """A fault that may be the one, with the change that would explain the residuals.

    `size` is the estimated change in `unit`, None where it cannot be estimated; `probability` is
    0 to 1, and that of all candidates of a verdict together is 1. A command that is not obeyed any
    more has no size: what acts `stands` where it is, in the unit.
    """

    fault: str
    size: float | None
    unit: str
    probability: float
    stands: float | None = None


class Pair(NamedTuple):
    """Two faults that may be there at once, with their sizes; see `Candidate`."""

    faults: tuple[str, str]
    sizes: tuple[float, float]
    units: tuple[str, str]
    probability: float


class Verdict(NamedTuple):
    """One thing that a monitor says.

    `time` is the time of the stream in s at which it is said, `since` the estimated onset.
    `residuals` tells by how much of its threshold each fired residual is out (|r|/threshold).
    `group` are the faults of the class that is named, which the structure does not tell apart;
    `candidates` has the most probable one first; `message` is one sentence for people. Where no
    single fault explains the residuals, `pairs` are those that do, the most probable one first.
    A heartbeat and the last verdict have the `account` of the watch, as plain JSON.
    """

    event: str
    time: float
    since: float | None = None
    residuals: dict[str, float] = {}  # noqa: RUF012 (never changed)
    group: tuple[str, ...] = ()
    candidates: tuple[Candidate, ...] = ()
    message: str = ""
    pairs: tuple[Pair, ...] = ()
    account: dict[str, Any] | None = None


def to_json(verdict: Verdict, number: int) -> str:
    """The verdict as one line of JSON, without the line feed; keys and order never change.

    `number` counts the verdicts of a watch from 1, so that a receiver knows one that comes twice.

    >>> to_json(Verdict("stop", 12.5, message="stopped"), 7)
    '{"number": 7, "event": "stop", "time": 12.5, "since": null, "residuals": {}, "group": [], \
"candidates": [], "message": "stopped", "pairs": []}'
    """
    line = {
        "number": number,
        **verdict._asdict(),
        "time": _finite(verdict.time),
        "residuals": {name: _finite(value) for name, value in verdict.residuals.items()},
        "group": list(verdict.group),
        "candidates": [_one(c) for c in verdict.candidates],
        "pairs": [{**p._asdict(), "sizes": [_finite(x) for x in p.sizes]} for p in verdict.pairs],
    }
    if verdict.account is None:
        del line["account"]
    return json_text(line)


def _one(candidate: Candidate) -> dict[str, Any]:
    found = candidate._asdict()
    found["size"] = None if candidate.size is None else _finite(candidate.size)
    if candidate.stands is None:
        del found["stands"]
    return found


def from_json(line: str) -> tuple[int, Verdict]:
    """The number and the verdict of such a line; raises ValueError for any other text.

    >>> from_json(to_json(Verdict("stop", 12.5), 7)) == (7, Verdict("stop", 12.5))
    True
    """
    try:
        return from_record(json.loads(line))
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"not a verdict: {line[:60]}") from error


def from_record(record: dict[str, Any]) -> tuple[int, Verdict]:
    """The same from what a JSON reader made of the line."""
    since = record["since"]
    verdict = Verdict(
        str(record["event"]),
        math.nan if record["time"] is None else float(record["time"]),
        None if since is None else float(since),
        {n: math.inf if v is None else float(v) for n, v in record["residuals"].items()},
        tuple(record["group"]),
        tuple(
            Candidate(str(c["fault"]), c["size"], str(c["unit"]), float(c["probability"]),
                      c.get("stands"))
            for c in record["candidates"]
        ),
        str(record["message"]),
        tuple(
            Pair((a, b), (_number(x), _number(y)), (u, v), float(p["probability"]))
            for p in record.get("pairs", ())
            for (a, b), (x, y), (u, v) in [(p["faults"], p["sizes"], p["units"])]
        ),
        _account(record.get("account")),
    )
    return int(record["number"]), verdict


def to_text(verdict: Verdict) -> str:
    """The verdict as one line for people; a start is before any sample, and has no time.

    >>> print(to_text(Verdict("warm-up", 0.46, message="r1 and r2 are watched from now on")))
           0.460 s  warm-up  r1 and r2 are watched from now on
    """
    message = verdict.message or described(verdict)
    when = "" if verdict.event == "start" else moment(verdict.time)
    return f"{when:>14}  {verdict.event:<7}  {message}"


def _account(record: Any) -> dict[str, Any] | None:
    if record is None or isinstance(record, dict):
        return record
    raise TypeError("an account that is none")


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def described(verdict: Verdict) -> str:
    """One sentence: what is faulty, since when, by what residuals, what else it could be.

    >>> print(described(Verdict("fault", 5.2, 5.03, {"r2": 3.14}, ("J", "f"), (
    ...     Candidate("f", 2.38e-6, "N.m.s/rad", 0.8), Candidate("J", None, "kg.m^2", 0.2)))))
    J or f since 5.030 s: f (80 %, +2.38e-06 N.m.s/rad) or J (20 %); r2 at 3.1 times its threshold
    >>> print(described(Verdict("update", 5.2, 5.03, {"r2": 3.14}, ("U",), (
    ...     Candidate("U", None, "V", 1.0, stands=6.7),))))
    U since 5.030 s: U (100 %, stands at 6.7 V); r2 at 3.1 times its threshold

    What a further row has to confirm has no class yet:

    >>> print(described(Verdict("update", 5.2, 5.03, {"r2": 3.14}, (), (
    ...     Candidate("J", None, "kg.m^2", 1.0),))))
    not confirmed yet, since 5.030 s: J (100 %); r2 at 3.1 times its threshold

    What no sample tells, many rows do:

    >>> print(described(Verdict("update", 5.2, 5.03, {"r2": 0.4}, ("J",))))
    J since 5.030 s; r2 in many rows, at 0.4 times its threshold at most
    """
    if verdict.group:
        text = listed(verdict.group, "or")
    else:
        text = "not clear yet which fault," if verdict.candidates else "an unknown fault"
        text = "not confirmed yet," if len(verdict.candidates) == 1 else text
    text += _since(verdict)
    sized = any(c.size is not None or c.stands is not None for c in verdict.candidates)
    apart = len({c.probability for c in verdict.candidates}) > 1
    if apart or sized or 0 < len(verdict.candidates) != len(verdict.group):
        text += ": " + listed([_candidate(c) for c in verdict.candidates], "or", 5)
    elif len(verdict.candidates) > 1:
        text += ", equally likely"
    return text + _levels(verdict)


def described_pairs(verdict: Verdict) -> str:
    """Which two faults at once explain what no single one does.

    >>> print(described_pairs(Verdict("update", 5.2, 5.03, {"r2": 3.14}, pairs=(
    ...     Pair(("R", "load"), (2.0, -0.1), ("Ohm", "N.m"), 0.9),))))
    two at once do since 5.030 s: R with load (90 %, +2 Ohm and -0.1 N.m); r2 at 3.1 times its \
threshold
    """
    parts = []
    for pair in verdict.pairs:
        own = zip(pair.sizes, pair.units, strict=True)
        sizes = " and ".join(f"{x:+.3g} {unit}".rstrip() for x, unit in own)
        words = f"{100 * pair.probability:.0f} %, {sizes}"
        parts.append(f"{pair.faults[0]} with {pair.faults[1]} ({words})")
    return f"two at once do{_since(verdict)}: {listed(parts, 'or', 3)}{_levels(verdict)}"


def described_unexplained(verdict: Verdict) -> str:
    """That no single fault explains what is seen, and which come nearest to it.

    >>> print(described_unexplained(Verdict("update", 5.2, 5.03, {"r2": 3.14}, candidates=(
    ...     Candidate("R", 2.0, "Ohm", 0.9),))))
    no single fault explains this since 5.030 s: several at once, or one that is not modelled; \
nearest comes R (90 %, +2 Ohm); r2 at 3.1 times its threshold
    """
    text = f"no single fault explains this{_since(verdict)}"
    text += ": several at once, or one that is not modelled"
    if verdict.candidates:
        nearest = listed([_candidate(c) for c in verdict.candidates], "or", 5)
        text += f"; nearest comes {nearest}"
    return text + _levels(verdict)


def _since(verdict: Verdict) -> str:
    return "" if verdict.since is None else f" since {moment(verdict.since)}"


def _levels(verdict: Verdict) -> str:
    parts = [
        f"{n} at {_times(v)} its threshold" if v > 1.0
        else f"{n} in many rows, at {_times(v)} its threshold at most"
        for n, v in verdict.residuals.items()
    ]  # fmt: skip
    return "; " + listed(parts, "and") if parts else ""


def _candidate(candidate: Candidate) -> str:
    words = f"{100 * candidate.probability:.0f} %"
    if candidate.size is not None:
        words += f", {candidate.size:+.3g} {candidate.unit}".rstrip()
    if candidate.stands is not None:
        words += f", stands at {candidate.stands:.3g} {candidate.unit}".rstrip()
    return f"{candidate.fault} ({words})"


def _times(ratio: float) -> str:
    if math.isinf(ratio):
        return "infinitely many times"
    return f"{ratio:.2g} times" if ratio < 100.0 else f"{ratio:.0f} times"


def _finite(value: float) -> float | None:
    """The value, or None for what JSON has no number for."""
    return float(value) if math.isfinite(value) else None
