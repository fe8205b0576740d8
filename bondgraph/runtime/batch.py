"""Many runs of one residual program side by side: every number is an array, one lane for a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from bondgraph.ir.program import (
    Choice,
    Compare,
    Condition,
    Expression,
    Logic,
    Mode,
    NewtonBlock,
    Program,
    Ref,
)
from bondgraph.runtime.interpret import Interpreter

Array = npt.NDArray[np.float64]
_KEPT = 20_000  # roots that are remembered


def _ssq(x: Array) -> Array:
    return x * np.abs(x)


def _ssqrt(x: Array) -> Array:
    return np.copysign(np.sqrt(np.abs(x)), x)


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    **{name: getattr(np, name) for name in "sqrt exp log sin cos tan sinh cosh tanh cbrt".split()},
    **{f"a{name}": getattr(np, f"arc{name}") for name in "sin cos tan sinh cosh tanh".split()},
    "abs": np.abs,
    "min": np.minimum,
    "max": np.maximum,
    "sign": np.sign,
    "pow": np.power,
    "atan2": np.arctan2,
    "ssq": _ssq,
    "ssqrt": _ssqrt,
}


class Lanes(Interpreter):
    """An `Interpreter` of arrays. `sample` remembers nothing that it was not given."""

    def __init__(self, program: Program, params: Mapping[str, Any]) -> None:
        super().__init__(program, params, real=np.float64, functions=_FUNCTIONS)
        # Most lanes, and samples of constant signals, differ in nothing that a root rests on.
        self._found: dict[tuple[str | float, ...], Any] = {}

    def sample(
        self,
        signals: Mapping[str, Any],
        increments: Mapping[str, Any],
        totals: Mapping[str, Any],
        modes: Mapping[str, bool],
        states: Mapping[str, Any] | None = None,
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Residuals and the memory after one sample; without `states` it is the first one.

        `increments` and `totals` are the counts of the encoders, which need not be whole here.
        """
        spaces: dict[str, dict[str, Any]] = {
            "local": {},
            "residual": {},
            "increment": dict(increments),
            "total": dict(totals),
        }
        self.states = dict(states or {})
        known = {name: {0: np.asarray(value, float)[()]} for name, value in signals.items()}
        with np.errstate(all="ignore"):
            for statement in self.program.first if states is None else self.program.step:
                self._assign(statement, spaces, known, modes)
        return spaces["residual"], self.states

    def _value(
        self, value: Expression, read: Callable[[Ref], Any], modes: Mapping[str, bool]
    ) -> Any:
        if isinstance(value, Choice):
            yes, no = (self._value(v, read, modes) for v in (value.yes, value.no))
            return np.where(self._met(value.condition, read, modes), yes, no)
        return super()._value(value, read, modes)

    def _met(
        self, condition: Condition, read: Callable[[Ref], Any], modes: Mapping[str, bool]
    ) -> Any:
        match condition:
            case Mode():
                return modes[condition.name]
            case Compare():
                left = self._value(condition.left, read, modes)
                right = self._value(condition.right, read, modes)
                if condition.op == "==":
                    return left == right
                return left < right if condition.op == "<" else left <= right
            case Logic():
                parts = [self._met(a, read, modes) for a in condition.args]
                if condition.op == "not":
                    return np.logical_not(parts[0])
                join = np.logical_and if condition.op == "and" else np.logical_or
                return join.reduce(np.broadcast_arrays(*parts))

    def _root(self, block: NewtonBlock, args: list[Any]) -> Any:
        wide = np.broadcast_arrays(*args)
        if not wide or not wide[0].shape:
            return super()._root(block, args)
        if len(self._found) > _KEPT:
            self._found.clear()
        values = []
        for lane in zip(*(a.tolist() for a in wide), strict=True):
            key = (block.name, *lane)
            if key not in self._found:
                self._found[key] = super()._root(block, list(lane))
            values.append(self._found[key])
        return np.array(values)

    def _lookup(self, name: str, x: Any) -> Any:
        xs, ys = zip(*self.tables[name], strict=True)
        inner = np.interp(x, xs, ys)
        return np.where(x <= xs[0], ys[0], np.where(x >= xs[-1], ys[-1], inner))
