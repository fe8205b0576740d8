"""Verdicts as lines: nothing is lost on the way, and people can read them."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.runtime.monitoring.verdict import (
    EVENTS,
    Candidate,
    Verdict,
    from_json,
    listed,
    to_json,
    to_text,
)

_numbers = st.floats(allow_nan=False, allow_infinity=False)
_verdicts = st.builds(
    Verdict,
    st.sampled_from(EVENTS),
    _numbers,
    st.none() | _numbers,
    st.dictionaries(st.text(), _numbers | st.just(math.inf), max_size=3),
    st.lists(st.text(), max_size=3).map(tuple),
    st.lists(
        st.builds(Candidate, st.text(), st.none() | _numbers, st.text(), _numbers), max_size=3
    ).map(tuple),
    st.text(),
)


@settings(max_examples=50)
@given(_verdicts, st.integers(min_value=1))
def test_a_line_gives_back_the_verdict(verdict: Verdict, number: int) -> None:
    line = to_json(verdict, number)
    assert "\n" not in line
    assert from_json(line) == (number, verdict)


def test_a_line_is_strict_json_with_the_keys_in_their_order() -> None:
    verdict = Verdict("fault", 1.0, 0.5, {"r1": math.inf}, ("a",), (Candidate("a", None, "", 1.0),))
    found = json.loads(to_json(verdict, 3), parse_constant=pytest.fail)
    assert list(found) == [
        *("number", "event", "time", "since", "residuals", "group", "candidates"),
        *("message", "pairs"),
    ]
    assert found["residuals"] == {"r1": None}
    assert found["candidates"] == [{"fault": "a", "size": None, "unit": "", "probability": 1.0}]


@pytest.mark.parametrize("line", ["", "{}", "[1]", '{"number": 1}', "null", '"text"'])
def test_other_lines_are_no_verdicts(line: str) -> None:
    with pytest.raises(ValueError):
        from_json(line)


def test_text_says_what_since_when_how_sure_and_what_else() -> None:
    candidates = (
        Candidate("m[1].el.Re", 4.4, "Ohm", 0.712),
        Candidate("m[1].el.k", None, "N.m/A", 0.288),
    )
    residuals = {"r1": 12.34, "r2": 1.26}
    line = to_text(Verdict("fault", 5.21, 5.034, residuals, ("m[1].el.Re",), candidates))
    assert line.split("fault", 1)[1].strip() == (
        "m[1].el.Re since 5.034 s: m[1].el.Re (71 %, +4.4 Ohm) or m[1].el.k (29 %);"
        " r1 at 12 times its threshold and r2 at 1.3 times its threshold"
    )
    assert "\n" not in line
    unsure = to_text(Verdict("update", 5.21, 5.034, {}, (), candidates))
    assert unsure.split("update", 1)[1].strip() == (
        "not clear yet which fault, since 5.034 s: m[1].el.Re (71 %, +4.4 Ohm) or m[1].el.k (29 %)"
    )


def test_candidates_that_nothing_tells_apart_are_named_once() -> None:
    candidates = tuple(Candidate(f, None, "", 0.5) for f in "ab")
    line = to_text(Verdict("fault", 1.0, 0.5, {"r1": 1234.5}, ("a", "b"), candidates))
    assert line.endswith("a or b since 0.500 s, equally likely; r1 at 1234 times its threshold")


def test_long_lists_are_cut_with_what_is_left_out() -> None:
    assert listed([str(k) for k in range(20)], "or") == "0, 1, 2, 3, 4, 5, 6 and 13 more"
    assert listed(list("abcdefghi"), "or") == "a, b, c, d, e, f, g and 2 more"
    assert listed(list("abcdefgh"), "or") == "a, b, c, d, e, f, g or h"
    assert (listed([], "or"), listed(["a"], "or"), listed(["a", "b"], "or")) == ("", "a", "a or b")
