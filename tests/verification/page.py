"""docs/verification.md: what the program was checked against, and how well it did."""

from tests.verification.figures import DOCS
from tests.verification.row import Row
from tests.verification.rows import SUBJECTS

PAGE = DOCS / "verification.md"

_HEAD = """# Verification and validation

Written by `python -m tests.verification`; do not edit. Each row names a case, the reference it is compared with, the
number that is compared (metric), the limit that this number must keep (acceptance), and the value measured (result).
Results are read from the page in the last column, or were measured on the date given there. "Not measured" means that
there is no figure yet. A result that does not meet its acceptance stays in the table.

The last table gives one command that repeats each row. **The test** must fail if the acceptance is not met; it checks
a case that is small enough for the everyday suite, or runs with `-m slow`. Rows that take hours (blind campaigns,
mutants, other versions of Python) have a test of a small sample, of the tools or of the page instead. **Its twin**
feeds the same check a deliberate error, which the check must notice. In a blind campaign the program diagnoses
simulated measurements with a hidden error; campaigns are made and sealed first, and scored afterwards
(`tests/blind/README.md`). DSM is the dynamic stiffness matrix.
"""
_ROWS = "| row | case | reference | metric | acceptance | result | from |\n|---|---|---|---|---|---|---|\n"
_REPEAT = "| row | command | the test that must fail | its twin |\n|---|---|---|---|\n"


def page() -> str:
    """The whole page."""
    parts, number = [_HEAD], 0
    told: list[str] = []
    for subject, rows in SUBJECTS.items():
        lines = []
        for row in rows:
            number += 1
            lines.append(_row(number, row))
            told.append(_repeat(number, row))
        parts.append(f"## {subject}\n\n{_ROWS}" + "\n".join(lines) + "\n")
    parts.append(f"## To repeat a row\n\n{_REPEAT}" + "\n".join(told) + "\n")
    return "\n".join(parts)


def _row(number: int, row: Row) -> str:
    source = f"[{row.source}]({row.source})" if row.source.endswith(".md") else row.source
    cells = (str(number), row.case, row.reference, row.metric, row.acceptance, row.result(), source)
    return f"| {' | '.join(cells)} |"


def _repeat(number: int, row: Row) -> str:
    twin = "-" if row.twin is None else f"`{row.twin}`"
    return f"| {number} | `{row.command}` | `{row.test}` | {twin} |"
