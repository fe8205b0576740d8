"""The paper's equations (3), (10) and (23), solved backwards from chosen motions.

Nothing here uses the compiler: the speeds are chosen as functions of time, and the inputs that
make them a solution follow from the equations one after the other.
"""

from __future__ import annotations

import sympy as sp

t = sp.Symbol("t", real=True)

# Parameters as symbols of one drive and of the cable, with numbers of ordinary size.
L, Re, k, Je, fe, K, N, Js, fs, R, tau0, A = sp.symbols("L Re k Je fe K N Js fs R tau0 A")
RL, LL, CL = sp.symbols("R_L L_L C_L")
NUMBERS = {
    L: sp.Rational(3, 7),
    Re: sp.Rational(17, 6),
    k: sp.Rational(5, 4),
    Je: sp.Rational(2, 9),
    fe: sp.Rational(3, 11),
    K: sp.Rational(7, 5),
    N: sp.Rational(5, 2),
    Js: sp.Rational(8, 3),
    fs: sp.Rational(4, 9),
    R: sp.Rational(6, 5),
    tau0: sp.Rational(1, 3),
    A: sp.Rational(-4),
    RL: sp.Rational(16, 5),
    LL: sp.Rational(5, 3),
    CL: sp.Rational(11, 10),
}


def backlash(We: sp.Expr, Ws: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """The angle of the shaft's twist, from 0, and the torque w of (3) as it is printed."""
    s = sp.Symbol("s", real=True)
    twist = sp.integrate((We - N * Ws).subs(t, s), (s, 0, t))
    gamma = 1 / (2 * tau0)
    e = sp.exp(-gamma * twist)
    return twist, A * K * tau0 * (1 - e) / (1 + e)


def drive(We: sp.Expr, Ws: sp.Expr) -> dict[str, sp.Expr]:
    """The voltage and the contact force that make two speeds a solution of (10)."""
    twist, w = backlash(We, Ws)
    Fx = (-Js * Ws.diff(t) - fs * Ws + N * w + N * K * twist) / R
    i = (Je * We.diff(t) + fe * We + w + K * twist) / k
    U0 = L * i.diff(t) + Re * i + k * We
    return {"U0": U0, "Fx": Fx, "We": We, "Ws": Ws}


def cable(Us: sp.Expr, output: bool) -> dict[str, sp.Expr]:
    """The voltage that makes Us a solution of (23) with its dot restored.

    The current at the end is that of a capacitor C_L (`output`, equation (21)) or zero.
    """
    i_s = CL * Us.diff(t) if output else sp.Integer(0)
    UL = LL / 2 * sp.diff(i_s, t) + RL / 2 * i_s + Us
    i_in = CL * UL.diff(t) + i_s
    Uin = LL / 2 * i_in.diff(t) + RL / 2 * i_in + UL
    return {"Uin": Uin, "Us": Us}


# ------------------------------------------------- relations derived by hand, PAPER_CHECKED order


def torque(s: dict[str, sp.Expr], extra: sp.Expr | int = 0) -> sp.Expr:
    """The motor's torque from both balances; w cancels unless the drawing adds `extra`."""
    load = Js * s["Ws"].diff(t) + fs * s["Ws"] + R * s["Fx"]
    return Je * s["We"].diff(t) + fe * s["We"] + load / N + extra


def r1(s: dict[str, sp.Expr], extra: sp.Expr | int = 0) -> sp.Expr:
    """Voltages of the armature with the current taken from the torque."""
    T = torque(s, extra)
    return k * s["We"] - s["U0"] + Re / k * T + L / k * T.diff(t)


def r2(s: dict[str, sp.Expr]) -> sp.Expr:
    """Twist rate of the shaft against the rate of the torque that it carries."""
    _, w = backlash(s["We"], s["Ws"])
    load = Js * s["Ws"].diff(t) + fs * s["Ws"] + R * s["Fx"] - N * w
    return load.diff(t) / N + K * (N * s["Ws"] - s["We"])


def r3(s: dict[str, sp.Expr]) -> sp.Expr:
    """The cable with the capacitor C_L at its end: a ladder of two sections."""
    Us = s["Us"]
    half = LL / 2
    one = Us + RL / 2 * CL * Us.diff(t) + half * CL * Us.diff(t, 2)
    current = CL * one.diff(t) + CL * Us.diff(t)
    return s["Uin"] - (one + RL / 2 * current + half * current.diff(t))


def r3a(s: dict[str, sp.Expr]) -> sp.Expr:
    """The cable with no current at its end."""
    Us = s["Us"]
    return s["Uin"] - Us - RL * CL / 2 * Us.diff(t) - LL * CL / 2 * Us.diff(t, 2)


# ------------------------------------------------------------------------------ as printed


def printed_24(s: dict[str, sp.Expr]) -> sp.Expr:
    """Equation (24), letter by letter."""
    _, w = backlash(s["We"], s["Ws"])
    load = fs * s["Ws"] - N * w + Js * s["Ws"].diff(t)
    T = Je * s["We"].diff(t) - w + fe * s["We"] + load / N
    return k * s["We"] - s["U0"] + Re / k * T + L / k * T.diff(t)


def printed_25(s: dict[str, sp.Expr]) -> sp.Expr:
    """Equation (25), letter by letter."""
    _, w = backlash(s["We"], s["Ws"])
    load = fs * s["Ws"] + Js * s["Ws"].diff(t) - N * w + R * s["Fx"]
    return N * load.diff(t) + K * (N * s["Ws"] - s["We"])


def printed_26(s: dict[str, sp.Expr]) -> sp.Expr:
    """Equation (26), letter by letter."""
    Us = s["Us"]
    return (
        s["Uin"]
        - LL**2 * CL**2 / 4 * Us.diff(t, 4)
        + (RL**2 * CL**2 / 4 - LL * CL / 2) * Us.diff(t, 2)
        + RL * CL / 2 * Us.diff(t)
        + Us
    )
