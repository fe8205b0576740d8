"""Masses, springs, gears and rigid bodies; relations by Newton's and Euler's laws."""

from __future__ import annotations

from tests.elements.forms import (
    FRICTION,
    NEWTON,
    RIGID,
    SWITCHED,
    VEHICLE,
    VIRTUAL,
    Form,
    Relation,
)

FORMS = [
    Form(
        "gear_train",
        "rotation",
        NEWTON,
        [
            Relation(
                "torque balances of three shafts, each torque carried to the next by its ratio",
                "tb = n1*(T - J1*D(ya, 1)) - J2*D(n2*yc, 1); n2*tb - J3*D(yc, 1) - f*yc - load",
                "n1 n2 J1 J2 J3 f T load ya yc",
            ),
            Relation("rigid gears", "ya - n1*n2*yc", "n1 n2 ya yc"),
        ],
    ),
    Form(
        "gear_backwards",
        "rotation",
        NEWTON,
        [
            Relation(
                "inertia and friction behind the gear count with the square of its ratio",
                "T - (J1 + n**2*J2)*D(ya, 1) - n**2*f*ya",
                "n J1 J2 f T ya",
            )
        ],
    ),
    Form(
        "tf_both_in",
        "rotation",
        NEWTON,
        [
            Relation(
                "inertia and friction behind the gear, whatever its sense, by its squared ratio",
                "T - (J1 + J2/n**2)*D(ya, 1) - f/n**2*ya",
                "n J1 J2 f T ya",
            )
        ],
    ),
    Form(
        "rigid_both",
        "rotation",
        NEWTON,
        [Relation("rigid gear", "ya - N*yb", "N ya yb")],
        undetectable="J f",
    ),
    Form(
        "rigid_gear",
        "rotation",
        NEWTON,
        [
            Relation(
                "torque balance of both shafts",
                "T - J1*D(w1, 1) - f1*w1 - (J2*D(w2, 1) + f2*w2)/N",
                "J1 f1 N J2 f2 T w1 w2",
            ),
            Relation("rigid gear", "w1 - N*w2", "N w1 w2"),
        ],
    ),
    Form(
        "backlash_tanh",
        "rotation",
        NEWTON,
        [
            Relation(
                "torque balance of the whole machine",
                "T - J1*D(w1, 1) - J2*D(w2, 1) - f*w2",
                "J1 J2 f T w1 w2",
            ),
            Relation(
                "torque balance of the load, torque of the shaft from its twist",
                "q = Int(w1 - w2, 0); K*(q - t0*tanh(q/t0)) - J2*D(w2, 1) - f*w2",
                "J2 K t0 f w1 w2",
            ),
        ],
    ),
    Form(
        "clutch",
        "rotation",
        SWITCHED,
        [
            Relation(
                "torque balance of the whole machine, in both modes",
                "T - J1*D(w1, 1) - d*w1 - J2*D(w2, 1) - c*w2",
                "J1 J2 c d T w1 w2",
            ),
            Relation(
                "on: the load takes the torque of the slip; off: no slip",
                "Piecewise((J2*D(w2, 1) + c*w2 - kc*(w1 - w2), on), (w1 - w2, True))",
                "J2 c kc w1 w2",
            ),
        ],
        modes="on",
    ),
    Form(
        "rigid_body",
        "rotation",
        RIGID,
        [
            Relation(
                "about x",
                "Jx*D(wx, 1) - (Jy - Jz)*wy*wz + c*wx - Tx",
                "Jx Jy Jz c Tx wx wy wz",
            ),
            Relation("about y", "Jy*D(wy, 1) - (Jz - Jx)*wz*wx", "Jx Jy Jz wx wy wz"),
            Relation("about z", "Jz*D(wz, 1) - (Jx - Jy)*wx*wy", "Jx Jy Jz wx wy wz"),
        ],
    ),
    Form(
        "rigid_body1",
        "rotation",
        RIGID,
        [
            Relation(
                "about y, the third speed from the equation about x",
                "T = Jx*D(wx, 1) + c*wx - Tx; (Jy - Jz)*wy*Jy*D(wy, 1) - (Jz - Jx)*T*wx",
                "Jx Jy Jz c Tx wx wy",
            ),
            Relation(
                "about z, the third speed from the equation about x",
                "m = (Jy - Jz)*wy; T = Jx*D(wx, 1) + c*wx - Tx;"
                " Jz*(D(T, 1)*m - T*D(m, 1)) - (Jx - Jy)*wx*wy*m**2",
                "Jx Jy Jz c Tx wx wy",
            ),
        ],
        positive="wy",
    ),
    Form(
        "pendulum",
        "rotation",
        VIRTUAL,
        [
            Relation(
                "torque balance about the pivot",
                "T - m*l**2*D(pos, 2) - c*D(pos, 1) - m*g*l*sin(pos)",
                "m l c T pos",
            ),
            Relation("the accelerometer", "alpha - D(pos, 2)", "pos alpha"),
        ],
    ),
    Form(
        "slider_theta",
        "rotation, translation",
        VIRTUAL,
        [
            Relation(
                "virtual power of crank and piston",
                "T - J*D(pos, 2) + r*sin(pos)*(m*D(x, 2) + c*D(x, 1))",
                "J m r c T pos x",
            ),
            Relation(
                "position of the piston, once differentiated", "D(x - r*cos(pos), 1)", "r pos x"
            ),
        ],
    ),
    Form(
        "slider_crank",
        "rotation, translation",
        VIRTUAL,
        [
            Relation(
                "virtual power; the piston's place is the geometry of crank and rod",
                "th = Int(speed, 0); v = -D(r*cos(th) + sqrt(l**2 - r**2*sin(th)**2), 1); "
                "T - J*D(speed, 1) - f*speed - v/speed*(m*D(v, 1) + c*v + load)",
                "J f m c r l T load speed",
            )
        ],
    ),
    Form(
        "spring_free",
        "translation",
        NEWTON,
        [
            Relation(
                "forces on the mass, once differentiated: the spring's length is not known",
                "D(F, 1) - m*D(y, 2) - c*D(y, 1) - k*y",
                "k m c F y",
            )
        ],
    ),
    Form(
        "spring_hard_q0",
        "translation",
        NEWTON,
        [
            Relation(
                "forces on the mass, the spring's length from 0.5 on",
                "x = Int(y, 1/2); F - m*D(y, 1) - k*x - x**3",
                "k m F y",
            )
        ],
    ),
    Form(
        "deadzone",
        "translation",
        NEWTON,
        [
            Relation(
                "forces on the mass; the spring acts beyond a play of one to each side",
                "x = Int(y, 0); U - L*D(y, 1) - c*Piecewise((x - 1, x > 1), (x + 1, x < -1), "
                "(0, True))",
                "c L U y",
            )
        ],
    ),
    Form(
        "springs_matrix",
        "translation",
        NEWTON,
        [
            Relation(
                "forces on the first mass; its place from the forces on the second",
                "z = Int(s2, 0); x = -(m2*D(s2, 1) + d*s2 + c*z)/b; F - m1*D(x, 2) - a*x - b*z",
                "a b c m1 m2 d F s2",
            )
        ],
    ),
    Form(
        "springs_matrix_free",
        "translation",
        NEWTON,
        [
            Relation(
                "the same once more differentiated, the places at the start being unknown",
                "v = -(m2*D(s2, 2) + d*D(s2, 1) + c*s2)/b; D(F, 1) - m1*D(v, 2) - a*v - b*s2",
                "a b c m1 m2 d F s2",
            )
        ],
    ),
    Form(
        "stribeck",
        "translation",
        FRICTION,
        [
            Relation(
                "forces on the mass",
                "F - m*D(y, 1) - (Fc + (Fs - Fc)*exp(-(y/vs)**2))*sign(y) - b*y",
                "m Fc Fs vs b F y",
            )
        ],
    ),
    Form(
        "hard_momentum",
        "translation",
        NEWTON,
        [
            Relation(
                "rate of the momentum, once differentiated; p**3 + p/i = y by Cardano's formula",
                "s = (y/2 + sqrt(y**2/4 + 1/(27*i**3)))**(1/3); p = s - 1/(3*i*s); "
                "y/c - D(F, 1) + D(p, 2)",
                "i c F y",
            )
        ],
    ),
    Form(
        "relativistic",
        "translation",
        "rate of the relativistic momentum: Goldstein, Classical Mechanics",
        [
            Relation(
                "forces on the mass",
                "F - R*y - D(m*y/sqrt(1 - y**2/c**2), 1)",
                "m c R F y",
            )
        ],
        values={"c": 3.0},
    ),
    Form(
        "inverse_and_spring",
        "translation",
        NEWTON,
        [
            Relation(
                "law of the mass; its momentum and the spring's length run from their starts",
                "q = Int(y, 1/5); p = Int(F - q/c, 1/2); y - p/i - p**3",
                "i c F y",
            )
        ],
    ),
    Form(
        "quarter_car",
        "translation",
        VEHICLE,
        [
            Relation(
                "forces on the body",
                "ks*stroke + cs*(vw - vb) - ms*(g + D(vb, 1))",
                "ms ks cs vw vb stroke",
            ),
            Relation("compression of the strut", "D(stroke, 1) - vw + vb", "vw vb stroke"),
        ],
        undetectable="mu kt",
    ),
    Form(
        "half_car",
        "translation, rotation",
        VEHICLE,
        [
            Relation(
                "rate of the force of the rear strut, by its law and from forces and torques on "
                "the body, whose weight is constant",
                "e = (a*m*D(yv, 1) - J*D(yt, 1))/(a + b); s = zr - yv + b*yt; "
                "k*s + c*D(s, 1) - D(e, 1)",
                "m J a b k c zr yv yt",
            )
        ],
    ),
    Form(
        "chassis",
        "translation, rotation",
        NEWTON,
        [
            Relation(
                "forces along the body",
                "body__Fx__1 + body__Fx__2 - body__m*D(u, 1) - body__fm*u",
                "body.m body.fm body.Fx[1] body.Fx[2] u",
            ),
            Relation(
                "torques about its middle",
                "body__d/2*(body__Fx__1 - body__Fx__2) - body__Iz*D(yaw, 1) - body__fz*yaw",
                "body.d body.Iz body.fz body.Fx[1] body.Fx[2] yaw",
            ),
        ],
    ),
]
