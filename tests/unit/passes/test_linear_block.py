"""Large linear blocks against numpy: the values, the choice of pivots, and grids of resistors."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

import numpy as np
import pytest

from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.passes.elimination import chaining as chain
from bondgraph.passes.elimination import linear_block
from bondgraph.passes.elimination.linear_block import (
    LinearEquation,
    linear_equation,
    products,
    solve_block,
)
from bondgraph.text.diagnostic import CompileError
from tests.sampled import Sampled
from tests.unit.passes.relations import compiled


def floats(exprs: list[Expr], given: dict[str, float]) -> list[float]:
    """The values in double precision, operation by operation as emitted code computes them."""
    values: dict[Expr, float] = {}
    for node in topological(exprs):
        if node.op is Op.SYM:
            values[node] = given[node.symbol.name]
        elif node.op is Op.NUM:
            values[node] = float(node.number)
        elif node.op is Op.ADD:
            terms = zip(node.coefficients, node.args, strict=True)
            values[node] = sum(float(c) * values[a] for c, a in terms)
        else:
            assert node.op is Op.MUL
            factors = zip(node.args, node.exponents, strict=True)
            values[node] = math.prod(values[a] ** e for a, e in factors)
    return [values[e] for e in exprs]


class Sparse:
    """A random sparse system `A x = b` with every entry a symbol, and some equations too many."""

    def __init__(self, seed: int, size: int, extra: int) -> None:
        draw = random.Random(seed)
        self.pool = Pool()
        self.given: dict[str, float] = {}
        solution = np.array([draw.uniform(-2, 2) for _ in range(size)])
        self.matrix = np.zeros((size + extra, size))
        for r in range(size + extra):
            for c in {r % size, *draw.sample(range(size), 2)}:
                self.matrix[r, c] = draw.choice((-1, 1)) * 10.0 ** draw.uniform(-2, 2)
        self.variables = [self.pool.symbol(f"x{c}", Kind.FLOW) for c in range(size)]
        right = self.matrix @ solution
        self.lines = [self.line(r, right[r]) for r in range(size + extra)]
        self.solution = solution

    def line(self, r: int, right: float) -> LinearEquation:
        entries = {}
        for c in np.flatnonzero(self.matrix[r]):
            entries[self.variables[c]] = self.pool.symbol(f"a{r}_{c}", Kind.PARAM)
            self.given[f"a{r}_{c}"] = self.matrix[r, c]
        self.given[f"b{r}"] = right
        return LinearEquation(r, entries, self.pool.neg(self.pool.symbol(f"b{r}", Kind.SENSOR)))

    def size(self, coefficient: Expr) -> float:
        return floats([coefficient], self.given)[0]


@pytest.mark.parametrize("seed", range(8))
def test_values_are_those_of_the_matrix(seed: int) -> None:
    system = Sparse(seed, size=25, extra=3)
    block = solve_block(system.pool, system.lines, system.size)
    assert block is not None
    values = floats([s.value for s in block.solved], system.given)
    found = {s.variable: value for s, value in zip(block.solved, values, strict=True)}
    accuracy = 1e-15 * float(np.linalg.cond(system.matrix))
    assert np.allclose([found[v] for v in system.variables], system.solution, atol=accuracy * 100)
    assert len(block.left) == 3
    assert {n for n, _ in block.left} | {s.equation for s in block.solved} == set(range(28))


@pytest.mark.parametrize("seed", range(8))
def test_equations_left_over_hold_on_the_solution_and_nowhere_else(seed: int) -> None:
    system = Sparse(seed, size=12, extra=2)
    block = solve_block(system.pool, system.lines, system.size)
    assert block is not None
    for number, expr in block.left:
        assert abs(floats([expr], system.given)[0]) < 1e-9
        off = {**system.given, f"b{number}": system.given[f"b{number}"] + 1}
        assert abs(floats([expr], off)[0]) > 0.5


def test_small_coefficients_are_no_pivots() -> None:
    """Eliminating x by 1e-20 x + y = 1 would lose 1e-20 next to one: x = y = 1 in x + y = 2."""
    pool = Pool()
    tiny, a, b = (pool.symbol(n, Kind.PARAM) for n in ("tiny", "a", "b"))
    x, y = pool.symbol("x", Kind.FLOW), pool.symbol("y", Kind.FLOW)
    given = {"tiny": 1e-20, "a": 1.0, "b": 1.0}
    lines = [
        LinearEquation(0, {x: tiny, y: a}, pool.neg(a)),
        LinearEquation(1, {x: a, y: b}, pool.num(-2)),
    ]
    block = solve_block(pool, lines, lambda c: floats([c], given)[0])
    assert block is not None
    assert sorted(floats([s.value for s in block.solved], given)) == [1.0, 1.0]


def test_what_vanishes_for_all_parameters_is_not_divided_by() -> None:
    """a x + b y = u and 2 a x + 2 b y = v determine nothing."""
    pool = Pool()
    a, b = pool.symbol("a", Kind.PARAM), pool.symbol("b", Kind.PARAM)
    x, y = pool.symbol("x", Kind.FLOW), pool.symbol("y", Kind.FLOW)
    u, v = pool.symbol("u", Kind.SENSOR), pool.symbol("v", Kind.SENSOR)
    lines = [
        LinearEquation(0, {x: a, y: b}, u),
        LinearEquation(1, {x: pool.scale(2, a), y: pool.scale(2, b)}, v),
    ]
    assert solve_block(pool, lines, lambda c: floats([c], {"a": 3.0, "b": 7.0})[0]) is None


def test_no_linear_equation_in_a_product_or_under_a_signal() -> None:
    pool = Pool()
    x, y = pool.symbol("x", Kind.FLOW), pool.symbol("y", Kind.FLOW)
    u, a = pool.symbol("u", Kind.INPUT), pool.symbol("a", Kind.PARAM)
    for zero in (pool.mul(x, y), pool.mul(u, x), pool.fn("exp", x)):
        assert linear_equation(pool, 0, zero, [x, y], lambda e: e) is None
    line = linear_equation(pool, 7, pool.add((1, pool.mul(a, x)), (-3, u)), [x, y], lambda e: e)
    assert line == (7, {x: a}, pool.scale(-3, u))


@pytest.mark.parametrize("seed", range(4))
def test_half_of_a_symmetric_block_is_the_other_half(seed: int) -> None:
    """With an equation of its own for each variable, equal coefficients stay one node."""
    draw, pool, size = random.Random(seed), Pool(), 12
    x = [pool.symbol(f"x{k}", Kind.FLOW) for k in range(size)]
    given = {f"a{i}_{k}": draw.uniform(1, 2) for k in range(size) for i in range(k)}
    given |= {f"a{k}_{k}": draw.uniform(30, 40) for k in range(size)}
    lines = []
    for k in range(size + 1):
        row = {x[i]: f"a{min(i, k)}_{max(i, k)}" for i in range(size)}
        given |= dict.fromkeys(row.values() if k == size else (), 1.0)
        entries = {v: pool.symbol(name, Kind.PARAM) for v, name in row.items()}
        lines.append(LinearEquation(k, entries, pool.symbol("u", Kind.INPUT)))
    draw.shuffle(lines)
    count = []
    for own in (dict(enumerate(x)), {}):
        block = solve_block(pool, lines, lambda c: floats([c], given)[0], own)
        assert block is not None
        count.append(len(topological([expr for _, expr in block.left])))
    assert count[0] < 0.75 * count[1]


def grid(size: int) -> tuple[str, np.ndarray]:
    """A grid of resistors, with the nodal matrix of Kirchhoff's law: conductances all differ.

    The source drives the first corner, the voltage is measured in the opposite one and halfway.
    """
    sensors = (size * size - 1, (size // 2) * size + size // 2)
    nodal = np.zeros((size * size, size * size))
    params, junctions, branches = [], [], []
    for k in range(size * size):
        leak = 1000 + 3 * k
        params.append(f"param g{k} = {leak}")
        sensor = f"; -> De:y{k}" if k in sensors else ""
        source = "; <- Se:u" if k == 0 else ""
        junctions.append(f"0:n{k} {{ -> R:l{k} = g{k}{sensor}{source} }}")
        nodal[k, k] += 1 / leak
        for other, inside in ((k + 1, (k + 1) % size), (k + size, k + size < size * size)):
            if inside:
                ohm = 1 + (7 * k + 3 * other) % 11
                params.append(f"param p{k}_{other} = {ohm}")
                branches.append(f"1:b{k}_{other} {{ <- n{k}; -> R:r{k}_{other} = p{k}_{other};"
                                f" -> n{other} }}")  # fmt: skip
                nodal[[k, other], [k, other]] += 1 / ohm
                nodal[[k, other], [other, k]] -= 1 / ohm
    return "model Grid {\n" + "\n".join([*params, *junctions, *branches]) + "\n}", nodal


def test_grid_of_resistors_is_nodal_analysis() -> None:
    """Each residual, as emitted code computes it, is zero at the voltages of the nodal matrix."""
    size = 7
    text, nodal = grid(size)
    c = compiled(text)
    rest = nodal[1:, 1:]
    voltages = np.concatenate([[5.0], np.linalg.solve(rest, -nodal[1:, 0] * 5.0)])
    given = {v.name: float(v.value.number) for v in c.graph.values if v.value is not None}
    given |= {"u": 5.0, **{f"y{k}": voltages[k] for k in (24, 48)}}
    relations = [r.residual.expr for r in c.residuals]
    assert len(relations) == 2
    for relation in relations:
        held = {s.symbol.name for s in symbols(relation)}
        assert held >= {"u", "g30", "p0_1"}
        assert sum(f"g{k}" in held for k in (24, 48)) == 1  # the balance at one sensor: its leak
        terms = [abs(x) for x in floats(list(relation.args), given)]
        assert abs(floats([relation], given)[0]) < 1e-12 * sum(terms)
        for name in ("p0_1", "g30", "y48", "y24", "u"):
            wrong = floats([relation], {**given, name: given[name] * 1.1})[0]
            alone = name.startswith("y") and name not in {x.symbol.name for x in symbols(relation)}
            assert alone or abs(wrong) > 1e-9 * sum(terms)


def test_a_grid_with_a_bent_resistor_is_no_linear_block_and_has_the_same_relations() -> None:
    """The voltages where Kirchhoff's law holds, found by Newton's method, leave residuals zero."""
    size = 3
    text, nodal = grid(size)
    bent = text.replace("r0_1 = p0_1", "r0_1 { f = (e + e^3)/p0_1 }")
    assert bent != text
    ohm = 1 + 3 % 11
    voltages = np.full(size * size, 5.0)
    for _ in range(20):
        drop = voltages[0] - voltages[1]
        surplus = nodal @ voltages
        surplus[1] -= drop**3 / ohm  # what the bent one carries beyond its share in `nodal`
        slope = nodal.copy()
        slope[1, 1] += 3 * drop**2 / ohm
        voltages[1:] -= np.linalg.solve(slope[1:, 1:], surplus[1:])
    assert drop > 0.05 and np.abs(surplus[1:]).max() < 1e-15
    compilation = compiled(bent)
    assert len(compilation.residuals) == 2
    machine = Sampled(compilation.program)
    healthy = {"u": 5.0, "y4": voltages[4], "y8": voltages[8]}
    calm = machine.exact({name: {0: value} for name, value in healthy.items()})
    for name in ("y4", "y8"):
        faulty = machine.exact({n: {0: v * (1 + 0.01 * (n == name))} for n, v in healthy.items()})
        told = [r.name for r in compilation.program.residuals if name in r.faults]
        assert told
        assert all(abs(faulty[r]) > 1e5 * abs(calm[r]) for r in told)


def test_program_of_a_grid_is_nodal_analysis() -> None:
    """What step computes is zero at the voltages of the nodal matrix, and moves with a fault."""
    size = 7
    text, nodal = grid(size)
    voltages = np.concatenate([[5.0], np.linalg.solve(nodal[1:, 1:], -nodal[1:, 0] * 5.0)])
    program = compiled(text).program
    machine = Sampled(program)
    healthy = {"u": 5.0, **{f"y{k}": voltages[k] for k in (24, 48)}}
    for _ in range(2000):
        calm = machine.step(healthy).residuals
    assert len(calm) == 2
    for name in ("y24", "y48"):
        moved = Sampled(program)
        for _ in range(2000):
            faulty = moved.step({**healthy, name: healthy[name] * 1.01}).residuals
        told = [r.name for r in program.residuals if name in r.faults]
        assert told
        assert all(abs(faulty[r]) > 1e9 * abs(calm[r]) for r in told)


@pytest.mark.parametrize("size", [4, 6])
def test_products_are_counted_before_they_are_formed(
    size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A count on the pattern is that of the elimination, but for the choice among equal pivots."""
    formed = [0]
    take = linear_block._Elimination.take

    def counted(self: linear_block._Elimination, at: int, variable: Expr) -> None:
        formed[0] += (len(self.holders[variable]) - 1) * (len(self.rows[at].entries) - 1)
        take(self, at, variable)

    lines: list[Sequence[LinearEquation]] = []
    monkeypatch.setattr(linear_block._Elimination, "take", counted)
    monkeypatch.setattr(
        chain, "products", lambda found, most: lines.append(found) or products(found, most)
    )
    compiled(grid(size)[0]).reduced  # noqa: B018
    (block,) = lines
    assert 0.7 < products(block, 10**6) / formed[0] < 1.3
    assert products(block, 20) in range(21, 21 + 4 * size * size)


def test_a_loop_too_large_is_refused_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(chain, "LARGEST", 50)
    c = compiled(grid(7)[0])
    with pytest.raises(CompileError) as caught:
        c.reduced  # noqa: B018
    found = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert [d.code for d in found] == ["loop-too-large"]
    # 49 + 84 resistors, but those to ground whose voltage is given or measured
    assert "`l1`, `l2`, `l3` and 127 more" in found[0].message
