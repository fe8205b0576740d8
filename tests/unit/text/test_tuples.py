"""The quick named tuples behave as those of `typing`."""

from __future__ import annotations

import pickle
import typing

import pytest

from bondgraph.text import tuples


class Quick(tuples.NamedTuple):
    """A pair and more."""

    first: int
    second: str = "b"

    @property
    def both(self) -> str:
        """First and second."""
        return f"{self.first}{self.second}"


class Slow(typing.NamedTuple):
    """The same, made by `typing`."""

    first: int
    second: str = "b"


def test_like_those_of_typing() -> None:
    assert tuple(Quick(1)) == tuple(Slow(1)) == (1, "b")
    assert Quick(second="c", first=2)._asdict() == Slow(2, "c")._asdict()
    assert repr(Quick(1)) == "Quick(first=1, second='b')"
    assert (Quick._fields, Quick._field_defaults) == (Slow._fields, Slow._field_defaults)
    assert Quick(1)._replace(first=3).both == "3b"
    assert Quick.__mro__[1:] == (tuple, object)
    assert not hasattr(Quick(1), "__dict__")
    assert Quick.__doc__ == "A pair and more."
    assert (Quick.__module__, Quick.__qualname__) == (__name__, "Quick")


def test_it_can_be_pickled_and_refuses_wrong_fields() -> None:
    assert pickle.loads(pickle.dumps(Quick(1))) == Quick(1)
    with pytest.raises(TypeError):
        Quick()  # type: ignore[call-arg]
    with pytest.raises(AttributeError):
        Quick(1).first = 2  # type: ignore[misc]
