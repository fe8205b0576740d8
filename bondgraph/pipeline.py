"""The order of the compiler, written once: from a source to the files, one stage a property."""

from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from bondgraph.compile_options import Options, checked
from bondgraph.text.diagnostic import CompileError, Report, Trouble
from bondgraph.text.renamed import by_new_name
from bondgraph.text.source import Source, Span

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Self, Unpack

    from bondgraph.backends.decision import Tuned
    from bondgraph.compile_options import OptionValues
    from bondgraph.exact.plant import Plant
    from bondgraph.exact.verification import Verification
    from bondgraph.ir.artifact import Artifact, BinaryArtifact
    from bondgraph.ir.causal import CausalGraph, Conflict
    from bondgraph.ir.equation_system import EquationSystem
    from bondgraph.ir.fixed_program import FixedProgram
    from bondgraph.ir.graph import BondGraph
    from bondgraph.ir.program import Program
    from bondgraph.ir.residuals import Form, Observer, ReducedSystem, ResidualSet
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
    from bondgraph.views import Relations, Signatures

T = TypeVar("T")

#: Options that change numbers of the residual program only, and the stages before it.
_LATE = frozenset({"rate", "bandwidth", "targets", "extras", "libm", "real", "ranges", "costs"})
_EARLY = frozenset(
    "syntax graph integral derivative equations structure reduced _plant _analysis _shown"
    " verification observers".split()
)


class Pipeline:
    """One model on its way through the compiler; each stage is computed when it is asked for.

    Source, model and options stay what they were at construction, so that a stage is always the
    one of these: `with_options` gives another one. Every stage raises `CompileError` with all
    diagnostics so far if the model is wrong there. Raises ValueError for an option that is no
    positive number, TypeError for names that are no sequence of names.
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

    def with_options(self, **changes: Unpack[OptionValues]) -> Self:
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
        return self._with(self.model, options)

    def in_form(self, form: Form) -> Self:
        """The same relations as residuals of another form, to be compared.

        They are those of `with_options(form=...)`, at less cost; what they share may have other
        names in their code.
        """
        return self._again(self.options._replace(form=form))

    def of(self, model: str) -> Self:
        """Another model of the same file, which is not read again.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/khepera.bg", open_ports=True)
        >>> c.of("Gear").graph.name
        'Gear'
        """
        other = self._with(model, self.options)
        vars(other).update(syntax=self.syntax)
        return other

    def _with(self, model: str | None, options: Options) -> Self:
        """Another one of the same text, of which nothing is known yet."""
        return type(self)(self.source, model, options)

    # ------------------------------------------------------------------------- helpers

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
    def conflicts(self) -> tuple[Conflict, ...]:
        """Why strokes cannot be placed; empty where they can."""
        from bondgraph.passes.causality.conflicts import conflicts

        return conflicts(self.graph)

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

    def _again(self, options: Options) -> Self:
        """With options that leave the relations what they are, and all that is known of these."""
        found = self._with(self.model, options)
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
