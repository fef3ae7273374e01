"""The pose that the platform takes at locked cable lengths."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_lengths, read_pose, read_robot
from cdpr_struct.interface.bands import Banded, read_band
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.inverse import MODELS
from cdpr_struct.interface.lumps import require_lumps_on_cables, require_sagging
from cdpr_struct.interface.operating_point import AtRest
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.reports import statics_rest
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.locked_rest import equilibria_text
from cdpr_struct.reports.text import paragraphs
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.locked_rest import LockedRest, locked_rest

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ForwardResult(Result):
    """The platform at rest at locked lengths.

    robot : with its load;  rest : pose, cables, start and other stable poses;  equilibria : whether these are listed
    """

    robot: Robot
    rest: LockedRest
    equilibria: bool = False

    @property
    def stable(self) -> bool:
        """Whether the platform is held there, not only balanced."""
        return bool(self.rest.solution.stable)

    @property
    def point(self) -> OperatingPoint:
        """The robot at rest."""
        found = self.rest.solution
        return OperatingPoint(self.robot, found.position, found.rotation, found.cables)

    @property
    def title(self) -> str:
        """Whose pose."""
        return f"{self.robot.name}: at locked lengths"

    def text(self) -> str:
        """Pose, stability, lengths and tensions."""
        more = [equilibria_text(dict(self.answer))] if self.equilibria else []
        return paragraphs(statics_rest.forward_text(self.answer), *more)

    def sentences(self) -> Sequence[str]:
        """Where the platform rests, how stiffly, and what is left unbalanced."""
        return statics_rest.forward_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of cables.csv."""
        return statics_rest.cable_columns(self.rest.solution.cables, self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """The robot at rest, cables coloured by tension."""
        from cdpr_struct.reports.figures import robot_drawing

        return lambda figure: robot_drawing.draw_robot(figure, self.point), robot_drawing.SIZE

    def files(self) -> Files:
        """Table, drawings and page."""
        return statics_rest.forward_files(self.robot, self.rest, self.answer, self.equilibria)


@answered
def forward(
    robot: RobotLike,
    lengths: Numbers | None = None,
    *,
    payload: float = 0.0,
    mass: float | None = None,
    wrench: Numbers | None = None,
    temperature: float | None = None,
    model: str = "sagging",
    start: PoseLike | None = None,
    equilibria: bool = False,
    band: float | None = None,
    samples: int | None = None,
) -> ForwardResult:
    """Find the pose that the platform takes at locked cable lengths, and other stable ones.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    lengths : unstrained, one a cable, or one a winch where cables share winches [m]
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]
    wrench : six numbers, a further constant force and moment on the platform, world axes [N, N m]
    temperature : of the cables, above that at which lengths are entered [K]; default: that of the robot file
    model : sagging, spring or ideal cables
    start : Pose, or x, y, z[, rx, ry, rz] [m, deg], where to look; default: the way continues from the home pose
    equilibria : print and draw the other stable poses, too
    band : level of bands about pose and tensions [%], like 90: within the robot's tolerances
    samples : with band, so many robots drawn within the tolerances check it

    Raises
    ------
    InputError : an unusable argument.
    CdprError : no equilibrium was found.
    """
    machine, chosen = (
        read_robot(robot, payload, mass, wrench=wrench, temperature=temperature, lumps=True, winches=True),
        one_of(model, "model", MODELS),
    )
    require_sagging(machine, chosen)
    asked = read_band(band, samples)
    length = read_lengths(lengths, machine)
    begin = None if start is None else read_pose(start, machine, "start")
    found = locked_rest(machine, length, begin, chosen)
    require_lumps_on_cables(machine, found.solution.cables)
    length = _paid_out(machine, length, found)
    rest = found.solution
    point = OperatingPoint(machine, rest.position, rest.rotation, rest.cables)
    bands, checks = ({}, []) if asked is None else Banded.at(point, asked, bool(rest.stable), chosen).rest()
    told = {
        **statics_rest.forward_json(machine, chosen, length, rest),
        **({"bands": bands} if bands else {}),
        **AtRest(point, found).told(*checks, moves=False),
    }
    return ForwardResult(with_extensions(told, machine, "forward", chosen), machine, found, equilibria)


def _paid_out(robot: Robot, lengths: list[float], found: LockedRest) -> list[float]:
    """The locked lengths, and where a winch holds the tension the length that it has paid out [m]."""
    reached = RobotArrays.of(robot).reading(found.solution.cables.total_length).tolist()
    each = zip(robot.cables, lengths, reached, strict=True)
    return [paid_out if cable.winch_tension else given for cable, given, paid_out in each]
