"""What results say of bands: keys of result.json, lines for a terminal, columns of tables, checks."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from cdpr_struct.bands.drawn_robots import DrawnRobots
from cdpr_struct.bands.frequency_bands import FrequencyBands
from cdpr_struct.bands.rest_bands import RestBands
from cdpr_struct.reports.tolerances_told import defaults_used
from cdpr_struct.reports.trust import Check
from cdpr_struct.robot.robot import FREEDOMS

TAUT = 3.0
"""Sigmas of its tension that a cable should have before it goes slack."""
_NOT_OF_RESTS = ("load_cell_gain", "load_cell_bias_N", "damping")  # tolerances that move no robot at rest
_ABOUT = (
    " They lie about the likeliest of these robots; the values beside them are those of the numbers in the file, and "
    "may lie outside."
)
_ALIKE = 0.2  # of a band's width by which its ends may differ from those of drawn robots


def frequencies_told(
    found: FrequencyBands, hertz: np.ndarray, drawn: DrawnRobots | None, level: float
) -> dict[str, Any]:
    """Bands of frequencies hertz (k,) [Hz]; those of neutral freedoms, at zero, have none."""
    vibrating = hertz > 0.0
    bands, sigma = np.full((len(hertz), 2), np.nan), np.full(len(hertz), np.nan)
    count, first = int(vibrating.sum()), int((~vibrating).sum())
    bands[vibrating] = np.stack([found.low, found.high], axis=-1)[:count]
    sigma[vibrating] = found.sigma[:count] * hertz[vibrating]
    meeting = [[number + first for number in group] for group in found.meeting if group[0] <= count]
    told = {"frequencies_hz": bands, "sigma_hz": sigma, "modes_that_may_meet": meeting}
    if drawn is None:
        return told
    ends = np.full((len(hertz), 2), np.nan)
    if drawn.hertz.size:
        ends[vibrating] = drawn.quantiles("hertz", level)
    return told | {"samples": samples_told(drawn) | {"frequencies_hz": ends, "differ": differing(bands, ends)}}


def rest_told(found: RestBands, drawn: DrawnRobots | None, level: float) -> dict[str, Any]:
    """Bands of pose [m, deg] and tensions [N]."""
    told = {
        "pose": _in_degrees(found.pose),
        "pose_sigma": _in_degrees(found.pose_sigma),
        "tensions_N": found.tension,
        "tension_sigma_N": found.tension_sigma,
    }
    if drawn is None:
        return told
    pose, tension = drawn.quantiles("pose", level), drawn.quantiles("tension", level)
    differ = [f"pose {name}" for name in _named(differing(found.pose, pose), FREEDOMS)]
    differ += [f"tension {number}" for number in differing(found.tension, tension)]
    return told | {
        "samples": samples_told(drawn) | {"pose": _in_degrees(pose), "tensions_N": tension, "differ": differ}
    }


def samples_told(drawn: DrawnRobots) -> dict[str, Any]:
    """How many robots were drawn, and how many of them are not held."""
    return {"count": len(drawn.pose) + drawn.lost, "not_stable": drawn.lost}


def _in_degrees(pose: np.ndarray) -> np.ndarray:
    return np.concatenate([pose[:3], np.degrees(pose[3:])])


def _named(numbers: Sequence[int], names: Sequence[str]) -> list[str]:
    return [names[number - 1] for number in numbers]


def differing(bands: np.ndarray, ends: np.ndarray) -> list[int]:
    """Numbers, from 1, of bands whose ends differ by more than a share of their width."""
    width = bands[:, 1] - bands[:, 0]
    with np.errstate(invalid="ignore"):
        return (np.flatnonzero((np.abs(ends - bands) > _ALIKE * width[:, None]).any(axis=1)) + 1).tolist()


def slack_check(tension: np.ndarray, sigma: np.ndarray, drawn: DrawnRobots | None) -> list[Check]:
    """Whether tensions are linear within the tolerances: a cable that may go slack bends the band."""
    with np.errstate(divide="ignore"):
        margin = np.where(sigma > 0.0, tension / np.maximum(sigma, 1e-300), np.inf)
    weakest = int(np.argmin(margin))
    said = (
        f"cable {weakest + 1} has {tension[weakest]:.3g} N with a sigma of {sigma[weakest]:.3g} N: it may go slack "
        "within the tolerances, where bands to first order do not hold"
    )
    said += (
        "; see those of the drawn robots." if drawn is not None else "; --samples 500 draws robots and shows theirs."
    )
    check = Check.of(
        "least tension in sigmas", float(margin[weakest]), TAUT, said if margin[weakest] < TAUT else None,
        at_least=True,
    )  # fmt: skip
    lost = [] if drawn is None else [_lost_check(drawn)]
    return [check, *lost]


def _lost_check(drawn: DrawnRobots) -> Check:
    said = "robots within the tolerances do not rest near this pose at these lengths; their share is left out"
    return Check.of("drawn robots without a stable rest", drawn.lost, 0.0, said if drawn.lost else None)


def band_note(bands: Mapping[str, Any]) -> str:
    """One paragraph about what the bands mean."""
    diagnosed = bands["known_from"] == "diagnosis"
    robots = "that a diagnosis left probable" if diagnosed else "whose numbers are off by their tolerances"
    text = (
        f"Bands: {bands['level']:g} % of robots {robots} lie inside, each number by itself, winches locked where the "
        "robot as entered has them."
    )
    text += _ABOUT if diagnosed else _tolerances_used(bands["tolerances"])
    differ = bands.get("samples", {}).get("differ")
    if differ:
        text += (
            " First order and drawn robots differ by more than a fifth of the band at: "
            f"{', '.join(map(str, differ))}; the bands marked * are theirs."
        )
    return text


def _tolerances_used(told: Mapping[str, Any]) -> str:
    stated = [name for name, row in told.items() if row["stated"]]
    own = f" Tolerances of the robot file: {', '.join(stated)}." if stated else ""
    defaults = defaults_used(told, _NOT_OF_RESTS)
    return own + (f" {defaults}" if defaults else "")


def band_words(bands: Mapping[str, Any], key: str, digits: int) -> list[str]:
    """A band in words for each value of a key: those of drawn robots where these differ, marked by a star."""
    ends = np.asarray(bands[key], dtype=float)
    drawn: Mapping[str, Any] = bands.get("samples", {})
    differ: tuple[int, ...] = ()
    if key in drawn:
        differ = _numbers_of(drawn["differ"], key)
        ends = np.where(np.isin(np.arange(1, len(ends) + 1), differ)[:, None], np.asarray(drawn[key], float), ends)
    return [
        "-" if not np.isfinite(pair).any() else words_of_band(pair, digits, i in differ)
        for i, pair in enumerate(ends, start=1)
    ]


def words_of_band(ends: Sequence[float] | np.ndarray, digits: int, starred: bool = False) -> str:
    """A band in words; starred: it is that of drawn robots."""
    return f"{ends[0]:.{digits}f} .. {ends[1]:.{digits}f}{'*' * starred}"


def _numbers_of(differ: Sequence[Any], key: str) -> tuple[int, ...]:
    """Places, from 1, at which the values of a key differ."""
    if key == "frequencies_hz":
        return tuple(differ)
    kind, names = ("tension", None) if key == "tensions_N" else ("pose", FREEDOMS)
    found = [name.split()[1] for name in differ if name.startswith(kind)]
    return tuple(int(name) if names is None else names.index(name) + 1 for name in found)


def band_columns(bands: Mapping[str, Any], key: str, name: str, unit: str) -> dict[str, Any]:
    """Two columns with the ends of the band of each value of a key."""
    ends = np.asarray(bands[key], dtype=float)
    return {f"{name}_low_{unit}": ends[:, 0], f"{name}_high_{unit}": ends[:, 1]}
