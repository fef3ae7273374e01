"""FRFs of a universal file (dataset 58) as the rows of a campaign."""

from pathlib import Path
from typing import Any

import numpy as np
import pyuff

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.universal_file import FREQUENCY_RESPONSE, PLATFORM_NODE
from cdpr_struct.robot.robot_file import LARGEST

_DERIVATIVES = {8: 2, 11: 1, 12: 0}  # ordinate displacement, velocity, acceleration: times i omega to acceleration
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
    try:
        sets = pyuff.UFF(str(path)).read_sets()
    except Exception as error:  # pyuff raises whatever its parsing runs into
        raise InputError(str(path), "", path.name, "a universal file with datasets 58 that can be read") from error
    sets = sets if isinstance(sets, list) else [sets]
    found = [s for s in sets if s.get("type") == 58 and s.get("func_type") == FREQUENCY_RESPONSE]
    if not found:
        kinds = ", ".join(str(s.get("type")) for s in sets) or "none"
        raise InputError(str(path), "datasets", kinds, "at least one dataset 58 with function type 4, an FRF")
    parts = [_one(path, number, one) for number, one in enumerate(found, start=1)]
    numbers = {name: np.concatenate([p[0][name] for p in parts]) for name in ("frequency_hz", "real", "imag")}
    words = {name: [w for p in parts for w in p[1][name]] for name in ("respond", "excite")}
    return numbers, {"case": [path.stem] * len(numbers["real"]), **words}


def _one(path: Path, number: int, one: dict[str, Any]) -> tuple[dict[str, np.ndarray], dict[str, list[str]]]:
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
    good = hertz > 0.0
    hertz, value = hertz[good], value[good] * (2j * np.pi * hertz[good]) ** _DERIVATIVES[kind]
    respond, excite = _name(one, "rsp"), _name(one, "ref")
    return (
        {"frequency_hz": hertz, "real": value.real, "imag": value.imag},
        {"respond": [respond] * len(hertz), "excite": [excite] * len(hertz)},
    )


def _name(one: dict[str, Any], end: str) -> str:
    """Name of the degree of freedom at the responding (rsp) or reference (ref) end."""
    node, direction = int(one[f"{end}_node"]), int(one[f"{end}_dir"])
    axis = _AXES[abs(direction) - 1] if 1 <= abs(direction) <= 6 else "?"
    axis = axis if direction > 0 else f"-{axis}"
    return axis if node == PLATFORM_NODE else f"node{node}:{axis}"
