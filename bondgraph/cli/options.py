"""Options that several commands have, and how what they say is read."""

from __future__ import annotations

import math
import re
from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from bondgraph import Compilation, Options, compile
from bondgraph.cli import console
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.limits import RATE, TUNING_BYTES
from bondgraph.text.regular_file import check_regular

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from typing import Unpack

    from bondgraph.compile_options import OptionValues
    from bondgraph.ir.graph import BondGraph
    from bondgraph.ir.residuals import Form
    from bondgraph.ir.unit import Unit
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


class Amount(float):
    """A number in SI that was written with a unit, or without one."""

    unit: Unit | None = None


def amount(text: str) -> Amount:
    """`4`, `4 s` or `4s` in SI; raises ValueError for anything else.

    >>> amount("4 ms"), amount("4 ms").unit.text, amount("1e3").unit
    (0.004, 'ms', None)
    """
    found = _AMOUNT.fullmatch(text.strip())
    if found is None:
        raise ValueError
    number, spelled = found.groups()
    if not spelled:
        return Amount(number)
    from bondgraph.library.units import parse_unit

    unit = parse_unit(spelled)
    if unit is None:
        raise ValueError
    value = Amount(float(number) * unit.factor)
    value.unit = unit
    return value


_AMOUNT = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?inf|nan)\s*(\D.*)?")


def quantity(
    unit: str, good: Callable[[float], bool], limits: str = "above 0"
) -> Callable[[str], float]:
    """Reads a number in a unit, or with a unit of the same dimension: `4`, `"4 s"`, `"4 min"`.

    Turns are 2 pi radians where an angular frequency is wanted in rad/s; a frequency in Hz is not
    taken in radians.
    """

    def read(text: str) -> float:
        from bondgraph.library.units import parse_unit

        value = amount(text)
        wanted = parse_unit(unit)
        assert wanted is not None
        number, own = float(value), value.unit
        if own is not None:
            turning = "Hz" in own.text
            if own.dimension != wanted.dimension or (unit == "Hz" and not turning):
                raise ValueError
            if unit == "rad/s" and turning:
                number *= 2.0 * math.pi
        if not good(number):
            raise ValueError
        return number

    read.__name__ = f"number {limits}, in {unit} or with a unit,"
    return read


def _sampled(value: float) -> bool:
    return 1.0 / RATE <= value <= RATE


positive = _number(float, "positive number", lambda value: 0 < value < math.inf)
seconds = quantity("s", lambda value: 0 < value < math.inf)
hertz = quantity("Hz", lambda value: 0 < value < math.inf)
sample_rate = quantity("Hz", _sampled, f"from {1 / RATE:g} to {RATE:g}")
bandwidth = quantity("rad/s", _sampled, f"from {1 / RATE:g} to {RATE:g}")
pace = _number(float, "positive number", lambda value: value > 0)
bits = _number(int, "number of bits from 1 to 52", lambda value: 1 <= value <= 52)
count = _number(int, "number above 0", lambda value: value >= 1)


def assigned(text: str) -> tuple[str, Amount]:
    """`NAME=VALUE`, the value in SI or with a unit; raises ValueError for anything else."""
    name, _, number = text.rpartition("=")
    value = amount(number)
    if not name or not math.isfinite(value):
        raise ValueError
    return name, value


def commanded(text: str) -> tuple[str, Amount | bool]:
    """As `assigned`; of a boolean input the value may be `true` or `false`."""
    name, _, word = text.rpartition("=")
    if name and word in ("true", "false"):
        return name, word == "true"
    return assigned(text)


assigned.__name__ = commanded.__name__ = "NAME=VALUE"


def check_units(graph: BondGraph, given: Iterable[tuple[str, Amount]]) -> None:
    """Raise `Trouble` where a signal was given in a unit of another dimension.

    What is said of an encoder, which counts angles or lengths, may be of these or of their speed.
    """
    from bondgraph.ir.unit import times
    from bondgraph.library.units import parse_unit

    known = {s.name: (s.dimension, s.unit, bool(s.counts)) for s in graph.sensors}
    known |= {i.name: (i.dimension, i.unit, False) for i in graph.inputs}
    per_second = parse_unit("1/s")
    assert per_second is not None
    for name, value in given:
        dimension, unit, encoder = known.get(name, (None, "", False))
        if value.unit is None or dimension is None:
            continue
        fitting = [dimension]
        if encoder:
            fitting.append(times(dimension, per_second.dimension))
        if value.unit.dimension not in fitting:
            raise Trouble(f"`{name}` is in {unit or 'no unit'}, not in {value.unit.text}")


def check_read(graph: BondGraph, given: Iterable[str], read: Sequence[str]) -> None:
    """Raise `Unknown` for a name that no signal has, `Trouble` for one that no residual reads."""
    there = [s.name for s in graph.sensors] + [i.name for i in graph.inputs if not i.mode]
    for name in given:
        if name not in read and name in there:
            raise Trouble(f"no residual reads `{name}`")
        if name not in read:
            raise console.Unknown(name, "no signal that the residuals read", read)


def noise(text: str) -> tuple[str, Amount]:
    """`NAME=DEVIATION`, or the deviation of all sensors with an empty name, which has no unit."""
    name, value = assigned(text) if "=" in text else ("", Amount(text))
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
        return name, quoted(value)


setting.__name__ = "NAME=VALUE"


def quoted(text: str) -> str:
    """A text as TOML has it."""
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def numbered(parser: ArgumentParser) -> None:
    """The options `--parameters` and `--set`."""
    parser.add_argument("--parameters", metavar="FILE.toml",
                        help="other values of parameters, with tolerances and offsets of sensors,"
                        " as `bondgraph fit` writes them")  # fmt: skip
    parser.add_argument("--set", metavar="NAME=VALUE", type=setting, action="append", default=[],
                        help="another value of a parameter, in SI or with a unit (R=1.2 kOhm);"
                        " may be repeated")  # fmt: skip


def numbers_again(args: Namespace) -> list[str]:
    """`--parameters` and `--set` as words of another command.

    >>> numbers_again(Namespace(parameters=None, set=[setting("R=1.2 kOhm"), setting("L=2")]))
    ['--set', 'R=1.2 kOhm', '--set', 'L=2.0']
    """
    import tomllib

    found = ["--parameters", args.parameters] if args.parameters else []
    for name, value in args.set:
        found += ["--set", f"{name}={tomllib.loads(f'is = {value}')['is']}"]
    return found


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
    sources += [Source("--set", f"parameters.{quoted(n)} = {v}") for n, v in args.set]
    known = [compilation.numbers(source) for source in filter(None, sources)]
    if not any(any(numbers) for numbers in known):
        return compilation
    three = [(n.parameters, n.offsets, n.tolerances) for n in known]
    given, offsets, tolerances = (
        {name: value for one in own for name, value in one.items()}
        for own in zip(*three, strict=True)
    )
    return compilation.with_options(parameters=given, offsets=offsets, tolerances=tolerances)


def fitted_bandwidth(args: Namespace, compilation: Compilation) -> float | None:
    """That of the filter with which the numbers of `--parameters` were fitted, if it is faster than
    the usual one."""
    from bondgraph.frontend.read import read
    from bondgraph.text.diagnostic import Report

    source = read(args.parameters, Report()) if args.parameters else None
    return None if source is None else compilation.numbers(source).bandwidth


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
    parser.add_argument("--rate", metavar="HZ", type=sample_rate, default=rate,
                        help=f"samples a second (default: {rate:g})")  # fmt: skip
    parser.add_argument("--bandwidth", metavar="RAD/S", type=bandwidth, default=None,
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
    parser.add_argument("--frequency", metavar="HZ", type=hertz, default=1.0,
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


def tuning_of(args: Namespace) -> Tuning | None:
    """The limits of `--tuning`, if it is given: for the residuals that they are of, from now on.

    Nobody has to say again with what `--isolate` and `--form` they were made.
    """
    from bondgraph.runtime.diagnosis.tuning import Tuning

    path = args.tuning
    if not path:
        return None
    try:
        check_regular(path, TUNING_BYTES)
        with open(path, encoding="utf-8") as file:
            tuning = Tuning.from_json(file.read())
    except (ValueError, UnicodeDecodeError) as error:
        raise Trouble(f"{path}: {error}; make it anew with `bondgraph tune`") from error
    args.isolate, args.form = tuning.residuals(args.isolate, args.form)
    return tuning


def announced(said: str, address: str, no_browser: bool) -> None:
    """Say where a page is, and show it unless that is not wanted."""
    print(f"{said}; look at {address}, stop with ^C", flush=True)
    if not no_browser:
        import webbrowser

        webbrowser.open(address)


def serving(parser: ArgumentParser, port: int) -> None:
    """Where a page is served."""
    add = parser.add_argument
    add("--port", metavar="N", type=int, default=port,
        help=f"where the page is served; 0 for any that is free (default: {port})")  # fmt: skip
    add("--host", metavar="NAME", default="127.0.0.1",
        help="address to serve at (default: 127.0.0.1, this computer only)")  # fmt: skip
    add("--no-browser", action="store_true", help="do not open the page")
