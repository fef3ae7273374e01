"""What the sensors said, as arrays that can be perturbed: (..., S states), any leading axes are a batch."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.measurement.campaign import States
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.equilibrium import rotation_from_vector


@dataclass(frozen=True, slots=True, eq=False)
class Readings:
    """position (..., S, 3), rotation (..., S, 3, 3), tension (..., S, m), length (..., S, m); nan where not read."""

    position: np.ndarray
    rotation: np.ndarray
    tension: np.ndarray
    length: np.ndarray

    @classmethod
    def of(cls, states: States) -> "Readings":
        """As recorded."""
        turn = np.array([rotation_from_angles(*angles) for angles in states.angles]).reshape((-1, 3, 3))
        return cls(states.position, turn, states.tension, states.length)

    def shifted(self, move: np.ndarray, turn: np.ndarray, tension: np.ndarray, length: np.ndarray) -> "Readings":
        """Readings with errors taken off: move (..., S, 3) [m], turn (..., S, 3) [rad, world], [N], [m]."""
        return Readings(
            self.position + move,
            rotation_from_vector(turn) @ self.rotation,
            self.tension + tension,
            self.length + length,
        )


def exit_turns(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(..., m) right angles by which a cable that comes up from a winch below turns at its exit, cables straight."""
    away = position[..., None, :] + robot.platform_anchors @ np.swapaxes(rotation, -1, -2) - robot.frame_anchors
    upward = away[..., 2] / np.linalg.norm(away, axis=-1)
    return np.asarray(np.arccos(upward) / (0.5 * np.pi))


def cell_reading(robot: Robot, tension: np.ndarray, approach: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """(..., m) what the robot's load cells say at tensions (..., m) [N].

    approach : (..., m) direction of the last motion, nan unknown;  turns : (..., m) right angles at the exits
    """
    more, last = robot.extensions, np.where(np.isfinite(approach), approach, 0.0)
    return np.asarray(tension * np.exp(more.friction * last * turns) * more.cell_gain + more.cell_bias)
