"""Shares of truths inside their bands, with what chance allows, as tables in Markdown."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from scipy.stats import binom, kstest

from benchmarks.band_coverage.prediction import LEVELS
from benchmarks.markdown_page import table

QUANTITIES = ("frequency", "pose", "tension")
_CHANCE = 0.01  # of a right band to miss the limits, and of right probabilities to fail their test
Told = dict[str, Any]


def limits(count: int, level: float) -> tuple[int, int]:
    """Least and most of `count` independent truths that lie inside bands of a level (0 to 1), but for 1 % of chance."""
    least, most = (int(binom.ppf(share, count, level)) for share in (0.5 * _CHANCE, 1.0 - 0.5 * _CHANCE))
    return least, most


def inside(told: Told, quantity: str, level: int) -> list[bool]:
    """Of all predictions of a robot of one quantity; a true robot that comes to no rest is outside."""
    m = told["cables"]
    place = {"pose": slice(0, 6), "tension": slice(6, 6 + m), "frequency": slice(6 + m, None)}[quantity]
    return [False] if "lost" in told else list(told["inside"][str(level)][place])


def chosen_inside(told: Told, quantity: str, level: int) -> bool:
    """Of the prediction that was chosen beforehand."""
    return "lost" not in told and told["inside"][str(level)][told["chosen"][QUANTITIES.index(quantity)]]


def uniformity(found: Sequence[Told], quantity: str) -> float:
    """p-value of Kolmogorov and Smirnov's test that probabilities of the chosen truths are uniform."""
    values = [told["probability"][QUANTITIES.index(quantity)] for told in found if "lost" not in told]
    return float(kstest(values, "uniform").pvalue) if values else 1.0


def faults(found: Sequence[Told]) -> Iterator[str]:
    """What chance does not allow, of robots of which the program does not warn."""
    for quantity in QUANTITIES:
        for level in LEVELS:
            count = sum(chosen_inside(told, quantity, level) for told in found)
            least, most = limits(len(found), 0.01 * level)
            if not least <= count <= most:
                yield f"{quantity}: {count} of {len(found)} inside the {level} % band, {least} to {most} allowed"
        if uniformity(found, quantity) < _CHANCE:
            yield f"{quantity}: probabilities are not uniform, p = {uniformity(found, quantity):.1e}"


def answered(found: Sequence[Told], warned: bool) -> list[Told]:
    """Robots with bands, of which the program warns or does not."""
    return [told for told in found if "refused" not in told and told["warned"] == warned]


def summary(found: Sequence[Told]) -> str:
    """Tables and sentences."""
    sure, doubtful = answered(found, False), answered(found, True)
    refused = sum("refused" in told for told in found)
    parts = [
        f"{len(sure)} robots with bands that the program does not doubt: one frequency, component of the pose and "
        f"tension of each, chosen beforehand.\n\n{shares(sure)}",
        f"All predictions of these robots, which hang together within a robot:\n\n{everything(sure)}",
        f"{len(doubtful)} robots more, about which the program warns that a cable may go slack:\n\n"
        f"{everything(doubtful)}",
        f"Refused: {refused} robots, as unstable. {meshes(sure)}",
        "; ".join(faults(sure)) or "No share and no test is outside what chance allows.",
    ]
    return "\n\n".join(parts)


def shares(found: Sequence[Told]) -> str:
    """Counts of chosen predictions beside exact binomial limits, and the test of their probabilities."""
    rows = []
    for quantity in QUANTITIES:
        cells = [f"{sum(chosen_inside(told, quantity, level) for told in found)}" for level in LEVELS]
        rows.append([quantity, *cells, f"{uniformity(found, quantity):.2f}"])
    allowed = ["{} to {}".format(*limits(len(found), 0.01 * level)) for level in LEVELS]
    head = ["chosen", *(f"in {level} %" for level in LEVELS), "p (uniform)"]
    return table(head, [*rows, ["allowed (99 %)", *allowed, f"{_CHANCE:g} or more"]])


def everything(found: Sequence[Told]) -> str:
    """Shares over all predictions, by quantity and kind of robot."""
    rows = []
    for kind in [*sorted({told["kind"] for told in found}), "all"]:
        own = [told for told in found if kind in (told["kind"], "all")]
        cells = [
            " / ".join(f"{100.0 * _mean(own, quantity, level):.1f}" for level in LEVELS) for quantity in QUANTITIES
        ]
        rows.append([kind, str(len(own)), str(sum("lost" in told for told in own)), *cells])
    head = [
        "robots",
        "count",
        "no rest",
        *(f"{quantity} in {' / '.join(map(str, LEVELS))} % [%]" for quantity in QUANTITIES),
    ]
    return table(head, rows)


def _mean(found: Sequence[Told], quantity: str, level: int) -> float:
    values = [each for told in found for each in inside(told, quantity, level)]
    return float(np.mean(values)) if values else float("nan")


def meshes(found: Sequence[Told]) -> str:
    """How sure the finite elements are."""
    changes = [told["mesh_change"] for told in found if "lost" not in told]
    if not changes:
        return ""
    return (
        f"The finest meshes change the truth by {np.median(changes):.1g} sigmas in the median and by at most "
        f"{max(changes):.1g}."
    )
