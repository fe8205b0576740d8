"""KheperaBuilt watched by its residuals; a program to start from.

Put your sensors into read_samples and what to do about a fault into raise_alarm.
"""

from __future__ import annotations

import khepera_built_residuals as m

TICKS = 1000

#: How far a residual may be from 0 while all is well: measure this on your healthy machine.
THRESHOLD = {
    "r1": 0.001,
    "r2": 0.001,
    "r3": 0.001,
}


def read_samples() -> m.Samples:
    """One sample of every signal, all taken at the same moment. Here: a machine at rest."""
    return m.Samples(
        Fx__1=0.0,      # N: Contact forces: rolling friction, known from the weight, Fx[1]
        Fx__2=0.0,      # N: Contact forces: rolling friction, known from the weight, Fx[2]
        U0__1=0.0,      # V: U0[1]
        U0__2=0.0,      # V: U0[2]
        Uin=0.0,        # V
        m__1__motor=0,  # 24 counts a turn; rad: m[1].motor
        m__2__motor=0,  # 24 counts a turn; rad: m[2].motor
        Us=0.0,         # V
    )


def raise_alarm(residual: str, value: float) -> None:
    """Say that something is wrong."""
    print(f"{residual} = {value:g}: look for a fault that it sees")


def main() -> None:
    """Watch the machine for a while."""
    monitor = m.Monitor()
    alarms = 0
    for _ in range(TICKS):  # every SAMPLE_TIME, from a timer
        residuals = monitor.step(read_samples())
        for name, threshold in THRESHOLD.items():
            value: float = getattr(residuals, name)
            if name in residuals.valid and abs(value) > threshold:
                raise_alarm(name, value)
                alarms += 1
    print(f"{TICKS} samples, {alarms} alarms")


if __name__ == "__main__":
    main()
