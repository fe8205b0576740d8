"""A rover on two wheels that a person can reckon: each wheel m v' = F - f v, in the plane."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.text.source import Source

MASS, FRICTION, TRACK, TURN = 0.5, 2.0, 0.2, 3600
MODEL = f"""bg 1
## A rover with an encoder on each wheel.
model Rover {{
    input F[2] : N
    param d = {TRACK} m
    param m = {MASS} kg +- 1%
    param f[2] = {FRICTION} N.s/m
    const rad = 0.1 m
    for j in 1..2 {{
        1:wheel[j] {{
            <- Se:F[j]
            -> I:m[j] = m
            -> R:f[j]
        }}
        sensor turn[j] : rad = int(wheel[j].f/rad) counts {TURN}/turn
        sensor v[j] : m/s = wheel[j].f
    }}
    let u = (wheel[1].f + wheel[2].f)/2
    let heading = rad*(turn[1] - turn[2])/d
    let x = int(u*cos(heading))
    let y = int(u*sin(heading))
}}
"""
SCENARIO = """
name = "errand"
duration = "5 s"
[sampling]
rate = "200 Hz"
[inputs]
"F[1]" = "1 + 0.5*sin(2*t)"
"F[2]" = "1 N"
[sensors."v[1]"]
noise = "1 mm/s"
[sensors."v[2]"]
noise = "1 mm/s"
[plane]
x = "x"
y = "y"
heading = "heading"
[desired]
"turn[1]" = "5*t"
"turn[2]" = "4*t"
"v[1]" = "0.5 m/s"
"v[2]" = "0.4 m/s"
[[fault]]
of = "f[2]"
change = "*= 3"
at = "1000 s"
label = "brake drags"
"""


@cache
def rover(rate: float = 200.0) -> Compilation:
    """The rover, compiled."""
    return Compilation(Source("rover.bg", MODEL), options=bondgraph.Options(rate=rate))


def written(folder: Path) -> tuple[Path, Path]:
    """Its model and scenario as files."""
    model, scenario = folder / "rover.bg", folder / "errand.toml"
    model.write_text(MODEL)
    scenario.write_text(SCENARIO)
    return model, scenario
