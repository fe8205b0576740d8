"""Rewrite a syntax tree in ways that must not change what the compiler finds."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any
from zlib import crc32

from bondgraph.ir import syntax
from bondgraph.ir.syntax import Chain, File, Junction, Model, Node, Part

#: Names that the language gives a meaning to.
_FIXED = frozenset("e f q p e1 f1 e2 f2 q0 p0 pi".split())
_PASSIVE = frozenset({"R", "C", "I", "De", "Df"})
_ELEMENTS = _PASSIVE | frozenset("0 1 TF MTF GY MGY Se MSe Sf MSf".split())


def walk(value: Any, change: Callable[[Any], Any]) -> Any:
    """A tree with `change` applied to every noun, from the leaves up."""
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        if type(value).__module__ != syntax.__name__:
            return value
        new = value._replace(**{f: walk(getattr(value, f), change) for f in value._fields})
        return change(new)
    if isinstance(value, tuple):
        return tuple(walk(v, change) for v in value)
    return value


def reordered(file: File, seed: int) -> File:
    """Every block with its statements in another order, the models too."""
    draw = random.Random(seed)

    def change(item: Any) -> Any:
        if isinstance(item, Model | Junction):
            body = list(item.body)
            draw.shuffle(body)
            return item._replace(body=tuple(body))
        if isinstance(item, File):
            models = list(item.models)
            draw.shuffle(models)
            return item._replace(models=tuple(models))
        return item

    return walk(file, change)


def new_name(name: str) -> str:
    """Another name, whose place in the alphabet has nothing to do with the old one."""
    return name if name in _FIXED else f"n{crc32(name.encode()):08x}"


def renamed(file: File) -> File:
    """Every name of a model, node, port and value replaced."""

    def change(item: Any) -> Any:
        if isinstance(item, Part):
            return item._replace(name=new_name(item.name))
        if isinstance(item, syntax.Import):
            return item._replace(names=tuple(new_name(n) for n in item.names))
        if isinstance(item, Node) and item.type not in _ELEMENTS:
            return item._replace(type=new_name(item.type))
        if isinstance(item, Model | syntax.Port | syntax.Generic):
            return item._replace(name=new_name(item.name))
        if isinstance(item, syntax.For):
            return item._replace(variable=new_name(item.variable))
        return item

    return walk(file, change)


def reversed_arrows(file: File, wanted: Callable[[Any, Any], bool]) -> File:
    """Every arrow whose two neighbours `wanted` accepts, drawn the other way."""

    def change(item: Any) -> Any:
        if not isinstance(item, Chain):
            return item
        arrows = [
            a._replace(forward=not a.forward) if wanted(left, right) else a
            for a, left, right in zip(item.arrows, item.nodes, item.nodes[1:], strict=False)
        ]
        return item._replace(arrows=tuple(arrows))

    return walk(file, change)


def is_passive(node: Any) -> bool:
    """A passive one-port or a detector, declared where it stands."""
    return isinstance(node, Node) and node.type in _PASSIVE


def at_passive(left: Any, right: Any) -> bool:
    """Whether a bond ends at a passive one-port or a detector."""
    return is_passive(left) or is_passive(right)


def ports_named(file: File) -> File:
    """Every chain through a submodel cut into bonds that name the submodel's ports."""
    ports = {
        m.name: {s.direction: s.name for s in m.body if isinstance(s, syntax.Port)}
        for m in file.models
    }

    def cut(chain: Chain) -> list[Any]:
        owners = [ports.get(n.type) if isinstance(n, Node) else None for n in chain.nodes]
        if len(chain.nodes) < 2 or not any(owners):
            return [chain]
        out: list[Any] = []
        for node, own in zip(chain.nodes, owners, strict=True):
            if own:
                out.append(chain._replace(nodes=(node,), arrows=()))
        for k, arrow in enumerate(chain.arrows):
            ends = []
            for at, enters in ((k, not arrow.forward), (k + 1, arrow.forward)):
                node, own = chain.nodes[at], owners[at]
                if own:
                    port = Part(own["in" if enters else "out"], None, None, node.origin)
                    node = syntax.Ref((node.name, port), node.origin)
                ends.append(node)
            out.append(chain._replace(nodes=tuple(ends), arrows=(arrow,)))
        return out

    def change(item: Any) -> Any:
        if isinstance(item, Model):
            body = [p for s in item.body for p in (cut(s) if isinstance(s, Chain) else [s])]
            return item._replace(body=tuple(body))
        return item

    return walk(file, change)


def bond_reversed(file: File, number: int) -> tuple[File, int]:
    """The bond at a submodel's named port with this number drawn the other way; how many exist."""
    seen = [0]

    def wanted(left: Any, right: Any) -> bool:
        named = [n for n in (left, right) if isinstance(n, syntax.Ref) and len(n.parts) == 2]
        if not named:
            return False
        seen[0] += 1
        return seen[0] - 1 == number

    new = reversed_arrows(file, wanted)
    return new, seen[0]
