"""Ranges of the signals of the shipped models that there are whole numbers for, by model."""

from __future__ import annotations

Ranges = dict[str, tuple[float, float]]


def _robot(path: str) -> Ranges:
    found = {f"{path}{name}": (-12.0, 12.0) for name in ("Uin", "Us", "U0[1]", "U0[2]")}
    for k in (1, 2):
        found[f"{path}Fx[{k}]"] = (-2.0, 2.0)
        found[f"{path}m[{k}].me.we"] = (-250.0, 250.0)
        found[f"{path}m[{k}].wh.ws"] = (-8.0, 8.0)
    return found


def _drive(path: str) -> Ranges:
    return {
        "U0": (-12.0, 12.0),
        "Fx": (-2.0, 2.0),
        f"{path}me.we": (-250.0, 250.0),
        f"{path}wh.ws": (-8.0, 8.0),
    }


_SUPPLY: Ranges = {"Uin": (-12.0, 12.0), "Us": (-12.0, 12.0)}

RANGES: dict[str, Ranges] = {
    "dc_motor": {
        "load": (-1e-3, 1e-3), "U": (-12.0, 12.0), "current": (-1.0, 1.0), "speed": (-300.0, 300.0)
    },
    "khepera": _robot(""),
    "khepera_built": {
        **{name: (-12.0, 12.0) for name in ("Uin", "Us", "U0[1]", "U0[2]")},
        "Fx[1]": (-2.0, 2.0), "Fx[2]": (-2.0, 2.0),
        "m[1].motor": (-3.0, 3.0), "m[2].motor": (-3.0, 3.0),
    },
    "khepera_plausible": _robot("robot."),
    "drive": _drive("m."),
    "drive_fig6": _drive(""),
    "cable": _SUPPLY,
    "cable_open": _SUPPLY,
    "chassis": {
        "body.Fx[1]": (-2.0, 2.0), "body.Fx[2]": (-2.0, 2.0), "u": (-1.0, 1.0), "yaw": (-5.0, 5.0)
    },
    "two_tanks": {"Q": (0.0, 1e-3), "p1": (-1e3, 2e4), "p2": (0.0, 2e4)},
    "hydraulic_actuator": {
        "ps": (0.0, 2e7), "spool": (-1.0, 1.0), "load": (-2e4, 2e4), "p": (0.0, 2e7),
        "v": (-1.0, 1.0),
    },
    "microphone": {
        "U0": (0.0, 100.0), "pressure": (-10.0, 10.0), "u": (0.0, 100.0), "v": (-1e-4, 1e-4),
        "r1_q": (-5e-6, 5e-6), "r2_q": (-5e-6, 5e-6), "r2_q_2": (-0.1, 0.1),
    },
    "quarter_car": {"vw": (-5.0, 5.0), "vb": (-5.0, 5.0), "stroke": (-0.2, 0.2)},
    "rc_loop": {"U": (-5.0, 5.0), "ua": (-5.0, 5.0), "uc": (-5.0, 5.0)},
    "rigid_gear": {"T": (-1.0, 1.0), "w1": (-100.0, 100.0), "w2": (-100.0, 100.0)},
}  # fmt: skip
