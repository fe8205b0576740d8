"""The order of the compiler, written once: from a source to the files, one stage a property."""

from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from bondgraph.exact.plant import Plant
    from bondgraph.exact.verification import Verification
    from bondgraph.ir.artifact import Artifact
    from bondgraph.ir.causal import CausalGraph, Conflict
    from bondgraph.ir.equation_system import EquationSystem
    from bondgraph.ir.graph import BondGraph
    from bondgraph.ir.program import Program
    from bondgraph.ir.residuals import ReducedSystem, ResidualSet
    from bondgraph.ir.runnable_code import Runnable
    from bondgraph.ir.signature_matrix import Detectability, ModeSignatures, SignatureMatrix
    from bondgraph.ir.state import StateEquations
    from bondgraph.ir.structural_model import StructuralModel
    from bondgraph.ir.syntax import File
    from bondgraph.passes.elimination.state_equations import Wanted
    from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
    from bondgraph.runtime.diagnosis.healthy import Facts
    from bondgraph.runtime.diagnosis.tuning import Tuning
    from bondgraph.runtime.monitoring.engine import Engine
    from bondgraph.runtime.simulation.run import Run
    from bondgraph.runtime.simulation.scenario import Scenario
    from bondgraph.views import Relations

T = TypeVar("T")


class Options(NamedTuple):
    """What a compilation may be asked for beyond the model.

    `rate` in samples a second, `bandwidth` of the residual filter in rad/s (None: chosen from the
    rate), `resolution` the relative size below which a term cannot be seen (12 bits), `targets`
    the languages to emit, `seed` of the random points that the exact verification uses,
    `decouple` the faults that further relations are to be free of, by combining relations.
    """

    rate: float = 1000.0
    bandwidth: float | None = None
    resolution: float = 2.0**-12
    targets: tuple[str, ...] = ("c", "python")
    seed: int = 1
    decouple: tuple[str, ...] = ()


class Compilation:
    """One model on its way through the compiler; each stage is computed when it is asked for.

    Every stage raises `CompileError` with all diagnostics so far if the model is wrong there.

    >>> import bondgraph
    >>> c = bondgraph.compile("models/dc_motor.bg")
    >>> len(c.residuals)
    2
    """

    def __init__(
        self, source: Source, model: str | None = None, options: Options | None = None
    ) -> None:
        self.source = source
        self.model = model
        self.options = options or Options()
        self.report = Report()
        self.open_ports = False

    # ------------------------------------------------------------ the stages, in order

    @cached_property
    def syntax(self) -> File:
        """The syntax tree."""
        from bondgraph.frontend.parser import parse

        return self._stage(parse(self.source, self.report))

    @cached_property
    def graph(self) -> BondGraph:
        """The flat bond graph."""
        from bondgraph.passes.elaboration.elaborate import elaborate

        return self._stage(
            elaborate(
                self.syntax, self.source, self.model, self._load, self.report, self.open_ports
            )
        )

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
        """The state equations for simulation, in one mode of the switches (None: all on)."""
        from bondgraph.passes.elimination.state_equations import Wanted, state_equations

        chosen = wanted or Wanted({i.name: True for i in self.graph.inputs if i.mode})
        return self._stage(state_equations(self.equations, self.integral, chosen, self.report))

    def scenario(self, path: str | os.PathLike[str]) -> Scenario:
        """Read a scenario file for this model; raises `CompileError` if it is wrong."""
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
    ) -> Run:
        """Run a scenario (or the file of one) on the virtual machine.

        Raises `CompileError` where scenario or model are wrong, `SimulationError` where the
        machine has no motion beyond some moment.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> from bondgraph.runtime.simulation.scenario import Course, Scenario
        >>> twelve = {"U": Course(None, ((0.0, 12.0),))}
        >>> run = c.simulate(Scenario("step", duration=2.0, inputs=twelve))
        >>> f"{run.truth.columns['speed'][-1]:.1f} rad/s"
        '189.9 rad/s'
        """
        from bondgraph.runtime.simulation.run import simulate
        from bondgraph.runtime.simulation.scenario import Scenario

        chosen = scenario if isinstance(scenario, Scenario) else self.scenario(scenario)
        return simulate(self.equations, self.integral, chosen, progress)

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
    def combined(self) -> ReducedSystem:
        """The same with relations that are free of the faults to `decouple`, if there are any."""
        if not self.options.decouple:
            return self.reduced
        from bondgraph.passes.analysis.signatures import signatures
        from bondgraph.passes.elimination.decouple import decouple

        seed, plant = self.options.seed, self._plant
        first = signatures(self.reduced, self.report, seed, plant)
        faults = self.options.decouple
        return self._stage(decouple(self.reduced, *first, faults, plant, self.report, seed))

    @cached_property
    def residuals(self) -> Relations:
        """The analytical redundancy relations, without what cancels in them."""
        from bondgraph.views import Relations

        return Relations(*self._analysis)

    @cached_property
    def signatures(self) -> SignatureMatrix:
        """The fault signature matrix."""
        return self._analysis[1]

    @cached_property
    def modes(self) -> ModeSignatures:
        """The fault signature matrix of each mode of a switched machine."""
        from bondgraph.passes.analysis.modes import modes

        return modes(*self._analysis, self._plant, self.options.seed)

    @cached_property
    def detectability(self) -> Detectability:
        """Which faults a residual sees as long as they last, which only in transients."""
        from bondgraph.passes.analysis.detectability import detectability

        return detectability(*self._analysis, self._plant, self.options.seed)

    @cached_property
    def best(self) -> tuple[tuple[str, ...], ...] | None:
        """The detectable faults in groups that no set of residuals could divide any further."""
        from bondgraph.passes.analysis.isolability import isolability

        residuals, matrix = self._analysis
        exprs = [r.expr for r in residuals.residuals]
        made = [r.free_of is not None for r in residuals.residuals]  # they add nothing new
        return isolability(exprs, made, matrix, self._plant, self.options.seed)

    @cached_property
    def _analysis(self) -> tuple[ResidualSet, SignatureMatrix]:
        from bondgraph.passes.analysis.signatures import signatures
        from bondgraph.passes.elimination.shortfall import stop_without_any

        found = signatures(self.combined, self.report, self.options.seed, self._plant)
        stop_without_any(self.report, found[0])
        return self._stage(found)

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
    def received(self) -> Program:
        """The residual program in which the readings that laws received are signals of their own.

        It tells what a wrong sensor does. For a verified model only.
        """
        from bondgraph.passes.lowering.lower import LowerOptions, lower

        residuals = self._analysis[0].residuals
        relations = [r.expr for r in residuals]
        if self.graph.pool.logged(relations) == relations:
            return self.program
        options = LowerOptions(*self.options[:2], resolution=self.options.resolution)
        assert self.program
        return self._stage(lower(self.graph, *self._analysis, options, received=True))

    @cached_property
    def program(self) -> Program:
        """The residual program, for a verified model only."""
        from bondgraph.passes.lowering.lower import LowerOptions, lower

        assert self.verification
        options = LowerOptions(*self.options[:2], resolution=self.options.resolution)
        return self._stage(lower(self.graph, *self._analysis, options))

    @cached_property
    def thresholds(self) -> Program | None:
        """The program of the adaptive thresholds, None for a model without tolerances."""
        from bondgraph.passes.lowering.lower import LowerOptions
        from bondgraph.passes.lowering.thresholds import thresholds

        options = LowerOptions(*self.options[:2], resolution=self.options.resolution)
        return thresholds(self.graph, self._analysis[0], self.program, options)

    @cached_property
    def artifacts(self) -> tuple[Artifact, ...]:
        """The files, as text."""
        from bondgraph.backends.emit import emit

        return emit(self.program, self.options.targets, self._bounds)

    @cached_property
    def runnables(self) -> tuple[Runnable, Runnable | None]:
        """The code of residuals and thresholds, to be loaded and run here; None without these."""
        from bondgraph.backends.runnable import runnable

        bounds = self._bounds
        return runnable(self.received), None if bounds is None else runnable(bounds)

    def engine(
        self, native: bool | None = None, tell: Callable[[str], None] | None = None
    ) -> Engine:
        """What runs the residuals and thresholds over arrays of samples, at nominal parameters.

        In C compiled here, or in Python (`native` False, or None and no compiler, which is told
        in one line to `tell`). Raises NativeError if it must be C and cannot be.

        >>> import bondgraph
        >>> engine = bondgraph.compile("models/dc_motor.bg").engine()
        >>> [k.path for k in engine.signals]
        ['load', 'U', 'current', 'speed']
        >>> batch = engine.run([[0.0, 6.0, 2.0, 0.0]] * 1000)  # 6 V and 2 A at rest
        >>> batch.valid[-1].tolist(), batch.value.shape
        ([True, True], (1000, 2))
        """
        from bondgraph.runtime.monitoring.native import start

        return start(*self.runnables, native=native, tell=tell)

    def diagnoses(
        self, fired: Iterable[str], silent: Iterable[str] = (), at_most: int | None = None
    ) -> tuple[tuple[str, ...], ...]:
        """The minimal sets of faults that explain the residuals that have `fired`.

        Several faults at once are allowed, up to `at_most`. Residuals named in `silent` clear the
        faults they see; leave that out where faults may cancel each other. Raises KeyError for an
        unknown residual.

        >>> import bondgraph
        >>> c = bondgraph.compile("models/dc_motor.bg")
        >>> c.diagnoses(["r1", "r2"], at_most=1)
        (('k',), ('current',), ('speed',))
        >>> c.diagnoses(["r2"], silent=["r1"])
        (('J',), ('f',), ('load',))
        """
        from bondgraph.structural.hitting import diagnoses

        matrix = self.signatures
        return diagnoses(matrix.sees, fired, silent, at_most)

    @cached_property
    def facts(self) -> Facts:
        """What a monitor has to know of the machine beside its residuals."""
        from bondgraph.runtime.diagnosis.healthy import facts

        return facts(self.graph, self._analysis[0], self.signatures, self.received)

    def diagnosis(self, engine: Engine, tuning: Tuning | None = None) -> Diagnosis:
        """What says verdicts about the residuals of an engine of this model.

        Without a `tuning` (`bondgraph tune`) it learns the noise from the first seconds. Raises
        ValueError for a tuning of another model, rate or bandwidth.
        """
        from bondgraph.runtime.diagnosis.diagnosis import Diagnosis

        if tuning is not None:
            if tuning.model != self.program.digest:
                raise ValueError("it is of another model, or of other options")
            if abs(tuning.bandwidth / engine.bandwidth - 1) > 1e-9:
                raise ValueError(f"it is for a filter of {tuning.bandwidth:g} rad/s")
        return Diagnosis(engine, self.facts, tuning)

    @cached_property
    def conflicts(self) -> tuple[Conflict, ...]:
        """Why strokes cannot be placed; empty where they can."""
        from bondgraph.passes.causality.conflicts import conflicts

        return conflicts(self.graph)

    def drawing(self, derivative: bool = False, bare: bool = False) -> str:
        """The bond graph with its causal strokes, or with what keeps them from being placed.

        As SVG, one self-contained text; a `bare` one for inside of a page that has its colours.
        """
        if self.conflicts:
            from bondgraph.backends.draw_conflicts import draw_conflicts

            return draw_conflicts(self.graph, self.conflicts, self.graph.name, bare)
        from bondgraph.backends.figure import draw

        causal = self.derivative if derivative else self.integral
        return draw(causal, self.graph.name, bare)

    def _repr_html_(self) -> str:
        """The drawing, the relations and the signatures, for a notebook."""
        parts = [self.drawing(), self.residuals._repr_html_(), self.signatures._repr_html_()]
        return "\n".join(parts)

    # ------------------------------------------------------------------------- helpers

    @property
    def _bounds(self) -> Program | None:
        """The thresholds if any residual has one; the report says why if none has."""
        bounds = self.thresholds
        if bounds is not None and all(r.unavailable for r in bounds.residuals):
            return None
        return bounds

    def _stage(self, value: T | None) -> T:
        self.report.stop_on_error()
        if value is None:
            raise CompileError(tuple(self.report.diagnostics))
        return value

    def _load(self, path: str, origin: Span) -> File | None:
        """The syntax tree of an imported file; reports at `origin` what is wrong with it."""
        from bondgraph.frontend.parser import parse
        from bondgraph.frontend.read import read

        beside = os.path.join(os.path.dirname(origin.source.path), path)
        source = read(beside, self.report, origin)
        return parse(source, self.report) if source else None


def compile(
    path: str | os.PathLike[str], model: str | None = None, **options: object
) -> Compilation:
    """Open a model for compilation; `path` may name the model: `robot.bg:Drive`.

    Options are those of `Options`. Nothing is computed before a stage is asked for. Raises
    `CompileError` if the file cannot be read, TypeError for an unknown option.
    """
    from bondgraph.frontend.read import read

    name = os.fspath(path)
    if model is None and not os.path.exists(name) and ":" in os.path.basename(name):
        name, _, model = name.rpartition(":")
    report = Report()
    source = read(name, report)
    if source is None:
        raise CompileError(tuple(report.diagnostics))
    chosen = Options(**options)  # type: ignore[arg-type]
    return Compilation(source, model, chosen)
