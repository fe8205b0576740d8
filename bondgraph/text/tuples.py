"""Named tuples that are quick to define.

`typing.NamedTuple` compiles the annotation of every field, which cost the command `check` a
quarter of its time; nothing here reads annotations. `collections.namedtuple` compiles a `__new__`
for every class, which cost a small `compile` a twentieth; here classes of as many fields share
one, and differ in the names of its arguments.
"""

from __future__ import annotations

__all__ = ["NamedTuple"]

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NamedTuple
else:
    from _collections import _tuplegetter
    from functools import cache
    from types import FunctionType

    @cache
    def _constructor(count):
        """The code of `__new__` for so many fields."""
        listed = "".join([f"_{k}, " for k in range(count)])
        return eval(f"lambda _cls, {listed}: _new(_cls, ({listed}))").__code__

    def _named_new(fields, defaults):
        code = _constructor(len(fields)).replace(co_varnames=("_cls", *fields), co_name="__new__")
        return FunctionType(code, {"_new": tuple.__new__}, "__new__", defaults)

    @classmethod
    def _make(cls, values):
        """A new tuple of all values, in order."""
        made = tuple.__new__(cls, values)
        if len(made) != len(cls._fields):
            raise TypeError(f"Expected {len(cls._fields)} arguments, got {len(made)}")
        return made

    def _replace(self, /, **changed):
        """A new tuple with some values changed."""
        made = self._make(map(changed.pop, self._fields, self))
        if changed:
            raise ValueError(f"Got unexpected field names: {list(changed)!r}")
        return made

    def _asdict(self):
        """The values by the names of their fields."""
        return dict(zip(self._fields, self, strict=True))

    def _repr(self):
        listed = [f"{n}={v!r}" for n, v in zip(self._fields, self, strict=True)]
        return f"{type(self).__name__}({', '.join(listed)})"

    def _plain(self):
        """What copy and pickle call the class with."""
        return tuple(self)

    _COMMON = {
        "__doc__": None, "__slots__": (), "__repr__": _repr, "__getnewargs__": _plain,
        "_make": _make, "_replace": _replace, "_asdict": _asdict,
    }  # fmt: skip

    class _Meta(type):
        """Makes a plain named tuple of a class body with annotated fields."""

        def __new__(meta, name, bases, body):
            if not bases:
                return type.__new__(meta, name, bases, body)
            fields = tuple(body.pop("__annotations__", ()))
            defaults = {field: body.pop(field) for field in fields if field in body}
            if fields[len(fields) - len(defaults) :] != tuple(defaults):
                raise TypeError(f"{name}: a field without a default follows one that has one")
            getters = {field: _tuplegetter(i, None) for i, field in enumerate(fields)}
            new = _named_new(fields, tuple(defaults.values()) or None)
            named = {"_fields": fields, "__match_args__": fields, "_field_defaults": defaults}
            return type(name, (tuple,), {**_COMMON, **getters, **named, "__new__": new, **body})

    class NamedTuple(metaclass=_Meta):
        """The base of a class of named tuples: `class Label(NamedTuple): ...`."""
