"""What may change in a file without changing a verdict: order, names, arrows of one-ports."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import pytest

from bondgraph.compilation import Compilation
from bondgraph.frontend.parser import parse
from bondgraph.frontend.read import read
from bondgraph.ir.syntax import File, Node, Ref
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span
from tests.properties import rewrite

ROOT = Path(__file__).parents[2]
MODELS = sorted((ROOT / "models").glob("*.bg"))


class Verdict(NamedTuple):
    """What a user learns of a model, free of the order in which it is told."""

    relations: int
    undetectable: frozenset[str]
    groups: frozenset[frozenset[str]]
    shape: tuple[int, ...]


def verdict(path: Path, change=lambda file: file, name=lambda fault: fault) -> Verdict:
    """The verdict on a model after its syntax tree was changed; `name` gives the old names back."""

    class Changed(Compilation):
        @cached_property
        def syntax(self) -> File:
            return change(super().syntax)

        def _load(self, path: str, origin: Span) -> File | None:
            file = super()._load(path, origin)
            return None if file is None else change(file)

    matrix = Changed(read(str(path), Report())).signatures
    return Verdict(
        len(matrix.residuals),
        frozenset(name(f) for f in matrix.undetectable),
        frozenset(frozenset(name(f) for f in g) for g in matrix.groups),
        tuple(sorted(sum(column) for column in zip(*matrix.rows, strict=True))),
    )


@pytest.fixture(scope="module", params=MODELS, ids=lambda p: p.stem)
def case(request) -> tuple[Path, Verdict]:
    return request.param, verdict(request.param)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_order_of_lines_changes_nothing(case, seed: int) -> None:
    path, expected = case
    assert verdict(path, lambda f: rewrite.reordered(f, seed)) == expected


def test_arrows_of_passive_elements_and_sensors_change_nothing(case) -> None:
    path, expected = case
    assert verdict(path, lambda f: rewrite.reversed_arrows(f, rewrite.at_passive)) == expected


def test_names_change_nothing(case) -> None:
    path, expected = case
    found = verdict(path, rewrite.renamed)
    assert found.relations == expected.relations
    assert found.shape == expected.shape
    assert sorted(map(len, found.groups)) == sorted(map(len, expected.groups))
    assert len(found.undetectable) == len(expected.undetectable)


def test_bonds_at_ports_drawn_the_other_way_change_nothing(case) -> None:
    path, expected = case
    bonds = rewrite.bond_reversed(rewrite.ports_named(_tree(path)), -1)[1]
    for number in range(bonds):
        found = verdict(path, lambda f, n=number: _port_reversed(f, n))
        assert found == expected, f"bond {number}"


def _port_reversed(file: File, number: int) -> File:
    return rewrite.bond_reversed(rewrite.ports_named(file), number)[0]


def _tree(path: Path) -> File:
    return parse(read(str(path), Report()), Report())


def _junction(node) -> bool:
    return node is None or (isinstance(node, Node) and node.type in ("0", "1"))


def test_bonds_between_junctions_drawn_the_other_way_change_nothing(case) -> None:
    """Such a bond turned round counts all flows behind it the other way.

    In the drives that is another machine: the torque of the backlash acts on both sides of the
    bond and cancels for one direction only, so the bonds at the elastic shaft are left alone.
    """
    path, expected = case

    def wanted(left, right) -> bool:
        shaft = any(isinstance(n, Ref) and n.parts[0].name == "twist" for n in (left, right))
        if shaft or not (_junction(left) or isinstance(left, Ref)):
            return False
        return _junction(right)

    found = verdict(path, lambda f: rewrite.reversed_arrows(f, wanted))
    assert found == expected
