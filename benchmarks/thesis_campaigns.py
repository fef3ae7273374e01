"""What does the diagnosis say about the thesis's own measurements, and how much of it hangs on assumed sigmas?

    python -m benchmarks.thesis_campaigns                 all tables, to the screen (about five minutes)
    python -m benchmarks.thesis_campaigns verdicts modes  some of them
    python -m benchmarks.thesis_campaigns --write         puts them into docs/thesis_measurements.md, with figures

Every table of that page stands between `<!-- name -->` and `<!-- end -->` and comes from here.
"""

import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from benchmarks import thesis_findings as findings
from benchmarks.markdown_page import put, table
from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.reports.diagnose.page import plates
from cdpr_struct.reports.diagnose.result import result_json

FIGURES = {"table-4-4/level": "level", "tables-4-5-4-6/campaign": "frequencies"}
PAGE = Path(__file__).parents[1] / "docs" / "thesis_measurements.md"
CAMPAIGNS = (
    "table-4-4/campaign",
    "table-4-4/level",
    "tables-4-5-4-6/campaign",
    "tables-4-5-4-6/with-shaker",
    "section-4-3-3/campaign",
    "section-4-3-3/simulated",
)


def verdict_row(name: str) -> list[str]:
    """Name, verdict and evidence, place."""
    result = result_json(diagnosed(findings.example(name)))
    return [name, *findings.verdict_cells(result), result["verdict"]["location"] or "-"]


def verdicts() -> str:
    """One line a campaign."""
    return table(["campaign", *findings.VERDICT_HEAD, "place"], [verdict_row(name) for name in CAMPAIGNS])


TABLES = {
    "verdicts": verdicts,
    "forces": findings.where_table_4_4_fails,
    "internal": findings.internal_force_share,
    "sensitivity": lambda: findings.sensitivity("table-4-4/level"),
    "sensitivity-frequencies": lambda: findings.sensitivity("tables-4-5-4-6/campaign"),
    "tensions": findings.tensions_that_frequencies_mean,
    "modes": findings.platform_modes,
    "weight": findings.weight_of_tables_2,
}


def draw() -> None:
    """The residuals of two campaigns, as `diagnose --out` draws them, beside the page."""
    for name, short in FIGURES.items():
        found = diagnosed(findings.example(name))
        drawn = next(plate.picture for plate in plates(found, result_json(found)) if plate.name == "residuals")
        PAGE.with_name(f"{PAGE.stem}_{short}.svg").write_text(drawn.svg, "utf-8")


def main(arguments: list[str]) -> int:
    """Print the chosen tables; with --write also put them into the page."""
    chosen = [a for a in arguments if not a.startswith("-")] or list(TABLES)
    unknown = sorted(set(chosen) - TABLES.keys())
    if unknown:
        print(f"unknown table {unknown[0]}; there are {', '.join(TABLES)}", file=sys.stderr)
        return 2
    for name in chosen:
        text = TABLES[name]()
        print(f"\n{name}\n{text}", flush=True)
        if "--write" in arguments:
            PAGE.write_text(put(PAGE.read_text("utf-8"), name, text), "utf-8")
    if "--write" in arguments:
        draw()
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
