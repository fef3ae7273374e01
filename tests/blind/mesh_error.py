"""How wrong is the referee's mesh? The null of each robot, noise free, on the mesh used and on one twice as fine."""

from __future__ import annotations

import numpy as np

from tests.blind.case_drawing import ROBOTS
from tests.blind.deviations import drawn_tolerances
from tests.blind.entered_robot import entered_robot
from tests.blind.measuring_plan import PlanSize, angles_deg, drawn_plan
from tests.blind.observation import ELEMENTS, Observation, Rest, observed
from tests.blind.sensors import CABLE_HZ, ROBOT_HZ, SIGMA
from tests.blind.vibrations import VISIBLE_SHARE

LIMIT = 0.2  # of the noise


def largest_differences(coarse: Observation, fine: Observation) -> dict[str, float]:
    """Largest difference of each kind of reading, in sigmas of its noise."""
    pairs = list(zip(_rests(coarse), _rests(fine), strict=True))
    visible = fine.shares > VISIBLE_SHARE
    robot = np.abs(coarse.robot_hz / fine.robot_hz - 1.0)[visible]
    return {
        "tension": max(float(np.abs(a.tensions - b.tensions).max()) for a, b in pairs) / SIGMA["tension_N"],
        "position": max(float(np.abs(a.position - b.position).max()) for a, b in pairs) / SIGMA["position_m"],
        "rotation": max(_turn(a, b) for a, b in pairs) / SIGMA["rotation_deg"],
        "cable frequency": float(np.abs(coarse.cable_hz / fine.cable_hz - 1.0).max()) / CABLE_HZ,
        "robot frequency": float(robot.max()) / ROBOT_HZ if robot.size else 0.0,
    }


def _rests(seen: Observation) -> list[Rest]:
    return [*seen.statics, *(rest for lock in seen.locks for rest in lock)]


def _turn(first: Rest, second: Rest) -> float:
    return float(np.abs(angles_deg(first.rotation) - angles_deg(second.rotation)).max())


def mesh_error(name: str, seed: int = 1, size: PlanSize | None = None, elements: int = ELEMENTS) -> dict[str, float]:
    """Largest differences between `elements` bars a cable and twice as many, for one drawn null of a robot."""
    robot, rng = entered_robot(name), np.random.default_rng(seed)
    deviations = drawn_tolerances(robot.cables, rng)
    if robot.pulley_radius is None:
        deviations = deviations.plus("pulley_radius", -deviations["pulley_radius"])
    plan = drawn_plan(robot, rng, size=size)
    coarse, fine = (observed(robot, deviations, plan, bars) for bars in (elements, 2 * elements))
    return largest_differences(coarse, fine)


def all_mesh_errors(seeds: tuple[int, ...] = (1, 2)) -> dict[str, dict[str, float]]:
    """Worst of some seeds for every robot."""
    found: dict[str, dict[str, float]] = {}
    for name in ROBOTS:
        rows = [mesh_error(name, seed) for seed in seeds]
        found[name] = {kind: max(row[kind] for row in rows) for kind in rows[0]}
    return found
