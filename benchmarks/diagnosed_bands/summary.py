"""Shares of truths inside the bands of diagnosed robots, with what chance allows, as tables in Markdown."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from benchmarks.band_coverage.summary import QUANTITIES, limits
from benchmarks.diagnosed_bands.trying import LEVELS
from benchmarks.markdown_page import table

Told = dict[str, Any]


def summary(found: Sequence[Told]) -> str:
    """Tables and sentences."""
    extended = [told for told in found if "refused" not in told]
    without = len(found) - len(extended)
    lost = sum("lost" in pose for told in extended for pose in told["poses"])
    width = "width over that of the best constant band"
    return "\n\n".join(
        [
            "One frequency, component of the pose and tension of a case, chosen beforehand, inside the bands:",
            table(["cases", "count", *QUANTITIES, "allowed (99 %)"], list(_rows(extended, _chosen))),
            "All predictions at three poses [%]:",
            table(
                ["cases", "count", *QUANTITIES, width],
                list(_rows(extended, _all)),
            ),
            f"{without} cases have no extended robot; {lost} poses came to no answer and count as outside.",
        ]
    )


def groups(found: Sequence[Told]) -> Iterator[tuple[str, list[Told]]]:
    """What was hidden and what was said: inside and outside the library, nothing; named, a class, unknown."""
    for kind, names in (("inside", ("single", "pair", "ambiguous")), ("outside", ("outside",)), ("nothing", ("null",))):
        for status in ("named", "class", "unknown"):
            own = [told for told in found if told["kind"] in names and told["status"] == status]
            if own:
                yield f"{kind}, {status}", own
    yield "all", list(found)


def _rows(found: Sequence[Told], cells: Any) -> Iterator[list[str]]:
    for name, own in groups(found):
        yield [name, str(len(own)), *cells(own)]


def _chosen(found: Sequence[Told]) -> list[str]:
    told = [
        " / ".join(str(sum(_is_inside(each, quantity, level) for each in found)) for level in LEVELS)
        for quantity in range(len(QUANTITIES))
    ]
    allowed = ("{} to {}".format(*limits(len(found), 0.01 * level)) for level in LEVELS)
    return [*told, " / ".join(allowed)]


def _is_inside(told: Told, quantity: int, level: int) -> bool:
    pose = told["poses"][told["chosen"][0]]
    return "lost" not in pose and bool(pose["inside"][str(level)][told["chosen"][1 + quantity]])


def _all(found: Sequence[Told]) -> list[str]:
    shares, widths = [], []
    for quantity in QUANTITIES:
        values = [_parts(told, pose, quantity) for told in found for pose in told["poses"]]
        inside = [np.mean(np.concatenate([each[level] for each in values])) for level in LEVELS]
        shares.append(" / ".join(f"{100.0 * share:.0f}" for share in inside))
        off, sigma = (np.concatenate([each[name] for each in values]) for name in ("off", "sigma"))
        widths.append(f"{1.645 * sigma.mean() / np.quantile(np.abs(off), 0.9):.2f}" if len(off) else "-")
    return [*shares, ", ".join(widths)]


def _parts(told: Told, pose: Told, quantity: str) -> dict[Any, np.ndarray]:
    """Of positions, tensions or frequencies at a pose: inside each band, and distances with sigmas."""
    m = told["cables"]
    place = {"pose": slice(0, 3), "tension": slice(6, 6 + m), "frequency": slice(6 + m, None)}[quantity]
    if "lost" in pose:
        count = {"pose": 3, "tension": m, "frequency": 3}[quantity]
        return {level: np.zeros(count, dtype=bool) for level in LEVELS} | {"off": np.zeros(0), "sigma": np.zeros(0)}
    inside = {level: np.array(pose["inside"][str(level)][place]) for level in LEVELS}
    return inside | {name: np.array(pose[name][place]) for name in ("off", "sigma")}
