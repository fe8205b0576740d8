"""Enumerations whose members are quick to name: `Op.ADD` is asked for at every node.

A class of Python's `enum` takes a detour through its metaclass for every name up to Python 3.11,
ten times what an attribute takes.
"""

from __future__ import annotations

__all__ = ["Enum"]

TYPE_CHECKING = False
if TYPE_CHECKING:
    from enum import Enum
else:

    class _Meta(type):
        """Makes the values in a class body members of the class."""

        def __init__(cls, name, bases, body):
            super().__init__(name, bases, body)
            for key in body if bases else ():
                if not key.startswith("_"):
                    member = object.__new__(cls)
                    member.name, member.value = key, body[key]
                    setattr(cls, key, member)

        def __iter__(cls):
            return (x for x in vars(cls).values() if isinstance(x, cls))

    class Enum(metaclass=_Meta):
        """The base of an enumeration: `class Op(Enum): ADD = "add"`."""

        __slots__ = ("name", "value")

        def __repr__(self):
            return f"{type(self).__name__}.{self.name}"

        def __reduce__(self):
            return getattr, (type(self), self.name)
