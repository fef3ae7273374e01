"""What is never exactly known about a robot, as independent standard normal numbers: narrow priors, always on."""

import numpy as np

from cdpr_struct.measurement.campaign import Tolerances
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.robot_arrays import RobotArrays

_HALF = np.sqrt(0.5)  # of a relative tolerance's sigma is common to all cables, which come from one reel


def tolerance_count(cables: int, wheels: bool) -> int:
    """How many numbers describe the tolerances of a robot with so many cables, with or without pulleys."""
    return sum(_sizes(cables)) + (cables if wheels else 0)


def _sizes(m: int) -> tuple[int, ...]:
    """Anchors of frame and platform, length zeros, EA and density of each cable and of all, mass, centre, inertia,
    gains and zeros of the load cells, radii of the pulleys; zeros of their swivel angles follow where there are any."""
    return (3 * m, 3 * m, m, m, 1, m, 1, 1, 3, 3, m, m, m)


def tolerated(arrays: RobotArrays, tolerances: Tolerances, u: np.ndarray) -> RobotArrays:
    """The robot whose tolerances are u (..., t) sigmas off; (...) are batch axes of its fields."""
    tol, m = tolerances, arrays.cable_count
    parts = np.split(u, np.cumsum(_sizes(m)), axis=-1)
    lead = u.shape[:-1]
    stretch = np.exp(0.5 * tol.platform_inertia * parts[9])
    moved = plus(
        arrays,
        frame_anchors=tol.anchor_m * parts[0].reshape((*lead, m, 3)),
        platform_anchors=tol.anchor_m * parts[1].reshape((*lead, m, 3)),
        length_offset=tol.length_m * parts[2],
        mass=tol.platform_mass_kg * parts[7][..., 0],
        center_of_mass=tol.center_of_mass_m * parts[8],
        cell_bias=tol.load_cell_bias_N * parts[11],
        pulley_radius=np.where(arrays.pulley_radius > 0.0, tol.pulley_radius_m * parts[12], 0.0),
    )
    if parts[13].shape[-1]:
        moved = plus(moved, swivel_zero=np.radians(tol.swivel_deg) * parts[13])
    return times(
        moved,
        axial_stiffness=np.exp(_HALF * tol.axial_stiffness * (parts[3] + parts[4])),
        linear_density=np.exp(_HALF * tol.linear_density * (parts[5] + parts[6])),
        inertia=stretch[..., :, None] * stretch[..., None, :],
        cell_gain=np.exp(tol.load_cell_gain * parts[10]),
    )
