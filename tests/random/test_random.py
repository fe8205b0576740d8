"""Each random graph is answered: verified, or refused with a reason; as many relations as by rank.

`python -m tests.random.run --count 10000` tries more of them, `--show NUMBER` prints one, and
`--smallest` looks for the smallest one that is answered wrongly.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.measured import measured
from tests.random.graphs import Graph
from tests.random.judge import judge
from tests.random.rank import P, rank, relations
from tests.random.rings import rings, surplus
from tests.random.run import PAGE, counted, of_seed, table, verdict

_BATCH = 20


@pytest.mark.parametrize("first", range(100, 120, _BATCH))
def test_the_answers_stand(first: int) -> None:
    wrong = {n: judge(of_seed(n)).wrong for n in range(first, first + _BATCH)}
    assert {n: text for n, text in wrong.items() if text} == {}


def test_the_sample_on_the_page_is_what_is_answered_now() -> None:
    samples = [re.search(r"--start (\d+) --count (\d\d)$", m.command) for m in measured(PAGE)]
    (sample,) = filter(None, samples)
    start, count = int(sample[1]), int(sample[2])
    (text,) = [m.text for m in measured(PAGE) if m.command == sample.string]
    assert text == table(counted(map(verdict, range(start, start + count))))


@pytest.mark.parametrize("first", range(25, 50, 25))
def test_rings_and_parallel_bonds_are_one_junction(first: int) -> None:
    for seed in range(first, first + 25):
        graph, closing = rings(seed)
        verdict = judge(graph)
        assert verdict.wrong == "", (seed, graph.text)
        assert ("junction-ring" in verdict.notes) <= (closing > 0), (seed, graph.text)
        if verdict.outcome == "refused: causality-conflict":
            # more is wrong than that a ring says one thing twice
            assert surplus(graph) > closing, (seed, graph.text)
        elif not verdict.outcome.startswith("refused"):
            assert ("junction-ring" in verdict.notes) == (closing > 0), (seed, graph.text)


_ONCE = sorted((Path(__file__).parent / "once").glob("*.bg"))


@pytest.mark.parametrize("file", _ONCE, ids=lambda file: file.stem)
def test_what_was_answered_wrongly_once(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    count = re.search(r"^# relations by rank: (\d+)$", text, re.MULTILINE)
    own = [f"k{n}" for n in range(int(count[1]))] if count else []  # rows with that many relations
    graph = Graph(text, tuple({name: 1} for name in own), frozenset(own), count is not None)
    verdict = judge(graph)
    assert verdict.wrong == ""
    assert "verification-unavailable" not in verdict.notes


def test_the_judge_sees_a_wrong_count() -> None:
    text = "bg 1\nmodel M { param p = 1; input u\n 1:j { <- Se:x = u; -> R:r = p; -> Df:y } }\n"
    # e - u = 0, e - p f = 0, y - f = 0 in e and f: one relation
    rows = ({"e": 1, "u": -1}, {"e": 1, "f": -5}, {"f": 1, "y": -1})
    known = frozenset("uy")
    assert judge(Graph(text, rows, known, True)) == ("ok", (), "")
    assert "by rank there are 2" in judge(Graph(text, (*rows, {"y": 1}), known, True)).wrong


def test_ranks() -> None:
    assert rank([{"a": 1, "b": 2}, {"a": 2, "b": 4}, {"b": 1}]) == 2
    assert rank([{"a": P}]) == 0
    # x = y1 and x = y2 leave one relation, whatever unknown z adds
    rows = [{"x": 1, "y1": -1}, {"x": 1, "y2": -1}, {"z": 1, "x": 3}]
    assert relations(rows, frozenset({"y1", "y2"})) == 1
