"""What the window shows of the robot at rest, from the values of the sliders."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.errors import CdprError, InputError, told
from cdpr_struct.live.controls import Controls
from cdpr_struct.reports.figures.robot_geometry import (
    RobotGeometry,
    cable_curves,
    pulley_wheels,
    robot_geometry,
    unloaded_geometry,
)
from cdpr_struct.robot.pose import Pose, angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.forward_kinematics import forward
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.slack_cables import cables_named, hangs_slack, slack_sentence

POINTS = 49
"""Points of a cable at rest."""
_MET = 1e-6  # relative distance to a limit that counts as lying on it


@dataclass(frozen=True, slots=True, eq=False)
class ViewState:
    """The robot at rest with m cables.

    curves   : (m, p, 3) hanging cables from the frame end to the platform end, world [m]
    wheels   : (w, q, 3) rims of pulleys
    lengths  : (m,) unstrained, as encoders say them [m];  tensions : (m,) at the platform [N];  sag : (m,) [m]
    exceeded : (m,) -1 below force_min, 1 above force_max, else 0
    slack    : (m,) bool
    messages : sentences for the user; none where all is well
    """

    point: OperatingPoint
    geometry: RobotGeometry
    curves: np.ndarray
    wheels: np.ndarray
    lengths: np.ndarray
    tensions: np.ndarray
    sag: np.ndarray
    exceeded: np.ndarray
    slack: np.ndarray
    messages: tuple[str, ...]

    @property
    def pose(self) -> Pose:
        """Where the platform is."""
        return Pose(self.point.position, angles_from_rotation(self.point.rotation))


@dataclass(frozen=True, slots=True, eq=False)
class Refusal:
    """A state in which the robot cannot be: straight lines between the anchors, and why."""

    geometry: RobotGeometry
    pose: Pose
    message: str


def view_state(robot: Robot, controls: Controls) -> ViewState | Refusal:
    """The robot at rest as the sliders say, or why it cannot be there.

    A pose that is held only outside the force limits is shown with the tensions that it would take.
    """
    where = controls.placed
    try:
        loaded = robot.with_load(controls.payload)
        if controls.lengths is not None:
            return _locked(loaded, np.array(controls.lengths), where)
        return _held(loaded, where)
    except (CdprError, ArithmeticError, np.linalg.LinAlgError, ValueError) as error:
        known = str(error if isinstance(error, ValueError) and not isinstance(error, InputError) else told(error))
        return Refusal(unloaded_geometry(robot, where), where, known)


def _held(robot: Robot, where: Pose) -> ViewState:
    """With the least norm of tensions within the force limits, or else without limits.

    Raises
    ------
    CdprError : no tensions balance the platform; the message is that of the limits.
    """
    try:
        found = inverse(robot, where.position, where.rotation)
        said: tuple[str, ...] = ()
    except CdprError as error:
        free = robot.with_force_limits(0.0, np.inf)
        found = inverse(free, where.position, where.rotation, allow_unheld=True)
        if not found.held:
            raise
        said = (f"Outside the force limits: {error}",)
    return _state(OperatingPoint(robot, where.position, where.rotation, found.cables), said)


def _locked(robot: Robot, lengths: np.ndarray, start: Pose) -> ViewState:
    """At the stable equilibrium nearest to the start.

    Raises
    ------
    CdprError : none was found from there.
    """
    found = forward(robot, lengths, start.position, start.rotation).require_converged()
    if not found.stable:
        raise CdprError("At these lengths the platform has no stable equilibrium near the last pose. Change a length.")
    return _state(OperatingPoint(robot, found.position, found.rotation, found.cables), ())


def _state(point: OperatingPoint, said: tuple[str, ...]) -> ViewState:
    robot, cables = point.entered, point.cables
    pull, slack = cables.tension_at_platform, hangs_slack(cables)
    exceeded = np.where(
        pull > robot.force_max * (1.0 + _MET), 1, np.where(pull < robot.force_min * (1.0 - _MET), -1, 0)
    )
    limp = slack_sentence(slack)
    said = said or _outside(exceeded)
    return ViewState(
        point, robot_geometry(point), cable_curves(point, np.linspace(0.0, 1.0, POINTS)), pulley_wheels(point),
        RobotArrays.of(robot).reading(cables.total_length), pull, cables.sag, exceeded, slack,
        said if limp is None else (*said, f"{limp[0].upper()}{limp[1:]}."),
    )  # fmt: skip


def _outside(exceeded: np.ndarray) -> tuple[str, ...]:
    """A sentence for each kind of limit that is exceeded, (m,) as in `ViewState`."""
    found = []
    for sign, words in ((-1, "below force_min"), (1, "above force_max")):
        numbers = (np.flatnonzero(exceeded == sign) + 1).tolist()
        if numbers:
            found.append(f"{cables_named(numbers)} {'pulls' if len(numbers) == 1 else 'pull'} with a force {words}.")
    return tuple(sentence[0].upper() + sentence[1:] for sentence in found)
