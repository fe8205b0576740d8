"""What a person works with in Python: relations as SymPy expressions, tables that print well."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Symbol
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Missing, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.text.renamed import by_new_name

if TYPE_CHECKING:
    from collections.abc import Callable

    from bondgraph.algebra.present import ClosedForm
    from bondgraph.notation.typeset import Letters


class Relation:
    """One analytical redundancy relation, in the user's own names.

    >>> import bondgraph
    >>> r = bondgraph.compile("models/dc_motor.bg").residuals["r1"]
    >>> r
    <r1: U - k*speed - R*current - L*D(current)>
    >>> r.expr
    -L*Derivative(current(t), t) - R*current(t) - k*speed(t) + U(t)
    >>> r.orders["current"], "J" in r.faults
    (1, False)
    """

    def __init__(
        self,
        graph: BondGraph,
        residual: Residual,
        matrix: SignatureMatrix,
        starts: Mapping[Symbol, Expr],
        spelled: Callable[[], Letters],
    ) -> None:
        self._graph = graph
        self._spelled = spelled  # how names are written in LaTeX, the same in all relations
        self._matrix = matrix
        self._starts = starts  # the graph's initial values, found once for all its relations
        self.residual = residual
        self.name = residual.name

    @cached_property
    def expr(self) -> Any:
        """The relation as a SymPy expression: signals are functions of t, parameters symbols.

        A parameter that is called `t` is the symbol `constant t`, not the time.
        """
        from bondgraph.algebra.present import tidy
        from bondgraph.algebra.symbolic import to_sympy

        root = tidy(self._graph.pool, *self._graph.pool.logged([self.residual.expr]))[0]
        return to_sympy(root, starts=self._starts)

    @cached_property
    def closed_form(self) -> ClosedForm:
        """The relation as text, its shared parts named and written once."""
        from bondgraph.algebra.present import closed_form

        return closed_form(self._graph, self.residual, self._starts)

    @property
    def text(self) -> str:
        """The closed form as lines of text."""
        return str(self.closed_form)

    @cached_property
    def latex(self) -> str:
        """The relation in LaTeX: derivatives as dots, of a path what keeps names apart, below."""
        from bondgraph.algebra.present import tidy
        from bondgraph.notation.latex import latex

        root = tidy(self._graph.pool, *self._graph.pool.logged([self.residual.expr]))[0]
        return latex(root, self._starts, self._spelled())

    @property
    def orders(self) -> dict[str, int]:
        """Highest derivative of each known signal; -1 where only its integral occurs."""
        return dict(self._matrix.orders[self._matrix.residuals.index(self.name)])

    @property
    def faults(self) -> tuple[str, ...]:
        """The faults that this relation reacts to."""
        return self._matrix.signature(self.name)

    def sensitivity(self, fault: str) -> Any:
        """How the relation changes with a parameter, or a constant error of a signal, in SymPy.

        Parameters are constant in time. KeyError for a name that is no fault candidate.

        >>> import bondgraph
        >>> bondgraph.compile("models/dc_motor.bg").residuals["r1"].sensitivity("L")
        -Derivative(current(t), t)
        """
        from bondgraph.algebra.symbolic import to_sympy

        pool = self._graph.pool
        zero = pool.symbol(ZERO_START, Kind.INITIAL).symbol
        starts = {**self._starts, zero: pool.zero}
        return to_sympy(self.sensitivity_node(fault), starts=starts)

    def sensitivity_node(self, fault: str) -> Expr:
        """The same as a node of the expression graph, for relations too long to be written out."""
        from bondgraph.algebra.sensitivity import sensitivity

        if fault not in self._graph.faults:
            raise KeyError(fault)
        wanted = self._graph.past(fault)
        pool, root = self._graph.pool, self.residual.expr
        slopes = sensitivity(pool, root, wanted, self._starts)
        return pool.logged([pool.add(*[(1, slopes[symbol]) for symbol in wanted])])[0]

    def effect(self, fault: str, signals: Mapping[str, Any], at: float = 0.0) -> float:
        """The relative sensitivity theta dr/dtheta: by how much the relation is off for 100 %.

        `signals` gives each known signal as a number or a SymPy expression of `t`
        (`bondgraph.algebra.symbolic.t`), parameters are nominal, theta is the parameter's nominal
        value or the signal's value at time `at`. In units of the relation. ValueError names
        signals that are missing and parameters without a value.

        >>> import bondgraph
        >>> r = bondgraph.compile("models/dc_motor.bg").residuals["r1"]
        >>> round(r.effect("R", {"U": 6, "current": 0.1, "speed": 300}), 3)
        -1.76
        """
        import sympy as sp

        from bondgraph.algebra.nominal import Nominal
        from bondgraph.algebra.symbolic import t, to_sympy

        nominal = Nominal(self._graph)
        known: dict[Any, Any] = {}
        expr = self.sensitivity(fault) * to_sympy(self._graph.fault_symbol(fault))
        for f in expr.atoms(sp.core.function.AppliedUndef):
            if f.func.__name__ in signals:
                known[f] = sp.sympify(signals[f.func.__name__]).subs(t, f.args[0])
        for value in self._graph.values:
            number = nominal.value(value.symbol)
            if number is not None:
                known[to_sympy(value.symbol)] = number
        result = expr.subs(known).doit().subs(t, at)
        missing = sorted(map(str, result.free_symbols | result.atoms(sp.Function)))
        if not result.is_number:
            raise ValueError(f"no value for {', '.join(missing)}")
        return float(result)

    def __repr__(self) -> str:
        return f"<{self.name}: {self.closed_form.text}>"

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self.latex}$"


class Signatures(SignatureMatrix):
    """The fault signature matrix of a model, as text, as HTML in a notebook, or in LaTeX."""

    def to_latex(self) -> str:
        r"""The matrix as a `tabular` of LaTeX, with a line between groups of equal signatures.

        >>> import bondgraph
        >>> lines = bondgraph.compile("models/dc_motor.bg").signatures.to_latex().splitlines()
        >>> print(lines[2], lines[4], sep="\n")
         & $r_{1}$ & $r_{2}$ & $M_b$ & $I_b$ \\
        $L$ & 1 & $\cdot$ & 1 & $\cdot$ \\
        """
        from bondgraph.notation.latex_table import latex_table

        return latex_table(self)


class Relations(Sequence[Relation]):
    """All relations of a model in stable order; by position or by name.

    `residual_set` is what the passes know of them.
    """

    if not TYPE_CHECKING:
        __getattr__ = by_new_name

    def __init__(self, residuals: ResidualSet, matrix: SignatureMatrix) -> None:
        graph = residuals.system.graph
        starts = graph.initial_values()
        self.residual_set = residuals
        self._all = tuple(
            Relation(graph, r, matrix, starts, lambda: self._spelled) for r in residuals.residuals
        )

    @cached_property
    def _spelled(self) -> Letters:
        """How the names of the model are written in LaTeX."""
        from bondgraph.notation.latex import lettered

        graph = self.residual_set.system.graph
        return lettered(graph.names)

    @overload
    def __getitem__(self, key: int | str) -> Relation: ...
    @overload
    def __getitem__(self, key: slice) -> tuple[Relation, ...]: ...
    def __getitem__(self, key: int | str | slice) -> Relation | tuple[Relation, ...]:
        """The relation at a position or of a name; raises IndexError or KeyError."""
        if isinstance(key, str):
            for relation in self._all:
                if relation.name == key:
                    return relation
            raise KeyError(key)
        return self._all[key]

    @property
    def missing(self) -> tuple[Missing, ...]:
        """The relations that the model has as well but that could not be had, and why."""
        return self.residual_set.missing

    def __len__(self) -> int:
        return len(self._all)

    def __iter__(self) -> Iterator[Relation]:
        return iter(self._all)

    def __repr__(self) -> str:
        return "\n".join(f"{r.name} = {r.text}" for r in self._all) or "no relation"

    def _repr_html_(self) -> str:
        rows = (f"<p>$${r.name} = {r.latex}$$</p>" for r in self._all)
        return "\n".join(rows)
