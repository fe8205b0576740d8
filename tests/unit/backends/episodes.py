"""Episodes that nobody simulated: noise, a step, gaps, verdicts, curves."""

from __future__ import annotations

import numpy as np

from bondgraph.backends.report.episode import Curve, Episode, Mark, Panel, Plane, Said, Trace


def episode(name: str, samples: int = 4000, residuals: int = 3) -> Episode:
    """A run of `samples` at 100 Hz in which the first residual leaves its threshold for good."""
    rng = np.random.default_rng(5)
    t = np.arange(samples) / 100
    end = float(t[-1])
    valid = t > 0.02 * end
    valid[int(0.5 * samples) : int(0.53 * samples)] = False
    traces = []
    for k in range(residuals):
        value = 0.01 * rng.standard_normal(samples)
        if k == 0:
            value += np.where(t > 0.4 * end, 0.2, 0.0)
        bound = 0.05 + 0.02 * np.abs(np.sin(t)) if k < 2 else None
        traces.append(Trace(f"r{k + 1}", value, "V", bound, valid))
    turn = 0.1 * t
    curves = [Curve(n, (1 + s) * np.sin(turn), 1 - np.cos(turn * (1 - s)))
              for n, s in (("desired", 0.0), ("virtual", 0.01), ("real", 0.02))]  # fmt: skip
    return Episode(
        name,
        "A turn to the left.",
        t,
        tuple(traces),
        (
            Panel("speed", "rad/s", (Trace("wanted", 5 + 0 * t), Trace("left", 5 + np.sin(t)))),
            Panel("U", "V", (Trace("U", np.sign(np.sin(t / 9))),)),
        ),
        (Plane("Trajectory in the plane", "x in m", "y in m", tuple(curves)),),
        (Mark(0.4 * end, "m[1].el.Re +30 %"), Mark(0.42 * end, "fe x 2"), Mark(end, "end of it")),
        (
            Said("warm-up", 0.0, 0.02 * end, "warm-up", "Warming up."),
            Said("fault", 0.41 * end, None, "m[1].el.Re or m[1].el.k",
                 "m[1].el.Re (80 %), m[1].el.k (20 %)", 0.4 * end),
            Said("gap", 0.5 * end, 0.53 * end, "gap", "No samples & nothing < said."),
            Said("update", 0.97 * end, end, "now m[1].el.Re is the one", "It is the resistance."),
        ),
        (("Sampling", "100 Hz"),),
    )  # fmt: skip
