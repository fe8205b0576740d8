"""Run a residual program in Python, with any kind of number: for tests and golden vectors."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple, assert_never

from bondgraph.ir.program import (
    Assign,
    Choice,
    Compare,
    Condition,
    Const,
    Dot,
    ExactStatement,
    Expression,
    Function,
    Logic,
    Mode,
    NewtonBlock,
    PolynomialTape,
    Product,
    Program,
    Ref,
    Sum,
)
from bondgraph.passes.lowering.newton import newton, or_nan

#: Anything with the arithmetic of a real number: float, numpy.float32, Fraction, mpmath.mpf.
Real = Any
_Read = Callable[[Ref], Real]


class Outcome(NamedTuple):
    """The residuals by name, and which of them may be trusted."""

    residuals: dict[str, Real]
    valid: dict[str, bool]


class Interpreter:
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
        sample_time: Real | None = None,
        bandwidth: Real | None = None,
        time_unit: Real | None = None,
        real: Callable[[float], Real] = float,
        functions: Mapping[str, Callable[..., Real]] | None = None,
    ) -> None:
        self.program = program
        self.real = real
        self.functions = dict(_FUNCTIONS) | dict(functions or {})
        self.tables = dict(program.tables)
        self.roots = {block.name: block for block in program.roots}
        self.params: dict[str, Real] = {
            f.name: real(f.default) for f in program.params if f.default is not None
        }
        self.params.update(params or {})
        self.options: dict[str, Real] = {
            "sample_time": real(1 / program.rate) if sample_time is None else sample_time,
            "bandwidth": real(program.bandwidth) if bandwidth is None else bandwidth,
            "time_unit": real(program.time_unit) if time_unit is None else time_unit,
        }
        self.coefs: dict[str, Real] = {}
        self.states: dict[str, Real] = {}
        self.age = 0
        self._counts: dict[str, int] = {}
        self._totals: dict[str, int] = {}
        self._configure()

    # ------------------------------------------------------------ configure

    def _configure(self) -> None:
        for field in self.program.coefs:
            self.coefs[field.name] = [self.real(0.0)] * field.size if field.size else None
        spaces: dict[str, dict[str, Real]] = {
            "param": self.params,
            "option": self.options,
            "local": {},
        }
        for statement in self.program.configure:
            if isinstance(statement, PolynomialTape):
                self._tape(statement, spaces)
            else:
                self._assign(statement, spaces, {}, {})

    def _tape(self, tape: PolynomialTape, spaces: dict[str, dict[str, Real]]) -> None:
        zero = self.real(0.0)
        read = self._reader(spaces)
        scales = [self._value(s, read, {}) for s in tape.scales]
        rows = [[zero] * tape.length for _ in range(tape.rows)]
        rows[0][0] = self.real(1.0)
        for op in tape.ops:
            if op.fresh:
                rows[op.target] = [zero] * tape.length
            target, source, scale = rows[op.target], rows[op.source], scales[op.scale]
            for i in range(op.length):
                target[i + op.shift] = target[i + op.shift] + scale * source[i]
        for out in tape.outputs:
            self.coefs[out.array] = rows[out.row][: out.length]

    # --------------------------------------------------------------- exact

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
        spaces: dict[str, dict[str, Real]] = {
            "local": {},
            "residual": {},
            "integral": dict(integrals or {}),
            "start": dict(start or {}),
            "time": {"time": time},
        }
        for statement in self.program.exact:
            self._assign(statement, spaces, known, modes or {})
        return spaces["residual"]

    # ---------------------------------------------------------------- step

    def restart(self) -> None:
        """Forget all samples; the next one starts anew."""
        self.age = 0

    def step(self, samples: Mapping[str, Real], modes: Mapping[str, bool] | None = None) -> Outcome:
        """One sample of each known signal (integer counts of an encoder).

        A sample that is not finite gives no valid residual and restarts the program.
        """
        names = [r.name for r in self.program.residuals]
        nothing = Outcome(dict.fromkeys(names, self.real(0.0)), dict.fromkeys(names, False))
        if not all(_finite(samples[k.name]) for k in self.program.knowns if k.name in samples):
            self.age = 0
            return nothing
        spaces: dict[str, dict[str, Real]] = {
            "local": {},
            "residual": {},
            "increment": {},
            "total": {},
        }
        self._count(samples, spaces)
        known = {name: {0: value} for name, value in samples.items()}
        for statement in self.program.step if self.age else self.program.first:
            self._assign(statement, spaces, known, modes or {})
        residuals = {name: spaces["residual"][name] for name in names}
        if not all(_finite(r) for r in residuals.values()):
            self.age = 0
            return nothing
        passed = self.age * self.options["sample_time"] * self.options["bandwidth"]
        self.age += 1
        valid = {r.name: not r.unavailable and passed >= r.settle for r in self.program.residuals}
        for opening in self.program.openings:
            valid[opening.residual] &= bool(self.states[opening.progress] >= 1)
        return Outcome(residuals, valid)

    def _count(self, samples: Mapping[str, Real], spaces: dict[str, dict[str, Real]]) -> None:
        for known in self.program.knowns:
            if known.counts is None or known.name not in samples:
                continue
            raw = int(samples[known.name])
            before = self._counts.get(known.name, raw) if self.age else raw
            step = (raw - before + 2**31) % 2**32 - 2**31
            total = self._totals.get(known.name, 0) + step if self.age else 0
            self._counts[known.name], self._totals[known.name] = raw, total
            spaces["increment"][known.name] = self.real(step)
            spaces["total"][known.name] = self.real(total)

    # ---------------------------------------------------------- statements

    def _reader(self, spaces: dict[str, dict[str, Real]]) -> _Read:
        def read(ref: Ref) -> Real:
            if ref.space == "coef":
                value = self.coefs[ref.name]
                return value[ref.order] if isinstance(value, list) else value
            if ref.space == "state":
                return self.states[ref.name]
            return spaces[ref.space][ref.name]

        return read

    def _assign(
        self,
        statement: ExactStatement,
        spaces: dict[str, dict[str, Real]],
        known: Mapping[str, Mapping[int, Real]],
        modes: Mapping[str, bool],
    ) -> None:
        plain = self._reader(spaces)

        def read(ref: Ref) -> Real:
            return known[ref.name][ref.order] if ref.space == "known" else plain(ref)

        if isinstance(statement, Dot):
            value = self.real(0.0)
            for term in statement.terms:
                for k in range(term.length):
                    value = value + self.coefs[term.array][k] * known[term.signal][k]
        else:
            value = self._value(statement.value, read, modes)
        target = statement.target
        if target.space == "coef":
            self.coefs[target.name] = value
        elif target.space == "state":
            self.states[target.name] = value
        else:
            spaces[target.space][target.name] = value

    def _value(self, value: Expression, read: _Read, modes: Mapping[str, bool]) -> Real:
        match value:
            case Const():
                return self.real(value.value)
            case Ref():
                return read(value)
            case Sum():
                total: Real = None
                for positive, term in value.terms:
                    x = self._value(term, read, modes)
                    if total is None:
                        total = x if positive else -x
                    else:
                        total = total + x if positive else total - x
                return total
            case Product():
                product = self._value(value.factors[0], read, modes)
                for factor in value.factors[1:]:
                    product = product * self._value(factor, read, modes)
                for divisor in value.divisors:
                    product = product / self._value(divisor, read, modes)
                return product
            case Function():
                args = [self._value(a, read, modes) for a in value.args]
                if value.name.startswith("table:"):
                    return self._lookup(value.name.removeprefix("table:"), args[0])
                if value.name.startswith("root:"):
                    return self._root(self.roots[value.name.removeprefix("root:")], args)
                return self.functions[value.name](*args)
            case Choice():
                chosen = value.yes if self._holds(value.condition, read, modes) else value.no
                return self._value(chosen, read, modes)
        assert_never(value)

    def _holds(self, condition: Condition, read: _Read, modes: Mapping[str, bool]) -> bool:
        match condition:
            case Mode():
                return modes[condition.name]
            case Compare():
                left = self._value(condition.left, read, modes)
                right = self._value(condition.right, read, modes)
                if condition.op == "==":
                    return bool(left == right)
                return bool(left < right if condition.op == "<" else left <= right)
            case Logic():
                parts = [self._holds(a, read, modes) for a in condition.args]
                if condition.op == "not":
                    return not parts[0]
                return all(parts) if condition.op == "and" else any(parts)
        assert_never(condition)

    def _root(self, block: NewtonBlock, args: list[Real]) -> Real:
        """Newton's method of a block, as generated code does it."""
        given = dict(zip(block.arguments, args, strict=True))

        def look(x: float) -> tuple[float, float]:
            spaces: dict[str, dict[str, Real]] = {"local": {**given, "x": self.real(x)}}
            read = self._reader(spaces)

            def part(statements: tuple[Assign, ...], value: Expression) -> float:
                for statement in statements:
                    self._assign(statement, spaces, {}, {})
                return float(self._value(value, read, {}))

            value = or_nan(lambda: part(block.body, block.value))
            return value, or_nan(lambda: part(block.further, block.slope))

        return self.real(newton(look, block.rising, block.guess, block.most))

    def _lookup(self, name: str, x: Real) -> Real:
        points: Sequence[tuple[float, float]] = self.tables[name]
        if x <= points[0][0]:
            return self.real(points[0][1])
        for (x0, y0), (x1, y1) in pairwise(points):
            if x < x1:
                slope = self.real((y1 - y0) / (x1 - x0))
                return self.real(y0) + slope * (x - self.real(x0))
        return self.real(points[-1][1])


def _finite(value: Real) -> bool:
    return bool(value - value == 0)


def _sign(x: Real) -> Real:
    return x / abs(x) if x != 0 else x


def _cbrt(x: Real) -> Real:
    return math.copysign(abs(x) ** (1 / 3), x)


def _ssqrt(x: Real) -> Real:
    return math.copysign(math.sqrt(abs(x)), x)


_FUNCTIONS: dict[str, Callable[..., Real]] = {
    **{
        name: getattr(math, name)
        for name in (
            "sqrt exp log sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh pow atan2"
        ).split()
    },
    "abs": abs,
    "min": min,
    "max": max,
    "sign": _sign,
    "cbrt": _cbrt,
    "ssqrt": _ssqrt,
    "ssq": lambda x: x * abs(x),
}
