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
from tests.blind.controller import (
    commanded_lengths,
    exit_points,
    hanging,
    intended_tensions,
    structure_matrix,
    weight_wrench,
)
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
TINY = 1e-3  # s, of differences in time
PACES = (0.7, 1.6)  # of the six axes, against each other


@dataclass(frozen=True, eq=False)
class Curve:
    """Sines along three axes, and of angles about three fixed ones: middle, size [m, rad], pace [rad/s], phase (6,)."""

    middle: np.ndarray
    size: np.ndarray
    pace: np.ndarray
    phase: np.ndarray

    def place(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Position (F, 3) [m] and rotation (F, 3, 3)."""
        values = self.middle + self.size * np.sin(np.multiply.outer(time, self.pace) + self.phase)
        return values[:, :3], Rotation.from_euler("xyz", values[:, 3:]).as_matrix()

    def motion(self, time: np.ndarray) -> np.ndarray:
        """(F, 3, 3) acceleration of the origin [m/s^2], angular velocity [rad/s] and acceleration [rad/s^2]."""
        here = self.place(time)[0] - self.middle[:3]
        before, now, after = (self._spin(time + step) for step in (-TINY, 0.0, TINY))
        return np.stack([-(self.pace[:3] ** 2) * here, now, (after - before) / (2.0 * TINY)], axis=1)

    def _spin(self, time: np.ndarray) -> np.ndarray:
        """(F, 3) angular velocity, world [rad/s]."""
        before, after = (Rotation.from_matrix(self.place(time + step)[1]) for step in (-TINY, TINY))
        return np.asarray((after * before.inv()).as_rotvec() / (2.0 * TINY))


def drawn_curve(robot: EnteredRobot, speed: float, rng: np.random.Generator) -> Curve:
    """Through the workspace, with a largest speed of some [m/s], tilting as far as its poses may."""
    space = workspace(robot)
    low, high = np.array(space.low), np.array(space.high)
    size = np.append(0.5 * (high - low), np.full(3, np.radians(space.tilt_deg))) * rng.uniform(*REACH, 6)
    pace = rng.uniform(*PACES, 6)
    pace = pace * speed / np.linalg.norm((size * pace)[:3])
    return Curve(np.append(0.5 * (low + high), np.zeros(3)), size, pace, rng.uniform(0.0, 2.0 * np.pi, 6))


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
    return [_command(robot, *moment) for moment in zip(*curve.place(time), curve.motion(time), strict=True)]


def _moments(frames: int) -> np.ndarray:
    return STEP * np.arange(-MARGIN, frames + MARGIN)


def planned(robot: EnteredRobot, curve: Curve, frames: int) -> Motion:
    """Straight cables with the intended tensions along a curve: what sizes are computed from, not what is read."""
    time = _moments(frames)
    position, rotation = curve.place(time)
    tensions, lengths = [], []
    for place, turned in zip(position, rotation, strict=True):
        tensions.append(_intended(robot, place, turned))
        anchors = place + robot.platform_anchors @ turned.T
        lengths.append(np.linalg.norm(exit_points(robot, anchors) - anchors, axis=1))
    turns = Rotation.from_matrix(rotation).as_rotvec()
    return Motion(time, np.array(lengths), position, turns, np.array(tensions))


def _intended(robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Tensions (m,) [N] that the controller means to have; of a robot that hangs, those that carry it best."""
    if robot.hangs:
        weight = weight_wrench(robot, position, rotation, 0.0)
        wanted: np.ndarray | None = -np.linalg.pinv(structure_matrix(robot, position, rotation)) @ weight
    else:
        wanted = intended_tensions(robot, position, rotation, 0.0)
    if wanted is None or wanted.max() > workspace(robot).most_tension:
        raise RejectedDrawError
    return wanted


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


def _command(robot: EnteredRobot, position: np.ndarray, rotation: np.ndarray, motion: np.ndarray) -> Command:
    """Lengths that hold a pose at rest, by the entered model; of a robot that hangs, those of a level platform."""
    approach = np.zeros(robot.cables)
    if robot.hangs:
        lengths, there, turned, tensions = hanging(robot, position, 0.0)
        if tensions.min() < LEAST_HANGING:
            raise RejectedDrawError
        return Command(lengths, 0.0, approach, there, turned, motion=motion)
    lengths = commanded_lengths(robot, position, rotation, 0.0, _intended(robot, position, rotation))
    return Command(lengths, 0.0, approach, position, rotation, motion=motion)
