"""The machines of models/ by hand: from chosen motions to all signals that are known.

Nothing here uses the compiler. Each function chooses some motions as polynomials of t and follows
the physics backwards, without solving anything: parameters may be functions of t, so that a fault
is a parameter that changes. `F` gives the value of a parameter or constant by its name.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from tests.models.series import Series, cos, d, sin, since_start, sqrt, ssqrt, t, tanh

Signals = dict[str, Series | bool]
Values = Callable[[str], Series]
q = Fraction


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
    current = d(F("line.C") * Us) if capacitor else 0 * Us
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


def khepera_encoders(F: Values) -> Signals:
    """Wheels and forces are chosen; shafts twist as they must, motors push as they must."""
    out: Signals = {}
    for j, wheel in ((1, t + t**2 / 3), (2, t / 2 - t**3 / 5)):
        own = f"m[{j}]"
        speed = 1 + d(wheel)
        force = q(1, 2) + t / (2 + j)
        twist = t / 3 + j * t**2 / 7  # from zero
        play = F(f"{own}.tau0")
        spring = F(f"{own}.K") * (twist + F(f"{own}.A") * play * tanh(twist / (4 * play)))
        hub = F(f"{own}.fs") * speed + d(F(f"{own}.Js") * speed) + F(f"{own}.R") * force
        # the spring carries what the hub needs: the rest of the load is the contact force
        force = force + (F(f"{own}.ge.N") * spring - hub) / F(f"{own}.R")
        rotor = d(twist) + F(f"{own}.ge.N") * speed
        torque = spring + F(f"{own}.fe") * rotor + d(F(f"{own}.Je") * rotor)
        current = torque / F(f"{own}.el.k")
        out[f"{own}.motor"], out[f"{own}.wheel"] = since_start(rotor), since_start(speed)
        out[f"Fx[{j}]"] = force
        drop = F(f"{own}.el.Re") * current + d(F(f"{own}.el.L") * current)
        out[f"U0[{j}]"] = F(f"{own}.el.k") * rotor + drop
    load = 1 + t / 4
    return out | {"load": load} | _line(F, load, 3 + t**2 - t**5 / 2)


def khepera_built(F: Values) -> Signals:
    """Speeds and contact forces are chosen, the motors push what that takes."""
    out: Signals = {}
    for j, hub in ((1, 1 + t + t**2), (2, 2 - t**3 / 5)):
        own = f"m[{j}]"
        force = q(1, 2) + t / (2 + j)
        rotor = F(f"{own}.ge.N") * hub
        load = F(f"{own}.fs") * hub + d(F(f"{own}.Js") * hub) + F(f"{own}.R") * force
        torque = load / F(f"{own}.ge.N") + F(f"{own}.fe") * rotor + d(F(f"{own}.Je") * rotor)
        current = torque / F(f"{own}.el.k")
        drop = F(f"{own}.el.Re") * current + d(F(f"{own}.el.L") * current)
        out[f"U0[{j}]"] = F(f"{own}.el.k") * rotor + drop
        out[f"{own}.motor"], out[f"Fx[{j}]"] = since_start(rotor), force
    return out | _line(F, 0 * t, 3 + t**2 - t**5 / 2)


def _line(F: Values, load: Series, Us: Series) -> Signals:
    """The cable of the robots with numbers of their own, from its end to its beginning."""
    R, L, C = F("R_L"), q(5, 10**7), q(22, 10**11)
    current = load + d(C * Us)
    voltage = Us + R / 2 * current + d(L / 2 * current)
    current = current + d(C * voltage)
    return {"Us": Us, "Uin": voltage + R / 2 * current + d(L / 2 * current)}


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
    lever = r * sin(th) * (1 + r * cos(th) / sqrt(length**2 - r**2 * sin(th) ** 2))
    v = lever * speed
    load = 1 + t
    force = d(F("m") * v) + F("c") * v + load
    T = d(F("J") * speed) + F("f") * speed + lever * force
    return {"speed": speed, "load": load, "T": T}


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
    """Solved forwards: every round of integration makes one more coefficient right."""
    U = 1 + t - t**2
    a, c = 2 + 0 * t, -1 + 0 * t
    Rab, Rbc, Rca = F("Rab"), F("Rbc"), F("Rca")
    for _ in t.c:
        b = (U / F("R0") + a / Rab + c / Rbc) / (1 / F("R0") + 1 / Rab + 1 / Rbc)
        into_a = (b - a) / Rab - (a - c) / Rca
        into_c = (b - c) / Rbc + (a - c) / Rca
        a = since_start(into_a, 2 * F("Ca")) / F("Ca")
        c = since_start(into_c, -F("Cc")) / F("Cc")
    return {"U": U, "ua": a, "uc": c}


def oven(F: Values) -> Signals:
    Th, To = 5 + t**2, 3 + t
    across = F("Gh") * (Th - To)
    Ta = To - (across - d(F("Co") * To)) / F("Go")
    return {"Th": Th, "To": To, "Ta": Ta, "P": d(F("Ch") * Th) + across, "on": True}
