"""A residual as a sum of total derivatives: what the filter of the generated code is made from."""

from __future__ import annotations

from bondgraph.ir.expr import Expr
from bondgraph.text.tuples import NamedTuple


class Term(NamedTuple):
    """`coefficient` * p**order of `atom`, with p = d/dt (order -1: its integral from the start).

    `atom` is a known signal, the number one, or a nonlinear expression of known signals;
    `coefficient` is made of parameters and numbers. `static` says that the atom holds no
    derivative, so that it can be computed from one sample and then filtered.
    """

    atom: Expr
    order: int
    coefficient: Expr
    static: bool


class Edge(NamedTuple):
    """polynomial of node `target` += `scale` * p**`shift` * polynomial of node `source`."""

    target: int
    source: int
    shift: int
    scale: Expr


class Leaf(NamedTuple):
    """An atom with the node whose polynomial in p multiplies it; `degree` is at most this."""

    atom: Expr
    node: int
    degree: int
    static: bool


class Tape(NamedTuple):
    """A residual too long to write out: how the polynomial of each atom is computed.

    Node 0 is the residual itself with polynomial 1; the edges lead from it to the leaves, every
    edge into a node before the first edge out of it.
    """

    edges: tuple[Edge, ...]
    leaves: tuple[Leaf, ...]
    nodes: int


class NormalForm(NamedTuple):
    """r = sum of terms, or, for a large residual, the tape that computes their coefficients.

    Integrals inside atoms start at zero: their declared initial values are terms of their own.
    Terms are sorted: by first appearance of the atom, then by order.
    """

    terms: tuple[Term, ...]
    tape: Tape | None = None

    @property
    def exact(self) -> bool:
        """Whether every atom is static: then the filtered residual is exact."""
        if self.tape is not None:
            return all(leaf.static for leaf in self.tape.leaves)
        return all(t.static for t in self.terms)
