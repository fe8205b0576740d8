"""A residual program as code that can be loaded and run in this process."""

from __future__ import annotations

from bondgraph.ir.artifact import Artifact
from bondgraph.ir.program import Program
from bondgraph.text.tuples import NamedTuple


class Together(NamedTuple):
    """Residuals that start anew together, all that they read, and what of it is whole.

    By their numbers in the program. An encoder or a mode that has no value cannot say so in its
    own type, so whoever runs the code has to restart the block that reads it.
    """

    residuals: tuple[int, ...]
    whole: tuple[int, ...]
    reads: tuple[int, ...]


class Runnable(NamedTuple):
    """What it takes to run a program, in C and in Python.

    `c` are the files to compile, of which the compiler is given `main`; `stem` begins the names
    of its functions. `python` is the text of the module, in which `params`, `knowns` and
    `residuals` name what has the same place in the program.
    """

    program: Program
    abi: int
    stem: str
    c: tuple[Artifact, ...]
    main: str
    python: str
    params: tuple[str, ...]
    knowns: tuple[str, ...]
    residuals: tuple[str, ...]
    blocks: tuple[Together, ...]
