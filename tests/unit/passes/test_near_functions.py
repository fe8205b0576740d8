"""Functions that are replaced by those near them, wherever they stand in `step`."""

from __future__ import annotations

from bondgraph.ir.program import Branch, Choice, Compare, Const, Function
from bondgraph.passes.lowering.near_functions import near_functions
from tests.unit.backends import programs
from tests.unit.backends.programs import plus, put, ref, times

_Y = ref("known:y")


def _tanh(name: str, inner: Function | None = None) -> Function:
    """tanh, or what is near it, of y or of something else."""
    return Function(name, (inner or _Y,))


def _statement(name: str) -> object:
    other = Function("exp", (_tanh(name),))
    return put("residual:r1", plus(times(Const(2.0), _tanh(name, other)), _Y))


def test_tanh_is_replaced_in_first_and_step_at_any_depth_and_not_in_exact() -> None:
    program = programs.program(
        "M", (programs.residual("r1"),), exact=(_statement("tanh"),), first=(_statement("tanh"),),
        step=(_statement("tanh"),), configure=(put("coef:a", _tanh("tanh")),),
    )  # fmt: skip
    found = near_functions(program)
    assert found.first == found.step == (_statement("near_tanh"),)
    assert found.exact == program.exact and found.configure == program.configure


def _branch(name: str) -> Branch:
    condition = Compare("<", _tanh(name), _Y)
    choice = Choice(condition, ref("local:a"), _tanh(name))
    inner = Branch(ref("local:a"), choice, (put("local:b", _tanh(name)),), (), "", None)
    sides = (inner, put("local:c", _tanh(name))), (put("local:d", _tanh(name)),)
    return Branch(ref("residual:r1"), Choice(condition, _tanh(name), _Y), *sides, "", None)


def test_both_sides_of_a_choice_and_its_condition_are_replaced() -> None:
    program = programs.program("M", (programs.residual("r1"),), step=(_branch("tanh"),))
    assert near_functions(program).step == (_branch("near_tanh"),)
