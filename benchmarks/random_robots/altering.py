"""Random robots altered: any size from 1 cm to 1 km and any mass, pulleys, poses near singular ones."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchmarks.random_robots.case import GRAVITY, Case
from cdpr_struct import Pose, Robot
from cdpr_struct.robot.cable import Pulley

_ALTERED = 0.5  # share of the seeds
_SMALLEST, _LARGEST = -2.0, 3.0  # log10 of the frame's extent [m]
_LIGHTEST, _HEAVIEST = -3.0, 2.0  # log10 of the factor on all forces and masses


def altered(case: Case) -> Case:
    """The case of a seed as it was drawn, or altered; draws of its own, so that the others stay as they were."""
    rng = np.random.default_rng([case.seed, 2])
    if rng.random() >= _ALTERED:
        return case
    kind = str(rng.choice(list(_ALTERATIONS), p=[0.4, 0.4, 0.2]))
    return replace(_ALTERATIONS[kind](rng, case), kind=kind)


def _any_size(rng: np.random.Generator, case: Case) -> Case:
    """All lengths and all forces by two factors; in half of the cases cables of other stiffness and weight, too."""
    extent = float(np.ptp(case.robot.frame_anchors, axis=0).max())
    lengths = 10.0 ** rng.uniform(_SMALLEST, _LARGEST) / extent
    stiffer, heavier = (1.0, 1.0) if rng.random() < 0.5 else 10.0 ** rng.uniform([-1.0, -1.5], [1.0, 0.7])
    robot = scaled(case.robot, lengths, 10.0 ** rng.uniform(_LIGHTEST, _HEAVIEST), stiffer, heavier)
    start = None if case.start is None else _moved_in(case.start, lengths)
    return replace(case, robot=robot, pose=_moved_in(case.pose, lengths), start=start)


def scaled(robot: Robot, lengths: float, forces: float, stiffer: float = 1.0, heavier: float = 1.0) -> Robot:
    """A robot with all lengths and all forces, weights among them, times two factors, and other cables."""
    body = robot.platform
    return replace(
        robot,
        platform=replace(
            body,
            mass=forces * body.mass,
            center_of_mass=lengths * body.center_of_mass,
            inertia=forces * lengths**2 * body.inertia,
        ),
        cables=tuple(
            replace(
                cable,
                axial_stiffness=forces * stiffer * cable.axial_stiffness,
                linear_density=forces * heavier / lengths * cable.linear_density,
                force_min=forces * cable.force_min,
                force_max=forces * cable.force_max,
            )
            for cable in robot.cables
        ),
        platform_anchors=lengths * robot.platform_anchors,
        frame_anchors=lengths * robot.frame_anchors,
        home=None if robot.home is None else _moved_in(robot.home, lengths),
    )


def _moved_in(pose: Pose, lengths: float) -> Pose:
    return Pose(lengths * pose.position, pose.angles)


def _over_pulleys(rng: np.random.Generator, case: Case) -> Case:
    """Swivelling pulleys at all frame anchors, or at some; with gravity, for the study's own pulleys hang cables."""
    robot, count = case.robot, len(case.robot.cables)
    extent = float(np.ptp(robot.frame_anchors, axis=0).max())
    radius = extent * 10.0 ** rng.uniform(-3.0, -1.3)
    lean = rng.uniform(-0.5, 0.5, (count, 2)) * (0.0 if rng.random() < 0.5 else 1.0)
    axes = np.concatenate([lean, np.full((count, 1), rng.choice([1.0, -1.0]))], axis=1)
    some = rng.random(count) < (1.0 if rng.random() < 0.7 else 0.6)
    pulleys = tuple(Pulley(radius, axis) if on else None for on, axis in zip(some, axes, strict=True))
    return replace(case, robot=replace(robot, pulleys=pulleys, gravity=GRAVITY))


def _near_singular(rng: np.random.Generator, case: Case) -> Case:
    """A platform just below its frame, or turned far, or with its anchors nearly in one point."""
    robot, near = case.robot, 10.0 ** rng.uniform(-5.0, -1.0)
    style = str(rng.choice(["high", "turned", "shrunk"]))
    if style == "shrunk":
        middle = robot.platform_anchors.mean(axis=0)
        return replace(case, robot=replace(robot, platform_anchors=middle + near * (robot.platform_anchors - middle)))
    position, angles = case.pose.position.copy(), case.pose.angles.copy()
    if style == "high":
        top = float(robot.frame_anchors[:, 2].max())
        position[2] = top - near * (top - position[2])
    else:
        angles[1 if robot.guided else 2] += rng.choice([-1.0, 1.0]) * np.radians(90.0) * (1.0 - near)
    return replace(case, pose=Pose(position, angles))


_ALTERATIONS: dict[str, Callable[[np.random.Generator, Case], Case]] = {
    "any size": _any_size,
    "pulleys": _over_pulleys,
    "near singular": _near_singular,
}
ALTERATIONS = tuple(_ALTERATIONS)
