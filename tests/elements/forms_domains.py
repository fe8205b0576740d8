"""Magnetic, acoustic, thermal and chemical models, machines with one thing to show; balances."""

from __future__ import annotations

from tests.elements.forms import (
    FRICTION,
    HEAT,
    MACHINE,
    NEWTON,
    REACTION,
    REDUNDANT,
    TANKS,
    VIRTUAL,
    Form,
    Relation,
)

MAGNETIC = (
    "Faraday's and Ampere's laws of a core of reluctances: Fitzgerald, Kingsley & Umans, Electric "
    "Machinery; windings as gyrators: Karnopp, Margolis & Rosenberg, System Dynamics"
)
SOUND = "acoustic mass and compliance: Kinsler, Frey, Coppens & Sanders, Fundamentals of Acoustics"
GAS = (
    "mass and energy of ideal gas in a fixed volume: Karnopp, Margolis & Rosenberg, System Dynamics"
)
REACTOR = (
    "balances of moles and of heat, Arrhenius' rate: Levenspiel, Chemical Reaction Engineering"
)

FORMS = [
    Form(
        "magnetic_core",
        "electrical, magnetic",
        MAGNETIC,
        [
            Relation("voltage law of the winding", "U - R*i - n*search", "n R U i search"),
            Relation(
                "rate of the magnetomotive force: iron that saturates, gap, eddy currents",
                "x = Int(search, 1/2); D(n*i - eddy*search - iron*x - sat*x**3, 1) - gap*search",
                "n iron sat gap eddy i search",
            ),
        ],
    ),
    Form(
        "magnetic_tee",
        "electrical, magnetic",
        MAGNETIC,
        [
            Relation(
                "rates of the fluxes add up: left leg by the voltage law of the fed winding, right "
                "leg by that of the other, middle leg by the force that the left leg leaves",
                "x = (U - R1*i1)/n1; z = R2*i2/n2; h = n1*D(i1, 1) - a*x; c*(x - z) - h",
                "n1 n2 R1 R2 a c U i1 i2",
            ),
            Relation(
                "rates of the magnetomotive forces around the whole core",
                "x = (U - R1*i1)/n1; z = R2*i2/n2; n1*D(i1, 1) - a*x - b*z - n2*D(i2, 1)",
                "n1 n2 R1 R2 a b U i1 i2",
            ),
        ],
    ),
    Form(
        "loudspeaker",
        "electrical, translation, acoustic",
        SOUND,
        [
            Relation(
                "rate of the forces on the cone, its speed from the voltage law of the coil",
                "v = (U - R*i - L*D(i, 1))/Bl; "
                "Bl*D(i, 1) - m*D(v, 2) - b*D(v, 1) - k*v - S*D(p, 1)",
                "R L Bl m b k S U i p",
            ),
            Relation(
                "pressure that drives the air in the vent: what the cone moves less what the box "
                "takes",
                "v = (U - R*i - L*D(i, 1))/Bl; w = S*v - Ca*D(p, 1); p - Ma*D(w, 1) - ra*w",
                "R L Bl S Ca Ma ra U i p",
            ),
        ],
    ),
    Form(
        "helmholtz",
        "acoustic",
        SOUND,
        [
            Relation(
                "pressures on the air in the neck, which fills the belly",
                "w = Ca*D(p, 1); sound - p - ra*w - Ma*D(w, 1)",
                "Ma ra Ca sound p",
            )
        ],
    ),
    Form(
        "heated_rod",
        "thermal",
        HEAT,
        [
            Relation(
                "heat of the middle lump, its temperature from the heat of the first",
                "j = P - C1*D(T1, 1); T2 = T1 - j/G12; j - C2*D(T2, 1) - G23*(T2 - T3)",
                "C1 C2 G12 G23 P T1 T3",
            )
        ],
        undetectable="C3 Ga",
    ),
    Form(
        "three_thermometers",
        "thermal",
        REDUNDANT,
        [
            Relation("heat of the body", "P - G*(T1 - Ta) - C*D(T1, 1)", "C G P Ta T1"),
            Relation("first and second instrument", "T1 - T2", "T1 T2"),
            Relation("first and third instrument", "T1 - T3", "T1 T3"),
        ],
    ),
    Form(
        "stirred_reactor",
        "chemical, thermal",
        REACTOR,
        [
            Relation(
                "moles in the reactor",
                "rate = V*k0*exp(-E/T)*conc; q*(cin - conc) - rate - V*D(conc, 1)",
                "V k0 E q cin conc T",
            ),
            Relation(
                "heat in the reactor",
                "rate = V*k0*exp(-E/T)*conc; q*c*(Tin - T) + dH*rate - UA*(T - Tj) - H*D(T, 1)",
                "V k0 E dH H UA c q Tin Tj conc T",
            ),
        ],
        positive="T",
    ),
    Form(
        "reaction_chain",
        "chemical",
        REACTION,
        [
            Relation("moles of A", "feed - k1*ca - D(ca, 1)", "k1 feed ca"),
            Relation(
                "moles of B, whose amount follows from the rate at which C appears",
                "b = D(cc, 1)/k2; k1*ca - D(cc, 1) - D(b, 1)",
                "k1 k2 ca cc",
            ),
        ],
    ),
    Form(
        "gas_tank",
        "thermofluid",
        GAS,
        [
            Relation("mass, p*V = mass*r*T", "w - kv*p - D(p*V/(r*T), 1)", "V r kv w p T"),
            Relation(
                "energy, mass*cv*T; enthalpy comes in and goes out",
                "(cv + r)*(w*Tin - kv*p*T) - D(cv*V*p/r, 1)",
                "V r cv kv w Tin p T",
            ),
        ],
        positive="T",
    ),
    Form(
        "tank_leak",
        "hydraulic",
        TANKS,
        [Relation("volume of the tank", "Q - k*ssqrt(p) - leak*p - A*D(p, 1)", "A k leak Q p")],
    ),
    Form(
        "friction_sign",
        "translation",
        FRICTION,
        [Relation("forces on the mass", "F - Fc*sign(y) - b*y - m*D(y, 1)", "m Fc b F y")],
    ),
    Form(
        "drag_abs",
        "translation",
        NEWTON,
        [
            Relation(
                "forces on the mass on a slope",
                "F - 981/100*m*slope - c*y*Abs(y) - m*D(y, 1)",
                "m c slope F y",
            )
        ],
    ),
    Form(
        "variable_gear",
        "rotation",
        VIRTUAL,
        [
            Relation(
                "virtual power of both shafts at the ratio of the moment",
                "v = n*w; T - J1*D(w, 1) - n*(J2*D(v, 1) + f*v)",
                "J1 J2 f T n w",
            )
        ],
    ),
    Form(
        "two_motors",
        "electrical, rotation",
        MACHINE,
        [Relation("voltage law of the machine with a sensor", "U - R*i - L*D(i, 1)", "L R U i")],
        undetectable="J d T",
    ),
]
