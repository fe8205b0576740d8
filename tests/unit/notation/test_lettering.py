"""How the names of a model become letters with an index."""

from __future__ import annotations

import pytest

from bondgraph.notation.lettering import Spare, indexed, letters, split_name


@pytest.mark.parametrize(
    ("name", "base", "below"),
    [
        ("yaw_x", "yaw", "x"),  # three letters may have an index, four are a word
        ("load_x", "load_x", ""),
        ("load2_x", "load2_x", ""),
        ("m2_a", "m", "2,a"),
        ("omega_x", "ω", "x"),
        ("Omega2", "Ω", "2"),
        ("Re", "R", "e"),
        ("US", "U", "S"),
        ("up", "up", ""),
        ("on_2", "on", "2"),
        ("Usb", "U", "sb"),
        ("USB", "USB", ""),
        ("yaw", "yaw", ""),
        ("load", "load", ""),
        ("Load", "Load", ""),
        ("x[2]", "x", "2"),
        ("x1[2,3]", "x", "1,2,3"),
        ("Fx_a[2]", "F", "x,a,2"),
        ("a.b.Re", "R", "e"),
        ("2x", "2x", ""),
    ],
)
def test_short_names_are_a_letter_with_an_index_and_words_stay_words(
    name: str, base: str, below: str
) -> None:
    assert split_name(name) == (base, below)


def test_the_digits_of_an_array_are_small_in_a_path() -> None:
    assert indexed("m[12]") == "m₁₂"
    assert indexed("a[1,2]") == "a₁,₂"
    assert indexed("plain3") == "plain3"


def test_a_path_is_shown_only_as_far_as_it_tells_names_apart() -> None:
    found = letters(["a.el.R", "b.el.R", "b.rod.R", "C"])
    wheres = {name: letter.where for name, letter in found.items()}
    assert wheres == {"a.el.R": ("a",), "b.el.R": ("b", "el"), "b.rod.R": ("rod",), "C": ()}


def test_of_parts_that_tell_names_apart_the_innermost_is_shown() -> None:
    found = letters(["a.b.R", "c.d.R"])
    assert [letter.where for letter in found.values()] == [("b",), ("d",)]


def test_of_a_path_that_is_endless_the_inner_parts_are_tried() -> None:
    """What only its outermost part tells apart is shown as it is."""
    inner = [f"p{k}" for k in range(8)]
    within = letters([".".join(["m", *inner, "R"]), ".".join(["m", "q", *inner[1:], "R"])])
    assert [letter.where for letter in within.values()] == [("p0",), ("q",)]
    beyond = letters([".".join([head, *inner, "R"]) for head in ("m", "q")])
    assert [letter.where for letter in beyond.values()] == [("m", *inner), ("q", *inner)]


def test_a_name_for_a_part_is_used_once() -> None:
    """Whatever else is called so, however that is written."""
    spare = Spare(["a.x1", "x_2", "b.x[4]", "x1.b", "y5"])
    assert [spare.name(k) for k in (1, 2, 3, 5, 5)] == ["x3", "x5", "x6", "x7", "x8"]
