"""What nobody reads is left out of a program, in programs that are written by hand."""

from __future__ import annotations

from bondgraph.ir.program import Const, Field, PolynomialTape, Program, TapeOp, TapeOutput
from bondgraph.passes.lowering.prune import pruned
from tests.unit.backends import programs
from tests.unit.backends.programs import plus, put, ref, times


def _targets(program: Program, procedure: str) -> list[str]:
    return [s.target.name for s in getattr(program, procedure)]


def test_locals_are_kept_as_far_as_a_residual_or_a_memory_rests_on_them() -> None:
    step = (
        put("local:a", ref("known:y")),
        put("local:b", times(ref("local:a"), Const(2.0))),
        put("local:c", ref("local:b")),  # of which nobody knows
        put("local:d", ref("known:y")),
        put("state:x", ref("local:d")),
        put("residual:r1", ref("local:b")),
        put("local:e", ref("residual:r1")),
    )
    program = programs.program("M", (programs.residual("r1"),), step=step, first=step, exact=step)
    found = pruned(program)
    for procedure in ("exact", "first", "step"):
        assert _targets(found, procedure) == ["a", "b", "d", "x", "r1"]


def test_a_local_that_is_read_before_it_is_set_again_is_kept_twice() -> None:
    step = (
        put("local:a", Const(1.0)),
        put("local:a", plus(ref("local:a"), ref("known:y"))),
        put("residual:r1", ref("local:a")),
    )
    found = pruned(programs.program("M", (programs.residual("r1"),), step=step))
    assert found.step == step


def test_locals_of_one_procedure_are_not_those_of_another() -> None:
    program = programs.program(
        "M",
        (programs.residual("r1"),),
        first=(put("local:a", ref("known:y")), put("residual:r1", ref("known:y"))),
        step=(put("local:a", ref("known:y")), put("residual:r1", ref("local:a"))),
    )
    found = pruned(program)
    assert _targets(found, "first") == ["r1"] and _targets(found, "step") == ["a", "r1"]


def test_coefficients_and_parameters_are_kept_for_any_procedure_that_reads_them() -> None:
    names = ("exact", "first", "step", "other", "none")
    program = programs.program(
        "M",
        (programs.residual("r1"),),
        params=tuple(Field(f"p_{n}", "", "", "") for n in names),
        coefs=tuple(Field(n, "", "", "") for n in names),
        configure=(
            put("local:half", times(Const(0.5), ref("param:p_other"))),
            put("coef:other", ref("local:half")),
            *[put(f"coef:{n}", ref(f"param:p_{n}")) for n in ("exact", "first")],
            put("coef:step", plus(ref("coef:other"), ref("param:p_step"))),
            put("local:unused", ref("param:p_none")),
            put("coef:none", ref("param:p_none")),
        ),
        **{n: (put("residual:r1", ref(f"coef:{n}")),) for n in ("exact", "first", "step")},
    )
    found = pruned(program)
    assert [c.name for c in found.coefs] == ["exact", "first", "step", "other"]
    assert [p.name for p in found.params] == ["p_exact", "p_first", "p_step", "p_other"]
    assert _targets(found, "configure") == ["half", "other", "exact", "first", "step"]


def _tape(*arrays: str) -> PolynomialTape:
    outputs = tuple(TapeOutput(name, 0, 1) for name in arrays)
    return PolynomialTape(
        "r1", 1, 1, (ref("param:R"), ref("local:cell")), (TapeOp(0, 0, 0, 0, 1, False),), outputs,
        "", None,
    )  # fmt: skip


def test_a_tape_is_kept_for_the_outputs_that_are_read() -> None:
    """By loops over all derivatives, or element by element; with what its factors need."""
    ladder = programs.ladder()
    configure = (put("local:cell", ref("param:C")), _tape("one", "two", "y_polynomial"))
    program = ladder._replace(configure=configure, step=(), first=())
    found = pruned(program)
    assert [c.name for c in found.coefs] == ["y_polynomial", "one"]
    tape = found.configure[-1]
    assert isinstance(tape, PolynomialTape) and len(found.configure) == 2
    assert [out.array for out in tape.outputs] == ["one", "y_polynomial"]
    assert [p.name for p in found.params] == ["R", "C"]
    alone = program._replace(exact=(put("residual:r1", ref("coef:one:0")),))
    assert [c.name for c in pruned(alone).coefs] == ["one"]
    nobody = pruned(program._replace(exact=(put("residual:r1", ref("known:y")),)))
    assert (nobody.configure, nobody.coefs, nobody.params) == ((), (), ())
