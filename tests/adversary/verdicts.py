"""Models of which only the verdict is known: what they show, status, count and what is said."""

from __future__ import annotations

from typing import NamedTuple


class Verdict(NamedTuple):
    """`code` is that of a diagnostic that must be among those given."""

    name: str
    status: str
    n_arr: int
    code: str
    situation: str


VERDICTS = [
    Verdict("empty_model", "error", 0, "empty-model", "a model without anything in it"),
    Verdict("only_param", "error", 0, "empty-model", "a model of parameters alone"),
    Verdict("no_sensor", "no_arr", 0, "", "a machine without sensors"),
    Verdict("se_se", "error", 0, "causality-conflict", "two effort sources on one junction"),
    Verdict("se_se_across", "error", 0, "causality-conflict", "the same across a transformer"),
    Verdict("sf_sf_through", "error", 0, "causality-conflict", "two flow sources in series"),
    Verdict("sf_loop", "ok", 1, "", "two flow sources on the sides of a gyrator: no conflict"),
    Verdict("tf_ring", "ok", 1, "algebraic-loop", "a ring of transformers of gain 6: all at rest"),
    Verdict(
        "tf_ring_1", "ok", 1, "algebraic-loop", "one of gain 1: nothing fixes the flow around it"
    ),
    Verdict("junction_ring", "ok", 1, "algebraic-loop", "a ring of junctions: as before"),
    Verdict("zero_n", "ok", 1, "dependent-storage", "an array of no cells"),
    Verdict("two_names", "ok", 1, "", "`a.b` and `a_b` are two names"),
    Verdict("self_int", "error", 0, "circular-definition", "an integral of itself"),
    Verdict("power_units", "ok", 1, "", "units of a product"),
    Verdict("sensor_unknown", "no_arr", 0, "", "a sensor that the unknown input uses up"),
    Verdict("sensor_input", "ok", 1, "", "a sensor of a known input"),
    Verdict("sensor_product_unknown", "ok", 1, "", "a product that hides no unknown"),
    Verdict("dup_sensor_products", "ok", 2, "", "sensors of power and of effort"),
    Verdict("coulomb_only_i", "ok", 1, "", "dry friction by its sign, without mass"),
    Verdict("coulomb_blocked", "ok", 2, "", "dry friction whose flow is the unknown"),
    Verdict("deadzone", "ok", 1, "", "a dead zone in the direction that it is written in"),
    Verdict("deadzone_inv", "refused", 0, "loop-unsolvable", "one that would have to be inverted"),
    Verdict("loop_of_many", "refused", 0, "loop-unsolvable", "a loop of several solutions"),
    Verdict("start_needed", "refused", 0, "initial-value-needed", "a start that is not declared"),
    Verdict(
        "partly_known", "ok", 1, "initial-value-needed", "the same beside a part that is known"
    ),
    Verdict("implicit_ambiguous", "ok", 1, "", "an implicit law that is used in its one direction"),
    Verdict("kepler", "ok", 1, "", "a law without inverse, used as written"),
    Verdict("expon", "ok", 1, "", "another"),
    Verdict("algebraic_self", "ok", 1, "", "a source that depends on its own flow"),
    Verdict("algebraic_singular", "ok", 1, "algebraic-loop", "one whose loop cancels a resistor"),
    Verdict("redundant_df", "ok", 2, "same-instrument", "one instrument behind two detectors"),
    Verdict("grid5", "ok", 2, "algebraic-loop", "a loop of fourteen resistors"),
    Verdict("gear_train", "ok", 2, "dependent-storage", "inertias without a state of their own"),
]
