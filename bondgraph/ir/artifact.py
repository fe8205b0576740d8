"""A file to be written: where, and what."""

from __future__ import annotations

from bondgraph.text.tuples import NamedTuple


class Artifact(NamedTuple):
    """Path below the output folder, and text."""

    path: str
    text: str


class BinaryArtifact(NamedTuple):
    """Path below the output folder, and bytes: what is no text."""

    path: str
    data: bytes
