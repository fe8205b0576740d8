"""Every element and situation that the compiler promises, and the model that shows it."""

from __future__ import annotations

from typing import NamedTuple


class Row(NamedTuple):
    """One line of the table; its C is run for `seconds` of the plant's time.

    `why` says, where it is not run on a power series, what stands in the way. The filter of
    `bandwidth` in rad/s forgets its start by exp(-40) in the time that is run.
    """

    group: str
    situation: str
    domain: str
    model: str
    why: str = ""
    seconds: float = 0.1
    sample_time: float = 1e-4
    bandwidth: float = 400.0


FAST = 0.012, 1e-5, 4000.0  # where products of signals and derivatives bias the filter

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
    ),
    Row("Elements", "the same, seen from the current", "electrical", "boost_duty_i"),
    Row("Elements", "MTF by a switch that is on or off", "electrical", "buck_bool"),
    Row("Elements", "MGY, ring of gyrators of a rigid body", "rotation", "rigid_body"),
    Row("Elements", "the same, one speed not measured", "rotation", "rigid_body1"),
    Row(
        "Elements",
        "MTF by an integrated signal (slider-crank)",
        "rotation, translation",
        "slider_theta",
    ),
    Row(
        "Elements",
        "MTF by a known input: dependent inertia, modulated ratio",
        "rotation",
        "variable_gear",
    ),
    Row(
        "Elements",
        "MSe by an integrated signal: weight of a pendulum",
        "rotation",
        "pendulum",
        "samples are counts, not a series",
    ),
    Row("Elements", "MSe by a sensor: controller", "electrical", "alias_sensor"),
    Row(
        "Elements",
        "MSf by other bond variables: stirred reactor",
        "chemical, thermal",
        "stirred_reactor",
    ),
    Row("Elements", "values that are expressions of parameters and signals", "electrical", "alias"),
    Row("Elements", "parameters without a value", "electrical", "symbolic"),
    Row("Elements", "R field of two ports", "electrical", "r_field"),
    Row("Elements", "I field: coupled coils", "electrical", "mutual"),
    Row("Elements", "the same, one current measured", "electrical", "mutual1"),
    Row("Elements", "C field: stiffness matrix", "translation", "springs_matrix"),
    Row(
        "Elements",
        "the same from an unknown start: fourth derivative",
        "translation",
        "springs_matrix_free",
        "",
        0.2,
        1e-4,
        200.0,
    ),
    Row(
        "Elements", "C field, mixed causality (condenser microphone)", "electrical, acoustic", "mic"
    ),
    Row("Elements", "IC field: magnet and ball", "electrical, translation", "solenoid"),
    Row(
        "Elements",
        "IC field: reluctance motor, its flux at the start not known",
        "electrical, rotation",
        "reluctance",
    ),
    Row("Elements", "C field of mass and energy of a gas, inverted", "thermofluid", "gas_tank"),
    Row(
        "Elements",
        "windings as GY, reluctances as C, iron that saturates",
        "electrical, magnetic",
        "magnetic_core",
    ),
    Row("Elements", "core of three legs", "electrical, magnetic", "magnetic_tee"),
    Row(
        "Elements",
        "GY and TF from coil to cone to air",
        "electrical, translation, acoustic",
        "loudspeaker",
    ),
    Row("Elements", "acoustic mass and compliance", "acoustic", "helmholtz"),
    Row(
        "Elements",
        "modulated valve, two chambers, piston, leak",
        "hydraulic, translation",
        "cylinder",
    ),
    Row("Elements", "friction law with the fall of Stribeck", "translation", "stribeck"),
    Row("Elements", "friction by sign", "translation", "friction_sign"),
    Row("Elements", "drag by abs", "translation", "drag_abs"),
    Row("Elements", "resistor of third order", "electrical", "cubic_law"),
    Row("Elements", "saturation by min and max", "electrical", "saturation"),
    Row("Elements", "backlash by tanh", "rotation", "backlash_tanh", seconds=0.4),
    Row("Elements", "table lookup", "electrical", "table_law"),
    Row("Elements", "law in one direction: diode in series", "electrical", "diode_series_r"),
    Row("Elements", "exponential law inverted: voltage from current", "electrical", "diode_i"),
    Row("Elements", "implicit law", "hydraulic", "three_tanks_implicit"),
    Row("Elements", "nonlinear storage, momentum by a root", "translation", "hard_momentum"),
    Row("Elements", "nonlinear storage with a closed inverse", "translation", "relativistic"),
    Row(
        "Elements", "momentum and length from declared starts", "translation", "inverse_and_spring"
    ),
    Row("Elements", "hardening spring from a declared start", "translation", "spring_hard_q0"),
    Row("Elements", "pseudo bond graph: temperature and heat flow", "thermal", "heat_exchanger"),
    Row("Elements", "heat conducted along a rod", "thermal", "heated_rod"),
    Row("Elements", "pseudo bond graph: level and enthalpy", "thermofluid", "thermofluid"),
    Row("Elements", "reaction: R with two ports, exponentials", "chemical", "chemical"),
    Row("Elements", "enzyme by Michaelis and Menten", "chemical", "michaelis"),
    Row("Elements", "chain of reactions", "chemical", "reaction_chain"),
    Row("Elements", "dependent storage: C across Se", "electrical", "c_se_dependent"),
    Row("Elements", "leak that is nominally zero, linear", "hydraulic", "tank_leak"),
    Row(
        "Elements",
        "leaks of two laws, one sensor for three tanks",
        "hydraulic",
        "three_tanks_level3",
    ),
    Row("Elements", "leak of a machine in SI units", "hydraulic", "two_tanks"),
    Row("Elements", "switched element", "electrical", "switch_r"),
    Row("Elements", "switched 1-junction", "electrical", "switched_junction"),
    Row("Elements", "switched 0-junction", "electrical", "switched_zero"),
    Row("Elements", "two switched branches in parallel", "electrical", "parallel_switches"),
    Row("Elements", "source that a thermostat switches", "thermal", "oven"),
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
    Row("Sensors", "three on one junction: each bias is isolated", "thermal", "three_thermometers"),
    Row("Sensors", "De that a source fixes: cannot be dualised", "electrical", "de_on_se"),
    Row("Sensors", "three around a junction without storage", "electrical", "three_df"),
    Row("Sensors", "both sides of a rigid transformer", "rotation", "rigid_both"),
    Row("Sensors", "unknown input; what it hides", "electrical, rotation", "dc_unknown_load"),
    Row(
        "Sensors", "two unknown inputs at one place count once", "electrical", "unknown_same_place"
    ),
    Row("Sensors", "unknown inputs that use up one of three sensors", "electrical", "two_unknown"),
    Row("Sensors", "unknown road under one wheel of two", "translation, rotation", "half_car"),
    Row("Sensors", "part without any sensor", "electrical, rotation", "two_motors"),
    Row(
        "Sensors",
        "all redundancy used up by unknown inputs",
        "electrical, rotation",
        "dc_unknown_all",
        "no relation",
    ),
    Row("Sensors", "no sensor", "electrical, rotation", "dc_none", "no relation"),
    Row("Loops", "linear algebraic loop: bridge", "electrical", "wheatstone"),
    Row("Loops", "the same with three sensors", "electrical", "wheatstone2"),
    Row("Loops", "bridge whose balance hides the supply", "electrical", "wheatstone_balanced"),
    Row("Loops", "grid of resistors", "electrical", "grid3"),
    Row("Loops", "larger grid", "electrical", "grid5"),
    Row("Loops", "linear differential loop", "electrical", "rlc_loop"),
    Row("Loops", "three coils in parallel", "electrical", "rl_parallel"),
    Row("Loops", "odd cycle of gyrators", "electrical", "gyrator_cycle3"),
    Row("Loops", "odd cycle of gyrators with resistors", "electrical", "gyrator_cycle3_res"),
    Row("Loops", "nonlinear loop, one Newton block", "electrical", "cubic_parallel"),
    Row("Loops", "nonlinear node of diodes", "electrical", "node_of_diodes"),
    Row("Loops", "bridge of four diodes, not grounded", "electrical", "bridge_rectifier"),
    Row("Loops", "root inside a root", "electrical", "nested_roots"),
    Row("Loops", "two laws without inverse at one node", "hydraulic", "two_tanh"),
    Row("Loops", "diode and storage behind one node", "electrical", "diode_loop"),
    Row("Machines", "Cuk's converter by its duty cycle", "electrical", "cuk", "", *FAST),
    Row("Machines", "motor on an H bridge", "electrical, rotation", "h_bridge"),
    Row("Machines", "synchronous motor with magnets", "electrical, rotation", "pmsm"),
    Row("Machines", "the same in the frame of its stator", "electrical, rotation", "pmsm_park"),
    Row("Machines", "induction motor, fluxes not known", "electrical, rotation", "induction"),
    Row("Machines", "motor with every arrow reversed", "electrical, rotation", "motor_reversed"),
    Row("Machines", "battery, charge counted", "electrical, chemical", "battery"),
    Row("Machines", "solar cell under unknown light", "electrical", "solar_cell"),
    Row("Machines", "gas accumulator, check valve by max", "hydraulic", "accumulator"),
    Row("Machines", "tank under unknown heat", "thermofluid", "boiler"),
    Row("Machines", "load under a crane", "translation, rotation", "crane"),
    Row("Machines", "planetary gear", "rotation", "planetary"),
    Row("Machines", "car in the plane", "translation, rotation", "bicycle"),
    Row("Machines", "the same, front and rear alike", "translation, rotation", "bicycle_neutral"),
    Row("Machines", "wind turbine in unknown wind", "rotation", "wind_turbine"),
]
