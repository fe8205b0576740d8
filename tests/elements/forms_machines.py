"""Machines: motors, microphones and the mobile robot, electrical and mechanical laws together."""

from __future__ import annotations

from tests.elements.forms import FIELDS, MACHINE, ROBOT, Form, Relation

MOTOR = "L R k J f U T"
HUB = "{0}wh__Js*D({0}wh__ws, 1) + {0}wh__fs*{0}wh__ws + {0}wh__R*{1}"
SLIP = "tanh((Int({0}me__we, 0) - {0}ge__N*Int({0}wh__ws, 0))/(4*{1}tau0))"


def drive(at: str, path: str, force: str, told: str, supply: str, fed: str) -> list[Relation]:
    """Both relations of one drive of the robot: `at` and `path` are where its names begin."""
    hub = f"h = {HUB.format(at, force)}"
    armature = "el.L el.Re el.k me.Je me.fe ge.N wh.Js wh.fs wh.R me.we wh.ws".split()
    shaft = "tau0 A me.K ge.N wh.Js wh.fs wh.R me.we wh.ws".split()
    return [
        Relation(
            "voltage law of the armature; its current from the torques of rotor and hub, between "
            "which the torque of the backlash is action and reaction",
            f"{hub}; i = ({at}me__Je*D({at}me__we, 1) + {at}me__fe*{at}me__we + h/{at}ge__N)"
            f"/{at}el__k; {supply} - {at}el__L*D(i, 1) - {at}el__Re*i - {at}el__k*{at}me__we",
            " ".join([*[path + x for x in armature], told, fed]),
        ),
        Relation(
            "the shaft twists at the difference of the speeds; its torque is what the hub takes "
            "less the torque of the backlash",
            f"{hub}; w = {at}A*{at}me__K*{at}tau0*{SLIP.format(at, at)}; "
            f"{at}me__we - {at}ge__N*{at}wh__ws - D(h/{at}ge__N - w, 1)/{at}me__K",
            " ".join([*[path + x for x in shaft], told]),
        ),
    ]


LINE = Relation(
    "voltage law of both halves of the cable's cell, currents from its end",
    "i = line__C*D(Us, 1); m = Us + line__R/2*i + line__L/2*D(i, 1); j = i + line__C*D(m, 1); "
    "Uin - m - line__R/2*j - line__L/2*D(j, 1)",
    "line.R line.L line.C Uin Us",
)

FORMS = [
    Form(
        "dc_i",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "torque balance, the speed from the voltage law",
                "w = (U - R*yi - L*D(yi, 1))/k; J*D(w, 1) + f*w + T - k*yi",
                f"{MOTOR} yi",
            )
        ],
    ),
    Form(
        "dc_w",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "voltage law, the current from the torque balance",
                "i = (J*D(yw, 1) + f*yw + T)/k; U - R*i - L*D(i, 1) - k*yw",
                f"{MOTOR} yw",
            )
        ],
    ),
    Form(
        "dc_iw",
        "electrical, rotation",
        MACHINE,
        [
            Relation("voltage law", "U - R*yi - L*D(yi, 1) - k*yw", "L R k U yi yw"),
            Relation("torque balance", "k*yi - J*D(yw, 1) - f*yw - T", "k J f T yi yw"),
        ],
    ),
    Form(
        "dc_motor",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "voltage law",
                "U - R*current - L*D(current, 1) - k*speed",
                "L R k U current speed",
            ),
            Relation(
                "torque balance",
                "k*current - J*D(speed, 1) - f*speed - load",
                "k J f load current speed",
            ),
        ],
    ),
    Form(
        "dc_angle",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "voltage law, the current from the torque balance, the speed from the angle",
                "i = (J*D(th, 2) + f*D(th, 1) + T)/k; U - R*i - L*D(i, 1) - k*D(th, 1)",
                f"{MOTOR} th",
            )
        ],
    ),
    Form(
        "dc_encoder",
        "electrical, rotation",
        MACHINE,
        [
            Relation("voltage law", "U - R*yi - L*D(yi, 1) - k*D(th, 1)", "L R k U yi th"),
            Relation("torque balance", "k*yi - J*D(th, 2) - f*D(th, 1) - T", "k J f T yi th"),
        ],
    ),
    Form(
        "dc_acc",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "voltage law and torque balance, both differentiated: the speed is not known",
                "s = (J*D(acc, 1) + f*acc + D(T, 1))/k; D(U, 1) - R*s - L*D(s, 1) - k*acc",
                f"{MOTOR} acc",
            )
        ],
    ),
    Form(
        "dc_power",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "torque balance, the speed from the voltage law, the current from the power",
                "i = power/U; w = (U - R*i - L*D(i, 1))/k; J*D(w, 1) + f*w + T - k*i",
                f"{MOTOR} power",
            )
        ],
        positive="U",
    ),
    Form(
        "dc_unknown_load",
        "electrical, rotation",
        MACHINE,
        [Relation("voltage law", "U - R*yi - L*D(yi, 1) - k*yw", "L R k U yi yw")],
        undetectable="J f",
    ),
    Form(
        "gy_both_out",
        "electrical, rotation",
        MACHINE,
        [
            Relation(
                "voltage law; both half arrows leave the gyrator, so the torque is -r times the "
                "current",
                "i = -(J*D(y, 1) + f*y)/r; U + r*y - R*i - L*D(i, 1)",
                "r L J f R U y",
            )
        ],
    ),
    Form(
        "mic",
        "electrical, acoustic",
        FIELDS,
        [
            Relation(
                "current into the plates, charge = capacitance of the gap times voltage",
                "q = A*u/Int(v, x0); (U - u)/R - D(q, 1)",
                "A R U u v",
            ),
            Relation(
                "forces on the membrane, the pull of the charge among them",
                "q = A*u/Int(v, x0); F - q**2/(2*A) - m*D(v, 1) - b*v - k*Int(v, 0)",
                "A m b k F u v",
            ),
        ],
    ),
    Form(
        "solenoid",
        "electrical, translation",
        FIELDS,
        [
            Relation(
                "voltage law of the coil, whose inductance is 2 K over the gap",
                "g = Int(v, gap0); U - R*i - D(2*K*i/g, 1)",
                "R K U i v",
            ),
            Relation(
                "forces on the ball: its weight, the pull of the magnet",
                "g = Int(v, gap0); w - K*i**2/g**2 - m*D(v, 1)",
                "K m w i v",
            ),
        ],
    ),
    Form(
        "reluctance",
        "electrical, rotation",
        FIELDS,
        [
            Relation(
                "voltage law of the phase, whose inductance goes with the angle",
                "a = Int(w, 3/10); U - R*i - D(i*(L0 + L1*cos(a)), 1)",
                "R L0 L1 U i w",
            ),
            Relation(
                "torques on the shaft; half the square of the current times the rate at which the "
                "inductance changes turns it",
                "a = Int(w, 3/10); -L1*sin(a)*i**2/2 - load - b*w - J*D(w, 1)",
                "L1 J b load i w",
            ),
        ],
    ),
    Form(
        "microphone",
        "electrical, acoustic",
        FIELDS,
        [
            Relation(
                "current into the plates, charge = capacitance of the gap times voltage",
                "q = eps*A*u/Int(v, x0); (U0 - u)/R - D(q, 1)",
                "A R U0 u v",
            ),
            Relation(
                "forces on the membrane, the pull of the charge among them",
                "q = eps*A*u/Int(v, x0); "
                "pressure*A - q**2/(2*eps*A) - m*D(v, 1) - b*v - k*Int(v, 0)",
                "A m b k pressure u v",
            ),
        ],
    ),
    Form(
        "drive",
        "electrical, rotation, translation",
        ROBOT,
        drive("m__", "m.", "Fx", "Fx", "U0", "U0"),
    ),
    Form(
        "drive_fig6",
        "electrical, rotation, translation",
        ROBOT,
        [
            Relation(
                "voltage law; as drawn, the torque of the backlash drives rotor and hub alike and "
                "counts twice",
                f"h = {HUB.format('', 'Fx')}; w = A*me__K*tau0*{SLIP.format('', '')}; "
                "i = (me__Je*D(me__we, 1) + me__fe*me__we + h/ge__N - 2*w)/el__k; "
                "U0 - el__L*D(i, 1) - el__Re*i - el__k*me__we",
                "tau0 A el.L el.Re el.k me.Je me.fe me.K ge.N wh.Js wh.fs wh.R U0 Fx me.we wh.ws",
            ),
            Relation(
                "the shaft twists at the difference of the speeds",
                f"h = {HUB.format('', 'Fx')}; w = A*me__K*tau0*{SLIP.format('', '')}; "
                "me__we - ge__N*wh__ws - D(h/ge__N - w, 1)/me__K",
                "tau0 A me.K ge.N wh.Js wh.fs wh.R Fx me.we wh.ws",
            ),
        ],
    ),
    Form(
        "khepera",
        "electrical, rotation, translation",
        ROBOT,
        [
            *drive("m__1__", "m[1].", "Fx__1", "Fx[1]", "U0__1", "U0[1]"),
            *drive("m__2__", "m[2].", "Fx__2", "Fx[2]", "U0__2", "U0[2]"),
            LINE,
        ],
        undetectable="body.m body.fm body.d body.Iz body.fz",
    ),
]
