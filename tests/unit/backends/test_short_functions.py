"""Cutting a run of statements: order, values that are handed on, and lines."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable

import pytest

from bondgraph.backends.program_units import grouped
from bondgraph.backends.short_functions import Piece, Step, parts, pieces
from bondgraph.ir.program import Assign, Const, PolynomialTape, Product, Ref, Statement, TapeOutput


def _flat(members: Iterable[int | Piece]) -> list[int]:
    return [k for m in members for k in ((m,) if isinstance(m, int) else m.numbers())]


def _walk(members: Iterable[int | Piece]) -> list[Piece]:
    own = [m for m in members if isinstance(m, Piece)]
    return [p for m in own for p in (m, *_walk(m.members))]


def _run(seed: int) -> list[Step]:
    """Statements that read a few of the last values, in parts of about eight."""
    draw = random.Random(seed)
    steps = []
    for at in range(draw.randint(40, 200)):
        takes = {f"v{draw.randint(max(0, at - 9), at - 1)}" for _ in range(3)} if at else set()
        key = f"r{at // 40}_w{at // 8}" if draw.random() < 0.8 else ""
        steps.append(Step((f"v{at}",), frozenset(takes), key, str(at // 2), draw.randint(1, 5)))
    return steps


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("cut", [pieces, parts])
def test_pieces_hand_on_what_is_read_and_keep_the_order(
    seed: int, cut: Callable[..., tuple[int | Piece, ...]]
) -> None:
    steps = _run(seed)
    members = cut(steps, 60, 54)
    assert _flat(members) == list(range(len(steps)))
    for piece in _walk(members):
        inside = [*piece.numbers()]
        assert inside == list(range(inside[0], inside[-1] + 1))
        given = {v for k in inside for v in steps[k].gives}
        read = {v for k in inside for v in steps[k].takes}
        after = {v for step in steps[inside[-1] + 1 :] for v in step.takes}
        assert set(piece.takes) == read - given
        assert set(piece.gives) == given & after
        own = sum(steps[k].lines for k in piece.members if isinstance(k, int))
        assert own <= 54
    left = sum(steps[k].lines for k in members if isinstance(k, int))
    assert left <= 60


def test_what_is_short_stays_whole() -> None:
    steps = _run(0)[:10]
    assert pieces(steps, 60, 54) == tuple(range(10))


def test_a_value_is_computed_where_all_that_need_it_are() -> None:
    """`w` for all, `m` for both parts of r1, `n` for the second of them alone."""

    def local(name: str, *reads: str) -> Assign:
        factors = (Const(2.0), *(Ref("local", r) for r in reads))
        return Assign(Ref("local", name), Product(factors), name, None)

    def coef(key: str, *reads: str) -> Assign:
        factors = tuple(Ref("local", r) for r in reads)
        return Assign(Ref("coef", f"{key}_x"), Product(factors), f"{key}: factor of x", None)

    run = [
        local("w"), local("n", "w"), local("m", "w"),
        coef("r1_w1", "m"), coef("r2", "w"), coef("r1_w2", "m", "n"),
    ]  # fmt: skip
    found = [(key, run[at].target.name) for key, at in grouped(run)]
    assert found == [
        ("", "w"), ("r1", "m"), ("r1_w1", "r1_w1_x"), ("r1_w2", "n"), ("r1_w2", "r1_w2_x"),
        ("r2", "r2_x"),
    ]  # fmt: skip


def test_what_reads_a_coefficient_is_computed_after_it() -> None:
    """A number of the tape of r2, that of a copy of it, and a local value with both."""

    def assign(target: Ref, comment: str, *factors: Ref) -> Assign:
        return Assign(target, Product((Const(2.0), *factors)), comment, None)

    array, copy, both = Ref("coef", "r2_x", 1), Ref("coef", "r2_x__1"), Ref("local", "both")
    outputs = (TapeOutput("r2_x", 0, 2), TapeOutput("r2_y", 1, 2))
    run: list[Statement] = [
        PolynomialTape("r2", 2, 2, (), (), outputs, "r2: factors of all derivatives", None),
        assign(copy, "r2_x[1]", array),
        assign(both, "both", array, copy),
        assign(Ref("coef", "r1_z"), "r1: factor of z", both),
        assign(Ref("coef", "free"), "free"),
    ]
    found = grouped(run)
    assert [at for _, at in found] == [4, 0, 1, 2, 3]
    assert [key for key, _ in found] == ["", "r2", "r2", "r1", "r1"]
