"""Readings of encoders on the swivel axes of pulleys, checked: only a cable that runs over a pulley has one."""

from typing import Protocol

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.cable_columns import SWIVEL
from cdpr_struct.measurement.campaign_rows import Rows
from cdpr_struct.robot.robot import Robot

_TURN = 360.0  # deg: an encoder says an angle within a turn, counted from anywhere
_SAME = 1e-9  # deg: two notes of the same number


class Swivelling(Protocol):
    """A state with the swivel angles of its cables (m,) and their sigmas [rad]."""

    name: str
    swivel: np.ndarray
    swivel_sigma: np.ndarray


def check_swivels(rows: Rows, robot: Robot) -> None:
    """Refuse swivel angles of a cable without a pulley, and numbers that are no angle in degrees.

    Raises
    ------
    InputError : the file, row and column of the first such reading.
    """
    for i, cable, place, value in _readings(rows, len(robot.cables)):
        where = f"{rows.place(i)}, column {place}"
        if robot.pulleys[cable] is None:
            expected = f"an empty cell: cable {cable + 1} of {robot.name} has no pulley; enter one in the robot file"
            raise InputError(rows.file, where, value, expected)
        if abs(value) > _TURN:
            expected = f"the angle about the swivel axis in degrees, from -{_TURN:g} to {_TURN:g}"
            raise InputError(rows.file, where, value, expected)


def _readings(rows: Rows, cables: int) -> list[tuple[int, int, str, float]]:
    """Row, cable (from 0), column in the file and value [deg] of every swivel angle that was read."""
    names = SWIVEL.columns(cables)
    columns = [(k, name, rows.numbers[name]) for k, name in enumerate(names) if name in rows.numbers]
    found = [(i, k, name, float(v)) for k, name, own in columns for i, v in enumerate(own) if np.isfinite(v)]
    for i, value in enumerate(rows.numbers.get(SWIVEL.long, ())):
        if np.isfinite(value):
            cable = int(rows.numbers["cable"][i]) - 1
            found.append((i, cable, names[cable] if SWIVEL.long in rows.headings else SWIVEL.long, float(value)))
    return found


def take_swivel(state: Swivelling, rows: Rows, i: int, cable: int, degrees: float, sigma: float) -> None:
    """Take the angle of a cable's pulley in row i into its state; an empty cell, nan, says nothing.

    Raises
    ------
    InputError : another file gave this state another angle.
    """
    if not np.isfinite(degrees):
        return
    before = float(np.degrees(state.swivel[cable]))
    if np.isfinite(before) and abs(before - degrees) > _SAME:
        place = f"{rows.place(i)}, case {state.name}, swivel angle of cable {cable + 1}"
        expected = f"{before:.12g}, as another file says of this case, or a case of its own"
        raise InputError(rows.file, place, degrees, expected)
    state.swivel[cable], state.swivel_sigma[cable] = np.radians(degrees), np.radians(sigma)
