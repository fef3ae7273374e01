"""The table and the figure of docs/diagnosis_baselines.md."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np

from benchmarks.diagnosis_baselines.scores import FIGURES, TOOL, TOOL_WITHOUT_CLASSES
from benchmarks.markdown_page import put, table

mpl.use("Agg")
TITLES = {
    "largest_drop": "largest drop of χ²",
    "ridge": "ridge, largest z",
    "lasso": "LASSO (BIC)",
    "matching_pursuit": "matching pursuit",
    "stepwise_bic": "stepwise BIC",
    "stepwise_extended_bic": "stepwise extended BIC",
    "noise_evidence": "evidence, noise only",
    "linear_evidence": "evidence, linear",
    TOOL_WITHOUT_CLASSES: "diagnosis, no classes",
    TOOL: "diagnosis",
}
BARS = (
    ("right_name_at_2x", "right name (where separable, 2x and above)", "tab:green"),
    ("wrong_confident_name", "wrong name said alone (all cases)", "tab:red"),
    ("any_wrong_name", "any wrong name said (all cases)", "lightcoral"),
)


def write_page(scores: dict[str, dict[str, Any]], about: str, page: Path) -> None:
    """Rewrite the tables of the page, and the figure beside it."""
    text = put(page.read_text("utf-8"), "run", about)
    page.write_text(put(text, "figures", figure_table(scores)), "utf-8")
    draw(scores, page.with_suffix(".svg"))


def figure_table(scores: dict[str, dict[str, Any]]) -> str:
    """One row a figure, one column a method: share, and in how many of how many cases."""
    head = ["figure", *(TITLES[method] for method in scores)]
    return table(head, [[what, *(_cell(entries[key]) for entries in scores.values())] for what, key in FIGURES])


def _cell(entry: dict[str, Any]) -> str:
    if entry["value"] is None:
        return "no case"
    return f"{100 * entry['value']:.0f} % ({entry['successes']}/{entry['cases']})"


def draw(scores: dict[str, dict[str, Any]], path: Path) -> None:
    """Right and wrong names per method, with 95 per cent binomial bands."""
    mpl.rcParams["svg.hashsalt"] = "diagnosis baselines"
    figure, axes = plt.subplots(figsize=(7.0, 0.6 + 0.55 * len(scores)), layout="constrained")
    where, height = np.arange(len(scores), dtype=float), 0.26
    for i, (key, label, colour) in enumerate(BARS):
        rows = [entries[key] for entries in scores.values()]
        value = np.array([100.0 * (row["value"] or 0.0) for row in rows])
        band = 100.0 * np.array([row["band"] or (0.0, 0.0) for row in rows]).T
        error = np.maximum([value - band[0], band[1] - value], 0.0)
        axes.barh(where + (i - 1) * height, value, height, color=colour, label=label)
        axes.errorbar(value, where + (i - 1) * height, xerr=error, fmt="none", ecolor="0.25", capsize=2, linewidth=0.8)
    axes.set_yticks(where, [TITLES[method] for method in scores])
    axes.invert_yaxis()
    axes.set(xlabel="share of cases, 95 % band [%]", xlim=(0.0, 100.0))
    figure.legend(loc="outside upper center", ncols=1, frameon=False, fontsize=8)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
