"""How far a healthy residual may be from zero for no parameter: by the sampling and the code."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from bondgraph.ir.program import law_pace
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.sensor_jumps import Jumps
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine

_FASTER = 4.0  # times the bandwidth, of the filter that an approximation is held against
_FASTEST = 2.0  # bandwidth * sample_time, above which a filter is what it is there
_BIAS = 1.5  # times what an approximation is off by as the two filters tell: noise is left over
#: Times how far a walk goes in a row, and the root of their number. A walk over the root of time is
#: a process of Ornstein and Uhlenbeck in the logarithm of time: it leaves c deviations c phi(c)
#: times while time becomes e times as long, which is 0.0005 times with this one.
_WALK = 4.0


class Doubt:
    """Tells what no tolerance does of a threshold, and which residuals have no value.

    - A switch turns between two samples: the residual may be off by as much as it makes to turn
      one sample later. Where filtered derivatives stand behind a switch they are of both its
      positions until the filter has settled, and the residual has no meaning.
    - A converter holds a command until the next one, so that it acts half a sample later than
      what moves in straight lines from sample to sample: as much as that makes is in doubt. What
      it made at most while noise was learned is in the noise; only where it is more, it counts.
    - So does what a sensor reads where it jumps between two samples, as an accelerometer does when
      a rope gives way: nobody knows when between them.
    - A nonlinear law of filtered derivatives is off by what the filter in front of it does to the
      signals. With half the time constants that is a quarter. What comes out of it then is filtered
      by what the slower filters have more: what is linear is the same by both ways, to the last
      digit and however fast it moves, as what a fault does to a derivative. The rest shows how much
      it is.
    - What adds up readings for ever adds up their noise, which walks away with the root of time.
    """

    def __init__(self, engine: Engine, model: DiagnosisModel) -> None:
        self._engine = engine
        self._every = rows_apart(engine)
        natures = [model.natures[name] for name in engine.residuals]
        place = {k.path: at for at, k in enumerate(engine.signals)}
        self._modes = sorted({place[m] for n in natures for m in n.modes})
        self._commands = [place[k.path] for k in engine.signals if k.kind == "input"]
        self._sensors = [
            place[k.path] for k in engine.signals if k.kind == "sensor" and k.counts is None
        ]
        self._bent = [(k, n.stages, n.laws) for k, n in enumerate(natures) if n.approximate]
        pace = engine.bandwidth * engine.sample_time
        self._faster = max(min(_FASTER, _FASTEST / pace), 1.0)
        usual, fast = (min(law_pace(x), _FASTEST) for x in (pace, self._faster * pace))
        #: Times what they differ by: a bias falls with the square of the bandwidth before laws.
        self._bias_share = _BIAS / (1.0 - (usual / fast) ** 2) if fast > usual else 0.0
        self.reset()

    def reset(self) -> None:
        """The next sample is the first."""
        engine = self._engine
        count = len(engine.residuals)
        self._jumps = Jumps(len(self._sensors))
        late = bool(self._modes or self._commands or self._sensors)
        self._late = engine.configured(bounds=False) if late else None
        faster = engine.bandwidth * self._faster
        self._fast = engine.configured(bandwidth=faster, bounds=False) if self._bent else None
        self._slower = [_Slower(engine, self._faster, n, laws) for _, n, laws in self._bent]
        self._sample: Array | None = None
        self.acted = np.zeros((0, count))  #: of the last samples, by how much that is in doubt
        self._peak = np.zeros((2, count))  # of this row and the one before
        self._age = 0

    def run(
        self, samples: Array, batch: Batch, number: int, walk: Array, held: Array
    ) -> tuple[Array, Mask]:
        """By how much each residual is in doubt, and which have a value; both (n, residuals).

        `batch` are the residuals of the samples, of which `number` counts the first one from the
        start of time. `walk` is how far what a residual adds up goes in a row, a deviation, `held`
        what is in its noise of what commands and switches make (`acted`).
        """
        doubt, valid = np.zeros_like(batch.value), batch.valid.copy()
        if self._late is not None:
            self.acted = self._late_by(self._late, samples, batch, valid)
            doubt += np.where(self.acted > held, self.acted, 0.0)
        if self._fast is not None:
            doubt += self._bias(self._fast, samples, batch, valid, number)
        if walk.any():
            rows = (self._age + 1 + np.arange(len(samples))) / self._every
            doubt += _WALK * walk * np.sqrt(rows)[:, None]
        self._age += len(samples)
        return doubt, valid

    def _late_by(self, late: Engine, samples: Array, batch: Batch, valid: Mask) -> Array:
        """What it makes that commands and jumps of sensors come half a sample later, and switches a
        whole one."""
        if not len(samples):
            return np.zeros_like(batch.value)
        last = samples[0] if self._sample is None else self._sample
        before = np.vstack([last, samples[:-1]])
        told = samples.copy()
        told[:, self._modes] = before[:, self._modes]
        told[:, self._commands] = 0.5 * (told + before)[:, self._commands]
        told[:, self._sensors] -= 0.5 * self._jumps.run((samples - before)[:, self._sensors])
        self._sample = samples[-1].copy()
        other = late.run(told)
        return np.where(other.valid & valid, np.abs(batch.value - other.value), 0.0)

    def _bias(
        self,
        fast: Engine,
        samples: Array,
        batch: Batch,
        valid: Mask,
        number: int,
    ) -> Array:
        """What the approximations are off by: the most of this row and the one before."""
        other = fast.run(samples)
        off = np.zeros_like(batch.value)
        for (k, *_), slower in zip(self._bent, self._slower, strict=True):
            sound = batch.valid[:, k] & other.valid[:, k]
            slow = slower.run(other.value[:, k], other.valid[:, k])
            off[:, k] = np.where(sound, self._bias_share * np.abs(batch.value[:, k] - slow), 0.0)
            valid[:, k] &= sound
        start = 0
        while start < len(off):
            stop = min(len(off), start + self._every - (number + start) % self._every)
            part = off[start:stop]
            part[:] = np.maximum(np.maximum.accumulate(part, axis=0), self._peak[1])
            self._peak[1] = part[-1]
            part[:] = np.maximum(part, self._peak[0])
            if (number + stop) % self._every == 0:
                self._peak[0], self._peak[1] = self._peak[1].copy(), 0.0
            start = stop
        return off


class _Slower:
    """What the filters of an engine have more than those of one that is so many times faster."""

    def __init__(self, engine: Engine, times: float, stages: int, laws: int) -> None:
        usual = engine.bandwidth * engine.sample_time
        faster = times * usual
        one = _more(usual, faster), _more(law_pace(usual), law_pace(faster))
        self._stages = [one[0]] * stages + [one[1]] * laws
        self._memory = np.zeros((len(self._stages), 1))
        self._sound = False

    def run(self, values: Array, valid: Mask) -> Array:
        """Of values (n,); it is at rest at the first one that is valid."""
        from scipy.signal import lfilter

        begins = np.flatnonzero(valid & ~np.append(self._sound, valid)[:-1]).tolist()
        found = values.copy()
        for begin, end in pairwise(sorted({0, *begins, len(values)})):
            for (above, below), memory in zip(self._stages, self._memory, strict=True):
                if begin in begins:
                    memory[:] = (1.0 - above[0]) * values[begin]
                part = found[begin:end]
                found[begin:end], memory[:] = lfilter(above, below, part, zi=memory)
        self._sound = bool(valid[-1]) if len(valid) else self._sound
        return found


def _more(usual: float, faster: float) -> tuple[list[float], list[float]]:
    """One stage over a faster one, for bandwidth * sample_time of both: numerator, denominator."""
    kept, fast = (max(2.0 - x, 0.0) / (2.0 + x) for x in (usual, faster))
    new = (1.0 - kept) / (1.0 - fast)
    return [new, -fast * new], [1.0, -kept]  # two bilinear ones, as in `Filter`
