"""How far a residual may be from zero while the machine is well, as code on board has it, and from
which size on it shows a fault."""

from __future__ import annotations

from bondgraph.text.tuples import NamedTuple


class ResidualLimit(NamedTuple):
    """Of one residual, in its unit: where it stands, and how far off that is too far.

    A sample is too far out by more than `level`. A row of samples counts in deviations of noise
    that adds up: `unit` is one over that. `loud` times the square of what is too much, less
    `drift`, is by how much more probable twice the noise makes it. A sum above `height` is a fault.
    Off by no more than `bound` is right within the tolerances of parameters, where nobody tells how
    much that is now.
    """

    mean: float
    level: float
    unit: float
    loud: float
    drift: float
    height: float
    bound: float


class ShownSize(NamedTuple):
    """From which size on a residual shows a fault: it `least` may go into alarm, it is `sure` to.

    Beside the smallest size with which the fault is sure to show in any residual. Infinite where
    the residual never did.
    """

    least: float
    sure: float


#: That of a residual of which nothing is known: nothing is too far.
NEVER = ResidualLimit(0.0, 1e30, 0.0, 0.0, 0.5, 1e30, 0.0)
ROW = 3.0  # time constants of the filter: so far apart are rows of samples
OVERSHOOT = 1.166  # of the mean of sums over their height, to either side (Siegmund, 1985)
SHARE = 1.0 / 3.0  # of the height, that a single row adds at most to how loud it is
