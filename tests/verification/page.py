"""docs/verification.md: what the program was checked against, and how well it did."""

from tests.verification.figures import DOCS
from tests.verification.row import Row
from tests.verification.rows import SUBJECTS

PAGE = DOCS / "verification.md"

_HEAD = """# Verification and validation

Written by `python -m tests.verification`; do not edit. Each row names a case, what it is compared with, the number that
is compared, how large it may be, and what was measured. Results are read from the pages in the last column, or were
measured on the day that stands there. "Not measured" means that there is no figure yet. A result that does not meet its
acceptance stays in the table.

The second table repeats each row by one command. **The test** must fail if the acceptance is not met: on a case that is
small enough for every day, or with `-m slow`. **Its twin** feeds the same check something wrong on purpose, which must
be seen. Blind campaigns are made before and scored afterwards (`tests/blind/README.md`).
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
