"""Electrical and mechanical models with their physics by hand."""

from __future__ import annotations

from tests.adversary.plant import Plant, model

PLANTS = [
    Plant(
        "dc_i",
        model("dc_i"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"yi": "i"},
        n_arr=1,
        params="L R k J f",
        inputs="U T",
    ),
    Plant(
        "dc_w",
        model("dc_w"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"yw": "w"},
        n_arr=1,
        params="L R k J f",
        inputs="U T",
    ),
    Plant(
        "dc_iw",
        model("dc_iw"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"yi": "i", "yw": "w"},
        n_arr=2,
        params="L R k J f",
        inputs="U T",
    ),
    Plant(
        "dc_none",
        model("dc_none"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={},
        n_arr=0,
        params="L R k J f",
        inputs="U T",
        undetectable="L R k J f U T",
        status="no_arr",
    ),
    Plant(
        "dc_angle",
        model("dc_angle"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w; D(th) - w"),
        sensors={"th": "th"},
        n_arr=1,
        params="L R k J f",
        inputs="U T",
        starts={"th": "0"},
    ),
    Plant(
        "dc_encoder",
        model("dc_encoder"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w; D(th) - w"),
        sensors={"th": "th", "yi": "i"},
        n_arr=2,
        params="L R k J f",
        inputs="U T",
        starts={"th": "0"},
    ),
    Plant(
        "dc_power",
        model("dc_power"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"power": "U*i"},
        n_arr=1,
        params="L R k J f",
        inputs="U T",
    ),
    Plant(
        "dc_unknown_load",
        model("dc_unknown_load"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"yi": "i", "yw": "w"},
        n_arr=1,
        params="L R k J f",
        inputs="U",
        unknown="T",
        undetectable="J f",
    ),
    Plant(
        "dc_unknown_all",
        model("dc_unknown_all"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"yi": "i"},
        n_arr=0,
        params="L R k J f",
        unknown="U T",
        status="no_arr",
    ),
    Plant(
        "dc_acc",
        model("dc_acc"),
        equations=("U - R*i - D(pL) - k*w; pL - L*i; k*i - D(pJ) - f*w - T; pJ - J*w"),
        sensors={"acc": "D(w)"},
        n_arr=1,
        params="L R k J f",
        inputs="U T",
    ),
    Plant(
        "wheatstone",
        model("wheatstone"),
        equations=("(U-l)/R1 - l/R2 - (l-r)/R5; (U-r)/R3 - r/R4 + (l-r)/R5"),
        sensors={"yl": "l"},
        n_arr=1,
        params="R1 R2 R3 R4 R5",
        inputs="U",
    ),
    Plant(
        "wheatstone2",
        model("wheatstone2"),
        equations=("(U-l)/R1 - l/R2 - (l-r)/R5; (U-r)/R3 - r/R4 + (l-r)/R5"),
        sensors={"yl": "l", "yr": "r", "y5": "(l-r)/R5"},
        n_arr=3,
        params="R1 R2 R3 R4 R5",
        inputs="U",
    ),
    Plant(
        "wheatstone_balanced",
        model("wheatstone_balanced"),
        equations=("(U-l)/R - l/R - (l-r)/R5; (U-r)/R - r/R + (l-r)/R5"),
        sensors={"y5": "(l-r)/R5"},
        n_arr=1,
        params="R R5",
        inputs="U",
        undetectable="R R5 U",
    ),
    Plant(
        "wheatstone_balanced2",
        model("wheatstone_balanced2"),
        equations=("(U-l)/R - l/q - (l-r)/R5; (U-r)/R - r/q + (l-r)/R5"),
        sensors={"y5": "(l-r)/R5"},
        n_arr=1,
        params="R R5 q",
        inputs="U",
        undetectable="R R5 U q",
    ),
    Plant(
        "grid2",
        model("grid2"),
        equations=("(U - m1)/A1 - m1/B1 - (m1 - m2)/X1; (U - m2)/A2 - m2/B2 + (m1 - m2)/X1"),
        sensors={"i1": "(U - m1)/A1", "un": "m2"},
        n_arr=2,
        params="A1 B1 X1 A2 B2",
        inputs="U",
    ),
    Plant(
        "grid3",
        model("grid3"),
        equations=(
            "(U - m1)/A1 - m1/B1 - (m1 - m2)/X1; "
            "(U - m2)/A2 - m2/B2 - (m2 - m3)/X2 + (m1 - m2)/X1; "
            "(U - m3)/A3 - m3/B3 + (m2 - m3)/X2"
        ),
        sensors={"i1": "(U - m1)/A1", "un": "m3"},
        n_arr=2,
        params="A1 B1 X1 A2 B2 X2 A3 B3",
        inputs="U",
    ),
    Plant(
        "grid4",
        model("grid4"),
        equations=(
            "(U - m1)/A1 - m1/B1 - (m1 - m2)/X1; "
            "(U - m2)/A2 - m2/B2 - (m2 - m3)/X2 + (m1 - m2)/X1; "
            "(U - m3)/A3 - m3/B3 - (m3 - m4)/X3 + (m2 - m3)/X2; "
            "(U - m4)/A4 - m4/B4 + (m3 - m4)/X3"
        ),
        sensors={"i1": "(U - m1)/A1", "un": "m4"},
        n_arr=2,
        params="A1 B1 X1 A2 B2 X2 A3 B3 X3 A4 B4",
        inputs="U",
    ),
    Plant(
        "grid5",
        model("grid5"),
        equations=(
            "(U - m1)/A1 - m1/B1 - (m1 - m2)/X1; "
            "(U - m2)/A2 - m2/B2 - (m2 - m3)/X2 + (m1 - m2)/X1; "
            "(U - m3)/A3 - m3/B3 - (m3 - m4)/X3 + (m2 - m3)/X2; "
            "(U - m4)/A4 - m4/B4 - (m4 - m5)/X4 + (m3 - m4)/X3; "
            "(U - m5)/A5 - m5/B5 + (m4 - m5)/X4"
        ),
        sensors={"i1": "(U - m1)/A1", "un": "m5"},
        n_arr=2,
        params="A1 B1 X1 A2 B2 X2 A3 B3 X3 A4 B4 X4 A5 B5",
        inputs="U",
    ),
    Plant(
        "rlc_loop",
        model("rlc_loop"),
        equations=(
            "U - R1*i1 - D(p1) - un; p1 - L1*i1; un - um - R2*i2; un - um - D(p2); "
            "p2 - L2*i3; i1 - i2 - i3 - D(q1); q1 - C1*un; i2 + i3 - D(q2); q2 - C2*um"
        ),
        sensors={"y": "un"},
        n_arr=1,
        params="R1 R2 L1 L2 C1 C2",
        inputs="U",
    ),
    Plant(
        "rl_parallel",
        model("rl_parallel"),
        equations=(
            "U - R0*i - un; i - ia - ib - ic; un - R1*ia - D(pa); un - R2*ib - D(pb); "
            "un - D(pc); pa - L1*ia; pb - L2*ib; pc - L3*ic"
        ),
        sensors={"y": "i"},
        n_arr=1,
        params="L1 L2 L3 R0 R1 R2",
        inputs="U",
    ),
]
