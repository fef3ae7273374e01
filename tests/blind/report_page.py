"""The page of the docs: figures of the acceptance table, curves, confusion matrix, every case."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.blind.drawing_figures import draw_accuracy, draw_confusion

TEMPLATE = Path(__file__).with_name("report_page.md")
# (what, key, how it is written, what is to be reached)
ROWS = (
    ("false alarms on null campaigns, with those of the rates", "false_alarms", "<= 5 %"),
    ("- of which in the set itself", "of_which_in_the_set.false_alarms", ""),
    ("detection at 1x the smallest detectable size, with those of the rates", "detection.1x", ">= 75 %"),
    ("- of which in the set itself", "of_which_in_the_set.detection.1x", ""),
    ("detection at 2x", "detection.2x", ">= 95 %"),
    ("detection at 4x", "detection.4x", ">= 99 %"),
    ("right class (at most 3 names) at 2x and above", "right_class_at_2x", ">= 92 %"),
    ("right name at 2x and above, where separable", "right_name_at_2x", ">= 90 %"),
    ("wrong confident name, over everything", "wrong_confident_name", "<= 2 %"),
    ("wrong confident class, over everything", "wrong_confident_class", ""),
    ("wrong confident name or class among the rates", "wrong_confident_among_rates", ""),
    ("95 % intervals that cover", "interval_coverage", "92-98 %"),
    ("median relative error at 2x and above", "median_relative_error", "< 15 %"),
    ("outside the library, called unknown", "unknown_caught", ">= 85 %"),
    ("in the library, called unknown", "unknown_inside_library", "<= 5 %"),
    ("pairs: both right, with those of the rates", "pair_both", ">= 80 %"),
    ("- of which in the set itself", "of_which_in_the_set.pair_both", ""),
    ("pairs: at least one right, with those of the rates", "pair_at_least_one", ">= 97 %"),
    ("- of which in the set itself", "of_which_in_the_set.pair_at_least_one", ""),
    ("ambiguous: class reported", "ambiguous_class_reported", ">= 95 %"),
    ("ambiguous: resolved once the separating measurement is served", "resolved_by_more_measurements", ">= 90 %"),
    ("held-out error before/after, median", "heldout_ratio_median", ">= 3"),
    ("held-out error smaller than before", "heldout_better", ">= 95 %"),
    ("calibration error of the probability", "calibration_error", "< 0.05"),
    ("log score of the probability", "log_score", ""),
    ("median time of one report [s]", "seconds_median", "< 30 (small), < 180 (full)"),
    ("longest time of one report [s]", "seconds_largest", ""),
    ("runs without a usable result", "failed_runs", "0"),
)


def write_page(scores: dict[str, Any], page: Path, mesh: dict[str, Any] | None) -> None:
    """Write the page and the two figures beside it."""
    draw_accuracy(scores["figures"], page.with_name(f"{page.stem}_accuracy.svg"))
    draw_confusion(scores["rows"], page.with_name(f"{page.stem}_confusion.svg"))
    text = TEMPLATE.read_text("utf-8")
    parts = {
        "HEADLINE": headline(scores),
        "FIGURES": figure_table(scores["figures"]),
        "MESH": mesh_table(mesh) if mesh else "not measured in this run",
        "CAUSES": cause_table(scores["figures"]["by_cause"]),
        "CASES": case_table(scores["rows"] + scores["rates"]),
        "STEM": page.stem,
    }
    for key, value in parts.items():
        text = text.replace(f"@{key}@", value)
    page.write_text(text, "utf-8")


def headline(scores: dict[str, Any]) -> str:
    """Which run this is."""
    run = scores["run"]
    release = f", release {run['release']}" if run.get("release") else ""
    return f"Set `{run['set']}`{release}, {scores['figures']['cases']} cases, budget `{run['budget']}`, {run['date']}."


def figure_table(figures: dict[str, Any]) -> str:
    """The acceptance table."""
    lines = ["| figure | reached | 95 % band | cases | to reach |", "| --- | --- | --- | --- | --- |"]
    for what, key, goal in ROWS:
        entry: Any = figures
        for part in key.split("."):
            entry = entry[part]
        lines.append(f"| {what} | {' | '.join(_written(entry))} | {goal} |")
    return "\n".join(lines)


def _written(entry: Any) -> tuple[str, str, str]:
    """Value, band and number of cases."""
    if isinstance(entry, dict):
        if entry["value"] is None:
            return "no case", "", "0"
        low, high = entry["band"]
        return f"{100 * entry['value']:.1f} %", f"{100 * low:.0f}-{100 * high:.0f} %", str(entry["cases"])
    return ("no case" if entry is None else f"{entry:.3g}"), "", ""


def mesh_table(mesh: dict[str, Any]) -> str:
    """Error of the referee's mesh in units of the noise, per robot and kind of reading."""
    kinds = sorted({kind for row in mesh.values() for kind in row})
    lines = ["| robot | " + " | ".join(kinds) + " |", "| --- |" + " --- |" * len(kinds)]
    for robot, row in mesh.items():
        lines.append(f"| {robot} | " + " | ".join(f"{row[kind]:.4f}" for kind in kinds) + " |")
    return "\n".join(lines)


def cause_table(causes: dict[str, Any]) -> str:
    """Found and right, per hidden name."""
    lines = ["| hidden | cases | something found | answer right |", "| --- | --- | --- | --- |"]
    lines += [f"| `{name}` | {row['cases']} | {row['found']} | {row['right']} |" for name, row in causes.items()]
    return "\n".join(lines)


def case_table(rows: list[dict[str, Any]]) -> str:
    """Every case."""
    lines = ["| case | robot | hidden | size | said | probability | right |", "| --- " * 7 + "|"]
    for row in rows:
        hidden = " + ".join(row["hidden"]) or "nothing"
        size = "" if row["multiple"] in (None, 0.0) else f"{row['multiple']:.2g}x"
        said = "; ".join(" or ".join(names) for names in row["said"])
        chance = "" if row["probability"] is None else f"{row['probability']:.2f}"
        verdict = "yes" if row["right"] else "no"
        cells = (
            row["case"],
            row["robot"],
            f"{row['kind']}: {hidden}",
            size,
            f"{row['status']} {said}",
            chance,
            verdict,
        )
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
