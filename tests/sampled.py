"""A residual program fed with samples, as the generated code is, on any kind of number."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from bondgraph.algebra.interpreter import DOUBLE, Interpreter, Real
from bondgraph.ir.program import Program, Ref


class Outcome(NamedTuple):
    """The residuals by name, and which of them may be trusted."""

    residuals: dict[str, Real]
    valid: dict[str, bool]


class Sampled(Interpreter):
    """A configured program with the memory of its step.

    `real` makes a number of the wanted kind from a float, `functions` replaces the functions of
    `math` by those of another kind of number. Times in s, bandwidth in rad/s; parameters by the
    identifiers of `Program.params`. Raises KeyError for a parameter that has no value.
    """

    def __init__(
        self,
        program: Program,
        params: Mapping[str, Real] | None = None,
        *,
        real: Callable[[float], Real] = float,
        functions: Mapping[str, Callable[..., Real]] | None = None,
        **options: Real,
    ) -> None:
        own = {**DOUBLE.functions, **(functions or {})}
        super().__init__(program, DOUBLE._replace(real=real, functions=own))
        self.configure(params, options)
        self.age = 0
        self._counts: dict[str, int] = {}
        self._totals: dict[str, int] = {}

    @property
    def coefs(self) -> dict[str, Real]:
        """The coefficients that configure has computed."""
        return self._of("coef")

    def exact(
        self,
        known: Mapping[str, Mapping[int, Real]],
        *,
        modes: Mapping[str, bool] | None = None,
        integrals: Mapping[str, Real] | None = None,
        start: Mapping[str, Real] | None = None,
        time: Real = 0.0,
    ) -> dict[str, Real]:
        """The residuals from exact derivatives `known[signal][order]`, in the time unit.

        Order -1 is the integral since the start, `start` the values then.
        """
        for name, orders in known.items():
            for order, value in orders.items():
                self.values[Ref("known", name, order)] = value
        self._give("integral", integrals or {})
        self._give("start", start or {})
        self._give("time", {"time": time})
        self.modes = modes or {}
        self.run(self.program.exact)
        return self._of("residual")

    def step(self, samples: Mapping[str, Real], modes: Mapping[str, bool] | None = None) -> Outcome:
        """One sample of each known signal (integer counts of an encoder).

        A sample that is not finite gives no valid residual and restarts the program.
        """
        names = [r.name for r in self.program.residuals]
        zero = self.number.real(0.0)
        nothing = Outcome(dict.fromkeys(names, zero), dict.fromkeys(names, False))
        if not all(_finite(samples[k.name]) for k in self.program.knowns if k.name in samples):
            self.age = 0
            return nothing
        self._count(samples)
        self._give("known", samples)
        self.modes = modes or {}
        self.run(self.program.step if self.age else self.program.first)
        found = self._of("residual")
        residuals = {name: found[name] for name in names}
        if not all(_finite(r) for r in residuals.values()):
            self.age = 0
            return nothing
        options = self._of("option")
        passed = self.age * options["sample_time"] * options["bandwidth"]
        self.age += 1
        valid = {r.name: not r.unavailable and passed >= r.settle for r in self.program.residuals}
        for opening in self.program.openings:
            valid[opening.residual] &= bool(self.values[Ref("state", opening.progress)] >= 1)
        return Outcome(residuals, valid)

    def _count(self, samples: Mapping[str, Real]) -> None:
        for known in self.program.knowns:
            if known.counts is None or known.name not in samples:
                continue
            raw = int(samples[known.name])
            before = self._counts.get(known.name, raw) if self.age else raw
            step = (raw - before + 2**31) % 2**32 - 2**31
            total = self._totals.get(known.name, 0) + step if self.age else 0
            self._counts[known.name], self._totals[known.name] = raw, total
            self._give("increment", {known.name: self.number.real(step)})
            self._give("total", {known.name: self.number.real(total)})

    def _give(self, space: Any, values: Mapping[str, Real]) -> None:
        self.values |= {Ref(space, name): value for name, value in values.items()}

    def _of(self, space: str) -> dict[str, Real]:
        return {ref.name: v for ref, v in self.values.items() if ref.space == space}


def _finite(value: Real) -> bool:
    return bool(value - value == 0)
