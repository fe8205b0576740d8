"""Parts of a plant: no larger than what a relation rests on, with all that it is told."""

from __future__ import annotations

from bondgraph.exact.plant_structure import PlantStructure
from bondgraph.ir.expr import symbols
from tests.unit.passes.relations import compiled


def test_a_relation_rests_on_no_more_than_says_too_much_about_what_it_is_told() -> None:
    # the ammeters, and what ties them together: neither the source nor the chain that they pump
    lines = ["model M { param R = 2", "  1:a { <- Se:U; -> R:R; -> Df:y; -> Df:z }"]
    lines += [f"  0:n{k} {{ -> C:c{k} = 1; -> R:r{k} = 2 }}" for k in range(8)]
    lines += [f"  n{k} -> 1:w{k} -> n{k + 1}\n  w{k} -> R:b{k} = 3" for k in range(7)]
    c = compiled("\n".join([*lines, "  Sf:pump = 2*a.f\n  pump -> n0\n  n7 -> De:x }"]))
    every = c._analysis[0].residuals
    twins = next(r for r in every if {"y", "z"} == set(map(str, symbols(r.expr))))
    cone = PlantStructure(c.graph).cone(twins.expr)
    assert not (cone.laws or cone.rates or cone.balances)
    assert {name for name, _, _ in cone.shown} == {"y", "z"}
    assert not set(c.signatures.signature(twins.name)) & {"U", "R"}


def test_a_fault_behind_what_a_relation_is_told_is_outside_its_cone() -> None:
    cells = [f"n{k - 1} -> 1:s{k} -> 0:n{k}\ns{k} {{ -> R:R{k} = p{k}; -> I:L{k} = 1 }}\n"
             f"n{k} {{ -> C:C{k} = 1; -> De:y{k} }}" for k in range(1, 5)]  # fmt: skip
    params = "; ".join(f"param p{k} = {k}" for k in range(1, 5))
    c = compiled(f"model M {{ {params}\nSe:U -> 0:n0\n" + "\n".join(cells) + "}")
    structure = PlantStructure(c.graph)
    for residual in c._analysis[0].residuals:
        cone = structure.reached(structure.cone(residual.expr))
        inside = {f for f, s in c.graph.fault_symbols().items() if s in cone}
        seen = c.signatures.signature(residual.name)
        assert set(seen) <= inside
        assert min(inside & {"p1", "p2", "p3", "p4"}) in seen


def test_a_part_has_every_signal_that_its_relation_is_told() -> None:
    # an input that only an integral holds belongs to no node: left out, it would be told as zero
    lines = ["model M { param R = 2; input u; let h = int(u)"]
    lines += ["  1:a { <- Se:E = h; -> R:R; -> Df:y }"]
    lines += [f"  0:n{k} {{ -> C:c{k} = 1; -> R:r{k} = 2 }}" for k in range(8)]
    lines += [f"  n{k} -> 1:w{k} -> n{k + 1}\n  w{k} -> R:b{k} = 3" for k in range(7)]
    c = compiled("\n".join([*lines, "  Sf:pump = 2*a.f\n  pump -> n0\n  n7 -> De:x }"]))
    structure = PlantStructure(c.graph)
    place, parts = structure.assembly.place, 0
    for residual in c._analysis[0].residuals:
        told = {s for s in symbols(residual.expr) if s in place}
        cone = structure.cone(residual.expr)
        assert told <= set(cone.place)
        parts += cone.count_of < structure.assembly.count_of
    assert parts
    assert {"u", "R", "y"} <= set(c.signatures.signature("r1"))
