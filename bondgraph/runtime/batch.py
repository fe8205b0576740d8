"""Many runs of one residual program side by side: every number is an array over the runs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.algebra.interpolation import Points, interpolation
from bondgraph.algebra.interpreter import Interpreter, Number
from bondgraph.ir.program import NewtonBlock, Program, Ref
from bondgraph.ir.tables import is_map

_KEPT = 20_000  # roots that are remembered


def _table(rows: Points, backwards: bool) -> Callable[..., Any]:
    if is_map(rows):
        return np.vectorize(interpolation(rows, backwards), otypes=[float])
    xs, ys = zip(*rows, strict=True)

    def table(x: Any) -> Any:
        inner = np.interp(x, xs, ys)
        return np.where(x <= xs[0], ys[0], np.where(x >= xs[-1], ys[-1], inner))

    return table


def _choose(holds: Any, yes: Callable[[], Any], no: Callable[[], Any]) -> Any:
    return np.where(holds, yes(), no())


#: Arrays of doubles, and single doubles among them.
ARRAYS = Number(
    np.float64,
    {
        **{n: getattr(np, n) for n in "sqrt exp log sin cos tan sinh cosh tanh cbrt sign".split()},
        **{f"a{n}": getattr(np, f"arc{n}") for n in "sin cos tan sinh cosh tanh tan2".split()},
        "abs": np.abs,
        "min": np.minimum,
        "max": np.maximum,
        "pow": np.power,
        "ssq": lambda x: x * np.abs(x),
        "ssqrt": lambda x: np.copysign(np.sqrt(np.abs(x)), x),
    },
    np.power,
    _table,
    _choose,
)


class Lanes(Interpreter):
    """An `Interpreter` of arrays. `sample` remembers nothing that it was not given."""

    def __init__(self, program: Program, params: Mapping[str, Any]) -> None:
        super().__init__(program, ARRAYS)
        # Most runs, and samples of constant signals, differ in nothing that a root rests on.
        self._found: dict[tuple[str | float, ...], Any] = {}
        with np.errstate(all="ignore"):
            self.configure(params)
        self._coefs = {ref: value for ref, value in self.values.items() if ref.space == "coef"}

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
        self.values, self.modes = dict(self._coefs), modes
        spaces: dict[Any, Mapping[str, Any]] = {
            "known": signals, "increment": increments, "total": totals, "state": states or {},
        }  # fmt: skip
        for space, given in spaces.items():
            for name, value in given.items():
                self.values[Ref(space, name)] = np.asarray(value, float)[()]
        for past in self.program.delayed:  # what is steady was so before
            if past.of in signals:
                self.values[Ref("known", past.known.name)] = self.values[Ref("known", past.of)]
        with np.errstate(all="ignore"):
            self.run(self.program.first if states is None else self.program.step)
        return self._of("residual"), self._of("state")

    def _of(self, space: str) -> dict[str, Any]:
        return {ref.name: value for ref, value in self.values.items() if ref.space == space}

    def _root(self, block: NewtonBlock, args: Sequence[Any]) -> Any:
        wide = np.broadcast_arrays(*args)
        if not wide or not wide[0].shape:
            return super()._root(block, args)
        if len(self._found) > _KEPT:
            self._found.clear()
        values = []
        for inputs in zip(*(a.tolist() for a in wide), strict=True):
            key = (block.name, *inputs)
            if key not in self._found:
                self._found[key] = super()._root(block, inputs)
            values.append(self._found[key])
        return np.array(values)
