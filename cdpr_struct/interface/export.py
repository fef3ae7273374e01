"""A robot at rest as a file of another program."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.arguments import one_of, read_robot
from cdpr_struct.interface.cable_wind import require_cables_without_drag
from cdpr_struct.interface.free_angles import FreeAngles
from cdpr_struct.interface.given import Numbers, PoseLike, RobotLike
from cdpr_struct.interface.operating_point import pose_in_degrees, rest
from cdpr_struct.interface.winches import require_locked_lengths
from cdpr_struct.reports.gltf_file import gltf_bytes
from cdpr_struct.reports.moordyn_file import moordyn_text
from cdpr_struct.robot.plausibility import implausible
from cdpr_struct.robot.robot import Robot

FORMATS = ("moorpy", "moordyn", "gltf")
SUFFIX = {"moorpy": ".txt", "moordyn": ".txt", "gltf": ".glb"}


@dataclass(frozen=True, slots=True, eq=False)
class Exported:
    """A file of another program.

    content : of the file;  pose : of the robot in it, x, y, z, rx, ry, rz [m, deg]
    warnings : sentences on what the format leaves out
    """

    content: bytes
    pose: list[float]
    warnings: tuple[str, ...]

    def write(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the file and return its path.

        Raises
        ------
        InputError : there is a file already, or it cannot be written.
        """
        target = Path(path)
        try:
            with target.open("wb" if overwrite else "xb") as file:
                file.write(self.content)
        except FileExistsError as error:
            raise InputError("path", "", str(target), "a name that no file has yet, or overwrite=True") from error
        except OSError as error:
            raise InputError("path", "", str(target), f"a file that can be written ({error.strerror})") from error
        return target


@answered
def export(
    robot: RobotLike,
    pose: PoseLike | None = None,
    *,
    to: str,
    lengths: Numbers | None = None,
    start: PoseLike | None = None,
    free: FreeAngles | None = None,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    payload: float = 0.0,
    mass: float | None = None,
) -> Exported:
    """Make the input file of MoorPy or MoorDyn, or a glTF scene, of a robot at rest.

    Parameters
    ----------
    robot : Robot, built-in name, or path of a robot file
    pose : Pose, or x, y, z[, rx, ry, rz] [m, deg]; default: the home pose
    to : moorpy, moordyn or gltf
    lengths : locked unstrained lengths [m], in place of pose;  start : with lengths, the pose where to look
    free : angles of the pose that hang freely, some of rx, ry, rz; they are found from those given
    lower_bound, upper_bound : of the cable forces at the platform [N]; default: those of the robot file
    payload : point load at the platform origin [kg];  mass : replaces the platform's [kg]

    Raises
    ------
    InputError : an unusable argument.
    CdprError : the robot cannot be at rest there.
    """
    form = one_of(to, "to", FORMATS)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound, winches=True)
    _require_free_body(machine, form)
    if form != "gltf":
        require_locked_lengths(machine, "the files of MoorPy and MoorDyn hold locked lengths only")
        require_cables_without_drag(machine, "the files of MoorPy and MoorDyn hold no wind; gltf shows the cables")
    state = rest(machine, pose, lengths, start, free)
    point, told = state.point, [*implausible(machine), *state.told()["warnings"]]
    if form == "gltf":
        return Exported(gltf_bytes(point), pose_in_degrees(point), tuple(told))
    content = moordyn_text(point, "moorpy" if form == "moorpy" else "moordyn").encode("ascii")
    return Exported(content, pose_in_degrees(point), (*told, *_left_out(machine)))


def _require_free_body(robot: Robot, form: str) -> None:
    """Refuse what a free body on lines in water cannot be.

    Raises
    ------
    InputError : a guide, or gravity other than along -z.
    """
    level = robot.down.tolist() == [0.0, 0.0, -1.0] and robot.gravity > 0.0
    if form != "gltf" and (robot.guided or not level):
        raise InputError("to", "", form, f"gltf: in {form} a body is free, and gravity acts along -z")


def _left_out(robot: Robot) -> list[str]:
    """What a body on lines does not know of a robot."""
    said = []
    if any(pulley is not None for pulley in robot.pulleys):
        said.append("Pulleys: cables begin at fixed points where they leave their pulleys at this pose.")
    if robot.extensions.active:
        said.append(f"Extensions are left out: {', '.join(robot.extensions.active)}.")
    inertia = robot.platform.inertia
    if np.abs(inertia - np.diag(np.diag(inertia))).max() > 1e-9 * np.abs(inertia).max():
        said.append("Products of inertia are left out: the format has the three moments only.")
    return said
