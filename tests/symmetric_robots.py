"""Robots whose structure matrix loses rank by symmetry: radial cables, parallel cables, mirrored anchors."""

import numpy as np

from cdpr_struct.robot.cable import Cable
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.robot import Robot

CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])


def symmetric_robots() -> list[Robot]:
    """Ten robots."""
    spaced = _ring(6, 300.0, 150.0)
    return [
        _robot("radial-6-6", _ring(6, 6.0), spaced, 30000.0, 1.6e8, 8.5),
        _robot("radial-6-6-inner", _ring(6, -6.0), spaced, 30000.0, 1.6e8, 8.5),
        _robot("radial-6-6-turned", _ring(6, 10.0, 0.0, 0.7), _ring(6, 300.0, 150.0, 0.7), 30000.0, 1.6e8, 8.5),
        _robot("radial-8-8", _ring(8, 1.0), _ring(8, 10.0, 6.0), 100.0, 1e6, 0.2),
        _robot("haptic", 0.05 * CORNERS, 0.5 * CORNERS, 0.3, 1e5, 0.001),
        _robot("haptic-flat", CORNERS * [0.05, 0.05, 0.02], 0.5 * CORNERS, 0.1, 1e5, 0.001),
        _robot("haptic-crossed", -0.05 * CORNERS, 0.5 * CORNERS, 0.3, 1e5, 0.001),
        _robot("haptic-half-crossed", CORNERS * [0.05, 0.05, -0.05], 0.5 * CORNERS, 0.3, 1e5, 0.001),
        _robot("vertical-6", _ring(6, 1.0), _ring(6, 1.0, 20.0), 30.0, 1e7, 0.5),
        _robot("mirrored-12", _ring(12, 0.5), _ring(12, 5.0, 4.0), 40.0, 1e6, 0.05),
    ]


def symmetric_positions(rng: np.random.Generator, robot: Robot, count: int) -> np.ndarray:
    """(count, 3) in the middle of the frame [m], three in four of them on its axis or a plane of symmetry."""
    low, high = robot.frame_anchors.min(axis=0), robot.frame_anchors.max(axis=0)
    middle, half = 0.5 * (low + high), 0.25 * (high - low)
    middle[2] -= 0.0 if half[2] > 0.0 else 0.3 * high[2]
    half[2] = max(half[2], 0.1 * high[2])
    share = rng.uniform(-1.0, 1.0, (count, 3))
    share[::4, :2] = 0.0
    share[1::4, 1] = 0.0
    share[2::4] = share[2::4, :1]
    return np.asarray(middle + share * half)


def _ring(count: int, radius: float, height: float = 0.0, phase: float = 0.0) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(count) / count + phase
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=1)


def _robot(name: str, inner: np.ndarray, outer: np.ndarray, mass: float, stiff: float, density: float) -> Robot:
    size = float(np.linalg.norm(inner, axis=1).mean())
    platform = Platform(mass, np.zeros(3), 0.4 * mass * size**2 * np.eye(3))
    return Robot(name, platform, (Cable(stiff, density),) * len(inner), inner, outer)
