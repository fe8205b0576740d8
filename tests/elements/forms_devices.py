"""Diodes, cubic resistors, tables, converters and switches; relations by Kirchhoff's laws."""

from __future__ import annotations

from tests.elements.forms import CIRCUITS, CONVERTER, DIODE, SWITCHED, Form, Relation

FORMS = [
    Form(
        "diode_series_r",
        "electrical",
        DIODE,
        [Relation("current of the diode", "i - Is*(exp((U - Rs*i)/vt) - 1)", "Is vt Rs U i")],
    ),
    Form(
        "diode",
        "electrical",
        DIODE,
        [
            Relation(
                "current law at the capacitor",
                "Is*(exp((U - u)/vt) - 1) - u/R - C*D(u, 1)",
                "Is vt C R U u",
            )
        ],
    ),
    Form(
        "diode_i",
        "electrical",
        DIODE,
        [
            Relation(
                "current law at the capacitor, its voltage from the diode's law turned round",
                "u = U - vt*log(1 + i/Is); i - u/R - C*D(u, 1)",
                "Is vt C R U i",
            )
        ],
        positive="i",
    ),
    Form(
        "diode_loop",
        "electrical",
        DIODE,
        [
            Relation(
                "current of the diode, with all that lies behind it",
                "u = y + R*C*D(y, 1); i = C*D(u, 1) + u/R + C*D(y, 1); "
                "i - Is*(exp((U - Rs*i - u)/vt) - 1)",
                "Is vt Rs C R U y",
            )
        ],
    ),
    Form(
        "cubic_law",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law with a resistor of third order",
                "i = C*D(y, 1); U - y - a*i - b*i**3",
                "C a b U y",
            )
        ],
    ),
    Form(
        "cubic_parallel",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "two nodes after two resistors of third order, current law at the second",
                "n = U - a*y - b*y**3; j = y - n/R; m = n - a*j - b*j**3; "
                "j - m/R - m/2 - C*D(m, 1)",
                "C a b R U y",
            )
        ],
    ),
    Form(
        "kepler",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law; the law of the resistor, e = f + c*sin(f), is used as it stands",
                "i = D(y, 1); U - y - i - c*sin(i)",
                "c U y",
            )
        ],
    ),
    Form(
        "expon",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law with a resistor that grows exponentially",
                "i = D(y, 1); U - y - i - c*exp(i)",
                "c U y",
            )
        ],
    ),
    Form(
        "implicit_ambiguous",
        "electrical",
        CIRCUITS,
        [Relation("voltage law, e = c*f*f", "U - c*y**2 - D(y, 1)", "c U y")],
    ),
    Form(
        "saturation",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law behind an amplifier that saturates",
                "Max(-um, Min(um, k*u)) - R*y - L*D(y, 1)",
                "L R k u y",
            )
        ],
    ),
    Form(
        "table_law",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law with a resistance of two slopes, 1 below a current of 1 and 2 above",
                "U - R*y - Piecewise((y, y < 1), (2*y - 1, True)) - L*D(y, 1)",
                "L R U y",
            )
        ],
    ),
    Form(
        "buck_duty",
        "electrical",
        CONVERTER,
        [
            Relation("voltage law of the coil", "a*U - RL*i - u - L*D(i, 1)", "L RL U a u i"),
            Relation("current law of the capacitor", "i - u/R - C*D(u, 1)", "C R u i"),
        ],
    ),
    Form(
        "buck_bool",
        "electrical",
        CONVERTER,
        [
            Relation(
                "voltage law of the coil, fed while the switch is on",
                "Piecewise((U, on), (0, True)) - u - L*D(i, 1)",
                "L U u i",
            ),
            Relation("current law of the capacitor", "i - u/R - C*D(u, 1)", "C R u i"),
        ],
        modes="on",
    ),
    Form(
        "boost_duty",
        "electrical",
        CONVERTER,
        [
            Relation(
                "voltage law of the coil, its current times 1 - a from that of the capacitor",
                "m = 1 - a; w = C*D(u, 1) + u/R; m**2*U - m**3*u - L*(m*D(w, 1) - w*D(m, 1))",
                "L C R U a u",
            )
        ],
    ),
    Form(
        "boost_duty_i",
        "electrical",
        CONVERTER,
        [
            Relation(
                "current law of the capacitor, its voltage times 1 - a from that of the coil",
                "m = 1 - a; w = U - L*D(i, 1); m**3*i - m*w/R - C*(m*D(w, 1) - w*D(m, 1))",
                "L C R U a i",
            )
        ],
    ),
    Form(
        "switch_r",
        "electrical",
        SWITCHED,
        [
            Relation(
                "closed: voltage law of the loop; open: the capacitor is alone with R2",
                "i = C*D(u, 1) + u/R2; Piecewise((U - R*i - u, on), (i, True))",
                "C R R2 U u",
            )
        ],
        modes="on",
    ),
    Form(
        "switched_junction",
        "electrical",
        SWITCHED,
        [
            Relation(
                "on: voltage law of the loop; off: the capacitor is alone with R2",
                "i = C*D(u, 1) + u/R2; Piecewise((U - R*i - u, on), (i, True))",
                "C R R2 U u",
            )
        ],
        modes="on",
    ),
    Form(
        "switched_zero",
        "electrical",
        SWITCHED,
        [
            Relation(
                "on: current law of the node; off: no voltage drives the coil",
                "u = L*D(i, 1) + R*i; Piecewise((Q - u/R2 - i, on), (u, True))",
                "L R R2 Q i",
            )
        ],
        modes="on",
    ),
]
