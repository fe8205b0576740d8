"""KheperaPlausible watched by its residuals; a program to start from.

Put your sensors into read_samples and what to do about a fault into raise_alarm.
"""

from __future__ import annotations

import khepera_plausible_residuals as m

TICKS = 1000

#: How far a residual may be from 0 while all is well: measure this on your healthy machine.
THRESHOLD = {
    "r1": 0.001,
    "r2": 0.001,
    "r3": 0.001,
    "r4": 0.001,
    "r5": 0.001,
}


def read_samples() -> m.Samples:
    """One sample of every signal, all taken at the same moment. Here: a machine at rest."""
    return m.Samples(
        # N: Contact forces, known as in the paper; each loads its wheel and moves the body,
        # robot.Fx[1]
        robot__Fx__1=0.0,
        # N: Contact forces, known as in the paper; each loads its wheel and moves the body,
        # robot.Fx[2]
        robot__Fx__2=0.0,
        robot__U0__1=0.0,         # V: robot.U0[1]
        robot__U0__2=0.0,         # V: robot.U0[2]
        robot__Uin=0.0,           # V: robot.Uin
        robot__m__1__me__we=0.0,  # rad/s: robot.m[1].me.we
        robot__m__1__wh__ws=0.0,  # rad/s: robot.m[1].wh.ws
        robot__m__2__me__we=0.0,  # rad/s: robot.m[2].me.we
        robot__m__2__wh__ws=0.0,  # rad/s: robot.m[2].wh.ws
        robot__Us=0.0,            # V: robot.Us
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
