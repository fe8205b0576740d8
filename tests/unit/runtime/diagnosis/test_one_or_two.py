"""Which pairs can be, and when two faults are told in place of one."""

from __future__ import annotations

from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.two_at_once import OneOrTwo, one_or_two, pairs_that_can
from tests.unit.runtime.diagnosis.explanations import SEES, explained, pair_of


def _doubles(*alike: tuple[tuple[int, ...], ...]) -> DoubleFaults:
    return DoubleFaults((("R",), ("f",), ("k",)), alike, "")


def test_two_at_once_have_to_cover_what_has_fired_and_keep_their_signs() -> None:
    known = {"R": 1.0, "f": 1.0, "k": 1.0}
    good = pair_of("R", "f", 0.6, -0.5, -0.2)
    found = [good, pair_of("f", "k", 0.6, 1.5, 0.1)]
    assert pairs_that_can(found, known, SEES, ["r1", "r2"]) == [good]
    blind = {"r1": ("R", "k"), "r2": ("k",)}
    assert pairs_that_can([good], known, blind, ["r1", "r2"]) == []


def test_two_at_once_do_not_feed_where_nothing_is_stored() -> None:
    """The machine has -change of what is nominally zero."""
    known, sees = {"leak": 0.0, "k": 1.0}, {"r1": ("leak", "k")}
    pair, feeding = pair_of("leak", "k", 0.6, -0.5, -0.2), pair_of("leak", "k", 0.6, 0.5, -0.2)
    assert pairs_that_can([pair, feeding], known, sees, ["r1"], {"leak": 1}) == [pair]


def test_no_signal_more_than_doubles_beside_another_fault() -> None:
    """A sensor that tells true/(1 - change): 0.5 of it is twice as much, 0.9 ten times; a command
    of which all is lost, or that is turned."""
    sensor, command = (Hypothesis(n, "gain", "", 0.3, n == "U") for n in ("y", "U"))
    known, sees = {"y": None, "U": None, "k": 1.0}, {"r1": ("y", "U", "k")}
    of = pair_of("y", "k", 0.6, 0.5, 0.1)
    fault = of.hypotheses[1]

    def can(signal: Hypothesis, change: float) -> bool:
        two = of._replace(hypotheses=(signal, fault), changes=(change, 0.1))
        return pairs_that_can([two], known, sees, ["r1"]) == [two]

    assert [can(sensor, change) for change in (0.5, 0.9, -0.9)] == [True, False, True]
    assert [can(command, change) for change in (1.0, 2.0, -0.9)] == [True, False, True]
    # by a tenth more: laws are rough
    assert [can(command, change) for change in (1.1, -1.1, 1.11, -1.11)] == [True] * 2 + [False] * 2


def test_two_at_once_are_a_thousand_times_as_rare_as_one() -> None:
    pair, other = pair_of("R", "f", 0.6, -0.5, -0.2), pair_of("R", "k", 9.0, 0.1, 0.1)
    for evidence, left in ((pair.evidence - 6.8, []), (pair.evidence - 7.0, [pair])):
        alone = [explained("k", evidence)._replace(left=9.0)]
        said = one_or_two(alone, [pair, other], False, lambda: _doubles((), (), ()))
        assert said == OneOrTwo(False, left)


def test_beside_one_that_fits_are_two_that_look_like_no_single_one() -> None:
    pair = pair_of("R", "f", 0.6, -0.5, -0.2)
    told, mistaken = _doubles((), (), ()), _doubles((), (), ((0, 1),))
    # as probable as one in a thousand of two makes it: beyond that it is two, and from a fiftieth
    # of all on it may be
    for more, alone, perhaps in ((7.0, False, True), (6.8, True, True), (2.9, True, False)):
        single = [explained("k", pair.evidence - more)]
        said = one_or_two(single, [pair], True, lambda: told)
        assert said == OneOrTwo(alone, () if alone else [pair], perhaps)
        assert one_or_two(single, [pair], True, lambda: mistaken) == OneOrTwo()
    nothing = DoubleFaults((("R",), ("f",), ("k",)), (), "no trajectory")
    assert one_or_two([explained("k", 3.0)], [pair], True, lambda: nothing) == OneOrTwo()
