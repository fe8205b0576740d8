"""The code in the build systems that it travels to.

Zephyr, ESP-IDF, Arduino and ROS 2 are not in Debian. So manifests are held against the rules of
their makers, and all sources are compiled by what `build_systems/` has: as much of each build
system as the generated files ask for. Kconfig and package.xml are read by kconfiglib and
catkin_pkg. The manifests of a motor were read once by PlatformIO 6 and by the component manager of
ESP-IDF as well, which are too large to install with every test.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

import kconfiglib
import pytest
import yaml
from catkin_pkg.package import parse_package

import bondgraph
from bondgraph.backends.emit import EXTRAS
from tests.unit.backends.compilers import run

_MODELS = Path(__file__).parents[2] / "models"
_HERE = Path(__file__).parent / "build_systems"
_ARM = ("arm-none-eabi-gcc", "-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard")
_RISCV = ("riscv64-unknown-elf-gcc", "-march=rv32imac -mabi=ilp32 --specs=picolibc.specs")

#: Semantic version, as PlatformIO, Arduino and ESP-IDF want it.
_VERSION = re.compile(r"\d+\.\d+\.\d+")


@pytest.fixture(scope="module", params=["khepera_encoders", "unset"])
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A robot with counts, and a machine whose parameter is yours to set."""
    found = tmp_path_factory.mktemp("code")
    if request.param == "unset":
        text = "bg 1\nmodel One { param R : Ohm\n 1:j { <- Se:U; -> R:R; -> Df:i } }\n"
        compilation = bondgraph.compile(text=text, targets=("c",))
    else:
        compilation = bondgraph.compile(_MODELS / f"{request.param}.bg", targets=("c",))
    compilation.write(found, extras=EXTRAS[2:])  # no golden vectors, which take long
    return found


def _stem(folder: Path) -> str:
    return next(folder.glob("*.h")).stem


def _needs(*tools: str) -> None:
    for tool in tools:
        if shutil.which(tool) is None:
            pytest.skip(f"{tool} is not installed")


def _built(source: Path, folder: Path, *options: str, cross: tuple[str, str] | None = None) -> Path:
    """A project configured and built by cmake, for a bare machine where a compiler is given."""
    if cross is not None:
        compiler, flags = cross
        options = (*options, "-DCMAKE_SYSTEM_NAME=Generic", f"-DCMAKE_C_COMPILER={compiler}",
                   f"-DCMAKE_C_FLAGS={flags}",
                   "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY")  # fmt: skip
    run("cmake", "-S", source, "-B", folder, *options)
    run("cmake", "--build", folder)
    return folder


def test_pkg_config_says_how_to_use_what_is_installed(folder: Path, tmp_path: Path) -> None:
    _needs("cmake", "cc", "pkg-config")
    stem = _stem(folder)
    prefix = tmp_path / "there"
    options = f"-DCMAKE_INSTALL_PREFIX={prefix}", f"-D{stem.upper()}_FLOAT=ON"
    run("cmake", "--install", _built(folder, tmp_path / "build", *options))
    (found,) = prefix.rglob("*.pc")
    assert f"-D{stem.upper()}_FLOAT" in found.read_text()
    flags = run("env", f"PKG_CONFIG_PATH={found.parent}", "pkg-config", "--cflags", "--libs", stem)
    program = tmp_path / "program"
    run("cc", folder / "example" / "example.c", "-o", program, *flags.split())
    assert "samples" in run(program)  # it compares the size of a number with that of the library


def test_as_a_part_of_another_project_nothing_is_installed(folder: Path, tmp_path: Path) -> None:
    _needs("cmake", "cc")
    (tmp_path / "CMakeLists.txt").write_text(
        f"cmake_minimum_required(VERSION 3.13)\nproject(other C)\nadd_subdirectory({folder} code)\n"
    )
    run("cmake", "--install", _built(tmp_path, tmp_path / "build"), "--prefix", tmp_path / "there")
    assert not (tmp_path / "there").exists()


def test_a_module_of_zephyr(folder: Path, tmp_path: Path) -> None:
    """`name`, and below `build` a folder with CMakeLists.txt and a file of Kconfig."""
    _needs("cmake", _ARM[0], "arm-none-eabi-nm")
    stem = _stem(folder)
    module = yaml.safe_load((folder / "zephyr" / "module.yml").read_text())
    assert set(module) <= {"name", "build", "tests", "samples", "boards", "blobs", "security"}
    assert re.fullmatch(r"[A-Za-z0-9_-]+", module["name"])
    assert (folder / module["build"]["cmake"] / "CMakeLists.txt").is_file()
    options = kconfiglib.Kconfig(folder / module["build"]["kconfig"]).syms
    options[stem.upper()].set_value("y")
    assert options[f"{stem.upper()}_FLOAT"].str_value == "y"
    asked = [f"-DMODULE={folder / 'zephyr'}"]
    for value in ("y", "n"):
        chosen = [f"-DCONFIG_{stem.upper()}{end}={value}" for end in ("", "_FLOAT")]
        built = _built(_HERE / "zephyr", tmp_path / value, *asked, *chosen, cross=_ARM)
        found = list(built.rglob(f"{stem}.c.obj"))
        assert len(found) == (value == "y")
    names = run("arm-none-eabi-nm", *(tmp_path / "y").rglob(f"{stem}.c.obj"))
    assert f"{stem}_step" in names and "__aeabi_dadd" not in names  # no double


def test_a_component_of_esp_idf(folder: Path, tmp_path: Path) -> None:
    _needs("cmake", _RISCV[0])
    stem = _stem(folder)
    manifest = yaml.safe_load((folder / "idf_component.yml").read_text())
    assert _VERSION.fullmatch(manifest["version"])
    assert set(manifest) <= {"version", "description", "dependencies", "targets", "url", "license"}
    options = kconfiglib.Kconfig(folder / "Kconfig").syms
    assert options[f"{stem.upper()}_FLOAT"].str_value == "y"
    chosen = f"-DCOMPONENT={folder}", f"-DCONFIG_{stem.upper()}_FLOAT=y"
    built = _built(_HERE / "espidf", tmp_path, *chosen, cross=_RISCV)
    names = run("riscv64-unknown-elf-nm", built / "component" / "libcomponent.a")
    assert f"T {stem}_step" in names and "__adddf3" not in names


def test_a_library_of_arduino_and_of_platformio(folder: Path, tmp_path: Path) -> None:
    _needs("g++")
    stem = _stem(folder)
    text = (folder / "library.properties").read_text()
    found = dict(line.split("=", 1) for line in text.splitlines())
    assert list(found)[:9] == [
        "name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url",
        "architectures",
    ]  # fmt: skip
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9 _.-]{0,62}", found["name"])
    assert _VERSION.fullmatch(found["version"]) and found["category"] == "Data Processing"
    manifest = json.loads((folder / "library.json").read_text())
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", manifest["name"]) and len(manifest["name"]) <= 50
    assert _VERSION.fullmatch(manifest["version"]) and len(manifest["description"]) <= 255
    sources = [rule[2:-1] for rule in manifest["build"]["srcFilter"]]
    assert sources == [f"{stem}.c"] and (folder / manifest["headers"]).is_file()
    (sketch,) = (folder / "examples").rglob("*.ino")
    assert sketch.stem == sketch.parent.name  # or Arduino does not open it
    (tmp_path / "all.cpp").write_text(
        f'#include <Arduino.h>\n#include "{sketch}"\n'
        "int main() { setup(); for (int k = 0; k < 100; ++k) loop(); }\n"
    )
    flags = ("-Wall", "-Wextra", "-Werror", f"-I{_HERE / 'arduino'}", f"-I{folder}")
    run("gcc", "-c", folder / f"{stem}.c", "-o", tmp_path / "code.o")
    run("g++", *flags, tmp_path / "all.cpp", tmp_path / "code.o", "-lm", "-o", tmp_path / "all")
    run(tmp_path / "all")


def test_a_node_of_ros_2(folder: Path, tmp_path: Path) -> None:
    """It gives what the code gives: a machine at rest is well, one that cannot be is not."""
    _needs("cmake", "g++")
    stem = _stem(folder)
    package = parse_package(folder / "ros2", warnings=(warnings := []))
    assert warnings == [] and package.name == f"{stem}_diagnosis" and package.package_format == 3
    assert {d.name for d in package.build_depends} == {"rclcpp", "std_msgs", "diagnostic_msgs"}
    options = (f"-DCMAKE_PREFIX_PATH={_HERE / 'ros2' / 'cmake'}",
               "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")  # fmt: skip
    node = _built(folder / "ros2", tmp_path, *options) / "node"
    header = (folder / f"{stem}.h").read_text()
    (row,) = re.findall(r"_ROW = (\d+)", header)
    signals = len(list(_members(header, f"{stem}_samples")))
    script = f"for k in $(seq {4 * int(row)}); do echo {'{}'}; done | {node}"
    samples = ["0"] * signals, [str(7 * k * k) for k in range(signals)]
    rest, wrong = (run("sh", "-c", script.format(" ".join(s))).splitlines() for s in samples)
    assert len(rest) == len(wrong) == 4
    assert all(line.startswith(f"0 {stem}: ") for line in rest)
    assert "r1=blind" in rest[0] and re.search(r"=-?0\.0+", rest[-1])
    assert wrong[-1].startswith(f"2 {stem}: ") and re.search(r": (perhaps|one of)", wrong[-1])
    assert "error: a sample has" in run("sh", "-c", f"echo 1 2 3 4 5 6 7 8 9 9 9 9 9 | {node}")


def _members(header: str, struct: str) -> Iterator[str]:
    body = header.split(f"typedef struct {struct} {{")[1].split(f"}} {struct};")[0]
    return iter(re.findall(r"^    \w+ \w+;", body, re.MULTILINE))
