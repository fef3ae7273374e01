"""First natural frequencies over the workspace, for all poses at once (fig 3.9)."""

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import expand_catenaries_at
from cdpr_struct.dynamics.internal_mass import with_internal_mass
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ritz_modes import ritz_modes
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_static_stiffness
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.statics.slack_cables import slack_count

_ORDER = 24
_MODES = 60
_HALF_WAVES = 2.5


def first_frequencies(robot: Robot, positions: np.ndarray, rotation: np.ndarray) -> dict[str, np.ndarray]:
    """First frequencies [Hz] of the robot, its platform (also on massless cables) and each cable; exact catenaries.

    The platform's is that of the mode whose platform motion is most like the platform's first mode on massless cables:
    where cable modes come near, they share its energy. A cable's frequency is that with both ends held. Minimum-norm
    tensions within the robot's force limits. nan where the platform is not held, or balanced but not stable.
    slack_cables: number of cables that hang slack where it is held.
    """
    solution = inverse(robot, positions, rotation, allow_unheld=True)
    held = np.flatnonzero(solution.held)
    good = held[_stable(_points(robot, positions, rotation, solution, held))]
    names = [
        "first_Hz",
        "platform_Hz",
        "platform_massless_Hz",
        *(f"cable_{i + 1}_Hz" for i in range(len(robot.cables))),
    ]
    columns = {name: np.full(len(positions), np.nan) for name in names}
    if good.size:
        found = _at_rest(_points(robot, positions, rotation, solution, good))
        for name, values in zip(names, found, strict=True):
            columns[name][good] = values
    return {**columns, "slack_cables": slack_count(solution.cables, solution.held), "held": solution.held}


def _points(
    robot: Robot, positions: np.ndarray, rotation: np.ndarray, solution: InverseSolution, chosen: np.ndarray
) -> OperatingPoint:
    states = solution.cables.at(chosen)
    return OperatingPoint(robot, positions[chosen], np.broadcast_to(rotation, (len(chosen), 3, 3)), states)


def _stable(point: OperatingPoint) -> np.ndarray:
    """(n,) bool: the platform's static stiffness, whatever the units of rotation, is positive definite."""
    if not len(point.position):
        return np.zeros(0, dtype=bool)
    return np.asarray(np.linalg.eigvalsh(platform_static_stiffness(point))[:, 0] > 0.0)


def _at_rest(point: OperatingPoint) -> list[np.ndarray]:
    full = expand_catenaries_at(point, _ORDER)
    first = np.sqrt(full.omega_squared[..., 0])
    modes = ritz_modes(point, full.reduced(_HALF_WAVES * float(first.max()), factor=1.2), _MODES)
    rigid = platform_static_stiffness(point), modes.platform_mass
    stiffness, mass = with_internal_mass(point.arrays, point.rotation, *rigid)
    massless, shape = _first_static_mode(stiffness, mass)
    moved = np.concatenate([modes.platform, modes.internal[..., None]], axis=-1)[..., : mass.shape[-1]]
    alike = np.einsum("nki,ni->nk", moved @ mass, shape) ** 2
    of_platform = np.take_along_axis(modes.omega, alike.argmax(axis=-1)[:, None], axis=-1)[:, 0]
    return [values / (2.0 * np.pi) for values in (modes.omega[:, 0], of_platform, massless, *first.T)]


def _first_static_mode(stiffness: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """omega (n,) [rad/s] (nan where unstable) and shape (n, d) of the first mode of matrices (n, d, d)."""
    inverse_root = np.linalg.inv(np.linalg.cholesky(mass))
    squared, vectors = np.linalg.eigh(inverse_root @ stiffness @ np.swapaxes(inverse_root, -1, -2))
    omega = np.sqrt(np.where(squared[:, 0] > 0.0, squared[:, 0], np.nan))
    return omega, np.einsum("nij,ni->nj", inverse_root, vectors[..., 0])
