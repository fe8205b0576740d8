"""Compile bond graphs into analytical redundancy relations and the code that evaluates them."""

from bondgraph.pipeline import Compilation, Options, compile
from bondgraph.text.diagnostic import CompileError

__all__ = ["Compilation", "CompileError", "Options", "compile"]
