"""python -m cdpr_struct.derivations [--check]: regenerate, or compare and exit 1 on drift."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from cdpr_struct.derivations import run


def main(arguments: list[str] | None = None) -> int:
    """Print the outcome; 0 when current, 1 on drift of text or value."""
    parser = argparse.ArgumentParser(prog="python -m cdpr_struct.derivations", description=__doc__)
    parser.add_argument("--check", action="store_true", help="compare, write nothing, exit 1 on drift")
    parser.add_argument("--output", type=Path, help="root to write to or compare with")
    options = parser.parse_args(arguments)
    report = run(options.check, options.output)
    for record in report.formulas:
        print(f"{record.status:10} {record.id:40} eq. ({record.thesis_equation})")
    for name in report.written:
        print(f"wrote {name}")
    if report.diff:
        print(report.diff)
    for error in report.value_errors:
        print(f"value: {error}")
    corrected = sum(record.status == "corrected" for record in report.formulas)
    print(f"{len(report.formulas)} formulas, {corrected} corrected, {report.seconds:.1f} s")
    if not report.current:
        print("stale: run python -m cdpr_struct.derivations and review the diff", file=sys.stderr)
    return 0 if report.current else 1


if __name__ == "__main__":
    sys.exit(main())
