"""Compile bond graphs into analytical redundancy relations and the code that evaluates them."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from bondgraph.pipeline import Compilation, Options, compile
    from bondgraph.text.diagnostic import CompileError

__all__ = ["Compilation", "CompileError", "Options", "compile"]
__version__ = "0.1.0"


def __getattr__(name: str) -> object:
    """What is offered here, loaded when it is asked for: `bondgraph --version` needs none of it."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from bondgraph import pipeline

    return getattr(pipeline, name)
