"""Bands over the workspace: keys of result.json, sentences, checks, and what the pictures of them show."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from cdpr_struct.bands.mapped_bands import BELOW, DRAWN, DRAWN_BELOW, ENDS, LOST, SLACK, band_column
from cdpr_struct.reports.bands_told import TAUT, differing
from cdpr_struct.reports.trust import Check
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.quantities import quantity_of
from cdpr_struct.workspace.work_list import Columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.workspace_map import Layer

_SELDOM = 0.05  # probability above which a pose is counted
_DECIMALS = 4  # of probabilities in pictures


def map_bands_told(name: str, grid: Grid, columns: Columns, samples: int, limit: float | None) -> dict[str, Any]:
    """What bands say over a grid, from the columns of `BandedQuantity`."""
    low, high, sigma = (columns[band_column(name, end)] for end in ENDS)
    known = np.isfinite(sigma)
    told: dict[str, Any] = {"poses": int(known.sum()), "sigma": _range(grid, sigma)}
    if limit is not None:
        below = columns[BELOW]
        told |= {"limit": limit, "probability_below": _range(grid, below)}
        told["poses_that_may_fall_below"] = int((below[known] > _SELDOM).sum())
    if not samples:
        return told
    ends = [columns[band_column(name, end)] for end in DRAWN]
    count = len(differing(np.stack([low, high], axis=-1), np.stack(ends, axis=-1)))
    drawn: dict[str, Any] = {"count": samples, "not_stable": int(np.nansum(columns[LOST])), "differing_poses": count}
    if limit is not None and known.any():
        drawn["largest_difference_of_probability"] = float(np.nanmax(np.abs(columns[DRAWN_BELOW] - columns[BELOW])))
    return told | {"samples": drawn}


def _range(grid: Grid, values: np.ndarray) -> dict[str, Any]:
    """Smallest and largest of some values and where they are, and their mean; empty if there are none."""
    if not np.isfinite(values).any():
        return {}
    ends = {"smallest": int(np.nanargmin(values)), "largest": int(np.nanargmax(values))}
    told = {end: {"value": values[i], "position_m": grid.positions[i]} for end, i in ends.items()}
    return {**told, "mean": float(np.nanmean(values))}


def map_band_sentences(result: Mapping[str, Any]) -> list[str]:
    """What bands say, in words."""
    bands, unit = result["bands"], result["unit"]
    if not bands["poses"]:
        return ["No pose has a band."]
    one = result["poses"] == 1
    said = [f"Sigma within the tolerances: {bands['sigma']['mean']:.3g} {unit}." if one else _sigma(bands, unit)]
    if "limit" in bands:
        most, limit = bands["probability_below"]["largest"], f"{bands['limit']:g} {unit}"
        chance = _chance(most["value"])
        if one or most["value"] < 10.0**-_DECIMALS:
            said.append(f"It falls below {limit} with a probability of {chance}{'' if one else ' at every pose'}.")
        else:
            count = bands["poses_that_may_fall_below"]
            said.append(
                f"It falls below {limit} with a probability of up to {chance}, at {_at(most)}; at "
                f"{count} of {bands['poses']} poses with more than {_SELDOM:g}."
            )
    if differ := bands.get("samples", {}).get("differing_poses"):
        said.append(
            f"First order and drawn robots differ by more than a fifth of the band at {differ} of {bands['poses']} "
            "poses; columns drawn_low and drawn_high are theirs."
        )
    return said


def _sigma(bands: Mapping[str, Any], unit: str) -> str:
    least, most = bands["sigma"]["smallest"], bands["sigma"]["largest"]
    return (
        f"Sigma within the tolerances: {least['value']:.3g} {unit} at {_at(least)} to {most['value']:.3g} {unit} at "
        f"{_at(most)}."
    )


def _at(end: Mapping[str, Any]) -> str:
    return "(" + ", ".join(f"{v:g}" for v in end["position_m"]) + ") m"


def _chance(value: float) -> str:
    return f"{value:.3g}" if value >= 10.0**-_DECIMALS else f"less than {10.0**-_DECIMALS:g}"


def map_band_checks(columns: Columns) -> list[Check]:
    """Whether tensions are linear within the tolerances at all poses, and whether drawn robots came to rest."""
    few = columns[SLACK] < TAUT
    said = (
        f"at {int(few.sum())} poses a cable may go slack within the tolerances, where bands to first order do not "
        "hold; --samples draws robots there"
    )
    count = "poses where a cable may go slack within the tolerances"
    checks = [Check.of(count, int(few.sum()), 0.0, said if few.any() else None)]
    if LOST in columns:
        lost = int(np.nansum(columns[LOST]))
        gone = "robots within the tolerances do not rest near their pose at these lengths; their share is left out"
        checks.append(Check.of("drawn robots without a stable rest", lost, 0.0, gone if lost else None))
    return checks


@dataclass(frozen=True, slots=True)
class BandLayer:
    """What one more picture of a map shows: name of its files, heading, caption."""

    name: str
    heading: str
    caption: str
    layer: "Layer"


def band_layers(name: str, columns: Columns, bands: Mapping[str, Any]) -> list[BandLayer]:
    """Pictures of sigma and of the probability of falling below the limit, where there is one."""
    from cdpr_struct.reports.figures.workspace_map import Layer

    own, nowhere = quantity_of(name), np.zeros(len(columns["held"]), dtype=bool)
    sigma = Layer(f"sigma of {own.label}", own.unit, columns[band_column(name, "sigma")], nowhere)
    about = "of robots within the tolerances, winches locked where the robot as entered has them"
    found = [BandLayer("sigma", "How sure is it?", f"One sigma of {own.label} [{own.unit}] {about}.", sigma)]
    if "limit" in bands:
        title = f"probability of less than {bands['limit']:g} {own.unit}"
        share = Layer(title, "-", np.round(columns[BELOW], _DECIMALS), nowhere)
        said = f"Share {about}, whose {own.label} lies below {bands['limit']:g} {own.unit}."
        found.append(BandLayer("probability", "Where may it fall below the limit?", said, share))
    return found
