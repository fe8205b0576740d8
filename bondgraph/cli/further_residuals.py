"""The options of a command that ask for residuals beyond those of the first elimination."""

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
