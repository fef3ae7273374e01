"""Lengths and tensions that hold a pose."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_pose, read_robot
from cdpr_struct.interface.bands import Banded, read_band
from cdpr_struct.interface.free_angles import FreeAngles, chosen_pose
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.lumps import require_lumps_on_cables, require_sagging
from cdpr_struct.interface.operating_point import AtRest, held
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.reports import statics_rest
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.held_stability import held_stability
from cdpr_struct.statics.inverse_kinematics import InverseSolution

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw

MODELS = ("sagging", "spring", "ideal")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class InverseResult(Result):
    """Lengths and tensions that hold a pose.

    robot : with its load;  pose : that is held;  solution : lengths (m,) [m], tensions (m,) [N], cables, residual
    """

    robot: Robot
    pose: Pose
    solution: InverseSolution

    @property
    def point(self) -> OperatingPoint:
        """The robot at rest."""
        return OperatingPoint(self.robot, self.pose.position, self.pose.rotation, self.solution.cables)

    @property
    def title(self) -> str:
        """Whose tensions."""
        return f"{self.robot.name}: held at a pose"

    def text(self) -> str:
        """Lengths and tensions of every cable."""
        return statics_rest.inverse_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """Range of the tensions, and what is left unbalanced."""
        return statics_rest.inverse_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of cables.csv."""
        return statics_rest.cable_columns(self.solution.cables, self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The robot at rest, cables coloured by tension."""
        from cdpr_struct.reports.figures import robot_drawing

        return lambda figure: robot_drawing.draw_robot(figure, self.point), robot_drawing.SIZE

    def files(self) -> Files:
        """Table, drawing and page."""
        return statics_rest.inverse_files(self.robot, self.pose, self.solution, self.answer)


@answered
def inverse(
    robot: RobotLike,
    pose: PoseLike | None = None,
    *,
    payload: float = 0.0,
    mass: float | None = None,
    model: str = "sagging",
    wrench: Numbers | None = None,
    temperature: float | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    free: FreeAngles | None = None,
    orient: str | None = None,
    band: float | None = None,
    samples: int | None = None,
) -> InverseResult:
    """Find the cable lengths and tensions that hold a pose, of least norm where there is a choice.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    model : sagging, spring or ideal cables
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    orient : hanging, or even: the angles `free` (default: all) are those of the most even tensions instead

    band : level of bands about pose and tensions at these lengths [%], like 90: within the robot's tolerances
    samples : with band, so many robots drawn within the tolerances check it

    The result's `stable` says whether the platform is held there at locked lengths, or only balanced.

    Raises
    ------
    InputError : an unusable argument.
    UnholdablePoseError : the cables cannot hold the pose.
    """
    chosen, asked = one_of(model, "model", MODELS), read_band(band, samples)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, wrench, temperature, lumps=True, winches=True)
    require_sagging(machine, chosen)
    where = read_pose(pose, machine)
    hanging = chosen_pose(machine, where, free, orient, chosen)
    where = where if hanging is None else hanging.pose
    solution = held(machine, where, chosen) if hanging is None else hanging.solution
    require_lumps_on_cables(machine, solution.cables)
    point = OperatingPoint(machine, where.position, where.rotation, solution.cables)
    stable = bool(held_stability(point.arrays, point.position, point.rotation, point.cables).stable)
    bands, checks = ({}, []) if asked is None else Banded.at(point, asked, stable, chosen).rest()
    told = {
        **statics_rest.inverse_json(machine, chosen, where, solution),
        "stable": stable,
        **({"bands": bands} if bands else {}),
        **AtRest(point, hanging=hanging).told(*checks, moves=False),
    }
    return InverseResult(with_extensions(told, machine, "inverse", chosen), machine, where, solution)
