"""FRFs (dataset 58) and modes (dataset 55) of a universal file as the rows of a campaign."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.universal_file import FREQUENCY_RESPONSE, PLATFORM_NODE
from cdpr_struct.measurement.universal_sets import Units, UniversalSet, kinds_of, sets_of
from cdpr_struct.robot.robot_file import LARGEST

_DERIVATIVES = {8: 2, 11: 1, 12: 0}  # ordinate displacement, velocity, acceleration: times i omega to acceleration
_NORMAL = 2
_MODES = (_NORMAL, 3, 7)  # analysis types of dataset 55: normal and complex modes
_ALONG = 3  # directions 1 to 3 are along the axes, 4 to 6 about them
_AXES = ("x", "y", "z", "rx", "ry", "rz")
_SUFFIXES = (".uff", ".unv", ".uf", ".bunv")


def is_universal(path: Path) -> bool:
    """Whether the name is that of a universal file."""
    return path.suffix.lower() in _SUFFIXES


def universal_columns(path: Path) -> tuple[dict[str, np.ndarray], dict[str, list[str]]]:
    """Numbers frequency_hz, real, imag and words case, respond, excite of all FRFs of a file.

    Node 1 is the platform point; its directions are called x .. rz. Other nodes keep their number ("node5:x").
    The file has no pose: the case is the file's name, and another file must give the pose of that case.

    Raises
    ------
    InputError : a file that is no universal file, or holds no FRF.
    """
    found = [s for s in sets_of(path, (58,)) if s.values.get("func_type") == FREQUENCY_RESPONSE]
    if not found:
        kinds = ", ".join(map(str, kinds_of(path))) or "none"
        raise InputError(str(path), "datasets", kinds, "at least one dataset 58 with function type 4, an FRF")
    parts = [_one(path, number, one) for number, one in enumerate(found, start=1)]
    numbers = {name: np.concatenate([p[0][name] for p in parts]) for name in ("frequency_hz", "real", "imag")}
    words = {name: [w for p in parts for w in p[1][name]] for name in ("respond", "excite")}
    return numbers, {"case": [path.stem] * len(numbers["real"]), **words}


def universal_modes(path: Path) -> tuple[dict[str, np.ndarray], dict[str, list[str]]]:
    """Numbers frequency_hz and words case of all modes (dataset 55, normal or complex) of a file.

    A complex mode's frequency is that of its damped vibration. The case is the file's name, as for FRFs.

    Raises
    ------
    InputError : a file that is no universal file, holds no mode, or one without a frequency above zero.
    """
    found = [(s.number, _mode_hertz(s.values)) for s in sets_of(path, (55,)) if s.values.get("analysis_type") in _MODES]
    if not found:
        kinds = ", ".join(map(str, kinds_of(path))) or "none"
        raise InputError(str(path), "datasets", kinds, "at least one dataset 55 with analysis type 2, 3 or 7, a mode")
    for number, hertz in found:
        if not 0.0 < hertz <= LARGEST:
            raise InputError(str(path), f"dataset {number}, frequency", hertz, "a frequency in Hz above zero")
    return {"frequency_hz": np.array([hertz for _, hertz in found])}, {"case": [path.stem] * len(found)}


def _mode_hertz(mode: Mapping[str, Any]) -> float:
    """Frequency of a mode; nan where the dataset has none."""
    if mode["analysis_type"] == _NORMAL:
        return float(mode.get("freq", np.nan))
    return float(abs(np.imag(mode.get("eig", np.nan)))) / (2.0 * np.pi)


def _one(path: Path, number: int, dataset: UniversalSet) -> tuple[dict[str, np.ndarray], dict[str, list[str]]]:
    one = dataset.values
    if "x" not in one or "data" not in one:
        raise InputError(str(path), f"FRF {number}", "no values", "frequencies and responses behind its header")
    hertz = np.asarray(one["x"], dtype=float)
    value = np.asarray(one["data"], dtype=complex)
    kind = int(one.get("ordinate_spec_data_type", 0))
    if kind not in _DERIVATIVES:
        raise InputError(
            str(path), f"FRF {number}, ordinate type", kind, "8 (displacement), 11 (velocity) or 12 (acceleration)"
        )
    declared = int(one.get("num_pts", value.size))
    if not declared == value.size == hertz.size > 0:
        given = f"{value.size} responses at {hertz.size} frequencies"
        raise InputError(
            str(path), f"FRF {number}", given, f"as many as the header declares, {declared}, and one at least"
        )
    if not ((np.abs(hertz) <= LARGEST).all() and (np.abs(value) <= LARGEST).all()):
        given, expected = "values that are not numbers", f"finite frequencies and responses, of at most {LARGEST:g}"
        raise InputError(str(path), f"FRF {number}", given, expected)
    value = value * _to_si(one, dataset.units)
    good = hertz > 0.0
    hertz, value = hertz[good], value[good] * (2j * np.pi * hertz[good]) ** _DERIVATIVES[kind]
    respond, excite = _name(one, "rsp"), _name(one, "ref")
    return (
        {"frequency_hz": hertz, "real": value.real, "imag": value.imag},
        {"respond": [respond] * len(hertz), "excite": [excite] * len(hertz)},
    )


def _to_si(one: Mapping[str, Any], units: Units) -> float:
    """Factor of a response in the file's units to m and N: rotations have no length, moments are force times length."""
    above = 1.0 if abs(int(one["rsp_dir"])) > _ALONG else 1.0 / units.length
    lever = units.length if abs(int(one["ref_dir"])) > _ALONG else 1.0
    return above * units.force * lever


def _name(one: Mapping[str, Any], end: str) -> str:
    """Name of the degree of freedom at the responding (rsp) or reference (ref) end."""
    node, direction = int(one[f"{end}_node"]), int(one[f"{end}_dir"])
    axis = _AXES[abs(direction) - 1] if 1 <= abs(direction) <= 6 else "?"
    axis = axis if direction > 0 else f"-{axis}"
    return axis if node == PLATFORM_NODE else f"node{node}:{axis}"
