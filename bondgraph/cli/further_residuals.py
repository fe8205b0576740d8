"""The options of a command that say which residuals there are, and what a step is made of."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from argparse import ArgumentParser


def isolating(parser: ArgumentParser) -> None:
    """The option `--isolate`."""
    parser.add_argument(
        "--isolate",
        action="store_true",
        help="add the few residuals that tell faults apart as far as the sensors allow",
    )


def realised(parser: ArgumentParser) -> None:
    """The option `--form`."""
    parser.add_argument(
        "--form",
        choices=("derivative", "observer"),
        default="derivative",
        help="what a step is made of: filtered samples, or states that follow a sensor where a "
        "residual has such a form (default: derivative)",
    )


def further(parser: ArgumentParser) -> None:
    """The options `--isolate` and `--decouple`."""
    isolating(parser)
    parser.add_argument(
        "--decouple",
        metavar="FAULT",
        action="append",
        default=[],
        help="add residuals that are free of this fault; may be repeated",
    )
