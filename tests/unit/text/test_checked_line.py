"""A line with a checksum is read as it was written, or not at all."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.text.checked_line import checked_line, record_of

_FINITE = st.floats(allow_nan=False, allow_infinity=False)
_PLAIN = st.none() | st.booleans() | st.integers() | _FINITE
_VALUES = st.recursive(
    _PLAIN | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=10,
)


@given(st.dictionaries(st.text().filter(lambda k: k != "crc"), _VALUES, min_size=1))
def test_what_is_written_is_read(record: dict[str, object]) -> None:
    line = checked_line(record)
    assert line.endswith(b"\n") and line.count(b"\n") == 1
    assert record_of(line[:-1]) == record
    assert set(json.loads(line.decode("utf-8", "surrogatepass"))) == {*record, "crc"}


def test_every_bit_counts() -> None:
    line = checked_line({"n": 3, "text": "état", "value": 1e-3})[:-1]
    for bit in range(8 * len(line)):
        changed = bytearray(line)
        changed[bit // 8] ^= 1 << bit % 8
        with pytest.raises(ValueError, match=r"checksum|finite|utf|codec"):
            record_of(bytes(changed))


@pytest.mark.parametrize("value", [float("inf"), float("-inf"), float("nan")])
def test_no_number_that_is_none_is_written(value: float) -> None:
    with pytest.raises(ValueError, match="not JSON compliant"):
        checked_line({"value": value})
