"""Electrical networks: linear loops, bridges, ladders, fields; relations by Kirchhoff's laws."""

from __future__ import annotations

from tests.elements.forms import CIRCUITS, COILS, FIELDS, REDUNDANT, Form, Relation


def ladder(cells: int) -> str:
    """From the end of a line of T-cells to its beginning, one voltage and current at a time."""
    arm = f"line__R/{2 * cells}*{{0}} + line__L/{2 * cells}*D({{0}}, 1)"
    steps = ["i0 = line__C*D(Us, 1)", "v0 = Us"]
    for k in range(cells):
        steps.append(f"m{k} = v{k} + {arm.format(f'i{k}')}")
        steps.append(f"i{k + 1} = i{k} + line__C/{cells}*D(m{k}, 1)")
        steps.append(f"v{k + 1} = m{k} + {arm.format(f'i{k + 1}')}")
    return "; ".join([*steps, f"Uin - v{cells}"])


FORMS = [
    Form(
        "redundant_df",
        "electrical",
        CIRCUITS,
        [
            Relation("voltage law of the coil and the resistor", "U - R*y - L*D(y, 1)", "U R L y"),
            Relation("one current, two instruments", "y - y1", "y y1"),
        ],
    ),
    Form(
        "symbolic",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law of the series circuit, once differentiated: the charge is not known",
                "D(U, 1) - R*D(y, 1) - L*D(y, 2) - y/C",
                "U R L C y",
            )
        ],
    ),
    Form(
        "power_units",
        "electrical",
        CIRCUITS,
        [Relation("current into the capacitor", "y - C*D(U - R*y, 1)", "R C U y")],
    ),
    Form(
        "alias",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "current law of two branches, each with a source, behind a coil",
                "n = U - L*D(y, 1); y - (n + 2*h)/(Q + s1__Z) - (n + h*y)/(Q/2 + 3)",
                "Q L s1.Z h U y",
            )
        ],
    ),
    Form(
        "alias_sensor",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law with a proportional controller of the current",
                "U + c__kp*(goal - c__y) + c__d - c__y - L*D(c__y, 1)",
                "L c.kp c.d goal U c.y",
            ),
            Relation(
                "the controller's error, of the reading that it gets", "e - (goal - c__y)", "goal e"
            ),
        ],
    ),
    Form(
        "arrays",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "currents and voltages of an RC ladder from its end to its source",
                "i3 = y/Rl + (c__3__C + 3/10)*D(y, 1); n2 = y + Rs__3*i3; "
                "i2 = i3 + c__2__C*D(n2, 1); n1 = n2 + Rs__2*i2; i1 = i2 + c__1__C*D(n1, 1); "
                "U - n1 - Rs__1*i1",
                "Rs[1] Rs[2] Rs[3] c[1].C c[2].C c[3].C Rl U y",
            )
        ],
    ),
    Form(
        "c_se_dependent",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "current law at the source: what the capacitors across it leave flows through R",
                "j = i - (C1 + 2/5)*D(U, 1); j - C2*D(U - R*j, 1)",
                "C1 C2 R U i",
            )
        ],
    ),
    Form(
        "algebraic_self",
        "electrical",
        CIRCUITS,
        [Relation("voltage law with a fed-back source", "U + k*y + g - 2*y", "k g U y")],
    ),
    Form(
        "wheatstone",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "current law at the right node, its voltage from the current law at the left one",
                "r = yl - R5*((U - yl)/R1 - yl/R2); (U - r)/R3 - r/R4 + (yl - r)/R5",
                "R1 R2 R3 R4 R5 U yl",
            )
        ],
    ),
    Form(
        "wheatstone2",
        "electrical",
        CIRCUITS,
        [
            Relation("current law, left node", "(U - yl)/R1 - yl/R2 - y5", "R1 R2 U yl y5"),
            Relation("current law, right node", "(U - yr)/R3 - yr/R4 + y5", "R3 R4 U yr y5"),
            Relation("law of the resistor between", "yl - yr - R5*y5", "R5 yl yr y5"),
        ],
    ),
    Form(
        "wheatstone_balanced",
        "electrical",
        CIRCUITS,
        [Relation("no current between nodes of equal voltage", "y5*(1 + 2*R5/R)", "y5")],
        undetectable="R R5 U",
    ),
    Form(
        "grid2",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "current law at the first node, the cross current from that at the second",
                "m = U - A1*i1; x = un/B2 - (U - un)/A2; i1 - m/B1 - x",
                "A1 B1 A2 B2 U i1 un",
            ),
            Relation(
                "law of the cross resistor",
                "m = U - A1*i1; x = un/B2 - (U - un)/A2; m - un - X1*x",
                "A1 X1 A2 B2 U i1 un",
            ),
        ],
    ),
    Form(
        "grid3",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltages along the crosswise resistors; each of their currents from a current law",
                "m1 = U - A1*i1; x1 = i1 - m1/B1; x2 = un/B3 - (U - un)/A3; "
                "m1 - X1*x1 - X2*x2 - un",
                "A1 B1 X1 X2 A3 B3 U i1 un",
            ),
            Relation(
                "current law at the middle node",
                "m1 = U - A1*i1; x1 = i1 - m1/B1; x2 = un/B3 - (U - un)/A3; m2 = un + X2*x2; "
                "x1 + (U - m2)/A2 - m2/B2 - x2",
                "A1 B1 A2 B2 X2 A3 B3 U i1 un",
            ),
        ],
    ),
    Form(
        "rc_loop",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law from the source to node a, both currents by the current laws",
                "ia = Ca*D(ua, 1) + (ua - uc)/Rca; ic = Cc*D(uc, 1) - (ua - uc)/Rca; "
                "U - R0*(ia + ic) - Rab*ia - ua",
                "R0 Rab Rca Ca Cc U ua uc",
            ),
            Relation(
                "the inner node has one voltage, seen from a and from c",
                "ia = Ca*D(ua, 1) + (ua - uc)/Rca; ic = Cc*D(uc, 1) - (ua - uc)/Rca; "
                "ua + Rab*ia - uc - Rbc*ic",
                "Rab Rbc Rca Ca Cc ua uc",
            ),
        ],
    ),
    Form(
        "rlc_loop",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "z is the voltage across R2 and L2: voltage law of the input, "
                "C2*(R1*z' + L1*z'') = a; current law behind, "
                "C2*z'' + z'/R2 + z/L2 = C2*y''; z eliminated",
                "a = (C1 + C2)*(R1*D(y, 1) + L1*D(y, 2)) + y - U; "
                "C2*D(a, 2) + D(a, 1)/R2 + a/L2 - C2**2*(R1*D(y, 3) + L1*D(y, 4))",
                "R1 R2 L1 L2 C1 C2 U y",
            )
        ],
    ),
    Form(
        "rl_parallel",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "current law of three coils under one voltage u, multiplied by both (L*p + R)",
                "u = U - R0*y; z = D(y, 1) - u/L3; "
                "L1*L2*D(z, 2) + (L1*R2 + L2*R1)*D(z, 1) + R1*R2*z "
                "- (L1 + L2)*D(u, 2) - (R1 + R2)*D(u, 1)",
                "L1 L2 L3 R0 R1 R2 U y",
            )
        ],
    ),
    Form(
        "rl_parallel_current",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "one voltage across two branches whose currents add up to the source's",
                "ia = Q - yb; R1*ia + L1*D(ia, 1) - R2*yb - L2*D(yb, 1)",
                "L1 L2 R1 R2 Q yb",
            )
        ],
    ),
    Form(
        "mutual",
        "electrical",
        COILS,
        [
            Relation(
                "voltage law of the first coil",
                "U - R1*y1 - L1*D(y1, 1) - M*D(y2, 1)",
                "L1 M R1 U y1 y2",
            ),
            Relation(
                "voltage law of the second coil",
                "R2*y2 + M*D(y1, 1) + L2*D(y2, 1)",
                "L2 M R2 y1 y2",
            ),
        ],
    ),
    Form(
        "mutual1",
        "electrical",
        COILS,
        [
            Relation(
                "voltage law of the second coil, differentiated; M times the slope of its current "
                "is what the first coil leaves",
                "w = U - R1*y1 - L1*D(y1, 1); R2*w + L2*D(w, 1) + M**2*D(y1, 2)",
                "L1 L2 M R1 R2 U y1",
            )
        ],
    ),
    Form(
        "r_field",
        "electrical",
        FIELDS,
        [
            Relation(
                "voltage law of the coil; its current from the current law at the capacitor",
                "i = (C*D(u, 1) + c*u)/b; U - L*D(i, 1) - a*i - b*u",
                "a b c L C U u",
            )
        ],
    ),
    Form(
        "gyrator_cycle3",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "three meshes coupled by gyrators: c from those of R and L, put into that of C",
                "c = (R*L*D(y, 1) + g1**2*y - g1*U)/(g1*g3 - g2*R); "
                "a = (U - g1*y + g3*c)/R; c - C*D(g2*y - g3*a, 1)",
                "g1 g2 g3 R C L U y",
            )
        ],
    ),
    Form(
        "gyrator_cycle3_res",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law of the fed mesh; its current from the third mesh",
                "a = (g2*y - R3*z)/g3; U - R1*a - g1*y + g3*z",
                "g1 g2 g3 R1 R3 U y z",
            ),
            Relation(
                "voltage law of the second mesh",
                "a = (g2*y - R3*z)/g3; g1*a - g2*z - R2*y",
                "g1 g2 g3 R2 R3 y z",
            ),
        ],
    ),
    Form(
        "three_df",
        "electrical",
        CIRCUITS,
        [
            Relation("current law of the node", "ya - yb - yc", "ya yb yc"),
            Relation("voltage law, first and second arm", "U - R1*ya - R2*yb", "R1 R2 U ya yb"),
            Relation("one voltage across two arms", "R2*yb - R3*yc", "R2 R3 yb yc"),
        ],
    ),
    Form(
        "de_on_se",
        "electrical",
        REDUNDANT,
        [Relation("the voltage is the source's", "y - U", "U y")],
        undetectable="R",
    ),
    Form(
        "sensors_odd",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law, the current being the slope of the charge",
                "U - u - R*D(Q, 1) - L*D(Q, 2)",
                "R L U u Q",
            ),
            Relation("law of the capacitor", "Q - C*u", "C u Q"),
            Relation("power turned to heat", "D(E, 1) - R*D(Q, 1)**2", "R E Q"),
            Relation("power into the capacitor", "P - u*D(Q, 1)", "u P Q"),
        ],
    ),
    Form(
        "two_unknown",
        "electrical",
        CIRCUITS,
        [Relation("voltage divider behind the last node", "R3*(yb - yc) - R2*yc", "R2 R3 yb yc")],
        undetectable="R1 C1 C2 U ya",
    ),
    Form(
        "unknown_same_place",
        "electrical",
        REDUNDANT,
        [Relation("one voltage, two instruments", "ya - yb", "ya yb")],
        undetectable="R C",
    ),
    Form(
        "cable_open",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltage law of the first half of a T-cell; the second half carries no current",
                "i = line__C*D(Us, 1); Uin - Us - line__R/2*i - line__L/2*D(i, 1)",
                "line.R line.L line.C Uin Us",
            )
        ],
    ),
    Form(
        "cable",
        "electrical",
        CIRCUITS,
        [
            Relation(
                "voltages and currents of four T-cells from the end of the line to its beginning",
                ladder(4),
                "line.R line.L line.C Uin Us",
            )
        ],
    ),
]
