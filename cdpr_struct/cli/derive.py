"""`cdpr-struct derive`: regenerate the closed forms from the derivations, or check that they are current."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer

from cdpr_struct.cli.output import Files, Output

NAME = "derive"
EXAMPLES = (
    "cdpr-struct derive --check",
    "cdpr-struct derive --check --out results/formulas",
)


def run(
    check: Annotated[bool, typer.Option("--check", help="Change nothing; exit 1 and show a diff if stale.")] = False,
    *,
    output: Output,
) -> int:
    """Regenerate Python and LaTeX from the sympy derivations."""
    from cdpr_struct import derivations

    with output.steps(derivations.STEPS) as progress:
        report = derivations.run(check=check, output=None, progress=progress)
    formulas = [
        {"id": f.id, "thesis_equation": f.thesis_equation, "status": f.status, "note": f.note} for f in report.formulas
    ]
    result = {
        "formulas": formulas,
        "diff": report.diff,
        "value_errors": list(report.value_errors),
        "seconds": report.seconds,
    }

    def files() -> Files:
        from cdpr_struct.reports.derive_page import derive_files

        return derive_files(result)

    output.deliver(result, lambda: _text(result), files)
    return 1 if check and (report.diff or report.value_errors) else 0


def _text(result: Mapping[str, Any]) -> str:
    lines = []
    for f in result["formulas"]:
        lines.append(f"{f['status']:<10} {f['thesis_equation']:<14} {f['id']}")
        lines += [f"{'':<10} {f['note']}"] if f["note"] else []
    lines.append(f"{len(result['formulas'])} formulas derived in {result['seconds']:.1f} s")
    drift = "".join([result["diff"], *(f"value drift: {e}\n" for e in result["value_errors"])])
    return "\n".join([*lines, drift]).rstrip("\n")
