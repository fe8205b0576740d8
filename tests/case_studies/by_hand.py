"""Relations of published case studies, derived by hand, and how they differ from the compiled ones.

The systems are described in `docs/case_studies.md`. Nothing here was copied from the compiler: the
relations by hand are balances, one for each sensor, and each compiled relation is a combination of
them, or the balance in which a quantity is replaced by what another balance says of it.
"""

from __future__ import annotations

from typing import NamedTuple


class Case(NamedTuple):
    """One case study.

    `hand` are the relations as they are usually given, `ours` what the compiled relations are, each
    an expression that vanishes, with steps `x = ...;` before it; `ours` may name those of `hand`.
    `D(x, k)` is the k-th derivative, `Int(x)` the integral from the start, `reading(x)` what a
    controller is told by the sensor x. `beside` is which of ours stands beside which of theirs.
    `weak` are the faults that show in transients only, `groups` the numbers of groups: by hand, of
    the default residuals, with further ones, at best. `signals` are in the order in which they get
    motions to compare at.
    """

    model: str
    signals: str
    hand: dict[str, str]
    ours: dict[str, str]
    beside: dict[str, str]
    weak: str
    groups: tuple[int, int, int, int]
    slow: str = ""  # relations that SymPy takes long to compare


THREE_TANKS = Case(
    "three_tanks",
    "p1 p3 p2 Q1 Q2",
    {
        "tank1": "Q1 - leak1*ssqrt(p1) - k13*ssqrt(p1 - p3) - A1*D(p1)/(rho*g)",
        "tank3": "k13*ssqrt(p1 - p3) - leak3*ssqrt(p3) - k32*ssqrt(p3 - p2) - A3*D(p3)/(rho*g)",
        "tank2": "Q2 + k32*ssqrt(p3 - p2) - (leak2 + k20)*ssqrt(p2) - A2*D(p2)/(rho*g)",
    },
    {
        "r1": "tank1",
        "r2": "tank3",
        "r3": "tank2",
        "r4": "tank1 + tank3",
        "r5": "tank3 + tank2",
    },
    {"tank1": "r1", "tank3": "r2", "tank2": "r3"},
    "A1 A2 A3",
    (6, 6, 8, 8),
)

CONTROLLED_TANKS = Case(
    "controlled_tanks",
    "y1 y2 qp up ub set",
    {
        "tank1": "qp - leak1*ssqrt(y1) - kb*ub*ssqrt(y1 - y2) - A1*D(y1)/(rho*g)",
        "tank2": "kb*ub*ssqrt(y1 - y2) - (leak2 + ko)*ssqrt(y2) - A2*D(y2)/(rho*g)",
        "control": "up - Kp*(set - reading(y1)) - Ki*Int(set - reading(y1))",
        "supply": "qp - kq*reading(up) - pump",
    },
    {
        "r1": "supply",
        "r2": "tank1",
        "r3": "tank2",
        "r4": "control",
        "r5": "tank1 + tank2",
        "r6": "q = qp - leak1*ssqrt(y1) - A1*D(y1)/(rho*g); y = y1 - (q/(kb*ub))*abs(q/(kb*ub)); "
        "q - (leak2 + ko)*ssqrt(y) - A2*D(y)/(rho*g)",
    },
    {"tank1": "r2", "tank2": "r3", "control": "r4", "supply": "r1"},
    "A1 A2 Kp",
    (8, 6, 8, 8),
)

CONTROL_VALVE = Case(
    "control_valve",
    "p1 p2 x F cv",
    {
        "chamber": "pc = (Av*(p1 - p2) + ks*x + d*D(x) + m*D(x, 2))/Ae; "
        "Kpos*(cv - reading(x)) + positioner - Ae*D(x) - gl*pc - cc*D(pc)",
        "valve": "F - (kby + kv*x)*ssqrt(p1 - p2)",
    },
    {
        "r1": "chamber",
        "r2": "valve",
        "r3": "s = ssqrt(p1 - p2); y = (F - kby*s)/(kv*s); "
        "pc = (Av*(p1 - p2) + ks*y + d*D(y) + m*D(y, 2))/Ae; "
        "s**4*(Kpos*(cv - reading(x)) + positioner - Ae*D(y) - gl*pc - cc*D(pc))",
    },
    {"chamber": "r1", "valve": "r2"},
    "Kpos cc Ae m d ks Av",
    (3, 3, 4, 4),
    slow="r3",
)

DRIVE_TRAIN = Case(
    "drive_train",
    "wr1 wg1 wr2 wg2 taur taug pg",
    {
        "rotor": "w = wr1 - wg1/N; taur - Br*wr1 - Jr*D(wr1) - K*Int(w) - B*w",
        "generator": "w = wr1 - wg1/N; "
        "eta*(K*Int(w) + B*w)/N - Bg*wg1 - Jg*D(wg1) - taug",
        "rotor2": "wr1 - wr2",
        "generator2": "wg1 - wg2",
        "power": "pg - etag*taug*wg1",
    },
    {
        "r1": "eta*(taur - Br*wr1 - Jr*D(wr1))/N - Bg*wg1 - Jg*D(wg1) - taug",
        "r2": "w = wr1 - wg1/N; D(taur - Br*wr1 - Jr*D(wr1) - B*w) - K*w",
        "r3": "rotor2",
        "r4": "generator2",
        "r5": "power",
        "r6": "w = wr1 - wg1/N; D(N*(taug + Bg*wg1 + Jg*D(wg1))/eta - B*w) - K*w",
    },
    {"generator": "r1", "rotor": "r2", "rotor2": "r3", "generator2": "r4", "power": "r5"},
    "Jr Jg K B",
    (9, 9, 10, 10),
)

STEAM_GENERATOR = Case(
    "steam_generator",
    "p T L Fw Fs P u z Tf Ta",
    {
        "boiling": "T - T0*(p/p0)**(1/4)",
        "mass": "Fw - Fs - leak*ssqrt(p - pa) - D(rho*A*L + av*p*(V - A*L))",
        "heat": "H = rho*A*L*cw*T + av*p*(V - A*L)*hv; "
        "P + cw*Tf*Fw - hv*Fs - cw*T*leak*ssqrt(p - pa) - kl*(T - Ta) - D(H)",
        "valve": "Fs - kv*z*ssqrt(p - pa)",
        "pump": "Fw - kp*u",
    },
    {
        "r1": "boiling",
        "r2": "mass",
        "r3": "heat",
        "r4": "pump",
        "r5": "valve",
        "r6": "(rho - av*p)**2*(heat - cw*T*mass)",
    },
    {"boiling": "r1", "mass": "r2", "heat": "r3", "valve": "r5", "pump": "r4"},
    "",
    (8, 8, 9, 9),
)

BACKLASH = Case(
    "backlash",
    "thetae thetas i Fx u",
    {
        "circuit": "u - R*i - L*D(i) - ke*D(thetae)",
        "motor": "a = thetae/N - thetas; "
        "ke*i - Je*D(thetae, 2) - fe*D(thetae) - (K*a - 4*K*j0*tanh(gamma*a/2))/N",
        "wheel": "a = thetae/N - thetas; "
        "K*a - 4*K*j0*tanh(gamma*a/2) - Js*D(thetas, 2) - fs*D(thetas) - rw*Fx",
    },
    {
        "r1": "circuit",
        "r2": "ke*i - Je*D(thetae, 2) - fe*D(thetae) "
        "- (Js*D(thetas, 2) + fs*D(thetas) + rw*Fx)/N",
        "r3": "a = Int(D(thetae)/N - D(thetas)); "
        "K*a - 4*K*j0*tanh(gamma*a/2) - Js*D(thetas, 2) - fs*D(thetas) - rw*Fx",
        "r4": "c = (Je*D(thetae, 2) + fe*D(thetae) "
        "+ (Js*D(thetas, 2) + fs*D(thetas) + rw*Fx)/N)/ke; u - R*c - L*D(c) - ke*D(thetae)",
        "r5": "c = Js*D(thetas, 2) + fs*D(thetas) + rw*Fx; "
        "a = Int(D(thetae)*(ke*i - Je*D(thetae, 2) - fe*D(thetae))/c - D(thetas)); "
        "K*a - 4*K*j0*tanh(gamma*a/2) - c",
        "r6": "a = Int(D(thetae)/N - D(thetas)); "
        "K*a - 4*K*j0*tanh(gamma*a/2) - N*(ke*i - Je*D(thetae, 2) - fe*D(thetae))",
    },
    {"circuit": "r1", "motor": "r2", "wheel": "r3"},
    "L Je Js thetae thetas",
    (6, 6, 9, 9),
)

CASES = (
    THREE_TANKS,
    CONTROLLED_TANKS,
    CONTROL_VALVE,
    DRIVE_TRAIN,
    STEAM_GENERATOR,
    BACKLASH,
)
