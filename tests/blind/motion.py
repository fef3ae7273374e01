"""What there is to be seen of the real robot while it moves: where it rests at every moment, inertia in the balance.

The motion is slow against every vibration, so that the platform is at each moment where its cables, its weight and
d'Alembert's force on it are in balance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from tests.blind.case_drawing import RejectedDrawError
from tests.blind.controller import commanded_lengths, hanging, intended_tensions
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot
from tests.blind.measuring_plan import LEAST_HANGING, workspace
from tests.blind.observation import SLACK, Rest, SlackStateError
from tests.blind.true_robot import Command, at_rest

STEP = 0.25  # s between frames
MARGIN = 4  # frames more at either end, for readings that are late
ELEMENTS = 16  # bars a cable: position to 1e-5 m, tension to 0.1 N
SMOOTH = 5  # degree of the splines between frames
REACH = (0.25, 0.7)  # of the half workspace
PACES = (0.7, 1.6)  # of the three axes, against each other


@dataclass(frozen=True, eq=False)
class Curve:
    """Sines along three axes: middle, size [m], pace [rad/s], phase (3,) each."""

    middle: np.ndarray
    size: np.ndarray
    pace: np.ndarray
    phase: np.ndarray

    def position(self, time: np.ndarray) -> np.ndarray:
        """(F, 3) [m]."""
        return np.asarray(self.middle + self.size * np.sin(np.multiply.outer(time, self.pace) + self.phase))

    def acceleration(self, time: np.ndarray) -> np.ndarray:
        """(F, 3) [m/s^2]."""
        return np.asarray(-(self.pace**2) * (self.position(time) - self.middle))


def drawn_curve(robot: EnteredRobot, speed: float, rng: np.random.Generator) -> Curve:
    """Through the workspace, with a largest speed of some [m/s]."""
    space = workspace(robot)
    low, high = np.array(space.low), np.array(space.high)
    size = 0.5 * (high - low) * rng.uniform(*REACH, 3)
    pace = rng.uniform(*PACES, 3)
    pace = pace * speed / np.linalg.norm(size * pace)
    return Curve(0.5 * (low + high), size, pace, rng.uniform(0.0, 2.0 * np.pi, 3))


@dataclass(frozen=True, eq=False)
class Motion:
    """Moments time (N,) [s], and there: commanded lengths (N, m), position (N, 3), turns (N, 3) as rotation vectors,
    tensions (N, m) at the platform."""

    time: np.ndarray
    lengths: np.ndarray
    position: np.ndarray
    turns: np.ndarray
    tensions: np.ndarray

    def at(self, name: str, time: np.ndarray) -> np.ndarray:
        """One of these at other moments (F,)."""
        return np.asarray(make_interp_spline(self.time, getattr(self, name), k=SMOOTH)(time))


def commanded(robot: EnteredRobot, curve: Curve, frames: int) -> list[Command]:
    """Along a curve, at 0, STEP, ... and some moments before and after; lengths are those of the entered model."""
    time = _moments(frames)
    return [_command(robot, *moment) for moment in zip(curve.position(time), curve.acceleration(time), strict=True)]


def _moments(frames: int) -> np.ndarray:
    return STEP * np.arange(-MARGIN, frames + MARGIN)


def moved(robot: EnteredRobot, deviations: Deviations, commands: list[Command]) -> Motion:
    """The real robot at commands, noise free."""
    time = _moments(len(commands) - 2 * MARGIN)
    rests = [Rest.of(at_rest(robot, deviations, command, ELEMENTS)) for command in commands]
    if min(float(rest.tensions.min()) for rest in rests) < SLACK:
        raise SlackStateError
    turns = Rotation.from_matrix(np.array([rest.rotation for rest in rests])).as_rotvec()
    return Motion(
        time,
        np.array([command.lengths for command in commands]),
        np.array([rest.position for rest in rests]),
        turns,
        np.array([rest.tensions for rest in rests]),
    )


def _command(robot: EnteredRobot, position: np.ndarray, acceleration: np.ndarray) -> Command:
    """Lengths of a level platform, by the entered model at rest."""
    approach = np.zeros(robot.cables)
    if robot.hangs:
        lengths, there, turned, tensions = hanging(robot, position, 0.0)
        if tensions.min() < LEAST_HANGING:
            raise RejectedDrawError
        return Command(lengths, 0.0, approach, there, turned, acceleration=acceleration)
    wanted = intended_tensions(robot, position, np.eye(3), 0.0)
    if wanted is None or wanted.max() > workspace(robot).most_tension:
        raise RejectedDrawError
    lengths = commanded_lengths(robot, position, np.eye(3), 0.0, wanted)
    return Command(lengths, 0.0, approach, position, np.eye(3), acceleration=acceleration)
