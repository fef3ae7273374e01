"""Tasks of any size, for the benchmark of growth: each function prepares one, and returns what is to be timed."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

from cdpr_struct.cli.main import run
from cdpr_struct.crosscheck.robot_modes import robot_modes
from cdpr_struct.dynamics.batched_modes import Batch, first_mode
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.damping import Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.dynamics.trajectory_distribution import distribute_along
from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.statics.trajectory import straight_line

POSES = 256
Task = Callable[[], object]


def ring_robot(cables: int) -> Robot:
    """Cables from a ring of 8 m radius, 6 m above, to a platform of 60 kg and 0.5 m radius, high and low in turn."""
    number = np.arange(cables)
    angle = 2.0 * np.pi * number / cables
    turned = angle + np.where(number % 2, 0.6, -0.6)
    frame = np.stack([8.0 * np.cos(angle), 8.0 * np.sin(angle), 6.0 + 0.4 * (number % 3)], axis=-1)
    own = np.stack([0.5 * np.cos(turned), 0.5 * np.sin(turned), np.where(number % 2, 0.3, -0.3)], axis=-1)
    platform = Platform(60.0, np.zeros(3), np.diag([7.1, 11.3, 11.3]))
    return Robot(f"ring-{cables}", platform, (Cable(251327.4, 0.067),) * cables, own, frame)


def _near(robot: Robot, count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(2)
    return np.array([0.0, 0.0, 1.0]) + rng.uniform(-1.0, 1.0, (count, 3)) * [1.5, 1.5, 0.3], np.eye(3)


def _rest(robot: Robot, positions: np.ndarray, rotation: np.ndarray) -> OperatingPoint:
    cables = inverse(robot, positions, rotation).cables
    return OperatingPoint(robot, positions, np.broadcast_to(rotation, (*positions.shape[:-1], 3, 3)), cables)


def ring_inverse_task(cables: int) -> Task:
    robot = ring_robot(cables)
    where = _near(robot, POSES)
    return lambda: inverse(robot, *where)


def ring_poses_task(cables: int) -> Task:
    robot = ring_robot(cables)
    point = _rest(robot, *_near(robot, POSES))
    return lambda: first_mode(Batch.of(point))


def ring_modes_task(cables: int) -> Task:
    robot = ring_robot(cables)
    point = _rest(robot, np.array([0.5, -1.0, 0.8]), np.eye(3))
    return lambda: certified_modes(point, "exact", 12)


def first_frequencies_task(poses: int) -> Task:
    """The whole command, files written."""
    side = round(poses**0.5)
    place = Path(os.environ["GROWTH_PLACE"])
    words = [
        "map",
        "thesis-3-1",
        f"--grid=-3:3:{side},-3:3:{max(2, poses // side)},0.5",
        "--quantity",
        "first-frequency",
    ]
    return lambda: run([*words, "--out", str(place), "--overwrite", "--quiet"])


def _thesis_point() -> OperatingPoint:
    return _rest(load_robot("thesis-3-1"), np.array([0.5, -1.0, 0.8]), np.eye(3))


def certified_task(count: int) -> Task:
    point = _thesis_point()
    return lambda: certified_modes(point, "exact", count)


def frequencies_task(count: int) -> Task:
    point = _thesis_point()
    port = platform_port("z", np.array([0.0, 0.0, 1.0]), False, np.zeros(3))
    hertz = np.linspace(0.1, 20.0, count)
    cables = cable_dynamics(point, "exact", 2.0 * np.pi * 20.0)
    return lambda: frequency_response(point, cables, Viscous(point.robot.damping_ratio), port, (port,), hertz)


def elements_task(count: int) -> Task:
    point = _thesis_point()
    return lambda: robot_modes(point, "fem", 12, elements=count)


def distribution_task(count: int) -> Task:
    robot = load_robot("cogiro")
    path = straight_line(Pose.from_degrees([0, 0, 1]), Pose.from_degrees([2, 1, 2]), 8.0, count)
    return lambda: distribute_along(robot, path, "frequency")


def campaign_task(readings: int) -> Task:
    """Tensions and lengths of thesis-3-1 with noise, drawn from the model itself: for the time, not for a verdict."""
    place, robot = Path(os.environ["GROWTH_PLACE"]), load_robot("thesis-3-1")
    states = readings // 16
    positions, rotation = _near(robot, states)
    held, rng = inverse(robot, positions, rotation), np.random.default_rng(3)
    tension = held.tensions + rng.normal(0.0, 3.0, held.tensions.shape)
    length = held.cables.length + rng.normal(0.0, 5e-4, held.tensions.shape)
    lines = ["case,x_m,y_m,z_m,rx_deg,ry_deg,rz_deg,cable,tension_N,length_m"]
    for i, (x, y, z) in enumerate(positions):
        for k in range(tension.shape[1]):
            lines.append(f"s{i},{x},{y},{z},0,0,0,{k + 1},{tension[i, k]:.3f},{length[i, k]:.5f}")
    (place / "states.csv").write_text("\n".join(lines) + "\n")
    (place / "campaign.toml").write_text(
        'robot = "thesis-3-1"\nmodel = "exact"\n[[measurement]]\nkind = "static_state"\nfile = "states.csv"\n'
        "sigma = { tension_N = 3.0, position_m = 0.0005, rotation_deg = 0.02, length_m = 0.0005 }\n"
    )
    return lambda: run(["diagnose", str(place / "campaign.toml"), "--quiet"])
