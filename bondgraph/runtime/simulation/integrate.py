"""Integration of state equations over one segment in which nothing jumps, by scipy's methods.

`Integrator` is for a whole run, `ShortSegments` has to keep up with the time on the wall.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.native_machine import BEYOND, NativeMachine
from bondgraph.text.diagnostic import Trouble

Inputs = Callable[[float], Sequence[float]]

_ABSOLUTE = 0.1  # of the relative tolerance, in units of the effort or flow of a state
_SPARSE = 60  # states from which on it pays to know which rate depends on which state
_MANY = 300  # states from which on eigenvalues cost more than they tell
_LARGE = 1e5  # units of effort or flow: a state that runs away
_START = 30_000  # rates, after which it can be told whether it will ever end
_CALLS = 5e8  # rates in a segment: hours
_PATIENCE = 2000  # such rates in a row, from which on a method will not find back
_OFTEN = 100  # rates between two words about how far it is
_RINGING = 1e5  # periods of one mode in a run: too many to follow
_NAMED = 2  # states that a ringing is told of, at most
_PART = 0.1  # of what the first of them has, from which on the other one is told
_COARSE = 1e-6  # relative tolerance of a step: finer than instruments are
_STEPS = 20_000  # in one segment, of a machine that has to keep up
_UNLIMITED = 2**31 - 1


class SimulationError(Trouble):
    """The machine cannot go on: no solution, or a law without a value; the message says when."""


class Integrator:
    """Chooses a method at the start of a run and keeps to it.

    `auto` is LSODA (Petzold, 1983), which finds out itself whether the machine is stiff; its
    multistep formulas are of no use where something rings far faster than the run is long, so that
    is left to Radau (Hairer and Wanner, 1996), which damps it.
    """

    def __init__(
        self,
        method: str,
        tolerance: float,
        duration: float,
        longest: float = math.inf,
        tell: Callable[[float], None] = lambda _: None,
    ) -> None:
        self.method = method
        self.tolerance = tolerance  # of a step, relative to each state
        self.duration = duration
        self.tell = tell  # of the time that integration has come to, now and then
        self._scales: dict[Machine, Array] = {}
        self.longest = longest  # step, in s: an input that moves smoothly is not run past

    def run(
        self,
        machine: Machine,
        inputs: Inputs,
        a: float,
        b: float,
        x: Array,
        wanted: Array,
        native: NativeMachine | None = None,
    ) -> Array:
        """The states at the `wanted` times in [a, b], and at b in the last row.

        `native` is the machine with these inputs, perhaps compiled. Raises `SimulationError` with
        the time, and the law or loop that has no value there.
        """
        if not len(x) or b <= a:
            return np.tile(x, (len(wanted) + 1, 1))
        if self.method == "auto":
            self.method = self._chosen(machine, inputs, a, x)
        ends = np.clip([*wanted, b], a, b)
        at = np.unique(ends)
        for method in dict.fromkeys((self.method, "Radau")):
            tried = _Tried(machine, inputs, (a, b), x, self.tell, native)
            found = self._solved(method, tried, x, at)
            if found is not None:
                return np.asarray(found[np.searchsorted(at, ends)])
        raise SimulationError(f"the run ends at {tried.t:.6g} s: {tried.trouble()}")

    def _solved(self, method: str, tried: _Tried, x: Array, at: Array) -> Array | None:
        relative, scale = self.tolerance, self._scale(tried, x)
        try:
            with np.errstate(all="ignore"):
                if method == "LSODA":
                    rates = tried.quick or tried  # one call less
                    return _odepack(rates, tried.span[0], x, at, relative, scale, self.longest)
                return self._by_steps(method, tried, x, at, _ABSOLUTE * relative * scale)
        except (ValueError, _Standstill):  # a slope that is no number is a ValueError of scipy
            return None
        finally:
            tried.close()

    def _by_steps(
        self, method: str, tried: _Tried, x: Array, at: Array, absolute: Array
    ) -> Array | None:
        from scipy.integrate import solve_ivp

        options: dict[str, Any] = {}
        if method in ("Radau", "BDF") and len(x) >= _SPARSE:
            options["jac_sparsity"] = tried.machine.pattern()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = solve_ivp(
                lambda t, y: np.array(tried(t, y)),  # what it gets it keeps
                tried.span,
                x,
                method,
                t_eval=at,
                max_step=self.longest,
                rtol=self.tolerance,
                atol=absolute,
                **options,
            )
        whole = found.status == 0 and np.isfinite(found.y).all()
        return np.asarray(found.y.T) if whole else None

    def _scale(self, tried: _Tried, x: Array) -> Array:
        """How much of each state matters, as it is where a machine runs for the first time."""
        machine, t = tried.machine, tried.span[0]
        if machine not in self._scales:
            self._scales[machine] = machine.scale(t, x.tolist(), tried.inputs(t))
        return self._scales[machine]

    def _chosen(self, machine: Machine, inputs: Inputs, t: float, x: Array) -> str:
        if len(x) >= _MANY:
            return "Radau"
        with np.errstate(all="ignore"):
            modes = np.linalg.eigvals(machine.jacobian(t, x, inputs(t)))
        ringing = float(np.max(np.abs(modes.imag))) * self.duration / (2 * np.pi)
        return "Radau" if ringing > _RINGING else "LSODA"


def _odepack(
    rates: Callable[[float, Array], Sequence[float] | Array],
    a: float,
    x: Array,
    at: Array,
    relative: float,
    scale: Array,
    longest: float = math.inf,
    most: int = _UNLIMITED,
) -> Array | None:
    """The states at ascending times from a on, by LSODA with its loop outside of Python.

    `relative` is the tolerance of a step, `scale` how much of each state matters; a step is at most
    the `longest`, and there are at most so many from one time to the next. None where it fails.
    """
    from scipy.integrate import ODEintWarning, odeint

    times = at if at[0] == a else np.concatenate([[a], at])
    if len(times) == 1:
        return np.array([x])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", ODEintWarning)
        try:
            found = odeint(
                rates,
                x,
                times,
                tfirst=True,
                rtol=relative,
                atol=_ABSOLUTE * relative * scale,
                tcrit=times[-1:],
                hmax=longest if math.isfinite(longest) else 0.0,
                mxstep=most,
            )
        except ODEintWarning:
            return None
    return found[len(times) - len(at) :] if np.isfinite(found).all() else None


class _Standstill(Exception):
    """A method that is lost where rates are no numbers."""


class _Tried:
    """The rates as scipy asks for them; remembers where it asked last and where there were none."""

    def __init__(
        self,
        machine: Machine,
        inputs: Inputs,
        span: tuple[float, float],
        start: Array,
        tell: Callable[[float], None],
        native: NativeMachine | None,
    ) -> None:
        self.machine, self.inputs, self.span, self.tell = machine, inputs, span, tell
        self.calls = 0
        self.t, self.x = span[0], start.tolist()
        self.failed = False
        self._in_vain = 0
        self._native = native
        self.quick = None if native is None else native.rates(self._slowly)

    def __call__(self, t: float, x: Array) -> Sequence[float] | Array:
        return self._slowly(t, x) if self.quick is None else self.quick(t, x)

    def _slowly(self, t: float, x: Array) -> Sequence[float]:
        """The rates in Python; it also counts those of compiled code, which asks now and then."""
        native = self._native
        if native is not None:
            if native.count(1):
                self.quick = native.rates(self._slowly)
            calls = native.go_on()
            if calls > 1:
                self._in_vain = 0
            self._look(t, calls)
        return self._plainly(t, x.tolist())

    def _look(self, t: float, calls: int) -> None:
        """After some more rates: tell how far it is, and give up what would take hours."""
        before, self.calls = self.calls, self.calls + calls
        if self.calls // _OFTEN > before // _OFTEN:
            self.tell(t)
            share = (t - self.span[0]) / (self.span[1] - self.span[0])
            if self.calls > _START and share * _CALLS < self.calls:
                raise _Standstill

    def _plainly(self, t: float, state: list[float]) -> Sequence[float]:
        """The rates in Python, and whether they are any."""
        self._look(t, 1)
        found = self.machine.rates(t, state, self.inputs(t))
        bad = not sum(map(abs, found)) < BEYOND  # also where one of them is no number
        self._in_vain = self._in_vain + 1 if bad else 0
        if self._in_vain > _PATIENCE:
            raise _Standstill
        bad = bad and all(map(math.isfinite, state))
        if bad or not self.failed:
            self.t, self.x, self.failed = t, state, bad or self.failed
        return found

    def close(self) -> None:
        """Nothing more is asked: remember where the last rates were."""
        last = None if self._native is None else self._native.last
        if last is not None and not self.failed:
            self.t, self.x = last

    def trouble(self) -> str:
        """Why it cannot go on."""
        u = self.inputs(self.t)
        found = self.machine.trouble(self.t, self.x, u) if self.failed else ""
        if found:
            return found
        if (np.abs(self.x) > _LARGE * self.machine.scale(self.t, self.x, u)).any():
            return "the solution grows without bound"
        ringing = self._ringing(u)
        if ringing:
            return ringing
        return (
            "steps become too small to go on; a law that jumps where the machine would rest"
            " (`sign`, `if`) does that, a steep `tanh` does not"
        )

    def _ringing(self, u: Sequence[float]) -> str:
        """What rings far too fast to be followed to the end, empty if nothing does."""
        if len(self.x) >= _MANY or self.failed:
            return ""
        with np.errstate(all="ignore"):
            slopes = self.machine.jacobian(self.t, np.array(self.x), u)
            if not np.isfinite(slopes).all():  # where a law ends there are none to one side
                return ""
            modes, right = np.linalg.eig(slopes)
            fastest = int(np.argmax(np.abs(modes.imag)))
            hertz = abs(modes[fastest].imag) / (2 * np.pi)
            if not hertz * (self.span[1] - self.t) > _RINGING:
                return ""
            # how much each state has part in it, whatever its unit is
            part = np.abs(right[:, fastest] * np.linalg.pinv(right)[fastest])
        first = np.argsort(-part, kind="stable")[:_NAMED]
        own = [k for k in first.tolist() if part[k] > _PART * part[first[0]]]
        names = " and ".join(f"`{self.machine.states[k]}`" for k in sorted(own))
        verb = "rings" if len(own) == 1 else "ring"
        return (
            f"{names} {verb} at {hertz:.3g} Hz, far too fast for so long a run; `quasi_static`"
            " in the scenario takes a part, such as a cable, as being at rest"
        )


class ShortSegments:
    """As `Integrator`, with less around it: LSODA (Petzold, 1983) straight from ODEPACK.

    A step is no finer than the tolerance 1e-6. What this cannot do, and all that a scenario names a
    method for, is left to `Integrator`, which also says what went wrong.
    """

    def __init__(self, method: str, tolerance: float, horizon: float) -> None:
        self._other = Integrator(method, tolerance, horizon)
        self._named = method != "auto"
        self._tolerance = max(tolerance, _COARSE)
        self._scales: dict[Machine, Array] = {}

    def run(
        self,
        machine: Machine,
        inputs: Inputs,
        a: float,
        b: float,
        x: Array,
        wanted: Array,
        native: NativeMachine | None = None,
    ) -> Array:
        """The states at the `wanted` times in [a, b], and at b in the last row.

        Raises `SimulationError` as `Integrator.run` does.
        """
        if len(x) and b > a and not self._named:
            found = self._quickly(machine, inputs, a, x, [*wanted.tolist(), b])
            if found is not None:
                return found
        return self._other.run(machine, inputs, a, b, x, wanted, native)

    def _quickly(
        self, machine: Machine, inputs: Inputs, a: float, x: Array, times: Sequence[float]
    ) -> Array | None:
        if machine not in self._scales:
            self._scales[machine] = machine.scale(a, x.tolist(), inputs(a))
        slopes = machine.rates

        def rates(t: float, y: Array) -> Sequence[float]:
            return slopes(t, y.tolist(), inputs(t))

        ends = np.array(times)
        at = np.unique(ends)
        scale = self._scales[machine]
        found = _odepack(rates, a, x, at, self._tolerance, scale, most=_STEPS)
        return None if found is None else found[np.searchsorted(at, ends)]
