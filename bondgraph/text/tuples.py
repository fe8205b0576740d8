"""Named tuples that are quick to define.

`typing.NamedTuple` compiles the annotation of every field, which cost the command `check` a
quarter of its time; nothing here reads annotations.
"""

from __future__ import annotations

__all__ = ["NamedTuple"]

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NamedTuple
else:
    from collections import namedtuple

    _KEPT = ("__module__", "__qualname__")

    class _Meta(type):
        """Makes a plain named tuple of a class body with annotated fields."""

        def __new__(meta, name, bases, body):
            if not bases:
                return type.__new__(meta, name, bases, body)
            fields = body.pop("__annotations__", {})
            defaults = [body.pop(field) for field in fields if field in body]
            made = namedtuple(name, fields, defaults=defaults, module=body["__module__"])
            for key, value in body.items():
                if key not in _KEPT:
                    setattr(made, key, value)
            return made

    class NamedTuple(metaclass=_Meta):
        """The base of a class of named tuples: `class Label(NamedTuple): ...`."""
