"""Relations written down by hand, each from a balance of its model, against those compiled."""

from __future__ import annotations

import random
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import sympy
from mpmath import mpf

from tests.adversary.jets import Evaluator
from tests.adversary.judge import parse
from tests.adversary.plant import HERE
from tests.adversary.test_adversary import compiled

# Model: relation, and the balance that it is; D(x, k) is the derivative k.
CLOSED = {
    "dc_i": (  # U - R*i - L*i' = k*w, put into J*w' + f*w = k*i - T: the arrow leads out to T
        "J*(D(U,1) - R*D(yi,1) - L*D(yi,2)) + f*(U - R*yi - L*D(yi,1)) - k*(k*yi - T)"
    ),
    "boost_duty": "U - (1-a)*u - L*D((C*D(u,1) + u/R)/(1-a), 1)",  # averaged coil and node
    "redundant_df": "U - R*y - L*D(y,1)",  # first of two, Kirchhoff's voltage law
    "stribeck": "F - m*D(y,1) - (Fc + (Fs-Fc)*exp(-(y/vs)**2))*sign(y) - b*y",  # Newton
    "de_on_se": "U - y",
    "rigid_both": "ya - N*yb",
    "michaelis": "feed - D(y,1) - vm*y/(km + y)",  # balance of the substrate
}


@pytest.mark.parametrize("model", CLOSED)
def test_a_relation_is_the_one_by_hand(model: str, tmp_path: Path) -> None:
    answer = compiled(HERE / "models" / f"{model}.bg", tmp_path)
    arr = next(a for a in answer["arrs"] if len(a["signature"]) > 2 or answer["n_arr"] == 1)
    names: dict[str, Any] = {x: sympy.Symbol(x) for x in answer["symbols"]}
    by_hand = sympy.parse_expr(CLOSED[model], local_dict=dict(names))
    draw = random.Random(3)
    params = {x: mpf(draw.random()) + 1 for x in answer["symbols"]}
    moving = {x for x in answer["symbols"] if x in arr["orders"]}
    values = []
    for _ in range(3):
        signals: dict[str, Any] = {
            x: [mpf(draw.random() - 0.5) / 4 + (k == 0) / mpf(3) for k in range(8)]
            if x in moving
            else params[x]
            for x in answer["symbols"]
        }
        value = Evaluator(signals, 8)
        values.append((value(parse(arr).expr)[0], value(by_hand)[0]))
    for (a, b), (c, d) in pairwise(values):
        assert abs(a * d - b * c) < mpf(10) ** -30 * abs(a * d), f"{arr['expr']} is not {by_hand}"
        assert abs(a) > mpf(10) ** -20
