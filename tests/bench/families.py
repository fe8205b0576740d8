"""Models of any size for the benchmarks: ladders, chains that are measured, trees, grids."""

from __future__ import annotations


def cable(cells: int) -> str:
    """The robot's cable, 8 bonds a cell, measured at its end."""
    return f"""bg 1
import Cable from "khepera.bg"
model Ladder {{
    Se:Uin -> Cable:line(n = {cells}) -> 0:out
    out {{ -> C:Cs = line.C; -> De:Us }}
}}
"""


def chain(cells: int) -> str:
    """R and L in series, C across, in every cell, 5 bonds a cell; measured ten times in all."""
    lines = ["bg 1", "model Chain {", "    Se:U -> 0:n0"]
    step = max(1, cells // 10)
    for i in range(1, cells + 1):
        sensor = f"; -> De:y{i}" if i % step == 0 else ""
        lines.append(f"    n{i - 1} -> 1:s{i} -> 0:n{i}")
        lines.append(f"    s{i} {{ -> R:R{i} = 2 Ohm; -> I:L{i} = 1 mH }}")
        lines.append(f"    n{i} {{ -> C:C{i} = 1 uF{sensor} }}")
    return "\n".join([*lines, "}"]) + "\n"


def tree(motors: int) -> str:
    """A supply that branches over wires into DC motors, the speed of each measured."""
    lines = ["bg 1", "model Motor {", "    port supply : in electrical"]
    for name, value in (("R", "2 Ohm"), ("L", "1 mH"), ("k", "0.05 N.m/A"),
                        ("J", "1e-4 kg.m^2"), ("b", "1e-5 N.m.s/rad")):  # fmt: skip
        lines.append(f"    param {name} = {value}")
    lines.append("    1:armature { <- supply; -> R:R; -> I:L; -> GY:k -> rotor }")
    lines.append("    1:rotor { -> I:J; -> R:b; -> Df:w }")
    lines += ["}", "model Tree {", "    param Rw = 0.1 Ohm", "    Se:U -> 0:n1"]
    for i in range(2, 2 * motors):
        lines.append(f"    1:w{i} {{ <- n{i // 2}; -> R:r{i} = Rw; -> 0:n{i} }}")
        if i >= motors:
            lines.append(f"    n{i} -> Motor:m{i}")
    return "\n".join([*lines, "}"]) + "\n"


def bus(motors: int) -> str:
    """One supply with DC motors in parallel, the speed and the current of each measured."""
    lines = tree(0).split("model Tree {")[0].replace("-> I:L;", "-> I:L; -> Df:i;")
    joins = "".join(f"    n -> Motor:m{i}\n" for i in range(1, motors + 1))
    return lines + "model Bus {\n    Se:U -> 0:n\n" + joins + "}\n"


def grid(size: int) -> str:
    """A square of `size` nodes a side joined by resistors, all different, each with a leak.

    One corner is fed, the opposite one and the middle are measured.
    """
    params, junctions, branches = [], [], []
    for k in range(size * size):
        params.append(f"    param g{k} = {1000 + k} Ohm")
        measured = k in (size * size - 1, (size // 2) * size + size // 2)
        extra = ("; <- Se:U" if k == 0 else "") + (f"; -> De:y{k}" if measured else "")
        junctions.append(f"    0:n{k} {{ -> R:l{k} = g{k}{extra} }}")
        for other, inside in ((k + 1, (k + 1) % size), (k + size, k + size < size * size)):
            if inside:
                params.append(f"    param p{k}_{other} = {1 + (7 * k + other) % 5} Ohm")
                branches.append(f"    1:b{k}_{other} {{ <- n{k}; -> n{other} }}")
                branches.append(f"    b{k}_{other} -> R:r{k}_{other} = p{k}_{other}")
    return "\n".join(["bg 1", "model Grid {", *params, *junctions, *branches, "}"]) + "\n"
