"""Orientations in data files as unit quaternions, columns qw, qx, qy, qz: turned into angles."""

from collections.abc import Iterable, Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.errors import NOTHING, InputError
from cdpr_struct.measurement.assumed_angles import ANGLES
from cdpr_struct.robot.pose import angles_from_rotation

QUATERNION = ("qw", "qx", "qy", "qz")
_REAL_LAST = [1, 2, 3, 0]  # columns in the order x, y, z, w
_NORM = 0.01  # by which the norm of a quaternion written with few digits may differ from one


def with_angles(file: str, numbers: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Columns (n,) of a table with rx_deg, ry_deg, rz_deg in place of a quaternion, if it has one.

    Raises
    ------
    InputError : not all four columns, angles beside them, or numbers that are no unit quaternion.
    """
    given = [name for name in QUATERNION if name in numbers]
    if not given:
        return dict(numbers)
    for name in QUATERNION:
        if name not in numbers:
            raise InputError(file, f"column {name}", NOTHING, f"all of {', '.join(QUATERNION)}")
    for name in ANGLES:
        if name in numbers:
            raise InputError(file, "header", f"{name} beside qw", "angles or a quaternion, not both")
    q = np.stack([numbers[name] for name in QUATERNION], axis=1)
    norm = np.linalg.norm(q, axis=1)
    for i in np.flatnonzero(~(np.abs(norm - 1.0) <= _NORM) & np.isfinite(q).any(axis=1)):
        expected = "a unit quaternion: qw^2 + qx^2 + qy^2 + qz^2 = 1"
        raise InputError(file, f"row {i + 1}, columns qw to qz", q[i].tolist(), expected)
    known = np.isfinite(norm)
    degrees = np.full((len(q), len(ANGLES)), np.nan)
    turns = Rotation.from_quat(q[known][:, _REAL_LAST])
    degrees[known] = np.degrees(angles_from_rotation(turns.as_matrix()))
    kept = {name: values for name, values in numbers.items() if name not in QUATERNION}
    return kept | dict(zip(ANGLES, degrees.T, strict=True))


def quaternion_headings(names: Iterable[str]) -> dict[str, str]:
    """Of each angle, the columns that it came from, in short; {} without a quaternion."""
    return dict.fromkeys(ANGLES, ", ".join(QUATERNION)) if QUATERNION[0] in names else {}
