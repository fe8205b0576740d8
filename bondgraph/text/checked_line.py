"""A record as a line of JSON with a checksum, by which damage to it is known."""

from __future__ import annotations

import json
import math
import re
import zlib
from typing import Any

from bondgraph.text.printable import json_text

_LINE = re.compile(rb'(\{.+), "crc": "([0-9a-f]{8})"\}', re.DOTALL)


def checked_line(record: dict[str, Any]) -> bytes:
    """The line of a record that is not empty, with the line feed; its last key is `crc`.

    That is the CRC-32 (ISO 3309, of zlib) of the JSON text without it. It tells each burst of at
    most 32 wrong bits, so each wrong byte, and all but one in 4e9 of other changes.

    >>> checked_line({"sent": 7})
    b'{"sent": 7, "crc": "455a11e2"}\\n'
    """
    body = json_text(record).encode()
    return body[:-1] + f', "crc": "{zlib.crc32(body):08x}"}}\n'.encode()


def record_of(line: bytes) -> dict[str, Any]:
    """The record of such a line, given without the line feed; raises ValueError that says why not.

    Numbers are finite, and no text is nested deeper than the reader can go.
    """
    found = _LINE.fullmatch(line)
    if found is None:
        raise ValueError("it is no record with a checksum")
    body = found[1] + b"}"
    if zlib.crc32(body) != int(found[2], 16):
        raise ValueError("its checksum does not match")
    try:
        record = json.loads(
            body.decode("utf-8", "surrogatepass"), parse_float=_finite, parse_constant=_finite
        )
    except RecursionError as error:
        raise ValueError("it is nested too deeply") from error
    assert isinstance(record, dict)  # it begins with a brace
    return record


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text} is no finite number")
    return value
