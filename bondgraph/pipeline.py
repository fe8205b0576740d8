"""The order of the compiler, written once: from a source to the files, one stage a property."""

from __future__ import annotations

import math
import os
from functools import cached_property
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeVar

from bondgraph.compile_options import Options, checked
from bondgraph.text.diagnostic import CompileError, Report, Trouble
from bondgraph.text.numerals import plural
from bondgraph.text.renamed import by_new_name
from bondgraph.text.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence
    from typing import Unpack

    from bondgraph.backends.decision import Tuned
    from bondgraph.backends.drawing.scene import Look
    from bondgraph.backends.write import Change
    from bondgraph.compile_options import OptionValues
    from bondgraph.derivations import Derivations
    from bondgraph.exact.plant import Plant
    from bondgraph.exact.verification import Verification
    from bondgraph.ir.artifact import Artifact, BinaryArtifact
    from bondgraph.ir.causal import CausalGraph, Conflict
    from bondgraph.ir.equation_system import EquationSystem
    from bondgraph.ir.fixed_program import FixedProgram
    from bondgraph.ir.graph import BondGraph
    from bondgraph.ir.program import Program
    from bondgraph.ir.residuals import Form, Observer, ReducedSystem, ResidualSet
    from bondgraph.ir.runnable_code import Runnable
    from bondgraph.ir.signature_matrix import (
        Detectability,
        DoubleFaults,
        ModeSignatures,
        SignatureMatrix,
    )
    from bondgraph.ir.state import StateEquations
    from bondgraph.ir.structural_model import StructuralModel
    from bondgraph.ir.syntax import File
    from bondgraph.passes.elimination.state_equations import Wanted
    from bondgraph.passes.lowering.lower import LowerOptions
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
    from bondgraph.views import Relations, Signatures

T = TypeVar("T")
Own = TypeVar("Own", bound="Compilation")

#: Bonds of a model whose double faults are found within half a second or so.
_WATCHED = 200

#: Options that change numbers of the residual program only, and the stages before it.
_LATE = frozenset({"rate", "bandwidth", "targets", "extras", "libm", "real", "ranges", "costs"})
_EARLY = frozenset(
    "syntax graph integral derivative equations structure reduced _plant _analysis _shown"
    " verification observers".split()
)


class Compilation:
    """One model on its way through the compiler; each stage is computed when it is asked for.

    Source, model and options stay what they were at construction, so that a stage is always the
    one of these: `with_options` gives another compilation. Every stage raises `CompileError` with
    all diagnostics so far if the model is wrong there. Raises ValueError for an option that is no
    positive number, TypeError for names that are no sequence of names.

    >>> import bondgraph
    >>> c = bondgraph.compile("models/dc_motor.bg")
    >>> len(c.residuals)
    2
    >>> c
    Compilation(Motor in models/dc_motor.bg: 9 elements, 2 sensors, 2 residuals)
    """

    source: Source
    model: str | None
    options: Options
    report: Report

    def __init__(
        self, source: Source, model: str | None = None, options: Options | None = None
    ) -> None:
        chosen = checked(options or Options())
        vars(self).update(source=source, model=model, options=chosen, report=Report())

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(
            f"{name} of a compilation cannot be set; c.with_options(...) is another compilation"
        )

    if not TYPE_CHECKING:
        __getattr__ = by_new_name

    def __reduce__(self) -> tuple[object, ...]:
        """So that another process, in another folder too, can compile the same model."""
        source = Source(os.path.abspath(self.source.path), self.source.text)
        return type(self), (source, self.model, self.options)

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

    def with_options(self, **changes: Unpack[OptionValues]) -> Compilation:
        """The same model with other options; raises as `compile` does.

        Stages that do not depend on what changes are not computed again.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg", rate=500.0)
        >>> c.with_options(bandwidth=20.0).options[:2]
        (500.0, 20.0)
        """
        options = self.options._replace(**changes)
        if changes.keys() <= _LATE:
            return self._again(options)
        return Compilation(self.source, self.model, options)

    def in_form(self, form: Form) -> Compilation:
        """The same relations as residuals of another form, to be compared.

        They are those of `with_options(form=...)`, at less cost; what they share may have other
        names in their code.
        """
        return self._again(self.options._replace(form=form))

    def of(self, model: str) -> Compilation:
        """Another model of the same file, which is not read again.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/khepera.bg", open_ports=True)
        >>> c.of("Gear").graph.name
        'Gear'
        """
        return self._sharing(Compilation(self.source, model, self.options))

    # ------------------------------------------------------------ the stages, in order

    @cached_property
    def syntax(self) -> File:
        """The syntax tree: what is written, and where."""
        from bondgraph.frontend.parser import parse

        return self._stage(parse(self.source, self.report))

    @cached_property
    def graph(self) -> BondGraph:
        """The flat bond graph: submodels opened, arrays unrolled, names as paths.

        >>> import bondgraph
        >>> bondgraph.compile("models/dc_motor.bg").graph.faults
        ('L', 'R', 'k', 'J', 'f', 'load', 'U', 'current', 'speed')
        """
        from bondgraph.passes.elaboration.elaborate import elaborate

        own = self.syntax, self.source, self.model, self._load, self.report
        graph = elaborate(*own, self.options.open_ports)
        if graph is None:
            self._mend_units()
        found = self._stage(graph)
        given, offsets = dict(self.options.parameters), dict(self.options.offsets)
        tolerances = dict(self.options.tolerances)
        try:
            found = found.with_values(given) if given else found
            found = found.with_tolerances(tolerances) if tolerances else found
            return found.with_offsets(offsets) if offsets else found
        except KeyError as error:
            what = "sensor or input" if error.args[0] in offsets else "value"
            raise ValueError(f"the model has no {what} `{error.args[0]}`") from error

    @cached_property
    def integral(self) -> CausalGraph:
        """Preferred integral causality."""
        from bondgraph.passes.causality.assign import assign

        return self._stage(assign(self.graph, "integral", self.report))

    @cached_property
    def derivative(self) -> CausalGraph:
        """Preferred derivative causality with the sensors dualised."""
        from bondgraph.passes.causality.assign import assign

        return self._stage(assign(self.integral.graph, "derivative", self.report))

    @cached_property
    def equations(self) -> EquationSystem:
        """The acausal equations."""
        from bondgraph.passes.elimination.equations import equations
        from bondgraph.passes.elimination.initial_values import initial_values
        from bondgraph.passes.elimination.nominal_loops import nominal_loops

        system = equations(self.integral.graph)
        if self.integral.loops:
            nominal_loops(system, self.report)
        if self.integral.dependent:
            initial_values(system, self.report)
        return self._stage(system)

    def state_equations(self, wanted: Wanted | None = None) -> StateEquations:
        """The state equations for simulation, in one mode of the switches (None: all on).

        >>> import bondgraph
        >>> [s.name for s in bondgraph.compile("models/dc_motor.bg").state_equations().states]
        ['L.p', 'J.p']
        """
        from bondgraph.passes.elimination.state_equations import Wanted, state_equations

        chosen = wanted or Wanted({i.name: True for i in self.graph.inputs if i.mode})
        return self._stage(state_equations(self.equations, self.integral, chosen, self.report))

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

    def with_biases(self, scenario: Scenario) -> Scenario:
        """A scenario whose instruments have the offsets of sensors (`Options`) as biases too."""
        from bondgraph.runtime.simulation.scenario import Instrument

        found = dict(scenario.instruments)
        for sensor in self.graph.sensors:
            if sensor.offset and sensor.same_as is None:
                own = found.get(sensor.name, Instrument())
                found[sensor.name] = own._replace(bias=own.bias + sensor.offset)
        return scenario._replace(instruments=found)

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

    @cached_property
    def structure(self) -> StructuralModel:
        """Which unknown, known signal and fault is in which equation."""
        from bondgraph.passes.analysis.extract import extract

        return self._stage(extract(self.equations))

    @cached_property
    def reduced(self) -> ReducedSystem:
        """The unknowns eliminated: a value for each, and the equations left over."""
        from bondgraph.passes.elimination.eliminate import eliminate

        return self._stage(eliminate(self.equations, self.report))

    @cached_property
    def residuals(self) -> Relations:
        """The analytical redundancy relations, without what cancels in them.

        >>> import bondgraph
        >>> bondgraph.compile("models/dc_motor.bg").residuals
        r1 = U - k*speed - R*current - L*D(current)
        r2 = load + f*speed + J*D(speed) - k*current
        """
        from bondgraph.views import Relations

        return Relations(*self._shown[1:])

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

    @cached_property
    def signatures(self) -> Signatures:
        """The fault signature matrix: which residual sees which fault.

        >>> import bondgraph
        >>> matrix = bondgraph.compile("models/dc_motor.bg").signatures
        >>> matrix.signature("r1"), matrix.to_numpy().shape
        (('L', 'R', 'k', 'U', 'current', 'speed'), (9, 2))
        """
        from bondgraph.views import Signatures

        return Signatures(*self._shown[2])

    @cached_property
    def mode_signatures(self) -> ModeSignatures:
        """The fault signature matrix of each mode of a switched machine.

        >>> import bondgraph
        >>> found = bondgraph.compile("models/oven.bg").mode_signatures
        >>> [mode.modes for mode in found.modes]
        [{'on': False}, {'on': True}]
        """
        from bondgraph.passes.analysis.modes import modes

        return modes(*self._analysis, self._plant, self.options.seed)

    @cached_property
    def detectability(self) -> Detectability:
        """Which faults a residual sees as long as they last, which only in transients.

        >>> import bondgraph
        >>> bondgraph.compile("models/dc_motor.bg").detectability.only_weak
        ('L', 'J')
        """
        from bondgraph.passes.analysis.detectability import detectability

        return detectability(*self._analysis, self._plant, self.options.seed)

    @cached_property
    def maximum_isolability(self) -> tuple[tuple[str, ...], ...] | None:
        """The detectable faults in groups that no set of residuals could divide any further.

        None where that could not be decided.

        >>> import bondgraph
        >>> bondgraph.compile("models/dc_motor.bg").maximum_isolability
        (('L', 'R', 'U'), ('k',), ('J', 'f', 'load'), ('current',), ('speed',))
        """
        from bondgraph.passes.analysis.isolability import isolability

        return isolability(*self._analysis, self._plant, self.options.seed)

    @cached_property
    def double_faults(self) -> DoubleFaults:
        """Which two faults at once could look like a third one alone, whatever residuals are used.

        >>> import bondgraph
        >>> found = bondgraph.compile("models/dc_motor.bg").double_faults
        >>> found.any_two
        True
        >>> found.like("k")
        ((('L', 'R', 'U'), ('J', 'f', 'load'), ('current',), ('speed',)),)
        """
        from bondgraph.passes.analysis.double_faults import double_faults

        best = self.maximum_isolability
        return double_faults(*self._analysis, best, self._plant, self.options.seed)

    @cached_property
    def _analysis(self) -> tuple[ResidualSet, SignatureMatrix]:
        from bondgraph.passes.analysis.signatures import signatures
        from bondgraph.passes.elimination.shortfall import stop_without_any
        from bondgraph.passes.relation.form import relations, with_further

        seed, plant = self.options.seed, self._plant
        residuals = relations(self.reduced, plant, seed)
        matrix = signatures(residuals, plant, seed)
        if self.options.decouple:
            from bondgraph.passes.elimination.decouple import decouple

            found = decouple(residuals, matrix, self.options.decouple, self.report)
            residuals = with_further(residuals, found, plant, seed)
            matrix = signatures(residuals, plant, seed)
        if self.options.isolate:
            from bondgraph.passes.analysis.isolability import isolability
            from bondgraph.passes.analysis.isolating_set import isolating_set

            best = isolability(residuals, matrix, plant, seed)
            if best is not None and len(best) > len(matrix.groups):
                own = isolating_set(residuals, matrix, best, plant, self.report, seed)
                residuals, matrix = own
        stop_without_any(self.report, residuals)
        return self._stage((residuals, matrix))

    @cached_property
    def _shown(self) -> tuple[BondGraph, ResidualSet, SignatureMatrix]:
        """The relations in what a log has by one moment: past values where there are delays."""
        from bondgraph.passes.relation.log_time import log_time

        residuals, matrix = self._analysis
        found = log_time(residuals)
        if found is not residuals:
            matrix = matrix._replace(orders=tuple(r.orders for r in found.residuals))
        return found.system.graph, found, matrix

    @cached_property
    def _plant(self) -> Plant:
        """The exact simulation of the model, independent of its elimination."""
        from bondgraph.exact.plant import Plant

        return Plant(self.graph)

    @cached_property
    def verification(self) -> Verification:
        """What the exact check of residuals and signatures did; raises if it failed."""
        from bondgraph.passes.analysis.verify import verify

        return self._stage(verify(self.graph, *self._analysis, self.report, self.options.seed))

    @cached_property
    def observers(self) -> dict[str, Observer | str]:
        """By residual what it is as an observer, or in words why it has no such form.

        >>> import bondgraph
        >>> found = bondgraph.compile("models/dc_motor.bg").observers["r1"]
        >>> found.sensor, found.rates, found.output
        ('current', (U - k*speed - L.p*R/L,), L.p/L)
        """
        from bondgraph.passes.elimination.observer import observer

        residuals = self._analysis[0].residuals
        return {r.name: observer(self.equations, self.integral, r) for r in residuals}

    @cached_property
    def _followed(self) -> dict[str, Observer]:
        """The observers that `step` is made of, verified."""
        from bondgraph.passes.analysis.verify import follows

        form, found = self.options.form, {}
        if form == "derivative":
            return {}
        for residual in self._analysis[0].residuals:
            observer = self.observers[residual.name]
            chosen = form == "observer" or residual.name in form
            if chosen and not isinstance(observer, str):
                follows(residual, observer, self._plant, self.report, self.options.seed)
                found[residual.name] = observer
        return self._stage(found)

    @cached_property
    def program(self) -> Program:
        """The residual program, for a verified model only."""
        from bondgraph.passes.lowering.lower import lower

        assert self.verification
        return self._stage(lower(*self._shown, self._lowering, observers=self._followed))

    @cached_property
    def fixed_program(self) -> FixedProgram:
        """The residual program in whole numbers, proven not to overflow within `Options.ranges`.

        >>> import bondgraph
        >>> ranges = {"load": (-1e-3, 1e-3), "U": (-12, 12), "current": (-1, 1), "speed": (0, 300)}
        >>> c = bondgraph.compile("models/dc_motor.bg", real="fixed", ranges=ranges)
        >>> c.fixed_program.residuals["r1"].fixed < 2e-5  # V, next to the same in double
        True
        """
        from bondgraph.backends.fixed_decision import fixed_limits
        from bondgraph.backends.fixed_point import fixed_point

        program, ranges = self.program, dict(self.options.ranges)
        fixed = self._stage(fixed_point(program, ranges, self.report))
        return self._stage(fixed_limits(fixed, self._tuned, self.report))

    @cached_property
    def program_with_readings(self) -> Program:
        """The residual program in which the readings that laws received are signals of their own.

        It tells what a wrong sensor does. For a verified model only.
        """
        from bondgraph.passes.lowering.lower import lower

        relations = [r.expr for r in self._shown[1].residuals]
        program = self.program
        if self.graph.pool.logged(relations) == relations:
            return program
        return self._stage(lower(*self._shown, self._lowering, True, observers=self._followed))

    @cached_property
    def thresholds(self) -> Program | None:
        """The program of the adaptive thresholds, None for a model without tolerances."""
        return self._thresholds(self._shown[0])

    def _thresholds(self, graph: BondGraph) -> Program | None:
        from bondgraph.passes.lowering.thresholds import thresholds

        own = self._shown[1], self.program, self._lowering
        return thresholds(graph, *own, observers=self._followed)

    @cached_property
    def residual_units(self) -> dict[str, str]:
        """The SI unit of each residual, "" where that is not known."""
        from bondgraph.passes.relation.residual_units import residual_units

        return residual_units(self.graph, [r.residual for r in self.residuals])

    @cached_property
    def artifacts(self) -> tuple[Artifact | BinaryArtifact, ...]:
        """The files; raises ValueError for a target that is not there.

        All are text but those of the target `fmu`. Raises `Trouble` where these cannot be compiled.
        """
        return self._emitted(self.options.targets, self.options.extras)

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

    @cached_property
    def conflicts(self) -> tuple[Conflict, ...]:
        """Why strokes cannot be placed; empty where they can."""
        from bondgraph.passes.causality.conflicts import conflicts

        return conflicts(self.graph)

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

    def _repr_html_(self) -> str:
        """The drawing, the relations and the signatures, for a notebook."""
        parts = [self.drawing(), self.residuals._repr_html_(), self.signatures._repr_html_()]
        return "\n".join(parts)

    # ------------------------------------------------------------------------- helpers

    def _sharing(self, other: Own) -> Own:
        """Another compilation of the same text, with its tree."""
        vars(other).update(syntax=self.syntax)
        return other

    def _again(self, options: Options) -> Compilation:
        """With options that leave the relations what they are, and all that is known of these."""
        found = Compilation(self.source, self.model, options)
        if not self.report.failed:
            vars(found).update({k: v for k, v in vars(self).items() if k in _EARLY})
            found.report.diagnostics.extend(self.report.diagnostics)
        return found

    @property
    def _lowering(self) -> LowerOptions:
        from bondgraph.passes.lowering.lower import LowerOptions

        rate, bandwidth, resolution = self.options[:3]
        return LowerOptions(
            rate, bandwidth, resolution=resolution, libm=self.options.libm,
            tolerances=tuple(dict(self.options.tolerances).items()),
        )  # fmt: skip

    def _emitted(
        self, targets: Sequence[str], extras: Sequence[str]
    ) -> tuple[Artifact | BinaryArtifact, ...]:
        from bondgraph.backends.emit import emit

        languages = tuple(name for name in targets if name != "fmu")
        fixed = self.fixed_program if self.options.real == "fixed" and "c" in languages else None
        code = self.program, languages, self._bounds, self._tuned, extras, fixed, self.options.costs
        found = emit(*code) if languages else ()
        return (*found, *self._fmus) if "fmu" in targets else found

    @property
    def _tuned(self) -> Tuned:
        """The limits of the tuning, for code."""
        from bondgraph.backends.decision import UNTUNED, Tuned

        own = self.options.tuning
        if own is None:
            return UNTUNED
        from bondgraph.runtime.diagnosis.cusum import on_board  # which NumPy comes with

        limits = {n: on_board(limit, own.bounds.get(n, 0.0)) for n, limit in own.limits.items()}
        words = f"{own.seconds:g} s of a healthy machine, {own.false_alarms:g} false alarms an hour"
        return Tuned(limits, words, own.shows, own.window)

    def tuned(self, tuning: Tuning) -> Compilation:
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

    @cached_property
    def _fmus(self) -> tuple[BinaryArtifact, ...]:
        """The monitor, and the machine where there can be one, for each version of FMI."""
        from bondgraph.backends.fmu.machine_core import machine_core
        from bondgraph.backends.fmu.monitor_core import monitor_core
        from bondgraph.backends.fmu.package import VERSIONS, fmu, packed
        from bondgraph.backends.rates import rate_language
        from bondgraph.runtime.c_library import NativeError, built
        from bondgraph.runtime.simulation.algebraic_loops import SINGULAR
        from bondgraph.runtime.simulation.native_machine import BEYOND
        from bondgraph.runtime.simulation.open_machine import open_machine

        cores = [monitor_core(self.program, self._bounds, self.residual_units)]
        machine = open_machine(self.equations, self.integral, rate_language(), self.report)
        if machine is not None:
            cores.append(machine_core(self.program.name, machine, BEYOND, SINGULAR))
        wanted = [fmu(core, version) for version in VERSIONS for core in cores]
        try:
            return tuple(
                packed(one, built(one.sources, one.compiled, f"the FMU {one.identifier}"))
                for one in wanted
            )
        except NativeError as error:
            raise Trouble(
                f"{error}; an FMU holds compiled code: install a C compiler, or name one in CC"
            ) from error

    @property
    def _bounds(self) -> Program | None:
        """The thresholds if any residual has one; the report says why if none has."""
        return self._bounds_of(self.thresholds)

    def _bounds_of(self, bounds: Program | None) -> Program | None:
        if bounds is not None and all(r.unavailable for r in bounds.residuals):
            return None
        return bounds

    def _stage(self, value: T | None) -> T:
        self.report.stop_on_error()
        if value is None:
            raise CompileError(tuple(self.report.diagnostics))
        return value

    def _mend_units(self) -> None:
        """Where units disagree, say which change of the text makes them agree."""
        from bondgraph.frontend.parser import parse
        from bondgraph.passes.elaboration.elaborate import elaborate
        from bondgraph.passes.elaboration.unit_mends import CODE, unit_mends

        def findings(text: str) -> list[str]:
            report, source = Report(), Source(self.source.path, text)
            file = parse(source, report)
            if file is not None and not report.failed:
                elaborate(file, source, self.model, self._load, report, self.options.open_ports)
            return [d.message for d in report.diagnostics if d.code == CODE]

        self.report.diagnostics[:] = unit_mends(self.syntax, self.report.diagnostics, findings)

    def _load(self, path: str, origin: Span) -> File | None:
        """The syntax tree of an imported file; reports at `origin` what is wrong with it."""
        from bondgraph.frontend.parser import has_edition, parse

        beside = os.path.join(os.path.dirname(origin.source.path), path)
        source = self._read(beside, origin)
        if source is None:
            return None
        if not has_edition(source):  # of a file that is no model, no line is shown
            self.report.error(
                "import-no-model", f"The file `{beside}` is no model: it does not begin with `bg`"
                " and the edition.", origin, help="Name a model file, as in `import Motor from"
                " \"motor.bg\"`; `bondgraph check` on the file itself says more.")  # fmt: skip
            return None
        return parse(source, self.report)

    def _read(self, path: str, origin: Span) -> Source | None:
        """The text of an imported file; an editor has one that is not saved yet."""
        from bondgraph.frontend.read import read

        return read(path, self.report, origin)


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
