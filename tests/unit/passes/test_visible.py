"""How large a term of a signal can stand out at some frequency up to the highest."""

from __future__ import annotations

import math

import pytest

from bondgraph.passes.lowering.visible import Spectrum


@pytest.mark.parametrize(
    ("sizes", "order", "share"),
    [
        # sizes are |c| w^k at the highest frequency w; below it order k falls as the k-th power
        ({0: 1.0, 2: 0.01}, 2, 0.01),  # largest at w
        ({0: 1.0, 2: 0.01}, 0, 1.0),  # alone at frequency zero
        ({0: 1.0, 1: 5.0, 2: 100.0}, 1, 0.5),  # at w/10 the others are 1 and 1, it is 0.5
        ({0: 1.0, 1: 0.1, 2: 1.0}, 1, 0.1),  # at w, where the others are as large
        ({1: 3.0, 2: 6.0}, 2, 1.0),  # above w/2 it is the largest itself
    ],
)
def test_share(sizes: dict[int, float], order: int, share: float) -> None:
    spectrum = Spectrum({k: math.log(size) for k, size in sizes.items()})
    assert spectrum.share(order, sizes[order]) == pytest.approx(share)


def test_the_limits() -> None:
    assert Spectrum({}).share(1, 0.5) == math.inf  # nothing beside it
    assert Spectrum({0: 0.0}).share(3, 0.0) == 0.0
