"""What a healthy machine taught: the noise of each residual and the limits that follow from it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from bondgraph.ir.residual_limit import ShownSize
from bondgraph.ir.residuals import Form
from bondgraph.text.foreign_data import WrongData, json_data
from bondgraph.text.limits import RATE
from bondgraph.text.tuples import NamedTuple

EDITION = 1
_MOST = 1e100  # of any number: its square is one, too
#: What each number of a limit is at least.
_LEAST = {"sigma": 1 / _MOST, "crossings": 0.0, "kappa": 0.0, "height": 0.0, "mean": -_MOST,
          "memory": 1 / _MOST, "unit": 0.0, "stands": -_MOST, "before1": 0.0, "before2": 0.0,
          "before3": 0.0, "before4": 0.0, "walk": 0.0,
          "held": 0.0, "apart": 0.0, "step": 0.0, "most": 0.0,
          "goes": 0.0, "along": 0.0}  # fmt: skip
_SLOWER = (50, 30, 20, 12, 8, 5, 4)  # times slower than the samples that a filter may be, rad
UNKNOWN = 2.0  #: deviations of what is not known yet of a healthy machine, for which there is room
FASTEST = 0.4  #: of the rate, rad: no filter has fewer samples to work with
_LONGEST = 1200.0  # s of a log, or samples, that a tuned filter is chosen for: alarms end rows late
#: Time constants after which a filter of second order has forgotten all but a thousandth, and the
#: share of the samples of a log in pieces that comes behind that at least.
_SETTLES, _SETTLED = 9.2, 0.5
_ENOUGH = 75  # rows, of three time constants, that a log should have


class Limit(NamedTuple):
    """Of one residual, in its own unit: noise `sigma` about its `mean`, and how often a second it
    crosses that upwards (`crossings`).

    It fires where max(0, |r - mean| - a) is above `kappa` sigma, or where a sum of rows is above
    `height` (see `Cusum`). Sums count in deviations of
    noise that adds up: the variance of a sum of n rows is n sigma^2 times their `memory`.
    Averages of rows `stands` above the mean; each with so much of those before it as `before1` and
    so on say adds up with the deviation `unit` (see `Lasting`), zero where that is not known. What
    adds up readings for ever walks away, in a row by the deviation `walk`. What half a sample of
    the commands makes (see `Doubt`) was `held` at most in the logs that the noise is from. These
    stand `apart` by such a deviation (see `Levels`): noise is beside where each stands. That moves
    in a row by the deviation `step`, by `most` if it surely does (see `Wander`), and surely `goes`
    so far in a log at most: room for that has who does not follow it. A sum along what a fault does
    is a fault above `along` (see `ScoreSums`), zero where that is not known.
    """

    sigma: float
    crossings: float
    kappa: float
    height: float
    mean: float = 0.0
    memory: float = 1.0
    unit: float = 0.0
    stands: float = 0.0
    before1: float = 0.0
    before2: float = 0.0
    before3: float = 0.0
    before4: float = 0.0
    walk: float = 0.0
    held: float = 0.0
    apart: float = 0.0
    step: float = 0.0
    most: float = 0.0
    goes: float = 0.0
    along: float = 0.0


class Tuning(NamedTuple):
    """Limits by residual for a filter of `bandwidth` (rad/s) at `rate` samples a second.

    `false_alarms` are those wanted per hour, of all residuals and tests together; `model` is
    the digest of the residuals that it belongs to, `seconds` how much healthy data it is from.
    `bounds` are the largest adaptive thresholds a in that data, by residual. `shows` says by
    residual and fault from which size on it shows within a `window` of seconds. The residuals are
    those of the options `isolate` and `form`: who uses the tuning compiles the model with these.

    >>> limits = {"r1": Limit(sigma=0.2, crossings=10.0, kappa=4.7, height=9.3)}
    >>> tuning = Tuning("7888fd5a1d32470a", 1000.0, 20.0, 1.0, 60.0, limits)
    >>> Tuning.from_json(tuning.to_json()) == tuning
    True
    """

    model: str
    rate: float
    bandwidth: float
    false_alarms: float
    seconds: float
    limits: Mapping[str, Limit]
    bounds: Mapping[str, float] = MappingProxyType({})
    shows: Mapping[str, Mapping[str, ShownSize]] = MappingProxyType({})
    window: float = 0.0
    isolate: bool = False
    form: Form = "derivative"

    def residuals(self, isolate: bool, form: Form) -> tuple[bool, Form]:
        """The options of its residuals, beside those that are asked for: these are not dropped.

        >>> Tuning("", 1.0, 1.0, 1.0, 1.0, {}, isolate=True).residuals(False, "observer")
        (True, 'observer')
        """
        return isolate or self.isolate, self.form if form == "derivative" else form

    def to_json(self) -> str:
        """A text for people and programs, as `bondgraph tune` writes it."""
        record = {
            "bondgraph tuning": EDITION,
            **self._asdict(),
            "limits": {name: limit._asdict() for name, limit in self.limits.items()},
            "bounds": dict(self.bounds),
            "shows": {
                name: {fault: [x if math.isfinite(x) else None for x in size]
                       for fault, size in faults.items()}
                for name, faults in self.shows.items()
            },
        }
        return json.dumps(record, indent=2) + "\n"

    @classmethod
    def from_json(cls, text: str) -> Tuning:
        """The tuning in a text; raises ValueError, with the reason, for any other text."""
        try:
            record: dict[str, Any] = json_data(text)
            if record["bondgraph tuning"] != EDITION:
                raise ValueError(f"edition {record['bondgraph tuning']} is not known here")
            limits = {
                str(name): Limit(
                    **{k: _number(Limit._field_defaults | limit, k, x) for k, x in _LEAST.items()}
                )
                for name, limit in record["limits"].items()
            }
            return cls(
                str(record["model"]),
                _number(record, "rate", 1.0 / RATE, RATE),
                _number(record, "bandwidth", 1.0 / RATE, RATE),
                _number(record, "false_alarms", 0.0),
                _number(record, "seconds", 0.0),
                limits,
                {str(n): _number(record["bounds"], n, 0.0) for n in record.get("bounds", {})},
                {
                    str(name): {str(fault): _shown(faults, fault) for fault in faults}
                    for name, faults in record.get("shows", {}).items()
                },
                _number({"window": 0.0} | record, "window", 0.0),
                *_residuals(record.get("isolate", False), record.get("form", "derivative")),
            )
        except (KeyError, TypeError, AttributeError, OverflowError) as error:
            raise ValueError(f"this is no tuning: {error}") from error
        except WrongData as error:
            where = f" in line {error.line}" if error.line else ""
            raise ValueError(f"this is no tuning: {error}{where}") from error


def _residuals(isolate: object, form: object) -> tuple[bool, Form]:
    """The residuals that a tuning is for; raises ValueError for what no tuning has."""
    if not isinstance(isolate, bool):
        raise ValueError("`isolate` of a tuning is true or false")
    if form == "derivative" or form == "observer":
        return isolate, form
    if not isinstance(form, list) or not all(isinstance(name, str) for name in form):
        raise ValueError("`form` of a tuning is derivative, observer, or names of residuals")
    return isolate, tuple(form)


def _number(record: Mapping[str, Any], key: str, least: float, most: float = _MOST) -> float:
    """A number of a tuning; raises ValueError for one that no tuning has."""
    value = record[key]
    if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
        raise ValueError(f"`{key}` of a tuning is a number from {least:g} to {most:g}")
    return float(value)


def _shown(faults: Mapping[str, Any], fault: str) -> ShownSize:
    """The sizes of a fault in a tuning: null is for one that never shows."""
    sizes = faults[fault]
    if not isinstance(sizes, list) or len(sizes) != len(ShownSize._fields):
        raise ValueError("`shows` of a tuning has two sizes for each fault")
    known = dict(zip(ShownSize._fields, sizes, strict=True))
    return ShownSize(*(math.inf if x is None else _number(known, k, 0.0) for k, x in known.items()))


_NEVER = Limit(math.inf, 1.0, 1.0, math.inf)


def limits(known: Mapping[str, Limit], names: Sequence[str]) -> list[Limit]:
    """Those of residuals by name; one that has none never fires."""
    return [known.get(name, _NEVER) for name in names]


def bandwidth_for(
    rate: float, samples: float | None = None, pieces: Sequence[int] = ()
) -> float:
    """The bandwidth (rad/s) of the filter for a log of so many samples, of an hour if none is told.

    A fiftieth of the rate makes the filter slow beside the samples. Where that would leave too few
    rows to learn from and to watch by, it is faster: as much as a log of this length needs, and no
    faster than a few samples can follow. So it is where the log is in `pieces` of so many samples,
    in each of which the filter has to settle: in half of them it has.

    >>> bandwidth_for(1000.0), bandwidth_for(1.0)
    (20.0, 0.08333333333333333)
    >>> bandwidth_for(1.0, 1200)
    0.2
    >>> bandwidth_for(1.0, 8000, [800] * 10)
    0.03333333333333333
    """
    rows = 3.6e3 * rate / 3.0 if samples is None else samples / 3.0  # with the rate as bandwidth

    def settled(slower: int) -> bool:
        left = sum(max(0.0, piece - _SETTLES * slower) for piece in pieces)
        return left >= _SETTLED * sum(pieces)

    return rate / next((n for n in _SLOWER if rows / n >= _ENOUGH and settled(n)), _SLOWER[-1])


def tuned_bandwidth(rate: float, samples: float) -> float:
    """The same for a watch that is tuned on logs of at most so many samples: of no more than 20
    minutes of them, or of 1200 where these take longer.

    Healthy samples of many hours make limits surer, and no watch slower: one that is tuned has no
    noise to learn from its first rows.

    >>> tuned_bandwidth(1.0, 7200), round(tuned_bandwidth(1 / 30, 2880), 5)
    (0.2, 0.00667)
    """
    return bandwidth_for(rate, min(samples, _LONGEST * max(rate, 1.0)))


def kappa(crossings: float, alarms: float) -> float:
    """The level that noise of one residual exceeds `alarms` times a second, to either side.

    Normal noise crosses the level k sigma upwards exp(-k^2/2) times as often as zero (Rice, 1945).

    >>> round(kappa(10.0, 1 / 3600), 2)
    4.73
    """
    return math.sqrt(2.0 * math.log(max(2.0 * crossings / alarms, 1.0 + 1e-9)))


def height(rows: float, alarms: float) -> float:
    """The height of a CUSUM of `rows` a second that ends above it `alarms` times a second.

    For independent normal rows and a drift of half a sigma to each side, by Siegmund's
    approximation of the mean time between false alarms (1985, eq. 2.56).

    >>> round(height(10.0, 1 / 3600), 1)
    9.3
    """
    wanted = 2.0 * rows / alarms  # rows between false alarms of one side
    low, high = 0.0, 1e4
    for _ in range(200):
        middle = (low + high) / 2
        if _between(middle) < wanted:
            low = middle
        else:
            high = middle
    return high


def _between(height: float) -> float:
    b = height + 1.166
    return 2.0 * (math.expm1(min(b, 700.0)) - b)
