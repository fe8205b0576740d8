"""Compile bond graphs into analytical redundancy relations and the code that evaluates them.

>>> import bondgraph
>>> c = bondgraph.compile(text='''bg 1
... model Circuit { param R = 2 Ohm; 1:loop { <- Se:U; -> R:R; -> Df:i } }
... ''')
>>> c.residuals
r1 = U - R*i
>>> c
Compilation(Circuit in <text>: 3 elements, 1 sensor, 1 residual)

Everything here is loaded when it is asked for.
"""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from bondgraph.backends.write import ForeignFiles
    from bondgraph.compilation import Compilation, compile
    from bondgraph.compile_options import Options
    from bondgraph.runtime.c_library import NativeError
    from bondgraph.runtime.diagnosis.tuning import Limit, Tuning
    from bondgraph.runtime.fleet.monitor_logs import Fleet, monitor
    from bondgraph.runtime.log import Log
    from bondgraph.runtime.simulation.integrate import SimulationError
    from bondgraph.runtime.simulation.scenario import (
        Controller,
        Course,
        Fault,
        Instrument,
        Plane,
        Sampling,
        Scenario,
    )
    from bondgraph.text.diagnostic import CompileError
    from bondgraph.text.source import Source

#: Where each name comes from: what users call, construct or catch.
_FROM = {
    "backends.write": ("ForeignFiles",),
    "compile_options": ("Options",),
    "compilation": ("Compilation", "compile"),
    "runtime.c_library": ("NativeError",),
    "runtime.diagnosis.tuning": ("Limit", "Tuning"),
    "runtime.fleet.monitor_logs": ("Fleet", "monitor"),
    "runtime.log": ("Log",),
    "runtime.simulation.integrate": ("SimulationError",),
    "runtime.simulation.scenario": (
        "Controller", "Course", "Fault", "Instrument", "Plane", "Sampling", "Scenario",
    ),
    "text.diagnostic": ("CompileError",),
    "text.source": ("Source",),
}  # fmt: skip

__all__ = [
    "Compilation",
    "CompileError",
    "Controller",
    "Course",
    "Fault",
    "Fleet",
    "ForeignFiles",
    "Instrument",
    "Limit",
    "Log",
    "NativeError",
    "Options",
    "Plane",
    "Sampling",
    "Scenario",
    "SimulationError",
    "Source",
    "Tuning",
    "compile",
    "monitor",
]
__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    for module, names in _FROM.items():
        if name in names:
            from importlib import import_module

            found = globals()[name] = getattr(import_module(f"bondgraph.{module}"), name)
            return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
