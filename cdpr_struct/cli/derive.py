"""`cdpr-struct derive`: regenerate the closed forms from the derivations, or check that they are current."""

from typing import Annotated

import typer

from cdpr_struct.cli.options import Json, Out
from cdpr_struct.cli.output import emit, result_json, write_files

NAME = "derive"


def run(
    check: Annotated[bool, typer.Option("--check", help="Change nothing; exit 1 and show a diff if stale.")] = False,
    out: Out = None,
    json: Json = False,
) -> int:
    """Regenerate Python and LaTeX from the sympy derivations."""
    import derivations

    report = derivations.run(check=check, output=None)
    formulas = [
        {"id": f.id, "thesis_equation": f.thesis_equation, "status": f.status, "note": f.note} for f in report.formulas
    ]
    result = {
        "formulas": formulas,
        "diff": report.diff,
        "value_errors": list(report.value_errors),
        "seconds": report.seconds,
    }

    def text() -> None:
        for f in formulas:
            print(f"{f['status']:<10} {f['thesis_equation']:<14} {f['id']}")
            if f["note"]:
                print(f"{'':<10} {f['note']}")
        print(f"{len(formulas)} formulas derived in {report.seconds:.1f} s")
        print("".join([report.diff, *(f"value drift: {e}\n" for e in report.value_errors)]), end="")

    emit(result, json, text)
    if out is not None:
        write_files(out, {"result.json": result_json(result)})
    return 1 if check and (report.diff or report.value_errors) else 0
