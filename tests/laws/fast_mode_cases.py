"""Poses at rest, their certified modes, and how the fast path compares with them over random robots."""

from dataclasses import replace

import numpy as np

from cdpr_struct.dynamics.batched_modes import Batch, first_mode, fits, lowest_modes
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.many_poses import poses_of
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import platform_static_stiffness
from cdpr_struct.robot.cable import Pulley
from cdpr_struct.robot.extensions import Extensions
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from tests.random_robots import random_positions, random_robot

LEVEL = np.eye(3)
POLYNOMIAL = 2e-9  # largest relative error of the first squared frequency by the polynomials, which no proof covers
FIRST, MANY = 1e-8, 2e-7  # largest relative errors of the first frequency, and of twelve


def near_home(robot, count, seed=3):
    spread = np.array([1.5, 1.2, 0.3])
    return robot.home.position + np.random.default_rng(seed).uniform(-1.0, 1.0, (count, 3)) * spread


def at_rest(robot, positions) -> OperatingPoint:
    """At those of the poses that are held and stable."""
    turns = np.broadcast_to(LEVEL, (len(positions), 3, 3))
    solution = inverse(robot, positions, turns, allow_unheld=True)
    held = np.flatnonzero(solution.held)
    point = OperatingPoint(robot, positions[held], turns[held], solution.cables.at(held))
    if not held.size:
        return point
    return poses_of(point, np.flatnonzero(np.linalg.eigvalsh(platform_static_stiffness(point))[:, 0] > 0.0))


def certified_squared(point, count) -> np.ndarray:
    return certified_brackets(point, count).mean(axis=-1)


def certified_brackets(point, count) -> np.ndarray:
    """(n, count, 2) squared [rad^2/s^2]."""
    poses = range(len(point.position))
    hertz = [certified_modes(poses_of(point, i), "exact", count).frequencies.bracket_hertz for i in poses]
    return (2.0 * np.pi * np.array(hertz)) ** 2


def with_extensions(**given):
    robot = load_robot("thesis-3-1")
    return replace(robot, extensions=Extensions.of(len(robot.cables), given))


def largest_error(ours, exact) -> float:
    return float(np.abs(0.5 * np.log(ours / exact)).max())


def on_pulleys(rng, robot, axes="oblique", line=False):
    """The robot over pulleys of 0.02 to 0.3 m, with 1e-6 to 1e-4 m/N in line where `line`; axes "none": no pulleys."""
    m = len(robot.cables)
    angle = rng.uniform(0.0, 2.0 * np.pi, m)
    axis = {
        "upright": np.tile([0.0, 0.0, 1.0], (m, 1)),
        "level": np.stack([np.cos(angle), np.sin(angle), np.zeros(m)], axis=1),
        "oblique": rng.normal(size=(m, 3)),
    }
    changes = {}
    if axes != "none":
        changes["pulleys"] = tuple(Pulley(float(rng.uniform(0.02, 0.3)), a) for a in axis[axes])
    if line:
        changes["extensions"] = Extensions.of(m, {"series_compliance": 10.0 ** rng.uniform(-6.0, -4.0, m)})
    return replace(robot, **changes)


def compare(seed: int, robots: int, poses: int, changed=lambda rng, robot: robot) -> dict[str, float]:
    """Over random robots: shares of poses that fit and are proved, the largest errors against certified modes, and how
    many proved intervals miss those of the certified modes."""
    rng = np.random.default_rng(seed)
    counts, errors, many_errors, missed = np.zeros(5), [0.0], [0.0], 0
    for _ in range(robots):
        robot = changed(rng, random_robot(rng))
        point = at_rest(robot, random_positions(rng, robot, poses))
        fast = np.flatnonzero(fits(point))
        counts[:2] += len(point.position), fast.size
        if not fast.size:
            continue
        point = poses_of(point, fast)
        bracket, batch = certified_brackets(point, 12), Batch.of(point)
        exact, first, many = bracket.mean(axis=-1), first_mode(batch), lowest_modes(batch, 12)
        proved, of_many = np.isfinite(first.squared), np.isfinite(many.squared)
        counts[2:] += proved.sum(), of_many.sum(), of_many.size
        missed += apart(first.low, first.squared, bracket[:, 0])[proved].sum()
        missed += apart(many.low, many.squared, bracket)[of_many].sum()
        if proved.any():
            errors.append(largest_error(first.squared[proved], exact[proved, 0]))
        if of_many.any():
            many_errors.append(largest_error(many.squared[of_many], exact[of_many]))
    stable, fitting, proved, of_many, asked = counts
    return {
        "stable": stable, "fitting": fitting / stable, "proved": proved / fitting, "many": of_many / asked,
        "error": max(errors), "many_error": max(many_errors), "missed": missed,
    }  # fmt: skip


def apart(low, high, bracket) -> np.ndarray:
    """Whether intervals have nothing in common, but for the error of the polynomials of the first frequency."""
    return (low > bracket[..., 1] * (1.0 + POLYNOMIAL)) | (high < bracket[..., 0])
