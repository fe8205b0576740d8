"""How late each form of a residual sees a fault: `python -m tests.forms`.

Two tanks in a row, the level of the upper one hidden, sampled every four seconds with a noise of
one percent. The plant is solved here, from its equations by hand. Beside both forms there is a
plain simulation of the healthy plant from the right start, without any correction. Each has a
limit of five standard deviations of itself on a healthy run; a fault is seen when two samples in
a row are beyond it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from statistics import median

import numpy as np
from scipy.integrate import solve_ivp

import bondgraph
from bondgraph.ir.program import Program
from bondgraph.runtime.batch import Lanes

MODEL = Path(__file__).with_name("cascade.bg")
RATE, SPAN, ONSET = 0.25, 8000.0, 4000.0
NOISE, KAPPA, SEEDS = 0.01, 5.0, 20
HEALTHY = {"A1": 0.02, "A2": 0.02, "k1": 1.2e-5, "k2": 1e-5, "leak1": 0.0, "leak2": 0.0,
           "Q": 1.0, "overflow": 1.0, "outflow": 1.0}  # fmt: skip
#: What each fault makes of its value; of the last three it is the gain of a signal.
FAULTS = {"A1": 0.04, "A2": 0.04, "k1": 0.9e-5, "k2": 0.9e-5, "leak1": 1e-6, "leak2": 1e-6,
          "Q": 0.9, "overflow": 0.5, "outflow": 0.95}  # fmt: skip
Trace = np.ndarray


def inflow(t: float) -> float:
    """What the pump gives."""
    return float(4e-4 * (1 + 0.3 * np.sin(0.05 * t)))


def plant(value: Callable[[str, float], float]) -> tuple[Trace, Trace, Trace]:
    """Times, outflow and overflow, solved to ten digits; `value` gives a parameter at a time."""

    def flows(t: float, level: Trace) -> tuple[float, float, float]:
        """Over the edge, between the tanks, out of the lower one."""
        high, low = np.maximum(9810 * level, 0.0)
        spill = 2e-7 * max(high - 1200, 0.0)
        between = value("k1", t) * np.sign(high - low) * np.sqrt(abs(high - low))
        return spill, between, value("k2", t) * np.sqrt(low)

    def rates(t: float, level: Trace) -> list[float]:
        spill, between, out = flows(t, level)
        lost = [value(name, t) * np.sqrt(max(9810 * h, 0.0))
                for name, h in zip(("leak1", "leak2"), level, strict=True)]  # fmt: skip
        gains = value("Q", t) * inflow(t) - spill - between - lost[0], between - out - lost[1]
        return [gains[0] / value("A1", t), gains[1] / value("A2", t)]

    t = np.arange(round(SPAN * RATE)) / RATE
    start = solve_ivp(rates, (-5000, 0), [0.2, 0.1], rtol=1e-9, atol=1e-10).y[:, -1]
    found = solve_ivp(rates, (0, SPAN), start, t_eval=t, rtol=1e-9, atol=1e-10, max_step=2.0)
    told = [flows(at, level) for at, level in zip(t, found.y.T, strict=True)]
    spill = np.array([f[0] * value("overflow", at) for f, at in zip(told, t, strict=True)])
    return t, np.array([f[2] * value("outflow", at) for f, at in zip(told, t, strict=True)]), spill


def simulated(signals: Mapping[str, Trace], start: Trace) -> Trace:
    """What the outflow is beyond that of a healthy plant which is told inflow and overflow."""
    (high, low), out, fine = start, [], 20
    rows = list(zip(*[signals[n] for n in ("Q", "overflow", "outflow")], strict=True))
    for now, then in zip(rows, [*rows[1:], rows[-1]], strict=True):
        out.append(now[2] - 1e-5 * np.sqrt(9810 * np.maximum(low, 0.0)))
        for k in range(fine):
            part = (k + 0.5) / fine  # what is told is linear between samples
            q, spill = (a + part * (b - a) for a, b in zip(now[:2], then[:2], strict=True))
            between = 1.2e-5 * np.sign(high - low) * np.sqrt(9810 * np.abs(high - low))
            leaving = 1e-5 * np.sqrt(9810 * np.maximum(low, 0.0))
            high = high + (q - spill - between) / 0.02 / RATE / fine
            low = low + (between - leaving) / 0.02 / RATE / fine
    return np.array(out)


def coded(program: Program, signals: Mapping[str, Trace]) -> Trace:
    """The residual r1 of a program."""
    lanes, states, out = Lanes(program, {}), None, []
    for row in zip(*signals.values(), strict=True):
        found, states = lanes.sample(dict(zip(signals, row, strict=True)), {}, {}, {}, states)
        out.append(np.broadcast_to(found["r1"], SEEDS))
    return np.array(out)


def residuals(
    programs: Mapping[str, Program], value: Callable[[str, float], float], seed: int
) -> dict[str, Trace]:
    """All residuals of a run, measured with the noise of each seed: samples by seeds."""
    t, out, spill = plant(value)
    draw = np.random.default_rng(seed)
    spilt, flown = [x[:, None] * (1 + NOISE * draw.standard_normal((len(t), SEEDS)))
                    for x in (spill, out)]  # fmt: skip
    pumped = np.repeat([[inflow(at)] for at in t], SEEDS, axis=1)
    told = {"Q": pumped, "overflow": spilt, "outflow": flown}
    # the right start: the upper level from what is spilled, the lower one from the outflow
    start = np.array([[1200 + spill[0] / 2e-7], [(out[0] / 1e-5) ** 2]]) / 9810
    found = {form: coded(program, told) for form, program in programs.items()}
    return {**found, "simulation": simulated(told, start * np.ones(SEEDS))}


def late(residual: Trace, sigma: float) -> float:
    """Seconds from the onset of a fault until two samples in a row are beyond the limit."""
    beyond = np.abs(residual[round(ONSET * RATE) :]) > KAPPA * sigma
    both = np.flatnonzero(beyond[1:] & beyond[:-1])
    return float((both[0] + 1) / RATE) if both.size else np.inf


def main() -> None:
    """The table: the median over seeds of the delay of each form, a row a fault."""
    programs = {form: bondgraph.compile(MODEL, rate=RATE, form=form).program
                for form in ("derivative", "observer")}  # fmt: skip
    healthy = residuals(programs, lambda name, t: HEALTHY[name], 1)
    sigma = {form: float(np.std(r[round(2000 * RATE) :])) for form, r in healthy.items()}
    print("| Fault | from | to | " + " | ".join(sigma) + " |")
    print("|---" * (3 + len(sigma)) + "|")
    for seed, (fault, wrong) in enumerate(FAULTS.items(), 2):

        def value(name: str, t: float, fault: str = fault, wrong: float = wrong) -> float:
            return wrong if name == fault and t > ONSET else HEALTHY[name]

        told = []
        for form, r in residuals(programs, value, seed).items():
            delay = median(late(r[:, k], sigma[form]) for k in range(SEEDS))
            told.append(f"{delay:g} s" if np.isfinite(delay) else "not seen")
        print(f"| `{fault}` | {HEALTHY[fault]:g} | {wrong:g} | {' | '.join(told)} |", flush=True)


if __name__ == "__main__":
    main()
