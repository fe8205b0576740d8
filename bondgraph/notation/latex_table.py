"""A fault signature matrix as a table of LaTeX, faults with equal signatures together."""

from __future__ import annotations

from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.notation.latex import lettered


def latex_table(matrix: SignatureMatrix) -> str:
    r"""A `tabular`: a row a fault, a column a residual, M_b detectable and I_b isolable.

    It needs no package. A line stands between groups of faults that have one signature.

    >>> own = SignatureMatrix(("r1",), ("el.R", "C"), ((True,), (False,)), ({},))
    >>> print(latex_table(own))
    \begin{tabular}{lccc}
    \hline
     & $r_{1}$ & $M_b$ & $I_b$ \\
    \hline
    $R$ & 1 & 1 & 1 \\
    \hline
    $C$ & $\cdot$ & $\cdot$ & $\cdot$ \\
    \hline
    \end{tabular}
    """
    spelled = lettered([*matrix.faults, *matrix.residuals])
    blocks = [*matrix.groups, *([matrix.undetectable] if matrix.undetectable else [])]

    def row(head: str, cells: list[str]) -> str:
        return f"{head} & {' & '.join(cells)} \\\\"

    heads = [f"${spelled(r, 0).text}$" for r in matrix.residuals]
    lines = [
        f"\\begin{{tabular}}{{l{'c' * (len(heads) + 2)}}}",
        "\\hline",
        row("", [*heads, "$M_b$", "$I_b$"]),
    ]
    for block in blocks:
        lines.append("\\hline")
        for fault in block:
            hits = matrix.row(fault)
            own = [*hits, any(hits), any(hits) and len(block) == 1]
            cells = ["1" if hit else "$\\cdot$" for hit in own]
            lines.append(row(f"${spelled(fault, 0).text}$", cells))
    return "\n".join([*lines, "\\hline", "\\end{tabular}"])
