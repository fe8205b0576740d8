"""Options that several commands have, and how what they say is read."""

from __future__ import annotations

import math
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from bondgraph import Compilation, Options, compile
from bondgraph.cli import console
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.limits import RATE, TUNING_BYTES
from bondgraph.text.regular_file import check_regular

if TYPE_CHECKING:
    from typing import Unpack

    from bondgraph.pipeline import Form, OptionValues
    from bondgraph.runtime.diagnosis.tuning import Tuning

T = TypeVar("T", float, int)


def _number(kind: Callable[[str], T], name: str, good: Callable[[T], bool]) -> Callable[[str], T]:
    """Reads a number of some kind; argparse calls it by its name where it is another one."""

    def read(text: str) -> T:
        value = kind(text)
        if not good(value):
            raise ValueError
        return value

    read.__name__ = name
    return read


positive = _number(float, "positive number", lambda value: 0 < value < math.inf)
frequency = _number(float, f"number from {1 / RATE:g} to {RATE:g}", lambda v: 1 / RATE <= v <= RATE)
pace = _number(float, "positive number", lambda value: value > 0)
bits = _number(int, "number of bits from 1 to 52", lambda value: 1 <= value <= 52)
count = _number(int, "number above 0", lambda value: value >= 1)


def assigned(text: str) -> tuple[str, float]:
    """`NAME=VALUE`; raises ValueError for anything else."""
    name, _, number = text.rpartition("=")
    value = float(number)
    if not name or not math.isfinite(value):
        raise ValueError
    return name, value


assigned.__name__ = "NAME=VALUE"


def noise(text: str) -> tuple[str, float]:
    """`NAME=DEVIATION`, or the deviation of all sensors with an empty name."""
    name, value = assigned(text) if "=" in text else ("", float(text))
    if not 0 <= value < math.inf:
        raise ValueError
    return name, value


noise.__name__ = "[NAME=]DEVIATION"


def isolating(parser: ArgumentParser) -> None:
    """The option `--isolate`."""
    parser.add_argument(
        "--isolate",
        action="store_true",
        help="add the few residuals that tell faults apart as far as the sensors allow",
    )


def form(text: str) -> Form:
    """`derivative`, `observer`, or `observer:r1,r3`, which says what residuals are observers."""
    word, colon, names = text.partition(":")
    if word == "observer" and colon:
        return tuple(filter(None, names.split(",")))
    if text == "observer":
        return "observer"
    if text != "derivative":
        raise ValueError
    return "derivative"


form.__name__ = "form"


def setting(text: str) -> tuple[str, str]:
    """`NAME=VALUE` as a name and what TOML has for the value: a number, or a text with a unit."""
    name, _, value = (part.strip() for part in text.rpartition("="))
    if not name or not value:
        raise ValueError
    try:
        return name, repr(float(value))
    except ValueError:
        return name, _quoted(value)


setting.__name__ = "NAME=VALUE"


def _quoted(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def numbered(parser: ArgumentParser) -> None:
    """The options `--parameters` and `--set`."""
    parser.add_argument("--parameters", metavar="FILE.toml", help="other values of parameters, and"
                        " offsets of sensors, as `bondgraph fit` writes them")  # fmt: skip
    parser.add_argument("--set", metavar="NAME=VALUE", type=setting, action="append", default=[],
                        help="another value of a parameter, in SI or with a unit (R=1.2 kOhm);"
                        " may be repeated")  # fmt: skip


def model_of(args: Namespace, **options: Unpack[OptionValues]) -> Compilation:
    """The model of a command with `--parameters` and `--set`, which goes before the file."""
    from bondgraph.frontend.read import read
    from bondgraph.text.diagnostic import Report
    from bondgraph.text.source import Source

    compilation = compile(args.model, **options)
    sources = []
    if args.parameters:
        report = Report()
        sources.append(read(args.parameters, report))
        report.stop_on_error()
    sources += [Source("--set", f"parameters.{_quoted(n)} = {v}") for n, v in args.set]
    given: dict[str, float] = {}
    offsets: dict[str, float] = {}
    for source in filter(None, sources):
        numbers, off = compilation.numbers(source)
        given, offsets = given | numbers, offsets | off
    if not given and not offsets:
        return compilation
    return compilation.with_options(parameters=given, offsets=offsets)


def realised(parser: ArgumentParser, usual: Form | None = "derivative") -> None:
    """The options of `numbered`, and `--form`; `usual` is what it is where it is not given."""
    numbered(parser)
    parser.add_argument(
        "--form",
        metavar="derivative|observer[:NAMES]",
        type=form,
        default=usual,
        help="what a step is made of: filtered samples, or states that follow a sensor where a "
        f"residual, or one of those named, has such a form (default: {usual or 'both, compared'})",
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


def sampling(parser: ArgumentParser) -> None:
    """The arguments that say how the machine is sampled."""
    rate = Options().rate
    parser.add_argument("--rate", metavar="HZ", type=frequency, default=rate,
                        help=f"samples a second (default: {rate:g})")  # fmt: skip
    parser.add_argument("--bandwidth", metavar="RAD/S", type=frequency, default=None,
                        help="bandwidth of the filter (default: chosen from the rate)")  # fmt: skip
    parser.add_argument("--bits", metavar="N", type=bits, default=12,
                        help="resolution of the samples (default: 12)")  # fmt: skip


def signals(parser: ArgumentParser) -> None:
    """The arguments that say what the machine does and how well it is measured."""
    parser.add_argument("--noise", metavar="[NAME=]DEVIATION", type=noise, action="append",
                        default=[], help="standard deviation of the samples of a signal, without"
                        " a name of every sensor; may be repeated")  # fmt: skip
    parser.add_argument("--at", metavar="NAME=VALUE", type=assigned, action="append", default=[],
                        help="what a signal is (default: 0; an encoder: its speed); may be"
                        " repeated")  # fmt: skip
    parser.add_argument("--swing", metavar="NAME=AMPLITUDE", type=assigned, action="append",
                        default=[], help="how far a signal swings around that; may be"
                        " repeated")  # fmt: skip
    parser.add_argument("--frequency", metavar="HZ", type=positive, default=1.0,
                        help="of the swing (default: 1)")  # fmt: skip
    parser.add_argument("--kappa", metavar="K", type=positive, default=5.0,
                        help="standard deviations of noise below the threshold"
                        " (default: 5)")  # fmt: skip


def realising(args: Namespace, **options: Unpack[OptionValues]) -> Compilation:
    """The model of a command with `--isolate` and `--form`; raises Unknown for no residual."""
    own: Form = args.form or "derivative"
    options |= {"isolate": args.isolate, "form": own}
    compilation = model_of(args, **options)
    if not isinstance(own, str):
        names = [r.name for r in compilation.residuals]
        for name in own:
            if name not in names:
                raise console.Unknown(name, "no residual of the model", names)
    return compilation


def opened(args: Namespace, targets: tuple[str, ...] = Options().targets) -> Compilation:
    """The model of a command with the options of `sampling`, and those that add residuals."""
    decouple = tuple(dict.fromkeys(getattr(args, "decouple", ())))
    compilation = realising(
        args,
        rate=args.rate,
        bandwidth=args.bandwidth,
        resolution=2.0**-args.bits,
        targets=targets,
        decouple=decouple,
    )
    for fault in decouple:
        if fault not in compilation.graph.faults:
            raise console.Unknown(fault, "no fault of the model", compilation.graph.faults)
    return compilation


def read_tuning(path: str) -> Tuning:
    """The limits that `bondgraph tune` wrote."""
    from bondgraph.runtime.diagnosis.tuning import Tuning

    try:
        check_regular(path, TUNING_BYTES)
        with open(path, encoding="utf-8") as file:
            return Tuning.from_json(file.read())
    except (ValueError, UnicodeDecodeError) as error:
        raise Trouble(f"{path}: {error}; make it anew with `bondgraph tune`") from error


def serving(parser: ArgumentParser, port: int) -> None:
    """Where a page is served."""
    add = parser.add_argument
    add("--port", metavar="N", type=int, default=port,
        help=f"where the page is served; 0 for any that is free (default: {port})")  # fmt: skip
    add("--host", metavar="NAME", default="127.0.0.1",
        help="address to serve at (default: 127.0.0.1, this computer only)")  # fmt: skip
    add("--no-browser", action="store_true", help="do not open the page")
