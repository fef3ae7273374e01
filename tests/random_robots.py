"""Robots that no one designed: anchors around an ellipse, cables from light to heavy, platforms of all kinds."""

from typing import Any

import numpy as np

from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot


def random_robot(rng: np.random.Generator, **changes: Any) -> Robot:
    """A robot on 6 to 12 cables, all from above, or half of them from below with a preload."""
    m = int(rng.choice([6, 7, 8, 8, 8, 9, 10, 12]))
    half, height = rng.uniform(2.0, 9.0, 2), rng.uniform(2.5, 8.0)
    around = 2.0 * np.pi * (np.arange(m) + rng.uniform(-0.3, 0.3, m)) / m
    frame = np.stack([half[0] * np.cos(around), half[1] * np.sin(around), np.full(m, height)], axis=1)
    preloaded = rng.random() < 0.5
    if preloaded:
        frame[1::2, 2] = 0.0
    frame[:, 2] += rng.uniform(-0.4, 0.4, m)
    size = rng.uniform(0.15, 0.7, 3)
    inner = around + rng.uniform(0.5, 1.2, m) * np.where(np.arange(m) % 2, 1.0, -1.0)
    platform = np.stack([size[0] * np.cos(inner), size[1] * np.sin(inner), rng.uniform(-size[2], size[2], m)], axis=1)
    density = 10.0 ** rng.uniform(-2.3, -0.7)
    stiff = density * 10.0 ** rng.uniform(6.3, 7.3)
    mass = min(10.0 ** rng.uniform(0.7, 2.5), stiff / 1000.0)
    lengths = size * rng.uniform(0.6, 1.2, 3)
    inertia = mass / 3.0 * np.diag(np.sum(lengths**2) - lengths**2)
    return Robot(
        name="random",
        platform=Platform(mass, rng.uniform(-0.05, 0.05, 3), inertia),
        cables=tuple(Cable(stiff, density, force_min=2.0 * mass if preloaded else 0.0) for _ in range(m)),
        platform_anchors=platform,
        frame_anchors=frame,
        home=Pose(np.array([0.0, 0.0, rng.uniform(0.1, 0.5) * height]), np.zeros(3)),
        **changes,
    )


def random_positions(rng: np.random.Generator, robot: Robot, count: int) -> np.ndarray:
    """(count, 3) in the middle of the robot's frame [m]."""
    low, high = robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)
    middle, half = 0.5 * (low + high), 0.2 * (high - low)
    positions = middle + rng.uniform(-1.0, 1.0, (count, 3)) * half
    positions[:, 2] = rng.uniform(0.2, 0.6, count) * high[2]
    return positions
