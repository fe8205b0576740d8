"""`bondgraph dump`: what the compiler knows about a model at one of its stages."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from bondgraph import Compilation, compile

STAGES = (
    "syntax",
    "graph",
    "integral",
    "derivative",
    "causal",
    "equations",
    "reduced",
    "residuals",
    "signatures",
    "program",
)


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `dump`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument(
        "--stage",
        choices=STAGES,
        required=True,
        metavar="STAGE",
        help=f"{', '.join(STAGES)}; causal is integral and derivative",
    )
    parser.add_argument(
        "--latex", action="store_true", help="of the signatures: the matrix as a table of LaTeX"
    )


def run(args: Namespace) -> int:
    """Print one stage."""
    compilation = compile(args.model)
    if args.latex and args.stage != "signatures":
        print("--latex is for --stage signatures", file=sys.stderr)
        return 2
    print(compilation.signatures.to_latex() if args.latex else text_of(compilation, args.stage))
    return 0


def text_of(compilation: Compilation, stage: str) -> str:
    """A stage as text; raises `CompileError` where the model does not get that far."""
    from bondgraph.notation import dump_stages as dump

    match stage:
        case "syntax":
            return dump.dump_syntax(compilation.syntax)
        case "graph":
            return dump.dump_graph(compilation.graph)
        case "integral":
            return dump.dump_causal(compilation.integral)
        case "derivative":
            return dump.dump_causal(compilation.derivative)
        case "causal":
            return f"{text_of(compilation, 'integral')}\n\n{text_of(compilation, 'derivative')}"
        case "equations":
            return dump.dump_equations(compilation.equations)
        case "reduced":
            from bondgraph.notation.dump_reduced import dump_reduced

            return dump_reduced(compilation.reduced)
        case "residuals":
            return dump.dump_residuals(compilation.residuals.residual_set)
        case "signatures":
            return dump.dump_signatures(compilation.signatures)
        case _:
            from bondgraph.notation.dump_program import dump_program

            return dump_program(compilation.program)
