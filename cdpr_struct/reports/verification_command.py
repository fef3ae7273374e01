"""The command that repeats a verification."""

import shlex

import numpy as np

from cdpr_struct.crosscheck.verification import Verification
from cdpr_struct.robot.pose import angles_from_rotation
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import builtin_names, load_robot


def verification_command(trial: Verification) -> str:
    """One shell command; a comment after it where the result does not tell how the robot was entered."""
    point, criteria = trial.point, trial.criteria
    robot, load, note = _entered_as(point.robot)
    degrees = np.degrees(angles_from_rotation(point.rotation))
    pose = [*point.position, *(degrees if np.abs(degrees).max() > 1e-12 else ())]
    where = ["cdpr-struct", "verify", robot, f"--pose={','.join(f'{float(v):.12g}' for v in pose)}", *load]
    how = [
        f"--elements={','.join(map(str, trial.elements))}", f"--modes={len(trial.kinds)}",
        f"--assembly={trial.assembly}", f"--tolerance={criteria.relative_error:g}", "--out=DIR",
    ]  # fmt: skip
    return f"{shlex.join(where)} \\\n  {shlex.join(how)}" + (f"\n# {note}" if note else "")


def _entered_as(robot: Robot) -> tuple[str, list[str], str]:
    """Robot argument, options of its load, and a note."""
    if robot.name not in builtin_names():
        return (
            f"{robot.name}.toml",
            [],
            f"the robot file that names itself {robot.name}, with the options it was run with",
        )
    plain, mass = load_robot(robot.name), robot.platform.mass
    if _same_platform(robot, plain):
        return robot.name, [], ""
    if mass > plain.platform.mass and _same_platform(robot, plain.with_load(payload=mass - plain.platform.mass)):
        return robot.name, [f"--payload={mass - plain.platform.mass:.12g}"], ""
    if _same_platform(robot, plain.with_load(mass=mass)):
        return robot.name, [f"--mass={mass:.12g}"], ""
    return robot.name, [], f"with the load options it was run with (platform {mass:g} kg)"


def _same_platform(one: Robot, other: Robot) -> bool:
    a, b = one.platform, other.platform
    return all(
        np.allclose(getattr(a, name), getattr(b, name), rtol=1e-9, atol=1e-12)
        for name in ("mass", "center_of_mass", "inertia")
    )
