"""What processes for texts are forked of: all that they need is loaded, and has been used once.

Loading this module does that; nobody else but the process that forks should.
"""

from __future__ import annotations

import gc

from bondgraph.cli.workbench.derived import derived
from bondgraph.cli.workbench.sketch import Job, opened, sketch
from bondgraph.cli.workbench.staged import staged
from bondgraph.runtime import threads

__all__ = ["staged"]

_MODEL = """\
bg 1

## A part, and what there is of its law in units.
model Part {
    port a : in electrical
    param R = 2 Ohm +- 5%
    a -> 1:loop
    loop {
        -[1]-> R:R
        -[2]-> C:c = 1 uF
        -> Df:i
    }
}

model Machine {
    input w : rad/s
    Se:U -> 1:main -> Part:part
    main -> I:L = 0.1 H
    main -> MGY:k { e1 = 0.1*w*f2; e2 = 0.1*w*f1 } -> R:load { e = 2*sqrt(abs(f)) }
    main -> Df:y
}
"""

threads.one()
_JOB = Job(0, "warm.bg", _MODEL)
for _derivative in (False, True):
    sketch(_JOB._replace(derivative=_derivative))
_compilation = opened(_JOB)
derived(_compilation, 0)
gc.collect()
gc.freeze()  # it is not looked through for garbage in each process anew
