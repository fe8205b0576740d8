"""What the mutants of a few lines are, and that no test file is asked in vain."""

from __future__ import annotations

import ast

import pytest

from tests.mutants.groups import GROUPS, ROOT, asked, modules
from tests.mutants.mutate import mutants
from tests.mutants.run import Answer, Reach, drawn, judged, rounds, share, within


def changes(text: str) -> list[str]:
    found = mutants("m.py", text.encode())
    for mutant in found:
        ast.parse(mutant.applied(text.encode()))
    return [m.change for m in found]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("if a < b: pass", ["a < b -> not a < b", "a < b -> a <= b"]),
        ("if a == b: pass", ["a == b -> a != b"]),
        ("x = a if p and q else b",
         ["p and q -> not (p and q)", "p and q -> p or q"]),
        ("x = -a + b", ["-a + b -> -a - b", "-a -> a"]),
        ("x = a[0]", ["a[0] -> a[-1]", "0 -> 1"]),
        ("x = min(a)", ["min(a) -> max(a)"]),
        ("while True: continue", ["True -> not True", "True -> False", "continue -> pass"]),
        ("def f(x): return x", ["return x -> return None"]),
        ("a.append(b)", ["a.append(b) -> pass"]),
        ("x = [y for y in z if not y]", ["not y -> y"]),
        ("x = 10, 1.0, 'a' + b, f'{a + b}'", ["1.0 -> 2.0"]),
        ("assert a < b", []),
        ("_FEW = 3", []),
        ("few = 3", ["3 -> 4"]),
        ("x = zip(a, b, strict=True)", []),
        ("raise ValueError(a + b)", []),
        ("def f(x: 'int' = 1) -> list[0]:\n    '''1 + 1'''\n    g(x)", ["1 -> 2"]),
        ("def __repr__(self): return a + b", []),
    ],
)  # fmt: skip
def test_what_is_changed(text: str, expected: list[str]) -> None:
    assert changes(text) == expected


def test_a_change_is_made_where_it_was_found_behind_letters_of_two_bytes() -> None:
    text = 'x = "é" + y if a < b else c\n'.encode()
    (mutant,) = [m for m in mutants("m.py", text) if m.change == "a < b -> a <= b"]
    assert mutant.applied(text).decode() == 'x = "é" + y if (a <= b) else c\n'


def test_like_changes_of_a_line_have_names_of_their_own() -> None:
    assert changes("x = f(1, 1)") == ["1 -> 2", "1 -> 2 #2"]


def test_functions_have_the_names_that_running_code_has() -> None:
    text = b"class A:\n    def f(self):\n        def g(): a + b\n        return [c + d for c in e]"

    class A:
        def f(self) -> str:
            def g() -> None: ...

            return g.__code__.co_qualname.split(".<locals>.", 1)[1]

    inner = {m.function for m in mutants("m.py", text) if "a + b" in m.change}
    outer = {m.function for m in mutants("m.py", text) if "c + d" in m.change}
    assert inner == {A().f()} and outer == {"A.f"}


@pytest.mark.parametrize("group", GROUPS)
def test_every_group_has_modules_with_mutants(group: str) -> None:
    assert sum(len(mutants(m, (ROOT / m).read_bytes())) for m in modules(group)) > 500


def test_no_module_is_in_two_groups() -> None:
    """Its mutants would be drawn, and counted, twice."""
    names = [name for group in GROUPS for name in modules(group)]
    assert len(names) == len(set(names))


def test_a_longer_draw_has_the_shorter_one_in_it() -> None:
    few, many = drawn(4, 1, ["causality", "oracle"]), drawn(8, 1, ["causality", "oracle"])
    assert len(few) == 4 and len(many) == 8 and set(few) < set(many)
    assert few != drawn(4, 2, ["causality", "oracle"])


def test_one_module_may_be_asked_about_alone() -> None:
    name = "bondgraph/passes/lowering/stages.py"
    found = drawn(10**6, 1, list(GROUPS), name)
    assert {m for _, m in found} == set(mutants(name, (ROOT / name).read_bytes()))
    assert {group for group, _ in found} == {"lowering"}
    assert drawn(5, 1, list(GROUPS), name) == found[:5]
    assert drawn(5, 1, ["oracle"], name) == []


def test_tests_that_reach_the_function_are_asked_those_of_its_name_and_room_first() -> None:
    (mutant,) = mutants("bondgraph/passes/elimination/chaining.py", b"def f(): x = a < b")
    here = frozenset({"bondgraph/passes/elimination/chaining.py:f"})
    named = Reach("tests/unit/passes/test_chaining.py", 9.0, here)
    near = Reach("tests/unit/passes/test_near.py", 5.0, here)
    fast, slow = Reach("tests/x/test_fast.py", 1.0, here), Reach("tests/x/test_slow.py", 99.0, here)
    other = Reach("tests/x/test_other.py", 1.0, frozenset())
    assert rounds(mutant, [slow, other, fast, near, named]) == [[named], [near], [slow, fast]]
    assert rounds(mutant, [slow, other]) == [[], [], [slow]]
    unreached = Reach("tests/unit/passes/test_near.py", 1.0, frozenset())
    assert rounds(mutant, [other, unreached]) == [[], [unreached], []]
    assert "tests/paper/test_paper.py" in asked()
    # the fastest that take no longer together, one of them in any case
    assert within(20.0, [slow, near, fast, named]) == [fast, near, named]
    assert within(8.0, [slow, near, fast, named]) == [fast, near]
    assert within(20.0, [slow]) == [slow] and within(20.0, []) == []


def test_the_share_of_its_own_tests_is_of_what_they_could_kill() -> None:
    """Wilson's interval of 8 of 10, as Agresti and Coull (1998) compute it: 0.490 to 0.943."""
    (mutant,) = mutants("m.py", b"def f(): x = a < b")
    outcomes = ["killed"] * 7 + ["timed out", "killed by others", "survived"] + ["equivalent"] * 5
    found = [Answer(mutant, "", outcome) for outcome in outcomes]
    assert share(found) == pytest.approx((0.8, 0.490, 0.943), abs=5e-4)


def test_every_equivalent_mutant_is_still_one() -> None:
    names = [name for group in GROUPS for name in modules(group)]
    every = {m.key for name in names for m in mutants(name, (ROOT / name).read_bytes())}
    assert set(judged()) <= every
    assert all(len(reason) > 10 for reason in judged().values())
