"""Relations that tell faults apart: against partitions by hand, and none more than it takes."""

from __future__ import annotations

import itertools
import json
from pathlib import Path

import pytest

from bondgraph.algebra.in_mode import in_mode
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.ir.expr import Kind, Pool
from bondgraph.passes.analysis.isolating_set import _idle, _without
from bondgraph.text.source import Source
from tests.real.draw import of_seed
from tests.unit.passes.relations import is_multiple
from tests.unit.passes.test_decouple import MOTOR, MOTOR_NUMBERS, motor_k
from tests.unit.passes.test_isolability import CASES, proportional


def isolating(text: str) -> Compilation:
    """The compilation with the relations that tell apart, verified exactly."""
    c = Compilation(Source("model.bg", "bg 1\n" + text), options=Options(isolate=True))
    assert c.verification.method.startswith("exact")
    return c


@pytest.mark.parametrize("name", CASES)
def test_groups_by_hand(name: str) -> None:
    """Faults whose operators are proportional stay together, all others are told apart."""
    text, operators = CASES[name]
    groups = isolating(text).signatures.groups
    group = {f: g for g in groups for f in g}
    assert group.keys() == operators.keys()
    for a, b in itertools.combinations(operators, 2):
        together = group[a] is group[b]
        assert together == proportional(operators[a], operators[b]), (a, b)


@pytest.mark.parametrize("name", CASES)
def test_none_is_more_than_it_takes(name: str) -> None:
    """Without any one of the further relations fewer groups are told apart."""
    matrix = isolating(CASES[name][0]).signatures
    alone = Compilation(Source("model.bg", "bg 1\n" + CASES[name][0])).signatures
    for left_out in matrix.residuals[len(alone.residuals) :]:
        kept = {r: r for r in matrix.residuals if r != left_out}
        assert len(matrix.renamed(kept).groups) < len(matrix.groups)


def test_the_cheaper_ones_are_kept() -> None:
    """Of the three faults that share both relations of a motor two have to be taken out.

    Without k that is the balance of power, of first order; without a gauge the order is two.
    """
    c = isolating(MOTOR)
    further = [r for r in c.residuals if r.residual.free_of]
    assert [r.residual.free_of for r in further][:1] == ["k"]
    assert len(further) == 2
    assert is_multiple(further[0], motor_k, MOTOR_NUMBERS, ("U", "i", "w"))
    assert max(further[0].orders.values()) == 1
    assert max(further[1].orders.values()) == 2


def test_what_is_best_does_not_depend_on_it() -> None:
    alone = Compilation(Source("model.bg", "bg 1\n" + MOTOR))
    found = isolating(MOTOR).maximum_isolability
    assert found is not None
    assert found == alone.maximum_isolability


def test_where_there_is_no_closed_form() -> None:
    """A speed in sin(k w) and in cos(2 k w) cannot be had from either."""
    c = isolating(
        """model M { param k=2; param b=1; input drive unknown
        1:shaft { <- Sf:w = drive; -> R:b; -> Df:speed }
        sensor one = shaft.f + sin(k*shaft.f)
        sensor two = shaft.f + cos(2*k*shaft.f) }"""
    )
    assert ("k", "speed") in c.signatures.groups
    (told,) = [d for d in c.report.diagnostics if d.code == "not-isolated"]
    assert "`k` and `speed`" in told.message
    assert told.severity == "info"


@pytest.mark.parametrize("seed", [2, 3, 13, 31, 39, 47, 58])
def test_between_what_there_was_and_what_is_best(seed: int) -> None:
    """On random plants: no group of before is mixed with another, none is divided too far."""
    text = of_seed(seed).text
    c = Compilation(Source("model.bg", text))
    before, best = c.signatures, c.maximum_isolability
    assert best is not None
    own = isolating(text.removeprefix("bg 1\n")).signatures
    for finer, coarser in ((best, own.groups), (own.groups, before.groups)):
        assert all(any(set(f) <= set(g) for g in coarser) for f in finer)


@pytest.mark.parametrize(
    ("text", "groups"),
    [
        # U - R i - L i' while on, i while off: only the gauge is in the second
        (
            """model M { input on : bool; param R = 2; param L = 1
            1:j when on { <- Se:U; -> R:R; -> I:L; -> Df:i } }""",
            [{"U", "R", "L"}, {"i"}],
        ),
        # C v' + (v - U)/R1 while a + (v - U)/R2 while b; with neither only C and the gauge act,
        # as one: v' C = 0
        (
            """model M { input a : bool; input b : bool; param R1 = 2; param R2 = 3; param C = 0.1
            0:s { <- Se:U }
            0:y { -> C:C; -> De:v }
            1:ja when a { <- s; -> R:R1; -> y }
            1:jb when b { <- s; -> R:R2; -> y } }""",
            [{"R1"}, {"R2"}, {"U"}, {"C", "v"}],
        ),
    ],
)
def test_what_acts_in_some_modes_only_is_told_in_the_others(
    text: str, groups: list[set[str]]
) -> None:
    c = isolating(text)
    assert sorted(map(set, c.signatures.groups), key=sorted) == sorted(groups, key=sorted)
    further = [r.residual for r in c.residuals if r.residual.free_of]
    modes = [i.symbol for i in c.graph.inputs if i.mode]
    on = dict.fromkeys(modes, True)
    assert further and in_mode(c.graph.pool, [r.expr for r in further], on)[-1] is c.graph.pool.zero


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The report says what the option would bring, and the option brings it."""
    path = tmp_path / "motor.bg"
    path.write_text("bg 1\n" + MOTOR)
    out = ["-o", str(tmp_path / "out")]
    assert main(["compile", str(path), *out]) == 0
    assert "5 groups at best" in capsys.readouterr().out
    assert main(["compile", str(path), "--isolate", *out]) == 0
    assert "in 5 groups" in capsys.readouterr().out
    assert main(["compile", str(path), "--isolate", "--json", *out]) == 0
    result = json.loads(capsys.readouterr().out)
    assert len(result["groups"]) == len(result["best"]) == 5
    assert [a.get("free_of") for a in result["arrs"]][:3] == [None, None, "k"]


def test_a_relation_is_idle_that_says_nothing_in_some_mode() -> None:
    """On either side of a switch, and of a switch inside of that."""
    p = Pool()
    one, two = (p.symbol(name, Kind.MODE) for name in ("one", "two"))
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    assert not _idle(x, p) and not _idle(p.choose(one, x, y), p)
    assert _idle(p.choose(one, x, p.zero), p) and _idle(p.choose(one, p.zero, x), p)
    inner = p.choose(two, p.zero, y)
    assert _idle(p.choose(one, x, inner), p) and _idle(p.choose(one, inner, x), p)
    assert not _idle(p.add((1, inner), (1, x)), p)  # with what else there is it says something


def test_a_relation_without_a_fault_is_zero_where_it_holds_it_and_else_what_it_was() -> None:
    p = Pool()
    one, two = (p.symbol(name, Kind.MODE) for name in ("one", "two"))
    x, fault = p.symbol("x", Kind.SENSOR), p.symbol("R", Kind.PARAM)
    product = p.mul(fault, x)
    assert _without(fault, [x, product], [one], p) == [x, product]
    assert _without(fault, [product, x], [], p) == [p.zero, p.zero]
    both = [p.choose(one, product, x), p.choose(one, x, p.add((1, product), (1, x)))]
    assert _without(fault, both, [one], p) == [
        p.choose(one, p.zero, x), p.choose(one, p.zero, p.add((1, product), (1, x))),
    ]  # fmt: skip
    nested = p.choose(one, p.choose(two, product, x), p.one)
    assert _without(fault, [nested], [one, two], p) == [
        p.choose(one, p.choose(two, p.zero, x), p.one)
    ]
