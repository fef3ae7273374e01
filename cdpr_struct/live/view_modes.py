"""What the window shows of the vibrations about a state of rest."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.crosscheck.mode_motion import ModeMotion, mode_motion
from cdpr_struct.crosscheck.robot_modes import robot_modes
from cdpr_struct.dynamics.platform_directions import direction_shares
from cdpr_struct.errors import CdprError, told
from cdpr_struct.live.view_state import ViewState
from cdpr_struct.reports.figures.robot_geometry import cable_curves
from cdpr_struct.reports.mode_words import motion_words


@dataclass(frozen=True, slots=True, eq=False)
class ViewModes:
    """The first k modes of a robot with m cables.

    hertz : (k,) [Hz];  kinds, words : k, which body moves, and how the platform does
    rest  : (m, p, 3) cables at rest, world [m];  motion : their shapes at the same points
    """

    hertz: np.ndarray
    kinds: tuple[str, ...]
    words: tuple[str, ...]
    rest: np.ndarray
    motion: ModeMotion

    def displaced(self, mode: int, gain: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Cables (m, p', 3) and platform, shift (3,) [m] and turn (3,) [rad], in a mode (from 0).

        gain : displacement of the point that moves most [m]
        """
        size, every = gain / self.motion.reach[mode], slice(None, None, int(self.motion.stride[mode]))
        cables = self.rest[:, every] + size * self.motion.cables[mode][:, every]
        platform = size * self.motion.platform[mode]
        return cables, platform[:3], platform[3:]


@dataclass(frozen=True, slots=True)
class NoModes:
    """There are no vibrations about this state, and why."""

    message: str


def view_modes(state: ViewState, count: int) -> ViewModes | NoModes:
    """The first `count` modes with exact cables."""
    point = state.point
    try:
        found = robot_modes(point, "exact", count)
    except (CdprError, ArithmeticError, np.linalg.LinAlgError) as error:
        return NoModes(str(told(error)))
    motion = mode_motion(point, found)
    words = motion_words(found.platform_energy, direction_shares(point, found.platform))
    return ViewModes(
        found.hertz, tuple(found.kinds()), tuple(words), cable_curves(point, motion.fractions), motion,
    )  # fmt: skip
