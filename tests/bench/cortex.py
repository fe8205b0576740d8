"""The step of the robot on a Cortex-M4F: instructions in qemu, bytes of code and memory."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import bondgraph
from bondgraph.backends.templates import codegen, fill

ROOT = Path(__file__).parents[2]
BOARD = Path(__file__).parent / "cortex_m4"
STEPS = 10_000  # as in main.c
TOOLS = ("arm-none-eabi-gcc", "arm-none-eabi-nm", "qemu-system-arm")
_CORE = "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard".split()
_LINK = "-nostartfiles --specs=nano.specs --specs=nosys.specs -Wl,--gc-sections".split()
_BOARD = "-M mps2-an386 -icount shift=0 -nographic -monitor none -serial none".split()


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
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bondgraph.compile(ROOT / "models" / "khepera.bg").write(folder, targets=["c"])
        code = ["-DKHEPERA_FLOAT", "-DKHEPERA_NO_THRESHOLDS", f"-I{folder}"]
        flags = [*_CORE, "-O2", "-ffunction-sections", "-fdata-sections", *code]
        board = codegen() / "c" / "costs" / "board.c"
        files = [str(BOARD / "main.c"), str(board), str(folder / "khepera.c")]
        (folder / "link.ld").write_text(fill("c/qemu/link.ld.j2", {}), encoding="utf-8")
        script, image = ["-T", str(folder / "link.ld")], str(folder / "image.elf")
        link = [*_LINK, *script, "-lm", "-lc", "-lgcc"]
        gcc = ["arm-none-eabi-gcc", "-std=gnu99", *flags, *files, *link, "-o", image]
        subprocess.run(gcc, check=True, capture_output=True)
        host = ["-semihosting-config", "enable=on,target=native"]
        told = _run("qemu-system-arm", *_BOARD, *host, "-kernel", image)
        whole, empty, valid = (int(word) for word in told.split() if word.isdigit())
        assert valid == 1, "the filter has not settled"
        sizes = _sizes(image)
    text = sum(sizes.get(name, 0) for name in _CALLED)
    return OnBoard(
        (whole - empty) / STEPS,
        text,
        sizes["khepera_nominal_coefficients"],
        sizes["memory"],
    )


#: What a step is made of, where the compiler has not put it into `khepera_step`.
_CALLED = ("khepera_step near_tanh count_samples bring_up_to_date run_r1 run_r2 run_r3 run_r4"
           " run_r5 number.0 part.1").split()  # fmt: skip


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
