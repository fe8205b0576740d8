"""Names of before: each gives what its new name gives, and warns."""

from __future__ import annotations

from operator import attrgetter
from warnings import warn

#: By class, what an attribute was called and what it is called now.
RENAMED = {
    "Compilation": {
        "best": "maximum_isolability",
        "diagnoses": "minimal_diagnoses",
        "facts": "diagnosis_model",
        "modes": "mode_signatures",
        "received": "program_with_readings",
        "runnables": "runnable_programs",
    },
    "Relations": {"residuals": "residual_set.residuals", "stage": "residual_set"},
}


def by_new_name(owner: object, name: str) -> object:
    """An attribute by its old name: the `__getattr__` of a class in the table, and of those below.

    Warns with a DeprecationWarning where the old name is used. For any other name it raises what
    would have been raised without it: the AttributeError of a property keeps its own words.
    """
    for kind in type(owner).__mro__:
        new = RENAMED.get(kind.__name__, {}).get(name)
        if new is not None:
            warn(f"{kind.__name__}.{name} is called {new} now", DeprecationWarning, stacklevel=2)
            return attrgetter(new)(owner)
    return object.__getattribute__(owner, name)
