"""Bands of cable forces along a motion: keys of result.json, table, CSV, checks, plate of the page."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from cdpr_struct.bands.force_bands import DrawnForces, ForceBands
from cdpr_struct.dynamics.trajectory_distribution import TrajectoryDistribution
from cdpr_struct.reports.bands_told import TAUT, band_note, differing, words_of_band
from cdpr_struct.reports.csv_table import csv_text
from cdpr_struct.reports.figures import force_bands as figure
from cdpr_struct.reports.figures.drawing import Drawing
from cdpr_struct.reports.html import HtmlTable, Plate
from cdpr_struct.reports.text import plain_table
from cdpr_struct.reports.trust import Check

_SURE = 0.95  # probability for which a raise of the lower bound is told
_TITLE = "Tensions within the tolerances"


def force_bands_told(
    found: ForceBands, time: np.ndarray, lower: np.ndarray, drawn: DrawnForces | None, samples: int
) -> dict[str, Any]:
    """Probabilities over the whole motion, and of each cable where its tension is nearest to its bound.

    time : (n,) [s];  lower : (n, m) bounds [N]
    """
    told: dict[str, Any] = {
        "instants": len(time),
        "probability_all_taut": found.all_taut,
        "probability_all_above_lower_bound": found.all_above,
        "probability_all_below_upper_bound": found.all_below,
        "raise_lower_bound": {"probability": _SURE, "by_N": found.raised(_SURE)},
        "cables": [_cable(found, time, lower, cable) for cable in range(found.tension.shape[1])],
    }
    if drawn is None:
        return told
    bands, ends = found.band[drawn.place].reshape((-1, 2)), drawn.ends.reshape((-1, 2))
    differ = differing(bands, ends)
    checked = {"count": samples, "not_stable": drawn.lost, "times_s": time[drawn.place], "ends_N": drawn.ends}
    return told | {"samples": checked | {"differing_tensions": len(differ), "of": len(bands)}}


def _cable(found: ForceBands, time: np.ndarray, lower: np.ndarray, cable: int) -> dict[str, Any]:
    at = int(((found.tension - lower) / np.maximum(found.sigma, 1e-300))[:, cable].argmin())
    return {
        "cable": cable + 1,
        "largest_sigma_N": found.sigma[:, cable].max(),
        "nearest_to_bound": {
            "time_s": time[at],
            "tension_N": found.tension[at, cable],
            "sigma_N": found.sigma[at, cable],
            "band_N": found.band[at, cable],
            "lower_bound_N": lower[at, cable],
        },
        "probability_below_lower_bound": found.below[:, cable].max(),
        "probability_slack": found.slack[:, cable].max(),
        "probability_above_upper_bound": found.above[:, cable].max(),
    }


def force_band_sentences(bands: Mapping[str, Any]) -> list[str]:
    """What they say of the whole motion."""
    more = bands["raise_lower_bound"]
    said = [
        f"All cables stay taut along the motion with a probability of {bands['probability_all_taut']:.3g}, above the "
        f"lower bound with {bands['probability_all_above_lower_bound']:.3g}, below the upper bound with "
        f"{bands['probability_all_below_upper_bound']:.3g}."
    ]
    if more["by_N"] > 0.0:
        said.append(
            f"To stay above the lower bound with a probability of {more['probability']:g}, distribute with a bound "
            f"that is {more['by_N']:.3g} N higher."
        )
    drawn = bands.get("samples")
    if drawn:
        count = drawn["differing_tensions"]
        said.append(
            f"First order and drawn robots differ by more than a fifth of the band at {count} of {drawn['of']} "
            f"tensions ({len(drawn['times_s'])} instants)."
        )
    return said


def force_bands_text(bands: Mapping[str, Any]) -> list[str]:
    """Table, sentences and note for a terminal."""
    return [plain_table(_TITLE, *_rows(bands)), " ".join(force_band_sentences(bands)), band_note(bands)]


def force_bands_table(bands: Mapping[str, Any]) -> HtmlTable:
    """The same for the page."""
    note = " ".join([*force_band_sentences(bands), band_note(bands)])
    return HtmlTable(_TITLE, *_rows(bands), note)


def _rows(bands: Mapping[str, Any]) -> tuple[list[str], list[list[str]]]:
    rows = []
    for cable in bands["cables"]:
        near = cable["nearest_to_bound"]
        low, high = near["band_N"]
        rows.append(
            [
                f"cable {cable['cable']}", f"{near['time_s']:.2f}", f"{near['tension_N']:.1f}",
                words_of_band([low, high], 1),
                f"{near['lower_bound_N']:.1f}", f"{cable['probability_below_lower_bound']:.3g}",
                f"{cable['probability_slack']:.2g}",
            ]
        )  # fmt: skip
    level = f"{bands['level']:g} % band [N]"
    names = ["nearest to its bound", "at [s]", "tension [N]", level, "bound [N]", "most p(below)", "most p(slack)"]
    return names, rows


def force_bands_csv(found: TrajectoryDistribution, bands: ForceBands) -> str:
    """One row an instant and cable."""
    shared, at, m = found.distribution, bands.instant, bands.tension.shape[1]
    lower, upper = (np.broadcast_to(end, shared.tensions.shape)[at] for end in (shared.lower, shared.upper))
    columns = {
        "tension_N": bands.tension,
        "sigma_N": bands.sigma,
        "low_N": bands.band[..., 0],
        "high_N": bands.band[..., 1],
        "lower_bound_N": lower,
        "upper_bound_N": upper,
        "probability_slack": bands.slack,
        "probability_below_lower_bound": bands.below,
        "probability_above_upper_bound": bands.above,
    }
    where = {"time_s": np.repeat(found.trajectory.time[at], m), "cable": np.tile(np.arange(1, m + 1), len(at))}
    return csv_text(where | {name: values.ravel() for name, values in columns.items()})


def force_band_checks(found: ForceBands, drawn: DrawnForces | None) -> list[Check]:
    """Whether tensions are linear within the tolerances along the motion."""
    margin = float((found.tension / np.maximum(found.sigma, 1e-300)).min())
    said = (
        "a cable may go slack within the tolerances, where bands to first order do not hold; --samples 500 draws "
        "robots at some instants"
    )
    least = Check.of("least tension in sigmas", margin, TAUT, said if margin < TAUT else None, at_least=True)
    if drawn is None:
        return [least]
    lost = "robots within the tolerances find no balance near the path at these lengths; their share is left out"
    return [least, Check.of("drawn robots without a stable rest", drawn.lost, 0.0, lost if drawn.lost else None)]


def force_bands_plate(found: TrajectoryDistribution, bands: ForceBands, level: float) -> Plate:
    """The picture on the page; level [%]."""
    drawn = Drawing("bands", figure.size(bands), lambda empty: figure.draw_force_bands(empty, found, bands))
    return Plate("bands", "How sure are the forces?", drawn, figure.caption(level))
