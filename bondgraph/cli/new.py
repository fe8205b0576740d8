"""`bondgraph new`: a model to begin with, a log of it, and a page with the commands for both."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING

from bondgraph import Compilation, compile
from bondgraph.frontend.words import KEYWORDS
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.whole_file import write_whole

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from bondgraph.runtime.log import Log

_MODEL = '''# {name}: a motor turns an inertia. Make it your machine, and ask `bondgraph check`.
bg 1

model {title} {{
    param L = 0.5 mH  # armature
    param R = 2 Ohm +- 5%
    param k = 20 mN.m/A         # torque constant
    param J = 20e-6 kg.m^2      # rotor and load
    param f = 100e-6 N.m.s/rad  # friction

    Se:U -> 1:armature  # one current
    armature {{
        -> I:L
        -> R:R
        -> Df:current
        -> GY:k -> rotor
    }}
    1:rotor {{  # one speed
        -> I:J
        -> R:f
        -> Df:speed
    }}
}}
'''
_FAULT = 6.0  # s into the log, from when on the resistance is larger by
_LARGER = 1.3

_README = '''# {name}

A bond graph of a machine, a log of it with a fault, and the commands to begin with:

    bondgraph check {file}.bg
    bondgraph draw {file}.bg -o {file}.svg
    bondgraph compile {file}.bg
    bondgraph explain {file}.bg r1 --derive
    bondgraph monitor {file}.bg {file}.csv
    bondgraph simulate {file}.bg --input "U=12 V" --duration "2 s" -o run.csv
    bondgraph report {file}.bg

| file | |
|---|---|
| `{file}.bg` | the model: parameters with units, junctions, sensors |
| `{file}.csv` | ten seconds of the machine, as read; from {at:g} s on R is {percent:.0f} % larger |

`bondgraph monitor` says so. `bondgraph compile` writes the residuals in C and Python to
`generated/{file}`.
'''


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `new`."""
    parser.add_argument("name", metavar="NAME", help="of the machine, and of its folder")
    parser.add_argument(
        "-o", "--output", metavar="DIR", help="the folder (default: the name of the machine)"
    )


def run(args: Namespace) -> int:
    """Write model, log and page into a folder that does not have them."""
    from bondgraph.runtime.log_file import write_log

    name = args.name.strip()
    file = "".join(c if c.isalnum() and c.isascii() else "_" for c in name).strip("_").lower()
    if not file or file[0].isdigit() or file in KEYWORDS:
        raise Trouble(f"`{name}` is no name for a model: write letters and digits, as in pump2")
    folder = Path(args.output or file)
    made = [folder / f"{file}.bg", folder / f"{file}.csv", folder / "README.md"]
    there = [str(path) for path in made if os.path.lexists(path)]
    if there:
        raise Trouble(f"{', '.join(there)}: there already; nothing is written")
    title = "".join(part.capitalize() for part in file.split("_"))
    text = _MODEL.format(name=name, title=title)
    log = _log(compile(str(made[0]), text=text))
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(made[0], text)
    write_log(log, str(made[1]))
    more = 100 * (_LARGER - 1)
    write_whole(made[2], _README.format(name=name, file=file, at=_FAULT, percent=more))
    print("\n".join([*map(str, made), "", f"go on with: bondgraph check {made[0]}"]))
    return 0


def _log(compilation: Compilation) -> Log:
    """Ten seconds of the machine, driven to and fro, with noise, and with a fault."""
    from bondgraph.runtime.simulation.scenario import Course, Fault, Instrument, Scenario

    times = [0.01 * k for k in range(1001)]
    drive = tuple((t, 6.0 + 3.0 * math.sin(2.0 * t) + math.sin(9.0 * t)) for t in times)
    scenario = Scenario(
        "worn brush",
        duration=10.0,
        inputs={"U": Course(None, drive)},
        instruments={"current": Instrument(noise=0.005), "speed": Instrument(noise=0.2)},
        faults=(Fault("R", "*=", _LARGER, at=_FAULT, label="worn brush"),),
    )
    return compilation.simulate(scenario).log
