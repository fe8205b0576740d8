"""Offsets, and the parts of a system that have too many equations or too few."""

from __future__ import annotations

from bondgraph.exact.offsets import Redundancy, offsets, square_part


def test_offsets_of_the_pendulum() -> None:
    # Pryce (2001), example: x'' = -x T, y'' = -y T + g, x^2 + y^2 = l^2
    found = offsets([{0: 2, 2: 0}, {1: 2, 2: 0}, {0: 0, 1: 0}], 3)
    assert found.equations == [0, 0, 2]
    assert found.variables == [2, 2, 0]
    assert found.free == found.unmatched == []


def test_a_constraint_on_a_chain_of_rates_is_differentiated_to_its_end() -> None:
    """x' = y, y' = z, x is known: x'', x' and x say what z, y and x are (index 3)."""
    found = offsets([{0: 1, 1: 0}, {1: 1, 2: 0}, {0: 0}], 3)
    assert found.equations == [1, 0, 2]
    assert found.variables == [2, 1, 0]


def test_the_equations_that_say_no_derivative_are_not_differentiated() -> None:
    """x' = x + y and y = 0 are enough as they are: x' is to be found, and y."""
    found = offsets([{0: 1, 1: 0}, {1: 0}], 2)
    assert found.equations == [0, 0]
    assert found.variables == [1, 0]


def test_offsets_tell_what_is_free_and_what_is_too_much() -> None:
    assert offsets([{0: 0, 1: 1}], 2).free in ([0], [1])
    assert offsets([{0: 0}, {0: 1}], 1).unmatched == [1]


def test_what_is_free_or_too_much_does_not_count_for_the_others() -> None:
    """Two rates are all that is asked: a third is one too many, and z is in none."""
    found = offsets([{0: 2}, {1: 1}, {1: 3}], 3)
    assert (found.free, found.unmatched) == ([2], [2])
    assert found.equations == [0, 0, 0]
    assert found.variables == [2, 1, 0]


def test_a_matching_is_taken_apart_where_a_later_equation_needs_it() -> None:
    """Each takes the first variable it sees; the last finds one through all of those before."""
    found = offsets([{0: 0, 1: 0}, {1: 0, 2: 0}, {2: 0, 3: 0}, {0: 0}], 4)
    assert found.free == found.unmatched == []
    assert offsets([{0: 0, 1: 0}, {0: 0, 1: 0}, {0: 0, 1: 0}], 2).unmatched == [2]


def test_the_square_part() -> None:
    # 0 and 1 share two variables; 2 has a third that nothing else holds, and one to spare
    assert square_part([{0: 0, 1: 0}, {0: 0, 1: 0}, {1: 0, 2: 0, 3: 0}], 4) == [(0, 0), (1, 1)]
    assert square_part([{0: 0}, {0: 0}], 1) == [(0, 0), (1, -1)]


def test_freedom_spreads_through_every_equation_that_holds_it() -> None:
    """Of 0: x y, 1: y z, 2: z w none is without freedom, as w is anybody's; 3 alone is."""
    rows = [{0: 0, 1: 0}, {1: 0, 2: 0}, {2: 0, 3: 0}, {4: 0}]
    assert square_part(rows, 5) == [(3, 4)]
    assert square_part([*rows, {0: 0}], 5) == [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)]


def test_what_is_told_twice_rests_on_the_equations_between() -> None:
    """0: a = b, 1: b = c, 2: c = d. With a and c told 0 and 1 are enough; with b alone none is."""
    chain = Redundancy([[0, 1], [1, 2], [2, 3]], 4)
    assert chain.about([[0], [2]]) == [0, 1]
    assert chain.about([[0], [3]]) == [0, 1, 2]
    assert chain.about([[1]]) == []
    assert chain.about([[1], [1]]) == []  # the same twice: no equation of the plant
    assert chain.about([[1, 2], [0]]) == [0, 1]  # b + c and a


def test_an_answer_about_some_values_leaves_nothing_behind_for_the_next() -> None:
    chain = Redundancy([[0, 1], [1, 2], [2, 3]], 4)
    assert chain.about([[0], [2]]) == [0, 1]
    assert chain.about([[3]]) == []
    assert chain.about([[2], [3]]) == [2]
