"""FMUs for the tests: compiled once, opened by FMPy as any tool would open them."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import bondgraph

fmpy = pytest.importorskip("fmpy", reason="needs FMPy: pip install bondgraph-arr[fmu]")
simulation = pytest.importorskip("fmpy.simulation")

MODELS = Path(__file__).parents[2] / "models"
VERSIONS = ("2", "3")
RATE = 1000.0  # samples a second, that of compile
BANDWIDTH = 300.0  # rad/s: filters that settle within some forty samples


class Folder:
    """The FMUs of a model, by the name of its file or its text, unpacked."""

    def __init__(self, home: Path, model: str) -> None:
        named = {"text": model} if "\n" in model else {"path": MODELS / f"{model}.bg"}
        self.compilation = bondgraph.compile(**named, targets=["fmu"], bandwidth=BANDWIDTH)
        self.home = home
        self.paths = [Path(path) for path in self.compilation.write(home)]

    def path(self, kind: str, version: str) -> Path:
        """The archive of a kind (`monitor`, `machine`)."""
        (found,) = self.home.glob(f"fmi{version}/*_{kind}.fmu")
        return found

    def unpacked(self, kind: str, version: str) -> Path:
        """The folder of one, unpacked at the first call."""
        folder = self.home / f"{kind}{version}"
        if not folder.exists():
            with zipfile.ZipFile(self.path(kind, version)) as archive:
                archive.extractall(folder)
        return folder


class Instance:
    """One instance, whatever its version of FMI: values by name, and what it has logged."""

    def __init__(self, folder: Folder, kind: str, version: str) -> None:
        home = folder.unpacked(kind, version)
        self.version = version
        self.description = fmpy.read_model_description(str(home))
        self.variables = {v.name: v for v in self.description.modelVariables}
        self.said: list[str] = []
        self.fmu = simulation.instantiate_fmu(str(home), self.description, logger=self._log)

    def _log(self, _environment: object, *said: Any) -> None:
        self.said.append(said[-1].decode())

    def start(self, tolerance: float | None = None, **values: float) -> None:
        """Initialize with these values."""
        if self.version == "2":
            self.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
            self.fmu.enterInitializationMode()
        else:
            self.fmu.enterInitializationMode(tolerance=tolerance, startTime=0.0)
        self.set(**values)
        self.fmu.exitInitializationMode()

    def set(self, **values: float) -> None:
        """Set values by name."""
        for name, value in values.items():
            self._access("set", name)([self.variables[name].valueReference], [value])

    def get(self, *names: str) -> list[float]:
        """Values by name."""
        return [
            self._access("get", n)([self.variables[n].valueReference])[0] for n in names
        ]

    def _access(self, what: str, name: str) -> Callable[..., Any]:
        types = {"Real": "Float64", "Integer": "Int32"} if self.version == "3" else {}
        own = self.variables[name].type
        found: Callable[..., Any] = getattr(self.fmu, what + types.get(own, own))
        return found

    def step(self, time: float, step: float = 1.0 / RATE) -> None:
        """Go on from a time, in s."""
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=step)

    def state(self, name: str) -> Callable[..., Any]:
        """A function for states, by its name without `FMUState`: `get`, `set`, `serialize`."""
        ending = "FMUstate" if self.version == "2" else "FMUState"
        own = "deSerialize" if name == "deserialize" and self.version == "2" else name
        found: Callable[..., Any] = getattr(self.fmu, own + ending)
        return found

    def names(self, causality: str) -> list[str]:
        """The variables of one causality, in order."""
        return [v.name for v in self.description.modelVariables if v.causality == causality]

    def close(self) -> None:
        """Free it; the library stays loaded for the others."""
        free = getattr(self.fmu, f"fmi{self.version}FreeInstance")
        free(self.fmu.component)
