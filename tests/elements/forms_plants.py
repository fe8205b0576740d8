"""Converters, drives, vehicles and plants as textbooks have them; relations by their balances."""

from __future__ import annotations

from tests.elements.forms import (
    CIRCUITS,
    CONVERTER,
    DIODE,
    MACHINE,
    NEWTON,
    OIL,
    SWITCHED,
    VEHICLE,
    VIRTUAL,
    Form,
    Relation,
)

PARK = "voltage laws in the frame of the rotor: Fitzgerald, Kingsley & Umans, Electric Machinery"
WIND = "torque balances of both ends of an elastic shaft: Karnopp, Margolis & Rosenberg, " + (
    "System Dynamics"
)
TANK = (
    "balances of mass and of energy of a stirred tank: Samantaray & Ould Bouamama, Model-based "
    "Process Supervision"
)
# rates h, k of the rotor's currents by the stator; the currents solve Rr*x + w*Lr*y = A and
# Rr*y - w*Lr*x = B, whose determinant Q is never zero
ROTOR = (
    "h = (ua - Rs*ia - Ls*D(ia, 1))/M; k = (ub - Rs*ib - Ls*D(ib, 1))/M; "
    "A = -M*D(ia, 1) - Lr*h - w*M*ib; B = -M*D(ib, 1) - Lr*k + w*M*ia; "
    "Q = Rr**2 + (w*Lr)**2; x = (Rr*A - w*Lr*B)/Q; y = (Rr*B + w*Lr*A)/Q"
)

FORMS = [
    Form(
        "cuk",
        "electrical",
        CONVERTER,
        [
            Relation(
                "current of the capacitor between, its voltage times 1 - d from the first coil",
                "m = 1 - d; w = U - L1*D(i1, 1); k = C2*D(u, 1) + u/R; "
                "m**3*i1 - C1*(m*D(w, 1) - w*D(m, 1)) - m**2*d*k",
                "L1 C1 C2 R d U i1 u",
            ),
            Relation(
                "voltage law of the second coil",
                "w = U - L1*D(i1, 1); k = C2*D(u, 1) + u/R; d*w - (1 - d)*(L2*D(k, 1) + u)",
                "L1 L2 C2 R d U i1 u",
            ),
        ],
    ),
    Form(
        "h_bridge",
        "electrical, rotation",
        SWITCHED,
        [
            Relation(
                "voltage law, the supply as the bridge turns it",
                "Piecewise((E, fwd), (-E, True)) - L*D(i, 1) - R*i - k*w",
                "L R k E i w",
            ),
            Relation("torque balance", "k*i - J*D(w, 1) - f*w", "k J f i w"),
        ],
        modes="fwd",
    ),
    Form(
        "accumulator",
        "hydraulic",
        OIL,
        [
            Relation("oil of the line", "Q - Cl*D(pl, 1) - kc*Max(pl - pg, 0)", "kc Cl Q pl pg"),
            Relation(
                "oil of the accumulator, whose gas keeps its temperature and yields its volume",
                "gas = p0*V0/pg; kc*Max(pl - pg, 0) - ko*ssqrt(pg) + D(gas, 1)",
                "p0 V0 kc ko pl pg",
            ),
        ],
    ),
    Form(
        "crane",
        "translation, rotation",
        VIRTUAL,
        [
            Relation(
                "forces on the load along the rail, H what the trolley leaves for it",
                "H = F - b*v - M*D(v, 1); H - m*D(v + l*cos(angle)*D(angle, 1), 1)",
                "M m l b F v angle",
            ),
            Relation(
                "virtual power of the swing",
                "H = F - b*v - M*D(v, 1); z = l*sin(angle)*D(angle, 1); "
                "l*cos(angle)*H + l*sin(angle)*m*(g + D(z, 1)) + c*D(angle, 1)",
                "M m l b c F v angle",
            ),
        ],
    ),
    Form(
        "planetary",
        "rotation",
        NEWTON,
        [
            Relation(
                "torques on the ring, its speed from Willis' relation, tooth force from the sun",
                "t = (Ts - Js*D(ws, 1))/rs; w = ((rs + rr)*wc - rs*ws)/rr; Jr*D(w, 1) + f*w + rr*t",
                "rs rr Js Jr f Ts ws wc",
            ),
            Relation(
                "torques on the carrier",
                "t = (Ts - Js*D(ws, 1))/rs; (rs + rr)*t - Jc*D(wc, 1) - Tc",
                "rs rr Js Jc Ts Tc ws wc",
            ),
        ],
    ),
    Form(
        "battery",
        "electrical, chemical",
        CIRCUITS,
        [
            Relation(
                "current of the lag, its voltage from that of the charge, which is counted",
                "x = Int(-load, 4/5); h = u + R0*load - a*x - b*log(x); load + h/R1 + C1*D(h, 1)",
                "a b R0 R1 C1 load u",
            )
        ],
        starts=(1.4, 0.3, 0.9),
    ),
    Form(
        "solar_cell",
        "electrical",
        DIODE,
        [Relation("current at the plug", "i - G*v - C*D(v, 1)", "C G i v")],
        undetectable="Is vt Rs Rp",
    ),
    Form(
        "bicycle",
        "translation, rotation",
        VEHICLE,
        [
            Relation(
                "the accelerometer; side speed from the front tyre, its force from forces and "
                "torques on the car",
                "F = (b*m*ay + Jz*D(r, 1))/(a + b); v = u*(delta - F/Cf) - a*r; ay - u*r - D(v, 1)",
                "m Jz a b Cf delta u r ay",
            ),
            Relation(
                # of the side speed by the torques alone nothing is left where a*Cf is b*Cr
                "law of the rear tyre",
                "F = (b*m*ay + Jz*D(r, 1))/(a + b); v = u*(delta - F/Cf) - a*r; "
                "m*ay - F + Cr*(v - b*r)/u",
                "m Jz a b Cf Cr delta u r ay",
            ),
        ],
    ),
    Form(
        "bicycle_neutral",
        "translation, rotation",
        VEHICLE,
        [
            Relation(
                "the accelerometer; side speed from the front tyre, its force from forces and "
                "torques on the car",
                "F = (b*m*ay + Jz*D(r, 1))/(a + b); v = u*(delta - F/Cf) - a*r; ay - u*r - D(v, 1)",
                "m Jz a b Cf delta u r ay",
            ),
            Relation(
                "law of the rear tyre",
                "F = (b*m*ay + Jz*D(r, 1))/(a + b); v = u*(delta - F/Cf) - a*r; "
                "m*ay - F + Cr*(v - b*r)/u",
                # the lateral force cancels: a/(a + b) = b*Cr/((a + b)*Cf) where a*Cf = b*Cr
                "Jz a b Cf Cr delta u r",
            ),
        ],
        values={"m": 1.2, "Jz": 0.9, "a": 0.8, "b": 0.8, "Cf": 2.3, "Cr": 2.3},
    ),
    Form(
        "induction",
        "electrical, rotation",
        "voltage laws in the frame of the stator: Fitzgerald, Kingsley & Umans, Electric Machinery",
        [
            Relation(
                "rate of the rotor's first voltage law Rr*x + w*Lr*y = A, rates by the stator's",
                f"{ROTOR}; Q*(Rr*h + D(w, 1)*Lr*y + w*Lr*k - D(A, 1))",
                "Rs Rr Ls Lr M ua ub ia ib w",
            ),
            Relation(
                "rate of its second current: by its voltage law and by the stator's",
                f"{ROTOR}; Q**2*(D(y, 1) - k)",
                "Rs Rr Ls Lr M ua ub ia ib w",
            ),
            Relation(
                "torque of fluxes and currents of the rotor",
                f"{ROTOR}; Q*((M*ib + Lr*y)*x - (M*ia + Lr*x)*y - J*D(w, 1) - f*w - load)",
                "Rs Rr Ls Lr M J f load ua ub ia ib w",
            ),
        ],
    ),
    Form(
        "wind_turbine",
        "rotation",
        WIND,
        [
            Relation(
                "rate of the shaft's torque, from the generator and from the twist",
                "t = N*(Jg*D(wg, 1) + Tg); s = w - wg/N; D(t, 1) - K*s - d*D(s, 1)",
                "K d Jg N Tg w wg",
            )
        ],
        undetectable="J Rw c1 c2",
    ),
    Form(
        "motor_reversed",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "voltage law; the source's arrow leaves the coil",
                "-U - R*yi - L*D(yi, 1) + k*yw",
                "L R k U yi yw",
            ),
            Relation(
                "torque balance; power goes from the shaft to the coil",
                "T - k*yi - f*yw - J*D(yw, 1)",
                "k J f T yi yw",
            ),
        ],
    ),
    Form(
        "pmsm",
        "electrical, rotation",
        PARK,
        [
            Relation("along the magnets", "ud - R*id - L*D(id, 1) + L*w*iq", "R L ud id iq w"),
            Relation(
                "across the magnets",
                "uq - R*iq - L*D(iq, 1) - (L*id + psi)*w",
                "R L psi uq id iq w",
            ),
            Relation("torque balance", "psi*iq - J*D(w, 1) - f*w - load", "psi J f load iq w"),
        ],
    ),
    Form(
        "pmsm_park",
        "electrical, rotation",
        PARK,
        [
            Relation(
                "along the magnets",
                "ua*cos(p*angle) + ub*sin(p*angle) - R*(ia*cos(p*angle) + ib*sin(p*angle)) "
                "- Ld*D(ia*cos(p*angle) + ib*sin(p*angle), 1) "
                "+ p*Lq*D(angle, 1)*(ib*cos(p*angle) - ia*sin(p*angle))",
                "R Ld Lq p ua ub ia ib angle",
            ),
            Relation(
                "across the magnets",
                "ub*cos(p*angle) - ua*sin(p*angle) - R*(ib*cos(p*angle) - ia*sin(p*angle)) "
                "- Lq*D(ib*cos(p*angle) - ia*sin(p*angle), 1) "
                "- p*D(angle, 1)*(Ld*(ia*cos(p*angle) + ib*sin(p*angle)) + psi)",
                "R Ld Lq psi p ua ub ia ib angle",
            ),
            Relation(
                "torque balance",
                "p*(psi + (Ld - Lq)*(ia*cos(p*angle) + ib*sin(p*angle)))"
                "*(ib*cos(p*angle) - ia*sin(p*angle)) - J*D(angle, 2) - b*D(angle, 1) - load",
                "Ld Lq psi p J b load ia ib angle",
            ),
        ],
    ),
    Form(
        "boiler",
        "thermofluid",
        TANK,
        [
            Relation("volume of the tank", "Q - kv*ssqrt(h) - A*D(h, 1)", "A kv Q h"),
            Relation(
                "energy of the water",
                "c*Q*Tin + G*(Tw - T) - c*kv*ssqrt(h)*T - D(c*A*h*T, 1)",
                "A kv c G Q Tin h T Tw",
            ),
        ],
        undetectable="Cw",
    ),
]
