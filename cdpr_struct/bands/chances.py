"""With which probability does a robot within its tolerances keep a limit, to first order?"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from cdpr_struct.bands.frequency_bands import drawn_changes
from cdpr_struct.bands.locked_response import LockedResponse
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.tolerances import Spread


@dataclass(frozen=True, slots=True, eq=False)
class DrawnRest:
    """n robots at rest at locked lengths, to first order.

    tension : (n, m) at the platform [N];  strain : (n, m) of the cables
    position_error : (n,) distance from where the robot as entered rests [m];  rotation_error : (n,) angle [rad]
    """

    tension: np.ndarray
    strain: np.ndarray
    position_error: np.ndarray
    rotation_error: np.ndarray

    @classmethod
    def of(
        cls, point: OperatingPoint, response: LockedResponse, spread: Spread, entered: OperatingPoint
    ) -> "DrawnRest":
        """Drawn about a point; spread: which robots are probable;  entered : the one that errors are distances from."""
        changes = drawn_changes(spread)
        tension = point.cables.tension_at_platform + changes @ response.tension
        turned = Rotation.from_matrix(point.rotation @ entered.rotation.T).as_rotvec()
        motion = changes @ response.pose + np.concatenate([point.position - entered.position, turned])
        strain = tension / point.cables.axial_stiffness
        lengths = (np.linalg.norm(part, axis=1) for part in (motion[:, :3], motion[:, 3:]))
        return cls(tension, strain, *lengths)


def chance(values: np.ndarray, least: float | None, most: float | None) -> float:
    """Share of draws (n, ..) that keep both limits in all their numbers."""
    kept = np.ones(len(values), dtype=bool)
    flat = values.reshape(len(values), -1)
    if least is not None:
        kept &= (flat >= least).all(axis=1)
    if most is not None:
        kept &= (flat <= most).all(axis=1)
    return float(kept.mean())
