"""python -m benchmarks.diagnosis_baselines --campaigns DIR --out DIR [--sealed DIR [--answers DIR] [--page FILE]]

Textbook selections of causes, and the diagnosis with parts taken out, on the campaigns of the blind tests. Answers of
all methods are written to OUT/answers first (what is there is kept: a break loses nothing); only then, and only with
--sealed, is the truth opened: OUT/figures.csv and OUT/cases.csv.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from benchmarks.diagnosis_baselines.answering import answer_all
from benchmarks.diagnosis_baselines.page import figure_table, write_page
from benchmarks.diagnosis_baselines.scores import all_scored, write_tables


def main(arguments: list[str] | None = None) -> int:
    """Command line."""
    options = _parser().parse_args(arguments)
    campaigns, out = Path(options.campaigns), Path(options.out)
    names = sorted(path.parent.name for path in campaigns.glob("*/campaign.toml"))
    names = [name for name in names if not options.only or name in options.only.split(",")]
    if not names:
        print(f"no campaigns in {campaigns}", file=sys.stderr)
        return 2
    answer_all(campaigns, out, names, options.workers, options.again)
    if options.sealed:
        _score(options, campaigns, out, names)
    return 0


def _score(options: argparse.Namespace, campaigns: Path, out: Path, names: list[str]) -> None:
    tool = Path(options.answers) if options.answers else None
    found = all_scored(campaigns, Path(options.sealed), out, names, tool)
    scores = write_tables(found, out)
    print(figure_table(scores))
    if options.page:
        count = len(next(iter(found.values())))
        write_page(scores, f"{count} cases of {options.set_name or campaigns}.", Path(options.page))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.diagnosis_baselines", description=__doc__.split("\n")[2]
    )
    parser.add_argument("--campaigns", required=True, help="campaigns of a blind set (OUT/campaigns of tests.blind)")
    parser.add_argument("--out", required=True, help="directory of prepared material, answers and tables")
    parser.add_argument("--sealed", default="", help="directory of the truth; without it nothing is scored")
    parser.add_argument("--answers", default="", help="answers of the diagnosis itself to these campaigns")
    parser.add_argument("--page", default="", help="page whose tables and figure are rewritten")
    parser.add_argument("--set-name", default="", help="what the page calls these campaigns")
    parser.add_argument("--only", default="", help="names of cases, by commas (default: all)")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--again", action="store_true", help="answer also what has an answer, from kept material")
    return parser


if __name__ == "__main__":
    sys.exit(main())
