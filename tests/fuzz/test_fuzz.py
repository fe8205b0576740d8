"""Short runs of the fuzzers, and Hypothesis on whole texts; the long runs are `make fuzz`."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fuzz.guided import kept_texts, run
from tests.fuzz.mutate import Mutator, corpus
from tests.fuzz.run import attempt
from tests.fuzz.targets import KINDS


def test_mutated_models_get_an_answer() -> None:
    mutator = Mutator(1, corpus())
    for _ in range(300):
        text = mutator.text()
        _, finding = attempt(text)
        assert finding is None, f"{finding.trace}\n{text}"


def test_the_same_seed_makes_the_same_texts() -> None:
    first, second = (Mutator(7, corpus()) for _ in range(2))
    assert [first.text() for _ in range(20)] == [second.text() for _ in range(20)]


@settings(max_examples=100, deadline=None)
@given(st.text() | st.text().map(lambda t: "bg 1\nmodel M {\n" + t + "\n}\n"))
def test_any_text_gets_an_answer(text: str) -> None:
    _, finding = attempt(text)
    assert finding is None, finding.trace


@pytest.mark.parametrize("kind", ["check", *KINDS])
def test_what_reads_texts_from_outside_answers(kind: str) -> None:
    """All that is kept, and some more."""
    known = len(kept_texts(kind))
    found = run(kind, known + (60 if kind == "compile" else 400), 3)
    assert not found.findings, next(iter(found.findings.values()))
    assert found.answers > 2 and found.memory < 1000
