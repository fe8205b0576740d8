"""Every element and situation that the compiler promises, and the model that shows it."""

from __future__ import annotations

from typing import NamedTuple


class Row(NamedTuple):
    """One line of the table; its C is run for `seconds` of the plant's time.

    `why` says, where it is not run, what stands in the way.
    """

    group: str
    situation: str
    domain: str
    model: str
    why: str = ""
    seconds: float = 0.1


ROWS = [
    Row("Elements", "Se, I, R, GY, two ports of one motor", "electrical, rotation", "dc_iw"),
    Row("Elements", "C and I as a chain of cells, arrays", "electrical", "arrays"),
    Row("Elements", "Sf, C, orifices with a square root", "hydraulic", "three_tanks"),
    Row("Elements", "TF, gear train of two ratios", "rotation", "gear_train"),
    Row("Elements", "TF drawn with both bonds inwards", "rotation", "tf_both_in"),
    Row("Elements", "GY drawn with both bonds outwards", "electrical, rotation", "gy_both_out"),
    Row("Elements", "MTF by a duty cycle", "electrical", "buck_duty"),
    Row(
        "Elements",
        "MTF by a duty cycle that the flow returns to",
        "electrical",
        "boost_duty",
        "a product of a signal and a derivative keeps the bias of the filter",
    ),
    Row("Elements", "MGY, ring of gyrators of a rigid body", "rotation", "rigid_body"),
    Row(
        "Elements",
        "MTF by an integrated signal (slider-crank)",
        "rotation, translation",
        "slider_theta",
    ),
    Row("Elements", "values that are expressions of parameters and signals", "electrical", "alias"),
    Row("Elements", "parameters without a value", "electrical", "symbolic"),
    Row("Elements", "R field of two ports", "electrical", "r_field"),
    Row("Elements", "I field: coupled coils", "electrical", "mutual"),
    Row("Elements", "C field: stiffness matrix", "translation", "springs_matrix"),
    Row(
        "Elements", "C field, mixed causality (condenser microphone)", "electrical, acoustic", "mic"
    ),
    Row(
        "Elements",
        "modulated valve, two chambers, piston, leak",
        "hydraulic, translation",
        "cylinder",
    ),
    Row("Elements", "friction law with the fall of Stribeck", "translation", "stribeck"),
    Row("Elements", "saturation by min and max", "electrical", "saturation"),
    Row("Elements", "backlash by tanh", "rotation", "backlash_tanh", seconds=0.4),
    Row("Elements", "table lookup", "electrical", "table_law"),
    Row("Elements", "law in one direction: diode in series", "electrical", "diode_series_r"),
    Row("Elements", "implicit law", "hydraulic", "three_tanks_implicit"),
    Row("Elements", "nonlinear storage, momentum by a root", "translation", "hard_momentum"),
    Row("Elements", "nonlinear storage with a closed inverse", "translation", "relativistic"),
    Row("Elements", "pseudo bond graph: temperature and heat flow", "thermal", "heat_exchanger"),
    Row("Elements", "pseudo bond graph: level and enthalpy", "thermofluid", "thermofluid"),
    Row("Elements", "reaction: R with two ports, exponentials", "chemical", "chemical"),
    Row("Elements", "enzyme by Michaelis and Menten", "chemical", "michaelis"),
    Row("Elements", "dependent storage: C across Se", "electrical", "c_se_dependent"),
    Row("Elements", "switched element", "electrical", "switch_r"),
    Row("Elements", "switched 1-junction", "electrical", "switched_junction"),
    Row("Elements", "switched 0-junction", "electrical", "switched_zero"),
    Row("Elements", "clutch", "rotation", "clutch"),
    Row("Sensors", "one of two detectors: speed from current", "electrical, rotation", "dc_i"),
    Row("Sensors", "angle, the integral of a flow", "electrical, rotation", "dc_angle"),
    Row(
        "Sensors",
        "encoder",
        "electrical, rotation",
        "dc_encoder",
        "samples are counts, not a series",
    ),
    Row("Sensors", "product of effort and flow", "electrical, rotation", "dc_power"),
    Row("Sensors", "acceleration", "electrical, rotation", "dc_acc"),
    Row("Sensors", "products, energies and charges together", "electrical", "sensors_odd"),
    Row("Sensors", "two on one junction, and one instrument twice", "electrical", "redundant_df"),
    Row("Sensors", "De that a source fixes: cannot be dualised", "electrical", "de_on_se"),
    Row("Sensors", "three around a junction without storage", "electrical", "three_df"),
    Row("Sensors", "both sides of a rigid transformer", "rotation", "rigid_both"),
    Row("Sensors", "unknown input; what it hides", "electrical, rotation", "dc_unknown_load"),
    Row(
        "Sensors", "two unknown inputs at one place count once", "electrical", "unknown_same_place"
    ),
    Row(
        "Sensors",
        "all redundancy used up by unknown inputs",
        "electrical, rotation",
        "dc_unknown_all",
        "no relation",
    ),
    Row("Sensors", "no sensor", "electrical, rotation", "dc_none", "no relation"),
    Row("Loops", "linear algebraic loop: bridge", "electrical", "wheatstone"),
    Row("Loops", "bridge whose balance hides the supply", "electrical", "wheatstone_balanced"),
    Row("Loops", "grid of resistors", "electrical", "grid3"),
    Row("Loops", "linear differential loop", "electrical", "rlc_loop"),
    Row("Loops", "odd cycle of gyrators", "electrical", "gyrator_cycle3"),
    Row("Loops", "odd cycle of gyrators with resistors", "electrical", "gyrator_cycle3_res"),
    Row("Loops", "nonlinear loop, one Newton block", "electrical", "cubic_parallel"),
    Row("Loops", "nonlinear node of diodes", "electrical", "node_of_diodes"),
    Row("Loops", "root inside a root", "electrical", "nested_roots"),
    Row("Loops", "diode and storage behind one node", "electrical", "diode_loop"),
]
