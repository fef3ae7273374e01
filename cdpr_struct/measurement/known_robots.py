"""Which robots does a diagnosis know?"""

from collections.abc import Set
from pathlib import Path

from cdpr_struct.errors import InputError
from cdpr_struct.robot.robot import Robot

_AT_REST = frozenset({"static_state", "loaded_pose"})
"""Kinds of data that a guided platform may have."""


def require_known(robot: Robot, kinds: Set[str], source: Path) -> None:
    """Refuse a robot that a diagnosis does not know, of which data of some kinds were measured.

    Raises
    ------
    InputError : other gravity than along -z, vibration of guided platforms, winches that hold tensions or are shared,
        masses or wind on cables.
    """
    for what, expected in _unknown(robot, kinds):
        raise InputError(str(source), "robot", f"{robot.name} with {what}", expected)


def _unknown(robot: Robot, kinds: Set[str]) -> list[tuple[str, str]]:
    """What of the robot is not among what is diagnosed, and what would be right."""
    found = []
    if robot.down.tolist() != [0.0, 0.0, -1.0] or not robot.gravity > 0.0:
        found.append((f"gravity = {robot.gravity_vector.tolist()}", "gravity along -z: no other is diagnosed"))
    moving = sorted(kinds - _AT_REST)
    if robot.guided and moving:
        expected = f"only {' and '.join(sorted(_AT_REST))} of a guided platform: {moving[0]} is not diagnosed there"
        found.append((f"platform.guided = {list(robot.guided)}", expected))
    if robot.tension_winches:
        number = robot.tension_winches[0]
        held = f"cables[{number}].winch_tension = {robot.cables[number - 1].winch_tension:g}"
        expected = "winches that hold lengths: those that hold a tension are not among what is diagnosed"
        found.append((held, expected))
    if robot.shared_winches:
        expected = "a winch for each cable: shared ones are not among what is diagnosed"
        found.append((f"cables on one winch, {robot.shared_winches[0]}", expected))
    if robot.lumps:
        expected = "no [[lumps]]: masses on cables are not among what is diagnosed"
        found.append((f"{len(robot.lumps)} lumps", expected))
    if robot.extensions.drag_width.any():
        expected = "no drag_width: wind on cables is not among what is diagnosed"
        found.append((f"extensions.drag_width = {robot.extensions.drag_width.tolist()}", expected))
    return found
