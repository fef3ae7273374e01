"""Figures of the report: detection against size, and the confusion matrix."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

mpl.use("Agg")
mpl.rcParams["svg.hashsalt"] = "blind tests"


def accuracy_curve(axes: Axes, table: dict[str, Any], label: str, colour: str) -> None:
    """Share against multiple of the smallest detectable size, with its binomial band."""
    known = [(float(key[:-1]), row) for key, row in table.items() if row["value"] is not None]
    if not known:
        return
    sizes = [size for size, _ in known]
    values = [row["value"] for _, row in known]
    axes.fill_between(sizes, *np.array([row["band"] for _, row in known]).T, color=colour, alpha=0.15, linewidth=0)
    axes.plot(sizes, values, "o-", color=colour, label=label)
    for size, row in known:
        axes.annotate(f"n={row['cases']}", (size, -0.075), ha="center", fontsize=7, color="0.4")


def draw_accuracy(figures: dict[str, Any], path: Path) -> None:
    """Detection and right class against size."""
    figure, axes = plt.subplots(figsize=(6.0, 3.6), layout="constrained")
    accuracy_curve(axes, figures["detection"], "something found", "tab:blue")
    accuracy_curve(axes, figures["right_class_by_size"], "right class", "tab:orange")
    axes.set(xlabel="size / smallest detectable size (referee)", ylabel="share of single causes", ylim=(-0.1, 1.02))
    axes.set_xscale("log", base=2)
    axes.set_xticks([0.5, 1.0, 2.0, 4.0], ["0.5", "1", "2", "4"])
    if axes.get_legend_handles_labels()[0]:
        figure.legend(loc="outside upper center", ncols=2, frameon=False)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def confusion(rows: list[dict[str, Any]]) -> tuple[list[str], list[str], np.ndarray]:
    """Hidden names, said names, and counts; a class of names shares its count among them."""
    single = [row for row in rows if row["kind"] != "pair"]
    hidden = sorted({_hidden(row) for row in single})
    shares: dict[tuple[str, str], float] = {}
    for row in single:
        names = [name for group in row["said"] for name in group] or [row["status"]]
        for name in names:
            shares[_hidden(row), name] = shares.get((_hidden(row), name), 0.0) + 1.0 / len(names)
    said = sorted({name for _, name in shares})
    return hidden, said, np.array([[shares.get((h, s), 0.0) for s in said] for h in hidden])


def _hidden(row: dict[str, Any]) -> str:
    mark = " (outside)" if row["kind"] == "outside" else ""
    return f"{row['hidden'][0]}{mark}" if row["hidden"] else "nothing"


def draw_confusion(rows: list[dict[str, Any]], path: Path) -> None:
    """Which hidden effect was given which name; pairs left out."""
    hidden, said, counts = confusion(rows)
    figure, axes = plt.subplots(figsize=(2.5 + 0.3 * len(said), 2.0 + 0.24 * len(hidden)), layout="constrained")
    axes.imshow(counts, cmap="Blues", aspect="auto")
    axes.set_xticks(range(len(said)), said, rotation=90, fontsize=7)
    axes.set_yticks(range(len(hidden)), hidden, fontsize=7)
    axes.set(xlabel="said", ylabel="hidden")
    for (row, column), count in np.ndenumerate(counts):
        if count:
            colour = "white" if count > 0.6 * counts.max() else "black"
            axes.annotate(f"{count:.2g}", (column, row), ha="center", va="center", fontsize=6, color=colour)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)
