"""The step of the robot on a Cortex-M: instructions in qemu, bytes of code and memory."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import bondgraph
from bondgraph.backends.templates import codegen, fill
from bondgraph.backends.write import COSTS
from bondgraph.ir.artifact import Artifact
from tests.bench import linear_part
from tests.unit.backends.fixed_models import RANGES

ROOT = Path(__file__).parents[2]
ROBOT = ROOT / "models" / "khepera.bg"
BOARD = Path(__file__).parent / "cortex_m4"
STEPS = 10_000  # as in main.c
TOOLS = ("arm-none-eabi-gcc", "arm-none-eabi-nm", "qemu-system-arm")
_LINK = "-nostartfiles --specs=nano.specs --specs=nosys.specs -Wl,--gc-sections".split()
_BOARD = "-icount shift=0 -nographic -monitor none -serial none".split()


class Board(NamedTuple):
    """A machine of qemu, what gcc has to know of its core, and what the code computes with."""

    machine: str
    core: str
    defines: str


M4F = Board(
    "mps2-an386", "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard", "-DKHEPERA_FLOAT"
)
M3 = Board("mps2-an385", "-mcpu=cortex-m3 -mthumb", "-DFIXED")


class OnBoard(NamedTuple):
    """Instructions of a settled step, and bytes: of step with all that it calls, of the constant
    coefficients, of what is remembered of one machine."""

    instructions: float
    text: int
    coefficients: int
    memory: int


def missing() -> list[str]:
    """The tools that are not installed."""
    return [tool for tool in TOOLS if shutil.which(tool) is None]


def measured() -> OnBoard:
    """The five residuals of the robot in float, at -O2."""
    return _measured(bondgraph.compile(ROBOT), M4F, _CALLED)


def measured_fixed(cut: Callable[[str], str] = str) -> OnBoard:
    """The same in whole numbers, on a core without floating point; `cut` as in `instructions`."""
    c = bondgraph.compile(ROBOT, real="fixed", ranges=RANGES["khepera"])
    return _measured(c, M3, _CALLED_FIXED, cut)


def _measured(
    c: bondgraph.Compilation, board: Board, called: list[str], cut: Callable[[str], str] = str
) -> OnBoard:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        c.write(folder, targets=["c"])
        own = folder / "khepera.c"
        own.write_text(cut(own.read_text(encoding="utf-8")), encoding="utf-8")
        code = [board.defines, "-DKHEPERA_NO_THRESHOLDS", f"-I{folder}"]
        flags = [*board.core.split(), "-O2", "-ffunction-sections", "-fdata-sections", *code]
        start = codegen() / "c" / "costs" / "board.c"
        files = [str(BOARD / "main.c"), str(start), str(folder / "khepera.c")]
        (folder / "link.ld").write_text(fill("c/qemu/link.ld.j2", {}), encoding="utf-8")
        script, image = ["-T", str(folder / "link.ld")], str(folder / "image.elf")
        link = [*_LINK, *script, "-lm", "-lc", "-lgcc"]
        gcc = ["arm-none-eabi-gcc", "-std=gnu99", *flags, *files, *link, "-o", image]
        subprocess.run(gcc, check=True, capture_output=True)
        host = ["-semihosting-config", "enable=on,target=native"]
        machine = ["-M", board.machine, *_BOARD]
        told = _run("qemu-system-arm", *machine, *host, "-kernel", image)
        whole, empty, valid = (int(word) for word in told.split() if word.isdigit())
        assert valid == 1, "the filter has not settled"
        sizes = _sizes(image)
    text = sum(sizes.get(name, 0) for name in called)
    return OnBoard(
        (whole - empty) / STEPS,
        text,
        sizes["khepera_nominal_coefficients"],
        sizes["memory"],
    )


#: What a step is made of, where the compiler has not put it into `khepera_step`.
_CALLED = ("khepera_step near_tanh count_samples bring_up_to_date run_r1 run_r2 run_r3 run_r4"
           " run_r5 number.0 part.1").split()  # fmt: skip
_CALLED_FIXED = "khepera_step tanh_of tanh_of.constprop.0 cubics number.0 part.1".split()


def _run(*command: str) -> str:
    """What a command prints; qemu prints what its machine says among its errors."""
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60)
    return done.stdout + done.stderr


def _sizes(image: str) -> dict[str, int]:
    lines = [line.split() for line in _run("arm-none-eabi-nm", "-S", image).splitlines()]
    return {words[3]: int(words[1], 16) for words in lines if len(words) == 4}


def report() -> None:
    """One line."""
    if tools := missing():
        print(f"Cortex-M4F: not measured, {', '.join(tools)} not installed")
        return
    found = measured()
    print(
        f"Cortex-M4F, float, -O2: {found.instructions:.0f} instructions a step <= 350, "
        f"{found.text} bytes of code <= 2048, {found.coefficients} of coefficients in flash, "
        f"{found.memory} of RAM a robot <= 120"
    )
    found = measured_fixed()
    print(
        f"Cortex-M3, fixed point, -O2: {found.instructions:.0f} instructions a step <= 600, "
        f"{measured_fixed(linear_part.of_fixed).instructions:.0f} of its linear part <= 330, "
        f"{found.text} bytes of code, {found.coefficients} of coefficients in flash, "
        f"{found.memory} of RAM a robot"
    )
    for real, c in (
        ("numbers in floating point", bondgraph.compile(ROBOT, costs=True)),
        ("whole numbers", bondgraph.compile(
            ROBOT, real="fixed", ranges=RANGES["khepera"], costs=True)),
    ):  # fmt: skip
        files = {a.path: a.text for a in c.artifacts if isinstance(a, Artifact)}
        print(f"With all that is called, and diagnose (<= 120) while well, {real}:")
        rows = COSTS.findall(files["README.md"])[0].splitlines()
        print("\n".join(row for row in rows if row.startswith("|")))
