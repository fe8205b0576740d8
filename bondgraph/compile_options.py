"""What a compilation may be asked for beyond the model, and what none can be asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from bondgraph.ir.residuals import Form
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.limits import RATE
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import TypedDict

    from bondgraph.runtime.diagnosis.tuning import Tuning

#: The least and the largest value of a signal, in its unit.
Range = tuple[float, float]


class Options(NamedTuple):
    """What a compilation may be asked for beyond the model.

    `rate` in samples a second, `bandwidth` of the residual filter in rad/s (None: chosen from the
    rate), `resolution` the relative size below which a term cannot be seen (12 bits; 0: each is
    seen), `targets` the languages to emit, `seed` of the random points that the exact verification
    uses, `decouple` the faults that further relations are to be free of. With `isolate` there are
    further relations that tell apart what the sensors allow to be told apart.
    `form` says how a residual has what a derivative is needed for: from filtered samples
    (`derivative`), or from states that it follows (`observer`), where it has such a form; a
    sequence of names says which residuals are observers.
    With `open_ports` the model is a part of a machine: its ports may be left without a bond.
    `parameters` are numbers in SI, by name, that take the place of those in the model: a dict, or
    pairs of names and numbers. `offsets` are by how much samples of sensors and inputs are too
    large, by name, in their units: what reads a log takes them off, `simulate` puts them on.
    `tolerances` are relative, by name, and take the place of those in the model too.
    `tuning` has the limits that the code is to have for its `diagnose`; see `Compilation.tuned`.
    `extras` are files beside the code: `tests`, `exact`, `example`, `qemu`, `zephyr`, `espidf`,
    `arduino`, `ros2`, `misra`.
    With `libm` step calls tanh of the mathematical library, else one that is 1e-8 near it.
    With `real` fixed C is in whole numbers of 32 bits, for samples in `ranges`: pairs of numbers in
    their units, by name.
    With `costs` the README says what the C costs on each core whose compiler is here.
    """

    rate: float = 1000.0
    bandwidth: float | None = None
    resolution: float = 2.0**-12
    targets: tuple[str, ...] = ("c", "python")
    seed: int = 1
    decouple: tuple[str, ...] = ()
    isolate: bool = False
    form: Form = "derivative"
    open_ports: bool = False
    parameters: Mapping[str, float] | tuple[tuple[str, float], ...] = ()
    offsets: Mapping[str, float] | tuple[tuple[str, float], ...] = ()
    tolerances: Mapping[str, float] | tuple[tuple[str, float], ...] = ()
    tuning: Tuning | None = None
    extras: tuple[str, ...] = ()
    libm: bool = False
    real: Literal["double", "fixed"] = "double"
    ranges: Mapping[str, Range] | tuple[tuple[str, Range], ...] = ()
    costs: bool = False


if TYPE_CHECKING:

    class OptionValues(TypedDict, total=False):
        """Options as keyword arguments; those that are left out stay as they are."""

        rate: float
        bandwidth: float | None
        resolution: float
        targets: tuple[str, ...]
        seed: int
        decouple: tuple[str, ...]
        isolate: bool
        form: Form
        open_ports: bool
        parameters: Mapping[str, float] | tuple[tuple[str, float], ...]
        offsets: Mapping[str, float] | tuple[tuple[str, float], ...]
        tolerances: Mapping[str, float] | tuple[tuple[str, float], ...]
        tuning: Tuning | None
        extras: tuple[str, ...]
        libm: bool
        real: Literal["double", "fixed"]
        ranges: Mapping[str, Range] | tuple[tuple[str, Range], ...]
        costs: bool


class WrongOption(ValueError, Trouble):
    """A number that no compilation can be asked for; a command that has it of a log says so."""


def checked(options: Options) -> Options:
    """The options, with tuples for lists; raises ValueError or TypeError for what none can be."""
    for name in ("rate", "bandwidth"):
        value = getattr(options, name)
        if value is not None and not 1.0 / RATE <= value <= RATE:
            message = f"{name} must be from {1.0 / RATE:g} to {RATE:g}, not {value:g}"
            raise WrongOption(f"{message}; of a log, see that the unit of its times is right")
    if not 0.0 <= options.resolution < float("inf"):  # 0: each term is seen
        raise WrongOption(f"resolution must be a positive number, not {options.resolution!r}")
    form = options.form
    if isinstance(form, str) and form not in ("derivative", "observer"):
        raise ValueError(f"form is derivative, observer or names of residuals, not {form!r}")
    if options.real not in ("double", "fixed"):
        raise ValueError(f"real is double or fixed, not {options.real!r}")
    ranges = {str(n): (float(a), float(b)) for n, (a, b) in dict(options.ranges).items()}
    for name, (low, high) in ranges.items():
        if not -float("inf") < low < high < float("inf"):
            raise WrongOption(f"the range of {name} must rise, not go from {low:g} to {high:g}")
    if options.real == "fixed":
        _check_fixed(options)
    for name in ("targets", "decouple", "extras"):
        value = getattr(options, name)
        if isinstance(value, str):
            raise TypeError(f"{name} is a sequence of names: [{value!r}]")
    numbers, offsets, tolerances = (
        {str(name): float(value) for name, value in dict(given).items()}
        for given in (options.parameters, options.offsets, options.tolerances)
    )
    for name, value in (*numbers.items(), *offsets.items(), *tolerances.items()):
        if not abs(value) < float("inf"):
            raise ValueError(f"{name} must be a finite number, not {value!r}")
    for name, value in tolerances.items():
        if value < 0.0:
            raise ValueError(f"the tolerance of {name} must not be negative, as {value!r} is")
    return options._replace(
        parameters=tuple(numbers.items()),
        offsets=tuple(offsets.items()),
        tolerances=tuple(tolerances.items()),
        targets=tuple(options.targets),
        extras=tuple(options.extras),
        decouple=tuple(options.decouple),
        ranges=tuple(ranges.items()),
        form=form if isinstance(form, str) else tuple(form),
    )


def _check_fixed(options: Options) -> None:
    """What there is not in whole numbers yet; raises `WrongOption`."""
    for name in options.extras:
        if name != "misra":
            raise WrongOption(f"--with {name} is for double: leave --real fixed out")
    if options.libm:
        raise WrongOption("--libm calls a function of double: leave --real fixed out")
