"""Tanks, cylinders, heat and reactions; relations by balances of volume, energy and moles."""

from __future__ import annotations

from tests.elements.forms import HEAT, OIL, REACTION, TANKS, Form, Relation

IN1 = "f12 = Q - l1*ssqrt(p1) - A1*D(p1, 1)"
OUT3 = "f23 = A3*D(p3, 1) + ko*ssqrt(p3) + l3*ssqrt(p3)"
DOWN = "p2 = p3 + f23*Abs(f23)/k23**2"

FORMS = [
    Form(
        "three_tanks",
        "hydraulic",
        TANKS,
        [
            Relation(
                "volume of the middle tank, its pressure from the flow out of the first",
                f"{IN1}; {OUT3}; p2 = p1 - f12*Abs(f12)/k12**2; f12 - f23 - A2*D(p2, 1)",
                "A1 A2 A3 k12 ko l1 l3 Q p1 p3",
            ),
            Relation(
                "drop of pressure through both valves",
                f"{IN1}; {OUT3}; p1 - p3 - f12*Abs(f12)/k12**2 - f23*Abs(f23)/k23**2",
                "A1 A3 k12 k23 ko l1 l3 Q p1 p3",
            ),
        ],
    ),
    Form(
        "three_tanks_implicit",
        "hydraulic",
        TANKS,
        [
            Relation(
                "volume of the middle tank, its pressure from the flow into the third",
                f"{IN1}; {OUT3}; p2 = p3 + k23*f23*Abs(f23); f12 - f23 - A2*D(p2, 1)",
                "A1 A2 A3 k23 ko l1 l3 Q p1 p3",
            ),
            Relation(
                "law of the first valve",
                f"{IN1}; {OUT3}; p2 = p3 + k23*f23*Abs(f23); f12 - k12*ssqrt(p1 - p2)",
                "A1 A3 k12 k23 ko l1 l3 Q p1 p3",
            ),
        ],
    ),
    Form(
        "three_tanks_all",
        "hydraulic",
        TANKS,
        [
            Relation(
                "volume of the first tank",
                "Q - l1*ssqrt(p1) - A1*D(p1, 1) - k12*ssqrt(p1 - p2)",
                "A1 k12 l1 Q p1 p2",
            ),
            Relation(
                "volume of the second and third tanks together",
                "k12*ssqrt(p1 - p2) - A2*D(p2, 1) - A3*D(p3, 1) - (ko + l3)*ssqrt(p3)",
                "A2 A3 k12 ko l3 p1 p2 p3",
            ),
            Relation(
                "law of the second valve",
                "f23 = k12*ssqrt(p1 - p2) - A2*D(p2, 1); p2 - p3 - k23*f23*Abs(f23)",
                "A2 k12 k23 p1 p2 p3",
            ),
        ],
    ),
    Form(
        "three_tanks_level3",
        "hydraulic",
        TANKS,
        [
            Relation(
                "from the last tank upwards to the balance of the first",
                f"f23 = A3*D(p3, 1) + ko*ssqrt(p3) + l3*p3; {DOWN}; f12 = f23 + A2*D(p2, 1); "
                "p1 = p2 + f12*Abs(f12)/k12**2; Q - l1*ssqrt(p1) - A1*D(p1, 1) - f12",
                "A1 A2 A3 k12 k23 ko l1 l3 Q p3",
            )
        ],
    ),
    Form(
        "three_tanks_Qunknown",
        "hydraulic",
        TANKS,
        [
            Relation(
                "volume of the middle tank; the first tank is behind the unknown inflow",
                f"{OUT3}; {DOWN}; k12*ssqrt(p1 - p2) - f23 - A2*D(p2, 1)",
                "A2 A3 k12 k23 ko l3 p1 p3",
            )
        ],
        undetectable="A1 l1",
    ),
    Form(
        "two_tanks",
        "hydraulic",
        TANKS,
        [
            Relation(
                "volume of the first tank",
                "Q - leak*ssqrt(p1) - k12*ssqrt(p1 - p2) - A1/(rho*g)*D(p1, 1)",
                "A1 k12 leak Q p1 p2",
            ),
            Relation(
                "volume of the second tank",
                "k12*ssqrt(p1 - p2) - kout*ssqrt(p2) - A2/(rho*g)*D(p2, 1)",
                "A2 k12 kout p1 p2",
            ),
        ],
    ),
    Form(
        "cylinder",
        "hydraulic, translation",
        OIL,
        [
            Relation(
                "oil of the fed chamber",
                "kv*x*ssqrt(ps - p1) - A1*v - kl*(p1 - p2) - V1*D(p1, 1)",
                "A1 V1 kl kv x ps p1 p2 v",
            ),
            Relation(
                "oil of the chamber that returns",
                "A2*v + kl*(p1 - p2) - kr*ssqrt(p2) - V2*D(p2, 1)",
                "A2 V2 kl kr p1 p2 v",
            ),
        ],
        undetectable="m b",
    ),
    Form(
        "hydraulic_actuator",
        "hydraulic, translation",
        OIL,
        [
            Relation(
                "oil of the chamber",
                "kv*spool*ssqrt(ps - p) - leak*p - A*v - V/B*D(p, 1)",
                "kv leak V B A ps spool p v",
            ),
            Relation("forces on the rod", "A*p - m*D(v, 1) - b*v - load", "A m b load p v"),
        ],
    ),
    Form(
        "heat_exchanger",
        "thermal",
        HEAT,
        [
            Relation(
                "heat of the hot side",
                "mh*cp*(Thi - Th) - UA*(Th - Tc) - Ch*D(Th, 1)",
                "UA Ch cp mh Thi Th Tc",
            ),
            Relation(
                "heat of the cold side",
                "mc*cp*(Tci - Tc) + UA*(Th - Tc) - Cc*D(Tc, 1)",
                "UA Cc cp mc Tci Th Tc",
            ),
        ],
    ),
    Form(
        "oven",
        "thermal",
        HEAT,
        [
            Relation(
                "heat of the heater",
                "Piecewise((P, on), (0, True)) - Gh*(Th - To) - Ch*D(Th, 1)",
                "Ch Gh P Th To",
            ),
            Relation(
                "heat of the oven",
                "Gh*(Th - To) - Go*(To - Ta) - Co*D(To, 1)",
                "Co Gh Go Ta Th To",
            ),
        ],
        modes="on",
    ),
    Form(
        "thermofluid",
        "thermofluid",
        "balances of mass and of energy of a stirred tank: Samantaray & Ould Bouamama, Model-based "
        "Process Supervision",
        [
            Relation("volume of the tank", "Q - kv*ssqrt(h) - A*D(h, 1)", "A kv Q h"),
            Relation(
                "energy of the tank: stored in its volume, lost with the outflow and to the room",
                "c*Q*Ti + P - c*kv*ssqrt(h)*T - ka*(T - Ta) - D(c*A*h*T, 1)",
                "A kv c ka Q Ti P h T",
            ),
        ],
    ),
    Form(
        "chemical",
        "chemical",
        REACTION,
        [
            Relation(
                "moles of B: its amount from the rate, the rate from the moles of A",
                "v = feed - D(ca, 1); b = (k1*ca - v/r)/k2; v - D(b, 1)",
                "k1 k2 r feed ca",
            )
        ],
        positive="ca",
    ),
    Form(
        "michaelis",
        "chemical",
        REACTION,
        [Relation("moles of the substrate", "feed - vm*y/(km + y) - D(y, 1)", "km vm feed y")],
        positive="y",
    ),
]
