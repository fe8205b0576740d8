"""An FMU from what computes in it: its sources, its description, and the archive of all."""

from __future__ import annotations

import hashlib
import io
import platform
import sys
import textwrap
import zipfile
from collections.abc import Mapping

from bondgraph.backends.fmu.fmu_variables import Variable, units
from bondgraph.backends.listing import harmless
from bondgraph.backends.target import load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact, BinaryArtifact
from bondgraph.text.tuples import NamedTuple

#: The versions of FMI there are, and the relative tolerance of a machine that is asked for none.
VERSIONS, TOLERANCE = ("2", "3"), "1.0e-07"

#: By system: the folder of FMI 2.0 where it has one, the end of that of FMI 3.0, and of the file.
_SYSTEMS = {
    "linux": ("linux64", "linux", ".so"),
    "darwin": ("darwin64", "darwin", ".dylib"),
    "win32": ("win64", "windows", ".dll"),
}
_ARCHITECTURES = {"amd64": "x86_64", "arm64": "aarch64"}
_BEGINNING = (1980, 1, 1, 0, 0, 0)  # of the time that archives know: the same bytes on any day


class Core(NamedTuple):
    """What computes in an FMU, whatever the version of FMI.

    `kind` names its templates, `identifier` its file and functions; `holes` are those of its own
    templates, `files` further sources of which `compiled` are given to the compiler. `step` is
    the only communication step that it takes, in s ("" for any), `interval` the one to propose.
    """

    kind: str
    name: str
    identifier: str
    description: str
    variables: tuple[Variable, ...]
    holes: Mapping[str, object]
    files: tuple[Artifact, ...]
    compiled: tuple[str, ...]
    step: str
    interval: str


class Fmu(NamedTuple):
    """An FMU without its binary: `compiled` are those of the `sources` to be given to a compiler.

    `build` is buildDescription.xml, "" where the version of FMI has none.
    """

    identifier: str
    version: str
    sources: tuple[Artifact, ...]
    compiled: tuple[str, ...]
    description: str
    build: str


def fmu(core: Core, version: str) -> Fmu:
    """The sources and the description of an FMU, for one of the `VERSIONS` of FMI."""
    compiled = (f"{core.identifier}.c", *core.compiled)
    about = f"{core.identifier}.c: {harmless(core.description, load('c'))}"
    holes: dict[str, object] = {
        **core.holes,
        "kind": core.kind,
        "name": core.name,
        "identifier": core.identifier,
        "version": version,
        "description": core.description,
        "about": [f" * {line}" for line in textwrap.wrap(about, 97)],
        "variables": core.variables,
        "unknowns": [k for k, v in enumerate(core.variables) if v.role == "output"],
        "units": units(core.variables),
        "compiled": compiled,
        "tolerance": TOLERANCE,
        "step": core.step,
        "interval": core.interval,
    }
    token = _digest([*_texts(version, holes | {"token": ""}), *(a.text for a in core.files)])
    code, description, build = _texts(version, holes | {"token": token})
    sources = (Artifact(compiled[0], code), *core.files)
    return Fmu(core.identifier, version, sources, compiled, description, build)


def _texts(version: str, holes: dict[str, object]) -> tuple[str, str, str]:
    """The file of C, modelDescription.xml and buildDescription.xml."""
    description = fill(f"fmu/modelDescription{version}.xml.j2", holes, html=True)
    build = fill("fmu/buildDescription.xml.j2", holes, html=True) if version == "3" else ""
    return fill("fmu/fmu.c.j2", holes), description, build


def _digest(texts: list[str]) -> str:
    """What identifies these texts, in the form that a GUID has."""
    found = hashlib.sha256("\0".join(texts).encode("utf-8", "surrogatepass")).hexdigest()
    return "-".join((found[:8], found[8:12], found[12:16], found[16:20], found[20:32]))


def packed(found: Fmu, library: bytes) -> BinaryArtifact:
    """The archive of an FMU with the library of its sources, made on this machine for this machine.

    The same sources and library give the same bytes.
    """
    files = {
        "modelDescription.xml": found.description.encode(),
        **{f"sources/{a.path}": a.text.encode() for a in found.sources},
        _place(found): library,
    }
    if found.build:
        files["sources/buildDescription.xml"] = found.build.encode()
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, data in files.items():
            entry = zipfile.ZipInfo(path, _BEGINNING)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return BinaryArtifact(f"fmi{found.version}/{found.identifier}.fmu", memory.getvalue())


def _place(found: Fmu) -> str:
    """Where the library of this machine stands in the archive."""
    system, name, ending = _SYSTEMS.get(sys.platform, _SYSTEMS["linux"])
    machine = platform.machine().lower()
    architecture = _ARCHITECTURES.get(machine, machine)
    own = f"{architecture}-{name}"
    if found.version == "2" and (architecture == "x86_64" or name == "darwin"):
        own = system  # FMI 2.0 names no other
    return f"binaries/{own}/{found.identifier}{ending}"
