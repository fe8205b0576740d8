"""Threads of numeric libraries: for the small matrices of a watch they only wait for each other."""

from __future__ import annotations

import os
import sys

#: What they are told by, when they are loaded.
VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS")


def one() -> None:
    """Ask for one thread, if nobody has asked for another number and they are not loaded yet."""
    if "numpy" not in sys.modules:
        for name in VARIABLES:
            os.environ.setdefault(name, "1")
