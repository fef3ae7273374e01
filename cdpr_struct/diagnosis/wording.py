"""What was found, in words for a person: causes with their sizes, corrections, peaks without a mode for certain."""

from collections.abc import Sequence

import numpy as np

from cdpr_struct.diagnosis.causes.handling import Correction
from cdpr_struct.diagnosis.diagnose import Diagnosis
from cdpr_struct.diagnosis.evidence import Choice
from cdpr_struct.diagnosis.prepared import SIGNIFICANT
from cdpr_struct.measurement.campaign import Campaign

_STRAY = 0.3  # probability to belong to no mode from which a peak is not compared for certain
_DOUBT = (2.0, 2.0)  # of its own sigmas, and per cent of its frequency, by which the modes that compete differ


def described(choice: Choice, theta: np.ndarray) -> str:
    """The cause's sentence with its size; a single number with its sign, and what the sign means.

    far : mean square length of vectors of three numbers, or of the only one of fewer;  parts : one length a unit
    """
    cause, value = choice.candidate.cause, theta * choice.prior
    first = choice.pattern.parameters[0].shown(float(value[0]), 0.0)
    rms, norm = float(np.sqrt(np.mean(value**2))), float(np.linalg.norm(value))
    single = len(value) == 1
    words = {
        "value": f"{first['value']:.3g}", "percent": _per_cent(float(np.exp(value.mean()))),
        "rms": f"{value[0]:+.2g}" if single else f"{rms:.2g}", "norm": f"{norm:.2g}", "unit": str(first["unit"]),
        "far": f"{value[0]:+.2g}" if single else f"{norm / np.sqrt(max(len(value) // 3, 1)):.2g}",
        "parts": _by_unit(choice, value),
    }  # fmt: skip
    text = cause.sentence.format(**words)
    text = text.replace(" in the mean", "") if single else text
    notes = [choice.pattern.label, cause.sign if single else ""]
    if "{percent}" in cause.sentence and not single:
        notes.append(f"from {_per_cent(float(np.exp(value.min())))} to {_per_cent(float(np.exp(value.max())))}")
    note = ", ".join(filter(None, notes))
    return f"{text} ({note})" if note else text


def listed(names: Sequence[str]) -> str:
    """Names of causes as "a, b and c"."""
    *first, last = (name.replace("_", " ") for name in names)
    return f"{', '.join(first)} and {last}" if first else last


def _by_unit(choice: Choice, value: np.ndarray) -> str:
    """Length of the vector that the numbers of each unit make, as "0.002 m and 0.001 rad"."""
    units = np.array([p.unit for p in choice.pattern.parameters])
    sizes = {str(unit): np.linalg.norm(value[units == unit]) for unit in dict.fromkeys(units.tolist())}
    return " and ".join(f"{size:.2g} {unit}" for unit, size in sizes.items())


def _per_cent(ratio: float) -> str:
    """A ratio in per cent; what is near one keeps its digits."""
    return f"{100.0 * ratio:.{1 if abs(ratio - 1.0) > 0.01 else 3}f} %"


def corrected(found: Diagnosis) -> list[str]:
    """Each correction of the data, and what to mend in which file."""
    before, said = found.entered_setting.campaign, []
    for correction, _ in found.corrections:
        said.append(correction.sentence + _mend(before, correction))
        before = correction.campaign
    return said


def rest_words(found: Diagnosis) -> str:
    """Whether the rest agrees once the data are corrected."""
    if found.p_value_left >= SIGNIFICANT:
        return f" The rest then agrees within its uncertainty (p = {found.p_value_left:.2g})."
    return f" The rest does not agree yet (p = {found.p_value_left:.2g})."


def _mend(before: Campaign, correction: Correction) -> str:
    """Columns that a correction changes, the files that hold them, and the factor if there is one."""
    if correction.place:  # readings are set aside, none is wrong
        return ""
    places = []
    for sheet in before.sheets:
        columns = changed_columns(before, correction.campaign, sheet.kind)
        names = [sheet.headings.get(name, name) for name in sheet.columns if name in columns]
        places += [f"column {name} of {sheet.file}" for name in names]
    if not places:
        return ""
    factor = correction.parameters.get("factor")
    return f" (mend {', '.join(places)}" + (f": times {factor:.4g})" if factor else ")")


def changed_columns(before: Campaign, after: Campaign, kind: str) -> set[str]:
    """Columns of a kind of file in which two campaigns differ; the pose is three of position and three of angles."""
    cables = range(1, before.states.tension.shape[1] + 1)
    names = {
        "tension": ["tension_N"], "length": ["length_m", *(f"length_{i}_m" for i in cables)],
        "position": ["x_m", "y_m", "z_m"], "angles": ["rx_deg", "ry_deg", "rz_deg"], "payload": ["payload_kg"],
    }  # fmt: skip
    found: set[str] = set()
    for field, columns in names.items():
        old, new = getattr(before.states, field), getattr(after.states, field)
        differ = np.isfinite(old) & np.isfinite(new) & (old != new)
        if len(columns) == 3:
            found |= {name for name, own in zip(columns, differ.T, strict=True) if own.any()}
        elif differ.any():
            found |= set(columns)
    own = "cable_frequencies" if kind == "cable_frequency" else "robot_frequencies"
    if not np.array_equal(getattr(before, own).hertz, getattr(after, own).hertz):
        found.add("frequency_hz")
    return found


def doubtful_peaks(found: Diagnosis) -> np.ndarray:
    """(r,) robot frequencies that are given to no mode for certain."""
    setting, peaks = found.ground.setting, found.ground.setting.campaign.robot_frequencies
    if not peaks.hertz.size:
        return np.zeros(0, dtype=bool)
    stray = found.ground.stray if len(found.ground.stray) else setting.stray
    own = 100.0 * peaks.sigma / peaks.hertz
    doubtful: np.ndarray = (stray > _STRAY) | (setting.robot_doubt > np.maximum(_DOUBT[0] * own, _DOUBT[1]))
    return doubtful


def agreement(found: Diagnosis) -> str:
    """The sentence where nothing is significant: of peaks without a mode for certain it says nothing."""
    doubtful, peaks = doubtful_peaks(found), found.campaign.robot_frequencies
    p = f" (p = {found.p_value:.2g})."
    if not doubtful.any():
        return "Nothing significant: simulation and measurements agree within their uncertainty" + p
    listed = ", ".join(f"{f:g}" for f in peaks.hertz[doubtful][:6]) + (", ..." if doubtful.sum() > 6 else "")
    text = f"Nothing significant{p} But {doubtful.sum()} of {len(doubtful)} robot frequencies ({listed} Hz)"
    text += " cannot be given to a mode for certain, so that they neither agree nor disagree."
    return text + (" The rest agrees within its uncertainty." if not doubtful.all() else "")
