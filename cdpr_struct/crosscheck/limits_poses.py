"""The printed limits over many poses of a robot: grids and trajectories, all at once."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from cdpr_struct.crosscheck.validity_limits import (
    CROSSOVER_DISTANCE,
    INCLINATION_EPSILON_PAIRS,
    LAMBDA_SQUARED_LIMIT,
    SAG_RATIO_LIMIT,
    crossover_distance,
    epsilon_limits,
)
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.taut_cables import taut_cables
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.free_orientation import names_of
from cdpr_struct.statics.hanging_solution import hung_solution
from cdpr_struct.statics.inverse_kinematics import InverseSolution, InverseStatus, inverse
from cdpr_struct.statics.shared_winches import resting_orientation
from cdpr_struct.workspace.pose_batches import PoseBatches
from cdpr_struct.workspace.work_list import Columns

CHUNK = 512
CUT_SHORT = "the search for tensions did not converge"
PARAMETERS = ("lambda2", "crossover_distance", "alpha_deg", "epsilon", "sag_ratio")
_DIRECTIONS = ("force x [N]", "force y [N]", "force z [N]", "moment x [N m]", "moment y [N m]", "moment z [N m]")


@dataclass(frozen=True, slots=True, eq=False)
class PoseAudit:
    """Cable parameters at k poses against the printed limits; nan at poses that the cables cannot hold.

    position, rotation : (k, 3) [m], (k, 3, 3)
    held     : (k,) bool;  reason : (k,) why not, "" where held
    tension  : (k, m) at the platform [N]
    value    : parameter -> (k, m);  limit : parameter -> (k, m), an upper bound but for the crossover distance
    broken   : parameter -> (k, m) bool
    """

    robot: Robot
    position: np.ndarray
    rotation: np.ndarray
    held: np.ndarray
    reason: tuple[str, ...]
    tension: np.ndarray
    value: dict[str, np.ndarray]
    limit: dict[str, np.ndarray]
    broken: dict[str, np.ndarray]

    @property
    def count(self) -> np.ndarray:
        """(k,) number of broken limits, over all cables."""
        return np.sum([b.sum(axis=-1) for b in self.broken.values()], axis=0)

    @property
    def use(self) -> np.ndarray:
        """(5, k, m) value over limit (limit over value for the crossover distance); above one is broken."""
        found = []
        for name in PARAMETERS:
            ratio = self.value[name] / np.where(self.limit[name] > 0.0, self.limit[name], np.nan)
            found.append(1.0 / np.maximum(ratio, 1e-12) if name == "crossover_distance" else ratio)
        return np.array(found)

    @property
    def largest_use(self) -> np.ndarray:
        """(5, k, m) `use`, zero where it is not defined."""
        return np.nan_to_num(self.use, nan=0.0)

    @property
    def worst_cable(self) -> np.ndarray:
        """(k,) number from 1 of the cable nearest to or farthest beyond a limit; 0 where the pose is not held."""
        return np.where(self.held, self.largest_use.max(axis=0).argmax(axis=-1) + 1, 0)


def audit_batches(
    robot: Robot, position: np.ndarray, rotation: np.ndarray, free: Sequence[bool] | None = None
) -> PoseBatches:
    """Columns of an audit at poses (k, 3), (k, 3, 3) or (3, 3), for `audit_of`; free : of rx, ry, rz."""
    if free is None:
        return PoseBatches("audit", _batch, robot, position, rotation, CHUNK)
    name = f"audit free {','.join(names_of(free))}"
    return PoseBatches(name, partial(_hanging_batch, tuple(free)), robot, position, rotation, CHUNK)


def audit_of(batches: PoseBatches, columns: Columns) -> PoseAudit:
    """The audit that the columns of all batches make."""
    rotation = columns.get("rotation", np.broadcast_to(batches.rotation, (len(batches.position), 3, 3)))
    values = {name: columns[name] for name in PARAMETERS}
    told = columns["held"], tuple(columns["reason"].tolist()), columns["tension"]
    return PoseAudit(batches.robot, batches.position, rotation, *told, values, *_against_limits(values))


def audit_poses(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> PoseAudit:
    """Cable parameters at poses (k, 3), (k, 3, 3) held by sagging cables of minimum-norm tension."""
    batches = audit_batches(robot, position, rotation)
    return audit_of(batches, batches.here())


def _batch(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> Columns:
    """Held or not, tensions, reasons and parameters of one batch of poses."""
    rotation = np.broadcast_to(rotation, (len(position), 3, 3))
    return _audited(robot, position, rotation, inverse(robot, position, rotation, allow_unheld=True))


def _hanging_batch(free: tuple[bool, ...], robot: Robot, position: np.ndarray, rotation: np.ndarray) -> Columns:
    """The same where the platform hangs freely about some of its angles; `rotation` (k, 3, 3) is where."""
    hung = resting_orientation(robot, position, angles_from_rotation(np.asarray(rotation)), free)
    return _audited(robot, position, hung.rotation, hung_solution(robot, hung)) | {"rotation": hung.rotation}


def _audited(robot: Robot, position: np.ndarray, rotation: np.ndarray, solution: InverseSolution) -> Columns:
    held = solution.held & (solution.tensions > 0.0).all(axis=-1)
    numbers = np.flatnonzero(held)
    values = {name: np.full(solution.tensions.shape, np.nan) for name in PARAMETERS}
    if len(numbers):
        own = solution.cables.at(numbers)
        for name, value in _parameters(OperatingPoint(robot, position[numbers], rotation[numbers], own)).items():
            values[name][numbers] = value
    reason = np.array(["" if h else _reason(solution, i) for i, h in enumerate(held)], dtype=str)
    return {"held": held, "reason": reason, "tension": np.where(held[:, None], solution.tensions, np.nan), **values}


def audit_rest(point: OperatingPoint) -> PoseAudit:
    """The same for one robot at rest, however it came there."""
    cables = point.cables.at(None)
    one = OperatingPoint(point.entered, point.position[None], point.rotation[None], cables)
    values = _parameters(one)
    held = np.ones(1, dtype=bool)
    tension = cables.tension_at_platform
    return PoseAudit(point.entered, one.position, one.rotation, held, ("",), tension, values, *_against_limits(values))


def _parameters(point: OperatingPoint) -> dict[str, np.ndarray]:
    cables = taut_cables(point)
    return {
        "lambda2": cables.lambda_squared,
        "crossover_distance": crossover_distance(cables.lambda_squared),
        "alpha_deg": np.abs(np.degrees(point.cables.inclination)),
        "epsilon": cables.epsilon,
        "sag_ratio": point.cables.sag / point.cables.chord,
    }


def _against_limits(value: dict[str, np.ndarray]) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    angle, shape = value["alpha_deg"], value["alpha_deg"].shape
    steep = angle > INCLINATION_EPSILON_PAIRS[-1][0]
    limit = {
        "lambda2": np.full(shape, LAMBDA_SQUARED_LIMIT),
        "crossover_distance": np.full(shape, CROSSOVER_DISTANCE),
        "alpha_deg": np.full(shape, INCLINATION_EPSILON_PAIRS[-1][0]),
        "epsilon": epsilon_limits(angle),
        "sag_ratio": np.full(shape, SAG_RATIO_LIMIT),
    }
    broken = {name: value[name] > limit[name] for name in PARAMETERS}
    broken["crossover_distance"] = value["crossover_distance"] < CROSSOVER_DISTANCE
    broken["epsilon"] &= ~steep
    return limit, broken


def _reason(solution: InverseSolution, pose: int) -> str:
    if solution.status[pose] == InverseStatus.NOT_CONVERGED:
        return CUT_SHORT
    if solution.held[pose]:
        return f"cable {int(solution.tensions[pose].argmin()) + 1} would go slack"
    residual = solution.residual_wrench[pose]
    axis = int(np.abs(residual).argmax())
    return f"the cables leave {residual[axis]:.3g} of {_DIRECTIONS[axis]} unbalanced"
