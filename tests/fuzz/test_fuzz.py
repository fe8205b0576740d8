"""What was kept and some texts more, without atheris; then what the fuzzer itself has to see.

The long runs are `make fuzz`.
"""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fuzz.attempt import attempt, smallest
from tests.fuzz.guided import KEPT, Run, kept_texts, run
from tests.fuzz.mutate import BYTES, ENCODING, Mutator, changed, corpus
from tests.fuzz.targets import KINDS, WORDS

_TEXTS = {"check": 300, "compile": 60}  # and 400 of all others


@pytest.mark.parametrize("name", KINDS)
def test_what_reads_texts_from_outside_answers(name: str) -> None:
    """All that is kept, and some more."""
    kind = KINDS[name]
    seeds, rng = kind.seeds(), random.Random(1)
    texts = [*seeds, *kept_texts(name)]
    models = Mutator(1, corpus())
    for _ in range(_TEXTS.get(name, 400)):
        texts.append(
            models.text().encode(ENCODING, BYTES)
            if kind.models
            else changed(rng, rng.choice(texts), texts, (*kind.words, *WORDS))
        )
    answers = set()
    for text in texts:
        answer, finding = attempt(kind.read, text)
        assert finding is None, f"{finding.trace}\n{text!r}"
        answers.add(answer)
    assert len(answers) > 5


def test_the_same_seed_makes_the_same_texts() -> None:
    first, second = (Mutator(7, corpus()) for _ in range(2))
    assert [first.text() for _ in range(20)] == [second.text() for _ in range(20)]


@settings(max_examples=100, deadline=None)
@given(st.text() | st.text().map(lambda t: "bg 1\nmodel M {\n" + t + "\n}\n"))
def test_any_text_gets_an_answer(text: str) -> None:
    _, finding = attempt(KINDS["check"].read, text.encode(ENCODING, "surrogatepass"))
    assert finding is None, finding.trace


def test_the_corpus_is_small_and_of_every_kind() -> None:
    sizes = {name: sum(map(len, kept_texts(name))) for name in KINDS}
    assert {p.name for p in KEPT.iterdir()} == sizes.keys()
    assert all(sizes.values()) and sum(sizes.values()) <= 400_000


def test_a_text_that_breaks_is_made_small() -> None:
    def read(text: bytes) -> str:
        if b"b" in text and text.endswith(b"d"):
            raise KeyError("planted")
        return "sound"

    _, finding = attempt(read, b"first\na bc\nlast d")
    assert finding is not None and finding.what == "KeyError in test_fuzz.py:read"
    assert smallest(finding.text, lambda t: attempt(read, t)[1] is not None) == b"bd"


def test_a_text_that_hangs_is_a_finding() -> None:
    def read(text: bytes) -> str:
        while text:
            pass
        return "sound"

    assert attempt(read, b"", 0.1) == ("sound", None)
    assert attempt(read, b"x", 0.1)[0].startswith("Slow in ")


@pytest.fixture
def planted() -> str:
    """The module of kinds that break on purpose."""
    pytest.importorskip("atheris", reason="atheris has wheels for Python 3.11 to 3.13")
    return "tests.fuzz.planted"


def test_branches_lead_the_fuzzer(planted: str) -> None:
    """Four letters in a row are not found by chance."""
    found = run(Run("deep", 50_000, module=planted))
    assert [f.what for f in found.findings] == ["LookupError in planted.py:deep"]
    assert found.findings[0].text.startswith(b"\xb0\x9d\x04\xe7")
    assert found.texts >= 50_000 and found.answers == 5


def test_a_run_that_time_ends_counts_what_it_did(planted: str) -> None:
    found = run(Run("deep", 10**9, module=planted, minutes=0.05))
    assert 0 < found.texts < 10**9 and found.seconds < 60
    assert not [f for f in found.findings if f.what != "LookupError in planted.py:deep"]


@pytest.mark.parametrize(
    ("name", "what", "seconds"),
    [("endless", "timeout", 2), ("stuck", "timeout", 2), ("hungry", "oom", 20)],
)
def test_what_takes_too_much_is_ended(planted: str, name: str, what: str, seconds: int) -> None:
    """The process with it; the next one goes on with the other texts.

    libFuzzer looks at the memory once a second: on a busy machine a short time is over before.
    """
    found = run(Run(name, 2_000, module=planted, seconds=seconds, memory=100))
    assert [(f.what, f.text) for f in found.findings] == [(what, f"{name}, ".encode() * 20)]
    assert found.texts >= 2_000 and found.answers == 5
