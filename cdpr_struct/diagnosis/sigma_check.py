"""The sigmas that were used, which of them are defaults, and signs that one is in a wrong unit."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.stats import chi2

from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.simulation_error import rows_read
from cdpr_struct.measurement.campaign import SIGNALS, Campaign, Sheet

_TOO_SMALL = 1e-3  # probability of residuals so small, below which sigmas are doubted
_UNIT = {
    "tension_N": "N", "position_m": "m", "rotation_deg": "deg", "length_m": "m", "frequency_hz": "Hz",
    "acceleration": "m/s^2",
}  # fmt: skip
_POSE = ("position_m", "rotation_deg")
_NEEDED = {
    "static_state": ("tension_N", "length_m", *_POSE), "loaded_pose": ("length_m", *_POSE),
    "cable_frequency": ("frequency_hz", *_POSE), "robot_frequency": ("frequency_hz", *_POSE),
    "frf": ("frequency_hz",), "free_decay": ("frequency_hz",), "platform_motion": ("frequency_hz", *_POSE),
}  # fmt: skip
_RANGE = {"position_m": (1e-6, 0.05), "rotation_deg": (1e-5, 5.0), "length_m": (1e-6, 0.05)}
_SHARE = {"tension_N": (1e-5, 0.3), "frequency_hz": (1e-6, 0.2)}  # of the median reading
_LOOSE = {  # tolerances beyond these are no drawing's
    "anchor_m": 0.1, "length_m": 0.1, "center_of_mass_m": 0.3, "pulley_radius_m": 0.02,
    "axial_stiffness": 0.5, "linear_density": 0.5, "platform_inertia": 1.0, "load_cell_gain": 0.3,
}  # fmt: skip
_DEFAULT_FREQUENCY = "0.3 % of each"


@dataclass(frozen=True, slots=True)
class Used:
    """A sigma of a file: its key, value in words, and whether the campaign file or a column gives it."""

    kind: str
    file: str
    sigma: str
    value: float | None
    words: str
    source: str


def sigmas_used(campaign: Campaign) -> list[Used]:
    """Of every file, the sigmas that its rows need."""
    return [_used(sheet, name) for sheet in campaign.sheets for name in _NEEDED[sheet.kind] if _read(sheet, name)]


def _read(sheet: Sheet, name: str) -> bool:
    """Whether a file of static states holds the quantity at all; other kinds hold theirs."""
    return sheet.kind != "static_state" or name in _POSE or name in sheet.columns


def _used(sheet: Sheet, name: str) -> Used:
    value = getattr(sheet.sigmas, name)
    words = _DEFAULT_FREQUENCY if value is None else f"{value:g} {_UNIT[name]}"
    source = "stated" if name in sheet.stated else "default"
    if value is None and sheet.kind in SIGNALS:
        words, source = "of each identified mode", "signal"
    if "sigma" in sheet.columns and name == _main(sheet):
        source = f"column sigma, else {source}"
    return Used(sheet.kind, sheet.file, name, value, words, source)


def _main(sheet: Sheet) -> str:
    """The quantity that a column `sigma` is about."""
    if sheet.kind == "static_state":
        return "tension_N" if "tension_N" in sheet.columns else "length_m"
    return "position_m" if sheet.kind == "loaded_pose" else "frequency_hz"


def tolerance_unit(name: str) -> str:
    """Unit of a tolerance, which ends its name; "" of those that are shares of the value entered."""
    return next((ending for ending in ("m", "kg", "N") if name.endswith(f"_{ending}")), "")


def warnings(found: Diagnosis) -> list[str]:
    """What is odd about the sigmas, in sentences."""
    said = [text for used in sigmas_used(found.campaign) if (text := _absurd(found.campaign, used))]
    for name, most in _LOOSE.items():
        value, unit = getattr(found.campaign.tolerances, name), tolerance_unit(name)
        if value > most:
            asked = f"in {unit}" if unit else "a share of it"
            said.append(f"the tolerance {name}, {value:g}, is very large: is it {asked}?")
    null, labels, read = found.entered, found.entered_setting.labels, rows_read(found)
    for kind in dict.fromkeys(labels.kind[read & ~np.isin(labels.block.astype(str), ("RF", "FA"))].tolist()):
        rows = np.flatnonzero((labels.kind == kind) & read)
        z = null.white_among(rows, null.r)
        p = float(chi2.cdf(float(z @ z), len(z)))
        if p < _TOO_SMALL:
            said.append(
                f"the residuals of {kind} are smaller than their sigmas and tolerances let expect (chi2/n "
                f"{float(z @ z) / len(z):.2g}, probability {p:.0e}): is one of them too large, or in a wrong unit? "
                "Little can be found with them"
            )
    return said


def _absurd(campaign: Campaign, used: Used) -> str:
    """A sentence where a sigma is out of the range of any sensor of its kind."""
    if used.value is None or used.sigma not in {*_RANGE, *_SHARE}:
        return ""
    low, high = _RANGE[used.sigma] if used.sigma in _RANGE else _of_readings(campaign, used)
    if low <= used.value <= high:
        return ""
    size = "large" if used.value > high else "small"
    return f"sigma.{used.sigma} of {used.file}, {used.words}, is very {size}: is it in {_UNIT[used.sigma]}?"


def _of_readings(campaign: Campaign, used: Used) -> tuple[float, float]:
    values: Any = campaign.states.tension
    if used.sigma == "frequency_hz":
        values = np.concatenate([campaign.cable_frequencies.hertz, campaign.robot_frequencies.hertz])
    values = values[np.isfinite(values)]
    middle = float(np.median(values)) if values.size else np.inf
    low, high = _SHARE[used.sigma]
    return (low * middle, high * middle) if np.isfinite(middle) else (0.0, np.inf)
