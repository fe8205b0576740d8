"""The plant by hand: its trajectories as power series, and what its linearisation can tell."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import sympy
from mpmath import mpf

from tests.adversary import jets
from tests.adversary.jets import Evaluator, Jet

HERE = Path(__file__).resolve().parent


class ssqrt(sympy.Function):
    def fdiff(self, argindex: int = 1) -> Any:
        return 1 / (2 * sympy.sqrt(myabs(self.args[0])))


class mysign(sympy.Function):
    def fdiff(self, argindex: int = 1) -> Any:
        return sympy.Integer(0)


class myabs(sympy.Function):
    def fdiff(self, argindex: int = 1) -> Any:
        return mysign(self.args[0])


def where(condition: Any, yes: Any, no: Any) -> Any:
    return sympy.Piecewise((yes, condition), (no, True))


FUNCTIONS: dict[str, Any] = {
    name: getattr(sympy, name) for name in "exp log sin cos tan tanh sinh cosh atan sqrt".split()
} | {
    "ssqrt": ssqrt,
    "abs": myabs,
    "sign": mysign,
    "where": where,
    "min": lambda a, b: where(a < b, a, b),
    "max": lambda a, b: where(a > b, a, b),
}


NOTHING: Mapping[str, Any] = MappingProxyType({})


class Plant(NamedTuple):
    """A model and its physics by hand.

    `equations` vanish; `D(x)` is the time derivative; names are those of the JSON (`a.b[1]` is
    `a__b__1`). `params` and `inputs` (known), `unknown` (inputs) and `modes` are separated from
    the variables, which are all other names. Of the sensors in `readings` the equations and other
    sensors hold what they read, which is what they measure plus their error. `starts`: declared
    initial values. `n_arr` is the right count; `undetectable` the faults that nothing can see
    (None: taken from the signatures). `values` overrides the random value of a parameter, the lead
    of an input or a guess.
    """

    name: str
    text: str
    equations: str
    sensors: dict[str, str]
    n_arr: int
    params: str = ""
    inputs: str = ""
    unknown: str = ""
    modes: str = ""
    starts: Mapping[str, str] = NOTHING
    values: Mapping[str, float] = NOTHING
    undetectable: str | None = None
    status: str = "ok"
    consts: Mapping[str, float] = NOTHING
    groups: int | None = None
    alias: Mapping[str, str] = NOTHING
    readings: str = ""


def read(text: str, scope: dict[str, Any]) -> Any:
    """Decimals are exact, as they are in the models."""
    return sympy.sympify(eval(re.sub(r"(?<![\w.])(\d+\.?\d*)", r"exactly('\1')", text), scope))


def model(name: str) -> str:
    """The text of a model of this folder."""
    return (HERE / "models" / f"{name}.bg").read_text(encoding="utf-8")


def plain(name: str) -> str:
    return re.sub(r"\[(\d+)\]", r"__\1", name).replace(".", "__")


class Simulator:
    """All signals of a plant as power series with `n` coefficients."""

    def __init__(self, plant: Plant, n: int, seed: int = 1, modes: dict[str, bool] | None = None):
        self.plant, self.n, self.modes = plant, n, modes or {}
        self.random = random.Random(seed)
        self.params = plant.params.split()
        self.inputs = plant.inputs.split()
        self.unknown = plant.unknown.split()
        given = {*self.params, *self.inputs, *self.unknown, *plant.modes.split(), *plant.consts}
        names = set(
            re.findall(r"[A-Za-z_]\w*", plant.equations + ";" + " ".join(plant.sensors.values()))
        )
        names -= {*FUNCTIONS, "D"}
        self.variables = sorted(names - given)
        scope: dict[str, Any] = {x: sympy.Symbol(x, real=True) for x in names | given}
        for x in plant.modes.split():
            scope[x] = sympy.Symbol(x)
        scope |= FUNCTIONS
        scope["D"] = lambda x: sympy.Symbol(x.name + "__dot", real=True)
        texts = [x.strip() for x in re.split(r"[\n;]", plant.equations) if x.strip()]
        scope["exactly"] = sympy.Rational
        self.equations = [read(x, scope) for x in texts]
        self.sensors = {k: read(v, scope) for k, v in plant.sensors.items()}
        self.readings = plant.readings.split()
        self.errors = {x: sympy.Symbol(f"{x}__error", real=True) for x in self.readings}
        self.equations += [scope[x] - self.sensors[x] - self.errors[x] for x in self.readings]
        self.starts = {k: read(v, scope) for k, v in plant.starts.items()}
        self.slopes = []
        for e in self.equations:
            rows = {}
            for j, x in enumerate(self.variables):
                a = e.diff(sympy.Symbol(x, real=True))
                b = e.diff(sympy.Symbol(x + "__dot", real=True))
                if a != 0 or b != 0:
                    rows[j] = (a, b)
            self.slopes.append(rows)
        self.nominal = {x: self.poly(self.lead(x), False) for x in self.params}
        self.nominal |= {x: self.poly(str(v), False) for x, v in plant.consts.items()}
        self.nominal |= {e.name: [mpf(0)] * n for e in self.errors.values()}
        self.signals = {x: self.poly(self.lead(x), True) for x in self.inputs + self.unknown}

    def lead(self, name: str) -> Any:
        return self.plant.values.get(name, 0.5 + self.random.random())

    def poly(self, lead: Any, moving: bool, size: float = 1.0) -> Jet:
        tail = [
            mpf((self.random.random() - 0.5) * size / (1 + k) if moving and k < 12 else 0)
            for k in range(self.n - 1)
        ]
        return [mpf(lead), *tail]

    def _scope(self, known: dict[str, Jet], x: list[Jet]) -> dict[str, Any]:
        scope: dict[str, Any] = dict(known) | self.modes
        for name, jet in zip(self.variables, x, strict=True):
            scope[name] = jet
            scope[name + "__dot"] = jets.der(jet)
        return scope

    def _defects(self, known: dict[str, Jet], x: list[Jet]) -> list[Jet]:
        value = Evaluator(self._scope(known, x), self.n)
        out = [value(e) for e in self.equations]
        for name, start in self.starts.items():
            here = x[self.variables.index(name)][0]
            out.append([here - value(start)[0]])
        return out

    def _jacobian(self, known: dict[str, Jet], x: list[Jet]) -> Any:
        value = Evaluator(self._scope(known, x), self.n)
        lengths = [len(d) for d in self._defects(known, x)]
        J = np.zeros((sum(lengths), len(x) * self.n))
        row = 0
        for rows, length in zip(self.slopes, lengths, strict=False):
            for j, (a, b) in rows.items():
                A = value(a) if a != 0 else []
                B = value(b) if b != 0 else []
                for k in range(length):
                    for i in range(self.n):
                        s = 0.0
                        if 0 <= k - i < len(A):
                            s += float(A[k - i])
                        if i and 0 <= k - i + 1 < len(B):
                            s += i * float(B[k - i + 1])
                        J[row + k, j * self.n + i] = s
            row += length
        for name in self.starts:
            J[row, self.variables.index(name) * self.n] = 1
            row += 1
        return J

    def _step(self, inverse: Any, defects: list[Jet], x: list[Jet], damp: float = 1) -> list[Jet]:
        flat = [c for d in defects for c in d]
        size = max((abs(c) for c in flat), default=mpf(0)) or mpf(1)
        move = inverse @ np.array([float(c / size) for c in flat])
        n = self.n
        return [
            [x[j][k] - damp * size * mpf(move[j * n + k]) for k in range(n)] for j in range(len(x))
        ]

    def solve(self) -> dict[str, Jet]:
        """The healthy signals; keeps the inverse for perturbed plants."""
        known = self.nominal | self.signals
        for _ in range(24):
            sizes: list[Any] = []
            x = [self.poly(self.lead(v), True, 0.3) for v in self.variables]
            try:
                for step in range(40):
                    d = self._defects(known, x)
                    sizes.append(max(abs(c) for r in d for c in r))
                    if sizes[-1] < 1e-6 and step:
                        break
                    if step > 12 and sizes[-1] > sizes[-7] / 2:
                        raise ValueError("this start leads nowhere")
                    inverse = np.linalg.pinv(self._jacobian(known, x), rcond=1e-12)
                    x = self._step(inverse, d, x, 0.5 if step < 4 else 1)
                else:
                    continue
                inverse = np.linalg.pinv(self._jacobian(known, x), rcond=1e-12)
            except (np.linalg.LinAlgError, ZeroDivisionError, ValueError, TypeError, OverflowError):
                continue
            self.inverse, self.x = inverse, x
            found = self.polish(known, x)
            if found is not None:
                self.x = found
                return self._measured(known, found)
        raise ArithmeticError(f"{self.plant.name}: the judge finds no healthy trajectory")

    def polish(self, known: dict[str, Jet], x: list[Jet]) -> list[Jet] | None:
        last = None
        for _ in range(40):
            d = self._defects(known, x)
            size = max(abs(c) for r in d for c in r)
            if size < 1e-26:
                return x
            if last is not None and size > last * 0.9:
                return None
            last = size
            x = self._step(self.inverse, d, x)
        return None

    def _measured(self, plant_known: dict[str, Jet], x: list[Jet]) -> dict[str, Jet]:
        value = Evaluator(self._scope(plant_known, x), self.n)
        return {s: value(e) for s, e in self.sensors.items()}

    def perturbed(self, fault: str, size: float = 1e-3) -> dict[str, Jet] | None:
        """The measured signals when one parameter or input moves; sensors add the move."""
        move = [mpf(self.random.random() + 0.2) * size for _ in range(min(self.n, 8))]
        move += [mpf(0)] * (self.n - len(move))
        known = self.nominal | self.signals
        if fault in self.sensors and fault not in self.readings:
            y = self._measured(known, self.x)
            y[fault] = jets.add(y[fault], move)
            return y
        moved = self.errors[fault].name if fault in self.readings else fault
        known = known | {moved: jets.add(known[moved], move)}
        x = self.polish(known, self.x)
        if x is None:
            return None if size < 1e-8 else self.perturbed(fault, size / 100)
        y = self._measured(known, x)
        return y | {fault: jets.add(y[fault], move)} if fault in self.readings else y


class Counts(NamedTuple):
    """What the frozen linearisation at the start of the trajectory says."""

    regular: bool
    n_arr: int
    undetectable: set[str]


def counts(sim: Simulator, x: list[Jet] | None = None) -> Counts:
    """Ranks of the linearised plant at one complex frequency, x' = s x."""
    s = complex(0.71, 0.93)
    value = Evaluator(sim._scope(sim.nominal | sim.signals, x or sim.x), sim.n)
    outside = [*sim.unknown, *sim.params, *sim.inputs]

    def row(e: Any) -> tuple[list[complex], list[complex]]:
        left = []
        for name in sim.variables:
            a = e.diff(sympy.Symbol(name, real=True))
            b = e.diff(sympy.Symbol(name + "__dot", real=True))
            left.append(
                (complex(value(a)[0]) if a != 0 else 0)
                + s * (complex(value(b)[0]) if b != 0 else 0)
            )
        right = []
        for name in outside:
            a = e.diff(sympy.Symbol(name, real=True))
            right.append(complex(value(a)[0]) if a != 0 else 0)
        return left, right

    rows = [row(e) for e in sim.equations]
    measured = [row(e) for e in sim.sensors.values()]
    P = np.array([r[0] for r in rows]).reshape(len(rows), len(sim.variables))
    regular = P.shape[0] == P.shape[1] == rank(P)
    whole = np.array([r[0] + r[1] for r in rows + measured])
    first = len(sim.variables) + len(sim.unknown)
    base = rank(whole[:, :first])
    n_arr = len(measured) - (base - len(sim.variables))
    hidden = set()
    for k, name in enumerate(sim.params + sim.inputs):
        column = whole[:, first + k : first + k + 1]
        if rank(np.hstack([whole[:, :first], column])) == base:
            hidden.add(name)
    for k, name in enumerate(sim.sensors):
        column = np.zeros((len(whole), 1))
        column[len(rows) + k] = 1
        if name in sim.readings:  # the machine runs on the error, too
            column[len(rows) - len(sim.readings) + sim.readings.index(name)] = -1
        if rank(np.hstack([whole[:, :first], column])) == base:
            hidden.add(name)
    return Counts(regular, n_arr, hidden)


def rank(matrix: Any) -> int:
    """With rows and columns brought to length one, so that scales do not matter."""
    m = matrix.astype(complex)
    m[abs(m) < 1e-14] = 0  # what the trajectory makes zero but for rounding
    for axis in (1, 0):
        size = np.linalg.norm(m, axis=axis, keepdims=True)
        m = m / np.where(size == 0, 1, size)
    values = np.linalg.svd(m, compute_uv=False)
    return int((values > 1e-9).sum())
