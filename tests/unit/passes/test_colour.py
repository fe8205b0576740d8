"""Colours of a chain of like cells: how far each sees."""

from __future__ import annotations

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.passes.elimination.colour import colours
from bondgraph.text.source import Source


def chain(cells: int) -> EquationSystem:
    """A voltage on a chain of R and C, all alike; the last capacitor is measured."""
    text = ["bg 1", "model Chain {", "    Se:u -> 0:n0"]
    for k in range(1, cells + 1):
        text.append(f"    n{k - 1} -> 1:s{k} -> 0:n{k}; s{k} -> R:r{k} = 2; n{k} -> C:c{k} = 3")
    text += [f"    n{cells} -> De:y", "}"]
    return Compilation(Source("chain.bg", "\n".join(text) + "\n")).equations


@pytest.mark.parametrize(("cells", "rounds"), [(20, 6), (500, 2)])
def test_six_steps_of_a_small_system_are_looked_at_and_two_of_a_large_one(
    cells: int, rounds: int
) -> None:
    system = chain(cells)
    assert (len(system.equations) < 2000) == (cells == 20)
    found = colours(system)
    assert found == colours(system, rounds) != colours(system, 8 - rounds)


def test_two_cells_are_alike_as_far_as_one_looks() -> None:
    system = chain(20)
    # from the balance of a cell to that of the next are two steps, to a variable and on to the
    # other equation: in two the middle of the chain sees no end, in forty everything
    balances = [k for k, e in enumerate(system.equations) if e.name.startswith("s")]
    near, far = (colours(system, rounds)[0] for rounds in (2, 40))
    assert len(balances) == 20
    middle = balances[5:15]
    assert len({near[k] for k in middle}) == 1
    assert len({far[k] for k in balances}) == 20
