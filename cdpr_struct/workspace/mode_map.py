"""The map of one mode, followed by its shape from the reference pose over the grid."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.hanging_solution import hung_solution
from cdpr_struct.statics.inverse_kinematics import InverseSolution
from cdpr_struct.statics.shared_winches import resting_orientation
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.inserted_poses import InsertedPoses
from cdpr_struct.workspace.mode_following import Following
from cdpr_struct.workspace.mode_matching import is_double
from cdpr_struct.workspace.mode_records import as_records, of_records
from cdpr_struct.workspace.shaped_modes import ShapedModes, bytes_of_pose, harmonics, shaped_modes
from cdpr_struct.workspace.work_list import Columns

MOST_MODES = 60
_LEAST, _SPARE = 8, 8  # modes that are computed at a pose: no fewer, and so many beyond the wanted one or twice as many
_WIDEST = MOST_MODES + 12
_MEMORY = 2**29  # bytes of shapes that a grid may have
_INSERTED, _AT_LEAST = 1, 256  # poses that may be inserted: so many a pose of the grid, and so many in any case
_ROUNDING = 1e-9  # m
_HERTZ, _SHAPES = "hertz", "shapes"


@dataclass(frozen=True, slots=True)
class ModeMap:
    """Mode `number` (1 is the first) at the reference pose, and what becomes of it.

    free : of rx, ry, rz, the angles at which the platform hangs freely at each pose; None: none
    """

    number: int
    free: tuple[bool, bool, bool] | None = None

    @property
    def count(self) -> int:
        """Modes that are computed at every pose."""
        return max(_LEAST, self.number + min(_SPARE, self.number + 2))

    def most_poses(self, robot: Robot) -> int:
        """Poses of the largest grid whose shapes are held in memory."""
        return _MEMORY // bytes_of_pose(robot, self.count)

    def evaluate(
        self, robot: Robot, positions: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None
    ) -> Columns:
        """Columns of the first modes, records of k frequencies and of k shapes a pose; `held`, `slack_cables`."""
        modes, columns = shaped_modes(robot, positions, rotation, self.count, harmonics(self.count), found)
        return {_HERTZ: as_records(modes.hertz), _SHAPES: as_records(modes.shapes), **columns}

    def finish(self, robot: Robot, grid: Grid, columns: Columns) -> Columns:
        """The columns of the map: mode_Hz, mode_number, mac, followed_from, veering, behind_veering.

        followed_from is the row of map.csv (the first is 1) of the pose before; 0 at the reference pose, and where
        there is no mode.
        """
        modes = ShapedModes(of_records(columns[_HERTZ]), of_records(columns[_SHAPES]))
        rest = {name: values for name, values in columns.items() if name not in (_HERTZ, _SHAPES)}
        start = reference(robot, grid, modes.hertz, self.number - 1)
        parts = harmonics(self.count)

        def compute(positions: np.ndarray, count: int) -> ShapedModes:
            if self.free is None:
                return shaped_modes(robot, positions, grid.rotation, count, parts)[0]
            hung = resting_orientation(robot, positions, grid.angles, self.free)
            return shaped_modes(robot, positions, hung.rotation, count, parts, hung_solution(robot, hung))[0]

        between = InsertedPoses(grid.positions, compute, max(_INSERTED * grid.size, _AT_LEAST))
        widest = min(_WIDEST, 2 * self.count)
        found = Following(modes, grid.neighbours, between, widest).from_pose(start, self.number - 1)
        return {
            "mode_Hz": found.hertz,
            "mode_number": found.number + 1,
            "mac": found.mac,
            "followed_from": found.before + 1,
            "veering": found.veering,
            "behind_veering": found.behind,
            **rest,
        }


def reference(robot: Robot, grid: Grid, hertz: np.ndarray, number: int) -> int:
    """The pose at which modes are numbered: the one next to the home pose if that lies within the grid, else next to
    the grid's centre, of those that are held and stable and at which the mode is no double one (if there are such).
    -1 if none is held and stable. hertz : (n, k)."""
    there = np.isfinite(hertz[:, number])
    if not there.any():
        return -1
    single = there & ~is_double(hertz, number)
    chosen = np.flatnonzero(single if single.any() else there)
    low, high = np.array([[axis[0], axis[-1]] for axis in grid.axes]).T
    middle = 0.5 * (low + high)
    if robot.home is not None:
        home = np.asarray(robot.home.position)
        middle = home if ((home >= low - _ROUNDING) & (home <= high + _ROUNDING)).all() else middle
    distance = ((grid.positions[chosen] - middle) ** 2).sum(axis=1)
    return int(chosen[distance.argmin()])
