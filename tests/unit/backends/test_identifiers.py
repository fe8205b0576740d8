"""Names of the model become identifiers, one to one."""

from __future__ import annotations

import keyword
import re

from hypothesis import given
from hypothesis import strategies as st

from bondgraph.backends.identifiers import file_name, identifier, snake, spellings

_NAME = st.sampled_from(["a", "b_", "int", "for", "x_1", "é", "A", "a1", "for_"])
_INDEX = st.sampled_from(["", "[1]", "[2]", "[12]"])
_PART = st.builds(str.__add__, _NAME, _INDEX)
_PATH = st.lists(_PART, min_size=1, max_size=4).map(".".join)


def test_the_examples_of_the_language() -> None:
    assert identifier("m[1].wh.ws") == "m__1__wh__ws"


@given(st.lists(_PATH, unique=True, max_size=20))
def test_different_names_stay_different_and_are_identifiers(paths: list[str]) -> None:
    reserved = frozenset({"int", "for", "a", "b_"})
    found = spellings(paths, reserved)
    assert len(set(found.values())) == len(paths)
    for text in found.values():
        assert re.fullmatch(r"[A-Za-z_]\w*", text, re.ASCII)
        assert text not in reserved


@given(st.text(max_size=12))
def test_a_stem_is_always_an_identifier(name: str) -> None:
    stem = snake(name)
    assert stem.isidentifier() and stem == stem.lower()
    assert not keyword.iskeyword(file_name(stem))
