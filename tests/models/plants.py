"""The machines of models/ by hand: from chosen motions to all signals that are known.

Nothing here uses the compiler. Each function chooses some motions as polynomials of t and follows
the physics backwards, without solving anything: parameters may be functions of t, so that a fault
is a parameter that changes. `F` gives the value of a parameter or constant by its name.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy as sp

t = sp.Symbol("t", nonnegative=True)
Signals = dict[str, sp.Expr]
Values = Callable[[str], sp.Expr]


def q(a: int, b: int = 1) -> sp.Rational:
    return sp.Rational(a, b)


def d(x: sp.Expr) -> sp.Expr:
    return sp.diff(x, t)


def since_start(x: sp.Expr, start: sp.Expr = q(0)) -> sp.Expr:
    """The integral of a polynomial from time zero."""
    s = sp.Symbol("s", nonnegative=True)
    return start + sp.integrate(sp.expand(x.subs(t, s)), (s, 0, t))


def ssqrt(x: sp.Expr) -> sp.Expr:
    return sp.sign(x) * sp.sqrt(sp.Abs(x))


def dc_motor(F: Values) -> Signals:
    current, speed = 1 + t + t**3 / 5, 2 - t**2 + t**3
    U = d(F("L") * current) + F("R") * current + F("k") * speed
    load = F("k") * current - d(F("J") * speed) - F("f") * speed
    return {"current": current, "speed": speed, "U": U, "load": load}


def chassis(F: Values) -> Signals:
    u, yaw = 2 + t - t**3, 1 - 2 * t + t**2
    total = d(F("body.m") * u) + F("body.fm") * u
    moment = d(F("body.Iz") * yaw) + F("body.fz") * yaw
    arm = F("body.d") / 2
    return {
        "u": u,
        "yaw": yaw,
        "body.Fx[1]": (total + moment / arm) / 2,
        "body.Fx[2]": (total - moment / arm) / 2,
    }


def ladder(F: Values, cells: int, capacitor: bool) -> Signals:
    """Walks from the end of the line to its beginning."""
    R, L, C = (F(f"line.{x}") / cells for x in "RLC")
    Us = 1 + t**2 - t**5 / 3 + t**9
    voltage = Us
    current = d(F("line.C") * Us) if capacitor else q(0)
    for _ in range(cells):
        voltage = voltage + R / 2 * current + d(L / 2 * current)
        current = current + d(C * voltage)
        voltage = voltage + R / 2 * current + d(L / 2 * current)
    return {"Us": Us, "Uin": voltage}


def two_tanks(F: Values) -> Signals:
    p2 = 2 + t
    weight = F("rho") * F("g")
    between = d(F("A2") / weight * p2) + F("kout") * ssqrt(p2)
    p1 = p2 + (between / F("k12")) ** 2  # the flow goes down the line
    Q = d(F("A1") / weight * p1) + F("leak") * ssqrt(p1) + between
    return {"p1": p1, "p2": p2, "Q": Q}


def rigid_gear(F: Values) -> Signals:
    w2 = 1 + t + t**3
    w1 = F("N") * w2
    load = d(F("J2") * w2) + F("f2") * w2
    return {"w1": w1, "w2": w2, "T": d(F("J1") * w1) + F("f1") * w1 + load / F("N")}


def hydraulic_actuator(F: Values) -> Signals:
    p, v, spool = 5 + t**2, 1 + t / 2, q(1, 2) + t / 9
    through = d(F("V") / F("B") * p) + F("leak") * p + F("A") * v
    drop = (through / (F("kv") * spool)) ** 2  # all flows are positive here
    load = F("A") * p - d(F("m") * v) - F("b") * v
    return {"p": p, "v": v, "spool": spool, "ps": p + drop, "load": load}


def slider_crank(F: Values) -> Signals:
    speed = q(1, 3) + t / 5
    th = since_start(speed)
    r, length = F("r"), F("l")
    lever = r * sp.sin(th)
    lever *= 1 + r * sp.cos(th) / sp.sqrt(length**2 - r**2 * sp.sin(th) ** 2)
    v = lever * speed
    load = 1 + t
    force = d(F("m") * v) + F("c") * v + load
    return {
        "speed": speed,
        "load": load,
        "T": d(F("J") * speed) + F("f") * speed + lever * force,
    }


def microphone(F: Values) -> Signals:
    u, v = 3 + t**2, 1 + t
    gap = since_start(v, F("x0"))
    charge = u * F("eps") * F("A") / gap
    pull = charge**2 / (2 * F("eps") * F("A"))
    sound = pull + d(F("m") * v) + F("b") * v + F("k") * since_start(v)
    return {
        "u": u,
        "v": v,
        "U0": u + F("R") * d(charge),
        "pressure": sound / F("A"),
    }


def quarter_car(F: Values) -> Signals:
    """The road is not known: only the body on its strut gives relations."""
    stroke = q(1, 2) + t**3
    push = F("ks") * stroke + F("cs") * d(stroke) - F("ms") * F("g")
    vb = since_start(push, q(3)) / F("ms")
    return {"vb": vb, "vw": vb + d(stroke), "stroke": stroke}


def rc_loop(F: Values) -> Signals:
    """A power series: exact at t = 0 up to its order."""
    U, order = 1 + t - t**2, 5
    a, c = q(2), q(-1)
    Rab, Rbc, Rca = F("Rab"), F("Rbc"), F("Rca")
    for _ in range(order):
        b = (U / F("R0") + a / Rab + c / Rbc) / (1 / F("R0") + 1 / Rab + 1 / Rbc)
        into_a = (b - a) / Rab - (a - c) / Rca
        into_c = (b - c) / Rbc + (a - c) / Rca
        charge_a = F("Ca").subs(t, 0) * 2 + sp.integrate(_truncated(into_a, order), t)
        charge_c = -F("Cc").subs(t, 0) + sp.integrate(_truncated(into_c, order), t)
        a = _truncated(charge_a / F("Ca"), order)
        c = _truncated(charge_c / F("Cc"), order)
    return {"U": U, "ua": a, "uc": c}


def _truncated(x: sp.Expr, order: int) -> sp.Expr:
    return sp.series(sp.together(x), t, 0, order + 1).removeO()


def oven(F: Values) -> Signals:
    Th, To = 5 + t**2, 3 + t
    across = F("Gh") * (Th - To)
    Ta = To - (across - d(F("Co") * To)) / F("Go")
    return {"Th": Th, "To": To, "Ta": Ta, "P": d(F("Ch") * Th) + across, "on": sp.true}
