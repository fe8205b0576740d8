"""What a report assumes of the signals and their noise where nobody says it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bondgraph.cli.detect import situation_of
from bondgraph.cli.reporting.seen import Assumed

if TYPE_CHECKING:
    from argparse import Namespace

    from bondgraph.ir.program import Program


def assumed(args: Namespace, program: Program) -> Assumed:
    """The situation of the arguments, completed, and all of it in words.

    Without signals each swings by 1 around 1, in its unit; without noise it is that of samples of
    `--bits` over the range of each signal, a step over the square root of 12. A program that
    iterates gets constant signals: a second of samples would take it a minute.
    """
    given = situation_of(args, program)
    words = []
    signals = [k for k in program.knowns if k.kind != "mode"]
    if not (args.at or args.swing):
        ones = {k.path: 1.0 for k in signals}
        swing = {} if program.roots else ones
        given = given._replace(at=ones, swing=swing)
        moves = "be 1" if program.roots else "swing by 1 around 1"
        rhythm = "" if program.roots else f" at {given.frequency:g} Hz"
        words.append(
            f"Nothing was said of what the machine does: every signal is taken to {moves}, in its"
            f" own unit{rhythm} (`--at`, `--swing`). The sizes below compare faults and residuals;"
            " they are not those of a real run."
        )
    else:
        told = [f"{n} at {v:g}" for n, v in given.at.items()]
        told += [f"{n} swings by {v:g}" for n, v in given.swing.items()]
        words.append(f"Signals, as given: {', '.join(told)}, at {given.frequency:g} Hz; others 0.")
    sensors = [k for k in signals if k.kind == "sensor" and k.counts is None]
    if args.noise:
        told = [f"{n} {v:g}" for n, v in given.noise.items()]
        words.append(f"Noise, as given: standard deviation of {', '.join(told)}; white.")
    elif sensors:
        ranges = {k.path: _range(given.at.get(k.path, 0.0), given.swing.get(k.path, 0.0))
                  for k in sensors}  # fmt: skip
        size = 2.0**-args.bits / math.sqrt(12)
        given = given._replace(noise={name: size * r for name, r in ranges.items()})
        words.append(
            "Nothing was said of noise (`--noise`): every sensor has that of"
            f" {args.bits}-bit samples over its range here, white, a step over the square root of"
            " 12."
        )
    if any(k.counts is not None for k in signals):
        words.append("An encoder has the noise of its counts, evenly spread over one.")
    words.append(
        f"A change counts as seen where it moves the residual past its adaptive threshold and"
        f" {given.kappa:g} standard deviations of the filtered noise:"
        f" {program.rate:g} samples a second, a filter of {program.bandwidth:g} rad/s."
    )
    return Assumed(given, tuple(words))


def _range(at: float, swing: float) -> float:
    """From the least to the largest that a signal is, zero included; 1 where it is always zero."""
    least, most = min(0.0, at - abs(swing)), max(0.0, at + abs(swing))
    return most - least or 1.0
