"""The sigmas that were used, which of them are defaults, and signs that one is in a wrong unit."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import chdtr, chdtrc, fdtrc

from cdpr_struct.association.peak_noise import SCALES
from cdpr_struct.hypotheses.correlated import Correlated
from cdpr_struct.hypotheses.detectable import FALSE_ALARMS
from cdpr_struct.hypotheses.judge import Judged
from cdpr_struct.inference.scale_mixture import OUTLIER, TAU_DEGREES
from cdpr_struct.measurement.cable_columns import SWIVEL
from cdpr_struct.measurement.campaign import AMBIENT, SIGNALS, Campaign, Sheet
from cdpr_struct.robot.tolerances import tolerance_unit

SENSORS = ("position", "rotation", "tension", "length", "cable_frequency", "frf", "swivel")
"""Names of the kinds of sensors, in the order of their numbers."""
_WANDERING = SENSORS[:5]  # whose noise may be correlated from one reading to the next
_PEAKS, _ROBOT = "robot_frequency", 0  # a kind of readings that no block holds, and its place among kinds of lists
_TOO_SMALL = 1.5  # factor on a stated sigma from which it is said to be too small
_UNIT = {
    "tension_N": "N", "position_m": "m", "rotation_deg": "deg", "length_m": "m", "frequency_hz": "Hz",
    "acceleration": "m/s^2", "swivel_deg": "deg",
}  # fmt: skip
_POSE = ("position_m", "rotation_deg")
_NEEDED = {
    "static_state": ("tension_N", "length_m", "swivel_deg", *_POSE), "loaded_pose": ("length_m", "swivel_deg", *_POSE),
    "cable_frequency": ("frequency_hz", *_POSE), "robot_frequency": ("frequency_hz", *_POSE),
    "frf": ("frequency_hz",), "free_decay": ("frequency_hz",), "platform_motion": ("frequency_hz", *_POSE),
    AMBIENT: ("frequency_hz",),
}  # fmt: skip
_RANGE = {"position_m": (1e-6, 0.05), "rotation_deg": (1e-5, 5.0), "length_m": (1e-6, 0.05), "swivel_deg": (1e-4, 20.0)}
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


@dataclass(frozen=True, slots=True)
class Doubt:
    """A sigma or tolerance that can hardly be right.

    about : "sigma", "tolerance", or "errors" that are smaller than sigmas allow
    name, file : of what is doubted;  words : its size;  unit : that it should have, "" for a share
    large : whether it (of errors, they) is too large;  probability : of errors so small or large, else nan
    """

    about: str
    name: str
    file: str
    words: str
    unit: str
    large: bool
    probability: float = np.nan


@dataclass(frozen=True, slots=True)
class NoiseOfKind:
    """How a kind of sensor scatters.

    factor : on its stated sigma, outliers apart;  readings, outliers : how many
    p_large : of a factor so large, if stated sigmas are right within what is assumed of them;  p_small : of errors so
    small, if they are right;  p_stated : of errors so large, if they are right
    """

    kind: str
    factor: float
    readings: int
    outliers: int
    p_large: float
    p_small: float
    p_stated: float = 1.0

    @classmethod
    def of(cls, kind: str, factor: float, readings: int, outliers: int) -> "NoiseOfKind":
        """Of a factor that so many readings were found to have."""
        square = max(factor**2 * (TAU_DEGREES + readings) - TAU_DEGREES, 0.0)
        large, small = fdtrc(readings, TAU_DEGREES, square / readings), chdtr(readings, square)
        return cls(kind, factor, readings, outliers, float(large), float(small), float(chdtrc(readings, square)))


def noise_of_kinds(found: Judged) -> list[NoiseOfKind]:
    """Of each kind of sensor that was read; of correlated noise with its slow part."""
    groups, noise, rows = found.model.readings, found.fit.noise, []
    drift = found.hypothesis.drift
    rest = drift.independent if isinstance(drift, Correlated) else 1.0
    for kind, members in enumerate(groups.members > 0.0):
        count = int(groups.size[members].sum())
        if count:
            odd = int(groups.size[members & noise.outlying].sum())
            share = rest if SENSORS[kind] in _WANDERING else 1.0
            rows.append(NoiseOfKind.of(SENSORS[kind], float(noise.tau[kind]) / share, count, odd))
    return rows


def noise_of_peaks(found: Judged) -> list[NoiseOfKind]:
    """The same of the robot's peaks, those that belong to a mode; nothing without any."""
    last = None if found.lists is None else found.lists.association.assignment
    count = 0 if last is None else round(float(last.number.sum()))
    if found.lists is None or last is None or not count:
        return []
    odd = round(float(last.number[:, SCALES >= OUTLIER].sum()))
    return [NoiseOfKind.of(_PEAKS, float(found.lists.association.noise.tau[_ROBOT]), count, odd)]


def sigmas_used(campaign: Campaign) -> list[Used]:
    """Of every file, the sigmas that its rows need."""
    return [_used(sheet, name) for sheet in campaign.sheets for name in _NEEDED[sheet.kind] if _read(sheet, name)]


def _read(sheet: Sheet, name: str) -> bool:
    """Whether a file of static states holds the quantity at all; other kinds hold theirs, perhaps but swivel angles."""
    if name == "swivel_deg":
        return any(SWIVEL.long == own or SWIVEL.number(own) for own in sheet.columns)
    return sheet.kind != "static_state" or name in _POSE or name in sheet.columns


def _used(sheet: Sheet, name: str) -> Used:
    value = getattr(sheet.sigmas, name)
    words = _DEFAULT_FREQUENCY if value is None else f"{value:g} {_UNIT[name]}"
    source = "stated" if name in sheet.stated else "default"
    if value is None and sheet.kind in (*SIGNALS, AMBIENT):
        words, source = "of each identified mode", "signal"
    if "sigma" in sheet.columns and name == _main(sheet):
        source = f"column sigma, else {source}"
    return Used(sheet.kind, sheet.file, name, value, words, source)


def _main(sheet: Sheet) -> str:
    """The quantity that a column `sigma` is about."""
    if sheet.kind == "static_state":
        return "tension_N" if "tension_N" in sheet.columns else "length_m"
    return "position_m" if sheet.kind == "loaded_pose" else "frequency_hz"


def doubts(campaign: Campaign, noise: list[NoiseOfKind]) -> list[Doubt]:
    """What is odd about sigmas and tolerances."""
    rows = [doubt for used in sigmas_used(campaign) if (doubt := _absurd(campaign, used))]
    for name, most in _LOOSE.items():
        value = getattr(campaign.tolerances, name)
        if value > most and not (name == "length_m" and campaign.relative_lengths):
            rows.append(Doubt("tolerance", name, "", f"{value:g}", tolerance_unit(name), True))
    for one in noise:
        if one.p_small < FALSE_ALARMS:
            rows.append(Doubt("errors", one.kind, "", f"{one.factor:.2g}", "", False, one.p_small))
        if one.p_stated < FALSE_ALARMS and one.factor >= _TOO_SMALL:
            rows.append(Doubt("errors", one.kind, "", f"{one.factor:.2g}", "", True, one.p_stated))
    return rows


def _absurd(campaign: Campaign, used: Used) -> Doubt | None:
    """A sigma out of the range of any sensor of its kind."""
    if used.value is None or used.sigma not in {*_RANGE, *_SHARE}:
        return None
    low, high = _RANGE[used.sigma] if used.sigma in _RANGE else _of_readings(campaign, used)
    if low <= used.value <= high:
        return None
    return Doubt("sigma", used.sigma, used.file, used.words, _UNIT[used.sigma], used.value > high)


def _of_readings(campaign: Campaign, used: Used) -> tuple[float, float]:
    values: Any = campaign.states.tension
    if used.sigma == "frequency_hz":
        values = np.concatenate([campaign.cable_frequencies.hertz, campaign.robot_frequencies.hertz])
    values = values[np.isfinite(values)]
    middle = float(np.median(values)) if values.size else np.inf
    low, high = _SHARE[used.sigma]
    return (low * middle, high * middle) if np.isfinite(middle) else (0.0, np.inf)
