"""Reading a log from MCAP, the recordings of ROS 2 and others: messages of topics, as one table."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.log import LEFT_OUT, Array, Log, LogError
from bondgraph.runtime.log_numbers import Form, Reader
from bondgraph.text.limits import COLUMNS
from bondgraph.text.numerals import listed
from bondgraph.text.regular_file import check_regular

if TYPE_CHECKING:
    from mcap.reader import McapReader
    from mcap.records import Channel, Schema

Decode = Callable[[bytes], object]

#: Packages that decode what is not JSON, by the encoding of the messages.
_DECODERS = {
    "cdr": ("mcap_ros2", "mcap-ros2-support"),
    "ros1": ("mcap_ros1", "mcap-ros1-support"),
    "protobuf": ("mcap_protobuf", "mcap-protobuf-support"),
}
_CLOCKS = ("log_time", "publish_time")
#: Times within messages, in whole seconds and nanoseconds: of ROS 2, ROS 1, protobuf.
_TIMES = (("sec", "nanosec"), ("secs", "nsecs"), ("seconds", "nanos"))
_LONGEST = 100  # elements of a list that are signals; images and scans have more
_SECOND = 10**9  # ns


def read_mcap(path: str, form: Form) -> Log:
    """The log in an MCAP file: a row for each moment at which there were messages.

    A column is a number in a message, called `/topic.field.part[0]` as in the message paths of
    Foxglove. Messages are JSON, or those of ROS 2, ROS 1 or protobuf where the package that decodes
    them is installed. The time is that of the recorder (`log_time`), the `publish_time`, or a field
    that the messages have themselves (`header.stamp`), in which case the others are left out.
    Raises LogError for a file that is damaged or has no message that can be read.
    """
    try:
        from mcap.reader import make_reader
    except ImportError as error:
        help = "install it (pip install 'bondgraph-arr[mcap]'), or use .csv"
        raise LogError(path, None, "MCAP needs the package mcap", help) from error
    check_regular(path)
    reader = _Topics(form)
    with open(path, "rb") as file:
        try:
            reader.take(make_reader(file))
        except LogError:
            raise
        except Exception as error:  # also of the libraries that unpack and decode
            help = "a recording that was not closed: `mcap recover` makes a whole file of it"
            what = f"{type(error).__name__}: {error}".removesuffix(": ")
            raise LogError(path, None, f"a damaged MCAP file: {what}", help) from error
    return reader.log()


class _Topics(Reader):
    """Makes a log of messages."""

    def __init__(self, form: Form) -> None:
        super().__init__(form)
        self._name = form.time or _CLOCKS[0]
        self._units[self._name] = "ns" if self._name in _CLOCKS else ""
        self._times: list[float] = []  # of each message that is taken
        self._cells: dict[str, tuple[list[int], list[float]]] = {}  # messages, numbers
        self._left: dict[str, str] = {}  # topics, and why they are left out

    def take(self, reader: McapReader) -> None:
        """All messages; raises whatever the library does where the file is damaged."""
        decoders: dict[int, Decode | None] = {}
        for schema, channel, message in reader.iter_messages():
            if channel.id not in decoders:
                decoders[channel.id] = self._decoder(schema, channel)
            decode = decoders[channel.id]
            if decode is None:
                continue
            topic = channel.topic
            try:
                found = self._numbers(decode(message.data), "")
                fields = {f"{topic}{path}": x for path, x in found}
            except Exception as error:  # of any library, for bytes that are not what they claim
                kind, name = channel.message_encoding, type(error).__name__
                text = f"a message of {topic} is no {kind}: {name}: {error}"
                raise LogError(self.form.name, None, text, "record it anew") from error
            if self._name in _CLOCKS:
                clock: float | None = getattr(message, self._name)
            else:
                clock = fields.get(f"{topic}.{self._name}", fields.get(self._name))
            if clock is None or math.isnan(clock):
                self._left[topic] = f"messages without {self._name}"
            else:
                self._row(clock, fields)

    def _row(self, clock: float, fields: dict[str, float]) -> None:
        row = len(self._times)
        self._times.append(clock)
        for name, value in fields.items():
            rows, values = self._cells.setdefault(name, ([], []))
            rows.append(row)
            values.append(value)
        if len(self._cells) > COLUMNS:
            message = f"more than {COLUMNS} columns"
            help = "name in a map file (--map) those that are signals: no others are read then"
            raise LogError(self.form.name, None, message, help)

    def _numbers(self, value: object, path: str) -> Iterator[tuple[str, float]]:
        """The numbers in a message, each with the path that leads to it; times in s."""
        if isinstance(value, bool | int | float):
            yield path, float(value)
        elif isinstance(value, str | bytes | bytearray | memoryview) or value is None:
            return
        elif isinstance(value, Iterable) and not isinstance(value, Mapping):
            elements = list(value)
            if len(elements) <= _LONGEST:
                for k, element in enumerate(elements):
                    yield from self._numbers(element, f"{path}[{k}]")
        else:
            parts = _parts(value)
            if tuple(parts) in _TIMES:
                whole, rest = parts.values()
                yield path, int(whole) + int(rest) / _SECOND
                if f".{self._name}".endswith(path):
                    self._units[self._name] = "s"
                return
            for name, part in parts.items():
                yield from self._numbers(part, f"{path}.{name}")

    def _decoder(self, schema: Schema | None, channel: Channel) -> Decode | None:
        """What makes objects of the messages of a channel; None for those that are left out."""
        topic, encoding = channel.topic, channel.message_encoding
        wanted = self.form.wanted
        fields = f"{topic}.", f"{topic}["
        if wanted and not any(name == topic or name.startswith(fields) for name in wanted):
            return None
        if encoding == "json":
            return json.loads
        if encoding not in _DECODERS:
            self._left[topic] = f"{encoding or 'no encoding'}, which is not read"
            return None
        module, package = _DECODERS[encoding]
        try:
            factory = import_module(f"{module}.decoder").DecoderFactory()
        except ImportError:
            self._left[topic] = f"{encoding}, pip install {package}"
            return None
        decode: Decode | None = factory.decoder_for(encoding, schema)
        if decode is None:
            self._left[topic] = f"{encoding} of an unknown schema"
        return decode

    def log(self) -> Log:
        """The messages as one table; raises LogError where there is none."""
        left = ", ".join(f"{topic} ({why})" for topic, why in self._left.items())
        if not self._cells:
            why = f"no message with numbers that can be read{left and f', but {left}'}"
            help = f"--time is {listed(_CLOCKS, 'or')}, or a field that messages have"
            raise LogError(self.form.name, None, why, help)
        clocks, row_of = np.unique(np.array(self._times), return_inverse=True)
        columns = {name: _column(cells, row_of, len(clocks)) for name, cells in self._cells.items()}
        return self._log(len(clocks), clocks, self._name, columns, {LEFT_OUT: left} if left else {})

    def _labelled(self, name: str) -> str:
        return ""


def _column(
    cells: tuple[list[int], list[float]], row_of: npt.NDArray[np.intp], count: int
) -> Array:
    """A column of so many rows, NaN where there is no message."""
    column = np.full(count, np.nan)
    column[row_of[cells[0]]] = cells[1]
    return column


def _parts(value: Any) -> Mapping[str, Any]:
    """The fields of an object as JSON, ROS and protobuf have them."""
    if isinstance(value, Mapping):
        return value
    if hasattr(value, "DESCRIPTOR"):
        return {field.name: getattr(value, field.name) for field in value.DESCRIPTOR.fields}
    names = getattr(type(value), "__slots__", None) or vars(value)
    return {name: getattr(value, name) for name in names if not name.startswith("_")}
