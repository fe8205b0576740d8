"""A compiled model in use: drawn, simulated, fitted to logs, written to files, watched."""

from __future__ import annotations

import math
import os
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any

from bondgraph.compile_options import Options, checked
from bondgraph.pipeline import Pipeline
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.numerals import plural
from bondgraph.text.source import Source

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from typing import Self, Unpack

    from bondgraph.backends.drawing.scene import Look
    from bondgraph.backends.write import Change
    from bondgraph.compile_options import OptionValues
    from bondgraph.derivations import Derivations
    from bondgraph.ir.artifact import Artifact, BinaryArtifact
    from bondgraph.ir.program import Program
    from bondgraph.ir.runnable_code import Runnable
    from bondgraph.ir.signature_matrix import (
        DoubleFaults,
    )
    from bondgraph.picture import Picture
    from bondgraph.runtime.diagnosis.accepted_faults import AcceptedFaults
    from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
    from bondgraph.runtime.diagnosis.fitted import Fitted
    from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
    from bondgraph.runtime.diagnosis.tuning import Tuning
    from bondgraph.runtime.log import Log
    from bondgraph.runtime.monitoring.columns import Mapped
    from bondgraph.runtime.monitoring.engine import Engine
    from bondgraph.runtime.simulation.read_scenario import Numbers
    from bondgraph.runtime.simulation.run import Run
    from bondgraph.runtime.simulation.scenario import Scenario

#: Bonds of a model whose double faults are found within half a second or so.
_WATCHED = 200


class Compilation(Pipeline):
    """A model that is compiled as far as it is asked for, and what can be done with it.

    Its stages are those of the compiler, each one of the same source, model and options
    (`with_options` gives another compilation). Every stage raises `CompileError` with all
    diagnostics so far if the model is wrong there. Raises ValueError for an option that is no
    positive number, TypeError for names that are no sequence of names.

    >>> import bondgraph
    >>> c = bondgraph.compile("models/dc_motor.bg")
    >>> len(c.residuals)
    2
    >>> c
    Compilation(Motor in models/dc_motor.bg: 9 elements, 2 sensors, 2 residuals)
    """

    def __repr__(self) -> str:
        """Model, elements, sensors and residuals as far as they are known; computes nothing."""
        graph, found = vars(self).get("graph"), vars(self).get("_analysis")
        name, parts = self.model, []
        if graph is not None:
            elements = sum(node.common is None for node in graph.nodes)
            name = graph.name
            parts = [plural(elements, "element"), plural(len(graph.sensors), "sensor")]
        if found is not None:
            parts.append(plural(len(found[0].residuals), "residual"))
        if self.report.failed:
            parts.append(str(CompileError(tuple(self.report.diagnostics))))
        about = f"{name} in {self.source.path}" if name else self.source.path
        return f"Compilation({': '.join(filter(None, (about, ', '.join(parts))))})"

    def _repr_html_(self) -> str:
        """The drawing, the relations and the signatures, for a notebook."""
        parts = [self.drawing(), self.residuals._repr_html_(), self.signatures._repr_html_()]
        return "\n".join(parts)

    def drawing(
        self, derivative: bool = False, bare: bool = False, look: Look | None = None
    ) -> str:
        """The bond graph with its causal strokes, or with what keeps them from being placed.

        As SVG, one self-contained text; a `bare` one for inside of a page that has its colours.
        `look` says what else is shown, see `backends.drawing.scene`.
        """
        from bondgraph.backends.drawing.scene import Look

        chosen = look or Look()
        if self.conflicts:
            from bondgraph.backends.figure import draw_conflicts

            return draw_conflicts(self.graph, self.conflicts, self.graph.name, bare, chosen)
        from bondgraph.backends.figure import draw

        causal = self.derivative if derivative else self.integral
        return draw(causal, self.graph.name, bare, chosen)

    def scenario(self, path: str | os.PathLike[str]) -> Scenario:
        """Read a scenario file (docs/simulation.md) for this model.

        Raises `CompileError` if it is wrong or not there.
        """
        from bondgraph.frontend.read import read
        from bondgraph.runtime.simulation.read_scenario import read_scenario

        report = Report()
        source = read(os.fspath(path), report)
        found = None if source is None else read_scenario(source, self.graph, report)
        report.stop_on_error()
        assert found is not None
        return found

    def simulate(
        self,
        scenario: Scenario | str | os.PathLike[str],
        progress: Callable[[float], None] = lambda _: None,
        *,
        native: bool = True,
        tell: Callable[[str], None] | None = None,
    ) -> Run:
        """Run a scenario (or the file of one) on the virtual machine.

        A long run is compiled to C on its way, unless `native` is False. Where that fails it goes
        on in Python, which is told in one line to `tell` (a RuntimeWarning if there is none).

        Signals in SI units, at `run.log.time` in s: `run.log` as sensors read them, `run.truth`
        without noise, with the states. `progress` is told the share that is done, 0 to 1. Raises
        `CompileError` where scenario or model are wrong, `SimulationError` where the machine has
        no motion beyond some moment, KeyError for a parameter without a value.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> twelve = {"U": bondgraph.Course.constant(12.0)}
        >>> run = c.simulate(bondgraph.Scenario("step", duration=2.0, inputs=twelve))
        >>> f"{run.truth.columns['speed'][-1]:.1f} rad/s"
        '189.9 rad/s'
        """
        from bondgraph.backends.rates import rate_file, rate_language
        from bondgraph.runtime.c_library import warn
        from bondgraph.runtime.simulation.native_machine import Coding
        from bondgraph.runtime.simulation.run import simulate
        from bondgraph.runtime.simulation.scenario import Scenario

        chosen = scenario if isinstance(scenario, Scenario) else self.scenario(scenario)
        coding = Coding(rate_language(), rate_file) if native else None
        biased = self.with_biases(chosen)
        run = simulate(self.equations, self.integral, biased, progress, coding, tell or warn)
        for item in self.graph.inputs:
            if item.offset and item.name in run.log.columns:
                run.log.columns[item.name] = run.log.columns[item.name] + item.offset
        return run

    def with_biases(self, scenario: Scenario) -> Scenario:
        """A scenario whose instruments have the offsets of sensors (`Options`) as biases too."""
        from bondgraph.runtime.simulation.scenario import Instrument

        found = dict(scenario.instruments)
        for sensor in self.graph.sensors:
            if sensor.offset and sensor.same_as is None:
                own = found.get(sensor.name, Instrument())
                found[sensor.name] = own._replace(bias=own.bias + sensor.offset)
        return scenario._replace(instruments=found)

    def plot(
        self, runs: Run | Mapping[str, Run], signals: Sequence[str] = (), title: str = ""
    ) -> Picture:
        """A picture of a run, or of several by label: a strip for each signal, a line for each run.

        `signals` are columns of the log or of the truth (states, true values), without any all of
        the log. A notebook shows the picture; `write(path)` makes a .png, .svg, .pdf or .html of
        it. Raises KeyError for what is no signal, `Trouble` without matplotlib.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> run = c.simulate(bondgraph.Scenario("still", duration=0.1))
        >>> c.plot({"at rest": run}, ["speed"])
        <picture of speed: at rest>
        """
        from collections.abc import Mapping

        from bondgraph.picture import Picture

        found = runs if isinstance(runs, Mapping) else {"": runs}
        return Picture(f"{self.graph.name}{title and f': {title}'}", found, tuple(signals))

    def numbers(self, source: Source) -> Numbers:
        """The numbers of a TOML text for this model, as `bondgraph fit` writes them.

        In SI. Raises `CompileError` if it is wrong.
        """
        from bondgraph.runtime.simulation.read_scenario import read_numbers

        report = Report()
        found = read_numbers(source, self.graph, report)
        report.stop_on_error()
        return found

    def fit(
        self,
        logs: Mapping[str, Log],
        free: Sequence[str] | None = None,
        noise: Mapping[str, float] | None = None,
        columns: Mapping[str, Mapped] | None = None,
        progress: Callable[[float], None] = lambda _: None,
        *,
        operating: str | None = None,
    ) -> Fitted:
        """Fit parameters to logs of the healthy machine, by the names of these (docs/fit.md).

        `free` are names of parameters, without it those with a tolerance, or else all; the name of
        a sensor or an input stands for its offset. `noise` are
        standard deviations of signals in their unit, where they are known. Only samples for which
        `operating` holds count, an expression over columns (docs/logs.md). The filter has the
        bandwidth of the options, else that of the rate and length of the logs or a faster one, if
        this tells more. Raises ValueError for
        logs that are too short and for what is no parameter of a residual, `LogError` for a log
        that lacks a signal.

        >>> import bondgraph, numpy
        >>> c = bondgraph.compile(text="bg 1\\nmodel M { param R = 2 Ohm; Se:U -> 1:i; i -> R:R;"
        ...                            " i -> Df:y }")
        >>> t, draw = numpy.arange(5000) / 1000, numpy.random.default_rng(2)
        >>> columns = {"U": numpy.sin(9 * t), "y": numpy.sin(9 * t) / 3}
        >>> columns["y"] = columns["y"] + 0.01 * draw.standard_normal(5000)
        >>> found = c.fit({"run": bondgraph.Log(t, columns, {}, {})})
        >>> R = found.parameters[0]
        >>> abs(R.value - 3) < R.interval < 0.05
        True
        """
        from bondgraph.runtime.diagnosis.fit_filter import fit_by_filter
        from bondgraph.runtime.diagnosis.healthy_tolerances import with_room
        from bondgraph.runtime.diagnosis.parameter_fit import fit, fittable
        from bondgraph.runtime.diagnosis.tuning import bandwidth_for, tuned_bandwidth
        from bondgraph.runtime.monitoring.whole_logs import stretches

        engine, model = self.engine(), self.diagnosis_model
        chosen = fittable(engine, model.faults, model.tolerances, free)
        pieces = stretches(engine, logs.items(), columns, operating)
        told = engine, pieces, chosen, model, noise or {}
        bandwidth, rate = self.options.bandwidth, 1.0 / engine.sample_time
        if bandwidth is not None:
            found = fit(*told, progress)
            watched = {bandwidth}
        else:
            lengths = [len(piece.samples) for _, piece in pieces]
            usual = bandwidth_for(rate, sum(lengths), lengths)
            found = fit_by_filter(*told, usual, progress)
            watched = {bandwidth_for(rate, log.rows) for log in logs.values()}
            watched |= {tuned_bandwidth(rate, log.rows) for log in logs.values()}
            watched.add(found.bandwidth)
        return with_room(found, engine, pieces, model, watched)

    def derivation(self, name: str) -> Derivations:
        """How a residual came about, replayed with SymPy (docs/derivations.md); KeyError else.

        Every step is done from the equations of the bond graph, in the order of the compiler.

        >>> import bondgraph
        >>> d = bondgraph.compile("models/dc_motor.bg").derivation("r1")
        >>> d.complete, [step.move for step in d[0].steps][-3:]
        (True, ['solve', 'differentiate', 'close'])
        """
        from bondgraph.derivations import Derivations
        from bondgraph.passes.relation.derive import derive

        shown = self.residuals[name].residual
        residual = next(r for r in self._analysis[0].residuals if r.name == name)
        return Derivations(self.graph, derive(residual, self.graph, shown))

    def minimal_diagnoses(
        self, fired: Iterable[str], silent: Iterable[str] = (), at_most: int | None = None
    ) -> tuple[tuple[str, ...], ...]:
        """The minimal sets of faults that explain the residuals that have `fired`.

        Several faults at once are allowed, up to `at_most`. Residuals named in `silent` clear the
        faults they see; leave that out where faults may cancel each other. Raises KeyError for an
        unknown residual.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> c.minimal_diagnoses(["r1", "r2"], at_most=1)
        (('k',), ('current',), ('speed',))
        >>> c.minimal_diagnoses(["r2"], silent=["r1"])
        (('J',), ('f',), ('load',))
        """
        from bondgraph.structural.hitting import diagnoses

        matrix = self.signatures
        return diagnoses(matrix.sees, fired, silent, at_most)

    def changes(
        self,
        folder: str | os.PathLike[str],
        targets: Sequence[str] | None = None,
        extras: Sequence[str] | None = None,
    ) -> tuple[Change, ...]:
        """What `write` with the same arguments would do, file by file, without doing it.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> {change.what for change in c.changes("generated/dc_motor")}
        {'same'}
        """
        from bondgraph.backends.write import changes

        if not self.residuals:
            return ()
        return changes(self._chosen(targets, extras), folder)

    def write(
        self,
        folder: str | os.PathLike[str],
        targets: Sequence[str] | None = None,
        extras: Sequence[str] | None = None,
    ) -> tuple[str, ...]:
        """Write the files below `folder`, all or none; their paths, with the folder.

        `targets` are the languages, `extras` what is written beside the code; without them those of
        the options. A model without redundancy
        has no files. Files of an earlier call that are as they were written are replaced. Raises
        `ForeignFiles`, with nothing written, where any other file is in the way, OSError if the
        disk refuses, ValueError for a target that is not there.

        >>> import bondgraph, os, tempfile
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     paths = c.write(folder, targets=["python"])
        >>> [os.path.basename(path) for path in paths[:3]]
        ['motor.py', 'README.md']
        """
        from bondgraph.backends.write import write

        if not self.residuals:
            return ()
        return write(self._chosen(targets, extras), folder)

    def _chosen(
        self, targets: Sequence[str] | None, extras: Sequence[str] | None
    ) -> tuple[Artifact | BinaryArtifact, ...]:
        """The files in these languages with these extras; those of the options without them."""
        if targets is None and extras is None:
            return self.artifacts
        given: dict[str, Any] = {"targets": targets, "extras": extras}
        asked = {name: value for name, value in given.items() if value is not None}
        chosen = checked(self.options._replace(**asked))
        return self._emitted(chosen.targets, chosen.extras)

    @cached_property
    def runnable_programs(self) -> tuple[Runnable, Runnable | None]:
        """The code of residuals and thresholds, to be loaded and run here; None without these."""
        from bondgraph.backends.runnable import runnable

        bounds = self._bounds_of(self._watched_thresholds)
        return runnable(self.program_with_readings), None if bounds is None else runnable(bounds)

    @property
    def _watched_thresholds(self) -> Program | None:
        """The thresholds of a machine whose unknown starts the samples tell, as a watch does."""
        from bondgraph.runtime.diagnosis.remembered import memories

        graph, residuals, _ = self._shown
        if not any(v.tolerance and not v.fault for v in graph.values):
            return self.thresholds
        found = memories(graph, residuals, self.program)
        unknown = {name: 0.0 for memory in found for name in memory.unknown}
        return self._thresholds(graph.with_tolerances(unknown)) if unknown else self.thresholds

    def engine(
        self, native: bool | None = None, tell: Callable[[str], None] | None = None
    ) -> Engine:
        """What runs the residuals and thresholds over arrays of samples, at nominal parameters.

        In C compiled here, or in Python (`native` False, or None and no compiler, which is told
        in one line to `tell`). Raises `NativeError` if it must be C and cannot be.

        >>> import bondgraph
        >>> engine = bondgraph.compile("models/dc_motor.bg").engine()
        >>> [k.path for k in engine.signals]
        ['load', 'U', 'current', 'speed']
        >>> batch = engine.run([[0.0, 6.0, 2.0, 0.0]] * 1000)  # 6 V and 2 A at rest
        >>> batch.valid[-1].tolist(), batch.value.shape
        ([True, True], (1000, 2))
        """
        from bondgraph.runtime.monitoring.native import start

        return start(*self.runnable_programs, native=native, tell=tell)

    @cached_property
    def diagnosis_model(self) -> DiagnosisModel:
        """What a diagnosis has to know of the machine beside its residuals."""
        from bondgraph.runtime.diagnosis.healthy import diagnosis_model

        def doubles() -> DoubleFaults:
            """Asked for before a machine is watched, which cannot wait for long."""
            from bondgraph.ir.signature_matrix import DoubleFaults

            small = len(self.graph.bonds) <= _WATCHED
            return self.double_faults if small else DoubleFaults((), (), "the model is too large")

        own = *self._shown, self.program_with_readings
        return diagnosis_model(*own, self.mode_signatures, doubles)

    def diagnosis(self, engine: Engine, tuning: Tuning | None = None) -> Diagnosis:
        """What says verdicts about the residuals of an engine of this model.

        Without a `tuning` (`bondgraph tune`) it learns the noise from the first seconds. Raises
        ValueError for a tuning of another model, rate or bandwidth.

        >>> import bondgraph, numpy
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> engine = c.engine(native=False)
        >>> diagnosis = c.diagnosis(engine)
        >>> time, samples = numpy.arange(2000) / 1000, numpy.tile([0.0, 6.0, 0.3, 0.2], (2000, 1))
        >>> for verdict in diagnosis.update(time, engine.run(samples), samples):
        ...     print(f"{verdict.event} at {verdict.time:.1f} s: {verdict.message[:33]}")
        warm-up at 0.5 s: the noise of r1 and r2 is learned
        warm-up at 1.9 s: r1 and r2 are watched from now on
        """
        from bondgraph.runtime.diagnosis.diagnosis import Diagnosis

        if tuning is not None:
            rate = 1.0 / engine.sample_time
            if abs(tuning.rate / rate - 1) > 1e-9:
                raise ValueError(
                    f"it is for {tuning.rate:.9g} samples a second, and these come at {rate:.9g}"
                    f" (`--rate {tuning.rate:.9g}` takes them at that)"
                )
            self._check_model(tuning)
            if abs(tuning.bandwidth / engine.bandwidth - 1) > 1e-9:
                raise ValueError(f"it is for a filter of {tuning.bandwidth:g} rad/s")
        return Diagnosis(engine, self.diagnosis_model, tuning)

    def accepting(
        self, engine: Engine, tuning: Tuning | None = None, after: float = math.inf
    ) -> AcceptedFaults:
        """As `diagnosis`, which goes on with a fault once it has been named for `after` seconds.

        Or when it is told to (`accept`), and says the next one then.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> watch = c.accepting(c.engine(native=False))
        >>> watch.accept(1.0), watch.accepted
        ([], ())
        """
        from bondgraph.runtime.diagnosis.accepted_faults import AcceptedFaults
        from bondgraph.runtime.diagnosis.diagnosis import Diagnosis

        self.diagnosis(engine, tuning)  # raises what there is to raise

        def made(own: Engine, model: DiagnosisModel) -> Diagnosis:
            return Diagnosis(own, model, tuning)

        return AcceptedFaults(engine, self.diagnosis_model, made, after)

    def tuned(self, tuning: Tuning) -> Self:
        """The same with the residuals and the filter of a tuning, and its limits in the code.

        Raises ValueError for a tuning of another model, of other options, parameters or rate.
        """
        own = self
        if tuning.model != self.program.digest:
            isolate, form = tuning.residuals(self.options.isolate, self.options.form)
            own = self.with_options(isolate=isolate, form=form)
        own._check_model(tuning)
        return own.with_options(bandwidth=tuning.bandwidth, tuning=tuning)

    def _check_model(self, tuning: Tuning) -> None:
        """Raises ValueError for a tuning of other residuals."""
        if tuning.model == self.program.digest:
            return
        residuals = "isolate", "form"
        if any(getattr(tuning, name) != getattr(self.options, name) for name in residuals):
            raise ValueError(
                f"it is of the residuals with isolate={tuning.isolate}, form={tuning.form!r}"
            )
        raise ValueError("it is of another model, or of other options or parameters")


def compile(
    path: str | os.PathLike[str] | None = None,
    model: str | None = None,
    *,
    text: str | None = None,
    **options: Unpack[OptionValues],
) -> Compilation:
    """Open a model for compilation, in the file at `path`, or in a `text`.

    A path may name the model: `robot.bg:Drive`. A text needs no path; one says what it is called
    in messages, and beside which files its imports are. Options are those of `Options`: `rate`,
    `bandwidth`, `resolution`, `targets`, `seed`, `decouple`, `isolate`, `form`, `open_ports`,
    `parameters`, `offsets`, `tolerances`, `extras`, `libm`, `real`, `ranges`, `costs`.
    Nothing is computed before a stage is asked for. Raises `CompileError` if the file cannot be
    read, TypeError for an unknown option, ValueError for a number that is not positive.

    >>> import bondgraph
    >>> bondgraph.compile("models/dc_motor.bg", rate=500.0)
    Compilation(models/dc_motor.bg)
    >>> c = bondgraph.compile(text="bg 1\\nmodel M { 1:j { <- Se:U; -> R:r = 2; -> Df:i } }")
    >>> c.residuals["r1"]
    <r1: U - 2*i>
    """
    from bondgraph.frontend.read import decode, read

    import_module("bondgraph.notation.line")  # in Python, nodes of a model are looked at
    report = Report()
    if text is not None:
        name = "<text>" if path is None else os.fspath(path)
        source = decode(name, text.encode(errors="surrogatepass"), report)
    elif path is None:
        raise TypeError("compile needs the path of a model file, or a text=")
    else:
        name = os.fspath(path)
        if "\n" in name:
            raise TypeError("a path has one line; for a model in a string say compile(text=...)")
        if model is None and not os.path.exists(name) and ":" in os.path.basename(name):
            name, _, model = name.rpartition(":")
        source = read(name, report)
    if source is None:
        raise CompileError(tuple(report.diagnostics))
    return Compilation(source, model, Options(**options))
